//! What the tests of the spheres share.
#![expect(dead_code, reason = "each test program uses its own part")]

use std::num::NonZeroUsize;

use ballast_gpr::geometry::Sphere;
use ballast_gpr::packing::dem::{Grain, Setup, Simulation, Stuff, TimeStep, Wall};

pub const ONE: NonZeroUsize = NonZeroUsize::MIN;

pub fn threads(count: usize) -> NonZeroUsize {
    NonZeroUsize::new(count).unwrap()
}

pub fn floor() -> Wall {
    Wall::plane([0.0; 3], [0.0, 0.0, 1.0], 0)
}

pub fn sphere(centre: [f64; 3], radius: f64) -> Grain {
    Grain::at_rest(Sphere { centre, radius })
}

/// Mass of a stone of ballast, kg.
pub fn mass(radius: f64) -> f64 {
    4.0 / 3.0 * std::f64::consts::PI * radius.powi(3) * Stuff::BALLAST.density
}

/// Numbers that look random and are the same everywhere: splitmix64.
pub struct Numbers(pub u64);

impl Numbers {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

/// A jittered lattice of `count` stones of 25–80 mm over a floor between four walls `width` apart.
pub fn loose_heap(count: usize, width: f64, seed: u64) -> Setup {
    let mut numbers = Numbers(seed);
    let spacing = 0.085;
    let across = (width / spacing) as usize;
    let mut grains = vec![];
    for n in 0..count {
        let (x, y, z) = (n % across, n / across % across, n / across / across);
        let radius = numbers.between(0.0125, 0.04);
        let place =
            [x, y, z].map(|k| (k as f64 + 0.5) * spacing + numbers.between(-1.0, 1.0) * (spacing / 2.0 - radius));
        grains.push(sphere(place, radius));
    }
    let mut setup = Setup::new(Stuff::BALLAST, grains);
    setup.time_step = TimeStep::Seconds(5e-6);
    setup.walls = vec![
        floor(),
        Wall::plane([0.0; 3], [1.0, 0.0, 0.0], 0),
        Wall::plane([width, 0.0, 0.0], [-1.0, 0.0, 0.0], 0),
        Wall::plane([0.0; 3], [0.0, 1.0, 0.0], 0),
        Wall::plane([0.0, width, 0.0], [0.0, -1.0, 0.0], 0),
    ];
    setup
}

/// All bits of the grains.
pub fn bits(simulation: &Simulation) -> Vec<u64> {
    simulation
        .grains()
        .iter()
        .flat_map(|grain| {
            [grain.sphere.centre, grain.velocity, grain.spin]
                .into_iter()
                .flatten()
                .map(f64::to_bits)
                .collect::<Vec<_>>()
        })
        .collect()
}
