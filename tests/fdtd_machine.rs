//! The same bits on every machine, and errors that name what they are about.

mod fdtd_support;

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use ballast_gpr::fdtd::{Fdtd, FdtdError, InstructionSet, Precision, Stepping, predict, reach};
use ballast_gpr::forward::{Forward, ForwardError};
use ballast_gpr::model::{
    Axis, DebyePole, Material, MaterialId, Model, Object, Receiver, Resonance, Source, paint, paint3,
};
use ballast_gpr::trace::{Component, Traces};
use ballast_gpr::units::constants::MU_0;
use fdtd_support::{box_of, fdtd, run, scene};

/// All effects at once: conduction, two Debye materials, a conductor, averaging, the absorbing boundary.
fn everything(steps: usize) -> Model {
    let mut model = scene([281, 263], 0.002, steps, [140, 200], &[[170, 200], [140, 60], [69, 100], [70, 100]]);
    let soil = model.add_material(Material::dielectric("soil", 4.0, 0.01));
    let relaxing = |id: &str, poles: usize| {
        let mut material = Material::dielectric(id, 3.0, 0.002);
        material.poles = (0..poles).map(|p| DebyePole { delta_eps: 3.0, tau: 1e-11 * (p + 1) as f64 }).collect();
        material.averagable = false;
        material
    };
    let (one, three) = (model.add_material(relaxing("one", 1)), model.add_material(relaxing("three", 3)));
    model.objects.push(box_of(&model, [0, 0, 281, 150], soil, true));
    model.objects.push(box_of(&model, [60, 60, 200, 100], one, true));
    model.objects.push(box_of(&model, [0, 20, 281, 40], three, true));
    let (start, end) = ([0.2, 0.2, 0.0], [0.2, 0.2, 0.002]);
    model.objects.push(Object::Cylinder { start, end, radius: 0.03, material: MaterialId::PEC, averaging: true });
    model
}

fn bits(traces: &Traces) -> Vec<u64> {
    let receivers = traces.receivers.iter().flat_map(|receiver| &receiver.components);
    receivers.flat_map(|trace| trace.samples.iter().map(|v| v.to_bits())).collect()
}

#[test]
fn bits_do_not_depend_on_threads_or_instructions() {
    let model = everything(400);
    for precision in [Precision::Single, Precision::Double] {
        let reference = bits(&run(&fdtd(precision, 1, InstructionSet::Scalar), &model).unwrap());
        for set in [InstructionSet::Auto, InstructionSet::Scalar, InstructionSet::Avx2, InstructionSet::Avx512] {
            for threads in [1, 2, 4] {
                match run(&fdtd(precision, threads, set), &model) {
                    Ok(traces) => assert!(bits(&traces) == reference, "{precision:?} {set:?} {threads}"),
                    Err(FdtdError::NoSuchInstructions { .. }) => eprintln!("NOT TESTED: this machine has no {set:?}"),
                    Err(other) => panic!("{other}"),
                }
            }
        }
    }
}

/// The order of the steps and what is left out show nowhere: a window so short that both light cones cut deep, blocks for
/// three threads.
#[test]
fn bits_do_not_depend_on_the_order_of_steps() {
    let mut model = everything(250);
    model.sources.push(model.sources[0].clone());
    let Source::HertzianDipole(second) = &mut model.sources[1] else { panic!("a current") };
    (second.position, second.excitation.start) = ([0.1, 0.46, 0.0], 4e-10);
    let painted = paint(&model).unwrap();
    assert!((0.3..0.9).contains(&reach(&model, &painted).unwrap().share_saved));
    for precision in [Precision::Single, Precision::Double] {
        let with = |threads, steps_per_pass, skip| {
            let solver = fdtd(precision, threads, InstructionSet::Auto);
            let stepping = Stepping { steps_per_pass: NonZeroUsize::new(steps_per_pass), skip };
            bits(&solver.solve_stepping(&model, &painted, stepping, &|_| ControlFlow::Continue(())).unwrap().0)
        };
        let reference = with(1, 1, false);
        for (threads, steps_per_pass) in [(1, 1), (1, 8), (1, 500), (2, 3), (3, 16)] {
            for skip in [false, true] {
                assert!(with(threads, steps_per_pass, skip) == reference, "{threads} {steps_per_pass} {skip}");
            }
        }
    }
}

