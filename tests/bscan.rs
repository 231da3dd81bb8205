//! B-scans: the same traces as gprMax gives, numbered as gprMax numbers them, and resumable.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use ballast_gpr::compare::relative_l2;
use ballast_gpr::gprmax::read_traces;

fn run(folder: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = Command::cargo_bin("ballast-gpr").unwrap().current_dir(folder).args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code(), text(output.stdout), text(output.stderr))
}

/// Five traces against gprMax 4.0.1, both in single precision: 2e-5, as for single traces.
#[test]
fn every_trace_is_that_of_gprmax() {
    let stored = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/gprmax_bscan/15_bscan5");
    let folder = tempfile::tempdir().unwrap();
    fs::copy(stored.join("scene.in"), folder.path().join("scan.in")).unwrap();
    let (code, _, errors) = run(folder.path(), &["run", "scan.in", "-n", "5"]);
    assert_eq!(code, Some(0), "{errors}");
    for number in 1..=5 {
        let ours = read_traces(&folder.path().join(format!("scan{number}.h5"))).unwrap();
        let theirs = read_traces(&stored.join(format!("out{number}.h5"))).unwrap();
        assert_eq!(ours.receivers[0].position, theirs.receivers[0].position);
        let (ours, theirs) = (ours.radar_trace().unwrap(), theirs.radar_trace().unwrap());
        let difference = relative_l2(theirs, ours).unwrap();
        eprintln!("trace {number}: {difference:.1e}");
        assert!(difference <= 2e-5, "trace {number}: {difference:e}");
    }
    // What is there is kept, and more traces are added to it.
    let (code, told, _) = run(folder.path(), &["run", "scan.in", "-n", "6", "--json"]);
    assert_eq!(code, Some(0));
    let outcomes: serde_json::Value = serde_json::from_str(&told).unwrap();
    let kept: Vec<bool> = outcomes.as_array().unwrap().iter().map(|outcome| outcome["kept"] == true).collect();
    assert_eq!(kept, [true, true, true, true, true, false]);
}

/// A trace whose receiver leaves the grid is refused by the name of the receiver; the traces before it stay.
#[test]
fn a_trace_that_leaves_the_grid_is_refused() {
    let stored = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/gprmax_bscan/15_bscan5/scene.in");
    let folder = tempfile::tempdir().unwrap();
    let scene = fs::read_to_string(stored).unwrap();
    fs::write(folder.path().join("scan.in"), scene.replace("#rx_steps: 0.04", "#rx_steps: 0.4")).unwrap();
    let (code, _, errors) = run(folder.path(), &["run", "scan.in", "-n", "2"]);
    assert_eq!(code, Some(2), "{errors}");
    assert!(errors.contains("receiver 1"), "{errors}");
    assert!(folder.path().join("scan1.h5").is_file() && !folder.path().join("scan2.h5").exists());
    let (code, _, errors) = run(folder.path(), &["run", "scan.in", "-n", "2", "--solver", "gprmax"]);
    assert_eq!(code, Some(2));
    assert!(errors.starts_with("error: `--traces` is for the built-in solver\n"), "{errors}");
}
