//! Experiments small enough to be run at every change: a heap, a pressed box, rain, a pushed block; stopping and going on.

mod cli_support;

use std::cell::Cell;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::Path;

use ballast_gpr::study::experiments::{
    ExperimentError, ExperimentSpec as _, JOURNAL, LateralSpec, OedometerSpec, PluviationSpec, ReposeSpec, Running,
    STATE, Told, run_lateral, run_oedometer, run_pluviation, run_repose,
};

/// Softened a hundred times: steps ten times as long.
fn soft(template: &str) -> String {
    template.replace("\"17.7 GPa\"", "\"0.177 GPa\"").replace("\"5 us\"", "\"50 us\"")
}

use cli_support::Place;

fn go_on(_: &Told) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn quietly() -> Running<'static> {
    Running { threads: NonZeroUsize::MIN, watch: &go_on, keep_in: None, fresh: true }
}

fn small_heap() -> ReposeSpec {
    let text = soft(ReposeSpec::TEMPLATE).replace("stones = 600", "stones = 200");
    ReposeSpec::read(&text, Path::new("heap.toml")).unwrap()
}

/// 200 stones make a heap between 15 and 50 degrees: rolling friction holds it, friction of 0.6 (31 degrees between planes) and the
/// interlocking of stones bound it. No stone is lost.
#[test]
fn a_small_heap_has_a_slope() {
    let result = run_repose(&small_heap(), &quietly()).unwrap();
    let slope = result.slope.unwrap();
    assert!((15.0..50.0).contains(&slope.degrees), "{slope:?}");
    assert_eq!(result.outcome.stones.len() + result.kept_back, 200);
    let passed = result.outcome.curve.column("stones_passed");
    assert!(passed.windows(2).all(|pair| pair[1] >= pair[0] - 1.0) && passed.len() > 20);
    assert!(result.outcome.notes.iter().any(|note| note.starts_with("softened: E = 0.177 GPa")));
    // The heap stands on the floor: no stone floats or lies in it.
    assert!(result.outcome.stones.iter().all(|stone| stone.centre[2] - stone.radius > -0.01 * stone.radius));
}

