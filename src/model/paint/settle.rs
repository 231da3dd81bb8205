//! What lies on the edges and faces of a plane of nodes.

use super::chunk::Job;
use super::claims::{Claim, Claims, List, edge_flag, face_flag};
use super::layout::Layout;
use crate::model::palette::{FaceMaterial, MagneticAveraging, Palette};
use crate::model::{EdgeMaterial, Indices, Material, MaterialId};

/// A plane of cells that has been painted.
#[derive(Clone, Copy)]
pub struct Done<'a> {
    /// Material of each cell, row by row.
    pub solid: &'a [MaterialId],
    pub claims: &'a Claims,
    /// The one material of each row, where there is one.
    pub even: &'a [Option<MaterialId>],
}

/// Stands in a row for an edge that is claimed, until it is looked up.
const CLAIMED: u32 = u32::MAX;

/// What was settled in a chunk of planes. Indices point into the chunk's own lists of entries.
pub struct Settled {
    /// Distinct edge materials.
    pub palette: Vec<EdgeMaterial>,
    /// Edges along the axes of the layout.
    pub edges: [Indices; 3],
    /// How many of them hold the mean of two or more different materials.
    pub averaged: [usize; 3],
    /// Distinct face materials.
    pub face_palette: Vec<FaceMaterial>,
    /// Faces across the axes of the layout.
    pub faces: [Indices; 3],
}

/// Settles planes of nodes, one after the other.
pub struct Settler<'a> {
    layout: Layout,
    materials: &'a [Material],
    faces_wanted: bool,
    magnetic_averaging: MagneticAveraging,
    palette: Palette<'a>,
    known: Known,
    last_face: Option<([MaterialId; 2], u32)>,
    row: Vec<u32>,
    settled: Settled,
}

/// Entries of cells met lately around edges.
struct Known {
    keys: [u64; Self::SIZE],
    entries: [u32; Self::SIZE],
}

impl Known {
    const SIZE: usize = 256;

    fn new() -> Self {
        // No key of four materials: a model has fewer than 65 536.
        Self { keys: [u64::MAX; Self::SIZE], entries: [0; Self::SIZE] }
    }

    /// Where the entry of four cells stands if it is known.
    fn slot(key: u64) -> usize {
        (key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 56) as usize
    }
}

/// Two cells, one above the other, as one number.
#[inline(always)]
fn two(a: MaterialId, b: MaterialId) -> u64 {
    u64::from(a.0) << 16 | u64::from(b.0)
}

/// A row of cells beside an edge, and whether it lies there or stands in for one beyond the outer wall.
#[derive(Clone, Copy)]
struct Beside<'a> {
    solid: &'a [MaterialId],
    even: Option<MaterialId>,
    claims: &'a Claims,
    j: usize,
    real: bool,
}

impl<'a> Beside<'a> {
    fn new(done: Done<'a>, j: usize, real: bool, layout: &Layout) -> Self {
        let cells = layout.n[2];
        Self { solid: &done.solid[j * cells..][..cells], even: done.even[j], claims: done.claims, j, real }
    }

    /// Flags of the row's cells, where any is set.
    fn held(&self) -> Option<&'a [u32]> {
        if self.real { self.claims.in_row(self.j) } else { None }
    }
}

impl<'a> Settler<'a> {
    /// Nothing settled yet.
    pub fn new(job: &Job<'a>) -> Self {
        let Job { layout, materials, faces_wanted, magnetic_averaging, .. } = *job;
        let none = || std::array::from_fn(|_| Indices::with_capacity(0));
        let settled = Settled { palette: vec![], edges: none(), averaged: [0; 3], face_palette: vec![], faces: none() };
        let palette = Palette::new(materials);
        Self {
            layout,
            materials,
            faces_wanted,
            magnetic_averaging,
            palette,
            known: Known::new(),
            last_face: None,
            row: vec![],
            settled,
        }
    }

    /// What was settled.
    pub fn finish(self) -> Settled {
        Settled { palette: self.palette.into_entries(), ..self.settled }
    }

