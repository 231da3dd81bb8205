//! The vector instructions of x86-64: SSE2, AVX2 and AVX-512. One of the two places in three dimensions with `unsafe`.
//!
//! Intrinsics are called within functions that are compiled without them, and inlined into `run`, which is compiled with
//! them.

use std::arch::x86_64::*;

use super::sheet::LANES;
use super::vector::{Kernel, Number, Set, TABLE};

/// 128 bits: every machine has them.
#[derive(Debug, Clone, Copy)]
pub struct Sse2;

/// 256 bits: the machine has AVX2.
#[derive(Debug, Clone, Copy)]
pub struct Avx2(());

/// 512 bits: the machine has AVX-512F and VL.
#[derive(Debug, Clone, Copy)]
pub struct Avx512(());

impl Number for f32 {
    type Any = Sse2;
    type Avx2 = Avx2;
    type Avx512 = Avx512;

    #[inline(always)]
    fn any() -> Sse2 {
        Sse2
    }
    #[inline(always)]
    unsafe fn avx2() -> Avx2 {
        Avx2(())
    }
    #[inline(always)]
    unsafe fn avx512() -> Avx512 {
        Avx512(())
    }
}

impl Number for f64 {
    type Any = Sse2;
    type Avx2 = Avx2;
    type Avx512 = Avx512;

    #[inline(always)]
    fn any() -> Sse2 {
        Sse2
    }
    #[inline(always)]
    unsafe fn avx2() -> Avx2 {
        Avx2(())
    }
    #[inline(always)]
    unsafe fn avx512() -> Avx512 {
        Avx512(())
    }
}

/// The operations that look the same in all of them: each on every register of a vector.
macro_rules! arithmetic {
    ($set:ty, $features:literal, $number:ty, $registers:literal of $lanes:literal, $splat:ident, $load:ident, $store:ident, $add:ident, $sub:ident, $mul:ident) => {
        #[inline(always)]
        fn splat(self, value: $number) -> Self::Vector {
            // SAFETY: a value of this type shows that the machine has the instruction.
            [unsafe { $splat(value) }; $registers]
        }
        #[inline(always)]
        fn load(self, from: &[$number; LANES]) -> Self::Vector {
            let mut vector = Set::<$number>::splat(self, 0.0);
            for (part, register) in vector.iter_mut().enumerate() {
                // SAFETY: as above, and the parts together are the array.
                *register = unsafe { $load(from.as_ptr().add(part * $lanes)) };
            }
            vector
        }
        #[inline(always)]
        fn store(self, vector: Self::Vector, to: &mut [$number; LANES]) {
            for part in 0..$registers {
                // SAFETY: as above, and the parts together are the array.
                unsafe { $store(to.as_mut_ptr().add(part * $lanes), vector[part]) };
            }
        }
        #[inline(always)]
        fn add(self, mut a: Self::Vector, b: Self::Vector) -> Self::Vector {
            for part in 0..$registers {
                // SAFETY: as above.
                a[part] = unsafe { $add(a[part], b[part]) };
            }
            a
        }
        #[inline(always)]
        fn sub(self, mut a: Self::Vector, b: Self::Vector) -> Self::Vector {
            for part in 0..$registers {
                // SAFETY: as above.
                a[part] = unsafe { $sub(a[part], b[part]) };
            }
            a
        }
        #[inline(always)]
        fn mul(self, mut a: Self::Vector, b: Self::Vector) -> Self::Vector {
            for part in 0..$registers {
                // SAFETY: as above.
                a[part] = unsafe { $mul(a[part], b[part]) };
            }
            a
        }
        #[inline(always)]
        fn run<K: Kernel<$number>>(self, kernel: K) {
            #[target_feature(enable = $features)]
            fn widened<K: Kernel<$number>>(set: $set, kernel: K) {
                kernel.run(set);
            }
            // SAFETY: as above.
            unsafe { widened(self, kernel) }
        }
    };
}

