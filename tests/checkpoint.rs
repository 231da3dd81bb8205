//! `run` is killed at random moments and goes on: the same bytes.

mod cli_support;

use std::fs;
use std::process::{Command, Stdio};
use std::time::Duration;

use cli_support::Place;

/// Stones, a wet one of two poles, an ore and a metal box in 60 x 56 x 64 cells.
fn input(steps: usize) -> String {
    let mut text = format!(
        "#title: killed\n#domain: 0.12 0.112 0.128\n#dx_dy_dz: 0.002 0.002 0.002\n#time_window: {steps}\n#pml_cells: 6\n\
         #material: 6 0.001 1 0 stone\n#material: 3 0.01 1 0 wet\n#add_dispersion_debye: 2 3 9e-12 1 9e-11 wet\n\
         #material: 4 0 1.5 2 ore\n#waveform: ricker 1 2e9 pulse\n#hertzian_dipole: y 0.06 0.05 0.1 pulse\n\
         #rx: 0.08 0.05 0.1\n#rx: 0.04 0.07 0.03\n#box: 0 0 0 0.12 0.112 0.03 wet\n"
    );
    for k in 0..20 {
        let place = |factor: f64, size: f64| (f64::from(k) * factor).fract() * size;
        let material = if k % 5 == 0 { "ore" } else { "stone" };
        text += &format!(
            "#sphere: {:.3} {:.3} {:.3} 0.011 {material}\n",
            0.012 + place(0.618, 0.096),
            0.012 + place(0.755, 0.088),
            0.012 + place(0.57, 0.07)
        );
    }
    for step in [3, steps / 3, steps / 2, 3 * steps / 4, steps - 1] {
        text += &format!("#snapshot: 0.02 0.02 0.02 0.1 0.1 0.1 0.008 0.008 0.008 {step} at_{step}.h5\n");
    }
    text + "#box: 0.05 0.05 0.01 0.07 0.07 0.02 pec\n"
}

/// Killed while it steps or writes, with 1, 2 and 4 threads in turn, until it has been let alone: what it leaves is what an
/// undisturbed run leaves, to the byte, snapshots included, and the checkpoint is gone.
#[test]
fn a_killed_run_goes_on_to_the_same_bytes() {
    for precision in ["single", "double"] {
        let place = Place::new();
        place.write("a.in", input(900));
        place.ok(&["run", "a.in", "--precision", precision, "--checkpoint", "off", "--out", "plain.h5"]);
        let mut went_on = 0;
        for round in 0u64.. {
            let threads = [1, 2, 4][round as usize % 3].to_string();
            let mut child = Command::new(assert_cmd::cargo::cargo_bin("ballast-gpr"))
                .args(["run", "a.in", "--precision", precision, "--checkpoint", "0.02s", "--threads", &threads])
                .current_dir(place.path(""))
                .stdout(Stdio::null())
                .stderr(Stdio::piped())
                .spawn()
                .unwrap();
            if went_on < 4 && round < 200 {
                // Moments from 50 ms to half a second after the start, none of them twice.
                std::thread::sleep(Duration::from_millis(50 + round * 137 % 450));
                // An error says that it was faster; the result shows.
                let _ = child.kill();
            }
            let output = child.wait_with_output().unwrap();
            let told = String::from_utf8(output.stderr).unwrap();
            went_on += usize::from(told.contains("note: goes on after step "));
            if output.status.success() {
                break;
            }
        }
        assert!(went_on >= 1, "was never killed in time");
        assert!(fs::read(place.path("a.h5")).unwrap() == fs::read(place.path("plain.h5")).unwrap());
        assert!(!place.path("a.h5.checkpoint").exists() && !place.path("a_snaps.partial").exists());
        for step in [3, 300, 450, 675, 899] {
            let [killed, plain] =
                ["a", "plain"].map(|name| fs::read(place.path(&format!("{name}_snaps/at_{step}.h5"))).unwrap());
            assert!(killed == plain, "snapshot of step {step}");
        }
    }
}

/// A checkpoint without the snapshots that the run had taken by then is of no use.
#[test]
fn a_snapshot_that_went_missing_is_named() {
    let place = Place::new();
    place.write("a.in", input(900));
    let mut child = Command::new(assert_cmd::cargo::cargo_bin("ballast-gpr"))
        .args(["run", "a.in", "--checkpoint", "0s"])
        .current_dir(place.path(""))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    // The first checkpoint after the third snapshot is the one to go on from.
    while !(place.path("a_snaps.partial/at_450.h5").exists() && place.path("a.h5.checkpoint").exists()) {
        assert!(child.try_wait().unwrap().is_none(), "was never stopped in time");
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    fs::remove_file(place.path("a_snaps.partial/at_3.h5")).unwrap();
    let error = place.fails(&["run", "a.in"], 2);
    assert!(error.contains("but snapshot 1, of step 3, is not there\n\nhint: begin anew with `--fresh`"), "{error}");
    // What a kill in the midst of writing leaves.
    place.write("a_snaps.partial/.writing-x1.partial", "half");
    place.ok(&["run", "a.in", "--fresh"]);
    assert!(place.path("a_snaps/at_3.h5").exists() && !place.path("a_snaps.partial").exists());
}

/// `--resume` wants a checkpoint, `--fresh` writes over whatever is there, and a file that is none is refused.
#[test]
fn flags_say_what_happens_to_a_checkpoint() {
    let place = Place::new();
    place.write("a.in", input(20));
    let error = place.fails(&["run", "a.in", "--resume"], 2);
    assert!(error.starts_with("error: there is no checkpoint `a.h5.checkpoint` to go on from\n\nhint: "), "{error}");
    place.write("a.h5.checkpoint", "something else");
    let error = place.fails(&["run", "a.in"], 2);
    assert!(error.starts_with("error: `a.h5.checkpoint` is not a checkpoint\n\nhint: "), "{error}");
    assert!(!place.path("a.h5").exists());
    place.ok(&["run", "a.in", "--fresh"]);
    assert_eq!(place.read("a.h5.checkpoint"), "something else", "a file that the run did not write stays");
    let error = place.fails(&["run", "a.in", "--force", "--checkpoint", "10"], 2);
    assert!(error.contains("write for example `90s`, `10min`, `2h` or `off`"), "{error}");
}
