//! The list of neighbours: when it is made again, and how contacts keep their memory.

use super::DemError;
use super::bodies::Body;
use super::cells::{Cells, Period};
use super::mesh_grid::MeshGrid;
use super::pairs::Pairs;
use super::setup::{Grain, WallShape};
use super::simulation::{ListState, Simulation};
use super::vector::{Four, dot, norm, sub};
use super::wall_contacts::WallContacts;
use crate::units::Metres;

/// The first skin over the smallest radius.
const FIRST_SKIN: f64 = 0.08;
/// Least and greatest skin over the smallest radius.
const SKINS: [f64; 2] = [0.01, 1.0];
/// A list that lasts fewer steps gets a wider skin, one that lasts more a narrower one. Making a list costs about as much as
/// five steps of a settled bed.
const LASTING: [u64; 2] = [150, 2000];

/// A grain that has left the domain.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Lost {
    /// Its number.
    pub grain: usize,
    /// Step at which this was noticed.
    pub step: u64,
    /// What it was like then.
    pub grain_then: Grain,
}

impl Simulation {
    /// Makes the first list.
    pub(super) fn first_list(&mut self) {
        self.list.skin = self.fitting_skin(FIRST_SKIN * self.radii[0]);
        self.make_list();
    }

    /// Makes the list when grains have come in, whose sizes the skin has to fit.
    pub(super) fn renew_list_for_all(&mut self) {
        self.list.skin = self.fitting_skin(self.list.skin);
        self.make_list();
    }

    fn fitting_skin(&self, skin: f64) -> f64 {
        let [least, greatest] = self.radii;
        if !least.is_finite() {
            return 1.0;
        }
        let skin = skin.clamp(SKINS[0] * least, SKINS[1] * least);
        // In a periodic box a pair must meet by one image only; the check of the box leaves room for a quarter diameter.
        if self.periodic == [None, None] { skin } else { skin.min(0.2 * greatest) }
    }

    /// Makes the list again if a contact could be missing from it; else notes how far the grains have really travelled.
    pub(super) fn renew_list_if_old(&mut self) {
        let travelled = |(now, then): (&Four, &Four)| {
            let d = sub(now.xyz(), then.xyz());
            dot(d, d)
        };
        let furthest = self.grains.place.iter().zip(&self.list.place).map(travelled).fold(0.0, f64::max).sqrt();
        // A hair more, for what is lost in rounding.
        self.list.travel = furthest * (1.0 + 1e-12);
        let soon = 0.98 * self.list.skin;
        if 2.0 * self.list.travel < soon && self.list.travel + self.list.body_travel < soon {
            return;
        }
        let lasted = self.step - self.list.made_at;
        let factor = if lasted < LASTING[0] {
            1.5
        } else if lasted > LASTING[1] {
            0.7
        } else {
            1.0
        };
        self.list.skin = self.fitting_skin(self.list.skin * factor);
        self.make_list();
    }

    /// Makes the list; contacts keep what they remember.
    pub(super) fn make_list(&mut self) {
        let pair_memory = self.pairs.memory(&self.grains);
        let wall_memory = self.walls.memory(&self.grains);
        let staying = self.wrap_and_drop();
        if staying.len() < self.grains.len() {
            self.grains.reorder(&staying);
            self.begin_watch_without_forces();
        }
        let skin = self.list.skin;
        let reach = 2.0 * self.grains.place.iter().map(|place| place.w()).fold(0.0, f64::max) + skin;
        let mut cells = Cells::new(&self.grains.place, reach, self.periodic);
        let order = cells.sort(&self.grains.place);
        self.grains.reorder(&order);
        self.note_turns();
        let (starts, partners) = cells.pairs(&self.grains.place, skin, &Period::new(self.periodic));
        self.pairs = Pairs::new(starts, partners, self.needs());
        self.pairs.remember(&self.grains, &pair_memory);
        self.fit_mesh_grids(0.5 * (reach - skin) + skin);
        self.walls = WallContacts::new(&self.grains.place, &self.bodies, &self.mesh_grids, skin);
        self.walls.remember(&self.grains, &wall_memory);
        self.list =
            ListState { skin, made_at: self.step, travel: 0.0, body_travel: 0.0, place: self.grains.place.clone() };
    }

