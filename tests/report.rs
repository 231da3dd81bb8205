//! From a plate measurement to a page: `pulse from-plate`, `build --pulse`, `estimate` and `report`.

mod cli_support;

use cli_support::Place;

fn ricker(t: f64, f: f64) -> f64 {
    let x = (std::f64::consts::PI * f * t).powi(2);
    (1.0 - 2.0 * x) * (-x).exp()
}

/// A recording as two columns of text: 512 samples of 25 ns, the direct wave at 4 ns and echoes of 0.5 GHz.
fn recording(echoes: &[(f64, f64)]) -> String {
    let step = 25.0 / 512.0;
    let value = |t: f64| {
        let direct = 800.0 * ricker(1e-9 * (t - 4.0), 0.5e9);
        direct + echoes.iter().map(|(at, size)| size * ricker(1e-9 * (t - at), 0.55e9)).sum::<f64>()
    };
    let lines = (0..512).map(|k| format!("{:.6} {:.6}\n", k as f64 * step, value(k as f64 * step)));
    format!("time_ns counts\n{}", lines.collect::<String>())
}

/// A place with a plate at 40 cm, a bed, and the sky.
fn place() -> Place {
    let place = Place::new();
    place.write("plate.txt", recording(&[(12.0, -3000.0)]));
    place.write("track.txt", recording(&[(12.0, -900.0), (18.3, -1500.0)]));
    place.write("sky.txt", recording(&[]));
    place
}

#[test]
fn a_walk_from_a_plate_to_a_page() {
    let place = place();
    let found = place.json(&[
        "pulse",
        "from-plate",
        "plate.txt",
        "--free-space",
        "sky.txt",
        "--height",
        "40cm",
        "--frequency",
        "500MHz",
        "--json",
    ]);
    assert!(found["correlation"].as_f64().unwrap() > 0.99, "{found}");
    for file in ["pulse.txt", "pulse.png", "pulse.svg", "pulse.json"] {
        assert!(place.path(file).is_file(), "{file}");
    }
    let pulse = std::fs::read_to_string(place.path("pulse.txt")).unwrap();
    assert!(pulse.starts_with("time pulse\n0 "), "{}", &pulse[..40]);

    place.build("bed", &["--pulse", "pulse.txt"]);
    let model = std::fs::read_to_string(place.path("bed/model.in")).unwrap();
    assert!(model.contains("#excitation_file: model_pulse1.txt"), "{model}");
    assert!(place.path("bed/pulse.txt").is_file());
    // The folder stands on its own: built again from its scene, without the first file.
    std::fs::remove_file(place.path("pulse.txt")).unwrap();
    place.ok(&["build", "bed/scene.toml", "--out", "again"]);
    let read = |name: &str| std::fs::read(place.path(name)).unwrap();
    assert_eq!(read("bed/model_pulse1.txt"), read("again/model_pulse1.txt"));

    let said = place.ok(&[
        "report",
        "bed",
        "--run",
        "--measured",
        "track.txt",
        "--plate",
        "plate.txt",
        "--free-space",
        "sky.txt",
        "--out",
        "page.html",
    ]);
    assert!(said.contains("page.html"), "{said}");
    let page = String::from_utf8(read("page.html")).unwrap();
    check(&page);
    assert!(page.contains("Both over the echo of a metal plate"));
    place.ok(&[
        "report",
        "bed",
        "--measured",
        "track.txt",
        "--plate",
        "plate.txt",
        "--free-space",
        "sky.txt",
        "--out",
        "second.html",
    ]);
    assert_eq!(read("page.html"), read("second.html"));
}

/// A page with every section, nothing that leads out of it, and every element closed.
fn check(page: &str) {
    for section in ["scene", "packing", "map", "traces", "effects", "cost", "manifest"] {
        assert!(page.contains(&format!("<section class=\"{section}\">")), "no section {section}");
    }
    assert!(page.contains("<section id=\"metrics\">"));
    assert!(page.matches("<img ").count() >= 4, "{} figures", page.matches("<img ").count());
    for out in ["http:", "https:", "<script", "<link", "<iframe", "url(", "file:", "@import", "src=\"/", "href=\"/"] {
        assert!(!page.contains(out), "the page holds `{out}`");
    }
    for source in page.split("src=\"").skip(1) {
        assert!(source.starts_with("data:image/svg+xml;base64,"), "{}", &source[..60]);
    }
    for link in page.split("href=\"").skip(1) {
        let target = link.strip_prefix('#').and_then(|rest| rest.split('"').next()).unwrap();
        assert!(page.contains(&format!("id=\"{target}\"")), "no anchor {target}");
    }
    closed(page);
}

