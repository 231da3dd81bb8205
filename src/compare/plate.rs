//! The echo of a metal plate, measured by itself: the amplitude of a perfect reflection.

use super::error::{CompareError, check, rounded};
use super::picks::{EchoPick, Event, ExpectedEchoes, NoEcho, pick_echoes};
use super::steps;
use crate::trace::AScan;
use crate::units::Seconds;

/// The echo of a plate.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct PlateEcho {
    /// Name of the measurement.
    pub name: String,
    /// Size of the largest extremum of the echo.
    pub amplitude: f64,
    /// When that extremum comes, on the time axis of the measurement.
    pub time: Seconds,
}

/// Finds the echo of a plate in a measurement of it: the strongest echo after the direct wave, or in `window`.
///
/// The mean is taken off first, and before that `free_space` if there is one; the strongest echo of all is then taken.
///
/// # Errors
/// A trace that is none; nothing that stands out of the noise.
pub fn plate_echo(
    plate: &AScan,
    free_space: Option<&AScan>,
    window: Option<(Seconds, Seconds)>,
) -> Result<PlateEcho, CompareError> {
    check(plate)?;
    let mut trace = plate.clone();
    if let Some(reference) = free_space {
        check(reference)?;
        trace = steps::subtract_reference(&trace, reference).0;
    }
    trace = steps::remove_dc(&trace).0;
    let expected = ExpectedEchoes { no_direct_wave: free_space.is_some(), plate: window, ..ExpectedEchoes::default() };
    let picks = pick_echoes(&trace, &expected);
    // Without a window what follows the direct wave first may be the plate itself, and a multiple be the "plate".
    let candidates = if window.is_some() { vec![picks.plate] } else { vec![picks.surface, picks.plate] };
    let strength = |pick: &EchoPick| pick.echo().map_or(0.0, |echo| echo.envelope.amplitude);
    let best = candidates.into_iter().max_by(|a, b| strength(a).total_cmp(&strength(b)));
    match best {
        Some(EchoPick::Picked(echo)) => Ok(PlateEcho {
            name: plate.name.clone(),
            amplitude: echo.waveform.amplitude.abs(),
            time: echo.waveform.time,
        }),
        other => {
            let reason = match other {
                Some(EchoPick::NotPicked(reason)) => reason,
                _ => NoEcho::NoPeakInWindow {
                    from: rounded(trace.first_sample.si()),
                    to: rounded(trace.time(trace.samples.len() - 1)),
                },
            };
            let purpose = "normalise by";
            Err(CompareError::NoEvent { name: plate.name.clone(), event: Event::PlateEcho, purpose, reason })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::steps::test_traces::{ricker, trace};
    use super::*;

    /// Direct wave of 1, plate of -0.7 and its multiple of 0.2: the plate, whether or not the direct wave is taken off, and
    /// the multiple where the window says so.
    #[test]
    fn the_plate_is_the_strongest_after_the_direct_wave() {
        let direct = |t: f64| ricker(t - 3e-9);
        let free = trace("free", 1000, 2e-11, direct);
        let plate = trace("plate", 1000, 2e-11, |t| direct(t) - 0.7 * ricker(t - 8e-9) + 0.2 * ricker(t - 13e-9));
        let window = Some((Seconds(12e-9), Seconds(14e-9)));
        for (reference, window, amplitude, time) in
            [(None, None, 0.7, 8e-9), (Some(&free), None, 0.7, 8e-9), (None, window, 0.2, 13e-9)]
        {
            let found = plate_echo(&plate, reference, window).unwrap();
            assert!((found.amplitude - amplitude).abs() < 1e-3 && (found.time.si() - time).abs() < 1e-12, "{found:?}");
        }
        assert_eq!(
            plate_echo(&free, None, None).unwrap_err().to_string(),
            "`free` has no plate echo to normalise by: no echo follows the one before it\n\nhint: give its time, or choose another rule"
        );
    }
}
