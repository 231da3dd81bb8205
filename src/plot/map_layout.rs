//! Lays a permittivity map out: pixels, axes, colour bar, key, symbols and scale bar.

use super::axis::{Axis, Scale, Span};
use super::chart_layout::{
    BORDER, CAPTION_SIZE, FRAME_COLOUR, LABEL_HEIGHT, LABEL_SIZE, TICK_SIZE, TITLE_HEIGHT, TITLE_SIZE, draw_label,
    draw_leader, draw_ticks, fitting_ticks,
};
use super::colour::{Colour, viridis};
use super::font::{shortened, text_width};
use super::image::Image;
use super::map::{MapFigure, SymbolKind};
use super::path::dashed;
use super::place::{Room, around};
use super::sheet::{Anchor, Rect, Sheet};
use super::ticks::choose;

/// Largest and smallest side of the map itself, points.
const LARGEST: [f64; 2] = [760.0, 640.0];
const SMALLEST: f64 = 60.0;

/// Most pixels of the picture along either side; finer grids are averaged.
const MOST_PIXELS: usize = 1600;

const BAR_WIDTH: f64 = 16.0;
const LEFT: f64 = 70.0;

/// Room for the name of a layer, points.
const LONGEST_NAME: f64 = 260.0;

const CONDUCTOR: Colour = Colour::BLACK;
const UNKNOWN: Colour = Colour::grey(205);
const SOURCE: Colour = Colour::new(213, 94, 0);
const RECEIVER: Colour = Colour::new(0, 114, 178);
const OUTLINE: Colour = Colour::grey(60);

/// Largest permittivity taken for air, which gprMax calls 1 exactly.
const AIR: f32 = 1.000_001;

/// Which kinds of cells a map holds, and the span of its colour bar.
struct Key {
    span: Span,
    has_air: bool,
    has_conductor: bool,
    has_unknown: bool,
    has_colour: bool,
}

impl Key {
    fn of(map: &MapFigure) -> Self {
        let (mut has_air, mut has_conductor, mut has_unknown, mut has_colour) = (false, false, false, false);
        let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
        for &value in &map.values {
            if value.is_nan() {
                has_unknown = true;
            } else if value.is_infinite() {
                has_conductor = true;
            } else if map.air_is_white && value <= AIR {
                has_air = true;
            } else {
                has_colour = true;
                low = low.min(value);
                high = high.max(value);
            }
        }
        let mut axis = Axis::linear("", "");
        axis.range = map.range;
        let span = Span::of(&axis, [low, high].into_iter().filter(|v| v.is_finite()).map(f64::from), 0.0);
        Self { span, has_air, has_conductor, has_unknown, has_colour }
    }

    fn rows(&self) -> Vec<(Colour, &'static str)> {
        let rows = [
            (self.has_air, Colour::WHITE, "air"),
            (self.has_conductor, CONDUCTOR, "conductor"),
            (self.has_unknown, UNKNOWN, "no value"),
        ];
        rows.into_iter().filter(|row| row.0).map(|row| (row.1, row.2)).collect()
    }
}

