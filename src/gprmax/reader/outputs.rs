//! The commands that ask for files beside the traces: blocks of geometry, snapshots.

use std::path::Path;

use super::super::geometry::geometry_names;
use super::error::Problem;
use super::lines::Command;
use super::multiple::inside;
use super::values::Parameters;
use crate::model::{Axis, GeometryFile, GeometryView, Model, Snapshot, SnapshotFormat, SnapshotTime, ViewKind};

pub(super) fn geometry_objects_write(model: &mut Model, command: &Command<'_>) -> Result<(), Problem> {
    let p = Parameters::of(command, "X1 Y1 Z1 X2 Y2 Z2 FILE", |n| n == 7)?;
    let (lower, upper, file) = (p.point(0)?, p.point(3)?, p.word(6)?);
    block(model, &p, lower, upper)?;
    let names =
        geometry_names(file).ok_or_else(|| p.not_one_of(file, "a file name", "bed, bed.h5 or any other".into()))?;
    let taken = model.geometry_files.iter().filter_map(|known| geometry_names(&known.file)).flatten();
    if taken.into_iter().any(|name| names.contains(&name)) {
        return Err(Problem::DefinedTwice { what: "geometry file", id: file.into() });
    }
    model.geometry_files.push(GeometryFile { lower, upper, file: file.into() });
    Ok(())
}

/// A view of the geometry.
pub(super) fn geometry_view(model: &mut Model, command: &Command<'_>) -> Result<(), Problem> {
    let p = Parameters::of(command, "X1 Y1 Z1 X2 Y2 Z2 DX DY DZ FILE n|f", |n| n == 11)?;
    let (lower, upper, spacing, file) = (p.point(0)?, p.point(3)?, p.point(6)?, p.word(9)?);
    let kind = match p.word(10)?.to_lowercase().as_str() {
        "n" => ViewKind::Cells,
        "f" => ViewKind::Edges,
        _ => return Err(p.not_one_of(p.word(10)?, "what a view shows", "n, f".into())),
    };
    block(model, &p, lower, upper)?;
    for (axis, &size) in spacing.iter().enumerate() {
        let (step, all) = (model.grid.node(axis, size), model.grid.cells[axis] as i64);
        let what = "a size of the view's cells";
        p.check(what, size, step >= 1, "at least that of the grid's")?;
        p.check(what, size, step <= all, "at most the domain")?;
        let same = kind == ViewKind::Cells || step == 1;
        p.check(what, size, same, "that of the grid's to show edges (`f`)")?;
    }
    if file.ends_with(['/', '.']) || Path::new(file).file_name().is_none() {
        return Err(p.not_one_of(file, "a file name", "view, view.vtkhdf or any other".into()));
    }
    let stem = |file: &str| Path::new(file).with_extension("");
    if model.geometry_views.iter().any(|known| stem(&known.file) == stem(file)) {
        return Err(Problem::DefinedTwice { what: "geometry view", id: file.into() });
    }
    model.geometry_views.push(GeometryView { lower, upper, spacing, kind, file: file.into() });
    Ok(())
}

/// Checks that a block lies on the grid and holds cells.
fn block(model: &Model, p: &Parameters<'_>, lower: [f64; 3], upper: [f64; 3]) -> Result<(), Problem> {
    for axis in [Axis::X, Axis::Y, Axis::Z] {
        let (low, high) = (lower[axis.index()], upper[axis.index()]);
        if model.grid.node(axis.index(), low) >= model.grid.node(axis.index(), high) {
            return Err(Problem::NoCells { command: p.command().into(), axis: axis.name(), lower: low, upper: high });
        }
    }
    inside(model, "corner of the block", lower)?;
    inside(model, "corner of the block", upper)
}

/// A snapshot; of the file's name gprMax takes what stands behind the last `/`.
pub(super) fn snapshot(model: &mut Model, command: &Command<'_>) -> Result<(), Problem> {
    let p = Parameters::of(command, "X1 Y1 Z1 X2 Y2 Z2 DX DY DZ TIME|STEP FILE[.h5|.vtkhdf]", |n| n == 11)?;
    let (lower, upper, spacing) = (p.point(0)?, p.point(3)?, p.point(6)?);
    let at = match p.word(9)?.parse::<i64>() {
        Ok(step) => {
            p.check("the step", step as f64, step >= 0, "0 or more")?;
            SnapshotTime::Iteration(step as usize)
        }
        Err(_) => SnapshotTime::Seconds(p.number(9, "a time in seconds or a step")?),
    };
    let word = p.word(10)?;
    let path = Path::new(word);
    let name = path.file_stem().and_then(|stem| stem.to_str()).filter(|_| !word.ends_with(['/', '.']));
    let name = name.ok_or_else(|| p.not_one_of(word, "a file name", "wave, wave.h5 or any other".into()))?;
    let format = match path.extension().and_then(|ending| ending.to_str()) {
        None | Some("vtkhdf") => SnapshotFormat::VtkHdf,
        Some("h5") => SnapshotFormat::Hdf5,
        Some(_) => return Err(p.not_one_of(word, "the file of a snapshot", format!("{name}.h5, {name}.vtkhdf"))),
    };
    let snapshot = Snapshot { lower, upper, spacing, at, name: name.into(), format };
    snapshot.step(model)?;
    snapshot.cells(model)?;
    if model.snapshots.iter().any(|known| known.name == snapshot.name && known.format == snapshot.format) {
        return Err(Problem::DefinedTwice { what: "snapshot", id: word.into() });
    }
    model.snapshots.push(snapshot);
    Ok(())
}
