//! Physical constants, CODATA 2022 (the values that SciPy 1.15 and later, and so gprMax 4.0.1, use).

/// Speed of light in vacuum, m/s (exact).
pub const C0: f64 = 299_792_458.0;
/// Vacuum permittivity, F/m.
pub const EPSILON_0: f64 = 8.854_187_818_8e-12;
/// Vacuum permeability, H/m.
pub const MU_0: f64 = 1.256_637_061_27e-6;
/// Impedance of free space, ohm.
pub const Z0: f64 = 376.730_313_411_805_1;

#[cfg(test)]
mod tests {
    use super::*;

    /// The three electromagnetic constants hang together to the digits CODATA prints.
    #[test]
    fn constants_hang_together() {
        assert!((C0 * (EPSILON_0 * MU_0).sqrt() - 1.0).abs() < 1e-11);
        assert!((Z0 / (MU_0 / EPSILON_0).sqrt() - 1.0).abs() < 1e-11);
    }
}
