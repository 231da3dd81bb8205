//! A step of a span of a row with differences of second order: `f₁ - f₀`.
//!
//! E follows H one chunk behind, so that H is still in the registers when E takes it.

use std::ops::Range;

use super::super::lanes::{Chunk, Lanes};
use super::super::real::Real;
use super::update::{ALONG, ANY, NONE, RowOfE, RowOfH};

/// A span of a row.
pub struct SecondRow<'a, T> {
    /// H of the row.
    pub h: RowOfH<'a, T>,
    /// What steps its E.
    pub e: RowOfE<'a, T>,
    /// Its E, and the chunk before the span.
    pub ez: &'a mut [Chunk<T>],
    /// Hx at the first node behind the span.
    pub beyond: T,
    /// E of the next row.
    pub east: &'a [Chunk<T>],
    /// Hy of the row before.
    pub west: &'a [Chunk<T>],
}

/// A chunk whose H has been stepped and whose E has not.
#[derive(Clone, Copy)]
struct Between<C> {
    ez: C,
    hx: C,
    hy: C,
}

impl<T: Real> SecondRow<'_, T> {
    /// Steps H and E.
    #[inline(always)]
    pub fn step<C: Lanes<T>>(mut self) {
        let count = self.cut();
        if self.h.across.is_some() || self.e.across.is_some() {
            let between = self.first::<C, ANY>();
            let between = self.some::<C, ANY, ANY, true>(1..count, between);
            let beyond = C::all(self.beyond);
            self.e_before::<C, ANY, true>(count, between, beyond);
        } else if self.e.ca.is_some() {
            self.step_along::<C, true>(count);
        } else {
            self.step_along::<C, false>(count);
        }
    }

    /// Steps H and E of a row that does not absorb across x: chunks below, those that do not absorb, and chunks above. H of
    /// a chunk is stepped together with E of the chunk before, which may be of the kind before.
    #[inline(always)]
    fn step_along<C: Lanes<T>, const LOSSY: bool>(&mut self, count: usize) {
        let plain = self.h.plain(count);
        let mut between = if plain.start == 0 { self.first::<C, NONE>() } else { self.first::<C, ALONG>() };
        between = self.some::<C, ALONG, ALONG, LOSSY>(1..plain.start, between);
        if (1..count).contains(&plain.start) {
            between = self.some::<C, NONE, ALONG, LOSSY>(plain.start..plain.start + 1, between);
        }
        between = self.some::<C, NONE, NONE, LOSSY>(plain.start + 1..plain.end, between);
        if (1..count).contains(&plain.end) && plain.end > plain.start {
            between = self.some::<C, ALONG, NONE, LOSSY>(plain.end..plain.end + 1, between);
        }
        between = self.some::<C, ALONG, ALONG, LOSSY>(plain.end + 1..count, between);
        let beyond = C::all(self.beyond);
        if plain.end < count || plain.start == count {
            self.e_before::<C, ALONG, LOSSY>(count, between, beyond);
        } else {
            self.e_before::<C, NONE, LOSSY>(count, between, beyond);
        }
    }

    /// Steps H only.
    #[inline(always)]
    pub fn step_h<C: Lanes<T>>(mut self) {
        let count = self.cut();
        let mut between = self.first::<C, ANY>();
        for i in 1..count {
            between = self.h_of::<C, ANY>(i, between.ez);
        }
    }

    /// Tells the compiler how long everything is, in chunks.
    #[inline(always)]
    fn cut(&mut self) -> usize {
        let count = self.east.len();
        self.west = &self.west[..count];
        self.h.hx = &mut std::mem::take(&mut self.h.hx)[..count];
        self.h.hy = &mut std::mem::take(&mut self.h.hy)[..count];
        self.e.cb = &self.e.cb[..count];
        self.e.ca = self.e.ca.map(|ca| &ca[..count]);
        self.ez = &mut std::mem::take(&mut self.ez)[..count + 1];
        count
    }

    #[inline(always)]
    fn first<C: Lanes<T>, const ABSORBING: u8>(&mut self) -> Between<C> {
        let south = C::load(&self.ez[0]);
        self.h_of::<C, ABSORBING>(0, south)
    }

    /// H of some chunks, and E of the ones before, which may absorb in another way.
    #[inline(always)]
    fn some<C: Lanes<T>, const OF_H: u8, const OF_E: u8, const LOSSY: bool>(
        &mut self,
        chunks: Range<usize>,
        mut last: Between<C>,
    ) -> Between<C> {
        for i in chunks {
            let these = self.h_of::<C, OF_H>(i, last.ez);
            self.e_before::<C, OF_E, LOSSY>(i, last, these.hx);
            last = these;
        }
        last
    }

    /// H of chunk `i`; `south`: E of the chunk before.
    #[inline(always)]
    fn h_of<C: Lanes<T>, const ABSORBING: u8>(&mut self, i: usize, south: C) -> Between<C> {
        let (ez, east) = (C::load(&self.ez[i + 1]), C::load(&self.east[i]));
        let [hx, hy] = self.h.step::<C, ABSORBING>(i, east - ez, ez - ez.southern(south));
        Between { ez, hx, hy }
    }

    /// E of the chunk before chunk `i`; `beyond`: Hx of chunk `i`.
    #[inline(always)]
    fn e_before<C: Lanes<T>, const ABSORBING: u8, const LOSSY: bool>(&mut self, i: usize, last: Between<C>, beyond: C) {
        let along_x = last.hy - C::load(&self.west[i - 1]);
        let along_y = last.hx.northern(beyond) - last.hx;
        self.e.step::<C, ABSORBING, LOSSY>(i - 1, last.ez, along_x, along_y).store(&mut self.ez[i]);
    }
}
