//! One formatter for every number that is written.

/// Writes a number with the shortest digits that read back to the same bits; `inf` for infinity.
///
/// ```
/// use ballast_gpr::gprmax::number;
/// assert_eq!(number(0.002), "0.002");
/// assert_eq!(number(9.231e-12), "9.231e-12");
/// assert_eq!(number(f64::INFINITY), "inf");
/// ```
pub fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || value.is_infinite() || (1e-4..1e7).contains(&size) {
        format!("{value}")
    } else {
        exponent(value)
    }
}

/// As [`number`], but never a bare integer, which gprMax would take for a number of iterations.
pub(super) fn exponent(value: f64) -> String {
    format!("{value:e}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// The text of a number parses back to the same bits.
        #[test]
        fn text_parses_back_to_the_same_bits(bits in any::<u64>()) {
            let value = f64::from_bits(bits);
            prop_assume!(!value.is_nan());
            prop_assert_eq!(number(value).parse::<f64>().unwrap().to_bits(), bits);
            prop_assert_eq!(exponent(value).parse::<f64>().unwrap().to_bits(), bits);
        }
    }
}
