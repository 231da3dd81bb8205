//! The validation cases of the fast tier, and the table of them in the README.

use std::fs;
use std::path::Path;

use assert_cmd::Command;

fn validate(arguments: &[&str]) -> (bool, String) {
    let output = Command::cargo_bin("ballast-gpr")
        .unwrap()
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .arg("validate")
        .args(arguments)
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    eprintln!("{text}\n{}", String::from_utf8_lossy(&output.stderr));
    (output.status.success(), text)
}

/// Every number of the fast tier is within its tolerance, and the README shows the table as it is now.
#[test]
fn the_fast_tier_agrees_and_the_readme_is_current() {
    let (agrees, table) = validate(&["--tier", "fast", "--markdown"]);
    assert!(agrees, "a number misses its tolerance");
    let readme = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md")).unwrap();
    let begin = "<!-- ballast-gpr validate --markdown -->\n";
    let end = "<!-- end -->";
    let start = readme.find(begin).expect("the README has no validation table") + begin.len();
    let stop = start + readme[start..].find(end).expect("the README's validation table has no end");
    assert_eq!(
        readme[start..stop].trim(),
        table.trim(),
        "the README's table is not current: put the output of `ballast-gpr validate --markdown` there"
    );
}

/// A number that is missed is a verdict of no: a reference with one sample changed is told apart, by name and exit code.
#[test]
fn a_miss_is_told_and_has_exit_code_1() {
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("broken");
    fs::create_dir(&case).unwrap();
    let stored = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/gprmax/01_fs_dipole_2d");
    let scene = fs::read_to_string(stored.join("scene.in")).unwrap();
    // Another receiver than the one the reference was made with: half a wavelength further.
    fs::write(case.join("scene.in"), scene.replace("#rx: 0.25 0.2 0", "#rx: 0.27 0.2 0")).unwrap();
    fs::copy(stored.join("out_f64.h5"), case.join("out_f64.h5")).unwrap();
    let output = Command::cargo_bin("ballast-gpr")
        .unwrap()
        .args(["validate", "gprmax", "--cases"])
        .arg(folder.path())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stdout).contains("DIFFERS"));
    assert_eq!(String::from_utf8_lossy(&output.stderr), "error: 1 number misses its tolerance\n");
}
