//! `compare`, `explain`, `pack`, `completions` and the help texts.

mod cli_support;

use std::fs;

use ballast_gpr::gprmax::read_traces;
use cli_support::{COARSE, Place};
use predicates::prelude::*;

/// A folder that has been run, long enough for both echoes.
fn run(place: &Place, name: &str, more: &[&str]) {
    place
        .ok(&[&["build", "--out", name, "--cell", "6mm", "--time-window", "20ns", "--frequency", "600MHz"], more]
            .concat());
    place.ok(&["run", name]);
}

/// Whatever the options, a trace is like itself: correlation 1 and no difference, exactly, since all is computed twice alike.
#[test]
fn a_trace_is_like_itself() {
    let place = Place::new();
    run(&place, "a", &[]);
    for options in [
        &["--window", "2ns..12ns"][..],
        &["--normalise", "none"],
        &["--normalise", "direct-wave"],
        &["--normalise", "plate-echo"],
        &["--time-zero", "first-peak"],
        &["--polarity", "auto"],
    ] {
        let told = place.json(&[&["compare", "a", "a", "--json", "--no-figure"], options].concat());
        let metrics = &told["metrics"];
        assert_eq!(metrics["relative_l2"], 0.0, "{options:?}");
        assert_eq!(metrics["rmse"], 0.0, "{options:?}");
        let correlation = metrics["zero_lag_correlation"].as_f64().unwrap();
        assert!((correlation - 1.0).abs() < 1e-12, "{options:?}: {correlation}");
    }
    assert_eq!(place.names("").iter().filter(|name| name.contains("comparison")).count(), 0);
    // Turned over, the difference is twice the trace.
    let told = place.json(&["compare", "a", "a", "--json", "--no-figure", "--polarity", "flip"]);
    assert!((told["metrics"]["relative_l2"].as_f64().unwrap() - 2.0).abs() < 1e-9);
}

/// The trace written out as text in nanoseconds, with 9 digits, is the trace.
#[test]
fn a_trace_equals_its_text() {
    let place = Place::new();
    run(&place, "a", &["--fouling", "20cm"]);
    let traces = read_traces(&place.path("a/fdtd.h5")).unwrap();
    let trace = traces.radar_trace().unwrap();
    let rows = trace.times().zip(&trace.samples).map(|(time, value)| format!("{:.9} {value:.8e}\n", 1e9 * time));
    place.write("trace.txt", rows.collect::<String>());
    let told = place.json(&["compare", "a", "trace.txt", "--json", "--no-figure"]);
    // Single precision has 7 digits, of which the text keeps all: what is left is the rounding of the times to 1e-9 ns,
    // over a pulse of some 0.5 ns.
    let difference = told["metrics"]["relative_l2"].as_f64().unwrap();
    assert!(difference < 1e-6, "{difference}");
    assert_eq!((&told["a"], &told["b"]), (&"a/fdtd.h5".into(), &"trace.txt".into()));
}

#[test]
fn many_traces_are_compared_with_one_and_drawn() {
    let place = Place::new();
    run(&place, "a", &[]);
    run(&place, "b", &["--fouling", "20cm"]);
    run(&place, "c", &["--seed", "2"]);
    let many = ["compare", "b", "c", "--to", "a", "--each", "--json", "--out", "figures/seen-1.5"];
    let told = place.json(&many);
    assert_eq!(told["ensemble"]["members"], 2);
    let told = &told["members"];
    assert_eq!((&told[0]["a"], &told[0]["b"]), (&"a/fdtd.h5".into(), &"b/fdtd.h5".into()));
    assert_eq!(told[1]["b"], "c/fdtd.h5");
    let late = told[0]["metrics"]["plate_time_error"]["envelope"].as_str().unwrap();
    assert!(!late.starts_with('-'), "fines make the wave slower: {late}");
    let names: Vec<_> =
        ["-1", "-2", ""].iter().flat_map(|k| ["json", "png", "svg"].map(|e| format!("seen-1.5{k}.{e}"))).collect();
    assert_eq!(place.names("figures"), names);
    assert!(fs::read(place.path("figures/seen-1.5-1.png")).unwrap().starts_with(b"\x89PNG"));
    assert!(place.read("figures/seen-1.5-2.svg").contains("<svg"));
    let written: serde_json::Value = serde_json::from_str(&place.read("figures/seen-1.5-1.json")).unwrap();
    assert_eq!(written["metrics"], told[0]["metrics"]);

    let before = place.files("figures");
    let error = place.fails(&many, 2);
    assert!(error.starts_with("error: `figures/seen-1.5.png` exists already\n"), "{error}");
    assert!(place.files("figures") == before);
    place.ok(&[&many[..], &["--force"]].concat());

    let table = place.ok(&["compare", "a", "b", "--no-figure"]);
    for line in ["A: a/fdtd.h5", "B: b/fdtd.h5", "surface echo, waveform, ns", "relative L2 difference"] {
        assert!(table.contains(line), "{table}");
    }
}