/// Names, positions and times as gprMax writes them: `Rx(i,j,k)`, E from 0, H from -dt/2, unused components zero.
#[test]
fn traces_are_laid_out_as_gprmax_lays_them_out() {
    let mut model = scene([40, 40], 0.002, 300, [20, 20], &[[25, 22], [30, 20]]);
    model.receivers[0].position[0] += 0.0007;
    model.receivers[1].name = Some("antenna".into());
    let traces = Fdtd::default().solve(&model, &|_| ControlFlow::Continue(())).unwrap();
    assert_eq!(traces.iterations, 300);
    assert_eq!((traces.receivers[0].name.as_str(), traces.receivers[1].name.as_str()), ("Rx(25,22,0)", "antenna"));
    assert_eq!(traces.receivers[0].position.map(|p| p.si()), [25.0 * 0.002, 22.0 * 0.002, 0.0]);
    for trace in &traces.receivers[0].components {
        let shift = if trace.component.is_magnetic() { -0.5 * traces.time_step.si() } else { 0.0 };
        assert_eq!((trace.first_sample.si(), trace.samples.len()), (shift, 300));
        let dead = matches!(trace.component, Component::Ex | Component::Ey | Component::Hz);
        assert_eq!(trace.peak() == 0.0, dead, "{:?}", trace.component);
    }
}

/// H is in A/m and half a step before E: `mu0 (Hy' - Hy)/dt = (Ez_{i+1} - Ez_i)/dx`, `mu0 (Hx' - Hx)/dt = -(Ez_{j+1} - Ez_j)/dy`
/// between the traces of neighbouring receivers. Tolerance: rounding of 300 steps in double precision.
#[test]
fn traces_fulfil_faradays_law() {
    let mut model = scene([40, 40], 0.002, 300, [20, 20], &[]);
    model.grid.spacing = [0.002, 0.003, 0.004];
    let node = |i: usize, j: usize| [i as f64 * 0.002, j as f64 * 0.003, 0.0];
    let receiver = |position| Receiver { position, name: None };
    let Source::HertzianDipole(dipole) = &mut model.sources[0] else { panic!("a current") };
    dipole.position = node(20, 20);
    model.receivers = vec![receiver(node(24, 23)), receiver(node(25, 23)), receiver(node(24, 24))];
    let traces = run(&fdtd(Precision::Double, 1, InstructionSet::Auto), &model).unwrap();
    let of = |receiver: usize, component| &traces.receivers[receiver].component(component).unwrap().samples;
    let (ez, ez_east, ez_north) = (of(0, Component::Ez), of(1, Component::Ez), of(2, Component::Ez));
    let scale = MU_0 / traces.time_step.si();
    for n in 0..299 {
        let rise = |component| of(0, component)[n + 1] - of(0, component)[n];
        let (east, north) = ((ez_east[n] - ez[n]) / 0.002, (ez_north[n] - ez[n]) / 0.003);
        assert!((scale * rise(Component::Hy) - east).abs() < 1e-9 * traces.receivers[0].components[2].peak() / 0.002);
        assert!((scale * rise(Component::Hx) + north).abs() < 1e-9 * traces.receivers[0].components[2].peak() / 0.002);
    }
}

