//! Speed of the embedded solver, in 10⁶ cells times steps per second of the loop: best of several short runs.
//!
//! `cargo bench --bench fdtd` prints the table; `-- small` only its first rows, `-- large` its last. Every step of every cell is
//! made (`skip: false`); one step per pass is how a solver without time tiling goes over the grid.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;

use ballast_gpr::fdtd::{Fdtd, InstructionSet, Precision, Stepping, predict, reach};
use ballast_gpr::model::{
    Axis, DebyePole, Excitation, Grid, HertzianDipole, Material, Model, Object, Painted, Receiver, Source, TimeWindow,
    Waveform, WaveformKind, paint,
};
use ballast_gpr::raster::build_model;
use ballast_gpr::scene::{SceneSpec, resolve};

/// A bed of cylinders in a host that fills the grid's lower half.
fn bed(nx: usize, ny: usize, steps: usize, host: Material, stone: Material) -> Model {
    let d = 0.002;
    let (width, height) = (nx as f64 * d, ny as f64 * d);
    let mut model = Model::new("bench", Grid { cells: [nx, ny, 1], spacing: [d; 3] }, TimeWindow::Iterations(steps));
    let (host, stone) = (model.add_material(host), model.add_material(stone));
    model.objects.push(Object::Box {
        lower: [0.0; 3],
        upper: [width, 0.6 * height, d],
        material: host,
        averaging: true,
    });
    for k in 0..(nx * ny / 1250) {
        let (x, y) = ((k as f64 * 0.618_034).fract() * width, (k as f64 * 0.754_878).fract() * 0.6 * height);
        let (start, end) = ([x, y, 0.0], [x, y, d]);
        model.objects.push(Object::Cylinder { start, end, radius: 0.02, material: stone, averaging: true });
    }
    model.waveforms.push(Waveform { id: "w".into(), kind: WaveformKind::Ricker, amplitude: 1.0, frequency: 1e9 });
    let position = [0.5 * width, 0.8 * height, 0.0];
    let excitation = Excitation { start: 0.0, stop: None };
    model.sources.push(Source::HertzianDipole(HertzianDipole {
        polarisation: Axis::Z,
        position,
        waveform: 0,
        excitation,
    }));
    model.receivers.push(Receiver { position: [0.55 * width, 0.8 * height, 0.0], name: None });
    model
}

/// Speed of the loop, and of the processor alone where one thread does all (`None` elsewhere than Linux).
#[derive(Clone, Copy, Default)]
struct Speed {
    wall: f64,
    processor: f64,
}

/// Nanoseconds that this thread has run.
fn processor_time() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    text.split(' ').next()?.parse().ok()
}

/// Best of several runs of each order of steps, taken in turn, so that all meet the same load.
fn speeds(model: &Model, painted: &Painted, fdtd: Fdtd, orders: &[Stepping], runs: usize) -> Vec<Speed> {
    let mut short = model.clone();
    short.time_window = TimeWindow::Iterations(1);
    let run = |model: &Model, stepping| {
        let before = processor_time();
        let run = fdtd.solve_stepping(model, painted, stepping, &|_| ControlFlow::Continue(()));
        let spent = processor_time().zip(before).map_or(f64::NAN, |(after, before)| after - before);
        run.map_or((f64::NAN, f64::NAN), |(_, stats)| (stats.cell_steps_per_second() / 1e6, spent))
    };
    let cell_steps = (model.grid.cell_count() * (model.iterations() - 1)) as f64;
    let mut best = vec![Speed::default(); orders.len()];
    for _ in 0..runs {
        for (best, &order) in best.iter_mut().zip(orders) {
            let ((_, idle), (wall, spent)) = (run(&short, order), run(model, order));
            best.wall = best.wall.max(wall);
            best.processor = best.processor.max(cell_steps / (spent - idle) * 1e3);
        }
    }
    best
}

