//! Sixteen numbers worked on at once: what the kernels are written in, and the plain variant that runs on any machine.
//!
//! Every variant multiplies, adds and subtracts as IEEE 754 has it, one operation at a time, so all give the same bits.

use super::super::real::Real;
use super::sheet::LANES;

/// Most entries of a palette that are looked up, not stored per edge.
pub const TABLE: usize = 32;

/// The vector instructions of a machine; a value of a type shows that the machine has them.
pub trait Set<T>: Copy {
    /// Sixteen numbers.
    type Vector: Copy;
    /// A table to look numbers up in, held in registers where possible.
    type Table: Copy;

    /// The same number sixteen times.
    fn splat(self, value: T) -> Self::Vector;
    /// Reads sixteen numbers.
    fn load(self, from: &[T; LANES]) -> Self::Vector;
    /// Writes sixteen numbers.
    fn store(self, vector: Self::Vector, to: &mut [T; LANES]);
    /// `a + b`
    fn add(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    /// `a - b`
    fn sub(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    /// `a b`
    fn mul(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    /// Reads a table.
    fn table(self, from: &[T; TABLE]) -> Self::Table;
    /// `table[index]`, entries below [`TABLE`].
    fn look_up(self, table: &Self::Table, index: &[u8; LANES]) -> Self::Vector;
    /// Runs a kernel, compiled with these instructions.
    fn run<K: Kernel<T>>(self, kernel: K);
}

/// A loop over some rows, with what it works on.
pub trait Kernel<T> {
    /// Runs the loop.
    fn run<S: Set<T>>(self, set: S);
}

/// A number of the fields, with the vector instructions for it.
pub trait Number: Real {
    /// What every machine of its kind has.
    type Any: Set<Self>;
    /// 256 bits.
    #[cfg(target_arch = "x86_64")]
    type Avx2: Set<Self>;
    /// 512 bits.
    #[cfg(target_arch = "x86_64")]
    type Avx512: Set<Self>;

    /// These need nothing.
    fn any() -> Self::Any;
    /// # Safety
    /// The machine must have AVX2.
    #[cfg(target_arch = "x86_64")]
    unsafe fn avx2() -> <Self as Number>::Avx2;
    /// # Safety
    /// The machine must have AVX-512F and VL.
    #[cfg(target_arch = "x86_64")]
    unsafe fn avx512() -> <Self as Number>::Avx512;
}

/// Number by number, for machines whose vector instructions nobody has written down yet.
#[cfg(any(test, not(target_arch = "x86_64")))]
#[derive(Debug, Clone, Copy)]
pub struct Plain;

#[cfg(any(test, not(target_arch = "x86_64")))]
impl<T: Real> Set<T> for Plain {
    type Vector = [T; LANES];
    type Table = [T; TABLE];

    #[inline(always)]
    fn splat(self, value: T) -> [T; LANES] {
        [value; LANES]
    }
    #[inline(always)]
    fn load(self, from: &[T; LANES]) -> [T; LANES] {
        *from
    }
    #[inline(always)]
    fn store(self, vector: [T; LANES], to: &mut [T; LANES]) {
        *to = vector;
    }
    #[inline(always)]
    fn add(self, mut a: [T; LANES], b: [T; LANES]) -> [T; LANES] {
        for lane in 0..LANES {
            a[lane] = a[lane] + b[lane];
        }
        a
    }
    #[inline(always)]
    fn sub(self, mut a: [T; LANES], b: [T; LANES]) -> [T; LANES] {
        for lane in 0..LANES {
            a[lane] = a[lane] - b[lane];
        }
        a
    }
    #[inline(always)]
    fn mul(self, mut a: [T; LANES], b: [T; LANES]) -> [T; LANES] {
        for lane in 0..LANES {
            a[lane] = a[lane] * b[lane];
        }
        a
    }
    #[inline(always)]
    fn table(self, from: &[T; TABLE]) -> [T; TABLE] {
        *from
    }
    #[inline(always)]
    fn look_up(self, table: &[T; TABLE], index: &[u8; LANES]) -> [T; LANES] {
        let mut found = [T::default(); LANES];
        for lane in 0..LANES {
            found[lane] = table[usize::from(index[lane]) % TABLE];
        }
        found
    }
    #[inline(never)]
    fn run<K: Kernel<T>>(self, kernel: K) {
        kernel.run(self);
    }
}

/// A row as vectors; what is left over at its end is left out.
#[inline(always)]
pub fn vectors<T>(row: &[T], count: usize) -> &[[T; LANES]] {
    &row.as_chunks().0[..count]
}

/// A row as vectors that may be written to; its length is a whole number of them.
#[inline(always)]
pub fn vectors_mut<T>(row: &mut [T]) -> &mut [[T; LANES]] {
    debug_assert_eq!(row.len() % LANES, 0);
    row.as_chunks_mut().0
}

#[cfg(not(target_arch = "x86_64"))]
impl Number for f32 {
    type Any = Plain;

    fn any() -> Plain {
        Plain
    }
}

#[cfg(not(target_arch = "x86_64"))]
impl Number for f64 {
    type Any = Plain;

    fn any() -> Plain {
        Plain
    }
}
