//! Running a chain of steps over a section.

use super::error::ProcessError;
use super::flaws::{Flaw, flaws};
use super::lateral::mean_trace;
use super::parse::{Chain, Instruction, NormaliseBy, ZeroAt};
use super::section::Section as _;
use super::{filter, gain, lateral, running};
use crate::compare::error::{CompareError, check, rounded};
use crate::compare::picks::{Echo, EchoPick, Event, ExpectedEchoes, pick_echoes};
use crate::compare::resample::resample;
use crate::compare::{Step, steps};
use crate::trace::{AScan, BScan};
use crate::units::Seconds;
use crate::units::constants::C0;

/// Most samples of a resampled trace.
const MOST_SAMPLES: usize = 10_000_000;

/// A section after a chain, and what was done.
#[derive(Debug, Clone, PartialEq)]
pub struct Processed {
    /// What came out.
    pub section: BScan,
    /// What was done, in order.
    pub steps: Vec<Step>,
    /// What was wrong with what went in, and stays so.
    pub flaws: Vec<Flaw>,
}

/// Runs the steps of a chain, in order, over a section of one or many traces.
///
/// Echoes (for time zero and normalisation) are picked on the mean of all traces by
/// [`pick_echoes`](crate::compare::pick_echoes), so that one shift and one divisor hold for all of them.
///
/// ```
/// use ballast_gpr::compare::process::process;
/// use ballast_gpr::trace::{BScan, Component};
/// use ballast_gpr::units::Seconds;
/// let samples = (0..512).map(|k| 100.0 + (-(f64::from(k) - 200.0).powi(2) / 90.0).exp()).collect();
/// let line = BScan::new(samples, 512, Seconds(49e-12), Seconds(0.0), Component::Recorded, "line".into())?;
/// let done = process(&line, &"dc, normalise=max".parse()?)?;
/// assert_eq!(done.section.trace(0).map(|trace| trace.peak()), Some(1.0));
/// assert_eq!(done.steps.len(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A section of one sample, of zeros, without a time axis or with a sample that is no number; a step that cannot be done,
/// named with its number.
pub fn process(section: &BScan, chain: &Chain) -> Result<Processed, ProcessError> {
    check_section(section)?;
    let flaws = flaws(section);
    let (mut section, mut records) = (section.clone(), Vec::with_capacity(chain.steps.len()));
    for (index, (instruction, written)) in chain.steps.iter().enumerate() {
        let (new, step) = apply(&section, *instruction).map_err(|source| ProcessError::AtStep {
            number: index + 1,
            step: written.clone(),
            source: Box::new(source),
        })?;
        section = new;
        records.push(step);
    }
    Ok(Processed { section, steps: records, flaws })
}

/// Refuses what no step can work on; single traces may be zero.
fn check_section(section: &BScan) -> Result<(), ProcessError> {
    for number in 0..section.count() {
        let Some(trace) = section.trace(number) else { continue };
        let named = if section.count() == 1 { AScan { name: section.name.clone(), ..trace } } else { trace };
        match check(&named) {
            Err(CompareError::AllZero { .. }) => {}
            other => other?,
        }
    }
    if section.samples().iter().all(|v| *v == 0.0) {
        return Err(CompareError::AllZero { name: section.name.clone() }.into());
    }
    Ok(())
}

fn apply(section: &BScan, instruction: Instruction) -> Result<(BScan, Step), ProcessError> {
    Ok(match instruction {
        Instruction::TimeZero(at) => set_time_zero(section, at)?,
        Instruction::RemoveDc => steps::remove_dc(section),
        Instruction::Dewow(window, by) => running::dewow(section, window, by)?,
        Instruction::Filter(band, order) => filter::filter(section, band, order)?,
        Instruction::Background(window) => lateral::remove_background(section, window)?,
        Instruction::Stack(group, least) => lateral::stack(section, group, least)?,
        Instruction::GainByTime(rate, power) => gain::gain_by_time(section, rate, power)?,
        Instruction::GainByLevel(window) => gain::gain_by_level(section, window)?,
        Instruction::Envelope => gain::take_envelope(section),
        Instruction::Crop(from, to) => steps::crop(section, from, to)?,
        Instruction::Resample(time_step) => resample_section(section, time_step)?,
        Instruction::Normalise(by) => normalise(section, by)?,
        Instruction::Flip => steps::flip(section),
    })
}

