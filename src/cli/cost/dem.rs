//! The cost curve of settled beds: stiffness, time step, number of stones, and stones that were not settled at all.

use crate::cli::cost::CostArgs;
use crate::cli::error::CliError;
use crate::cli::interrupt;
use crate::cli::progress::Bar;
use crate::cli::table::Report;
use crate::fdtd::Fdtd;
use crate::files;
use crate::forward::Progress;
use crate::plot::{Axis, Chart, Figure as _, Series, Stroke};
use crate::study::{DemCostError, DemCostPlan, DemCostRow, DemCostTable, DemKnob, Judged, PRESSED, settling_cost};

/// Stones of the bed that stiffness and time step are turned for.
const STONES: usize = 400;

/// A figure of a row: its error and what chance makes of it.
struct Kind {
    name: &'static str,
    title: &'static str,
    axis: Axis,
    of: fn(&DemCostRow) -> Option<[f64; 2]>,
}

/// The three errors, in the units of their figures.
fn kinds() -> [Kind; 3] {
    [
        Kind {
            name: "voids",
            title: "error of the voids",
            axis: Axis::log10("error of the voids", "percentage points"),
            of: |row| row.voids_percent.map(|judged| [judged.error.abs(), judged.noise]),
        },
        Kind {
            name: "settlement",
            title: "error of the settlement",
            axis: Axis::log10("error of the strain under load", "% of it"),
            of: |row| row.strain_percent.map(relative),
        },
        Kind {
            name: "trace",
            title: "error of the mean trace",
            axis: Axis::log10("error of the mean trace (relative L2)", "%"),
            of: |row| row.trace_percent.zip(row.trace_noise_percent).map(|(error, noise)| [error, noise]),
        },
    ]
}

/// Error and noise of a strain in per cent of the reference's.
fn relative(judged: Judged) -> [f64; 2] {
    let reference = judged.mean - judged.error;
    [judged.error.abs(), judged.noise].map(|value| 100.0 * value / reference)
}

/// Measures and shows the curve.
pub(super) fn run(args: &CostArgs) -> Result<(), CliError> {
    let stones = args.stones.map_or(STONES, |stones| stones as usize);
    let plan = DemCostPlan::standard(stones, args.seeds, args.slices.max(1))?;
    let bar = Bar::new("settling beds");
    let on_point = |done, total| {
        let _ = bar.update(Progress { done, total });
    };
    let table = settling_cost(&plan, &Fdtd::default(), &on_point, &|_| interrupt::flow())?;
    drop(bar);
    let json = serde_json::to_string_pretty(&table)? + "\n";
    if let Some(folder) = &args.out {
        files::write_bytes(&folder.join("dem.json"), json.as_bytes())?;
        files::write_bytes(&folder.join("dem.csv"), csv(&table).as_bytes())?;
        for kind in kinds() {
            figure(&table, &kind).write(folder, &format!("cost-dem-{}", kind.name))?;
        }
    }
    if args.json {
        print!("{json}");
        return Ok(());
    }
    report(&table).print();
    println!(
        "± is the standard error of the difference to the reference (marked *), over {} beds each: smaller differences are \
         chance. One thread; a bed of {:.0} cm.\nsettlement: strain of the bed under a plate from {:.0} to {:.0} kPa; trace: \
         mean over {} sections of each bed, direct wave taken off, relative L2",
        table.seeds,
        100.0 * table.height_m,
        1e-3 * PRESSED[0].si(),
        1e-3 * PRESSED[1].si(),
        table.sections
    );
    for row in table.rows.iter().filter(|row| row.stopped.is_some()) {
        println!("{}, {}: {}", row.knob.name(), row.name, row.stopped.as_deref().unwrap_or_default());
    }
    Ok(())
}

