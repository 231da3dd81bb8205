//! Why a section cannot be processed so.

use crate::compare::CompareError;
use crate::trace::BScanError;
use crate::units::{Hertz, Seconds};

/// Why a section cannot be processed so.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ProcessError {
    /// A trace that no step can work on, or an echo that is not there.
    #[error(transparent)]
    Trace(#[from] CompareError),
    /// Traces that do not lie side by side.
    #[error(transparent)]
    Section(#[from] BScanError),
    /// A step of a chain that failed.
    #[error("failed at step {number}, `{step}`: {source}")]
    AtStep {
        /// Which step, from 1.
        number: usize,
        /// What it was to do.
        step: String,
        /// Why it did not.
        source: Box<Self>,
    },
    /// A running window with fewer than three samples.
    #[error(
        "a window of {window} holds {samples} of the samples of `{name}` ({time_step} apart): at least 3 are needed\n\nhint: a window of about the period of the lowest frequency of the pulse, for example 3ns for 500 MHz and above"
    )]
    WindowShort {
        /// Name of the section.
        name: String,
        /// The window.
        window: Seconds,
        /// Samples in it.
        samples: usize,
        /// Time between samples.
        time_step: Seconds,
    },
    /// A running window longer than the trace.
    #[error(
        "a window of {window} is longer than the traces of `{name}`, {duration}\n\nhint: a window of about the period of the lowest frequency of the pulse, for example 3ns for 500 MHz and above"
    )]
    WindowLong {
        /// Name of the section.
        name: String,
        /// The window.
        window: Seconds,
        /// How long a trace is.
        duration: Seconds,
    },
    /// A corner that the sampling cannot hold.
    #[error(
        "the corner at {corner} is not below half the sampling rate of `{name}`, {nyquist}\n\nhint: lower the corner, or leave it out with `highpass=FROM`"
    )]
    AboveNyquist {
        /// Name of the section.
        name: String,
        /// The corner.
        corner: Hertz,
        /// Half the sampling rate.
        nyquist: Hertz,
    },
    /// A corner of zero, below, or no number.
    #[error("a corner at {corner} is out of range: it should be above zero\n\nhint: `lowpass=TO` has no lower corner")]
    Corner {
        /// The corner.
        corner: Hertz,
    },
    /// A band that ends before it begins.
    #[error(
        "the band {from} to {to} is empty\n\nhint: write the lower corner first, for example `bandpass=300MHz..1.5GHz`"
    )]
    Band {
        /// Lower corner.
        from: Hertz,
        /// Upper corner.
        to: Hertz,
    },
    /// An order that makes no sound filter.
    #[error("a Butterworth filter of order {order} is out of range: 1 to {most}")]
    Order {
        /// The order.
        order: usize,
        /// The highest that is taken.
        most: usize,
    },
    /// A trace too short for a filter to start and end in.
    #[error(
        "the traces of `{name}` have {samples} samples: this filter needs more than {needed}\n\nhint: a lower order, for example `bandpass=300MHz..1.5GHz:2`"
    )]
    FilterLong {
        /// Name of the section.
        name: String,
        /// Samples of each trace.
        samples: usize,
        /// Samples that it needs at least.
        needed: usize,
    },
    /// Fewer traces than a step needs.
    #[error("`{name}` has {traces} {}: {purpose} needs at least {needed}", if *traces == 1 { "trace" } else { "traces" })]
    Traces {
        /// Name of the section.
        name: String,
        /// Traces there are.
        traces: usize,
        /// What needs more.
        purpose: &'static str,
        /// How many it needs.
        needed: usize,
    },
    /// Traces that do not resemble one another.
    #[error(
        "only {kept} of the {traces} traces from trace {first} of `{name}` correlate with their median trace by {least} or more: they are no repetitions of one another\n\nhint: stack fewer at a time (`stack=10`), allow more (`stack=all:0.5`), or take the background off instead"
    )]
    NoRepetitions {
        /// Name of the section.
        name: String,
        /// First trace of the group, from 0.
        first: usize,
        /// Traces in the group.
        traces: usize,
        /// Traces that correlate well enough.
        kept: usize,
        /// The least correlation that is kept.
        least: f64,
    },
    /// A correlation that is none.
    #[error("a least correlation of {least} is out of range: -1 to 1")]
    Correlation {
        /// What was asked for.
        least: f64,
    },
    /// A gain that leaves the range of numbers.
    #[error(
        "a gain of exp({rate} t/ns) (t/ns)^{power} grows past {most:e} within the {duration} of `{name}`\n\nhint: 0.1 to 0.5 per ns is usual at 1 GHz"
    )]
    Gain {
        /// Name of the section.
        name: String,
        /// Rate, 1/ns.
        rate: f64,
        /// Power.
        power: f64,
        /// The largest gain that is taken.
        most: f64,
        /// How long a trace is.
        duration: Seconds,
    },
    /// A time step that makes no or too many samples.
    #[error(
        "a time step of {step} is out of range for `{name}` ({duration}): it should be above zero and make 2 to {most} samples"
    )]
    TimeStep {
        /// Name of the section.
        name: String,
        /// The step asked for.
        step: Seconds,
        /// How long a trace is.
        duration: Seconds,
        /// The most samples that are made.
        most: usize,
    },
}
