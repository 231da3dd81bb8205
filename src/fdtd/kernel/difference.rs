//! The difference of a field across one cell, of second or fourth order.

use super::super::real::Real;

/// A difference at each node of a row.
pub trait Difference<T>: Copy {
    /// `count` nodes from node `from` on. A loop over as many nodes then needs no check of bounds.
    fn part(self, from: usize, count: usize) -> Self;
    /// The difference at node `j`.
    fn at(&self, j: usize) -> T;
}

/// `f₁ - f₀`
#[derive(Clone, Copy)]
pub struct Second<'a, T> {
    /// `f₀`
    pub low: &'a [T],
    /// `f₁`
    pub high: &'a [T],
}

impl<T: Real> Difference<T> for Second<'_, T> {
    #[inline(always)]
    fn part(self, from: usize, count: usize) -> Self {
        Self { low: &self.low[from..][..count], high: &self.high[from..][..count] }
    }

    #[inline(always)]
    fn at(&self, j: usize) -> T {
        self.high[j] - self.low[j]
    }
}

/// `9/8 (f₁ - f₀) - 1/24 (f₂ - f₋₁)`
#[derive(Clone, Copy)]
pub struct Fourth<'a, T> {
    /// `f₋₁`
    pub before: &'a [T],
    /// `f₀`
    pub low: &'a [T],
    /// `f₁`
    pub high: &'a [T],
    /// `f₂`
    pub behind: &'a [T],
}

impl<T: Real> Difference<T> for Fourth<'_, T> {
    #[inline(always)]
    fn part(self, from: usize, count: usize) -> Self {
        Self {
            before: &self.before[from..][..count],
            low: &self.low[from..][..count],
            high: &self.high[from..][..count],
            behind: &self.behind[from..][..count],
        }
    }

    #[inline(always)]
    fn at(&self, j: usize) -> T {
        T::of(9.0 / 8.0) * (self.high[j] - self.low[j]) - T::of(1.0 / 24.0) * (self.behind[j] - self.before[j])
    }
}
