//! `run`: one target and many, kept results, failures among others, and Ctrl-C.

mod cli_support;

use std::fs;

use cli_support::{COARSE, Place};

#[test]
fn a_result_is_kept_until_asked_otherwise() {
    let place = Place::new();
    place.build("a", &[]);
    let first = place.json(&["run", "a", "--json"]);
    assert_eq!(first["kept"], false);
    assert_eq!(first["result"], "a/fdtd.h5");
    assert_eq!(first["record"]["solver"], "fdtd");
    let bytes = fs::read(place.path("a/fdtd.h5")).unwrap();
    let second = place.json(&["run", "a", "--json"]);
    assert_eq!(second["kept"], true);
    assert_eq!(second["record"], first["record"]);
    let third = place.json(&["run", "a", "--json", "--force"]);
    assert_eq!(third["kept"], false);
    assert!(fs::read(place.path("a/fdtd.h5")).unwrap() == bytes);
    assert_eq!(place.json(&["run", "a", "--json", "--out", "deep.h5", "--precision", "double"])["result"], "deep.h5");
    assert!(fs::read(place.path("deep.h5")).unwrap() != bytes);
}

/// An input file alone, outside every folder of this program, gives the same trace as the folder it came from.
#[test]
fn an_input_file_runs_by_itself() {
    let place = Place::new();
    place.build("a", &["--geometry", "cylinders"]);
    fs::copy(place.path("a/model.in"), place.path("alone.in")).unwrap();
    let run = place.json(&["run", "alone.in", "--json"]);
    assert_eq!(run["result"], "alone.h5");
    place.ok(&["run", "a"]);
    assert!(fs::read(place.path("alone.h5")).unwrap() == fs::read(place.path("a/fdtd.h5")).unwrap());
}

/// A result whose model was built anew is refused, and taken again with `--force`.
#[test]
fn a_stale_result_is_never_passed_off() {
    let place = Place::new();
    place.build("a", &[]);
    place.ok(&["run", "a"]);
    place.build("a", &["--seed", "2", "--force"]);
    let old = fs::read(place.path("a/fdtd.h5")).unwrap();
    let error = place.fails(&["run", "a"], 2);
    assert!(error.contains("`a/fdtd.h5` exists already, of another model"), "{error}");
    assert!(fs::read(place.path("a/fdtd.h5")).unwrap() == old);
    place.ok(&["run", "a", "--force"]);
    assert!(fs::read(place.path("a/fdtd.h5")).unwrap() != old);
    fs::remove_file(place.path("a/fdtd.run.json")).unwrap();
    let error = place.fails(&["run", "a"], 2);
    assert!(error.contains("nothing beside it says what made it"), "{error}");
}

/// One folder that cannot run does not stop the others; the second call keeps what the first gave.
#[test]
fn a_failure_among_many_is_told_and_the_rest_finishes() {
    let place = Place::new();
    place.ok(&[&["build", "--out", "many", "--realisations", "3"], &COARSE[..]].concat());
    fs::write(place.path("many/seed-2/model.in"), "#domain: 1 1 0.002\n").unwrap();
    let targets = ["run", "many/seed-1", "many/seed-2", "many/seed-3"];
    let output = place.program().args(targets).assert().code(1).get_output().clone();
    let (told, error) = (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
    assert!(told.starts_with("3 runs, 1 failed\n"), "{told}");
    let reason = "many/seed-2: `many/seed-2/model.in` has no `#dx_dy_dz`\n\nhint: write for example `#dx_dy_dz: 0.002 0.002 0.002`\n\n";
    assert!(error.starts_with(reason), "{error}");
    assert!(error.ends_with("error: 1 of 3 runs failed; the others are complete\n"), "{error}");
    for (seed, there) in [(1, true), (2, false), (3, true)] {
        assert_eq!(place.path(&format!("many/seed-{seed}/fdtd.h5")).exists(), there, "seed {seed}");
    }
    let output = place.program().args(targets).arg("--json").assert().code(1).get_output().clone();
    let rows: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&rows[0]["kept"], &rows[2]["kept"]), (&true.into(), &true.into()));
    assert_eq!(rows[1]["target"], "many/seed-2");
    assert!(rows[1]["error"].as_str().unwrap().starts_with("`many/seed-2/model.in` has no"));
    let forced = place.program().args(["run", "many/seed-1", "many/seed-3", "--json", "--force"]).output().unwrap();
    let rows: serde_json::Value = serde_json::from_slice(&forced.stdout).unwrap();
    assert_eq!((&rows[0]["kept"], &rows[1]["kept"]), (&false.into(), &false.into()));
}

/// Ctrl-C, as the signal that it is.
#[cfg(unix)]
mod interrupted {
    use std::process::{Child, Command, Output, Stdio};
    use std::time::{Duration, Instant};

    use super::*;

