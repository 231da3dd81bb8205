//! `build --slices`: sections through one bed in space, an ensemble for waves in two dimensions.

use std::path::Path;
use std::time::Instant;

use crate::cli::build::{BuildArgs, build_scene};
use crate::cli::error::CliError;
use crate::cli::folder;
use crate::cli::interrupt;
use crate::cli::manifest::{PackManifest, PackSeconds};
use crate::cli::pack;
use crate::cli::progress::Bar;
use crate::cli::settle;
use crate::cli::table::Report;
use crate::files;
use crate::forward::{ForwardError, Progress};
use crate::scene::{self, Dimension, PackingMethod, SceneSpec};
use crate::study::{MeanAndSpread, voids_percent};
use crate::units::{Metres, Share};

/// A row of the table of voids.
#[derive(Debug, Clone, serde::Serialize)]
struct Row {
    name: String,
    /// Where the plane lies, from the bed's front, m.
    at_m: Option<f64>,
    /// Discs of a section, spheres of the bed.
    stones: usize,
    /// Up to the nominal height over the whole width, %.
    voids_percent: f64,
}

/// Settles or reads the bed, and builds a folder for each section beside those of the bed.
///
/// # Errors
/// When the scene has no spheres, or a section cannot be built or written.
pub(super) fn run(
    args: &BuildArgs,
    spec: &SceneSpec,
    base: &Path,
    count: u32,
    template: Option<&(String, String)>,
) -> Result<(), CliError> {
    folder::check_free(base, args.force)?;
    let mut spec = spec.clone();
    (spec.grid.dimension, spec.packing.slice) = (Dimension::Two, None);
    let (mut scene, settled) = settle::resolve(&spec, Some(base))?;
    let Some(bed) = scene.spheres.clone() else {
        return Err(CliError::input(format!(
            "`--slices` cuts a bed of spheres, and this scene has none (`method = \"{}\"`)\n\nhint: `--method dem`, or `--method random-addition`",
            scene.spec.packing.method.name()
        )));
    };
    for line in settled.iter().flat_map(settle::told) {
        eprintln!("{line}");
    }
    folder::prepare(base, args.force)?;
    let started = Instant::now();
    pack::write_scene(&mut scene, base)?;
    let writing = started.elapsed().as_secs_f64();
    let bar = Bar::new("building");
    let mut rows = vec![];
    for index in 0..count {
        if interrupt::requested() {
            return Err(ForwardError::Stopped.into());
        }
        let at = (f64::from(index) + 0.5) / f64::from(count) * bed.size[1].si();
        let mut spec = scene.spec.clone();
        spec.packing.slice = Some(Metres(at));
        let section = scene::resolve_with(&spec, Some(bed.clone()))?;
        let name = format!("slice-{}", index + 1);
        rows.push(Row {
            name: name.clone(),
            at_m: Some(at),
            stones: section.discs().len(),
            voids_percent: voids_percent(&section).unwrap_or(f64::NAN),
        });
        build_scene(section, &base.join(&name), template.cloned(), args.force)?;
        let _ = bar.update(Progress { done: index as usize + 1, total: count as usize });
    }
    drop(bar);
    let of_sections = MeanAndSpread::of(&rows.iter().map(|row| row.voids_percent).collect::<Vec<_>>());
    let height = scene.spec.tank.height;
    let of_bed = 100.0 * (1.0 - bed.solid_share_between(Metres(0.0), height).si());
    rows.push(Row { name: "bed".into(), at_m: None, stones: bed.count(), voids_percent: of_bed });
    rows.extend(discs(&scene.spec, of_bed));
    let table = serde_json::json!({ "height_m": height.si(), "sections": of_sections, "rows": rows });
    let text = serde_json::to_string_pretty(&table)? + "\n";
    files::write_bytes(&base.join("slices.json"), text.as_bytes())?;
    files::write_bytes(&base.join("slices.csv"), csv(&rows).as_bytes())?;
    let seconds = PackSeconds { packing: scene.packing_seconds, writing };
    PackManifest::of(&scene, settled.as_ref(), seconds).write(&base.join(folder::MANIFEST))?;
    if args.json {
        print!("{text}");
        return Ok(());
    }
    print(&rows, of_sections);
    eprintln!("\nnext: ballast-gpr run {}/slice-*", folder::typed(base));
    Ok(())
}

/// A packing of discs by random sequential adsorption in the place of the bed, to stand beside it; none where that method has no
/// such bed, which is told.
fn discs(spec: &SceneSpec, voids: f64) -> Option<Row> {
    let mut spec = spec.clone();
    (spec.packing.method, spec.packing.slice, spec.packing.file) = (PackingMethod::Rsa, None, None);
    spec.packing.voids = Share(0.01 * voids);
    match scene::resolve(&spec) {
        Ok(scene) => Some(Row {
            name: "discs (RSA)".into(),
            at_m: None,
            stones: scene.discs().len(),
            voids_percent: voids_percent(&scene)?,
        }),
        Err(error) => {
            let text = error.to_string();
            eprintln!("note: no packing of discs beside it: {}", text.lines().next().unwrap_or_default());
            None
        }
    }
}

fn csv(rows: &[Row]) -> String {
    let mut text = String::from("name,at_m,stones,voids_percent\n");
    for row in rows {
        let at = row.at_m.map_or(String::new(), |at| at.to_string());
        text.push_str(&format!("{},{at},{},{}\n", row.name, row.stones, row.voids_percent));
    }
    text
}

fn print(rows: &[Row], of_sections: Option<MeanAndSpread>) {
    let mut report = Report::new("Voids up to the nominal height", ["what", "plane at, m", "stones", "voids, %"]);
    for row in rows {
        let at = row.at_m.map_or("–".into(), |at| format!("{at:.3}"));
        report.row([row.name.clone(), at, row.stones.to_string(), format!("{:.2}", row.voids_percent)]);
    }
    report.print();
    if let Some(of) = of_sections {
        println!("sections: {:.2} ± {:.2} % (standard deviation of one)", of.mean, of.standard_deviation);
    }
}
