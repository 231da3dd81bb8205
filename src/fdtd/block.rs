//! A block of rows with everything that acts on them: one thread's share of the grid.
//!
//! A block is stepped several steps at a time, in one *pass* over its rows: when the front is at row `f`, step `s` of the
//! pass takes row `f - s`, so a row goes through all steps while it is in the cache. In place this is exact: E of row `r`
//! takes Hy of rows `r` and `r - 1` of the same step, which the next step reaches only after it, and Hy of row `r` takes E
//! of rows `r` and `r + 1` of the step before, made just before at the same front.
//!
//! A block stores as many rows of each neighbour as a pass has steps, and steps them too, one row fewer on each side in each
//! step: what it knows of the neighbours at the beginning of a pass is enough for its own rows until the end. Each value is
//! made by the same operations wherever it is made, so the bits do not depend on how the grid is cut.

use std::ops::Range;

use super::coefficients::Slab;
use super::dispersion::{Dispersion, overlap};
use super::kernel::{self, ColumnProfile, RowProfile};
use super::layout::{LANES, Rows, padded_width};
use super::reach::Cones;
use super::real::Real;
use super::setup::Setup;

/// One thread's share of the grid.
pub struct Block<T> {
    /// Rows of the grid that this block answers for.
    pub own: Range<usize>,
    /// Row of the grid that is stored row 0.
    base: usize,
    /// Row of the far wall.
    wall: usize,
    width: usize,
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
    fn at(&mut self, row: usize) -> &mut [V] {
        &mut self.things[self.of_row[row]..self.of_row[row + 1]]
    }
}

impl<T: Real> Block<T> {
    /// Allocates the rows `own` of the grid, with `depth` rows of each neighbour.
    ///
    /// Every block of the grid must have `depth` rows at least, but for one that has the grid to itself.
    pub fn new(setup: &Setup<'_>, own: Range<usize>, depth: usize) -> Self {
        let [nx, ny] = setup.painted.cells_xy;
        let width = padded_width(ny);
        let base = if own.start == 1 { 0 } else { own.start - depth };
        let stored = (own.end + depth).min(nx + 1) - base;
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
        Self {
            base,
            wall: nx,
            width,
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

    /// Makes the steps `first..first + count` of every row. `count` is not more than the block's depth.
    ///
    /// The lowest row of each step gets its H only: Hy for E of the row above.
    #[inline(always)]
    pub fn pass(&mut self, cones: &Cones, first: usize, count: usize) {
        let (begin, end) = (self.own.start, self.own.end);
        let first_front = if begin == 1 { 0 } else { begin - count };
        for front in first_front..end + count - 1 {
            for s in 0..count.min(front + 1) {
                let row = front - s;
                let lowest = if begin == 1 { 0 } else { begin + s - count };
                if row < lowest || row >= (end + count - 1 - s).min(self.wall) {
                    continue;
                }
                let (r, step) = (row - self.base, first + s);
                if let Some((j, n)) = cones.span(row, step) {
                    self.step_h(r, j, n);
                    if row > lowest {
                        self.step_e(r, j, n, step);
                    }
                }
                self.record(r, step + 1);
            }
        }
    }

    #[inline(always)]
    fn step_h(&mut self, r: usize, j: usize, n: usize) {
        let (ez, ez_south, ez_east) = (self.ez.at(r, j, n), self.ez.at(r, j - 1, n), self.ez.at(r + 1, j, n));
        kernel::update_h(self.hx.at_mut(r, j, n), self.hy.at_mut(r, j, n), ez, ez_south, ez_east);
        if let Some((slot, profile)) = self.absorb_h[r] {
            kernel::absorb_row_h(self.hy.at_mut(r, j, n), ez, ez_east, self.phi_h.at_mut(slot, j, n), profile);
        }
        for c in &mut self.columns {
            let Some((j, n)) = overlap(c.j, c.count, j, n) else { continue };
            let (ez, ez_south) = (self.ez.at(r, j, n), self.ez.at(r, j - 1, n));
            let phi = c.phi_h.at_mut(r, 1 + j - c.j, n);
            kernel::absorb_columns_h(self.hx.at_mut(r, j, n), ez, ez_south, phi, profile(&c.h, j - c.j));
        }
    }

    #[inline(always)]
    fn step_e(&mut self, r: usize, j: usize, n: usize, step: usize) {
        if let Some(dispersion) = &mut self.dispersion {
            dispersion.keep(r, j, self.ez.at(r, j, n));
        }
        let ez = self.ez.at_mut(r, j, n);
        let (hx, hx_north) = (self.hx.at(r, j, n), self.hx.at(r, j + 1, n));
        let (hy, hy_west) = (self.hy.at(r, j, n), self.hy.at(r - 1, j, n));
        let cb = self.cb.at(r, j, n);
        match &self.ca {
            None => kernel::update_e(ez, cb, self.ratio, hx, hx_north, hy, hy_west),
            Some(ca) => kernel::update_e_lossy(ez, ca.at(r, j, n), cb, self.ratio, hx, hx_north, hy, hy_west),
        }
        if let Some((slot, profile)) = self.absorb_e[r] {
            kernel::absorb_row_e(ez, cb, hy, hy_west, self.phi_e.at_mut(slot, j, n), profile);
        }
        for c in &mut self.columns {
            let Some((j, n)) = overlap(c.j, c.count, j, n) else { continue };
            let (hx, hx_north) = (self.hx.at(r, j, n), self.hx.at(r, j + 1, n));
            let (ez, cb) = (self.ez.at_mut(r, j, n), self.cb.at(r, j, n));
            let phi = c.phi_e.at_mut(r, 1 + j - c.j, n);
            kernel::absorb_columns_e(ez, cb, self.ratio, hx, hx_north, phi, profile(&c.e, j - c.j));
        }
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
        for probe in self.probes.at(r) {
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
    pub fn pack(&mut self, last: bool, depth: usize, letter: &mut Vec<T>) {
        letter.clear();
        let begin = if last { self.own.end - depth } else { self.own.start };
        for row in begin..begin + depth {
            self.each_of_row(row - self.base, &mut |values| letter.extend_from_slice(values));
        }
    }

    /// Takes the state of the neighbour's rows next to the block's last or first row from a letter.
    pub fn unpack(&mut self, last: bool, depth: usize, letter: &[T]) {
        let begin = if last { self.own.end } else { self.own.start - depth };
        let mut rest = letter;
        for row in begin..begin + depth {
            self.each_of_row(row - self.base, &mut |values| {
                let (mine, others) = rest.split_at(values.len());
                values.copy_from_slice(mine);
                rest = others;
            });
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
