//! What a model does not call for is absent: at zero strength the bits are those without it, and it matters when needed.

mod fdtd_support;

use std::ops::ControlFlow;

use ballast_gpr::fdtd::{Fdtd, Precision};
use ballast_gpr::model::{
    Axis, DebyePole, Excitation, Grid, HertzianDipole, MagneticDipole, Material, MaterialId, Model, Receiver, Source,
    TimeWindow, VoltageSource, Waveform, WaveformKind, paint3,
};
use fdtd_support::{box_of, ez, relative_l2, scene, solve};

/// A stone in air under a source, 120 x 100 cells of 2 mm, 600 steps.
fn stone(material: Material, averaging: bool) -> Model {
    let mut model = scene([120, 100], 0.002, 600, [60, 70], &[[75, 70]]);
    let id = model.add_material(material);
    model.objects.push(box_of(&model, [30, 20, 90, 50], id, averaging));
    model
}

fn trace(model: &Model) -> Vec<f64> {
    ez(&solve(model, Precision::Single), 0).to_vec()
}

/// An edge that conducts a little elsewhere turns the array `ca` on; nodes with `ca = 1` keep their bits.
#[test]
fn zero_conductivity_is_absent_to_the_bit() {
    let mut model = stone(Material::dielectric("stone", 6.0, 0.0), true);
    // Conducts inside a conductor's box, where its edges are never reached by a field: E is zero all around them.
    let hidden = model.add_material(Material::dielectric("hidden", 6.0, 1.0));
    let conductor = |model: &mut Model| {
        model.objects.push(box_of(model, [2, 2, 9, 9], MaterialId::PEC, true));
    };
    let mut reference = stone(Material::dielectric("stone", 6.0, 0.0), true);
    conductor(&mut reference);
    conductor(&mut model);
    model.objects.push(box_of(&model, [4, 4, 7, 7], hidden, true));
    assert_eq!(trace(&reference), trace(&model));
}

/// A pole without strength is dropped when the coefficients are made, so no memory and no loop is left of it.
#[test]
fn a_pole_without_strength_is_absent_to_the_bit() {
    let mut plain = Material::dielectric("stone", 6.0, 0.003);
    plain.averagable = false;
    let mut with_pole = plain.clone();
    with_pole.poles.push(DebyePole { delta_eps: 0.0, tau: 9e-12 });
    assert_eq!(trace(&stone(plain, true)), trace(&stone(with_pole, true)));
}

/// In a medium that is the same everywhere there is nothing to average.
#[test]
fn averaging_in_an_even_medium_is_absent_to_the_bit() {
    let even = |averaging| {
        let mut model = scene([120, 100], 0.002, 600, [60, 70], &[[75, 70]]);
        let id = model.add_material(Material::dielectric("soil", 6.0, 0.003));
        model.objects.push(box_of(&model, [0, 0, 120, 100], id, averaging));
        trace(&model)
    };
    assert_eq!(even(true), even(false));
}

/// No absorbing cells: neither arrays nor loops; a run too short for the wave to come back from the walls is the same.
#[test]
fn the_absorbing_boundary_acts_only_where_it_lies() {
    // 60 cells to the nearest wall and back are 120 cells at 0.71 cells per step: 169 steps.
    let run = |pml| {
        let mut model = scene([160, 160], 0.002, 120, [80, 80], &[[85, 80]]);
        model.pml_cells = Some(pml);
        trace(&model)
    };
    assert_eq!(run([0; 6]), run([10, 10, 0, 10, 10, 0]));
}

/// Each effect moves the trace by far more than the tolerance of any comparison (2e-5 in single precision).
#[test]
fn effects_that_are_needed_matter() {
    let plain = Material::dielectric("stone", 6.0, 0.0);
    let reference = trace(&stone(plain.clone(), true));
    let lossy = Material { sigma: 0.02, ..plain.clone() };
    let poles = vec![DebyePole { delta_eps: 6.0, tau: 2e-11 }];
    let wet = Material { poles, averagable: false, ..plain.clone() };
    let mut open = stone(plain.clone(), true);
    open.pml_cells = Some([0; 6]);
    for (effect, moved) in [
        ("conductivity", relative_l2(&trace(&stone(lossy, true)), &reference)),
        (
            "dispersion",
            relative_l2(
                &trace(&stone(wet, true)),
                &trace(&stone(Material { averagable: false, ..plain.clone() }, true)),
            ),
        ),
        ("averaging", relative_l2(&trace(&stone(plain, false)), &reference)),
        ("absorbing boundary", relative_l2(&trace(&open), &reference)),
    ] {
        assert!(moved > 1e-3, "{effect} moves the trace by {moved:e} only");
    }
}

/// Traces of the same model in space, to the bit.
fn in_space(model: &Model) -> Vec<u64> {
    let fdtd = Fdtd { precision: Precision::Single, ..Fdtd::default() };
    let (traces, _) = fdtd.solve_painted_three(model, &paint3(model).unwrap(), &|_| ControlFlow::Continue(())).unwrap();
    let receivers = traces.receivers.iter().flat_map(|receiver| &receiver.components);
    receivers.flat_map(|trace| trace.samples.iter().map(|v| v.to_bits())).collect()
}

/// A magnetic dipole without amplitude, and a voltage behind 1e300 ohm, change no bit; one volt behind 50 ohm does.
#[test]
fn sources_without_strength_are_absent_to_the_bit() {
    let grid = Grid { cells: [24, 25, 26], spacing: [0.002; 3] };
    let mut model = Model::new("", grid, TimeWindow::Iterations(120));
    model.pml_cells = Some([5; 6]);
    let pulse =
        |amplitude| Waveform { id: format!("{amplitude}"), kind: WaveformKind::Ricker, amplitude, frequency: 5e9 };
    model.waveforms = vec![pulse(1.0), pulse(0.0)];
    let (excitation, position) = (Excitation { start: 0.0, stop: None }, [0.024, 0.026, 0.024]);
    let dipole = HertzianDipole { polarisation: Axis::Y, position, waveform: 0, excitation };
    model.sources.push(Source::HertzianDipole(dipole));
    model.receivers.push(Receiver { position: [0.02, 0.028, 0.026], name: None });
    let without = in_space(&model);
    let with = |source: Source| {
        let mut model = model.clone();
        model.sources.push(source);
        in_space(&model)
    };
    let (polarisation, position) = (Axis::X, [0.022, 0.026, 0.026]);
    let magnetic = MagneticDipole { polarisation, position, waveform: 1, excitation };
    assert!(with(Source::MagneticDipole(magnetic)) == without);
    let voltage = |resistance, waveform| {
        Source::VoltageSource(VoltageSource { polarisation, position, resistance, waveform, excitation })
    };
    assert!(with(voltage(1e300, 1)) == without);
    assert!(with(voltage(50.0, 0)) != without);
    // A voltage of zero that is on is a short circuit, and a resistor without a voltage takes its share.
    assert!(with(voltage(0.0, 1)) != without && with(voltage(50.0, 1)) != without);
}
