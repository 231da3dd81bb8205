//! The embedded solver against gprMax 4.0.1 in turns in one run, single precision, the same number of threads, gprMax in its
//! best orientation (two-dimensional models invariant along y) and with its own OpenMP policy.
//!
//! `cargo bench --bench speed_table` prints the table (about 15 minutes on two quiet cores); words after `--` choose groups:
//! `planes`, `volumes` (loops in two and three dimensions), `scene`, `bscan`, `accuracy`, `prediction`. Loops: every cell makes
//! every step (no light cones), median of the rounds; scenes and B-scans: whole processes as a user runs them, light cones
//! included. Accuracy: the scenes of `cost fdtd2d` and `cost fdtd3d`, ours with the setting that reaches about the error that
//! gprMax's own rules reach with the finest cells tried; our painting and loop against gprMax's loop alone.
//!
//! Environment: `BENCH_ROUNDS` (5), `BENCH_THREADS` (2), `BALLAST_GPR_GPRMAX_PYTHON`. Without a gprMax the bench fails.

#[path = "support/peer.rs"]
mod peer;
#[path = "support/scenes.rs"]
mod scenes;

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use ballast_gpr::compare::relative_l2;
use ballast_gpr::fdtd::{Fdtd, Stepping, predict, predict_three};
use ballast_gpr::forward::Forward as _;
use ballast_gpr::gprmax::{InputOptions, Interpreter, install, read_traces, write_input};
use ballast_gpr::model::{Material, Model, Order, TimeWindow, paint, paint3};
use ballast_gpr::scene::Smoothing;
use ballast_gpr::study::{CostBed, CostScene, CostSetting, CostSolver, CostSubject, cost_of};
use ballast_gpr::trace::{AScan, Component};
use ballast_gpr::units::Metres;
use peer::{Outcome, least, load, median, ours, setting, theirs};
use scenes::{across_y, bed_2d, bed_3d, host, moist};

/// Cell, m, what happens where two materials meet, and the order of the differences.
type Setting = (f64, Smoothing, Order);

struct Bench {
    rounds: usize,
    threads: usize,
    python: Interpreter,
}

/// Speed of the loop in 10⁶ cells times steps per second, and memory per cell of fields and coefficients.
fn our_loop(model: &Model, threads: usize) -> Outcome<(f64, f64)> {
    let fdtd = Fdtd { threads: NonZeroUsize::new(threads), ..Fdtd::default() };
    let every = Stepping { skip: false, ..Stepping::default() };
    let go_on: ballast_gpr::forward::OnProgress<'_> = &|_| ControlFlow::Continue(());
    let (_, stats) = if model.is_plane() {
        fdtd.solve_stepping(model, &paint(model)?, every, go_on)?
    } else {
        fdtd.solve_stepping_three(model, &paint3(model)?, false, go_on)?
    };
    Ok((stats.cell_steps_per_second() / 1e6, stats.bytes as f64 / model.grid.cell_count() as f64))
}

impl Bench {
    fn their_loop(&self, model: &Model, folder: &Path) -> Outcome<f64> {
        write_input(model, folder, "loop", &InputOptions::default())?;
        let (input, output) = (folder.join("loop.in"), folder.join("loop.h5"));
        let [_, seconds] = theirs(&self.python, &input, &output, self.threads, &[])?;
        Ok((model.grid.cell_count() * model.iterations()) as f64 / seconds / 1e6)
    }

    /// One row: loops only.
    fn loops(&self, name: &str, must: &str, model: &Model, their_steps: usize, folder: &Path) -> Outcome<()> {
        let mut short = if model.grid.cells[2] == 1 { across_y(model) } else { model.clone() };
        short.time_window = TimeWindow::Iterations(their_steps);
        let (before, mut we, mut they, mut memory) = (load(), vec![], vec![], 0.0);
        for round in 0..self.rounds {
            // Each goes first as often as the other, so that a machine that slows down or warms up favours neither.
            for turn in 0..2 {
                if (round + turn) % 2 == 0 {
                    let (speed, bytes) = our_loop(model, self.threads)?;
                    we.push(1.0 / speed);
                    memory = bytes;
                } else {
                    they.push(1.0 / self.their_loop(&short, folder)?);
                }
            }
        }
        let best = least(&they) / least(&we);
        let (we, they) = (1.0 / median(&we), 1.0 / median(&they));
        let ratio = we / they;
        println!(
            "{name:<34}{we:>9.0}{they:>10.0}{ratio:>8.1}{best:>8.1}{must:>6}{memory:>8.1}  {before} -> {}",
            load()
        );
        Ok(())
    }

