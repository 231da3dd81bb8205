//! Which vector instructions the step of a plane uses: the one place in three dimensions with `unsafe`.
//!
//! A step is compiled once per instruction set and chosen at run time. All variants come from the same source without
//! fused multiplication and addition; only the look-up of coefficients is written out, and it only copies. So every variant
//! gives the same bits.

use super::super::instructions::InstructionSet;
use super::super::real::Real;
use super::plane::{Plane, Scratch, Step};

/// Most entries of a palette that are looked up, not stored per edge.
pub const TABLE: usize = 32;

/// Steps a plane with instructions that this machine was found to have.
pub fn step<T: Number>(set: InstructionSet, step: &Step<'_, T>, plane: &mut Plane<T>, scratch: &mut Scratch<T>) {
    match set {
        // SAFETY: the set comes from `InstructionSet::resolve`, which refuses what the machine does not have.
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx512 => unsafe { step_avx512(step, plane, scratch) },
        // SAFETY: as above.
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx2 => unsafe { step_avx2(step, plane, scratch) },
        _ => step.run(plane, scratch),
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn step_avx2<T: Number>(step: &Step<'_, T>, plane: &mut Plane<T>, scratch: &mut Scratch<T>) {
    step.run(plane, scratch);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl")]
fn step_avx512<T: Number>(step: &Step<'_, T>, plane: &mut Plane<T>, scratch: &mut Scratch<T>) {
    step.run(plane, scratch);
}

/// A number that can be looked up: `out[k] = table[index[k]]`; lengths are whole multiples of 16, entries below 32.
pub trait Number: Real {
    /// Looks up a row; `few`: no entry of 16 or more.
    fn look_up(set: InstructionSet, table: &[Self; TABLE], few: bool, index: &[u8], out: &mut [Self]);
}

#[inline(always)]
fn look_up_plainly<T: Real>(table: &[T; TABLE], index: &[u8], out: &mut [T]) {
    for (out, &index) in out.iter_mut().zip(index) {
        *out = table[usize::from(index) % TABLE];
    }
}

impl Number for f64 {
    #[inline(always)]
    fn look_up(_: InstructionSet, table: &[Self; TABLE], _: bool, index: &[u8], out: &mut [Self]) {
        look_up_plainly(table, index, out);
    }
}

impl Number for f32 {
    #[inline(always)]
    fn look_up(set: InstructionSet, table: &[Self; TABLE], few: bool, index: &[u8], out: &mut [Self]) {
        match set {
            // SAFETY: as in `step`.
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx512 => unsafe { look_up_avx512(table, index, out) },
            // SAFETY: as in `step`.
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx2 if few => unsafe { look_up_avx2(table, index, out) },
            _ => look_up_plainly(table, index, out),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl")]
fn look_up_avx512(table: &[f32; TABLE], index: &[u8], out: &mut [f32]) {
    use std::arch::x86_64::{
        _mm_loadu_si128, _mm512_cvtepu8_epi32, _mm512_loadu_ps, _mm512_permutex2var_ps, _mm512_storeu_ps,
    };
    // SAFETY: both halves lie within the table.
    let (low, high) = unsafe { (_mm512_loadu_ps(table.as_ptr()), _mm512_loadu_ps(table[16..].as_ptr())) };
    for (index, out) in index.chunks_exact(16).zip(out.chunks_exact_mut(16)) {
        // SAFETY: both chunks hold 16 entries.
        unsafe {
            let index = _mm512_cvtepu8_epi32(_mm_loadu_si128(index.as_ptr().cast()));
            _mm512_storeu_ps(out.as_mut_ptr(), _mm512_permutex2var_ps(low, index, high));
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn look_up_avx2(table: &[f32; TABLE], index: &[u8], out: &mut [f32]) {
    use std::arch::x86_64::{
        _mm_loadl_epi64, _mm256_blendv_ps, _mm256_castsi256_ps, _mm256_cvtepu8_epi32, _mm256_loadu_ps,
        _mm256_permutevar8x32_ps, _mm256_slli_epi32, _mm256_storeu_ps,
    };
    // SAFETY: both quarters lie within the table.
    let (low, high) = unsafe { (_mm256_loadu_ps(table.as_ptr()), _mm256_loadu_ps(table[8..].as_ptr())) };
    for (index, out) in index.chunks_exact(8).zip(out.chunks_exact_mut(8)) {
        // SAFETY: both chunks hold 8 entries.
        unsafe {
            let index = _mm256_cvtepu8_epi32(_mm_loadl_epi64(index.as_ptr().cast()));
            // The fourth bit of the index, moved to the sign, chooses the half.
            let upper = _mm256_castsi256_ps(_mm256_slli_epi32::<28>(index));
            let found =
                _mm256_blendv_ps(_mm256_permutevar8x32_ps(low, index), _mm256_permutevar8x32_ps(high, index), upper);
            _mm256_storeu_ps(out.as_mut_ptr(), found);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every way of looking up finds what plain indexing finds.
    #[test]
    fn every_way_of_looking_up_finds_the_same() {
        let table: [f32; TABLE] = std::array::from_fn(|entry| 1.0 / (entry as f32 + 0.3));
        let sets = [InstructionSet::Scalar, InstructionSet::Avx2, InstructionSet::Avx512];
        for set in sets.into_iter().filter(|set| set.resolve().is_ok()) {
            for most in [16, TABLE] {
                let index: Vec<u8> = (0..96).map(|k| (k * 7 % most) as u8).collect();
                let mut out = vec![0.0; 96];
                f32::look_up(set, &table, most == 16, &index, &mut out);
                assert!(out.iter().zip(&index).all(|(&v, &entry)| v == table[usize::from(entry)]), "{}", set.name());
            }
        }
    }
}
