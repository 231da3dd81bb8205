//! What the page tells of one folder.

use std::path::Path;

use serde_json::Value;

use super::page::{Model, Picture, Table};
use crate::cli::compare::expected;
use crate::cli::error::CliError;
use crate::cli::estimate;
use crate::cli::folder::{self, RunRecord};
use crate::cli::trace_file;
use crate::files;
use crate::plot::{Axis, Chart, Series};
use crate::scene::{self, PackingMethod, Scene, SceneSpec};
use crate::units::Metres;

/// Reads a folder.
///
/// # Errors
/// When its scene or manifest cannot be read.
pub fn read(path: &Path, number: usize) -> Result<Model, CliError> {
    let toml = files::read_text(&path.join(folder::SCENE))?;
    let spec = SceneSpec::read(&path.join(folder::SCENE))?;
    let manifest_path = path.join(folder::MANIFEST);
    let manifest = files::read_text(&manifest_path)?;
    let value: Value = serde_json::from_str(&manifest).map_err(|error| {
        CliError::input(format!("the manifest `{}` cannot be read: {error}", manifest_path.display()))
    })?;
    let layered = as_layers(&spec)?;
    let (traces, estimates, notes) = traces(path, &layered)?;
    let picture = |name: &str, alt: &str| -> Result<Vec<Picture>, CliError> {
        let file = path.join(name);
        Ok(if file.is_file() { vec![Picture::of_svg(alt, &files::read_text(&file)?)] } else { vec![] })
    };
    let mut packing_figures = picture("packing.svg", "The stones in the tank")?;
    packing_figures.extend(picture("grading.svg", "Sieve curve asked for and found")?);
    Ok(Model {
        id: format!("model-{number}"),
        name: path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned()),
        title: spec.title.clone(),
        summary: summary(&value),
        scene: scene_table(&spec),
        toml,
        packing: packing_table(&value),
        packing_figures,
        map: picture("map.svg", "Relative permittivity over the section")?,
        layers: layers_table(&layered),
        traces,
        estimates,
        notes,
        effects: effects_table(&value),
        cost: cost_table(path, &value),
        manifest,
    })
}

/// The scene without its stones: the composition and the arrivals, at no cost.
pub fn as_layers(spec: &SceneSpec) -> Result<Scene, CliError> {
    let mut spec = spec.clone();
    spec.packing.method = PackingMethod::Homogeneous;
    Ok(scene::resolve(&spec)?)
}

fn text(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Null => "–".into(),
        other => other.to_string(),
    }
}

fn number(value: &Value, digits: usize) -> String {
    value.as_f64().map_or("–".into(), |value| format!("{value:.digits$}"))
}

fn summary(manifest: &Value) -> String {
    let [nx, ny, nz] = [0, 1, 2].map(|axis| manifest["cells"][axis].as_u64().unwrap_or(1));
    let deep = if nz > 1 { format!(" × {nz}") } else { String::new() };
    format!(
        "Seed {}, {nx} × {ny}{deep} cells, {} steps of {} ps, made by {}.",
        text(&manifest["seed"]),
        text(&manifest["iterations"]),
        number(&(manifest["time_step"].as_f64().unwrap_or(0.0) * 1e12).into(), 2),
        text(&manifest["program"])
    )
}

fn scene_table(spec: &SceneSpec) -> Table {
    let mut rows = vec![
        ["tank, inside".into(), format!("{} wide, {} of ballast", spec.tank.width, spec.tank.height)],
        ["voids".into(), spec.packing.voids.to_string()],
        ["stones".into(), format!("{}, {}", spec.packing.stone, spec.packing.method.name())],
        [
            "fouling".into(),
            spec.fouling
                .as_ref()
                .map_or("none".into(), |fouling| format!("{} of {}", fouling.amount, fouling.material)),
        ],
        [
            "antenna".into(),
            format!(
                "{}, {} above the surface, {}",
                spec.antenna.frequency,
                spec.antenna.height,
                spec.antenna.pulse.as_ref().map_or_else(
                    || spec.antenna.waveform.name().to_string(),
                    |file| format!("pulse of `{}`", file.file_name().unwrap_or_default().to_string_lossy())
                )
            ),
        ],
    ];
    rows.push(["grid".into(), format!("cells of {}, {}", spec.grid.cell.in_unit("mm"), spec.grid.time_window)]);
    Table::of("What was built", ["", "value"], rows)
}

