//! Cells with what each claims, and edges and faces with what they are made of: a painted grid as geometry files hold it.

use std::collections::HashMap;
use std::sync::atomic::AtomicBool;

use super::PaintError;
use super::chunk::Job;
use super::claims::{Claims, List, edge_flag, face_flag};
use super::layout::Layout;
use super::settle::latest;
use super::solid::solids;
use crate::model::{MaterialId, Model};

/// What an edge or a face is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Parts {
    /// One material.
    One(MaterialId),
    /// The perfect magnetic conductor: faces that hold no field.
    MagneticConductor,
    /// The mean of the four cells around an edge, sorted.
    Edge([MaterialId; 4]),
    /// The mean of the two cells beside a face, sorted.
    Face([MaterialId; 2]),
}

/// A painted grid as geometry files hold it, edge by edge.
///
/// In contrast to [`Painted3`](crate::model::Painted3) it tells what a mean is a mean of, and which cells claim what.
#[derive(Debug, Clone, PartialEq)]
pub struct Finished {
    /// Cells along x, y, z.
    pub cells: [usize; 3],
    /// Material of each cell: `solid[(i * ny + j) * nz + k]`.
    pub solid: Vec<MaterialId>,
    /// What each cell claims, see [`Finished::claims_edge`] and [`Finished::claims_face`].
    claims: Vec<u32>,
    /// All that edges and faces are made of, each once.
    pub parts: Vec<Parts>,
    /// Index into `parts` of Ex, Ey, Ez, Hx, Hy, Hz at node `(i, j, k)`: place `(i * (ny + 1) + j) * (nz + 1) + k`.
    pub fields: [Vec<u32>; 6],
}

impl Finished {
    /// Whether a cell claims its edge along an axis that lies at the high ends (1) or low ends (0) of the two other axes.
    pub fn claims_edge(&self, cell: usize, axis: usize, high: [usize; 2]) -> bool {
        self.claims[cell] & edge_flag(axis, high) != 0
    }

    /// Drops what perfect conductors claim of their faces, from a cell on: in gprMax they claim edges only, and a solver does
    /// not see the difference, since no field crosses their faces.
    fn unclaim_conductors(&mut self, first: usize) {
        let faces = (0..3).flat_map(|axis| [face_flag(axis, 0), face_flag(axis, 1)]).fold(0, |all, flag| all | flag);
        let cells = self.claims.iter_mut().zip(&self.solid).skip(first);
        cells.filter(|(_, id)| **id == MaterialId::PEC).for_each(|(claims, _)| *claims &= !faces);
    }

    /// Whether a cell claims its face across an axis at the high (1) or low (0) end.
    pub fn claims_face(&self, cell: usize, axis: usize, high: usize) -> bool {
        self.claims[cell] & face_flag(axis, high) != 0
    }
}

/// Paints the objects of a model and tells of every edge and face what it is made of.
///
/// Behind the outer walls that absorb, along the axes that a two-dimensional model does not have, and beyond the last node of
/// an axis stands what gprMax puts there: perfect conductors and free space.
///
/// # Errors
/// When an object fills no cell or has no such material.
pub fn paint_finished(model: &Model) -> Result<Finished, PaintError> {
    let layout = Layout::new(model.grid, false);
    let solids = solids(model, &layout)?;
    let filled: Vec<AtomicBool> = solids.iter().map(|_| AtomicBool::new(false)).collect();
    let (materials, magnetic_averaging) = (&model.materials[..], model.magnetic_averaging);
    let job = Job { layout, materials, solids: &solids, filled: &filled, faces_wanted: true, magnetic_averaging };
    let all: Vec<u32> = (0..solids.len() as u32).collect();
    let [nx, ny, nz] = model.grid.cells;
    let nodes = (nx + 1) * (ny + 1) * (nz + 1);
    let mut finisher = Finisher {
        model,
        finished: Finished {
            cells: model.grid.cells,
            solid: vec![MaterialId::FREE_SPACE; nx * ny * nz],
            claims: vec![0; nx * ny * nz],
            parts: vec![],
            fields: std::array::from_fn(|_| Vec::with_capacity(nodes)),
        },
        known: HashMap::new(),
    };
    let (mut before, mut now) = (Claims::new(layout, true), Claims::new(layout, true));
    for i in 0..=nx {
        if i < nx {
            let cells = i * ny * nz..(i + 1) * ny * nz;
            now.clear();
            job.paint_plane(i, &mut finisher.finished.solid[cells.clone()], &mut now, &all, true);
            for (j, row) in finisher.finished.claims[cells].chunks_exact_mut(nz).enumerate() {
                row.copy_from_slice(now.in_row(j).unwrap_or(&vec![0; nz]));
            }
            finisher.finished.unclaim_conductors(i * ny * nz);
        }
        finisher.plane(i, (i > 0).then_some(&before), (i < nx).then_some(&now));
        std::mem::swap(&mut before, &mut now);
    }
    Ok(finisher.finished)
}

struct Finisher<'a> {
    model: &'a Model,
    finished: Finished,
    known: HashMap<Parts, u32>,
}

