//! What couples the axes on surfaces that lie aslant: D along one axis makes E along another.
//!
//! With the inverse permittivity at a node, `(1/eps)_ab`, E on the two edges along `a` that end there gains
//! `dt (1/eps)_ab C_b`, half of it each, `C_b` being the mean of the curls of H on the two edges along `b` (Werner & Cary
//! 2007, doi:10.1016/j.jcp.2007.05.008). What an edge along `a` takes from one along `b` is then what that one takes from it,
//! so the permittivity of the whole grid is symmetric, and energy is bounded as long as it is positive and the time step
//! short enough. Both are sums over nodes: [`Couple::all`] weakens a node until its part is positive and below that of free
//! space times `1/COUPLED_STABLE_SHARE²`. With `eps_r` up to 12 against air that is next to nowhere (2 % of the coupling), at
//! 81 a fifth.
//!
//! Conduction stays on its own edge: its part in what couples is `sigma/(w eps)` of it. Nothing couples within the absorbing
//! boundary, nor where an edge conducts perfectly, relaxes or is held by a source.
//!
//! A node is taken after its row has been stepped. It needs H of its plane and the one before, of its row and the one before,
//! and adds to E of the same: nothing that is stepped later in the same step reads those.

use std::ops::Range;

use super::drive::Act;
use super::plane::{Plane, Shared};
use super::setup::{OTHERS, Setup3};
use super::vector::Number;
use crate::model::{COUPLED_STABLE_SHARE, Coupling};
use crate::units::constants::EPSILON_0;

/// What couples the axes at a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Couple {
    pub node: [usize; 3],
    /// What the scaled E along an axis gains from the sums of the two scaled curls along the two others.
    weights: [[f64; 2]; 3],
}

/// How near to zero, and to what the time step allows, the least and the largest permittivity may come: as a share.
const MARGIN: f64 = 0.98;

impl Couple {
    /// The couplings of a model, weakened where they must be.
    pub fn all(setup: &Setup3<'_>) -> Vec<Self> {
        setup.painted.couplings.iter().filter_map(|coupling| Self::at(setup, coupling)).collect()
    }

    fn at(setup: &Setup3<'_>, coupling: &Coupling) -> Option<Self> {
        let (painted, active) = (&setup.painted, setup.active.e);
        let [_, ny, nz] = painted.cells.map(|count| count + 1);
        let node = [coupling.node / (ny * nz), coupling.node / nz % ny, coupling.node % nz];
        let free = |axis: usize| {
            let [low, high] = [setup.slabs[axis].cells, setup.slabs[axis + 3].cells];
            node[axis] > low && node[axis] + high < painted.cells[axis]
        };
        let both = |axis: usize| {
            let mut before = node;
            before[axis] -= 1;
            [before, node]
        };
        let held = |axis: usize| {
            let mut set = setup.drives.iter().filter(|drive| drive.act == Act::SetE && drive.axis == axis);
            set.any(|drive| both(axis).contains(&drive.node))
        };
        if (0..3).any(|axis| node[axis] == 0 || active[axis] && (!free(axis) || held(axis))) {
            return None;
        }
        // Of each axis the harmonic means of what an edge takes from its own curl, and of what it might take more.
        let most = 1.0 / (COUPLED_STABLE_SHARE * COUPLED_STABLE_SHARE);
        let (mut own, mut left, mut damped) = ([1.0; 3], [1.0; 3], 1.0f64);
        for axis in (0..3).filter(|&axis| active[axis]) {
            let edges = both(axis).map(|at| &setup.edges[setup.entry(axis, painted.node(at))]);
            let takes = edges.map(|edge| edge.source * EPSILON_0 / setup.dt);
            if edges.iter().any(|edge| edge.memories() > 0) || takes.iter().any(|&take| take <= 0.0 || take >= most) {
                return None;
            }
            let harmonic = |[a, b]: [f64; 2]| 2.0 * a * b / (a + b);
            own[axis] = harmonic(takes);
            left[axis] = harmonic(takes.map(|take| most - take));
            damped = edges.iter().fold(damped, |least, edge| least.min(0.5 * (1.0 + edge.ca)));
        }
        let paired = |axis: usize| OTHERS[axis].iter().all(|&other| active[other]);
        let inverse: [f64; 3] =
            std::array::from_fn(|axis| if paired(axis) { damped * coupling.inverse[axis] } else { 0.0 });
        let over = |of: [f64; 3]| -> [f64; 3] {
            std::array::from_fn(|axis| {
                let [a, b] = OTHERS[axis];
                inverse[axis] / (of[a] * of[b]).sqrt()
            })
        };
        let share = (MARGIN / -extremes(over(own))[0]).min(MARGIN / extremes(over(left))[1]).min(1.0);
        let d = setup.spacing;
        let weights = std::array::from_fn(|axis| {
            OTHERS[axis].map(|other| {
                let third = 3 - axis - other;
                0.25 * share * inverse[third] * d[axis] / d[other] * setup.scale_of_curl(other, setup.dt / EPSILON_0)
            })
        });
        Some(Self { node, weights })
    }
}

