//! The two precisions of the fields.

use std::ops::{Add, Mul, Sub};

use super::lanes::{Lanes, Registers};
use super::state::Numbers;

/// A number that a field may hold: `f32` or `f64`.
pub trait Real:
    Copy + PartialOrd + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Default + Send + Sync + 'static
{
    /// A chunk of nodes with what every machine of this architecture has: SSE2 on x86-64.
    type Basic: Lanes<Self>;
    /// A chunk of nodes with AVX2.
    #[cfg(target_arch = "x86_64")]
    type Avx2: Lanes<Self>;
    /// A chunk of nodes with AVX-512.
    #[cfg(target_arch = "x86_64")]
    type Avx512: Lanes<Self>;

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
    ($($precision:ty: $numbers:ident, $sse2:ident x $four:literal, $avx2:ident x $two:literal, $avx512:ident x $one:literal);+) => {$(
        impl Real for $precision {
            #[cfg(target_arch = "x86_64")]
            type Basic = Registers<std::arch::x86_64::$sse2, $four>;
            #[cfg(not(target_arch = "x86_64"))]
            type Basic = Registers<$precision, 16>;
            #[cfg(target_arch = "x86_64")]
            type Avx2 = Registers<std::arch::x86_64::$avx2, $two>;
            #[cfg(target_arch = "x86_64")]
            type Avx512 = Registers<std::arch::x86_64::$avx512, $one>;

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

real!(f32: Single, __m128 x 4, __m256 x 2, __m512 x 1; f64: Double, __m128d x 8, __m256d x 4, __m512d x 2);
