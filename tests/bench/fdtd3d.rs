//! Speed of the embedded solver in three dimensions, in 10⁶ cells times steps per second of the loop: best of several short
//! runs, single precision, ten absorbing cells on each side, every node stepped in every step; and the time to paint 500
//! spheres into 2.3 million cells.
//!
//! `cargo bench --bench fdtd3d` prints the table; `-- small` only its first rows.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::time::Instant;

use ballast_gpr::fdtd::{Fdtd, InstructionSet};
use ballast_gpr::model::{
    Axis, Excitation, Grid, HertzianDipole, Material, Model, Object, Painted3, Receiver, Source, TimeWindow, Waveform,
    WaveformKind, paint3,
};

/// Spheres that may overlap, in the grid's lower two thirds.
fn bed(cells: [usize; 3], steps: usize, spheres: usize, sigma: f64) -> Model {
    let d = 0.004;
    let size = cells.map(|count| count as f64 * d);
    let mut model = Model::new("bench", Grid { cells, spacing: [d; 3] }, TimeWindow::Iterations(steps));
    let stone = model.add_material(Material::dielectric("stone", 6.0, sigma));
    for k in 0..spheres {
        let place = |factor: f64, size: f64| (k as f64 * factor).fract() * size;
        let centre = [place(0.618_034, size[0]), place(0.754_878, size[1]), place(0.569_84, 0.66 * size[2])];
        model.objects.push(Object::Sphere { centre, radius: 0.022, material: stone, averaging: true });
    }
    model.waveforms.push(Waveform { id: "w".into(), kind: WaveformKind::Ricker, amplitude: 1.0, frequency: 1e9 });
    let excitation = Excitation { start: 0.0, stop: None };
    let position = [0.5 * size[0], 0.5 * size[1], 0.8 * size[2]];
    model.sources.push(Source::HertzianDipole(HertzianDipole {
        polarisation: Axis::X,
        position,
        waveform: 0,
        excitation,
    }));
    model.receivers.push(Receiver { position: [0.55 * size[0], 0.5 * size[1], 0.8 * size[2]], name: None });
    model
}

fn best(model: &Model, painted: &Painted3, threads: usize, instruction_set: InstructionSet) -> f64 {
    let fdtd = Fdtd { threads: NonZeroUsize::new(threads), instruction_set, ..Fdtd::default() };
    let speed = |_| {
        let run = fdtd.solve_stepping_three(model, painted, false, &|_| ControlFlow::Continue(()));
        run.map_or(f64::NAN, |(_, stats)| stats.cell_steps_per_second() / 1e6)
    };
    (0..3).map(speed).fold(0.0, f64::max)
}

fn main() {
    let small = std::env::args().any(|word| word == "small");
    let model = bed([125, 125, 150], 1, 500, 0.001);
    let begin = Instant::now();
    if let Ok(painted) = paint3(&model) {
        let (seconds, bytes) = (begin.elapsed().as_secs_f64(), painted.bytes() as f64 / 1_048_576.0);
        println!("painting 500 spheres in {} cells: {seconds:.3} s, {bytes:.1} MiB", painted.solid.len());
    }
    println!("{:<10}{:<11}{:<10}{:>9}{:>10}", "cells", "stone", "set", "1 thread", "2 threads");
    for side in if small { &[128][..] } else { &[128, 200, 300] } {
        for (name, spheres, sigma) in [("none", 0, 0.0), ("lossless", 500, 0.0), ("lossy", 500, 0.001)] {
            let steps = 300_000_000 / (side * side * side) + 4;
            let model = bed([*side; 3], steps, spheres, sigma);
            let Ok(painted) = paint3(&model) else { continue };
            for set in [InstructionSet::Avx512, InstructionSet::Avx2, InstructionSet::Scalar] {
                let speed = |threads| best(&model, &painted, threads, set);
                let (one, two) = (speed(1), speed(2));
                println!("{:<10}{name:<11}{:<10}{one:>9.0}{two:>10.0}", format!("{side}³"), set.name());
            }
        }
    }
}