/// Every element that is opened is closed, in order.
fn closed(page: &str) {
    let mut open: Vec<&str> = vec![];
    for tag in page.split('<').skip(1) {
        let name = tag.split(|c: char| c.is_whitespace() || c == '>').next().unwrap();
        if let Some(name) = name.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name), "closing </{name}>");
        } else if !matches!(name, "!DOCTYPE" | "meta" | "img") {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "left open: {open:?}");
}

#[test]
fn folders_without_a_measurement_are_compared_with_the_first() {
    let place = Place::new();
    place.build("clean", &[]);
    place.build("fouled", &["--fouling", "20cm"]);
    place.ok(&["run", "clean", "fouled"]);
    place.ok(&["report", "clean", "fouled", "--title", "<b>Two & \"more\"</b>"]);
    let page = std::fs::read_to_string(place.path("report.html")).unwrap();
    check(&page);
    assert!(page.contains("&lt;b&gt;Two &amp; &quot;more&quot;&lt;&#x2f;b&gt;"));
    assert_eq!(page.matches("<section class=\"scene\">").count(), 2);
    place.build("bare", &[]);
    place.ok(&["report", "bare", "--out", "bare.html"]);
    let page = std::fs::read_to_string(place.path("bare.html")).unwrap();
    assert!(page.contains("No trace yet"));
}

/// The echo of the base 6.3 ns after that of the surface: of 48 cm that is `(c t/2h)^2 = 3.871`; the surface 0.3 of the plate's is
/// `(1.3/0.7)^2 = 3.449`.
#[test]
fn a_measured_trace_is_read_side_by_side() {
    let place = place();
    let found = place.json(&[
        "estimate",
        "track.txt",
        "--thickness",
        "48cm",
        "--plate",
        "plate.txt",
        "--free-space",
        "sky.txt",
        "--json",
        "--surface",
        "11ns..13ns",
        "--base",
        "17ns..20ns",
        "--nominal",
        "500MHz",
    ]);
    let estimates = &found["estimates"];
    let near = |key: &str, wanted: f64| {
        let value = estimates[key].as_f64().unwrap();
        assert!((value / wanted - 1.0).abs() < 0.01, "{key} {value}, {wanted}");
    };
    near("tdsp_waveform", 3.871);
    near("tdsp_envelope", 3.871);
    near("srm", 3.449);
    assert!(place.path("estimate.svg").is_file());
}

/// A trace of one of the beds, read with the scene it was built from: the fouled height comes back within three of the standard
/// deviations that are told.
#[test]
fn the_fouled_height_of_a_simulated_bed_comes_back() {
    let place = Place::new();
    let window = ["--cell", "8mm", "--frequency", "500MHz", "--time-window", "20ns"];
    place.ok(&[&["build", "--out", "bed", "--fouling", "20cm", "--seed", "77"], &window[..]].concat());
    place.ok(&["run", "bed"]);
    let found =
        place.json(&["estimate", "bed", "--scene", "bed", "--seed", "1", "--seeds", "4", "--json", "--no-figure"]);
    let height = &found["ensemble"]["fouled_height"];
    let number = |key: &str| {
        let text = height[key].as_str().map(String::from).unwrap_or_else(|| height[key].to_string());
        text.trim_end_matches(" m").parse::<f64>().unwrap()
    };
    let (value, deviation) = (number("value"), number("standard_deviation"));
    assert!((value - 0.2).abs() < 3.0 * deviation, "{value} ± {deviation}");
    assert!(deviation < 0.2, "{deviation}");
    assert!(found["estimates"]["composition"]["column"].as_f64().unwrap() > 3.6);
    assert!(!place.path("estimate.json").exists());
}