    /// Settles plane `i` of nodes, between two planes of cells; only one of them at the ends of the grid.
    pub fn plane(&mut self, i: usize, before: Option<Done<'_>>, after: Option<Done<'_>>) {
        let (Some(low), Some(high)) = (before.or(after), after.or(before)) else { return };
        let layout = self.layout;
        let [planes, rows, _] = layout.n;
        let is = |done: Option<Done<'_>>| done.is_some();
        for j in 0..=rows {
            let (below, above) = (j.saturating_sub(1), j.min(rows - 1));
            let beside = |done, j, real| Beside::new(done, j, real, &layout);
            if layout.wanted(0) {
                let row = [beside(high, below, j > 0), beside(high, above, j < rows)];
                self.pairs(0, row, [Some((&high.claims.x, j)), None], i < planes);
            }
        }
        for j in (0..=rows).filter(|&j| layout.wanted(1) && !(layout.flat && j == rows)) {
            let at = j.min(rows - 1);
            let row = [Beside::new(low, at, is(before), &layout), Beside::new(high, at, is(after), &layout)];
            let lists = [before.map(|b| (&b.claims.yz[0][1], at)), after.map(|a| (&a.claims.yz[0][0], at))];
            self.pairs(1, row, lists, j < rows);
        }
        for j in (0..=rows).filter(|_| layout.wanted(2)) {
            let (below, above) = (j.saturating_sub(1), j.min(rows - 1));
            let row = [(low, is(before)), (high, is(after))].map(|(done, real)| {
                [Beside::new(done, below, real && j > 0, &layout), Beside::new(done, above, real && j < rows, &layout)]
            });
            let lists = [before.map(|b| (&b.claims.yz[1][1], j)), after.map(|a| (&a.claims.yz[1][0], j))];
            self.fours(row, lists);
        }
        if self.faces_wanted {
            self.faces(before, after);
        }
    }