impl Set<f32> for Avx512 {
    type Vector = [__m512; 1];
    type Table = [__m512; 2];

    arithmetic!(Avx512, "avx512f,avx512vl", f32, 1 of 16, _mm512_set1_ps, _mm512_loadu_ps, _mm512_storeu_ps, _mm512_add_ps, _mm512_sub_ps, _mm512_mul_ps);

    #[inline(always)]
    fn table(self, from: &[f32; TABLE]) -> Self::Table {
        // SAFETY: a value of this type shows that the machine has the instruction, and both halves lie within the table.
        unsafe { [_mm512_loadu_ps(from.as_ptr()), _mm512_loadu_ps(from.as_ptr().add(16))] }
    }
    #[inline(always)]
    fn look_up(self, &[low, high]: &Self::Table, index: &[u8; LANES]) -> Self::Vector {
        // SAFETY: as above, and there are sixteen indices.
        unsafe {
            let index = _mm512_cvtepu8_epi32(_mm_loadu_si128(index.as_ptr().cast()));
            [_mm512_permutex2var_ps(low, index, high)]
        }
    }
}

impl Set<f64> for Avx512 {
    type Vector = [__m512d; 2];
    type Table = [__m512d; 4];

    arithmetic!(Avx512, "avx512f,avx512vl", f64, 2 of 8, _mm512_set1_pd, _mm512_loadu_pd, _mm512_storeu_pd, _mm512_add_pd, _mm512_sub_pd, _mm512_mul_pd);

    #[inline(always)]
    fn table(self, from: &[f64; TABLE]) -> Self::Table {
        let mut table = [Set::<f64>::splat(self, 0.0)[0]; 4];
        for (part, register) in table.iter_mut().enumerate() {
            // SAFETY: a value of this type shows that the machine has the instruction; four quarters are the table.
            *register = unsafe { _mm512_loadu_pd(from.as_ptr().add(8 * part)) };
        }
        table
    }
    #[inline(always)]
    fn look_up(self, &[a, b, c, d]: &Self::Table, index: &[u8; LANES]) -> Self::Vector {
        let mut found = Set::<f64>::splat(self, 0.0);
        for (part, register) in found.iter_mut().enumerate() {
            // SAFETY: as above, and there are twice eight indices.
            *register = unsafe {
                let index = _mm512_cvtepu8_epi64(_mm_loadl_epi64(index.as_ptr().add(8 * part).cast()));
                let upper = _mm512_test_epi64_mask(index, _mm512_set1_epi64(16));
                let (low, high) = (_mm512_permutex2var_pd(a, index, b), _mm512_permutex2var_pd(c, index, d));
                _mm512_mask_blend_pd(upper, low, high)
            };
        }
        found
    }
}

impl Set<f32> for Avx2 {
    type Vector = [__m256; 2];
    type Table = [__m256; 4];

    arithmetic!(Avx2, "avx2", f32, 2 of 8, _mm256_set1_ps, _mm256_loadu_ps, _mm256_storeu_ps, _mm256_add_ps, _mm256_sub_ps, _mm256_mul_ps);

    #[inline(always)]
    fn table(self, from: &[f32; TABLE]) -> Self::Table {
        let mut table = [Set::<f32>::splat(self, 0.0)[0]; 4];
        for (part, register) in table.iter_mut().enumerate() {
            // SAFETY: a value of this type shows that the machine has the instruction; four quarters are the table.
            *register = unsafe { _mm256_loadu_ps(from.as_ptr().add(8 * part)) };
        }
        table
    }
    #[inline(always)]
    fn look_up(self, &[a, b, c, d]: &Self::Table, index: &[u8; LANES]) -> Self::Vector {
        let mut found = Set::<f32>::splat(self, 0.0);
        for (part, register) in found.iter_mut().enumerate() {
            // SAFETY: as above, and there are twice eight indices.
            *register = unsafe {
                let index = _mm256_cvtepu8_epi32(_mm_loadl_epi64(index.as_ptr().add(8 * part).cast()));
                // The fourth and the fifth bit of the index, moved to the sign, choose the quarter.
                let odd = _mm256_castsi256_ps(_mm256_slli_epi32::<28>(index));
                let upper = _mm256_castsi256_ps(_mm256_slli_epi32::<27>(index));
                let low = _mm256_blendv_ps(_mm256_permutevar8x32_ps(a, index), _mm256_permutevar8x32_ps(b, index), odd);
                let high =
                    _mm256_blendv_ps(_mm256_permutevar8x32_ps(c, index), _mm256_permutevar8x32_ps(d, index), odd);
                _mm256_blendv_ps(low, high, upper)
            };
        }
        found
    }
}

