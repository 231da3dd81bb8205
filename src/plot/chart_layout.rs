//! Lays a chart out: margins, ticks, curves, labels and legend.

use super::axis::{Scale, Span};
use super::chart::{Band, Chart, Legend, Line, Series, Stroke};
use super::colour::Colour;
use super::error::PlotError;
use super::font::{shortened, text_width};
use super::legend::{
    LEGEND_ROW, draw_entry, draw_symbol, has_line, has_points, legend_entries, legend_inside, legend_rows, line_width,
    pattern,
};
use super::path::{clip_polygon, clipped, dashed, sampled, thinned};
use super::place::{Room, around, beside_level, beside_upright};
use super::sheet::{Anchor, Rect, Sheet};
use super::ticks::{Ticks, choose, given};

/// Letter sizes, points per em.
pub(super) const TITLE_SIZE: f64 = 17.0;
pub(super) const CAPTION_SIZE: f64 = 14.0;
pub(super) const TICK_SIZE: f64 = 13.0;
pub(super) const LABEL_SIZE: f64 = 12.5;

/// Height of a title with the space around it.
pub(super) const TITLE_HEIGHT: f64 = 30.0;

/// Space between the border of a figure and what it shows.
pub(super) const BORDER: f64 = 12.0;

/// Height of a label with the space around its letters.
pub(super) const LABEL_HEIGHT: f64 = 17.0;

const TICK_LENGTH: f64 = 5.0;

pub(super) const FRAME_COLOUR: Colour = Colour::grey(70);
const GRID_COLOUR: Colour = Colour::grey(228);
const ZERO_COLOUR: Colour = Colour::grey(190);
const LINE_COLOUR: Colour = Colour::grey(90);
const TEXT_COLOUR: Colour = Colour::grey(20);

/// A frame with its two axes.
struct Plane {
    frame: Rect,
    x: Span,
    y: Span,
    x_ticks: Ticks,
    y_ticks: Ticks,
    downwards: bool,
}

impl Plane {
    /// Where a point falls on the sheet, in the frame or out of it.
    fn place(&self, (x, y): (f64, f64)) -> Option<[f64; 2]> {
        let (u, v) = (self.x.share(x)?, self.y.share(y)?);
        Some([self.frame.x + u * self.frame.width, self.level(v)])
    }

    /// Where a share of the vertical axis lies on the sheet.
    fn level(&self, share: f64) -> f64 {
        let share = if self.downwards { 1.0 - share } else { share };
        self.frame.bottom() - share * self.frame.height
    }
}

/// Width needed left of the frame of a chart of this height, points.
pub(super) fn left_margin(chart: &Chart, area: &Rect) -> f64 {
    let y = vertical_span(chart, &horizontal_span(chart));
    left_of(chart, &vertical_ticks(chart, &y, area.height - 90.0))
}

fn left_of(chart: &Chart, ticks: &Ticks) -> f64 {
    let widest = ticks.major.iter().map(|(_, label)| text_width(label, TICK_SIZE)).fold(0.0, f64::max);
    let caption = if chart.y.caption(&ticks.factor).is_empty() { 0.0 } else { CAPTION_SIZE + 12.0 };
    BORDER + caption + widest + TICK_LENGTH + 5.0
}

fn vertical_ticks(chart: &Chart, span: &Span, height: f64) -> Ticks {
    let mut ticks = if chart.y.ticks.is_empty() {
        choose(span, (height / 42.0).clamp(2.0, 10.0) as usize)
    } else {
        let mut ticks = given(span, &chart.y.ticks);
        keep_apart(&mut ticks, |a, b| (b.0 - a.0) * height >= TICK_SIZE + 2.0);
        ticks
    };
    if chart.y.downwards {
        for share in ticks.major.iter_mut().map(|(share, _)| share).chain(&mut ticks.minor) {
            *share = 1.0 - *share;
        }
    }
    ticks
}

fn horizontal_ticks(chart: &Chart, span: &Span, width: f64) -> Ticks {
    if chart.x.ticks.is_empty() {
        return fitting_ticks(span, width);
    }
    let mut ticks = given(span, &chart.x.ticks);
    keep_apart(&mut ticks, |a, b| {
        (b.0 - a.0) * width >= (text_width(&a.1, TICK_SIZE) + text_width(&b.1, TICK_SIZE)) / 2.0 + 6.0
    });
    ticks
}