/// Stopped in the midst of the flow and gone on with: the same bits as without.
#[test]
fn a_heap_that_was_stopped_goes_on_to_the_same_bits() {
    let spec = small_heap();
    let whole = run_repose(&spec, &quietly()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let calls = Cell::new(0);
    let stops = |told: &Told| {
        calls.set(calls.get() + u32::from(told.stage == "flowing out"));
        if calls.get() == 20 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let kept = Some(folder.path().to_path_buf());
    let first = Running { watch: &stops, keep_in: kept.clone(), ..quietly() };
    let error = match run_repose(&spec, &first) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("it was not stopped: {} calls", calls.get()),
    };
    assert!(error.contains("s of `flowing out`; the state is kept in"), "{error}");
    assert!(folder.path().join(STATE).exists() && folder.path().join(JOURNAL).exists());

    // Another specification does not go on from there.
    let mut other = spec.clone();
    other.stone.friction = 0.5;
    let running = Running { keep_in: kept, fresh: false, ..quietly() };
    let error = run_repose(&other, &running).unwrap_err();
    assert!(matches!(error, ExperimentError::OtherSave { .. }), "{error}");

    // Nor two runs at once.
    let elsewhere = std::fs::File::open(folder.path()).unwrap();
    elsewhere.lock().unwrap();
    let error = run_repose(&spec, &running).unwrap_err();
    assert!(matches!(error, ExperimentError::InUse { .. }), "{error}");
    drop(elsewhere);

    let second = run_repose(&spec, &running).unwrap();
    assert_eq!(second, whole);
    assert!(!folder.path().join(STATE).exists() && !folder.path().join(JOURNAL).exists());
}

/// 300 stones between plates: stress grows with strain, is drawn back with a loss, and floor and plate bear the same within the weight
/// of the stones (300 of 50 mm: 0.52 kN on 0.09 m², 5.8 kPa).
#[test]
fn a_pressed_box_stiffens_and_keeps_a_strain() {
    let text = soft(OedometerSpec::TEMPLATE).replace("stones = 600", "stones = 300").replace("\"40 cm\"", "\"30 cm\"");
    let outcome = run_oedometer(&OedometerSpec::read(&text, Path::new("box.toml")).unwrap(), &quietly()).unwrap();
    let read = |key: &str| outcome.reading(key).unwrap();
    assert!(read("stress_kpa") >= 100.0 && read("strain_percent") > 0.0);
    assert!(read("strain_left_percent") > 0.0 && read("strain_left_percent") < read("strain_percent"));
    // Sides press with less than the plate; frictionless ones so that floor and plate are in balance.
    assert!((0.05..0.9).contains(&read("side_ratio")), "{}", read("side_ratio"));
    assert!((35.0..55.0).contains(&read("porosity_percent")));
    let rows = &outcome.curve.rows;
    let peak = rows.iter().max_by(|a, b| a[1].total_cmp(&b[1])).unwrap();
    assert!((peak[3] - peak[1] - 5.8e3).abs() < 5e3, "{peak:?}");
}

/// Layer on layer: the bed grows, no stone is lost. Its porosity lies above that of the densest random packing (36 %) and below that of
/// towers (1 - pi/6 of cells that are 1.2 diameters wide, 64 %): friction and rolling friction keep it loose, and so do walls six
/// stones apart.
#[test]
fn rain_makes_a_bed() {
    let text = soft(PluviationSpec::TEMPLATE)
        .replace("layers = 4", "layers = 3")
        .replace("per_layer = 150", "per_layer = 80")
        .replace("\"40 cm\"", "\"30 cm\"");
    let outcome = run_pluviation(&PluviationSpec::read(&text, Path::new("rain.toml")).unwrap(), &quietly()).unwrap();
    let heights = outcome.curve.column("height_m");
    assert!(heights.len() == 3 && heights.windows(2).all(|pair| pair[1] > pair[0]), "{heights:?}");
    assert_eq!(outcome.stones.len(), 240);
    let porosity = outcome.reading("porosity_percent").unwrap();
    assert!((36.0..64.0).contains(&porosity), "{porosity}");
}

/// A short sleeper in coarse stones: it resists, every face has its share, and the shares make the whole.
#[test]
fn a_short_sleeper_resists() {
    let text = soft(LateralSpec::TEMPLATE)
        .replace("length = \"2.5 m\"", "length = \"60 cm\"")
        .replace("mass = \"372 kg\"", "mass = \"90 kg\"")
        .replace("shoulder = \"40 cm\"", "shoulder = \"15 cm\"")
        .replace("under = \"30 cm\"", "under = \"20 cm\"")
        .replace("spacing = \"60 cm\"", "spacing = \"45 cm\"")
        .replace("time = \"2.5 s\"", "time = \"0.6 s\"")
        .replace("speed = \"10 mm/s\"", "speed = \"40 mm/s\"")
        .replace("distance = \"8 mm\"", "distance = \"6 mm\"");
    let spec = LateralSpec::read(&text, Path::new("lateral.toml")).unwrap();
    let outcome = run_lateral(&spec, &quietly()).unwrap();
    let peak = outcome.reading("peak_kn").unwrap();
    // At least the friction of its own weight on half of its foot, at most a tenfold of it.
    let weight = 1e-3 * 9.81 * 90.0;
    assert!((0.25 * weight..10.0 * weight).contains(&peak), "{peak} kN");
    for row in &outcome.curve.rows {
        let faces: f64 = row[2..7].iter().sum();
        assert!((faces - row[1]).abs() <= 1e-9 * row[1].abs().max(1.0));
    }
    let solid = outcome.reading("solid_percent").unwrap();
    assert!((45.0..70.0).contains(&solid), "{solid}");
}

/// The same seed gives the same bits on one thread and on two, another seed another heap.
#[test]
fn threads_change_nothing_and_seeds_do() {
    let text = soft(PluviationSpec::TEMPLATE)
        .replace("layers = 4", "layers = 1")
        .replace("per_layer = 150", "per_layer = 120");
    let spec = PluviationSpec::read(&text, Path::new("rain.toml")).unwrap();
    let one = run_pluviation(&spec, &quietly()).unwrap();
    let two = run_pluviation(&spec, &Running { threads: NonZeroUsize::new(2).unwrap(), ..quietly() }).unwrap();
    assert_eq!(one, two);
    let mut other = spec;
    other.run.seed = 2;
    assert_ne!(run_pluviation(&other, &quietly()).unwrap().stones, one.stones);
}

/// The command writes every file, keeps a finished seed and tells mean and spread.
#[test]
fn the_command_writes_an_ensemble() {
    let place = Place::new();
    let text = soft(&place.ok(&["experiment", "pluviation", "--print-template"]));
    place.write("rain.toml", text.replace("layers = 4", "layers = 1").replace("per_layer = 150", "per_layer = 60"));
    let command =
        ["experiment", "pluviation", "rain.toml", "--out", "rain", "--seeds", "2", "--json", "--threads", "1"];
    let told = place.json(&command);
    assert_eq!(told["readings"]["stones"]["mean"], 60.0);
    assert_eq!(told["readings"]["height_m"]["values"].as_array().unwrap().len(), 2);
    let names =
        ["curve.csv", "curve.png", "curve.svg", "experiment.toml", "manifest.json", "outcome.json", "stones.csv"];
    assert_eq!(place.names("rain/seed-1"), names);
    let before = place.files("rain");
    assert_eq!(place.json(&command), told);
    assert!(place.files("rain") == before, "a finished seed was made again");
    let error = place.fails(&["experiment", "pluviation", "rain.toml", "--out", "rain"], 2);
    assert!(error.starts_with("error: the folder `rain` is not empty"), "{error}");
}

/// Every template is read as it is printed.
#[test]
fn templates_are_complete() {
    let place = Place::new();
    for name in ["rolling-sphere", "repose", "lateral", "oedometer", "pluviation"] {
        let text = place.ok(&["experiment", name, "--print-template"]);
        assert!(text.contains("# assumed"), "{name}");
        // Read up to the first thing that is wrong with it.
        let wrong = text.replacen("density = ", "densety = ", 1);
        place.write("wrong.toml", wrong);
        let error = place.fails(&["experiment", name, "wrong.toml"], 2);
        assert!(error.contains("did you mean `density` in place of `densety`?"), "{name}: {error}");
    }
    let told = place.json(&["experiment", "rolling-sphere", "--json"]);
    assert!(told["readings"]["flat-eta0.2-bounded_stop_s"].as_f64().unwrap() > 0.5);
}

/// The full tier of `validate irazabal2017` has a place for every figure: its file and the program name the same.
#[test]
fn the_full_tier_names_its_figures() {
    let text = include_str!("../validation/irazabal2017/full.toml");
    let case = ballast_gpr::study::Case::read("irazabal2017", text).unwrap();
    let mut wanted: Vec<String> = ["0_20", "0_25", "0_30", "5_9_gpa", "11_8_gpa", "23_6_gpa", "1200_stones"]
        .iter()
        .flat_map(|heap| ["", "_cone", "_spread", "_kept_back"].map(|what| format!("repose_{heap}{what}")))
        .collect();
    wanted.extend(["repose_grows", "repose_over_moduli"].map(String::from));
    wanted.extend(
        ["stones", "peak_kn", "peak_mm", "bottom_start_percent", "bottom_3mm_percent"].map(|w| format!("lateral_{w}")),
    );
    let mut found: Vec<String> = case.expected.iter().map(|expected| expected.key.clone()).collect();
    wanted.sort();
    found.sort();
    assert_eq!(found, wanted);
}
