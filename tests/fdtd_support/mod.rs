//! Scenes and measures that the solver's tests share.
#![expect(dead_code, reason = "each test file uses its own part")]

use std::num::NonZeroUsize;
use std::ops::ControlFlow;

use ballast_gpr::fdtd::{Fdtd, FdtdError, InstructionSet, Precision};
use ballast_gpr::model::{
    Axis, Excitation, Grid, HertzianDipole, MaterialId, Model, Object, Receiver, Source, TimeWindow, Waveform,
    WaveformKind,
};
use ballast_gpr::trace::{Component, Traces};

/// Free space, a Ricker pulse of 1 GHz and 1 A at a node, receivers at nodes.
pub fn scene(cells: [usize; 2], cell: f64, steps: usize, source: [usize; 2], receivers: &[[usize; 2]]) -> Model {
    let grid = Grid { cells: [cells[0], cells[1], 1], spacing: [cell; 3] };
    let mut model = Model::new("test", grid, TimeWindow::Iterations(steps));
    model.waveforms.push(Waveform { id: "w".into(), kind: WaveformKind::Ricker, amplitude: 1.0, frequency: 1e9 });
    let at = |node: [usize; 2]| [node[0] as f64 * cell, node[1] as f64 * cell, 0.0];
    let excitation = Excitation { start: 0.0, stop: None };
    let dipole = HertzianDipole { polarisation: Axis::Z, position: at(source), waveform: 0, excitation };
    model.sources.push(Source::HertzianDipole(dipole));
    model.receivers = receivers.iter().map(|&node| Receiver { position: at(node), name: None }).collect();
    model
}

/// A box from node `(i0, j0)` to `(i1, j1)`.
pub fn box_of(model: &Model, [i0, j0, i1, j1]: [usize; 4], material: MaterialId, averaging: bool) -> Object {
    let d = model.grid.spacing;
    let lower = [i0 as f64 * d[0], j0 as f64 * d[1], 0.0];
    let upper = [i1 as f64 * d[0], j1 as f64 * d[1], d[2]];
    Object::Box { lower, upper, material, averaging }
}

/// Runs a model with nobody watching.
pub fn run(fdtd: &Fdtd, model: &Model) -> Result<Traces, FdtdError> {
    fdtd.solve_stats(model, &|_| ControlFlow::Continue(())).map(|(traces, _)| traces)
}

/// Runs a model that must run.
pub fn solve(model: &Model, precision: Precision) -> Traces {
    run(&Fdtd { precision, ..Fdtd::default() }, model).unwrap()
}

/// A solver with so many threads and such instructions.
pub fn fdtd(precision: Precision, threads: usize, instruction_set: InstructionSet) -> Fdtd {
    Fdtd { precision, threads: NonZeroUsize::new(threads), instruction_set }
}

/// Ez of a receiver.
pub fn ez(traces: &Traces, receiver: usize) -> &[f64] {
    &traces.receivers[receiver].component(Component::Ez).unwrap().samples
}

/// `|a - b| / |b|`
pub fn relative_l2(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let difference: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
    (difference / b.iter().map(|b| b * b).sum::<f64>()).sqrt()
}
