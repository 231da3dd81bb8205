//! From commands to a model.

use std::path::{Path, PathBuf};

use super::commands::CommandKind;
use super::directives::{Directives, directives};
use super::error::InFileError;
use super::fractal::Fractals;
use super::include::Whole;
use super::lines::split;
use super::multiple::apply;
use super::single::start;
use crate::model::Model;

/// What an input file holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// The model.
    pub model: Model,
    /// Commands that were read and not acted upon, and lines that gprMax ignores though they look like commands.
    pub notes: Vec<Note>,
}

/// A line that does not change the traces and was not acted upon.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// Line number, from 1.
    pub line: usize,
    /// What was passed over, and why that is harmless.
    pub text: String,
}

impl std::fmt::Display for Note {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "line {}: {}", self.line, self.text)
    }
}

/// Reads an input file.
///
/// Geometry and excitation files are looked for beside the input file, included files beside the file that includes them.
///
/// # Errors
/// See [`InFileError`]: every error names the file and the line.
pub fn read_input(path: &Path) -> Result<Input, InFileError> {
    let whole = Whole::read(path)?;
    let mut input = read_whole(path, &whole.text).map_err(|error| whole.error(error))?;
    for note in &mut input.notes {
        let (line, place) = whole.note(note.line);
        *note = Note { line, text: format!("{place}{}", note.text) };
    }
    Ok(input)
}

/// Gives the files that decide what an input file means: itself, those it includes, those that its commands read.
///
/// # Errors
/// As [`read_input`], for the files that are included.
pub fn input_files(path: &Path) -> Result<Vec<PathBuf>, InFileError> {
    Ok(Whole::read(path)?.files())
}

/// Reads the text of an input file, in which everything that it includes stands already.
fn read_whole(path: &Path, text: &str) -> Result<Input, InFileError> {
    let at = |line: usize| move |problem| InFileError::Line { path: path.into(), line, problem: Box::new(problem) };
    let (commands, indented) = split(text).map_err(|(line, problem)| at(line)(problem))?;
    let asked = directives(text).map_err(|(line, problem)| at(line)(problem))?;
    let mut model = start(path, &commands, asked)?;
    let mut notes: Vec<Note> = indented
        .into_iter()
        .map(|line| Note { line, text: "ignored, as gprMax does: a command must start in the first column".into() })
        .collect();
    // gprMax builds materials, then their poles, waveforms, sources and receivers, then objects and snapshots, each in
    // file order.
    let passes: [&[&str]; 10] = [
        &["pml_cfs"],
        &["material"],
        &["add_dispersion_debye"],
        &["add_dispersion_lorentz"],
        &["add_dispersion_drude"],
        &["waveform", "excitation_file"],
        &["hertzian_dipole", "magnetic_dipole", "voltage_source"],
        &["rx", "rx_array"],
        &[
            "box",
            "cylinder",
            "sphere",
            "triangle",
            "ellipsoid",
            "cone",
            "cylindrical_sector",
            "plate",
            "edge",
            "fractal_box",
            "geometry_objects_read",
            "geometry_objects_write",
        ],
        &["snapshot", "geometry_view"],
    ];
    let mut fractals = Fractals::default();
    for pass in passes {
        if pass.contains(&"fractal_box") {
            // Mixtures first, then the boxes made of them and what is done to their faces.
            let (mixtures, boxes) = Fractals::COMMANDS.split_at(3);
            for names in [mixtures, boxes] {
                for command in commands.iter().filter(|command| names.contains(&command.name)) {
                    fractals.read(&mut model, command).map_err(at(command.line))?;
                }
            }
        }
        for command in commands.iter().filter(|command| pass.contains(&command.name)) {
            if command.name == "fractal_box" {
                model.objects.extend(fractals.object(command).map_err(at(command.line))?);
            } else {
                apply(&mut model, path, command, &mut notes).map_err(at(command.line))?;
            }
        }
    }
    for command in &commands {
        if let CommandKind::Noted(why) = command.kind {
            notes.push(Note { line: command.line, text: format!("`#{}` is not acted upon: {why}", command.name) });
        }
    }
    for command in commands.iter().filter(|command| ["src_steps", "rx_steps"].contains(&command.name)) {
        let what = if command.name == "src_steps" { "sources" } else { "receivers" };
        let text =
            format!("`#{}` moves the {what} from the second trace of a B-scan on (`run --traces`)", command.name);
        notes.push(Note { line: command.line, text });
    }
    notes.sort_by_key(|note| note.line);
    Ok(Input { model, notes })
}

/// Reads an input file and gives its model only; [`read_input`] also says what was not acted upon.
///
/// # Errors
/// As [`read_input`].
pub fn read_model(path: &Path) -> Result<Model, InFileError> {
    read_input(path).map(|input| input.model)
}

/// What an input file asks of the embedded solver alone (`## ballast-gpr: order 4`), whatever else stands in it.
///
/// # Errors
/// When the file cannot be read, or asks for something unknown.
pub fn read_directives(path: &Path) -> Result<Directives, InFileError> {
    let whole = Whole::read(path)?;
    let at = |line: usize| move |problem| InFileError::Line { path: path.into(), line, problem: Box::new(problem) };
    directives(&whole.text).map_err(|(line, problem)| whole.error(at(line)(problem)))
}
