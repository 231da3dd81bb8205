//! FDTD(2,4) in three dimensions: four-point differences, plane by plane on all threads.
//!
//! The arrays are those of `sheet` in scale and place, each as one block with a layer of images around the grid: behind an
//! outer wall lies E along the wall reversed, and H along it the same. Where a conductor stands between two places of H the
//! difference does not look through it, on both ways, as in two dimensions (`conductor`).
//!
//! H is stepped as a whole before E: simple, and bound by memory. There are no light cones, no tiles and no
//! checkpoints yet; media that relax or are magnetic, sections and absorbing cells of second order are refused by name.

use std::time::{Duration, Instant};

use rayon::prelude::*;

use super::super::FdtdError;
use super::super::real::Real;
use super::super::slab::Slab;
use super::absorbing_fourth::{Absorbing4, Profiles4};
use super::drive::Act;
use super::kernel::{difference, take_e, take_h};
use super::setup::{OTHERS, Setup3, axis_of};
use crate::forward::{OnProgress, Progress};
use crate::model::Model;

/// Steps between two looks at the whole field.
const STEPS_BETWEEN_SCANS: usize = 128;

/// The fields and what lies on the edges.
struct Fields<T> {
    /// Nodes stored along x, y, z: those of the grid and a layer around.
    n: [usize; 3],
    cells: [usize; 3],
    e: [Vec<T>; 3],
    h: [Vec<T>; 3],
    /// Coefficients of each entry of the palette, and one more for what is held at zero.
    ca: [Vec<T>; 3],
    cb: [Vec<T>; 3],
    /// Entry on each stored edge.
    entry: [Vec<u32>; 3],
    /// Differences of E that a conductor within the grid cuts.
    cuts_h: Cuts,
    /// Those of H, by the component of E that they make.
    cuts_e: Cuts,
}

/// A place within a plane whose difference is cut at the lower or at the upper node.
#[derive(Clone, Copy)]
struct Cut {
    row: u32,
    k: u32,
    low: bool,
    high: bool,
}

/// Ex, Ey, Ez, Hx, Hy, Hz at a receiver, one sample a step, still scaled.
type Samples = [Vec<f64>; 6];
/// Cuts of each component along the first and the second axis of [`OTHERS`], by plane.
type Cuts = [[Vec<Vec<Cut>>; 2]; 3];

/// Steps a model; returns what each receiver recorded, still scaled, and the wall time of the loop.
///
/// # Errors
/// When a field diverges or the caller asks to stop.
pub fn run<T: Real>(
    setup: &Setup3<'_>,
    threads: usize,
    on_progress: OnProgress<'_>,
) -> Result<(Vec<Samples>, Duration), FdtdError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.map_err(|_| FdtdError::Stopped)?;
    let mut fields = Fields::<T>::new(setup);
    let mut absorbing = Absorbing4::<T>::new(setup);
    let profiles = Profiles4::<T>::new(setup);
    let mut samples: Vec<Samples> =
        setup.receivers.iter().map(|_| std::array::from_fn(|_| vec![0.0; setup.iterations])).collect();
    let (limit, ratios) = (T::of(setup.limit()), std::array::from_fn(|axis| T::of(setup.ratio(axis))));
    let begin = Instant::now();
    let mut last = begin;
    for step in 0..setup.iterations {
        for (node, samples) in setup.receivers.iter().zip(&mut samples) {
            for (field, samples) in samples.iter_mut().enumerate() {
                let list = if field < 3 { &fields.e[field] } else { &fields.h[field - 3] };
                // Nothing lies behind the last cells: what is stored there are images.
                let inside = (0..3).all(|axis| field == axis + 3 || node[axis] < fields.cells[axis]);
                samples[step] = if inside || field < 3 { list[fields.place(*node)].double() } else { 0.0 };
            }
        }
        let is_last = step + 1 == setup.iterations;
        if is_last || step % STEPS_BETWEEN_SCANS == STEPS_BETWEEN_SCANS - 1 {
            fields.check(setup, step, limit)?;
        }
        if is_last {
            break;
        }
        if last.elapsed() > Duration::from_millis(100) {
            last = Instant::now();
            if on_progress(Progress { done: step, total: setup.iterations }).is_break() {
                return Err(FdtdError::Stopped);
            }
        }
        pool.install(|| fields.step_h(&mut absorbing, &profiles));
        fields.drive(setup, step, true);
        fields.mirror_h();
        pool.install(|| fields.step_e(ratios, &mut absorbing, &profiles));
        fields.drive(setup, step, false);
        fields.mirror_e();
    }
    let _ = on_progress(Progress { done: setup.iterations, total: setup.iterations });
    Ok((samples, begin.elapsed()))
}

