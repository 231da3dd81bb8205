//! The cost curve of the packing: time and error of the sieve curve over the number of stones.

use crate::cli::cost::CostArgs;
use crate::cli::error::CliError;
use crate::cli::interrupt;
use crate::cli::progress::Bar;
use crate::cli::table::Report;
use crate::files;
use crate::forward::{ForwardError, Progress};
use crate::packing::{self, RsaInput};
use crate::plot::{Axis, Chart, Figure as _, Series, Stroke};
use crate::study::fit_exponent;
use crate::units::Metres;

/// Packings per size; the median time and the mean error count.
const REPEATS: u64 = 5;
/// Most stones of the curve unless asked otherwise.
const MOST: usize = 100_000;
/// Fewest stones of the curve.
const FEWEST: usize = 1000;
/// Stones per metre of the tank's bed, 48 cm high (`validate benedetto2018`: 294 in 1.5 m).
const PER_METRE: f64 = 196.0;

#[derive(Debug, Clone, serde::Serialize)]
struct Point {
    stones: usize,
    positioning_seconds: f64,
    compaction_seconds: f64,
    grading_error_percent: f64,
    solid_error_percent: f64,
}

/// Packs ever wider tanks and shows time and error.
pub(super) fn run(args: &CostArgs) -> Result<(), CliError> {
    let mut sizes = vec![args.stones.map_or(MOST, |stones| stones as usize).max(FEWEST)];
    while let Some(next) = sizes.last().map(|stones| stones / 3).filter(|stones| *stones >= FEWEST) {
        sizes.push(next);
    }
    sizes.reverse();
    let bar = Bar::new("packings");
    let mut points = Vec::new();
    for (index, stones) in sizes.iter().enumerate() {
        points.push(measure(*stones)?);
        if interrupt::requested() {
            return Err(ForwardError::Stopped.into());
        }
        let _ = bar.update(Progress { done: index + 1, total: sizes.len() });
    }
    drop(bar);
    let total = |point: &Point| (point.stones as f64, point.positioning_seconds + point.compaction_seconds);
    let exponent = fit_exponent(&points.iter().map(total).collect::<Vec<_>>()).map(|(exponent, _)| exponent);
    let json = serde_json::to_string_pretty(&serde_json::json!({ "points": points, "exponent": exponent }))? + "\n";
    if let Some(folder) = &args.out {
        files::write_bytes(&folder.join("cost-packing.json"), json.as_bytes())?;
        figure(&points, exponent).write(folder, "cost-packing")?;
    }
    if args.json {
        print!("{json}");
        return Ok(());
    }
    let mut table = Report::new(
        format!("Packing of ever wider tanks, median time and mean error of {REPEATS}"),
        ["stones", "positioning, s", "compaction, s", "µs per stone", "sieve curve off by, %", "solid share off by, %"],
    );
    for point in &points {
        table.row([
            point.stones.to_string(),
            format!("{:.4}", point.positioning_seconds),
            format!("{:.4}", point.compaction_seconds),
            format!("{:.2}", 1e6 * total(point).1 / total(point).0),
            format!("{:.3}", point.grading_error_percent),
            format!("{:.3}", point.solid_error_percent),
        ]);
    }
    table.print();
    if let Some(exponent) = exponent {
        println!("time grows as N^{exponent:.2}");
    }
    Ok(())
}

/// What one packing came to.
struct Run {
    positioning: f64,
    compaction: f64,
    grading: f64,
    solid: f64,
    stones: usize,
}

fn measure(stones: usize) -> Result<Point, CliError> {
    let input = RsaInput { width: Metres(stones as f64 / PER_METRE), ..RsaInput::benedetto2018()? };
    let wanted = input.start()?.solid_share.si();
    let mut runs = Vec::new();
    for seed in 1..=REPEATS {
        let outcome = packing::pack(&input, seed)?;
        let rows = outcome.after.grading_table(&input.grading);
        runs.push(Run {
            positioning: outcome.seconds_positioning.si(),
            compaction: outcome.seconds_compaction.si(),
            grading: rows.iter().map(|row| 100.0 * row.deviation().si().abs()).fold(0.0, f64::max),
            solid: 100.0 * (outcome.before.solid_share().si() - wanted).abs(),
            stones: outcome.after.count(),
        });
    }
    let median = |of: &dyn Fn(&Run) -> f64| {
        let mut values: Vec<f64> = runs.iter().map(of).collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let mean = |of: &dyn Fn(&Run) -> f64| runs.iter().map(of).sum::<f64>() / runs.len() as f64;
    Ok(Point {
        stones: runs[0].stones,
        positioning_seconds: median(&|run| run.positioning),
        compaction_seconds: median(&|run| run.compaction),
        grading_error_percent: mean(&|run| run.grading),
        solid_error_percent: mean(&|run| run.solid),
    })
}

fn figure(points: &[Point], exponent: Option<f64>) -> Chart {
    let title = exponent.map_or("Packing".into(), |exponent| format!("Packing: time grows as N^{exponent:.2}"));
    let curve =
        |of: &dyn Fn(&Point) -> f64| points.iter().map(|point| (point.stones as f64, of(point))).collect::<Vec<_>>();
    let first = points.first().map_or(1.0, |point| point.positioning_seconds / point.stones as f64);
    Chart::new(&title, Axis::log10("stones", ""), Axis::log10("time", "s"))
        .with(Series::line("positioning", curve(&|point| point.positioning_seconds)).drawn(Stroke::LineAndPoints, 0))
        .with(Series::line("compaction", curve(&|point| point.compaction_seconds)).drawn(Stroke::LineAndPoints, 1))
        .with(Series::line("linear", curve(&|point| first * point.stones as f64)).drawn(Stroke::Dotted, 7))
}
