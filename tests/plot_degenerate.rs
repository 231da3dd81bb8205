//! Data that break plotting programs: none, one, constant, gaps, the huge and the tiny.

use ballast_gpr::plot::{
    Axis, Band, Chart, Figure, MapFigure, Mark, Marker, PackingFigure, Panels, Pixels, PlotError, ReferenceLine, Scale,
    Series, Shades, Stroke,
};
use proptest::prelude::*;

fn axis(scale: Scale) -> Axis {
    Axis { scale, ..Axis::linear("x", "m") }
}

fn odd_number() -> impl Strategy<Value = f64> {
    let known = [0.0, -0.0, 5e-324, 1e9, 1e9 + 1e-6, 1e-9, f64::MAX, f64::MIN, f64::MIN_POSITIVE];
    let not_finite = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    let known: Vec<f64> = known.into_iter().chain(not_finite).collect();
    prop_oneof![4 => -100.0..100.0, 1 => prop::num::f64::ANY, 1 => prop::sample::select(known)]
}

fn scale() -> impl Strategy<Value = Scale> {
    prop::sample::select(vec![Scale::Linear, Scale::Log10])
}

fn style() -> impl Strategy<Value = Stroke> {
    use Stroke::{DashDotted, Dashed, Dotted, LineAndPoints, Points, Solid};
    prop::sample::select(vec![Solid, Dashed, Dotted, DashDotted, Points, LineAndPoints])
}