/// Preset, scene file, folder and input file tell the same model.
#[test]
fn a_scene_is_explained_from_wherever_it_lies() {
    let place = Place::new();
    let scene = ["--fouling", "20cm", "--moisture", "5%"];
    place.build("a", &scene);
    let from_flags = place.json(&[&["explain", "--json"], &COARSE[..], &scene].concat());
    let from_folder = place.json(&["explain", "a", "--json"]);
    let from_scene = place.json(&["explain", "a/scene.toml", "--json"]);
    let from_input = place.json(&["explain", "a/model.in", "--json"]);
    for key in ["cells", "iterations", "effects", "memory_bytes"] {
        assert_eq!(from_flags[key], from_folder[key], "{key}");
        assert_eq!(from_flags[key], from_scene[key], "{key}");
        assert_eq!(from_flags[key], from_input[key], "{key}");
    }
    assert!(from_input["fouling"].is_null());
    let effects = from_flags["effects"].as_array().unwrap();
    assert!(effects.len() >= 6);
    assert!(effects.iter().all(|effect| effect["reason"].as_str().is_some_and(|reason| reason.len() > 8)));
    let on = |name: &str| {
        effects.iter().find(|effect| effect["name"].as_str().unwrap().starts_with(name)).unwrap()["on"]
            .as_bool()
            .unwrap()
    };
    assert!(on("Debye relaxation") && on("absorbing boundary") && !on("magnetic loss / permeability"));
    let table = place.ok(&["explain", "a"]);
    for word in ["Bulk permittivity", "Arrivals", "Fouling", "Effects", "light cones", "memory: ", "predicted time"] {
        assert!(table.contains(word), "{table}");
    }
    assert!(!place.ok(&["explain", "a/model.in"]).contains("Bulk permittivity"));
}

#[test]
fn a_packing_is_written_in_every_form() {
    let place = Place::new();
    let told = place.json(&["pack", "--out", "p", "--json"]);
    let names = [
        "grading.csv",
        "grading.png",
        "grading.svg",
        "manifest.json",
        "packing.csv",
        "packing.dxf",
        "packing.json",
        "packing.png",
        "packing.scr",
        "packing.svg",
        "packing.txt",
        "scene.toml",
    ];
    assert_eq!(place.names("p"), names);
    let stones = told["stones"].as_u64().unwrap();
    assert_eq!(place.read("p/packing.csv").lines().filter(|line| !line.starts_with(['x', '#'])).count() as u64, stones);
    assert!(told["grading"].as_array().unwrap().len() >= 5);
    assert!(!place.read("p/grading.csv").contains("-0,"), "{}", place.read("p/grading.csv"));
    let table = place.ok(&["pack"]);
    assert!(table.contains("stones") && table.contains(&stones.to_string()), "{table}");
    let gradings = place.ok(&["pack", "--list-gradings"]);
    for name in gradings.lines() {
        place.ok(&["explain", "--json", "--grading", name, "--homogeneous"]);
    }
    assert!(gradings.lines().any(|name| name == "benedetto2018"), "{gradings}");
}

