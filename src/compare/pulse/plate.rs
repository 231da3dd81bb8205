//! The echo of a metal plate, cut out of a measurement.

use std::f64::consts::PI;

use crate::compare::error::CompareError;
use crate::compare::picks::{Echo, EchoPick, Event, ExpectedEchoes, pick_echoes};
use crate::compare::steps::{Step, subtract_reference};
use crate::trace::AScan;
use crate::units::Seconds;

/// What is kept around the peak of an echo's envelope.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Gate {
    /// Kept before the peak.
    pub before: Seconds,
    /// Kept after it.
    pub after: Seconds,
    /// Over which both ends rise and fall, as half a period of a cosine; inside what is kept.
    pub taper: Seconds,
}

impl Gate {
    /// The gate for pulses of a centre frequency: 1.2 periods before the peak, 1.6 after it, ends of 0.4.
    ///
    /// Tuned on the plate echoes of one horn of 1 GHz at three heights: the pulse of the middle one predicts the others with
    /// correlations of 0.95 and 0.98; from 1.0 and 1.5 to 1.3 and 2.0 periods that is 0.95 and 0.97 to 0.99. Longer gates take in
    /// what comes from beside the plate (0.93 with 1.5 and 3.0).
    pub fn of_frequency(frequency: f64) -> Self {
        let period = 1.0 / frequency;
        Self { before: Seconds(1.2 * period), after: Seconds(1.6 * period), taper: Seconds(0.4 * period) }
    }

    /// Weight at a time from the peak, s.
    fn weight(&self, t: f64) -> f64 {
        let inside = (t + self.before.si()).min(self.after.si() - t);
        if inside <= 0.0 {
            return 0.0;
        }
        if inside >= self.taper.si() { 1.0 } else { 0.5 - 0.5 * (PI * inside / self.taper.si()).cos() }
    }

    /// Multiplies a trace with the gate around a time.
    pub fn apply(&self, trace: &AScan, around: Seconds) -> AScan {
        let samples = trace.times().zip(&trace.samples).map(|(t, v)| v * self.weight(t - around.si())).collect();
        AScan { samples, ..trace.clone() }
    }
}

/// How the echo is found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateOptions {
    /// What is kept.
    pub gate: Gate,
    /// Where the echo is looked for; without it, the strongest echo after the direct wave (of all, where a free-space trace was
    /// taken off).
    pub window: Option<(Seconds, Seconds)>,
}

/// An echo of a plate.
#[derive(Debug, Clone)]
pub struct PlateEcho {
    /// The trace, free space taken off, zero outside the gate.
    pub trace: AScan,
    /// The same before the gate.
    pub ungated: AScan,
    /// Where the echo is.
    pub echo: Echo,
    /// What was done.
    pub steps: Vec<Step>,
    /// Share of the energy before the gate that lies outside it, from one gate before the peak to one after it.
    pub energy_outside: f64,
}

/// Cuts the echo of a metal plate out of a trace: takes off the free-space trace, finds the echo, and applies the gate.
///
/// # Errors
/// No echo that stands out.
pub fn plate_echo(
    trace: &AScan,
    free_space: Option<&AScan>,
    options: &PlateOptions,
) -> Result<PlateEcho, CompareError> {
    let mut steps = vec![];
    let ungated = match free_space {
        Some(reference) => {
            let (left, step) = subtract_reference(trace, reference);
            steps.push(step);
            left
        }
        None => trace.clone(),
    };
    let expected = ExpectedEchoes {
        plate: options.window,
        no_direct_wave: free_space.is_some(),
        // In a window the strongest peak counts: a plate's echo is no matter of noise.
        no_noise: options.window.is_some(),
        ..ExpectedEchoes::default()
    };
    let picks = pick_echoes(&ungated, &expected);
    // What is left of the direct wave may be picked as the surface; the plate's echo is the stronger of the two.
    let found = match (picks.surface, picks.plate) {
        (EchoPick::Picked(first), EchoPick::Picked(second))
            if options.window.is_none()
                && free_space.is_some()
                && first.envelope.amplitude > second.envelope.amplitude =>
        {
            EchoPick::Picked(first)
        }
        (EchoPick::Picked(first), EchoPick::NotPicked(_)) if options.window.is_none() && free_space.is_some() => {
            EchoPick::Picked(first)
        }
        (_, second) => second,
    };
    let echo = match found {
        EchoPick::Picked(echo) => echo,
        EchoPick::NotPicked(reason) => {
            return Err(CompareError::NoEvent {
                name: trace.name.clone(),
                event: Event::PlateEcho,
                purpose: "take the pulse from",
                reason,
            });
        }
    };
    let gate = &options.gate;
    let gated = gate.apply(&ungated, echo.envelope.time);
    let wider = Gate {
        before: Seconds(2.0 * gate.before.si() + gate.after.si()),
        after: Seconds(2.0 * gate.after.si() + gate.before.si()),
        ..*gate
    };
    let energy = |trace: &AScan| trace.samples.iter().map(|v| v * v).sum::<f64>();
    let (inside, around) = (energy(&gated), energy(&wider.apply(&ungated, echo.envelope.time)));
    steps.push(Step::Gated { around: echo.envelope.time, before: gate.before, after: gate.after, taper: gate.taper });
    Ok(PlateEcho { trace: gated, ungated, echo, steps, energy_outside: (1.0 - inside / around).max(0.0) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::steps::test_traces::{ricker, trace};

    /// Of two pulses the gate leaves the stronger, untouched where its weight is one, and says what it left out.
    #[test]
    fn the_gate_leaves_one_echo() {
        let both = trace("both", 2000, 1e-11, |t| 0.3 * ricker(t - 4e-9) - ricker(t - 10e-9));
        let options = PlateOptions { gate: Gate::of_frequency(1e9), window: None };
        let found = plate_echo(&both, Some(&trace("air", 2000, 1e-11, |_| 0.0)), &options).unwrap();
        assert!((found.echo.envelope.time.si() - 10e-9).abs() < 5e-12);
        for (t, v) in found.trace.times().zip(&found.trace.samples) {
            let from = t - 10e-9;
            if (-0.7e-9..1.1e-9).contains(&from) {
                assert!((v + ricker(from)).abs() < 1e-6, "{t}");
            } else if !(-1.6e-9..2.1e-9).contains(&from) {
                assert_eq!(*v, 0.0);
            }
        }
        assert!(found.energy_outside < 1e-5, "{}", found.energy_outside);
    }

    #[test]
    fn a_window_chooses_the_echo_and_nothing_is_refused() {
        let both = trace("both", 2000, 1e-11, |t| 0.3 * ricker(t - 4e-9) - ricker(t - 10e-9));
        let window = Some((Seconds(3e-9), Seconds(5e-9)));
        let found = plate_echo(&both, None, &PlateOptions { gate: Gate::of_frequency(1e9), window }).unwrap();
        assert!((found.echo.waveform.time.si() - 4e-9).abs() < 5e-12);
        let options = PlateOptions { gate: Gate::of_frequency(1e9), window: None };
        assert!(plate_echo(&trace("flat", 2000, 1e-11, |_| 0.0), None, &options).is_err());
    }
}
