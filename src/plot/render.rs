//! From a sheet to the bytes of a PNG file and the text of an SVG file, through plotters.
//!
//! plotters knows whole pixels only. A PNG is drawn at four pixels per point and halved; an SVG is drawn at eight units
//! per point under a `viewBox`, so a curve moves in steps of an eighth of a point.

use std::fmt::Write as _;

use plotters::backend::{BitMapBackend, SVGBackend};
use plotters_backend::{BackendColor, BackendCoord, BackendStyle, DrawingBackend, DrawingErrorKind};

use super::colour::Colour;
use super::error::PlotError;
use super::font::{self, Lettering};
use super::image::{Image, base64};
use super::sheet::{Mark, Rect, Sheet};

/// Canvas pixels per point while a PNG is drawn; the file has half as many.
const PNG_SCALE: f64 = 4.0;

/// Canvas units per point in an SVG.
const SVG_SCALE: f64 = 8.0;

/// Smallest and largest side of a sheet, points.
const SIDES: [f64; 2] = [40.0, 4000.0];

/// A colour no figure uses: in the SVG it marks where a picture is to be put in.
const PICTURE_KEY: Colour = Colour::new(1, 2, 3);

struct Pen {
    colour: BackendColor,
    width: u32,
}

impl BackendStyle for Pen {
    fn color(&self) -> BackendColor {
        self.colour
    }

    fn stroke_width(&self) -> u32 {
        self.width
    }
}

fn backend_colour(colour: Colour) -> BackendColor {
    let [r, g, b] = colour.rgb;
    BackendColor { alpha: colour.alpha, rgb: (r, g, b) }
}

fn check(sheet: &Sheet) -> Result<(), PlotError> {
    font::check()?;
    let [smallest, largest] = SIDES;
    let fits = |side: f64| (smallest..=largest).contains(&side);
    if fits(sheet.width) && fits(sheet.height) {
        Ok(())
    } else {
        Err(PlotError::Size { width: sheet.width, height: sheet.height, smallest, largest })
    }
}

fn failed<E: std::error::Error + Send + Sync + 'static>(
    sheet: &Sheet,
) -> impl Fn(DrawingErrorKind<E>) -> PlotError + use<E> {
    let title = sheet.title.clone();
    move |source| PlotError::Drawing { title: title.clone(), source: Box::new(source) }
}

/// Draws a sheet as PNG, two pixels per point.
pub(super) fn png(sheet: &Sheet) -> Result<Vec<u8>, PlotError> {
    check(sheet)?;
    let [width, height] = [sheet.width, sheet.height].map(|side| 2 * (side * PNG_SCALE / 2.0).round() as usize);
    let mut image = Image { width, height, pixels: vec![255; 3 * width * height] };
    {
        let mut backend = BitMapBackend::with_buffer(&mut image.pixels, (width as u32, height as u32));
        for mark in &sheet.marks {
            draw_pixels(&mut backend, mark).map_err(failed(sheet))?;
        }
        backend.present().map_err(failed(sheet))?;
    }
    image.halved().png()
}

/// Draws a sheet as SVG.
pub(super) fn svg(sheet: &Sheet) -> Result<String, PlotError> {
    check(sheet)?;
    let canvas = [sheet.width, sheet.height].map(|side| (side * SVG_SCALE).round() as u32);
    let mut text = String::new();
    {
        let mut backend = SVGBackend::with_string(&mut text, (canvas[0], canvas[1]));
        backend
            .draw_rect((0, 0), (canvas[0] as i32, canvas[1] as i32), &backend_colour(Colour::WHITE), true)
            .map_err(failed(sheet))?;
        for mark in &sheet.marks {
            draw_vectors(&mut backend, mark).map_err(failed(sheet))?;
        }
        backend.present().map_err(failed(sheet))?;
    }
    finish_svg(sheet, canvas, &text)
}

fn coordinate([x, y]: [f64; 2], scale: f64) -> BackendCoord {
    ((x * scale).round() as i32, (y * scale).round() as i32)
}

/// Corners on the canvas, without repetitions.
fn corners(points: &[[f64; 2]], scale: f64) -> Vec<BackendCoord> {
    let mut path: Vec<_> = points.iter().map(|&point| coordinate(point, scale)).collect();
    path.dedup();
    path
}

