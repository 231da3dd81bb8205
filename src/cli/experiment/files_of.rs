//! The files of an experiment.

use std::path::Path;

use crate::cli::error::CliError;
use crate::cli::experiment::Specified;
use crate::cli::experiment::figures;
use crate::cli::folder;
use crate::files;
use crate::study::experiments::Outcome;

/// Name of the file that says what the experiment was.
const SPEC: &str = "experiment.toml";
/// Name of the file with readings, curve and stones.
const OUTCOME: &str = "outcome.json";

/// What made the files of a folder, written last.
#[derive(serde::Serialize)]
struct Manifest<'a> {
    format_version: u32,
    program: String,
    experiment: &'a str,
    /// The specification, with the seed that was used.
    spec: &'a Specified,
    readings: &'a [crate::study::experiments::Reading],
    notes: &'a [String],
    /// Wall time, since it was last begun, s.
    seconds: f64,
}

/// Writes all files of an experiment.
///
/// # Errors
/// When one cannot be written.
pub fn write(out: &Path, spec: &Specified, text: &str, outcome: &Outcome, seconds: f64) -> Result<(), CliError> {
    let write = |name: &str, text: &str| files::write_bytes(&out.join(name), text.as_bytes());
    write(SPEC, text)?;
    write("curve.csv", &outcome.curve.csv())?;
    write(OUTCOME, &(serde_json::to_string(outcome)? + "\n"))?;
    if !outcome.stones.is_empty() {
        let mut stones = String::from("x_m,y_m,z_m,radius_m\n");
        for stone in &outcome.stones {
            let [x, y, z] = stone.centre;
            stones.push_str(&format!("{x},{y},{z},{}\n", stone.radius));
        }
        write("stones.csv", &stones)?;
    }
    figures::write(out, spec, outcome)?;
    let manifest = Manifest {
        format_version: 1,
        program: folder::program(),
        experiment: &outcome.experiment,
        spec,
        readings: &outcome.readings,
        notes: &outcome.notes,
        seconds,
    };
    Ok(write(folder::MANIFEST, &(serde_json::to_string_pretty(&manifest)? + "\n"))?)
}

/// The outcome of an experiment that is done already, if the folder holds one of the same specification.
pub fn finished(out: &Path, spec: &Specified) -> Option<Outcome> {
    let manifest = std::fs::read_to_string(out.join(folder::MANIFEST)).ok()?;
    let manifest: serde_json::Value = serde_json::from_str(&manifest).ok()?;
    if *manifest.get("spec")? != serde_json::to_value(spec).ok()? {
        return None;
    }
    serde_json::from_str(&std::fs::read_to_string(out.join(OUTCOME)).ok()?).ok()
}
