//! Every kind of figure, drawn: the PNG decodes and is not blank, the SVG holds its words and smooth curves.
//!
//! With `BALLAST_GPR_GALLERY=folder` the same figures are left in that folder, to be looked at.

use std::collections::HashSet;
use std::f64::consts::PI;
use std::path::PathBuf;
use std::time::Instant;

use ballast_gpr::plot::{
    Axis, Band, Chart, Figure, MapFigure, MapLayer, MapSymbol, Mark, Marker, PackingFigure, Panels, ReferenceLine,
    Series, Stroke, SymbolKind, viridis,
};

/// A Ricker wavelet of 1 GHz centred at `t0` ns.
fn ricker(t: f64, t0: f64) -> f64 {
    let a = (PI * (t - t0)).powi(2);
    (1.0 - 2.0 * a) * (-a).exp()
}

fn trace(shift: f64, noise: f64) -> Vec<(f64, f64)> {
    (0..5000)
        .map(|i| {
            let t = f64::from(i) * 0.005;
            let clutter = noise * ((t * 9.1).sin() + (t * 7.3).cos()) * (-((t - 10.0) / 4.0).powi(2)).exp();
            (t, 0.35 * ricker(t, 6.9 + shift) - ricker(t, 12.6 + shift) + clutter)
        })
        .collect()
}

fn grading() -> Chart {
    let sieves = [22.4, 31.5, 40.0, 50.0, 63.0, 80.0];
    let with = |passing: [f64; 6]| sieves.into_iter().zip(passing).collect::<Vec<_>>();
    let x = Axis { ticks: sieves.to_vec(), ..Axis::log10("sieve", "mm").between(20.0, 100.0) };
    let mut chart =
        Chart::new("Grading: asked for and packed", x, Axis::linear("passing by mass", "%").between(0.0, 100.0))
            .with(Series::line("input", with([2.0, 12.0, 45.0, 80.0, 99.0, 100.0])))
            .with(Series::line("packed", with([1.0, 14.0, 42.0, 83.0, 98.0, 100.0])).drawn(Stroke::Dashed, 1));
    chart.bands.push(Band {
        name: "allowed by the standard".into(),
        x: sieves.to_vec(),
        lower: vec![0.0, 0.0, 30.0, 70.0, 97.0, 100.0],
        upper: vec![3.0, 25.0, 65.0, 99.0, 100.0, 100.0],
        colour: 7,
    });
    chart
}

fn comparison() -> Panels {
    let time = || Axis::linear("time", "ns").between(0.0, 25.0);
    let (measured, simulated) = (trace(0.0, 0.04), trace(0.12, 0.01));
    let pair = |label: &str, x: Axis, a: Vec<(f64, f64)>, b: Vec<(f64, f64)>| {
        Chart::new("", x, Axis::linear(label, ""))
            .with(Series::line("measured", a).drawn(Stroke::Solid, 6))
            .with(Series::line("simulated", b).drawn(Stroke::Dashed, 1))
    };
    let echoes = ["air / ballast, 6.90 ns", "plate, 12.60 ns"];
    let echoes: Vec<_> =
        [6.9, 12.6].into_iter().zip(echoes).map(|(t, name)| ReferenceLine::vertical(t, name)).collect();
    let mut traces = pair("amplitude, plate echo = 1", time(), measured.clone(), simulated.clone());
    traces.lines = echoes.clone();
    let envelope = |t: &[(f64, f64)]| t.iter().map(|&(x, y)| (x, (y * y + 0.02).sqrt())).collect();
    let mut envelopes = pair("envelope", time(), envelope(&measured), envelope(&simulated));
    envelopes.lines = echoes;
    let shape = |share: f64| share.powi(2) * (1.0 - share.powi(2)).exp();
    let spectrum = |f0: f64| (0..300).map(|i| f64::from(i) * 0.01).map(|f| (f, shape(f / f0))).collect();
    let spectra = pair("spectrum", Axis::linear("frequency", "GHz"), spectrum(0.92), spectrum(1.0));
    let difference = measured.iter().zip(&simulated).map(|(a, b)| (a.0, a.1 - b.1)).collect();
    let residual =
        Chart::new("", time(), Axis::linear("residual", "")).with(Series::line("measured − simulated", difference));
    let charts = vec![traces, envelopes, spectra, residual];
    let heights = vec![1.5, 1.0, 1.0, 1.0];
    Panels { heights, size: [960.0, 1150.0], ..Panels::stacked("Clean ballast: measured and simulated", charts) }
}

