//! Where the arrays live.
//!
//! `Ez` lies at node `(i, j)`, `Hx` at `(i, j - ½)`, `Hy` at `(i + ½, j)`: index `j` of an `Hx` row is the edge *below*
//! node `j`, so that every kernel runs over `j = 1..` with aligned rows. Rows run along y and are contiguous; node 0 of
//! each row and the nodes past the far wall are padding that stays zero because their coefficients are.
//!
//! H is held scaled, so that its step has no coefficient: `Hx = hx dt/(mu0 dy)`, `Hy = hy dt/(mu0 dx)`, in V/m.

use super::real::Real;

/// Rows are padded to whole multiples of this many numbers (64 bytes in single precision).
pub const LANES: usize = 16;

/// How many nodes, counted from `j = 1`, the kernels run over.
pub fn padded_width(ny: usize) -> usize {
    ny.next_multiple_of(LANES)
}

/// Rows of numbers, node 1 of each on a 64-byte border.
#[derive(Debug, Clone)]
pub struct Rows<T> {
    data: Vec<T>,
    /// Place of node 0 of row 0.
    origin: usize,
    stride: usize,
}

impl<T: Real> Rows<T> {
    /// Zeros: `rows` rows of `width` nodes from `j = 1`.
    pub fn zeros(rows: usize, width: usize) -> Self {
        let stride = width + LANES;
        let data = vec![T::default(); Self::length(rows, width)];
        let to_border = data.as_ptr().align_offset(64).min(LANES);
        Self { data, origin: to_border + LANES - 1, stride }
    }

    fn length(rows: usize, width: usize) -> usize {
        rows * (width + LANES) + 2 * LANES
    }

    /// Memory that [`Rows::zeros`] takes, bytes.
    pub fn bytes(rows: usize, width: usize) -> u64 {
        (Self::length(rows, width) * size_of::<T>()) as u64
    }

    /// `count` nodes of a row from node `j` on.
    #[inline(always)]
    pub fn at(&self, row: usize, j: usize, count: usize) -> &[T] {
        &self.data[self.origin + row * self.stride + j..][..count]
    }

    /// `count` nodes of a row from the second node before `j` on; node -1 is padding.
    #[inline(always)]
    pub fn two_before(&self, row: usize, j: usize, count: usize) -> &[T] {
        &self.data[self.origin + row * self.stride + j - 2..][..count]
    }

    /// Node -1 of a row.
    #[inline(always)]
    pub fn below_wall(&mut self, row: usize) -> &mut T {
        &mut self.data[self.origin + row * self.stride - 1]
    }

    /// `count` nodes of a row from node `j` on.
    #[inline(always)]
    pub fn at_mut(&mut self, row: usize, j: usize, count: usize) -> &mut [T] {
        &mut self.data[self.origin + row * self.stride + j..][..count]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows do not overlap within their widths, and node 1 lies on a 64-byte border in both precisions.
    #[test]
    fn rows_are_apart_and_aligned() {
        let width = padded_width(33);
        assert_eq!(width, 48);
        let mut rows = Rows::<f64>::zeros(3, width);
        rows.at_mut(1, 0, width + 2).fill(1.0);
        assert!(rows.at(0, 0, width + 1).iter().chain(rows.at(2, 0, width)).all(|&v| v == 0.0));
        assert_eq!(rows.at(2, 1, 1).as_ptr() as usize % 64, 0);
        assert_eq!(Rows::<f32>::zeros(3, width).at(1, 1, 1).as_ptr() as usize % 64, 0);
    }
}
