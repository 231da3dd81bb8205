//! A chart: series, bands and marks over two axes.

use super::axis::Axis;
use super::chart_layout::lay_out_chart;
use super::error::PlotError;
use super::figure::Figure;
use super::pixels::Pixels;
use super::sheet::{Rect, Sheet};

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    /// A line without gaps.
    Solid,
    /// Long dashes.
    Dashed,
    /// Dots.
    Dotted,
    /// Dash, dot, dash, dot.
    DashDotted,
    /// A symbol at each point and no line.
    Points,
    /// A line with a symbol at each point.
    LineAndPoints,
}

/// Points and how they are drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Name in the legend; empty for none.
    pub name: String,
    /// Abscissa and ordinate in the units of the axes. A point that is not a number is a gap.
    pub points: Vec<(f64, f64)>,
    /// How it is drawn.
    pub style: Stroke,
    /// Index into [`PALETTE`](super::PALETTE), which also chooses the symbol.
    pub colour: usize,
    /// Width of the line, points.
    pub width: f64,
}

impl Series {
    /// Makes a solid line in the first colour.
    pub fn line(name: &str, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), points, style: Stroke::Solid, colour: 0, width: 1.6 }
    }

    /// The same series drawn another way.
    #[must_use]
    pub fn drawn(mut self, style: Stroke, colour: usize) -> Self {
        (self.style, self.colour) = (style, colour);
        self
    }
}

/// The area between two curves, for example a mean plus and minus one standard deviation.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// Name in the legend; empty for none.
    pub name: String,
    /// Abscissae.
    pub x: Vec<f64>,
    /// Lower ordinate at each abscissa.
    pub lower: Vec<f64>,
    /// Upper ordinate at each abscissa.
    pub upper: Vec<f64>,
    /// Index into [`PALETTE`](super::PALETTE); drawn pale.
    pub colour: usize,
}

/// A point with its name written beside it.
#[derive(Debug, Clone, PartialEq)]
pub struct Marker {
    /// Abscissa.
    pub x: f64,
    /// Ordinate.
    pub y: f64,
    /// What is written; empty for a bare symbol.
    pub label: String,
    /// Index into [`PALETTE`](super::PALETTE).
    pub colour: usize,
}

/// Which way a reference line runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Line {
    /// Upright, at an abscissa.
    Vertical,
    /// Level, at an ordinate.
    Horizontal,
}

/// A thin dashed line across the chart with its name beside it: an echo, a target.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceLine {
    /// Where: an abscissa or an ordinate.
    pub at: f64,
    /// Which way it runs.
    pub line: Line,
    /// What is written beside it; empty for nothing.
    pub label: String,
}

impl ReferenceLine {
    /// Makes an upright line.
    pub fn vertical(at: f64, label: &str) -> Self {
        Self { at, line: Line::Vertical, label: label.into() }
    }

    /// Makes a level line.
    pub fn horizontal(at: f64, label: &str) -> Self {
        Self { at, line: Line::Horizontal, label: label.into() }
    }
}

/// Where the legend goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Legend {
    /// In the corner where it hides nothing; above the chart when it would hide something in each.
    #[default]
    Auto,
    /// Above the chart.
    Above,
    /// Nowhere.
    None,
}

/// A two-dimensional chart.
///
/// Labels of markers and reference lines never overlap one another; one that finds no room is left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// Title, above the chart; empty for none.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Curves and points, the lowest first.
    pub series: Vec<Series>,
    /// Shaded bands, below all series.
    pub bands: Vec<Band>,
    /// Points with names.
    pub markers: Vec<Marker>,
    /// Lines with names.
    pub lines: Vec<ReferenceLine>,
    /// Values drawn as pixels, below all else.
    pub pixels: Option<Pixels>,
    /// Where the legend goes.
    pub legend: Legend,
    /// Width and height, points; the PNG has twice as many pixels.
    pub size: [f64; 2],
}

impl Chart {
    /// Makes an empty chart of 960 × 600 points.
    pub fn new(title: &str, x: Axis, y: Axis) -> Self {
        Self {
            title: title.into(),
            x,
            y,
            series: Vec::new(),
            bands: Vec::new(),
            markers: Vec::new(),
            lines: Vec::new(),
            pixels: None,
            legend: Legend::Auto,
            size: [960.0, 600.0],
        }
    }

    /// The same chart with one more series.
    #[must_use]
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    pub(super) fn check(&self) -> Result<(), PlotError> {
        if let Some(Pixels { values, columns, rows, .. }) = &self.pixels
            && columns.checked_mul(*rows) != Some(values.len())
        {
            let title = self.title.clone();
            return Err(PlotError::MapShape { title, values: values.len(), nx: *columns, ny: *rows });
        }
        match self.bands.iter().find(|band| band.lower.len() != band.x.len() || band.upper.len() != band.x.len()) {
            Some(Band { name, x, lower, upper, .. }) => {
                Err(PlotError::BandShape { name: name.clone(), x: x.len(), lower: lower.len(), upper: upper.len() })
            }
            None => Ok(()),
        }
    }
}

impl Figure for Chart {
    fn lay_out(&self) -> Result<Sheet, PlotError> {
        let mut sheet = Sheet::new(&self.title, self.size[0], self.size[1]);
        lay_out_chart(&mut sheet, self, Rect::new(0.0, 0.0, self.size[0], self.size[1]), 0.0)?;
        Ok(sheet)
    }
}