fn lettering(size: f64, scale: f64, mark: &Mark) -> Option<Lettering> {
    let Mark::Text { anchor, upwards, colour, .. } = mark else { return None };
    Some(Lettering { size: size * scale, anchor: *anchor, upwards: *upwards, colour: backend_colour(*colour) })
}

fn draw_vectors<B: DrawingBackend>(backend: &mut B, mark: &Mark) -> Result<(), DrawingErrorKind<B::ErrorType>> {
    match mark {
        Mark::Line { points, colour, width } => {
            let pen = Pen { colour: backend_colour(*colour), width: (width * SVG_SCALE).round().max(1.0) as u32 };
            backend.draw_path(corners(points, SVG_SCALE), &pen)
        }
        Mark::Area { points, colour } => backend.fill_polygon(corners(points, SVG_SCALE), &backend_colour(*colour)),
        Mark::Disc { centre, radius, colour } => {
            let radius = (radius * SVG_SCALE).round().max(1.0) as u32;
            backend.draw_circle(coordinate(*centre, SVG_SCALE), radius, &backend_colour(*colour), true)
        }
        Mark::Text { at, text, size, .. } => match lettering(*size, SVG_SCALE, mark) {
            Some(style) => backend.draw_text(text, &style, coordinate(*at, SVG_SCALE)),
            None => Ok(()),
        },
        Mark::Picture { place, .. } => {
            let (from, to) = canvas_rect(place, SVG_SCALE);
            backend.draw_rect(from, to, &backend_colour(PICTURE_KEY), true)
        }
    }
}

fn canvas_rect(place: &Rect, scale: f64) -> (BackendCoord, BackendCoord) {
    (coordinate([place.x, place.y], scale), coordinate([place.right(), place.bottom()], scale))
}

fn draw_pixels<B: DrawingBackend>(backend: &mut B, mark: &Mark) -> Result<(), DrawingErrorKind<B::ErrorType>> {
    match mark {
        Mark::Line { points, colour, width } => {
            let path: Vec<_> = points.iter().map(|p| p.map(|c| c * PNG_SCALE)).collect();
            draw_stroke(backend, &path, width * PNG_SCALE, backend_colour(*colour))
        }
        Mark::Area { points, colour } => {
            let polygon: Vec<_> = points.iter().map(|p| p.map(|c| c * PNG_SCALE)).collect();
            fill(backend, &polygon, backend_colour(*colour))
        }
        Mark::Disc { centre, radius, colour } => {
            draw_disc(backend, centre.map(|c| c * PNG_SCALE), radius * PNG_SCALE, backend_colour(*colour))
        }
        Mark::Text { at, text, size, .. } => match lettering(*size, PNG_SCALE, mark) {
            Some(style) => backend.draw_text(text, &style, coordinate(*at, PNG_SCALE)),
            None => Ok(()),
        },
        Mark::Picture { place, image } => {
            let (from, to) = canvas_rect(place, PNG_SCALE);
            let size = ((to.0 - from.0).max(1) as u32, (to.1 - from.1).max(1) as u32);
            backend.blit_bitmap(from, size, &image.stretched(size.0 as usize, size.1 as usize).pixels)
        }
    }
}

/// Draws a wide line as one quadrilateral per segment with a disc on every joint: the mitres of plotters' own wide
/// lines stick out at the sharp turns of a trace.
fn draw_stroke<B: DrawingBackend>(
    backend: &mut B,
    path: &[[f64; 2]],
    width: f64,
    colour: BackendColor,
) -> Result<(), DrawingErrorKind<B::ErrorType>> {
    let half = (width / 2.0).max(0.5);
    let last = path.len().saturating_sub(2);
    for (index, pair) in path.windows(2).enumerate() {
        let [[x0, y0], [x1, y1]] = [pair[0], pair[1]];
        let length = (x1 - x0).hypot(y1 - y0);
        if length > 0.0 {
            let (nx, ny) = (-(y1 - y0) / length * half, (x1 - x0) / length * half);
            let quad = [[x0 + nx, y0 + ny], [x1 + nx, y1 + ny], [x1 - nx, y1 - ny], [x0 - nx, y0 - ny]];
            fill(backend, &quad, colour)?;
        }
        if index < last && half > 1.0 {
            draw_disc(backend, [x1, y1], half, colour)?;
        }
    }
    Ok(())
}