/// Looks up one by one.
macro_rules! plain_table {
    ($number:ty) => {
        #[inline(always)]
        fn table(self, from: &[$number; TABLE]) -> Self::Table {
            *from
        }
        #[inline(always)]
        fn look_up(self, table: &Self::Table, index: &[u8; LANES]) -> Self::Vector {
            let mut found = [0.0; LANES];
            for lane in 0..LANES {
                found[lane] = table[usize::from(index[lane]) % TABLE];
            }
            self.load(&found)
        }
    };
}

impl Set<f64> for Avx2 {
    type Vector = [__m256d; 4];
    type Table = [f64; TABLE];

    arithmetic!(Avx2, "avx2", f64, 4 of 4, _mm256_set1_pd, _mm256_loadu_pd, _mm256_storeu_pd, _mm256_add_pd, _mm256_sub_pd, _mm256_mul_pd);

    plain_table!(f64);
}

impl Set<f32> for Sse2 {
    type Vector = [__m128; 4];
    type Table = [f32; TABLE];

    arithmetic!(Sse2, "sse2", f32, 4 of 4, _mm_set1_ps, _mm_loadu_ps, _mm_storeu_ps, _mm_add_ps, _mm_sub_ps, _mm_mul_ps);
    plain_table!(f32);
}

impl Set<f64> for Sse2 {
    type Vector = [__m128d; 8];
    type Table = [f64; TABLE];

    arithmetic!(Sse2, "sse2", f64, 8 of 2, _mm_set1_pd, _mm_loadu_pd, _mm_storeu_pd, _mm_add_pd, _mm_sub_pd, _mm_mul_pd);
    plain_table!(f64);
}

#[cfg(test)]
mod tests {
    use super::super::vector::Plain;
    use super::*;

    fn same<T: Number + std::fmt::Debug, S: Set<T>>(set: S) {
        let table: [T; TABLE] = std::array::from_fn(|entry| T::of(1.0 / (entry as f64 + 0.3)));
        for shift in 0..TABLE {
            let index: [u8; LANES] = std::array::from_fn(|lane| ((lane * 7 + shift) % TABLE) as u8);
            let mut out = [[T::default(); LANES]; 2];
            let (a, b) = (set.look_up(&set.table(&table), &index), set.splat(T::of(0.1)));
            set.store(set.sub(set.mul(a, b), set.add(set.load(&table.as_chunks().0[1]), b)), &mut out[0]);
            let (a, b) = (Plain.look_up(&Plain.table(&table), &index), Plain.splat(T::of(0.1)));
            Plain.store(Plain.sub(Plain.mul(a, b), Plain.add(Plain.load(&table.as_chunks().0[1]), b)), &mut out[1]);
            assert_eq!(out[0], out[1], "{index:?}");
        }
    }

    /// Every set computes and looks up what plain numbers give.
    #[test]
    fn every_set_gives_the_same() {
        same::<f32, _>(Sse2);
        same::<f64, _>(Sse2);
        if is_x86_feature_detected!("avx2") {
            let set = Avx2(());
            same::<f32, _>(set);
            same::<f64, _>(set);
        }
        if is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl") {
            let set = Avx512(());
            same::<f32, _>(set);
            same::<f64, _>(set);
        }
    }
}
