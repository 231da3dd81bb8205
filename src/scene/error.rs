//! What can be wrong with a scene.

use std::path::{Path, PathBuf};

use crate::files::{self, FileError};
use crate::material::{DielectricError, Equivalent2dError, FitError, FoulingError, MixError, UnknownMaterial};
use crate::packing::PackingError;
use crate::units::{Metres, Share};

/// What can be wrong with a scene.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// No built-in scene of that name.
    #[error("there is no preset `{name}`\n\nhint: the presets are: {known}")]
    UnknownPreset {
        /// What the user wrote.
        name: String,
        /// Names of the presets.
        known: String,
    },
    /// The TOML cannot be read.
    #[error("the scene `{}` cannot be read\n{message}{hint}", file.display())]
    Toml {
        /// The file.
        file: PathBuf,
        /// What the TOML reader said, with the line.
        message: String,
        /// A hint with its blank line in front, or nothing.
        hint: String,
    },
    /// A scene of another version.
    #[error("the scene `{}` has format {found}, this version reads format {known}", file.display())]
    Format {
        /// The file.
        file: PathBuf,
        /// Its format.
        found: u32,
        /// The format that is known.
        known: u32,
    },
    /// A file of a pulse that is none.
    #[error(
        "the pulse `{}` line {line}: {what}\n\nhint: `ballast-gpr pulse from-plate PLATE --height 40cm --out pulse.txt` writes one", file.display()
    )]
    Pulse {
        /// The file.
        file: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// What is wrong there.
        what: String,
    },
    /// The scene cannot be written as TOML.
    #[error("the scene cannot be written as TOML: {0}")]
    Serialise(String),
    /// A quantity out of its range.
    #[error("`{key}` is {value}, but must be {limit}\n\nhint: {hint}")]
    OutOfRange {
        /// Key in the scene file.
        key: &'static str,
        /// What the user wrote.
        value: String,
        /// The range.
        limit: String,
        /// Something to type.
        hint: String,
    },
    /// A fouling amount that cannot be read.
    #[error(
        "`{text}` is not an amount of fouling\n\nhint: write a height (`20cm`), `40% of voids`, `16% by volume` or `14% by mass`"
    )]
    FoulingText {
        /// What the user wrote.
        text: String,
    },
    /// Water for fines that are not there.
    #[error(
        "`moisture.fines` is {moisture}, but this bed has no fines\n\nhint: add some with `--fouling 20cm`; water between clean stones is `voids = \"5%\"` under `[moisture]`"
    )]
    NoFines {
        /// What the user wrote.
        moisture: Share,
    },
    /// A packing of another width than the tank.
    #[error("the packing `{}` is {packing} wide, the tank {tank}\n\nhint: write `width = \"{packing}\"` under `[tank]`", file.display())]
    PackingWidth {
        /// The file.
        file: PathBuf,
        /// Width of the packing.
        packing: Metres,
        /// Width of the tank.
        tank: Metres,
    },
    /// A bed of spheres in another box than the tank.
    #[error(
        "the bed is {length} long and {width} deep, the tank {} and {}\n\nhint: write `width = \"{length}\"` and `depth = \"{width}\"` under `[tank]`",
        tank[0], tank[1]
    )]
    BedSize {
        /// Length of the bed.
        length: Metres,
        /// Width of the bed.
        width: Metres,
        /// Width and depth of the tank.
        tank: [Metres; 2],
    },
    /// A bed without walls in a tank with them.
    #[error("the bed repeats itself, and the tank has walls\n\nhint: pack it without `--periodic`")]
    PeriodicBed,
    /// A bed that nobody has settled yet.
    #[error(
        "the bed of this scene has to settle first (`method = \"dem\"`), which takes its time\n\nhint: `ballast-gpr build --packing dem --out FOLDER` settles and keeps it, then use FOLDER"
    )]
    NotSettled,
    /// Discs where spheres are needed.
    #[error(
        "the packing `{method}` is one of discs, and space has three dimensions\n\nhint: `--dimension 2`, or spheres: `--method dem` or `--method random-addition`"
    )]
    DiscsInSpace {
        /// The method.
        method: &'static str,
    },
    /// `method = "file"` without a file.
    #[error(
        "`packing.method` is \"file\", but `packing.file` names no file\n\nhint: add `file = \"packing.csv\"` under `[packing]`"
    )]
    NoPackingFile,
    /// The packing failed.
    #[error(transparent)]
    Packing(#[from] PackingError),
    /// A material that is not known.
    #[error(transparent)]
    UnknownMaterial(#[from] UnknownMaterial),
    /// A material with impossible values.
    #[error("the material `{name}`: {source}")]
    Dielectric {
        /// Name of the material.
        name: String,
        /// What is wrong.
        source: DielectricError,
    },
    /// A perfect conductor where a dielectric is needed.
    #[error("the material `{name}` is a perfect conductor and cannot be part of the bed or the walls")]
    Conductor {
        /// Name of the material.
        name: String,
    },
    /// A mixture that cannot be.
    #[error(transparent)]
    Mix(#[from] MixError),
    /// A mixture that one relaxation cannot follow.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// No equivalent stone.
    #[error(transparent)]
    Equivalent2d(#[from] Equivalent2dError),
    /// Fouling that does not fit.
    #[error(transparent)]
    Fouling(#[from] FoulingError),
    /// A file could not be read.
    #[error(transparent)]
    File(#[from] FileError),
}

impl SceneError {
    /// Turns an error of the TOML reader into one with the nearest known key.
    pub(super) fn toml(file: &Path, text: &str, error: &toml::de::Error) -> Self {
        let mut message = String::new();
        if let Some(span) = error.span() {
            let start = span.start.min(text.len());
            let line = text[..start].matches('\n').count() + 1;
            let content = text.lines().nth(line - 1).unwrap_or("").trim_end();
            message.push_str(&format!("  line {line}: {content}\n"));
        }
        let (said, own_hint) = error.message().split_once("\n\nhint: ").unwrap_or((error.message(), ""));
        let hint = unknown_field(said)
            .and_then(|(typed, known)| files::nearest_name(typed, known.iter().copied()).map(|name| (typed, name)))
            .map(|(typed, name)| format!("did you mean `{name}` in place of `{typed}`?"))
            .or_else(|| (!own_hint.is_empty()).then(|| own_hint.to_string()))
            .map_or(String::new(), |hint| format!("\n\nhint: {hint}"));
        message.push_str(&format!("  {}", said.trim_end().replace('\n', "\n  ")));
        Self::Toml { file: file.into(), message, hint }
    }
}

/// Takes serde's "unknown field `a`, expected one of `b`, `c`" apart.
fn unknown_field(message: &str) -> Option<(&str, Vec<&str>)> {
    let start = message.find("unknown field `").or_else(|| message.find("unknown variant `"))?;
    let mut quoted = message[start..].split('`').skip(1).step_by(2);
    let typed = quoted.next()?;
    Some((typed, quoted.collect()))
}
