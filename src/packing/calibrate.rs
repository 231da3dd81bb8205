//! Refitting the settlement `Δh = α Δ₁/Δ₂ - β` (eq. 14 of Benedetto et al. 2018) to a grading, a width and a height.

use std::sync::atomic::{AtomicUsize, Ordering};

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::units::{Metres, Share};

use super::error::PackingError;
use super::optimise::{CompactionFit, RsaStart};
use super::run::{InputRule, RsaInput, pack};

/// What to step through. [`CalibrationPlan::default`] is the paper's: steps of 2.5 % with 5 arrangements.
///
/// The paper says that `Δ₂` went in "corresponding steps" without giving them. Here `Δ₁` is stepped and `Δ₂` follows from
/// keeping the solid area (eqs. 4–6), `Δ₂ = 100 (1 - 1/(1 + Δ₁/100))`: the only pairs that equations 10–17 ever use.
/// (Equal steps would give `Δ₁/Δ₂ = 1` throughout and nothing to fit; stepping both freely changes the amount of stone,
/// and a settlement then no longer depends on the ratio alone.) The paper gives no range either: the default goes from one
/// step to 30 %, twice the 15 % that its tank needs. For the paper's tank α comes out between 18 cm and 27 cm depending on
/// the range and the class reading, and β moves with it so that the input height stays within 54–56 cm.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CalibrationPlan {
    /// First `Δ₁`.
    pub first: Share,
    /// Last `Δ₁`.
    pub last: Share,
    /// Step of `Δ₁`.
    pub step: Share,
    /// Packings per step.
    pub arrangements: usize,
    /// Seed of the first packing; the others count up from it.
    pub seed: u64,
}

impl Default for CalibrationPlan {
    fn default() -> Self {
        Self { first: Share(0.025), last: Share(0.30), step: Share(0.025), arrangements: 5, seed: 1 }
    }
}

/// One packing of a calibration.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct CalibrationPoint {
    /// `Δ₁`: how much higher than the real bed the packing started.
    pub delta_1: Share,
    /// `Δ₂`: how much looser.
    pub delta_2: Share,
    /// Seed of the packing.
    pub seed: u64,
    /// Height after compaction.
    pub final_height: Metres,
    /// `Δh`: how much it settled.
    pub settlement: Metres,
}

/// A refitted settlement.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Calibration {
    /// The fit, for [`InputRule::Fit`].
    pub fit: CompactionFit,
    /// Share of the variance of `Δh` that the fit explains.
    pub r_squared: f64,
    /// Standard deviation of `Δh` about the fit, two degrees of freedom taken off.
    pub residual: Metres,
    /// Every packing that went into it.
    pub points: Vec<CalibrationPoint>,
    /// Steps left out because at least one of their packings jammed.
    pub jammed: Vec<Share>,
}

/// Packs the bed of `input` from every step of `plan` and fits `α` and `β` by least squares to all packings.
///
/// The packings run in parallel; the result does not depend on the number of threads. `progress` is told how many packings
/// are done and how many there are, from any thread. What `input` says about its own start is not used.
///
/// # Errors
/// A plan without runs, fewer than two steps that do not jam, an input that makes no sense.
pub fn calibrate(
    input: &RsaInput,
    plan: &CalibrationPlan,
    progress: impl Fn(usize, usize) + Sync,
) -> Result<Calibration, PackingError> {
    let steps = plan.steps()?;
    let total = steps.len() * plan.arrangements;
    let done = AtomicUsize::new(0);
    let runs: Vec<Result<CalibrationPoint, PackingError>> = (0..total)
        .into_par_iter()
        .map(|run| {
            let point = settle(input, steps[run / plan.arrangements], plan.seed.wrapping_add(run as u64));
            progress(done.fetch_add(1, Ordering::Relaxed) + 1, total);
            point
        })
        .collect();
    let (mut points, mut jammed) = (Vec::new(), Vec::new());
    for (step, runs) in steps.iter().zip(runs.chunks(plan.arrangements)) {
        match runs.iter().cloned().collect::<Result<Vec<_>, _>>() {
            Ok(settled) => points.extend(settled),
            Err(PackingError::Jammed { .. }) => jammed.push(*step),
            Err(error) => return Err(error),
        }
    }
    let worked = steps.len() - jammed.len();
    let line = fit_line(&points).filter(|_| worked >= 2);
    let (alpha, beta) = line.ok_or(PackingError::CalibrationTooFewPoints { worked, tried: steps.len() })?;
    let fit = CompactionFit { alpha: Metres(alpha), beta: Metres(beta) };
    let count = points.len() as f64;
    let mean = points.iter().map(|point| point.settlement.si()).sum::<f64>() / count;
    let scatter: f64 = points.iter().map(|point| (point.settlement.si() - mean).powi(2)).sum();
    let rest: f64 = points.iter().map(|p| (p.settlement.si() - fit.settlement(ratio(p)).si()).powi(2)).sum();
    let residual = Metres((rest / (count - 2.0).max(1.0)).sqrt());
    Ok(Calibration { fit, r_squared: 1.0 - rest / scatter, residual, points, jammed })
}

