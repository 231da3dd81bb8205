//! What a run keeps beside its traces.

use super::checkpoint::Checkpoints;
use crate::trace::FieldSnapshot;

/// What a run keeps beside its traces: nothing, unless somebody says what becomes of it.
#[derive(Clone, Copy, Default)]
pub struct Keeping<'a> {
    /// Its state, to go on from.
    pub checkpoints: Option<&'a Checkpoints<'a>>,
    /// The snapshots that the model asks for.
    pub snapshots: Option<&'a Snapshots<'a>>,
}

/// What becomes of the snapshots of a run.
#[derive(Clone, Copy)]
pub struct Snapshots<'a> {
    /// Takes one, with its place in the model's list, as soon as its step is reached; the run stops for it, and ends with
    /// what it says when it fails.
    pub take: &'a dyn Fn(usize, FieldSnapshot) -> Result<(), String>,
    /// Tells whether one of this place has been taken by the run whose checkpoint is gone on from.
    pub is_there: &'a dyn Fn(usize) -> bool,
}
