//! The trait that every electromagnetic solver fulfils: a model in, traces out.

use std::ops::ControlFlow;

use crate::model::Model;
use crate::trace::Traces;

/// How far a run has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Steps done.
    pub done: usize,
    /// Steps in all.
    pub total: usize,
}

/// Called now and then during a run; `Break` asks the solver to stop.
pub type OnProgress<'a> = &'a (dyn Fn(Progress) -> ControlFlow<()> + Sync);

/// A solver of Maxwell's equations.
pub trait Forward {
    /// `fdtd` or `gprmax`.
    fn name(&self) -> &'static str;

    /// Runs a model.
    ///
    /// # Errors
    /// See [`ForwardError`].
    fn solve(&self, model: &Model, on_progress: OnProgress<'_>) -> Result<Traces, ForwardError>;
}

/// Why a run gave no traces.
#[derive(Debug, thiserror::Error)]
pub enum ForwardError {
    /// The model asks for something the solver cannot do, or something impossible.
    #[error(transparent)]
    Model(Box<dyn std::error::Error + Send + Sync>),
    /// The solver itself failed.
    #[error(transparent)]
    Solver(Box<dyn std::error::Error + Send + Sync>),
    /// The caller asked to stop.
    #[error("stopped on request")]
    Stopped,
}
