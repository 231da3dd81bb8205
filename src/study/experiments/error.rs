//! What keeps an experiment from its end.

use std::path::PathBuf;

use crate::files::FileError;
use crate::geometry::triangle_mesh::MeshError;
use crate::packing::dem::DemError;

/// Why an experiment could not be run.
#[derive(Debug, thiserror::Error)]
pub enum ExperimentError {
    /// The TOML cannot be read.
    #[error("the experiment `{}` cannot be read\n{message}{hint}", file.display())]
    Toml {
        /// The file.
        file: PathBuf,
        /// What the reader said, with the line.
        message: String,
        /// A hint with its blank line in front, or nothing.
        hint: String,
    },
    /// A value out of its range.
    #[error(
        "`{key}` is {value}, but must be {limit}\n\nhint: `ballast-gpr experiment {experiment} --print-template` has values that work"
    )]
    OutOfRange {
        /// Name of the experiment.
        experiment: &'static str,
        /// Key in the file.
        key: &'static str,
        /// Its value.
        value: String,
        /// What it must be.
        limit: String,
    },
    /// A container in which not one stone has room.
    #[error(
        "the {what} is {width} wide, and the largest stone {diameter}\n\nhint: make it wider, or take smaller stones"
    )]
    NarrowerThanAStone {
        /// `box`, `opening of the hopper`, …
        what: &'static str,
        /// Its width.
        width: crate::units::Metres,
        /// Diameter of the largest stone.
        diameter: crate::units::Metres,
    },
    /// Spheres that cannot be simulated, or a run that was stopped as it went bad.
    #[error(transparent)]
    Dem(DemError),
    /// A wall that is none.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A file that could not be written or read.
    #[error("failed to {0}")]
    File(#[from] FileError),
    /// A save file of another experiment.
    #[error("`{}` cannot be gone on from: {what}\n\nhint: begin anew with `--fresh`", file.display())]
    OtherSave {
        /// The file.
        file: PathBuf,
        /// How this shows.
        what: String,
    },
    /// A folder in which another run keeps its state.
    #[error("another run keeps its state in `{}`\n\nhint: wait for its end, or choose another folder with `--out`", folder.display())]
    InUse {
        /// The folder.
        folder: PathBuf,
    },
    /// Stopped on request, with what has been reached kept.
    #[error("stopped on request after {seconds:.4} s of `{stage}`{kept}")]
    Stopped {
        /// Time reached, s.
        seconds: f64,
        /// What was going on.
        stage: &'static str,
        /// Where the state is kept, as the end of the sentence.
        kept: String,
    },
    /// A stage that takes longer than it may.
    #[error("`{stage}` has not come to an end within {limit} s: {what}\n\nhint: {hint}")]
    NeverEnds {
        /// What was going on.
        stage: &'static str,
        /// Time it had, s.
        limit: f64,
        /// How far it came.
        what: String,
        /// What to try.
        hint: &'static str,
    },
}

impl From<DemError> for ExperimentError {
    fn from(error: DemError) -> Self {
        Self::Dem(error)
    }
}

impl ExperimentError {
    /// Makes the error of a TOML text that cannot be read.
    pub(super) fn toml(file: &std::path::Path, text: &str, error: &toml::de::Error) -> Self {
        let mut message = String::new();
        if let Some(span) = error.span() {
            let line = text[..span.start.min(text.len())].matches('\n').count();
            let shown = text.lines().nth(line).unwrap_or("");
            message = format!("  line {}: {}\n", line + 1, shown.trim());
        }
        let said = error.message();
        message.push_str(&format!("  {}", said.trim_end().replace('\n', "\n  ")));
        let mut quoted = said.split('`').skip(1).step_by(2);
        let near = (said.starts_with("unknown field") || said.starts_with("unknown variant"))
            .then(|| quoted.next())
            .flatten()
            .and_then(|typed| Some((typed, crate::files::nearest_name(typed, quoted)?)));
        let hint = near
            .map_or(String::new(), |(typed, near)| format!("\n\nhint: did you mean `{near}` in place of `{typed}`?"));
        Self::Toml { file: file.into(), message, hint }
    }
}
