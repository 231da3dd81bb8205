//! The absorbing boundary: first-order HORIPML as corrections added to a row after its plain step.
//!
//! With `d` the difference of the plain step, the field gains `coefficient [(RA - 1) d + RB phi]`, then
//! `phi <- RE phi - RF d` (Giannopoulos 2012, "Unsplit implementation of higher order PMLs", IEEE Trans. Antennas Propag.,
//! doi:10.1109/TAP.2011.2180344, first order).

use super::super::real::Real;

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

/// Corrects Hy of a row: `d = Ez_{i+1} - Ez_i`.
#[inline(always)]
pub fn absorb_row_h<T: Real>(hy: &mut [T], ez: &[T], ez_east: &[T], phi: &mut [T], p: RowProfile<T>) {
    let n = hy.len();
    let (ez, ez_east, phi) = (&ez[..n], &ez_east[..n], &mut phi[..n]);
    for j in 0..n {
        let d = ez_east[j] - ez[j];
        hy[j] = hy[j] + (p.ra_less_one * d + p.rb * phi[j]);
        phi[j] = p.re * phi[j] - p.rf * d;
    }
}

/// Corrects Ez of a row: `d = Hy_i - Hy_{i-1}`.
#[inline(always)]
pub fn absorb_row_e<T: Real>(ez: &mut [T], cb: &[T], hy: &[T], hy_west: &[T], phi: &mut [T], p: RowProfile<T>) {
    let n = ez.len();
    let (cb, hy, hy_west, phi) = (&cb[..n], &hy[..n], &hy_west[..n], &mut phi[..n]);
    for j in 0..n {
        let d = hy[j] - hy_west[j];
        ez[j] = ez[j] + cb[j] * (p.ra_less_one * d + p.rb * phi[j]);
        phi[j] = p.re * phi[j] - p.rf * d;
    }
}

/// Corrects Hx at one end of a row: `d = Ez_j - Ez_{j-1}`.
#[inline(always)]
pub fn absorb_columns_h<T: Real>(hx: &mut [T], ez: &[T], ez_south: &[T], phi: &mut [T], p: ColumnProfile<'_, T>) {
    let n = hx.len();
    let (ez, ez_south, phi) = (&ez[..n], &ez_south[..n], &mut phi[..n]);
    let (ra_less_one, rb, re, rf) = (&p.ra_less_one[..n], &p.rb[..n], &p.re[..n], &p.rf[..n]);
    for j in 0..n {
        let d = ez[j] - ez_south[j];
        hx[j] = hx[j] - (ra_less_one[j] * d + rb[j] * phi[j]);
        phi[j] = re[j] * phi[j] - rf[j] * d;
    }
}

/// Corrects Ez at one end of a row: `d = Hx_j - Hx_{j-1}`; `ratio = dx²/dy²` as in the plain step.
#[inline(always)]
pub fn absorb_columns_e<T: Real>(
    ez: &mut [T],
    cb: &[T],
    ratio: T,
    hx: &[T],
    hx_north: &[T],
    phi: &mut [T],
    p: ColumnProfile<'_, T>,
) {
    let n = ez.len();
    let (cb, hx, hx_north, phi) = (&cb[..n], &hx[..n], &hx_north[..n], &mut phi[..n]);
    let (ra_less_one, rb, re, rf) = (&p.ra_less_one[..n], &p.rb[..n], &p.re[..n], &p.rf[..n]);
    for j in 0..n {
        let d = hx_north[j] - hx[j];
        ez[j] = ez[j] - cb[j] * (ratio * (ra_less_one[j] * d + rb[j] * phi[j]));
        phi[j] = re[j] * phi[j] - rf[j] * d;
    }
}
