//! The embedded solver in three dimensions as a machine: the same bits everywhere, errors that name things, its cost.

use std::fs;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Mutex;
use std::time::Duration;

use ballast_gpr::fdtd::{
    CheckpointEvent, Checkpoints, Fdtd, FdtdError, InstructionSet, Keeping, Precision, predict_three,
};
use ballast_gpr::model::{
    Averaging, Axis, DebyePole, Excitation, Grid, HertzianDipole, Material, MaterialId, Model, Object, Painted3,
    Receiver, Source, TimeWindow, Waveform, WaveformKind, paint3,
};
use ballast_gpr::trace::Traces;

/// Everything at once: averaged and claimed edges, conductivity, poles, conductors, magnetic stone, uneven absorbing cells,
/// oblong cells, three dipoles.
fn everything(materials: usize) -> Model {
    let grid = Grid { cells: [31, 33, 37], spacing: [0.002, 0.0025, 0.003] };
    let mut model = Model::new("everything", grid, TimeWindow::Iterations(150));
    model.pml_cells = Some([3, 2, 5, 4, 0, 6]);
    model.waveforms.push(Waveform { id: "w".into(), kind: WaveformKind::Ricker, amplitude: 1.0, frequency: 2e9 });
    let mut wet = Material::dielectric("wet", 4.0, 0.01);
    wet.poles = vec![DebyePole { delta_eps: 3.0, tau: 9e-12 }, DebyePole { delta_eps: 1.0, tau: 9e-11 }];
    wet.averagable = false;
    let wet = model.add_material(wet);
    let ore = model.add_material(Material { mu_r: 1.5, ..Material::dielectric("ore", 3.0, 0.0) });
    let whole = [31.0 * 0.002, 33.0 * 0.0025, 0.03];
    model.objects.push(Object::Box { lower: [0.0; 3], upper: whole, material: wet, averaging: true });
    for k in 0..materials {
        let stone = Material::dielectric(format!("stone{k}"), 4.0 + 0.3 * k as f64, 1e-3 * k as f64);
        let material = model.add_material(stone);
        let place = |factor: f64, size: f64| (k as f64 * factor).fract() * size;
        let centre = [place(0.618, 0.062), place(0.755, 0.0825), place(0.57, 0.1)];
        model.objects.push(Object::Sphere { centre, radius: 0.0121, material, averaging: k % 3 > 0 });
    }
    let sphere = |centre, radius, material| Object::Sphere { centre, radius, material, averaging: true };
    model.objects.push(sphere([0.02, 0.03, 0.07], 0.009, MaterialId::PEC));
    model.objects.push(sphere([0.05, 0.05, 0.06], 0.011, ore));
    let excitation = Excitation { start: 0.0, stop: None };
    for (polarisation, i) in [(Axis::X, 6.0), (Axis::Y, 13.0), (Axis::Z, 25.0)] {
        let position = [i * 0.002, 0.04, 0.09];
        let dipole = HertzianDipole { polarisation, position, waveform: 0, excitation };
        model.sources.push(Source::HertzianDipole(dipole));
    }
    for i in 0..=31 {
        let position = [f64::from(i) * 0.002, f64::from(i) * 0.0025, f64::from(i) * 0.003];
        model.receivers.push(Receiver { position, name: None });
    }
    model
}

fn solve(model: &Model, precision: Precision, threads: usize, instruction_set: InstructionSet) -> Traces {
    let fdtd = Fdtd { precision, threads: NonZeroUsize::new(threads), instruction_set };
    let (traces, stats) = fdtd.solve_stats(model, &|_| ControlFlow::Continue(())).unwrap();
    assert_eq!(stats.threads, threads);
    traces
}

