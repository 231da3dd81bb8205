//! Materials by name, each with where its numbers come from and how sure they are.

use super::dielectric::{WATER, WATER_EPS_INFINITY};
use super::{DebyePole, Dielectric};
use crate::units::SiemensPerMetre;

/// How well a number is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Confidence {
    /// Read in the source named.
    ReadInSource,
    /// A standard literature value, not read in the source itself.
    Standard,
    /// Weak or not verified.
    Weak,
}

/// A material of the built-in table.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct NamedMaterial {
    /// Its name, lower case with hyphens.
    pub name: &'static str,
    /// Other names it is found by.
    pub also: &'static [&'static str],
    /// Relative permittivity; far above the relaxations where there are poles. One for a perfect conductor.
    pub eps_r: f64,
    /// The range of `eps_r` that the source gives, where it gives one; `eps_r` is its middle.
    pub range: Option<(f64, f64)>,
    /// Conductivity; the geometric middle where the source gives a range. Zero where it gives none.
    pub sigma: SiemensPerMetre,
    /// Debye relaxations.
    pub poles: &'static [DebyePole],
    /// Whether it is treated as a perfect electric conductor.
    pub perfect_conductor: bool,
    /// Where the numbers come from.
    pub source: &'static str,
    /// How sure they are.
    pub confidence: Confidence,
}

impl NamedMaterial {
    /// The material as a dielectric; none for a perfect conductor.
    pub fn dielectric(&self) -> Option<Dielectric> {
        (!self.perfect_conductor).then(|| Dielectric {
            eps_r: self.eps_r,
            sigma: self.sigma,
            poles: self.poles.to_vec(),
        })
    }
}

/// A name that is not in the table.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "unknown material `{name}`{}\n\nhint: known are {}; or give its values: `{{ eps_r = 6.5, sigma = \"1mS/m\" }}`",
    nearest.map(|n| format!("; did you mean `{n}`?")).unwrap_or_default(),
    all_named().map(|m| m.name).collect::<Vec<_>>().join(", ")
)]
pub struct UnknownMaterial {
    /// What was given.
    pub name: String,
    /// The nearest known name, if one is near.
    pub nearest: Option<&'static str>,
}

/// Finds a material by its name or one of its other names; case, spaces and underscores do not matter.
///
/// ```
/// use ballast_gpr::material::named;
/// assert_eq!(named("Limestone")?.eps_r, 6.5);
/// # Ok::<(), ballast_gpr::material::UnknownMaterial>(())
/// ```
///
/// # Errors
/// A name that is not known, with the nearest that is.
pub fn named(name: &str) -> Result<&'static NamedMaterial, UnknownMaterial> {
    let wanted = name.trim().to_ascii_lowercase().replace(['_', ' '], "-");
    TABLE.iter().find(|m| m.name == wanted || m.also.contains(&wanted.as_str())).ok_or_else(|| {
        let known = TABLE.iter().flat_map(|m| std::iter::once(m.name).chain(m.also.iter().copied()));
        UnknownMaterial { name: name.into(), nearest: crate::files::nearest_name(&wanted, known) }
    })
}

/// Every material of the table.
pub fn all_named() -> impl Iterator<Item = &'static NamedMaterial> {
    TABLE.iter()
}

use Confidence::{ReadInSource as A, Standard as B, Weak as C};

const fn row(
    name: &'static str,
    eps_r: f64,
    sigma: f64,
    confidence: Confidence,
    source: &'static str,
) -> NamedMaterial {
    NamedMaterial {
        name,
        also: &[],
        eps_r,
        range: None,
        sigma: SiemensPerMetre(sigma),
        poles: &[],
        perfect_conductor: false,
        source,
        confidence,
    }
}

