//! Geometry files that a model asks for.

/// A block of cells to write into a geometry file (`#geometry_objects_write`), which `#geometry_objects_read` takes.
#[derive(Debug, Clone, PartialEq)]
pub struct GeometryFile {
    /// Lower corner, m.
    pub lower: [f64; 3],
    /// Upper corner, m.
    pub upper: [f64; 3],
    /// Name of the file, relative to the folder of the input file; the extension `.h5` may be left out.
    pub file: String,
}
