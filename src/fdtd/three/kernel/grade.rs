//! The coefficients along a row: none, the same everywhere, looked up, or one number an edge; with conduction or without.

use super::super::super::real::Real;
use super::super::sheet::LANES;
use super::super::vector::{Kernel, Set, TABLE, vectors, vectors_mut};

/// The coefficients of the step of a row.
pub trait Grade<T: Real>: Copy {
    /// As the loop holds them.
    type Open<S: Set<T>>: Copy;

    /// Readies them for `count` vectors.
    fn open<S: Set<T>>(self, set: S, count: usize) -> Self::Open<S>;
    /// The plain step of vector `k`: `ca field + cb curl`.
    fn step<S: Set<T>>(set: S, open: Self::Open<S>, k: usize, field: S::Vector, curl: S::Vector) -> S::Vector;
    /// What the absorbing boundary adds: `field + cb gain`.
    fn gain<S: Set<T>>(set: S, open: Self::Open<S>, k: usize, field: S::Vector, gain: S::Vector) -> S::Vector;
}

/// Neither: H where nothing is magnetic.
#[derive(Clone, Copy)]
pub struct Bare;

impl<T: Real> Grade<T> for Bare {
    type Open<S: Set<T>> = ();

    #[inline(always)]
    fn open<S: Set<T>>(self, _: S, _: usize) {}
    #[inline(always)]
    fn step<S: Set<T>>(set: S, (): (), _: usize, field: S::Vector, curl: S::Vector) -> S::Vector {
        set.add(field, curl)
    }
    #[inline(always)]
    fn gain<S: Set<T>>(set: S, (): (), _: usize, field: S::Vector, gain: S::Vector) -> S::Vector {
        set.add(field, gain)
    }
}

/// A coefficient along a row.
pub trait Coefficient<T: Real>: Copy {
    /// As the loop holds it.
    type Open<S: Set<T>>: Copy;

    /// Readies it for `count` vectors.
    fn open<S: Set<T>>(self, set: S, count: usize) -> Self::Open<S>;
    /// The sixteen of vector `k`.
    fn at<S: Set<T>>(set: S, open: Self::Open<S>, k: usize) -> S::Vector;
}

/// The same everywhere.
#[derive(Clone, Copy)]
pub struct Even<T>(pub T);

impl<T: Real> Coefficient<T> for Even<T> {
    type Open<S: Set<T>> = S::Vector;

    #[inline(always)]
    fn open<S: Set<T>>(self, set: S, _: usize) -> S::Vector {
        set.splat(self.0)
    }
    #[inline(always)]
    fn at<S: Set<T>>(_: S, open: S::Vector, _: usize) -> S::Vector {
        open
    }
}

/// Looked up in a table, one byte an edge.
#[derive(Clone, Copy)]
pub struct Indexed<'a, T> {
    /// What is looked up.
    pub table: &'a [T; TABLE],
    /// Where.
    pub index: &'a [u8],
}

impl<'a, T: Real> Coefficient<T> for Indexed<'a, T> {
    type Open<S: Set<T>> = (S::Table, &'a [[u8; LANES]]);

    #[inline(always)]
    fn open<S: Set<T>>(self, set: S, count: usize) -> Self::Open<S> {
        (set.table(self.table), vectors(self.index, count))
    }
    #[inline(always)]
    fn at<S: Set<T>>(set: S, (table, index): Self::Open<S>, k: usize) -> S::Vector {
        set.look_up(&table, &index[k])
    }
}

/// One number an edge.
#[derive(Clone, Copy)]
pub struct Stored<'a, T>(pub &'a [T]);

impl<'a, T: Real> Coefficient<T> for Stored<'a, T> {
    type Open<S: Set<T>> = &'a [[T; LANES]];

    #[inline(always)]
    fn open<S: Set<T>>(self, _: S, count: usize) -> Self::Open<S> {
        vectors(self.0, count)
    }
    #[inline(always)]
    fn at<S: Set<T>>(set: S, open: Self::Open<S>, k: usize) -> S::Vector {
        set.load(&open[k])
    }
}

/// `cb` alone: nothing conducts.
#[derive(Clone, Copy)]
pub struct Lossless<C>(pub C);

impl<T: Real, C: Coefficient<T>> Grade<T> for Lossless<C> {
    type Open<S: Set<T>> = C::Open<S>;

    #[inline(always)]
    fn open<S: Set<T>>(self, set: S, count: usize) -> Self::Open<S> {
        self.0.open(set, count)
    }
    #[inline(always)]
    fn step<S: Set<T>>(set: S, open: Self::Open<S>, k: usize, field: S::Vector, curl: S::Vector) -> S::Vector {
        set.add(field, set.mul(C::at(set, open, k), curl))
    }
    #[inline(always)]
    fn gain<S: Set<T>>(set: S, open: Self::Open<S>, k: usize, field: S::Vector, gain: S::Vector) -> S::Vector {
        set.add(field, set.mul(C::at(set, open, k), gain))
    }
}

/// `ca`, then `cb`: something conducts (E), or is magnetic (H).
#[derive(Clone, Copy)]
pub struct Lossy<C>(pub [C; 2]);

impl<T: Real, C: Coefficient<T>> Grade<T> for Lossy<C> {
    type Open<S: Set<T>> = [C::Open<S>; 2];

    #[inline(always)]
    fn open<S: Set<T>>(self, set: S, count: usize) -> Self::Open<S> {
        let [ca, cb] = self.0;
        [ca.open(set, count), cb.open(set, count)]
    }
    #[inline(always)]
    fn step<S: Set<T>>(set: S, [ca, cb]: Self::Open<S>, k: usize, field: S::Vector, curl: S::Vector) -> S::Vector {
        set.add(set.mul(C::at(set, ca, k), field), set.mul(C::at(set, cb, k), curl))
    }
    #[inline(always)]
    fn gain<S: Set<T>>(set: S, [_, cb]: Self::Open<S>, k: usize, field: S::Vector, gain: S::Vector) -> S::Vector {
        set.add(field, set.mul(C::at(set, cb, k), gain))
    }
}

/// Writes a coefficient out.
pub struct WriteOut<'a, T, C> {
    /// The coefficient.
    pub coefficient: C,
    /// Where to.
    pub out: &'a mut [T],
}

impl<T: Real, C: Coefficient<T>> Kernel<T> for WriteOut<'_, T, C> {
    #[inline(always)]
    fn run<S: Set<T>>(self, set: S) {
        let out = vectors_mut(self.out);
        let open = self.coefficient.open(set, out.len());
        for (k, out) in out.iter_mut().enumerate() {
            set.store(C::at(set, open, k), out);
        }
    }
}
