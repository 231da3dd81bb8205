//! A painted model of either dimension, as the subcommands need it.

use ndarray::Array2;

use crate::cli::error::CliError;
use crate::model::{self, Effects, Model, Painted, Painted3, Resolution};
use crate::raster::{self, Placement};
use crate::scene::Scene;

/// The cells of a model.
pub enum Cells {
    /// Of a section.
    Plane(Painted),
    /// Of a model in space.
    Space(Box<Painted3>),
}

impl Cells {
    /// Paints a model.
    ///
    /// # Errors
    /// When it cannot be painted.
    pub fn of(model: &Model) -> Result<Self, CliError> {
        Ok(if model.is_plane() {
            Self::Plane(model::paint(model)?)
        } else {
            Self::Space(Box::new(model::paint3(model)?))
        })
    }

    /// What will be simulated, and why.
    pub fn effects(&self, model: &Model) -> Effects {
        match self {
            Self::Plane(painted) => Effects::of(model, painted),
            Self::Space(painted) => Effects::of_three(model, painted),
        }
    }

    /// How fine the cells are for the waves.
    pub fn resolution(&self, model: &Model) -> Option<Resolution> {
        match self {
            Self::Plane(painted) => Resolution::of(model, painted),
            Self::Space(painted) => Resolution::of_three(model, painted),
        }
    }

    /// Permittivity of the section, in space of the one below the antenna.
    pub fn map(&self, scene: &Scene, model: &Model) -> Array2<f64> {
        let frequency = scene.spec.antenna.frequency;
        match self {
            Self::Plane(painted) => raster::permittivity_map(model, painted, frequency),
            Self::Space(painted) => {
                let across = Placement::of(&scene.spec).source[2];
                raster::permittivity_section(model, painted, across, frequency)
            }
        }
    }
}
