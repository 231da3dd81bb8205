//! The Yee scheme, TMz, on one row; see [`layout`](super::super::layout) for where the arrays live and how H is scaled.
//!
//! `along_x` and `along_y` are the differences that make the curl, of either order.

use super::super::real::Real;
use super::difference::Difference;

/// One H step: `Hx -= dy Ez`, `Hy += dx Ez`, both scaled.
///
/// Shape: all begin at node `j = 1` of row `i`; equal lengths.
#[inline(always)]
pub fn update_h<T: Real, D: Difference<T>>(hx: &mut [T], hy: &mut [T], along_x: D, along_y: D) {
    let n = hx.len();
    let (hy, along_x, along_y) = (&mut hy[..n], along_x.part(0, n), along_y.part(0, n));
    for j in 0..n {
        hx[j] = hx[j] - along_y.at(j);
        hy[j] = hy[j] + along_x.at(j);
    }
}

/// One E step without conductivity: `Ez += cb [dx Hy - ratio dy Hx]`.
///
/// `cb = dt²/(mu0 dx² EA)`, `EA = eps/dt`; `ratio = dx²/dy²`; `cb = 0` holds the walls and perfect conductors.
#[inline(always)]
pub fn update_e<T: Real, D: Difference<T>>(ez: &mut [T], cb: &[T], ratio: T, along_x: D, along_y: D) {
    let n = ez.len();
    let (cb, along_x, along_y) = (&cb[..n], along_x.part(0, n), along_y.part(0, n));
    for j in 0..n {
        let curl = along_x.at(j) - ratio * along_y.at(j);
        ez[j] = ez[j] + cb[j] * curl;
    }
}

/// One E step with conductivity: as [`update_e`], with `ca Ez` in place of `Ez`.
///
/// `ca = (eps/dt - sigma/2)/(eps/dt + sigma/2)`.
#[inline(always)]
pub fn update_e_lossy<T: Real, D: Difference<T>>(ez: &mut [T], ca: &[T], cb: &[T], ratio: T, along_x: D, along_y: D) {
    let n = ez.len();
    let (ca, cb, along_x, along_y) = (&ca[..n], &cb[..n], along_x.part(0, n), along_y.part(0, n));
    for j in 0..n {
        let curl = along_x.at(j) - ratio * along_y.at(j);
        ez[j] = ca[j] * ez[j] + cb[j] * curl;
    }
}
