//! gprMax's material database, schema version 1: a JSON file beside the geometry file.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::GeometryError;
use crate::files::read_text;
use crate::model::{DebyePole, Material};

const SCHEMA: &str = "gprMax-material-database";
const SCHEMA_VERSION: u64 = 1;

#[derive(Debug, Serialize, Deserialize)]
struct Document {
    schema: String,
    schema_version: u64,
    database: Map<String, Value>,
    materials: BTreeMap<String, Entry>,
}

#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(default)]
struct Entry {
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    model: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    base: Option<Base>,
    #[serde(skip_serializing_if = "Option::is_none")]
    builtin: Option<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    poles: Vec<Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    averagable: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    alias: Option<Value>,
    #[serde(skip_serializing_if = "Map::is_empty")]
    metadata: Map<String, Value>,
}

#[derive(Debug, Serialize, Deserialize)]
struct Base {
    relative_permittivity: f64,
    #[serde(default)]
    electric_conductivity_s_per_m: Loss,
    #[serde(default = "one")]
    relative_permeability: f64,
    #[serde(default)]
    magnetic_conductivity_s_per_m: Loss,
}

#[derive(Debug, Serialize, Deserialize)]
struct Pole {
    relative_permittivity_difference: f64,
    relaxation_time_s: f64,
}

/// A number, or the word `inf`, since JSON has no infinity.
#[derive(Debug, Serialize, Deserialize)]
#[serde(untagged)]
enum Loss {
    Number(f64),
    Word(String),
}

impl Default for Loss {
    fn default() -> Self {
        Self::Number(0.0)
    }
}

impl Loss {
    fn of(value: f64) -> Self {
        if value.is_infinite() { Self::Word("inf".into()) } else { Self::Number(value) }
    }

    /// The value; "not a number" for a word other than `inf`, which the range check then refuses.
    fn value(&self) -> f64 {
        match self {
            Self::Number(value) => *value,
            Self::Word(word) if word == "inf" => f64::INFINITY,
            Self::Word(_) => f64::NAN,
        }
    }
}

fn one() -> f64 {
    1.0
}

/// An open material database.
pub(in super::super) struct Database {
    path: PathBuf,
    materials: BTreeMap<String, Entry>,
}

impl Database {
    /// Reads a database.
    pub fn open(path: &Path) -> Result<Self, GeometryError> {
        let not = |reason: String| GeometryError::NotADatabase { path: path.into(), reason };
        let document: Document = serde_json::from_str(&read_text(path)?).map_err(|error| not(error.to_string()))?;
        if document.schema != SCHEMA || document.schema_version != SCHEMA_VERSION {
            let (schema, version) = (document.schema, document.schema_version);
            return Err(not(format!(
                "its schema is `{schema}` version {version}, not `{SCHEMA}` version {SCHEMA_VERSION}"
            )));
        }
        Ok(Self { path: path.into(), materials: document.materials })
    }

