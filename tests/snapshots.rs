//! Snapshots: those of gprMax 4.0.1 (`out_f64_snaps` in `validation/gprmax` and `validation/gprmax3d`), the same bits however
//! the run is made, and what the program does with the files.

mod cli_support;

use std::cell::RefCell;
use std::fs;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use ballast_gpr::fdtd::{Fdtd, Keeping, Precision, Snapshots};
use ballast_gpr::gprmax::hdf5::H5File;
use ballast_gpr::gprmax::{read_model, read_snapshot, read_traces, snapshot_file, snapshot_to_bytes};
use ballast_gpr::model::{Model, Snapshot, SnapshotFormat, SnapshotTime};
use ballast_gpr::trace::{FieldSnapshot, FieldValues, Traces};
use cli_support::Place;

/// The folders of `validation` that hold snapshots of gprMax.
fn scenes() -> Vec<PathBuf> {
    let all = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation");
    let folders = ["gprmax", "gprmax3d"].map(|name| fs::read_dir(all.join(name)).unwrap());
    let mut scenes: Vec<_> = folders.into_iter().flatten().map(|entry| entry.unwrap().path()).collect();
    scenes.retain(|path| path.join("out_f64_snaps").is_dir());
    scenes.sort();
    scenes
}

/// Runs a model and collects its snapshots, in the order of the model.
fn solve(model: &Model, precision: Precision, threads: usize) -> (Traces, Vec<FieldSnapshot>) {
    let taken = RefCell::new(vec![None; model.snapshots.len()]);
    let take = |index: usize, snapshot: FieldSnapshot| {
        assert!(taken.borrow_mut()[index].replace(snapshot).is_none(), "snapshot {index} was taken twice");
        Ok(())
    };
    let snapshots = Snapshots { take: &take, is_there: &|_| false };
    let keeping = Keeping { checkpoints: None, snapshots: Some(&snapshots) };
    let fdtd = Fdtd { precision, threads: NonZeroUsize::new(threads), ..Fdtd::default() };
    let (traces, _) = fdtd.solve_kept(model, keeping, &|_| ControlFlow::Continue(())).unwrap();
    (traces, taken.into_inner().into_iter().map(|snapshot| snapshot.expect("every snapshot is taken")).collect())
}

/// Group of the fields in a file of either layout.
fn fields_of(file: &H5File) -> &'static str {
    if file.has("/VTKHDF") { "/VTKHDF/CellData/" } else { "/" }
}

/// Largest difference of E and of H, each beside the largest value that gprMax has.
fn difference(ours: &H5File, theirs: &H5File) -> [f64; 2] {
    let group = fields_of(theirs);
    ["E", "H"].map(|kind| {
        let (mut worst, mut size) = (0.0f64, 0.0f64);
        for axis in ["x", "y", "z"] {
            let name = format!("{group}{kind}{axis}");
            assert_eq!(ours.shape(&name).unwrap(), theirs.shape(&name).unwrap(), "{name}");
            for (a, b) in ours.read_f64(&name).unwrap().iter().zip(theirs.read_f64(&name).unwrap()) {
                assert!(a.is_finite());
                (worst, size) = (worst.max((a - b).abs()), size.max(b.abs()));
            }
        }
        assert!(size > 0.0, "nothing but zeros in {}", theirs.path().display());
        worst / size
    })
}

/// Every attribute of a group that gprMax writes is there, with the same value; times and lengths to the last bits.
fn same_attributes(ours: &H5File, theirs: &H5File) {
    let (group, names): (&str, &[&str]) = if theirs.has("/VTKHDF") {
        ("/VTKHDF", &["Direction", "Origin", "Spacing", "Type", "Version", "WholeExtent"])
    } else {
        ("/", &["dx_dy_dz", "gprMax", "iteration", "magnetic_time", "nx_ny_nz", "origin", "time"])
    };
    for name in names {
        let [a, b] = [ours, theirs].map(|file| file.attribute(group, name).unwrap().expect(name));
        assert_eq!(a.kind(), b.kind(), "{name}");
        if a.kind() == "floats" {
            let [a, b] = [ours, theirs].map(|file| file.floats(group, name).unwrap());
            assert!(a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| (a - b).abs() <= 1e-15 * b.abs()), "{name}");
        } else {
            assert_eq!(a, b, "{name}");
        }
    }
    let children = |file: &H5File| file.children(fields_of(file).trim_end_matches('/')).unwrap();
    if theirs.has("/VTKHDF") {
        assert_eq!(children(ours), children(theirs));
    } else {
        assert_eq!(ours.children("/").unwrap(), theirs.children("/").unwrap());
    }
}