const fn conductor(name: &'static str, also: &'static [&'static str]) -> NamedMaterial {
    NamedMaterial {
        also,
        perfect_conductor: true,
        ..row(name, 1.0, 0.0, B, "a metal reflects all at radar frequencies")
    }
}

const ANNAN: &str = "table of Annan and Daniels, 100 MHz";

static TABLE: &[NamedMaterial] = &[
    NamedMaterial { also: &["free-space", "vacuum"], ..row("air", 1.0, 0.0, A, "definition") },
    NamedMaterial {
        poles: &[WATER],
        ..row("water", WATER_EPS_INFINITY, 0.0, A, "gprMax materials.py, 20 °C: 80.1 at rest, 9.231 ps")
    },
    NamedMaterial {
        also: &["limestone-ballast"],
        ..row(
            "limestone",
            6.5,
            0.0,
            A,
            "Benedetto et al. 2017, Table 4: the ballast of the tank (after Fensler et al.)",
        )
    },
    NamedMaterial { range: Some((4.0, 6.0)), ..row("granite", 5.0, 1e-4, B, ANNAN) },
    NamedMaterial { range: Some((4.0, 8.0)), ..row("limestone-rock", 6.0, 1e-3, B, ANNAN) },
    NamedMaterial {
        range: Some((6.0, 9.0)),
        ..row("basalt", 7.5, 1e-3, C, "range of Campbell and Ulrichs 1969, 450 MHz")
    },
    NamedMaterial {
        also: &["a4-silt", "silty-fouling"],
        ..row("silt", 5.03, 0.0, A, "Benedetto et al. 2017, Table 4: the fouling soil of the tank, 2.5 % water by mass")
    },
    row("fouling-fines", 5.1, 0.0, A, "sand and gravel fines of the SBB ballast study at ETH, 1 GHz"),
    row("kaolinite-clay", 6.69, 1e-8, A, "Harajchi and Slob 2025: porosity 0.45, 5 % water, 1 GHz"),
    row("moist-sand", 4.54, 1e-6, A, "Harajchi and Slob 2025: porosity 0.375, 4.5 % water, 1 GHz"),
    NamedMaterial { range: Some((3.0, 5.0)), ..row("dry-sand", 4.0, 1e-5, B, ANNAN) },
    NamedMaterial { range: Some((20.0, 30.0)), ..row("saturated-sand", 25.0, 3e-4, B, ANNAN) },
    NamedMaterial {
        also: &["methacrylate-authors"],
        ..row(
            "methacrylate",
            4.0,
            0.0,
            A,
            "Benedetto et al. 2017: the value used for the tank; the plastic itself has 2.6",
        )
    },
    NamedMaterial {
        also: &["pmma", "acrylic", "plexiglas"],
        ..row("methacrylate-physical", 2.6, 8e-4, B, "tables after von Hippel: loss tangent 0.0057 at 1 GHz")
    },
    row("concrete", 8.0, 0.01, A, "sleepers of the SBB ballast study at ETH and of PINN4GPR, 1 GHz"),
    row("concrete-itu", 5.31, 0.0326, A, "ITU-R P.2040; conductivity at 1 GHz of 0.0326 f_GHz^0.8095"),
    row("wood", 2.0, 0.01, A, "sleepers of the SBB ballast study at ETH and of PINN4GPR, 1 GHz"),
    row("asphalt", 8.0, 0.01, A, "sub-ballast of the SBB ballast study at ETH and of PINN4GPR, 1 GHz"),
    NamedMaterial {
        also: &["pss", "gravel-sub-base"],
        ..row("sub-base", 5.0, 0.0, A, "gravel sub-base of the SBB ballast study at ETH, 1 GHz")
    },
    row("sub-ballast", 8.0, 0.001, A, "Li 2025, 2 GHz"),
    row("subgrade", 13.0, 0.01, A, "Li 2025, 2 GHz"),
    NamedMaterial { range: Some((20.5, 25.0)), ..row("wet-subgrade", 22.75, 0.0, A, "Mbubia 2026, Table 3, 1.4 GHz") },
    conductor("pec", &["perfect-conductor", "metal"]),
    conductor("steel", &["rail"]),
    conductor("copper", &["copper-plate"]),
];

#[cfg(test)]
mod tests {
    use super::*;

    /// The values named in Benedetto et al. 2017 and the physical one of the plastic.
    #[test]
    fn the_materials_of_the_tank() {
        for (name, eps_r) in [("limestone", 6.5), ("silt", 5.03), ("methacrylate", 4.0), ("PMMA", 2.6), ("air", 1.0)] {
            assert_eq!(named(name).unwrap().dielectric().unwrap().eps_r, eps_r, "{name}");
        }
        assert_eq!(named("steel").unwrap().dielectric(), None);
        assert_eq!(named("Free space").unwrap().name, "air");
    }

    #[test]
    fn every_name_is_unique_and_every_row_is_a_material_with_a_source() {
        let mut seen = std::collections::HashSet::new();
        for material in all_named() {
            assert!(!material.source.is_empty());
            for name in std::iter::once(&material.name).chain(material.also) {
                assert!(seen.insert(*name), "{name} is there twice");
                assert_eq!(named(name).unwrap(), material);
            }
            if let Some(dielectric) = material.dielectric() {
                Dielectric::new(dielectric.eps_r, dielectric.sigma, dielectric.poles).unwrap();
            }
            if let Some((low, high)) = material.range {
                assert!((material.eps_r - 0.5 * (low + high)).abs() < 1e-12, "{}", material.name);
            }
        }
    }

    #[test]
    fn an_unknown_name_is_answered_with_the_nearest() {
        let message = named("limstone").unwrap_err().to_string();
        assert!(
            message
                .starts_with("unknown material `limstone`; did you mean `limestone`?\n\nhint: known are air, water,"),
            "{message}"
        );
        assert!(message.ends_with("copper; or give its values: `{ eps_r = 6.5, sigma = \"1mS/m\" }`"), "{message}");
        assert_eq!(named("xyzzyxyzzy").unwrap_err().nearest, None);
    }
}
