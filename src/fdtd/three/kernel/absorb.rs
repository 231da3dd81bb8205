//! The absorbing boundary: HORIPML or MRIPML as corrections added to a row after its plain step.
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

/// The nine coefficients of a row in second order: with `d` the difference, the field gains
/// `scale (add0 d + add1 phi1 + add2 phi2)`, then each `phi <- next0 phi1 + next1 phi2 + next2 d`.
#[derive(Debug, Clone, Copy)]
pub struct RowFilter<T> {
    /// Factors of `d`, `phi1`, `phi2`, with the sign of the difference.
    pub add: [T; 3],
    /// Factors of `phi1`, `phi2`, `d` for the new `phi1` and `phi2`.
    pub next: [[T; 3]; 2],
}

/// The nine coefficients at the nodes of a row that lie within the absorbing cells at an end of z, as in [`RowFilter`].
#[derive(Debug, Clone, Copy)]
pub struct ColumnFilter<'a, T> {
    /// Factors of `d`, `phi1`, `phi2`, with the sign of the difference.
    pub add: [&'a [T]; 3],
    /// Factors of `phi1`, `phi2`, `d` for the new `phi1` and `phi2`.
    pub next: [[&'a [T]; 3]; 2],
}

/// Corrects a row in second order.
#[inline(always)]
pub fn absorb_row_twice<T: Real>(
    field: &mut [T],
    scale: &[T],
    [a, b]: [&[T]; 2],
    [phi1, phi2]: [&mut [T]; 2],
    p: RowFilter<T>,
) {
    let n = field.len();
    let (scale, a, b, phi1, phi2) = (&scale[..n], &a[..n], &b[..n], &mut phi1[..n], &mut phi2[..n]);
    let RowFilter { add: [x, y, z], next: [[p1, q1, r1], [p2, q2, r2]] } = p;
    for k in 0..n {
        let (d, one, two) = (b[k] - a[k], phi1[k], phi2[k]);
        field[k] = field[k] + scale[k] * (x * d + y * one + z * two);
        phi1[k] = p1 * one + q1 * two + r1 * d;
        phi2[k] = p2 * one + q2 * two + r2 * d;
    }
}

/// Corrects one end of a row in second order.
#[inline(always)]
pub fn absorb_columns_twice<T: Real>(
    field: &mut [T],
    scale: &[T],
    [a, b]: [&[T]; 2],
    [phi1, phi2]: [&mut [T]; 2],
    p: ColumnFilter<'_, T>,
) {
    let n = field.len();
    let (scale, a, b, phi1, phi2) = (&scale[..n], &a[..n], &b[..n], &mut phi1[..n], &mut phi2[..n]);
    let [x, y, z] = p.add.map(|part| &part[..n]);
    let [[p1, q1, r1], [p2, q2, r2]] = p.next.map(|row| row.map(|part| &part[..n]));
    for k in 0..n {
        let (d, one, two) = (b[k] - a[k], phi1[k], phi2[k]);
        field[k] = field[k] + scale[k] * (x[k] * d + y[k] * one + z[k] * two);
        phi1[k] = p1[k] * one + q1[k] * two + r1[k] * d;
        phi2[k] = p2[k] * one + q2[k] * two + r2[k] * d;
    }
}
