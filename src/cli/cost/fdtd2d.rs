//! The cost curve of the built-in solver in two dimensions.

use crate::cli::cost::CostArgs;
use crate::cli::cost_choice;
use crate::cli::error::CliError;
use crate::cli::explain::human_bytes;
use crate::cli::interrupt;
use crate::cli::progress::Bar;
use crate::cli::table::Report;
use crate::fdtd::{self, Fdtd, FdtdError, Precision};
use crate::files;
use crate::forward::{ForwardError, Progress};
use crate::gprmax;
use crate::model::{Model, Order, paint};
use crate::plot::{Axis, Chart, Figure as _, Series, Stroke};
use crate::scene::Smoothing;
use crate::study::{CostPoint, CostScene, CostSetting, CostSolver, CostTable, cost_curve};
use crate::units::Metres;

/// Coarsest cell of the curve.
const COARSEST: f64 = 0.008;

/// Measures and shows the curve.
pub(super) fn run(args: &CostArgs) -> Result<(), CliError> {
    let mut cells = vec![Metres(COARSEST)];
    while let Some(last) =
        cells.last().map(|cell| cell.si()).filter(|cell| cell / 2.0 >= args.finest.si() * (1.0 - 1e-9))
    {
        cells.push(Metres(last / 2.0));
    }
    let (single, double) = (Fdtd::default(), Fdtd { precision: Precision::Double, ..Fdtd::default() });
    let bytes = |model: &Model, precision| -> Result<u64, ForwardError> {
        let painted = paint(model).map_err(FdtdError::from)?;
        Ok(fdtd::memory(model, &painted, precision)?)
    };
    let solvers = [
        CostSolver { solver: &single, double_precision: false, bytes: &|model| bytes(model, Precision::Single) },
        CostSolver { solver: &double, double_precision: true, bytes: &|model| bytes(model, Precision::Double) },
    ];
    let bar = Bar::new("cost curve");
    let on_point = |done, total| {
        let _ = bar.update(Progress { done, total });
    };
    let table = cost_curve(&CostScene::standard()?, &cells, &solvers, &on_point, &|_| interrupt::flow())?;
    drop(bar);
    let json = serde_json::to_string_pretty(&table)? + "\n";
    if let Some(folder) = &args.out {
        files::write_bytes(&folder.join("cost-fdtd2d.json"), json.as_bytes())?;
        files::write_bytes(&folder.join("cost-fdtd2d.csv"), csv(&table).as_bytes())?;
        figure(&table).write(folder, "cost-fdtd2d")?;
    }
    if args.keep {
        let folder = gprmax::install::cache_folder()?;
        files::create_folder(&folder)?;
        files::write_bytes(&folder.join(cost_choice::OWN_TABLE), json.as_bytes())?;
    }
    if args.json {
        print!("{json}");
    } else {
        print(&table);
    }
    Ok(())
}

fn smoothing(point: &CostPoint) -> &'static str {
    match point.setting.smoothing {
        Smoothing::None => "staircase",
        Smoothing::Edges => "edges",
        Smoothing::Area => "area",
        Smoothing::Shapes => "shapes",
    }
}

fn precision(point: &CostPoint) -> &'static str {
    if point.setting.double_precision { "double" } else { "single" }
}

fn csv(table: &CostTable) -> String {
    let mut text = String::from("cell_mm,smoothing,order,precision,error_percent,seconds,bytes,cell_steps\n");
    for point in &table.points {
        text.push_str(&format!(
            "{},{},{},{},{},{},{},{}\n",
            1e3 * point.setting.cell.si(),
            smoothing(point),
            point.setting.order,
            precision(point),
            100.0 * point.error,
            point.seconds,
            point.bytes,
            point.cell_steps
        ));
    }
    text
}

fn print(table: &CostTable) {
    let mut report = Report::new(
        "Error of the echoes (relative L2) against the extrapolated trace, tank with 20 cm of fouling, 1 GHz",
        ["cell, mm", "smoothing", "order", "precision", "error, %", "seconds", "memory", "cell-steps"],
    );
    for point in &table.points {
        report.row([
            format!("{}", 1e3 * point.setting.cell.si()),
            smoothing(point).into(),
            point.setting.order.to_string(),
            precision(point).into(),
            format!("{:.3}", 100.0 * point.error),
            format!("{:.3}", point.seconds),
            human_bytes(point.bytes),
            format!("{:.2e}", point.cell_steps as f64),
        ]);
    }
    report.print();
    println!(
        "order of convergence: area means and order 2 {:.2}, the two finest differ by {:.2} %; true shapes and order 4 {:.2}; \
         their limits differ by {:.3} %",
        table.measured_order,
        100.0 * table.finest_difference,
        table.order_of_shapes,
        100.0 * table.limits_differ
    );
}

fn figure(table: &CostTable) -> Chart {
    let mut chart = Chart::new(
        "What accuracy costs: tank with 20 cm of fouling, 1 GHz",
        Axis::log10("wall time", "s"),
        Axis::log10("error of the echoes", "%"),
    );
    let kinds = [
        (Smoothing::None, "staircase"),
        (Smoothing::Edges, "edge means"),
        (Smoothing::Area, "area means"),
        (Smoothing::Shapes, "true shapes"),
    ];
    for (index, (kind, name)) in kinds.into_iter().enumerate() {
        for (order, style) in [(Order::Second, Stroke::Dashed), (Order::Fourth, Stroke::LineAndPoints)] {
            let of = |p: &CostSetting| p.smoothing == kind && p.order == order && !p.double_precision;
            let points = table.points.iter().filter(|point| of(&point.setting));
            let points: Vec<(f64, f64)> = points.map(|point| (point.seconds, 100.0 * point.error)).collect();
            let label = format!("{name}, order {order}");
            chart.series.push(Series::line(&label, points).drawn(style, index));
        }
    }
    for point in table.points.iter().filter(|p| {
        !p.setting.double_precision && p.setting.smoothing == Smoothing::Shapes && p.setting.order == Order::Fourth
    }) {
        chart.markers.push(crate::plot::Marker {
            x: point.seconds,
            y: 100.0 * point.error,
            label: point.setting.cell.in_unit("mm"),
            colour: 3,
        });
    }
    chart
}
