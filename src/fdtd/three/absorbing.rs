//! The memory and profiles of the absorbing cells that a plane passes through.

use super::super::real::Real;
use super::super::slab::{Filter, Slab};
use super::super::state::{Numbers, State};
use super::arena::Arena;
use super::kernel::{ColumnFilter, ColumnProfile, RowFilter, RowProfile};
use super::setup::Setup3;
use super::sheet::{LANES, Sheets, padded};

/// The memory of the two E and the two H components that a slab across one axis corrects, and the factors that stand
/// before the difference in their curls (a sign, and the ratio of non-cubic cells).
///
/// A slab across axis `a` corrects, of E and of H alike, the components along the two axes after it in cyclic order: the
/// first of them by the second's conjugate with a minus in E, the second by the first's with a plus (in H the other way).
///
/// E of the first and second component, then H: one number for each difference, two in second order.
#[derive(Debug)]
pub struct Memory<T> {
    sheets: Sheets<T>,
    /// Numbers for each difference.
    each: usize,
}

impl<T: Real> Memory<T> {
    fn new(arena: &mut Arena, rows: usize, width: usize, second_order: bool) -> Self {
        let each = if second_order { 2 } else { 1 };
        Self { sheets: Sheets::zeros_in(arena, 4 * each, rows, width), each }
    }

    /// The first numbers of both components of E (0) or H (2): `n` nodes of a row from node `k` on.
    #[inline(always)]
    pub fn pair(&mut self, of: usize, row: usize, k: usize, n: usize) -> [&mut [T]; 2] {
        let apart = self.each * self.sheets.apart();
        let (_, rest) = self.sheets.split_mut(of * self.each, row, k);
        let (first, second) = rest.split_at_mut(apart);
        [&mut first[..n], &mut second[..n]]
    }

    /// Both numbers of one component, E of the first (0) or second (1), H (2, 3), in second order: `n` nodes of a row from
    /// node `k` on.
    #[inline(always)]
    pub fn both(&mut self, of: usize, row: usize, k: usize, n: usize) -> [&mut [T]; 2] {
        let apart = self.sheets.apart();
        let (_, rest) = self.sheets.split_mut(of * self.each, row, k);
        let (first, second) = rest.split_at_mut(apart);
        [&mut first[..n], &mut second[..n]]
    }
}

/// Factors before the differences: E of the first and second component, H of the first and second.
fn factors(setup: &Setup3<'_>, axis: usize) -> [f64; 4] {
    let first = (axis + 1) % 3;
    [-setup.ratio(first), 1.0, 1.0, -1.0]
}

/// The rows of a slab across x or y: four profiles, for E of the first and second component, and H.
#[derive(Debug, Clone, Copy)]
pub struct Profiles<T> {
    /// In first order.
    pub first: [RowProfile<T>; 4],
    /// In second order.
    pub second: Option<[RowFilter<T>; 4]>,
}

/// A filter in the precision of the fields, with the factor that stands before the difference.
fn scaled<T: Real>(filter: Filter, factor: f64) -> RowFilter<T> {
    RowFilter { add: filter.add.map(|v| T::of(factor * v)), next: filter.next.map(|row| row.map(T::of)) }
}

/// Profiles of the row or plane `index` within the slabs across an axis; `None` outside them.
pub fn profiles<T: Real>(setup: &Setup3<'_>, axis: usize, index: usize) -> Option<Profiles<T>> {
    let (low, high) = (&setup.slabs[axis], &setup.slabs[axis + 3]);
    let n = setup.painted.cells[axis];
    if index >= low.extent() && index + high.cells < n {
        return None;
    }
    // The slab that a field lies in, and how deep.
    let within = |of: usize| {
        let at = index as f64 + if of < 2 { 0.0 } else { 0.5 };
        let below = low.cells as f64 - at;
        if low.cells > 0 && below >= 0.0 { (low, below) } else { (high, at - (n - high.cells) as f64) }
    };
    let factors = factors(setup, axis);
    let first = |of: usize| {
        let (slab, depth) = within(of);
        let [ra_less_one, rb, re, rf] = slab.at(depth);
        RowProfile {
            ra_less_one: T::of(factors[of] * ra_less_one),
            rb: T::of(factors[of] * rb),
            re: T::of(re),
            rf: T::of(rf),
        }
    };
    let second = |of: usize| {
        let (slab, depth) = within(of);
        scaled(slab.filter(depth), factors[of])
    };
    let second_order = low.is_second_order() || high.is_second_order();
    let second = second_order.then(|| std::array::from_fn(second));
    Some(Profiles { first: std::array::from_fn(first), second })
}

/// The absorbing cells at both ends of z, in vectors of a row: the same in every plane.
#[derive(Debug)]
pub struct Columns<T> {
    /// First node of each vector.
    pub vectors: Vec<usize>,
    /// E of the first and second component, and H: `RA - 1`, `RB`, `RE`, `RF` at each node, vector after vector.
    profiles: [[Vec<T>; 4]; 4],
    /// In second order: the nine coefficients of a filter at each node, likewise.
    filters: Option<[[Vec<T>; 9]; 4]>,
}

