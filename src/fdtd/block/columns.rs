//! The absorbing cells at both ends of y, in the chunks of each row that hold them.

use super::super::kernel::{Along, Ends};
use super::super::lanes::Chunk;
use super::super::layout::{LANES, Rows, padded_width};
use super::super::real::Real;
use super::super::slab::Slab;

/// The absorbing cells at both ends of y.
pub struct Columns<T> {
    /// Absorbing chunks at the lower end: chunk 1 and on.
    low: usize,
    /// First absorbing chunk at the upper end.
    high: usize,
    /// What absorbs E.
    pub e: OneField<T>,
    /// What absorbs H.
    pub h: OneField<T>,
}

/// Coefficients and memory of one field.
pub struct OneField<T> {
    /// `RA - 1`, `RB`, `RE`, `RF` at the nodes of the absorbing chunks.
    pub profile: Vec<[Chunk<T>; 4]>,
    /// The memory of each row.
    pub phi: Rows<T>,
}

/// Absorbing chunks at the lower end, and the first at the upper end.
fn chunks(low: &Slab, high: &Slab, ny: usize) -> (usize, usize) {
    let (all, below) = (padded_width(ny) / LANES, low.cells.div_ceil(LANES));
    let above = if high.cells > 0 { (ny - high.cells) / LANES + 1 } else { all + 1 };
    (below, above.max(below + 1))
}

/// Nodes of the absorbing chunks.
pub fn absorbing_nodes(low: &Slab, high: &Slab, ny: usize) -> usize {
    let (below, above) = chunks(low, high, ny);
    (below + padded_width(ny) / LANES + 1 - above) * LANES
}

impl<T: Real> Columns<T> {
    /// Allocates the memory of so many rows. Nodes of an absorbing chunk that lie before the entrance absorb nothing.
    pub fn new(slabs: [&Slab; 2], ny: usize, rows: usize) -> Self {
        let [y0, y1] = slabs;
        let (low, high) = chunks(y0, y1, ny);
        let all = padded_width(ny) / LANES;
        let sample = |j: f64| {
            let (below, above) = (y0.cells as f64 - j, j - (ny - y1.cells) as f64);
            // The padding behind the wall absorbs nothing.
            let nothing = below <= 0.0 && (above <= 0.0 || j > ny as f64);
            let at = if below > 0.0 {
                y0.at(below)
            } else if nothing {
                [0.0; 4]
            } else {
                y1.at(above)
            };
            at.map(T::of)
        };
        let field = |shift: f64| {
            let of_chunk = |chunk: usize| -> [[T; 4]; LANES] {
                std::array::from_fn(|k| sample((LANES * (chunk - 1) + 1 + k) as f64 - shift))
            };
            let absorbing: Vec<[[T; 4]; LANES]> = (1..=low).chain(high..=all).map(of_chunk).collect();
            let profile = absorbing.iter().map(|chunk| std::array::from_fn(|k| chunk.map(|of| of[k]))).collect();
            OneField { profile, phi: Rows::zeros(rows, absorbing.len() * LANES) }
        };
        Self { low, high, e: field(0.0), h: field(0.5) }
    }

    /// Which of `count` chunks from chunk `first` on absorb.
    #[inline(always)]
    pub fn ends(&self, first: usize, count: usize) -> Ends {
        let low = (self.low + 1).saturating_sub(first).min(count);
        let high = self.high.saturating_sub(first).clamp(low, count);
        Ends { low, high, place_low: first - 1, place_high: (self.low + first + high).saturating_sub(self.high) }
    }

    /// Node of a row's memory where node `j` has its own, if it has.
    pub fn place(&self, j: usize) -> Option<usize> {
        let chunk = (j - 1) / LANES + 1;
        if chunk <= self.low { Some(j) } else { (chunk >= self.high).then(|| j - LANES * (self.high - 1 - self.low)) }
    }
}

impl<T: Real> OneField<T> {
    /// What absorbs in a span of a row.
    #[inline(always)]
    pub fn along(&mut self, row: usize, ends: Ends) -> Along<'_, T> {
        let count = self.profile.len();
        Along { phi: self.phi.chunks_mut(row, 1, count), profile: &self.profile, ends }
    }

    /// `RA - 1` and `RF` at a place, and the memory of a row there.
    pub fn at(&mut self, row: usize, place: usize) -> ([T; 2], &mut T) {
        let (chunk, k) = ((place - 1) / LANES, (place - 1) % LANES);
        let [ra_less_one, _, _, rf] = &self.profile[chunk];
        ([ra_less_one[k], rf[k]], &mut self.phi.at_mut(row, place, 1)[0])
    }

    /// The memory of a row.
    pub fn memory(&mut self, row: usize) -> &mut [T] {
        let count = self.profile.len() * LANES;
        self.phi.at_mut(row, 1, count)
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::slab::Slab;
    use super::*;
    use crate::model::AbsorbingProfile;

    fn slab(cells: usize) -> Slab {
        if cells == 0 { Slab::none() } else { Slab::new(&AbsorbingProfile::default(), cells, 0.5, 4e-12).unwrap() }
    }

    /// 500 cells, 10 absorbing at each end: nodes 1 to 16 below; above the first is node 491, in the chunk of 481 to 496.
    #[test]
    fn absorbing_chunks_hold_the_absorbing_cells() {
        assert_eq!(chunks(&slab(10), &slab(10), 500), (1, 31));
        assert_eq!(absorbing_nodes(&slab(10), &slab(10), 500), 48);
        let columns = Columns::<f32>::new([&slab(10), &slab(10)], 500, 1);
        assert_eq!([columns.place(1), columns.place(16), columns.place(17)], [Some(1), Some(16), None]);
        assert_eq!([columns.place(480), columns.place(481), columns.place(500)], [None, Some(17), Some(36)]);
        let Ends { low, high, place_high, .. } = columns.ends(1, 32);
        assert_eq!((low, high, place_high), (1, 30, 1));
        assert_eq!(columns.ends(31, 1).place(0), Some(1));
        assert_eq!(columns.ends(32, 1).place(0), Some(2));
        assert_eq!(columns.ends(2, 29).plain(29), 0..29);
        // Both ends within one chunk share it; no absorbing cells, no chunks.
        assert_eq!(chunks(&slab(3), &slab(4), 9), (1, 2));
        assert_eq!((chunks(&slab(0), &slab(0), 9), absorbing_nodes(&slab(0), &slab(0), 9)), ((0, 2), 0));
        let both = Columns::<f64>::new([&slab(3), &slab(4)], 9, 1);
        let ra = |j: usize| both.e.profile[0][0][j - 1];
        assert!(
            ra(1) < 0.0 && ra(2) < 0.0 && ra(3) == 0.0 && ra(5) == 0.0 && ra(6) < 0.0 && ra(9) < 0.0 && ra(10) == 0.0
        );
    }
}
