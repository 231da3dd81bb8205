//! What fills the cells and what bounds the grid, beyond the plain dielectric: absent at zero strength, needed where it is
//! there, bounded in the cases that break such solvers.

use std::ops::ControlFlow;

use ballast_gpr::fdtd::{Fdtd, FdtdError, Precision};
use ballast_gpr::model::{
    AbsorbingProfile, Axis, DebyePole, Excitation, Formulation, Grading, Grid, HertzianDipole, Material, Model, Object,
    Receiver, Resonance, Source, Stretch, TimeWindow, Waveform, WaveformKind,
};

/// A block of a material under a dipole along x; 24 x 22 x 26 cells of 2 mm.
fn scene(material: Material, steps: usize) -> Model {
    let grid = Grid { cells: [24, 22, 26], spacing: [0.002; 3] };
    let mut model = Model::new("", grid, TimeWindow::Iterations(steps));
    model.pml_cells = Some([5; 6]);
    model.waveforms.push(Waveform { id: "w".into(), kind: WaveformKind::Ricker, amplitude: 1.0, frequency: 2e9 });
    let position = [0.024, 0.022, 0.034];
    let excitation = Excitation { start: 0.0, stop: None };
    let dipole = HertzianDipole { polarisation: Axis::X, position, waveform: 0, excitation };
    model.sources.push(Source::HertzianDipole(dipole));
    model.receivers.push(Receiver { position: [0.028, 0.026, 0.034], name: None });
    model.receivers.push(Receiver { position: [0.028, 0.026, 0.02], name: None });
    let material = model.add_material(material);
    model.objects.push(Object::Box { lower: [0.0; 3], upper: [0.048, 0.044, 0.026], material, averaging: true });
    model
}

/// The same material in TE across z.
fn transverse(material: Material, steps: usize) -> Model {
    let mut model = scene(material, steps);
    model.grid.cells = [24, 26, 2];
    model.transverse_electric = Some(Axis::Z);
    model.pml_cells = Some([5, 5, 0, 5, 5, 0]);
    *model.sources[0].position_mut() = [0.024, 0.034, 0.002];
    model.receivers[0].position = [0.028, 0.038, 0.002];
    model.receivers[1].position = [0.028, 0.02, 0.002];
    let Object::Box { upper, .. } = &mut model.objects[0] else { panic!("a box") };
    *upper = [0.048, 0.026, 0.004];
    model
}

fn run(model: &Model, precision: Precision) -> Result<Vec<f64>, FdtdError> {
    let fdtd = Fdtd { precision, ..Fdtd::default() };
    let (traces, _) = fdtd.solve_stats(model, &|_| ControlFlow::Continue(()))?;
    Ok(traces.receivers.into_iter().flat_map(|receiver| receiver.components).flat_map(|scan| scan.samples).collect())
}

fn bits(model: &Model) -> Vec<f64> {
    run(model, Precision::Single).unwrap()
}

fn moved(a: &Model, b: &Model) -> f64 {
    let (a, b) = (bits(a), bits(b));
    let difference: f64 = a.iter().zip(&b).map(|(a, b)| (a - b).powi(2)).sum();
    (difference / b.iter().map(|v| v * v).sum::<f64>()).sqrt()
}

fn with(resonances: Vec<Resonance>) -> Material {
    Material { resonances, averagable: false, ..Material::dielectric("stone", 4.0, 0.01) }
}

const LORENTZ: Resonance = Resonance::Lorentz { delta_eps: 2.0, frequency: 3e9, damping: 1e9 };
const DRUDE: Resonance = Resonance::Drude { frequency: 1e9, collisions: 5e9 };

#[test]
fn poles_without_strength_are_absent_to_the_bit() {
    let none = vec![
        Resonance::Lorentz { delta_eps: 0.0, frequency: 3e9, damping: 1e9 },
        Resonance::Drude { frequency: 0.0, collisions: 5e9 },
    ];
    for scene in [scene, transverse] {
        assert_eq!(bits(&scene(with(none.clone()), 150)), bits(&scene(with(vec![]), 150)));
        assert!(moved(&scene(with(vec![LORENTZ]), 500), &scene(with(vec![]), 500)) > 1e-3);
        assert!(moved(&scene(with(vec![DRUDE]), 500), &scene(with(vec![]), 500)) > 1e-3);
    }
}

/// Where all cells hold the same dispersive material there is nothing to average; between two it matters.
#[test]
fn dispersive_averaging_acts_between_materials_only() {
    let averaged = |averaged: bool, whole: bool| {
        let mut model = scene(with(vec![LORENTZ]), 500);
        model.materials[2].averagable = true;
        model.dispersive_averaging = averaged;
        if whole {
            let Object::Box { upper, .. } = &mut model.objects[0] else { panic!("a box") };
            *upper = [0.048, 0.044, 0.052];
        }
        model
    };
    assert_eq!(bits(&averaged(true, true)), bits(&averaged(false, true)));
    assert!(moved(&averaged(true, false), &averaged(false, false)) > 1e-3);
}

