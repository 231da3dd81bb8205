//! What two dimensions cost in accuracy and three in time: the bed in space, sections through it, and discs.

use crate::cli::cost::CostArgs;
use crate::cli::error::CliError;
use crate::cli::interrupt;
use crate::cli::pack;
use crate::cli::scene_args::SceneArgs;
use crate::cli::settle;
use crate::cli::table::Report;
use crate::fdtd::Fdtd;
use crate::files;
use crate::plot::{Axis, Band, Chart, Figure as _, Series, Stroke};
use crate::study::{DimensionRow, DimensionTable, MeanAndSpread, compare_dimensions};

/// Settles or reads the bed, runs it every way and shows the table.
pub(super) fn run(args: &CostArgs) -> Result<(), CliError> {
    let preset = args.scene.is_none().then(|| "bed".to_string());
    let spec = SceneArgs { preset, ..SceneArgs::default() }.spec(args.scene.as_deref())?;
    let (mut scene, settled) = settle::resolve(&spec, args.out.as_deref())?;
    let Some(bed) = scene.spheres.clone() else {
        return Err(CliError::input(
            "this scene holds no spheres to cut\n\nhint: leave `--scene` out, or name one with `method = \"dem\"`",
        ));
    };
    if let Some(folder) = &args.out {
        pack::write_scene(&mut scene, folder)?;
    }
    let solver = Fdtd::default();
    let table = compare_dimensions(&solver, &scene.spec, &bed, args.slices, &|_| interrupt::flow())?;
    let json = serde_json::to_string_pretty(&serde_json::json!({
        "stones": bed.count(),
        "mixture_plate_ns": table.mixture_ns,
        "settling_seconds": settled.as_ref().map(|_| scene.packing_seconds),
        "rows": table.rows,
    }))? + "\n";
    let report = report(&table);
    if let Some(folder) = &args.out {
        files::write_bytes(&folder.join("cost-dimension.json"), json.as_bytes())?;
        files::write_bytes(&folder.join("cost-dimension.md"), report.markdown().as_bytes())?;
        files::write_bytes(&folder.join("cost-dimension-traces.csv"), traces(&table).as_bytes())?;
        figure(&table).write(folder, "cost-dimension")?;
    }
    if args.json {
        print!("{json}");
        return Ok(());
    }
    report.print();
    println!("plate echo of a plane wave through the bed as a mixture: {:.3} ns", table.mixture_ns);
    println!("the echo's time is that of its envelope's peak: in space the pulse has two extrema of like size");
    println!("mixture as below: with the voids of the middle below the antenna, away from walls");
    println!("± is the standard deviation of single runs; times are wall times of one run on this machine as it was");
    if let Some(settled) = &settled {
        for line in settle::told(settled) {
            println!("{line}");
        }
    }
    Ok(())
}

fn spread(of: Option<MeanAndSpread>, digits: usize) -> String {
    match of {
        None => "–".into(),
        Some(of) if of.count == 1 => format!("{:.digits$}", of.mean),
        Some(of) => format!("{:.digits$} ± {:.digits$}", of.mean, of.standard_deviation),
    }
}

fn report(table: &DimensionTable) -> Report {
    let head = [
        "model",
        "runs",
        "voids, %",
        "plate echo, ns",
        "late by, ns",
        "by waveform, ns",
        "its amplitude",
        "not picked",
        "cells",
        "s a run",
    ];
    let mut report = Report::new("The same bed in space, in sections and as discs", head);
    let truth = table.rows.first().and_then(|row| row.plate_envelope_ns).map(|of| of.mean);
    for row in &table.rows {
        let late =
            row.plate_envelope_ns.zip(truth).map_or("–".into(), |(of, truth)| format!("{:+.3}", of.mean - truth));
        report.row([
            row.name.into(),
            row.seconds.count.to_string(),
            spread(row.voids_percent, 2),
            spread(row.plate_envelope_ns, 3),
            late,
            spread(row.plate_ns, 3),
            spread(row.amplitude, 3),
            row.not_picked.to_string(),
            row.cells.to_string(),
            spread(Some(row.seconds), 2),
        ]);
    }
    report
}

/// Mean and standard deviation of the traces of a row, sample by sample: time, mean, deviation.
fn mean_trace(table: &DimensionTable, row: &DimensionRow) -> Vec<[f64; 3]> {
    let traces: Vec<_> = table.traces.iter().filter(|trace| trace.name == row.name).collect();
    let samples = traces.iter().map(|trace| trace.points.len()).min().unwrap_or(0);
    (0..samples)
        .filter_map(|k| {
            let values: Vec<f64> = traces.iter().map(|trace| trace.points[k].1).collect();
            MeanAndSpread::of(&values).map(|of| [traces[0].points[k].0, of.mean, of.standard_deviation])
        })
        .collect()
}

/// All mean traces: row, time from the emission, amplitude over that of the reference plate, standard deviation.
fn traces(table: &DimensionTable) -> String {
    let mut text = String::from("model,time_ns,amplitude,standard_deviation\n");
    for row in &table.rows {
        for [time, mean, deviation] in mean_trace(table, row) {
            text.push_str(&format!("\"{}\",{time},{mean},{deviation}\n", row.name));
        }
    }
    text
}

fn figure(table: &DimensionTable) -> Chart {
    let axes =
        (Axis::linear("time from the emission", "ns"), Axis::linear("echo over that of a plate at the surface", ""));
    let mut chart = Chart::new("One bed in space, in sections and as discs", axes.0, axes.1);
    let strokes = [
        Stroke::Solid,
        Stroke::Dotted,
        Stroke::DashDotted,
        Stroke::Solid,
        Stroke::Dashed,
        Stroke::Dashed,
        Stroke::Dotted,
    ];
    for (index, row) in table.rows.iter().enumerate() {
        let mean = mean_trace(table, row);
        let points: Vec<_> = mean.iter().map(|[time, value, _]| (*time, *value)).filter(|(t, _)| *t > 0.0).collect();
        if row.name == "sections" && row.seconds.count > 1 {
            let shown = || mean.iter().filter(|[time, ..]| *time > 0.0);
            chart.bands.push(Band {
                name: "sections, ± one deviation".into(),
                x: shown().map(|[time, ..]| *time).collect(),
                lower: shown().map(|[_, value, deviation]| value - deviation).collect(),
                upper: shown().map(|[_, value, deviation]| value + deviation).collect(),
                colour: 0,
            });
        }
        let colour = [6, 7, 7, 0, 1, 2, 5][index.min(6)];
        chart = chart.with(Series::line(row.name, points).drawn(strokes[index.min(6)], colour));
    }
    chart
}
