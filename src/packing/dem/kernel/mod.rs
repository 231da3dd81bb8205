//! The two sweeps of a step: contacts, then grains. They see slices and numbers only.

mod batch;
mod contacts;
mod sweep;
mod walls;

pub use contacts::{ContactSweep, PairSlots, contacts};
pub use sweep::{GrainSlots, GrainSweep, grains};
pub use walls::{WallSlots, WallSweep, walls};

/// What a sweep noticed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Notice {
    /// Greatest square of a speed, m²/s²; infinite where a speed is not a number.
    pub fastest: f64,
    /// The grain (by its turn) of the first speed beyond the limit, or `usize::MAX`.
    pub too_fast: usize,
    /// Deepest overlap over the smaller radius.
    pub deepest: f64,
    /// A grain (by its turn) of that contact.
    pub deepest_grain: usize,
}

impl Notice {
    /// Nothing noticed.
    pub const NONE: Self = Self { fastest: 0.0, too_fast: usize::MAX, deepest: 0.0, deepest_grain: usize::MAX };

    /// Takes over what another sweep noticed; the order in which sweeps are joined does not matter.
    pub fn join(&mut self, other: &Self) {
        self.fastest = self.fastest.max(other.fastest);
        self.too_fast = self.too_fast.min(other.too_fast);
        if (other.deepest, self.deepest_grain) > (self.deepest, other.deepest_grain) {
            (self.deepest, self.deepest_grain) = (other.deepest, other.deepest_grain);
        }
    }

    /// Notes an overlap.
    #[inline(always)]
    pub fn deep(&mut self, share: f64, grain: usize) {
        if share > self.deepest || (share == self.deepest && grain < self.deepest_grain) {
            (self.deepest, self.deepest_grain) = (share, grain);
        }
    }
}
