//! The Yee scheme in three dimensions on one row; see `sheet` for where the arrays live and how they are scaled.

use super::super::super::real::Real;

/// One H step of a component: `H += (a1 - a0) - (b1 - b0)`, all scaled.
#[inline(always)]
pub fn add_h<T: Real>(h: &mut [T], a: [&[T]; 2], b: [&[T]; 2]) {
    let n = h.len();
    let (a0, a1, b0, b1) = (&a[0][..n], &a[1][..n], &b[0][..n], &b[1][..n]);
    for k in 0..n {
        h[k] = h[k] + ((a1[k] - a0[k]) - (b1[k] - b0[k]));
    }
}

/// As [`add_h`] in a magnetic material: `H <- da H + db curl`, `da = (mu/dt - s/2)/(mu/dt + s/2)`, `db = (mu0/dt)/(mu/dt + s/2)`.
#[inline(always)]
pub fn add_h_magnetic<T: Real>(h: &mut [T], da: &[T], db: &[T], a: [&[T]; 2], b: [&[T]; 2]) {
    let n = h.len();
    let (a0, a1, b0, b1) = (&a[0][..n], &a[1][..n], &b[0][..n], &b[1][..n]);
    let (da, db) = (&da[..n], &db[..n]);
    for k in 0..n {
        h[k] = da[k] * h[k] + db[k] * ((a1[k] - a0[k]) - (b1[k] - b0[k]));
    }
}

/// What lies around a row of one component of E.
#[derive(Clone, Copy)]
pub struct EdgeRow<'a, T> {
    /// Present where something conducts: `(eps/dt - sigma/2)/(eps/dt + sigma/2)`.
    pub ca: &'a [T],
    /// Takes the scaled curl.
    pub cb: &'a [T],
    /// What the second difference of the curl is multiplied by; 1 in cubic cells.
    pub ratio: T,
    /// H before and behind the edge in the first difference.
    pub a: [&'a [T]; 2],
    /// H before and behind the edge in the second difference.
    pub b: [&'a [T]; 2],
}

/// One E step without conductivity: `E += cb [(a1 - a0) - ratio (b1 - b0)]`; `cb = 0` holds perfect conductors.
#[inline(always)]
pub fn add_curl<T: Real>(e: &mut [T], row: EdgeRow<'_, T>) {
    let n = e.len();
    let (a0, a1, b0, b1) = (&row.a[0][..n], &row.a[1][..n], &row.b[0][..n], &row.b[1][..n]);
    let (cb, ratio) = (&row.cb[..n], row.ratio);
    for k in 0..n {
        e[k] = e[k] + cb[k] * ((a1[k] - a0[k]) - ratio * (b1[k] - b0[k]));
    }
}

/// One E step with conductivity: as [`add_curl`], with `ca E` in place of `E`.
#[inline(always)]
pub fn add_curl_lossy<T: Real>(e: &mut [T], row: EdgeRow<'_, T>) {
    let n = e.len();
    let (a0, a1, b0, b1) = (&row.a[0][..n], &row.a[1][..n], &row.b[0][..n], &row.b[1][..n]);
    let (ca, cb, ratio) = (&row.ca[..n], &row.cb[..n], row.ratio);
    for k in 0..n {
        e[k] = ca[k] * e[k] + cb[k] * ((a1[k] - a0[k]) - ratio * (b1[k] - b0[k]));
    }
}
