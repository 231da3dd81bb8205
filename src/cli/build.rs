//! `build`: from a scene to a folder with packing, map, gprMax input and manifest.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;

use crate::cli::build_slices;
use crate::cli::cells::Cells;
use crate::cli::cost_choice;
use crate::cli::error::CliError;
use crate::cli::folder;
use crate::cli::interrupt;
use crate::cli::manifest::{Manifest, Seconds};
use crate::cli::map_figure;
use crate::cli::pack;
use crate::cli::progress::Bar;
use crate::cli::scene_args::SceneArgs;
use crate::cli::settle;
use crate::files;
use crate::forward::Progress;
use crate::gprmax::{self, InputOptions};
use crate::raster;
use crate::scene::{self, FoulingAmount, PackingMethod, Scene, SceneSpec};
use crate::units::Share;

/// Build a scene: pack the stones, mix the materials, draw the map, write the gprMax input.
#[derive(Debug, Clone, Args)]
pub struct BuildArgs {
    /// Scene file, or a folder that holds a `scene.toml`; without one the preset `tank`. The file kept by an earlier build
    /// makes the same bytes again.
    #[arg(value_name = "SCENE.toml|FOLDER")]
    pub scene: Option<PathBuf>,
    #[command(flatten)]
    pub args: SceneArgs,
    /// Folder to write [default: a name from fouling and seed, in the current folder].
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
    /// Build NUM siblings with seeds counted from --seed, each in its own folder below --out.
    #[arg(long, value_name = "NUM", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub realisations: u32,
    /// Cut the bed of spheres with NUM planes, evenly spaced, and build each section for two dimensions in a folder of its own below
    /// --out: an ensemble. The folder itself holds the bed; `slices.csv` has the void share of every section, of the bed and
    /// of discs packed by random sequential adsorption.
    #[arg(long, value_name = "NUM", value_parser = clap::value_parser!(u32).range(1..=10_000), conflicts_with = "realisations")]
    pub slices: Option<u32>,
    /// Choose the cheapest cell size, smoothing and order, with absorbing cells to match, whose error the cost table gives as at most this (see `cost fdtd2d`).
    #[arg(long, value_name = "SHARE", conflicts_with_all = ["cell", "smoothing", "order"])]
    pub tolerance: Option<Share>,
    /// Template for the gprMax input in place of the built-in one.
    #[arg(long, value_name = "FILE")]
    pub template: Option<PathBuf>,
    /// Write into a folder that is not empty, over files of the same names.
    #[arg(long)]
    pub force: bool,
    /// Print the manifests as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// When the scene cannot be built or written.
pub fn run(args: &BuildArgs) -> Result<(), CliError> {
    let mut spec = args.args.spec(args.scene.as_deref())?;
    if let Some(tolerance) = args.tolerance {
        let choice = cost_choice::choose(cost_choice::OwnTable::Plane, tolerance, spec.antenna.frequency)?;
        eprintln!("{}", choice.sentence());
        (spec.grid.cell, spec.grid.smoothing) = (choice.cell, choice.smoothing);
        (spec.grid.order, spec.grid.absorbing_cells) = (choice.order, choice.absorbing_cells);
    }
    let template = args
        .template
        .as_deref()
        .map(|path| Ok::<_, CliError>((path.display().to_string(), files::read_text(path)?)))
        .transpose()?;
    let base = args.out.clone().unwrap_or_else(|| default_folder(&spec, args.realisations));
    if let Some(count) = args.slices {
        return build_slices::run(args, &spec, &base, count, template.as_ref());
    }
    let bar = Bar::new("building");
    let mut manifests: Vec<serde_json::Value> = Vec::new();
    for index in 0..args.realisations {
        if interrupt::requested() {
            return Err(crate::forward::ForwardError::Stopped.into());
        }
        let mut spec = spec.clone();
        spec.seed = spec.seed.wrapping_add(u64::from(index));
        let target = if args.realisations == 1 { base.clone() } else { base.join(format!("seed-{}", spec.seed)) };
        let state = if args.realisations > 1 && !args.force { sibling(&spec, &target)? } else { Sibling::New };
        let said = match state {
            Sibling::Whole => {
                let text = files::read_text(&target.join(folder::MANIFEST))?;
                manifests.push(serde_json::from_str(&text)?);
                "was there already".to_string()
            }
            Sibling::New | Sibling::Begun => {
                let force = args.force || state == Sibling::Begun;
                let manifest = build_folder(&spec, &target, template.clone(), force)?;
                manifests.push(serde_json::to_value(&manifest)?);
                manifest.summary()
            }
        };
        if !args.json {
            println!("{}: {said}", target.display());
        }
        let _ = bar.update(Progress { done: index as usize + 1, total: args.realisations as usize });
    }
    drop(bar);
    if args.json {
        println!("{}", serde_json::to_string_pretty(&manifests)?);
    } else {
        let next =
            if args.realisations == 1 { folder::typed(&base) } else { format!("{}/seed-*", folder::typed(&base)) };
        eprintln!("\nnext: ballast-gpr run {next}");
    }
    Ok(())
}

/// What an earlier call left of one of several siblings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sibling {
    /// Nothing.
    New,
    /// The same scene, not finished.
    Begun,
    /// The same scene, complete.
    Whole,
}

