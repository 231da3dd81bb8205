//! Which cells of a plane claim which of their edges and faces, and who claimed each edge and face last.

use std::ops::Range;

use super::layout::Layout;
use crate::model::MaterialId;

/// The edge of a cell along `axis` that lies at its high end (1) or low end (0) along the two other axes, as a flag.
pub fn edge_flag(axis: usize, high: [usize; 2]) -> u32 {
    1 << (4 * axis + 2 * high[0] + high[1])
}

/// The face of a cell across `axis` at its high end (1) or low end (0), as a flag.
pub fn face_flag(axis: usize, high: usize) -> u32 {
    1 << (12 + 2 * axis + high)
}

/// All edges and faces of a cell.
const ALL: u32 = (1 << 18) - 1;

/// Who claimed an edge or face last: an object counted from 1 (0: none), and its material there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Claim {
    pub object: u32,
    pub material: MaterialId,
}

impl Claim {
    /// Nobody.
    pub const NONE: Self = Self { object: 0, material: MaterialId::FREE_SPACE };

    /// The later of two; of one object's, that of the second.
    pub fn latest(self, other: Self) -> Self {
        if other.object >= self.object { other } else { self }
    }
}

/// Claims on one kind of edge or face of a plane: place `j * (cells in a row + 1) + k`; empty where none is wanted.
pub type List = Vec<Claim>;

/// Claims within one plane of cells.
#[derive(Debug)]
pub struct Claims {
    layout: Layout,
    faces_wanted: bool,
    /// Flags of the edges and faces that each cell claims; empty while none ever did.
    held: Vec<u32>,
    /// Whether any cell of a row holds a claim.
    rows: Vec<bool>,
    any: bool,
    /// Along x.
    pub x: List,
    /// Along y and z, on the low and on the high side of the plane.
    pub yz: [[List; 2]; 2],
    /// Faces across x, on the low and on the high side of the plane.
    pub across_x: [List; 2],
    /// Faces across y and z.
    pub across_yz: [List; 2],
}

impl Claims {
    /// No claims; takes memory only when the first is made.
    pub fn new(layout: Layout, faces_wanted: bool) -> Self {
        Self {
            layout,
            faces_wanted,
            held: vec![],
            rows: vec![false; layout.n[1]],
            any: false,
            x: vec![],
            yz: Default::default(),
            across_x: Default::default(),
            across_yz: Default::default(),
        }
    }

    /// Forgets all claims.
    pub fn clear(&mut self) {
        if !self.any {
            return;
        }
        self.any = false;
        self.held.fill(0);
        self.rows.fill(false);
        self.lists().for_each(|list| list.fill(Claim::NONE));
    }

    fn lists(&mut self) -> impl Iterator<Item = &mut List> {
        let edges = std::iter::once(&mut self.x).chain(self.yz.as_flattened_mut());
        edges.chain(&mut self.across_x).chain(&mut self.across_yz)
    }

    fn begin(&mut self) {
        self.any = true;
        if !self.held.is_empty() {
            return;
        }
        let [_, rows, cells] = self.layout.n;
        self.held = vec![0; rows * cells];
        let list = vec![Claim::NONE; (rows + 1) * (cells + 1)];
        if self.layout.wanted(0) {
            self.x = list.clone();
        }
        for axis in [1, 2] {
            if self.layout.wanted(axis) {
                self.yz[axis - 1] = [list.clone(), list.clone()];
            }
        }
        if self.faces_wanted {
            (self.across_x, self.across_yz) = ([list.clone(), list.clone()], [list.clone(), list]);
        }
    }

    /// Flags of the edges and faces that the cells of a row claim; `None` where no cell of the row does.
    pub fn in_row(&self, j: usize) -> Option<&[u32]> {
        let cells = self.layout.n[2];
        self.rows[j].then(|| &self.held[j * cells..][..cells])
    }

    /// Drops the claims that cells of a row hold.
    pub fn drop_run(&mut self, j: usize, run: Range<usize>) {
        if self.rows[j] {
            self.held[j * self.layout.n[2]..][run].fill(0);
        }
    }

    /// Lets cells of a row claim all their edges and faces.
    pub fn claim_run(&mut self, j: usize, run: Range<usize>, claim: Claim) {
        if run.is_empty() {
            return;
        }
        self.begin();
        self.rows[j] = true;
        let cells = self.layout.n[2];
        self.held[j * cells..][run.clone()].fill(ALL);
        let both = run.start..run.end + 1;
        let fill = |list: &mut List, j: usize, run: &Range<usize>| {
            if !list.is_empty() {
                list[j * (cells + 1)..][run.clone()].fill(claim);
            }
        };
        for j in [j, j + 1] {
            fill(&mut self.x, j, &both);
            fill(&mut self.across_yz[0], j, &run);
        }
        fill(&mut self.across_yz[1], j, &both);
        let [y, z] = &mut self.yz;
        for side in [0, 1] {
            fill(&mut y[side], j, &both);
            fill(&mut z[side], j, &run);
            fill(&mut z[side], j + 1, &run);
            fill(&mut self.across_x[side], j, &run);
        }
    }

    /// Lets a cell hold these claims and no others.
    pub fn hold(&mut self, j: usize, k: usize, flags: u32) {
        if flags != 0 {
            self.begin();
        }
        if !self.held.is_empty() {
            self.rows[j] |= flags != 0;
            self.held[j * self.layout.n[2] + k] = flags;
        }
    }

    /// Notes who claimed an edge (`field` 0 to 2) or face (3 to 5) at node `(j, k)` of the plane of nodes on the low (0) or
    /// high (1) side of this plane of cells. It counts where a cell holds such a claim.
    pub fn note(&mut self, field: usize, side: usize, [j, k]: [usize; 2], claim: Claim) {
        self.begin();
        let place = j * (self.layout.n[2] + 1) + k;
        let list = match field {
            0 => &mut self.x,
            1 | 2 => &mut self.yz[field - 1][side],
            3 => &mut self.across_x[side],
            _ => &mut self.across_yz[field - 4],
        };
        if let Some(known) = list.get_mut(place) {
            *known = claim;
        }
    }

    /// Claims one edge along an axis of the layout, from a node; the plane of cells `i` keeps what concerns it.
    pub fn claim_edge(&mut self, i: usize, axis: usize, [a, j, k]: [usize; 3], claim: Claim) {
        if !self.layout.wanted(axis) {
            return;
        }
        self.begin();
        let [_, rows, cells] = self.layout.n;
        // The plane lies behind the node (side 0) or before it (side 1).
        let side = a - i;
        let place = j * (cells + 1) + k;
        match axis {
            0 => self.x[place] = claim,
            _ => self.yz[axis - 1][side][place] = claim,
        }
        let beside = |node: usize, of: usize| {
            let before = (axis != of).then(|| (node.wrapping_sub(1), 1));
            std::iter::once((node, 0)).chain(before)
        };
        for (row, high_j) in beside(j, 1) {
            for (cell, high_k) in beside(k, 2) {
                if row < rows && cell < cells {
                    let high = match axis {
                        0 => [high_j, high_k],
                        1 => [side, high_k],
                        _ => [side, high_j],
                    };
                    self.rows[row] = true;
                    self.held[row * cells + cell] |= edge_flag(axis, high);
                }
            }
        }
    }
}
