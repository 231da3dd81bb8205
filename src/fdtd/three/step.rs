//! The step of a plane.

use std::ops::Range;

use super::absorbing::{Absorbing, Memory, Profiles};
use super::fields::{ForE, ForH};
use super::grades::RowGrade;
use super::kernel::{
    Absorb, AbsorbEndTwice, AbsorbEnds, AbsorbRowTwice, Absorbs, Bare, Curl, Grade, Lossless, Lossy, StepAll, StepE,
    StepH, Stored,
};
use super::plane::{Plane, Scratch, Shared, drive_row};
use super::sheet::LANES;
use super::vector::{Kernel, Number, Set, vectors_mut};

/// A step of one plane: H from E of this plane and the next, then E from H of this plane and the one before.
///
/// Rows may be stepped one after the other in place: H of a row needs E of the row and of the next, which are still those
/// of the step before, and E of a row needs H of the row and the one before, which are stepped already.
pub struct Step<'a, T> {
    pub shared: &'a Shared<T>,
    pub step: usize,
    /// The rows to step.
    pub rows: Range<usize>,
    /// The plane before.
    pub west: &'a Plane<T>,
    /// The plane after.
    pub east: &'a Plane<T>,
}

/// Some nodes of a row: `n` from node `k` of row `j` on.
#[derive(Clone, Copy)]
struct Span {
    j: usize,
    k: usize,
    n: usize,
}

