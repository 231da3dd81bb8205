//! Values on an even grid behind the curves of a chart: a radargram, a short-time spectrum.

use super::axis::Span;
use super::colour::{Colour, viridis};
use super::image::Image;
use super::sheet::Rect;

/// How values become colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shades {
    /// Grey: zero is the middle, the limit white, minus the limit black.
    #[default]
    Grey,
    /// Viridis: zero is dark, the limit bright.
    Viridis,
}

/// Values on an even grid, each drawn as a rectangle about its place.
#[derive(Debug, Clone, PartialEq)]
pub struct Pixels {
    /// The values, at `[column * rows + row]`. What is not a number is white.
    pub values: Vec<f64>,
    /// Number of columns.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// Abscissae of the first and the last column.
    pub x: (f64, f64),
    /// Ordinates of the first and the last row.
    pub y: (f64, f64),
    /// How values become colours.
    pub shades: Shades,
    /// The size at which the colours end; the largest size of a value where none is given.
    pub limit: Option<f64>,
}

impl Pixels {
    /// Half of the distance between two neighbours; a half where there is one alone.
    fn half_cell((first, last): (f64, f64), count: usize) -> f64 {
        let cell = (last - first) / count.saturating_sub(1).max(1) as f64;
        if cell == 0.0 || !cell.is_finite() { 0.5 } else { 0.5 * cell }
    }

    pub(super) fn horizontal_edges(&self) -> [f64; 2] {
        let half = Self::half_cell(self.x, self.columns);
        [self.x.0 - half, self.x.1 + half]
    }

    pub(super) fn vertical_edges(&self) -> [f64; 2] {
        let half = Self::half_cell(self.y, self.rows);
        [self.y.0 - half, self.y.1 + half]
    }

    /// The size at which the colours end.
    pub fn largest(&self) -> f64 {
        let finite = self.values.iter().filter(|v| v.is_finite());
        self.limit.filter(|limit| *limit > 0.0).unwrap_or_else(|| finite.fold(0.0, |largest, v| v.abs().max(largest)))
    }

    /// The picture that fills a frame with these spans, two pixels per point; white beyond the grid.
    pub(super) fn image(&self, frame: &Rect, [x, y]: [&Span; 2], downwards: bool) -> Image {
        let pixels_of = |length: f64| (2.0 * length).round().clamp(1.0, 4000.0) as usize;
        let (width, height) = (pixels_of(frame.width), pixels_of(frame.height));
        let cells = |span: &Span, [first, last]: [f64; 2], count: usize, pixels: usize, turned: bool| {
            let cell = |pixel: usize| {
                let share = (pixel as f64 + 0.5) / pixels as f64;
                let share = if turned { 1.0 - share } else { share };
                let value = span.low + share * (span.high - span.low);
                let at = (value - first) / (last - first) * count as f64;
                (0.0..count as f64).contains(&at).then_some(at as usize)
            };
            (0..pixels).map(cell).collect::<Vec<_>>()
        };
        let columns = cells(x, self.horizontal_edges(), self.columns, width, false);
        // The first row of a picture is its top.
        let rows = cells(y, self.vertical_edges(), self.rows, height, !downwards);
        let limit = self.largest();
        let mut pixels = Vec::with_capacity(3 * width * height);
        for row in &rows {
            for column in &columns {
                let value = column.zip(*row).map(|(column, row)| self.values[column * self.rows + row]);
                pixels.extend(value.map_or(Colour::WHITE, |value| self.colour(value, limit)).rgb);
            }
        }
        Image { width, height, pixels }
    }

    fn colour(&self, value: f64, limit: f64) -> Colour {
        let share = if limit > 0.0 { value / limit } else { 0.0 };
        match self.shades {
            _ if !value.is_finite() => Colour::WHITE,
            Shades::Grey => Colour::grey((127.5 + 127.5 * share.clamp(-1.0, 1.0)).round() as u8),
            Shades::Viridis => viridis(share),
        }
    }
}
