//! What a simulation has come to.

use super::bodies::BodyState;
use super::cells::Period;
use super::law::Rolling;
use super::rebuild::Lost;
use super::setup::{Grain, Wall, WallShape};
use super::simulation::Simulation;
use super::stuff::Stuff;
use super::time_step::StepLength;
use super::vector::{add, cross, dot, norm, scale, sub};
use crate::units::{Metres, Seconds};

/// Two grains that touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Their numbers; the normal points from the second to the first.
    pub grains: [usize; 2],
    /// Unit vector from the second to the first.
    pub normal: [f64; 3],
    /// Force on the first grain in the last step, N.
    pub force: [f64; 3],
    /// Its part along the normal, N; never negative.
    pub normal_force: f64,
    /// Overlap.
    pub overlap: Metres,
    /// Midst of the overlap, m.
    pub point: [f64; 3],
}

/// A grain that touches a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallContact {
    /// Number of the grain.
    pub grain: usize,
    /// Index of the wall.
    pub wall: usize,
    /// The triangle of a mesh; 0 of a plane.
    pub triangle: usize,
    /// Unit vector from the wall to the grain.
    pub normal: [f64; 3],
    /// Force on the grain in the last step, N.
    pub force: [f64; 3],
    /// Overlap.
    pub overlap: Metres,
    /// Where on the wall, m.
    pub point: [f64; 3],
}

/// What the grains did to a wall in the last step.
#[derive(Debug, Clone, PartialEq)]
pub struct WallLoad {
    /// Force on the wall, N.
    pub force: [f64; 3],
    /// Torque on the wall about the origin, N m.
    pub torque: [f64; 3],
    /// Force on each patch, N: as many as the mesh has, one for a plane.
    pub patches: Vec<[f64; 3]>,
    /// How many places touch.
    pub contacts: usize,
}

impl Simulation {
    /// The time since the start.
    pub fn time(&self) -> Seconds {
        Seconds(self.step as f64 * self.length.seconds + self.watch.time_offset)
    }

    /// Steps made.
    pub fn step(&self) -> u64 {
        self.step
    }

    /// The time step and what it is measured by.
    pub fn step_length(&self) -> StepLength {
        self.length
    }

    /// The materials.
    pub fn stuffs(&self) -> &[Stuff] {
        &self.stuffs
    }

    /// Whether friction is computed: switched on, and above zero somewhere.
    pub fn has_friction(&self) -> bool {
        self.effective_friction()
    }

    /// How rolling is resisted; `None` where no coefficient is above zero.
    pub fn rolling(&self) -> Rolling {
        self.effective_rolling()
    }

    /// How many grains there were at the start.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The grains by number; those that are lost as they were when this was noticed, so that numbers stay.
    pub fn grains(&self) -> Vec<Grain> {
        let mut all = vec![None; self.count];
        for i in 0..self.grains.len() {
            all[self.grains.id[i] as usize] = Some(self.grains.grain(i));
        }
        for lost in &self.lost {
            all[lost.grain] = Some(lost.grain_then);
        }
        all.into_iter().flatten().collect()
    }

    /// One grain; none when it is lost or there never was one.
    pub fn grain(&self, number: usize) -> Option<Grain> {
        self.turn_of(number).map(|i| self.grains.grain(i))
    }

    /// Grains that have left the domain, in the order in which this was noticed.
    pub fn lost(&self) -> &[Lost] {
        &self.lost
    }

    /// Torque of the rolling friction of the bounded model on a grain in the last step, N m; none unless
    /// [`keep_rolling_torque`](Simulation::keep_rolling_torque) was asked for.
    pub fn rolling_torque(&self, number: usize) -> Option<[f64; 3]> {
        let i = self.turn_of(number)?;
        self.rolling_torque.get(i).map(|four| four.xyz())
    }

    /// Pairs of grains that touched in the last step, ordered by number.
    pub fn contacts(&self) -> Vec<Contact> {
        let period = Period::new(self.periodic);
        let mut all: Vec<Contact> = self
            .pairs
            .touching()
            .map(|(i, pair)| {
                let j = self.pairs.partner[pair] as usize;
                let (here, there) = (self.grains.place[i], self.grains.place[j]);
                let apart = period.nearest(sub(here.xyz(), there.xyz()));
                let distance = norm(apart);
                let normal = scale(1.0 / distance, apart);
                let overlap = here.w() + there.w() - distance;
                let force = self.pairs.force[pair].xyz();
                let (a, b) = (self.grains.id[i] as usize, self.grains.id[j] as usize);
                let sign = if a < b { 1.0 } else { -1.0 };
                Contact {
                    grains: [a.min(b), a.max(b)],
                    normal: scale(sign, normal),
                    force: scale(sign, force),
                    normal_force: dot(force, normal).max(0.0),
                    overlap: Metres(overlap),
                    point: sub(here.xyz(), scale(here.w() - 0.5 * overlap, normal)),
                }
            })
            .collect();
        all.sort_unstable_by_key(|contact| contact.grains);
        all
    }

    /// Grains that touched walls in the last step.
    pub fn wall_contacts(&self) -> Vec<WallContact> {
        let mut all: Vec<WallContact> = self
            .walls
            .touching()
            .map(|(c, slot)| WallContact {
                grain: self.grains.id[self.walls.grain[c] as usize] as usize,
                wall: self.walls.wall[c] as usize,
                triangle: slot.triangle as usize,
                normal: slot.normal,
                force: slot.force,
                overlap: Metres(slot.history.w()),
                point: slot.point,
            })
            .collect();
        all.sort_by_key(|contact| (contact.wall, contact.grain));
        all
    }

