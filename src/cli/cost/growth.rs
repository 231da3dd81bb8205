//! How the time of the built-in solver grows with cells and steps, and how near it comes to what the machine can give.

use std::num::NonZeroUsize;

use crate::cli::cost::CostArgs;
use crate::cli::cost::roofline::in_place_bandwidth;
use crate::cli::error::CliError;
use crate::cli::interrupt;
use crate::cli::progress::Bar;
use crate::cli::table::Report;
use crate::fdtd::{Fdtd, Stats, Stepping};
use crate::files;
use crate::forward::{ForwardError, Progress};
use crate::model::{self, Grid, Material, Model, Object, TimeWindow};
use crate::plot::{Axis, Chart, Figure as _, Series, Stroke};
use crate::study::fit_exponent;

/// Cell-steps of one measurement: about half a second.
const CELL_STEPS: usize = 300_000_000;
/// Fewest steps: touching the memory for the first time is to be a small part.
const LEAST_STEPS: usize = 80;
/// Runs of each grid, of which the median counts.
const RUNS: usize = 5;
/// Grids on a plane, 3:2 as a section of a bed is.
const PLANES: [[usize; 3]; 6] =
    [[94, 63, 1], [188, 125, 1], [375, 250, 1], [750, 500, 1], [1500, 1000, 1], [3000, 2000, 1]];
/// Cubes.
const CUBES: [[usize; 3]; 5] = [[32; 3], [64; 3], [128; 3], [200; 3], [300; 3]];

/// One grid.
#[derive(Debug, Clone, serde::Serialize)]
struct Point {
    dimensions: usize,
    cells: [usize; 3],
    steps: usize,
    seconds_per_step: f64,
    cell_steps_per_second: f64,
    bytes_per_cell: f64,
    /// Share of what memory alone would allow if every step went over all fields once.
    share_of_memory: f64,
}

/// Bytes that a step of a cell moves at the least when each step goes over the grid once: three fields read and written and
/// one coefficient in two dimensions, six and three index bytes in three.
fn least_bytes(dimensions: usize) -> f64 {
    if dimensions == 2 { 2.0 * 3.0 * 4.0 + 4.0 } else { 2.0 * 6.0 * 4.0 + 3.0 }
}

/// Free space with a lossless block over the lower half, ten absorbing cells around.
fn block(cells: [usize; 3], steps: usize) -> Model {
    let d = 0.002;
    let mut model = Model::new("growth", Grid { cells, spacing: [d; 3] }, TimeWindow::Iterations(steps));
    let stone = model.add_material(Material::dielectric("stone", 6.0, 0.0));
    let upper = std::array::from_fn(|axis| cells[axis] as f64 * d * if axis == 1 { 0.5 } else { 1.0 });
    model.objects.push(Object::Box { lower: [0.0; 3], upper, material: stone, averaging: true });
    model
}

fn solve(fdtd: &Fdtd, model: &Model) -> Result<Stats, CliError> {
    let every = Stepping { skip: false, ..Stepping::default() };
    Ok(if model.is_plane() {
        fdtd.solve_stepping(model, &model::paint(model)?, every, &|_| interrupt::flow())?.1
    } else {
        fdtd.solve_stepping_three(model, &model::paint3(model)?, false, &|_| interrupt::flow())?.1
    })
}

fn measure(cells: [usize; 3], bandwidth: f64) -> Result<Point, CliError> {
    let dimensions = if cells[2] == 1 { 2 } else { 3 };
    let all: usize = cells.iter().product();
    let steps = (CELL_STEPS / all).clamp(LEAST_STEPS, 20_000);
    let model = block(cells, steps + 1);
    let runs: Result<Vec<Stats>, CliError> = (0..RUNS).map(|_| solve(&Fdtd::default(), &model)).collect();
    let mut runs = runs?;
    runs.sort_by(|a, b| a.wall.si().total_cmp(&b.wall.si()));
    let middle = runs[RUNS / 2];
    let rate = (all * steps) as f64 / middle.wall.si();
    Ok(Point {
        dimensions,
        cells,
        steps,
        seconds_per_step: middle.wall.si() / steps as f64,
        cell_steps_per_second: rate,
        bytes_per_cell: middle.bytes as f64 / all as f64,
        share_of_memory: rate * least_bytes(dimensions) / bandwidth,
    })
}

