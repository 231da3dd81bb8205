//! Where a fourth-order difference would look through a perfect conductor.
//!
//! The fourth-order difference is a smoothed second-order one: with `d` the plain difference at a place of H,
//! `D = d - (d_before - 2 d + d_behind)/24`, that is `D = S d`, and E takes the plain difference of `S H`. `S` couples each
//! place of H to the next ones along the axis, through the node of E between them. Where that node conducts perfectly the
//! coupling is cut, on both ways: `S` stays symmetric whatever the shape, so the scheme keeps an energy and is stable up to
//! the same step as without conductors. On a plane it is image theory: `f₋₁` becomes `-f₁` for E, `h₂` becomes `h₁` for H.
//!
//! Falling back to plain differences next to a conductor, the other choice, has no such symmetry, and is first-order there.

use super::setup::Setup;

/// A difference one or both of whose outer values lie behind a conductor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cut {
    /// Node, or place of H, along y.
    pub j: usize,
    /// `f₋₁` does.
    pub low: bool,
    /// `f₂` does.
    pub high: bool,
}

/// All cut differences of stored rows, with their rows counted from the first stored one.
#[derive(Debug, Default)]
pub struct Cuts {
    /// Differences of Ez along x, which make Hy.
    pub hy: Vec<(usize, Cut)>,
    /// Differences of Ez along y, which make Hx.
    pub hx: Vec<(usize, Cut)>,
    /// Differences of Hy along x, which make Ez.
    pub ez_x: Vec<(usize, Cut)>,
    /// Differences of Hx along y, which make Ez.
    pub ez_y: Vec<(usize, Cut)>,
}

impl Cuts {
    /// Finds them in the rows `base..base + stored`. The outer walls are no cuts: the rows hold their images.
    pub fn new(setup: &Setup<'_>, base: usize, stored: usize) -> Self {
        let mut cuts = Self::default();
        let conducts: Vec<bool> = setup.edges.iter().map(|edge| edge.cb == 0.0).collect();
        if !conducts.contains(&true) {
            return cuts;
        }
        let [nx, ny] = setup.painted.cells_xy;
        let is = |i: usize, j: usize| {
            i > 0 && i < nx && j > 0 && j < ny && conducts[setup.painted.edge_z[i * (ny + 1) + j] as usize]
        };
        let note = |list: &mut Vec<(usize, Cut)>, row: usize, j: usize, low: bool, high: bool| {
            if low || high {
                list.push((row - base, Cut { j, low, high }));
            }
        };
        for row in base..(base + stored).min(nx) {
            for j in 1..=ny {
                // Where all four values are those of a conductor, the difference is zero in any case.
                if (j - 1..=j + 2).any(|j| !is(row, j.saturating_sub(1))) {
                    note(&mut cuts.hx, row, j, is(row, j - 1), is(row, j));
                }
                if (row..=row + 3).any(|row| !is(row.saturating_sub(1), j)) {
                    note(&mut cuts.hy, row, j, is(row, j), is(row + 1, j));
                }
                if row > 0 && j < ny && !is(row, j) {
                    note(&mut cuts.ez_y, row, j, is(row, j - 1), is(row, j + 1));
                    note(&mut cuts.ez_x, row, j, is(row - 1, j), is(row + 1, j));
                }
            }
        }
        cuts
    }

    /// Memory that they take, bytes.
    pub fn bytes(&self) -> u64 {
        ((self.hx.len() + self.hy.len() + self.ez_x.len() + self.ez_y.len()) * size_of::<Cut>()) as u64
    }
}
