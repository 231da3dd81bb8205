//! A bed of spheres from three sides.

use super::axis::{Scale, Span};
use super::chart_layout::{BORDER, CAPTION_SIZE, FRAME_COLOUR, TICK_SIZE, TITLE_HEIGHT, TITLE_SIZE, draw_ticks};
use super::colour::viridis;
use super::error::PlotError;
use super::figure::Figure;
use super::image::Image;
use super::sheet::{Anchor, Rect, Sheet};
use super::ticks::choose;

/// Spheres in their box as seen from the front, from the side and from above, along parallel rays, coloured by a figure
/// each of them has.
#[derive(Debug, Clone, PartialEq)]
pub struct SpheresFigure {
    /// Title; empty for none.
    pub title: String,
    /// Length, width and height of the box, m.
    pub size: [f64; 3],
    /// Centre (x, y, and z upwards) and radius of every sphere, m.
    pub spheres: Vec<[f64; 4]>,
    /// The figure that colours each sphere.
    pub values: Vec<f64>,
    /// What that figure is, with its unit: `diameter (mm)`.
    pub caption: String,
}

/// A view: which axes run right and up, and which towards the viewer, with the sign of that direction.
struct View {
    name: &'static str,
    right: usize,
    up: usize,
    near: usize,
    sign: f64,
}

const VIEWS: [View; 3] = [
    View { name: "front", right: 0, up: 2, near: 1, sign: -1.0 },
    View { name: "right side", right: 1, up: 2, near: 0, sign: 1.0 },
    View { name: "from above", right: 0, up: 1, near: 2, sign: 1.0 },
];

/// Longest side of the box on the sheet, points.
const LONGEST: f64 = 420.0;
const LEFT: f64 = 58.0;
const BELOW: f64 = 50.0;
const ABOVE: f64 = 26.0;
const BAR: f64 = 14.0;
/// Pixels per point of the picture, before every four become one.
const PIXELS: f64 = 4.0;
/// Direction of the light: from the left, above and before the viewer. Its length is one: 0.36² + 0.48² + 0.8².
const LIGHT: [f64; 3] = [-0.36, 0.48, 0.8];
/// Light that reaches every surface.
const AMBIENT: f64 = 0.35;

