//! The command line: one file per subcommand. The only place that prints, reads flags or exits.

mod batch;
mod bscan;
mod build;
mod build_slices;
mod cells;
mod checkpoint;
mod child;
mod compare;
mod comparison_figure;
mod convert;
mod cost;
mod cost_choice;
mod demo;
mod ensemble_figure;
mod error;
mod estimate;
mod experiment;
mod explain;
mod folder;
mod geometry_files;
mod gprmax;
mod inspect;
mod interrupt;
mod manifest;
mod map_figure;
mod pack;
mod pack_spheres;
mod process;
mod process_figure;
mod progress;
mod pulse;
mod report;
mod run;
mod scene_args;
mod settle;
mod snapshots;
mod table;
mod trace_file;
mod validate;

use std::io::Write as _;
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};

pub use error::{CliError, Kind};

/// From a sieve curve to a ground-penetrating-radar trace of railway ballast.
///
/// One command takes a sieve curve, a void ratio, a degree of fouling and an antenna, and gives a packing of stones, its
/// permittivity map and a gprMax input; others simulate it, compare traces, and say what the chosen accuracy costs.
#[derive(Debug, Parser)]
#[command(name = "ballast-gpr", version, propagate_version = true, after_help = AFTER_HELP)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const AFTER_HELP: &str = "\
Start with:
  ballast-gpr demo                          clean and fouled tank: built, simulated, compared, drawn
  ballast-gpr build --fouling 20cm          a folder with packing, map and gprMax input
  ballast-gpr run tank-fouling-20cm-seed-1  its A-scan

Exit codes: 0 done, 1 ran and the verdict is no, 2 your input or files, 3 gprMax, 70 a fault of this program,
130 stopped by Ctrl-C.";

#[derive(Debug, Subcommand)]
enum Command {
    Demo(demo::DemoArgs),
    Build(build::BuildArgs),
    Run(run::RunArgs),
    Compare(compare::CompareArgs),
    Process(process::ProcessArgs),
    Explain(explain::ExplainArgs),
    Inspect(inspect::InspectArgs),
    Convert(convert::ConvertArgs),
    Pack(pack::PackArgs),
    Validate(validate::ValidateArgs),
    Cost(cost::CostArgs),
    Pulse(pulse::PulseArgs),
    Estimate(estimate::EstimateArgs),
    Report(report::ReportArgs),
    Experiment(experiment::ExperimentArgs),
    Gprmax(gprmax::GprMaxArgs),
    /// Print the completion script of a shell: `source <(ballast-gpr completions bash)`.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
}

/// Reads the command line, does what it says and returns the exit code.
pub fn main() -> ExitCode {
    interrupt::end_with_the_reader();
    let cli = Cli::parse();
    interrupt::listen();
    let outcome = match &cli.command {
        Command::Demo(args) => demo::run(args),
        Command::Build(args) => build::run(args),
        Command::Run(args) => run::run(args),
        Command::Compare(args) => compare::run(args),
        Command::Process(args) => process::run(args),
        Command::Explain(args) => explain::run(args),
        Command::Inspect(args) => inspect::run(args),
        Command::Convert(args) => convert::run(args),
        Command::Pack(args) => pack::run(args),
        Command::Validate(args) => validate::run(args),
        Command::Cost(args) => cost::run(args),
        Command::Pulse(args) => pulse::run(args),
        Command::Estimate(args) => estimate::run(args),
        Command::Report(args) => report::run(args),
        Command::Experiment(args) => experiment::run(args),
        Command::Gprmax(args) => gprmax::run(args),
        Command::Completions { shell } => {
            clap_complete::generate(*shell, &mut Cli::command(), "ballast-gpr", &mut std::io::stdout());
            Ok(())
        }
    };
    let _ = std::io::stdout().flush();
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            error.exit_code()
        }
    }
}