fn packing_table(manifest: &Value) -> Table {
    let mut rows = vec![];
    for (what, key) in [("discs", "packing"), ("spheres", "spheres")] {
        let found = &manifest[key];
        if found.is_null() {
            continue;
        }
        rows.push([format!("{what}, number"), text(&found["stones"])]);
        rows.push([
            format!("{what}, height, cm"),
            number(&(100.0 * found["height_m"].as_f64().unwrap_or(0.0)).into(), 1),
        ]);
        rows.push([format!("{what}, solid share up to that height, %"), number(&found["solid_percent"], 1)]);
        rows.push([format!("{what}, solid share inside, %"), number(&found["interior_solid_percent"], 1)]);
    }
    if rows.is_empty() {
        rows.push(["stones".into(), "none: layers of mixtures".into()]);
    }
    let fouling = &manifest["fouling"]["nominal"];
    if !fouling.is_null() {
        rows.push(["Selig's fouling index, %".into(), number(&fouling["selig"], 1)]);
        rows.push(["its class".into(), text(&fouling["selig_class"])]);
        rows.push(["voids filled, %".into(), number(&fouling["percentage_void_contamination"], 1)]);
        rows.push(["relative ballast fouling ratio, %".into(), number(&fouling["relative_ballast_fouling_ratio"], 1)]);
        rows.push(["its class".into(), text(&fouling["relative_class"])]);
    }
    Table::of("Figures", ["", "value"], rows)
}

fn layers_table(scene: &Scene) -> Table {
    let mut rows = vec![];
    let mut arrival = scene.arrivals.surface.si();
    for layer in &scene.layers {
        let from = arrival;
        arrival += crate::compare::permittivity::two_way_time(layer.thickness, layer.eps_r).si();
        rows.push([
            layer.name.clone(),
            format!("{:.1}", 100.0 * layer.thickness.si()),
            format!("{:.3}", layer.eps_r),
            format!("{:.3}", 1e9 * from),
            format!("{:.3}", 1e9 * arrival),
        ]);
    }
    let header = ["layer", "thickness, cm", "permittivity of the mixture", "echo of its top, ns", "of its base, ns"];
    Table::of("Layers, and the arrivals of a plane wave from the emission", header, rows)
}

type Traces = (Vec<Picture>, Vec<Table>, Vec<String>);

fn traces(path: &Path, scene: &Scene) -> Result<Traces, CliError> {
    if trace_file::result_of(path).is_err() {
        let note = format!("No trace yet: ballast-gpr run {}", folder::typed(path));
        return Ok((vec![], vec![], vec![note]));
    }
    let trace = trace_file::read(path)?;
    let windows = expected(&[path])?;
    let thickness = Metres(scene.layers.iter().map(|layer| layer.thickness.si()).sum());
    match estimate::of_trace(&trace, &windows, Some(thickness), None, Some(scene)) {
        Ok(found) => {
            let chart = estimate::picks_chart(&trace, &found);
            let table = Table::from(&estimate::table(&found));
            Ok((vec![Picture::of("A-scan with its picks", &chart)?], vec![table], vec![]))
        }
        Err(reason) => {
            let points = trace.times().zip(&trace.samples).map(|(t, v)| (1e9 * t, *v)).collect();
            let chart = Chart::new("A-scan", Axis::linear("time", "ns"), Axis::linear("amplitude", ""))
                .with(Series::line("", points));
            Ok((vec![Picture::of("A-scan", &chart)?], vec![], vec![reason.to_string()]))
        }
    }
}

fn effects_table(manifest: &Value) -> Table {
    let list = manifest["effects"]["list"].as_array().or_else(|| manifest["effects"].as_array());
    let rows = list.into_iter().flatten().map(|effect| {
        let on = if effect["on"].as_bool() == Some(true) { "on" } else { "off" };
        let share = effect["share"].as_f64().filter(|share| *share > 0.0);
        [
            text(&effect["name"]),
            on.into(),
            text(&effect["reason"]),
            share.map_or("–".into(), |share| format!("{:.1} %", 100.0 * share)),
        ]
    });
    Table::of("What was simulated, and why", ["effect", "", "why", "share of the grid"], rows.collect())
}

fn cost_table(path: &Path, manifest: &Value) -> Table {
    let seconds = &manifest["seconds"];
    let mut rows: Vec<[String; 3]> = [("packing", "packing"), ("cells", "raster"), ("writing", "writing")]
        .map(|(name, key)| [name.into(), number(&seconds[key], 2), String::new()])
        .into();
    for name in ["fdtd.h5", "gprmax.h5"] {
        if let Some(record) = RunRecord::beside(&path.join(name)) {
            let threads = record.threads.map_or("threads left to it".into(), |threads| format!("{threads} threads"));
            rows.push([
                format!("simulation, {}", record.solver),
                format!("{:.2}", record.wall_seconds),
                format!("{} precision, {threads}", record.precision),
            ]);
        }
    }
    Table::of("Wall times", ["", "s", ""], rows)
}
