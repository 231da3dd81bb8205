//! A block of rows with everything that acts on them: one thread's share of the grid.
//!
//! A block is stepped several steps at a time, in one *pass* over its rows: when the front is at row `f`, step `s` of the
//! pass takes row `f - s`, so a row goes through all steps while it is in the cache. In place this is exact: E of row `r`
//! takes Hy of rows `r` and `r - 1` of the same step, which the next step reaches only after it, and Hy of row `r` takes E
//! of rows `r` and `r + 1` of the step before, made just before at the same front. With differences of fourth order E of row
//! `r` takes Hy of the rows `r - 2` to `r + 1` and Hy of row `r` takes E of the rows `r - 1` to `r + 2`: E follows H one row
//! behind, and the next step follows three rows behind.
//!
//! A block stores as many rows of each neighbour as a value moves in a pass, and steps them too, fewer of them on each side
//! in each step: what it knows of the neighbours at the beginning of a pass is enough for its own rows until the end. Each
//! value is made by the same operations wherever it is made, so the bits do not depend on how the grid is cut.
//!
//! The outer walls conduct perfectly. Differences of fourth order see behind them the images of what lies before: E
//! reversed, H the same. Along y the images stand in the padding of each row.

use std::ops::Range;

use super::conductor::{Cut, Cuts};
use super::dispersion::{Dispersion, overlap};
use super::kernel::{self, ColumnProfile, Difference, Fourth, RowProfile, Second};
use super::layout::{LANES, Rows, padded_width};
use super::reach::Cones;
use super::real::Real;
use super::setup::Setup;
use super::slab::Slab;
use crate::model::Order;

/// One thread's share of the grid.
pub struct Block<T> {
    /// Rows of the grid that this block answers for.
    pub own: Range<usize>,
    /// Row of the grid that is stored row 0.
    base: usize,
    /// Row of the far wall.
    wall: usize,
    width: usize,
    ny: usize,
    order: Order,
    ratio: T,
    limit: T,
    ez: Rows<T>,
    hx: Rows<T>,
    hy: Rows<T>,
    cb: Rows<T>,
    /// Present only where something conducts.
    ca: Option<Rows<T>>,
    absorb_e: Vec<AbsorbingRow<T>>,
    absorb_h: Vec<AbsorbingRow<T>>,
    phi_e: Rows<T>,
    phi_h: Rows<T>,
    columns: Vec<Columns<T>>,
    /// Present with differences of fourth order only.
    cuts: Option<CutRows>,
    /// The image of a row behind a wall.
    image: Rows<T>,
    drives: ByRow<Drive<T>>,
    dispersion: Option<Dispersion<T>>,
    probes: ByRow<Probe>,
    beyond: Option<Beyond>,
}

/// Place in the memory and profile of a row within the absorbing cells at an end of x; `None` for a row outside them.
type AbsorbingRow<T> = Option<(usize, RowProfile<T>)>;

/// The absorbing cells at one end of y.
struct Columns<T> {
    /// First node.
    j: usize,
    /// Nodes.
    count: usize,
    e: [Vec<T>; 4],
    h: [Vec<T>; 4],
    phi_e: Rows<T>,
    phi_h: Rows<T>,
}

/// The differences that conductors cut, by row.
struct CutRows {
    hx: ByRow<Cut>,
    hy: ByRow<Cut>,
    ez_x: ByRow<Cut>,
    ez_y: ByRow<Cut>,
}

/// A source within the block.
struct Drive<T> {
    j: usize,
    /// What is taken from E, per step.
    series: Vec<T>,
}

/// A receiver within the block, and what it has recorded.
pub struct Probe {
    /// Place in the model's list of receivers.
    pub receiver: usize,
    j: usize,
    /// Ez, Hx, Hy, one sample per step; H still scaled.
    pub samples: [Vec<f64>; 3],
}

/// A value that no sound run reaches.
#[derive(Debug, Clone, Copy)]
pub struct Beyond {
    /// Step after which it was seen.
    pub step: usize,
    /// Node of the grid.
    pub node: [usize; 2],
    /// E there, V/m.
    pub value: f64,
}

/// Things that lie on stored rows, sorted by row.
struct ByRow<V> {
    things: Vec<V>,
    /// First thing of each row, and one entry more.
    of_row: Vec<usize>,
}

impl<V> ByRow<V> {
    fn new(stored: usize, mut things: Vec<(usize, V)>) -> Self {
        things.sort_by_key(|(row, _)| *row);
        let of_row = (0..=stored).map(|row| things.partition_point(|(of, _)| *of < row)).collect();
        Self { things: things.into_iter().map(|(_, thing)| thing).collect(), of_row }
    }

