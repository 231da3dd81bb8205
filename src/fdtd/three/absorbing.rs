//! The memory and profiles of the absorbing cells that a plane passes through.

use super::super::real::Real;
use super::super::slab::{Filter, Slab};
use super::super::state::{Numbers, State};
use super::kernel::{ColumnFilter, ColumnProfile, RowFilter, RowProfile};
use super::setup::Setup3;
use super::sheet::{LANES, Sheet};

/// The memory of the two E and the two H components that a slab across one axis corrects, and the factors that stand
/// before the difference in their curls (a sign, and the ratio of non-cubic cells).
///
/// A slab across axis `a` corrects, of E and of H alike, the components along the two axes after it in cyclic order: the
/// first of them by the second's conjugate with a minus in E, the second by the first's with a plus (in H the other way).
#[derive(Debug)]
pub struct Memory<T> {
    /// First component, then second.
    pub e: [Store<T>; 2],
    /// First component, then second.
    pub h: [Store<T>; 2],
}

/// The memory of one component: one number for each difference, two in second order.
#[derive(Debug)]
pub struct Store<T> {
    pub phi: Sheet<T>,
    pub second: Option<Sheet<T>>,
}

impl<T: Real> Memory<T> {
    fn new(rows: usize, width: usize, second_order: bool) -> Self {
        let sheet = || Sheet::zeros(rows, width);
        let store = || Store { phi: sheet(), second: second_order.then(sheet) };
        Self { e: [store(), store()], h: [store(), store()] }
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

/// The absorbing cells at one end of z: the same in every plane.
#[derive(Debug)]
pub struct Columns<T> {
    /// First node.
    pub k: usize,
    /// Nodes.
    pub count: usize,
    /// E of the first and second component, and H: `RA - 1`, `RB`, `RE`, `RF` at each node.
    profiles: [[Vec<T>; 4]; 4],
    /// In second order: the nine coefficients of a filter at each node, likewise.
    filters: Option<[[Vec<T>; 9]; 4]>,
}

impl<T: Real> Columns<T> {
    /// The ends that have absorbing cells. The counts are padded to whole vectors with nodes that absorb nothing.
    pub fn both(setup: &Setup3<'_>) -> Vec<Self> {
        let nz = setup.painted.cells[2];
        let factors = factors(setup, 2);
        let one = |low: bool| {
            let slab: &Slab = &setup.slabs[if low { 2 } else { 5 }];
            if slab.cells == 0 {
                return None;
            }
            let extent = if low { slab.extent() } else { slab.cells };
            let count = extent.next_multiple_of(LANES).min(nz);
            let k = if low { 0 } else { nz - count };
            let depth = |of: usize, node: usize| {
                let z = node as f64 + if of < 2 { 0.0 } else { 0.5 };
                if low { slab.cells as f64 - z } else { z - (nz - slab.cells) as f64 }
            };
            let filter = |of: usize| -> [Vec<T>; 9] {
                let at = |node: usize| {
                    let RowFilter { add, next: [one, two] } = scaled::<T>(slab.filter(depth(of, node)), factors[of]);
                    [add, one, two]
                };
                std::array::from_fn(|c| (k..k + count).map(|node| at(node)[c / 3][c % 3]).collect())
            };
            let profile = |of: usize| -> [Vec<T>; 4] {
                let at = |node: usize| {
                    let [ra_less_one, rb, re, rf] = slab.at(depth(of, node));
                    [factors[of] * ra_less_one, factors[of] * rb, re, rf]
                };
                std::array::from_fn(|c| (k..k + count).map(|node| T::of(at(node)[c])).collect())
            };
            let filters = slab.is_second_order().then(|| std::array::from_fn(filter));
            Some(Self { k, count, profiles: std::array::from_fn(profile), filters })
        };
        [true, false].into_iter().filter_map(one).collect()
    }

    /// The profile of E of the first (0) or second (1) component, or of H (2, 3), from a node of the end on.
    #[inline(always)]
    pub fn profile(&self, of: usize, from: usize) -> ColumnProfile<'_, T> {
        let [ra_less_one, rb, re, rf] = &self.profiles[of];
        ColumnProfile { ra_less_one: &ra_less_one[from..], rb: &rb[from..], re: &re[from..], rf: &rf[from..] }
    }
}

impl<T: Real> State for Memory<T> {
    fn visit(&mut self, visitor: &mut dyn FnMut(Numbers<'_>)) {
        let Self { e, h } = self;
        e.visit(visitor);
        h.visit(visitor);
    }
}

impl<T: Real> State for Store<T> {
    fn visit(&mut self, visitor: &mut dyn FnMut(Numbers<'_>)) {
        let Self { phi, second } = self;
        phi.visit(visitor);
        second.visit(visitor);
    }
}

impl<T> Columns<T> {
    /// The filter of E of the first (0) or second (1) component, or of H (2, 3), in second order, from node `from` of the slab on.
    #[inline(always)]
    pub fn filter(&self, of: usize, from: usize) -> Option<ColumnFilter<'_, T>> {
        let [a0, a1, a2, n0, n1, n2, n3, n4, n5] = self.filters.as_ref()?[of].each_ref().map(|part| &part[from..]);
        Some(ColumnFilter { add: [a0, a1, a2], next: [[n0, n1, n2], [n3, n4, n5]] })
    }
}

/// The absorbing memory of one plane.
#[derive(Debug)]
pub struct Absorbing<T> {
    /// Where the plane lies within a slab across x.
    pub x: Option<(Profiles<T>, Memory<T>)>,
    /// Rows of the slabs across y, one after the other.
    pub y: Option<Memory<T>>,
    /// At each end of z.
    pub z: Vec<Memory<T>>,
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
    /// Allocates what plane `i` needs.
    pub fn new(setup: &Setup3<'_>, i: usize, width: usize, columns: &[Columns<T>]) -> Self {
        let [_, ny, _] = setup.painted.cells;
        let rows = setup.slabs[1].extent() + setup.slabs[4].cells;
        let second = setup.slabs.iter().any(Slab::is_second_order);
        Self {
            x: profiles(setup, 0, i).map(|profiles| (profiles, Memory::new(ny - 1, width, second))),
            y: (rows > 0).then(|| Memory::new(rows - 1, width, second)),
            z: columns.iter().map(|c| Memory::new(ny - 1, c.count.next_multiple_of(LANES), second)).collect(),
        }
    }

    /// Memory of all planes, bytes.
    pub fn bytes(setup: &Setup3<'_>, width: usize) -> u64 {
        let [nx, ny, nz] = setup.painted.cells;
        let mut cells = setup.slabs.each_ref().map(Slab::extent);
        (3..6).for_each(|side| cells[side] = setup.slabs[side].cells);
        let numbers = if setup.slabs.iter().any(Slab::is_second_order) { 2 } else { 1 };
        let of_x = (cells[0] + cells[3]) as u64 * 4 * Sheet::<T>::bytes(ny - 1, width);
        let rows = cells[1] + cells[4];
        let of_y = if rows > 0 { nx as u64 * 4 * Sheet::<T>::bytes(rows - 1, width) } else { 0 };
        let column =
            |count: usize| Sheet::<T>::bytes(ny - 1, count.next_multiple_of(LANES).min(nz.next_multiple_of(LANES)));
        let of_z: u64 = [cells[2], cells[5]].into_iter().filter(|&count| count > 0).map(column).sum();
        numbers * (of_x + of_y + nx as u64 * 4 * of_z)
    }
}
