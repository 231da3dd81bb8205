//! What `convert` writes, read by other people's programs: ImpDAR (RD3, DT1), segyio (SEG-Y), NumPy (npz, CSV).

mod common;

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use ballast_gpr::measured::{About, write_csv, write_dt1, write_npz, write_rd3, write_segy};
use ballast_gpr::trace::{BScan, Component};
use ballast_gpr::units::{Hertz, Metres, Seconds};
use common::gprmax;

/// The readers, at these versions; what they need besides comes with gprMax.
const READERS: [&str; 2] = ["impdar==1.2.1", "segyio==1.9.14"];

/// A folder with the readers, installed if need be; nothing where they cannot be had, and that aloud.
fn readers(python: &Path) -> Option<PathBuf> {
    let folder =
        Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("readers-{}", READERS.join("-").replace("==", "-")));
    let complete = folder.join("complete");
    if complete.is_file() {
        return Some(folder);
    }
    let mut install = Command::new(python);
    install.args(["-m", "pip", "install", "--quiet", "--no-deps", "--target"]).arg(&folder).args(READERS);
    let output = install.output().unwrap();
    if output.status.success() {
        fs::write(complete, "").unwrap();
        return Some(folder);
    }
    let why = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!std::env::var("CI").is_ok_and(|value| value == "true"), "the readers are needed: {why}");
    let _ = writeln!(std::io::stderr(), "\nSKIPPED: other readers could not be installed: {why}\n");
    None
}

/// A wave that runs late along the line, as fields of a simulation are: small numbers, time zero between two samples. Its first
/// 100 samples are next to nothing, since one reader takes their mean off, in 16 bits.
fn wave() -> BScan {
    let (traces, points, step) = (7, 300, 5e-12);
    let amplitude = |trace: usize, index: usize| {
        let time = (index as f64 - 180.0 - 9.0 * trace as f64) / 14.0;
        3.7e-4 * (1.0 - 2.0 * time * time) * (-time * time).exp()
    };
    let samples = (0..traces).flat_map(|trace| (0..points).map(move |index| amplitude(trace, index))).collect();
    let name = "wave".into();
    let scan = BScan::new(samples, points, Seconds(step), Seconds(-0.5 * step), Component::Hx, name).unwrap();
    let places = (0..traces).map(|trace| [Metres(0.4 + 0.05 * trace as f64), Metres(0.0), Metres(0.0)]).collect();
    scan.with_positions(places).unwrap()
}

#[test]
fn other_programs_read_what_is_written() {
    let Some(interpreter) = gprmax() else { return };
    let Some(packages) = readers(&interpreter.python) else { return };
    let folder = tempfile::tempdir().unwrap();
    let (scan, path) = (wave(), |ending: &str| folder.path().join(format!("scan.{ending}")));
    let about = About { antenna: None, centre_frequency: Some(Hertz(1.5e9)), antenna_separation: Some(Metres(0.06)) };
    let counts = [
        ("rd3", write_rd3(&path("rd3"), &scan, &about).unwrap().amplitude_of_count),
        ("dt1", write_dt1(&path("DT1"), &scan, &about).unwrap().amplitude_of_count),
    ];
    write_segy(&path("sgy"), &scan, &about).unwrap();
    write_csv(&path("csv"), &scan).unwrap();
    write_npz(&path("npz"), &scan).unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python/read_radar_files.py");
    let output =
        Command::new(&interpreter.python).arg(script).arg(folder.path()).env("PYTHONPATH", packages).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8_lossy(&output.stdout);
    let told: serde_json::Value = serde_json::from_str(text.lines().last().unwrap()).unwrap();
    let number =
        |format: &str, key: &str| told[format][key].as_f64().unwrap_or_else(|| panic!("{format} {key}: {told}"));
    for format in ["rd3", "dt1", "sgy", "csv", "npz"] {
        assert_eq!(told[format]["shape"], serde_json::json!([7, 300]), "{format}");
        assert!((number(format, "step") / 5e-12 - 1.0).abs() < 1e-9, "{format}: {told}");
    }
    // Half a count of 32000 for RD3, and a little for the factor, which is fitted; one and a half for DT1, which the reader cuts to whole numbers after taking a mean off;
    // half of the last of 24 bits for SEG-Y; all digits in CSV.
    for (format, most) in [("rd3", 0.55 / 32000.0), ("dt1", 1.6 / 32000.0), ("sgy", 6e-8), ("csv", 1e-15)] {
        let difference = number(format, "difference");
        println!("{format}: {difference:.2e}");
        assert!(difference <= most, "{format}: {difference:e}");
    }
    for (format, amplitude) in counts {
        assert!((number(format, "factor") / amplitude - 1.0).abs() < 1e-3, "{format}: {told}");
    }
    assert!((number("csv", "first") + 2.5e-12).abs() < 1e-20 && (number("npz", "first") + 2.5e-12).abs() < 1e-20);
    let places = told["sgy"]["x"].as_array().unwrap();
    assert!(places.iter().enumerate().all(|(k, x)| (x.as_f64().unwrap() - 0.4 - 0.05 * k as f64).abs() < 1e-9));
    assert_eq!(told["sgy"]["text"], "C1  WRITTEN BY BALLAST-GPR: WA");
}