fn ensemble() -> Chart {
    let mean = trace(0.0, 0.0);
    let spread = |t: f64| 0.02 + 0.15 * (-((t - 12.0) / 3.0).powi(2)).exp();
    let scaled = |t: Vec<(f64, f64)>| t.into_iter().map(|p| (p.0, 430.0 * p.1)).collect::<Vec<_>>();
    let mut chart = Chart::new("30 packings of one grading", Axis::linear("time", "ns"), Axis::linear("Ez", "V/m"))
        .with(Series::line("mean", scaled(mean.clone())))
        .with(Series::line("one packing", scaled(trace(0.1, 0.03))).drawn(Stroke::Dotted, 6));
    chart.bands.push(Band {
        name: "mean ± standard deviation".into(),
        x: mean.iter().map(|p| p.0).collect(),
        lower: mean.iter().map(|&(t, v)| 430.0 * (v - spread(t))).collect(),
        upper: mean.iter().map(|&(t, v)| 430.0 * (v + spread(t))).collect(),
        colour: 0,
    });
    chart
}

fn cost() -> Chart {
    let times = [0.02, 0.11, 0.83, 6.4, 51.0];
    let errors = [0.31, 0.088, 0.021, 0.0052, 0.0013];
    let names = ["8 mm", "4 mm", "2 mm", "1 mm", "0.5 mm"];
    let rows = || times.into_iter().zip(errors);
    let curve = |name: &str, slower: f64, better: f64, colour| {
        Series::line(name, rows().map(|(t, e)| (t * slower, e * better)).collect()).drawn(Stroke::LineAndPoints, colour)
    };
    let mut chart = Chart::new("What accuracy costs", Axis::log10("wall time", "s"), Axis::log10("error", ""))
        .with(curve("staircase", 1.0, 1.0, 0))
        .with(curve("smoothed", 1.1, 0.35, 1));
    chart.markers = rows().zip(names).map(|((x, y), name)| Marker { x, y, label: name.into(), colour: 0 }).collect();
    chart.lines = vec![ReferenceLine::horizontal(0.02, "wanted: 2 %")];
    chart
}

fn crowded() -> Chart {
    let wave = |x: f64| 3e-6 * (x * 0.7).sin() * (-x / 60.0).exp();
    let wave = (0..2000).map(|i| f64::from(i) * 0.05).map(|x| (x, wave(x))).collect();
    let mut chart = Chart::new("Many marks", Axis::linear("time", "ns"), Axis::linear("Ez", "V/m"))
        .with(Series::line("a wave", wave));
    chart.lines = (0..14).map(|i| ReferenceLine::vertical(20.0 + 1.3 * f64::from(i), &format!("echo {i}"))).collect();
    let peak = |i: i32| (60.0 + f64::from(i % 4), 1e-6 * f64::from(i / 4));
    chart.markers = (0..12)
        .map(|i| (peak(i), format!("peak {i}")))
        .map(|((x, y), label)| Marker { x, y, label, colour: 2 })
        .collect();
    for colour in 0..8 {
        let style = [Stroke::Dashed, Stroke::Points, Stroke::DashDotted, Stroke::LineAndPoints][colour % 4];
        let points = (0..21).map(|i| (5.0 * f64::from(i), -4e-6 - 4e-7 * colour as f64)).collect();
        chart.series.push(Series::line(&format!("level {colour}"), points).drawn(style, colour));
    }
    chart
}

/// Discs of 28 to 72 mm on a square lattice; `fall` lets them sink by a share of their height.
fn discs(width: f64, height: f64, fall: f64) -> Vec<[f64; 3]> {
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / f64::from(u32::MAX >> 1)
    };
    let pitch = 0.075;
    let (columns, rows) = (((width - 0.005) / pitch) as usize, ((height - 0.005) / pitch) as usize);
    (0..rows * columns)
        .map(|n| [0.04 + pitch * (n % columns) as f64, (0.04 + pitch * (n / columns) as f64) * (1.0 - fall)])
        .map(|[x, y]| [x, y, 0.014 + 0.022 * random()])
        .collect()
}

fn packing(title: &str, width: f64, height: f64) -> PackingFigure {
    let (now, before) = (discs(width, height, 0.12), discs(width, height, 0.0));
    PackingFigure { title: title.into(), width, height, discs: now, before: Some(before) }
}

fn map_values([nx, ny]: [usize; 2], [width, height]: [f64; 2]) -> Vec<f32> {
    let stones = discs(width, 0.4, 0.1);
    let value = |x: f64, y: f64| match y {
        y if y < 0.04 => f32::INFINITY,
        y if y < 0.06 => f32::NAN,
        y if stones.iter().any(|s| (s[0] - x).hypot(s[1] + 0.1 - y) < s[2]) => 6.5,
        y if y < 0.2 => 3.0 + (x * 10.0).sin() as f32 * 0.5,
        _ => 1.0,
    };
    let cell = |n: usize, count: usize, side: f64| (n as f64 + 0.5) * side / count as f64;
    (0..nx * ny).map(|n| value(cell(n / ny, nx, width), cell(n % ny, ny, height))).collect()
}

