//! The absorbing boundary as corrections added to a row after its plain step: at the ends of z, and in second order; see
//! `update` for the formula and for the rows across x and y.

use super::super::super::real::Real;
use super::super::sheet::LANES;
use super::super::vector::{Kernel, Set, vectors, vectors_mut};
use super::grade::Grade;

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

/// Corrects vectors at the ends of a row.
pub struct AbsorbEnds<'a, T, G> {
    /// The component.
    pub field: &'a mut [T],
    /// The difference, `d[1] - d[0]`.
    pub d: [&'a [T]; 2],
    /// The coefficients of the row.
    pub grade: G,
    /// One number a node of the ends, vector after vector.
    pub phi: &'a mut [T],
    /// The coefficients at these nodes.
    pub profile: ColumnProfile<'a, T>,
    /// First node of each of these vectors.
    pub vectors: &'a [usize],
    /// First node of the row.
    pub begin: usize,
}

impl<T: Real, G: Grade<T>> Kernel<T> for AbsorbEnds<'_, T, G> {
    #[inline(always)]
    fn run<S: Set<T>>(self, set: S) {
        let Self { field, d: [a, b], grade, phi, profile: p, vectors: places, begin } = self;
        let field = vectors_mut(field);
        let (n, count) = (field.len(), places.len());
        let (a, b, phi) = (vectors(a, n), vectors(b, n), &mut vectors_mut(phi)[..count]);
        let (ra_less_one, rb) = (vectors(p.ra_less_one, count), vectors(p.rb, count));
        let (re, rf) = (vectors(p.re, count), vectors(p.rf, count));
        let grade = grade.open(set, n);
        for place in 0..count {
            let k = places[place].wrapping_sub(begin) / LANES;
            if k >= n {
                continue;
            }
            let (d, memory) = (set.sub(set.load(&b[k]), set.load(&a[k])), set.load(&phi[place]));
            let gain = set.add(set.mul(set.load(&ra_less_one[place]), d), set.mul(set.load(&rb[place]), memory));
            set.store(G::gain(set, grade, k, set.load(&field[k]), gain), &mut field[k]);
            let kept = set.mul(set.load(&re[place]), memory);
            set.store(set.sub(kept, set.mul(set.load(&rf[place]), d)), &mut phi[place]);
        }
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
pub struct AbsorbRowTwice<'a, T> {
    /// The component.
    pub field: &'a mut [T],
    /// What takes the curl, or ones.
    pub scale: &'a [T],
    /// The difference, `d[1] - d[0]`.
    pub d: [&'a [T]; 2],
    /// Two numbers a node.
    pub phi: [&'a mut [T]; 2],
    /// The coefficients.
    pub filter: RowFilter<T>,
}

impl<T: Real> Kernel<T> for AbsorbRowTwice<'_, T> {
    #[inline(always)]
    fn run<S: Set<T>>(self, set: S) {
        let Self { field, scale, d: [a, b], phi: [phi1, phi2], filter: p } = self;
        let field = vectors_mut(field);
        let n = field.len();
        let (scale, a, b) = (vectors(scale, n), vectors(a, n), vectors(b, n));
        let (phi1, phi2) = (&mut vectors_mut(phi1)[..n], &mut vectors_mut(phi2)[..n]);
        let ([x, y, z], [[p1, q1, r1], [p2, q2, r2]]) = (p.add, p.next);
        let (x, y, z) = (set.splat(x), set.splat(y), set.splat(z));
        let (p1, q1, r1) = (set.splat(p1), set.splat(q1), set.splat(r1));
        let (p2, q2, r2) = (set.splat(p2), set.splat(q2), set.splat(r2));
        for k in 0..n {
            let d = set.sub(set.load(&b[k]), set.load(&a[k]));
            let (one, two) = (set.load(&phi1[k]), set.load(&phi2[k]));
            let gain = set.add(set.add(set.mul(x, d), set.mul(y, one)), set.mul(z, two));
            set.store(set.add(set.load(&field[k]), set.mul(set.load(&scale[k]), gain)), &mut field[k]);
            set.store(set.add(set.add(set.mul(p1, one), set.mul(q1, two)), set.mul(r1, d)), &mut phi1[k]);
            set.store(set.add(set.add(set.mul(p2, one), set.mul(q2, two)), set.mul(r2, d)), &mut phi2[k]);
        }
    }
}

/// Corrects one end of a row in second order.
pub struct AbsorbEndTwice<'a, T> {
    /// The component.
    pub field: &'a mut [T],
    /// What takes the curl, or ones.
    pub scale: &'a [T],
    /// The difference, `d[1] - d[0]`.
    pub d: [&'a [T]; 2],
    /// Two numbers a node.
    pub phi: [&'a mut [T]; 2],
    /// The coefficients.
    pub filter: ColumnFilter<'a, T>,
}

impl<T: Real> Kernel<T> for AbsorbEndTwice<'_, T> {
    #[inline(always)]
    fn run<S: Set<T>>(self, set: S) {
        let Self { field, scale, d: [a, b], phi: [phi1, phi2], filter: p } = self;
        let field = vectors_mut(field);
        let n = field.len();
        let (scale, a, b) = (vectors(scale, n), vectors(a, n), vectors(b, n));
        let (phi1, phi2) = (&mut vectors_mut(phi1)[..n], &mut vectors_mut(phi2)[..n]);
        let ([x, y, z], [[p1, q1, r1], [p2, q2, r2]]) = (p.add, p.next);
        let (x, y, z) = (vectors(x, n), vectors(y, n), vectors(z, n));
        let (p1, q1, r1) = (vectors(p1, n), vectors(q1, n), vectors(r1, n));
        let (p2, q2, r2) = (vectors(p2, n), vectors(q2, n), vectors(r2, n));
        for k in 0..n {
            let (x, y, z) = (set.load(&x[k]), set.load(&y[k]), set.load(&z[k]));
            let (p1, q1, r1) = (set.load(&p1[k]), set.load(&q1[k]), set.load(&r1[k]));
            let (p2, q2, r2) = (set.load(&p2[k]), set.load(&q2[k]), set.load(&r2[k]));
            let d = set.sub(set.load(&b[k]), set.load(&a[k]));
            let (one, two) = (set.load(&phi1[k]), set.load(&phi2[k]));
            let gain = set.add(set.add(set.mul(x, d), set.mul(y, one)), set.mul(z, two));
            set.store(set.add(set.load(&field[k]), set.mul(set.load(&scale[k]), gain)), &mut field[k]);
            set.store(set.add(set.add(set.mul(p1, one), set.mul(q1, two)), set.mul(r1, d)), &mut phi1[k]);
            set.store(set.add(set.add(set.mul(p2, one), set.mul(q2, two)), set.mul(r2, d)), &mut phi2[k]);
        }
    }
}
