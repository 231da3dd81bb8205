//! The objects of a model, painted in order, the later over the earlier.

use std::sync::Arc;

use super::Axis;
use super::fractal::FractalBox;
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
    /// An ellipsoid with half-axes along x, y, z: `#ellipsoid`.
    Ellipsoid {
        /// Centre, m.
        centre: [f64; 3],
        /// Half-axes, m. Not snapped to the grid.
        radii: [f64; 3],
        /// What it is made of.
        material: MaterialId,
        /// Whether the edges on its surface take the mean of the materials around them.
        averaging: bool,
    },
    /// A circular cone or its stump: `#cone`.
    Cone {
        /// Centre of the first face, m.
        start: [f64; 3],
        /// Centre of the second face, m.
        end: [f64; 3],
        /// Radius of the first and of the second face, m. Not snapped to the grid.
        radii: [f64; 2],
        /// What it is made of.
        material: MaterialId,
        /// Whether the edges on its surface take the mean of the materials around them.
        averaging: bool,
    },
    /// A sector of a circular cylinder along an axis: `#cylindrical_sector`. One that is less than half a cell thick is a
    /// sheet on one plane of nodes, which claims its edges.
    Sector {
        /// Axis of the cylinder.
        axis: Axis,
        /// Where the axis stands along the two other axes, m.
        centre: [f64; 2],
        /// Lower and upper end, m.
        extent: [f64; 2],
        /// Radius, m. Not snapped to the grid.
        radius: f64,
        /// Angle at which it begins, from the first of the other axes towards the second, degrees.
        start: f64,
        /// Angle that it takes, degrees.
        sweep: f64,
        /// What it is made of.
        material: MaterialId,
        /// Whether the edges on its surface take the mean of the materials around them.
        averaging: bool,
    },
    /// A prism on a triangle across an axis: `#triangle`. One that is less than half a cell thick is a sheet on one plane of
    /// nodes, which claims its edges.
    Triangle {
        /// Corners, m.
        corners: [[f64; 3]; 3],
        /// Axis along which all corners have the same coordinate.
        axis: Axis,
        /// How far the prism reaches from the corners towards larger coordinates, m.
        thickness: f64,
        /// What it is made of.
        material: MaterialId,
        /// Whether the edges on its surface take the mean of the materials around them.
        averaging: bool,
    },
    /// A rectangle without thickness, which claims the edges that lie in it: `#plate`.
    Plate {
        /// Corner with the smallest coordinates, m; along one axis the same as in `upper`.
        lower: [f64; 3],
        /// Corner with the largest coordinates, m.
        upper: [f64; 3],
        /// What it is made of.
        material: MaterialId,
    },
    /// A line of edges along an axis, which it claims: `#edge`.
    Edge {
        /// End with the smaller coordinate, m.
        lower: [f64; 3],
        /// End with the larger coordinate, m.
        upper: [f64; 3],
        /// What it is made of.
        material: MaterialId,
    },
    /// A block of cells with their materials: `#geometry_objects_read`.
    Voxels(Voxels),
    /// A box of noise: `#fractal_box`.
    Fractal(FractalBox),
}

impl Object {
    /// Whether any of it is made of a material.
    pub fn holds(&self, id: MaterialId) -> bool {
        match self {
            Self::Box { material, .. }
            | Self::Cylinder { material, .. }
            | Self::Sphere { material, .. }
            | Self::Ellipsoid { material, .. }
            | Self::Cone { material, .. }
            | Self::Sector { material, .. }
            | Self::Triangle { material, .. }
            | Self::Plate { material, .. }
            | Self::Edge { material, .. } => *material == id,
            Self::Voxels(block) => {
                let edges = block.edges.iter().flat_map(|edges| &edges.fields);
                block.cells.contains(&Some(id)) || edges.into_iter().any(|field| field.contains(&id))
            }
            Self::Fractal(fractal) => fractal.holds(id),
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
    /// What its cells claim, where that does not follow from their materials and `averaging`.
    pub edges: Option<Arc<BlockEdges>>,
}

/// Which edges and faces the cells of a block claim, and what these are made of.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockEdges {
    /// What each cell claims, see [`edge_flag`](super::edge_flag) and [`face_flag`](super::face_flag); in the order of the
    /// cells.
    pub claims: Vec<u32>,
    /// Material of Ex, Ey, Ez, Hx, Hy, Hz at each node of the block, z fastest. It counts where a cell in or beside the block
    /// claims the edge or face.
    pub fields: [Vec<MaterialId>; 6],
}
