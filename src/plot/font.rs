//! Letters: the embedded font, how wide a text is, and how plotters draws it.
//!
//! plotters leaves out the bearing of each glyph and draws SVG text smaller than PNG text, hence an own text style.

use std::sync::LazyLock;

use ab_glyph::{Font, FontRef, PxScale, ScaleFont, point};
use plotters_backend::text_anchor::{HPos, Pos, VPos};
use plotters_backend::{BackendColor, BackendCoord, BackendTextStyle, FontFamily, FontStyle, FontTransform};

use super::error::PlotError;
use super::sheet::Anchor;

/// DejaVu Sans 2.37, Latin, Greek, mathematical signs and arrows only; the licence lies beside it.
static FONT_BYTES: &[u8] = include_bytes!("fonts/DejaVuSans-subset.ttf");

static FONT: LazyLock<Option<FontRef<'static>>> = LazyLock::new(|| FontRef::try_from_slice(FONT_BYTES).ok());

/// The families named in an SVG file, the embedded one first.
const FAMILIES: &str = "DejaVu Sans, Verdana, Arial, Helvetica, sans-serif";

/// plotters-svg divides the size of a text by this before it writes it.
const SVG_SIZE_DIVISOR: f64 = 1.24;

/// Fails when the embedded font cannot be read.
pub(super) fn check() -> Result<(), PlotError> {
    FONT.as_ref().map(|_| ()).ok_or(PlotError::Font)
}

/// Width of a text of `size` points per em, points.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    FONT.as_ref().map_or(0.0, |font| glyphs(font, text, size).1)
}

/// The text, or as much of its beginning as fits into a width, with an ellipsis.
pub(super) fn shortened(text: &str, size: f64, width: f64) -> String {
    if text_width(text, size) <= width {
        return text.to_owned();
    }
    let mut kept: Vec<char> = text.chars().take((width / (0.2 * size)).max(0.0) as usize).collect();
    while kept.pop().is_some() {
        let short: String = kept.iter().chain(['…'].iter()).collect();
        if text_width(&short, size) <= width {
            return short;
        }
    }
    String::new()
}

/// Height of a capital letter of DejaVu Sans, share of the em (1493 / 2048).
pub(super) const CAP_HEIGHT: f64 = 0.729;

/// Depth of a descender of DejaVu Sans, share of the em.
pub(super) const DESCENT: f64 = 0.236;

/// Glyphs of a line with the abscissa of each, and the advance of all.
fn glyphs(font: &FontRef<'static>, text: &str, size: f64) -> (Vec<(ab_glyph::GlyphId, f64)>, f64) {
    let scaled = font.as_scaled(scale(font, size));
    let mut advance = 0.0;
    let mut previous = None;
    let mut placed = Vec::with_capacity(text.len());
    for letter in text.chars() {
        let glyph = scaled.glyph_id(letter);
        if let Some(before) = previous {
            advance += f64::from(scaled.kern(before, glyph));
        }
        placed.push((glyph, advance));
        advance += f64::from(scaled.h_advance(glyph));
        previous = Some(glyph);
    }
    (placed, advance)
}

fn scale(font: &FontRef<'static>, size: f64) -> PxScale {
    font.pt_to_px_scale(size as f32 * 0.75).unwrap_or(PxScale::from(size as f32))
}

/// One text as plotters wants it; the point given to `draw_text` is on the baseline.
pub(super) struct Lettering {
    /// Pixels per em on the canvas.
    pub size: f64,
    /// Where the point lies along the text.
    pub anchor: Anchor,
    /// Whether the text reads upwards.
    pub upwards: bool,
    /// Colour of the letters.
    pub colour: BackendColor,
}

impl BackendTextStyle for Lettering {
    type FontError = PlotError;

    fn color(&self) -> BackendColor {
        self.colour
    }

    fn size(&self) -> f64 {
        self.size * SVG_SIZE_DIVISOR
    }

    fn transform(&self) -> FontTransform {
        if self.upwards { FontTransform::Rotate270 } else { FontTransform::None }
    }

    fn style(&self) -> FontStyle {
        FontStyle::Normal
    }

    fn anchor(&self) -> Pos {
        let along = match self.anchor {
            Anchor::Start => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::End => HPos::Right,
        };
        Pos::new(along, VPos::Bottom)
    }

    fn family(&self) -> FontFamily<'_> {
        FontFamily::Name(FAMILIES)
    }

    fn layout_box(&self, text: &str) -> Result<((i32, i32), (i32, i32)), PlotError> {
        check()?;
        Ok(((0, 0), (text_width(text, self.size).round() as i32, 0)))
    }

    fn draw<E, D: FnMut(i32, i32, BackendColor) -> Result<(), E>>(
        &self,
        text: &str,
        (x, y): BackendCoord,
        mut draw: D,
    ) -> Result<Result<(), E>, PlotError> {
        let font = FONT.as_ref().ok_or(PlotError::Font)?;
        let scale = scale(font, self.size);
        for (glyph, advance) in glyphs(font, text, self.size).0 {
            let positioned = glyph.with_scale_and_position(scale, point((f64::from(x) + advance) as f32, y as f32));
            let Some(outline) = font.outline_glyph(positioned) else { continue };
            let corner = outline.px_bounds().min;
            let mut failed = None;
            outline.draw(|dx, dy, coverage| {
                if failed.is_none() && coverage > 0.0 {
                    let alpha = self.colour.alpha * f64::from(coverage.min(1.0));
                    let at = (corner.x as i32 + dx as i32, corner.y as i32 + dy as i32);
                    failed = draw(at.0, at.1, BackendColor { alpha, rgb: self.colour.rgb }).err();
                }
            });
            if let Some(error) = failed {
                return Ok(Err(error));
            }
        }
        Ok(Ok(()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Advance widths of DejaVu Sans 2.37: `0` 1303, `.` 651 of 2048 units per em.
    #[test]
    fn a_text_is_as_wide_as_its_advances() {
        let expected = 100.0 * f64::from(1303 + 651 + 1303) / 2048.0;
        assert!((text_width("0.0", 100.0) - expected).abs() < 1e-3, "{} not {expected}", text_width("0.0", 100.0));
        assert_eq!(text_width("", 100.0), 0.0);
    }

    #[test]
    fn a_text_is_shortened_to_its_room() {
        assert_eq!(shortened("time", 13.0, 100.0), "time");
        let short = shortened(&"ballast ".repeat(500), 13.0, 100.0);
        assert!(short.starts_with("ballast") && short.ends_with('…') && text_width(&short, 13.0) <= 100.0, "{short}");
        assert_eq!(shortened("time", 13.0, 1.0), "");
    }

    #[test]
    fn the_font_holds_the_letters_that_figures_need() {
        let font = FONT.as_ref().unwrap();
        for letter in "AZaz09εΩσμµπλφρᵣ×·–—−±°²³⁻⁰¹⁹₀₉√∞≈≤≥→←↑↓'’“”éüß%√∑".chars()
        {
            assert_ne!(font.glyph_id(letter).0, 0, "no glyph for {letter}");
        }
        assert!(FONT_BYTES.len() < 150_000);
    }
}
