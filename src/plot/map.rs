//! A map of relative permittivity over the section of a model.

use super::error::PlotError;
use super::figure::Figure;
use super::map_layout::lay_out_map;
use super::sheet::Sheet;

/// What a symbol on a map stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SymbolKind {
    /// A source: a triangle that points down.
    Source,
    /// A receiver: a triangle that points up.
    Receiver,
}

/// A source or receiver on a map.
#[derive(Debug, Clone, PartialEq)]
pub struct MapSymbol {
    /// Abscissa, m.
    pub x: f64,
    /// Ordinate, m, upwards.
    pub y: f64,
    /// What is written beside it; empty for nothing.
    pub label: String,
    /// What it stands for.
    pub kind: SymbolKind,
}

/// A layer named at the right edge of a map.
#[derive(Debug, Clone, PartialEq)]
pub struct MapLayer {
    /// Lower boundary, m.
    pub bottom: f64,
    /// Upper boundary, m.
    pub top: f64,
    /// Its name.
    pub label: String,
}

/// A map of relative permittivity, drawn to scale.
#[derive(Debug, Clone, PartialEq)]
pub struct MapFigure {
    /// Title; empty for none.
    pub title: String,
    /// Relative permittivity of every cell, at `[i * ny + j]` with `i` along x and `j` along y, upwards. Infinity is a
    /// perfect conductor (black); NaN is no value (light grey).
    pub values: Vec<f32>,
    /// Number of cells along x.
    pub nx: usize,
    /// Number of cells along y.
    pub ny: usize,
    /// Width and height of the grid, m.
    pub extent: [f64; 2],
    /// Permittivity at either end of the colour bar; `None` takes the smallest and the largest value.
    pub range: Option<(f64, f64)>,
    /// Whether cells of permittivity 1 are white and stand apart from the colour bar.
    pub air_is_white: bool,
    /// Sources and receivers.
    pub symbols: Vec<MapSymbol>,
    /// Layers to name.
    pub layers: Vec<MapLayer>,
    /// Depth of the absorbing layers at the left, bottom, right and top, m, outlined if given.
    pub absorbing: Option<[f64; 4]>,
}

impl MapFigure {
    /// Makes a map without symbols, layers or absorbing boundary, air in white.
    pub fn new(title: &str, values: Vec<f32>, [nx, ny]: [usize; 2], extent: [f64; 2]) -> Self {
        Self {
            title: title.into(),
            values,
            nx,
            ny,
            extent,
            range: None,
            air_is_white: true,
            symbols: Vec::new(),
            layers: Vec::new(),
            absorbing: None,
        }
    }
}

impl Figure for MapFigure {
    fn lay_out(&self) -> Result<Sheet, PlotError> {
        let [width, height] = self.extent;
        if [width, height].iter().any(|side| !side.is_finite() || *side <= 0.0) {
            return Err(PlotError::Extent { title: self.title.clone(), width, height });
        }
        if self.nx.checked_mul(self.ny) != Some(self.values.len()) || self.values.is_empty() {
            let (title, values) = (self.title.clone(), self.values.len());
            return Err(PlotError::MapShape { title, values, nx: self.nx, ny: self.ny });
        }
        Ok(lay_out_map(self))
    }
}