/// Data sets, attributes and values of every snapshot. Double precision, 1e-10: as for traces. Single precision, 1e-4 of the
/// largest value: gprMax's own single precision is off by up to 2e-4 of a trace's peak in three dimensions; ours by 2e-5 of
/// what is left at the last step.
#[test]
fn snapshots_are_those_of_gprmax() {
    let scenes = scenes();
    assert!(scenes.len() >= 4, "{scenes:?}");
    for scene in scenes {
        let model = read_model(&scene.join("scene.in")).unwrap();
        let there = fs::read_dir(scene.join("out_f64_snaps")).unwrap().count();
        assert_eq!(there, model.snapshots.len(), "{}", scene.display());
        let place = tempfile::tempdir().unwrap();
        for (precision, tolerance) in [(Precision::Double, 1e-10), (Precision::Single, 1e-4)] {
            let (_, taken) = solve(&model, precision, 2);
            for (asked, snapshot) in model.snapshots.iter().zip(&taken) {
                let name = snapshot_file(asked);
                let path = place.path().join(&name);
                fs::write(&path, snapshot_to_bytes(snapshot, asked.format).unwrap()).unwrap();
                if asked.format == SnapshotFormat::Hdf5 {
                    assert_eq!(&read_snapshot(&path).unwrap(), snapshot);
                }
                let [ours, theirs] =
                    [&path, &scene.join("out_f64_snaps").join(&name)].map(|p| H5File::open(p).unwrap());
                same_attributes(&ours, &theirs);
                let found = difference(&ours, &theirs);
                println!("{} {name} {}: {found:?}", scene.display(), precision.name());
                assert!(found.iter().all(|d| *d <= tolerance), "{} {name}: {found:?}", scene.display());
            }
        }
    }
}

/// A snapshot looks where no receiver does: what is left out of the steps does not show in it, nor do threads, nor does it show
/// in the traces.
#[test]
fn snapshots_have_the_same_bits_however_the_run_is_made() {
    for scene in scenes() {
        let model = read_model(&scene.join("scene.in")).unwrap();
        for precision in [Precision::Single, Precision::Double] {
            let (traces, plain) = solve(&model, precision, 1);
            for threads in [2, 4] {
                assert!(solve(&model, precision, threads) == (traces.clone(), plain.clone()), "{threads} threads");
            }
            // One of everything at the last step lets nothing be left out.
            let mut wide = model.clone();
            let upper = std::array::from_fn(|axis| model.grid.cells[axis] as f64 * model.grid.spacing[axis]);
            wide.snapshots.push(Snapshot {
                lower: [0.0; 3],
                upper,
                spacing: model.grid.spacing,
                at: SnapshotTime::Iteration(model.iterations() - 1),
                name: "all".into(),
                format: SnapshotFormat::Hdf5,
            });
            let (wide_traces, mut wide) = solve(&wide, precision, 1);
            let whole = wide.pop().unwrap();
            assert!(wide_traces == traces && wide == plain, "{}", scene.display());
            assert_eq!(whole.step, model.iterations() - 1);
            // Each alone: nothing else keeps its steps.
            for (index, asked) in model.snapshots.iter().enumerate() {
                let alone = Model { snapshots: vec![asked.clone()], receivers: vec![], ..model.clone() };
                assert!(solve(&alone, precision, 1).1[0] == plain[index], "{} {}", scene.display(), asked.name);
            }
        }
        // Nobody asks for them: they are not taken, and the traces are the same.
        let fdtd = Fdtd { precision: Precision::Double, ..Fdtd::default() };
        let (traces, _) = fdtd.solve_stats(&model, &|_| ControlFlow::Continue(())).unwrap();
        assert!(traces == solve(&model, Precision::Double, 1).0);
    }
}

/// A plane of 2 mm cells with a stone; `more` lines.
fn input(more: &str) -> String {
    format!(
        "#domain: 0.16 0.12 0.002\n#dx_dy_dz: 0.002 0.002 0.002\n#time_window: 120\n#pml_cells: 6 6 0 6 6 0\n\
         #material: 6 0 1 0 stone\n#waveform: ricker 1 2e9 pulse\n#hertzian_dipole: z 0.06 0.09 0 pulse\n#rx: 0.1 0.09 0\n\
         #src_steps: 0.002 0 0\n#rx_steps: 0.002 0 0\n#cylinder: 0.08 0.05 0 0.08 0.05 0.002 0.02 stone\n\
         #snapshot: 0 0 0 0.16 0.12 0.002 0.002 0.002 0.002 60 wave.h5\n\
         #snapshot: 0 0 0 0.16 0.12 0.002 0.004 0.004 0.002 3e-10 wave\n{more}"
    )
}

