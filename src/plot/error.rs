//! What can go wrong with a figure.

use crate::files::FileError;

/// A figure that could not be drawn or written.
#[derive(Debug, thiserror::Error)]
pub enum PlotError {
    /// The values of a map do not fill its grid.
    #[error("the map `{title}` has {values} values, but its grid is {nx} × {ny} = {} cells", nx.saturating_mul(*ny))]
    MapShape {
        /// Title of the map.
        title: String,
        /// How many values it holds.
        values: usize,
        /// Cells along x.
        nx: usize,
        /// Cells along y.
        ny: usize,
    },
    /// The extent of a map or of a packing is not a size.
    #[error("the figure `{title}` spans {width} m × {height} m; both must be above zero and finite")]
    Extent {
        /// Title of the figure.
        title: String,
        /// Width, m.
        width: f64,
        /// Height, m.
        height: f64,
    },
    /// The spheres and what colours them are not as many.
    #[error("the figure `{title}` has {spheres} spheres, but {values} values to colour them; they must be as many")]
    SphereValues {
        /// Title of the figure.
        title: String,
        /// Number of spheres.
        spheres: usize,
        /// Number of values.
        values: usize,
    },
    /// The three columns of a band differ in length.
    #[error("the band `{name}` has {x} abscissae, {lower} lower and {upper} upper values; they must be as many")]
    BandShape {
        /// Name of the band.
        name: String,
        /// Number of abscissae.
        x: usize,
        /// Number of lower values.
        lower: usize,
        /// Number of upper values.
        upper: usize,
    },
    /// The figure is too small or too large to draw.
    #[error(
        "a figure of {width} × {height} points cannot be drawn: each side must lie between {smallest} and {largest}"
    )]
    Size {
        /// Width, points.
        width: f64,
        /// Height, points.
        height: f64,
        /// Smallest side that can be drawn, points.
        smallest: f64,
        /// Largest side that can be drawn, points.
        largest: f64,
    },
    /// The embedded font cannot be read.
    #[error("the font inside the program cannot be read")]
    Font,
    /// The drawing backend failed.
    #[error("draw `{title}`: {source}")]
    Drawing {
        /// Title of the figure.
        title: String,
        /// What the backend said.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The pixels could not be packed as PNG.
    #[error("encode an image of {width} × {height} pixels as PNG: {source}")]
    Png {
        /// Width, pixels.
        width: u32,
        /// Height, pixels.
        height: u32,
        /// What the encoder said.
        source: png::EncodingError,
    },
    /// The file could not be written.
    #[error(transparent)]
    File(#[from] FileError),
}
