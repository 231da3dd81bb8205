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
use super::slab::Slab;
use super::solver::{Fdtd, Precision, Stepping};
use super::team;
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
    /// What of the time each effect takes.
    pub shares: TimeShares,
}

/// What of the time of a step an effect takes, in [0, 1]; `None` where it is absent, or was not tried.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TimeShares {
    /// Conduction.
    pub conduction: Option<f64>,
    /// Poles.
    pub dispersion: Option<f64>,
    /// The absorbing boundary.
    pub boundary: Option<f64>,
}

/// Cells up to which the model itself is tried, and of a part of which a larger one is predicted: what they take no cache
/// holds any more.
const MOST_TRIED_CELLS: usize = 8_000_000;
/// Cell-steps of the longer trial run: some thirty milliseconds, so that what a run pays once does not drown them.
const TRIAL_CELL_STEPS: usize = 200_000_000;
/// Runs of each kind, of which the middle one counts.
const TRIALS: usize = 3;

/// Memory of the fields and coefficients of a two-dimensional model, bytes.
///
/// # Errors
/// Whatever the solver cannot do, as [`Fdtd::solve_stats`] would say it.
pub fn memory(model: &Model, painted: &Painted, precision: Precision) -> Result<u64, FdtdError> {
    Ok(bytes_needed(&Setup::new(model, painted)?, precision))
}

/// Predicts memory and wall time in single precision, from some steps of the model itself on this machine: about 0.2 s, twice
/// to four times as much where effects are to be told apart. A model of more than eight million cells is tried on as many of
/// its rows as make so many.
///
/// What light cones leave out is taken off, the nodes that the busiest thread of each step must make being what counts.
///
/// # Errors
/// Whatever the solver cannot do, as [`Fdtd::solve_stats`] would say it.
pub fn predict(model: &Model, painted: &Painted, threads: Option<NonZeroUsize>) -> Result<Prediction, FdtdError> {
    let setup = Setup::new(model, painted)?;
    let fdtd = Fdtd { threads, ..Fdtd::default() };
    let cells = model.grid.cell_count();
    let (per_step, shares) = if cells <= MOST_TRIED_CELLS {
        try_out(&fdtd, model, &setup)?
    } else {
        let (part, even) = even_part(model, &setup)?;
        let (per_step, shares) = try_out(&fdtd, &part, &Setup::new(&part, &even)?)?;
        (per_step * cells as f64 / part.grid.cell_count() as f64, shares)
    };
    let cones = Cones::new(&setup, true);
    let seconds =
        per_step * setup.iterations as f64 * team::share_of_time::<f32>(&setup, &cones, fdtd.threads_for(model));
    Ok(Prediction {
        bytes: bytes_needed(&setup, Precision::Single),
        seconds,
        cell_steps: cells as u64 * setup.iterations as u64,
        share_saved: cones.reach().share_saved,
        shares,
    })
}

/// Seconds per step when every cell is stepped, and what of them each effect takes: what a step without it takes less.
fn try_out(fdtd: &Fdtd, model: &Model, setup: &Setup<'_>) -> Result<(f64, TimeShares), FdtdError> {
    let without = |present: bool, change: &dyn Fn(&mut Setup<'_>)| {
        present.then(|| {
            let mut setup = setup.clone();
            change(&mut setup);
            setup
        })
    };
    let lossless = without(setup.lossy(), &|setup| setup.edges.iter_mut().for_each(|edge| edge.ca = 1.0));
    let poles = setup.edges.iter().any(|edge| !edge.poles.is_empty());
    let plain = without(poles, &|setup| setup.edges.iter_mut().for_each(|edge| edge.poles.clear()));
    let walled = without(setup.slabs.iter().any(|slab| slab.cells > 0), &|setup| setup.slabs = [Slab::none(); 4]);
    let kinds = [Some(setup.clone()), lossless, plain, walled];
    let mut times = [const { vec![] }; 4];
    // In turns, so that all kinds meet the same load.
    for _ in 0..TRIALS {
        for (times, kind) in times.iter_mut().zip(&kinds) {
            if let Some(kind) = kind {
                times.push(seconds_per_step(fdtd, model, kind)?);
            }
        }
    }
    let middle = times.map(|mut times: Vec<f64>| {
        times.sort_by(f64::total_cmp);
        times.get(times.len() / 2).copied()
    });
    let all = middle[0].unwrap_or(0.0);
    let [_, conduction, dispersion, boundary] = middle.map(|less| less.map(|less| (1.0 - less / all).clamp(0.0, 1.0)));
    Ok((all, TimeShares { conduction, dispersion, boundary }))
}

/// Wall time of a step, from the difference of a longer and a shorter run: starting threads and touching memory for the first
/// time are left out.
fn seconds_per_step(fdtd: &Fdtd, model: &Model, setup: &Setup<'_>) -> Result<f64, FdtdError> {
    let stepping = Stepping { skip: false, ..Stepping::default() };
    let pass = fdtd.steps_per_pass(model, setup);
    let passes = (TRIAL_CELL_STEPS / (model.grid.cell_count() * pass)).clamp(2, 1000);
    let seconds = |steps: usize| {
        // One sample more than steps: the last sample is taken after the last step.
        let mut some = setup.clone();
        some.set_iterations(steps + 1);
        fdtd.run::<f32>(model, &some, stepping, &|_| ControlFlow::Continue(())).map(|(_, stats)| stats.wall.si())
    };
    let (short, long) = (seconds(pass)?, seconds((1 + passes) * pass)?);
    // A short run that was held up tells nothing.
    let whole = long / ((1 + passes) * pass) as f64;
    Ok(((long - short) / (passes * pass) as f64).max(0.2 * whole))
}

/// As many rows of a large model as are tried, of its commonest kind of material.
fn even_part(model: &Model, setup: &Setup<'_>) -> Result<(Model, Painted), FdtdError> {
    let [nx, ny, _] = model.grid.cells;
    let rows = (MOST_TRIED_CELLS / ny).clamp(32.min(nx), nx);
    let mut part =
        Model::new("", Grid { cells: [rows, ny, 1], spacing: model.grid.spacing }, TimeWindow::Iterations(1));
    let mut absorbing = model.absorbing_cells();
    (absorbing[0], absorbing[3]) = (0, 0);
    part.pml_cells = Some(absorbing);
    (part.threads, part.order) = (model.threads, model.order);
    let nodes = poles_per_node(setup);
    let poles = (0..nodes.len()).max_by_key(|&poles| nodes[poles]).unwrap_or(0);
    let mut material = Material::dielectric("trial", 4.0, if setup.lossy() { 0.01 } else { 0.0 });
    material.poles = (0..poles).map(|pole| DebyePole { delta_eps: 1.0, tau: 1e-11 * (pole + 1) as f64 }).collect();
    material.averagable = poles == 0;
    let id = part.add_material(material);
    part.objects.push(Object::Box { lower: [0.0; 3], upper: [f64::MAX; 3], material: id, averaging: true });
    let painted = paint(&part)?;
    Ok((part, painted))
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