    #[inline(always)]
    fn at(&self, row: usize) -> &[V] {
        &self.things[self.of_row[row]..self.of_row[row + 1]]
    }

    #[inline(always)]
    fn at_mut(&mut self, row: usize) -> &mut [V] {
        &mut self.things[self.of_row[row]..self.of_row[row + 1]]
    }
}

impl<T: Real> Block<T> {
    /// Allocates the rows `own` of the grid, with `rim` rows of each neighbour: what a value moves in a pass.
    ///
    /// Every block of the grid must have `rim` rows at least, but for one that has the grid to itself.
    pub fn new(setup: &Setup<'_>, own: Range<usize>, rim: usize) -> Self {
        let [nx, ny] = setup.painted.cells_xy;
        let width = padded_width(ny);
        let base = if own.start == 1 { 0 } else { own.start - rim };
        let stored = (own.end + rim).min(nx + 1) - base;
        let mut cb = Rows::zeros(stored, width);
        let mut ca = setup.lossy().then(|| Rows::zeros(stored, width));
        for row in base.max(1)..(base + stored).min(nx) {
            let entries = &setup.painted.edge_z[row * (ny + 1)..][..ny];
            for (j, &entry) in entries.iter().enumerate().skip(1) {
                let edge = &setup.edges[entry as usize];
                cb.at_mut(row - base, j, 1)[0] = T::of(edge.cb);
                if let Some(ca) = &mut ca {
                    ca.at_mut(row - base, j, 1)[0] = T::of(edge.ca);
                }
            }
        }
        let row_of = |r: usize| (base + r) as f64;
        let [x0, y0, x1, y1] = &setup.slabs;
        let (absorb_e, slots_e) = row_profiles(stored, x0, x1, row_of, nx, 0.0);
        let (absorb_h, slots_h) = row_profiles(stored, x0, x1, row_of, nx, 0.5);
        let columns = [(y0, true), (y1, false)].into_iter().filter(|(slab, _)| slab.cells > 0);
        let columns = columns.map(|(slab, low)| Columns::new(slab, low, ny, stored)).collect();
        let is_stored = |row: usize| row >= base && row < base + stored;
        let drives = setup.drives.iter().filter(|drive| is_stored(drive.i)).map(|drive| {
            let series = drive.series.iter().map(|&v| T::of(v)).collect();
            (drive.i - base, Drive { j: drive.j, series })
        });
        let own_wall = |row: usize| (row == 0 && own.start == 1) || (row == nx && own.end == nx);
        let probes = setup.receivers.iter().enumerate();
        let probes = probes.filter(|(_, node)| own.contains(&node[0]) || own_wall(node[0])).map(|(receiver, node)| {
            let samples = std::array::from_fn(|_| vec![0.0; setup.iterations]);
            (node[0] - base, Probe { receiver, j: node[1], samples })
        });
        let cuts = (setup.order == Order::Fourth).then(|| {
            let Cuts { hy, hx, ez_x, ez_y } = Cuts::new(setup, base, stored);
            let by_row = |list| ByRow::new(stored, list);
            CutRows { hx: by_row(hx), hy: by_row(hy), ez_x: by_row(ez_x), ez_y: by_row(ez_y) }
        });
        Self {
            base,
            wall: nx,
            width,
            ny,
            order: setup.order,
            image: Rows::zeros(usize::from(cuts.is_some()), width),
            cuts,
            ratio: T::of(setup.ratio()),
            limit: T::of(setup.limit()),
            ez: Rows::zeros(stored, width),
            hx: Rows::zeros(stored, width),
            hy: Rows::zeros(stored, width),
            cb,
            ca,
            absorb_e,
            absorb_h,
            phi_e: Rows::zeros(slots_e, width),
            phi_h: Rows::zeros(slots_h, width),
            columns,
            drives: ByRow::new(stored, drives.collect()),
            dispersion: Dispersion::new(setup, base, stored),
            probes: ByRow::new(stored, probes.collect()),
            beyond: None,
            own,
        }
    }

    /// The receivers and what they recorded.
    pub fn into_probes(self) -> Vec<Probe> {
        self.probes.things
    }

    /// The first value at a receiver that no sound run reaches.
    pub fn beyond_at_receivers(&self) -> Option<Beyond> {
        self.beyond
    }

