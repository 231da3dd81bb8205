//! `pack` of a bed of spheres: its files, figures and statistics.

use std::path::Path;

use crate::cli::error::CliError;
use crate::cli::pack::{PACKING, grading_chart, packing_figure, percent};
use crate::cli::settle;
use crate::cli::table::Report;
use crate::files;
use crate::packing::settle::Settled;
use crate::packing::spheres::TOUCHING;
use crate::packing::{Packing, SphereBed, export};
use crate::plot::{Axis, Chart, Figure as _, Series, SpheresFigure};
use crate::scene::Scene;
use crate::units::Metres;

/// Height of the layers of the porosity profile, in largest diameters.
const LAYER: f64 = 0.2;

/// Sections of an ensemble, for the figures of a bed.
const SECTIONS: usize = 8;

/// Writes every file of a bed into its folder.
///
/// # Errors
/// When a file cannot be written.
pub fn write(scene: &Scene, bed: &SphereBed, folder: &Path) -> Result<(), CliError> {
    let write = |name: &str, text: &str| files::write_bytes(&folder.join(name), text.as_bytes());
    write("packing.csv", &export::spheres_csv(bed))?;
    write(PACKING, &export::spheres_json(bed)?)?;
    write("stones.vtp", &export::stones_vtp(bed))?;
    if !bed.contacts.is_empty() {
        write("contacts.vtp", &export::contacts_vtp(bed))?;
    }
    let mut table = String::from("bottom_m,top_m,voids_percent\n");
    for row in bed.porosity_profile(layer(bed)) {
        table.push_str(&format!("{},{},{}\n", row.bottom.si(), row.top.si(), percent(row.voids)));
    }
    write("porosity.csv", &table)?;
    porosity_chart(bed).write(folder, "porosity")?;
    let grading = scene.spec.packing.grading.curve()?;
    let rows = bed.grading_table(&grading);
    let mut table = String::from("sieve_mm,input_passing_percent,output_passing_percent,deviation_percent\n");
    for row in &rows {
        let (wanted, found) = (percent(row.wanted), percent(row.found));
        table.push_str(&format!("{},{wanted},{found},{}\n", 1e3 * row.sieve.si(), percent(row.deviation())));
    }
    write("grading.csv", &table)?;
    grading_chart(&grading, &rows).write(folder, "grading")?;
    if let Some(forces) = bed.force_distribution() {
        let mut table = String::from("force_over_mean_from,force_over_mean_to,density\n");
        for bin in &forces.bins {
            table.push_str(&format!("{},{},{}\n", bin.from, bin.to, bin.density));
        }
        write("forces.csv", &table)?;
        let points =
            forces.bins.iter().filter(|b| b.density > 0.0).map(|b| (0.5 * (b.from + b.to), b.density)).collect();
        let axes = (Axis::linear("normal force over its mean", ""), Axis::log10("probability density", ""));
        Chart::new("Contact forces", axes.0, axes.1).with(Series::line("bed", points)).write(folder, "forces")?;
    }
    let by_size = |sphere: &crate::geometry::Sphere| 2e3 * sphere.radius;
    views(bed, "diameter (mm)", by_size).write(folder, "views")?;
    if let Some(section) = &scene.packing {
        packing_figure(section, None).write(folder, "section")?;
    }
    Ok(())
}

fn layer(bed: &SphereBed) -> Metres {
    Metres(LAYER * bed.largest_diameter().si())
}

/// Voids over height.
fn porosity_chart(bed: &SphereBed) -> Chart {
    let rows = bed.porosity_profile(layer(bed));
    let points = rows.iter().map(|row| (0.5 * (row.bottom.si() + row.top.si()), percent(row.voids))).collect();
    Chart::new("Voids over height", Axis::linear("height", "m"), Axis::linear("voids", "%").between(0.0, 100.0))
        .with(Series::line("whole floor", points))
}

/// The bed from three sides, coloured by a figure of each stone.
fn views(bed: &SphereBed, caption: &str, of: impl Fn(&crate::geometry::Sphere) -> f64) -> SpheresFigure {
    let [length, width, _] = bed.size.map(Metres::si);
    SpheresFigure {
        title: format!(
            "{} stones, {:.1} cm, {:.1} % solid inside",
            bed.count(),
            100.0 * bed.top().si(),
            percent(bed.interior_solid_share())
        ),
        size: [length, width, bed.top().si().max(bed.size[2].si())],
        spheres: bed.spheres.iter().map(|s| [s.centre[0], s.centre[1], s.centre[2], s.radius]).collect(),
        values: bed.spheres.iter().map(of).collect(),
        caption: caption.into(),
    }
}

/// Mean and standard deviation of the void shares inside of sections across y, %; none where a plane meets no stone.
fn voids_of_sections(bed: &SphereBed) -> Option<(f64, f64)> {
    let (low, high) = bed.interior();
    let sections = bed.slices(1, SECTIONS).ok()?;
    let within = sections.iter().enumerate().filter(|(k, _)| {
        let at = (*k as f64 + 0.5) / SECTIONS as f64 * bed.size[1].si();
        (low[1]..=high[1]).contains(&at)
    });
    let voids: Vec<f64> = within.map(|(_, section)| 100.0 - percent(share_in(section, low, high))).collect();
    let mean = voids.iter().sum::<f64>() / voids.len().max(1) as f64;
    let squares: f64 = voids.iter().map(|v| (v - mean).powi(2)).sum();
    (voids.len() > 1).then(|| (mean, (squares / (voids.len() - 1) as f64).sqrt()))
}

