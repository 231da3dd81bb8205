//! Where the arrays live.
//!
//! Plane `i` holds `Ex (i+½, j, k)`, `Ey (i, j+½, k)`, `Ez (i, j, k+½)`, `Hx (i, j+½, k+½)`, `Hy (i+½, j, k+½)` and
//! `Hz (i+½, j+½, k)`, each as a [`Sheet`] of rows along z, the contiguous axis. Row `j = -1` is padding, so is everything
//! past the far walls; E there is set to zero after every step of its row, and H stays zero because E is. One row follows
//! the other without a gap: the node after the last of a row is node 0 of the next, where Ex and Ey lie on a wall and are
//! zero; what lies before node 0 is only ever taken for edges on that wall, which are then set to zero.
//!
//! Fields are held scaled, so that the step of H has no coefficient: E as the voltage along its edge, `E d` (V), and H as
//! `H mu0 A/dt` with the area `A` of its face, also in V.

use super::super::real::Real;
use super::super::state::{Numbers, State};

/// Rows are padded to whole multiples of this many numbers (64 bytes in single precision).
pub const LANES: usize = 16;

/// How many nodes of a row the kernels run over.
pub fn padded(nz: usize) -> usize {
    nz.next_multiple_of(LANES)
}

/// Rows of numbers along z, from `j = -1` on, node 0 of each on a 64-byte border.
#[derive(Debug, Clone)]
pub struct Sheet<T> {
    data: Vec<T>,
    /// Place of node 0 of row -1.
    origin: usize,
    stride: usize,
}

impl<T: Real> Sheet<T> {
    /// Zeros: the rows `-1..=last` of `width` nodes.
    pub fn zeros(last: usize, width: usize) -> Self {
        let data = vec![T::default(); Self::length(last, width)];
        let to_border = data.as_ptr().align_offset(64).min(LANES);
        Self { data, origin: to_border + LANES, stride: width }
    }

    fn length(last: usize, width: usize) -> usize {
        (last + 2) * width + 3 * LANES
    }

    /// Memory that [`Sheet::zeros`] takes, bytes.
    pub fn bytes(last: usize, width: usize) -> u64 {
        (Self::length(last, width) * size_of::<T>()) as u64
    }

    /// `count` nodes of row `j` from node `k` on.
    #[inline(always)]
    pub fn at(&self, j: usize, k: usize, count: usize) -> &[T] {
        &self.data[self.origin + (j + 1) * self.stride + k..][..count]
    }

    /// `count` nodes of row `j` from node `k` on.
    #[inline(always)]
    pub fn at_mut(&mut self, j: usize, k: usize, count: usize) -> &mut [T] {
        &mut self.data[self.origin + (j + 1) * self.stride + k..][..count]
    }

    /// `count` nodes of row `j` from the node before `k` on.
    #[inline(always)]
    pub fn before(&self, j: usize, k: usize, count: usize) -> &[T] {
        &self.data[self.origin + (j + 1) * self.stride + k - 1..][..count]
    }

    /// `count` nodes of the row before `j` from node `k` on.
    #[inline(always)]
    pub fn south(&self, j: usize, k: usize, count: usize) -> &[T] {
        &self.data[self.origin + j * self.stride + k..][..count]
    }
}

impl<T: Real> State for Sheet<T> {
    fn visit(&mut self, visitor: &mut dyn FnMut(Numbers<'_>)) {
        let Self { data, origin, stride: _ } = self;
        let rows = data.len() - 3 * LANES;
        visitor(T::numbers(&mut data[*origin..][..rows]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows do not overlap within their widths, and node 0 lies on a 64-byte border in both precisions.
    #[test]
    fn rows_are_apart_and_aligned() {
        let width = padded(33);
        assert_eq!(width, 48);
        let mut sheet = Sheet::<f64>::zeros(3, width);
        sheet.at_mut(1, 0, width).fill(1.0);
        let others = [sheet.south(1, 0, width), sheet.at(2, 0, width), sheet.at(3, 0, width + 1)];
        assert!(others.into_iter().flatten().all(|&v| v == 0.0));
        assert_eq!(sheet.before(2, 0, 2), [1.0, 0.0]);
        assert_eq!(sheet.at(2, 0, 1).as_ptr() as usize % 64, 0);
        assert_eq!(Sheet::<f32>::zeros(3, width).at(1, 0, 1).as_ptr() as usize % 64, 0);
    }
}
