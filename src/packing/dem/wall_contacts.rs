//! The list of grains near walls, with what each contact remembers and does.

use super::bodies::Body;
use super::grains::Grains;
use super::mesh_grid::MeshGrid;
use super::setup::WallShape;
use super::vector::{Four, dot, sub};

/// The most places at which a grain may touch one wall; the shallowest give way.
pub const MOST_TOUCHES: usize = 6;
/// The mark of a slot without a contact.
pub const NO_FEATURE: u64 = u64::MAX;

/// One place where a grain touches a wall: what it remembers and did in the last step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slot {
    /// What of the wall is touched.
    pub feature: u64,
    /// The triangle that is touched.
    pub triangle: u32,
    /// Elastic tangential force on the grain, N, and overlap, m.
    pub history: Four,
    /// Elastic rolling torque on the grain, N m.
    pub rolling: [f64; 3],
    /// Normal from the wall to the grain.
    pub normal: [f64; 3],
    /// Force on the grain, N.
    pub force: [f64; 3],
    /// Where, m.
    pub point: [f64; 3],
}

impl Slot {
    /// Whether there is no contact in it.
    pub fn is_empty(&self) -> bool {
        self.feature == NO_FEATURE
    }
}

impl Default for Slot {
    fn default() -> Self {
        Self {
            feature: NO_FEATURE,
            triangle: 0,
            history: Four::default(),
            rolling: [0.0; 3],
            normal: [0.0; 3],
            force: [0.0; 3],
            point: [0.0; 3],
        }
    }
}

/// Grains near walls, those of one grain side by side.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct WallContacts {
    /// The candidates of grain `i` are `starts[i]..starts[i + 1]`.
    pub starts: Vec<u32>,
    /// The grain of each candidate.
    pub grain: Vec<u32>,
    /// The wall of each candidate.
    pub wall: Vec<u32>,
    /// The triangles of candidate `c` are `triangle_starts[c]..triangle_starts[c + 1]`.
    pub triangle_starts: Vec<u32>,
    /// See `triangle_starts`.
    pub triangles: Vec<u32>,
    /// The slots of candidate `c` are `slot_starts[c]..slot_starts[c + 1]`; those that touch come first.
    pub slot_starts: Vec<u32>,
    /// See `slot_starts`.
    pub slots: Vec<Slot>,
    /// Force of each candidate on its grain, N, and bound of the rolling friction, N m.
    pub force: Vec<Four>,
    /// Torque of each candidate on its grain, N m, and power of the wall on the grain, W.
    pub torque: Vec<Four>,
    /// Candidates at each wall that may move.
    pub of_moving: Vec<(u32, Vec<u32>)>,
}

impl WallContacts {
    /// Lists what is nearer than `skin`; each mesh has its grid, whose reach must be that of the largest grain and the skin.
    pub fn new(places: &[Four], bodies: &[Body], grids: &[MeshGrid], skin: f64) -> Self {
        let mut made = Self { starts: vec![0], triangle_starts: vec![0], slot_starts: vec![0], ..Self::default() };
        for (i, place) in places.iter().enumerate() {
            for (wall, body) in bodies.iter().enumerate() {
                if !body.present {
                    continue;
                }
                let slots = match &body.wall.shape {
                    WallShape::Plane { point, .. } => {
                        let height = dot(sub(place.xyz(), body.to_space(*point)), body.normal);
                        usize::from(height < place.w() + skin)
                    }
                    WallShape::Mesh(mesh) => {
                        let (at, reach) = (body.to_body(place.xyz()), place.w() + skin);
                        let before = made.triangles.len();
                        let near = grids[wall].near(at).iter().filter(|&&t| mesh.distance_to(t, at) < reach);
                        made.triangles.extend(near);
                        if made.triangles.len() > before { MOST_TOUCHES } else { 0 }
                    }
                };
                if slots > 0 {
                    made.grain.push(i as u32);
                    made.wall.push(wall as u32);
                    made.triangle_starts.push(made.triangles.len() as u32);
                    made.slots.resize(made.slots.len() + slots, Slot::default());
                    made.slot_starts.push(made.slots.len() as u32);
                }
            }
            made.starts.push(made.grain.len() as u32);
        }
        made.finish(bodies);
        made
    }

    /// Fills what follows from the candidates.
    pub fn finish(&mut self, bodies: &[Body]) {
        self.force = vec![Four::default(); self.grain.len()];
        self.torque = self.force.clone();
        self.finish_moving(bodies);
    }

    /// Lists the candidates at walls that may move.
    pub fn finish_moving(&mut self, bodies: &[Body]) {
        let moving = bodies.iter().enumerate().filter(|(_, body)| body.moves());
        self.of_moving = moving
            .map(|(wall, _)| {
                let at_wall = (0..self.wall.len()).filter(|&c| self.wall[c] as usize == wall);
                (wall as u32, at_wall.map(|c| c as u32).collect())
            })
            .collect();
    }

    /// The slots of a candidate.
    pub fn slots_of(&self, candidate: usize) -> std::ops::Range<usize> {
        self.slot_starts[candidate] as usize..self.slot_starts[candidate + 1] as usize
    }

    /// The contacts: candidate and slot.
    pub fn touching(&self) -> impl Iterator<Item = (usize, &Slot)> {
        (0..self.grain.len()).flat_map(|c| {
            self.slots[self.slots_of(c)].iter().take_while(|slot| !slot.is_empty()).map(move |slot| (c, slot))
        })
    }

    /// How deep the grain of a candidate lies in its wall, m; negative where it does not touch.
    pub fn depth(&self, candidate: usize, bodies: &[Body], place: Four) -> f64 {
        let body = &bodies[self.wall[candidate] as usize];
        match &body.wall.shape {
            WallShape::Plane { point, .. } => place.w() - dot(sub(place.xyz(), body.to_space(*point)), body.normal),
            WallShape::Mesh(mesh) => {
                let triangles = self.triangle_starts[candidate] as usize..self.triangle_starts[candidate + 1] as usize;
                let at = body.to_body(place.xyz());
                let distances = self.triangles[triangles].iter().map(|&triangle| mesh.distance_to(triangle, at));
                place.w() - distances.fold(f64::INFINITY, f64::min)
            }
        }
    }

    /// What the contacts remember, by number of the grain and wall.
    pub fn memory(&self, grains: &Grains) -> Vec<([u32; 2], Slot)> {
        let mut kept: Vec<_> =
            self.touching().map(|(c, slot)| ([grains.id[self.grain[c] as usize], self.wall[c]], *slot)).collect();
        // Stable: the order of the slots of a candidate stays.
        kept.sort_by_key(|kept| kept.0);
        kept
    }

    /// Takes over what contacts remember.
    pub fn remember(&mut self, grains: &Grains, memory: &[([u32; 2], Slot)]) {
        for c in 0..self.grain.len() {
            let key = [grains.id[self.grain[c] as usize], self.wall[c]];
            let first = memory.partition_point(|kept| kept.0 < key);
            let kept = memory[first..].iter().take_while(|kept| kept.0 == key);
            let slots = self.slots_of(c);
            for (slot, (_, kept)) in self.slots[slots].iter_mut().zip(kept) {
                *slot = *kept;
            }
        }
    }
}
