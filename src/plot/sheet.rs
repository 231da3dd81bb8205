//! The sheet: a list of marks in points, laid out once and drawn by both backends.

use super::colour::Colour;
use super::font::{CAP_HEIGHT, DESCENT, shortened, text_width};
use super::image::Image;

/// Where the given point lies along a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// At its start.
    Start,
    /// In its middle.
    Middle,
    /// At its end.
    End,
}

/// An upright rectangle on the sheet, points, y downwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rect {
    /// Left edge.
    pub x: f64,
    /// Top edge.
    pub y: f64,
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
}

impl Rect {
    /// Makes a rectangle from its top left corner and its size.
    pub const fn new(x: f64, y: f64, width: f64, height: f64) -> Self {
        Self { x, y, width, height }
    }

    /// Right edge.
    pub const fn right(&self) -> f64 {
        self.x + self.width
    }

    /// Bottom edge.
    pub const fn bottom(&self) -> f64 {
        self.y + self.height
    }

    /// Whether a point lies in it.
    pub fn contains(&self, [x, y]: [f64; 2]) -> bool {
        x >= self.x && x <= self.right() && y >= self.y && y <= self.bottom()
    }

    /// Whether another rectangle lies in it wholly.
    pub fn encloses(&self, other: &Self) -> bool {
        self.contains([other.x, other.y]) && self.contains([other.right(), other.bottom()])
    }

    /// Whether the two share an area.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.x < other.right() && other.x < self.right() && self.y < other.bottom() && other.y < self.bottom()
    }

    /// The rectangle with every edge moved inwards.
    pub fn shrunk(&self, by: f64) -> Self {
        let (dx, dy) = (by.min(self.width / 2.0), by.min(self.height / 2.0));
        Self::new(self.x + dx, self.y + dy, self.width - 2.0 * dx, self.height - 2.0 * dy)
    }

    /// Its four corners, clockwise from the top left.
    pub const fn corners(&self) -> [[f64; 2]; 4] {
        [[self.x, self.y], [self.right(), self.y], [self.right(), self.bottom()], [self.x, self.bottom()]]
    }
}

/// One thing to draw. Points, y downwards.
#[derive(Debug, Clone, PartialEq)]
pub enum Mark {
    /// A line through points.
    Line {
        /// Its corners.
        points: Vec<[f64; 2]>,
        /// Its colour.
        colour: Colour,
        /// Its width.
        width: f64,
    },
    /// A filled polygon.
    Area {
        /// Its corners.
        points: Vec<[f64; 2]>,
        /// Its colour.
        colour: Colour,
    },
    /// A filled disc.
    Disc {
        /// Its centre.
        centre: [f64; 2],
        /// Its radius.
        radius: f64,
        /// Its colour.
        colour: Colour,
    },
    /// A line of text.
    Text {
        /// Where it stands, on the baseline.
        at: [f64; 2],
        /// What it says.
        text: String,
        /// Points per em.
        size: f64,
        /// Where `at` lies along it.
        anchor: Anchor,
        /// Whether it reads upwards.
        upwards: bool,
        /// Colour of the letters.
        colour: Colour,
    },
    /// A picture of pixels, stretched over a rectangle.
    Picture {
        /// Where.
        place: Rect,
        /// What.
        image: Image,
    },
}

/// A figure laid out: its size in points and its marks, the lowest first.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// Title, for programs that read the file aloud and for error messages.
    pub title: String,
    /// Width, points.
    pub width: f64,
    /// Height, points.
    pub height: f64,
    /// What to draw, in this order.
    pub marks: Vec<Mark>,
}

impl Sheet {
    /// Makes an empty sheet.
    pub fn new(title: &str, width: f64, height: f64) -> Self {
        Self { title: printable(title), width, height, marks: Vec::new() }
    }

    /// Draws a line through points; fewer than two are nothing.
    pub fn line(&mut self, points: Vec<[f64; 2]>, colour: Colour, width: f64) {
        if points.len() > 1 {
            self.marks.push(Mark::Line { points, colour, width });
        }
    }

    /// Fills a polygon.
    pub fn area(&mut self, points: Vec<[f64; 2]>, colour: Colour) {
        if points.len() > 2 {
            self.marks.push(Mark::Area { points, colour });
        }
    }

    /// Fills a rectangle.
    pub fn fill(&mut self, rect: Rect, colour: Colour) {
        self.area(rect.corners().to_vec(), colour);
    }

    /// Draws the outline of a rectangle.
    pub fn frame(&mut self, rect: Rect, colour: Colour, width: f64) {
        let [a, b, c, d] = rect.corners();
        self.line(vec![a, b, c, d, a, b], colour, width);
    }

    /// Fills a disc.
    pub fn disc(&mut self, centre: [f64; 2], radius: f64, colour: Colour) {
        self.marks.push(Mark::Disc { centre, radius, colour });
    }

    /// Writes a line of text on a baseline.
    pub fn text(&mut self, at: [f64; 2], text: &str, size: f64, anchor: Anchor) {
        self.text_in(at, text, size, anchor, Colour::grey(20));
    }

    /// Writes a title centred on a baseline, in smaller letters or cut short when it is wider than its room.
    pub(super) fn title(&mut self, at: [f64; 2], text: &str, size: f64, width: f64) {
        let size = (size * width / text_width(text, size).max(1.0)).clamp(0.75 * size, size);
        self.text(at, &shortened(text, size, width), size, Anchor::Middle);
    }

    /// Writes a line of text on a baseline, in a colour.
    pub fn text_in(&mut self, at: [f64; 2], text: &str, size: f64, anchor: Anchor, colour: Colour) {
        let text = printable(text);
        if !text.is_empty() {
            self.marks.push(Mark::Text { at, text, size, anchor, upwards: false, colour });
        }
    }

    /// Writes a line of text that reads upwards; `at` is the middle of its baseline.
    pub fn text_upwards(&mut self, at: [f64; 2], text: &str, size: f64) {
        let text = printable(text);
        if !text.is_empty() {
            let (anchor, colour) = (Anchor::Middle, Colour::grey(20));
            self.marks.push(Mark::Text { at, text, size, anchor, upwards: true, colour });
        }
    }

    /// Draws a picture over a rectangle.
    pub fn picture(&mut self, place: Rect, image: Image) {
        self.marks.push(Mark::Picture { place, image });
    }

    /// The rectangles that the texts of this sheet fill, with the texts.
    pub fn text_boxes(&self) -> Vec<(Rect, &str)> {
        self.marks
            .iter()
            .filter_map(|mark| match mark {
                Mark::Text { at, text, size, anchor, upwards, .. } => {
                    Some((text_box(*at, text, *size, *anchor, *upwards), text.as_str()))
                }
                _ => None,
            })
            .collect()
    }
}

/// The rectangle that a text fills, from its capitals to its descenders.
pub(super) fn text_box([x, y]: [f64; 2], text: &str, size: f64, anchor: Anchor, upwards: bool) -> Rect {
    let width = text_width(text, size);
    let before = match anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => width / 2.0,
        Anchor::End => width,
    };
    let (up, down) = (CAP_HEIGHT * size, DESCENT * size);
    if upwards {
        Rect::new(x - up, y - width + before, up + down, width)
    } else {
        Rect::new(x - before, y - up, width, up + down)
    }
}

/// The text with control characters, which XML forbids, turned into spaces.
fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') { ' ' } else { c }).collect()
}
