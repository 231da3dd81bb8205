//! `report`: one page with everything of some folders, and how they compare with a measurement.

mod comparison;
mod model;
mod page;

use std::path::PathBuf;

use clap::Args;

use crate::cli::error::CliError;
use crate::cli::folder;
use crate::cli::run::{SolverName, plain_run, run_one};
use crate::cli::trace_file;
use crate::files;

use page::Page;

/// Write one self-contained HTML page on folders of `build` and `run`: scene, packing, map, trace, metrics, effects, cost, manifest.
///
/// The figures are inside the page, which opens offline and loads nothing. The first folder's trace is compared with the others',
/// or all with a measurement. Same folders, same bytes.
#[derive(Debug, Clone, Args)]
#[command(
    after_help = "Example:\n  ballast-gpr report tank-clean-seed-1 --run --measured track.dzt --plate plate.dzt --free-space sky.dzt --out report.html"
)]
pub struct ReportArgs {
    /// Folders written by `build`, with the results of `run`.
    #[arg(required = true, value_name = "FOLDER")]
    pub folders: Vec<PathBuf>,
    /// A measured trace that every folder's is compared with.
    #[arg(long, value_name = "TRACE")]
    pub measured: Option<PathBuf>,
    /// The same antenna over a metal plate at the height of the bed's surface: gives amplitude and time zero of the measurement.
    #[arg(long, value_name = "TRACE", requires = "measured")]
    pub plate: Option<PathBuf>,
    /// The same antenna alone, taken off measurement and plate.
    #[arg(long, value_name = "TRACE", requires = "measured")]
    pub free_space: Option<PathBuf>,
    /// Simulate the folders that hold no trace yet, with the built-in solver.
    #[arg(long)]
    pub run: bool,
    /// Title of the page.
    #[arg(long, value_name = "TEXT", default_value = "Radar on ballast")]
    pub title: String,
    /// File to write.
    #[arg(long, value_name = "FILE", default_value = "report.html")]
    pub out: PathBuf,
    /// Overwrite a page that is there.
    #[arg(long)]
    pub force: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// When a folder is not whole, a trace cannot be read, or the page not written.
pub fn run(args: &ReportArgs) -> Result<(), CliError> {
    folder::may_write(&args.out, args.force)?;
    let mut models = vec![];
    for (index, path) in args.folders.iter().enumerate() {
        if !folder::is_built(path) {
            return Err(CliError::input(format!(
                "`{0}` is no folder that `build` has written completely\n\nhint: `ballast-gpr build --out {1}`, then `ballast-gpr run {1}`",
                path.display(),
                folder::typed(path)
            )));
        }
        if args.run && trace_file::result_of(path).is_err() {
            run_one(&plain_run(path, SolverName::Fdtd, false), path)?;
        }
        models.push(model::read(path, index + 1)?);
    }
    let comparisons = match &args.measured {
        Some(measured) => comparison::with_measured(args, measured)?,
        None => comparison::among(&with_results(args))?,
    };
    let page = Page { program: folder::program(), title: args.title.clone(), models, comparisons };
    files::create_folder(args.out.parent().unwrap_or(std::path::Path::new("")))?;
    files::write_bytes(&args.out, page.render()?.as_bytes())?;
    println!("written: {}", args.out.display());
    Ok(())
}

/// The folders that hold a result.
fn with_results(args: &ReportArgs) -> Vec<PathBuf> {
    args.folders.iter().filter(|path| trace_file::result_of(path).is_ok()).cloned().collect()
}
