//! `pack`: the packing alone, with its files, figures and statistics.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;

use crate::cli::error::CliError;
use crate::cli::folder;
use crate::cli::manifest::{PackManifest, PackSeconds};
use crate::cli::pack_spheres;
use crate::cli::progress::Bar;
use crate::cli::scene_args::SceneArgs;
use crate::cli::settle;
use crate::cli::table::Report;
use crate::files;
use crate::forward::Progress;
use crate::packing::calibrate::{self, CalibrationPlan};
use crate::packing::{Grading, GradingRow, InputRule, Packing, Porosity, RsaOutcome, export};
use crate::plot::{Axis, Band, Chart, Figure as _, PackingFigure, Series, Stroke};
use crate::scene::{self, PackingMethod, Scene, SceneSpec};
use crate::units::Share;

/// Pack stones: sizing, positioning and compaction, without a radar model.
#[derive(Debug, Clone, Args)]
pub struct PackArgs {
    /// Scene file, or a folder that holds a `scene.toml`; without one the preset `tank`.
    #[arg(value_name = "SCENE.toml|FOLDER")]
    pub scene: Option<PathBuf>,
    #[command(flatten)]
    pub args: SceneArgs,
    /// Refit alpha and beta of eq. 14 to this grading and domain as the paper did (2.5 % steps, 5 arrangements), report
    /// the fit and pack with it.
    #[arg(long)]
    pub calibrate: bool,
    /// Folder for text, CAD, CSV and JSON files and figures; without it only the statistics are printed.
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
    /// Write into a folder that is not empty, over files of the same names.
    #[arg(long)]
    pub force: bool,
    /// List the built-in sieve curves and end.
    #[arg(long)]
    pub list_gradings: bool,
    /// Print the statistics as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// When the stones cannot be packed or the files not written.
pub fn run(args: &PackArgs) -> Result<(), CliError> {
    if args.list_gradings {
        for name in Grading::names() {
            println!("{name}");
        }
        return Ok(());
    }
    let mut spec = args.args.spec(args.scene.as_deref())?;
    let calibration = args.calibrate.then(|| refit(&mut spec, args.json)).transpose()?;
    if let Some(folder) = &args.out {
        folder::check_free(folder, args.force)?;
    }
    let (mut scene, settled) = settle::resolve(&spec, args.out.as_deref())?;
    if let (Some(folder), true) = (&args.out, scene.packing.is_some() || scene.spheres.is_some()) {
        scene.spec.to_toml()?;
        folder::prepare(folder, args.force)?;
        let started = Instant::now();
        write_scene(&mut scene, folder)?;
        let seconds = PackSeconds { packing: scene.packing_seconds, writing: started.elapsed().as_secs_f64() };
        PackManifest::of(&scene, settled.as_ref(), seconds).write(&folder.join(folder::MANIFEST))?;
    }
    if let Some(bed) = &scene.spheres {
        return pack_spheres::print(&scene, bed, settled.as_ref(), args.json);
    }
    let packing = scene.packing.as_ref().ok_or_else(|| {
        CliError::input("this scene has no stones (`method = \"homogeneous\"`)\n\nhint: leave `--homogeneous` out")
    })?;
    let grading = scene.spec.packing.grading.curve()?;
    if args.json {
        println!("{}", serde_json::to_string_pretty(&statistics(&scene, packing, &grading, calibration))?);
    } else {
        print(&scene, packing, &grading);
    }
    Ok(())
}

fn refit(spec: &mut SceneSpec, json: bool) -> Result<serde_json::Value, CliError> {
    let input = scene::rsa_input(spec, Porosity::new(spec.packing.voids).map_err(CliError::from)?)?;
    let bar = Bar::new("calibrating");
    let plan = CalibrationPlan { seed: spec.seed, ..CalibrationPlan::default() };
    let found = calibrate::calibrate(&input, &plan, |done, total| {
        let _ = bar.update(Progress { done, total });
    })?;
    drop(bar);
    spec.packing.input = InputRule::Fit(found.fit);
    if !json {
        println!(
            "dh = alpha D1/D2 - beta refitted on {} packings: alpha {:.1} cm, beta {:.1} cm (paper 22.5 and 18.6), R² {:.3}, \
             residual {:.2} cm\n",
            found.points.len(),
            100.0 * found.fit.alpha.si(),
            100.0 * found.fit.beta.si(),
            found.r_squared,
            100.0 * found.residual.si()
        );
    }
    Ok(serde_json::json!({
        "packings": found.points.len(),
        "alpha_m": found.fit.alpha.si(),
        "beta_m": found.fit.beta.si(),
        "r_squared": found.r_squared,
        "residual_m": found.residual.si(),
    }))
}

/// A share in percent, without the sign that a zero may carry.
pub fn percent(share: Share) -> f64 {
    100.0 * share.si() + 0.0
}

/// Writes the scene and its packing into a folder. A packing read from outside is kept there too and named by the scene, so
/// that the folder is whole wherever it is moved.
///
/// # Errors
/// When a file cannot be written.
pub fn write_scene(scene: &mut Scene, folder: &Path) -> Result<(), CliError> {
    if let Some(pulse) = &scene.pulse {
        let text = crate::gprmax::excitation_text("pulse", pulse);
        files::write_bytes(&folder.join(PULSE), text.as_bytes())?;
        scene.spec.antenna.pulse = Some(PULSE.into());
    }
    if matches!(scene.spec.packing.method, PackingMethod::File | PackingMethod::Dem) {
        scene.spec.packing.method = PackingMethod::File;
        scene.spec.packing.file = Some(PACKING.into());
    }
    if let Some(bed) = &scene.spheres {
        files::write_bytes(&folder.join(folder::SCENE), scene.spec.to_toml()?.as_bytes())?;
        return pack_spheres::write(scene, bed, folder);
    }
    files::write_bytes(&folder.join(folder::SCENE), scene.spec.to_toml()?.as_bytes())?;
    write_packing(scene, folder)
}

/// Name of the pulse that a scene has from a file.
const PULSE: &str = "pulse.txt";

/// Name of the packing that keeps every bit.
pub const PACKING: &str = "packing.json";

/// Writes every file of a scene's packing into its folder; nothing for a homogeneous bed.
///
/// # Errors
/// When a file cannot be written.
fn write_packing(scene: &Scene, folder: &Path) -> Result<(), CliError> {
    let Some(packing) = &scene.packing else { return Ok(()) };
    let write = |name: &str, bytes: &[u8]| files::write_bytes(&folder.join(name), bytes);
    write("packing.csv", export::csv(packing).as_bytes())?;
    write(PACKING, export::json(packing)?.as_bytes())?;
    write("packing.scr", export::autocad_script(packing).as_bytes())?;
    write("packing.dxf", &export::dxf(packing)?)?;
    let grading = scene.spec.packing.grading.curve()?;
    if let Some(outcome) = &scene.adsorption {
        let input = scene::rsa_input(&scene.spec, Porosity::new(scene.spec.packing.voids)?)?;
        write("packing.txt", export::text_report(&input, outcome).as_bytes())?;
        let rows = packing.grading_table(&grading);
        let mut table = String::from("sieve_mm,input_passing_percent,output_passing_percent,deviation_percent\n");
        for row in &rows {
            let GradingRow { sieve, wanted, found } = row;
            table.push_str(&format!(
                "{},{},{},{}\n",
                1e3 * sieve.si(),
                percent(*wanted),
                percent(*found),
                percent(row.deviation())
            ));
        }
        write("grading.csv", table.as_bytes())?;
        grading_chart(&grading, &rows).write(folder, "grading")?;
    }
    packing_figure(packing, scene.adsorption.as_ref()).write(folder, "packing")?;
    Ok(())
}

fn discs(packing: &Packing) -> Vec<[f64; 3]> {
    packing.discs.iter().map(|disc| [disc.x, disc.y, disc.radius]).collect()
}

pub fn packing_figure(packing: &Packing, outcome: Option<&RsaOutcome>) -> PackingFigure {
    let title = format!(
        "{} stones, {:.1} cm, {:.1} % solid",
        packing.count(),
        100.0 * packing.top().si(),
        100.0 * packing.solid_share().si()
    );
    let height = outcome.map_or(packing.height, |outcome| outcome.input_height);
    PackingFigure {
        title,
        width: packing.width.si(),
        height: height.si(),
        discs: discs(packing),
        before: outcome.map(|outcome| discs(&outcome.before)),
    }
}

/// Input and output sieve curves, as in the paper's Fig. 8, with the standard's band where there is one.
pub fn grading_chart(grading: &Grading, rows: &[GradingRow]) -> Chart {
    let mm = |row: &GradingRow| 1e3 * row.sieve.si();
    let sieves = Axis { ticks: rows.iter().map(mm).collect(), ..Axis::log10("sieve", "mm") };
    let mut chart = Chart::new("Sieve curve", sieves, Axis::linear("passing", "%").between(0.0, 100.0))
        .with(Series::line("input", rows.iter().map(|row| (mm(row), percent(row.wanted))).collect()))
        .with(
            Series::line("packing", rows.iter().map(|row| (mm(row), percent(row.found))).collect())
                .drawn(Stroke::Dashed, 1),
        );
    let bands: Vec<_> = grading
        .sieves()
        .iter()
        .filter_map(|sieve| Some((1e3 * sieve.size.si(), sieve.lowest?, sieve.highest?)))
        .collect();
    if !bands.is_empty() {
        chart.bands.push(Band {
            name: format!("{} limits", grading.name()),
            x: bands.iter().map(|(x, _, _)| *x).collect(),
            lower: bands.iter().map(|(_, low, _)| 100.0 * low.si()).collect(),
            upper: bands.iter().map(|(_, _, high)| 100.0 * high.si()).collect(),
            colour: 2,
        });
    }
    chart
}

fn print(scene: &Scene, packing: &Packing, grading: &Grading) {
    let mut table = Report::new(format!("{} (seed {})", scene.spec.title, scene.spec.seed), ["figure", "value"]);
    if let Some(outcome) = &scene.adsorption {
        table.row(["input height, cm".into(), format!("{:.1}", 100.0 * outcome.input_height.si())]);
        table.row(["input solid share, %".into(), format!("{:.1}", 100.0 * outcome.input_solid_share.si())]);
    }
    table.row(["stones".into(), packing.count().to_string()]);
    table.row([
        "diameters, mm".into(),
        format!("{:.1} to {:.1}", 1e3 * packing.smallest_diameter().si(), 1e3 * packing.largest_diameter().si()),
    ]);
    table.row(["height, cm".into(), format!("{:.2}", 100.0 * packing.top().si())]);
    table.row(["solid share up to that height, %".into(), format!("{:.2}", 100.0 * packing.solid_share().si())]);
    table.row(["solid share inside, %".into(), format!("{:.2}", 100.0 * packing.interior_solid_share().si())]);
    if let Some(outcome) = &scene.adsorption {
        table.row(["positioning, ms".into(), format!("{:.2}", 1e3 * outcome.seconds_positioning.si())]);
        table.row(["compaction, ms".into(), format!("{:.2}", 1e3 * outcome.seconds_compaction.si())]);
    }
    table.print();
    let mut table = Report::new("Sieve curve, % passing", ["sieve, mm", "input", "packing", "deviation"]);
    for row in packing.grading_table(grading) {
        table.row([
            format!("{}", 1e3 * row.sieve.si()),
            format!("{:.1}", percent(row.wanted)),
            format!("{:.1}", percent(row.found)),
            format!("{:+.2}", percent(row.deviation())),
        ]);
    }
    table.print();
}

fn statistics(
    scene: &Scene,
    packing: &Packing,
    grading: &Grading,
    calibration: Option<serde_json::Value>,
) -> serde_json::Value {
    let rows: Vec<_> = packing
        .grading_table(grading)
        .iter()
        .map(|row| {
            serde_json::json!({
                "sieve_mm": 1e3 * row.sieve.si(),
                "input_passing_percent": percent(row.wanted),
                "output_passing_percent": percent(row.found),
            })
        })
        .collect();
    serde_json::json!({
        "seed": scene.spec.seed,
        "calibration": calibration,
        "input_height_m": scene.adsorption.as_ref().map(|outcome| outcome.input_height.si()),
        "input_solid_share": scene.adsorption.as_ref().map(|outcome| outcome.input_solid_share.si()),
        "stones": packing.count(),
        "smallest_diameter_m": packing.smallest_diameter().si(),
        "largest_diameter_m": packing.largest_diameter().si(),
        "height_m": packing.top().si(),
        "solid_share": packing.solid_share().si(),
        "interior_solid_share": packing.interior_solid_share().si(),
        "seconds_positioning": scene.adsorption.as_ref().map(|outcome| outcome.seconds_positioning.si()),
        "seconds_compaction": scene.adsorption.as_ref().map(|outcome| outcome.seconds_compaction.si()),
        "grading": rows,
    })
}
