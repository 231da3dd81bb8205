//! The grains in the order of their places, so that neighbours in space are near in memory.

use super::setup::Grain;
use super::stuff::Stuff;
use super::vector::Four;
use crate::geometry::Sphere;

/// Structure of arrays; index `i` is not the grain's number but its turn.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Grains {
    /// The number of the grain in the set-up.
    pub id: Vec<u32>,
    /// Centre and radius, m.
    pub place: Vec<Four>,
    /// Velocity, m/s, and mass, kg.
    pub velocity: Vec<Four>,
    /// Angular velocity, rad/s, and rolling friction times radius, m.
    pub spin: Vec<Four>,
    /// Index of the material.
    pub material: Vec<u16>,
}

impl Grains {
    /// Takes checked grains in the order given.
    pub fn new(grains: &[Grain], stuffs: &[Stuff]) -> Self {
        let mut made = Self::default();
        made.append(grains, stuffs, 0);
        made
    }

    /// Takes further checked grains, numbered from `first`, behind the others.
    pub fn append(&mut self, grains: &[Grain], stuffs: &[Stuff], first: usize) {
        for (id, grain) in grains.iter().enumerate() {
            let stuff = &stuffs[grain.material];
            let radius = grain.sphere.radius;
            self.id.push((first + id) as u32);
            self.place.push(Four::new(grain.sphere.centre, radius));
            self.velocity.push(Four::new(grain.velocity, stuff.density * grain.sphere.volume()));
            self.spin.push(Four::new(grain.spin, stuff.rolling_friction * radius));
            self.material.push(grain.material as u16);
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.id.len()
    }

    /// The grain at a turn.
    pub fn grain(&self, i: usize) -> Grain {
        Grain {
            sphere: Sphere { centre: self.place[i].xyz(), radius: self.place[i].w() },
            velocity: self.velocity[i].xyz(),
            spin: self.spin[i].xyz(),
            material: self.material[i] as usize,
        }
    }

    /// Puts the grains into a new order; those that the order leaves out are dropped.
    pub fn reorder(&mut self, order: &[u32]) {
        fn pick<T: Copy>(of: &mut Vec<T>, order: &[u32]) {
            *of = order.iter().map(|&i| of[i as usize]).collect();
        }
        pick(&mut self.id, order);
        pick(&mut self.place, order);
        pick(&mut self.velocity, order);
        pick(&mut self.spin, order);
        pick(&mut self.material, order);
    }
}
