//! A ball against a wall: how long an impact lasts, how fast the ball leaves, how deep it lies at rest.

use std::num::NonZeroUsize;

use super::error::ExperimentError;
use crate::geometry::Sphere;
use crate::packing::dem::{Grain, Setup, Simulation, Stuff, TimeStep, Wall};
use crate::units::Metres;

/// What an impact comes to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// Time in contact, s.
    pub duration: f64,
    /// Speed after over speed before.
    pub restitution: f64,
}

/// `1/E*` is twice `(1 - nu²)/E`: ball and wall are of one material, Pa.
fn effective_young(stuff: &Stuff) -> f64 {
    stuff.young / (2.0 * (1.0 - stuff.poisson * stuff.poisson))
}

/// Duration of the elastic impact of a ball on a wall, closed form, s: `2.943 d/v` with the depth
/// `d = (15 m v²/(16 E* sqrt R))^(2/5)` (Hertz; the factor is `2 int_0^1 dx/sqrt(1 - x^2.5)`).
pub fn hertz_duration(stuff: &Stuff, radius: Metres, speed: f64) -> f64 {
    let mass = stuff.density * Sphere { centre: [0.0; 3], radius: radius.si() }.volume();
    let depth = (15.0 * mass * speed * speed / (16.0 * effective_young(stuff) * radius.si().sqrt())).powf(0.4);
    2.943_275_2 * depth / speed
}

/// Depth at which the weight of a ball on a floor is in balance, closed form, m: `(3/4 m g/(E* sqrt R))^(2/3)`.
pub fn hertz_depth(stuff: &Stuff, radius: Metres, gravity: f64) -> f64 {
    let mass = stuff.density * Sphere { centre: [0.0; 3], radius: radius.si() }.volume();
    (0.75 * mass * gravity / (effective_young(stuff) * radius.si().sqrt())).powf(2.0 / 3.0)
}

fn ball(
    stuff: Stuff,
    radius: Metres,
    centre: f64,
    speed: f64,
    gravity: f64,
    step: f64,
) -> Result<Simulation, ExperimentError> {
    let sphere = Sphere { centre: [0.0, 0.0, centre], radius: radius.si() };
    let grain = Grain { velocity: [0.0, 0.0, -speed], ..Grain::at_rest(sphere) };
    let mut setup = Setup::new(stuff, vec![grain]);
    setup.gravity = [0.0, 0.0, -gravity];
    setup.time_step = TimeStep::Seconds(step);
    setup.walls = vec![Wall::plane([0.0; 3], [0.0, 0.0, 1.0], 0)];
    Ok(Simulation::new(setup)?)
}

/// Throws a ball at a wall without gravity, `speed` in m/s, in a thousand steps for each elastic duration.
///
/// # Errors
/// When the simulation cannot be made or goes bad.
pub fn throw(stuff: Stuff, radius: Metres, speed: f64) -> Result<Impact, ExperimentError> {
    let step = 1e-3 * hertz_duration(&stuff, radius, speed);
    let mut simulation = ball(stuff, radius, radius.si() + 10.5 * speed * step, speed, 0.0, step)?;
    let mut touching = 0_u64;
    for _ in 0..20_000 {
        simulation.run_quietly(1, NonZeroUsize::MIN)?;
        let now = !simulation.wall_contacts().is_empty();
        if touching > 0 && !now {
            break;
        }
        touching += u64::from(now);
    }
    let after = simulation.grain(0).map_or(f64::NAN, |ball| ball.velocity[2]);
    Ok(Impact { duration: touching as f64 * step, restitution: after / speed })
}

/// Lets a ball settle on a floor from half as deep again, m.
///
/// # Errors
/// When the simulation cannot be made or goes bad.
pub fn settle_on_floor(stuff: Stuff, radius: Metres, gravity: f64) -> Result<f64, ExperimentError> {
    let depth = hertz_depth(&stuff, radius, gravity);
    let step = 1e-2 * hertz_duration(&stuff, radius, 0.1);
    let mut simulation = ball(stuff, radius, radius.si() - 1.5 * depth, 0.0, gravity, step)?;
    simulation.run_quietly(60_000, NonZeroUsize::MIN)?;
    Ok(simulation.grain(0).map_or(f64::NAN, |ball| radius.si() - ball.sphere.centre[2]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps are a thousandth of the duration: it is off by one at most, and 0.1 % by the scheme.
    #[test]
    fn impacts_are_those_of_hertz_and_of_the_restitution_asked_for() {
        let radius = Metres(0.025);
        let elastic = Stuff { restitution: 1.0, ..Stuff::BALLAST };
        let found = throw(elastic, radius, 1.0).unwrap();
        assert!((found.duration / hertz_duration(&elastic, radius, 1.0) - 1.0).abs() < 3e-3, "{found:?}");
        assert!((found.restitution - 1.0).abs() < 2e-3);
        // 2.87 (m²/(R E*² v))^(1/5), as the literature prints it.
        let (mass, young) =
            (2700.0 * Sphere { centre: [0.0; 3], radius: 0.025 }.volume(), 17.7e9 / (2.0 * (1.0 - 0.0324)));
        let printed = 2.87 * (mass * mass / (0.025 * young * young)).powf(0.2);
        assert!((hertz_duration(&elastic, radius, 1.0) / printed - 1.0).abs() < 1e-3);
        for restitution in [0.2, 0.4, 0.8] {
            let found = throw(Stuff { restitution, ..Stuff::BALLAST }, radius, 1.0).unwrap();
            assert!((found.restitution - restitution).abs() < 2e-3, "{restitution}: {found:?}");
        }
        let depth = settle_on_floor(Stuff::BALLAST, radius, 9.81).unwrap();
        assert!((depth / hertz_depth(&Stuff::BALLAST, radius, 9.81) - 1.0).abs() < 1e-6);
    }
}
