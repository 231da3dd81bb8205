//! One stage of settling: until the stones are at rest.

use std::num::NonZeroUsize;
use std::time::Instant;

use crate::geometry::Sphere;
use crate::packing::dem::{Grain, Setup, Simulation, Stuff, TimeStep, Wall};
use crate::packing::spheres::SphereContact;
use crate::units::Seconds;

use super::error::SettleError;
use super::keep::Place;
use super::spec::{SettleInput, Settling, Stage};

/// The first stage is over when its energy ratio is below so many times what is asked for: what is left of the motion stops when
/// friction is switched on. 1,200 stones of the tank's ballast (`column` 0.25, 1 GPa) reach that after 2.3 s, and the last
/// ratio after 3.9 s, with the same solid share to 0.0001.
const EARLY: f64 = 100.0;
/// Simulated time between two looks at the energy, s.
const LOOK: f64 = 0.01;

/// Name of the first stage.
pub(super) const FALL: &str = "fall, without friction";
/// Name of the first stage where stones rub on each other in it.
pub(super) const FALL_RUBBING: &str = "fall, with friction";
/// Name of the second stage.
pub(super) const REST: &str = "rest, with friction";

/// The end of a stage.
pub(super) struct Ended {
    pub(super) spheres: Vec<Sphere>,
    pub(super) contacts: Vec<SphereContact>,
    pub(super) lost: usize,
    pub(super) time_step: Seconds,
    pub(super) stage: Stage,
}

/// Stones at rest where they are, in their box, after one step: stones that lie pressed on each other hold energy that the
/// watchdog knows after a step only, and a switch makes it begin anew.
pub(super) fn begin(
    input: &SettleInput,
    spheres: Vec<Sphere>,
    friction: bool,
    threads: NonZeroUsize,
) -> Result<Simulation, SettleError> {
    let mut simulation = Simulation::new(box_of_stones(input, spheres, friction))?;
    simulation.run_quietly(1, threads)?;
    simulation.set_friction(friction);
    Ok(simulation)
}

/// Lets the stones of a bed come to rest.
pub(super) fn run(place: &Place<'_>, name: &'static str, simulation: &mut Simulation) -> Result<Ended, SettleError> {
    Run { place, name, clock: Instant::now() }.to_rest(simulation)
}

/// One stage on its way.
struct Run<'a> {
    place: &'a Place<'a>,
    name: &'static str,
    clock: Instant,
}

impl Run<'_> {
    fn to_rest(&self, simulation: &mut Simulation) -> Result<Ended, SettleError> {
        let (input, how, stones) = (self.place.input, &self.place.input.how, simulation.count());
        let grains = simulation.grains();
        // What lifts every stone by the mean diameter, J.
        let mass: f64 = grains.iter().map(|grain| grain.sphere.volume() * how.density.si()).sum();
        let mean = grains.iter().map(|grain| 2.0 * grain.sphere.radius).sum::<f64>() / stones.max(1) as f64;
        let lift = mass * 9.81 * mean;
        let dt = simulation.step_length().seconds;
        let most = (how.longest.si() / dt).ceil() as u64;
        let chunk = ((LOOK / dt).round() as u64).max(1);
        // Nothing is at rest before a stone could have fallen from the column's top.
        let volume: f64 = grains.iter().map(|grain| grain.sphere.volume()).sum();
        let column = volume / (input.size[0].si() * input.size[1].si() * how.column.si());
        let earliest = if self.name != REST { ((2.0 * column / 9.81).sqrt() / dt) as u64 } else { 0 };
        let (mut energy_ratio, mut unbalanced_ratio, mut at_rest) = (f64::INFINITY, 1.0, false);
        while simulation.step() < most && !at_rest {
            let of_longest = simulation.step() as f64 / most as f64;
            let now = Settling { stage: self.name, of_longest, energy_ratio, unbalanced_ratio };
            if (self.place.on_progress)(now).is_break() {
                self.place.write(simulation)?;
                return Err(SettleError::Stopped);
            }
            simulation.run_quietly(chunk.min(most - simulation.step()), self.place.threads)?;
            energy_ratio = simulation.kinetic_energy() / lift;
            unbalanced_ratio = simulation.unbalanced_force_ratio();
            let wanted = how.energy_ratio * if self.name == REST { 1.0 } else { EARLY };
            let low = energy_ratio < wanted && unbalanced_ratio < how.unbalanced_ratio;
            at_rest = simulation.step() > earliest && low;
        }
        Ok(self.ended(simulation, (energy_ratio, unbalanced_ratio, at_rest)))
    }

    fn ended(&self, simulation: &Simulation, (energy_ratio, unbalanced_ratio, at_rest): (f64, f64, bool)) -> Ended {
        let (input, stones, dt) = (self.place.input, simulation.count(), simulation.step_length().seconds);
        let lost: Vec<usize> = (0..stones).filter(|number| simulation.grain(*number).is_none()).collect();
        let mut place = vec![u32::MAX; stones];
        let mut left = Vec::with_capacity(stones);
        for (number, place) in place.iter_mut().enumerate() {
            if let Some(grain) = simulation.grain(number) {
                *place = left.len() as u32;
                left.push(within_period(grain.sphere, input));
            }
        }
        let contacts = simulation
            .contacts()
            .iter()
            .map(|contact| SphereContact {
                first: place[contact.grains[0]],
                second: place[contact.grains[1]],
                normal_force: contact.normal_force,
            })
            .collect();
        Ended {
            spheres: left,
            contacts,
            lost: lost.len(),
            time_step: Seconds(dt),
            stage: Stage {
                name: self.name.into(),
                stones,
                steps: simulation.step(),
                simulated_seconds: simulation.step() as f64 * dt,
                wall_seconds: self.clock.elapsed().as_secs_f64(),
                energy_ratio,
                unbalanced_ratio,
                at_rest,
            },
        }
    }
}

/// The sphere with its centre in the box along the directions in which the bed repeats itself.
fn within_period(sphere: Sphere, input: &SettleInput) -> Sphere {
    let mut centre = sphere.centre;
    for ((at, size), periodic) in centre.iter_mut().zip(input.size).zip(input.periodic) {
        if periodic {
            *at = at.rem_euclid(size.si());
        }
    }
    Sphere { centre, ..sphere }
}

/// Floor, walls where the bed does not repeat itself, and the stones at rest, with friction or without.
pub fn box_of_stones(input: &SettleInput, spheres: Vec<Sphere>, friction: bool) -> Setup {
    let how = &input.how;
    let stuff = Stuff {
        density: how.density.si(),
        young: how.young.si(),
        poisson: how.poisson,
        restitution: how.restitution,
        friction: how.friction,
        rolling_friction: how.rolling_friction,
    };
    let mut setup = Setup::new(stuff, spheres.into_iter().map(Grain::at_rest).collect());
    setup.friction = friction;
    setup.time_step = TimeStep::ShareOfRayleigh(how.time_step.si());
    // Soft stones that have settled lie deeper in each other than strangers may at the start.
    setup.limits.initial_overlap = setup.limits.overlap;
    setup.walls.push(Wall::plane([0.0; 3], [0.0, 0.0, 1.0], 0));
    for axis in 0..2 {
        let far = input.size[axis].si();
        if input.periodic[axis] {
            setup.periodic[axis] = Some([0.0, far]);
            continue;
        }
        for (at, inwards) in [(0.0, 1.0), (far, -1.0)] {
            let (mut point, mut normal) = ([0.0; 3], [0.0; 3]);
            (point[axis], normal[axis]) = (at, inwards);
            setup.walls.push(Wall::plane(point, normal, 0));
        }
    }
    setup
}
