//! Views of the geometry that a model asks for.

/// What a view shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ViewKind {
    /// The material of cells: of the one at the lower corner of each cell of the view.
    Cells,
    /// The material of every edge, as the solver sees it.
    Edges,
}

/// A block of cells to write for ParaView (`#geometry_view`).
#[derive(Debug, Clone, PartialEq)]
pub struct GeometryView {
    /// Lower corner, m.
    pub lower: [f64; 3],
    /// Upper corner, m.
    pub upper: [f64; 3],
    /// Sizes of the view's cells, m; those of the grid for edges.
    pub spacing: [f64; 3],
    /// What it shows.
    pub kind: ViewKind,
    /// Name of the file, relative to the folder of the traces; its ending becomes `.vtkhdf`.
    pub file: String,
}
