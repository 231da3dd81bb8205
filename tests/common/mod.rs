//! What several test files share.

use std::io::Write as _;
use std::path::PathBuf;

use ballast_gpr::gprmax::{Interpreter, install};

/// gprMax, installed if need be.
///
/// Where it cannot be had, the test fails if `CI=true`, and else says so aloud and gives nothing: the test then returns.
#[allow(dead_code, reason = "not every test file uses it")]
pub fn gprmax() -> Option<Interpreter> {
    let found = if std::env::var_os(install::PYTHON_WITH_GPRMAX).is_some() {
        install::find(None)
    } else {
        install::install(&mut |line| eprintln!("{line}"))
    };
    match found {
        Ok(interpreter) => Some(interpreter),
        Err(error) if std::env::var("CI").is_ok_and(|value| value == "true") => panic!("gprMax is needed: {error}"),
        Err(error) => {
            // The test runner keeps what `eprintln!` says to itself when a test passes; this has to be seen.
            let _ = writeln!(
                std::io::stderr(),
                "\nSKIPPED: this test needs gprMax, which could not be installed: {error}\n"
            );
            None
        }
    }
}

/// The folder of a reference case under `validation/gprmax`.
#[allow(dead_code, reason = "not every test file uses it")]
pub fn reference_case(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("validation/gprmax").join(name)
}
