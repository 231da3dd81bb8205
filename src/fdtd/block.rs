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
//! Within a pass the rows are taken a few at a time, so that a row that a step leaves in the innermost cache is taken by the
//! next steps at once: each step takes four rows before the next step takes the four that begin one row (three rows) earlier.
//!
//! The outer walls conduct perfectly. Differences of fourth order see behind them the images of what lies before: E
//! reversed, H the same. Along y the images stand in the padding of each row.

use std::ops::Range;

use super::dispersion::Dispersion;
use super::kernel::{Across, RowOfE, RowOfH, RowProfile, SecondRow};
use super::lanes::Lanes;
use super::layout::{LANES, Rows, padded_width};
use super::reach::Cones;
use super::real::Real;
use super::setup::Setup;
use super::slab::Slab;
use crate::model::Order;
pub use by_row::{Beyond, Probe};
use by_row::{ByRow, Drive};
use columns::Columns;
pub use columns::absorbing_nodes;
use fourth::CutRows;

mod by_row;
mod columns;
mod fourth;
mod rims;

/// Rows that a step takes before the next step takes its own. On 750 x 500 and 1500 x 1000 cells 4 rows were faster than one
/// by a tenth to a fifth, 2 to 8 within 5 % of 4 (single precision, Zen 5, one thread).
const ROWS_AT_ONCE: usize = 4;

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
    columns: Columns<T>,
    /// Present with differences of fourth order only.
    cuts: Option<CutRows>,
    /// A row of zeros; with differences of fourth order the image of a row behind a wall.
    image: Rows<T>,
    drives: ByRow<Drive<T>>,
    dispersion: Option<Dispersion<T>>,
    probes: ByRow<Probe>,
    beyond: Option<Beyond>,
}

/// Place in the memory and profile of a row within the absorbing cells at an end of x; `None` for a row outside them.
type AbsorbingRow<T> = Option<(usize, RowProfile<T>)>;

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
        let cuts = (setup.order == Order::Fourth).then(|| CutRows::new(setup, base, stored));
        Self {
            base,
            wall: nx,
            width,
            ny,
            order: setup.order,
            image: Rows::zeros(1, width),
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
            columns: Columns::new([y0, y1], ny, stored),
            drives: ByRow::new(stored, drives.collect()),
            dispersion: Dispersion::new(setup, base, stored),
            probes: ByRow::new(stored, probes.collect()),
            beyond: None,
            own,
        }
    }

    /// The receivers and what they recorded.
    pub fn into_probes(self) -> Vec<Probe> {
        self.probes.into_things()
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
    pub fn pass<C: Lanes<T>>(&mut self, cones: &Cones, first: usize, count: usize) {
        let (begin, end) = (self.own.start, self.own.end);
        let reach = self.order.cells_per_step();
        let behind = reach / 2;
        let left = |s: usize| reach * (count - 1 - s);
        let first_front = if begin == 1 { 0 } else { begin - left(0) - 1 - behind };
        for front in (first_front..end + left(0) + behind).step_by(ROWS_AT_ONCE) {
            for s in 0..count {
                let lowest = if begin == 1 { 1 } else { begin - left(s) };
                let highest = (end + left(s)).min(self.wall);
                let from = front.saturating_sub(reach * s).max(lowest.saturating_sub(1 + behind));
                let until = (front + ROWS_AT_ONCE).saturating_sub(reach * s).min(highest + behind);
                for row in from..until {
                    match self.order {
                        Order::Second => self.step_second::<C>(cones, row, row >= lowest, first + s),
                        Order::Fourth => self.step_fourth::<C>(cones, row, lowest..highest, first + s),
                    }
                }
            }
        }
    }

    /// H of a row, and its E with `with_e`.
    #[inline(always)]
    fn step_second<C: Lanes<T>>(&mut self, cones: &Cones, row: usize, with_e: bool, step: usize) {
        let r = row - self.base;
        if let Some((j, n)) = cones.span(row, step) {
            if let (true, Some(dispersion)) = (with_e, &mut self.dispersion) {
                dispersion.keep(r, j, self.ez.at(r, j, n));
            }
            let row = self.row(r, j, n);
            if with_e {
                row.step::<C>();
                self.drive(r, j, n, step);
            } else {
                row.step_h::<C>();
            }
        }
        self.record(r, step + 1);
    }

    /// A span of a stored row for the kernel.
    #[inline(always)]
    fn row(&mut self, r: usize, j: usize, n: usize) -> SecondRow<'_, T> {
        let (first, count) = ((j - 1) / LANES + 1, n / LANES);
        let Self { ez, hx, hy, cb, ca, ratio, phi_e, phi_h, columns, absorb_e, absorb_h, image, .. } = self;
        let ends = columns.ends(first, count);
        let (west, hy) = match r {
            0 => (image.chunks(0, first, count), hy.chunks_mut(0, first, count)),
            _ => hy.with_last(r, first, count),
        };
        let beyond = hx.at(r, j + n, 1)[0];
        let (ez, east) = ez.with_next(r, first, count + 1);
        let h = RowOfH {
            hx: hx.chunks_mut(r, first, count),
            hy,
            across: across(absorb_h[r], phi_h, first, count),
            along: columns.h.along(r, ends),
        };
        let e = RowOfE {
            cb: cb.chunks(r, first, count),
            ca: ca.as_ref().map(|ca| ca.chunks(r, first, count)),
            ratio: *ratio,
            across: across(absorb_e[r], phi_e, first, count),
            along: columns.e.along(r, ends),
        };
        SecondRow { h, e, ez, beyond, east, west }
    }

    /// Lets sources and dispersion act on E of a row, once it has been stepped.
    #[inline(always)]
    fn drive(&mut self, r: usize, j: usize, n: usize, step: usize) {
        for drive in self.drives.at(r).iter().filter(|drive| (j..j + n).contains(&drive.j)) {
            let ez = self.ez.at_mut(r, drive.j, 1);
            ez[0] = ez[0] - drive.series[step];
        }
        if let Some(dispersion) = &mut self.dispersion {
            dispersion.relax_row(r, j, self.ez.at_mut(r, j, n));
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

    /// The first value in the block's own rows that no sound run reaches; `step` is the number of steps made.
    pub fn find_beyond(&self, step: usize) -> Option<Beyond> {
        self.own.clone().find_map(|row| {
            let ez = self.ez.at(row - self.base, 1, self.width);
            let j = ez.iter().position(|v| v.is_beyond(self.limit))?;
            Some(Beyond { step, node: [row, j + 1], value: ez[j].double() })
        })
    }
}

/// What absorbs across a span of a row.
#[inline(always)]
fn across<T: Real>(row: AbsorbingRow<T>, phi: &mut Rows<T>, first: usize, count: usize) -> Option<Across<'_, T>> {
    row.map(|(slot, profile)| Across { phi: phi.chunks_mut(slot, first, count), profile })
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
