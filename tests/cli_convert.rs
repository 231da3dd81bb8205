//! `inspect` and `convert`, as a user would start them.

mod cli_support;

use std::fs;
use std::path::Path;

use ballast_gpr::gprmax::read_traces;
use ballast_gpr::measured::{Format, Recording, read};
use cli_support::Place;
use predicates::prelude::*;

fn repository(path: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path).display().to_string()
}

/// A simulated B-scan of five numbered files, as a user's folder.
fn place_with_scan() -> Place {
    let place = Place::new();
    fs::create_dir(place.path("scan")).unwrap();
    for number in 1..=5 {
        let from = repository(&format!("validation/gprmax_bscan/15_bscan5/out{number}.h5"));
        fs::copy(from, place.path(&format!("scan/out{number}.h5"))).unwrap();
    }
    place
}

/// Ez of every numbered file, to half a count, through each format; the magnetic field half a step before it.
#[test]
fn a_simulated_scan_goes_into_every_format() {
    let place = place_with_scan();
    let traces: Vec<_> = (1..=5).map(|k| read_traces(&place.path(&format!("scan/out{k}.h5"))).unwrap()).collect();
    let step = traces[0].time_step.si();
    for (name, files) in [("a.rd3", 2), ("b.DT1", 2), ("c.csv", 1), ("d.npz", 1)] {
        let told = place.json(&["convert", "scan", name, "--json"]);
        assert_eq!((told["files"].as_array().unwrap().len(), told["traces"].as_u64()), (files, Some(5)), "{name}");
        let amplitude = told["amplitude_of_one_count"].as_f64().unwrap();
        if Format::of(Path::new(name)).is_empty() {
            assert_eq!(amplitude, 1.0);
            continue;
        }
        let recording = read(&place.path(name)).unwrap();
        assert_eq!(recording.warnings, []);
        let scan = &recording.channels[0];
        assert!((scan.time_step.si() / step - 1.0).abs() < 1e-12);
        for (ours, theirs) in scan.traces().zip(&traces) {
            let trace = theirs.radar_trace().unwrap();
            let near = |(count, value): (&f64, &f64)| (count * amplitude - value).abs() <= 0.500_001 * amplitude;
            assert!(ours.iter().zip(&trace.samples).all(near), "{name}");
        }
    }
    let seen = place.json(&["inspect", "c.csv", "--json"]);
    assert_eq!(seen["channels"][0]["traces"], 5);
    place.ok(&["convert", "scan", "hx.csv", "--component", "Hx"]);
    let first = place.json(&["inspect", "hx.csv", "--json"])["channels"][0]["first_sample_s"].as_f64().unwrap();
    assert!((first + 0.5 * step).abs() < 1e-12 * step, "{first}");
    // Whole picoseconds, band-limited: the trace is the same to 1e-3 of its peak, sample by sample where both have one.
    place.ok(&["convert", "scan", "e.sgy", "--step", "5ps"]);
    let segy = read(&place.path("e.sgy")).unwrap();
    assert!((segy.channels[0].time_step.si() - 5e-12).abs() < 1e-24 && segy.channels[0].count() == 5);
    place.ok(&["convert", "e.sgy", "e.csv"]);
    let told = place.json(&["compare", "scan/out1.h5", "e.csv", "--json", "--no-figure"]);
    assert!(told["metrics"]["relative_l2"].as_f64().unwrap() < 1e-2, "{}", told["metrics"]);
}

/// Times of a digitised curve are uneven: refused with a hint, then brought onto an even axis by the step that it asks for.
#[test]
fn uneven_times_are_made_even_when_asked() {
    let place = Place::new();
    let rows = (0..100).map(|k| f64::from(k) + 0.4 * f64::from(k * 37 % 7) / 7.0).map(|k| 0.1 * k);
    let rows = rows.map(|t| format!("{t:.9} {:.9}\n", t.sin())).collect::<String>();
    place.write("curve.txt", format!("t_ns v\n{rows}"));
    assert!(place.fails(&["convert", "curve.txt", "even.csv"], 2).contains("hint: give a step to resample to"));
    place.ok(&["convert", "curve.txt", "even.csv", "--step", "0.05ns"]);
    let even = place.read("even.csv");
    let pairs: Vec<(f64, f64)> = even
        .lines()
        .skip(1)
        .map(|line| line.split_once(',').map(|(t, v)| (t.parse().unwrap(), v.parse().unwrap())).unwrap())
        .collect();
    assert!(pairs.len() > 190);
    // The largest gap is 0.14: a cubic spline is off by 5/384 of its fourth power, and its free ends by the second.
    assert!(pairs.iter().all(|(t, v)| (v - t.sin()).abs() < 3e-3));
}

