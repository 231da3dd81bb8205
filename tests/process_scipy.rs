//! Every processing step against NumPy and SciPy on the same samples (`tests/python/process_scipy.py`).

mod common;

use std::collections::BTreeMap;
use std::process::Command;

use ballast_gpr::compare::process::{
    Band, Running, dewow, filter, gain_by_level, gain_by_time, remove_background, short_time_spectrum, stack,
    take_envelope,
};
use ballast_gpr::compare::{
    CompareOptions, Normalisation, Polarity, Step, compare, remove_dc, spectrum, structural_similarity, time_warp,
};
use ballast_gpr::trace::{BScan, Component};
use ballast_gpr::units::{Hertz, Seconds};
use rand::{RngExt as _, SeedableRng as _};

const TIME_STEP: f64 = 25e-9 / 512.0;
const LENGTH: usize = 512;
const TRACES: usize = 12;

/// Twelve traces of three pulses over drift, an offset and noise, the first an outlier; amplitudes of some 1e5 as an
/// instrument counts them.
fn lines() -> BScan {
    let mut random = rand_pcg::Pcg64::seed_from_u64(20);
    let ricker = |t: f64| {
        let a = (std::f64::consts::PI * 1e9 * t).powi(2);
        (1.0 - 2.0 * a) * (-a).exp()
    };
    let mut samples = Vec::new();
    for trace in 0..TRACES {
        let level = if trace == 0 { 0.3 } else { 0.02 };
        for k in 0..LENGTH {
            let t = k as f64 * TIME_STEP;
            let echoes = ricker(t - 5e-9) - 0.4 * ricker(t - 9e-9) + 0.1 * ricker(t - 15e-9 - 0.05e-9 * trace as f64);
            let drift = 0.3 + 0.5 * (0.2e9 * t).sin();
            samples.push(1e5 * (echoes + drift + level * (random.random::<f64>() - 0.5)));
        }
    }
    BScan::new(samples, LENGTH, Seconds(TIME_STEP), Seconds(0.0), Component::Recorded, "lines".into()).unwrap()
}

/// What a script of `tests/python` makes of a JSON value.
fn by_python<T: serde::de::DeserializeOwned>(script: &str, given: &serde_json::Value) -> Option<T> {
    let python = common::gprmax()?.python;
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("given.json");
    std::fs::write(&file, given.to_string()).unwrap();
    let script = format!("{}/tests/python/{script}", env!("CARGO_MANIFEST_DIR"));
    let output = Command::new(python).arg(script).arg(&file).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

fn rows(section: &BScan) -> Vec<&[f64]> {
    section.traces().collect()
}

/// Both compute in double precision what is the same number: 1e-9 of the largest leaves room for the rounding of recursive
/// filters and transforms (1e-12 is what they show) and for nothing else.
#[test]
fn steps_give_what_scipy_gives() {
    let lines = lines();
    let given = serde_json::json!({ "time_step": TIME_STEP, "traces": rows(&lines) });
    let Some(wanted) = by_python::<BTreeMap<String, Vec<Vec<f64>>>>("process_scipy.py", &given) else { return };
    let mut ours: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    let mut put = |name: &str, section: BScan| ours.insert(name.into(), section.samples().to_vec());
    put("mean", remove_dc(&lines).0);
    put("dewow", dewow(&lines, Seconds(3e-9), Running::Mean).unwrap().0);
    put("dewow median", dewow(&lines, Seconds(3e-9), Running::Median).unwrap().0);
    for order in [1, 2, 3, 4, 7] {
        for (name, band) in [
            ("bandpass", Band::Pass(Hertz(0.3e9), Hertz(1.5e9))),
            ("highpass", Band::High(Hertz(0.4e9))),
            ("lowpass", Band::Low(Hertz(2.1e9))),
        ] {
            put(&format!("{name} {order}"), filter(&lines, band, order).unwrap().0);
        }
    }
    put("background", remove_background(&lines, None).unwrap().0);
    put("moving background", remove_background(&lines, Some(5)).unwrap().0);
    let (stacked, step) = stack(&lines, None, None).unwrap();
    put("stack", stacked);
    put("sec", gain_by_time(&lines, 0.15, 1.2).unwrap().0);
    put("agc", gain_by_level(&lines, Seconds(4e-9)).unwrap().0);
    put("envelope", take_envelope(&lines).0);
    let first = lines.trace(0).unwrap();
    ours.insert("spectrum".into(), spectrum(&first).amplitude);
    ours.insert("short-time spectrum".into(), short_time_spectrum(&first, Seconds(4e-9)).unwrap().amplitude);

    let Step::Stacked { dropped, .. } = step else { panic!("{step:?}") };
    assert_eq!(dropped, [0]);
    assert_eq!(wanted["dropped"], [[0.0]]);
    assert_eq!(ours.len() + 1, wanted.len());
    for (name, found) in &ours {
        let wanted: Vec<f64> = wanted[name].concat();
        let largest = wanted.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        assert_eq!(found.len(), wanted.len(), "{name}");
        for (k, (found, wanted)) in found.iter().zip(&wanted).enumerate() {
            assert!((found - wanted).abs() < 1e-9 * largest, "{name}: {found} for {wanted} at {k}");
        }
    }
}

/// The metrics of two traces and of two radargrams: every number written out again in NumPy (the time warping with the whole
/// matrix; the structural similarity equal to that of scikit-image 0.26 where it is installed).
#[test]
fn metrics_give_what_numpy_gives() {
    let a = remove_dc(&lines()).0;
    let samples: Vec<f64> =
        a.traces().flat_map(|trace| trace[8..].iter().chain(&trace[..8])).map(|v| 0.8 * v).collect();
    let b = BScan::new(samples, LENGTH, a.time_step, a.first_sample, a.component, "later".into()).unwrap();
    let given = serde_json::json!({ "a": rows(&a), "b": rows(&b), "band": 10 });
    let Some(wanted) = by_python::<BTreeMap<String, f64>>("compare_numpy.py", &given) else { return };
    let (first, second) = (a.trace(0).unwrap(), b.trace(0).unwrap());
    let options = CompareOptions {
        remove_dc: false,
        normalisation: Normalisation::None,
        polarity: Polarity::Keep,
        ..CompareOptions::default()
    };
    let metrics = compare(&first, &second, &options).unwrap().metrics;
    let lag = metrics.cross_correlation.lag.si() / TIME_STEP;
    assert!((lag - wanted["lag in samples"]).abs() < 0.5, "{lag} for {}", wanted["lag in samples"]);
    let warped = time_warp(&first, &second, Seconds(10.0 * TIME_STEP)).unwrap().unwrap();
    for (name, found) in [
        ("structural similarity", structural_similarity(&a, &b).unwrap()),
        ("time warp", warped.distance),
        ("correlation", metrics.zero_lag_correlation),
        ("rmse", metrics.rmse),
        ("relative l2", metrics.relative_l2),
        ("envelope correlation", metrics.envelope_correlation),
    ] {
        let wanted = wanted[name];
        assert!((found - wanted).abs() < 1e-9 * wanted.abs(), "{name}: {found} for {wanted}");
    }
}