    /// Notes which turn each grain has.
    pub(super) fn note_turns(&mut self) {
        self.turns.clear();
        self.turns.resize(self.count, u32::MAX);
        for (turn, &id) in self.grains.id.iter().enumerate() {
            self.turns[id as usize] = turn as u32;
        }
    }

    /// Makes the grids over the meshes, if there are none for this reach.
    pub(super) fn fit_mesh_grids(&mut self, reach: f64) {
        if self.mesh_grids.len() == self.bodies.len() && self.mesh_reach >= reach {
            return;
        }
        // Room for skins to come.
        self.mesh_reach = 1.3 * reach;
        let grid = |body: &Body| match &body.wall.shape {
            WallShape::Mesh(mesh) => MeshGrid::new(mesh, self.mesh_reach),
            WallShape::Plane { .. } => MeshGrid::default(),
        };
        self.mesh_grids = self.bodies.iter().map(grid).collect();
    }

    /// Shifts grains into the periodic box and gives those that are still in the domain, by their turn.
    fn wrap_and_drop(&mut self) -> Vec<u32> {
        let period = Period::new(self.periodic);
        let [lower, upper] = self.domain;
        let mut staying = Vec::with_capacity(self.grains.len());
        for i in 0..self.grains.len() {
            if period.any() {
                let shift = period.shift_into_box(self.grains.place[i].xyz());
                for (k, shift) in shift.into_iter().enumerate() {
                    self.grains.place[i].0[k] += shift;
                    // Gravity along a period has no potential: what the shift takes, the work gives.
                    self.watch.work -= self.grains.velocity[i].w() * self.gravity[k] * shift;
                }
            }
            let place = self.grains.place[i].xyz();
            if (0..3).all(|k| place[k] >= lower[k] && place[k] <= upper[k]) {
                staying.push(i as u32);
            } else {
                let (grain, grain_then) = (self.grains.id[i] as usize, self.grains.grain(i));
                self.lost.push(Lost { grain, step: self.step, grain_then });
            }
        }
        staying
    }

    /// Refuses a start with overlaps that would shoot grains apart; of grains with numbers from `first` on.
    pub(super) fn check_overlaps(&self, first: usize) -> Result<(), DemError> {
        let limit = self.limits.initial_overlap;
        let is_new = |i: usize| self.grains.id[i] as usize >= first;
        let period = Period::new(self.periodic);
        for i in 0..self.grains.len() {
            let here = self.grains.place[i];
            for pair in self.pairs.starts[i] as usize..self.pairs.starts[i + 1] as usize {
                let j = self.pairs.partner[pair] as usize;
                if !is_new(i) && !is_new(j) {
                    continue;
                }
                let there = self.grains.place[j];
                let overlap = here.w() + there.w() - norm(period.nearest(sub(here.xyz(), there.xyz())));
                let share = overlap / here.w().min(there.w());
                if share.is_nan() || share > limit {
                    let (a, b) = (self.grains.id[i] as usize, self.grains.id[j] as usize);
                    return Err(DemError::DeepOverlap {
                        first: a.min(b),
                        second: a.max(b),
                        overlap: Metres(overlap),
                        share: 100.0 * share,
                        limit: 100.0 * limit,
                    });
                }
            }
        }
        for c in 0..self.walls.grain.len() {
            let (i, wall) = (self.walls.grain[c] as usize, self.walls.wall[c] as usize);
            if !is_new(i) {
                continue;
            }
            let depth = self.walls.depth(c, &self.bodies, self.grains.place[i]);
            let share = depth / self.grains.place[i].w();
            if share.is_nan() || share > limit {
                return Err(DemError::DeepInWall {
                    grain: self.grains.id[i] as usize,
                    wall,
                    overlap: Metres(depth),
                    share: 100.0 * share,
                    limit: 100.0 * limit,
                });
            }
        }
        Ok(())
    }
}
