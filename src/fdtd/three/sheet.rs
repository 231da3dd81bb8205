//! Where the arrays live.
//!
//! Plane `i` holds `Ex (i+½, j, k)`, `Ey (i, j+½, k)`, `Ez (i, j, k+½)`, `Hx (i, j+½, k+½)`, `Hy (i+½, j, k+½)` and
//! `Hz (i+½, j+½, k)` in rows along z, the contiguous axis; see `fields`. Row `j = -1` is padding, so is everything past the
//! far walls; E there is set to zero after every step of its row, and H stays zero because E is. [`Sheets`] hold such
//! rows.
//!
//! Fields are held scaled, so that the step of H has no coefficient: E as the voltage along its edge, `E d` (V), and H as
//! `H mu0 A/dt` with the area `A` of its face, also in V.

use super::super::real::Real;
use super::super::state::{Numbers, State};
use super::arena::{Arena, Piece};

/// Rows are padded to whole multiples of this many numbers (64 bytes in single precision).
pub const LANES: usize = 16;

/// How many nodes of a row the kernels run over.
pub fn padded(nz: usize) -> usize {
    nz.next_multiple_of(LANES)
}

/// Bytes after which the places of a cache that numbers fall on come round.
const ROUND: usize = 4096;

/// Several quantities, each in rows of numbers along z, from `j = -1` on, node 0 of each on a 64-byte border.
///
/// They lie one behind the other, at such distances that the same row of each falls on other places of a cache: rows that
/// are read together would push each other out otherwise.
#[derive(Debug, Clone)]
pub struct Sheets<T> {
    data: Piece<T>,
    /// Place of node 0 of row -1 of the first quantity.
    origin: usize,
    /// Nodes of a row.
    width: usize,
    /// Numbers from one quantity to the next.
    apart: usize,
    parts: usize,
}

/// The numbers of one quantity, but for the padding.
fn length(last: usize, width: usize) -> usize {
    (last + 2) * width
}

/// Numbers from one quantity to the next: the least distance at which the first few rows of six are spread over all places.
fn distance<T>(last: usize, width: usize) -> usize {
    let line = 64 / size_of::<T>();
    let mut apart = (length(last, width) + 2 * LANES).next_multiple_of(line);
    let lines = |apart: usize| apart * size_of::<T>() % ROUND / 64;
    while !(9..=55).contains(&lines(apart)) || lines(apart) == 32 {
        apart += line;
    }
    apart
}

impl<T: Real> Sheets<T> {
    /// Zeros: `parts` quantities, of each the rows `-1..=last` of `width` nodes.
    pub fn zeros(parts: usize, last: usize, width: usize) -> Self {
        let data = vec![T::default(); Self::numbers(parts, last, width)];
        Self::within(data.into(), parts, last, width)
    }

    /// As [`Sheets::zeros`], in an arena.
    pub fn zeros_in(arena: &mut Arena, parts: usize, last: usize, width: usize) -> Self {
        Self::within(arena.zeros(Self::numbers(parts, last, width)), parts, last, width)
    }

    fn within(data: Piece<T>, parts: usize, last: usize, width: usize) -> Self {
        let to_border = data.as_ptr().align_offset(64).min(LANES);
        Self { data, origin: to_border + LANES, width, apart: distance::<T>(last, width), parts }
    }

    /// How many numbers there are, with the padding.
    fn numbers(parts: usize, last: usize, width: usize) -> usize {
        parts * distance::<T>(last, width) + LANES
    }

    /// Memory that [`Sheets::zeros`] takes, bytes.
    pub fn bytes(parts: usize, last: usize, width: usize) -> u64 {
        Arena::bytes::<T>(Self::numbers(parts, last, width))
    }

    /// Place of a node in the numbers of its quantity.
    #[inline(always)]
    pub fn place(&self, j: usize, k: usize) -> usize {
        (j + 1) * self.width + k
    }

    /// `count` nodes of row `j` of a quantity from node `k` on.
    #[inline(always)]
    pub fn at(&self, part: usize, j: usize, k: usize, count: usize) -> &[T] {
        &self.data[self.origin + part * self.apart + self.place(j, k)..][..count]
    }

    /// `count` nodes of row `j` of a quantity from node `k` on.
    #[inline(always)]
    pub fn at_mut(&mut self, part: usize, j: usize, k: usize, count: usize) -> &mut [T] {
        let place = self.place(j, k);
        &mut self.data[self.origin + part * self.apart + place..][..count]
    }

    /// All numbers before node `k` of row `j` of a quantity, and all from there on, those of the next quantities
    /// [`Sheets::apart`] behind each other.
    #[inline(always)]
    pub fn split_mut(&mut self, part: usize, j: usize, k: usize) -> (&mut [T], &mut [T]) {
        let place = self.place(j, k);
        self.data.split_at_mut(self.origin + part * self.apart + place)
    }

    /// Numbers from one quantity to the next.
    #[inline(always)]
    pub fn apart(&self) -> usize {
        self.apart
    }

    /// Nodes of a row.
    #[inline(always)]
    pub fn width(&self) -> usize {
        self.width
    }
}

impl<T: Real> State for Sheets<T> {
    fn visit(&mut self, visitor: &mut dyn FnMut(Numbers<'_>)) {
        let Self { data, origin, width, apart, parts } = self;
        let rows = (*apart - 2 * LANES) / *width * *width;
        (0..*parts).for_each(|part| visitor(T::numbers(&mut data[*origin + part * *apart..][..rows])));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Quantities and rows do not overlap, node 0 lies on a 64-byte border in both precisions, and the same row of six
    /// quantities never falls on the same places of a cache.
    #[test]
    fn rows_are_apart_and_aligned() {
        let width = padded(33);
        assert_eq!(width, 48);
        let mut sheets = Sheets::<f64>::zeros(2, 3, width);
        sheets.at_mut(0, 1, 0, width).fill(1.0);
        sheets.at_mut(1, 3, 0, width).fill(2.0);
        let others = [sheets.at(0, 0, 0, width), sheets.at(0, 2, 0, 2 * width), sheets.at(1, 0, 0, 3 * width)];
        assert!(others.into_iter().flatten().all(|&v| v == 0.0));
        let apart = sheets.apart();
        let (before, rest) = sheets.split_mut(0, 2, 0);
        assert_eq!((before.last(), rest.first(), rest[apart + width]), (Some(&1.0), Some(&0.0), 2.0));
        assert_eq!(sheets.at(1, 2, 0, 1).as_ptr() as usize % 64, 0);
        assert_eq!(Sheets::<f32>::zeros(2, 3, width).at(1, 1, 0, 1).as_ptr() as usize % 64, 0);
        for last in [2, 61, 99, 128, 150, 200, 256, 300] {
            for nodes in [16, 64, 128, 208, 256, 304, 512] {
                let lines = |part: usize| part * distance::<f32>(last, nodes) * 4 % ROUND / 64;
                assert!((1..6).all(|part| (1..=part).all(|other| lines(other) != lines(other - 1))));
                assert!(distance::<f32>(last, nodes) - length(last, nodes) <= 2 * LANES + 20 * 16);
            }
        }
    }

    /// A state shows the rows of every quantity and nothing else.
    #[test]
    fn a_state_is_its_rows() {
        let mut sheets = Sheets::<f32>::zeros(3, 7, 16);
        let mut bytes = vec![];
        sheets.visit(&mut |numbers| bytes.push(numbers.bytes()));
        assert!(bytes.len() == 3 && bytes.iter().all(|&part| part >= 9 * 16 * 4));
    }
}