/// Solid share of the part of a section across y that the interior of its bed shows.
fn share_in(section: &Packing, low: [f64; 3], high: [f64; 3]) -> crate::units::Share {
    let area: f64 = section
        .discs
        .iter()
        .map(|d| {
            crate::geometry::disc_rectangle_area(d.radius, low[0] - d.x, high[0] - d.x, low[2] - d.y, high[2] - d.y)
        })
        .sum();
    crate::units::Share(area / ((high[0] - low[0]) * (high[2] - low[2])))
}

/// Prints the statistics of a bed.
///
/// # Errors
/// When they cannot be written as JSON.
pub fn print(scene: &Scene, bed: &SphereBed, settled: Option<&Settled>, json: bool) -> Result<(), CliError> {
    let grading = scene.spec.packing.grading.curve()?;
    let rows = bed.grading_table(&grading);
    let coordination = bed.coordination(TOUCHING);
    let forces = bed.force_distribution();
    let sections = voids_of_sections(bed);
    let overlap = bed.deepest_overlap().map_or(0.0, |overlap| overlap.depth.si());
    if json {
        let value = serde_json::json!({
            "seed": scene.spec.seed,
            "method": scene.spec.packing.method.name(),
            "generator": bed.generator,
            "stones": bed.count(),
            "smallest_diameter_m": bed.smallest_diameter().si(),
            "largest_diameter_m": bed.largest_diameter().si(),
            "height_m": bed.top().si(),
            "solid_share": bed.solid_share().si(),
            "interior_solid_share": bed.interior_solid_share().si(),
            "section_voids_percent": sections.map(|(mean, spread)| serde_json::json!({ "mean": mean, "spread": spread })),
            "deepest_overlap_m": overlap,
            "coordination": coordination,
            "forces": forces,
            "porosity_profile": bed.porosity_profile(layer(bed)).iter().map(|row| serde_json::json!({
                "bottom_m": row.bottom.si(), "top_m": row.top.si(), "voids_percent": percent(row.voids),
            })).collect::<Vec<_>>(),
            "grading": rows.iter().map(|row| serde_json::json!({
                "sieve_mm": 1e3 * row.sieve.si(),
                "input_passing_percent": percent(row.wanted),
                "output_passing_percent": percent(row.found),
            })).collect::<Vec<_>>(),
            "stages": settled.map(|settled| &settled.stages),
            "struck_off": settled.map(|settled| settled.struck_off),
            "lost": settled.map(|settled| settled.lost),
            "time_step_s": settled.map(|settled| settled.time_step.si()),
            "seconds": scene.packing_seconds,
        });
        println!("{}", serde_json::to_string_pretty(&value)?);
        return Ok(());
    }
    let mut table = Report::new(format!("{} (seed {})", scene.spec.title, scene.spec.seed), ["figure", "value"]);
    let mut row = |name: &str, value: String| table.row([name.into(), value]);
    row("stones", bed.count().to_string());
    let sizes = [bed.smallest_diameter(), bed.largest_diameter()].map(|d| 1e3 * d.si());
    row("diameters, mm", format!("{:.1} to {:.1}", sizes[0], sizes[1]));
    row("height, cm", format!("{:.2}", 100.0 * bed.top().si()));
    row("voids up to that height, %", format!("{:.2}", 100.0 - percent(bed.solid_share())));
    row("voids inside, away from walls, %", format!("{:.2}", 100.0 - percent(bed.interior_solid_share())));
    if let Some((mean, spread)) = sections {
        row("voids of sections inside, %", format!("{mean:.2} ± {spread:.2}"));
    }
    row("contacts per stone", format!("{:.2}", coordination.mean));
    row("contacts per stone inside", format!("{:.2}", coordination.interior));
    row("the same without rattlers", format!("{:.2}", coordination.interior_without_rattlers));
    row("rattlers, %", format!("{:.1}", percent(coordination.rattlers)));
    row("deepest overlap, mm", format!("{:.4}", 1e3 * overlap));
    if let Some(forces) = &forces {
        row("contact force, N", format!("{:.3} (mean), {:.2} (largest)", forces.mean_newtons, forces.largest_newtons));
    }
    table.print();
    for line in settled.iter().flat_map(|settled| settle::told(settled)) {
        println!("{line}");
    }
    let mut table = Report::new("Sieve curve by mass, % passing", ["sieve, mm", "input", "bed", "deviation"]);
    for row in &rows {
        table.row([
            format!("{}", 1e3 * row.sieve.si()),
            format!("{:.1}", percent(row.wanted)),
            format!("{:.1}", percent(row.found)),
            format!("{:+.2}", percent(row.deviation())),
        ]);
    }
    table.print();
    Ok(())
}
