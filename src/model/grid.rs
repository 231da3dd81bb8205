//! The Yee grid: cell counts, cell sizes, the Courant step and how coordinates become indices.

use crate::units::constants::C0;

/// A Yee grid. Two-dimensional when exactly one axis has a single cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Cells along x, y, z.
    pub cells: [usize; 3],
    /// Cell size along x, y, z, m.
    pub spacing: [f64; 3],
}

impl Grid {
    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.cells.iter().product()
    }

    /// Axis along which nothing changes, if the grid is two-dimensional.
    pub fn invariant_axis(&self) -> Option<usize> {
        let mut single = (0..3).filter(|&axis| self.cells[axis] == 1);
        match (single.next(), single.next()) {
            (Some(axis), None) => Some(axis),
            _ => None,
        }
    }

    /// Largest stable time step, s: `1/(c sqrt(sum 1/d²))` over the axes along which the fields change.
    pub fn courant_step(&self) -> f64 {
        self.courant_step_without(self.invariant_axis())
    }

    /// As [`Grid::courant_step`], for fields that do not change along `invariant`.
    pub fn courant_step_without(&self, invariant: Option<usize>) -> f64 {
        let sum: f64 =
            (0..3).filter(|&axis| Some(axis) != invariant).map(|axis| 1.0 / self.spacing[axis].powi(2)).sum();
        1.0 / (C0 * sum.sqrt())
    }

    /// Index of the node nearest to `metres` along `axis`; a coordinate half-way between two nodes goes down.
    pub fn node(&self, axis: usize, metres: f64) -> i64 {
        ceil_half_down(metres / self.spacing[axis])
    }

    /// Position of a node, m.
    pub fn node_position(&self, node: [usize; 3]) -> [f64; 3] {
        std::array::from_fn(|axis| node[axis] as f64 * self.spacing[axis])
    }
}

/// Nearest integer, halves going down: gprMax's rounding of coordinates to nodes.
pub fn ceil_half_down(value: f64) -> i64 {
    (value - 0.5).ceil() as i64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// dt printed by gprMax 4.0.1 for square cells of 2 mm in 2-D and for 2 × 3 × 4 mm with z invariant.
    #[test]
    fn courant_step_is_that_of_gprmax() {
        let square = Grid { cells: [200, 200, 1], spacing: [0.002; 3] };
        assert_eq!(square.courant_step(), 4.717308673499368e-12);
        let oblong = Grid { cells: [300, 150, 1], spacing: [0.002, 0.003, 0.004] };
        assert_eq!(oblong.courant_step(), 5.550842071803178e-12);
    }

    #[test]
    fn halves_round_down() {
        assert_eq!(ceil_half_down(2.5), 2);
        assert_eq!(ceil_half_down(2.5000001), 3);
        assert_eq!(ceil_half_down(-0.5), -1);
    }
}
