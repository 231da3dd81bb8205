//! Records the commit that the program is built from, for the manifests it writes.

use std::path::Path;
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // Only what changes with a commit, and only if it is there: a path that is missing would rebuild the crate every time.
    let head = Path::new(".git/HEAD");
    if let Ok(text) = std::fs::read_to_string(head) {
        println!("cargo::rerun-if-changed=.git/HEAD");
        let branch = text.strip_prefix("ref: ").map(|name| format!(".git/{}", name.trim()));
        if let Some(branch) = branch.filter(|branch| Path::new(branch).exists()) {
            println!("cargo::rerun-if-changed={branch}");
        }
    }
    let output = Command::new("git").args(["rev-parse", "--short=12", "HEAD"]).output();
    let commit = output.ok().filter(|output| output.status.success());
    let commit = commit.map_or("unknown".into(), |output| String::from_utf8_lossy(&output.stdout).trim().to_string());
    println!("cargo::rustc-env=BALLAST_GPR_COMMIT={commit}");
}