pub(super) fn lay_out_map(map: &MapFigure) -> Sheet {
    let key = Key::of(map);
    let [width, height] = map.extent;
    let scale = (LARGEST[0] / width).min(LARGEST[1] / height);
    let top = if map.title.is_empty() { BORDER + 6.0 } else { BORDER + TITLE_HEIGHT };
    let (drawn_width, drawn_height) = ((width * scale).max(SMALLEST), (height * scale).max(SMALLEST));
    let names =
        map.layers.iter().map(|layer| text_width(&layer.label, LABEL_SIZE)).fold(0.0, f64::max).min(LONGEST_NAME);
    let names = if names > 0.0 { names + 22.0 } else { 0.0 };
    let key_height = key.rows().len() as f64 * 22.0;
    let bar_height = (drawn_height - key_height).max(110.0);
    let column = drawn_height.max(bar_height + key_height);
    let frame = Rect::new(LEFT, top, drawn_width, drawn_height);
    let bar = Rect::new(frame.right() + 16.0 + names, top, BAR_WIDTH, bar_height);
    let below = 5.0 + TICK_SIZE + 5.0 + CAPTION_SIZE + 8.0 + BORDER;
    let mut sheet = Sheet::new(&map.title, (bar.right() + 96.0).max(360.0), top + column + below);
    let middle = frame.x + frame.width / 2.0;
    let half = text_width(&map.title, TITLE_SIZE) / 2.0 + BORDER;
    let middle = if 2.0 * half < sheet.width { middle.clamp(half, sheet.width - half) } else { sheet.width / 2.0 };
    sheet.title([middle, BORDER + TITLE_SIZE], &map.title, TITLE_SIZE, sheet.width - 2.0 * BORDER);
    sheet.picture(frame, picture(map, &key.span));
    draw_axes(&mut sheet, map, &frame);
    draw_absorbing(&mut sheet, map, &frame);
    draw_layers(&mut sheet, map, &frame);
    draw_bar(&mut sheet, &key, &bar);
    let mut room = Room::default();
    draw_scale_bar(&mut sheet, map, &frame, &mut room);
    draw_symbols(&mut sheet, map, &frame, &mut room);
    sheet
}

/// The colour at a share of the colour bar: viridis turned round, so that permittivity darkens from air (white) to a
/// perfect conductor (black) in grey print too.
fn shade(share: f64) -> Colour {
    viridis(1.0 - share)
}

/// Colours of the cells; where several cells share a pixel, the mean of their colours.
fn picture(map: &MapFigure, span: &Span) -> Image {
    let table: Vec<[u8; 3]> = (0..256).map(|i| shade(f64::from(i) / 255.0).rgb).collect();
    let (low, factor) = (span.low as f32, (255.0 / (span.high - span.low)) as f32);
    let colour = |value: f32| {
        if value.is_nan() {
            UNKNOWN.rgb
        } else if value.is_infinite() {
            CONDUCTOR.rgb
        } else if map.air_is_white && value <= AIR {
            Colour::WHITE.rgb
        } else {
            table[((value - low) * factor).round().clamp(0.0, 255.0) as usize]
        }
    };
    let (width, height) = (map.nx.min(MOST_PIXELS), map.ny.min(MOST_PIXELS));
    let mut pixels = vec![0; 3 * width * height];
    let share = |k: usize, cells: usize, pixels: usize| k * cells / pixels..((k + 1) * cells / pixels);
    for column in 0..width {
        for level in 0..height {
            let (mut sum, mut count) = ([0_u32; 3], 0);
            for i in share(column, map.nx, width) {
                for &value in &map.values[i * map.ny..][share(level, map.ny, height)] {
                    let rgb = colour(value);
                    for c in 0..3 {
                        sum[c] += u32::from(rgb[c]);
                    }
                    count += 1;
                }
            }
            let at = 3 * ((height - 1 - level) * width + column);
            for c in 0..3 {
                pixels[at + c] = ((sum[c] + count / 2) / count.max(1)) as u8;
            }
        }
    }
    Image { width, height, pixels }
}

fn draw_axes(sheet: &mut Sheet, map: &MapFigure, frame: &Rect) {
    let span = |high: f64| Span { scale: Scale::Linear, low: 0.0, high };
    let x_ticks = fitting_ticks(&span(map.extent[0]), frame.width);
    let y_ticks = choose(&span(map.extent[1]), (frame.height / 60.0).clamp(2.0, 8.0) as usize);
    draw_ticks(sheet, frame, &x_ticks, &y_ticks);
    sheet.frame(*frame, FRAME_COLOUR, 1.0);
    let baseline = frame.bottom() + 5.0 + TICK_SIZE + 5.0 + CAPTION_SIZE + 3.0;
    let caption = Axis::linear("x", "m").caption(&x_ticks.factor);
    sheet.text([frame.x + frame.width / 2.0, baseline], &caption, CAPTION_SIZE, Anchor::Middle);
    let caption = Axis::linear("y", "m").caption(&y_ticks.factor);
    sheet.text_upwards([BORDER + CAPTION_SIZE, frame.y + frame.height / 2.0], &caption, CAPTION_SIZE);
}