impl CalibrationPlan {
    fn steps(&self) -> Result<Vec<Share>, PackingError> {
        let (first, last, step) = (self.first.si(), self.last.si(), self.step.si());
        let count = ((last - first) / step + 1e-9).floor() + 1.0;
        let sensible = first > 0.0 && step > 0.0 && self.arrangements > 0 && (1.0..=10_000.0).contains(&count);
        if !sensible {
            let Self { first, last, step, arrangements, .. } = *self;
            return Err(PackingError::CalibrationHasNoRuns { first, last, step, arrangements });
        }
        Ok((0..count as usize).map(|k| Share(first + k as f64 * step)).collect())
    }
}

fn settle(input: &RsaInput, delta_1: Share, seed: u64) -> Result<CalibrationPoint, PackingError> {
    let stretch = 1.0 + delta_1.si();
    let start = RsaStart {
        height: Metres(input.height.si() * stretch),
        solid_share: Share(input.voids.solid_share().si() / stretch),
    };
    let outcome = pack(&RsaInput { input: InputRule::Explicit(start), ..input.clone() }, seed)?;
    let final_height = outcome.after.top();
    Ok(CalibrationPoint {
        delta_1,
        delta_2: Share(1.0 - 1.0 / stretch),
        seed,
        final_height,
        settlement: Metres(start.height.si() - final_height.si()),
    })
}

fn ratio(point: &CalibrationPoint) -> f64 {
    point.delta_1.si() / point.delta_2.si()
}

/// Least squares for `Δh = α ratio - β`; none for fewer than two points.
fn fit_line(points: &[CalibrationPoint]) -> Option<(f64, f64)> {
    if points.len() < 2 {
        return None;
    }
    let design = DMatrix::from_fn(points.len(), 2, |k, column| if column == 0 { ratio(&points[k]) } else { -1.0 });
    let settled = DVector::from_iterator(points.len(), points.iter().map(|point| point.settlement.si()));
    let solution = design.svd(true, true).solve(&settled, 1e-12).ok()?;
    Some((solution[0], solution[1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points that lie on the paper's own line give back its own numbers.
    #[test]
    fn points_on_a_line_give_the_line() {
        let point = |x: f64| CalibrationPoint {
            delta_1: Share(x),
            delta_2: Share(1.0 - 1.0 / (1.0 + x)),
            seed: 0,
            final_height: Metres(0.0),
            settlement: CompactionFit::PUBLISHED.settlement(1.0 + x),
        };
        let (alpha, beta) = fit_line(&[0.05, 0.1, 0.2, 0.25].map(point)).unwrap();
        assert!((alpha - 0.225).abs() < 1e-13 && (beta - 0.186).abs() < 1e-13, "{alpha} {beta}");
        assert!(fit_line(&[point(0.1)]).is_none());
    }

    #[test]
    fn the_paper_steps_by_two_and_a_half_percent() {
        let steps = CalibrationPlan::default().steps().unwrap();
        assert_eq!(steps.len(), 12);
        assert!((steps[11].si() - 0.30).abs() < 1e-12);
    }

    #[test]
    fn a_plan_without_runs_is_refused() {
        let input = RsaInput::benedetto2018().unwrap();
        let plan = CalibrationPlan { last: Share(0.01), ..Default::default() };
        assert_eq!(
            calibrate(&input, &plan, |_, _| {}).unwrap_err().to_string(),
            "a calibration from 2.5% to 1% in steps of 2.5% with 5 arrangements has no runs\n\nhint: the paper steps by 2.5% with 5 arrangements"
        );
        let plan = CalibrationPlan { first: Share(0.05), last: Share(0.05), ..Default::default() };
        assert_eq!(
            calibrate(&input, &plan, |_, _| {}).unwrap_err().to_string(),
            "the compaction fit needs at least 2 steps that do not jam, and 1 of 1 worked\n\nhint: step further up: a larger last step gives a looser start"
        );
    }
}