/// The fit on a small tank: what was refitted is told, both ways, and used.
#[test]
fn a_calibration_is_told_and_used() {
    let place = Place::new();
    place.write("small.toml", "[tank]\nwidth = \"80 cm\"\nheight = \"30 cm\"\n");
    let told = place.json(&["pack", "small.toml", "--calibrate", "--json", "--out", "p"]);
    let alpha = told["calibration"]["alpha_m"].as_f64().unwrap();
    assert!(
        told["calibration"]["packings"].as_u64().unwrap() > 10
            && alpha > told["calibration"]["beta_m"].as_f64().unwrap()
    );
    assert!(place.read("p/scene.toml").contains("[packing.input.fit]"), "{}", place.read("p/scene.toml"));
    assert!(place.ok(&["pack", "small.toml", "--calibrate"]).starts_with("dh = alpha D1/D2 - beta refitted on"));
    assert!(place.json(&["pack", "small.toml", "--json"])["calibration"].is_null());
}

#[test]
fn completions_name_every_subcommand() {
    let place = Place::new();
    for shell in ["bash", "zsh", "fish"] {
        let script = place.ok(&["completions", shell]);
        for word in ["build", "compare", "explain", "gprmax", "fouling"] {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
}

#[test]
fn the_help_tells_what_a_user_needs() {
    let place = Place::new();
    let says = |arguments: &[&str], words: &[&str]| {
        let mut assert = place.program().args(arguments).assert().success();
        for word in words {
            assert = assert.stdout(predicate::str::contains(*word));
        }
    };
    says(&["--version"], &["ballast-gpr ", env!("CARGO_PKG_VERSION")]);
    says(
        &["--help"],
        &["Start with:", "ballast-gpr demo", "Exit codes: 0 done", "130 stopped", "explain", "pack", "cost"],
    );
    says(&["demo", "--help"], &["--with-gprmax", "--print-scene", "[default: demo]"]);
    says(
        &["build", "--help"],
        &["SCENE.toml", "--fouling", "40% of voids", "--realisations", "--tolerance", "--geometry", "--force"],
    );
    says(
        &["run", "--help"],
        &["FOLDER|FILE.in", "--solver", "gprmax install", "--jobs", "--precision", "already there are kept"],
    );
    says(&["compare", "--help"], &["--to", "FROM..TO", "plate-echo", "two-column text", "--free-space", "--no-figure"]);
    says(&["explain", "--help"], &["FOLDER|SCENE.toml|FILE.in", "--threads", "--json"]);
    says(&["pack", "--help"], &["--calibrate", "--list-gradings", "--out"]);
    says(&["pulse", "from-plate", "--help"], &["--free-space", "--height", "#excitation_file", "Example:"]);
    says(&["estimate", "--help"], &["TDSP", "SRM", "CRIM", "--thickness", "--seeds", "Example:"]);
    says(&["report", "--help"], &["--measured", "--plate", "--run", "opens offline", "Example:"]);
    says(&["gprmax", "--help"], &["install", "check"]);
    says(&["gprmax", "install", "--help"], &["needs Python 3.11", "--json"]);
    says(&["completions", "--help"], &["bash", "zsh", "fish"]);
    place.program().assert().code(2).stderr(predicate::str::contains("Usage: ballast-gpr <COMMAND>"));
}

/// A reader that goes away before anything is printed ends the program without a word.
#[test]
fn output_that_nobody_reads_is_no_fault() {
    let place = Place::new();
    let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("ballast-gpr"))
        .args(["pack", "--list-gradings"])
        .current_dir(place.path(""))
        .stdout(std::process::Stdio::from(closed_pipe()))
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let code = child.wait().unwrap().code();
    let mut said = String::new();
    std::io::Read::read_to_string(&mut child.stderr.unwrap(), &mut said).unwrap();
    assert_eq!((code, said.as_str()), (Some(141), ""));
}

/// The writing end of a pipe that has no reading end.
fn closed_pipe() -> std::io::PipeWriter {
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    writer
}