    /// A model that runs for minutes: seconds before it is stopped are far from its end.
    fn long(place: &Place, name: &str) {
        place.ok(&["build", "--out", name, "--homogeneous", "--cell", "1mm", "--time-window", "900ns"]);
    }

    fn start(place: &Place, arguments: &[&str]) -> Child {
        let program = place.program().get_program().to_owned();
        let mut command = Command::new(program);
        command.args(arguments).current_dir(place.path("")).stdout(Stdio::piped()).stderr(Stdio::piped());
        command.spawn().unwrap()
    }

    fn interrupt(child: Child) -> Output {
        std::thread::sleep(Duration::from_millis(1500));
        let asked = Instant::now();
        assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
        let output = child.wait_with_output().unwrap();
        assert!(asked.elapsed() < Duration::from_secs(8), "{:?}", asked.elapsed());
        assert_eq!(output.status.code(), Some(130), "{}", String::from_utf8_lossy(&output.stderr));
        output
    }

    #[test]
    fn a_run_that_is_stopped_leaves_nothing_and_can_be_repeated() {
        let place = Place::new();
        long(&place, "a");
        let before = place.files("");
        let output = interrupt(start(&place, &["run", "a"]));
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(
            error,
            "\nstopping; nothing half-written stays (Ctrl-C again ends at once)\nerror: stopped on request\n"
        );
        assert!(place.files("") == before, "{:?}", place.names(""));
        place.build("a", &["--force"]);
        place.ok(&["run", "a"]);
    }

    /// The short run is done and kept; the long ones, and nothing of them, are stopped with the program.
    #[test]
    fn a_batch_that_is_stopped_keeps_what_is_done() {
        let place = Place::new();
        place.build("short", &[]);
        long(&place, "first");
        long(&place, "second");
        let before = place.files("");
        let output = interrupt(start(&place, &["run", "short", "first", "second", "--jobs", "2", "--json"]));
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(error.ends_with("error: stopped on request; start the same command again to go on\n"), "{error}");
        let rows: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(rows[0]["kept"], false);
        assert_eq!(rows[1]["error"], "stopped on request");
        let mut after = place.files("");
        assert!(after.remove(&std::path::PathBuf::from("short/fdtd.h5")).is_some());
        assert!(after.remove(&std::path::PathBuf::from("short/fdtd.run.json")).is_some());
        assert!(after == before, "{:?}", place.names(""));
        assert_eq!(place.json(&["run", "short", "--threads", "1", "--json"])["kept"], true);
    }

    /// gprMax that is stopped is no gprMax that failed: exit code 130, no log, and the process is gone.
    #[test]
    fn gprmax_that_is_stopped_leaves_nothing() {
        use std::os::unix::fs::PermissionsExt as _;
        let place = Place::new();
        place.build("a", &[]);
        let versions = "case \"$*\" in *versions*) echo versions 3.12.0 4.0.1 3.0; exit 0;; esac";
        place.write("python", format!("#!/bin/sh\n{versions}\necho started\nsleep 30\ntouch survived\n"));
        fs::set_permissions(place.path("python"), fs::Permissions::from_mode(0o755)).unwrap();
        let before = place.files("");
        interrupt(start(&place, &["run", "a", "--solver", "gprmax", "--gprmax-python", "./python"]));
        assert!(place.files("") == before, "{:?}", place.names(""));
    }
}

const WRITES: &str = "#domain: 0.1 0.08 0.002\n#dx_dy_dz: 0.002 0.002 0.002\n#time_window: 150\n#pml_cells: 5 5 0 5 5 0\n\
    #material: 6 0.001 1 0 stone\n#waveform: ricker 1 1e9 w\n#hertzian_dipole: z 0.03 0.04 0 w\n#rx: 0.07 0.04 0\n\
    #box: 0.02 0.02 0 0.06 0.03 0.002 stone\n#box: 0.04 0.02 0 0.05 0.024 0.002 pec\n";