    /// One row: whole processes.
    fn process(&self, name: &str, must: &str, model: &Model, traces: Option<usize>, folder: &Path) -> Outcome<()> {
        let plain = InputOptions::default();
        write_input(model, folder, "ours", &plain)?;
        write_input(&across_y(model), folder, "theirs", &plain)?;
        let count = traces.map(|count| count.to_string());
        let our_words: Vec<&str> = count.as_deref().map_or(vec![], |count| vec!["--traces", count]);
        let their_words: Vec<&str> = count.as_deref().map_or(vec![], |count| vec!["-n", count, "--geometry-fixed"]);
        let (before, mut we, mut they) = (load(), vec![], vec![]);
        for round in 0..self.rounds {
            for turn in 0..2 {
                if (round + turn) % 2 == 0 {
                    let output = folder.join("ours.h5");
                    we.push(ours(&folder.join("ours.in"), &output, self.threads, &our_words)?[0]);
                } else {
                    let (input, output) = (folder.join("theirs.in"), folder.join("theirs.h5"));
                    they.push(theirs(&self.python, &input, &output, self.threads, &their_words)?[0]);
                }
            }
        }
        let last = count.as_deref().unwrap_or("");
        let (a, b) = (format!("theirs{last}.h5"), format!("ours{last}.h5"));
        let (a, b) = (read_traces(&folder.join(a))?, read_traces(&folder.join(b))?);
        let (a, b) = (a.receivers[0].component(Component::Ey), b.receivers[0].component(Component::Ez));
        let mut a = a.ok_or("no Ey")?.clone();
        a.component = Component::Ez;
        let b = b.ok_or("no Ez")?;
        // Turned about, the field has the other sign or the same; both did the same work in single precision.
        let flipped = AScan { samples: a.samples.iter().map(|v| -v).collect(), ..a.clone() };
        let difference = relative_l2(&a, b)?.min(relative_l2(&flipped, b)?);
        if difference.is_nan() || difference > 2e-5 {
            return Err(format!("{name}: the traces differ by {difference:e}").into());
        }
        let best = least(&they) / least(&we);
        let (we, they) = (median(&we), median(&they));
        let ratio = they / we;
        println!("{name:<34}{we:>8.2}s{they:>9.2}s{ratio:>8.1}{best:>8.1}{must:>6}{:>8}  {before} -> {}", "", load());
        Ok(())
    }

    /// One row: the time to about the same error, which is that of the echoes against the limit of ever finer cells.
    fn accuracy(
        &self,
        name: &str,
        subject: &dyn CostSubject,
        reference: &[f64],
        pair: [Setting; 2],
        folder: &Path,
    ) -> Outcome<()> {
        let single = Fdtd { threads: NonZeroUsize::new(self.threads), ..Fdtd::default() };
        let solver = CostSolver { solver: &single, double_precision: false, finest: Metres(0.0), bytes: &|_| Ok(0) };
        let cells: Vec<Metres> = reference.iter().map(|&cell| Metres(cell)).collect();
        let [mine, other] = pair.map(|(cell, smoothing, order)| CostSetting {
            cell: Metres(cell),
            smoothing,
            order,
            double_precision: false,
        });
        let points = cost_of(subject, &cells, &[mine, other], &solver, &|_| ControlFlow::Continue(()))?;
        let (model, same) = (subject.model(mine)?, subject.model(other)?);
        let turned = if same.is_plane() { across_y(&same) } else { same.clone() };
        write_input(&turned, folder, "accuracy", &InputOptions::default())?;
        let (input, output) = (folder.join("accuracy.in"), folder.join("accuracy.h5"));
        let (before, mut we, mut they) = (load(), vec![], vec![]);
        for _ in 0..self.rounds {
            let begin = Instant::now();
            single.solve(&model, &|_| ControlFlow::Continue(()))?;
            we.push(begin.elapsed().as_secs_f64());
            they.push(theirs(&self.python, &input, &output, self.threads, &[])?[1]);
        }
        // gprMax's trace is the one whose error was found.
        let component = subject.component();
        let theirs = read_traces(&output)?;
        let of_theirs = if same.is_plane() { Component::Ey } else { component };
        let a = theirs.receivers[0].component(of_theirs).ok_or("no such component")?.clone();
        let ours = single.solve(&same, &|_| ControlFlow::Continue(()))?;
        let b = ours.receivers[0].component(component).ok_or("no such component")?;
        let sign = |sign: f64| AScan { samples: a.samples.iter().map(|v| sign * v).collect(), component, ..a.clone() };
        let difference = relative_l2(&sign(1.0), b)?.min(relative_l2(&sign(-1.0), b)?);
        if difference.is_nan() || difference > 1e-3 {
            return Err(format!("{name}: the traces differ by {difference:e}").into());
        }
        let (ratio, best) = (median(&they) / median(&we), least(&they) / least(&we));
        println!(
            "{name:<34}{:>8.2}s{:>9.2}s{ratio:>8.0}{best:>8.0}{:>6}{:>8}  {before} -> {}",
            median(&we),
            median(&they),
            "100",
            "",
            load()
        );
        for (who, setting, point) in [("ours", mine, &points[0]), ("gprMax", other, &points[1])] {
            let CostSetting { cell, smoothing, order, .. } = setting;
            println!(
                "    {who}: cells of {}, `{}`, order {order}: {:.2} %",
                cell.in_unit("mm"),
                smoothing.name(),
                100.0 * point.error
            );
        }
        Ok(())
    }