    /// The material of a key.
    pub fn material(&self, key: &str) -> Result<Material, GeometryError> {
        let path = || self.path.clone();
        let entry =
            self.materials.get(key).ok_or_else(|| GeometryError::NoMaterial { path: path(), key: key.into() })?;
        let kind = |kind: &str| GeometryError::Kind { path: path(), key: key.into(), kind: kind.into() };
        let not = |reason: String| GeometryError::NotADatabase { path: path(), reason };
        if entry.alias.is_some() {
            return Err(kind("an alias of another material"));
        }
        if entry.metadata.contains_key("directional_materials") {
            return Err(kind("anisotropic"));
        }
        let id = entry.metadata.get("original_id").and_then(Value::as_str).unwrap_or(key).to_owned();
        let model = entry.model.as_deref().unwrap_or("without a model");
        if model == "builtin" {
            return match entry.builtin.as_deref() {
                Some("pec") => Ok(Material { id, ..Material::pec() }),
                Some("free_space") => Ok(Material { id, ..Material::free_space() }),
                other => Err(kind(&format!("the builtin material `{}`", other.unwrap_or("without a name")))),
            };
        }
        if model != "constant" && model != "debye" {
            return Err(kind(&format!("of the model `{model}`")));
        }
        let base = entry.base.as_ref().ok_or_else(|| not(format!("material `{key}` has no `base`")))?;
        let poles: Vec<DebyePole> = entry
            .poles
            .iter()
            .map(|pole| serde_json::from_value::<Pole>(pole.clone()))
            .map(|pole| {
                pole.map(|p| DebyePole { delta_eps: p.relative_permittivity_difference, tau: p.relaxation_time_s })
            })
            .collect::<Result<_, _>>()
            .map_err(|error| not(format!("a pole of material `{key}`: {error}")))?;
        if (model == "debye") == poles.is_empty() {
            return Err(not(format!("material `{key}` of the model `{model}` has {} poles", poles.len())));
        }
        let (sigma, sigma_magnetic) =
            (base.electric_conductivity_s_per_m.value(), base.magnetic_conductivity_s_per_m.value());
        self.check(
            key,
            "the relative permittivity",
            base.relative_permittivity,
            base.relative_permittivity >= 1.0,
            "at least 1",
        )?;
        self.check(
            key,
            "the relative permeability",
            base.relative_permeability,
            base.relative_permeability >= 1.0,
            "at least 1",
        )?;
        self.check(key, "the conductivity", sigma, sigma >= 0.0, "0 or more, or \"inf\"")?;
        self.check(key, "the magnetic loss", sigma_magnetic, sigma_magnetic >= 0.0, "0 or more, or \"inf\"")?;
        for pole in &poles {
            self.check(
                key,
                "the change of permittivity of a pole",
                pole.delta_eps,
                pole.delta_eps >= 0.0,
                "0 or more",
            )?;
            self.check(key, "the relaxation time of a pole", pole.tau, pole.tau > 0.0, "above 0")?;
        }
        let averagable =
            entry.averagable.unwrap_or(true) && poles.is_empty() && sigma.is_finite() && sigma_magnetic.is_finite();
        let (eps_r, mu_r) = (base.relative_permittivity, base.relative_permeability);
        Ok(Material {
            id,
            eps_r,
            sigma,
            mu_r,
            sigma_magnetic,
            poles,
            resonances: vec![],
            averagable,
            directional: None,
        })
    }

    /// Whether a key names a perfect magnetic conductor.
    pub fn is_magnetic_conductor(&self, key: &str) -> bool {
        let base = self.materials.get(key).and_then(|entry| entry.base.as_ref());
        base.is_some_and(|base| base.magnetic_conductivity_s_per_m.value().is_infinite())
    }

    fn check(
        &self,
        key: &str,
        what: &'static str,
        value: f64,
        allowed: bool,
        limit: &'static str,
    ) -> Result<(), GeometryError> {
        if allowed && !value.is_nan() {
            return Ok(());
        }
        Err(GeometryError::Value { path: self.path.clone(), key: key.into(), what, value, limit })
    }
}

/// Lays a database out as JSON. `name` starts with a letter and holds letters, digits, `_` and `-`.
pub(in super::super) fn write_database(
    name: &str,
    materials: &[(String, &Material)],
) -> Result<String, serde_json::Error> {
    let entries = materials.iter().map(|(key, material)| (key.clone(), entry(material))).collect();
    let header = [
        ("id", name),
        ("name", name),
        ("version", "1.0.0"),
        ("description", concat!("written by ballast-gpr ", env!("CARGO_PKG_VERSION"))),
    ];
    let document = Document {
        schema: SCHEMA.into(),
        schema_version: SCHEMA_VERSION,
        database: header.into_iter().map(|(key, value)| (key.into(), value.into())).collect(),
        materials: entries,
    };
    serde_json::to_string_pretty(&document).map(|text| text + "\n")
}

fn entry(material: &Material) -> Entry {
    let metadata: Map<String, Value> = [("original_id".into(), material.id.clone().into())].into_iter().collect();
    let builtin = [Material::pec(), Material::free_space()].into_iter().find(|known| known == material);
    if let Some(known) = builtin {
        return Entry { model: Some("builtin".into()), builtin: Some(known.id), metadata, ..Entry::default() };
    }
    let poles = material
        .poles
        .iter()
        .map(|pole| {
            let fields = [
                ("relative_permittivity_difference".into(), pole.delta_eps.into()),
                ("relaxation_time_s".into(), pole.tau.into()),
            ];
            Value::Object(fields.into_iter().collect())
        })
        .collect::<Vec<_>>();
    Entry {
        name: Some(material.id.clone()),
        model: Some(if poles.is_empty() { "constant" } else { "debye" }.into()),
        base: Some(Base {
            relative_permittivity: material.eps_r,
            electric_conductivity_s_per_m: Loss::of(material.sigma),
            relative_permeability: material.mu_r,
            magnetic_conductivity_s_per_m: Loss::of(material.sigma_magnetic),
        }),
        poles,
        averagable: Some(material.averagable),
        metadata,
        ..Entry::default()
    }
}
