//! The registers of each instruction set, as chunks of sixteen nodes: beside [`instructions`](super::instructions) the one
//! place of the plane's solver with `unsafe`.
//!
//! Nothing here fuses a multiplication with an addition, so every kind of register gives the same bits.

use std::ops::{Add, Mul, Sub};

use super::layout::LANES;

/// Numbers of sixteen neighbouring nodes.
pub type Chunk<T> = [T; LANES];

/// A chunk in the registers of an instruction set.
pub trait Lanes<T>: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// Reads a chunk.
    fn load(from: &Chunk<T>) -> Self;
    /// Writes a chunk.
    fn store(self, to: &mut Chunk<T>);
    /// The same number at all nodes.
    fn all(value: T) -> Self;
    /// The southern neighbours: the last of `low`, then all but the last of these.
    fn southern(self, low: Self) -> Self;
    /// The northern neighbours: all but the first of these, then the first of `high`.
    fn northern(self, high: Self) -> Self;
}

/// A register. What its methods do is what [`Lanes`] says of a chunk.
pub trait Register: Copy {
    /// What it holds.
    type Number: Copy;
    /// How many of them.
    const WIDTH: usize;
    /// Reads the first `WIDTH` numbers, of which there must be so many.
    fn load(from: &[Self::Number]) -> Self;
    /// Writes the first `WIDTH` numbers, of which there must be so many.
    fn store(self, to: &mut [Self::Number]);
    /// The same number everywhere.
    fn all(value: Self::Number) -> Self;
    /// Sums.
    fn plus(self, other: Self) -> Self;
    /// Differences.
    fn minus(self, other: Self) -> Self;
    /// Products.
    fn times(self, other: Self) -> Self;
    /// As [`Lanes::southern`].
    fn southern(self, low: Self) -> Self;
    /// As [`Lanes::northern`].
    fn northern(self, high: Self) -> Self;
}

/// As many registers as a chunk takes.
#[derive(Debug, Clone, Copy)]
pub struct Registers<R, const COUNT: usize>([R; COUNT]);

macro_rules! each {
    ($operator:ident, $name:ident, $of_register:ident) => {
        impl<R: Register, const COUNT: usize> $operator for Registers<R, COUNT> {
            type Output = Self;
            #[inline(always)]
            fn $name(mut self, other: Self) -> Self {
                let mut k = 0;
                while k < COUNT {
                    self.0[k] = self.0[k].$of_register(other.0[k]);
                    k += 1;
                }
                self
            }
        }
    };
}

each!(Add, add, plus);
each!(Sub, sub, minus);
each!(Mul, mul, times);

impl<R: Register, const COUNT: usize> Lanes<R::Number> for Registers<R, COUNT> {
    #[inline(always)]
    fn load(from: &Chunk<R::Number>) -> Self {
        let mut all = Self([R::load(from); COUNT]);
        let mut k = 1;
        while k < COUNT {
            all.0[k] = R::load(&from[k * R::WIDTH..][..R::WIDTH]);
            k += 1;
        }
        all
    }

    #[inline(always)]
    fn store(self, to: &mut Chunk<R::Number>) {
        let mut k = 0;
        while k < COUNT {
            self.0[k].store(&mut to[k * R::WIDTH..][..R::WIDTH]);
            k += 1;
        }
    }

    #[inline(always)]
    fn all(value: R::Number) -> Self {
        Self([R::all(value); COUNT])
    }

    #[inline(always)]
    fn southern(mut self, low: Self) -> Self {
        let mut k = COUNT - 1;
        while k > 0 {
            self.0[k] = self.0[k].southern(self.0[k - 1]);
            k -= 1;
        }
        self.0[0] = self.0[0].southern(low.0[COUNT - 1]);
        self
    }

    #[inline(always)]
    fn northern(mut self, high: Self) -> Self {
        let mut k = 0;
        while k + 1 < COUNT {
            self.0[k] = self.0[k].northern(self.0[k + 1]);
            k += 1;
        }
        self.0[COUNT - 1] = self.0[COUNT - 1].northern(high.0[0]);
        self
    }
}

#[cfg(not(target_arch = "x86_64"))]
macro_rules! one_number {
    ($number:ty) => {
        impl Register for $number {
            type Number = $number;
            const WIDTH: usize = 1;
            #[inline(always)]
            fn load(from: &[$number]) -> Self {
                from[0]
            }
            #[inline(always)]
            fn store(self, to: &mut [$number]) {
                to[0] = self;
            }
            #[inline(always)]
            fn all(value: $number) -> Self {
                value
            }
            #[inline(always)]
            fn plus(self, other: Self) -> Self {
                self + other
            }
            #[inline(always)]
            fn minus(self, other: Self) -> Self {
                self - other
            }
            #[inline(always)]
            fn times(self, other: Self) -> Self {
                self * other
            }
            #[inline(always)]
            fn southern(self, low: Self) -> Self {
                low
            }
            #[inline(always)]
            fn northern(self, high: Self) -> Self {
                high
            }
        }
    };
}

#[cfg(not(target_arch = "x86_64"))]
one_number!(f32);
#[cfg(not(target_arch = "x86_64"))]
one_number!(f64);