    /// Forces and torques of the grains on each wall in the last step.
    pub fn wall_loads(&self) -> Vec<WallLoad> {
        let empty = |body: &super::bodies::Body| WallLoad {
            force: [0.0; 3],
            torque: [0.0; 3],
            patches: match &body.wall.shape {
                WallShape::Plane { .. } => vec![[0.0; 3]],
                WallShape::Mesh(mesh) => vec![[0.0; 3]; mesh.patches().len()],
            },
            contacts: 0,
        };
        let mut loads: Vec<WallLoad> = self.bodies.iter().map(empty).collect();
        for contact in self.wall_contacts() {
            let load = &mut loads[contact.wall];
            let force = scale(-1.0, contact.force);
            load.force = add(load.force, force);
            load.torque = add(load.torque, cross(contact.point, force));
            let patch = match &self.bodies[contact.wall].wall.shape {
                WallShape::Plane { .. } => 0,
                WallShape::Mesh(mesh) => mesh.patch_index(contact.triangle),
            };
            load.patches[patch] = add(load.patches[patch], force);
            load.contacts += 1;
        }
        loads
    }

    /// A wall as it was set up, with its motion of now.
    pub fn wall(&self, wall: usize) -> Option<&Wall> {
        self.bodies.get(wall).map(|body| &body.wall)
    }

    /// Where a wall is now.
    pub fn wall_state(&self, wall: usize) -> Option<BodyState> {
        self.bodies.get(wall).map(|body| body.state)
    }

    /// Where a point of a wall of the set-up is now, m.
    pub fn wall_point(&self, wall: usize, point: [f64; 3]) -> Option<[f64; 3]> {
        self.bodies.get(wall).map(|body| body.to_space(point))
    }

    /// Kinetic energy of the grains, of motion and spin, J.
    pub fn kinetic_energy(&self) -> f64 {
        (0..self.grains.len())
            .map(|i| {
                let (v, w) = (self.grains.velocity[i], self.grains.spin[i].xyz());
                let radius = self.grains.place[i].w();
                0.5 * v.w() * (dot(v.xyz(), v.xyz()) + 0.4 * radius * radius * dot(w, w))
            })
            .sum()
    }

    /// Energy of the grains in the field of gravity, zero at the origin, J.
    pub fn potential_energy(&self) -> f64 {
        (0..self.grains.len())
            .map(|i| -self.grains.velocity[i].w() * dot(self.gravity, self.grains.place[i].xyz()))
            .sum()
    }

    /// Elastic energy of the normal forces of Hertz, J: `8/15 E* √R* δ^2.5`.
    pub fn elastic_energy(&self) -> f64 {
        let period = Period::new(self.periodic);
        let hertz = |stiffness: f64, radius: f64, overlap: f64| {
            4.0 / 15.0 * stiffness * (radius * overlap.max(0.0)).sqrt() * overlap.max(0.0).powi(2)
        };
        // Also of contacts that no step has seen yet.
        let of_pair = |i: usize, pair: usize| {
            let j = self.pairs.partner[pair] as usize;
            let (here, there) = (self.grains.place[i], self.grains.place[j]);
            let overlap = here.w() + there.w() - norm(period.nearest(sub(here.xyz(), there.xyz())));
            let law = self.laws.of(self.grains.material[i], self.grains.material[j]);
            hertz(law.normal_stiffness, here.w() * there.w() / (here.w() + there.w()), overlap)
        };
        let of_wall = |c: usize| {
            let i = self.walls.grain[c] as usize;
            let material = self.bodies[self.walls.wall[c] as usize].wall.material as u16;
            let law = self.laws.of(self.grains.material[i], material);
            let radius = self.grains.place[i].w();
            let slots = &self.walls.slots[self.walls.slots_of(c)];
            if slots[0].is_empty() {
                return hertz(law.normal_stiffness, radius, self.walls.depth(c, &self.bodies, self.grains.place[i]));
            }
            let live = slots.iter().filter(|slot| !slot.is_empty());
            live.map(|slot| hertz(law.normal_stiffness, radius, slot.history.w())).sum()
        };
        let of_grain = |i: usize| {
            let pairs = self.pairs.starts[i] as usize..self.pairs.starts[i + 1] as usize;
            pairs.map(|pair| of_pair(i, pair)).sum::<f64>()
        };
        (0..self.grains.len()).map(of_grain).sum::<f64>() + (0..self.walls.grain.len()).map(of_wall).sum::<f64>()
    }

    /// How many places touch per grain: pairs count for both their grains, walls for one.
    pub fn coordination_number(&self) -> f64 {
        let pairs = self.pairs.touching().count();
        if self.grains.len() == 0 {
            return 0.0;
        }
        (2 * pairs + self.walls.touching().count()) as f64 / self.grains.len() as f64
    }

    /// Mean of the force that is left over on each grain (gravity included), over the mean of the contact forces; in the
    /// last step. One where nothing touches.
    pub fn unbalanced_force_ratio(&self) -> f64 {
        let mut forces: Vec<[f64; 3]> =
            self.grains.velocity.iter().map(|velocity| scale(velocity.w(), self.gravity)).collect();
        let (mut sum, mut count) = (0.0, 0_usize);
        for (i, pair) in self.pairs.touching() {
            let force = self.pairs.force[pair].xyz();
            let j = self.pairs.partner[pair] as usize;
            forces[i] = add(forces[i], force);
            forces[j] = sub(forces[j], force);
            sum += norm(force);
            count += 1;
        }
        for (c, slot) in self.walls.touching() {
            let i = self.walls.grain[c] as usize;
            forces[i] = add(forces[i], slot.force);
            sum += norm(slot.force);
            count += 1;
        }
        if sum == 0.0 {
            return 1.0;
        }
        let left_over = forces.iter().map(|force| norm(*force)).sum::<f64>() / forces.len() as f64;
        left_over / (sum / count as f64)
    }
}
