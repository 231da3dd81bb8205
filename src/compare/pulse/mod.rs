//! The pulse that an antenna sends, from its echo on a metal plate.
//!
//! # Theory
//!
//! Plate and antenna are linear and do not change: a source that is driven by `x(t)` returns the echo `g * x`, with one
//! response `g` for one height, one geometry and one dimension. In two dimensions the source is a line, whose far field is
//! the half-derivative of its current and falls with the root of the distance; in space a dipole sends the derivative, which
//! falls with the distance, and nearer than a wavelength there is more. None of that need be written down: the echo `e` of a
//! known broad pulse `b`, simulated over the same plate at the same height, holds all of it, `e = g * b`. What is wanted is the
//! `x` with `g * x = m`, the measured echo.
//!
//! With capitals for the transforms `G = E/B`, so `X = M/G = B M/E`; where `E` is small that would blow up what is only noise.
//! The filter that turns `e` into `m` is therefore taken with the least energy ([`Filter::between`]):
//! `W = M E* / (|E|² + r² max|E|²)` minimises `||e * w - m||² + r² max|E|² ||w||²` (Tikhonov's regularisation, for white noise the
//! filter of Wiener with a noise `r` of the strongest component). Then `x = b * w`, cut to its length with soft ends
//! ([`Deconvolved`]).
//!
//! The simulated echo of `x` is the measured one; whether `x` is the antenna's own pulse and not that of one height only is
//! seen by what it predicts at another height.

mod deconvolve;
mod filter;
mod fit;
mod plate;

pub use deconvolve::{DeconvolutionOptions, Deconvolved, deconvolve};
pub use filter::Filter;
pub use fit::{AnalyticPulse, PulseFit, fit_pulse};
pub use plate::{Gate, PlateEcho, PlateOptions, plate_echo};