/// Makes a tick whose label would touch the one before a tick without label.
fn keep_apart(ticks: &mut Ticks, apart: impl Fn(&(f64, String), &(f64, String)) -> bool) {
    let mut kept: Vec<(f64, String)> = Vec::with_capacity(ticks.major.len());
    for tick in ticks.major.drain(..) {
        if kept.last().is_none_or(|last| apart(last, &tick)) {
            kept.push(tick);
        } else {
            ticks.minor.push(tick.0);
        }
    }
    ticks.major = kept;
}

fn horizontal_span(chart: &Chart) -> Span {
    let lines = chart.series.iter().any(|s| !matches!(s.style, Stroke::Points | Stroke::LineAndPoints));
    let margin = if lines || chart.pixels.is_some() || (chart.series.is_empty() && !chart.bands.is_empty()) {
        0.0
    } else {
        0.04
    };
    let upright = chart.lines.iter().filter(|line| line.line == Line::Vertical).map(|line| line.at);
    let points =
        chart.series.iter().flat_map(|s| &s.points).filter(|p| p.1.is_finite() && p.0.is_finite()).map(|p| p.0);
    let bands = chart.bands.iter().flat_map(|band| band.x.iter().copied());
    let edges = chart.pixels.iter().flat_map(|pixels| pixels.horizontal_edges());
    let values = points.chain(bands).chain(chart.markers.iter().map(|m| m.x)).chain(upright).chain(edges);
    Span::of(&chart.x, values.filter(|v| v.is_finite()), margin)
}

fn vertical_span(chart: &Chart, x: &Span) -> Span {
    let seen = |at: f64| x.share(at).is_some_and(|share| (-1e-9..=1.0 + 1e-9).contains(&share));
    let level = chart.lines.iter().filter(|line| line.line == Line::Horizontal).map(|line| line.at);
    let points = chart.series.iter().flat_map(|s| &s.points).filter(|p| seen(p.0)).map(|p| p.1);
    let bands = chart.bands.iter().flat_map(|band| {
        let rows = band.x.iter().zip(band.lower.iter().zip(&band.upper));
        rows.filter(|(at, _)| seen(**at)).flat_map(|(_, (low, high))| [*low, *high])
    });
    let markers = chart.markers.iter().filter(|m| seen(m.x)).map(|m| m.y);
    let edges = chart.pixels.iter().flat_map(|pixels| pixels.vertical_edges());
    let margin = if chart.pixels.is_some() { 0.0 } else { 0.06 };
    Span::of(&chart.y, points.chain(bands).chain(markers).chain(level).chain(edges).filter(|v| v.is_finite()), margin)
}

/// Chooses as many horizontal ticks as fit beside one another.
pub(super) fn fitting_ticks(span: &Span, width: f64) -> Ticks {
    let mut most = (width / 55.0).clamp(2.0, 14.0) as usize;
    loop {
        let ticks = choose(span, most);
        let fits = ticks.major.windows(2).all(|pair| {
            let needed = (text_width(&pair[0].1, TICK_SIZE) + text_width(&pair[1].1, TICK_SIZE)) / 2.0 + 10.0;
            (pair[1].0 - pair[0].0) * width >= needed
        });
        if fits || most <= 2 {
            return ticks;
        }
        most -= 1;
    }
}

fn plane(chart: &Chart, area: &Rect, top: f64, least_left: f64) -> Plane {
    let x = horizontal_span(chart);
    let y = vertical_span(chart, &x);
    let bottom =
        BORDER + TICK_LENGTH + TICK_SIZE + 5.0 + if chart.x.label.is_empty() { 0.0 } else { CAPTION_SIZE + 8.0 };
    let height = (area.height - top - bottom).max(10.0);
    let y_ticks = vertical_ticks(chart, &y, height);
    let left = left_of(chart, &y_ticks).max(least_left).min(area.width * 0.45);
    let mut right = BORDER + 8.0;
    let mut x_ticks = Ticks::default();
    for _ in 0..2 {
        let width = (area.width - left - right).max(10.0);
        x_ticks = horizontal_ticks(chart, &x, width);
        let overhang = |(share, label): &(f64, String)| (share - 1.0) * width + text_width(label, TICK_SIZE) / 2.0;
        let needed = x_ticks.major.last().map_or(0.0, overhang) + BORDER / 2.0;
        right = right.max(needed.min(area.width * 0.3));
    }
    let width = (area.width - left - right).max(10.0);
    let frame = Rect::new(area.x + left, area.y + top, width, height);
    Plane { frame, x, y, x_ticks, y_ticks, downwards: chart.y.downwards }
}

