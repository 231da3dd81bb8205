//! The absorbing boundary: first-order HORIPML as corrections added to a chunk after its plain step.
//!
//! With `d` the difference of the plain step, the field gains `coefficient [(RA - 1) d + RB phi]`, then
//! `phi <- RE phi - RF d` (Giannopoulos 2012, "Unsplit implementation of higher order PMLs", IEEE Trans. Antennas Propag.,
//! doi:10.1109/TAP.2011.2180344, first order).

use std::ops::Range;

use super::super::lanes::{Chunk, Lanes};
use super::super::real::Real;

/// The four coefficients of a row that lies within the absorbing cells at an end of x.
#[derive(Debug, Clone, Copy)]
pub struct RowProfile<T> {
    /// `RA - 1`
    pub ra_less_one: T,
    /// `RB`
    pub rb: T,
    /// `RE`
    pub re: T,
    /// `RF`
    pub rf: T,
}

/// A row within the absorbing cells at an end of x.
pub struct Across<'a, T> {
    /// The memory of each chunk of the span.
    pub phi: &'a mut [Chunk<T>],
    /// Its coefficients.
    pub profile: RowProfile<T>,
}

impl<T: Real> Across<'_, T> {
    /// What the field of a chunk gains by the difference across it.
    #[inline(always)]
    pub fn gain<C: Lanes<T>>(&mut self, i: usize, d: C) -> C {
        let RowProfile { ra_less_one, rb, re, rf } = self.profile;
        gain(d, &mut self.phi[i], [C::all(ra_less_one), C::all(rb), C::all(re), C::all(rf)])
    }
}

/// The chunks of a span that hold absorbing cells of the ends of y.
pub struct Along<'a, T> {
    /// The memory of the row, one chunk per absorbing chunk of the grid.
    pub phi: &'a mut [Chunk<T>],
    /// `RA - 1`, `RB`, `RE`, `RF` at the nodes of the absorbing chunks.
    pub profile: &'a [[Chunk<T>; 4]],
    /// Which of them are in the span.
    pub ends: Ends,
}

/// Which chunks of a span hold absorbing cells: those below `low`, and those from `high` on.
#[derive(Debug, Clone, Copy)]
pub struct Ends {
    /// Chunks below.
    pub low: usize,
    /// First chunk above.
    pub high: usize,
    /// Place of chunk 0 among the absorbing chunks, if it is one.
    pub place_low: usize,
    /// Place of chunk `high`, if there is one.
    pub place_high: usize,
}

impl Ends {
    /// The chunks of a span of `count` that do not absorb.
    pub fn plain(self, count: usize) -> Range<usize> {
        let (low, high) = (self.low.min(count), self.high.min(count));
        if low < high { low..high } else { count..count }
    }

    /// Place of a chunk among the absorbing ones.
    #[inline(always)]
    pub fn place(self, i: usize) -> Option<usize> {
        if i < self.low {
            Some(self.place_low + i)
        } else {
            i.checked_sub(self.high).map(|above| self.place_high + above)
        }
    }
}

impl<T: Real> Along<'_, T> {
    /// What the field of a chunk gains by the difference along y; `None` for a chunk that does not absorb.
    #[inline(always)]
    pub fn gain<C: Lanes<T>>(&mut self, i: usize, d: C) -> Option<C> {
        let place = self.ends.place(i)?;
        let [ra_less_one, rb, re, rf] = &self.profile[place];
        Some(gain(d, &mut self.phi[place], [C::load(ra_less_one), C::load(rb), C::load(re), C::load(rf)]))
    }
}

/// `(RA - 1) d + RB phi`, and the new `phi`.
#[inline(always)]
fn gain<T: Real, C: Lanes<T>>(d: C, phi: &mut Chunk<T>, [ra_less_one, rb, re, rf]: [C; 4]) -> C {
    let old = C::load(phi);
    (re * old - rf * d).store(phi);
    ra_less_one * d + rb * old
}