/// Draws a figure and checks that every coordinate in it lies on the sheet or close to it.
fn check(figure: &dyn Figure) {
    let sheet = figure.lay_out().unwrap();
    let svg = figure.svg().unwrap();
    assert!(!svg.contains("NaN"));
    let limit = 8.0 * 3.0 * sheet.width.max(sheet.height);
    for line in svg.lines().filter(|line| line.starts_with("<polyline") || line.starts_with("<polygon")) {
        let points = line.split("points=\"").nth(1).unwrap();
        for number in points.split(|c: char| !c.is_ascii_digit() && c != '-').filter(|text| !text.is_empty()) {
            let value: f64 = number.parse().unwrap();
            assert!(value.abs() <= limit, "{value} lies far off the sheet");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_data_break_a_chart(
        points in prop::collection::vec((odd_number(), odd_number()), 0..40),
        band in prop::collection::vec((odd_number(), odd_number(), odd_number()), 0..20),
        marks in prop::collection::vec((odd_number(), odd_number(), "\\PC{0,20}"), 0..6),
        scales in (scale(), scale()),
        range in prop::option::of((odd_number(), odd_number())),
        style in style(),
        width in odd_number(),
        size in (60.0..1200.0_f64, 60.0..900.0_f64),
    ) {
        let mut chart = Chart::new("<title> & \u{1}", axis(scales.0), axis(scales.1));
        chart.size = [size.0, size.1];
        chart.x.range = range;
        chart.series.push(Series { width, ..Series::line("a <series>", points).drawn(style, 3) });
        chart.bands.push(Band {
            name: "band".into(),
            x: band.iter().map(|b| b.0).collect(),
            lower: band.iter().map(|b| b.1).collect(),
            upper: band.iter().map(|b| b.2).collect(),
            colour: 1,
        });
        chart.lines = marks.iter().map(|m| ReferenceLine::vertical(m.0, &m.2)).collect();
        chart.markers = marks.into_iter().map(|(x, y, label)| Marker { x, y, label, colour: 2 }).collect();
        check(&chart);
    }

    #[test]
    fn no_packing_or_map_breaks_its_figure(
        discs in prop::collection::vec([odd_number(), odd_number(), odd_number()], 0..20),
        values in prop::collection::vec(any::<f32>(), 12),
        sides in (1e-3..1e3_f64, 1e-3..1e3_f64),
        range in prop::option::of((odd_number(), odd_number())),
    ) {
        let (width, height) = sides;
        check(&PackingFigure { title: "p".into(), width, height, discs: discs.clone(), before: Some(discs) });
        let mut map = MapFigure::new("m", values, [3, 4], [width, height]);
        map.range = range;
        check(&map);
    }
}

/// The pixels too: one chart of each kind of oddity.
#[test]
fn odd_data_are_drawn_in_pixels() {
    let odd: [&[(f64, f64)]; 6] = [
        &[],
        &[(1.0, 1.0)],
        &[(0.0, 5.0), (1.0, 5.0), (2.0, 5.0)],
        &[(0.0, 1.0), (1.0, f64::NAN), (2.0, 1.5), (f64::INFINITY, 2.0), (3.0, 4.0)],
        &[(-1e300, -1e300), (1e300, 1e300)],
        &[(1e-300, 1e-300), (2e-300, 4e-300)],
    ];
    for points in odd {
        for style in [Stroke::Solid, Stroke::Dashed, Stroke::LineAndPoints] {
            let series = Series::line("s", points.to_vec()).drawn(style, 0);
            let chart = Chart::new("odd", axis(Scale::Linear), axis(Scale::Linear)).with(series);
            assert_eq!(Chart { size: [240.0, 160.0], ..chart }.png().unwrap()[1..4], *b"PNG");
        }
    }
}

/// One point alone is seen as a symbol, even where a line was asked for.
#[test]
fn a_single_point_is_visible() {
    let chart = Chart::new("", axis(Scale::Linear), axis(Scale::Linear)).with(Series::line("", vec![(1.0, 2.0)]));
    assert!(chart.svg().unwrap().contains("<circle"));
}

#[test]
fn contradicting_data_are_refused_with_the_numbers() {
    let map = MapFigure::new("m", vec![1.0; 5], [2, 3], [1.0, 1.0]);
    assert_eq!(map.svg().unwrap_err().to_string(), "the map `m` has 5 values, but its grid is 2 × 3 = 6 cells");
    let packing = PackingFigure { title: "p".into(), width: 0.0, height: 1.0, discs: vec![], before: None };
    let expected = "the figure `p` spans 0 m × 1 m; both must be above zero and finite";
    assert_eq!(packing.png().unwrap_err().to_string(), expected);
    let mut chart = Chart::new("", axis(Scale::Linear), axis(Scale::Linear));
    chart.bands.push(Band { name: "b".into(), x: vec![0.0], lower: vec![], upper: vec![1.0], colour: 0 });
    assert!(matches!(chart.svg(), Err(PlotError::BandShape { x: 1, lower: 0, upper: 1, .. })));
    chart.bands.clear();
    chart.size = [1e9, 5.0];
    assert!(matches!(chart.png(), Err(PlotError::Size { .. })));
    assert!(Panels::stacked("", vec![]).svg().is_ok());
}

fn radargram() -> Chart {
    let values = vec![-1.0, 0.0, 1.0, f64::NAN, 0.5, -0.5];
    let mut chart = Chart::new("line", Axis::linear("trace", ""), Axis::linear("time", "ns").downwards());
    let (x, y) = ((0.0, 1.0), (0.0, 2.0));
    chart.pixels = Some(Pixels { values, columns: 2, rows: 3, x, y, shades: Shades::Grey, limit: None });
    chart
}

/// Two traces of three samples: the first sample of the first is black at the top left, its last white at the bottom left;
/// what is not a number is white; 0 ns is written above 2 ns.
#[test]
fn the_first_sample_of_a_radargram_is_at_the_top() {
    let sheet = radargram().lay_out().unwrap();
    let picture = |mark: &Mark| if let Mark::Picture { image, .. } = mark { Some(image.clone()) } else { None };
    let image = sheet.marks.iter().find_map(picture).unwrap();
    let at = |u: f64, v: f64| {
        let (x, y) = ((u * image.width as f64) as usize, (v * image.height as f64) as usize);
        image.pixels[3 * (y * image.width + x)]
    };
    assert_eq!([at(0.1, 0.1), at(0.1, 0.5), at(0.1, 0.9)], [0, 128, 255]);
    assert_eq!([at(0.9, 0.1), at(0.9, 0.5), at(0.9, 0.9)], [255, 191, 64]);
    let highest = |wanted: f64| {
        let boxes = sheet.text_boxes();
        let those = boxes.iter().filter(|(_, text)| text.parse() == Ok(wanted)).map(|(place, _)| place.y);
        those.fold(f64::INFINITY, f64::min)
    };
    assert!(highest(0.0) < highest(2.0) && highest(2.0) < 600.0, "{} {}", highest(0.0), highest(2.0));
}

#[test]
fn pixels_that_do_not_fill_their_grid_are_refused() {
    let mut chart = radargram();
    chart.pixels.as_mut().unwrap().rows = 4;
    assert!(chart.lay_out().is_err());
}
