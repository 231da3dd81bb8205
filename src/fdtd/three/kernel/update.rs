//! The Yee scheme in three dimensions on one row; see `sheet` for where the arrays live and how they are scaled.
//!
//! The absorbing boundary across x and y (HORIPML or MRIPML in first order) is stepped along: with `d` the difference that it
//! corrects, the field gains `scale [(RA - 1) d + RB phi]` after its plain step, then `phi <- RE phi - RF d` (Giannopoulos
//! 2012, doi:10.1109/TAP.2011.2180344). The sign of the difference in the curl, and the ratio of non-cubic cells, stand in
//! `RA - 1` and `RB`.

use super::super::super::real::Real;
use super::super::sheet::LANES;
use super::super::vector::{Kernel, Set, vectors, vectors_mut};
use super::absorb::RowProfile;
use super::grade::Grade;

/// The two differences that make the curl of a row: of each, the row that is taken away and the row it is taken from.
#[derive(Clone, Copy)]
pub struct Curl<'a, T> {
    /// The first difference, `a[1] - a[0]`.
    pub a: [&'a [T]; 2],
    /// The second difference, which is taken from the first.
    pub b: [&'a [T]; 2],
}

/// The absorbing memory of a difference in a row.
pub struct Absorb<'a, T> {
    /// One number a node.
    pub phi: &'a mut [T],
    /// The same along the row.
    pub profile: RowProfile<T>,
}

/// What absorbs in a row, in the first and in the second difference of its curl.
pub type Absorbs<'a, T> = [Option<Absorb<'a, T>>; 2];

/// Both differences as vectors.
struct Rows<'a, T> {
    a: [&'a [[T; LANES]]; 2],
    b: [&'a [[T; LANES]]; 2],
}

impl<'a, T: Real> Rows<'a, T> {
    #[inline(always)]
    fn new(curl: Curl<'a, T>, count: usize) -> Self {
        let Curl { a: [a0, a1], b: [b0, b1] } = curl;
        Self { a: [vectors(a0, count), vectors(a1, count)], b: [vectors(b0, count), vectors(b1, count)] }
    }

    #[inline(always)]
    fn differences<S: Set<T>>(&self, set: S, k: usize) -> [S::Vector; 2] {
        let a = set.sub(set.load(&self.a[1][k]), set.load(&self.a[0][k]));
        [a, set.sub(set.load(&self.b[1][k]), set.load(&self.b[0][k]))]
    }
}

/// An [`Absorb`] as vectors.
struct Absorbing<'a, T, S: Set<T>> {
    phi: &'a mut [[T; LANES]],
    profile: [S::Vector; 4],
}

impl<'a, T: Real, S: Set<T>> Absorbing<'a, T, S> {
    #[inline(always)]
    fn new(set: S, absorb: Absorb<'a, T>, count: usize) -> Self {
        let RowProfile { ra_less_one, rb, re, rf } = absorb.profile;
        let profile = [set.splat(ra_less_one), set.splat(rb), set.splat(re), set.splat(rf)];
        Self { phi: &mut vectors_mut(absorb.phi)[..count], profile }
    }

    /// What the field gains, but for its scale; the memory is stepped.
    #[inline(always)]
    fn gain(&mut self, set: S, k: usize, d: S::Vector) -> S::Vector {
        let ([ra_less_one, rb, re, rf], memory) = (self.profile, set.load(&self.phi[k]));
        set.store(set.sub(set.mul(re, memory), set.mul(rf, d)), &mut self.phi[k]);
        set.add(set.mul(ra_less_one, d), set.mul(rb, memory))
    }
}

/// One step of a component of H: `H <- da H + db curl`; see [`Grade`] for the coefficients, which nothing needs where nothing
/// is magnetic.
pub struct StepH<'a, T, G> {
    /// The component.
    pub h: &'a mut [T],
    /// Of E.
    pub curl: Curl<'a, T>,
    /// What absorbs.
    pub absorbs: Absorbs<'a, T>,
    /// The coefficients.
    pub grade: G,
}

impl<T: Real, G: Grade<T>> Kernel<T> for StepH<'_, T, G> {
    #[inline(always)]
    fn run<S: Set<T>>(self, set: S) {
        let ratio = set.splat(T::of(1.0));
        step(set, self.h, self.curl, self.absorbs, self.grade, ratio);
    }
}

/// One step of a component of E: `E <- ca E + cb [(a1 - a0) - ratio (b1 - b0)]`; `cb = 0` holds perfect conductors.
pub struct StepE<'a, T, G> {
    /// The component.
    pub e: &'a mut [T],
    /// Of H.
    pub curl: Curl<'a, T>,
    /// What absorbs.
    pub absorbs: Absorbs<'a, T>,
    /// The coefficients.
    pub grade: G,
    /// What the second difference of the curl is multiplied by; 1 in cubic cells.
    pub ratio: T,
}

