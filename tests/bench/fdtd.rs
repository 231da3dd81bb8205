//! Speed of the embedded solver, in 10⁶ cells times steps per second of the loop: best of several short runs.
//!
//! `cargo bench --bench fdtd` prints the table; `-- small` only its first rows.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;

use ballast_gpr::fdtd::{Fdtd, InstructionSet, Precision};
use ballast_gpr::model::{
    Axis, DebyePole, Excitation, Grid, HertzianDipole, Material, Model, Object, Painted, Receiver, Source, TimeWindow,
    Waveform, WaveformKind, paint,
};

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

fn best(fdtd: Fdtd, model: &Model, painted: &Painted, runs: usize) -> f64 {
    let speed = |_| {
        let run = fdtd.solve_painted(model, painted, &|_| ControlFlow::Continue(()));
        run.map_or(f64::NAN, |(_, stats)| stats.cell_steps_per_second() / 1e6)
    };
    (0..runs).map(speed).fold(0.0, f64::max)
}

fn main() {
    let words: Vec<String> = std::env::args().collect();
    let small = words.iter().any(|word| word == "small");
    let sizes = if small { &[(750, 500)][..] } else { &[(750, 500), (1500, 1000), (3000, 2000)] };
    let mut wet = Material::dielectric("host", 3.5, 0.005);
    wet.poles.push(DebyePole { delta_eps: 6.0, tau: 9.231e-12 });
    wet.averagable = false;
    let hosts = [
        ("lossless", Material::dielectric("host", 1.0, 0.0)),
        ("lossy", Material::dielectric("host", 4.0, 0.005)),
        ("Debye", wet),
    ];
    println!("{:<12}{:<10}{:<8}{:<9}{:>9}{:>10}", "cells", "host", "number", "set", "1 thread", "2 threads");
    for &(nx, ny) in sizes {
        for (name, host) in &hosts {
            let steps = 100_000_000 / (nx * ny);
            let model = bed(nx, ny, steps, host.clone(), Material::dielectric("stone", 6.0, 0.0));
            let Ok(painted) = paint(&model) else { continue };
            for precision in [Precision::Single, Precision::Double] {
                for set in [InstructionSet::Avx512, InstructionSet::Avx2, InstructionSet::Scalar] {
                    if set == InstructionSet::Scalar && (nx > 750 || precision == Precision::Double) {
                        continue;
                    }
                    let run = |threads: usize| {
                        let fdtd = Fdtd { precision, threads: NonZeroUsize::new(threads), instruction_set: set };
                        best(fdtd, &model, &painted, 8)
                    };
                    let (one, two) = (run(1), run(2));
                    let (cells, number, set) = (format!("{nx}x{ny}"), precision.name(), set.name());
                    println!("{cells:<12}{name:<10}{number:<8}{set:<9}{one:>9.0}{two:>10.0}");
                }
            }
        }
    }
}
