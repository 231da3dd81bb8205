//! How series look, and the legend that explains it.

use super::chart::{Chart, Series, Stroke};
use super::chart_layout::TICK_SIZE;
use super::colour::Colour;
use super::font::{shortened, text_width};
use super::path::dashed;
use super::place::Room;
use super::sheet::{Anchor, Rect, Sheet};

/// Height of a row of the legend, points.
pub(super) const LEGEND_ROW: f64 = 20.0;

const LEGEND_SAMPLE: f64 = 32.0;

/// Lengths of dash, gap, dash, gap …, points; none for a line without gaps.
pub(super) fn pattern(style: Stroke) -> &'static [f64] {
    match style {
        Stroke::Solid | Stroke::Points | Stroke::LineAndPoints => &[],
        Stroke::Dashed => &[7.0, 4.0],
        Stroke::Dotted => &[1.8, 3.2],
        Stroke::DashDotted => &[9.0, 3.0, 1.8, 3.0],
    }
}

pub(super) fn has_line(style: Stroke) -> bool {
    style != Stroke::Points
}

pub(super) fn has_points(style: Stroke) -> bool {
    matches!(style, Stroke::Points | Stroke::LineAndPoints)
}

/// The width of a line, kept to what can be seen.
pub(super) fn line_width(series: &Series) -> f64 {
    if series.width.is_finite() { series.width.clamp(0.5, 10.0) } else { 1.6 }
}

/// Draws the symbol that belongs to a colour of the palette.
pub(super) fn draw_symbol(sheet: &mut Sheet, [x, y]: [f64; 2], index: usize, r: f64) {
    let colour = Colour::of_palette(index);
    match index % 5 {
        0 => sheet.disc([x, y], r, colour),
        1 => sheet.fill(Rect::new(x - 0.88 * r, y - 0.88 * r, 1.76 * r, 1.76 * r), colour),
        2 => sheet.area(vec![[x, y - 1.25 * r], [x + 1.1 * r, y + 0.75 * r], [x - 1.1 * r, y + 0.75 * r]], colour),
        3 => sheet.area(vec![[x, y - 1.3 * r], [x + 1.3 * r, y], [x, y + 1.3 * r], [x - 1.3 * r, y]], colour),
        _ => sheet.area(vec![[x, y + 1.25 * r], [x + 1.1 * r, y - 0.75 * r], [x - 1.1 * r, y - 0.75 * r]], colour),
    }
}

/// What an entry explains: the index of a series or of a band.
pub(super) enum Sample {
    Series(usize),
    Band(usize),
}

/// A row of the legend.
pub(super) struct Entry {
    pub(super) sample: Sample,
    pub(super) name: String,
}

impl Entry {
    pub(super) fn width(&self) -> f64 {
        LEGEND_SAMPLE + 8.0 + text_width(&self.name, TICK_SIZE) + 18.0
    }
}

/// The rows of the legend, their names cut to a width.
pub(super) fn legend_entries(chart: &Chart, width: f64) -> Vec<Entry> {
    let named = |sample, name: &str| Entry { sample, name: shortened(name, TICK_SIZE, width - LEGEND_SAMPLE - 26.0) };
    let series = chart.series.iter().enumerate().map(|(i, s)| named(Sample::Series(i), &s.name));
    let bands = chart.bands.iter().enumerate().map(|(i, b)| named(Sample::Band(i), &b.name));
    series.chain(bands).filter(|entry| !entry.name.is_empty()).collect()
}

/// The corner where a legend hides nothing, if there is one.
pub(super) fn legend_inside(frame: &Rect, entries: &[Entry], room: &mut Room) -> Option<Rect> {
    let width = entries.iter().map(Entry::width).fold(0.0, f64::max) - 2.0;
    let height = entries.len() as f64 * LEGEND_ROW + 10.0;
    let (left, right) = (frame.x + 8.0, frame.right() - 8.0 - width);
    let (top, bottom) = (frame.y + 8.0, frame.bottom() - 8.0 - height);
    let places = [[right, top], [left, top], [right, bottom], [left, bottom]];
    let places = places.map(|[x, y]| Rect::new(x, y, width, height));
    let tolerable = |place: &Rect| room.hidden(&place.shrunk(-3.0)) == 0;
    let free: Vec<_> = places.into_iter().filter(tolerable).collect();
    if width > 0.6 * frame.width || height > 0.7 * frame.height { None } else { room.claim(frame, free) }
}

/// Entries of a legend above the chart, row by row.
pub(super) fn legend_rows(entries: &[Entry], width: f64) -> Vec<Vec<&Entry>> {
    let mut rows: Vec<Vec<&Entry>> = Vec::new();
    let mut used = f64::INFINITY;
    for entry in entries {
        if used + entry.width() > width {
            rows.push(Vec::new());
            used = 0.0;
        }
        used += entry.width();
        if let Some(row) = rows.last_mut() {
            row.push(entry);
        }
    }
    rows
}

/// Draws one entry from the point at the left end of its sample.
pub(super) fn draw_entry(sheet: &mut Sheet, chart: &Chart, entry: &Entry, [x, y]: [f64; 2]) {
    match entry.sample {
        Sample::Series(index) => {
            let series = &chart.series[index];
            if has_line(series.style) {
                for dash in dashed(&[[x, y], [x + LEGEND_SAMPLE, y]], pattern(series.style)) {
                    sheet.line(dash, Colour::of_palette(series.colour), line_width(series));
                }
            }
            if has_points(series.style) {
                draw_symbol(sheet, [x + LEGEND_SAMPLE / 2.0, y], series.colour, 4.0);
            }
        }
        Sample::Band(index) => {
            let colour = Colour::of_palette(chart.bands[index].colour).with_alpha(0.25);
            sheet.fill(Rect::new(x, y - 6.0, LEGEND_SAMPLE, 12.0), colour);
        }
    }
    sheet.text([x + LEGEND_SAMPLE + 8.0, y + 0.36 * TICK_SIZE], &entry.name, TICK_SIZE, Anchor::Start);
}
