//! What the field does to traces before anything is read off them: filters, gains, background, stacking.
//!
//! Every step is a plain function on an [`AScan`](crate::trace::AScan) or a [`BScan`](crate::trace::BScan) (a [`Section`]),
//! gives a new one with the [`Step`](super::Step) for the report, and refuses what cannot be in words. A [`Chain`] is a list
//! of them as a user writes it, `dewow=3ns, bandpass=300MHz..1.5GHz, background`; [`process`] runs it. [`flaws`] tells what
//! an instrument may have done to a trace that no step undoes. Filters, running means and medians, gains, envelopes and
//! spectra equal those of SciPy on the same samples (`tests/process_scipy.rs`).

mod chain;
mod error;
mod filter;
mod flaws;
mod gain;
mod lateral;
mod parse;
mod running;
mod section;
mod short_time;

pub use chain::{Processed, process};
pub use error::ProcessError;
pub use filter::{Band, filter};
pub use flaws::{Flaw, flaws, flaws_of};
pub use gain::{gain_by_level, gain_by_time, take_envelope};
pub use lateral::{mean_trace, median_trace, remove_background, stack};
pub use parse::{Chain, Instruction, NormaliseBy, ParseError, STEPS, ZeroAt};
pub use running::{Running, dewow};
pub use section::Section;
pub use short_time::{ShortTimeSpectrum, short_time_spectrum};
