//! The snapshots that an input file asks for (`#snapshot`).

use std::fs;
use std::path::{Path, PathBuf};

use crate::cli::checkpoint::{self, CheckpointArgs, Used};
use crate::cli::error::CliError;
use crate::cli::folder;
use crate::fdtd::{FdtdError, Keeping, Snapshots};
use crate::files::{FileError, create_folder, read_text, remove_half_written, write_bytes};
use crate::gprmax;
use crate::model::{Model, Snapshot};
use crate::trace::FieldSnapshot;

/// Snapshots on their way: each is written when its step is reached, into a folder of its own beside the place of all, and
/// they move there together when the run is done.
pub(super) struct Album {
    asked: Vec<Snapshot>,
    place: PathBuf,
    waiting: PathBuf,
}

impl Album {
    /// Names the folders of a result's snapshots.
    ///
    /// # Errors
    /// When a snapshot is there already and may not be overwritten.
    pub fn open(model: &Model, result: &Path, force: bool) -> Result<Self, CliError> {
        let place = gprmax::snapshot_folder(result);
        let waiting = folder::with_ending(&place, "partial");
        let album = Self { asked: model.snapshots.clone(), place, waiting };
        match album.paths().into_iter().find(|path| path.exists()) {
            Some(path) if !force => Err(CliError::input(format!(
                "`#snapshot` would write `{}`, which exists already\n\nhint: overwrite it with `--force`, or write other results with `--out FILE.h5`",
                path.display()
            ))),
            _ => Ok(album),
        }
    }

    /// Where the snapshots will be.
    fn paths(&self) -> Vec<PathBuf> {
        self.asked.iter().map(|asked| self.place.join(gprmax::snapshot_file(asked))).collect()
    }

    fn waiting(&self, index: usize) -> Option<PathBuf> {
        self.asked.get(index).map(|asked| self.waiting.join(gprmax::snapshot_file(asked)))
    }

    /// Whether one has been taken.
    pub fn is_there(&self, index: usize) -> bool {
        self.waiting(index).is_some_and(|path| path.is_file())
    }

    /// Keeps one; an error fits after "failed to".
    pub fn take(&self, index: usize, snapshot: &FieldSnapshot) -> Result<(), String> {
        let (Some(path), Some(asked)) = (self.waiting(index), self.asked.get(index)) else { return Ok(()) };
        let file = |error: FileError| error.to_string();
        create_folder(&self.waiting).map_err(file)?;
        let bytes = gprmax::snapshot_to_bytes(snapshot, asked.format)
            .map_err(|error| format!("lay out `{}`: {error}", path.display()))?;
        write_bytes(&path, &bytes).map_err(file)
    }

    /// Moves all to their place; gives their paths.
    ///
    /// # Errors
    /// What the system said.
    pub fn publish(&self) -> Result<Vec<PathBuf>, CliError> {
        let paths = self.paths();
        if !paths.is_empty() {
            create_folder(&self.place)?;
        }
        for (index, path) in paths.iter().enumerate() {
            if let Some(waiting) = self.waiting(index) {
                fs::rename(&waiting, path).map_err(FileError::of("write", path))?;
            }
        }
        self.discard();
        Ok(paths)
    }

    /// Removes what waits.
    pub fn discard(&self) {
        if !self.waiting.is_dir() {
            return;
        }
        for path in (0..self.asked.len()).filter_map(|index| self.waiting(index)) {
            // What cannot be removed keeps its folder, and that is told.
            let _ = fs::remove_file(path);
        }
        remove_half_written(&self.waiting);
        if let Err(error) = fs::remove_dir(&self.waiting) {
            eprintln!("warning: failed to remove `{}`: {error}", self.waiting.display());
        }
    }
}

/// Refuses to let gprMax write snapshots where there are some, for files that only gprMax can read.
///
/// # Errors
/// When the folder of the snapshots is there and may not be written into.
pub(super) fn check_any(input: &Path, result: &Path, force: bool) -> Result<(), CliError> {
    let folder = gprmax::snapshot_folder(result);
    let asks = read_text(input)?.lines().any(|line| line.starts_with("#snapshot:"));
    if force || !asks || !folder.exists() {
        return Ok(());
    }
    Err(CliError::input(format!(
        "`#snapshot` would write into `{}`, which exists already\n\nhint: overwrite what is in it with `--force`, or write other results with `--out FILE.h5`",
        folder.display()
    )))
}

/// Runs a solver with the checkpoint and the snapshots of a result; [`Album::publish`] them when the result is written.
///
/// # Errors
/// What the solver said; then no snapshot waits, unless there is a checkpoint to go on from.
pub(super) fn solve_kept<R>(
    args: &CheckpointArgs,
    album: &Album,
    result: &Path,
    solve: impl FnOnce(Keeping<'_>) -> Result<R, FdtdError>,
) -> Result<(R, Used), CliError> {
    let take = |index: usize, snapshot: FieldSnapshot| album.take(index, &snapshot);
    let is_there = |index: usize| album.is_there(index);
    let snapshots = Snapshots { take: &take, is_there: &is_there };
    let solved = checkpoint::with_checkpoint(args, result, |checkpoints| {
        solve(Keeping { checkpoints, snapshots: Some(&snapshots) })
    });
    if solved.is_err() && !checkpoint::path(result).exists() {
        album.discard();
    }
    solved
}