#[test]
fn what_cannot_be_done_is_named() {
    let base = || scene([60, 60], 0.002, 10, [30, 30], &[[35, 30]]);
    let dipole = |model: &mut Model, position: [f64; 3]| {
        let Source::HertzianDipole(dipole) = &mut model.sources[0] else { panic!("a current") };
        dipole.position = position;
    };
    let message = |change: &dyn Fn(&mut Model)| {
        let mut model = base();
        change(&mut model);
        run(&Fdtd::default(), &model).unwrap_err().to_string()
    };
    let with = |material: Material| {
        move |model: &mut Model| {
            let id = model.add_material(material.clone());
            model.objects.push(box_of(model, [0, 0, 20, 20], id, true));
        }
    };
    let magnetic = Material { mu_r: 2.0, ..Material::dielectric("iron_ore", 5.0, 0.0) };
    let many =
        Material { poles: vec![DebyePole { delta_eps: 1.0, tau: 1e-11 }; 4], ..Material::dielectric("soup", 5.0, 0.0) };
    let lorentz = Resonance::Lorentz { delta_eps: 1.0, frequency: 1e9, damping: 1e8 };
    let ringing = Material { resonances: vec![lorentz], ..Material::dielectric("bell", 5.0, 0.0) };
    let thin = Material::dielectric("thin", 0.5, 0.0);
    let fast =
        Material { poles: vec![DebyePole { delta_eps: 1.0, tau: 0.0 }], ..Material::dielectric("fast", 5.0, 0.0) };
    for (begin, found) in [
        (
            "source 1 lies outside the grid: x = 0.5 m, but the grid ends at 0.12 m",
            message(&|m| dipole(m, [0.5, 0.06, 0.0])),
        ),
        ("source 1 lies on the outer wall, at node (0, 30)", message(&|m| dipole(m, [0.0, 0.06, 0.0]))),
        ("receiver 1 lies outside the grid: y = -0.5 m", message(&|m| m.receivers[0].position[1] = -0.5)),
        (
            "source 1 is polarised along x",
            message(&|m| {
                let Source::HertzianDipole(dipole) = &mut m.sources[0] else { panic!("a current") };
                dipole.polarisation = Axis::X;
            }),
        ),
        (
            "source 1 lies in a perfect conductor, at node (30, 30)",
            message(&|m| {
                m.objects.push(box_of(m, [29, 29, 32, 32], MaterialId::PEC, true));
            }),
        ),
        ("`thin` has a relative permittivity of 0.5, but at least 1 is needed", message(&with(thin))),
        ("`fast` has a relaxation time in s of 0, but at least", message(&with(fast))),
        (
            "30 and 30 absorbing cells leave nothing of the 60 cells along x",
            message(&|m| m.pml_cells = Some([30, 0, 0, 30, 0, 0])),
        ),
        (
            "1 and 0 absorbing cells leave nothing of the 1 cells along z",
            message(&|m| m.pml_cells = Some([0, 0, 1, 0, 0, 0])),
        ),
        ("a grid of 60 x 1 x 1 cells of", message(&|m| m.grid.cells = [60, 1, 1])),
        (
            "10 and 10 absorbing cells leave nothing of the 4 cells along z",
            message(&|m| {
                (m.grid.cells, m.pml_cells) = ([60, 60, 4], None);
            }),
        ),
        ("cells of 2 mm are too coarse for this scene", message(&with(Material::dielectric("mud", 400.0, 0.0)))),
        ("the model needs", message(&|m| m.grid.cells = [4_000_000, 4_000_000, 1])),
    ] {
        assert!(found.starts_with(begin), "expected `{begin}…`, found `{found}`");
    }
    // The loops for the plane do not know magnetic materials and many poles, and say so to who insists.
    for (material, begin) in [
        (magnetic, "`iron_ore` is magnetic (mu_r 2, magnetic loss 0 ohm/m)"),
        (many, "`soup` has 4 Debye poles, at most 3 are known"),
        (ringing, "`bell` has a Lorentz pole, which the loops for two dimensions do not know"),
    ] {
        let mut model = base();
        with(material)(&mut model);
        assert!(!model.is_plane());
        let found = Fdtd::default().solve_painted(&model, &paint(&model).unwrap(), &|_| ControlFlow::Continue(()));
        let found = found.unwrap_err().to_string();
        assert!(found.starts_with(begin), "{found}");
    }
}

/// A model along z may take the way of three dimensions, one cell thick, too: the same sums in another order, so that traces
/// differ by rounding only (1e-16 over 400 steps).
#[test]
fn both_ways_agree_on_a_plane() {
    let model = everything(400);
    assert!(model.is_plane());
    let fdtd = fdtd(Precision::Double, 1, InstructionSet::Auto);
    let plane = run(&fdtd, &model).unwrap();
    let painted = paint3(&model).unwrap();
    let (space, _) = fdtd.solve_painted_three(&model, &painted, &|_| ControlFlow::Continue(())).unwrap();
    for (a, b) in plane.receivers.iter().zip(&space.receivers) {
        for (a, b) in a.components.iter().zip(&b.components) {
            let worst = a.samples.iter().zip(&b.samples).fold(0.0f64, |worst, (a, b)| worst.max((a - b).abs()));
            assert!(worst <= 1e-12 * a.peak(), "{} {}: {worst:e} of {:e}", a.name, a.component.name(), a.peak());
        }
    }
}

/// `Break` ends the run soon, in whatever thread; the calls count upwards.
#[test]
fn a_run_stops_on_request() {
    let model = everything(1_000_000);
    let calls = AtomicUsize::new(0);
    let result = fdtd(Precision::Single, 2, InstructionSet::Auto).solve(&model, &|progress| {
        assert_eq!(progress.total, 1_000_000);
        if calls.fetch_add(1, Ordering::Relaxed) == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert!(matches!(result, Err(ForwardError::Stopped)));
    assert_eq!(calls.load(Ordering::Relaxed), 3);
}

/// Memory and work are known beforehand; the time is of the right order (a busy machine allows no more).
#[test]
fn the_cost_is_predicted() {
    let model = everything(300);
    let painted = paint(&model).unwrap();
    let solver = fdtd(Precision::Single, 1, InstructionSet::Auto);
    let predicted = predict(&model, &painted, solver.threads).unwrap();
    let (_, stats) = solver.solve_painted(&model, &painted, &|_| ControlFlow::Continue(())).unwrap();
    assert_eq!((predicted.bytes, predicted.cell_steps), (stats.bytes, stats.cell_steps));
    let ratio = predicted.seconds / stats.wall.si();
    assert!((0.1..10.0).contains(&ratio), "predicted {} s, took {} s", predicted.seconds, stats.wall.si());
}