/// Lays a chart out in an area of a sheet; the frame begins at least `least_left` from the left edge of the area.
pub(super) fn lay_out_chart(sheet: &mut Sheet, chart: &Chart, area: Rect, least_left: f64) -> Result<(), PlotError> {
    chart.check()?;
    let top = if chart.title.is_empty() { BORDER } else { BORDER + TITLE_HEIGHT };
    let mut plan = plane(chart, &area, top, least_left);
    let entries = legend_entries(chart, plan.frame.width);
    let mut room = Room { ink: ink(chart, &plan), ..Room::default() };
    let mut legend = None;
    if chart.legend != Legend::None && !entries.is_empty() {
        if chart.legend == Legend::Auto {
            legend = legend_inside(&plan.frame, &entries, &mut room);
        }
        if legend.is_none() {
            let rows = legend_rows(&entries, plan.frame.width);
            plan = plane(chart, &area, top + rows.len() as f64 * LEGEND_ROW + 6.0, least_left);
            room = Room { ink: ink(chart, &plan), ..Room::default() };
            for (number, row) in rows.iter().enumerate() {
                let y = area.y + top + number as f64 * LEGEND_ROW;
                let mut x = plan.frame.x;
                for entry in row {
                    draw_entry(sheet, chart, entry, [x, y + LEGEND_ROW / 2.0]);
                    x += entry.width();
                }
            }
        }
    }
    if !chart.title.is_empty() {
        let middle = plan.frame.x + plan.frame.width / 2.0;
        let room = 2.0 * (middle - area.x).min(area.right() - middle) - BORDER;
        sheet.title([middle, area.y + BORDER + TITLE_SIZE], &chart.title, TITLE_SIZE, room);
    }
    draw_grid(sheet, &plan);
    if let Some(pixels) = &chart.pixels {
        sheet.picture(plan.frame, pixels.image(&plan.frame, [&plan.x, &plan.y], plan.downwards));
    }
    for band in &chart.bands {
        draw_band(sheet, &plan, band);
    }
    draw_reference_lines(sheet, chart, &plan);
    for series in &chart.series {
        draw_series(sheet, &plan, series);
    }
    draw_axes(sheet, chart, &plan);
    if let Some(place) = legend {
        sheet.fill(place, Colour::WHITE.with_alpha(0.85));
        sheet.frame(place, Colour::grey(200), 0.75);
        for (number, entry) in entries.iter().enumerate() {
            let y = place.y + 5.0 + (number as f64 + 0.5) * LEGEND_ROW;
            draw_entry(sheet, chart, entry, [place.x + 8.0, y]);
        }
    }
    draw_labels(sheet, chart, &plan, &mut room);
    Ok(())
}

fn draw_grid(sheet: &mut Sheet, plan: &Plane) {
    let frame = plan.frame;
    for (share, _) in &plan.x_ticks.major {
        let x = frame.x + share * frame.width;
        sheet.line(vec![[x, frame.y], [x, frame.bottom()]], GRID_COLOUR, 0.75);
    }
    for (share, _) in &plan.y_ticks.major {
        let y = frame.bottom() - share * frame.height;
        sheet.line(vec![[frame.x, y], [frame.right(), y]], GRID_COLOUR, 0.75);
    }
    if plan.y.scale == Scale::Linear && plan.y.low < 0.0 && plan.y.high > 0.0 {
        let y = plan.level(plan.y.share(0.0).unwrap_or(0.0));
        sheet.line(vec![[frame.x, y], [frame.right(), y]], ZERO_COLOUR, 0.75);
    }
}

fn draw_axes(sheet: &mut Sheet, chart: &Chart, plan: &Plane) {
    let frame = plan.frame;
    draw_ticks(sheet, &frame, &plan.x_ticks, &plan.y_ticks);
    sheet.frame(frame, FRAME_COLOUR, 1.0);
    let below = frame.bottom() + TICK_LENGTH + TICK_SIZE + 5.0 + CAPTION_SIZE + 4.0;
    let caption = chart.x.caption(&plan.x_ticks.factor);
    let caption = shortened(&caption, CAPTION_SIZE, frame.width + 30.0);
    sheet.text([frame.x + frame.width / 2.0, below], &caption, CAPTION_SIZE, Anchor::Middle);
    let widest = plan.y_ticks.major.iter().map(|(_, label)| text_width(label, TICK_SIZE)).fold(0.0, f64::max);
    let x = frame.x - TICK_LENGTH - 5.0 - widest - 8.0;
    let caption = shortened(&chart.y.caption(&plan.y_ticks.factor), CAPTION_SIZE, frame.height + 20.0);
    sheet.text_upwards([x, frame.y + frame.height / 2.0], &caption, CAPTION_SIZE);
}

