//! `cost`: what accuracy costs in time, measured on this machine.

mod accuracy;
mod dem;
mod dimension;
mod growth;
mod packing;
mod roofline;

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::cli::error::CliError;
use crate::cli::folder;
use crate::units::Metres;

/// Measure error against time and memory, and draw the curve.
#[derive(Debug, Clone, Args)]
pub struct CostArgs {
    /// What to measure: `fdtd2d` and `fdtd3d`, the built-in solver over cell size, smoothing, order and precision; `packing`, the random
    /// sequential adsorption over the number of stones; `growth`, the built-in solver's time over the number of cells in two
    /// and three dimensions, beside what the machine's memory can give; `dimension`, a settled bed in space against sections
    /// through it and against discs: what two dimensions cost in accuracy and three in time; `dem`, settled beds over stiffness,
    /// time step and number of stones, and against stones that are placed and not settled: error of voids, settlement and
    /// radar trace (minutes).
    #[arg(value_enum)]
    pub solver: CostName,
    /// fdtd2d, fdtd3d: finest cell; the others are its doubles up to 8 mm (10 mm in three dimensions). The defaults take
    /// minutes [default: 0.5 mm, in three dimensions 1.25 mm].
    #[arg(long, value_name = "LENGTH")]
    pub finest: Option<Metres>,
    /// packing: most stones; the others are thirds of it down to a thousand. dem: stones of the bed that stiffness and time step
    /// are turned for; its number is turned from a quarter to four times that [default: packing 100000, dem 400].
    #[arg(long, value_name = "NUM", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    pub stones: Option<u32>,
    /// dem: beds of each setting, with seeds from 1 on; their spread is the noise that errors are seen against.
    #[arg(long, value_name = "NUM", default_value_t = 3, value_parser = clap::value_parser!(u64).range(1..=1000))]
    pub seeds: u64,
    /// growth: leave out grids of more cells [default: up to 27 million, which take 1 GB and minutes].
    #[arg(long, value_name = "NUM")]
    pub cells: Option<usize>,
    /// dimension: scene file, or a folder that `build` or `pack` has written, with spheres [default: the preset `bed`, which
    /// is settled first].
    #[arg(long, value_name = "SCENE.toml|FOLDER")]
    pub scene: Option<PathBuf>,
    /// dimension, dem: sections through each bed, and as many packings of discs.
    #[arg(long, value_name = "NUM", default_value_t = 5)]
    pub slices: usize,
    /// Folder for table (CSV, JSON) and figure [default: none are written].
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
    /// fdtd2d, fdtd3d: keep the table in the cache folder, where `--tolerance` reads it.
    #[arg(long)]
    pub keep: bool,
    /// Overwrite files that are there.
    #[arg(long)]
    pub force: bool,
    /// Print as JSON.
    #[arg(long)]
    pub json: bool,
}

/// What has a cost curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CostName {
    /// The built-in solver in two dimensions.
    Fdtd2d,
    /// The built-in solver in three dimensions.
    Fdtd3d,
    /// Random sequential adsorption and compaction.
    Packing,
    /// Growth of the solver's time with the number of cells.
    Growth,
    /// Settled beds: stiffness, time step, number of stones.
    Dem,
    /// A bed in space, sections through it, and discs.
    Dimension,
}

/// Runs the subcommand.
///
/// # Errors
/// When a run fails or a file cannot be written.
pub fn run(args: &CostArgs) -> Result<(), CliError> {
    if let Some(folder) = &args.out {
        folder::prepare(folder, args.force)?;
    }
    match args.solver {
        CostName::Fdtd2d => accuracy::run_plane(args),
        CostName::Fdtd3d => accuracy::run_space(args),
        CostName::Packing => packing::run(args),
        CostName::Growth => growth::run(args),
        CostName::Dem => dem::run(args),
        CostName::Dimension => dimension::run(args),
    }
}