/// What of a model these differences do not take; `None` when nothing.
pub fn refusal(model: &Model, setup: &Setup3<'_>) -> Option<&'static str> {
    [
        (model.invariant_axis().is_some(), "a section that is not solved as a plane"),
        (setup.magnetic(), "a magnetic medium"),
        (setup.remembers(), "a medium that relaxes or resonates"),
        (setup.slabs.iter().any(Slab::is_second_order), "an absorbing boundary of second order"),
        (!model.snapshots.is_empty(), "a snapshot"),
    ]
    .into_iter()
    .find_map(|(is_there, what)| is_there.then_some(what))
}

/// Memory of the fields, bytes.
pub fn bytes<T: Real>(setup: &Setup3<'_>) -> u64 {
    let stored: usize = setup.painted.cells.iter().map(|n| n + 3).product();
    (stored * (6 * size_of::<T>() + 12)) as u64 + Absorbing4::<T>::bytes(setup)
}

impl<T: Real> Fields<T> {
    fn new(setup: &Setup3<'_>) -> Self {
        let cells = setup.painted.cells;
        let n = cells.map(|count| count + 3);
        let size = n.iter().product::<usize>();
        let zero = setup.edges.len();
        let number = |of: usize| {
            std::array::from_fn(|axis| {
                let entries = (0..zero).map(|entry| T::of(setup.coefficients(axis, entry)[of]));
                entries.chain([T::default()]).collect()
            })
        };
        let mut fields = Self {
            n,
            cells,
            e: std::array::from_fn(|_| vec![T::default(); size]),
            h: std::array::from_fn(|_| vec![T::default(); size]),
            ca: number(0),
            cb: number(1),
            entry: std::array::from_fn(|_| vec![zero as u32; size]),
            cuts_h: Default::default(),
            cuts_e: Default::default(),
        };
        for axis in 0..3 {
            for i in 0..cells[0] {
                for j in 0..cells[1] {
                    for k in 0..cells[2] {
                        if !setup.on_wall(axis, [i, j, k]) {
                            let entry = setup.entry(axis, setup.painted.node([i, j, k]));
                            let place = fields.place([i, j, k]);
                            fields.entry[axis][place] = entry as u32;
                        }
                    }
                }
            }
        }
        fields.find_cuts(setup);
        for drive in &setup.drives {
            if let Some(initial) = drive.initial {
                let place = fields.place(drive.node);
                fields.e[drive.axis][place] = T::of(initial);
            }
        }
        fields.mirror_e();
        fields
    }

    /// Where a node of the grid is stored.
    #[inline(always)]
    fn place(&self, [i, j, k]: [usize; 3]) -> usize {
        ((i + 1) * self.n[1] + j + 1) * self.n[2] + k + 1
    }

    /// How far apart two nodes are stored that follow each other along an axis.
    #[inline(always)]
    fn stride(&self, axis: usize) -> usize {
        [self.n[1] * self.n[2], self.n[2], 1][axis]
    }

    /// The differences that conductors within the grid cut. Outer walls are none: the layer around holds their images.
    fn find_cuts(&mut self, setup: &Setup3<'_>) {
        let empty = || vec![vec![]; self.cells[0] + 1];
        let none = || -> Cuts { std::array::from_fn(|_| [empty(), empty()]) };
        let (mut cuts_h, mut cuts_e) = (none(), none());
        let conducts: Vec<bool> = setup.edges.iter().map(|edge| edge.cb == 0.0).collect();
        if conducts.contains(&true) {
            for axis in 0..3 {
                let is = |node: [usize; 3]| {
                    !setup.on_wall(axis, node) && conducts[self.entry[axis][self.place(node)] as usize]
                };
                for (second, along) in OTHERS[axis].into_iter().enumerate() {
                    let near = |node: [usize; 3], by: isize| {
                        let mut other = node;
                        let at = node[along] as isize + by;
                        other[along] = at.max(0) as usize;
                        at >= 0 && is(other)
                    };
                    let nodes = (0..=self.cells[0]).flat_map(|i| (0..=self.cells[1]).map(move |j| [i, j]));
                    for [i, j] in nodes {
                        for k in 0..=self.cells[2] {
                            let node = [i, j, k];
                            let cut = |low, high| Cut { row: j as u32, k: k as u32, low, high };
                            if node[along] < self.cells[along] && (is(node) || near(node, 1)) {
                                cuts_h[axis][second][i].push(cut(is(node), near(node, 1)));
                            }
                            if !is(node) && !setup.on_wall(axis, node) && (near(node, -1) || near(node, 1)) {
                                cuts_e[axis][second][i].push(cut(near(node, -1), near(node, 1)));
                            }
                        }
                    }
                }
            }
        }
        (self.cuts_h, self.cuts_e) = (cuts_h, cuts_e);
    }

    /// One step of H: `H_a += D_c E_b - D_b E_c`, `b` and `c` the axes after `a` in turn.
    fn step_h(&mut self, absorbing: &mut Absorbing4<T>, profiles: &Profiles4<T>) {
        let (plane, [nx, ny, nz]) = (self.stride(0), self.cells);
        let [mut hx, mut hy, mut hz] = std::mem::take(&mut self.h);
        let this = &*self;
        let [mx, my, mz] = &mut absorbing.h;
        let planes = hx[plane..].par_chunks_mut(plane).zip(hy[plane..].par_chunks_mut(plane));
        let planes = planes.zip(hz[plane..].par_chunks_mut(plane)).zip(mx).zip(my).zip(mz).enumerate();
        planes.take(nx + 1).for_each(|(i, (((((hx, hy), hz), mx), my), mz))| {
            let mut scratch = [vec![T::default(); nz + 1], vec![T::default(); nz + 1]];
            for j in 0..=ny {
                let at = this.place([i, j, 0]);
                for (axis, h, memory) in [(0, &mut *hx, &mut *mx), (1, &mut *hy, &mut *my), (2, &mut *hz, &mut *mz)] {
                    // H along an axis has no place behind the last cell across it.
                    if (i == nx && axis != 0) || (j == ny && axis != 1) {
                        continue;
                    }
                    let ([b, c], run) = (OTHERS[axis], nz + usize::from(axis == 2));
                    let [first, second] = &mut scratch;
                    for (out, of, along) in [(&mut first[..run], b, c), (&mut second[..run], c, b)] {
                        let stride = this.stride(along);
                        let row = |by: usize| &this.e[of][at + by * stride - stride..][..run];
                        difference(out, [row(0), row(1), row(2), row(3)]);
                        let which = usize::from(OTHERS[of][1] == along);
                        cut_h(out, &this.e[of], &this.cuts_h[of][which][i], (j, at, stride));
                    }
                    let h = &mut h[at % plane..][..run];
                    take_h(h, first, second);
                    let factors = [T::of(1.0), T::of(-1.0)];
                    memory.correct(h, &profiles.ones, [c, b], factors, &scratch, profiles.h(), [i, j]);
                }
            }
        });
        self.h = [hx, hy, hz];
    }

    /// One step of E: `E_a = ca E_a + cb (D_b H_c - ratio D_c H_b)`.
    fn step_e(&mut self, ratios: [T; 3], absorbing: &mut Absorbing4<T>, profiles: &Profiles4<T>) {
        let (plane, [nx, ny, nz]) = (self.stride(0), self.cells);
        let [mut ex, mut ey, mut ez] = std::mem::take(&mut self.e);
        let this = &*self;
        let [mx, my, mz] = &mut absorbing.e;
        let planes = ex[plane..].par_chunks_mut(plane).zip(ey[plane..].par_chunks_mut(plane));
        let planes = planes.zip(ez[plane..].par_chunks_mut(plane)).zip(mx).zip(my).zip(mz).enumerate();
        planes.take(nx).for_each(|(i, (((((ex, ey), ez), mx), my), mz))| {
            let room = || vec![T::default(); nz];
            let (mut scratch, mut ca, mut cb) = ([room(), room()], room(), room());
            for j in 0..ny {
                let at = this.place([i, j, 0]);
                for (axis, e, memory) in [(0, &mut *ex, &mut *mx), (1, &mut *ey, &mut *my), (2, &mut *ez, &mut *mz)] {
                    // On the outer walls E stays zero.
                    if (i == 0 && axis != 0) || (j == 0 && axis != 1) {
                        continue;
                    }
                    let ([b, c], ratio) = (OTHERS[axis], ratios[axis]);
                    let entries = &this.entry[axis][at..][..nz];
                    for (k, &entry) in entries.iter().enumerate() {
                        (ca[k], cb[k]) = (this.ca[axis][entry as usize], this.cb[axis][entry as usize]);
                    }
                    let [first, second] = &mut scratch;
                    for (out, of, along) in [(&mut *first, c, b), (&mut *second, b, c)] {
                        let stride = this.stride(along);
                        let row = |by: usize| &this.h[of][at + by * stride - 2 * stride..][..nz];
                        difference(out, [row(0), row(1), row(2), row(3)]);
                        let which = usize::from(OTHERS[axis][1] == along);
                        cut_e(out, &this.h[of], &this.cuts_e[axis][which][i], (j, at, stride));
                    }
                    let e = &mut e[at % plane..][..nz];
                    take_e(e, [&ca, &cb], ratio, first, second);
                    let factors = [T::of(1.0), T::default() - ratio];
                    memory.correct(e, &cb, [b, c], factors, &scratch, profiles.e(), [i, j]);
                }
            }
        });
        self.e = [ex, ey, ez];
    }

    /// Lets the sources act on H or on E.
    fn drive(&mut self, setup: &Setup3<'_>, step: usize, on_h: bool) {
        for drive in setup.drives.iter().filter(|drive| (drive.act == Act::TakeH) == on_h && drive.on.contains(&step)) {
            let place = self.place(drive.node);
            let value = T::of(drive.series[step]);
            let field = if on_h { &mut self.h[drive.axis][place] } else { &mut self.e[drive.axis][place] };
            *field = if drive.act == Act::SetE { value } else { *field - value };
        }
    }

    /// Writes the images of E behind the outer walls: along a wall reversed.
    fn mirror_e(&mut self) {
        for (axis, others) in OTHERS.into_iter().enumerate() {
            for across in others {
                let last = self.cells[across] + 1;
                self.mirror(true, axis, across, [(0, 2), (last + 1, last - 1)]);
            }
        }
    }

    /// Writes the images of H behind the outer walls: along a wall the same.
    fn mirror_h(&mut self) {
        for (axis, others) in OTHERS.into_iter().enumerate() {
            for across in others {
                let last = self.cells[across];
                self.mirror(false, axis, across, [(0, 1), (last + 1, last)]);
            }
        }
    }

    /// Copies two layers across an axis, as stored places.
    fn mirror(&mut self, is_e: bool, axis: usize, across: usize, layers: [(usize, usize); 2]) {
        let (n, stride) = (self.n, [self.stride(0), self.stride(1), self.stride(2)]);
        let field = if is_e { &mut self.e[axis] } else { &mut self.h[axis] };
        let [p, q] = if across == 0 {
            [1, 2]
        } else if across == 1 {
            [0, 2]
        } else {
            [0, 1]
        };
        for (to, from) in layers {
            for a in 0..n[p] {
                for b in 0..n[q] {
                    let base = a * stride[p] + b * stride[q];
                    let value = field[base + from * stride[across]];
                    field[base + to * stride[across]] = if is_e { T::default() - value } else { value };
                }
            }
        }
    }

    /// Looks for a value that no sound run reaches.
    fn check(&self, setup: &Setup3<'_>, step: usize, limit: T) -> Result<(), FdtdError> {
        for axis in 0..3 {
            let Some(place) = self.e[axis].par_iter().position_first(|v| v.is_beyond(limit)) else { continue };
            let stored = [place / self.stride(0), place / self.n[2] % self.n[1], place % self.n[2]];
            let node = stored.map(|at| at.saturating_sub(1));
            let (d, value) = (setup.spacing, self.e[axis][place].double() / setup.spacing[axis]);
            let position = std::array::from_fn(|a| node[a] as f64 * d[a]);
            return Err(FdtdError::DivergedAt { step, axis: axis_of(axis), node, position, value });
        }
        Ok(())
    }
}

/// The cuts of a row; they are sorted by row.
fn of_row(cuts: &[Cut], j: usize) -> &[Cut] {
    let begin = cuts.partition_point(|cut| (cut.row as usize) < j);
    let end = cuts.partition_point(|cut| (cut.row as usize) <= j);
    &cuts[begin..end]
}

/// Takes out of a row of differences of E what came through conductors, and puts in what their images give.
fn cut_h<T: Real>(out: &mut [T], e: &[T], cuts: &[Cut], (j, at, stride): (usize, usize, usize)) {
    let part = T::of(1.0 / 24.0);
    for cut in of_row(cuts, j) {
        let Some(out) = out.get_mut(cut.k as usize) else { continue };
        let f = |by: usize| e[at + cut.k as usize + by * stride - stride];
        let plain = f(2) - f(1);
        if cut.low {
            *out = *out + part * ((f(1) - f(0)) - plain);
        }
        if cut.high {
            *out = *out + part * ((f(3) - f(2)) - plain);
        }
    }
}

/// As [`cut_h`], for the differences of H.
fn cut_e<T: Real>(out: &mut [T], h: &[T], cuts: &[Cut], (j, at, stride): (usize, usize, usize)) {
    let part = T::of(1.0 / 24.0);
    for cut in of_row(cuts, j) {
        let Some(out) = out.get_mut(cut.k as usize) else { continue };
        let f = |by: usize| h[at + cut.k as usize + by * stride - 2 * stride];
        if cut.low {
            *out = *out + part * (f(1) - f(0));
        }
        if cut.high {
            *out = *out + part * (f(3) - f(2));
        }
    }
}
