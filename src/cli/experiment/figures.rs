//! The figure of each experiment.

use std::path::Path;

use crate::cli::error::CliError;
use crate::cli::experiment::Specified;
use crate::plot::{Axis, Chart, Figure as _, PALETTE, Panels, Series, Stroke};
use crate::study::experiments::{Curve, Outcome, SECTORS, measure_slope};

const STROKES: [Stroke; 4] = [Stroke::Solid, Stroke::Dashed, Stroke::Dotted, Stroke::DashDotted];

/// Draws `curve.png` and `curve.svg`.
///
/// # Errors
/// When they cannot be written.
pub fn write(out: &Path, spec: &Specified, outcome: &Outcome) -> Result<(), CliError> {
    match spec {
        Specified::RollingSphere(_) => rolling(&outcome.curve).write(out, "curve")?,
        Specified::Repose(_) => repose(outcome).write(out, "curve")?,
        Specified::Lateral(_) => lateral(&outcome.curve).write(out, "curve")?,
        Specified::Oedometer(_) => oedometer(&outcome.curve).write(out, "curve")?,
        Specified::Pluviation(_) => pluviation(&outcome.curve).write(out, "curve")?,
    };
    Ok(())
}

fn line(curve: &Curve, [x, y]: [&str; 2], factors: [f64; 2], name: &str, index: usize) -> Series {
    let points = curve.points(x, y).into_iter().map(|(x, y)| (factors[0] * x, factors[1] * y)).collect();
    // A colour that comes back has another stroke.
    Series::line(name, points).drawn(STROKES[(index + index / PALETTE.len()) % STROKES.len()], index)
}

/// Displacement and torque of all runs over time.
fn rolling(curve: &Curve) -> Panels {
    let charts = [("displacement_m", "displacement", "m"), ("torque_n_m", "rolling torque", "N m")];
    let charts = charts.map(|(ending, label, unit)| {
        let chart = Chart::new("", Axis::linear("time", "s"), Axis::linear(label, unit));
        let columns = curve.columns.iter().filter(|column| column.ends_with(ending));
        columns.enumerate().fold(chart, |chart, (index, column)| {
            let name = column.trim_end_matches(ending).trim_end_matches('_');
            chart.with(line(curve, ["time_s", column], [1.0; 2], name, index))
        })
    });
    Panels { size: [960.0, 900.0], ..Panels::stacked("A ball comes to rest", charts.into()) }
}

/// The flow, and the surface of the heap with the measured slope.
fn repose(outcome: &Outcome) -> Panels {
    let flow = Chart::new("", Axis::linear("time since the gate opened", "s"), Axis::linear("stones passed", ""))
        .with(line(&outcome.curve, ["time_s", "stones_passed"], [1.0; 2], "", 0));
    let mut heap = Chart::new("", Axis::linear("distance from the axis", "m"), Axis::linear("height", "m"));
    if let Some(slope) = measure_slope(&outcome.stones, [0.0; 2]) {
        let surface = slope.profile.iter().map(|[r, z]| (*r, *z)).filter(|(_, z)| z.is_finite()).collect();
        let name = format!("surface, mean of {SECTORS} sectors");
        let fall = slope.degrees.to_radians().tan();
        // Through the middle of the slope.
        let middle = slope.profile.iter().find(|[_, z]| *z <= 0.5 * slope.height).copied().unwrap_or([0.0; 2]);
        let ends = [0.8, 0.2].map(|share| share * slope.height);
        let fitted = ends.map(|z| (middle[0] + (middle[1] - z) / fall, z)).to_vec();
        heap = heap
            .with(Series::line(&name, surface))
            .with(Series::line(&format!("{:.1} degrees", slope.degrees), fitted).drawn(Stroke::Dashed, 1));
    }
    Panels { size: [960.0, 800.0], ..Panels::stacked("Angle of repose", vec![flow, heap]) }
}

/// Force over displacement, and the share of each face.
fn lateral(curve: &Curve) -> Panels {
    let (x, faces) = ("displacement_mm", ["bottom", "shoulder", "crib"]);
    let axis = || Axis::linear("displacement", "mm");
    let mut forces = Chart::new("", axis(), Axis::linear("lateral force", "kN")).with(line(
        curve,
        [x, "force_n"],
        [1.0, 1e-3],
        "sleeper",
        0,
    ));
    let mut shares = Chart::new("", axis(), Axis::linear("share", "%").between(0.0, 100.0));
    let whole = curve.column("force_n");
    let most = whole.iter().copied().fold(0.0, f64::max);
    for (index, face) in faces.into_iter().enumerate() {
        let column = format!("{face}_n");
        forces = forces.with(line(curve, [x, &column], [1.0, 1e-3], face, index + 1));
        // Where hardly any force acts, a share of it tells nothing.
        let points = curve.points(x, &column).into_iter().zip(&whole);
        let points = points.filter(|(_, whole)| **whole > 0.05 * most).map(|((x, y), whole)| (x, 100.0 * y / whole));
        let series = Series::line(face, points.collect());
        shares = shares.with(series.drawn(STROKES[(index + 1) % STROKES.len()], index + 1));
    }
    Panels { size: [960.0, 900.0], ..Panels::stacked("Lateral resistance", vec![forces, shares]) }
}

fn oedometer(curve: &Curve) -> Chart {
    let chart = Chart::new("Oedometer", Axis::linear("strain", "%"), Axis::linear("stress", "kPa"));
    [("stress_pa", "plate"), ("side_stress_pa", "sides"), ("floor_stress_pa", "floor")]
        .into_iter()
        .enumerate()
        .fold(chart, |chart, (index, (column, name))| {
            chart.with(line(curve, ["strain", column], [100.0, 1e-3], name, index))
        })
}

fn pluviation(curve: &Curve) -> Panels {
    let layers = || Axis::linear("layer", "");
    let charts = [("height_m", 100.0, "height", "cm"), ("porosity", 100.0, "porosity inside", "%")];
    let charts = charts.map(|(column, factor, label, unit)| {
        let series = line(curve, ["layer", column], [1.0, factor], "", 0).drawn(Stroke::LineAndPoints, 0);
        Chart::new("", layers(), Axis::linear(label, unit)).with(series)
    });
    Panels { size: [960.0, 700.0], ..Panels::stacked("Pluviation", charts.into()) }
}