impl<T: Number> Step<'_, T> {
    /// Runs the step.
    #[inline(always)]
    pub fn run<S: Set<T>>(&self, set: S, plane: &mut Plane<T>, scratch: &mut Scratch<T>) {
        let active = &self.shared.active.rows;
        for j in self.rows.start.max(active.start)..self.rows.end.min(active.end) {
            let Some((k, n)) = self.shared.cones.span(plane.i, j, self.step) else { continue };
            let span = Span { j, k, n };
            self.step_h(set, plane, span);
            drive_row(&plane.magnets, j, k..k + n, self.step, &mut plane.fields);
            self.step_e(set, plane, span, scratch);
            drive_row(&plane.drives, j, k..k + n, self.step, &mut plane.fields);
            if let Some(dispersion) = &mut plane.dispersion {
                let e = plane.fields.e_mut(j, k, n);
                dispersion.relax_row(set, j, k, e, &scratch.old, &self.shared.poles);
            }
        }
    }

    /// H of some nodes of a row.
    #[inline(always)]
    fn step_h<S: Set<T>>(&self, set: S, plane: &mut Plane<T>, span: Span) {
        let Span { j, k, n } = span;
        let active = self.shared.active.h;
        let Plane { fields, magnetic, absorbing, .. } = plane;
        let ForH { h, e: [ex, ey, ez], north: [ex_north, _, ez_north], above: [ex_above, ey_above, _] } =
            fields.for_h(j, k, n);
        let (ey_east, ez_east) = (self.east.fields.at(1, j, k, n), self.east.fields.at(2, j, k, n));
        let curls = [
            Curl { a: [ey, ey_above], b: [ez, ez_north] },
            Curl { a: [ez, ez_east], b: [ex, ex_above] },
            Curl { a: [ex, ex_north], b: [ey, ey_east] },
        ];
        let grade = |axis: usize| {
            let sheet = magnetic.as_ref()?;
            let part = |of: usize| Stored(sheet.at(3 * of + axis, j, k, n));
            Some(Lossy([part(0), part(1)]))
        };
        let [hx, hy, hz] = h;
        let beside = self.shared.y[j].is_some() || absorbing.as_ref().is_some_and(|absorbing| absorbing.x.is_some());
        if active == [true; 3] && !beside && magnetic.is_none() {
            let (fields, one) = ([&mut *hx, &mut *hy, &mut *hz], T::of(1.0));
            StepAll { fields, curls, grades: [Bare; 3], ratio: [one; 3] }.run(set);
        } else {
            // Across x: Hy by the first difference, Hz by the second; across y: Hz by the first, Hx by the second.
            let [on_x, on_y, on_z] = self.beside(absorbing.as_mut(), span, 2, [(1, 0), (2, 1)], [(2, 0), (0, 1)]);
            let [of_x, of_y, of_z] = curls;
            if active[0] {
                step_magnetic(set, hx, of_x, on_x, grade(0));
            }
            if active[1] {
                step_magnetic(set, hy, of_y, on_y, grade(1));
            }
            if active[2] {
                step_magnetic(set, hz, of_z, on_z, grade(2));
            }
        }
        let Some(absorbing) = absorbing else { return };
        let db = |axis: usize| grade(axis).map(|Lossy([_, Stored(db)])| db);
        if beside && self.shared.twice {
            if let Some((profiles, memory)) = &mut absorbing.x {
                if active[1] {
                    self.absorb_twice(set, hy, db(1), curls[1].a, memory, (j, k), profiles, 2);
                }
                if active[2] {
                    self.absorb_twice(set, hz, db(2), curls[2].b, memory, (j, k), profiles, 3);
                }
            }
            if let (Some((slot, profiles)), Some(memory)) = (&self.shared.y[j], &mut absorbing.y) {
                self.absorb_twice(set, hz, db(2), curls[2].a, memory, (*slot, k), profiles, 2);
                self.absorb_twice(set, hx, db(0), curls[0].b, memory, (*slot, k), profiles, 3);
            }
        }
        let Some(memory) = &mut absorbing.z else { return };
        if self.shared.twice {
            if active[0] {
                self.end_twice(set, hx, db(0), curls[0].a, memory, span, 2);
            }
            if active[1] {
                self.end_twice(set, hy, db(1), curls[1].b, memory, span, 3);
            }
            return;
        }
        if active[0] {
            self.end_magnetic(set, hx, grade(0), curls[0].a, memory, span, 2);
        }
        if active[1] {
            self.end_magnetic(set, hy, grade(1), curls[1].b, memory, span, 3);
        }
    }

    /// E of some nodes of a row.
    #[inline(always)]
    fn step_e<S: Set<T>>(&self, set: S, plane: &mut Plane<T>, span: Span, scratch: &mut Scratch<T>) {
        let Span { j, k, n } = span;
        let (width, active) = (self.shared.width, self.shared.active.e);
        let Plane { i, fields, grades, absorbing, dispersion, .. } = plane;
        let Some(grades) = grades else { return };
        let Scratch { scale, old } = scratch;
        if let Some(dispersion) = dispersion {
            dispersion.keep(j, k, [fields.at(0, j, k, n), fields.at(1, j, k, n), fields.at(2, j, k, n)], old);
        }
        let ForE { e, h: [hx, hy, hz], south: [hx_south, _, hz_south], below: [hx_below, hy_below, _] } =
            fields.for_e(j, k, n);
        let (hy_west, hz_west) = (self.west.fields.at(4, j, k, n), self.west.fields.at(5, j, k, n));
        let curls = [
            Curl { a: [hz_south, hz], b: [hy_below, hy] },
            Curl { a: [hx_below, hx], b: [hz_west, hz] },
            Curl { a: [hy_west, hy], b: [hx_south, hx] },
        ];
        let place = (j, k, n);
        let row =
            [grades.of(self.shared, 0, place), grades.of(self.shared, 1, place), grades.of(self.shared, 2, place)];
        let (lossy, ratio) = (grades.is_lossy(j), self.shared.ratio);
        let [ex, ey, ez] = e;
        let beside = self.shared.y[j].is_some() || absorbing.as_ref().is_some_and(|absorbing| absorbing.x.is_some());
        match row {
            _ if active != [true; 3] || beside => {
                // Across x: Ey by the second difference, Ez by the first; across y: Ez by the second, Ex by the first.
                let [on_x, on_y, on_z] = self.beside(absorbing.as_mut(), span, 0, [(1, 1), (2, 0)], [(2, 1), (0, 0)]);
                let ([of_x, of_y, of_z], [x, y, z]) = (curls, row);
                if active[0] {
                    step_component(set, ex, of_x, on_x, x, ratio[0]);
                }
                if active[1] {
                    step_component(set, ey, of_y, on_y, y, ratio[1]);
                }
                if active[2] {
                    step_component(set, ez, of_z, on_z, z, ratio[2]);
                }
            }
            [RowGrade::Even(x), RowGrade::Even(y), RowGrade::Even(z)] => {
                step_all(set, [&mut *ex, &mut *ey, &mut *ez], curls, [x, y, z], lossy, ratio);
            }
            [RowGrade::Indexed(x), RowGrade::Indexed(y), RowGrade::Indexed(z)] => {
                step_all(set, [&mut *ex, &mut *ey, &mut *ez], curls, [x, y, z], lossy, ratio);
            }
            [RowGrade::Stored(x), RowGrade::Stored(y), RowGrade::Stored(z)] => {
                step_all(set, [&mut *ex, &mut *ey, &mut *ez], curls, [x, y, z], lossy, ratio);
            }
            [x, y, z] => {
                let [of_x, of_y, of_z] = curls;
                step_component(set, ex, of_x, [None, None], x, ratio[0]);
                step_component(set, ey, of_y, [None, None], y, ratio[1]);
                step_component(set, ez, of_z, [None, None], z, ratio[2]);
            }
        }
        if let Some(absorbing) = absorbing {
            if self.shared.twice {
                let ([x, y, z], [scale_x, scale_y, scale_z]) = (row, scale);
                let cb_x = Some(x.scale(set, &mut scale_x[..n]));
                let cb_y = Some(y.scale(set, &mut scale_y[..n]));
                let cb_z = Some(z.scale(set, &mut scale_z[..n]));
                if let Some((profiles, memory)) = &mut absorbing.x {
                    if active[1] {
                        self.absorb_twice(set, ey, cb_y, curls[1].b, memory, (j, k), profiles, 0);
                    }
                    if active[2] {
                        self.absorb_twice(set, ez, cb_z, curls[2].a, memory, (j, k), profiles, 1);
                    }
                }
                if let (Some((slot, profiles)), Some(memory)) = (&self.shared.y[j], &mut absorbing.y) {
                    self.absorb_twice(set, ez, cb_z, curls[2].b, memory, (*slot, k), profiles, 0);
                    self.absorb_twice(set, ex, cb_x, curls[0].a, memory, (*slot, k), profiles, 1);
                }
                if let Some(memory) = &mut absorbing.z {
                    if active[0] {
                        self.end_twice(set, ex, cb_x, curls[0].b, memory, span, 0);
                    }
                    if active[1] {
                        self.end_twice(set, ey, cb_y, curls[1].a, memory, span, 1);
                    }
                }
            } else if let Some(memory) = &mut absorbing.z {
                let [x, y, _] = row;
                if active[0] {
                    self.end(set, ex, x, curls[0].b, memory, span, 0);
                }
                if active[1] {
                    self.end(set, ey, y, curls[1].a, memory, span, 1);
                }
            }
        }
        // The outer walls conduct perfectly, and nothing lies beyond them.
        if k == 0 {
            (ex[0], ey[0]) = (T::default(), T::default());
        }
        if k + n == width {
            let inside = set.load(&self.shared.inside);
            for e in [&mut *ex, &mut *ey, &mut *ez] {
                if let Some(last) = vectors_mut(e).last_mut() {
                    set.store(set.mul(set.load(last), inside), last);
                }
            }
        }
        if *i == 0 {
            ey.fill(T::default());
            ez.fill(T::default());
        }
        if j == 0 {
            ex.fill(T::default());
            ez.fill(T::default());
        }
    }

    /// What absorbs in first order in each component of a row within slabs across x or y: E (0) or H (2). Of both slabs the
    /// component and the difference that each memory acts on.
    #[inline(always)]
    fn beside<'a>(
        &self,
        absorbing: Option<&'a mut Absorbing<T>>,
        Span { j, k, n }: Span,
        of: usize,
        of_x: [(usize, usize); 2],
        of_y: [(usize, usize); 2],
    ) -> [Absorbs<'a, T>; 3] {
        let mut absorbs = [[None, None], [None, None], [None, None]];
        let Some(Absorbing { x, y, .. }) = absorbing.filter(|_| !self.shared.twice) else { return absorbs };
        let mut add = |profiles: &Profiles<T>, memory: [&'a mut [T]; 2], places: [(usize, usize); 2]| {
            for (number, (phi, (axis, difference))) in memory.into_iter().zip(places).enumerate() {
                absorbs[axis][difference] = Some(Absorb { phi, profile: profiles.first[of + number] });
            }
        };
        if let Some((profiles, memory)) = x {
            add(profiles, memory.pair(of, j, k, n), of_x);
        }
        if let (Some((slot, profiles)), Some(memory)) = (&self.shared.y[j], y) {
            add(profiles, memory.pair(of, *slot, k, n), of_y);
        }
        absorbs
    }

    /// Corrects a row within a slab across x or y, in second order; `scale` is absent for H where nothing is magnetic.
    #[expect(clippy::too_many_arguments, reason = "a row, its coefficients and its memory")]
    fn absorb_twice<S: Set<T>>(
        &self,
        set: S,
        field: &mut [T],
        scale: Option<&[T]>,
        d: [&[T]; 2],
        memory: &mut Memory<T>,
        (row, k): (usize, usize),
        profiles: &Profiles<T>,
        of: usize,
    ) {
        if let Some(filters) = &profiles.second {
            let (scale, phi) = (scale.unwrap_or(&self.shared.ones), memory.both(of, row, k, field.len()));
            set.run(AbsorbRowTwice { field, scale, d, phi, filter: filters[of] });
        }
    }

    /// Corrects the ends of a row within slabs across z, in second order; `scale` is absent for H where nothing is magnetic.
    #[expect(clippy::too_many_arguments, reason = "a row, its coefficients and its memory")]
    fn end_twice<S: Set<T>>(
        &self,
        set: S,
        field: &mut [T],
        scale: Option<&[T]>,
        [a, b]: [&[T]; 2],
        memory: &mut Memory<T>,
        Span { j, k, n }: Span,
        of: usize,
    ) {
        let columns = &self.shared.z;
        for (place, &node) in columns.vectors.iter().enumerate() {
            let (true, Some(filter)) = (k <= node && node < k + n, columns.filter(of, place)) else { continue };
            let from = node - k;
            let phi = memory.both(of, j, place * LANES, LANES);
            let scale = scale.map_or(&self.shared.ones[..LANES], |scale| &scale[from..][..LANES]);
            let d = [&a[from..][..LANES], &b[from..][..LANES]];
            set.run(AbsorbEndTwice { field: &mut field[from..][..LANES], scale, d, phi, filter });
        }
    }

    /// Corrects the ends of a row of E within slabs across z.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "a row, its coefficients and its memory")]
    fn end<S: Set<T>>(
        &self,
        set: S,
        field: &mut [T],
        grade: RowGrade<'_, T>,
        d: [&[T]; 2],
        memory: &mut Memory<T>,
        span: Span,
        of: usize,
    ) {
        match grade {
            RowGrade::Even([_, cb]) => self.end_of(field, Lossless(cb), d, memory, span, of).run(set),
            RowGrade::Indexed([_, cb]) => self.end_of(field, Lossless(cb), d, memory, span, of).run(set),
            RowGrade::Stored([_, cb]) => self.end_of(field, Lossless(cb), d, memory, span, of).run(set),
        }
    }

    /// Corrects the ends of a row of H within slabs across z.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "a row, its coefficients and its memory")]
    fn end_magnetic<S: Set<T>>(
        &self,
        set: S,
        field: &mut [T],
        grade: Option<Lossy<Stored<'_, T>>>,
        d: [&[T]; 2],
        memory: &mut Memory<T>,
        span: Span,
        of: usize,
    ) {
        match grade {
            None => self.end_of(field, Bare, d, memory, span, of).run(set),
            Some(grade) => set.run(self.end_of(field, grade, d, memory, span, of)),
        }
    }

    #[inline(always)]
    fn end_of<'a, G: Grade<T>>(
        &'a self,
        field: &'a mut [T],
        grade: G,
        d: [&'a [T]; 2],
        memory: &'a mut Memory<T>,
        Span { j, k: begin, .. }: Span,
        of: usize,
    ) -> AbsorbEnds<'a, T, G> {
        let columns = &self.shared.z;
        let [first, second] = memory.pair(of / 2 * 2, j, 0, columns.vectors.len() * LANES);
        let phi = if of.is_multiple_of(2) { first } else { second };
        AbsorbEnds { field, d, grade, phi, profile: columns.profile(of, 0), vectors: &columns.vectors, begin }
    }
}

