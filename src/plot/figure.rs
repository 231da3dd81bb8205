//! What all figures share: they lay themselves out, and are written as PNG and SVG.

use std::path::{Path, PathBuf};

use crate::files::{create_folder, write_bytes};

use super::error::PlotError;
use super::render;
use super::sheet::Sheet;

/// Something that can be laid out on a sheet, and so written as a picture.
pub trait Figure {
    /// Lays the figure out.
    ///
    /// # Errors
    /// Data that contradict themselves: see [`PlotError`].
    fn lay_out(&self) -> Result<Sheet, PlotError>;

    /// The figure as a PNG file, two pixels per point.
    ///
    /// # Errors
    /// See [`PlotError`].
    fn png(&self) -> Result<Vec<u8>, PlotError> {
        render::png(&self.lay_out()?)
    }

    /// The figure as the text of an SVG file, coordinates in eighths of a point.
    ///
    /// # Errors
    /// See [`PlotError`].
    fn svg(&self) -> Result<String, PlotError> {
        render::svg(&self.lay_out()?)
    }

    /// Writes `<stem>.png` and `<stem>.svg` into a folder, which is created when it is missing; returns their paths.
    ///
    /// # Errors
    /// See [`PlotError`].
    fn write(&self, folder: &Path, stem: &str) -> Result<Vec<PathBuf>, PlotError> {
        let sheet = self.lay_out()?;
        let files = [("png", render::png(&sheet)?), ("svg", render::svg(&sheet)?.into_bytes())];
        create_folder(folder)?;
        files
            .into_iter()
            .map(|(extension, bytes)| {
                let path = folder.join(format!("{stem}.{extension}"));
                write_bytes(&path, &bytes)?;
                Ok(path)
            })
            .collect()
    }
}
