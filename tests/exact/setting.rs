//! What the closed forms share: models by nodes, runs, spectra, errors.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use ballast_gpr::fdtd::{Fdtd, Precision};
use ballast_gpr::model::{
    Axis, Excitation, Grid, HertzianDipole, Model, Receiver, Source, TimeWindow, Waveform, WaveformKind, paint, paint3,
};
use ballast_gpr::trace::{Component, Traces};
use rustfft::num_complex::Complex64;

/// Free space without absorbing cells.
pub fn empty(cells: [usize; 3], spacing: [f64; 3], steps: usize) -> Model {
    let mut model = Model::new("exact", Grid { cells, spacing }, TimeWindow::Iterations(steps));
    model.pml_cells = Some([0; 6]);
    model
}

/// A Ricker pulse of 1 GHz.
pub fn add_pulse(model: &mut Model, amplitude: f64) -> usize {
    let id = format!("w{}", model.waveforms.len());
    model.waveforms.push(Waveform { id, kind: WaveformKind::Ricker, amplitude, frequency: 1e9 });
    model.waveforms.len() - 1
}

/// A dipole at a node.
pub fn add_dipole(model: &mut Model, polarisation: Axis, node: [usize; 3], waveform: usize, stop: Option<f64>) {
    let position = model.grid.node_position(node);
    let excitation = Excitation { start: 0.0, stop };
    model.sources.push(Source::HertzianDipole(HertzianDipole { polarisation, position, waveform, excitation }));
}

/// A receiver at a node.
pub fn add_receiver(model: &mut Model, node: [usize; 3]) {
    model.receivers.push(Receiver { position: model.grid.node_position(node), name: None });
}

/// Runs a model in double precision, however coarse its cells are.
pub fn solve(model: &Model) -> Traces {
    let fdtd = Fdtd { precision: Precision::Double, ..Fdtd::default() };
    let go_on = |_| ControlFlow::Continue(());
    let run = if model.grid.invariant_axis() == Some(2) {
        fdtd.solve_painted(model, &paint(model).unwrap(), &go_on)
    } else {
        fdtd.solve_painted_three(model, &paint3(model).unwrap(), &go_on)
    };
    run.unwrap().0
}

/// A component at a receiver.
pub fn samples(traces: &Traces, receiver: usize, component: Component) -> &[f64] {
    &traces.receivers[receiver].component(component).unwrap().samples
}

/// Ez at a receiver.
pub fn ez(traces: &Traces, receiver: usize) -> &[f64] {
    samples(traces, receiver, Component::Ez)
}

/// What `a` has beyond `b`.
pub fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// The spectrum of a trace at one frequency, time factor `exp(+i w t)`, per time step.
pub fn spectrum(samples: &[f64], dt: f64, frequency: f64) -> Complex64 {
    spectrum_at(samples, dt, Complex64::from(2.0 * PI * frequency))
}

/// The same at a complex angular frequency: an imaginary part below zero damps what is late.
pub fn spectrum_at(samples: &[f64], dt: f64, w: Complex64) -> Complex64 {
    let turn = (-Complex64::i() * w * dt).exp();
    samples.iter().rev().fold(Complex64::ZERO, |sum, value| sum * turn + value)
}

/// `|a - b| / |b|`
pub fn relative_l2(a: &[f64], b: &[f64]) -> f64 {
    let norm = |v: &[f64]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
    norm(&difference(a, b)) / norm(b)
}
