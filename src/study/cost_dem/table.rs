//! What the beds came to.

use crate::study::cost_dem::plan::{DemKnob, DemSetting};
use crate::study::statistics::MeanAndSpread;

/// A figure of a setting beside that of its reference.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Judged {
    /// Mean over the seeds.
    pub mean: f64,
    /// Standard deviation of a single bed.
    pub spread: f64,
    /// Mean less that of the reference.
    pub error: f64,
    /// Standard error of this difference: errors below it cannot be told from chance.
    pub noise: f64,
}

impl Judged {
    /// Of figures and those of the reference; none where either is empty.
    pub(super) fn of(figures: &[f64], reference: &[f64]) -> Option<Self> {
        let (own, reference) = (MeanAndSpread::of(figures)?, MeanAndSpread::of(reference)?);
        let variance = |of: MeanAndSpread| of.standard_deviation.powi(2) / of.count as f64;
        Some(Self {
            mean: own.mean,
            spread: own.standard_deviation,
            error: own.mean - reference.mean,
            noise: (variance(own) + variance(reference)).sqrt(),
        })
    }
}

/// What a setting gives and costs.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct DemCostRow {
    /// What is turned.
    pub knob: DemKnob,
    /// Where it stands, for people.
    pub name: String,
    /// The setting; none where nothing is settled.
    pub setting: Option<DemSetting>,
    /// Whether the others of the knob are judged by this one.
    pub reference: bool,
    /// Stones of a bed, on average.
    pub stones: f64,
    /// Median wall time of a bed on one thread, s.
    pub seconds: f64,
    /// Voids below four fifths of the height, %.
    pub voids_percent: Option<Judged>,
    /// Strain between the stresses of the plate, %; none where nothing is settled.
    pub strain_percent: Option<Judged>,
    /// Arrival of the metal plate's echo from the emission, by the envelope, mean over the sections of a bed, ns.
    pub plate_ns: Option<Judged>,
    /// Relative L2 difference of the mean trace (direct wave taken off) from that of the reference, %.
    pub trace_percent: Option<f64>,
    /// What chance makes of it: the norm of the standard error of both means, %.
    pub trace_noise_percent: Option<f64>,
    /// Sections whose plate echo could not be picked.
    pub not_picked: usize,
    /// What stopped a bed, where one was.
    pub stopped: Option<String>,
}

/// All settings.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct DemCostTable {
    /// Version of the format.
    pub format_version: u32,
    /// Height of all beds, m.
    pub height_m: f64,
    /// The setting that the knobs are turned about.
    pub base: DemSetting,
    /// Beds of each setting.
    pub seeds: u64,
    /// Sections through each bed.
    pub sections: usize,
    /// The rows.
    pub rows: Vec<DemCostRow>,
}

/// Mean trace of all sections, and the square of the norm of its standard error. The traces are those of one grid's step; what
/// is longer than the shortest is cut.
pub(super) fn mean_trace(traces: &[Vec<f64>]) -> Option<(Vec<f64>, f64)> {
    let count = traces.len();
    let samples = traces.iter().map(Vec::len).min()?;
    let mean: Vec<f64> = (0..samples).map(|k| traces.iter().map(|t| t[k]).sum::<f64>() / count as f64).collect();
    let squares: f64 = traces.iter().flat_map(|t| t.iter().zip(&mean)).map(|(v, mean)| (v - mean).powi(2)).sum();
    let error = if count > 1 { squares / ((count - 1) * count) as f64 } else { 0.0 };
    Some((mean, error))
}

/// Relative L2 difference of two mean traces, and what chance makes of it; shares of the reference's norm.
pub(super) fn off(of: &(Vec<f64>, f64), reference: &(Vec<f64>, f64)) -> (f64, f64) {
    let norm = reference.0.iter().map(|v| v * v).sum::<f64>().sqrt();
    let distance = of.0.iter().zip(&reference.0).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    (distance / norm, (of.1 + reference.1).sqrt() / norm)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1, 3 against 4, 8: means 2 and 6, variances 2 and 8, of the mean 1 and 4, so that the difference -4 is known to √5.
    #[test]
    fn a_difference_has_the_errors_of_both() {
        let judged = Judged::of(&[1.0, 3.0], &[4.0, 8.0]).unwrap();
        assert_eq!((judged.mean, judged.error), (2.0, -4.0));
        assert!((judged.noise - 5.0_f64.sqrt()).abs() < 1e-15);
        assert!(Judged::of(&[], &[1.0]).is_none());
    }

    /// Traces that differ by chance alone: the distance of two means of `n` is what the noise says, within a tenth for 4,000
    /// samples of the triangle-like sum of two hashes.
    #[test]
    fn chance_alone_is_told_as_such() {
        let mut state = 1_u64;
        let mut chance = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let mut traces = |n: usize| -> Vec<Vec<f64>> {
            (0..n).map(|_| (0..4000).map(|k| (k as f64 * 0.01).sin() + chance()).collect()).collect()
        };
        let (a, b) = (mean_trace(&traces(6)).unwrap(), mean_trace(&traces(9)).unwrap());
        let (found, noise) = off(&a, &b);
        assert!((found / noise - 1.0).abs() < 0.1, "{found} {noise}");
    }
}
