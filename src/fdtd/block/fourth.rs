//! Steps with differences of fourth order: rows, images behind the walls, and what conductors cut.

use std::ops::Range;

use super::super::conductor::{Cut, Cuts};
use super::super::kernel::{FourthRowOfE, FourthRowOfH, RowOfE, RowOfH};
use super::super::lanes::Lanes;
use super::super::layout::LANES;
use super::super::reach::Cones;
use super::super::real::Real;
use super::super::setup::Setup;
use super::by_row::ByRow;
use super::{Block, across};

/// The differences that conductors cut, by row.
pub struct CutRows {
    hx: ByRow<Cut>,
    hy: ByRow<Cut>,
    ez_x: ByRow<Cut>,
    ez_y: ByRow<Cut>,
}

impl CutRows {
    /// Finds them in the rows `base..base + stored`.
    pub fn new(setup: &Setup<'_>, base: usize, stored: usize) -> Self {
        let Cuts { hy, hx, ez_x, ez_y } = Cuts::new(setup, base, stored);
        let by_row = |list| ByRow::new(stored, list);
        Self { hx: by_row(hx), hy: by_row(hy), ez_x: by_row(ez_x), ez_y: by_row(ez_y) }
    }
}

impl<T: Real> Block<T> {
    /// H of a row, and E of the row before if it is one of `rows_of_e`.
    #[inline(always)]
    pub fn step_fourth<C: Lanes<T>>(&mut self, cones: &Cones, row: usize, rows_of_e: Range<usize>, step: usize) {
        if row < self.wall
            && let Some((j, n)) = cones.span(row, step)
        {
            self.step_h_fourth::<C>(row, j, n);
        }
        let Some(row) = row.checked_sub(1) else { return };
        if rows_of_e.contains(&row)
            && let Some((j, n)) = cones.span(row, step)
        {
            self.step_e_fourth::<C>(row, j, n, step);
        }
        self.record(row - self.base, step + 1);
    }

    #[inline(always)]
    fn step_h_fourth<C: Lanes<T>>(&mut self, row: usize, j: usize, n: usize) {
        let (r, first, count) = (row - self.base, (j - 1) / LANES + 1, n / LANES);
        let Self { ez, hx, hy, phi_h, columns, absorb_h, image, .. } = self;
        let (at_first, at_last) = (row == 0, row + 1 == self.wall);
        if at_first || at_last {
            let inside = ez.at(if at_first { r + 1 } else { r }, j, n);
            for (image, &value) in image.at_mut(0, j, n).iter_mut().zip(inside) {
                *image = T::default() - value;
            }
        }
        let across = across(absorb_h[r], phi_h, first, count);
        let along = columns.h.along(r, columns.ends(first, count));
        let h = RowOfH { hx: hx.chunks_mut(r, first, count), hy: hy.chunks_mut(r, first, count), across, along };
        let east = ez.chunks(r + 1, first, count);
        let before = if at_first { image.chunks(0, first, count) } else { ez.chunks(r - 1, first, count) };
        let behind = if at_last { image.chunks(0, first, count) } else { ez.chunks(r + 2, first, count) };
        let ez = ez.chunks(r, first - 1, count + 2);
        FourthRowOfH { h, ez, across: [before, east, behind] }.step::<C>();
        self.cut_h(r, j, n);
        self.image_h(r);
    }

    #[inline(always)]
    fn step_e_fourth<C: Lanes<T>>(&mut self, row: usize, j: usize, n: usize, step: usize) {
        let (r, first, count) = (row - self.base, (j - 1) / LANES + 1, n / LANES);
        if let Some(dispersion) = &mut self.dispersion {
            dispersion.keep(r, j, self.ez.at(r, j, n));
        }
        let Self { ez, hx, hy, phi_e, columns, absorb_e, .. } = self;
        let across = across(absorb_e[r], phi_e, first, count);
        let along = columns.e.along(r, columns.ends(first, count));
        let ca = self.ca.as_ref().map(|ca| ca.chunks(r, first, count));
        let e = RowOfE { cb: self.cb.chunks(r, first, count), ca, ratio: self.ratio, across, along };
        let row_of = |r: usize| hy.chunks(r, first, count);
        let (low, high) = (row_of(r - 1), row_of(r));
        let before = if row == 1 { low } else { row_of(r - 2) };
        let behind = if row + 1 == self.wall { high } else { row_of(r + 1) };
        let hx = hx.chunks(r, first - 1, count + 2);
        FourthRowOfE { e, ez: ez.chunks_mut(r, first, count), hx, hy: [before, low, high, behind] }.step::<C>();
        self.cut_e(r, j, n);
        self.drive(r, j, n, step);
        self.image_e(r);
    }

