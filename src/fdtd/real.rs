//! The two precisions of the fields.

use std::ops::{Add, Mul, Sub};

use super::state::Numbers;

/// A number that a field may hold: `f32` or `f64`.
pub trait Real:
    Copy + PartialOrd + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Default + Send + Sync + 'static
{
    /// The nearest number of this precision.
    fn of(value: f64) -> Self;
    /// The same number in double precision.
    fn double(self) -> f64;
    /// Whether its magnitude is larger than a limit, or it is not a number.
    fn is_beyond(self, limit: Self) -> bool;
    /// Some of them, as a part of a state.
    fn numbers(some: &mut [Self]) -> Numbers<'_>;
}

macro_rules! real {
    ($($precision:ty: $numbers:ident),+) => {$(
        impl Real for $precision {
            #[inline(always)]
            fn of(value: f64) -> Self {
                value as Self
            }
            #[inline(always)]
            fn double(self) -> f64 {
                f64::from(self)
            }
            #[inline(always)]
            fn is_beyond(self, limit: Self) -> bool {
                self.abs() > limit || self.is_nan()
            }
            fn numbers(some: &mut [Self]) -> Numbers<'_> {
                Numbers::$numbers(some)
            }
        }
    )+};
}

real!(f32: Single, f64: Double);
