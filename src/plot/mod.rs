//! Figures, as PNG and SVG.
//!
//! Every figure is plain data: a [`Chart`], several of them in [`Panels`], a [`PackingFigure`], a [`SpheresFigure`] or a
//! [`MapFigure`].
//! [`Figure::write`] lays it out once on a [`Sheet`] and hands that sheet to the two backends of plotters, so the two
//! files show the same. All of them share one palette (Okabe and Ito), one embedded font (a subset of DejaVu Sans) and
//! one set of letter sizes.
//!
//! ```
//! use ballast_gpr::plot::{Axis, Chart, Figure, Series};
//! let trace = Series::line("simulated", vec![(0.0, 0.0), (1.0, 0.8), (2.0, -0.4)]);
//! let chart = Chart::new("A-scan", Axis::linear("time", "ns"), Axis::linear("amplitude", "")).with(trace);
//! let folder = tempfile::tempdir()?;
//! let written = chart.write(folder.path(), "a-scan")?;
//! assert_eq!(written, [folder.path().join("a-scan.png"), folder.path().join("a-scan.svg")]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod axis;
mod chart;
mod chart_layout;
mod colour;
mod error;
mod figure;
mod font;
mod image;
mod legend;
mod map;
mod map_layout;
mod packing;
mod panels;
mod path;
mod pixels;
mod place;
mod render;
mod sheet;
mod spheres;
mod ticks;

pub use axis::{Axis, Scale};
pub use chart::{Band, Chart, Legend, Line, Marker, ReferenceLine, Series, Stroke};
pub use colour::{Colour, PALETTE, viridis};
pub use error::PlotError;
pub use figure::Figure;
pub use image::{Image, base64};
pub use map::{MapFigure, MapLayer, MapSymbol, SymbolKind};
pub use packing::PackingFigure;
pub use panels::Panels;
pub use pixels::{Pixels, Shades};
pub use sheet::{Anchor, Mark, Rect, Sheet};
pub use spheres::SpheresFigure;