    /// Makes the steps `first..first + count` of every row; a value moves not more than the block's rim in them.
    ///
    /// The lowest rows of each step get their H only, for E of the rows above; so do the highest with differences of fourth
    /// order.
    #[inline(always)]
    pub fn pass(&mut self, cones: &Cones, first: usize, count: usize) {
        let (begin, end) = (self.own.start, self.own.end);
        let reach = self.order.cells_per_step();
        let behind = reach / 2;
        let left = |s: usize| reach * (count - 1 - s);
        let first_front = if begin == 1 { 0 } else { begin - left(0) - 1 - behind };
        for front in first_front..end + left(0) + behind {
            for s in 0..count.min(front / reach + 1) {
                let (row, step) = (front - reach * s, first + s);
                let lowest = if begin == 1 { 1 } else { begin - left(s) };
                let highest = (end + left(s)).min(self.wall);
                if row + 1 + behind < lowest || row >= highest + behind {
                    continue;
                }
                if row < self.wall
                    && let Some((j, n)) = cones.span(row, step)
                {
                    self.step_h(row, j, n);
                }
                let Some(row) = row.checked_sub(behind) else { continue };
                if row >= lowest
                    && row < highest
                    && let Some((j, n)) = cones.span(row, step)
                {
                    self.step_e(row, j, n, step);
                }
                self.record(row - self.base, step + 1);
            }
        }
    }

    #[inline(always)]
    fn step_h(&mut self, row: usize, j: usize, n: usize) {
        let r = row - self.base;
        let Self { ez, hx, hy, phi_h, columns, absorb_h, image, .. } = self;
        let absorb = absorb_h[r].map(|(slot, profile)| (phi_h.at_mut(slot, j, n), profile));
        let row_h = RowOfH { hx: hx.at_mut(r, j, n), hy: hy.at_mut(r, j, n), absorb, columns, r, j };
        let (low, east) = (ez.at(r, j, n), ez.at(r + 1, j, n));
        let south = ez.at(r, j - 1, n);
        match self.order {
            Order::Second => row_h.step(Second { low, high: east }, Second { low: south, high: low }),
            Order::Fourth => {
                let (first, last) = (row == 0, row + 1 == self.wall);
                if first || last {
                    let inside = if first { east } else { low };
                    for (image, &value) in image.at_mut(0, j, n).iter_mut().zip(inside) {
                        *image = T::default() - value;
                    }
                }
                let before = if first { image.at(0, j, n) } else { ez.at(r - 1, j, n) };
                let behind = if last { image.at(0, j, n) } else { ez.at(r + 2, j, n) };
                let along_y =
                    Fourth { before: ez.two_before(r, j, n), low: south, high: low, behind: ez.at(r, j + 1, n) };
                row_h.step(Fourth { before, low, high: east, behind }, along_y);
                self.cut_h(r, j, n);
                self.image_h(r);
            }
        }
    }

    #[inline(always)]
    fn step_e(&mut self, row: usize, j: usize, n: usize, step: usize) {
        let r = row - self.base;
        if let Some(dispersion) = &mut self.dispersion {
            dispersion.keep(r, j, self.ez.at(r, j, n));
        }
        let Self { ez, hx, hy, phi_e, columns, absorb_e, .. } = self;
        let absorb = absorb_e[r].map(|(slot, profile)| (phi_e.at_mut(slot, j, n), profile));
        let ca = self.ca.as_ref().map(|ca| ca.at(r, j, n));
        let (cb, ratio) = (self.cb.at(r, j, n), self.ratio);
        let row_e = RowOfE { ez: ez.at_mut(r, j, n), ca, cb, ratio, absorb, columns, r, j };
        let (low, north) = (hx.at(r, j, n), hx.at(r, j + 1, n));
        let (west, high) = (hy.at(r - 1, j, n), hy.at(r, j, n));
        match self.order {
            Order::Second => row_e.step(Second { low: west, high }, Second { low, high: north }),
            Order::Fourth => {
                let before = if row == 1 { west } else { hy.at(r - 2, j, n) };
                let behind = if row + 1 == self.wall { high } else { hy.at(r + 1, j, n) };
                let along_y = Fourth { before: hx.at(r, j - 1, n), low, high: north, behind: hx.at(r, j + 2, n) };
                row_e.step(Fourth { before, low: west, high, behind }, along_y);
                self.cut_e(r, j, n);
            }
        }
        for drive in self.drives.at(r).iter().filter(|drive| (j..j + n).contains(&drive.j)) {
            let ez = self.ez.at_mut(r, drive.j, 1);
            ez[0] = ez[0] - drive.series[step];
        }
        if let Some(dispersion) = &mut self.dispersion {
            dispersion.relax_row(r, j, self.ez.at_mut(r, j, n));
        }
        if self.order == Order::Fourth {
            self.image_e(r);
        }
    }

