//! Reading "20cm", "1 GHz", "42%": digits scaled in decimal, then rounded once.

/// Why a quantity could not be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum UnitError {
    /// No number at the front.
    #[error("`{text}` is not a {dimension}: it should start with a number\n\nhint: write for example `{example}`")]
    NotANumber {
        /// What the user wrote.
        text: String,
        /// `length`, `time`, …
        dimension: &'static str,
        /// Something that would be read.
        example: &'static str,
    },
    /// A number without a unit.
    #[error("`{text}` has no unit: a {dimension} needs one of {known}\n\nhint: write for example `{example}`")]
    NoUnit {
        /// What the user wrote.
        text: String,
        /// `length`, `time`, …
        dimension: &'static str,
        /// The units that are known.
        known: String,
        /// Something that would be read.
        example: &'static str,
    },
    /// A unit that this quantity does not have.
    #[error(
        "`{text}` has the unknown unit `{unit}`: a {dimension} needs one of {known}\n\nhint: write for example `{example}`"
    )]
    UnknownUnit {
        /// What the user wrote.
        text: String,
        /// The unit found.
        unit: String,
        /// `length`, `time`, …
        dimension: &'static str,
        /// The units that are known.
        known: String,
        /// Something that would be read.
        example: &'static str,
    },
}

/// A unit: its name and the power of ten that turns it into SI.
pub(super) type Unit = (&'static str, i32);

/// Reads `text` as a number and one of `units`, scaled to SI by shifting the decimal exponent (correctly rounded).
pub(super) fn parse(
    text: &str,
    dimension: &'static str,
    units: &[Unit],
    example: &'static str,
) -> Result<f64, UnitError> {
    let trimmed = text.trim();
    let (number, unit) = split(trimmed);
    let not_a_number = || UnitError::NotANumber { text: text.into(), dimension, example };
    let value: f64 = number.parse().map_err(|_| not_a_number())?;
    if !value.is_finite() {
        return Err(not_a_number());
    }
    let known = || units.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
    if unit.is_empty() {
        return Err(UnitError::NoUnit { text: text.into(), dimension, known: known(), example });
    }
    let power = units.iter().find(|(name, _)| *name == unit).map(|(_, power)| *power).ok_or_else(|| {
        UnitError::UnknownUnit { text: text.into(), unit: unit.into(), dimension, known: known(), example }
    })?;
    let (mantissa, exponent) = match number.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().map_err(|_| not_a_number())?),
        None => (number, 0),
    };
    format!("{mantissa}e{}", exponent + power).parse().map_err(|_| not_a_number())
}

/// Splits "1.5e-3 m" into the number and the unit.
fn split(text: &str) -> (&str, &str) {
    let bytes = text.as_bytes();
    let mut end = 0;
    while end < bytes.len() {
        let c = bytes[end];
        let exponent_follows = || {
            let mut k = end + 1;
            if matches!(bytes.get(k), Some(b'+' | b'-')) {
                k += 1;
            }
            end > 0 && bytes.get(k).is_some_and(u8::is_ascii_digit)
        };
        let sign_in_exponent = matches!(c, b'+' | b'-') && (end == 0 || matches!(bytes[end - 1], b'e' | b'E'));
        if c.is_ascii_digit() || c == b'.' || sign_in_exponent || (matches!(c, b'e' | b'E') && exponent_follows()) {
            end += 1;
        } else {
            break;
        }
    }
    (&text[..end], text[end..].trim())
}

/// Writes `si` in the unit that is `10^power`, with the shortest digits that read back to the same bits.
pub(super) fn shortest(si: f64, power: i32) -> String {
    if si == 0.0 || !si.is_finite() {
        return format!("{si}");
    }
    let text = format!("{si:e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent = exponent.parse::<i32>().unwrap_or(0) - power;
    let (sign, mantissa) = mantissa.strip_prefix('-').map_or(("", mantissa), |rest| ("-", rest));
    let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
    let point = 1 + exponent;
    if !(-3..=15).contains(&point) {
        return format!("{sign}{mantissa}e{exponent}");
    }
    let count = digits.len() as i32;
    if point <= 0 {
        format!("{sign}0.{}{digits}", "0".repeat((-point) as usize))
    } else if point >= count {
        format!("{sign}{digits}{}", "0".repeat((point - count) as usize))
    } else {
        format!("{sign}{}.{}", &digits[..point as usize], &digits[point as usize..])
    }
}