fn on_sheet(map: &MapFigure, frame: &Rect, x: f64, y: f64) -> [f64; 2] {
    [frame.x + x / map.extent[0] * frame.width, frame.bottom() - y / map.extent[1] * frame.height]
}

fn draw_absorbing(sheet: &mut Sheet, map: &MapFigure, frame: &Rect) {
    let Some([left, bottom, right, top]) = map.absorbing else { return };
    let [x0, y0] = on_sheet(map, frame, left, map.extent[1] - top);
    let [x1, y1] = on_sheet(map, frame, map.extent[0] - right, bottom);
    if !(x0 < x1 && y0 < y1 && frame.encloses(&Rect::new(x0, y0, x1 - x0, y1 - y0))) {
        return;
    }
    let corners = [[x0, y0], [x0, y1], [x1, y1], [x1, y0]];
    for (side, _) in [left, bottom, right, top].into_iter().enumerate().filter(|(_, depth)| *depth > 0.0) {
        let ends = [corners[side], corners[(side + 1) % 4]];
        sheet.line(ends.to_vec(), Colour::WHITE, 2.2);
        for dash in dashed(&ends, &[6.0, 4.0]) {
            sheet.line(dash, OUTLINE, 1.2);
        }
    }
    let place = Rect::new(x0 + 4.0, y0 + 4.0, text_width("absorbing layer outside", LABEL_SIZE) + 6.0, LABEL_HEIGHT);
    if Rect::new(x0, y0, x1 - x0, y1 - y0).encloses(&place) {
        draw_label(sheet, &place, "absorbing layer outside");
    }
}

/// Brackets right of the map with the names of the layers; names that would overlap are moved apart.
fn draw_layers(sheet: &mut Sheet, map: &MapFigure, frame: &Rect) {
    let mut layers: Vec<_> = map
        .layers
        .iter()
        .filter(|layer| layer.bottom.is_finite() && layer.top.is_finite())
        .map(|layer| {
            let ends =
                [layer.top, layer.bottom].map(|y| on_sheet(map, frame, 0.0, y)[1].clamp(frame.y, frame.bottom()));
            (ends[0].min(ends[1]), ends[0].max(ends[1]), layer.label.as_str())
        })
        .collect();
    layers.sort_by(|a, b| (a.0 + a.1).total_cmp(&(b.0 + b.1)));
    let mut free = f64::NEG_INFINITY;
    for (top, bottom, label) in layers {
        let x = frame.right() + 5.0;
        sheet.line(
            vec![[x, top + 1.0], [x + 4.0, top + 1.0], [x + 4.0, bottom - 1.0], [x, bottom - 1.0]],
            OUTLINE,
            1.0,
        );
        let middle = (top + bottom) / 2.0;
        let y = middle.max(free);
        sheet.line(vec![[x + 4.0, middle], [x + 9.0, y]], OUTLINE, 1.0);
        let label = shortened(label, LABEL_SIZE, LONGEST_NAME);
        sheet.text([x + 12.0, y + 0.36 * LABEL_SIZE], &label, LABEL_SIZE, Anchor::Start);
        free = y + LABEL_HEIGHT;
    }
}

fn draw_bar(sheet: &mut Sheet, key: &Key, bar: &Rect) {
    let mut y = bar.y;
    if key.has_colour {
        let rows = 256;
        let pixels = (0..rows).flat_map(|row| shade(1.0 - row as f64 / (rows - 1) as f64).rgb).collect();
        sheet.picture(*bar, Image { width: 1, height: rows, pixels });
        sheet.frame(*bar, FRAME_COLOUR, 1.0);
        let ticks = choose(&key.span, (bar.height / 50.0).clamp(2.0, 8.0) as usize);
        let mut widest: f64 = 0.0;
        for (share, label) in &ticks.major {
            let at = bar.bottom() - share * bar.height;
            sheet.line(vec![[bar.right(), at], [bar.right() + 4.0, at]], FRAME_COLOUR, 1.0);
            sheet.text([bar.right() + 8.0, at + 0.36 * TICK_SIZE], label, TICK_SIZE, Anchor::Start);
            widest = widest.max(text_width(label, TICK_SIZE));
        }
        let factor = if ticks.factor.is_empty() { String::new() } else { format!(" (×{})", ticks.factor) };
        let whole = format!("relative permittivity εᵣ{factor}");
        let fits = text_width(&whole, CAPTION_SIZE) <= bar.height;
        let caption = if fits { whole } else { format!("εᵣ{factor}") };
        let x = bar.right() + 8.0 + widest + 8.0 + CAPTION_SIZE * 0.8;
        sheet.text_upwards([x, bar.y + bar.height / 2.0], &caption, CAPTION_SIZE);
        y = bar.bottom();
    }
    for (number, (colour, name)) in key.rows().into_iter().enumerate() {
        let swatch = Rect::new(bar.x, y + 8.0 + 22.0 * number as f64, BAR_WIDTH, 14.0);
        sheet.fill(swatch, colour);
        sheet.frame(swatch, FRAME_COLOUR, 1.0);
        sheet.text([swatch.right() + 8.0, swatch.y + 11.5], name, TICK_SIZE, Anchor::Start);
    }
}