    /// Writes the images of H behind the walls at both ends of a row.
    #[inline(always)]
    fn image_h(&mut self, r: usize) {
        let (first, last) = (self.hx.at(r, 1, 1)[0], self.hx.at(r, self.ny, 1)[0]);
        self.hx.at_mut(r, 0, 1)[0] = first;
        self.hx.at_mut(r, self.ny + 1, 1)[0] = last;
    }

    /// Writes the images of E behind the walls at both ends of a row.
    #[inline(always)]
    fn image_e(&mut self, r: usize) {
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
            for c in columns.iter_mut().filter(|c| (c.j..c.j + c.count).contains(&cut.j)) {
                let at = cut.j - c.j;
                *field = *field - c.h[0][at] * more;
                let phi = &mut c.phi_h.at_mut(r, 1 + at, 1)[0];
                *phi = *phi - c.h[3][at] * more;
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
            for c in columns.iter_mut().filter(|c| (c.j..c.j + c.count).contains(&cut.j)) {
                let at = cut.j - c.j;
                *field = *field - cb * (*ratio * (c.e[0][at] * more));
                let phi = &mut c.phi_e.at_mut(r, 1 + at, 1)[0];
                *phi = *phi - c.e[3][at] * more;
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

    /// Takes the samples of a row's receivers.
    #[inline(always)]
    fn record(&mut self, r: usize, sample: usize) {
        for probe in self.probes.at_mut(r) {
            let ez = self.ez.at(r, probe.j, 1)[0];
            let values = [ez, self.hx.at(r, probe.j + 1, 1)[0], self.hy.at(r, probe.j, 1)[0]];
            for (samples, value) in probe.samples.iter_mut().zip(values) {
                samples[sample] = value.double();
            }
            if ez.is_beyond(self.limit) && self.beyond.is_none() {
                self.beyond = Some(Beyond { step: sample, node: [self.base + r, probe.j], value: ez.double() });
            }
        }
    }

    /// Copies the state of the first or the last rows of the block's own into a letter.
    pub fn pack(&mut self, last: bool, rim: usize, letter: &mut Vec<T>) {
        letter.clear();
        let begin = if last { self.own.end - rim } else { self.own.start };
        for row in begin..begin + rim {
            self.each_of_row(row - self.base, &mut |values| letter.extend_from_slice(values));
        }
    }

    /// Takes the state of the neighbour's rows next to the block's last or first row from a letter.
    pub fn unpack(&mut self, last: bool, rim: usize, letter: &[T]) {
        let begin = if last { self.own.end } else { self.own.start - rim };
        let mut rest = letter;
        for row in begin..begin + rim {
            self.each_of_row(row - self.base, &mut |values| {
                let (mine, others) = rest.split_at(values.len());
                values.copy_from_slice(mine);
                rest = others;
            });
            if self.order == Order::Fourth {
                self.image_h(row - self.base);
                self.image_e(row - self.base);
            }
        }
    }

    /// All that a step changes in a row.
    fn each_of_row(&mut self, r: usize, visit: &mut impl FnMut(&mut [T])) {
        visit(self.ez.at_mut(r, 1, self.width));
        visit(self.hx.at_mut(r, 1, self.width));
        visit(self.hy.at_mut(r, 1, self.width));
        if let Some((slot, _)) = self.absorb_e[r] {
            visit(self.phi_e.at_mut(slot, 1, self.width));
        }
        if let Some((slot, _)) = self.absorb_h[r] {
            visit(self.phi_h.at_mut(slot, 1, self.width));
        }
        for c in &mut self.columns {
            visit(c.phi_e.at_mut(r, 1, c.count));
            visit(c.phi_h.at_mut(r, 1, c.count));
        }
        if let Some(dispersion) = &mut self.dispersion {
            visit(dispersion.memory_of_row(r));
        }
    }

    /// The first value in the block's own rows that no sound run reaches; `step` is the number of steps made.
    pub fn find_beyond(&self, step: usize) -> Option<Beyond> {
        self.own.clone().find_map(|row| {
            let ez = self.ez.at(row - self.base, 1, self.width);
            let j = ez.iter().position(|v| v.is_beyond(self.limit))?;
            Some(Beyond { step, node: [row, j + 1], value: ez[j].double() })
        })
    }
}

/// A row of H with all that changes in its step, from node `j` on.
struct RowOfH<'a, T> {
    hx: &'a mut [T],
    hy: &'a mut [T],
    absorb: Option<(&'a mut [T], RowProfile<T>)>,
    columns: &'a mut [Columns<T>],
    r: usize,
    j: usize,
}

impl<T: Real> RowOfH<'_, T> {
    #[inline(always)]
    fn step<D: Difference<T>>(self, along_x: D, along_y: D) {
        let Self { hx, hy, absorb, columns, r, j: from } = self;
        kernel::update_h(hx, hy, along_x, along_y);
        if let Some((phi, profile)) = absorb {
            kernel::absorb_row_h(hy, along_x, phi, profile);
        }
        for c in columns {
            let Some((j, n)) = overlap(c.j, c.count, from, hx.len()) else { continue };
            let phi = c.phi_h.at_mut(r, 1 + j - c.j, n);
            let along_y = along_y.part(j - from, n);
            kernel::absorb_columns_h(&mut hx[j - from..][..n], along_y, phi, profile(&c.h, j - c.j));
        }
    }
}

/// A row of E with all that changes in its step, from node `j` on.
struct RowOfE<'a, T> {
    ez: &'a mut [T],
    ca: Option<&'a [T]>,
    cb: &'a [T],
    ratio: T,
    absorb: Option<(&'a mut [T], RowProfile<T>)>,
    columns: &'a mut [Columns<T>],
    r: usize,
    j: usize,
}

impl<T: Real> RowOfE<'_, T> {
    #[inline(always)]
    fn step<D: Difference<T>>(self, along_x: D, along_y: D) {
        let Self { ez, ca, cb, ratio, absorb, columns, r, j: from } = self;
        match ca {
            None => kernel::update_e(ez, cb, ratio, along_x, along_y),
            Some(ca) => kernel::update_e_lossy(ez, ca, cb, ratio, along_x, along_y),
        }
        if let Some((phi, profile)) = absorb {
            kernel::absorb_row_e(ez, cb, along_x, phi, profile);
        }
        for c in columns {
            let Some((j, n)) = overlap(c.j, c.count, from, ez.len()) else { continue };
            let phi = c.phi_e.at_mut(r, 1 + j - c.j, n);
            let (ez, cb, along_y) = (&mut ez[j - from..][..n], &cb[j - from..][..n], along_y.part(j - from, n));
            kernel::absorb_columns_e(ez, cb, ratio, along_y, phi, profile(&c.e, j - c.j));
        }
    }
}

#[inline(always)]
fn profile<T>(p: &[Vec<T>; 4], from: usize) -> ColumnProfile<'_, T> {
    ColumnProfile { ra_less_one: &p[0][from..], rb: &p[1][from..], re: &p[2][from..], rf: &p[3][from..] }
}

