//! Differences of fourth order on one row, and what takes them.

use super::super::super::real::Real;
use super::absorb::{ColumnProfile, RowProfile};

/// `9/8 (f₁ - f₀) - 1/24 (f₂ - f₋₁)` at each node of a row, from the values before and behind it.
#[inline(always)]
pub fn difference<T: Real>(out: &mut [T], [before, low, high, behind]: [&[T]; 4]) {
    let n = out.len();
    let (before, low, high, behind) = (&before[..n], &low[..n], &high[..n], &behind[..n]);
    let (near, far) = (T::of(9.0 / 8.0), T::of(1.0 / 24.0));
    for k in 0..n {
        out[k] = near * (high[k] - low[k]) - far * (behind[k] - before[k]);
    }
}

/// `H += a - b`.
#[inline(always)]
pub fn take_h<T: Real>(h: &mut [T], a: &[T], b: &[T]) {
    let n = h.len();
    let (a, b) = (&a[..n], &b[..n]);
    for k in 0..n {
        h[k] = h[k] + (a[k] - b[k]);
    }
}

/// `E = ca E + cb (a - ratio b)`; `cb = 0` holds conductors and walls.
#[inline(always)]
pub fn take_e<T: Real>(e: &mut [T], [ca, cb]: [&[T]; 2], ratio: T, a: &[T], b: &[T]) {
    let n = e.len();
    let (ca, cb, a, b) = (&ca[..n], &cb[..n], &a[..n], &b[..n]);
    for k in 0..n {
        e[k] = ca[k] * e[k] + cb[k] * (a[k] - ratio * b[k]);
    }
}

/// Corrects a row within the absorbing cells at an end of x or y by its difference `d`, which stands with `factor` in the
/// curl; `scale` is `cb` for E, ones for H.
#[inline(always)]
pub fn absorb_row_by<T: Real>(field: &mut [T], scale: &[T], (factor, d): (T, &[T]), phi: &mut [T], p: RowProfile<T>) {
    let n = field.len();
    let (scale, d, phi) = (&scale[..n], &d[..n], &mut phi[..n]);
    for k in 0..n {
        field[k] = field[k] + scale[k] * (factor * (p.ra_less_one * d[k] + p.rb * phi[k]));
        phi[k] = p.re * phi[k] - p.rf * d[k];
    }
}

/// The same along z.
#[inline(always)]
pub fn absorb_columns_by<T: Real>(
    field: &mut [T],
    scale: &[T],
    (factor, d): (T, &[T]),
    phi: &mut [T],
    p: ColumnProfile<'_, T>,
) {
    let n = field.len();
    let (scale, d, phi) = (&scale[..n], &d[..n], &mut phi[..n]);
    let (ra_less_one, rb, re, rf) = (&p.ra_less_one[..n], &p.rb[..n], &p.re[..n], &p.rf[..n]);
    for k in 0..n {
        field[k] = field[k] + scale[k] * (factor * (ra_less_one[k] * d[k] + rb[k] * phi[k]));
        phi[k] = re[k] * phi[k] - rf[k] * d[k];
    }
}