    /// What `explain` says beforehand beside what the run then takes.
    fn prediction(&self, name: &str, model: &Model) -> Outcome<()> {
        let threads = NonZeroUsize::new(self.threads);
        let fdtd = Fdtd { threads, ..Fdtd::default() };
        let go_on: ballast_gpr::forward::OnProgress<'_> = &|_| ControlFlow::Continue(());
        let (predicted, stats) = if model.is_plane() {
            let painted = paint(model)?;
            (predict(model, &painted, threads)?, fdtd.solve_painted(model, &painted, go_on)?.1)
        } else {
            let painted = paint3(model)?;
            (predict_three(model, &painted, threads)?, fdtd.solve_painted_three(model, &painted, go_on)?.1)
        };
        let measured = stats.wall.si();
        let off = 100.0 * (predicted.seconds / measured - 1.0);
        println!("{name:<34}{:>8.2}s{measured:>9.2}s{off:>+7.0}%{:>8}", predicted.seconds, "±30 %");
        Ok(())
    }
}

fn main() -> Outcome<()> {
    let bench = Bench {
        rounds: setting("BENCH_ROUNDS", "5").parse()?,
        threads: setting("BENCH_THREADS", "2").parse()?,
        python: install::find(None)?,
    };
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let asked = |group: &str| words.is_empty() || words.iter().any(|word| word == group);
    let folder = tempfile::tempdir()?;
    let place = folder.path();
    println!("{} threads, {} rounds in turns; medians, and the ratio of the best", bench.threads, bench.rounds);
    println!(
        "{:<34}{:>9}{:>10}{:>8}{:>8}{:>6}{:>8}  load",
        "10⁶ cell-steps/s, or time", "ours", "gprMax", "ratio", "best", "must", "B/cell"
    );
    if asked("planes") {
        for (nx, ny, must, we, they) in
            [(750, 500, "15", 2400, 800), (1500, 1000, "15", 800, 200), (3000, 2000, "12", 200, 50)]
        {
            let model = bed_2d(nx, ny, we, host(), nx * ny / 1250);
            bench.loops(&format!("2-D {nx} x {ny}"), must, &model, they, place)?;
        }
        bench.loops("2-D 750 x 500, Debye pole", "10", &bed_2d(750, 500, 1200, moist(), 0), 400, place)?;
    }
    if asked("volumes") {
        // Enough steps that touching the memory for the first time, which gprMax does before its loop, is a small part.
        for (side, we, they) in [(128, 800, 60), (200, 300, 20), (300, 150, 8)] {
            let model = bed_3d([side; 3], we, host(), side * side * side / 4200);
            bench.loops(&format!("3-D {side}³"), "8", &model, they, place)?;
        }
        bench.loops("3-D 128³, Debye pole", "6", &bed_3d([128; 3], 400, moist(), 0), 30, place)?;
    }
    let section = |window: f64| {
        let mut model = bed_2d(750, 500, 1, host(), 300);
        model.time_window = TimeWindow::Seconds(window);
        model
    };
    if asked("scene") {
        bench.process("2-D scene 750 x 500, 15 ns", "30", &section(15e-9), None, place)?;
    }
    if asked("bscan") {
        let mut model = bed_2d(300, 200, 1, host(), 50);
        model.time_window = TimeWindow::Seconds(8e-9);
        (model.source_steps, model.receiver_steps) = ([0.002, 0.0, 0.0], [0.002, 0.0, 0.0]);
        bench.process("B-scan of 50, 300 x 200, 8 ns", "30", &model, Some(50), place)?;
    }
    if asked("accuracy") {
        let plane = CostScene::standard()?;
        let pair = [(1.6e-3, Smoothing::Area, Order::Second), (1e-3, Smoothing::Edges, Order::Second)];
        bench.accuracy("2-D, 1 % error of the echoes", &plane, &[2e-3, 1e-3, 0.5e-3], pair, place)?;
        let space = CostBed::standard();
        // gprMax's rule is of first order in space: 1 % would take cells of a tenth of a millimetre. It gets 1.25 mm.
        let pair = [(2e-3, Smoothing::Tensors, Order::Second), (1.25e-3, Smoothing::Edges, Order::Second)];
        bench.accuracy("3-D, 1 % of the echoes, theirs 13 %", &space, &[5e-3, 2.5e-3, 1.25e-3], pair, place)?;
    }
    if asked("prediction") {
        println!("{:<34}{:>9}{:>10}{:>8}", "`explain`", "predicted", "measured", "off");
        let lossy = Material::dielectric("host", 4.0, 0.005);
        bench.prediction("2-D lossless 750 x 500, 15 ns", &section(15e-9))?;
        bench.prediction("2-D lossy 1500 x 1000", &bed_2d(1500, 1000, 3000, lossy.clone(), 1200))?;
        bench.prediction("2-D Debye 750 x 500", &bed_2d(750, 500, 3000, moist(), 0))?;
        bench.prediction("3-D 128³, 500 spheres", &bed_3d([128; 3], 600, host(), 500))?;
        bench.prediction("3-D 200³, lossy", &bed_3d([200; 3], 300, lossy, 1900))?;
        bench.prediction("3-D Debye 100³", &bed_3d([100; 3], 400, moist(), 0))?;
    }
    Ok(())
}
