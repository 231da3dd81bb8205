//! Why a model could not be painted.

/// Why a model could not be painted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PaintError {
    /// An object of which an edge's share is not known.
    #[error(
        "object {number} has no true shape in the plane: there a mean over shapes takes boxes and cylinders along z\n\nhint: `--smoothing edges`, or leave `## ballast-gpr: averaging shapes` out"
    )]
    NoShare {
        /// Place in the list of objects, from 1.
        number: usize,
    },
    /// An object without volume, of which no box has a share.
    #[error(
        "object {number} has no volume, and no share in a mean over shapes, unless it conducts perfectly\n\n\
         hint: give it a thickness, or leave `## ballast-gpr: averaging shapes` out"
    )]
    NoVolume {
        /// Place in the list of objects, from 1.
        number: usize,
    },
    /// The grid is not two-dimensional with z as the invariant axis.
    #[error(
        "a grid of {0} x {1} x {2} cells is not two-dimensional along z\n\n\
         hint: give z a single cell, and x and y more than one; other grids run with `--solver gprmax`",
        cells[0], cells[1], cells[2]
    )]
    NotTwoDimensional {
        /// Cell counts.
        cells: [usize; 3],
    },
    /// An object that fills no cell; gprMax refuses it too.
    #[error(
        "object {number}, a {kind} of `{material}` at ({x} m, {y} m), fills no cell of {cell} m\n\n\
         hint: make the object larger than a cell, make the cells smaller, or leave it out"
    )]
    FillsNoCell {
        /// Place in the list of objects, from 1.
        number: usize,
        /// `box`, `cylinder`, `sphere` or `block of voxels`.
        kind: &'static str,
        /// Identifier of its material.
        material: String,
        /// Where it begins, m.
        x: f64,
        /// Where it begins, m.
        y: f64,
        /// The longer side of a cell, m.
        cell: f64,
    },
    /// An object of a material that the model does not hold.
    #[error("object {number} asks for material number {material}, but the model has {materials}")]
    NoSuchMaterial {
        /// Place in the list of objects, from 1.
        number: usize,
        /// The index asked for.
        material: usize,
        /// How many there are.
        materials: usize,
    },
    /// A block of voxels whose list of cells has another length than its shape says.
    #[error("object {number}, a block of {0} x {1} x {2} voxels, holds {cells} of them", shape[0], shape[1], shape[2])]
    VoxelCount {
        /// Place in the list of objects, from 1.
        number: usize,
        /// Cells along x, y, z.
        shape: [usize; 3],
        /// Cells given.
        cells: usize,
    },
    /// A block of cells with edges of its own, whose arrays do not fit, or in the plane.
    #[error(
        "object {number}, a block of voxels, brings edges that do not fit its cells, or that the plane does not know"
    )]
    BlockEdges {
        /// Place in the list of objects, from 1.
        number: usize,
    },
}