    /// Writes the images of H behind the walls at both ends of a row.
    #[inline(always)]
    pub(super) fn image_h(&mut self, r: usize) {
        let (first, last) = (self.hx.at(r, 1, 1)[0], self.hx.at(r, self.ny, 1)[0]);
        self.hx.at_mut(r, 0, 1)[0] = first;
        self.hx.at_mut(r, self.ny + 1, 1)[0] = last;
    }

    /// Writes the images of E behind the walls at both ends of a row.
    #[inline(always)]
    pub(super) fn image_e(&mut self, r: usize) {
        let (first, last) = (self.ez.at(r, 1, 1)[0], self.ez.at(r, self.ny - 1, 1)[0]);
        *self.ez.below_wall(r) = T::default() - first;
        self.ez.at_mut(r, self.ny + 1, 1)[0] = T::default() - last;
    }

    /// Takes out of H what came through conductors, and puts in what their images give.
    #[inline(always)]
    fn cut_h(&mut self, r: usize, j: usize, n: usize) {
        let Self { ez, hx, hy, phi_h, columns, absorb_h, .. } = self;
        let Some(cuts) = &self.cuts else { return };
        let part = T::of(1.0 / 24.0);
        for cut in cuts.hx.at(r).iter().filter(|cut| (j..j + n).contains(&cut.j)) {
            let f = ez.two_before(r, cut.j, 4);
            let high = if cut.high { f[1] + f[3] } else { T::default() };
            let low = if cut.low { f[0] + f[2] } else { T::default() };
            let more = part * (high - low);
            let field = &mut hx.at_mut(r, cut.j, 1)[0];
            *field = *field - more;
            if let Some(place) = columns.place(cut.j) {
                let ([ra_less_one, rf], phi) = columns.h.at(r, place);
                *field = *field - ra_less_one * more;
                *phi = *phi - rf * more;
            }
        }
        for cut in cuts.hy.at(r).iter().filter(|cut| (j..j + n).contains(&cut.j)) {
            let f = |row: usize| ez.at(row, cut.j, 1)[0];
            let high = if cut.high { f(r) + f(r + 2) } else { T::default() };
            let low = if cut.low { f(r - 1) + f(r + 1) } else { T::default() };
            let more = part * (high - low);
            let field = &mut hy.at_mut(r, cut.j, 1)[0];
            *field = *field + more;
            if let Some((slot, p)) = absorb_h[r] {
                *field = *field + p.ra_less_one * more;
                let phi = &mut phi_h.at_mut(slot, cut.j, 1)[0];
                *phi = *phi - p.rf * more;
            }
        }
    }

    /// As [`Block::cut_h`], for E.
    #[inline(always)]
    fn cut_e(&mut self, r: usize, j: usize, n: usize) {
        let Self { ez, hx, hy, cb, phi_e, columns, absorb_e, ratio, .. } = self;
        let Some(cuts) = &self.cuts else { return };
        let part = T::of(1.0 / 24.0);
        for cut in cuts.ez_y.at(r).iter().filter(|cut| (j..j + n).contains(&cut.j)) {
            let h = hx.at(r, cut.j - 1, 4);
            let high = if cut.high { h[3] - h[2] } else { T::default() };
            let low = if cut.low { h[1] - h[0] } else { T::default() };
            let more = part * (high + low);
            let (field, cb) = (&mut ez.at_mut(r, cut.j, 1)[0], cb.at(r, cut.j, 1)[0]);
            *field = *field - cb * (*ratio * more);
            if let Some(place) = columns.place(cut.j) {
                let ([ra_less_one, rf], phi) = columns.e.at(r, place);
                *field = *field - cb * (*ratio * (ra_less_one * more));
                *phi = *phi - rf * more;
            }
        }
        for cut in cuts.ez_x.at(r).iter().filter(|cut| (j..j + n).contains(&cut.j)) {
            let h = |row: usize| hy.at(row, cut.j, 1)[0];
            let high = if cut.high { h(r + 1) - h(r) } else { T::default() };
            let low = if cut.low { h(r - 1) - h(r - 2) } else { T::default() };
            let more = part * (high + low);
            let (field, cb) = (&mut ez.at_mut(r, cut.j, 1)[0], cb.at(r, cut.j, 1)[0]);
            *field = *field + cb * more;
            if let Some((slot, p)) = absorb_e[r] {
                *field = *field + cb * (p.ra_less_one * more);
                let phi = &mut phi_e.at_mut(slot, cut.j, 1)[0];
                *phi = *phi - p.rf * more;
            }
        }
    }
}
