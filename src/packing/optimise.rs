//! The input height and the input solid share that settle to the real ones: equations 7–19 of Benedetto et al. 2018.

use crate::units::{Metres, Share};

use super::error::{PackingError, positive};
use super::porosity::Porosity;

/// The settlement of a bed under compaction, `Δh = α Δ₁/Δ₂ - β` (eq. 14 of Benedetto et al. 2018).
///
/// It was fitted for circles of one grading in one rectangle: refit it for others
/// ([`calibrate`](super::calibrate::calibrate)).
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CompactionFit {
    /// Slope α.
    pub alpha: Metres,
    /// Offset β.
    pub beta: Metres,
}

impl CompactionFit {
    /// The numbers of the paper: α = 22.5, β = 18.6; it prints no unit, and only centimetres give its own 55 cm.
    pub const PUBLISHED: Self = Self { alpha: Metres(0.225), beta: Metres(0.186) };

    /// The settlement for a ratio `Δ₁/Δ₂`, eq. 14.
    pub fn settlement(&self, ratio: f64) -> Metres {
        Metres(self.alpha.si() * ratio - self.beta.si())
    }
}

/// What the positioning of stones starts from.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct RsaStart {
    /// Height of the domain before compaction, `h*_input`.
    pub height: Metres,
    /// Solid share of the domain before compaction, `P*_c,input / 100`.
    pub solid_share: Share,
}

/// Solves equations 7–19 for the start that settles to a bed of `height` with `voids`.
///
/// With `x = Δ₁/100`, the solid area is kept (eqs. 4–6) when `(1 + x)(1 - Δ₂/100) = 1`, so `Δ₁/Δ₂ = 1 + x`; put into
/// `h_real = h_real (1 + x) - α (1 + x) + β` (eqs. 9, 14) this gives `x = (α - β)/(h_real - α)`. Eq. 15 prints a product
/// where eq. 13 has the minus of the settlement, and the text says `h' < h` where `h' > h` is meant: the minus and
/// `h' > h` are used here.
///
/// # Errors
/// A height that is none; a fit that does not settle; a height for which the input height would be more than double the
/// real one, where the fit diverges (at `h_real = α`) and means nothing.
pub fn optimise(height: Metres, voids: Porosity, fit: CompactionFit) -> Result<RsaStart, PackingError> {
    let h = positive("height of the bed", height)?;
    let (alpha, beta) = (fit.alpha.si(), fit.beta.si());
    if alpha.is_nan() || beta.is_nan() || alpha <= beta {
        return Err(PackingError::FitDoesNotSettle { alpha: fit.alpha, beta: fit.beta });
    }
    let lowest = (alpha + (alpha - beta)).max(0.0);
    if h < lowest {
        let lowest = Metres((lowest * 1e4).ceil() / 1e4);
        return Err(PackingError::FitDiverges { alpha: fit.alpha, beta: fit.beta, height, lowest });
    }
    let x = (alpha - beta) / (h - alpha);
    Ok(RsaStart { height: Metres(h * (1.0 + x)), solid_share: Share(voids.solid_share().si() / (1.0 + x)) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Section 5.2.1: 48 cm and 58 % start from 55 cm and 50 %; unrounded 55.3 cm and 50.3 %.
    #[test]
    fn the_tank_of_the_paper() {
        let start = optimise(Metres(0.48), Porosity::BENEDETTO_2018, CompactionFit::PUBLISHED).unwrap();
        assert!((start.height.si() - 0.5534).abs() < 5e-5, "{}", start.height);
        assert!((start.solid_share.si() - 0.5031).abs() < 5e-5, "{}", start.solid_share);
        assert_eq!((start.height.si() * 100.0).round(), 55.0);
        assert_eq!((start.solid_share.si() * 100.0).round(), 50.0);
    }

    #[test]
    fn where_the_fit_diverges_it_is_refused() {
        let error = optimise(Metres(0.25), Porosity::BENEDETTO_2018, CompactionFit::PUBLISHED).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the compaction fit (alpha 22.5 cm, beta 18.6 cm) gives no input height for a bed of 25 cm: it holds from 26.4 cm upwards\n\nhint: refit it to this grading and height with `--calibrate`"
        );
        let fit = CompactionFit { alpha: Metres(0.1), beta: Metres(0.2) };
        let error = optimise(Metres(0.48), Porosity::BENEDETTO_2018, fit).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the compaction fit (alpha 10 cm, beta 20 cm) says that a bed does not settle: alpha must be above beta\n\nhint: the paper has alpha 22.5 cm and beta 18.6 cm"
        );
        let error = optimise(Metres(0.0), Porosity::BENEDETTO_2018, CompactionFit::PUBLISHED).unwrap_err();
        assert!(error.to_string().starts_with("the height of the bed of 0 m is not a length"), "{error}");
    }

    proptest! {
        /// The start solves the paper's system: eq. 9 with eq. 14 gives back the real height, and the solid area is kept.
        #[test]
        fn the_start_solves_the_system(h in 0.265..3.0_f64, voids in 0.2..0.7_f64) {
            let voids = Porosity::new(Share(voids)).unwrap();
            let start = optimise(Metres(h), voids, CompactionFit::PUBLISHED).unwrap();
            let delta_1 = 100.0 * (start.height.si() / h - 1.0);
            let delta_2 = 100.0 * (1.0 - start.solid_share.si() / voids.solid_share().si());
            let settled = start.height.si() - CompactionFit::PUBLISHED.settlement(delta_1 / delta_2).si();
            prop_assert!((settled - h).abs() < 1e-9 * h, "{} {}", settled, h);
            let solid = start.height.si() * start.solid_share.si();
            prop_assert!((solid - h * voids.solid_share().si()).abs() < 1e-12);
        }
    }
}
