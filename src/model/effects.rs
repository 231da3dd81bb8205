//! Which physical effects a model calls for, read off the model and never off a flag.

use super::{Model, Painted};

/// One effect: on or off, and why.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Effect {
    /// The field's word for it.
    pub name: &'static str,
    /// Whether the model calls for it.
    pub on: bool,
    /// What in the model calls for it, or what is missing.
    pub reason: String,
    /// Memory it adds, bytes (single precision).
    pub bytes: u64,
}

/// The effects of a model.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Effects {
    /// Each effect the embedded solver knows, on or off.
    pub list: Vec<Effect>,
}

impl Effects {
    /// Reads the effects off a model.
    pub fn of(_model: &Model, _painted: &Painted) -> Self {
        Self { list: vec![] }
    }
}