    /// Settles a row of edges across the rows, between two rows of cells: the first at the high side, the second at the low.
    fn pairs(&mut self, axis: usize, [a, b]: [Beside<'_>; 2], lists: [Option<(&List, usize)>; 2], in_grid: bool) {
        let cells = self.layout.n[2];
        let held = [a.held(), b.held()];
        let claims = held.iter().any(Option::is_some);
        if let Some(id) = a.even.filter(|_| !claims && a.even == b.even) {
            let entry = self.pure(axis, id);
            self.settled.edges[axis].push_run(entry, cells + 1);
            return;
        }
        let mut row = self.blank_row();
        let flags = [1, 0].map(|side| [1, 0].map(|end| edge_flag(axis, [side, end])));
        for (held, [high, low]) in held.into_iter().zip(flags) {
            for (k, held) in held.unwrap_or_default().iter().enumerate().filter(|(_, held)| **held != 0) {
                if held & low != 0 {
                    row[k] = CLAIMED;
                }
                if held & high != 0 {
                    row[k + 1] = CLAIMED;
                }
            }
        }
        let mut averaged = 0;
        let mut below = two(a.solid[0], b.solid[0]);
        for (k, ((out, a), b)) in row.iter_mut().zip(a.solid).zip(b.solid).enumerate() {
            let above = two(*a, *b);
            *out = self.edge(axis, *out, below << 32 | above, lists, k, &mut averaged);
            below = above;
        }
        row[cells] = self.edge(axis, row[cells], below << 32 | below, lists, cells, &mut averaged);
        self.settled.averaged[axis] += if in_grid { averaged } else { 0 };
        self.settled.edges[axis].extend(&row);
        self.row = row;
    }

    /// Settles a row of edges along the rows, between the rows of cells before and after it, below and above.
    fn fours(&mut self, [[a, b], [c, d]]: [[Beside<'_>; 2]; 2], lists: [Option<(&List, usize)>; 2]) {
        let cells = self.layout.n[2];
        let all = [a, b, c, d];
        let held = all.map(|beside| beside.held());
        let claims = held.iter().any(Option::is_some);
        if let Some(id) = a.even.filter(|_| !claims && all.iter().all(|beside| beside.even == a.even)) {
            let entry = self.pure(2, id);
            self.settled.edges[2].push_run(entry, cells + 1);
            return;
        }
        let mut row = self.blank_row();
        let flags = [[1, 1], [1, 0], [0, 1], [0, 0]].map(|high| edge_flag(2, high));
        for (held, flag) in held.into_iter().zip(flags) {
            let cells = held.unwrap_or_default().iter().zip(&mut row);
            cells.filter(|(held, _)| **held & flag != 0).for_each(|(_, out)| *out = CLAIMED);
        }
        let mut averaged = 0;
        let around = a.solid.iter().zip(b.solid).zip(c.solid).zip(d.solid);
        for (k, (out, (((a, b), c), d))) in row.iter_mut().zip(around).enumerate() {
            *out = self.edge(2, *out, two(*a, *b) << 32 | two(*c, *d), lists, k, &mut averaged);
        }
        row[cells] = row[cells - 1];
        self.settled.averaged[2] += averaged;
        self.settled.edges[2].extend(&row);
        self.row = row;
    }

    /// Room for the edges of a row, none of them claimed.
    fn blank_row(&mut self) -> Vec<u32> {
        let mut row = std::mem::take(&mut self.row);
        row.clear();
        row.resize(self.layout.n[2] + 1, 0);
        row
    }

    /// The entry of the edge at place `k` of a row: of its last claimant, or else of the four cells around it.
    #[inline(always)]
    fn edge(
        &mut self,
        axis: usize,
        mark: u32,
        key: u64,
        lists: [Option<(&List, usize)>; 2],
        k: usize,
        averaged: &mut usize,
    ) -> u32 {
        if mark == CLAIMED {
            let cells = self.layout.n[2];
            return self.pure(axis, latest(lists, cells, k).material);
        }
        self.entry(key, averaged)
    }

    /// The entry of an edge along an axis of the layout that is made of one material.
    fn pure(&mut self, axis: usize, id: MaterialId) -> u32 {
        let along = self.materials[id.index()].along(self.layout.axes()[axis], id);
        self.palette.pure(along)
    }

    /// The entry of an edge that nobody claims, from the four cells around it.
    #[inline(always)]
    fn entry(&mut self, key: u64, averaged: &mut usize) -> u32 {
        let even = key == (key & 0xffff) * 0x0001_0001_0001_0001;
        *averaged += usize::from(!even);
        let slot = Known::slot(key);
        if self.known.keys[slot] == key {
            return self.known.entries[slot];
        }
        self.look_up(key, even)
    }

    #[cold]
    fn look_up(&mut self, key: u64, even: bool) -> u32 {
        let ids = [0, 16, 32, 48].map(|shift| MaterialId((key >> shift) as u16));
        let entry = if even { self.palette.pure(ids[0]) } else { self.palette.mean(ids) };
        let slot = Known::slot(key);
        (self.known.keys[slot], self.known.entries[slot]) = (key, entry);
        entry
    }

    /// Settles the faces: the harmonic mean of the two cells that share one, unless either claims it.
    fn faces(&mut self, before: Option<Done<'_>>, after: Option<Done<'_>>) {
        let (Some(low), Some(high)) = (before.or(after), after.or(before)) else { return };
        let [_, rows, cells] = self.layout.n;
        for axis in 0..3 {
            for j in 0..=rows {
                for k in 0..=cells {
                    // The two cells, whether they are in the grid, and where their claims stand.
                    let at = |axis_of: usize, node: usize, n: usize, side: usize| {
                        let down = usize::from(axis == axis_of && side == 0);
                        (node.saturating_sub(down).min(n - 1), node >= down && node - down < n)
                    };
                    let side = |side: usize| {
                        let ((j, in_rows), (k, in_cells)) = (at(1, j, rows, side), at(2, k, cells, side));
                        let done = if axis == 0 && side == 0 { low } else { high };
                        let in_planes = axis != 0 || if side == 0 { before.is_some() } else { after.is_some() };
                        (done, j, k, in_planes && in_rows && in_cells)
                    };
                    let sides = [side(0), side(1)];
                    let claimed = sides.iter().zip([1, 0]).any(|((done, j, k, real), high)| {
                        *real && done.claims.in_row(*j).is_some_and(|held| held[*k] & face_flag(axis, high) != 0)
                    });
                    let ids = if claimed {
                        let lists = match axis {
                            0 => {
                                [before.map(|b| (&b.claims.across_x[1], j)), after.map(|a| (&a.claims.across_x[0], j))]
                            }
                            _ => [Some((&high.claims.across_yz[axis - 1], j)), None],
                        };
                        [latest(lists, cells, k).material; 2]
                    } else {
                        sides.map(|(done, j, k, _)| done.solid[j * cells + k])
                    };
                    let entry =
                        self.face_entry(ids.map(|id| self.materials[id.index()].along(self.layout.axes()[axis], id)));
                    self.settled.faces[axis].push(entry);
                }
            }
        }
    }

    fn face_entry(&mut self, ids: [MaterialId; 2]) -> u32 {
        if let Some((_, entry)) = self.last_face.filter(|(last, _)| *last == ids) {
            return entry;
        }
        let [a, b] = ids.map(|id| &self.materials[id.index()]);
        let face = FaceMaterial::between(a, b, self.magnetic_averaging);
        let entries = &mut self.settled.face_palette;
        let entry = entries.iter().position(|known| *known == face).unwrap_or_else(|| {
            entries.push(face);
            entries.len() - 1
        }) as u32;
        self.last_face = Some((ids, entry));
        entry
    }
}

/// The last claim in up to two lists, at place `k` of their rows.
pub fn latest(lists: [Option<(&List, usize)>; 2], cells: usize, k: usize) -> Claim {
    let claim = |list: Option<(&List, usize)>| list.and_then(|(list, j)| list.get(j * (cells + 1) + k).copied());
    lists.map(claim).into_iter().flatten().fold(Claim::NONE, Claim::latest)
}