/// 1, 2 and 4 threads and every instruction set that the machine has, with coefficients looked up and stored.
#[test]
fn bits_do_not_depend_on_the_machine() {
    for materials in [3, 9] {
        let model = everything(materials);
        let entries = paint3(&model).unwrap().palette.len();
        assert_eq!(entries > 32, materials == 9, "{entries}");
        for precision in [Precision::Single, Precision::Double] {
            let plain = solve(&model, precision, 1, InstructionSet::Scalar);
            let reached = plain.receivers.iter().filter(|receiver| receiver.components.iter().any(|t| t.peak() > 0.0));
            assert!(reached.count() >= 30);
            for threads in [2, 4] {
                assert!(solve(&model, precision, threads, InstructionSet::Scalar) == plain, "{threads} threads");
            }
            let mut sets = 0;
            for set in [InstructionSet::Auto, InstructionSet::Avx2, InstructionSet::Avx512] {
                let fdtd = Fdtd { precision, threads: NonZeroUsize::new(1), instruction_set: set };
                if let Ok((traces, _)) = fdtd.solve_stats(&model, &|_| ControlFlow::Continue(())) {
                    assert!(traces == plain, "{}", set.name());
                    sets += 1;
                }
            }
            assert!(sets > 0);
        }
    }
}

/// Axes that are coupled on surfaces: neither threads and instructions nor what no wave has reached change a bit; on flat
/// faces nothing is coupled, and only the time step is another one.
#[test]
fn coupled_axes_keep_their_bits() {
    let mut model = everything(5);
    model.averaging = Averaging::Tensors;
    let painted = paint3(&model).unwrap();
    assert!(painted.couplings.len() > 1000, "{}", painted.couplings.len());
    for precision in [Precision::Single, Precision::Double] {
        let fdtd = Fdtd { precision, ..Fdtd::default() };
        let run = |skip| fdtd.solve_stepping_three(&model, &painted, skip, &|_| ControlFlow::Continue(())).unwrap().0;
        let plain = run(false);
        assert!(run(true) == plain);
        for threads in [1, 2, 4] {
            assert!(solve(&model, precision, threads, InstructionSet::Scalar) == plain, "{threads} threads");
        }
    }
    let uncoupled = Painted3 { couplings: vec![], ..painted.clone() };
    let without = |painted: &Painted3| {
        Fdtd::default().solve_painted_three(&model, painted, &|_| ControlFlow::Continue(())).unwrap().0
    };
    assert!(without(&uncoupled) != without(&painted));
    model.objects.retain(|object| matches!(object, Object::Box { .. }));
    let flat = paint3(&model).unwrap();
    assert!(flat.couplings.is_empty());
    model.averaging = Averaging::Shapes;
    assert!(paint3(&model).unwrap() == flat);
}

/// A Debye pole without strength and a magnetic material like free space cost nothing and change no bit.
#[test]
fn effects_of_no_strength_change_no_bit() {
    let mut model = everything(3);
    let air = model.add_material(Material::dielectric("air", 1.0, 0.0));
    let upper = [0.02, 0.02, 0.02];
    model.objects.push(Object::Box { lower: [0.0; 3], upper, material: air, averaging: false });
    let without = solve(&model, Precision::Single, 1, InstructionSet::Auto);
    model.materials[air.index()].poles = vec![DebyePole { delta_eps: 0.0, tau: 1e-11 }];
    assert!(solve(&model, Precision::Single, 1, InstructionSet::Auto) == without);
    model.materials[air.index()].poles[0].delta_eps = 0.5;
    assert!(solve(&model, Precision::Single, 1, InstructionSet::Auto) != without);
}

