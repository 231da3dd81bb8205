//! How a grid is laid out for painting: planes across x, rows in a plane, runs of cells along a row.

use super::PaintError;
use crate::model::{CheckError, Grid, Model};

/// Refuses grids that are not two-dimensional along z.
///
/// # Errors
/// With the cell counts, when z has more than one cell, or x or y only one.
pub fn check_two_dimensional(model: &Model) -> Result<(), PaintError> {
    let cells = model.grid.cells;
    if model.grid.invariant_axis() != Some(2) || cells.contains(&0) {
        return Err(PaintError::NotTwoDimensional { cells });
    }
    Ok(())
}

/// Refuses grids without cells and grids with more than one axis of a single cell.
///
/// # Errors
/// With the cell counts and sizes.
pub fn check_grid(grid: &Grid) -> Result<(), CheckError> {
    let Grid { cells, spacing } = *grid;
    if cells.contains(&0) || cells.iter().filter(|&&count| count == 1).count() > 1 {
        return Err(CheckError::Grid { cells, spacing });
    }
    Ok(())
}

/// Planes, rows and runs of a grid.
///
/// Planes lie across x. In three dimensions rows follow each other along y and run along z; a model that is invariant along
/// z has one row in a plane, which runs along y. So runs are long in both, and cells lie in memory as in the results.
#[derive(Debug, Clone, Copy)]
pub struct Layout {
    pub grid: Grid,
    /// Whether the model is invariant along z and only its z edges are wanted.
    pub flat: bool,
    /// Planes, rows in a plane, cells in a row.
    pub n: [usize; 3],
}

impl Layout {
    /// The layout of a grid.
    pub fn new(grid: Grid, flat: bool) -> Self {
        let [nx, ny, nz] = grid.cells;
        Self { grid, flat, n: if flat { [nx, 1, ny] } else { [nx, ny, nz] } }
    }

    /// Axes of the grid across which the planes lie, along which rows follow each other and along which they run.
    pub fn axes(&self) -> [usize; 3] {
        if self.flat { [0, 2, 1] } else { [0, 1, 2] }
    }

    /// Three things in the order x, y, z, in the order of planes, rows and runs.
    pub fn turned<V: Clone>(&self, of: &[V; 3]) -> [V; 3] {
        self.axes().map(|axis| of[axis].clone())
    }

    /// Whether the edges along an axis of the layout are wanted.
    pub fn wanted(&self, axis: usize) -> bool {
        !self.flat || axis == 1
    }

    /// Cells in a plane.
    pub fn plane(&self) -> usize {
        self.n[1] * self.n[2]
    }

    /// Planes painted in one go. A chunk paints the plane before it too, so more make less work, and fewer more chunks.
    pub fn planes_per_chunk(&self) -> usize {
        (self.n[0] / 64).clamp(8, 64)
    }
}
