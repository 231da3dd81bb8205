//! The Yee scheme, TMz, on one row; see [`layout`](super::super::layout) for where the arrays live and how H is scaled.

use super::super::real::Real;

/// One H step: `Hx -= Ez_j - Ez_{j-1}`, `Hy += Ez_{i+1} - Ez_i`, both scaled.
///
/// Shape: all slices begin at node `j = 1` of row `i`, `ez_south` at `j = 0`, `ez_east` in row `i + 1`; equal lengths.
#[inline(always)]
pub fn update_h<T: Real>(hx: &mut [T], hy: &mut [T], ez: &[T], ez_south: &[T], ez_east: &[T]) {
    let n = ez.len();
    let (hx, hy, ez_south, ez_east) = (&mut hx[..n], &mut hy[..n], &ez_south[..n], &ez_east[..n]);
    for j in 0..n {
        hx[j] = hx[j] - (ez[j] - ez_south[j]);
        hy[j] = hy[j] + (ez_east[j] - ez[j]);
    }
}

/// One E step without conductivity: `Ez += cb [(Hy_i - Hy_{i-1}) - ratio (Hx_j - Hx_{j-1})]`.
///
/// `cb = dt²/(mu0 dx² EA)`, `EA = eps/dt`; `ratio = dx²/dy²`; `cb = 0` holds the walls and perfect conductors.
#[inline(always)]
pub fn update_e<T: Real>(ez: &mut [T], cb: &[T], ratio: T, hx: &[T], hx_north: &[T], hy: &[T], hy_west: &[T]) {
    let n = ez.len();
    let (cb, hx, hx_north, hy, hy_west) = (&cb[..n], &hx[..n], &hx_north[..n], &hy[..n], &hy_west[..n]);
    for j in 0..n {
        let curl = (hy[j] - hy_west[j]) - ratio * (hx_north[j] - hx[j]);
        ez[j] = ez[j] + cb[j] * curl;
    }
}

/// One E step with conductivity: as [`update_e`], with `ca Ez` in place of `Ez`.
///
/// `ca = (eps/dt - sigma/2)/(eps/dt + sigma/2)`.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "one slice per symbol of the equation")]
pub fn update_e_lossy<T: Real>(
    ez: &mut [T],
    ca: &[T],
    cb: &[T],
    ratio: T,
    hx: &[T],
    hx_north: &[T],
    hy: &[T],
    hy_west: &[T],
) {
    let n = ez.len();
    let (ca, cb, hx, hx_north, hy, hy_west) = (&ca[..n], &cb[..n], &hx[..n], &hx_north[..n], &hy[..n], &hy_west[..n]);
    for j in 0..n {
        let curl = (hy[j] - hy_west[j]) - ratio * (hx_north[j] - hx[j]);
        ez[j] = ca[j] * ez[j] + cb[j] * curl;
    }
}