fn echo(trace: &AScan, event: Event, purpose: &'static str) -> Result<Echo, ProcessError> {
    let picks = pick_echoes(trace, &ExpectedEchoes::default());
    match picks.of(event) {
        EchoPick::Picked(echo) => Ok(*echo),
        EchoPick::NotPicked(reason) => {
            Err(CompareError::NoEvent { name: trace.name.clone(), event, purpose, reason: *reason }.into())
        }
    }
}

fn set_time_zero(section: &BScan, at: ZeroAt) -> Result<(BScan, Step), ProcessError> {
    let mean = mean_trace(section);
    let zero = Seconds(0.0);
    let of = |event| echo(&mean, event, "set the time zero by").map(|echo| echo.waveform.time);
    let (time, becomes, by) = match at {
        ZeroAt::DirectWave => (of(Event::DirectWave)?, zero, Event::DirectWave.to_string()),
        ZeroAt::FirstPeak => (steps::first_peak(&mean)?, zero, "first peak".into()),
        ZeroAt::Surface => (of(Event::SurfaceEcho)?, zero, Event::SurfaceEcho.to_string()),
        ZeroAt::Time(time) => (time, zero, "time given".into()),
        ZeroAt::Plate(height) => {
            (of(Event::PlateEcho)?, Seconds(2.0 * height.si() / C0), format!("plate echo under {height} of air"))
        }
    };
    Ok(steps::set_time_zero(section, time, becomes, &by))
}

fn normalise(section: &BScan, by: NormaliseBy) -> Result<(BScan, Step), ProcessError> {
    let of = |event| echo(&mean_trace(section), event, "normalise by").map(|echo| echo.waveform.amplitude.abs());
    let (divisor, name) = match by {
        NormaliseBy::Maximum => (section.samples().iter().fold(0.0_f64, |m, v| m.max(v.abs())), "largest amplitude"),
        NormaliseBy::DirectWave => (of(Event::DirectWave)?, "direct wave"),
        NormaliseBy::Surface => (of(Event::SurfaceEcho)?, "surface echo"),
        NormaliseBy::Plate => (of(Event::PlateEcho)?, "plate echo"),
    };
    if divisor == 0.0 {
        return Err(CompareError::AllZero { name: section.name.clone() }.into());
    }
    Ok(steps::normalise(section, divisor, name))
}

