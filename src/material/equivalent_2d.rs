//! The stone that makes a two-dimensional bed as slow as the real one.

use super::{Complex, MixError, MixingModel, mix};
use crate::units::Share;

/// How travel time is judged, which decides how much slower than the arithmetic mean a bed of circles is.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum JudgedBy {
    /// By phase or correlation: 1.05 times the arithmetic mean (1.03 to 1.06 measured at the centre frequency).
    Phase,
    /// By the peak of the envelope: 1.10 times (1.09 to 1.11 measured).
    EnvelopePeak,
    /// By a factor measured for the grading and frequency at hand.
    Factor(f64),
}

impl JudgedBy {
    /// Bulk permittivity of a bed of circles in 2-D TM over the arithmetic mean of its parts.
    ///
    /// The two fixed factors were measured on random packings of 22 to 63 mm circles, solid share 0.50 to 0.51, stone 6.5,
    /// Ricker 0.5 and 1 GHz, cells of 2 mm. Measure your own for another grading or frequency.
    pub const fn factor(self) -> f64 {
        match self {
            Self::Phase => 1.05,
            Self::EnvelopePeak => 1.10,
            Self::Factor(factor) => factor,
        }
    }
}

/// The equivalent stone, and what the bed would read with and without it. Serialised, each permittivity is the pair of its
/// real and imaginary part.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Equivalent2d {
    /// Permittivity to give the stones of the two-dimensional model.
    #[serde(serialize_with = "as_pair")]
    pub stone: Complex,
    /// Factor between the bed and the arithmetic mean that was reckoned with.
    pub factor: f64,
    /// Bulk permittivity of the real bed: refractive mixing (CRIM) of the true rock and the fill.
    #[serde(serialize_with = "as_pair")]
    pub target_bulk: Complex,
    /// Bulk permittivity that the two-dimensional bed shows with the true rock: the factor times the arithmetic mean.
    #[serde(serialize_with = "as_pair")]
    pub uncorrected_bulk: Complex,
    /// The arithmetic mean itself, with the true rock.
    #[serde(serialize_with = "as_pair")]
    pub arithmetic_bulk: Complex,
}

fn as_pair<S: serde::Serializer>(value: &Complex, serializer: S) -> Result<S::Ok, S::Error> {
    serde::Serialize::serialize(&[value.re, value.im], serializer)
}

/// Why there is no equivalent stone.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Equivalent2dError {
    /// No stones, or a factor that is none.
    #[error("a solid share of {solid} with factor {factor} has no equivalent stone: both should be above zero")]
    NothingToCorrect {
        /// Share of the volume that is stone.
        solid: Share,
        /// The factor.
        factor: f64,
    },
    /// The stone would have to be lighter than air.
    #[error(
        "the equivalent stone would need a permittivity of {stone}, below 1: the fill alone is nearly as slow as the real bed\n\nhint: use the true rock, or a smaller factor than {factor}"
    )]
    BelowFreeSpace {
        /// What the equation gives.
        stone: Complex,
        /// The factor used.
        factor: f64,
    },
    /// The parts do not mix.
    #[error(transparent)]
    Mix(#[from] MixError),
}