/// `#geometry_objects_write` writes beside the input file what `#geometry_objects_read` finds again: the whole domain, read
/// into an empty one, gives the same traces. A file that is in the way stays as it was.
#[test]
fn geometry_files_are_written_and_read_back() {
    let place = Place::new();
    fs::create_dir(place.path("in")).unwrap();
    fs::write(place.path("in/a.in"), format!("{WRITES}#geometry_objects_write: 0 0 0 0.1 0.08 0.002 bed\n")).unwrap();
    fs::write(place.path("in/bed_materials.json"), "of somebody else").unwrap();
    let error = place.fails(&["run", "in/a.in"], 2);
    assert!(error.contains("`in/bed_materials.json`, which exists already with another content"), "{error}");
    assert!(!place.path("in/a.h5").exists() && !place.path("in/bed.h5").exists());
    place.ok(&["run", "in/a.in", "--force", "--precision", "double"]);
    // The same bytes in the way are no obstacle.
    place.ok(&["run", "in/a.in", "--out", "again.h5", "--precision", "double"]);
    let objects = WRITES.find("#box").unwrap();
    let read = "#geometry_objects_read: 0 0 0 bed.h5 bed_materials y\n";
    fs::write(place.path("in/b.in"), format!("{}{read}", &WRITES[..objects])).unwrap();
    place.ok(&["run", "in/b.in", "--precision", "double"]);
    let traces = |name: &str| ballast_gpr::gprmax::read_traces(&place.path(name)).unwrap().receivers;
    assert!(traces("in/a.h5")[0].components.iter().any(|trace| trace.peak() > 0.0));
    // The second takes another way through the solver, which knows edges of a block: rounding, no more.
    for (a, b) in traces("in/a.h5")[0].components.iter().zip(&traces("in/b.h5")[0].components) {
        let peak = a.peak();
        assert!(a.samples.iter().zip(&b.samples).all(|(a, b)| (a - b).abs() <= 1e-12 * peak), "{}", a.component.name());
    }
    fs::write(place.path("in/empty.in"), &WRITES[..objects]).unwrap();
    place.ok(&["run", "in/empty.in", "--precision", "double"]);
    assert_ne!(traces("in/a.h5"), traces("in/empty.h5"));
}

/// A B-scan writes its geometry files once; nothing is written over its traces or over what it reads.
#[test]
fn geometry_files_of_a_b_scan_and_names_in_use() {
    let place = Place::new();
    let write = |name: &str, line: &str| fs::write(place.path(name), format!("{WRITES}{line}\n")).unwrap();
    write("scan.in", "#rx_steps: 0.002 0 0\n#geometry_objects_write: 0.02 0.02 0 0.06 0.03 0.002 part.h5");
    place.ok(&["run", "scan.in", "--traces", "2"]);
    assert!(place.path("part.h5").is_file() && place.path("part_h5_materials.json").is_file());
    write("own.in", "#geometry_objects_write: 0.02 0.02 0 0.06 0.03 0.002 own");
    let error = place.fails(&["run", "own.in"], 2);
    assert!(error.contains("would write `own.h5`, where the traces go"), "{error}");
    write(
        "loop.in",
        "#geometry_objects_read: 0 0 0 part.h5 part_h5_materials y\n#geometry_objects_write: 0 0 0 0.1 0.08 0.002 part.h5",
    );
    let error = place.fails(&["run", "loop.in", "--force"], 2);
    assert!(error.contains("would write `part.h5`, which `loop.in` reads"), "{error}");
    write("far.in", "#geometry_objects_write: 0.02 0.02 0 0.06 0.03 0.002 nowhere/part");
    let error = place.fails(&["run", "far.in"], 2);
    assert!(error.contains("but `nowhere` is not a folder"), "{error}");
}

/// `build --slices`: a folder for each section, the bed above them, and their voids side by side. Sections hold on average what the
/// bed holds (Delesse); four of a small bed are within 6 percentage points of it.
#[test]
fn sections_through_a_bed_are_an_ensemble() {
    let place = Place::new();
    let scene =
        "[tank]\nwidth = \"40 cm\"\ndepth = \"40 cm\"\nheight = \"30 cm\"\n[packing]\nmethod = \"random-addition\"\n";
    fs::write(place.path("bed.toml"), scene).unwrap();
    let told = place.json(&[&["build", "bed.toml", "--slices", "4", "--out", "s", "--json"], &COARSE[..]].concat());
    let rows = told["rows"].as_array().unwrap();
    let voids = |name: &str| rows.iter().find(|row| row["name"] == name).unwrap()["voids_percent"].as_f64().unwrap();
    assert!((told["sections"]["mean"].as_f64().unwrap() - voids("bed")).abs() < 6.0, "{told}");
    for (number, at) in [(1, 0.05), (2, 0.15), (3, 0.25), (4, 0.35)] {
        let name = format!("slice-{number}");
        let row = rows.iter().find(|row| row["name"] == *name).unwrap();
        assert!((row["at_m"].as_f64().unwrap() - at).abs() < 1e-12);
        assert!(place.path(&format!("s/{name}/model.in")).is_file());
        let manifest: serde_json::Value =
            serde_json::from_str(&place.read(&format!("s/{name}/manifest.json"))).unwrap();
        assert_eq!(manifest["cells"][2], 1);
    }
    let manifest: serde_json::Value = serde_json::from_str(&place.read("s/manifest.json")).unwrap();
    assert!(manifest["program"].as_str().unwrap().starts_with("ballast-gpr"));
    assert_eq!(
        manifest["spheres"]["stones"].as_u64(),
        rows.iter().find(|r| r["name"] == "bed").unwrap()["stones"].as_u64()
    );
    assert_eq!(place.read("s/slices.csv").lines().count(), 1 + rows.len());
    place.ok(&["run", "s/slice-1", "s/slice-2"]);
}
