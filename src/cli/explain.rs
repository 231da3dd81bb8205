//! `explain`: what will be simulated and why, what is left out and why, memory and predicted time.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::Args;

use crate::cli::cost_choice;
use crate::cli::error::CliError;
use crate::cli::scene_args::SceneArgs;
use crate::cli::table::Report;
use crate::fdtd::{self, Prediction, TimeShares};
use crate::gprmax;
use crate::model::{self, Effect, Effects, Model, Resolution};
use crate::raster;
use crate::scene::{self, EquivalentStone, Scene, SceneSpec};
use crate::units::{Metres, Share};

/// Explain a scene before anything runs.
#[derive(Debug, Clone, Args)]
pub struct ExplainArgs {
    /// A folder written by `build`, a scene file, or a gprMax input file; without one the preset `tank`.
    #[arg(value_name = "FOLDER|SCENE.toml|FILE.in")]
    pub target: Option<PathBuf>,
    #[command(flatten)]
    pub args: SceneArgs,
    /// Threads that the prediction is for [default: all cores].
    #[arg(long, value_name = "NUM")]
    pub threads: Option<NonZeroUsize>,
    /// Say which cell size, averaging and order keep this error, by the cost table of two or of three dimensions.
    #[arg(long, value_name = "SHARE", conflicts_with = "json")]
    pub tolerance: Option<Share>,
    /// Print as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// When the target cannot be read or the scene resolved.
pub fn run(args: &ExplainArgs) -> Result<(), CliError> {
    let is_input =
        args.target.as_ref().is_some_and(|path| path.extension().is_some_and(|e| e.eq_ignore_ascii_case("in")));
    let (scene, model) = if let (true, Some(path)) = (is_input, &args.target) {
        if args.args != SceneArgs::default() {
            return Err(CliError::input(format!(
                "`{}` is a gprMax input file, which no flag of a scene can change\n\nhint: leave the flag out, or change the file",
                path.display()
            )));
        }
        let read = gprmax::read_input(path)?;
        for note in &read.notes {
            eprintln!("note: {note}");
        }
        (None, read.model)
    } else {
        let spec: SceneSpec = args.args.spec(args.target.as_deref())?;
        let scene = scene::resolve(&spec)?;
        let model = raster::build_model(&scene)?;
        (Some(scene), model)
    };
    let Forecast { effects, prediction, resolution } = Forecast::of(&model, args.threads)?;
    if args.json {
        let value = serde_json::json!({
            "bulk_permittivity": scene.as_ref().map(|scene| &scene.bulk),
            "layers": scene.as_ref().map(|scene| &scene.layers),
            "arrivals": scene.as_ref().map(|scene| &scene.arrivals),
            "fouling": scene.as_ref().and_then(|scene| scene.fouling.as_ref()),
            "cells": model.grid.cells,
            "time_step_s": model.time_step(),
            "iterations": model.iterations(),
            "order": model.order,
            "scene_effects": scene.iter().flat_map(scene_effects).map(|(name, on, reason)| serde_json::json!({
                "name": name, "on": on, "reason": reason
            })).collect::<Vec<_>>(),
            "effects": effects.list,
            "memory_bytes": prediction.bytes,
            "predicted_seconds": prediction.seconds,
            "cell_steps": prediction.cell_steps,
            "shares_of_time": {
                "electric conductivity": prediction.shares.conduction,
                "Debye relaxation": prediction.shares.dispersion,
                "absorbing boundary": prediction.shares.boundary,
            },
            "share_of_cell_steps_left_out": prediction.share_saved,
            "snapshots": model.snapshots.iter().map(gprmax::snapshot_file).collect::<Vec<_>>(),
            "cells_per_shortest_wavelength": resolution.as_ref().map(|resolution| resolution.cells_per_wavelength),
        });
        println!("{}", serde_json::to_string_pretty(&value)?);
        return Ok(());
    }
    if let Some(scene) = &scene {
        print_scene(scene);
    }
    print_model(&model);
    let mut table = Report::new("Effects", ["effect", "", "why", "share of the grid", "share of the time", "memory"]);
    for (name, on, why) in scene.iter().flat_map(scene_effects) {
        table.row([name.into(), if on { "on" } else { "off" }.into(), why, "–".into(), "–".into(), "–".into()]);
    }
    for effect in &effects.list {
        let share = if effect.share > 0.0 { percent(effect.share) } else { "–".into() };
        let memory = if effect.bytes > 0 { human_bytes(effect.bytes) } else { "–".into() };
        table.row([
            effect.name.to_string(),
            if effect.on { "on" } else { "off" }.into(),
            effect.reason.clone(),
            share,
            share_of_time(prediction.shares, effect).map_or("–".into(), percent),
            memory,
        ]);
    }
    let left_out = if prediction.share_saved > 0.0 { "on" } else { "off" };
    let why = format!("{} of the cell-steps are left out", percent(prediction.share_saved));
    table.row(["light cones".into(), left_out.into(), why, "–".into(), "–".into(), "–".into()]);
    table.print();
    if prediction.shares != TimeShares::default() {
        println!(
            "share of the time: what a step without the effect took less, in a trial of some tens of milliseconds on this machine"
        );
    }
    println!(
        "share of the grid: of its edges (of its cells for the boundary), and so of the cell-steps before light cones"
    );
    if let Some(resolution) = &resolution {
        println!(
            "resolution: {:.1} cells per shortest wavelength ({:.1} mm in `{}` at {:.2} GHz)",
            resolution.cells_per_wavelength,
            1e3 * resolution.wavelength.si(),
            resolution.material,
            1e-9 * resolution.frequency.si()
        );
    }
    print_files(&model)?;
    println!("memory: {}", human_bytes(prediction.bytes));
    println!(
        "predicted time of the built-in solver: {:.2} s for {:.2e} cell-steps, {:.0} % of them left out (no wave there that a \
         receiver will see)",
        prediction.seconds,
        prediction.cell_steps as f64,
        100.0 * prediction.share_saved
    );
    if let Some(tolerance) = args.tolerance {
        println!("{}", cost_choice::choose_for(&model, tolerance)?.sentence());
    }
    if let Some(resolution) = resolution.filter(Resolution::is_coarse) {
        eprintln!("warning: {resolution}");
    }
    Ok(())
}

/// What of the time an effect takes, where it was measured.
fn share_of_time(shares: TimeShares, effect: &Effect) -> Option<f64> {
    match effect.name.split(' ').next() {
        Some("electric") => shares.conduction,
        Some("Debye") => shares.dispersion,
        Some("absorbing") => shares.boundary,
        _ => None,
    }
}

/// What a run will be like.
struct Forecast {
    effects: Effects,
    prediction: Prediction,
    resolution: Option<Resolution>,
}

impl Forecast {
    /// Paints a model, two- or three-dimensional, and reads off it what a run will be like.
    fn of(model: &Model, threads: Option<NonZeroUsize>) -> Result<Self, CliError> {
        if model.is_plane() {
            let painted = model::paint(model)?;
            return Ok(Self {
                effects: Effects::of(model, &painted),
                prediction: fdtd::predict(model, &painted, threads)?,
                resolution: Resolution::of(model, &painted),
            });
        }
        let painted = model::paint3(model)?;
        Ok(Self {
            effects: Effects::of_three(model, &painted),
            prediction: fdtd::predict_three(model, &painted, threads)?,
            resolution: Resolution::of_three(model, &painted),
        })
    }
}

/// What of the scene itself is in the model, and why: these change materials, not the solver.
fn scene_effects(scene: &Scene) -> Vec<(&'static str, bool, String)> {
    let spec = &scene.spec;
    let fouling = match (&spec.fouling, scene.bed.fouled_height > 0.0) {
        (Some(fouling), true) => {
            let height = Metres(scene.bed.fouled_height).in_unit("cm");
            (
                true,
                format!(
                    "{} of `{}` fills {} of the voids up to {height}",
                    fouling.amount, fouling.material, fouling.filling
                ),
            )
        }
        (Some(fouling), false) => (false, format!("the scene asks for {}", fouling.amount)),
        (None, _) => (false, "the scene has no `[fouling]`".into()),
    };
    let water = spec.moisture.unwrap_or_default();
    let moisture = match (water.fines.si() > 0.0, water.voids.si() > 0.0) {
        (false, false) => (false, "the scene adds no water".into()),
        _ => (true, format!("{} of the fines, {} of the open voids", water.fines, water.voids)),
    };
    let equivalent = spec.packing.stone_permittivity == EquivalentStone::Equivalent2d;
    let why = if equivalent { "`stone_permittivity = \"equivalent-2d\"`" } else { "`stone_permittivity = \"true\"`" };
    vec![
        ("fouling", fouling.0, fouling.1),
        ("moisture", moisture.0, moisture.1),
        ("2-D equivalent stone", equivalent, why.into()),
    ]
}

fn print_scene(scene: &Scene) {
    let spec = &scene.spec;
    println!("{} (seed {})\n", spec.title, spec.seed);
    let mut table = Report::new(
        "Bulk permittivity: a 3-D mixture and a 2-D section (Ez along the stones) are not the same medium",
        ["zone", "solid %", "3-D mixture", "2-D, true stone", "stone in the model", "2-D as modelled"],
    );
    for zone in &scene.bulk {
        table.row([
            zone.zone.into(),
            format!("{:.1}", 100.0 * zone.solid_share),
            format!("{:.3}", zone.mixture),
            format!("{:.3}", zone.two_dimensional),
            format!("{:.3}", zone.stone_in_model),
            format!("{:.3}", zone.two_dimensional_in_model),
        ]);
    }
    table.print();
    println!(
        "The model as it is answers \"what would a trace over this 2-D section look like\"; with `--equivalent-2d` it answers\n\
         \"when do the echoes of the real, three-dimensional bed arrive\".\n"
    );
    let mut table = Report::new("Arrivals of a plane wave through the mixture, from the emission", ["echo", "ns"]);
    table.row(["surface".into(), format!("{:.3}", 1e9 * scene.arrivals.surface.si())]);
    for (layer, time) in &scene.arrivals.interfaces {
        table.row([format!("bottom of {layer}"), format!("{:.3}", 1e9 * time.si())]);
    }
    table.row(["metal plate".into(), format!("{:.3}", 1e9 * scene.arrivals.plate.si())]);
    table.print();
    if let Some(fouling) = &scene.fouling {
        let mut table = Report::new("Fouling", ["measure", "nominal bed", "this packing"]);
        let (a, b) = (&fouling.nominal, fouling.of_packing.as_ref());
        let mut row = |name: &str, of: &dyn Fn(&crate::material::FoulingIndices) -> String| {
            table.row([name.into(), of(a), b.map_or("–".into(), of)]);
        };
        row("height, % of the bed", &|i| format!("{:.1}", i.height_percent));
        row("percentage void contamination", &|i| format!("{:.1}", i.percentage_void_contamination));
        row("void contaminant index", &|i| format!("{:.1}", i.void_contaminant_index));
        row("relative ballast fouling ratio", &|i| {
            format!("{:.1} ({})", i.relative_ballast_fouling_ratio, i.relative_class.name())
        });
        row("Selig's fouling index", &|i| match (i.selig, i.selig_class) {
            (Some(index), Some(class)) => format!("{index:.1} ({})", class.name()),
            _ => "–".into(),
        });
        row("mass, % of stones and fines", &|i| format!("{:.1}", i.mass_percent));
        row("volume, % of the bed", &|i| format!("{:.1}", i.volume_percent));
        table.print();
        println!(
            "volume, % of bed and base plate (Benedetto 2017, Table 4): {:.1}\n",
            fouling.volume_percent_of_column
        );
    }
}

fn print_model(model: &Model) {
    let [nx, ny, nz] = model.grid.cells;
    println!(
        "grid: {nx} x {ny} x {nz} cells of {} mm, {} steps of {:.4} ps, differences of order {}\n",
        model.grid.spacing.map(|d| format!("{}", 1e3 * d)).join(" x "),
        model.iterations(),
        1e12 * model.time_step(),
        model.order
    );
}

/// What is written beside the traces.
fn print_files(model: &Model) -> Result<(), CliError> {
    for asked in &model.snapshots {
        let (step, [nx, ny, nz]) = (asked.step(model)?, asked.cells(model)?.count);
        println!(
            "snapshot: {nx} x {ny} x {nz} cells at step {step} ({:.3} ns), {}; what reaches its box by then is stepped",
            1e9 * step as f64 * model.time_step(),
            gprmax::snapshot_file(asked)
        );
    }
    for (command, file) in model
        .geometry_files
        .iter()
        .map(|asked| ("#geometry_objects_write", &asked.file))
        .chain(model.geometry_views.iter().map(|asked| ("#geometry_view", &asked.file)))
    {
        println!("`{command}`: {file}, written with the traces");
    }
    Ok(())
}

/// A share as people read it.
fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent > 0.0 && percent < 0.1 { "under 0.1 %".into() } else { format!("{percent:.1} %") }
}

/// Bytes as people read them.
pub fn human_bytes(bytes: u64) -> String {
    let mut value = bytes as f64;
    for unit in ["B", "kB", "MB", "GB"] {
        if value < 1000.0 {
            return if unit == "B" { format!("{value} B") } else { format!("{value:.1} {unit}") };
        }
        value /= 1000.0;
    }
    format!("{value:.1} TB")
}