fn resample_section(section: &BScan, time_step: Seconds) -> Result<(BScan, Step), ProcessError> {
    let span = (section.length() - 1) as f64 * section.time_step.si();
    let count = (span / time_step.si() + 1e-9).floor() + 1.0;
    if !(time_step.si() > 0.0 && (2.0..=MOST_SAMPLES as f64).contains(&count)) {
        return Err(ProcessError::TimeStep {
            name: section.name.clone(),
            step: time_step,
            duration: rounded(span),
            most: MOST_SAMPLES,
        });
    }
    let mut row = mean_trace(section);
    let new = section.rebuilt(section.first_sample, time_step, |trace| {
        row.samples = trace.to_vec();
        resample(&row, section.first_sample, time_step, count as usize).samples
    })?;
    Ok((new, Step::Resampled { from: section.time_step, to: time_step }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::steps::test_traces::{ricker, trace};
    use proptest::prelude::*;

    fn line(traces: usize) -> BScan {
        let one = |k: usize| {
            trace("line", 800, 2.5e-11, move |t| {
                3.0 + ricker(t - 2e-9) - 0.2 * ricker(t - 6e-9) + 0.01 * (k % 3) as f64 * ricker(t - 10e-9)
            })
        };
        BScan::of(&(0..traces).map(one).collect::<Vec<_>>(), "line".into()).unwrap()
    }

    fn message(section: &BScan, chain: &str) -> String {
        process(section, &chain.parse().unwrap()).unwrap_err().to_string()
    }

    #[test]
    fn a_chain_does_what_it_says_in_order() {
        let done =
            process(&line(6), &"dc, timezero=direct, bandpass=200MHz..3GHz, stack, crop=0ns..8ns".parse().unwrap());
        let done = done.unwrap();
        let said: Vec<String> = done.steps.iter().map(ToString::to_string).collect();
        assert_eq!(
            said,
            [
                "mean of 3.000e0 removed",
                "time zero at the direct wave (moved by -2 ns)",
                "band-pass 0.2 GHz to 3 GHz, Butterworth order 4 forwards and backwards",
                "6 traces stacked into 1, none dropped",
                "cropped to 0 ns to 8 ns",
            ]
        );
        let trace = done.section.trace(0).unwrap();
        assert_eq!((trace.samples.len(), done.section.count()), (321, 1));
        // The order matters: after the stack there is no background to take off.
        assert_eq!(
            message(&line(6), "stack, background"),
            "failed at step 2, `background`: `line` has 1 trace: background removal needs at least 2"
        );
    }

    #[test]
    fn hard_cases_are_refused_word_for_word() {
        let one =
            BScan::new(vec![1.0], 1, Seconds(1e-11), Seconds(0.0), crate::trace::Component::Recorded, "one".into());
        assert_eq!(message(&one.unwrap(), "dc"), "trace `one` has one sample: at least two are needed");
        let mut bad = line(3);
        bad.samples_mut()[805] = f64::NAN;
        assert!(message(&bad, "dc").starts_with("trace `line trace 1` holds NaN at sample 5 (0.125 ns)"));
        let mut silent = line(3);
        silent.samples_mut().fill(0.0);
        assert!(message(&silent, "dc").starts_with("trace `line` is zero everywhere"));
        assert_eq!(
            message(&line(1), "resample=-1ns"),
            "failed at step 1, `resample=-1ns`: a time step of -1 ns is out of range for `line` (19.975 ns): it should be above zero and make 2 to 10000000 samples"
        );
        assert!(
            message(&line(1), "resample=0.001ps").contains("is out of range")
                && message(&line(1), "resample=25ns").contains("is out")
        );
        assert!(message(&line(1), "crop=30ns..40ns").contains("holds 0 samples of `line`"));
    }

    #[test]
    fn a_silent_trace_among_others_is_worked_on_and_told() {
        let mut line = line(4);
        line.samples_mut()[..800].fill(0.0);
        let done = process(&line, &"dewow=4ns, agc=2ns, envelope".parse().unwrap()).unwrap();
        assert_eq!(done.flaws, [Flaw::NoSignal { name: "line".into(), traces: 1 }]);
        assert!(done.section.samples()[..800].iter().all(|v| *v == 0.0));
        assert!(done.section.samples().iter().all(|v| v.is_finite()));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        /// Whatever finite numbers a section holds, a chain gives an error or as many finite numbers as it says.
        #[test]
        fn any_section_gives_an_error_or_finite_numbers(
            samples in prop::collection::vec(prop_oneof![-1.0..1.0_f64, Just(0.0), Just(1e150), Just(-1e-150)], 4..240),
            traces in 1..4_usize,
            step in 1e-12..1e-9_f64,
            chain in prop::sample::select(vec![
                "dc, dewow=1ns", "dewow=2ns:median", "bandpass=100MHz..400MHz:2", "highpass=50MHz:1, lowpass=300MHz:3",
                "background", "background=2", "stack", "stack=2:-1", "sec=0.1:1", "agc=1ns", "envelope", "timezero=first",
                "normalise=max", "flip, crop=0ns..1ns", "resample=0.3ns",
            ]),
        ) {
            let length = samples.len() / traces;
            let cut = samples[..length * traces].to_vec();
            let section = BScan::new(cut, length, Seconds(step), Seconds(0.0), crate::trace::Component::Recorded, "any".into()).unwrap();
            if let Ok(done) = process(&section, &chain.parse().unwrap()) {
                prop_assert!(done.section.samples().iter().all(|v| v.is_finite()), "{chain}");
                prop_assert_eq!(done.steps.len(), chain.split(',').count());
            }
        }
    }
}