/// Looks at the folder of a sibling: a call that was stopped goes on where it was.
fn sibling(spec: &SceneSpec, target: &Path) -> Result<Sibling, CliError> {
    let Ok(text) = files::read_text(&target.join(folder::SCENE)) else { return Ok(Sibling::New) };
    if spec.packing.method == PackingMethod::Dem || text != scene::resolve(spec)?.spec.to_toml()? {
        return Ok(Sibling::New);
    }
    Ok(if folder::is_built(target) { Sibling::Whole } else { Sibling::Begun })
}

/// Builds one folder.
///
/// # Errors
/// When the scene cannot be built or written.
pub fn build_folder(
    spec: &SceneSpec,
    target: &Path,
    template: Option<(String, String)>,
    force: bool,
) -> Result<Manifest, CliError> {
    folder::check_free(target, force)?;
    let (scene, settled) = settle::resolve(spec, Some(target))?;
    for line in settled.iter().flat_map(settle::told) {
        eprintln!("{line}");
    }
    build_scene(scene, target, template, force)
}

/// Builds the folder of a scene that is resolved and packed.
///
/// # Errors
/// When it cannot be built or written.
pub fn build_scene(
    mut scene: Scene,
    target: &Path,
    template: Option<(String, String)>,
    force: bool,
) -> Result<Manifest, CliError> {
    let started = Instant::now();
    let model = raster::build_model(&scene)?;
    let cells = Cells::of(&model)?;
    if let Some(resolution) = cells.resolution(&model) {
        resolution.check()?;
        if resolution.is_coarse() {
            eprintln!("warning: {resolution}");
        }
    }
    let raster_seconds = started.elapsed().as_secs_f64();
    scene.spec.to_toml()?;
    folder::prepare(target, force)?;
    let started = Instant::now();
    pack::write_scene(&mut scene, target)?;
    gprmax::write_input(&model, target, "model", &InputOptions { template })?;
    map_figure::write(&scene, &model, &cells, target)?;
    let seconds =
        Seconds { packing: scene.packing_seconds, raster: raster_seconds, writing: started.elapsed().as_secs_f64() };
    let manifest = Manifest::of(&scene, &model, &cells, seconds);
    manifest.write(&target.join(folder::MANIFEST))?;
    Ok(manifest)
}

fn default_folder(spec: &SceneSpec, realisations: u32) -> PathBuf {
    let what = match spec.fouling.as_ref().map(|fouling| fouling.amount) {
        None => "clean".to_string(),
        Some(FoulingAmount::Height(height)) => format!("fouling-{}", height.in_unit("cm").replace(' ', "")),
        Some(amount) => format!("fouling-{amount}").replace(' ', "-").replace('%', "pc"),
    };
    if realisations == 1 { format!("tank-{what}-seed-{}", spec.seed).into() } else { format!("tank-{what}").into() }
}
