//! Where the arrays live.
//!
//! `Ez` lies at node `(i, j)`, `Hx` at `(i, j - ½)`, `Hy` at `(i + ½, j)`: index `j` of an `Hx` row is the edge *below*
//! node `j`, so that every kernel runs over `j = 1..` with aligned rows. Rows run along y and are contiguous; node 0 of
//! each row and the nodes past the far wall are padding that stays zero because their coefficients are.
//!
//! For the kernels a row is made of chunks of sixteen nodes: chunk `c` holds the nodes `16 (c - 1) + 1 ..= 16 c`, and chunk 0,
//! which is also what lies behind the last chunk of the row before, only padding and node 0.
//!
//! H is held scaled, so that its step has no coefficient: `Hx = hx dt/(mu0 dy)`, `Hy = hy dt/(mu0 dx)`, in V/m.

use super::lanes::Chunk;
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

    /// Where chunk 0 of row 0 begins.
    #[inline(always)]
    fn border(&self) -> usize {
        self.origin + 1 - LANES
    }

    /// `count` chunks of a row from chunk `first` on.
    #[inline(always)]
    pub fn chunks(&self, row: usize, first: usize, count: usize) -> &[Chunk<T>] {
        &self.data[self.border()..].as_chunks().0[row * (self.stride / LANES) + first..][..count]
    }

    /// As [`Rows::chunks`], to change them.
    #[inline(always)]
    pub fn chunks_mut(&mut self, row: usize, first: usize, count: usize) -> &mut [Chunk<T>] {
        let (border, at) = (self.border(), row * (self.stride / LANES) + first);
        &mut self.data[border..].as_chunks_mut().0[at..][..count]
    }

    /// `count` chunks of a row from the one before chunk `first` on, to change, and all but the first of them of the next row.
    #[inline(always)]
    pub fn with_next(&mut self, row: usize, first: usize, count: usize) -> (&mut [Chunk<T>], &[Chunk<T>]) {
        let (border, stride) = (self.border(), self.stride / LANES);
        let (these, next) = self.data[border..].as_chunks_mut().0.split_at_mut((row + 1) * stride);
        (&mut these[row * stride + first - 1..][..count], &next[first..][..count - 1])
    }

    /// `count` chunks of the row before, and the same of a row, to change.
    #[inline(always)]
    pub fn with_last(&mut self, row: usize, first: usize, count: usize) -> (&[Chunk<T>], &mut [Chunk<T>]) {
        let (border, stride) = (self.border(), self.stride / LANES);
        let (last, these) = self.data[border..].as_chunks_mut().0.split_at_mut(row * stride);
        (&last[(row - 1) * stride + first..][..count], &mut these[first..][..count])
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