fn map() -> MapFigure {
    let (extent, cells) = ([1.5, 0.95], [750, 475]);
    let symbol = |x: f64, label: &str, kind| MapSymbol { x, y: 0.8, label: label.into(), kind };
    let layer = |bottom: f64, top: f64, label: &str| MapLayer { bottom, top, label: label.into() };
    MapFigure {
        symbols: vec![
            symbol(0.72, "source, 2 GHz Ricker", SymbolKind::Source),
            symbol(0.78, "receiver", SymbolKind::Receiver),
        ],
        layers: vec![
            layer(0.5, 0.95, "air"),
            layer(0.2, 0.5, "clean ballast"),
            layer(0.06, 0.2, "fouled ballast"),
            layer(0.0, 0.04, "plate"),
        ],
        absorbing: Some([0.06, 0.0, 0.06, 0.06]),
        ..MapFigure::new("Fouled ballast over a plate", map_values(cells, extent), cells, extent)
    }
}

/// Draws a figure both ways and checks what can be checked without eyes.
fn check(stem: &str, figure: &dyn Figure, words: &[&str]) {
    let kept = std::env::var_os("BALLAST_GPR_GALLERY").map(PathBuf::from);
    let temporary = tempfile::tempdir().unwrap();
    let folder = kept.unwrap_or_else(|| temporary.path().into());
    let written = figure.write(&folder, stem).unwrap();
    let sheet = figure.lay_out().unwrap();

    let file = std::io::BufReader::new(std::fs::File::open(&written[0]).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    for (pixels, points) in [(info.width, sheet.width), (info.height, sheet.height)] {
        assert!((f64::from(pixels) - 2.0 * points).abs() <= 1.0, "{stem}: {pixels} pixels for {points} points");
    }
    let colours: HashSet<_> = pixels.chunks_exact(3).collect();
    assert!(colours.len() > 20, "{stem}: only {} colours", colours.len());

    let svg = std::fs::read_to_string(&written[1]).unwrap();
    assert!(svg.starts_with("<?xml") && svg.trim_end().ends_with("</svg>"), "{stem}");
    assert_eq!(svg.matches("<text").count(), svg.matches("</text>").count());
    for bad in ["NaN", "inf,", "-0.0", "−0.0\n", "\n−0\n", " dy="] {
        assert!(!svg.contains(bad), "{stem}: {bad}");
    }
    for word in words {
        assert!(svg.lines().any(|line| line == *word), "{stem}: no text `{word}`");
    }
    for (place, text) in sheet.text_boxes() {
        let inside = place.x >= 0.0 && place.y >= 0.0 && place.right() <= sheet.width && place.bottom() <= sheet.height;
        assert!(inside, "{stem}: `{text}` is cut: {place:?} on {} × {}", sheet.width, sheet.height);
    }
    let boxes = sheet.text_boxes();
    for (i, (a, first)) in boxes.iter().enumerate() {
        for (b, second) in &boxes[i + 1..] {
            assert!(!a.overlaps(b), "{stem}: `{first}` lies over `{second}`");
        }
    }
}

/// The value of an attribute.
fn attribute<'a>(text: &'a str, name: &str) -> &'a str {
    text.split(&format!("{name}=\"")).nth(1).unwrap().split('"').next().unwrap()
}

/// The coordinates of the longest curve in an SVG file, in points.
fn longest_curve(svg: &str) -> Vec<(f64, f64)> {
    let root = svg.lines().find(|line| line.starts_with("<svg")).unwrap();
    let canvas: f64 = attribute(root, "viewBox").split(' ').nth(2).unwrap().parse().unwrap();
    let units = canvas / attribute(root, " width").parse::<f64>().unwrap();
    let curves = svg.lines().filter(|line| line.starts_with("<polyline")).map(|line| attribute(line, "points"));
    let place = |text: &str| text.parse::<f64>().unwrap() / units;
    let longest = curves.max_by_key(|points| points.len()).unwrap();
    longest.split_whitespace().map(|p| p.split_once(',').unwrap()).map(|(x, y)| (place(x), place(y))).collect()
}

#[test]
fn grading_curves_are_drawn() {
    let words = ["Grading: asked for and packed", "sieve (mm)", "passing by mass (%)", "input", "22.4", "63"];
    check("grading", &grading(), &words);
}