/// Names of what lies in a folder.
fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn snapshots_lie_beside_their_result_and_are_not_overwritten() {
    let place = Place::new();
    place.write("a.in", input(""));
    let said = place.ok(&["run", "a.in"]);
    assert!(said.contains("a_snaps/wave.h5 written\n") && said.contains("a_snaps/wave.vtkhdf written\n"), "{said}");
    assert_eq!(names(&place.path("")), ["a.h5", "a.in", "a.run.json", "a_snaps"]);
    assert_eq!(names(&place.path("a_snaps")), ["wave.h5", "wave.vtkhdf"]);
    let snapshot = read_snapshot(&place.path("a_snaps/wave.h5")).unwrap();
    assert_eq!((snapshot.step, snapshot.shape), (60, [80, 60, 1]));
    assert!(matches!(&snapshot.fields[2], FieldValues::Single(values) if values.iter().any(|v| *v != 0.0)));
    // Another result has its own; one that is there is not overwritten unasked, nor is its trace.
    fs::remove_file(place.path("a.h5")).unwrap();
    let error = place.fails(&["run", "a.in"], 2);
    assert!(
        error.contains("error: `#snapshot` would write `a_snaps/wave.h5`, which exists already\n\nhint: "),
        "{error}"
    );
    assert!(!place.path("a.h5").exists());
    fs::write(place.path("a_snaps/wave.h5"), "old").unwrap();
    place.ok(&["run", "a.in", "--force"]);
    assert_eq!(read_snapshot(&place.path("a_snaps/wave.h5")).unwrap(), snapshot);
    let outcome = place.json(&["run", "a.in", "--out", "b.h5", "--json"]);
    assert_eq!(outcome["files"], serde_json::json!(["b_snaps/wave.h5", "b_snaps/wave.vtkhdf"]));
    // A B-scan has a folder for each trace, as gprMax has.
    place.ok(&["run", "a.in", "-n", "2", "--out", "c.h5"]);
    let [first, second] = [1, 2].map(|trace| read_snapshot(&place.path(&format!("c{trace}_snaps/wave.h5"))).unwrap());
    assert!(first == snapshot && second != snapshot);
    assert_eq!(read_traces(&place.path("c1.h5")).unwrap().receivers.len(), 1);
}

/// A disk that says no stops the run, and nothing waits behind.
#[test]
fn a_snapshot_that_cannot_be_kept_ends_the_run() {
    let place = Place::new();
    place.write("a.in", input(""));
    place.write("a_snaps.partial", "in the way");
    let error = place.fails(&["run", "a.in"], 2);
    assert!(error.contains("snapshot 1: failed to create the folder `a_snaps.partial`: "), "{error}");
    assert_eq!(names(&place.path("")), ["a.in", "a_snaps.partial"]);
}

/// What gprMax refuses is refused, with the line.
#[test]
fn snapshots_that_cannot_be_are_refused() {
    let place = Place::new();
    for (line, said) in [
        (
            "0 0 0 0.16 0.12 0.002 0.002 0.002 0.002 120 late.h5",
            "asked for at step 120, but the model has steps 0 to 119",
        ),
        ("0 0 0 0.16 0.12 0.002 0.002 0.002 0.002 -1 a.h5", "the step of `#snapshot` is -1, it should be 0 or more"),
        ("0 0 0 0.16 0.12 0.002 0.002 0.002 0.002 6 a.vti", "`a.vti`"),
        ("0 0 0 0.16 0.12 0.002 0.002 0.002 0.002 6 wave.h5", "`wave.h5`"),
        ("0 0 0 0.16 0.12 0.002 0.0001 0.002 0.002 6 a", "has cells of 0.0001 m along x, less than those of the grid"),
        ("0 0 0 0.16 0.12 0.002 0.002 0.002 0.002 6 a Ez", "12"),
        (
            "0 0 0 0.162 0.12 0.002 0.002 0.002 0.002 6 a",
            "reaches from 0 to 0.162 m along x, the grid from 0 to 0.16 m",
        ),
        ("0 0 0 0.16 0.12 0 0.002 0.002 0.002 6 a", "leaves out layer 0 along z"),
        ("0 0 0 0.16 0.12 0.002 0.002 0.016 0.002 6 a", "last cell along y that reaches beyond the grid"),
    ] {
        place.write("a.in", input(&format!("#snapshot: {line}\n")));
        let error = place.fails(&["run", "a.in"], 2);
        assert!(error.starts_with("error: `a.in` line 14: ") && error.contains(said), "{line}: {error}");
    }
}
