//! The Yee scheme, TMz, on one chunk; see [`layout`](super::super::layout) for where the arrays live and how H is scaled.
//!
//! `along_x` and `along_y` are the differences that make the curl, of either order.

use std::ops::Range;

use super::super::lanes::{Chunk, Lanes};
use super::super::real::Real;
use super::absorb::{Across, Along};

/// A chunk that does not absorb.
pub const NONE: u8 = 0;
/// A chunk that absorbs along y and not across x.
pub const ALONG: u8 = 1;
/// A chunk that may absorb either way.
pub const ANY: u8 = 2;

/// H of a span of a row, and what absorbs it.
pub struct RowOfH<'a, T> {
    /// One chunk per chunk of the span.
    pub hx: &'a mut [Chunk<T>],
    /// One chunk per chunk of the span.
    pub hy: &'a mut [Chunk<T>],
    /// In the absorbing cells at an end of x.
    pub across: Option<Across<'a, T>>,
    /// The absorbing cells at the ends of y.
    pub along: Along<'a, T>,
}

impl<T: Real> RowOfH<'_, T> {
    /// The chunks of a span of `count` whose H does not absorb.
    pub fn plain(&self, count: usize) -> Range<usize> {
        if self.across.is_some() { count..count } else { self.along.ends.plain(count) }
    }

    /// One H step of chunk `i`: `Hx -= dy Ez`, `Hy += dx Ez`, both scaled. `ABSORBING`: [`NONE`], [`ALONG`] or [`ANY`].
    #[inline(always)]
    pub fn step<C: Lanes<T>, const ABSORBING: u8>(&mut self, i: usize, along_x: C, along_y: C) -> [C; 2] {
        let mut hx = C::load(&self.hx[i]) - along_y;
        let mut hy = C::load(&self.hy[i]) + along_x;
        if ABSORBING == ANY
            && let Some(across) = &mut self.across
        {
            hy = hy + across.gain(i, along_x);
        }
        if ABSORBING != NONE
            && let Some(gain) = self.along.gain(i, along_y)
        {
            hx = hx - gain;
        }
        hx.store(&mut self.hx[i]);
        hy.store(&mut self.hy[i]);
        [hx, hy]
    }
}

/// What steps E of a span of a row, one chunk per chunk of the span.
pub struct RowOfE<'a, T> {
    /// `dt²/(mu0 dx² EA)`, `EA = eps/dt + sigma/2`; zero holds the walls and perfect conductors.
    pub cb: &'a [Chunk<T>],
    /// `(eps/dt - sigma/2)/(eps/dt + sigma/2)`; `None` where nothing conducts.
    pub ca: Option<&'a [Chunk<T>]>,
    /// `dx²/dy²`
    pub ratio: T,
    /// In the absorbing cells at an end of x.
    pub across: Option<Across<'a, T>>,
    /// The absorbing cells at the ends of y.
    pub along: Along<'a, T>,
}

impl<T: Real> RowOfE<'_, T> {
    /// The chunks of a span of `count` whose E does not absorb.
    pub fn plain(&self, count: usize) -> Range<usize> {
        if self.across.is_some() { count..count } else { self.along.ends.plain(count) }
    }

    /// One E step of chunk `i`: `ca Ez + cb [dx Hy - ratio dy Hx]`. `ABSORBING`: [`NONE`], [`ALONG`] or [`ANY`]; `LOSSY`: there is a `ca`.
    #[inline(always)]
    pub fn step<C: Lanes<T>, const ABSORBING: u8, const LOSSY: bool>(
        &mut self,
        i: usize,
        ez: C,
        along_x: C,
        along_y: C,
    ) -> C {
        let (cb, ratio) = (C::load(&self.cb[i]), C::all(self.ratio));
        let mut ez = match self.ca {
            Some(ca) if LOSSY => C::load(&ca[i]) * ez,
            _ => ez,
        };
        ez = ez + cb * (along_x - ratio * along_y);
        if ABSORBING == ANY
            && let Some(across) = &mut self.across
        {
            ez = ez + cb * across.gain(i, along_x);
        }
        if ABSORBING != NONE
            && let Some(gain) = self.along.gain(i, along_y)
        {
            ez = ez - cb * (ratio * gain);
        }
        ez
    }
}