/// Computes the stone permittivity `e` that solves `k ((1 - f) fill + f e) = CRIM(f rock, (1 - f) fill)`.
///
/// `f` is the solid share. A bed of circles under a field along their axes (2-D TM) is at least as slow as the
/// arithmetic mean of its parts, while a real bed is near CRIM; with the true rock its base echo is late by as much as 20 cm
/// of fouling would make it. Always report [`Equivalent2d::uncorrected_bulk`] beside the corrected run. `fill` is what is
/// between the stones as one medium (air, or fines and water already mixed). Three-dimensional runs need none of this.
///
/// ```
/// use ballast_gpr::material::{equivalent_2d, Complex, JudgedBy};
/// use ballast_gpr::units::Share;
/// let one = Complex::new(1.0, 0.0);
/// let found = equivalent_2d(Complex::new(6.5, 0.0), one, Share(0.58), JudgedBy::Phase)?;
/// assert!((found.stone.re - 5.20).abs() < 0.005);
/// # Ok::<(), ballast_gpr::material::Equivalent2dError>(())
/// ```
///
/// # Errors
/// No stones, a factor of zero or less, parts that do not mix, or a stone that would be lighter than air.
pub fn equivalent_2d(
    rock: Complex,
    fill: Complex,
    solid: Share,
    judged_by: JudgedBy,
) -> Result<Equivalent2d, Equivalent2dError> {
    let (f, factor) = (solid.si(), judged_by.factor());
    if !(f > 0.0 && factor > 0.0 && factor.is_finite()) {
        return Err(Equivalent2dError::NothingToCorrect { solid, factor });
    }
    let parts = [(solid, rock), (Share(1.0 - f), fill)];
    let target_bulk = mix(MixingModel::Crim, &parts)?;
    let arithmetic_bulk = mix(MixingModel::Arithmetic, &parts)?;
    let mut stone = (target_bulk / factor - fill * (1.0 - f)) / f;
    if rock.im == 0.0 && fill.im == 0.0 {
        stone.im = 0.0;
    }
    if stone.re < 1.0 || stone.im > 0.0 {
        return Err(Equivalent2dError::BelowFreeSpace { stone, factor });
    }
    Ok(Equivalent2d { stone, factor, target_bulk, uncorrected_bulk: arithmetic_bulk * factor, arithmetic_bulk })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn real(eps: f64) -> Complex {
        Complex::new(eps, 0.0)
    }

    /// Figures of the polarisation measurement: f 0.511, rock 6.5: 5.03 by phase and 4.75 by envelope (by hand
    /// (3.2106/1.10 - 0.489)/0.511 = 4.755); f 0.58: 5.20.
    #[test]
    fn the_equivalent_stone_of_the_measured_beds() {
        for (solid, by, stone) in
            [(0.511, JudgedBy::Phase, 5.03), (0.511, JudgedBy::EnvelopePeak, 4.755), (0.58, JudgedBy::Phase, 5.20)]
        {
            let found = equivalent_2d(real(6.5), real(1.0), Share(solid), by).unwrap();
            assert!((found.stone.re - stone).abs() < 0.006, "{found:?}");
        }
        let found = equivalent_2d(real(6.5), real(1.0), Share(0.511), JudgedBy::Phase).unwrap();
        assert!((found.target_bulk.re - 3.21).abs() < 0.005 && (found.arithmetic_bulk.re - 3.81).abs() < 0.005);
        assert!((found.uncorrected_bulk.re / found.target_bulk.re - 1.25).abs() < 0.02, "+23…+32 % is reported");
    }

    /// Putting the stone back into the equation gives the bulk of the real bed, with fouling for fill too.
    #[test]
    fn the_equation_holds_with_fouling_in_the_voids() {
        let (rock, fill) = (Complex::new(6.5, -0.1), Complex::new(5.03, -0.4));
        let found = equivalent_2d(rock, fill, Share(0.58), JudgedBy::Factor(1.02)).unwrap();
        let back = (fill * 0.42 + found.stone * 0.58) * 1.02;
        assert!((back - found.target_bulk).norm() < 1e-12);
    }

    #[test]
    fn messages_word_for_word() {
        let message =
            |rock, fill, solid, by| equivalent_2d(real(rock), real(fill), Share(solid), by).unwrap_err().to_string();
        assert_eq!(
            message(6.5, 1.0, 0.0, JudgedBy::Phase),
            "a solid share of 0% with factor 1.05 has no equivalent stone: both should be above zero"
        );
        let light = message(2.0, 80.0, 0.5, JudgedBy::Phase);
        assert!(light.starts_with("the equivalent stone would need a permittivity of -"), "{light}");
        assert!(light.ends_with("\n\nhint: use the true rock, or a smaller factor than 1.05"), "{light}");
    }
}