/// Each message begins with what is wrong, and with what.
#[test]
fn errors_name_what_is_wrong() {
    let message = |change: &dyn Fn(&mut Model)| {
        let mut model = everything(3);
        change(&mut model);
        let run = Fdtd::default().solve_stats(&model, &|_| ControlFlow::Continue(()));
        run.map_or_else(|error| error.to_string(), |_| "no error".into())
    };
    let dipole = |model: &mut Model, place: [f64; 3]| {
        let Source::HertzianDipole(dipole) = &mut model.sources[2] else { panic!("a current") };
        dipole.position = place;
    };
    for (begin, found) in [
        (
            "source 3, along z, lies on the outer wall, at node (0, 16, 30), where E stays zero",
            message(&|m| dipole(m, [0.0, 0.04, 0.09])),
        ),
        (
            "source 3, along z, lies on the outer wall, at node (25, 16, 37)",
            message(&|m| dipole(m, [0.05, 0.04, 0.111])),
        ),
        ("source 3 lies in a perfect conductor, at node (10, 12, 23)", message(&|m| dipole(m, [0.02, 0.03, 0.069]))),
        ("source 3 lies outside the grid: z = 1 m", message(&|m| dipole(m, [0.05, 0.04, 1.0]))),
        ("a grid of 31 x 1 x 1 cells", message(&|m| m.grid.cells = [31, 1, 1])),
        ("cells of 3 mm are too coarse", message(&|m| m.materials[2].eps_r = 900.0)),
        ("the model needs", message(&|m| m.grid.cells = [100_000, 100_000, 1000])),
        ("31 and 4 absorbing cells leave nothing", message(&|m| m.pml_cells = Some([31, 2, 5, 4, 0, 6]))),
    ] {
        assert!(found.starts_with(begin), "expected `{begin}…`, found `{found}`");
    }
}

