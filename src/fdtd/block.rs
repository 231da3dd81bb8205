//! A block of rows with everything that acts on them: one thread's share of the grid.
//!
//! Row `r` of a block is row `first - 1 + r` of the grid; rows 0 and `rows + 1` are copies of the neighbours' (or the
//! walls, which stay zero). A block repeats the step of `Hy` west of its first row, so that only E rows are exchanged,
//! once per step, and the bits do not depend on how the grid is cut.

use super::coefficients::Slab;
use super::dispersion::Dispersion;
use super::kernel::{self, ColumnProfile, RowProfile};
use super::layout::{LANES, Rows, padded_width};
use super::real::Real;
use super::setup::Setup;

/// One thread's share of the grid.
pub struct Block<T> {
    /// Row of the grid that is row 1 of this block.
    pub first: usize,
    /// Rows of E that this block steps.
    pub rows: usize,
    width: usize,
    ratio: T,
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
    drives: Vec<Drive<T>>,
    dispersion: Option<Dispersion<T>>,
    probes: Vec<Probe>,
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
    row: usize,
    j: usize,
    /// What is taken from E, per step.
    series: Vec<T>,
}

/// A receiver within the block, and what it has recorded.
pub struct Probe {
    /// Place in the model's list of receivers.
    pub receiver: usize,
    row: usize,
    j: usize,
    /// Ez, Hx, Hy, one sample per step; H still scaled.
    pub samples: [Vec<f64>; 3],
}

impl<T: Real> Block<T> {
    /// Allocates the rows `first..first + rows` of the grid.
    pub fn new(setup: &Setup<'_>, first: usize, rows: usize) -> Self {
        let [nx, ny] = setup.painted.cells_xy;
        let width = padded_width(ny);
        let stored = rows + 2;
        let mut cb = Rows::zeros(stored, width);
        let mut ca = setup.lossy().then(|| Rows::zeros(stored, width));
        for r in 1..=rows {
            let entries = &setup.painted.edge_z[(first - 1 + r) * (ny + 1)..][..ny];
            for (j, &entry) in entries.iter().enumerate().skip(1) {
                let edge = &setup.edges[entry as usize];
                cb.at_mut(r, j, 1)[0] = T::of(edge.cb);
                if let Some(ca) = &mut ca {
                    ca.at_mut(r, j, 1)[0] = T::of(edge.ca);
                }
            }
        }
        let row_of = |r: usize| (first - 1 + r) as f64;
        let [x0, _, x1, _] = &setup.slabs;
        let (absorb_e, slots_e) = row_profiles(rows, x0, x1, row_of, nx, 0.0);
        let (absorb_h, slots_h) = row_profiles(rows, x0, x1, row_of, nx, 0.5);
        let [_, y0, _, y1] = &setup.slabs;
        let columns = [(y0, true), (y1, false)].into_iter().filter(|(slab, _)| slab.cells > 0);
        let columns = columns.map(|(slab, low)| Columns::new(slab, low, ny, rows)).collect();
        let owned = |row: usize| {
            let last_block = first + rows == nx;
            (row >= first && row < first + rows) || (row == 0 && first == 1) || (row == nx && last_block)
        };
        let mut drives: Vec<_> = setup
            .drives
            .iter()
            .filter(|drive| owned(drive.i))
            .map(|drive| {
                let series = drive.series.iter().map(|&v| T::of(v)).collect();
                Drive { row: drive.i + 1 - first, j: drive.j, series }
            })
            .collect();
        drives.sort_by_key(|drive| drive.row);
        let probe = |(receiver, node): (usize, &[usize; 3])| Probe {
            receiver,
            row: node[0] + 1 - first,
            j: node[1],
            samples: std::array::from_fn(|_| Vec::with_capacity(setup.iterations)),
        };
        let probes = setup.receivers.iter().enumerate().filter(|(_, node)| owned(node[0])).map(probe).collect();
        Self {
            first,
            rows,
            width,
            ratio: T::of(setup.ratio()),
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
            drives,
            dispersion: Dispersion::new(setup, first, rows),
            probes,
        }
    }

    /// Takes the receivers' samples before a step.
    pub fn record(&mut self) {
        for probe in &mut self.probes {
            let values = [
                self.ez.at(probe.row, probe.j, 1)[0],
                self.hx.at(probe.row, probe.j + 1, 1)[0],
                self.hy.at(probe.row, probe.j, 1)[0],
            ];
            for (samples, value) in probe.samples.iter_mut().zip(values) {
                samples.push(value.double());
            }
        }
    }

    /// The receivers and what they recorded.
    pub fn into_probes(self) -> Vec<Probe> {
        self.probes
    }

    /// One step of every row: H of a row, then its E while both are in the cache.
    ///
    /// Row `r` of E needs `Hy` of rows `r` and `r - 1` of the same step, and `Hy` of row `r` needs E of rows `r` and
    /// `r + 1` of the step before, so rows may be stepped one after the other in place.
    #[inline(always)]
    pub fn sweep(&mut self, step: usize) {
        let mut progress = Cursor::default();
        self.step_hy_west();
        for r in 1..=self.rows {
            self.step_h(r);
            self.step_e(r, step, &mut progress);
        }
    }

    #[inline(always)]
    fn step_hy_west(&mut self) {
        let n = self.width;
        let (ez, ez_east) = (self.ez.at(0, 1, n), self.ez.at(1, 1, n));
        kernel::update_hy(self.hy.at_mut(0, 1, n), ez, ez_east);
        if let Some((slot, profile)) = self.absorb_h[0] {
            kernel::absorb_row_h(self.hy.at_mut(0, 1, n), ez, ez_east, self.phi_h.at_mut(slot, 1, n), profile);
        }
    }

