//! The commands that may stand once: grid, time window, absorbing boundary.

use std::path::Path;

use super::boundary::{formulation, symmetry};
use super::directives::Directives;
use super::error::{InFileError, Problem};
use super::lines::Command;
use super::values::Parameters;
use crate::model::{Axis, Grid, MagneticAveraging, Model, TimeWindow, ceil_half_down};

/// `#domain_mode`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum DomainMode {
    Transverse { electric: bool },
    Three,
}

/// The most cells that a file may ask for: beyond it gprMax would need 300 GB (70 bytes a cell) and more.
const MOST_CELLS: f64 = 4_294_967_296.0;
/// The most time steps that a file may ask for.
const MOST_STEPS: f64 = 1e9;

/// The model before anything is in it: grid, time window and the other single commands.
pub(super) fn start(path: &Path, commands: &[Command<'_>], asked: Directives) -> Result<Model, InFileError> {
    let find = |name: &str| commands.iter().find(|command| command.name == name);
    let at = |command: &Command<'_>| {
        let line = command.line;
        move |problem| InFileError::Line { path: path.into(), line, problem: Box::new(problem) }
    };
    let essential = |name: &'static str, example: &'static str| {
        find(name).ok_or_else(|| InFileError::Missing { path: path.into(), command: name, example })
    };
    let domain = essential("domain", "#domain: 0.6 0.5 0.002")?;
    let spacing = essential("dx_dy_dz", "#dx_dy_dz: 0.002 0.002 0.002")?;
    let window = essential("time_window", "#time_window: 8e-9")?;

    let sizes = cell_sizes(spacing).map_err(at(spacing))?;
    let mode = find("domain_mode").map(|command| domain_mode(command).map_err(at(command))).transpose()?;
    let (grid, infinite) = grid(domain, sizes, mode).map_err(at(domain))?;
    let title = find("title").map_or("", |command| command.parameters);
    let mut model = Model::new(title, grid, TimeWindow::Iterations(1));
    (model.order, model.averaging) = (asked.order, asked.averaging);
    model.transverse_electric = infinite.filter(|_| mode == Some(DomainMode::Transverse { electric: true }));
    if let Some(command) = find("time_step_stability_factor") {
        model.stability_factor = stability_factor(command).map_err(at(command))?;
    }
    model.time_window = time_window(window, model.time_step()).map_err(at(window))?;
    if let Some(command) = find("omp_threads").or_else(|| find("num_threads")) {
        let threads = Parameters::of(command, "THREADS", |n| n == 1)
            .and_then(|p| p.count(0, "a number of threads").map(|count| (p, count)))
            .and_then(|(p, count)| {
                p.check("the number of threads", count as f64, count > 0, "1 or more").map(|_| count)
            });
        model.threads = Some(threads.map_err(at(command))?);
    }
    if let Some(command) = find("dispersive_averaging") {
        let on = Parameters::of(command, "y|n", |n| n == 1).and_then(|p| p.yes_or_no(0, "a flag"));
        model.dispersive_averaging = on.map_err(at(command))?;
    }
    if let Some(command) = find("magnetic_averaging") {
        model.magnetic_averaging = magnetic_averaging(command).map_err(at(command))?;
    }
    if let Some(command) = find("src_steps") {
        model.source_steps = steps(command).map_err(at(command))?;
    }
    if let Some(command) = find("rx_steps") {
        model.receiver_steps = steps(command).map_err(at(command))?;
    }
    if let Some(command) = find("pml_formulation") {
        model.absorbing_profile.formulation = formulation(command).map_err(at(command))?;
    }
    let sides = find("pml_cells");
    if let Some(command) = sides {
        model.pml_cells = Some(pml_cells(command, &grid).map_err(at(command))?);
    }
    for command in commands.iter().filter(|command| command.name == "symmetry_boundary") {
        symmetry(&mut model, command).map_err(at(command))?;
    }
    if sides.is_none() {
        check_default_pml(path, &model)?;
    }
    Ok(model)
}

fn magnetic_averaging(command: &Command<'_>) -> Result<MagneticAveraging, Problem> {
    let p = Parameters::of(command, "harmonic|arithmetic", |n| n == 1)?;
    let word = p.word(0)?;
    let found = MagneticAveraging::ALL.into_iter().find(|known| known.name() == word);
    found.ok_or_else(|| p.not_one_of(word, "a mean", MagneticAveraging::ALL.map(MagneticAveraging::name).join(", ")))
}

fn steps(command: &Command<'_>) -> Result<[f64; 3], Problem> {
    Parameters::of(command, "DX DY DZ", |n| n == 3)?.point(0)
}

fn cell_sizes(command: &Command<'_>) -> Result<[f64; 3], Problem> {
    let p = Parameters::of(command, "DX DY DZ", |n| n == 3)?;
    let sizes = p.point(0)?;
    for size in sizes {
        p.check("a cell size", size, size > 0.0, "above 0")?;
    }
    Ok(sizes)
}

