//! A packing of discs, before and after it was compacted.

use super::axis::{Scale, Span};
use super::chart_layout::{
    BORDER, CAPTION_SIZE, FRAME_COLOUR, TICK_SIZE, TITLE_HEIGHT, TITLE_SIZE, draw_ticks, fitting_ticks,
};
use super::colour::Colour;
use super::error::PlotError;
use super::figure::Figure;
use super::sheet::{Anchor, Rect, Sheet};
use super::ticks::choose;

/// The discs of a packing in their box, to scale; with the state before compaction beside or above it.
#[derive(Debug, Clone, PartialEq)]
pub struct PackingFigure {
    /// Title; empty for none.
    pub title: String,
    /// Width of the box, m.
    pub width: f64,
    /// Height of the box, m.
    pub height: f64,
    /// Centre `x`, centre `y` (upwards from the floor) and radius of every disc, m.
    pub discs: Vec<[f64; 3]>,
    /// The discs before compaction, if they are to be shown too.
    pub before: Option<Vec<[f64; 3]>>,
}

/// Largest frame of one state, points.
const LARGEST: [f64; 2] = [820.0, 620.0];

const LEFT: f64 = 66.0;
const BELOW: f64 = 64.0;
const ABOVE: f64 = 30.0;
const WALL: f64 = 5.0;
const HATCH: f64 = 8.0;

const STONE: Colour = Colour::grey(178);
const STONE_RIM: Colour = Colour::grey(70);
const WALL_COLOUR: Colour = Colour::grey(40);

impl PackingFigure {
    /// Frames of the states on a sheet of the size returned: beside one another or stacked, whichever shows them larger.
    fn frames(&self, states: usize) -> (Vec<Rect>, [f64; 2]) {
        let top = if self.title.is_empty() { BORDER } else { BORDER + TITLE_HEIGHT };
        let side_by_side = states > 1 && self.height >= self.width;
        let largest = if side_by_side { [420.0, 640.0] } else { LARGEST };
        let scale = (largest[0] / self.width).min(largest[1] / self.height);
        let (width, height) = ((self.width * scale).max(60.0), (self.height * scale).max(60.0));
        let right = BORDER + WALL + 14.0;
        let pitch = [LEFT + width + right, ABOVE + height + BELOW];
        let frame = |number: usize| {
            let (column, row) = if side_by_side { (number as f64, 0.0) } else { (0.0, number as f64) };
            Rect::new(column * pitch[0] + LEFT, top + row * pitch[1] + ABOVE, width, height)
        };
        let frames: Vec<_> = (0..states).map(frame).collect();
        let (across, down) = if side_by_side { (states as f64, 1.0) } else { (1.0, states as f64) };
        (frames, [(across * pitch[0]).max(420.0), top + down * pitch[1]])
    }

    fn draw_state(&self, sheet: &mut Sheet, frame: &Rect, discs: &[[f64; 3]], caption: &str) {
        sheet.text([frame.x, frame.y - 10.0], caption, CAPTION_SIZE, Anchor::Start);
        let scale = [frame.width / self.width, frame.height / self.height];
        for &[x, y, radius] in discs {
            let centre = [frame.x + x * scale[0], frame.bottom() - y * scale[1]];
            let size = radius * scale[0].min(scale[1]);
            let reach = frame.shrunk(-40.0);
            if size > 0.0 && size < 2000.0 && reach.shrunk(-size).contains(centre) {
                let rim = (0.12 * size).clamp(0.25, 0.8);
                sheet.disc(centre, size, STONE_RIM);
                sheet.disc(centre, size - rim, STONE);
            }
        }
        let (left, right, floor) = (frame.x - WALL, frame.right() + WALL, frame.bottom());
        sheet.fill(Rect::new(left, frame.y, WALL, frame.height), WALL_COLOUR);
        sheet.fill(Rect::new(frame.right(), frame.y, WALL, frame.height), WALL_COLOUR);
        sheet.fill(Rect::new(left, floor, right - left, WALL), WALL_COLOUR);
        let mut x = left;
        while x + HATCH <= right {
            sheet.line(vec![[x, floor + WALL + HATCH], [x + HATCH, floor + WALL]], FRAME_COLOUR, 0.75);
            x += HATCH;
        }
        let span = |high: f64| Span { scale: Scale::Linear, low: 0.0, high };
        let x_ticks = fitting_ticks(&span(self.width), frame.width);
        let y_ticks = choose(&span(self.height), (frame.height / 60.0).clamp(2.0, 8.0) as usize);
        let outer = Rect::new(left, frame.y, right - left, frame.height);
        let below = Rect::new(frame.x, frame.y, frame.width, frame.height + WALL + HATCH);
        draw_ticks(sheet, &below, &x_ticks, &Default::default());
        draw_ticks(sheet, &outer, &Default::default(), &y_ticks);
        let unit = |factor: &str| if factor.is_empty() { "m".to_owned() } else { format!("×{factor} m") };
        let baseline = below.bottom() + 5.0 + TICK_SIZE + 1.0 + CAPTION_SIZE + 3.0;
        let middle = [frame.x + frame.width / 2.0, baseline];
        sheet.text(middle, &format!("width ({})", unit(&x_ticks.factor)), CAPTION_SIZE, Anchor::Middle);
        let aside = [frame.x - LEFT + BORDER + 6.0, frame.y + frame.height / 2.0];
        sheet.text_upwards(aside, &format!("height ({})", unit(&y_ticks.factor)), CAPTION_SIZE);
    }
}

impl Figure for PackingFigure {
    fn lay_out(&self) -> Result<Sheet, PlotError> {
        let sides = [self.width, self.height];
        if sides.iter().any(|side| !side.is_finite() || *side <= 0.0) {
            return Err(PlotError::Extent { title: self.title.clone(), width: self.width, height: self.height });
        }
        let states: Vec<(&str, &[[f64; 3]])> = match &self.before {
            Some(before) => vec![("(a) before compaction", before), ("(b) after compaction", &self.discs)],
            None => vec![("", &self.discs)],
        };
        let (frames, [width, height]) = self.frames(states.len());
        let mut sheet = Sheet::new(&self.title, width, height);
        sheet.title([width / 2.0, BORDER + TITLE_SIZE], &self.title, TITLE_SIZE, width - 2.0 * BORDER);
        for (frame, (name, discs)) in frames.iter().zip(states) {
            let stones = match discs.len() {
                1 => "1 stone".to_owned(),
                count => format!("{count} stones"),
            };
            let caption = if name.is_empty() { stones } else { format!("{name}, {stones}") };
            self.draw_state(&mut sheet, frame, discs, &caption);
        }
        Ok(sheet)
    }
}