/// Profiles of the rows that lie within the slabs at the ends of x, and how many there are; `shift` is ½ for H.
fn row_profiles<T: Real>(
    rows: usize,
    low: &Slab,
    high: &Slab,
    row_of: impl Fn(usize) -> f64,
    nx: usize,
    shift: f64,
) -> (Vec<AbsorbingRow<T>>, usize) {
    let mut slots = 0;
    let mut of_row = |r: usize| {
        let i = row_of(r) + shift;
        let (below, above) = (low.cells as f64 - i, i - (nx - high.cells) as f64);
        let [ra_less_one, rb, re, rf] = if below > 0.0 {
            low.at(below)
        } else if above > 0.0 {
            high.at(above)
        } else {
            return None;
        };
        slots += 1;
        let [ra_less_one, rb, re, rf] = [ra_less_one, rb, re, rf].map(T::of);
        Some((slots - 1, RowProfile { ra_less_one, rb, re, rf }))
    };
    let profiles = (0..rows).map(&mut of_row).collect();
    (profiles, slots)
}

impl<T: Real> Columns<T> {
    /// `low`: at `y = 0`. The count is padded to whole vectors with nodes that absorb nothing.
    fn new(slab: &Slab, low: bool, ny: usize, rows: usize) -> Self {
        let count = slab.cells.next_multiple_of(LANES).min(ny);
        let j = if low { 1 } else { ny + 1 - count };
        let depth = |j: f64| if low { slab.cells as f64 - j } else { j - (ny - slab.cells) as f64 };
        let sample = |shift: f64| -> [Vec<T>; 4] {
            std::array::from_fn(|k| (j..j + count).map(|j| T::of(slab.at(depth(j as f64 - shift))[k])).collect())
        };
        let phi = || Rows::zeros(rows, count.next_multiple_of(LANES));
        Self { j, count, e: sample(0.0), h: sample(0.5), phi_e: phi(), phi_h: phi() }
    }
}