/// The preset `tank`: what light cones and passes spare together.
fn tank() {
    let scene = SceneSpec::preset("tank").ok().and_then(|spec| resolve(&spec).ok());
    let Some(model) = scene.and_then(|scene| build_model(&scene).ok()) else { return };
    let Ok(painted) = paint(&model) else { return };
    let Ok(reach) = reach(&model, &painted) else { return };
    let plain = Stepping { steps_per_pass: NonZeroUsize::new(1), skip: false };
    let orders = [plain, Stepping { steps_per_pass: None, ..plain }, Stepping::default()];
    let fdtd = Fdtd { threads: NonZeroUsize::new(1), ..Fdtd::default() };
    let best = speeds(&model, &painted, fdtd, &orders, 3);
    println!("tank: {:.1} % of the cell-steps left out", 100.0 * reach.share_saved);
    for (name, speed) in ["one step per pass", "several", "several, light cones"].iter().zip(best) {
        println!("tank, one thread, {name}: {:.0} wall, {:.0} processor", speed.wall, speed.processor);
    }
}

fn main() {
    tank();
    let words: Vec<String> = std::env::args().collect();
    let asked = |size: &str| words.iter().any(|word| word == size);
    let all = [(750, 500), (1500, 1000), (3000, 2000)];
    let sizes = if asked("small") {
        &all[..1]
    } else if asked("large") {
        &all[2..]
    } else {
        &all[..]
    };
    let mut wet = Material::dielectric("host", 3.5, 0.005);
    wet.poles.push(DebyePole { delta_eps: 6.0, tau: 9.231e-12 });
    wet.averagable = false;
    let hosts = [
        ("lossless", Material::dielectric("host", 1.0, 0.0), Precision::Single),
        ("lossy", Material::dielectric("host", 4.0, 0.005), Precision::Single),
        ("Debye", wet, Precision::Single),
        ("lossless", Material::dielectric("host", 1.0, 0.0), Precision::Double),
    ];
    let depths = [1, 2, 4, 8, 16];
    let orders = depths.map(|depth| Stepping { steps_per_pass: NonZeroUsize::new(depth), skip: false });
    println!("steps per pass; w: wall time, p: processor time (one thread)");
    println!(
        "{:<11}{:<10}{:<8}{:<9}{:<4}{}",
        "cells",
        "host",
        "number",
        "set",
        "",
        depths.map(|d| format!("{d:>8}")).concat()
    );
    for &(nx, ny) in sizes {
        for (name, host, precision) in &hosts {
            let steps = (200_000_000 / (nx * ny)).max(48) / 16 * 16 + 1;
            let model = bed(nx, ny, steps, host.clone(), Material::dielectric("stone", 6.0, 0.0));
            let Ok(painted) = paint(&model) else { continue };
            for instruction_set in [InstructionSet::Avx512, InstructionSet::Avx2] {
                if instruction_set == InstructionSet::Avx2 && nx > 750 {
                    continue;
                }
                for threads in [1, 2] {
                    let fdtd = Fdtd { precision: *precision, threads: NonZeroUsize::new(threads), instruction_set };
                    let best = speeds(&model, &painted, fdtd, &orders, 6);
                    let (cells, number, set) = (format!("{nx}x{ny}"), precision.name(), instruction_set.name());
                    let print = |kind: &str, of: &dyn Fn(&Speed) -> f64| {
                        let row: String = best.iter().map(|speed| format!("{:>8.0}", of(speed))).collect();
                        println!("{cells:<11}{name:<10}{number:<8}{set:<9}{kind:<4}{row}");
                    };
                    print(&format!("{threads}w"), &|speed| speed.wall);
                    if threads == 1 {
                        print("1p", &|speed| speed.processor);
                    }
                    if instruction_set == InstructionSet::Avx512 {
                        // So long a run that light cones leave next to nothing out.
                        let mut long = model.clone();
                        long.time_window = TimeWindow::Iterations(20_000);
                        let begin = std::time::Instant::now();
                        let Ok(predicted) = predict(&long, &painted, fdtd.threads) else { continue };
                        let milliseconds = 1e3 * begin.elapsed().as_secs_f64();
                        let whole = predicted.seconds / (1.0 - predicted.share_saved);
                        let speed = predicted.cell_steps as f64 / whole / 1e6;
                        println!("{:>38}  predicted {speed:.0} in {milliseconds:.0} ms", "");
                    }
                }
            }
        }
    }
}
