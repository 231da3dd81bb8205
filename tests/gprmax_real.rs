//! gprMax itself: installed, run, and shown our files.

mod common;

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use ballast_gpr::forward::{Forward as _, Progress};
use ballast_gpr::gprmax::hdf5::H5File;
use ballast_gpr::gprmax::{
    GprMax, InputOptions, Interpreter, RunError, geometry_files, install, read_model, read_traces, write_input,
    write_traces,
};
use ballast_gpr::model::{
    Axis, DebyePole, Excitation, Grid, HertzianDipole, Material, MaterialId, Model, Object, Receiver, Source,
    TimeWindow, Voxels, Waveform, WaveformKind,
};
use ballast_gpr::trace::{Component, Traces};
use common::{gprmax, reference_case};

fn solver(python: Interpreter, double_precision: bool) -> GprMax {
    GprMax { python, threads: Some(1), double_precision }
}

fn go_on(_: Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Runs one of the scripts of `tests/python`, or a module of gprMax, and gives what it printed.
fn python(interpreter: &Interpreter, arguments: &[&str], folder: &Path) -> String {
    let output = Command::new(&interpreter.python).args(arguments).current_dir(folder).output().unwrap();
    let (text, errors) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{arguments:?} {}:\n{text}\n{errors}", output.status);
    text.into_owned()
}

fn script(name: &str) -> String {
    format!("{}/tests/python/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// Largest difference of two sets of traces over the peak of the first, over all components.
fn distance(a: &Traces, b: &Traces) -> f64 {
    assert_eq!((a.iterations, a.receivers.len()), (b.iterations, b.receivers.len()));
    let mut worst: f64 = 0.0;
    for (one, other) in a.receivers.iter().zip(&b.receivers) {
        for trace in &one.components {
            let samples = &other.component(trace.component).unwrap().samples;
            let difference = trace.samples.iter().zip(samples).fold(0.0f64, |d, (x, y)| d.max((x - y).abs()));
            worst = worst.max(if trace.peak() > 0.0 { difference / trace.peak() } else { difference });
        }
    }
    worst
}

#[test]
fn the_private_environment_is_made_once_and_found() {
    let Some(interpreter) = gprmax() else { return };
    let versions = install::check(&interpreter).unwrap();
    assert_eq!((versions.gprmax.as_str(), versions.h5py.as_str()), (install::GPRMAX_VERSION, install::H5PY_VERSION));
    assert_eq!(install::find(Some(&interpreter.python)).unwrap(), interpreter);
    if std::env::var_os(install::PYTHON_WITH_GPRMAX).is_none() {
        assert_eq!(install::find(None).unwrap(), interpreter);
        let mut lines = 0;
        assert_eq!(install::install(&mut |_| lines += 1).unwrap(), interpreter);
        assert_eq!(lines, 0, "what is there is not installed again");
    }
}

/// Case 01 again, in double precision: the same arithmetic as in the stored output. Other machines may contract or order
/// operations otherwise, hence 1e-12 of the peak and not zero.
#[test]
fn a_scene_runs_and_gives_the_stored_traces() {
    let Some(interpreter) = gprmax() else { return };
    let folder = tempfile::tempdir().unwrap();
    let case = reference_case("01_fs_dipole_2d");
    let output = folder.path().join("trace.h5");
    let (calls, last) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let progress = |progress: Progress| {
        calls.fetch_add(1, Ordering::Relaxed);
        if progress.total == 849 {
            last.store(progress.done, Ordering::Relaxed);
        }
        ControlFlow::Continue(())
    };
    let run = solver(interpreter, true).run_file(&case.join("scene.in"), &output, &progress).unwrap();
    let worst = distance(&read_traces(&case.join("out_f64.h5")).unwrap(), &run.traces);
    assert!(worst < 1e-12, "{worst:e}");
    assert_eq!(read_traces(&output).unwrap(), run.traces);
    assert_eq!(last.load(Ordering::Relaxed), 849);
    assert!(calls.load(Ordering::Relaxed) >= 2);
    let loop_seconds = run.loop_seconds.unwrap();
    assert!(loop_seconds > 0.0 && loop_seconds < run.wall_seconds, "{loop_seconds} {}", run.wall_seconds);
    let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["trace.h5"]);
}

fn scene_with_voxels() -> Model {
    let grid = Grid { cells: [100, 80, 1], spacing: [0.002; 3] };
    let mut model = Model::new("voxels, cylinder and box", grid, TimeWindow::Iterations(600));
    let stone = model.add_material(Material::dielectric("stone", 6.0, 0.001));
    let fines = model.add_material(Material::dielectric("fine grains", 4.0, 0.005));
    model.materials[fines.index()].id = "fines".into();
    let poles = vec![DebyePole { delta_eps: 12.5, tau: 9.231e-12 }, DebyePole { delta_eps: 1.5, tau: 1e-10 }];
    let wet =
        model.add_material(Material { poles, averagable: false, ..Material::dielectric("wet-fines", 4.9, 0.005) });
    model.waveforms.push(Waveform { id: "w".into(), kind: WaveformKind::Ricker, amplitude: 1.0, frequency: 1e9 });
    let cells: Vec<_> = (0..60 * 30)
        .map(|n| {
            [Some(fines), Some(stone), None, Some(MaterialId::PEC), Some(wet), Some(MaterialId::FREE_SPACE)]
                [(n / 7 + n / 211) % 6]
        })
        .collect();
    model.objects = vec![
        Object::Box { lower: [0.0; 3], upper: [0.2, 0.03, 0.002], material: fines, averaging: true },
        Object::Voxels(Voxels {
            origin: [0.04, 0.02, 0.0],
            shape: [60, 30, 1],
            cells: Arc::from(cells),
            averaging: true,
            edges: None,
        }),
        Object::Cylinder {
            start: [0.1013, 0.05, 0.0],
            end: [0.1013, 0.05, 0.002],
            radius: 0.012,
            material: stone,
            averaging: false,
        },
    ];
    let excitation = Excitation { start: 0.0, stop: None };
    model.sources.push(Source::HertzianDipole(HertzianDipole {
        polarisation: Axis::Z,
        position: [0.08, 0.13, 0.0],
        waveform: 0,
        excitation,
    }));
    model.receivers.push(Receiver { position: [0.12, 0.13, 0.0], name: Some("right".into()) });
    model
}

/// What our writer writes is what gprMax simulates: a block of voxels with stone, wet fines, metal and gaps gives the same
/// traces as the same cells written as one box each, in file order.
///
/// Not averaged: then each cell claims its edges in the order of painting, so voxels and boxes must agree to the last bit.
#[test]
fn voxels_are_simulated_like_the_boxes_they_stand_for() {
    let Some(interpreter) = gprmax() else { return };
    let mut voxels = scene_with_voxels();
    let Object::Voxels(block) = &mut voxels.objects[1] else { panic!("the second object is the block") };
    block.averaging = false;
    let block = block.clone();
    let mut boxes = voxels.clone();
    let d = 0.002;
    let cell = |n: usize, material: MaterialId| {
        let lower = [block.origin[0] + (n / 30) as f64 * d, block.origin[1] + (n % 30) as f64 * d, 0.0];
        Object::Box { lower, upper: lower.map(|x| x + d), material, averaging: false }
    };
    boxes.objects.splice(1..2, block.cells.iter().enumerate().filter_map(|(n, id)| id.map(|id| cell(n, id))));
    let gprmax = solver(interpreter, true);
    let a = gprmax.solve(&voxels, &go_on).unwrap();
    let b = gprmax.solve(&boxes, &go_on).unwrap();
    assert!(a.radar_trace().unwrap().peak() > 100.0);
    assert_eq!(distance(&a, &b), 0.0);
    // Averaged, with a material that the database marks as not averagable though the file has one of its name: accepted.
    let mut averaged = scene_with_voxels();
    averaged.materials[2].averagable = false;
    assert!(distance(&a, &gprmax.solve(&averaged, &go_on).unwrap()) > 1e-3);
    // The block matters: without it the trace is another by far.
    let mut without = voxels.clone();
    without.objects.remove(1);
    let c = gprmax.solve(&without, &go_on).unwrap();
    assert!(distance(&a, &c) > 0.01, "{}", distance(&a, &c));
}

/// Geometry files as gprMax writes them: `/data` says the same cell for cell, and gprMax reads ours back and gives the traces
/// of the first scene. Edges beside metal and Debye stuff follow from the cells again where these do not touch each other.
#[test]
fn geometry_files_are_those_of_gprmax() {
    let Some(interpreter) = gprmax() else { return };
    for (name, head, objects, block) in [
        (
            "plane",
            "#domain: 0.08 0.06 0.002\n#pml_cells: 5 5 0 5 5 0\n#hertzian_dipole: z 0.02 0.03 0 w\n#rx: 0.06 0.03 0\n",
            "#box: 0.01 0.01 0 0.05 0.03 0.002 half\n#cylinder: 0.04 0.034 0 0.04 0.034 0.002 0.011 rock\n\
             #box: 0.02 0.014 0 0.024 0.02 0.002 pec\n",
            ["0 0 0", "0.08 0.06 0.002"],
        ),
        (
            "three",
            "#domain: 0.06 0.05 0.04\n#pml_cells: 4\n#hertzian_dipole: z 0.014 0.014 0.02 w\n#rx: 0.04 0.03 0.02\n",
            "#box: 0.01 0.01 0 0.05 0.03 0.016 half\n#sphere: 0.03 0.026 0.02 0.011 rock\n\
             #box: 0.04 0.012 0.004 0.046 0.02 0.01 wet\n#box: 0.012 0.018 0.006 0.018 0.022 0.03 pec\n",
            ["0.008 0.008 0", "0.052 0.044 0.036"],
        ),
    ] {
        let common = format!(
            "{head}#dx_dy_dz: 0.002 0.002 0.002\n#time_window: 120\n#material: 4 0.01 1 0 half\n#material: 6 0.02 2 0.5 rock\n\
             #material: 5 0 1 0 wet\n#add_dispersion_debye: 1 3 1e-11 wet\n#waveform: ricker 1 1e9 w\n"
        );
        let folder = tempfile::tempdir().unwrap();
        let path = |file: &str| folder.path().join(file);
        let [lower, upper] = block;
        let scene = format!("{common}{objects}#geometry_objects_write: {lower} {upper} bed\n");
        std::fs::write(path("first.in"), scene).unwrap();
        let gprmax = solver(interpreter.clone(), true);
        gprmax.run_file(&path("first.in"), &path("first.h5"), &go_on).unwrap();
        let theirs = materials_of_cells(&path("bed.h5"));
        let model = read_model(&path("first.in")).unwrap();
        let files = geometry_files(&model, folder.path()).unwrap();
        assert_eq!(
            files.iter().map(|(path, _)| path.clone()).collect::<Vec<_>>(),
            [path("bed.h5"), path("bed_materials.json")]
        );
        for (path, bytes) in files {
            std::fs::write(path, bytes).unwrap();
        }
        assert_eq!(materials_of_cells(&path("bed.h5")), theirs, "{name}");
        let used: std::collections::BTreeSet<&String> = theirs.1.iter().collect();
        assert!(used.len() >= 4, "{used:?}");
        // Materials that the file brings under the same names get other names in gprMax, which mixes them all the same.
        std::fs::write(path("second.in"), format!("{common}#geometry_objects_read: {lower} bed.h5 bed_materials y\n"))
            .unwrap();
        gprmax.run_file(&path("second.in"), &path("second.h5"), &go_on).unwrap();
        let [first, second] = ["first.h5", "second.h5"].map(|file| read_traces(&path(file)).unwrap());
        assert!(first.receivers[0].components.iter().any(|trace| trace.peak() > 0.0));
        // Means of four in another order of summation: a few units in the last place.
        let worst = distance(&first, &second);
        assert!(worst < 1e-12, "{name} {worst:e}");
    }
}

/// Shape of a geometry file and the identifier of the material of each of its cells.
fn materials_of_cells(path: &Path) -> (Vec<usize>, Vec<String>) {
    let file = H5File::open(path).unwrap();
    let database = format!("{}.json", file.text("/", "MaterialDatabase").unwrap());
    let text = std::fs::read_to_string(path.with_file_name(database)).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    let keys = file.read_texts("/material_keys").unwrap();
    let id = |key: &String| json["materials"][key]["metadata"]["original_id"].as_str().unwrap().to_owned();
    let ids: Vec<String> = keys.iter().map(id).collect();
    let cells = file.read_i16("/data").unwrap();
    (file.shape("/data").unwrap(), cells.iter().map(|&index| ids[index as usize].clone()).collect())
}

/// Reading and writing changes nothing for gprMax: case 11 rewritten by us gives the stored trace. Tolerance as above.
#[test]
fn a_rewritten_scene_gives_the_same_traces() {
    let Some(interpreter) = gprmax() else { return };
    for case in ["11_geometry_objects_read", "09_debye_water_layer"] {
        let model = read_model(&reference_case(case).join("scene.in")).unwrap();
        let traces = solver(interpreter.clone(), true).solve(&model, &go_on).unwrap();
        let worst = distance(&read_traces(&reference_case(case).join("out_f64.h5")).unwrap(), &traces);
        assert!(worst < 1e-12, "{case} {worst:e}");
    }
}

/// h5py finds our numbers, attributes and types in our files.
#[test]
fn h5py_reads_what_we_write() {
    let Some(interpreter) = gprmax() else { return };
    let folder = tempfile::tempdir().unwrap();
    let case = reference_case("01_fs_dipole_2d");
    let (model, mut traces) =
        (read_model(&case.join("scene.in")).unwrap(), read_traces(&case.join("out_f64.h5")).unwrap());
    traces.solver = "ballast-gpr".into();
    let path = folder.path().join("ours.h5");
    write_traces(&path, &traces, &model).unwrap();
    let read = |path: &Path| -> serde_json::Map<String, serde_json::Value> {
        serde_json::from_str(&python(
            &interpreter,
            &[&script("read_output.py"), &path.to_string_lossy()],
            folder.path(),
        ))
        .unwrap()
    };
    let (ours, theirs) = (read(&path), read(&case.join("out_f64.h5")));
    // Everything that gprMax writes is there with the same value, but for its own name of the layout of receivers and the
    // last digits of the pulse.
    for (key, value) in &theirs {
        let found = ours.get(key).unwrap_or_else(|| panic!("{key} is missing in our file"));
        if key == "srcs/src1/excitation/samples" {
            assert_eq!((&found["shape"], &found["type"]), (&value["shape"], &value["type"]));
            assert!(
                (found["peak"].as_f64().unwrap() - value["peak"].as_f64().unwrap()).abs() < 1e-12,
                "{found} {value}"
            );
        } else if key != "@ReceiverLayout" {
            assert_eq!(found, value, "{key}");
        }
    }
    traces.double_precision = false;
    write_traces(&path, &traces, &model).unwrap();
    assert_eq!(read(&path)["rxs/rx1/Ez"]["type"], "float32");
}

/// The current of a source that is on for a while only is recorded as gprMax records it: same samples, same times.
#[test]
fn the_current_of_a_source_is_that_of_gprmax() {
    let Some(interpreter) = gprmax() else { return };
    let folder = tempfile::tempdir().unwrap();
    for kind in WaveformKind::ALL {
        let mut model = scene_with_voxels();
        model.objects.clear();
        model.time_window = TimeWindow::Iterations(500);
        model.waveforms[0].kind = kind.clone();
        let Source::HertzianDipole(dipole) = &mut model.sources[0] else { panic!("a current") };
        // An impulse lasts one step and slips between the samples of a current that starts at this time.
        let start = if kind == WaveformKind::Impulse { 0.0 } else { 2e-10 };
        dipole.excitation = Excitation { start, stop: Some(1.6e-9) };
        let paths = write_input(&model, folder.path(), "scene", &InputOptions::default()).unwrap();
        let (theirs, ours) = (folder.path().join("theirs.h5"), folder.path().join("ours.h5"));
        let run = solver(interpreter.clone(), true).run_file(&paths[0], &theirs, &go_on).unwrap();
        write_traces(&ours, &run.traces, &model).unwrap();
        let current = |path| H5File::open(path).unwrap().read_f64("/srcs/src1/excitation/samples").unwrap();
        let (theirs, ours) = (current(&theirs), current(&ours));
        let peak = theirs.iter().fold(0.0f64, |peak, v| peak.max(v.abs()));
        let worst = theirs.iter().zip(&ours).fold(0.0f64, |worst, (a, b)| worst.max((a - b).abs()));
        // A few roundings of times near 2e-9 s at 1 GHz in an exponent of up to 20: below 1e-13 of the peak.
        assert!(theirs.len() == ours.len() && peak > 0.0 && worst < 1e-12 * peak, "{kind:?} {worst:e} of {peak:e}");
    }
}

/// gprMax's own tools take our files: two runs are merged, and an A-scan is drawn.
#[test]
fn tools_of_gprmax_read_what_we_write() {
    let Some(interpreter) = gprmax() else { return };
    let folder = tempfile::tempdir().unwrap();
    let case = reference_case("01_fs_dipole_2d");
    let (mut model, traces) =
        (read_model(&case.join("scene.in")).unwrap(), read_traces(&case.join("out_f64.h5")).unwrap());
    for run in 1..=2 {
        write_traces(&folder.path().join(format!("line{run}.h5")), &traces, &model).unwrap();
        let Source::HertzianDipole(dipole) = &mut model.sources[0] else { panic!("a current") };
        dipole.position[0] += 0.02;
        model.receivers.iter_mut().for_each(|receiver| receiver.position[0] += 0.02);
    }
    python(
        &interpreter,
        &["-m", "gprMax.toolboxes.Utilities.outputfiles_merge", "line", "-o", "merged.h5"],
        folder.path(),
    );
    let merged = read_traces(&folder.path().join("merged.h5")).unwrap();
    let names: Vec<_> =
        merged.receivers.iter().map(|receiver| (receiver.name.as_str(), receiver.position[0].si())).collect();
    let expected = [
        ("Rx(125,100,0) trace 1", 0.25),
        ("Rx(125,100,0) trace 2", 0.27),
        ("Rx(125,125,0) trace 1", 0.25),
        ("Rx(125,125,0) trace 2", 0.27),
    ];
    assert_eq!(names, expected);
    let ez =
        |traces: &Traces, receiver: usize| traces.receivers[receiver].component(Component::Ez).unwrap().samples.clone();
    assert_eq!(ez(&merged, 1), ez(&traces, 0));
    assert_eq!(ez(&merged, 2), ez(&traces, 1));
    python(&interpreter, &[&script("plot_ascan.py"), "line1.h5"], folder.path());
}

/// A file that gprMax refuses: its own words are shown and kept, and no output is left.
#[test]
fn an_error_of_gprmax_is_shown() {
    let Some(interpreter) = gprmax() else { return };
    let folder = tempfile::tempdir().unwrap();
    let input = folder.path().join("broken.in");
    std::fs::write(&input, "#domain: 0.1 0.1 0.002\n#dx_dy_dz: 0.002 0.002 0.002\n#time_window: 1e-9\n#box: 1 2 3\n")
        .unwrap();
    let output = folder.path().join("out.h5");
    let error = solver(interpreter, false).run_file(&input, &output, &go_on).unwrap_err();
    let message = error.to_string();
    assert!(message.contains("broken.in"), "{message}");
    assert!(message.contains("'#box: 1 2 3' requires at least seven parameters"), "{message}");
    let RunError::Failed { log, .. } = error else { panic!("{message}") };
    assert_eq!(log, PathBuf::from(format!("{}.log", output.display())));
    assert!(std::fs::read_to_string(&log).unwrap().contains("requires at least seven parameters"));
    assert!(!output.exists());
}

/// A request to stop ends a long run at once and leaves nothing.
#[test]
fn a_run_stops_on_request() {
    let Some(interpreter) = gprmax() else { return };
    let folder = tempfile::tempdir().unwrap();
    let mut model = scene_with_voxels();
    model.time_window = TimeWindow::Iterations(5_000_000);
    let paths = write_input(&model, folder.path(), "long", &InputOptions::default()).unwrap();
    let output = folder.path().join("out.h5");
    let stop = |progress: Progress| {
        if progress.total == 5_000_000 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    assert!(matches!(solver(interpreter, false).run_file(&paths[0], &output, &stop), Err(RunError::Stopped)));
    let left = std::fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(left, paths.len());
}

/// `#output_dir` in a file sends gprMax's output elsewhere; it is found there.
#[test]
fn an_output_that_the_file_sends_elsewhere_is_found() {
    let Some(interpreter) = gprmax() else { return };
    let folder = tempfile::tempdir().unwrap();
    let mut model = scene_with_voxels();
    model.objects.clear();
    model.time_window = TimeWindow::Iterations(20);
    let paths = write_input(&model, folder.path(), "scene", &InputOptions::default()).unwrap();
    let text = std::fs::read_to_string(&paths[0]).unwrap() + "#output_dir: results\n";
    std::fs::write(&paths[0], text).unwrap();
    let output = folder.path().join("wanted.h5");
    solver(interpreter, false).run_file(&paths[0], &output, &go_on).unwrap();
    assert!(output.is_file());
}

/// A file with a command that the embedded solver lacks: refused by name, and run by gprMax where the user says so.
#[test]
fn what_the_embedded_solver_lacks_gprmax_runs() {
    let Some(interpreter) = gprmax() else { return };
    let folder = tempfile::tempdir().unwrap();
    let scene = "#domain: 0.06 0.06 0.06\n#dx_dy_dz: 0.002 0.002 0.002\n#time_window: 150\n#pml_cells: 5\n\
        #waveform: ricker 1 2e9 w\n#transmission_line: z 0.03 0.03 0.03 50 w\n#rx: 0.04 0.03 0.03\n";
    std::fs::write(folder.path().join("line.in"), scene).unwrap();
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_ballast-gpr"));
        command.args(["run", "line.in"]).args(arguments).current_dir(folder.path()).output().unwrap()
    };
    let refused = run(&[]);
    assert_eq!(refused.status.code(), Some(2));
    let message = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(message.contains("line 6: `#transmission_line` is not supported by the embedded solver"), "{message}");
    assert!(message.contains("hint: `--solver gprmax`"), "{message}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "a refused run leaves nothing");
    let python = interpreter.python.to_str().unwrap();
    let ran = run(&["--solver", "gprmax", "--gprmax-python", python, "--out", "line.h5"]);
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    let traces = read_traces(&folder.path().join("line.h5")).unwrap();
    assert!(traces.receivers[0].component(Component::Ez).unwrap().peak() > 0.0);
}