impl<T: Real> Columns<T> {
    /// The vectors that hold absorbing cells; their other nodes absorb nothing.
    pub fn new(setup: &Setup3<'_>) -> Self {
        let nz = setup.painted.cells[2];
        let (low, high): (&Slab, &Slab) = (&setup.slabs[2], &setup.slabs[5]);
        let below = if low.cells > 0 { low.extent() } else { 0 };
        let above = if high.cells > 0 { nz - high.cells } else { padded(nz) };
        let vectors: Vec<usize> = (0..padded(nz)).step_by(LANES).filter(|&k| k < below || k + LANES > above).collect();
        let factors = factors(setup, 2);
        let nodes = || vectors.iter().flat_map(|&k| k..k + LANES);
        // The slab that a node lies in, and how deep; none between the slabs and beyond the grid.
        let within = |of: usize, node: usize| {
            let z = node as f64 + if of < 2 { 0.0 } else { 0.5 };
            let (in_low, in_high) = (low.cells as f64 - z, z - (nz - high.cells) as f64);
            if low.cells > 0 && in_low >= 0.0 {
                Some((low, in_low))
            } else if high.cells > 0 && in_high >= 0.0 && node < nz {
                Some((high, in_high))
            } else {
                None
            }
        };
        let filter = |of: usize| -> [Vec<T>; 9] {
            let at = |node: usize| {
                let Some((slab, depth)) = within(of, node) else { return [[T::default(); 3]; 3] };
                let RowFilter { add, next: [one, two] } = scaled::<T>(slab.filter(depth), factors[of]);
                [add, one, two]
            };
            std::array::from_fn(|c| nodes().map(|node| at(node)[c / 3][c % 3]).collect())
        };
        let profile = |of: usize| -> [Vec<T>; 4] {
            let at = |node: usize| {
                let Some((slab, depth)) = within(of, node) else { return [0.0; 4] };
                let [ra_less_one, rb, re, rf] = slab.at(depth);
                [factors[of] * ra_less_one, factors[of] * rb, re, rf]
            };
            std::array::from_fn(|c| nodes().map(|node| T::of(at(node)[c])).collect())
        };
        let second_order = low.is_second_order() || high.is_second_order();
        let filters = second_order.then(|| std::array::from_fn(filter));
        Self { profiles: std::array::from_fn(profile), filters, vectors }
    }

    /// The profile of E of the first (0) or second (1) component, or of H (2, 3), in vector `place`.
    #[inline(always)]
    pub fn profile(&self, of: usize, place: usize) -> ColumnProfile<'_, T> {
        let from = place * LANES;
        let [ra_less_one, rb, re, rf] = &self.profiles[of];
        ColumnProfile { ra_less_one: &ra_less_one[from..], rb: &rb[from..], re: &re[from..], rf: &rf[from..] }
    }

    /// The filter of E of the first (0) or second (1) component, or of H (2, 3), in second order, in vector `place`.
    #[inline(always)]
    pub fn filter(&self, of: usize, place: usize) -> Option<ColumnFilter<'_, T>> {
        let filters = &self.filters.as_ref()?[of];
        let part = |c: usize| &filters[c][place * LANES..];
        let next = [[part(3), part(4), part(5)], [part(6), part(7), part(8)]];
        Some(ColumnFilter { add: [part(0), part(1), part(2)], next })
    }
}

impl<T: Real> State for Memory<T> {
    fn visit(&mut self, visitor: &mut dyn FnMut(Numbers<'_>)) {
        let Self { sheets, each: _ } = self;
        sheets.visit(visitor);
    }
}

/// The absorbing memory of one plane.
#[derive(Debug)]
pub struct Absorbing<T> {
    /// Where the plane lies within a slab across x.
    pub x: Option<(Profiles<T>, Memory<T>)>,
    /// Rows of the slabs across y, one after the other.
    pub y: Option<Memory<T>>,
    /// At the ends of z, vector after vector.
    pub z: Option<Memory<T>>,
}

impl<T: Real> State for Absorbing<T> {
    fn visit(&mut self, visitor: &mut dyn FnMut(Numbers<'_>)) {
        let Self { x, y, z } = self;
        if let Some((_, memory)) = x {
            memory.visit(visitor);
        }
        y.visit(visitor);
        z.visit(visitor);
    }
}

impl<T: Real> Absorbing<T> {
    /// Takes what plane `i` needs from an arena.
    pub fn new(setup: &Setup3<'_>, arena: &mut Arena, i: usize, width: usize, columns: &Columns<T>) -> Self {
        let [_, ny, _] = setup.painted.cells;
        let rows = setup.slabs[1].extent() + setup.slabs[4].cells;
        let (second, ends) = (setup.slabs.iter().any(Slab::is_second_order), columns.vectors.len() * LANES);
        Self {
            x: profiles(setup, 0, i).map(|profiles| (profiles, Memory::new(arena, ny - 1, width, second))),
            y: (rows > 0).then(|| Memory::new(arena, rows - 1, width, second)),
            z: (ends > 0).then(|| Memory::new(arena, ny - 1, ends, second)),
        }
    }

    /// Memory of all planes, bytes.
    pub fn bytes(setup: &Setup3<'_>, width: usize) -> u64 {
        let [nx, ny, nz] = setup.painted.cells;
        let mut cells = setup.slabs.each_ref().map(Slab::extent);
        (3..6).for_each(|side| cells[side] = setup.slabs[side].cells);
        let each = if setup.slabs.iter().any(Slab::is_second_order) { 2 } else { 1 };
        let memory = |rows: usize, width: usize| Sheets::<T>::bytes(4 * each, rows - 1, width);
        let of_x = (cells[0] + cells[3]) as u64 * memory(ny, width);
        let rows = cells[1] + cells[4];
        let of_y = if rows > 0 { nx as u64 * memory(rows, width) } else { 0 };
        let below = if cells[2] > 0 { cells[2].next_multiple_of(LANES).min(width) } else { 0 };
        let above = if cells[5] > 0 { width - ((nz - cells[5]) / LANES * LANES).max(below).min(width) } else { 0 };
        let of_z = if below + above > 0 { memory(ny, below + above) } else { 0 };
        of_x + of_y + nx as u64 * of_z
    }
}