/// The step of one component of H.
fn step_magnetic<T: Number, S: Set<T>>(
    set: S,
    h: &mut [T],
    curl: Curl<'_, T>,
    absorbs: Absorbs<'_, T>,
    grade: Option<Lossy<Stored<'_, T>>>,
) {
    match grade {
        None => set.run(StepH { h, curl, absorbs, grade: Bare }),
        Some(grade) => set.run(StepH { h, curl, absorbs, grade }),
    }
}

/// The step of one component of E: with `ca` even where it is one everywhere, which changes no bit.
fn step_component<T: Number, S: Set<T>>(
    set: S,
    e: &mut [T],
    curl: Curl<'_, T>,
    absorbs: Absorbs<'_, T>,
    grade: RowGrade<'_, T>,
    ratio: T,
) {
    match grade {
        RowGrade::Even(both) => set.run(StepE { e, curl, absorbs, grade: Lossy(both), ratio }),
        RowGrade::Indexed(both) => set.run(StepE { e, curl, absorbs, grade: Lossy(both), ratio }),
        RowGrade::Stored(both) => set.run(StepE { e, curl, absorbs, grade: Lossy(both), ratio }),
    }
}

/// The step of all components of E where nothing absorbs and all have coefficients of one kind.
#[inline(always)]
fn step_all<T: Number, S: Set<T>, C: Copy>(
    set: S,
    fields: [&mut [T]; 3],
    curls: [Curl<'_, T>; 3],
    [x, y, z]: [[C; 2]; 3],
    lossy: bool,
    ratio: [T; 3],
) where
    Lossy<C>: Grade<T>,
    Lossless<C>: Grade<T>,
{
    if lossy {
        StepAll { fields, curls, grades: [Lossy(x), Lossy(y), Lossy(z)], ratio }.run(set);
    } else {
        StepAll { fields, curls, grades: [Lossless(x[1]), Lossless(y[1]), Lossless(z[1])], ratio }.run(set);
    }
}
