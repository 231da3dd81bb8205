//! Particle-steps per second of the spheres: a settled bed and free fall, and the cost against their number.
//!
//! `cargo bench --bench dem` for the table; with `-- 5000 2 4000` one bed of so many stones on so many threads for so
//! many steps.

use std::num::NonZeroUsize;
use std::time::Instant;

use ballast_gpr::packing::dem::{Setup, Simulation, TimeStep};

#[path = "../dem_support/mod.rs"]
mod dem_support;

fn rate(simulation: &mut Simulation, steps: u64, threads: usize) -> f64 {
    let begin = Instant::now();
    let threads = NonZeroUsize::new(threads).unwrap_or(NonZeroUsize::MIN);
    if let Err(error) = simulation.run_quietly(steps, threads) {
        eprintln!("{error}");
        std::process::exit(1);
    }
    steps as f64 * simulation.count() as f64 / begin.elapsed().as_secs_f64()
}

fn simulate(setup: Setup) -> Simulation {
    Simulation::new(setup).unwrap_or_else(|error| {
        eprintln!("{error}");
        std::process::exit(1)
    })
}

/// A bed of `count` stones in a box 1 m wide per 5000 stones: dropped softly (E 20 MPa) and then stiffened to 17.7 GPa from
/// the places of a bed with overlaps removed by growing the step again.
fn settled(count: usize, threads: usize) -> Simulation {
    let width = (count as f64 / 5000.0).sqrt().max(0.3);
    let mut setup = dem_support::loose_heap(count, width, 1);
    // Larger steps while it falls: 5 µs are 19 % of the Rayleigh time, 15 µs are 58 %.
    setup.time_step = TimeStep::Seconds(1.2e-5);
    let mut simulation = simulate(setup);
    let begin = Instant::now();
    for round in 0..60 {
        rate(&mut simulation, 2000, threads);
        let energy = simulation.kinetic_energy();
        if round % 10 == 9 {
            eprintln!(
                "  settling: {:.2} s of bed in {:.0} s, {energy:.3e} J, unbalanced {:.3}",
                simulation.time().si(),
                begin.elapsed().as_secs_f64(),
                simulation.unbalanced_force_ratio()
            );
        }
        if round > 15 && energy < 1e-4 * count as f64 * 1e-2 {
            break;
        }
    }
    let _ = simulation.set_time_step(TimeStep::Seconds(5e-6));
    simulation
}

fn main() {
    let numbers: Vec<u64> = std::env::args().filter_map(|word| word.parse().ok()).collect();
    if let [count, threads, steps] = numbers[..] {
        let mut fall = dem_support::loose_heap(count as usize, (count as f64 / 5000.0).sqrt(), 1);
        fall.walls.clear();
        let mut falling = simulate(fall);
        for _ in 0..3 {
            println!("fall {count} on {threads}: {:.3e}", rate(&mut falling, steps, threads as usize));
        }
        let mut bed = settled(count as usize, threads as usize);
        println!("coordination {:.2}", bed.coordination_number());
        for _ in 0..5 {
            println!("bed {count} on {threads}: {:.3e}", rate(&mut bed, steps, threads as usize));
        }
        return;
    }
    println!("| scene | stones | threads | particle-steps/s |\n|---|---|---|---|");
    for count in [5000, 20_000] {
        let mut bed = settled(count, 2);
        for threads in [1, 2] {
            let best = (0..3).map(|_| rate(&mut bed, 400, threads)).fold(0.0, f64::max);
            println!("| bed | {count} | {threads} | {best:.3e} |");
        }
    }
}
