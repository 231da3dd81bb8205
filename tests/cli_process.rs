//! `process`, started as a user would.

mod cli_support;

use cli_support::Place;

/// A trace of 512 samples in 25 ns: direct wave, echo of the other sign, offset and drift.
fn horn(scale: f64) -> String {
    let ricker = |t: f64| {
        let a = (std::f64::consts::PI * t).powi(2);
        (1.0 - 2.0 * a) * (-a).exp()
    };
    let line = |k: i32| {
        let t = f64::from(k) * 25.0 / 512.0;
        let v = scale * (ricker(t - 5.0) - 0.5 * ricker(t - 11.0) + 0.02 * t + 0.3);
        format!("{t} {v}\n")
    };
    (0..512).map(line).collect()
}

const STEPS: &str = "dewow=4ns, timezero=direct, bandpass=200MHz..3GHz, crop=-1ns..15ns, normalise=max";

#[test]
fn a_trace_is_processed_written_and_drawn() {
    let place = Place::new();
    place.write("horn.txt", horn(1000.0));
    let told = place.json(&["process", "horn.txt", "out.csv", "--steps", STEPS, "--figure", "seen", "--json"]);
    assert_eq!(place.names(""), ["horn.txt", "out.csv", "seen.png", "seen.svg"]);
    let kinds: Vec<_> = told["steps"].as_array().unwrap().iter().map(|step| step["step"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["dewowed", "time-zero-set", "filtered", "cropped", "normalised"]);
    assert_eq!(told["steps"][2]["from"], "0.2 GHz");
    // The direct wave is at 5 ns, so the first sample kept is at -0.996 ns; from there to 15 ns every 25/512 ns.
    assert_eq!((&told["before"]["samples"], &told["after"]["samples"]), (&512.into(), &328.into()));
    let text = place.read("out.csv");
    assert!(text.contains("# band-pass 0.2 GHz to 3 GHz, Butterworth order 4 forwards and backwards\n"), "{text}");

    // What was written reads back: the direct wave is the largest, at zero, and the echo comes 6 ns later.
    let row = |line: &str| line.split(',').map(|v| v.parse::<f64>().unwrap()).collect::<Vec<_>>();
    let rows: Vec<Vec<f64>> = text.lines().filter(|l| !l.starts_with(['#', 't'])).map(row).collect();
    let extreme = |sign: f64| rows.iter().max_by(|a, b| (sign * a[1]).total_cmp(&(sign * b[1]))).unwrap();
    assert!(extreme(1.0)[0].abs() < 0.05 && (extreme(1.0)[1] - 1.0).abs() < 1e-12);
    assert!((extreme(-1.0)[0] - 6.0).abs() < 0.05 && (extreme(-1.0)[1] + 0.5).abs() < 0.05, "{:?}", extreme(-1.0));
    let told = place.json(&["process", "out.csv", "--steps", "flip", "--json"]);
    assert_eq!(told["before"]["samples"], 328);

    let table = place.ok(&["process", "horn.txt", "--steps", "dc, envelope"]);
    assert!(table.contains("envelope taken") && table.contains("1 trace of 512 samples"), "{table}");
    let error = place.fails(&["process", "horn.txt", "out.csv", "--steps", "dc"], 2);
    assert!(error.starts_with("error: `out.csv` exists already\n"), "{error}");
}

#[test]
fn clipped_samples_and_jumps_are_told() {
    let place = Place::new();
    let cut = |line: &str| {
        let (t, v) = line.split_once(' ').unwrap();
        format!("{t} {}\n", v.parse::<f64>().unwrap().min(700.0))
    };
    place.write("cut.txt", horn(1000.0).lines().map(cut).collect::<String>());
    let output = place.program().args(["process", "cut.txt", "--steps", "dc"]).assert().success().get_output().clone();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.starts_with("warning: `cut.txt` is clipped: "), "{said}");
    let told = place.json(&["process", "cut.txt", "--steps", "dc", "--json"]);
    assert_eq!(told["flaws"][0]["flaw"], "clipped");

    let jump = |line: &str| {
        let (t, v) = line.split_once(' ').unwrap();
        let more = if t.parse::<f64>().unwrap() > 14.0 { 900.0 } else { 0.0 };
        format!("{t} {}\n", v.parse::<f64>().unwrap() + more)
    };
    place.write("jump.txt", horn(1000.0).lines().map(jump).collect::<String>());
    let told = place.json(&["process", "jump.txt", "--steps", "dewow=4ns", "--json"]);
    assert_eq!(told["flaws"][0]["flaw"], "level-jump");
}

#[test]
fn the_help_teaches_the_steps() {
    let place = Place::new();
    let help = place.ok(&["process", "--help"]);
    for word in ["bandpass=FROM..TO", "dewow=3ns", "stack[=all|TRACES]", "sec=RATE", "--free-space", "in the order"] {
        assert!(help.contains(word), "{word} in\n{help}");
    }
}
