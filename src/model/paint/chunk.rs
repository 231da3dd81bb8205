//! A chunk of planes, painted and settled on one thread.

use std::sync::atomic::{AtomicBool, Ordering};

use super::claims::Claims;
use super::layout::Layout;
use super::settle::{Done, Settled, Settler};
use super::solid::{Plane, Solid};
use crate::model::{MagneticAveraging, Material, MaterialId};

/// What all chunks share.
pub struct Job<'a> {
    pub layout: Layout,
    pub materials: &'a [Material],
    pub solids: &'a [Solid<'a>],
    /// Whether each of them has filled a cell.
    pub filled: &'a [AtomicBool],
    pub faces_wanted: bool,
    pub magnetic_averaging: MagneticAveraging,
}

/// The claims and rows of a plane.
struct Kept {
    claims: Claims,
    even: Vec<Option<MaterialId>>,
}

impl Job<'_> {
    /// Paints the planes of `cells`, the first of which is plane `first`, with some of the solids, and settles the planes of
    /// nodes before each of them; behind the grid's last plane one more.
    pub fn run(&self, first: usize, cells: &mut [MaterialId], solids: &[u32]) -> Settled {
        let (plane, count) = (self.layout.plane(), cells.len() / self.layout.plane());
        let mut settler = Settler::new(self);
        let kept = || Kept { claims: Claims::new(self.layout, self.faces_wanted), even: vec![] };
        let (mut before, mut now) = (kept(), kept());
        let mut earlier = vec![];
        if first > 0 {
            earlier = vec![MaterialId::FREE_SPACE; plane];
            self.paint(first - 1, &mut earlier, &mut before, solids, false);
        }
        for at in 0..count {
            let (done, rest) = cells.split_at_mut(at * plane);
            let solid = &mut rest[..plane];
            self.paint(first + at, solid, &mut now, solids, true);
            let previous = if at > 0 { &done[(at - 1) * plane..] } else { &earlier[..] };
            let previous = (first + at > 0).then(|| before.done(previous));
            settler.plane(first + at, previous, Some(now.done(solid)));
            std::mem::swap(&mut before, &mut now);
        }
        if first + count == self.layout.n[0] {
            settler.plane(first + count, Some(before.done(&cells[(count - 1) * plane..])), None);
        }
        settler.finish()
    }

    /// Paints plane `i`, which holds free space and no claims, with some of the solids; `own`: those that fill a cell of it are marked.
    pub fn paint_plane(&self, i: usize, solid: &mut [MaterialId], claims: &mut Claims, solids: &[u32], own: bool) {
        let mut plane = Plane { layout: self.layout, i, solid, claims };
        for &index in solids {
            let object = &self.solids[index as usize];
            if object.cells[0].contains(&i) && object.fill(&mut plane) && own {
                self.filled[index as usize].store(true, Ordering::Relaxed);
            }
        }
    }

    fn paint(&self, i: usize, solid: &mut [MaterialId], kept: &mut Kept, solids: &[u32], own: bool) {
        kept.claims.clear();
        self.paint_plane(i, solid, &mut kept.claims, solids, own);
        let even = |row: &[MaterialId]| Some(row[0]).filter(|first| row.iter().all(|id| id == first));
        kept.even.clear();
        kept.even.extend(solid.chunks_exact(self.layout.n[2]).map(even));
    }
}

impl Kept {
    fn done<'a>(&'a self, solid: &'a [MaterialId]) -> Done<'a> {
        Done { solid, claims: &self.claims, even: &self.even }
    }
}
