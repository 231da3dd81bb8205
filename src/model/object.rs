//! The objects of a model, painted in order, the later over the earlier.

use std::sync::Arc;

use super::material::MaterialId;

/// Something that fills cells. Coordinates in metres, as the user wrote them: painting snaps them to the grid.
#[derive(Debug, Clone, PartialEq)]
pub enum Object {
    /// An axis-parallel box: `#box`.
    Box {
        /// Corner with the smallest coordinates, m.
        lower: [f64; 3],
        /// Corner with the largest coordinates, m.
        upper: [f64; 3],
        /// What it is made of.
        material: MaterialId,
        /// Whether the edges on its surface take the mean of the materials around them.
        averaging: bool,
    },
    /// A circular cylinder: `#cylinder`.
    Cylinder {
        /// Centre of the first face, m.
        start: [f64; 3],
        /// Centre of the second face, m.
        end: [f64; 3],
        /// Radius, m. Not snapped to the grid.
        radius: f64,
        /// What it is made of.
        material: MaterialId,
        /// Whether the edges on its surface take the mean of the materials around them.
        averaging: bool,
    },
    /// A ball: `#sphere`.
    Sphere {
        /// Centre, m.
        centre: [f64; 3],
        /// Radius, m. Not snapped to the grid.
        radius: f64,
        /// What it is made of.
        material: MaterialId,
        /// Whether the edges on its surface take the mean of the materials around them.
        averaging: bool,
    },
    /// A block of cells with their materials: `#geometry_objects_read`.
    Voxels(Voxels),
}

impl Object {
    /// Whether any of it is made of a material.
    pub fn holds(&self, id: MaterialId) -> bool {
        match self {
            Self::Box { material, .. } | Self::Cylinder { material, .. } | Self::Sphere { material, .. } => {
                *material == id
            }
            Self::Voxels(block) => block.cells.contains(&Some(id)),
        }
    }
}

/// A block of cells, each with its material.
#[derive(Debug, Clone, PartialEq)]
pub struct Voxels {
    /// Position of the block's lowest corner, m.
    pub origin: [f64; 3],
    /// Cells along x, y, z.
    pub shape: [usize; 3],
    /// Material of each cell, z fastest: `cells[(i * ny + j) * nz + k]`. `None` leaves the cell as it is.
    pub cells: Arc<[Option<MaterialId>]>,
    /// Whether the edges between cells take the mean of the materials around them.
    pub averaging: bool,
}