/// A plane of TE holds the same fields wherever its invariant axis lies: turned in space, to the bit.
#[test]
fn transverse_models_do_not_depend_on_their_axis() {
    let along_z = transverse(with(vec![DRUDE]), 150);
    let mut along_x = along_z.clone();
    let turned = |[x, y, z]: [f64; 3]| [z, x, y];
    along_x.grid.cells = [2, 24, 26];
    along_x.transverse_electric = Some(Axis::X);
    along_x.pml_cells = Some([0, 5, 5, 0, 5, 5]);
    let position = turned(along_x.sources[0].position());
    *along_x.sources[0].position_mut() = position;
    *along_x.sources[0].polarisation_mut() = Axis::Y;
    along_x.receivers.iter_mut().for_each(|receiver| receiver.position = turned(receiver.position));
    let Object::Box { upper, .. } = &mut along_x.objects[0] else { panic!("a box") };
    *upper = turned(*upper);
    let (z, x) = (bits(&along_z), bits(&along_x));
    let component = |all: &[f64], receiver: usize, field: usize| all[(receiver * 6 + field) * 150..][..150].to_vec();
    for receiver in 0..2 {
        for (of_z, of_x) in [(0, 1), (1, 2), (5, 3)] {
            let (z, x) = (component(&z, receiver, of_z), component(&x, receiver, of_x));
            assert!(z.iter().any(|&v| v != 0.0));
            assert_eq!(z, x);
        }
        for dead in [2, 3, 4] {
            assert!(component(&z, receiver, dead).iter().all(|&v| v == 0.0));
        }
    }
}

/// Poles far faster than the step, strong resonances in the middle of the pulse, hardly
/// damped ones: 10⁴ steps in a closed box stay below the first 500.
#[test]
fn hard_poles_stay_bounded_over_ten_thousand_steps() {
    let stiff = Material {
        poles: vec![DebyePole { delta_eps: 70.0, tau: 1e-16 }, DebyePole { delta_eps: 5.0, tau: 1e-8 }],
        averagable: false,
        ..Material::dielectric("stiff", 3.0, 0.0)
    };
    let lorentz = |delta_eps, frequency, damping| with(vec![Resonance::Lorentz { delta_eps, frequency, damping }]);
    let cases = [
        ("stiff", stiff),
        ("strong", lorentz(10.0, 2e9, 1e8)),
        ("hardly damped", lorentz(1.0, 2e9, 1e3)),
        ("nearly critical", lorentz(3.0, 1e9, 6.28e9)),
        ("plasma", with(vec![Resonance::Drude { frequency: 6e9, collisions: 1e8 }])),
        ("dense plasma", with(vec![Resonance::Drude { frequency: 5e10, collisions: 1e13 }])),
    ];
    for (name, material) in cases {
        for mut model in [scene(material.clone(), 10_000), transverse(material.clone(), 10_000)] {
            // Small, closed and conducting: what is in it stays in it, but may only fade.
            model.pml_cells = Some([0; 6]);
            model.waveforms[0].frequency = 1e9;
            if model.transverse_electric.is_none() {
                model.grid.cells = [15, 14, 18];
                *model.sources[0].position_mut() = [0.014, 0.014, 0.03];
                model.receivers.truncate(1);
                model.receivers[0].position = [0.018, 0.018, 0.03];
                let Object::Box { upper, .. } = &mut model.objects[0] else { panic!("a box") };
                *upper = [0.03, 0.028, 0.026];
            }
            let all = run(&model, Precision::Single).unwrap_or_else(|error| panic!("{name}: {error}"));
            for (field, samples) in all.chunks_exact(10_000).enumerate() {
                let peak = |part: &[f64]| part.iter().fold(0.0f64, |peak, v| peak.max(v.abs()));
                assert!(samples.iter().all(|v| v.is_finite()), "{name}");
                let (early, late) = (peak(&samples[..2_000]), peak(&samples[8_000..]));
                assert!(late <= 1.05 * early, "{name} {field}: {late:e} after {early:e}");
            }
        }
    }
}

