//! Why two traces cannot be compared.

use super::picks::{Event, NoEcho};
use crate::trace::{AScan, BScanError, Component};
use crate::units::Seconds;

/// Why two traces cannot be compared.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CompareError {
    /// A trace without samples.
    #[error("trace `{name}` has no samples")]
    Empty {
        /// Name of the trace.
        name: String,
    },
    /// A trace of one sample.
    #[error("trace `{name}` has one sample: at least two are needed")]
    OneSample {
        /// Name of the trace.
        name: String,
    },
    /// A trace of zeros (or, after the mean is taken off, of one constant).
    #[error(
        "trace `{name}` is zero everywhere: there is nothing to compare\n\nhint: is it the field component that the source excites?"
    )]
    AllZero {
        /// Name of the trace.
        name: String,
    },
    /// A sample that is no number.
    #[error(
        "trace `{name}` holds {value} at sample {index} ({time})\n\nhint: a solver that has diverged writes such values"
    )]
    NotFinite {
        /// Name of the trace.
        name: String,
        /// First such sample, counted from 0.
        index: usize,
        /// Its time.
        time: Seconds,
        /// What it holds.
        value: f64,
    },
    /// A time axis that is none.
    #[error("trace `{name}` has the time step {time_step} from {first}: the step should be above zero and both finite")]
    TimeAxis {
        /// Name of the trace.
        name: String,
        /// Its time step.
        time_step: Seconds,
        /// Time of its first sample.
        first: Seconds,
    },
    /// Steps so different that one of them is in another unit.
    #[error(
        "the time steps of `{a}` ({step_a}) and `{b}` ({step_b}) differ by a factor of {factor:.0}, more than {limit:.0}\n\nhint: is one of the time columns in seconds and the other in nanoseconds?"
    )]
    TimeStepsApart {
        /// Name of the first trace.
        a: String,
        /// Its time step.
        step_a: Seconds,
        /// Name of the second trace.
        b: String,
        /// Its time step.
        step_b: Seconds,
        /// The larger over the smaller.
        factor: f64,
        /// The largest that is taken.
        limit: f64,
    },
    /// A common step that makes no or too many samples.
    #[error("a common time step of {step} is out of range: it should be above zero and make at most {most} samples")]
    CommonStep {
        /// The step asked for.
        step: Seconds,
        /// The most samples that are made.
        most: usize,
    },
    /// No time, or too little, that both traces cover.
    #[error(
        "`{a}` ({from_a} to {to_a}) and `{b}` ({from_b} to {to_b}) share {shared} samples: at least {least} are needed\n\nhint: set the time zero of both, for example by the direct wave"
    )]
    NoOverlap {
        /// Name of the first trace.
        a: String,
        /// Its first time.
        from_a: Seconds,
        /// Its last time.
        to_a: Seconds,
        /// Name of the second trace.
        b: String,
        /// Its first time.
        from_b: Seconds,
        /// Its last time.
        to_b: Seconds,
        /// Samples in common.
        shared: usize,
        /// Samples needed.
        least: usize,
    },
    /// A window without samples.
    #[error(
        "the window {from} to {to} holds {samples} samples of `{name}` ({first} to {last}): at least {least} are needed"
    )]
    Window {
        /// Name of the trace.
        name: String,
        /// Start of the window.
        from: Seconds,
        /// End of the window.
        to: Seconds,
        /// Samples inside.
        samples: usize,
        /// First time of the trace.
        first: Seconds,
        /// Last time of the trace.
        last: Seconds,
        /// Samples needed.
        least: usize,
    },
    /// A step that needs an echo which was not found.
    #[error("`{name}` has no {event} to {purpose}: {reason}\n\nhint: give its time, or choose another rule")]
    NoEvent {
        /// Name of the trace.
        name: String,
        /// The echo needed.
        event: Event,
        /// What for: `set the time zero by`, `normalise by`.
        purpose: &'static str,
        /// Why it was not found.
        reason: NoEcho,
    },
    /// Two traces that should be sample by sample and are not.
    #[error(
        "`{a}` ({samples_a} samples of {step_a}) and `{b}` ({samples_b} samples of {step_b}) are not on the same time axis\n\nhint: resample one onto the other first"
    )]
    DifferentAxes {
        /// Name of the first trace.
        a: String,
        /// Its samples.
        samples_a: usize,
        /// Its time step.
        step_a: Seconds,
        /// Name of the second trace.
        b: String,
        /// Its samples.
        samples_b: usize,
        /// Its time step.
        step_b: Seconds,
    },
    /// A plate to normalise by that neither trace has.
    #[error(
        "neither `{a}` nor `{b}` has a measurement of a plate to normalise by\n\nhint: name one with `--plate FILE`"
    )]
    NoPlate {
        /// Name of the first trace.
        a: String,
        /// Name of the second trace.
        b: String,
    },
    /// Radargrams of other shapes, or too small ones.
    #[error(
        "`{a}` ({traces_a} traces of {samples_a} samples) and `{b}` ({traces_b} of {samples_b}) have no structural similarity: both need the same shape and at least {least} of each"
    )]
    Shapes {
        /// Name of the first radargram.
        a: String,
        /// Its traces.
        traces_a: usize,
        /// Its samples.
        samples_a: usize,
        /// Name of the second radargram.
        b: String,
        /// Its traces.
        traces_b: usize,
        /// Its samples.
        samples_b: usize,
        /// Fewest traces and samples.
        least: usize,
    },
    /// Too few simulations for a band.
    #[error("{members} simulations make no ensemble: at least 2 are needed")]
    FewMembers {
        /// How many there are.
        members: usize,
    },
    /// Simulations without a time that all of them cover.
    #[error(
        "the {members} simulations cover no time in common\n\nhint: give a part that all cover, for example `--window 2ns..15ns`"
    )]
    NoCommonTime {
        /// How many there are.
        members: usize,
    },
    /// Traces that do not lie side by side.
    #[error(transparent)]
    Section(#[from] BScanError),
    /// Two runs that do not have the same receivers, or none.
    #[error("{a} receivers cannot be compared with {b}")]
    Receivers {
        /// Receivers of the first run.
        a: usize,
        /// Receivers of the second.
        b: usize,
    },
    /// A receiver without one of the six components.
    #[error("receiver `{receiver}` has no {}", component.name())]
    NoComponent {
        /// Its name.
        receiver: String,
        /// The component.
        component: Component,
    },
}

/// Refuses what no step can work on.
pub(super) fn check(trace: &AScan) -> Result<(), CompareError> {
    let name = || trace.name.clone();
    match trace.samples.len() {
        0 => return Err(CompareError::Empty { name: name() }),
        1 => return Err(CompareError::OneSample { name: name() }),
        _ => {}
    }
    let (time_step, first) = (trace.time_step, trace.first_sample);
    if !(time_step.si() > 0.0 && time_step.si().is_finite() && first.si().is_finite()) {
        return Err(CompareError::TimeAxis { name: name(), time_step, first });
    }
    if let Some(index) = trace.samples.iter().position(|v| !v.is_finite()) {
        let time = rounded(trace.time(index));
        return Err(CompareError::NotFinite { name: name(), index, time, value: trace.samples[index] });
    }
    if trace.peak() == 0.0 { Err(CompareError::AllZero { name: name() }) } else { Ok(()) }
}

/// A time to print: to a tenth of a picosecond, so that 0.1 + 0.2 does not show its last bits.
pub(super) fn rounded(time: f64) -> Seconds {
    let tenths = (time * 1e13).round();
    if tenths.abs() < 1e15 { Seconds(tenths / 1e13 + 0.0) } else { Seconds(time) }
}