impl<T: Real, G: Grade<T>> Kernel<T> for StepE<'_, T, G> {
    #[inline(always)]
    fn run<S: Set<T>>(self, set: S) {
        let ratio = set.splat(self.ratio);
        step(set, self.e, self.curl, self.absorbs, self.grade, ratio);
    }
}

#[inline(always)]
#[expect(clippy::needless_range_loop, reason = "the place counts in several rows at once")]
fn step<T: Real, S: Set<T>, G: Grade<T>>(
    set: S,
    field: &mut [T],
    curl: Curl<'_, T>,
    absorbs: Absorbs<'_, T>,
    grade: G,
    ratio: S::Vector,
) {
    let field = vectors_mut(field);
    let n = field.len();
    let rows = Rows::new(curl, n);
    let grade = grade.open(set, n);
    match absorbs {
        [None, None] => {
            for k in 0..n {
                let [a, b] = rows.differences(set, k);
                let value = G::step(set, grade, k, set.load(&field[k]), set.sub(a, set.mul(ratio, b)));
                set.store(value, &mut field[k]);
            }
        }
        [Some(first), None] => {
            let mut first = Absorbing::new(set, first, n);
            for k in 0..n {
                let [a, b] = rows.differences(set, k);
                let value = G::step(set, grade, k, set.load(&field[k]), set.sub(a, set.mul(ratio, b)));
                let value = G::gain(set, grade, k, value, first.gain(set, k, a));
                set.store(value, &mut field[k]);
            }
        }
        [None, Some(second)] => {
            let mut second = Absorbing::new(set, second, n);
            for k in 0..n {
                let [a, b] = rows.differences(set, k);
                let value = G::step(set, grade, k, set.load(&field[k]), set.sub(a, set.mul(ratio, b)));
                let value = G::gain(set, grade, k, value, second.gain(set, k, b));
                set.store(value, &mut field[k]);
            }
        }
        [Some(first), Some(second)] => {
            let mut first = Absorbing::new(set, first, n);
            let mut second = Absorbing::new(set, second, n);
            for k in 0..n {
                let [a, b] = rows.differences(set, k);
                let value = G::step(set, grade, k, set.load(&field[k]), set.sub(a, set.mul(ratio, b)));
                let value = G::gain(set, grade, k, value, first.gain(set, k, a));
                let value = G::gain(set, grade, k, value, second.gain(set, k, b));
                set.store(value, &mut field[k]);
            }
        }
    }
}

/// One step of all components of a field at once where nothing absorbs; as one by one, but each number is read once.
pub struct StepAll<'a, T, G> {
    /// The components along x, y, z.
    pub fields: [&'a mut [T]; 3],
    /// The curl of each.
    pub curls: [Curl<'a, T>; 3],
    /// The coefficients of each.
    pub grades: [G; 3],
    /// What the second difference of each curl is multiplied by.
    pub ratio: [T; 3],
}

impl<T: Real, G: Grade<T>> Kernel<T> for StepAll<'_, T, G> {
    #[inline(always)]
    fn run<S: Set<T>>(self, set: S) {
        let [x, y, z] = self.fields;
        let (x, y, z) = (vectors_mut(x), vectors_mut(y), vectors_mut(z));
        let n = x.len();
        let (y, z) = (&mut y[..n], &mut z[..n]);
        let [of_x, of_y, of_z] = self.curls;
        let (of_x, of_y, of_z) = (Rows::new(of_x, n), Rows::new(of_y, n), Rows::new(of_z, n));
        let [grade_x, grade_y, grade_z] = self.grades;
        let (grade_x, grade_y, grade_z) = (grade_x.open(set, n), grade_y.open(set, n), grade_z.open(set, n));
        let [ratio_x, ratio_y, ratio_z] = self.ratio;
        let (ratio_x, ratio_y, ratio_z) = (set.splat(ratio_x), set.splat(ratio_y), set.splat(ratio_z));
        for k in 0..n {
            let [a, b] = of_x.differences(set, k);
            let new_x = G::step(set, grade_x, k, set.load(&x[k]), set.sub(a, set.mul(ratio_x, b)));
            let [a, b] = of_y.differences(set, k);
            let new_y = G::step(set, grade_y, k, set.load(&y[k]), set.sub(a, set.mul(ratio_y, b)));
            let [a, b] = of_z.differences(set, k);
            let new_z = G::step(set, grade_z, k, set.load(&z[k]), set.sub(a, set.mul(ratio_z, b)));
            set.store(new_x, &mut x[k]);
            set.store(new_y, &mut y[k]);
            set.store(new_z, &mut z[k]);
        }
    }
}