/// The least and the largest eigenvalue of a symmetric matrix with zeros on its diagonal; those of no coupling are a hair off
/// zero.
fn extremes([p, q, r]: [f64; 3]) -> [f64; 2] {
    let third = (p * p + q * q + r * r) / 3.0;
    if third < 1e-24 {
        return [-1e-12, 1e-12];
    }
    let size = third.sqrt();
    let angle = (p * q * r / (third * size)).clamp(-1.0, 1.0).acos() / 3.0;
    let third_of_turn = 2.0 * std::f64::consts::FRAC_PI_3;
    [2.0 * size * (angle + third_of_turn).cos(), 2.0 * size * angle.cos()]
}

/// The couplings of a plane, by row.
pub struct Couples<T> {
    /// Place of the first of each row, and of the end.
    rows: Vec<u32>,
    all: Vec<Held<T>>,
}

/// A coupling within a row.
struct Held<T> {
    k: u32,
    weights: [[T; 2]; 3],
}

impl<T: Number> Couples<T> {
    /// Those of plane `i`; `None` where there are none.
    pub fn new(setup: &Setup3<'_>, i: usize) -> Option<Self> {
        let first = setup.couples.partition_point(|couple| couple.node[0] < i);
        let here = &setup.couples[first..];
        let here = &here[..here.partition_point(|couple| couple.node[0] == i)];
        let rows = (0..=setup.painted.cells[1]).map(|j| here.partition_point(|couple| couple.node[1] < j) as u32);
        let held =
            |couple: &Couple| Held { k: couple.node[2] as u32, weights: couple.weights.map(|pair| pair.map(T::of)) };
        (!here.is_empty()).then(|| Self { rows: rows.collect(), all: here.iter().map(held).collect() })
    }

    /// Memory of so many couplings, bytes.
    pub fn bytes(setup: &Setup3<'_>) -> u64 {
        if setup.couples.is_empty() {
            return 0;
        }
        let rows = setup.painted.cells[0] * (setup.painted.cells[1] + 1) * size_of::<u32>();
        (setup.couples.len() * size_of::<Held<T>>() + rows) as u64
    }

    /// Whether there are any in some rows.
    pub fn are_in(&self, rows: &Range<usize>) -> bool {
        let at = |row: usize| self.rows[row.min(self.rows.len() - 1)];
        at(rows.start) < at(rows.end)
    }
}

/// Lets the axes of a plane take from each other in some rows that have been stepped; `west` is the plane before.
pub fn couple<T: Number>(
    shared: &Shared<T>,
    step: usize,
    rows: &Range<usize>,
    plane: &mut Plane<T>,
    west: &mut Plane<T>,
) {
    let Some(couples) = &plane.couples else { return };
    let (width, ratio) = (plane.fields.width(), shared.ratio);
    for j in rows.start.max(1)..rows.end.min(couples.rows.len() - 1) {
        let held = &couples.all[couples.rows[j] as usize..couples.rows[j + 1] as usize];
        if held.is_empty() {
            continue;
        }
        let Some((begin, count)) = shared.cones.span(plane.i, j, step) else { continue };
        // Rows `j - 1` and `j`, the second from `width` on.
        let [ex_west, _, _, _, hy_west, hz_west] = west.fields.two_rows(j);
        let [ex, ey, ez, hx, hy, hz] = plane.fields.two_rows(j);
        for Held { k, weights: [of_x, of_y, of_z] } in held {
            let k = *k as usize;
            if !(begin..begin + count).contains(&k) {
                continue;
            }
            let at = width + k;
            let x = |hy: &[T], hz: &[T]| (hz[at] - hz[k]) - ratio[0] * (hy[at] - hy[at - 1]);
            let y = |at: usize| (hx[at] - hx[at - 1]) - ratio[1] * (hz[at] - hz_west[at]);
            let z = |at: usize| (hy[at] - hy_west[at]) - ratio[2] * (hx[at] - hx[at - width]);
            let [x, y, z] = [x(hy, hz) + x(hy_west, hz_west), y(at) + y(k), z(at) + z(at - 1)];
            let gain = [of_x[0] * y + of_x[1] * z, of_y[0] * z + of_y[1] * x, of_z[0] * x + of_z[1] * y];
            ex[at] = ex[at] + gain[0];
            ex_west[at] = ex_west[at] + gain[0];
            ey[at] = ey[at] + gain[1];
            ey[k] = ey[k] + gain[1];
            ez[at] = ez[at] + gain[2];
            ez[at - 1] = ez[at - 1] + gain[2];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Eigenvalues by hand: of `[[0, 1, 0], [1, 0, 0], [0, 0, 0]]` they are -1 and 1, of ones off the diagonal -1 and 2, and
    /// those of minus a matrix are minus its own.
    #[test]
    fn eigenvalues_are_those_of_algebra() {
        for (of, wanted) in [([0.0, 0.0, 1.0], [-1.0, 1.0]), ([1.0; 3], [-1.0, 2.0]), ([-1.0; 3], [-2.0, 1.0])] {
            let found = extremes(of);
            assert!((0..2).all(|n| (found[n] - wanted[n]).abs() < 1e-12), "{found:?} {wanted:?}");
        }
    }
}