/// A bar of a round length, at most a quarter of the width, in the lower left corner.
fn draw_scale_bar(sheet: &mut Sheet, map: &MapFigure, frame: &Rect, room: &mut Room) {
    let wanted = map.extent[0] / 4.0;
    let power = 10f64.powf(wanted.log10().floor());
    let digit = [5.0, 2.0, 1.0].into_iter().find(|digit| digit * power <= wanted * (1.0 + 1e-9)).unwrap_or(1.0);
    let length = digit * power;
    let (value, unit) = match length {
        l if l >= 1.0 => (l, "m"),
        l if l >= 0.01 => (l * 100.0, "cm"),
        l => (l * 1000.0, "mm"),
    };
    let label = format!("{} {unit}", (value * 1000.0).round() / 1000.0);
    let drawn = length / map.extent[0] * frame.width;
    let width = drawn.max(text_width(&label, LABEL_SIZE)) + 14.0;
    let inner = map.absorbing.map_or([0.0; 2], |[left, bottom, ..]| {
        [left / map.extent[0] * frame.width, bottom / map.extent[1] * frame.height]
    });
    let ground = Rect::new(frame.x + inner[0] + 8.0, frame.bottom() - inner[1] - 38.0, width, 30.0);
    if !frame.encloses(&ground) || width > frame.width / 2.0 {
        return;
    }
    sheet.fill(ground, Colour::WHITE.with_alpha(0.85));
    let x = ground.x + (width - drawn) / 2.0;
    sheet.fill(Rect::new(x, ground.bottom() - 10.0, drawn, 4.0), Colour::BLACK);
    sheet.text([ground.x + width / 2.0, ground.y + 14.0], &label, LABEL_SIZE, Anchor::Middle);
    room.taken.push(ground);
}

fn draw_symbols(sheet: &mut Sheet, map: &MapFigure, frame: &Rect, room: &mut Room) {
    let placed: Vec<_> = map
        .symbols
        .iter()
        .map(|symbol| (symbol, on_sheet(map, frame, symbol.x, symbol.y)))
        .filter(|(_, at)| frame.contains(*at))
        .collect();
    room.taken.extend(placed.iter().map(|(_, [x, y])| Rect::new(x - 7.0, y - 7.0, 14.0, 14.0)));
    for (symbol, [x, y]) in &placed {
        let (colour, up) = match symbol.kind {
            SymbolKind::Source => (SOURCE, -1.0),
            SymbolKind::Receiver => (RECEIVER, 1.0),
        };
        for (r, colour) in [(8.5, Colour::WHITE), (6.0, colour)] {
            sheet.area(vec![[*x, y - up * r], [x + r, y + up * 0.75 * r], [x - r, y + up * 0.75 * r]], colour);
        }
    }
    for (symbol, at) in placed.iter().filter(|(symbol, _)| !symbol.label.is_empty()) {
        let width = text_width(&symbol.label, LABEL_SIZE) + 6.0;
        if let Some(place) = room.claim(frame, around(*at, width, LABEL_HEIGHT)) {
            draw_leader(sheet, *at, &place);
            draw_label(sheet, &place, &symbol.label);
        }
    }
}
