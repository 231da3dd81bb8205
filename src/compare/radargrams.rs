//! Radargrams through the steps of a comparison of their mean traces.

use super::error::CompareError;
use super::process::Section as _;
use super::resample::resample;
use super::steps::{self, Step};
use crate::trace::{AScan, BScan};

/// Takes every trace of a radargram through steps that were done to one trace, and onto the axis of what came out.
///
/// `steps` and `prepared` are those of a [`Comparison`](super::Comparison) of the mean traces of two radargrams; then both
/// radargrams lie on one axis and [`structural_similarity`](super::structural_similarity) can be computed. `reference` is
/// what was subtracted. Steps that do not come from a comparison are left out.
///
/// # Errors
/// Traces that do not fit together.
pub fn prepare_as(
    section: &BScan,
    steps: &[Step],
    prepared: &AScan,
    reference: Option<&AScan>,
) -> Result<BScan, CompareError> {
    let mut section = section.clone();
    for step in steps {
        section = match step {
            Step::Subtracted { .. } => match reference {
                Some(reference) => steps::subtract_reference(&section, reference).0,
                None => section,
            },
            Step::MeanRemoved { .. } => steps::remove_dc(&section).0,
            Step::TimeZeroSet { shift, .. } => {
                section.moved(crate::units::Seconds(section.first_sample.si() + shift.si()))
            }
            Step::Flipped => steps::flip(&section).0,
            Step::Normalised { divisor, .. } => steps::normalise(&section, *divisor, "").0,
            _ => section,
        };
    }
    let (first, dt, count) = (prepared.first_sample, prepared.time_step, prepared.samples.len());
    let mut row = AScan { time_step: section.time_step, first_sample: section.first_sample, ..prepared.clone() };
    let new = section.rebuilt(first, dt, |trace| {
        row.samples = trace.to_vec();
        resample(&row, first, dt, count).samples
    })?;
    Ok(new)
}

#[cfg(test)]
mod tests {
    use super::super::comparison::{CompareOptions, compare};
    use super::super::process::mean_trace;
    use super::super::steps::test_traces::{ricker, trace};
    use super::*;
    use crate::compare::structural_similarity;

    fn line(dt: f64, scale: f64, offset: f64) -> BScan {
        let traces: Vec<_> = (0..9)
            .map(|k| {
                let late = 0.05e-9 * f64::from(k);
                trace("line", (20e-9 / dt) as usize, dt, |t| {
                    offset + scale * (ricker(t - 4e-9) - 0.5 * ricker(t - 9e-9 - late))
                })
            })
            .collect();
        BScan::of(&traces, "line".into()).unwrap()
    }

    /// The same line with another step, scale, sign and offset: after the steps of the mean traces it is the same radargram,
    /// to the 1e-5 of the resampling.
    #[test]
    fn the_same_line_seen_by_another_instrument_is_the_same_line() {
        let (a, b) = (line(2e-11, 1.0, 0.0), line(4.9e-11, -300.0, 50.0));
        let found = compare(&mean_trace(&a), &mean_trace(&b), &CompareOptions::default()).unwrap();
        let a = prepare_as(&a, &found.steps_a, &found.a, None).unwrap();
        let b = prepare_as(&b, &found.steps_b, &found.b, None).unwrap();
        assert_eq!(a.samples_per_trace(), b.samples_per_trace());
        let similarity = structural_similarity(&a, &b).unwrap();
        assert!(similarity > 0.999, "{similarity}");
        let (flipped, _) = steps::flip(&b);
        let turned = structural_similarity(&a, &flipped).unwrap();
        assert!(turned < 0.97, "{turned}");
    }
}
