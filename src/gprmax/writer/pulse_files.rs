//! The files of pulses given as samples.

use std::path::{Path, PathBuf};

use super::error::WriteError;
use super::number::number;
use crate::files::write_bytes;
use crate::model::{Model, Sampled, Waveform, WaveformKind};

/// The samples of a pulse that is given so.
pub(super) fn sampled(waveform: &Waveform) -> Option<&Sampled> {
    match &waveform.kind {
        WaveformKind::User(sampled) => Some(sampled),
        _ => None,
    }
}

/// The text of an `#excitation_file` with one pulse: `time NAME`, then times, s, and samples.
pub fn excitation_text(name: &str, pulse: &Sampled) -> String {
    let mut text = format!("time {name}\n");
    for (time, value) in pulse.times().iter().zip(pulse.values()) {
        text.push_str(&format!("{} {}\n", number(*time), number(*value)));
    }
    text
}

/// One file beside an input file for each pulse given as samples.
pub(super) struct PulseFiles<'a> {
    pub model: &'a Model,
    pub stem: String,
}

impl PulseFiles<'_> {
    /// Name of the file of a waveform; empty where a formula gives it.
    pub fn name(&self, index: usize) -> String {
        match sampled(&self.model.waveforms[index]) {
            Some(_) => format!("{}_pulse{}.txt", self.stem, index + 1),
            None => String::new(),
        }
    }

    /// Writes the files and gives their paths.
    pub fn write(&self, folder: &Path) -> Result<Vec<PathBuf>, WriteError> {
        let mut written = vec![];
        for (index, waveform) in self.model.waveforms.iter().enumerate() {
            let Some(sampled) = sampled(waveform) else { continue };
            let path = folder.join(self.name(index));
            write_bytes(&path, excitation_text(&waveform.id, sampled).as_bytes())?;
            written.push(path);
        }
        Ok(written)
    }
}
