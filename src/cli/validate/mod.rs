//! `validate`: the numbers of papers, of exact solutions and of gprMax beside ours.

mod agreement;
mod arrivals;
mod benedetto;
mod bias;
mod echoes;
mod irazabal;
mod spheres;

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::cli::error::{CliError, Kind};
use crate::cli::table::Report;
use crate::study::{Row, Verdict};

/// Compare with published numbers, exact solutions and gprMax; exit code 1 when one of them is missed.
#[derive(Debug, Clone, Args)]
pub struct ValidateArgs {
    /// Which cases; all of the tier without a name.
    #[arg(value_enum)]
    pub names: Vec<CaseName>,
    /// `fast` takes under a minute; `full` adds the ensembles and runs real gprMax.
    #[arg(long, value_enum, default_value = "fast")]
    pub tier: Tier,
    /// Folders with gprMax's input and output files for `gprmax`.
    #[arg(long, value_name = "FOLDER", num_args = 1.., default_values = ["validation/gprmax", "validation/gprmax3d"])]
    pub cases: Vec<PathBuf>,
    /// Folder for figures; none are drawn without it.
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
    /// Settled spheres for `permittivity-bias` (`packing.json` of `pack --preset bed --packing dem`) [default: settles them first].
    #[arg(long, value_name = "FILE")]
    pub bed: Option<PathBuf>,
    /// Python interpreter that has gprMax, in place of the private one.
    #[arg(long, value_name = "PYTHON", env = "BALLAST_GPR_GPRMAX_PYTHON")]
    pub gprmax_python: Option<PathBuf>,
    /// Print as JSON.
    #[arg(long, conflicts_with = "markdown")]
    pub json: bool,
    /// Print as Markdown, as in the README.
    #[arg(long)]
    pub markdown: bool,
}

/// The cases.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CaseName {
    /// Packing: Benedetto et al. 2018.
    Benedetto2018,
    /// The built-in solver on homogeneous layers against exact arrivals.
    TankArrivals,
    /// The built-in solver against gprMax's own outputs (in the full tier gprMax runs again, on the tanks too).
    Gprmax,
    /// Spheres with bounded rolling friction: Irazábal et al. 2017 (in the full tier the angle of repose over five seeds each, and
    /// the lateral resistance of a sleeper: hours).
    Irazabal2017,
    /// Settled beds of equal spheres and of ballast gradings: solid shares and voids (full tier).
    Spheres,
    /// Echoes of real packings, ten seeds, clean and fouled, true and equivalent stones (full tier).
    TankEchoes,
    /// Bias of every permittivity estimate on beds of stones, both polarisations and space, four fouling heights (full tier:
    /// minutes, and as many for the spheres to settle).
    PermittivityBias,
}

/// How much to run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Tier {
    /// Under a minute.
    Fast,
    /// Everything.
    Full,
}

/// What a case came to.
pub struct CaseReport {
    /// Name and one line about it.
    pub title: String,
    /// The table to show.
    pub table: Report,
    /// The same as JSON.
    pub json: serde_json::Value,
    /// How many comparisons missed their tolerance.
    pub misses: usize,
}

/// Runs the subcommand.
///
/// # Errors
/// When a case cannot be run, or one of its numbers is missed.
pub fn run(args: &ValidateArgs) -> Result<(), CliError> {
    let names = if !args.names.is_empty() {
        args.names.clone()
    } else if args.tier == Tier::Full {
        CaseName::value_variants().to_vec()
    } else {
        vec![CaseName::Benedetto2018, CaseName::TankArrivals, CaseName::Gprmax, CaseName::Irazabal2017]
    };
    if let Some(folder) = &args.out {
        crate::files::create_folder(folder)?;
    }
    let mut misses = 0;
    let mut json = serde_json::Map::new();
    for name in names {
        let report = match name {
            CaseName::Benedetto2018 => benedetto::validate()?,
            CaseName::TankArrivals => arrivals::validate(args.out.as_deref())?,
            CaseName::Gprmax => agreement::validate(args)?,
            CaseName::Irazabal2017 => irazabal::validate(args.tier)?,
            CaseName::Spheres => spheres::validate()?,
            CaseName::PermittivityBias => bias::validate(args.out.as_deref(), args.bed.as_deref())?,
            CaseName::TankEchoes => echoes::validate(args.out.as_deref())?,
        };
        misses += report.misses;
        let key = name.to_possible_value().map_or(String::new(), |value| value.get_name().to_string());
        if args.markdown {
            println!("**{}**\n\n{}", report.title, report.table.markdown());
        } else if !args.json {
            report.table.print();
            println!();
        }
        json.insert(key, report.json);
    }
    if args.json {
        println!("{}", serde_json::to_string_pretty(&json)?);
    }
    if misses > 0 {
        let word = if misses == 1 { "number misses its" } else { "numbers miss their" };
        return Err(CliError::new(Kind::Verdict, format!("{misses} {word} tolerance")));
    }
    Ok(())
}

/// Turns the rows of a published case into a report.
fn report_of(title: &str, rows: &[Row]) -> Result<CaseReport, CliError> {
    let mut table = Report::new(title, ["quantity", "paper", "ours", "difference", "tolerance", "verdict", "why"]);
    for row in rows {
        let show = |value: Option<f64>| value.map_or("–".into(), |value| format!("{value:.*}", row.decimals));
        table.row([
            row.quantity.clone(),
            show(row.paper),
            show(Some(row.ours)),
            row.difference.map_or("–".into(), |value| format!("{value:+.*}", row.decimals)),
            row.tolerance.map_or("–".into(), |value| format!("{value}")),
            row.verdict.name().into(),
            row.why.clone(),
        ]);
        if row.varies {
            table.in_markdown(2, "varies");
            table.in_markdown(3, "–");
        }
    }
    let misses = rows.iter().filter(|row| row.verdict == Verdict::Differs).count();
    Ok(CaseReport { title: title.into(), table, json: serde_json::to_value(rows)?, misses })
}
