//! The six fields of a plane.
//!
//! One row follows the other without a gap: the node after the last of a row is node 0 of the next, where Ex and Ey lie on a
//! wall and are zero; what lies before node 0 is only ever taken for edges on that wall, which are then set to zero.

use super::super::real::Real;
use super::super::state::{Numbers, State};
use super::arena::Arena;
use super::sheet::Sheets;

/// The fields of a plane: Ex, Ey, Ez, Hx, Hy, Hz, the rows `-1..=last` of each.
pub struct Fields<T> {
    sheets: Sheets<T>,
}

/// What the step of H of some nodes of a row needs: `k` is the first of them.
pub struct ForH<'a, T> {
    /// H along x, y, z.
    pub h: [&'a mut [T]; 3],
    /// E along x, y, z.
    pub e: [&'a [T]; 3],
    /// E of the row after.
    pub north: [&'a [T]; 3],
    /// E of the nodes from `k + 1` on.
    pub above: [&'a [T]; 3],
}

/// What the step of E of some nodes of a row needs.
pub struct ForE<'a, T> {
    /// E along x, y, z.
    pub e: [&'a mut [T]; 3],
    /// H along x, y, z.
    pub h: [&'a [T]; 3],
    /// H of the row before.
    pub south: [&'a [T]; 3],
    /// H of the nodes from `k - 1` on.
    pub below: [&'a [T]; 3],
}

impl<T: Real> Fields<T> {
    /// Zeros: the rows `-1..=last` of `width` nodes.
    pub fn zeros(arena: &mut Arena, last: usize, width: usize) -> Self {
        Self { sheets: Sheets::zeros_in(arena, 6, last, width) }
    }

    /// No rows.
    pub fn none() -> Self {
        Self { sheets: Sheets::zeros(6, 0, 0) }
    }

    /// Memory that [`Fields::zeros`] takes, bytes.
    pub fn bytes(last: usize, width: usize) -> u64 {
        Sheets::<T>::bytes(6, last, width)
    }

    /// Nodes of a row.
    #[inline(always)]
    pub fn width(&self) -> usize {
        self.sheets.width()
    }

    /// `n` nodes of row `j` of a field, Ex, Ey, Ez, Hx, Hy, Hz, from node `k` on.
    #[inline(always)]
    pub fn at(&self, field: usize, j: usize, k: usize, n: usize) -> &[T] {
        self.sheets.at(field, j, k, n)
    }

    /// One value of a field.
    #[inline(always)]
    pub fn value_mut(&mut self, field: usize, j: usize, k: usize) -> &mut T {
        &mut self.sheets.at_mut(field, j, k, 1)[0]
    }

    /// What the step of H of row `j` needs, `n` nodes from node `k` on.
    #[inline(always)]
    pub fn for_h(&mut self, j: usize, k: usize, n: usize) -> ForH<'_, T> {
        let (apart, width) = (self.sheets.apart(), self.sheets.width());
        let (e, h) = self.sheets.split_mut(3, j, k);
        let (hx, rest) = h.split_at_mut(apart);
        let (hy, hz) = rest.split_at_mut(apart);
        let z = e.len() - apart;
        let (x, y) = (z - 2 * apart, z - apart);
        ForH {
            h: [&mut hx[..n], &mut hy[..n], &mut hz[..n]],
            e: [&e[x..][..n], &e[y..][..n], &e[z..][..n]],
            north: [&e[x + width..][..n], &e[y + width..][..n], &e[z + width..][..n]],
            above: [&e[x + 1..][..n], &e[y + 1..][..n], &e[z + 1..][..n]],
        }
    }

    /// What the step of E of row `j` needs, `n` nodes from node `k` on.
    #[inline(always)]
    pub fn for_e(&mut self, j: usize, k: usize, n: usize) -> ForE<'_, T> {
        let (apart, width) = (self.sheets.apart(), self.sheets.width());
        let (_, rest) = self.sheets.split_mut(0, j, k);
        let (ex, rest) = rest.split_at_mut(apart);
        let (ey, rest) = rest.split_at_mut(apart);
        let (ez, h) = rest.split_at_mut(apart - 2 * width);
        let (x, y, z) = (2 * width, 2 * width + apart, 2 * width + 2 * apart);
        ForE {
            e: [&mut ex[..n], &mut ey[..n], &mut ez[..n]],
            h: [&h[x..][..n], &h[y..][..n], &h[z..][..n]],
            south: [&h[x - width..][..n], &h[y - width..][..n], &h[z - width..][..n]],
            below: [&h[x - 1..][..n], &h[y - 1..][..n], &h[z - 1..][..n]],
        }
    }

    /// Rows `j - 1` and `j` of each field, Ex, Ey, Ez, Hx, Hy, Hz, one behind the other.
    pub fn two_rows(&mut self, j: usize) -> [&mut [T]; 6] {
        let (apart, width) = (self.sheets.apart(), self.sheets.width());
        let (_, mut rest) = self.sheets.split_mut(0, j - 1, 0);
        std::array::from_fn(|field| {
            let own = if field < 5 { apart } else { 2 * width };
            let (rows, others) = std::mem::take(&mut rest).split_at_mut(own);
            rest = others;
            &mut rows[..2 * width]
        })
    }

    /// `n` nodes of row `j` of E along x, y, z, from node `k` on.
    #[inline(always)]
    pub fn e_mut(&mut self, j: usize, k: usize, n: usize) -> [&mut [T]; 3] {
        self.for_e(j, k, n).e
    }
}

impl<T: Real> State for Fields<T> {
    fn visit(&mut self, visitor: &mut dyn FnMut(Numbers<'_>)) {
        let Self { sheets } = self;
        sheets.visit(visitor);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each way of reaching a value finds the one that was written.
    #[test]
    fn every_way_leads_to_the_same_place() {
        let (rows, width) = (3, 32);
        let mut fields = Fields::<f32>::zeros(&mut Arena::of_bytes(0), rows, width);
        let number = |field: usize, j: usize, k: usize| (1000 * field + 100 * j + k) as f32 + 1.0;
        for field in 0..6 {
            for j in 0..rows {
                for k in 0..width {
                    *fields.value_mut(field, j, k) = number(field, j, k);
                }
            }
        }
        let (j, k, n) = (1, 16, 16);
        assert_eq!(fields.at(4, j, k, n)[3], number(4, 1, 19));
        let ForH { h, e, north, above } = fields.for_h(j, k, n);
        for axis in 0..3 {
            let found = [h[axis][2], e[axis][2], north[axis][2], above[axis][2]];
            let at = |field, j, k| number(field, j, k);
            assert_eq!(found, [at(3 + axis, 1, 18), at(axis, 1, 18), at(axis, 2, 18), at(axis, 1, 19)]);
        }
        assert_eq!((above[0][15], above[1][15]), (number(0, 2, 0), number(1, 2, 0)));
        let ForE { e, h, south, below } = fields.for_e(j, 0, n);
        for axis in 0..3 {
            let found = [e[axis][2], h[axis][2], south[axis][2], below[axis][2]];
            let at = |field, j, k| number(field, j, k);
            assert_eq!(found, [at(axis, 1, 2), at(3 + axis, 1, 2), at(3 + axis, 0, 2), at(3 + axis, 1, 1)]);
        }
    }
}