    #[inline(always)]
    fn step_h(&mut self, r: usize) {
        let n = self.width;
        let (ez, ez_south, ez_east) = (self.ez.at(r, 1, n), self.ez.at(r, 0, n), self.ez.at(r + 1, 1, n));
        kernel::update_h(self.hx.at_mut(r, 1, n), self.hy.at_mut(r, 1, n), ez, ez_south, ez_east);
        if let Some((slot, profile)) = self.absorb_h[r] {
            kernel::absorb_row_h(self.hy.at_mut(r, 1, n), ez, ez_east, self.phi_h.at_mut(slot, 1, n), profile);
        }
        for c in &mut self.columns {
            let (ez, ez_south) = (self.ez.at(r, c.j, c.count), self.ez.at(r, c.j - 1, c.count));
            let phi = c.phi_h.at_mut(r, 1, c.count);
            kernel::absorb_columns_h(self.hx.at_mut(r, c.j, c.count), ez, ez_south, phi, profile(&c.h));
        }
    }

    #[inline(always)]
    fn step_e(&mut self, r: usize, step: usize, progress: &mut Cursor) {
        let n = self.width;
        if let Some(dispersion) = &mut self.dispersion {
            dispersion.keep(r, self.ez.at(r, 1, n), progress.span);
        }
        let ez = self.ez.at_mut(r, 1, n);
        let (hx, hx_north) = (self.hx.at(r, 1, n), self.hx.at(r, 2, n));
        let (hy, hy_west) = (self.hy.at(r, 1, n), self.hy.at(r - 1, 1, n));
        let cb = self.cb.at(r, 1, n);
        match &self.ca {
            None => kernel::update_e(ez, cb, self.ratio, hx, hx_north, hy, hy_west),
            Some(ca) => kernel::update_e_lossy(ez, ca.at(r, 1, n), cb, self.ratio, hx, hx_north, hy, hy_west),
        }
        if let Some((slot, profile)) = self.absorb_e[r] {
            kernel::absorb_row_e(ez, cb, hy, hy_west, self.phi_e.at_mut(slot, 1, n), profile);
        }
        for c in &mut self.columns {
            let (hx, hx_north) = (self.hx.at(r, c.j, c.count), self.hx.at(r, c.j + 1, c.count));
            let (ez, cb) = (self.ez.at_mut(r, c.j, c.count), self.cb.at(r, c.j, c.count));
            let phi = c.phi_e.at_mut(r, 1, c.count);
            kernel::absorb_columns_e(ez, cb, self.ratio, hx, hx_north, phi, profile(&c.e));
        }
        while let Some(drive) = self.drives.get(progress.drive).filter(|drive| drive.row == r) {
            let ez = self.ez.at_mut(r, drive.j, 1);
            ez[0] = ez[0] - drive.series[step];
            progress.drive += 1;
        }
        if let Some(dispersion) = &mut self.dispersion {
            dispersion.relax_row(r, self.ez.at_mut(r, 1, n), &mut progress.span);
        }
    }

    /// E of the first and the last row: what the neighbours need.
    pub fn rim(&self, last: bool) -> &[T] {
        self.ez.at(if last { self.rows } else { 1 }, 1, self.width)
    }

    /// Where the neighbours' E goes.
    pub fn halo(&mut self, last: bool) -> &mut [T] {
        self.ez.at_mut(if last { self.rows + 1 } else { 0 }, 1, self.width)
    }

    /// The first node whose E is not a number or larger than `limit`, as `(i, j)` of the grid.
    pub fn find_beyond(&self, limit: T) -> Option<[usize; 2]> {
        let beyond = |v: &T| v.is_beyond(limit);
        (1..=self.rows).find_map(|r| {
            let j = self.ez.at(r, 1, self.width).iter().position(beyond)?;
            Some([self.first - 1 + r, j + 1])
        })
    }

    /// E at a node of the grid, V/m; `None` where another block steps it.
    pub fn value_at(&self, [i, j]: [usize; 2]) -> Option<f64> {
        let row = (i + 1).checked_sub(self.first).filter(|row| (1..=self.rows).contains(row))?;
        Some(self.ez.at(row, j, 1)[0].double())
    }

    /// As [`Block::find_beyond`], at the receivers only.
    pub fn find_beyond_at_receivers(&self, limit: T) -> Option<[usize; 2]> {
        let beyond = |probe: &&Probe| self.ez.at(probe.row, probe.j, 1)[0].is_beyond(limit);
        self.probes.iter().find(beyond).map(|probe| [self.first - 1 + probe.row, probe.j])
    }
}

/// How far a sweep has come in the lists that are sorted by row.
#[derive(Default)]
struct Cursor {
    drive: usize,
    span: usize,
}

#[inline(always)]
fn profile<T>(p: &[Vec<T>; 4]) -> ColumnProfile<'_, T> {
    ColumnProfile { ra_less_one: &p[0], rb: &p[1], re: &p[2], rf: &p[3] }
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
    let profiles = (0..=rows).map(&mut of_row).collect();
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
        let phi = || Rows::zeros(rows + 1, count.next_multiple_of(LANES));
        Self { j, count, e: sample(0.0), h: sample(0.5), phi_e: phi(), phi_h: phi() }
    }
}