/// Ticks and their labels below and left of a frame.
pub(super) fn draw_ticks(sheet: &mut Sheet, frame: &Rect, x_ticks: &Ticks, y_ticks: &Ticks) {
    for (share, label) in &x_ticks.major {
        let x = frame.x + share * frame.width;
        sheet.line(vec![[x, frame.bottom()], [x, frame.bottom() + TICK_LENGTH]], FRAME_COLOUR, 1.0);
        sheet.text([x, frame.bottom() + TICK_LENGTH + TICK_SIZE + 1.0], label, TICK_SIZE, Anchor::Middle);
    }
    for share in &x_ticks.minor {
        let x = frame.x + share * frame.width;
        sheet.line(vec![[x, frame.bottom()], [x, frame.bottom() + 0.6 * TICK_LENGTH]], FRAME_COLOUR, 0.75);
    }
    for (share, label) in &y_ticks.major {
        let y = frame.bottom() - share * frame.height;
        sheet.line(vec![[frame.x - TICK_LENGTH, y], [frame.x, y]], FRAME_COLOUR, 1.0);
        sheet.text([frame.x - TICK_LENGTH - 4.0, y + 0.36 * TICK_SIZE], label, TICK_SIZE, Anchor::End);
    }
    for share in &y_ticks.minor {
        let y = frame.bottom() - share * frame.height;
        sheet.line(vec![[frame.x - 0.6 * TICK_LENGTH, y], [frame.x, y]], FRAME_COLOUR, 0.75);
    }
}

fn pieces(plan: &Plane, points: impl Iterator<Item = (f64, f64)>) -> Vec<Vec<[f64; 2]>> {
    clipped(points.map(|p| plan.place(p)), &plan.frame).iter().map(|piece| thinned(piece)).collect()
}

/// The points of a series that have a place in the frame.
fn spots(plan: &Plane, series: &Series) -> Vec<[f64; 2]> {
    let frame = plan.frame.shrunk(-0.5);
    let mut spots: Vec<_> =
        series.points.iter().filter_map(|&p| plan.place(p)).filter(|p| frame.contains(*p)).collect();
    spots.dedup_by(|a, b| (a[0] - b[0]).abs() < 0.25 && (a[1] - b[1]).abs() < 0.25);
    spots
}

fn draw_series(sheet: &mut Sheet, plan: &Plane, series: &Series) {
    let colour = Colour::of_palette(series.colour);
    if has_line(series.style) {
        for piece in pieces(plan, series.points.iter().copied()) {
            for dash in dashed(&piece, pattern(series.style)) {
                sheet.line(dash, colour, line_width(series));
            }
        }
    }
    // A line through one point alone would show nothing.
    let lonely = series.points.iter().filter(|&&p| plan.place(p).is_some()).count() == 1;
    if has_points(series.style) || lonely {
        for spot in spots(plan, series) {
            draw_symbol(sheet, spot, series.colour, 4.0);
        }
    }
}

/// The outlines of a band: one polygon per run of rows without gaps.
fn band_outlines(plan: &Plane, band: &Band) -> Vec<Vec<[f64; 2]>> {
    let rows: Vec<_> = band
        .x
        .iter()
        .zip(band.lower.iter().zip(&band.upper))
        .map(|(&x, (&low, &high))| Some((plan.place((x, low))?, plan.place((x, high))?)))
        .collect();
    rows.split(Option::is_none)
        .map(|run| {
            let (lower, upper): (Vec<_>, Vec<_>) = run.iter().flatten().copied().unzip();
            let outline: Vec<_> = thinned(&upper).into_iter().chain(thinned(&lower).into_iter().rev()).collect();
            clip_polygon(&outline, &plan.frame)
        })
        .filter(|outline| outline.len() > 2)
        .collect()
}

fn draw_band(sheet: &mut Sheet, plan: &Plane, band: &Band) {
    for outline in band_outlines(plan, band) {
        sheet.area(outline, Colour::of_palette(band.colour).with_alpha(0.25));
    }
}

fn reference_position(plan: &Plane, at: f64, line: Line) -> Option<f64> {
    let frame = plan.frame;
    let share = match line {
        Line::Vertical => plan.x.share(at)?,
        Line::Horizontal => plan.y.share(at)?,
    };
    (-1e-9..=1.0 + 1e-9).contains(&share).then(|| match line {
        Line::Vertical => frame.x + share * frame.width,
        Line::Horizontal => plan.level(share),
    })
}

