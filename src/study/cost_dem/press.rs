//! How far a bed settles under a load: a plate as large as the floor presses it.

use std::num::NonZeroUsize;

use crate::packing::SphereBed;
use crate::packing::dem::{DemError, Motion, Simulation, Wall};
use crate::packing::settle::{SettleInput, box_of_stones};
use crate::units::Pascals;

/// From and up to which stress the settlement counts: a light roller to what a heavy axle leaves under the sleeper's depth.
pub const PRESSED: [Pascals; 2] = [Pascals(5e3), Pascals(50e3)];
/// Speed of the plate, m/s. Its inertial number `v / h d √(ρ / p)` is 0.002 in 30 cm of ballast: slow.
const SPEED: f64 = 0.02;
/// Way of the plate between two looks at its stress, m, and looks whose mean counts.
const LOOK: (f64, usize) = (2e-6, 4);
/// Gap that the plate begins with above the highest stone, m.
const CLEAR: f64 = 1e-4;
/// Strain at which nothing more is expected.
const MOST: f64 = 0.3;

/// Strain of a bed between the stresses of [`PRESSED`], with the stones it was settled with; none where the plate never
/// meets that stress.
///
/// # Errors
/// When the simulation goes bad.
pub fn settlement(input: &SettleInput, bed: &SphereBed) -> Result<Option<f64>, DemError> {
    let (top, area) = (bed.top().si(), bed.floor_area());
    let mut setup = box_of_stones(input, bed.spheres.clone(), true);
    let plate = setup.walls.len();
    let down = Motion::Prescribed {
        velocity: [0.0, 0.0, -SPEED],
        spin: [0.0; 3],
        about: [0.0; 3],
        from: 0.0,
        until: f64::INFINITY,
    };
    setup.walls.push(Wall::plane([0.0, 0.0, top + CLEAR], [0.0, 0.0, -1.0], 0).moving(down));
    let mut simulation = Simulation::new(setup)?;
    let dt = simulation.step_length().seconds;
    let steps = ((LOOK.0 / (SPEED * dt)).round() as u64).max(1);
    let mut began: Option<f64> = None;
    let mut last = [0.0; LOOK.1];
    for look in 0_usize.. {
        simulation.run_quietly(steps, NonZeroUsize::MIN)?;
        last[look % LOOK.1] = simulation.wall_loads()[plate].force[2] / area;
        let stress = last.iter().sum::<f64>() / LOOK.1 as f64;
        let lowered = SPEED * dt * simulation.step() as f64;
        match began {
            None if stress >= PRESSED[0].si() => began = Some(lowered),
            Some(from) if stress >= PRESSED[1].si() => return Ok(Some((lowered - from) / (top + CLEAR - from))),
            _ if lowered > MOST * top => break,
            _ => {}
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Sphere;
    use crate::packing::settle::SettleSpec;
    use crate::packing::{ClassReading, Grading};
    use crate::units::Metres;

    /// One sphere between floor and plate, which is two contacts with a plane in a row: each yields
    /// `(3 F / (4 E* √R))^(2/3)` (Hertz), with `E* = E / (2 (1 - ν²))` for two bodies of one stuff.
    /// 1 %: the plate moves, so that the sphere is pushed by a little more than its weight, and looks are 2 µm apart.
    #[test]
    fn one_sphere_settles_by_the_law_of_hertz() {
        let how = SettleSpec { young: Pascals(1e8), ..SettleSpec::default() };
        let side = Metres(0.052);
        let input = SettleInput {
            size: [side, side, Metres(0.1)],
            periodic: [false; 2],
            grading: Grading::benedetto2018().unwrap(),
            class_reading: ClassReading::default(),
            how,
        };
        let radius = 0.025;
        let sphere = Sphere { centre: [0.026, 0.026, radius], radius };
        let bed = SphereBed::new("file", None, input.size, vec![sphere]);
        let found = settlement(&input, &bed).unwrap().unwrap();
        let stiffness = 1e8 / (2.0 * (1.0 - how.poisson.powi(2)));
        let yields = |stress: Pascals| {
            let force = stress.si() * side.si().powi(2);
            2.0 * (0.75 * force / (stiffness * f64::sqrt(radius))).powf(2.0 / 3.0)
        };
        let exact = (yields(PRESSED[1]) - yields(PRESSED[0])) / (2.0 * radius - yields(PRESSED[0]));
        assert!((found / exact - 1.0).abs() < 0.01, "{found} {exact}");
    }
}