/// Whole numbers are kept to the last bit, through either pair, in either direction.
#[test]
fn counts_are_kept() {
    let place = Place::new();
    let line = repository("tests/corpus/dzt/sixteen-bits.dzt");
    place.ok(&["convert", &line, "a.rd3"]);
    place.ok(&["convert", "a.rad", "b.HD"]);
    let (first, last) = (read(Path::new(&line)).unwrap(), read(&place.path("b.DT1")).unwrap());
    assert_eq!(first.channels[0].samples(), last.channels[0].samples());
    assert!((first.channels[0].first_sample.si() - last.channels[0].first_sample.si()).abs() < 1e-20);
    let places = |recording: &Recording| recording.channels[0].positions().unwrap().to_vec();
    let pairs = places(&first).into_iter().zip(places(&last));
    // DT1 holds positions in 32 bits: 24 of them for numbers up to 0.2.
    assert!(pairs.into_iter().all(|(one, other)| (one[0].si() - other[0].si()).abs() < 1e-8));
    place.program().args(["convert", "a.rad", "b.HD"]).assert().code(2);
    place.ok(&["convert", "a.rad#2", "b.HD", "--force"]);
    assert_eq!(read(&place.path("b.DT1")).unwrap().channels[0].samples(), first.channels[0].trace(2).unwrap().samples);
}

#[test]
fn a_recording_is_shown_and_one_trace_of_it_taken_aloud() {
    let place = Place::new();
    let line = repository("tests/corpus/dzt/two-channels.dzt");
    let told = place.json(&["inspect", &line, "--json"]);
    assert_eq!((&told["format"], &told["channels"][1]["traces"]), (&"GSSI DZT".into(), &5.into()));
    assert_eq!(told["centre_frequency_hz"], 1e9);
    let table = place.ok(&["inspect", &line, "--header"]);
    for word in ["traces, channel 1", "5 (0 to 4)", "1 ns to 23 ns", "41000SA", "1 GHz", "rhf_epsr"] {
        assert!(table.contains(word), "{word}: {table}");
    }
    place.ok(&["inspect", &line, "--figure", "seen/line-1.5"]);
    assert_eq!(place.names("seen"), ["line-1.5.png", "line-1.5.svg"]);
    assert!(place.read("seen/line-1.5.svg").contains("channel 1"));
    assert!(place.fails(&["inspect", &line, "--figure", "seen/line-1.5"], 2).contains("exists already"));
    let warned = place.ok(&["inspect", &repository("tests/corpus/iprb/short.iprb")]);
    assert!(warned.contains("experimental"), "{warned}");
    place.ok(&["convert", &format!("{line}#1:3"), "one.csv"]);
    assert_eq!(place.read("one.csv").lines().count(), 13);
    // Sample 0 of trace 3 of channel 1: (29 + 21 + 0) mod 101 - 50 = 0; sample 1: 13 more, times 300.
    assert_eq!(place.read("one.csv").lines().take(3).collect::<Vec<_>>(), ["time_ns,trace_0", "1,0", "3,3900"]);
    let said = place.program().args(["compare", &line, &line, "--no-figure"]).output().unwrap();
    let said = String::from_utf8(said.stderr).unwrap();
    assert!(
        said.contains("holds 5 traces: the mean of 1 to 4 is taken") && said.contains("holds 2 channels: 0 is taken"),
        "{said}"
    );
}

#[test]
fn the_help_names_formats_and_what_is_experimental() {
    let place = Place::new();
    for (command, words) in [
        ("inspect", ["GSSI", "SEG-Y", "Experimental", "ballast-gpr inspect plate.dzt --figure plate"]),
        ("convert", [".rd3", "--step", "on trial", "--component"]),
    ] {
        for word in words {
            place.program().args([command, "--help"]).assert().success().stdout(predicate::str::contains(word));
        }
    }
}