/// The figures of a row with their differences, as columns of the table for people.
fn report(table: &DemCostTable) -> Report {
    let heads = [
        "turned",
        "setting",
        "stones",
        "s a bed",
        "voids, %",
        "off by",
        "strain, %",
        "off by, %",
        "plate echo, ns",
        "off by, ps",
        "trace off by, %",
    ];
    let mut report = Report::new("What settling costs", heads);
    let mean =
        |judged: Option<Judged>, digits: usize| judged.map_or("–".into(), |of| format!("{:.digits$}", of.mean));
    for row in &table.rows {
        let off = |of: Option<[f64; 2]>, digits: usize| match of {
            _ if row.reference => "*".into(),
            None => "–".to_string(),
            Some([error, noise]) => format!("{error:+.digits$} ± {noise:.digits$}"),
        };
        let signed = |judged: Judged, unit: f64| [unit * judged.error, unit * judged.noise];
        let strain = row.strain_percent.map(|judged| {
            let [error, noise] = relative(judged);
            [error.copysign(judged.error), noise]
        });
        report.row([
            row.knob.name().into(),
            row.name.clone(),
            format!("{:.0}", row.stones),
            if row.seconds < 0.1 { format!("{:.4}", row.seconds) } else { format!("{:.2}", row.seconds) },
            mean(row.voids_percent, 2),
            off(row.voids_percent.map(|judged| signed(judged, 1.0)), 2),
            mean(row.strain_percent, 4),
            off(strain, 0),
            mean(row.plate_ns, 3),
            off(row.plate_ns.map(|judged| signed(judged, 1e3)), 0),
            off(row.trace_percent.zip(row.trace_noise_percent).map(|(error, noise)| [error, noise]), 1),
        ]);
    }
    report
}

fn csv(table: &DemCostTable) -> String {
    let mut text = String::from(
        "knob,setting,reference,stones,seconds,voids_percent,voids_error,voids_noise,strain_percent,strain_error,strain_noise,\
         plate_ns,plate_error,plate_noise,trace_error_percent,trace_noise_percent,stopped\n",
    );
    let plain = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    let three = |judged: Option<Judged>| match judged {
        None => ",,".to_string(),
        Some(of) => format!("{},{},{}", of.mean, of.error, of.noise),
    };
    for row in &table.rows {
        text.push_str(&format!(
            "{},\"{}\",{},{},{},{},{},{},{},{},{}\n",
            row.knob.name(),
            row.name,
            row.reference,
            row.stones,
            row.seconds,
            three(row.voids_percent),
            three(row.strain_percent),
            three(row.plate_ns),
            plain(row.trace_percent),
            plain(row.trace_noise_percent),
            row.stopped.is_some()
        ));
    }
    text
}

/// Error against wall time, a curve for each knob, with what chance makes of it as a thin line.
fn figure(table: &DemCostTable, kind: &Kind) -> Chart {
    let mut chart = Chart::new(
        &format!("What settling costs: {}", kind.title),
        Axis::log10("wall time of a bed", "s"),
        kind.axis.clone(),
    );
    let knobs = [DemKnob::Stiffness, DemKnob::TimeStep, DemKnob::Stones, DemKnob::Placed];
    for (colour, knob) in knobs.into_iter().enumerate() {
        let rows = || table.rows.iter().filter(move |row| row.knob == knob && !row.reference);
        let points = |which: usize| -> Vec<(f64, f64)> {
            let of = |row: &DemCostRow| (kind.of)(row).map(|values| (row.seconds, values[which]));
            rows().filter_map(of).filter(|(time, value)| *time > 0.0 && *value > 0.0).collect()
        };
        let stroke = if knob == DemKnob::Placed { Stroke::Points } else { Stroke::LineAndPoints };
        if !points(0).is_empty() {
            chart = chart.with(Series::line(knob.name(), points(0)).drawn(stroke, colour));
        }
        if knob != DemKnob::Placed && !points(1).is_empty() {
            let name = format!("{}: chance", knob.name());
            chart = chart.with(Series::line(&name, points(1)).drawn(Stroke::Dotted, colour));
        }
    }
    chart
}

impl From<DemCostError> for CliError {
    fn from(error: DemCostError) -> Self {
        match error {
            DemCostError::Scene(error) => error.into(),
            DemCostError::Packing(error) => error.into(),
            DemCostError::Settle(error) => error.into(),
            DemCostError::Echo(error) => error.into(),
        }
    }
}
