//! The absorbing boundary: first-order HORIPML as corrections added to a row after its plain step.
//!
//! With `d = b - a` the difference of the plain step, the field gains `scale [(RA - 1) d + RB phi]`, then
//! `phi <- RE phi - RF d` (Giannopoulos 2012, doi:10.1109/TAP.2011.2180344, first order). The sign of the difference in the
//! curl, and the ratio of non-cubic cells, stand in `RA - 1` and `RB`.

use super::super::super::real::Real;

/// The four coefficients of a row that lies within the absorbing cells at an end of x or y.
#[derive(Debug, Clone, Copy)]
pub struct RowProfile<T> {
    /// `RA - 1`, with the sign of the difference.
    pub ra_less_one: T,
    /// `RB`, with the sign of the difference.
    pub rb: T,
    /// `RE`
    pub re: T,
    /// `RF`
    pub rf: T,
}

/// The four coefficients at the nodes of a row that lie within the absorbing cells at an end of z.
#[derive(Debug, Clone, Copy)]
pub struct ColumnProfile<'a, T> {
    /// `RA - 1`, with the sign of the difference.
    pub ra_less_one: &'a [T],
    /// `RB`, with the sign of the difference.
    pub rb: &'a [T],
    /// `RE`
    pub re: &'a [T],
    /// `RF`
    pub rf: &'a [T],
}

/// Corrects a row of H in a material that is not magnetic.
#[inline(always)]
pub fn absorb_row<T: Real>(field: &mut [T], [a, b]: [&[T]; 2], phi: &mut [T], p: RowProfile<T>) {
    let n = field.len();
    let (a, b, phi) = (&a[..n], &b[..n], &mut phi[..n]);
    for k in 0..n {
        let d = b[k] - a[k];
        field[k] = field[k] + (p.ra_less_one * d + p.rb * phi[k]);
        phi[k] = p.re * phi[k] - p.rf * d;
    }
}

/// Corrects a row of E, or of H in a magnetic material.
#[inline(always)]
pub fn absorb_row_scaled<T: Real>(field: &mut [T], scale: &[T], [a, b]: [&[T]; 2], phi: &mut [T], p: RowProfile<T>) {
    let n = field.len();
    let (scale, a, b, phi) = (&scale[..n], &a[..n], &b[..n], &mut phi[..n]);
    for k in 0..n {
        let d = b[k] - a[k];
        field[k] = field[k] + scale[k] * (p.ra_less_one * d + p.rb * phi[k]);
        phi[k] = p.re * phi[k] - p.rf * d;
    }
}

/// Corrects H at one end of a row, in a material that is not magnetic.
#[inline(always)]
pub fn absorb_columns<T: Real>(field: &mut [T], [a, b]: [&[T]; 2], phi: &mut [T], p: ColumnProfile<'_, T>) {
    let n = field.len();
    let (a, b, phi) = (&a[..n], &b[..n], &mut phi[..n]);
    let (ra_less_one, rb, re, rf) = (&p.ra_less_one[..n], &p.rb[..n], &p.re[..n], &p.rf[..n]);
    for k in 0..n {
        let d = b[k] - a[k];
        field[k] = field[k] + (ra_less_one[k] * d + rb[k] * phi[k]);
        phi[k] = re[k] * phi[k] - rf[k] * d;
    }
}

/// Corrects E at one end of a row, or H in a magnetic material.
#[inline(always)]
pub fn absorb_columns_scaled<T: Real>(
    field: &mut [T],
    scale: &[T],
    [a, b]: [&[T]; 2],
    phi: &mut [T],
    p: ColumnProfile<'_, T>,
) {
    let n = field.len();
    let (scale, a, b, phi) = (&scale[..n], &a[..n], &b[..n], &mut phi[..n]);
    let (ra_less_one, rb, re, rf) = (&p.ra_less_one[..n], &p.rb[..n], &p.re[..n], &p.rf[..n]);
    for k in 0..n {
        let d = b[k] - a[k];
        field[k] = field[k] + scale[k] * (ra_less_one[k] * d + rb[k] * phi[k]);
        phi[k] = re[k] * phi[k] - rf[k] * d;
    }
}
