//! Beds of stones to be timed.

use std::num::NonZeroUsize;
use std::time::Instant;

use ballast_gpr::geometry::Sphere;
use ballast_gpr::packing::dem::{Grain, Setup, Simulation, Stuff, TimeStep, Wall};

use super::dem_support::loose_heap;

/// The time step of all that is timed, s.
pub const TIME_STEP: f64 = 5e-6;
/// Stones of a tile, 1 m wide.
pub const TILE: usize = 5000;

/// What a simulation says, or the end of the bench.
pub fn must<T, E: std::fmt::Display>(result: Result<T, E>) -> T {
    result.unwrap_or_else(|error| {
        eprintln!("{error}");
        std::process::exit(1)
    })
}

/// Particle-steps per second of the next `steps` steps.
pub fn rate(simulation: &mut Simulation, steps: u64, threads: usize) -> f64 {
    let begin = Instant::now();
    must(simulation.run_quietly(steps, NonZeroUsize::new(threads).unwrap_or(NonZeroUsize::MIN)));
    steps as f64 * simulation.count() as f64 / begin.elapsed().as_secs_f64()
}

/// A tile of stones of 25–80 mm, dropped between four walls and come to rest; kept in the folder for temporary files.
pub fn settled_tile() -> Vec<Grain> {
    let state = std::env::temp_dir().join("ballast-gpr-bench-tile.state");
    if let Ok(kept) = Simulation::load(&state) {
        return kept.grains();
    }
    let mut setup = loose_heap(TILE, 1.0, 1);
    // While it falls a longer step will do: 47 % of the Rayleigh time.
    setup.time_step = TimeStep::Seconds(1.2e-5);
    let mut simulation = must(Simulation::new(setup));
    for round in 1..=70 {
        rate(&mut simulation, 2000, 2);
        let energy = simulation.kinetic_energy();
        if round % 10 == 0 {
            eprintln!("settling: {:.2} s of the bed, {energy:.2e} J", simulation.time().si());
        }
        if round > 40 && energy < 1e-2 {
            break;
        }
    }
    must(simulation.save(&state));
    simulation.grains()
}

/// Tiles side by side between four walls, at rest.
pub fn bed(tile: &[Grain], [nx, ny]: [usize; 2]) -> Setup {
    let mut grains = Vec::with_capacity(tile.len() * nx * ny);
    for n in 0..nx * ny {
        let shift = [(n % nx) as f64, (n / nx) as f64, 0.0];
        grains.extend(tile.iter().map(|grain| {
            let centre = std::array::from_fn(|k| grain.sphere.centre[k] + shift[k]);
            Grain::at_rest(Sphere { centre, radius: grain.sphere.radius })
        }));
    }
    let mut setup = Setup::new(Stuff::BALLAST, grains);
    setup.time_step = TimeStep::Seconds(TIME_STEP);
    let [wide, deep] = [nx as f64, ny as f64];
    setup.walls = vec![
        Wall::plane([0.0; 3], [0.0, 0.0, 1.0], 0),
        Wall::plane([0.0; 3], [1.0, 0.0, 0.0], 0),
        Wall::plane([wide, 0.0, 0.0], [-1.0, 0.0, 0.0], 0),
        Wall::plane([0.0; 3], [0.0, 1.0, 0.0], 0),
        Wall::plane([0.0, deep, 0.0], [0.0, -1.0, 0.0], 0),
    ];
    setup
}

/// Stones that fall and touch nothing.
pub fn fall(count: usize) -> Setup {
    let mut setup = loose_heap(count, (count as f64 / TILE as f64).sqrt(), 1);
    setup.walls.clear();
    setup
}
