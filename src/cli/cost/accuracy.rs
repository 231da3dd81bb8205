//! The cost curves of the built-in solver, in two and three dimensions.

use crate::cli::cost::CostArgs;
use crate::cli::cost_choice::OwnTable;
use crate::cli::error::CliError;
use crate::cli::explain::human_bytes;
use crate::cli::interrupt;
use crate::cli::progress::Bar;
use crate::cli::table::Report;
use crate::fdtd::{self, Fdtd, FdtdError, Precision};
use crate::files;
use crate::forward::{ForwardError, Progress};
use crate::gprmax;
use crate::model::{Model, Order, paint, paint3};
use crate::plot::{Axis, Chart, Figure as _, Series, Stroke};
use crate::scene::Smoothing;
use crate::study::{CostBed, CostPoint, CostScene, CostSetting, CostSolver, CostSubject, CostTable, cost_curve};
use crate::units::Metres;

/// One of the two curves.
struct Curve {
    subject: Box<dyn CostSubject>,
    /// What the scene is.
    scene: &'static str,
    own: OwnTable,
    /// Cells are its halves, quarters, …, m.
    coarsest: f64,
    /// Finest cell unless asked otherwise, m.
    finest: f64,
    /// Finest cell in double precision, m.
    finest_double: f64,
}

/// Measures and shows the curve in two dimensions.
pub(super) fn run_plane(args: &CostArgs) -> Result<(), CliError> {
    let subject = Box::new(CostScene::standard()?);
    let scene = "tank with 20 cm of fouling, 1 GHz";
    let own = OwnTable::Plane;
    run(args, Curve { subject, scene, own, coarsest: 8e-3, finest: 0.5e-3, finest_double: 0.0 })
}

/// Measures and shows the curve in three dimensions.
pub(super) fn run_space(args: &CostArgs) -> Result<(), CliError> {
    let subject = Box::new(CostBed::standard());
    let scene = "balls on soil in three dimensions, 1 GHz";
    let own = OwnTable::Space;
    run(args, Curve { subject, scene, own, coarsest: 10e-3, finest: 1.25e-3, finest_double: 2.5e-3 })
}

/// Memory of a run, bytes.
fn bytes(model: &Model, precision: Precision) -> Result<u64, ForwardError> {
    if model.is_plane() {
        let painted = paint(model).map_err(FdtdError::from)?;
        return Ok(fdtd::memory(model, &painted, precision)?);
    }
    let painted = paint3(model).map_err(FdtdError::from)?;
    Ok(fdtd::memory_three(model, &painted, precision)?)
}

fn run(args: &CostArgs, curve: Curve) -> Result<(), CliError> {
    let finest = args.finest.map_or(curve.finest, |finest| finest.si());
    let mut cells = vec![Metres(curve.coarsest)];
    while let Some(last) = cells.last().map(|cell| cell.si()).filter(|cell| cell / 2.0 >= finest * (1.0 - 1e-9)) {
        cells.push(Metres(last / 2.0));
    }
    let (single, double) = (Fdtd::default(), Fdtd { precision: Precision::Double, ..Fdtd::default() });
    let solvers = [
        CostSolver {
            solver: &single,
            double_precision: false,
            finest: Metres(0.0),
            bytes: &|model| bytes(model, Precision::Single),
        },
        CostSolver {
            solver: &double,
            double_precision: true,
            finest: Metres(curve.finest_double),
            bytes: &|model| bytes(model, Precision::Double),
        },
    ];
    let bar = Bar::new("cost curve");
    let on_point = |done, total| {
        let _ = bar.update(Progress { done, total });
    };
    let table = cost_curve(curve.subject.as_ref(), &cells, &solvers, &on_point, &|_| interrupt::flow())?;
    drop(bar);
    let json = serde_json::to_string_pretty(&table)? + "\n";
    if let Some(folder) = &args.out {
        let name = curve.own.name();
        files::write_bytes(&folder.join(format!("{name}.json")), json.as_bytes())?;
        files::write_bytes(&folder.join(format!("{name}.csv")), csv(&table).as_bytes())?;
        figure(&table, &curve).write(folder, name)?;
    }
    if args.keep {
        let folder = gprmax::install::cache_folder()?;
        files::create_folder(&folder)?;
        files::write_bytes(&folder.join(format!("{}.json", curve.own.name())), json.as_bytes())?;
    }
    if args.json {
        print!("{json}");
    } else {
        print(&table, &curve);
    }
    Ok(())
}

fn smoothing(point: &CostPoint) -> &'static str {
    match point.setting.smoothing {
        Smoothing::None => "staircase",
        Smoothing::Edges => "edges",
        Smoothing::Area => "area",
        Smoothing::Shapes => "shapes",
        Smoothing::Tensors => "tensors",
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

fn print(table: &CostTable, curve: &Curve) {
    let mut report = Report::new(
        format!("Error of the echoes (relative L2) against the extrapolated trace, {}", curve.scene),
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
        "order of convergence: smoothing `{}` and order 2 {:.2}, the two finest differ by {:.2} %; true shapes and order 4 \
         {:.2}; their limits differ by {:.3} %",
        curve.subject.smoothings()[0].name(),
        table.measured_order,
        100.0 * table.finest_difference,
        table.order_of_shapes,
        100.0 * table.limits_differ
    );
}

fn figure(table: &CostTable, curve: &Curve) -> Chart {
    let mut chart = Chart::new(
        &format!("What accuracy costs: {}", curve.scene),
        Axis::log10("wall time", "s"),
        Axis::log10("error of the echoes", "%"),
    );
    let kinds = [
        (Smoothing::None, "staircase"),
        (Smoothing::Edges, "edge means"),
        (Smoothing::Area, if matches!(curve.own, OwnTable::Space) { "volume means" } else { "area means" }),
        (Smoothing::Shapes, "true shapes"),
        (Smoothing::Tensors, "tensors"),
    ];
    for (index, (kind, name)) in kinds.into_iter().enumerate() {
        for (order, style) in [(Order::Second, Stroke::Dashed), (Order::Fourth, Stroke::LineAndPoints)] {
            let of = |p: &CostSetting| p.smoothing == kind && p.order == order && !p.double_precision;
            let points = table.points.iter().filter(|point| of(&point.setting));
            let points: Vec<(f64, f64)> = points.map(|point| (point.seconds, 100.0 * point.error)).collect();
            if !points.is_empty() {
                let label = format!("{name}, order {order}");
                chart.series.push(Series::line(&label, points).drawn(style, index));
            }
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