#[test]
fn models_that_cannot_be_are_refused_by_name() {
    let message = |change: &dyn Fn(&mut Model), model: Model| {
        let mut model = model;
        change(&mut model);
        run(&model, Precision::Single).unwrap_err().to_string()
    };
    let overdamped = with(vec![Resonance::Lorentz { delta_eps: 1.0, frequency: 1e9, damping: 1e10 }]);
    assert!(
        message(&|_| (), scene(overdamped, 9)).starts_with("`stone` has a Lorentz pole of 1000000000 Hz damped by")
    );
    let fast = with(vec![Resonance::Lorentz { delta_eps: 1.0, frequency: 1e11, damping: 1e10 }]);
    assert!(
        message(&|_| (), scene(fast, 9))
            .starts_with("`stone` has a Lorentz pole of 100000000000 Hz, which turns by 2.4")
    );
    let still = with(vec![Resonance::Drude { frequency: 1e9, collisions: 0.0 }]);
    assert!(message(&|_| (), scene(still, 9)).starts_with("`stone` has a collision rate in 1/s of 0, but at least"));
    let thick = |model: &mut Model| model.grid.cells[2] = 3;
    assert_eq!(
        message(&thick, transverse(with(vec![]), 9)),
        "a TE model across z has two cells along that axis and more than one along the others, but this one has 24 x 26 x 3"
    );
    let along = |model: &mut Model| {
        *model.sources[0].polarisation_mut() = Axis::Z;
    };
    assert_eq!(
        message(&along, transverse(with(vec![]), 9)),
        "source 1 drives a field along z, which a two-dimensional model (TE across z) does not hold"
    );
    let low = |model: &mut Model| {
        model.sources[0].position_mut()[2] = 0.0;
    };
    assert!(message(&low, transverse(with(vec![]), 9)).starts_with("source 1 lies at node 0 along z, but the fields"));
}

fn stretched(model: &Model, formulation: Formulation, stretches: Vec<Stretch>) -> Model {
    Model { absorbing_profile: AbsorbingProfile { formulation, stretches }, ..model.clone() }
}

/// The default written out, and in the other formulation, is the default; alpha, kappa and a second stretch matter.
#[test]
fn a_stretch_that_does_nothing_is_absent_to_the_bit() {
    let base = Stretch::default();
    let more = [
        ("alpha", vec![Stretch { alpha: Grading::constant(0.05), ..base }]),
        ("kappa", vec![Stretch { kappa: Grading { order: 2, reverse: false, min: 1.0, max: Some(4.0) }, ..base }]),
    ];
    for model in [scene(with(vec![]), 500), transverse(with(vec![]), 500)] {
        let plain = bits(&model);
        assert_eq!(bits(&stretched(&model, Formulation::Recursive, vec![base])), plain);
        assert_eq!(bits(&stretched(&model, Formulation::Multipole, vec![base])), plain);
        for (name, stretches) in &more {
            let moved = moved(&stretched(&model, Formulation::Recursive, stretches.clone()), &model);
            assert!(moved > 1e-4, "{name} moves the trace by {moved:e}");
        }
        // A factor, and a term, that stretches nothing: the same sums, once more rounded.
        let nothing = |kappa| Stretch { kappa: Grading::constant(kappa), sigma: Grading::constant(0.0), ..base };
        for (formulation, kappa) in [(Formulation::Recursive, 1.0), (Formulation::Multipole, 0.0)] {
            let model = stretched(&model, formulation, vec![base, nothing(kappa)]);
            let (found, wanted) = (run(&model, Precision::Double).unwrap(), run(&transform(&model), Precision::Double));
            let worst = found.iter().zip(wanted.unwrap()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            let peak = found.iter().fold(0.0f64, |peak, v| peak.max(v.abs()));
            assert!(worst < 1e-12 * peak, "{formulation:?}: {worst:e} of {peak:e}");
        }
    }
}

/// The model with the default boundary.
fn transform(model: &Model) -> Model {
    stretched(model, Formulation::Recursive, vec![])
}

/// Boundaries of every kind through a conductor and a relaxing block: 10⁴ steps fade.
#[test]
fn boundaries_stay_bounded_over_ten_thousand_steps() {
    let growing = |order, max| Grading { order, reverse: false, min: 0.0, max: Some(max) };
    let base = Stretch::default();
    let first = Stretch { sigma: growing(4, 0.5), ..base };
    let second = Stretch { alpha: growing(4, 0.55), sigma: growing(4, 1.0), ..base };
    let third = Stretch { kappa: Grading::constant(0.0), alpha: growing(1, 0.05), sigma: growing(3, 2.0) };
    for (formulation, stretches) in [
        (Formulation::Recursive, vec![Stretch { kappa: Grading::constant(2.0), ..base }]),
        (Formulation::Recursive, vec![first, second]),
        (Formulation::Multipole, vec![first, third]),
    ] {
        let wet = Material { poles: vec![DebyePole { delta_eps: 9.0, tau: 2e-11 }], ..with(vec![]) };
        let model = transverse(wet, 10_000);
        let all = run(&stretched(&model, formulation, stretches), Precision::Single).unwrap();
        for samples in all.chunks_exact(10_000) {
            let peak = |part: &[f64]| part.iter().fold(0.0f64, |peak, v| peak.max(v.abs()));
            let (early, late) = (peak(&samples[..1_000]), peak(&samples[9_000..]));
            assert!(late <= 1e-3 * early, "{formulation:?}: {late:e} after {early:e}");
        }
    }
}