#[test]
fn a_comparison_is_drawn() {
    let words = ["plate, 12.60 ns", "air / ballast, 6.90 ns", "25", "time (ns)", "frequency (GHz)", "−0.5"];
    check("comparison", &comparison(), &words);
}

#[test]
fn an_ensemble_is_drawn() {
    check("ensemble", &ensemble(), &["mean ± standard deviation", "Ez (V/m)"]);
}

#[test]
fn a_cost_curve_is_drawn() {
    check("cost", &cost(), &["0.5 mm", "8 mm", "wanted: 2 %", "0.001", "wall time (s)"]);
}

#[test]
fn a_crowded_chart_is_drawn() {
    check("crowded", &crowded(), &["echo 0", "echo 13", "Ez (×10⁻⁶ V/m)"]);
}

/// Long words are cut short, not off.
#[test]
fn long_words_stay_on_the_sheet() {
    let long = |word: &str| word.repeat(60);
    let axis = |word: &str| Axis::linear(&long(word), "m");
    let mut chart = Chart::new(&long("title "), axis("abscissa "), axis("ordinate "));
    chart.series = vec![Series::line(&long("series "), vec![(0.0, 1.0), (1.0, 0.0)])];
    check("long_words", &chart, &[]);
    let layer = MapLayer { bottom: 0.0, top: 1.0, label: long("layer ") };
    let map = MapFigure::new(&long("title "), vec![2.0, 3.0, 4.0, 5.0], [2, 2], [1.0, 1.0]);
    check("long_words_map", &MapFigure { layers: vec![layer], ..map }, &[]);
}

#[test]
fn packings_are_drawn() {
    let words = ["(a) before compaction, 114 stones", "(b) after compaction, 114 stones", "width (m)"];
    check("packing", &packing("RSA packing, seed 7", 1.48, 0.48), &words);
    check("tall_packing", &packing("Column", 0.4, 0.6), &["Column", "height (m)"]);
}

#[test]
fn a_map_is_drawn() {
    let words = ["source, 2 GHz Ricker", "receiver", "clean ballast", "conductor", "no value", "20 cm", "x (m)"];
    check("map", &map(), &words);
    let svg = map().svg().unwrap();
    assert!(svg.contains("href=\"data:image/png;base64,iVBORw0KGgo"), "the picture is no PNG");
}

/// Cells are stored column by column, upwards: of four cells (air, 3; infinity, 4) the second is top left and the
/// third, a conductor, is bottom right.
#[test]
fn a_map_stands_upright() {
    let map = MapFigure::new("", vec![1.0, 3.0, f32::INFINITY, 4.0], [2, 2], [1.0, 1.0]);
    let sheet = map.lay_out().unwrap();
    let image = sheet.marks.iter().find_map(|mark| match mark {
        Mark::Picture { image, .. } => Some(image),
        _ => None,
    });
    let pixels: Vec<_> = image.unwrap().pixels.chunks_exact(3).collect();
    let (lowest, highest) = (viridis(1.0).rgb, viridis(0.0).rgb);
    assert_eq!(pixels, [lowest, highest, [255; 3], [0; 3]]);
}

/// A curve that moved in whole points would look stepped: a slow sine must take positions between quarters of them.
#[test]
fn curves_in_svg_are_finer_than_a_quarter_point() {
    let sine = (0..1000).map(|i| f64::from(i) / 100.0).map(|x| (x, x.sin())).collect();
    let chart = Chart::new("", Axis::linear("x", ""), Axis::linear("y", "")).with(Series::line("", sine));
    let curve = longest_curve(&chart.svg().unwrap());
    let between = curve.iter().filter(|p| (p.1 * 4.0 - (p.1 * 4.0).round()).abs() > 1e-6).count();
    assert!(between > curve.len() / 4, "{between} of {} points lie between quarters of a point", curve.len());
    let levels: HashSet<i64> = curve.iter().map(|p| (p.1 * 8.0).round() as i64).collect();
    assert!(levels.len() > 400, "{}", levels.len());
}

/// The goal is a second for 4000 × 3000 cells on an idle machine; ten, so that a busy one does not fail.
#[test]
fn a_large_map_is_drawn_fast() {
    let values = (0..12_000_000_u32).map(|i| 1.0 + (i % 3000) as f32 * 0.003).collect();
    let figure = MapFigure::new("large", values, [4000, 3000], [4.0, 3.0]);
    let start = Instant::now();
    let svg = figure.svg().unwrap();
    let middle = start.elapsed();
    let png = figure.png().unwrap();
    let end = start.elapsed();
    println!("SVG {middle:?} ({} kB), PNG {:?} ({} kB)", svg.len() / 1000, end - middle, png.len() / 1000);
    assert!(end.as_secs_f64() < 10.0);
}