fn domain_mode(command: &Command<'_>) -> Result<DomainMode, Problem> {
    let p = Parameters::of(command, "TM|TE|3D", |n| n == 1)?;
    let word = p.word(0)?;
    match word.to_uppercase().as_str() {
        "TM" => Ok(DomainMode::Transverse { electric: false }),
        "TE" => Ok(DomainMode::Transverse { electric: true }),
        "3D" => Ok(DomainMode::Three),
        _ => Err(p.not_one_of(word, "a mode", "TM, TE, 3D".into())),
    }
}

/// The grid, and its infinite axis: one cell thick in TM, two in TE.
fn grid(command: &Command<'_>, spacing: [f64; 3], mode: Option<DomainMode>) -> Result<(Grid, Option<Axis>), Problem> {
    let p = Parameters::of(command, "X Y Z", |n| n == 3)?;
    let axes = [Axis::X, Axis::Y, Axis::Z];
    let infinite: Vec<Axis> = axes.into_iter().filter(|axis| p.rest(0)[axis.index()].to_lowercase() == "inf").collect();
    let thickness = match mode {
        Some(DomainMode::Transverse { .. }) if infinite.len() != 1 => {
            return Err(Problem::InfiniteAxes { found: infinite.len() });
        }
        Some(DomainMode::Transverse { electric: true }) => 2.0,
        Some(DomainMode::Transverse { electric: false }) => 1.0,
        _ if !infinite.is_empty() => return Err(Problem::InfiniteWithoutMode),
        _ => 0.0,
    };
    let mut extent = [0.0; 3];
    for axis in 0..3 {
        let is_infinite = infinite.iter().any(|of| of.index() == axis);
        let what = "an extent in metres";
        extent[axis] = if is_infinite { thickness * spacing[axis] } else { p.number(axis, what)? };
    }
    let counts: [f64; 3] = std::array::from_fn(|axis| (extent[axis] / spacing[axis] - 0.5).ceil());
    let total = counts[0] * counts[1] * counts[2];
    for axis in 0..3 {
        p.check("an extent", extent[axis], counts[axis] >= 1.0, "at least one cell")?;
    }
    if total > MOST_CELLS || counts.iter().any(|&count| count > MOST_CELLS) || !total.is_finite() {
        return Err(Problem::TooManyCells { cells: counts, total, limit: MOST_CELLS });
    }
    let cells: [usize; 3] = std::array::from_fn(|axis| ceil_half_down(extent[axis] / spacing[axis]).max(0) as usize);
    let single = cells.iter().filter(|&&count| count == 1).count();
    if single > usize::from(thickness != 2.0) {
        return Err(p.unsupported("a domain with more than one axis of a single cell"));
    }
    Ok((Grid { cells, spacing }, infinite.first().copied()))
}

fn stability_factor(command: &Command<'_>) -> Result<f64, Problem> {
    let p = Parameters::of(command, "FACTOR", |n| n == 1)?;
    let factor = p.number(0, "a factor")?;
    p.check("the factor", factor, factor > 0.0 && factor <= 1.0, "above 0 and at most 1")
}

fn time_window(command: &Command<'_>, time_step: f64) -> Result<TimeWindow, Problem> {
    let p = Parameters::of(command, "SECONDS or a whole number of ITERATIONS", |n| n == 1)?;
    let limit = "at most 1e9";
    if let Ok(count) = p.word(0)?.parse::<i64>() {
        p.check("the number of iterations", count as f64, count > 0, "1 or more")?;
        p.check("the number of iterations", count as f64, count as f64 <= MOST_STEPS, limit)?;
        return Ok(TimeWindow::Iterations(count as usize));
    }
    let seconds = p.number(0, "a time in seconds or a number of iterations")?;
    p.check("the time", seconds, seconds > 0.0, "above 0")?;
    p.check("the number of iterations", (seconds / time_step).ceil(), seconds / time_step <= MOST_STEPS, limit)?;
    Ok(TimeWindow::Seconds(seconds))
}

fn pml_cells(command: &Command<'_>, grid: &Grid) -> Result<[usize; 6], Problem> {
    let p = Parameters::of(command, "N, or X0 Y0 Z0 XMAX YMAX ZMAX", |n| n == 1 || n == 6)?;
    let mut layers = [0; 6];
    for (side, layer) in layers.iter_mut().enumerate() {
        *layer = p.count(if p.len() == 1 { 0 } else { side }, "a number of cells")?;
    }
    for axis in [Axis::X, Axis::Y, Axis::Z] {
        let (below, above, cells) = (layers[axis.index()], layers[axis.index() + 3], grid.cells[axis.index()]);
        if below.saturating_add(above) >= cells {
            return Err(Problem::PmlTooThick { axis: axis.name(), below, above, cells });
        }
    }
    Ok(layers)
}

fn check_default_pml(path: &Path, model: &Model) -> Result<(), InFileError> {
    let layers = model.absorbing_cells();
    for axis in [Axis::X, Axis::Y, Axis::Z] {
        let (low, high, cells) = (layers[axis.index()], layers[axis.index() + 3], model.grid.cells[axis.index()]);
        let layer = low.max(high);
        if low + high >= cells {
            return Err(InFileError::DefaultPml { path: path.into(), axis: axis.name(), cells, layer });
        }
    }
    Ok(())
}
