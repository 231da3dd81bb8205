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
use crate::model::{self, Grid, Material, Model, Object, Painted, Painted3, TimeWindow};
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

/// Grids whose time is measured over the steps, too.
const OVER_STEPS: [[usize; 3]; 2] = [[375, 250, 1], [64; 3]];
/// Numbers of steps.
const STEPS: [usize; 4] = [250, 500, 1000, 2000];

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

/// A run of one grid over one number of steps.
#[derive(Debug, Clone, serde::Serialize)]
struct StepsPoint {
    dimensions: usize,
    cells: [usize; 3],
    steps: usize,
    seconds: f64,
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

/// A model with its cells and edges, painted once for all runs.
enum Scene {
    Two(Model, Painted),
    Three(Model, Box<Painted3>),
}

impl Scene {
    fn of(cells: [usize; 3]) -> Result<Self, CliError> {
        let model = block(cells, LEAST_STEPS);
        Ok(if model.is_plane() {
            let painted = model::paint(&model)?;
            Self::Two(model, painted)
        } else {
            let painted = model::paint3(&model)?;
            Self::Three(model, Box::new(painted))
        })
    }

    /// The middle one of several runs of so many steps.
    fn run(&mut self, steps: usize) -> Result<Stats, CliError> {
        let fdtd = Fdtd::default();
        // One sample more than steps: the last sample is taken after the last step.
        let window = TimeWindow::Iterations(steps + 1);
        let runs: Result<Vec<Stats>, CliError> = (0..RUNS)
            .map(|_| {
                Ok(match self {
                    Self::Two(model, painted) => {
                        model.time_window = window;
                        let every = Stepping { skip: false, ..Stepping::default() };
                        fdtd.solve_stepping(model, painted, every, &|_| interrupt::flow())?.1
                    }
                    Self::Three(model, painted) => {
                        model.time_window = window;
                        fdtd.solve_stepping_three(model, painted, false, &|_| interrupt::flow())?.1
                    }
                })
            })
            .collect();
        let mut runs = runs?;
        runs.sort_by(|a, b| a.wall.si().total_cmp(&b.wall.si()));
        Ok(runs[RUNS / 2])
    }
}

fn measure(cells: [usize; 3], bandwidth: f64) -> Result<(Point, Vec<StepsPoint>), CliError> {
    let dimensions = if cells[2] == 1 { 2 } else { 3 };
    let all: usize = cells.iter().product();
    let steps = (CELL_STEPS / all).clamp(LEAST_STEPS, 20_000);
    let mut scene = Scene::of(cells)?;
    let middle = scene.run(steps)?;
    let rate = (all * steps) as f64 / middle.wall.si();
    let point = Point {
        dimensions,
        cells,
        steps,
        seconds_per_step: middle.wall.si() / steps as f64,
        cell_steps_per_second: rate,
        bytes_per_cell: middle.bytes as f64 / all as f64,
        share_of_memory: rate * least_bytes(dimensions) / bandwidth,
    };
    let lengths = if OVER_STEPS.contains(&cells) { &STEPS[..] } else { &[] };
    let over_steps = lengths.iter().map(|&steps| {
        let seconds = scene.run(steps)?.wall.si();
        Ok(StepsPoint { dimensions, cells, steps, seconds })
    });
    Ok((point, over_steps.collect::<Result<_, CliError>>()?))
}

/// Measures and shows the growth.
pub(super) fn run(args: &CostArgs) -> Result<(), CliError> {
    let threads = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let bar = Bar::new("grids");
    let main_memory = in_place_bandwidth(threads, 256 << 20);
    let inner_cache = in_place_bandwidth(threads, 24 << 10);
    let grids: Vec<[usize; 3]> = PLANES.into_iter().chain(CUBES).filter(|cells| fits(*cells, args)).collect();
    let (mut points, mut over_steps) = (Vec::new(), Vec::new());
    for (index, cells) in grids.iter().enumerate() {
        let (point, some) = measure(*cells, main_memory)?;
        points.push(point);
        over_steps.extend(some);
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
    let exponents_of_steps = [2, 3].map(|dimensions| {
        let of = over_steps.iter().filter(|point| point.dimensions == dimensions);
        fit_exponent(&of.map(|point| (point.steps as f64, point.seconds)).collect::<Vec<_>>())
            .map(|(exponent, _)| exponent)
    });
    let json = serde_json::json!({
        "threads": threads, "main_memory_bytes_per_second": main_memory, "inner_cache_bytes_per_second": inner_cache,
        "points": points, "exponents": exponents, "over_steps": over_steps, "exponents_of_steps": exponents_of_steps,
    });
    let json = serde_json::to_string_pretty(&json)? + "\n";
    if let Some(folder) = &args.out {
        files::write_bytes(&folder.join("cost-growth.json"), json.as_bytes())?;
        files::write_bytes(&folder.join("cost-growth.csv"), csv(&points).as_bytes())?;
        figure(&points, main_memory).write(folder, "cost-growth")?;
        figure_over_steps(&over_steps).write(folder, "cost-growth-steps")?;
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
    for (what, exponents) in
        [("of a step grows with the cells as N", exponents), ("grows with the steps as n", exponents_of_steps)]
    {
        if let [Some(plane), Some(cube)] = exponents {
            println!("time {what}^{plane:.2} in two dimensions, ^{cube:.2} in three");
        }
    }
    Ok(())
}

/// Whether a grid is within what the user lets it measure.
fn fits(cells: [usize; 3], args: &CostArgs) -> bool {
    args.cells.is_none_or(|most| cells.iter().product::<usize>() <= most)
}

/// One line per grid.
fn csv(points: &[Point]) -> String {
    let mut text =
        "cells_x,cells_y,cells_z,steps,seconds_per_step,cell_steps_per_second,bytes_per_cell,share_of_memory\n"
            .to_string();
    for point in points {
        let [nx, ny, nz] = point.cells;
        let Point { steps, seconds_per_step, cell_steps_per_second, bytes_per_cell, share_of_memory, .. } = point;
        text += &format!(
            "{nx},{ny},{nz},{steps},{seconds_per_step:e},{cell_steps_per_second:e},{bytes_per_cell},{share_of_memory}\n"
        );
    }
    text
}

fn figure_over_steps(points: &[StepsPoint]) -> Chart {
    let curve = |dimensions: usize| -> Vec<(f64, f64)> {
        points
            .iter()
            .filter(|point| point.dimensions == dimensions)
            .map(|point| (point.steps as f64, point.seconds))
            .collect()
    };
    Chart::new("Time of a run", Axis::log10("steps", ""), Axis::log10("time", "s"))
        .with(Series::line("375 x 250 cells", curve(2)).drawn(Stroke::LineAndPoints, 0))
        .with(Series::line("64³ cells", curve(3)).drawn(Stroke::LineAndPoints, 1))
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