fn draw_reference_lines(sheet: &mut Sheet, chart: &Chart, plan: &Plane) {
    let frame = plan.frame;
    for line in &chart.lines {
        let Some(at) = reference_position(plan, line.at, line.line) else { continue };
        let ends = match line.line {
            Line::Vertical => [[at, frame.y], [at, frame.bottom()]],
            Line::Horizontal => [[frame.x, at], [frame.right(), at]],
        };
        for dash in dashed(&ends, &[4.0, 3.0]) {
            sheet.line(dash, LINE_COLOUR, 1.0);
        }
    }
}

fn draw_labels(sheet: &mut Sheet, chart: &Chart, plan: &Plane, room: &mut Room) {
    let frame = plan.frame;
    for line in chart.lines.iter().filter(|line| !line.label.is_empty()) {
        let Some(at) = reference_position(plan, line.at, line.line) else { continue };
        let width = text_width(&line.label, LABEL_SIZE) + 6.0;
        let places = match line.line {
            Line::Vertical => beside_upright(at, &frame, width, LABEL_HEIGHT),
            Line::Horizontal => beside_level(at, &frame, width, LABEL_HEIGHT),
        };
        if let Some(place) = room.claim(&frame, places) {
            draw_label(sheet, &place, &line.label);
        }
    }
    let spots: Vec<_> = chart
        .markers
        .iter()
        .filter_map(|marker| Some((marker, plan.place((marker.x, marker.y))?)))
        .filter(|(_, at)| frame.contains(*at))
        .collect();
    room.taken.extend(spots.iter().map(|(_, [x, y])| Rect::new(x - 5.0, y - 5.0, 10.0, 10.0)));
    let mut labels = Vec::new();
    for (marker, at) in spots.iter().filter(|(marker, _)| !marker.label.is_empty()) {
        let width = text_width(&marker.label, LABEL_SIZE) + 6.0;
        if let Some(place) = room.claim(&frame, around(*at, width, LABEL_HEIGHT)) {
            draw_leader(sheet, *at, &place);
            labels.push((place, marker.label.as_str()));
        }
    }
    for (marker, at) in &spots {
        sheet.disc(*at, 5.0, Colour::WHITE);
        draw_symbol(sheet, *at, marker.colour, 4.0);
    }
    for (place, label) in labels {
        draw_label(sheet, &place, label);
    }
}

/// Draws a thin line from a point to its label when the label is not close by.
pub(super) fn draw_leader(sheet: &mut Sheet, at: [f64; 2], place: &Rect) {
    let near = [at[0].clamp(place.x, place.right()), at[1].clamp(place.y, place.bottom())];
    if (near[0] - at[0]).hypot(near[1] - at[1]) > 14.0 {
        sheet.line(vec![at, near], LINE_COLOUR, 0.75);
    }
}

/// Writes a label in its place, on a pale ground so that it can be read over a curve.
pub(super) fn draw_label(sheet: &mut Sheet, place: &Rect, text: &str) {
    sheet.fill(*place, Colour::WHITE.with_alpha(0.8));
    sheet.text_in([place.x + 3.0, place.y + 12.8], text, LABEL_SIZE, Anchor::Start, TEXT_COLOUR);
}

/// What curves, bands and symbols cover, as points.
fn ink(chart: &Chart, plan: &Plane) -> Vec<[f64; 2]> {
    let mut ink = Vec::new();
    for series in &chart.series {
        if has_line(series.style) {
            ink.extend(pieces(plan, series.points.iter().copied()).iter().flat_map(|piece| sampled(piece, 4.0)));
        }
        if has_points(series.style) {
            ink.extend(spots(plan, series));
        }
    }
    ink.extend(chart.bands.iter().flat_map(|b| band_outlines(plan, b)).flat_map(|outline| sampled(&outline, 8.0)));
    ink.extend(chart.markers.iter().filter_map(|m| plan.place((m.x, m.y))));
    for line in &chart.lines {
        let Some(at) = reference_position(plan, line.at, line.line) else { continue };
        let frame = plan.frame;
        ink.extend(match line.line {
            Line::Vertical => sampled(&[[at, frame.y], [at, frame.bottom()]], 12.0),
            Line::Horizontal => sampled(&[[frame.x, at], [frame.right(), at]], 12.0),
        });
    }
    ink
}
