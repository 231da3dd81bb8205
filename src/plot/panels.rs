//! Several charts in one figure.

use super::chart::Chart;
use super::chart_layout::{BORDER, TITLE_HEIGHT, TITLE_SIZE, lay_out_chart, left_margin};
use super::error::PlotError;
use super::figure::Figure;
use super::sheet::{Rect, Sheet};

/// Charts in a grid, row by row, under one title; the frames of a column begin at the same abscissa.
#[derive(Debug, Clone, PartialEq)]
pub struct Panels {
    /// Title above all of them; empty for none.
    pub title: String,
    /// Number of columns; zero counts as one.
    pub columns: usize,
    /// The charts; their own sizes are not used.
    pub charts: Vec<Chart>,
    /// Height of each row relative to the others; missing ones count as 1.
    pub heights: Vec<f64>,
    /// Width and height of the whole, points.
    pub size: [f64; 2],
}

impl Panels {
    /// Stacks charts in one column, 960 points wide and 300 high each.
    pub fn stacked(title: &str, charts: Vec<Chart>) -> Self {
        let height = 40.0 + 300.0 * charts.len().max(1) as f64;
        Self { title: title.into(), columns: 1, charts, heights: Vec::new(), size: [960.0, height] }
    }

    fn row_weight(&self, row: usize) -> f64 {
        self.heights.get(row).copied().filter(|weight| weight.is_finite() && *weight > 0.0).unwrap_or(1.0)
    }
}

impl Figure for Panels {
    fn lay_out(&self) -> Result<Sheet, PlotError> {
        let [width, height] = self.size;
        let mut sheet = Sheet::new(&self.title, width, height);
        let top = if self.title.is_empty() { 0.0 } else { TITLE_HEIGHT };
        sheet.title([width / 2.0, BORDER + TITLE_SIZE], &self.title, TITLE_SIZE + 1.0, width - 2.0 * BORDER);
        let columns = self.columns.max(1);
        let rows = self.charts.len().div_ceil(columns);
        let weights: f64 = (0..rows).map(|row| self.row_weight(row)).sum();
        let mut areas = Vec::with_capacity(self.charts.len());
        let mut y = top;
        for row in 0..rows {
            let row_height = (height - top) * self.row_weight(row) / weights;
            let column_width = width / columns as f64;
            areas.extend((0..columns).map(|c| Rect::new(c as f64 * column_width, y, column_width, row_height)));
            y += row_height;
        }
        for column in 0..columns {
            let cells = || self.charts.iter().zip(&areas).skip(column).step_by(columns);
            let left = cells().map(|(chart, area)| left_margin(chart, area)).fold(0.0, f64::max);
            for (chart, area) in cells() {
                lay_out_chart(&mut sheet, chart, *area, left)?;
            }
        }
        Ok(sheet)
    }
}
