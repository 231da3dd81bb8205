//! The absorbing boundary: first-order HORIPML as corrections added to a row after its plain step.
//!
//! With `d` the difference of the plain step, the field gains `coefficient [(RA - 1) d + RB phi]`, then
//! `phi <- RE phi - RF d` (Giannopoulos 2012, "Unsplit implementation of higher order PMLs", IEEE Trans. Antennas Propag.,
//! doi:10.1109/TAP.2011.2180344, first order).

use super::super::real::Real;
use super::difference::Difference;

/// The four coefficients of a row that lies within the absorbing cells at an end of x.
#[derive(Debug, Clone, Copy)]
pub struct RowProfile<T> {
    /// `RA - 1`
    pub ra_less_one: T,
    /// `RB`
    pub rb: T,
    /// `RE`
    pub re: T,
    /// `RF`
    pub rf: T,
}

/// The four coefficients at the nodes of a row that lie within the absorbing cells at an end of y.
#[derive(Debug, Clone, Copy)]
pub struct ColumnProfile<'a, T> {
    /// `RA - 1`
    pub ra_less_one: &'a [T],
    /// `RB`
    pub rb: &'a [T],
    /// `RE`
    pub re: &'a [T],
    /// `RF`
    pub rf: &'a [T],
}

/// Corrects Hy of a row by the difference of Ez along x.
#[inline(always)]
pub fn absorb_row_h<T: Real, D: Difference<T>>(hy: &mut [T], along_x: D, phi: &mut [T], p: RowProfile<T>) {
    let n = hy.len();
    let (along_x, phi) = (along_x.part(0, n), &mut phi[..n]);
    for j in 0..n {
        let d = along_x.at(j);
        hy[j] = hy[j] + (p.ra_less_one * d + p.rb * phi[j]);
        phi[j] = p.re * phi[j] - p.rf * d;
    }
}

/// Corrects Ez of a row by the difference of Hy along x.
#[inline(always)]
pub fn absorb_row_e<T: Real, D: Difference<T>>(ez: &mut [T], cb: &[T], along_x: D, phi: &mut [T], p: RowProfile<T>) {
    let n = ez.len();
    let (cb, along_x, phi) = (&cb[..n], along_x.part(0, n), &mut phi[..n]);
    for j in 0..n {
        let d = along_x.at(j);
        ez[j] = ez[j] + cb[j] * (p.ra_less_one * d + p.rb * phi[j]);
        phi[j] = p.re * phi[j] - p.rf * d;
    }
}

/// Corrects Hx at one end of a row by the difference of Ez along y.
#[inline(always)]
pub fn absorb_columns_h<T: Real, D: Difference<T>>(hx: &mut [T], along_y: D, phi: &mut [T], p: ColumnProfile<'_, T>) {
    let n = hx.len();
    let (along_y, phi) = (along_y.part(0, n), &mut phi[..n]);
    let (ra_less_one, rb, re, rf) = (&p.ra_less_one[..n], &p.rb[..n], &p.re[..n], &p.rf[..n]);
    for j in 0..n {
        let d = along_y.at(j);
        hx[j] = hx[j] - (ra_less_one[j] * d + rb[j] * phi[j]);
        phi[j] = re[j] * phi[j] - rf[j] * d;
    }
}

/// Corrects Ez at one end of a row by the difference of Hx along y; `ratio = dx²/dy²` as in the plain step.
#[inline(always)]
pub fn absorb_columns_e<T: Real, D: Difference<T>>(
    ez: &mut [T],
    cb: &[T],
    ratio: T,
    along_y: D,
    phi: &mut [T],
    p: ColumnProfile<'_, T>,
) {
    let n = ez.len();
    let (cb, along_y, phi) = (&cb[..n], along_y.part(0, n), &mut phi[..n]);
    let (ra_less_one, rb, re, rf) = (&p.ra_less_one[..n], &p.rb[..n], &p.re[..n], &p.rf[..n]);
    for j in 0..n {
        let d = along_y.at(j);
        ez[j] = ez[j] - cb[j] * (ratio * (ra_less_one[j] * d + rb[j] * phi[j]));
        phi[j] = re[j] * phi[j] - rf[j] * d;
    }
}
