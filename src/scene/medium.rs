//! Materials of a scene: as the file says them, and as the mixing rules and the solver use them.

use crate::material::{Complex, DebyePole, Dielectric, DielectricError};
use crate::units::{Hertz, KilogramsPerCubicMetre, SiemensPerMetre};

/// A material in a scene file.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialSpec {
    /// Relative permittivity (far above the relaxations, where there are some).
    pub eps_r: f64,
    /// Conductivity.
    #[serde(default)]
    pub sigma: SiemensPerMetre,
    /// Density of the grains, for masses.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density: Option<KilogramsPerCubicMetre>,
    /// Where the values come from.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
    /// Whether the values are assumed rather than published for this scene.
    #[serde(default)]
    pub assumed: bool,
    /// Debye relaxations.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub poles: Vec<DebyePole>,
}

impl MaterialSpec {
    /// The dielectric, checked.
    ///
    /// # Errors
    /// When a value is one that no passive material has.
    pub fn dielectric(&self) -> Result<Dielectric, DielectricError> {
        Dielectric::new(self.eps_r, self.sigma, self.poles.clone())
    }
}

/// A named material of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Medium {
    /// Name, as it will stand in the gprMax input.
    pub name: String,
    /// Its dielectric behaviour.
    pub dielectric: Dielectric,
}

impl Medium {
    /// Free space.
    pub fn air() -> Self {
        Self { name: "free_space".into(), dielectric: Dielectric::lossless(1.0) }
    }

    /// Real part of the relative permittivity at a frequency.
    pub fn eps_r_at(&self, frequency: Hertz) -> f64 {
        self.eps_at(frequency).re
    }

    /// Complex relative permittivity at a frequency.
    pub fn eps_at(&self, frequency: Hertz) -> Complex {
        self.dielectric.permittivity(frequency)
    }

    /// Whether this is plain free space.
    pub fn is_air(&self) -> bool {
        self.name == "free_space"
    }
}
