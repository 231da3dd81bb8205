//! What a run will cost, before it is begun.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;

use super::FdtdError;
use super::block::absorbing_nodes;
use super::coefficients::Edge;
use super::conductor::Cuts;
use super::layout::{Rows, padded_width};
use super::reach::Cones;
use super::setup::Setup;
use super::solver::{Fdtd, Precision, Stepping};
use crate::model::{
    DebyePole, Grid, MOST_POLES_IN_A_PLANE, Material, Model, Object, Order, Painted, TimeWindow, paint,
};

/// What a run will cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prediction {
    /// Memory of the fields and coefficients, bytes.
    pub bytes: u64,
    /// Wall time of the loop over the steps, s.
    pub seconds: f64,
    /// Cells times steps, those left out included.
    pub cell_steps: u64,
    /// Share of them that is left out, because no wave is there that a receiver will see.
    pub share_saved: f64,
}

/// Cells of the trial runs: more than the inner caches hold, so that a larger model runs at the same speed.
const TRIAL_CELLS: usize = 250_000;
/// Cell-steps of the shorter trial run: one or two milliseconds.
const TRIAL_CELL_STEPS: usize = 2_400_000;
/// Runs of each length, of which the fastest counts.
const TRIALS: usize = 3;

/// Memory of the fields and coefficients of a two-dimensional model, bytes.
///
/// # Errors
/// Whatever the solver cannot do, as [`Fdtd::solve_stats`] would say it.
pub fn memory(model: &Model, painted: &Painted, precision: Precision) -> Result<u64, FdtdError> {
    Ok(bytes_needed(&Setup::new(model, painted)?, precision))
}

/// Predicts memory and wall time in single precision, from trial runs of some twenty milliseconds in all on this machine;
/// twice that for a model with Debye media.
///
/// The trials have rows as long as the model's, the same coefficients and the same threads; the time of the dispersive
/// nodes is the difference of two of them.
///
/// # Errors
/// Whatever the solver cannot do, as [`Fdtd::solve_stats`] would say it.
pub fn predict(model: &Model, painted: &Painted, threads: Option<NonZeroUsize>) -> Result<Prediction, FdtdError> {
    let setup = Setup::new(model, painted)?;
    let fdtd = Fdtd { threads, ..Fdtd::default() };
    let bytes = bytes_needed(&setup, Precision::Single);
    let cells = model.grid.cell_count();
    let poles = poles_per_node(&setup);
    let plain = trial(&fdtd, model, setup.lossy(), 0)?;
    let mut per_step = plain * cells as f64;
    for (count, &nodes) in poles.iter().enumerate().skip(1).filter(|(_, nodes)| **nodes > 0) {
        let extra = (trial(&fdtd, model, setup.lossy(), count)? - plain).max(0.0);
        per_step += extra * nodes as f64;
    }
    let steps = setup.iterations;
    let share_saved = Cones::new(&setup, true).reach().share_saved;
    let seconds = per_step * steps as f64 * (1.0 - share_saved);
    Ok(Prediction { bytes, seconds, cell_steps: cells as u64 * steps as u64, share_saved })
}

/// Seconds per cell and step of an even material on a grid with the model's rows.
fn trial(fdtd: &Fdtd, model: &Model, lossy: bool, poles: usize) -> Result<f64, FdtdError> {
    let [nx, ny, _] = model.grid.cells;
    let nx = nx.min((TRIAL_CELLS / ny).max(32));
    let grid = Grid { cells: [nx, ny, 1], spacing: model.grid.spacing };
    let mut even = Model::new("", grid, TimeWindow::Iterations(1));
    let mut absorbing = model.absorbing_cells();
    if nx < model.grid.cells[0] {
        (absorbing[0], absorbing[3]) = (0, 0);
    }
    even.pml_cells = Some(absorbing);
    even.threads = model.threads;
    even.order = model.order;
    let mut material = Material::dielectric("trial", 4.0, if lossy { 0.01 } else { 0.0 });
    material.poles = (0..poles).map(|pole| DebyePole { delta_eps: 1.0, tau: 1e-11 * (pole + 1) as f64 }).collect();
    material.averagable = poles == 0;
    let id = even.add_material(material);
    even.objects.push(Object::Box { lower: [0.0; 3], upper: [f64::MAX; 3], material: id, averaging: true });
    let painted = paint(&even)?;
    let mut seconds = |steps: usize| {
        // One sample more than steps: the last sample is taken after the last step.
        even.time_window = TimeWindow::Iterations(steps + 1);
        let stepping = Stepping { skip: false, ..Stepping::default() };
        let solved = fdtd.solve_stepping(&even, &painted, stepping, &|_| ControlFlow::Continue(()));
        solved.map(|(_, stats)| stats.wall.si())
    };
    // The difference leaves out what a run pays once: starting threads and touching memory for the first time. Short and
    // long runs take turns, so that both meet the same load.
    let steps = (TRIAL_CELL_STEPS / (nx * ny)).clamp(16, 512) / 16 * 16;
    let (mut short, mut long) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..TRIALS {
        short = short.min(seconds(steps)?);
        long = long.min(seconds(3 * steps)?);
    }
    let marginal = (long - short) / (2 * steps) as f64;
    let whole = long / (3 * steps) as f64;
    Ok(if marginal > 0.2 * whole { marginal } else { whole } / (nx * ny) as f64)
}

/// How many nodes have 0, 1, 2, … Debye poles.
fn poles_per_node(setup: &Setup<'_>) -> Vec<usize> {
    let mut nodes = vec![0; MOST_POLES_IN_A_PLANE + 1];
    let per_entry = setup.painted.edges_per_entry();
    for (edge, count) in setup.edges.iter().zip(per_entry) {
        nodes[edge.poles.len()] += count;
    }
    nodes
}

/// Memory while objects are painted: cells, claims and edges.
pub fn painting_bytes(model: &Model) -> u64 {
    model.grid.cell_count() as u64 * 9
}

/// Memory of the fields, the coefficients and the absorbing boundary of a run, bytes.
pub fn bytes_needed(setup: &Setup<'_>, precision: Precision) -> u64 {
    match precision {
        Precision::Single => bytes::<f32>(setup),
        Precision::Double => bytes::<f64>(setup),
    }
}

fn bytes<T: super::real::Real>(setup: &Setup<'_>) -> u64 {
    let [nx, ny] = setup.painted.cells_xy;
    let width = padded_width(ny);
    let arrays = if setup.lossy() { 5 } else { 4 };
    let [x0, y0, x1, y1] = &setup.slabs;
    let columns = 2 * Rows::<T>::bytes(nx, absorbing_nodes(y0, y1, ny));
    let poles: usize = poles_per_node(setup).iter().enumerate().map(|(poles, nodes)| poles * nodes).sum();
    let cuts = if setup.order == Order::Fourth { Cuts::new(setup, 0, nx).bytes() } else { 0 };
    let samples = setup.receivers.len() * 6 * 8 + setup.drives.len() * (8 + size_of::<T>());
    arrays * Rows::<T>::bytes(nx + 1, width)
        + 2 * Rows::<T>::bytes(x0.cells + x1.cells, width)
        + columns
        + (poles * size_of::<T>()) as u64
        + (samples * setup.iterations) as u64
        + (setup.edges.len() * size_of::<Edge>()) as u64
        + cuts
}