impl Finisher<'_> {
    /// Finishes plane `i` of nodes, between two planes of cells.
    fn plane(&mut self, i: usize, before: Option<&Claims>, now: Option<&Claims>) {
        let [_, ny, nz] = self.finished.cells;
        for field in 0..6 {
            for j in 0..=ny {
                for k in 0..=nz {
                    let axis = field % 3;
                    let lists: [Option<(&List, usize)>; 2] = match (field, axis) {
                        (0, _) => [now.map(|n| (&n.x, j)), None],
                        (1 | 2, axis) => {
                            [before.map(|b| (&b.yz[axis - 1][1], j)), now.map(|n| (&n.yz[axis - 1][0], j))]
                        }
                        (3, _) => [before.map(|b| (&b.across_x[1], j)), now.map(|n| (&n.across_x[0], j))],
                        (_, axis) => [now.map(|n| (&n.across_yz[axis - 1], j)), None],
                    };
                    let (drawn, fixed) = (self.drawn(field, [i, j, k], lists), self.fixed(axis, field < 3, [i, j, k]));
                    // gprMax lists the means of places that it then makes conductors, too.
                    let entry = self.place(drawn);
                    let entry = fixed.map_or(entry, |fixed| self.place(fixed));
                    self.finished.fields[field].push(entry);
                }
            }
        }
    }

    /// Place in the list of parts.
    fn place(&mut self, parts: Parts) -> u32 {
        let list = &mut self.finished.parts;
        *self.known.entry(parts).or_insert_with(|| {
            list.push(parts);
            (list.len() - 1) as u32
        })
    }

    fn drawn(&self, field: usize, node: [usize; 3], lists: [Option<(&List, usize)>; 2]) -> Parts {
        let (axis, electric) = (field % 3, field < 3);
        let n = self.finished.cells;
        // E lies along its axis, between cells across the two others; H lies across it, between two cells.
        let along = |of: usize| (of == axis) == electric;
        if (0..3).any(|of| along(of) && node[of] >= n[of]) {
            return Parts::One(MaterialId::FREE_SPACE);
        }
        let others: &[usize] = if electric { &[[1, 2], [0, 2], [0, 1]][axis] } else { &[axis] };
        let count = 1 << others.len();
        let mut claimed = false;
        let mut ids = [MaterialId::FREE_SPACE; 4];
        for (side, id) in ids[..count].iter_mut().enumerate() {
            let mut low = [0; 3];
            others.iter().enumerate().for_each(|(bit, &of)| low[of] = side >> bit & 1);
            let real = (0..3).all(|of| node[of] >= low[of] && node[of] - low[of] < n[of]);
            let [i, j, k] = std::array::from_fn(|of| node[of].saturating_sub(low[of]).min(n[of] - 1));
            let cell = (i * n[1] + j) * n[2] + k;
            *id = self.finished.solid[cell];
            claimed |= real
                && match *others {
                    [a, b] => self.finished.claims_edge(cell, axis, [low[a], low[b]]),
                    _ => self.finished.claims_face(cell, axis, low[axis]),
                };
        }
        let one = |id: MaterialId| Parts::One(self.model.materials[id.index()].along(axis, id));
        let ids = &mut ids[..count];
        let last = claimed.then(|| latest(lists, n[2], node[2]).material);
        // A face beside a perfect conductor is made of what lies on the other side.
        if !electric && ids.contains(&MaterialId::PEC) {
            let other = ids.iter().copied().find(|&id| id != MaterialId::PEC).unwrap_or(MaterialId::FREE_SPACE);
            return one(last.filter(|&id| id != MaterialId::PEC).unwrap_or(other));
        }
        if let Some(last) = last {
            return one(last);
        }
        ids.sort_unstable();
        match *ids {
            [a, .., b] if a == b => one(a),
            [a, b] => Parts::Face([a, b]),
            [a, b, c, d] => Parts::Edge([a, b, c, d]),
            _ => Parts::One(MaterialId::FREE_SPACE),
        }
    }

    /// What stands at a place whatever has been painted there.
    fn fixed(&self, axis: usize, electric: bool, node: [usize; 3]) -> Option<Parts> {
        let (model, n) = (self.model, self.finished.cells);
        let pec = Parts::One(MaterialId::PEC);
        if let Some(invariant) = model.invariant_axis() {
            let along = axis == invariant;
            match (model.transverse_electric.is_some(), electric) {
                (false, true) if !along => return Some(pec),
                (true, _) if electric == along => {
                    // Dead along the whole axis, but for what lies beyond its last node.
                    let beyond = node[invariant] >= n[invariant];
                    let dead = if electric { pec } else { Parts::MagneticConductor };
                    return Some(if beyond { Parts::One(MaterialId::FREE_SPACE) } else { dead });
                }
                (true, _) if node[invariant] != 1 => {
                    return Some(if electric { pec } else { Parts::MagneticConductor });
                }
                _ => {}
            }
        }
        let absorbing = model.absorbing_cells();
        let wall = |of: usize| {
            of != axis && (node[of] == 0 && absorbing[of] > 0 || node[of] == n[of] && absorbing[of + 3] > 0)
        };
        (electric && node[axis] < n[axis] && (0..3).any(wall)).then_some(pec)
    }
}