fn draw_disc<B: DrawingBackend>(
    backend: &mut B,
    [x, y]: [f64; 2],
    radius: f64,
    colour: BackendColor,
) -> Result<(), DrawingErrorKind<B::ErrorType>> {
    for row in (y - radius).floor() as i32..=(y + radius).ceil() as i32 {
        let half = (radius * radius - (f64::from(row) + 0.5 - y).powi(2)).max(0.0).sqrt();
        span(backend, row, x - half, x + half, colour)?;
    }
    Ok(())
}

/// Fills a polygon, whose corners need not be whole pixels, by the even-odd rule: the pixels whose centres lie in it.
fn fill<B: DrawingBackend>(
    backend: &mut B,
    polygon: &[[f64; 2]],
    colour: BackendColor,
) -> Result<(), DrawingErrorKind<B::ErrorType>> {
    let low = polygon.iter().map(|p| p[1]).fold(f64::INFINITY, f64::min).floor() as i32;
    let high = polygon.iter().map(|p| p[1]).fold(f64::NEG_INFINITY, f64::max).ceil() as i32;
    let mut crossings = Vec::new();
    for row in low..=high {
        let level = f64::from(row) + 0.5;
        crossings.clear();
        for (index, &[x0, y0]) in polygon.iter().enumerate() {
            let [x1, y1] = polygon[(index + 1) % polygon.len()];
            if (y0 <= level) != (y1 <= level) {
                crossings.push(x0 + (x1 - x0) * (level - y0) / (y1 - y0));
            }
        }
        crossings.sort_by(f64::total_cmp);
        for pair in crossings.chunks_exact(2) {
            span(backend, row, pair[0], pair[1], colour)?;
        }
    }
    Ok(())
}

/// Fills the pixels of a row whose centres lie between two abscissae.
fn span<B: DrawingBackend>(
    backend: &mut B,
    row: i32,
    left: f64,
    right: f64,
    colour: BackendColor,
) -> Result<(), DrawingErrorKind<B::ErrorType>> {
    let (from, to) = ((left - 0.5).ceil() as i32, (right - 0.5).ceil() as i32 - 1);
    if from <= to { backend.draw_line((from, row), (to, row), &colour) } else { Ok(()) }
}

/// Mends what plotters cannot write: the size in points, the title, baselines, round joints and pictures.
fn finish_svg(sheet: &Sheet, canvas: [u32; 2], drawn: &str) -> Result<String, PlotError> {
    let mut text = String::with_capacity(drawn.len() + 1024);
    let _ = write!(
        text,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" \
         viewBox=\"0 0 {} {}\" stroke-linejoin=\"round\">\n<title>{}</title>\n",
        sheet.width,
        sheet.height,
        canvas[0],
        canvas[1],
        sheet.title.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
    );
    let key = format!("fill=\"#{:02X}{:02X}{:02X}\"", PICTURE_KEY.rgb[0], PICTURE_KEY.rgb[1], PICTURE_KEY.rgb[2]);
    let mut pictures = sheet.marks.iter().filter_map(|mark| match mark {
        Mark::Picture { place, image } => Some((place, image)),
        _ => None,
    });
    for line in drawn.lines().skip(1) {
        if line.starts_with("<rect") && line.contains(&key) {
            if let Some((place, image)) = pictures.next() {
                let ((x, y), (right, bottom)) = canvas_rect(place, SVG_SCALE);
                let _ = writeln!(
                    text,
                    "<image x=\"{x}\" y=\"{y}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" \
                     image-rendering=\"optimizeSpeed\" style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{}\"/>",
                    right - x,
                    bottom - y,
                    base64(&image.enlarged().png()?)
                );
            }
        } else if line.starts_with("<text") {
            text.push_str(&line.replacen(" dy=\"-0.5ex\"", "", 1));
            text.push('\n');
        } else {
            text.push_str(line);
            text.push('\n');
        }
    }
    Ok(text)
}