/// Measures and shows the growth.
pub(super) fn run(args: &CostArgs) -> Result<(), CliError> {
    let threads = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let bar = Bar::new("grids");
    let main_memory = in_place_bandwidth(threads, 256 << 20);
    let inner_cache = in_place_bandwidth(threads, 24 << 10);
    let grids: Vec<[usize; 3]> = PLANES.into_iter().chain(CUBES).filter(|cells| fits(*cells, args)).collect();
    let mut points = Vec::new();
    for (index, cells) in grids.iter().enumerate() {
        points.push(measure(*cells, main_memory)?);
        if interrupt::requested() {
            return Err(ForwardError::Stopped.into());
        }
        let _ = bar.update(Progress { done: index + 1, total: grids.len() });
    }
    drop(bar);
    let exponent = |dimensions| {
        let of = |point: &&Point| point.dimensions == dimensions;
        let pair = |point: &Point| (point.cells.iter().product::<usize>() as f64, point.seconds_per_step);
        fit_exponent(&points.iter().filter(of).map(pair).collect::<Vec<_>>()).map(|(exponent, _)| exponent)
    };
    let exponents = [exponent(2), exponent(3)];
    let json = serde_json::json!({
        "threads": threads, "main_memory_bytes_per_second": main_memory, "inner_cache_bytes_per_second": inner_cache,
        "points": points, "exponents": exponents,
    });
    let json = serde_json::to_string_pretty(&json)? + "\n";
    if let Some(folder) = &args.out {
        files::write_bytes(&folder.join("cost-growth.json"), json.as_bytes())?;
        figure(&points, main_memory).write(folder, "cost-growth")?;
    }
    if args.json {
        print!("{json}");
        return Ok(());
    }
    let mut table = Report::new(
        format!("The built-in solver, every cell at every step, single precision, {threads} threads, median of {RUNS}"),
        ["cells", "steps", "ms per step", "10⁶ cell-steps/s", "bytes per cell", "of one sweep at memory speed"],
    );
    for point in &points {
        table.row([
            point.cells.iter().filter(|count| **count > 1).map(usize::to_string).collect::<Vec<_>>().join(" x "),
            point.steps.to_string(),
            format!("{:.3}", 1e3 * point.seconds_per_step),
            format!("{:.0}", point.cell_steps_per_second / 1e6),
            format!("{:.1}", point.bytes_per_cell),
            format!("{:.0} %", 100.0 * point.share_of_memory),
        ]);
    }
    table.print();
    println!(
        "in place, all threads: {:.0} GB/s in main memory, {:.0} GB/s in the innermost cache",
        main_memory / 1e9,
        inner_cache / 1e9
    );
    println!("more than 100 %: several steps are made while the fields are in a cache");
    if let [Some(plane), Some(cube)] = exponents {
        println!(
            "time of a step grows as N^{plane:.2} in two dimensions, N^{cube:.2} in three; with the steps linearly"
        );
    }
    Ok(())
}

/// Whether a grid is within what the user lets it measure.
fn fits(cells: [usize; 3], args: &CostArgs) -> bool {
    args.cells.is_none_or(|most| cells.iter().product::<usize>() <= most)
}

fn figure(points: &[Point], bandwidth: f64) -> Chart {
    let curve = |dimensions: usize| -> Vec<(f64, f64)> {
        let of = points.iter().filter(|point| point.dimensions == dimensions);
        of.map(|point| (point.cells.iter().product::<usize>() as f64, point.seconds_per_step)).collect()
    };
    let memory = |dimensions: usize| -> Vec<(f64, f64)> {
        curve(dimensions).iter().map(|(cells, _)| (*cells, cells * least_bytes(dimensions) / bandwidth)).collect()
    };
    Chart::new("Time of a step", Axis::log10("cells", ""), Axis::log10("time of a step", "s"))
        .with(Series::line("two dimensions", curve(2)).drawn(Stroke::LineAndPoints, 0))
        .with(Series::line("three dimensions", curve(3)).drawn(Stroke::LineAndPoints, 1))
        .with(Series::line("2-D, one sweep at memory speed", memory(2)).drawn(Stroke::Dotted, 0))
        .with(Series::line("3-D, one sweep at memory speed", memory(3)).drawn(Stroke::Dotted, 1))
}