impl SpheresFigure {
    fn span(&self) -> [f64; 2] {
        let finite = || self.values.iter().copied().filter(|value| value.is_finite());
        let (low, high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
        match () {
            () if low > high => [0.0, 1.0],
            () if high - low < 1e-9 * high.abs() => [low - 0.5, low + 0.5],
            () => [low, high],
        }
    }

    /// What is seen along a direction: for every pixel the nearest sphere, lit, and darker the deeper it lies.
    fn picture(&self, view: &View, width: usize, height: usize) -> Image {
        let [low, high] = self.span();
        let scale = width as f64 / self.size[view.right];
        let mut depth = vec![f64::NEG_INFINITY; width * height];
        let mut pixels = vec![255_u8; 3 * width * height];
        let far = self.size[view.near];
        for (sphere, value) in self.spheres.iter().zip(&self.values) {
            let radius = sphere[3] * scale;
            let (x, y) = (sphere[view.right] * scale, height as f64 - sphere[view.up] * scale);
            let near = view.sign * sphere[view.near];
            let colour = viridis((value - low) / (high - low)).rgb.map(f64::from);
            let clamp = |at: f64, most: usize| (at.max(0.0) as usize).min(most);
            for row in clamp(y - radius, height)..clamp(y + radius + 1.0, height) {
                for column in clamp(x - radius, width)..clamp(x + radius + 1.0, width) {
                    let (u, v) = ((column as f64 + 0.5 - x) / radius, (y - row as f64 - 0.5) / radius);
                    let towards = 1.0 - u * u - v * v;
                    if towards < 0.0 {
                        continue;
                    }
                    let normal = [u, v, towards.sqrt()];
                    let here = near + normal[2] * sphere[3];
                    let at = row * width + column;
                    if here <= depth[at] {
                        continue;
                    }
                    depth[at] = here;
                    let lit: f64 = normal.iter().zip(LIGHT).map(|(n, l)| n * l).sum();
                    let behind = if view.sign > 0.0 { far - here } else { -here };
                    let shade =
                        (AMBIENT + (1.0 - AMBIENT) * lit.max(0.0)) * (1.0 - 0.55 * (behind / far).clamp(0.0, 1.0));
                    for c in 0..3 {
                        pixels[3 * at + c] = (colour[c] * shade).round().clamp(0.0, 255.0) as u8;
                    }
                }
            }
        }
        Image { width, height, pixels }.halved()
    }

    fn draw_view(&self, sheet: &mut Sheet, frame: &Rect, view: &View) {
        sheet.text([frame.x, frame.y - 8.0], view.name, CAPTION_SIZE, Anchor::Start);
        let pixels = |points: f64| ((points * PIXELS).round() as usize).max(2) / 2 * 2;
        sheet.picture(*frame, self.picture(view, pixels(frame.width), pixels(frame.height)));
        sheet.frame(*frame, FRAME_COLOUR, 1.0);
        let span = |axis: usize| Span { scale: Scale::Linear, low: 0.0, high: self.size[axis] };
        let x_ticks = choose(&span(view.right), (frame.width / 70.0).clamp(2.0, 8.0) as usize);
        let y_ticks = choose(&span(view.up), (frame.height / 60.0).clamp(2.0, 8.0) as usize);
        draw_ticks(sheet, frame, &x_ticks, &y_ticks);
        let label = |axis: usize, factor: &str| {
            let unit = if factor.is_empty() { "m".to_owned() } else { format!("×{factor} m") };
            format!("{} ({unit})", ["x", "y", "z"][axis])
        };
        let baseline = frame.bottom() + 5.0 + TICK_SIZE + 4.0 + CAPTION_SIZE;
        let middle = [frame.x + frame.width / 2.0, baseline];
        sheet.text(middle, &label(view.right, &x_ticks.factor), CAPTION_SIZE, Anchor::Middle);
        let aside = [frame.x - LEFT + CAPTION_SIZE + 2.0, frame.y + frame.height / 2.0];
        sheet.text_upwards(aside, &label(view.up, &y_ticks.factor), CAPTION_SIZE);
    }

    fn draw_bar(&self, sheet: &mut Sheet, bar: &Rect) {
        let [low, high] = self.span();
        let rows = 256;
        let pixels = (0..rows).flat_map(|row| viridis(1.0 - row as f64 / (rows - 1) as f64).rgb).collect();
        sheet.picture(*bar, Image { width: 1, height: rows, pixels });
        sheet.frame(*bar, FRAME_COLOUR, 1.0);
        let ticks = choose(&Span { scale: Scale::Linear, low, high }, (bar.height / 40.0).clamp(2.0, 8.0) as usize);
        for (share, label) in &ticks.major {
            let at = bar.bottom() - share * bar.height;
            sheet.line(vec![[bar.right(), at], [bar.right() + 4.0, at]], FRAME_COLOUR, 1.0);
            sheet.text([bar.right() + 8.0, at + 0.36 * TICK_SIZE], label, TICK_SIZE, Anchor::Start);
        }
        let factor = if ticks.factor.is_empty() { String::new() } else { format!(" ×{}", ticks.factor) };
        let caption = format!("{}{factor}", self.caption);
        sheet.text([bar.x, bar.y - 8.0], &caption, CAPTION_SIZE, Anchor::Start);
    }
}

impl Figure for SpheresFigure {
    fn lay_out(&self) -> Result<Sheet, PlotError> {
        let [length, width, height] = self.size;
        if self.size.iter().any(|side| !side.is_finite() || *side <= 0.0) {
            return Err(PlotError::Extent { title: self.title.clone(), width: length.min(width), height });
        }
        if self.values.len() != self.spheres.len() {
            return Err(PlotError::SphereValues {
                title: self.title.clone(),
                spheres: self.spheres.len(),
                values: self.values.len(),
            });
        }
        let scale = LONGEST / length.max(width).max(height);
        let side = |metres: f64| (metres * scale).max(40.0);
        let top = if self.title.is_empty() { BORDER } else { BORDER + TITLE_HEIGHT };
        // Front and side stand beside one another, the view from above lies below the front, the colours beside it.
        let front = Rect::new(LEFT + BORDER, top + ABOVE, side(length), side(height));
        let aside = Rect::new(front.right() + LEFT + 16.0, front.y, side(width), front.height);
        let above = Rect::new(front.x, front.bottom() + BELOW + ABOVE, front.width, side(width));
        let bar = Rect::new(aside.x, above.y, BAR, above.height.max(100.0));
        let whole = [(aside.right() + 14.0).max(bar.x + 180.0) + BORDER, above.bottom().max(bar.bottom()) + BELOW];
        let mut sheet = Sheet::new(&self.title, whole[0], whole[1]);
        sheet.title([whole[0] / 2.0, BORDER + TITLE_SIZE], &self.title, TITLE_SIZE, whole[0] - 2.0 * BORDER);
        for (frame, view) in [front, aside, above].iter().zip(&VIEWS) {
            self.draw_view(&mut sheet, frame, view);
        }
        self.draw_bar(&mut sheet, &bar);
        Ok(sheet)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure() -> SpheresFigure {
        SpheresFigure {
            title: "two".into(),
            size: [0.4, 0.2, 0.2],
            spheres: vec![[0.1, 0.05, 0.1, 0.05], [0.1, 0.15, 0.1, 0.05]],
            values: vec![0.0, 1.0],
            caption: "number".into(),
        }
    }

    /// From the front the sphere with the smaller y hides the other; a view from the side shows both, each on its side; what
    /// no sphere covers stays white.
    #[test]
    fn the_nearer_sphere_hides_the_other() {
        let figure = figure();
        let pixel = |image: &Image, x: f64, y: f64| {
            let at = 3 * ((y * image.height as f64) as usize * image.width + (x * image.width as f64) as usize);
            [image.pixels[at], image.pixels[at + 1], image.pixels[at + 2]]
        };
        let front = figure.picture(&VIEWS[0], 400, 200);
        let [red, green, blue] = pixel(&front, 0.25, 0.5);
        assert!(blue > green && green < red + 20, "the dark violet of the first sphere: {red} {green} {blue}");
        assert_eq!(pixel(&front, 0.75, 0.5), [255; 3]);
        let side = figure.picture(&VIEWS[1], 200, 200);
        let ([_, left, _], [_, right, _]) = (pixel(&side, 0.25, 0.5), pixel(&side, 0.75, 0.5));
        assert!(left < 60 && right > 100, "{left} {right}");
    }

    #[test]
    fn a_sheet_has_three_views_and_refuses_what_does_not_fit() {
        let sheet = figure().lay_out().unwrap();
        let names: Vec<_> = sheet.text_boxes().into_iter().map(|(_, text)| text.to_string()).collect();
        assert!(["front", "right side", "from above", "number"].iter().all(|name| names.iter().any(|n| n == name)));
        let short = SpheresFigure { values: vec![1.0], ..figure() };
        assert_eq!(
            short.lay_out().unwrap_err().to_string(),
            "the figure `two` has 2 spheres, but 1 values to colour them; they must be as many"
        );
        assert!(SpheresFigure { size: [0.0, 1.0, 1.0], ..figure() }.lay_out().is_err());
    }
}
