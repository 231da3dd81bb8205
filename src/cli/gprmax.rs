//! `gprmax`: install the real gprMax privately, or check the one that is there.

use std::path::PathBuf;

use clap::{Args, Subcommand};

use crate::cli::error::CliError;
use crate::gprmax;

/// Install or check the real gprMax.
#[derive(Debug, Clone, Args)]
pub struct GprMaxArgs {
    #[command(subcommand)]
    command: GprMaxCommand,
}

#[derive(Debug, Clone, Subcommand)]
enum GprMaxCommand {
    /// Make a private Python environment with the pinned gprMax under your cache folder (needs Python 3.11 to 3.13).
    Install {
        /// Print as JSON.
        #[arg(long)]
        json: bool,
    },
    /// Tell which gprMax `run --solver gprmax` would use, and whether it works.
    Check {
        /// Python interpreter that has gprMax, in place of the private one.
        #[arg(long, value_name = "PYTHON", env = "BALLAST_GPR_GPRMAX_PYTHON")]
        gprmax_python: Option<PathBuf>,
        /// Print as JSON.
        #[arg(long)]
        json: bool,
    },
}

/// Runs the subcommand.
///
/// # Errors
/// When gprMax cannot be installed, found or started.
pub fn run(args: &GprMaxArgs) -> Result<(), CliError> {
    let (interpreter, json) = match &args.command {
        GprMaxCommand::Install { json } => (gprmax::install::install(&mut |line| eprintln!("  {line}"))?, *json),
        GprMaxCommand::Check { gprmax_python, json } => (gprmax::install::find(gprmax_python.as_deref())?, *json),
    };
    let version = gprmax::install::check(&interpreter)?;
    if json {
        println!(
            "{}",
            serde_json::to_string_pretty(
                &serde_json::json!({ "python": interpreter.python, "python_version": version.python, "gprmax_version": version.gprmax, "h5py_version": version.h5py })
            )?
        );
    } else {
        println!("gprMax {} works with {} (Python {})", version.gprmax, interpreter.python.display(), version.python);
    }
    Ok(())
}