/// `Break` ends the run soon.
#[test]
fn a_run_stops_on_request() {
    let mut model = everything(3);
    model.time_window = TimeWindow::Iterations(50_000);
    let run = Fdtd::default().solve_stats(&model, &|progress| {
        if progress.done > 20 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert_eq!(run.unwrap_err().to_string(), "stopped on request");
}

/// Memory and work are known beforehand; the time is of the right order (a busy machine allows no more).
#[test]
fn the_cost_is_predicted() {
    let mut model = everything(3);
    model.time_window = TimeWindow::Iterations(400);
    let painted = paint3(&model).unwrap();
    let fdtd = Fdtd { threads: NonZeroUsize::new(1), ..Fdtd::default() };
    let predicted = predict_three(&model, &painted, fdtd.threads).unwrap();
    let (_, stats) = fdtd.solve_painted_three(&model, &painted, &|_| ControlFlow::Continue(())).unwrap();
    assert_eq!((predicted.bytes, predicted.cell_steps), (stats.bytes, stats.cell_steps));
    let ratio = predicted.seconds / stats.wall.si();
    assert!((0.1..10.0).contains(&ratio), "predicted {} s, took {} s", predicted.seconds, stats.wall.si());
}

/// Runs a model with checkpoints at `path` after every few steps; `stop`: asks it to stop at once. What was told comes too.
fn solve_kept(
    model: &Model,
    precision: Precision,
    threads: usize,
    path: &Path,
    stop: bool,
) -> (Result<Traces, FdtdError>, Vec<[usize; 2]>) {
    let events = Mutex::new(vec![]);
    let tell = |event: CheckpointEvent<'_>| {
        events.lock().unwrap().push(match event {
            CheckpointEvent::Resumed { step, .. } => [0, step],
            CheckpointEvent::Written { step, iterations, bytes, .. } => {
                assert!(iterations == 150 && bytes > 1_000_000);
                [1, step]
            }
            CheckpointEvent::Failed { error } => panic!("{error}"),
        });
    };
    let every = if stop { Duration::MAX } else { Duration::ZERO };
    let every = every.min(Duration::from_secs(3600));
    let (path, stop_after) = (path.to_path_buf(), Duration::ZERO);
    let checkpoints = Checkpoints { path, every, stop_after, go_on: true, tell: &tell };
    let fdtd = Fdtd { precision, threads: NonZeroUsize::new(threads), ..Fdtd::default() };
    let flow = if stop { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let run = fdtd.solve_kept(model, Keeping { checkpoints: Some(&checkpoints), snapshots: None }, &|_| flow);
    (run.map(|(traces, _)| traces), events.into_inner().unwrap())
}

/// Stopped every few steps and gone on with another number of threads each time, in either precision, every effect present:
/// the same bits as in one go. A run that only writes checkpoints has the same bits, too.
#[test]
fn a_run_goes_on_from_its_checkpoint_to_the_same_bits() {
    let model = everything(3);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.checkpoint");
    for precision in [Precision::Single, Precision::Double] {
        let plain = solve(&model, precision, 2, InstructionSet::Auto);
        let (mut rounds, mut at) = (0, 0);
        let traces = loop {
            let threads = [1, 4, 2][rounds % 3];
            let (run, events) = solve_kept(&model, precision, threads, &path, true);
            if at > 0 {
                assert_eq!(events[0], [0, at]);
            }
            match run {
                Ok(traces) => break traces,
                Err(FdtdError::Stopped) => {
                    let [written, step] = *events.last().unwrap();
                    assert!(written == 1 && step > at && step - at <= 32, "from {at} to {step}");
                    (rounds, at) = (rounds + 1, step);
                }
                Err(error) => panic!("{error}"),
            }
        };
        assert!(rounds >= 10 && traces == plain, "{rounds} rounds");
        fs::remove_file(&path).unwrap();
        let (traces, events) = solve_kept(&model, precision, 2, &path, false);
        assert!(events.len() > 10 && traces.unwrap() == plain);
        fs::remove_file(&path).unwrap();
    }
}

/// A checkpoint of something else, or a damaged one, is refused by name; none is passed off.
#[test]
fn a_foreign_or_damaged_checkpoint_is_refused() {
    let model = everything(3);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.checkpoint");
    assert!(matches!(solve_kept(&model, Precision::Single, 1, &path, true).0, Err(FdtdError::Stopped)));
    let whole = fs::read(&path).unwrap();
    let refused = |model: &Model, precision| {
        let message = solve_kept(model, precision, 1, &path, true).0.unwrap_err().to_string();
        message.replace(&path.display().to_string(), "P")
    };
    let mut other = model.clone();
    other.sources.pop();
    let message = refused(&other, Precision::Single);
    assert!(message.starts_with("the checkpoint `P` has another model: "), "{message}");
    assert!(message.ends_with("\n\nhint: begin anew with `--fresh`"), "{message}");
    let message = refused(&model, Precision::Double);
    assert!(message.starts_with("the checkpoint `P` has another precision: single, wanted double"), "{message}");
    let line = whole.iter().position(|&byte| byte == b'\n').unwrap();
    let flipped = |at: usize| {
        let mut bytes = whole.clone();
        bytes[at] ^= 4;
        bytes
    };
    for (bytes, begin) in [
        (flipped(whole.len() / 2), "the checkpoint `P` is damaged: its checksum is wrong"),
        (flipped(line + 1), "the checkpoint `P` is damaged: its checksum is wrong"),
        (flipped(whole.len() - 1), "the checkpoint `P` is damaged: its checksum is wrong"),
        (whole[..whole.len() - 1].to_vec(), "the checkpoint `P` is damaged: it is cut short"),
        ([&whole[..], &[0]].concat(), "the checkpoint `P` is damaged: it is cut short or has something behind"),
        (whole[..line - 3].to_vec(), "the checkpoint `P` is damaged: its first line"),
        (flipped(2), "`P` is not a checkpoint"),
        (b"\xff\xfe".to_vec(), "`P` is not a checkpoint"),
        (vec![], "`P` is not a checkpoint"),
    ] {
        fs::write(&path, bytes).unwrap();
        let message = refused(&model, Precision::Single);
        assert!(message.starts_with(begin), "expected `{begin}…`, found `{message}`");
    }
    // The number of threads is no part of the model.
    fs::write(&path, whole).unwrap();
    other = Model { threads: Some(2), ..model };
    assert!(matches!(solve_kept(&other, Precision::Single, 1, &path, true).0, Err(FdtdError::Stopped)));
}
