//! The bed's media and its bulk permittivities.

use super::medium::Medium;

/// What lies where in the bed.
#[derive(Debug, Clone, PartialEq)]
pub struct Bed {
    /// Height of the fouled zone, m; zero when clean.
    pub fouled_height: f64,
    /// Stones above the fouled zone.
    pub stone_clean: Medium,
    /// Stones in the fouled zone. Differs from `stone_clean` only with the 2-D equivalent permittivity.
    pub stone_fouled: Medium,
    /// Voids above the fouled zone.
    pub void_clean: Medium,
    /// Voids in the fouled zone.
    pub void_fouled: Medium,
    /// The clean mixture as one material, by the scene's mixing rule.
    pub bulk_clean: Medium,
    /// The fouled mixture as one material.
    pub bulk_fouled: Medium,
}

/// The bulk permittivity of one zone of the bed, as a mixture in 3-D and as a 2-D section behaves.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct BulkPermittivity {
    /// `clean` or `fouled`.
    pub zone: &'static str,
    /// Solid share that the figures are for.
    pub solid_share: f64,
    /// By the scene's mixing rule, with the true stone: what a 3-D bed is taken to be.
    pub mixture: f64,
    /// The arithmetic mean with the true stone: what a 2-D bed of circles with Ez along them tends to.
    pub two_dimensional: f64,
    /// Permittivity of the stones in the model.
    pub stone_in_model: f64,
    /// The arithmetic mean with the stones of the model, times the measured excess over it.
    pub two_dimensional_in_model: f64,
}
