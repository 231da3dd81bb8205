//! A step of a span of a row with differences of fourth order: `9/8 (f₁ - f₀) - 1/24 (f₂ - f₋₁)`.

use std::ops::Range;

use super::super::lanes::{Chunk, Lanes};
use super::super::real::Real;
use super::update::{ANY, NONE, RowOfE, RowOfH};

#[inline(always)]
fn difference<T: Real, C: Lanes<T>>(before: C, low: C, high: C, behind: C) -> C {
    C::all(T::of(9.0 / 8.0)) * (high - low) - C::all(T::of(1.0 / 24.0)) * (behind - before)
}

/// H of a span of a row, and the E that it takes.
pub struct FourthRowOfH<'a, T> {
    /// H of the row.
    pub h: RowOfH<'a, T>,
    /// E of the row, from the chunk before the span to the one behind it.
    pub ez: &'a [Chunk<T>],
    /// E of the rows -1, 1 and 2 places on.
    pub across: [&'a [Chunk<T>]; 3],
}

impl<T: Real> FourthRowOfH<'_, T> {
    /// Steps H.
    #[inline(always)]
    pub fn step<C: Lanes<T>>(mut self) {
        let count = self.h.hy.len();
        let plain = self.h.plain(count);
        self.h.hx = &mut std::mem::take(&mut self.h.hx)[..count];
        self.ez = &self.ez[..count + 2];
        self.across = self.across.map(|row| &row[..count]);
        self.some::<C, ANY>(0..plain.start.min(count));
        self.some::<C, NONE>(plain.clone());
        self.some::<C, ANY>(plain.end..count);
    }

    #[inline(always)]
    fn some<C: Lanes<T>, const ABSORBING: u8>(&mut self, chunks: Range<usize>) {
        let [before, high, behind] = self.across;
        let mut south = C::load(&self.ez[chunks.start]);
        let (mut south_of_south, mut low) = (south.southern(south), C::load(&self.ez[chunks.start + 1]));
        for i in chunks {
            let north = C::load(&self.ez[i + 2]);
            let one_south = low.southern(south);
            let two_south = one_south.southern(south_of_south);
            let along_x = difference(C::load(&before[i]), low, C::load(&high[i]), C::load(&behind[i]));
            let along_y = difference(two_south, one_south, low, low.northern(north));
            self.h.step::<C, ABSORBING>(i, along_x, along_y);
            (south, south_of_south, low) = (low, one_south, north);
        }
    }
}

/// E of a span of a row, and the H that it takes.
pub struct FourthRowOfE<'a, T> {
    /// What steps E.
    pub e: RowOfE<'a, T>,
    /// E of the row.
    pub ez: &'a mut [Chunk<T>],
    /// Hx of the row, from the chunk before the span to the one behind it.
    pub hx: &'a [Chunk<T>],
    /// Hy of the rows -2, -1, 0 and 1 places on.
    pub hy: [&'a [Chunk<T>]; 4],
}

impl<T: Real> FourthRowOfE<'_, T> {
    /// Steps E.
    #[inline(always)]
    pub fn step<C: Lanes<T>>(mut self) {
        let count = self.ez.len();
        self.hx = &self.hx[..count + 2];
        self.hy = self.hy.map(|row| &row[..count]);
        self.e.cb = &self.e.cb[..count];
        self.e.ca = self.e.ca.map(|ca| &ca[..count]);
        let plain = self.e.plain(count);
        self.some::<C, ANY, true>(0..plain.start.min(count));
        if self.e.ca.is_some() {
            self.some::<C, NONE, true>(plain.clone());
        } else {
            self.some::<C, NONE, false>(plain.clone());
        }
        self.some::<C, ANY, true>(plain.end..count);
    }

    #[inline(always)]
    fn some<C: Lanes<T>, const ABSORBING: u8, const LOSSY: bool>(&mut self, chunks: Range<usize>) {
        let [before, low, high, behind] = self.hy;
        let (mut south, mut here) = (C::load(&self.hx[chunks.start]), C::load(&self.hx[chunks.start + 1]));
        for i in chunks {
            let north = C::load(&self.hx[i + 2]);
            let one_north = here.northern(north);
            let two_north = one_north.northern(north.northern(north));
            let along_x = difference(C::load(&before[i]), C::load(&low[i]), C::load(&high[i]), C::load(&behind[i]));
            let along_y = difference(here.southern(south), here, one_north, two_north);
            let ez = C::load(&self.ez[i]);
            self.e.step::<C, ABSORBING, LOSSY>(i, ez, along_x, along_y).store(&mut self.ez[i]);
            (south, here) = (here, north);
        }
    }
}