#[cfg(target_arch = "x86_64")]
mod x86_64 {
    use std::arch::x86_64::*;

    use super::Register;

    macro_rules! register {
        ($register:ty: $width:literal x $number:ty, $load:ident, $store:ident, $all:ident, $plus:ident, $minus:ident, $times:ident,
         |$these:ident, $low:ident| $south:expr, |$those:ident, $high:ident| $north:expr) => {
            impl Register for $register {
                type Number = $number;
                const WIDTH: usize = $width;
                #[inline(always)]
                fn load(from: &[$number]) -> Self {
                    let from = &from[..$width];
                    // SAFETY: so many numbers are there; only a sweep of this instruction set uses this register.
                    unsafe { $load(from.as_ptr()) }
                }
                #[inline(always)]
                fn store(self, to: &mut [$number]) {
                    let to = &mut to[..$width];
                    // SAFETY: as in `load`.
                    unsafe { $store(to.as_mut_ptr(), self) }
                }
                #[inline(always)]
                fn all(value: $number) -> Self {
                    // SAFETY: only a sweep of this instruction set uses this register.
                    unsafe { $all(value) }
                }
                #[inline(always)]
                fn plus(self, other: Self) -> Self {
                    // SAFETY: as in `all`.
                    unsafe { $plus(self, other) }
                }
                #[inline(always)]
                fn minus(self, other: Self) -> Self {
                    // SAFETY: as in `all`.
                    unsafe { $minus(self, other) }
                }
                #[inline(always)]
                fn times(self, other: Self) -> Self {
                    // SAFETY: as in `all`.
                    unsafe { $times(self, other) }
                }
                #[inline(always)]
                fn southern(self, low: Self) -> Self {
                    let ($these, $low) = (self, low);
                    // SAFETY: as in `all`.
                    unsafe { $south }
                }
                #[inline(always)]
                fn northern(self, high: Self) -> Self {
                    let ($those, $high) = (self, high);
                    // SAFETY: as in `all`.
                    unsafe { $north }
                }
            }
        };
    }

    register!(__m128: 4 x f32, _mm_loadu_ps, _mm_storeu_ps, _mm_set1_ps, _mm_add_ps, _mm_sub_ps, _mm_mul_ps,
        |these, low| _mm_shuffle_ps::<0b10_01_10_00>(_mm_shuffle_ps::<0b00_00_11_11>(low, these), these),
        |these, high| _mm_shuffle_ps::<0b10_00_10_01>(these, _mm_shuffle_ps::<0b00_00_11_11>(these, high)));

    register!(__m128d: 2 x f64, _mm_loadu_pd, _mm_storeu_pd, _mm_set1_pd, _mm_add_pd, _mm_sub_pd, _mm_mul_pd,
        |these, low| _mm_shuffle_pd::<0b01>(low, these),
        |these, high| _mm_shuffle_pd::<0b01>(these, high));

    register!(__m512: 16 x f32, _mm512_loadu_ps, _mm512_storeu_ps, _mm512_set1_ps, _mm512_add_ps, _mm512_sub_ps, _mm512_mul_ps,
        |these, low| _mm512_castsi512_ps(_mm512_alignr_epi32::<15>(_mm512_castps_si512(these), _mm512_castps_si512(low))),
        |these, high| _mm512_castsi512_ps(_mm512_alignr_epi32::<1>(_mm512_castps_si512(high), _mm512_castps_si512(these))));

    register!(__m512d: 8 x f64, _mm512_loadu_pd, _mm512_storeu_pd, _mm512_set1_pd, _mm512_add_pd, _mm512_sub_pd, _mm512_mul_pd,
        |these, low| _mm512_castsi512_pd(_mm512_alignr_epi64::<7>(_mm512_castpd_si512(these), _mm512_castpd_si512(low))),
        |these, high| _mm512_castsi512_pd(_mm512_alignr_epi64::<1>(_mm512_castpd_si512(high), _mm512_castpd_si512(these))));

    // The upper half of the lower register beside the lower half of the upper one is what each half takes a number from.
    register!(__m256: 8 x f32, _mm256_loadu_ps, _mm256_storeu_ps, _mm256_set1_ps, _mm256_add_ps, _mm256_sub_ps, _mm256_mul_ps,
    |these, low| {
        let middle = _mm256_castps_si256(_mm256_permute2f128_ps::<0x21>(low, these));
        _mm256_castsi256_ps(_mm256_alignr_epi8::<12>(_mm256_castps_si256(these), middle))
    },
    |these, high| {
        let middle = _mm256_castps_si256(_mm256_permute2f128_ps::<0x21>(these, high));
        _mm256_castsi256_ps(_mm256_alignr_epi8::<4>(middle, _mm256_castps_si256(these)))
    });

    register!(__m256d: 4 x f64, _mm256_loadu_pd, _mm256_storeu_pd, _mm256_set1_pd, _mm256_add_pd, _mm256_sub_pd, _mm256_mul_pd,
        |these, low| _mm256_shuffle_pd::<0b0101>(_mm256_permute2f128_pd::<0x21>(low, these), these),
        |these, high| _mm256_shuffle_pd::<0b0101>(these, _mm256_permute2f128_pd::<0x21>(these, high)));
}
