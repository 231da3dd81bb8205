//! `compare` with ensembles and plates, started as a user would.

mod cli_support;

use cli_support::Place;

fn ricker(t: f64) -> f64 {
    let a = (std::f64::consts::PI * t).powi(2);
    (1.0 - 2.0 * a) * (-a).exp()
}

/// A trace as text: 1500 samples of 0.01 ns.
fn text(of: impl Fn(f64) -> f64) -> String {
    (0..1500).map(|k| f64::from(k) * 0.01).map(|t| format!("{t:.2} {}\n", of(t))).collect()
}

/// Six simulations whose base echo comes at 9.0, 9.1, … 9.5 ns, and a measurement with it in their middle and one beyond them.
#[test]
fn an_ensemble_holds_the_measurement_or_tells_where_it_does_not() {
    let place = Place::new();
    let bed = |base: f64| text(move |t| ricker(t - 2.0) - 0.3 * ricker(t - 5.0) - 0.6 * ricker(t - base));
    let names: Vec<String> = (0..6).map(|k| format!("sim{k}.txt")).collect();
    for (k, name) in names.iter().enumerate() {
        place.write(name, bed(9.0 + 0.1 * k as f64));
    }
    place.write("inside.txt", bed(9.25));
    place.write("late.txt", bed(10.25));
    let run = |measured: &str, more: &[&str]| {
        let members: Vec<&str> = names.iter().map(String::as_str).collect();
        [&["compare"], members.as_slice(), &["--to", measured], more]
            .concat()
            .iter()
            .map(ToString::to_string)
            .collect::<Vec<_>>()
    };
    let json = |measured: &str| {
        let words = run(measured, &["--json", "--no-figure"]);
        place.json(&words.iter().map(String::as_str).collect::<Vec<_>>())
    };
    let inside = json("inside.txt");
    assert_eq!((&inside["ensemble"]["members"], inside["members"].as_array().unwrap().len()), (&6.into(), 6));
    // The mean of 9.0 to 9.5 ns is 9.25 ns; the sample deviation of six even steps of 0.1 ns is 0.1 sqrt(3.5) = 0.187 ns.
    let late = &inside["ensemble"]["metrics"]["plate echo, envelope, ns"];
    assert!(late["mean"].as_f64().unwrap().abs() < 0.005, "{late}");
    assert!((late["deviation"].as_f64().unwrap() - 0.187).abs() < 0.005, "{late}");
    let share = |told: &serde_json::Value| told["ensemble"]["inside_span"].as_f64().unwrap();
    let outside = json("late.txt");
    assert!(share(&inside) > 0.9 && share(&outside) < share(&inside) - 0.05, "{} {}", share(&inside), share(&outside));
    assert_eq!(inside["ensemble"]["inside_span_of_a_member"], 5.0 / 7.0);

    let words = run("late.txt", &["--out", "seen/band"]);
    let table = place.ok(&words.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(table.contains("measured samples between smallest and largest"), "{table}");
    assert_eq!(place.names("seen"), ["band.json", "band.png", "band.svg"]);
    let words = run("late.txt", &["--out", "seen/band", "--each", "--force"]);
    place.ok(&words.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(place.names("seen").len(), 3 + 3 * 6);
}

/// The antenna counts 4000 for a perfect reflection and turns the sign; the bed reflects 0.3 at its surface.
#[test]
fn a_plate_makes_amplitudes_reflections() {
    let place = Place::new();
    let direct = |t: f64| ricker(t - 2.0);
    place.write("measured.txt", text(|t| 4000.0 * (direct(t) + 0.3 * ricker(t - 6.0) + 0.5 * ricker(t - 11.0))));
    place.write("plate.txt", text(|t| 4000.0 * (direct(t) + ricker(t - 6.0) + 0.2 * ricker(t - 10.0))));
    place.write("simulated.txt", text(|t| -7e-3 * (direct(t) + 0.3 * ricker(t - 6.0) + 0.5 * ricker(t - 11.0))));
    place.write("simulated-plate.txt", text(|t| -7e-3 * (direct(t) + ricker(t - 6.0))));
    let base = ["compare", "simulated.txt", "measured.txt", "--plate", "plate.txt", "--polarity", "auto"];
    for more in [&["--plate-simulated", "simulated-plate.txt"][..], &[]] {
        let told = place.json(&[&base[..], more, &["--json", "--no-figure"]].concat());
        assert!(told["metrics"]["rmse"].as_f64().unwrap() < 1e-3, "{told}");
        let surface = told["picks_b"]["surface"]["picked"]["waveform"]["amplitude"].as_f64().unwrap();
        assert!((surface.abs() - 0.3).abs() < 0.003, "{surface}");
        let by = told["steps_b"].as_array().unwrap().iter().find(|step| step["step"] == "normalised").unwrap();
        assert_eq!(by["by"], "plate echo of `plate.txt`");
    }
    // From a height of 0.6 m the plate echo is due at 1.2 m / c = 4.003 ns; it is at 6 ns in both plates.
    let more = ["--plate-simulated", "simulated-plate.txt", "--plate-height", "60cm", "--json", "--no-figure"];
    let told = place.json(&[&base[..], &more].concat());
    let time = told["picks_a"]["surface"]["picked"]["waveform"]["time"].as_str().unwrap().to_string();
    let time: f64 = time.trim_end_matches(" ns").parse().unwrap();
    assert!((time - 4.003).abs() < 0.002, "{time}");
}
