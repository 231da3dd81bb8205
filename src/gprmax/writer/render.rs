//! From a model to the text of an input file.

use std::path::{Path, PathBuf};

use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment, UndefinedBehavior};
use serde::Serialize;

use super::super::reader::DIRECTIVE;
use super::error::WriteError;
use super::number::{exponent, number};
use super::pulse_files::{PulseFiles, sampled};
use super::voxel_files::{VoxelFiles, command_safe};
use crate::files::write_bytes;
use crate::model::{
    Averaging, Beyond, Formulation, FractalBox, GeometryFile, GeometryView, Grading, MagneticAveraging, Material,
    MaterialId, Model, Object, Order, Resonance, Snapshot, SnapshotTime, Source, Stretch, TimeWindow, ViewKind,
    VoltageSource,
};

/// The template that is built in.
pub const DEFAULT_TEMPLATE: &str = include_str!("../../../templates/model.in");

/// How to write an input file.
///
/// A template is one of minijinja (Jinja2). It sees texts `generator`, `title`, `domain_mode`, `time_window`, `time_step`,
/// `stability_factor`, `threads`; lists `domain`, `spacing`, `cells`, `pml_cells`, `pml_cfs` (finished); the text `pml_formulation`; the number `iterations`; `materials` (each
/// `builtin`, `id`, `eps_r`, `sigma`, `mu_r`, `sigma_magnetic`, `poles` with `delta_eps`, `tau`, `resonance`, `resonances`), the flag
/// `dispersive_averaging`, the text `magnetic_averaging`, `waveforms` (`kind`, `amplitude`,
/// `frequency`, `id`; `file`, `between`, `beyond` of pulses given as samples), `sources` (`command`, `polarisation`, `position`, `resistance`,
/// `waveform`, `start`, `stop`), `receivers` (`position`, `name`),
/// lists `source_steps`, `receiver_steps`, and `objects`, `geometry_files`, `geometry_views` and `snapshots`, the finished lines. What is not given is an empty text or list; a name that does not exist is an error.
#[derive(Debug, Clone, Default)]
pub struct InputOptions {
    /// Name and text of a template to use instead of [`DEFAULT_TEMPLATE`].
    pub template: Option<(String, String)>,
}

/// What a template sees. Every field is always present; an empty text or list stands for "not given".
#[derive(Debug, Serialize)]
struct Page {
    generator: &'static str,
    /// What only the embedded solver reads; none for gprMax's own scheme.
    directives: Vec<String>,
    title: String,
    domain: [String; 3],
    domain_mode: &'static str,
    spacing: [String; 3],
    cells: [usize; 3],
    time_window: String,
    time_step: String,
    iterations: usize,
    stability_factor: String,
    pml_cells: Vec<usize>,
    pml_formulation: &'static str,
    pml_cfs: Vec<String>,
    threads: String,
    materials: Vec<MaterialLine>,
    dispersive_averaging: bool,
    /// Empty for gprMax's default.
    magnetic_averaging: &'static str,
    waveforms: Vec<WaveformLine>,
    sources: Vec<SourceLine>,
    receivers: Vec<ReceiverLine>,
    /// Empty where nothing moves.
    source_steps: Vec<String>,
    receiver_steps: Vec<String>,
    /// `#box`, `#cylinder`, `#sphere` and `#geometry_objects_read` lines, in the order of painting.
    objects: Vec<String>,
    /// `#geometry_objects_write` lines.
    geometry_files: Vec<String>,
    /// `#geometry_view` lines.
    geometry_views: Vec<String>,
    /// `#snapshot` lines.
    snapshots: Vec<String>,
}

#[derive(Debug, Serialize)]
struct MaterialLine {
    /// Free space, which needs no `#material` and stands here for its poles.
    builtin: bool,
    id: String,
    eps_r: String,
    sigma: String,
    mu_r: String,
    sigma_magnetic: String,
    poles: Vec<PoleLine>,
    /// `lorentz`, `drude` or empty.
    resonance: &'static str,
    /// The numbers of each pole, with blanks between them.
    resonances: Vec<String>,
}

#[derive(Debug, Serialize)]
struct PoleLine {
    delta_eps: String,
    tau: String,
}

#[derive(Debug, Serialize)]
struct WaveformLine {
    /// File of a pulse given as samples, and how they are interpolated; else empty.
    file: String,
    between: &'static str,
    beyond: String,
    kind: &'static str,
    amplitude: String,
    frequency: String,
    id: String,
}

#[derive(Debug, Serialize)]
struct SourceLine {
    command: &'static str,
    /// Empty but for voltage sources.
    resistance: String,
    polarisation: &'static str,
    position: [String; 3],
    waveform: String,
    start: String,
    stop: String,
}

#[derive(Debug, Serialize)]
struct ReceiverLine {
    position: [String; 3],
    name: String,
}

/// Writes a model as `<stem>.in`, with `<stem>_geometry.h5` and `<stem>_materials.json` where it holds voxels.
///
/// Returns the files written, the `.in` file first. Materials that only voxels use stand in the database, all others in the
/// `.in` file. Blocks of voxels that change nothing are left out. Characters of `stem` that gprMax's commands cannot name
/// become `_` in the names of the geometry files.
///
/// # Errors
/// See [`WriteError`]. Nothing is left half-written.
pub fn write_input(
    model: &Model,
    folder: &Path,
    stem: &str,
    options: &InputOptions,
) -> Result<Vec<PathBuf>, WriteError> {
    check(model)?;
    let voxels = VoxelFiles::of(model, stem)?;
    let pulses = PulseFiles { model, stem: command_safe(stem) };
    let text = fill_in(&page(model, &voxels, &pulses)?, options)?;
    let path = folder.join(format!("{stem}.in"));
    let mut written = vec![path.clone()];
    written.extend(voxels.write(folder)?);
    written.extend(pulses.write(folder)?);
    write_bytes(&path, text.as_bytes())?;
    Ok(written)
}

fn fill_in(page: &Page, options: &InputOptions) -> Result<String, WriteError> {
    let (name, source) = match &options.template {
        Some((name, text)) => (name.as_str(), text.as_str()),
        None => ("model.in", DEFAULT_TEMPLATE),
    };
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.set_auto_escape_callback(|_| AutoEscape::None);
    let rendered = environment.render_named_str(name, source, Serde(page));
    let mut text = rendered.map_err(|error| {
        let what =
            error.detail().map_or_else(|| error.kind().to_string(), |detail| format!("{}: {detail}", error.kind()));
        let place = error.line().map_or(String::new(), |line| {
            let text = source.lines().nth(line - 1).unwrap_or("");
            format!(" in line {line}: {}", text.trim())
        });
        WriteError::Template { name: name.into(), reason: what + &place }
    })?;
    text.truncate(text.trim_end().len());
    Ok(text + "\n")
}

fn page(model: &Model, voxels: &VoxelFiles<'_>, pulses: &PulseFiles<'_>) -> Result<Page, WriteError> {
    let grid = &model.grid;
    let mut objects = vec![];
    for (index, object) in model.objects.iter().enumerate() {
        objects.extend(object_line(model, index, object, voxels)?);
    }
    Ok(Page {
        generator: concat!("written by ballast-gpr ", env!("CARGO_PKG_VERSION")),
        directives: directives(model),
        title: model.title.split_whitespace().collect::<Vec<_>>().join(" "),
        domain: std::array::from_fn(|axis| match model.transverse_electric {
            Some(across) if across.index() == axis => "inf".into(),
            _ => number(grid.cells[axis] as f64 * grid.spacing[axis]),
        }),
        domain_mode: if model.transverse_electric.is_some() { "TE" } else { "" },
        spacing: grid.spacing.map(number),
        cells: grid.cells,
        time_window: match model.time_window {
            TimeWindow::Seconds(seconds) => exponent(seconds),
            TimeWindow::Iterations(count) => count.to_string(),
        },
        time_step: number(model.time_step()),
        iterations: model.iterations(),
        stability_factor: number(model.stability_factor),
        pml_cells: model.pml_cells.map_or(vec![], Vec::from),
        pml_formulation: match model.absorbing_profile.formulation {
            Formulation::Recursive => "",
            multipole => multipole.name(),
        },
        pml_cfs: model.absorbing_profile.stretches.iter().map(stretch).collect(),
        threads: model.threads.map_or(String::new(), |count| count.to_string()),
        materials: materials(model, voxels),
        dispersive_averaging: model.dispersive_averaging,
        magnetic_averaging: match model.magnetic_averaging {
            MagneticAveraging::Harmonic => "",
            arithmetic => arithmetic.name(),
        },
        waveforms: model
            .waveforms
            .iter()
            .enumerate()
            .map(|(index, w)| WaveformLine {
                file: pulses.name(index),
                between: sampled(w).map_or("", |sampled| sampled.between().name()),
                beyond: sampled(w).map_or(String::new(), |sampled| match sampled.beyond() {
                    Beyond::Value(value) => number(value),
                    Beyond::Extrapolate => "extrapolate".into(),
                }),
                kind: w.kind.name(),
                amplitude: number(w.amplitude),
                frequency: number(w.frequency),
                id: w.id.clone(),
            })
            .collect(),
        sources: sources(model)?,
        receivers: model
            .receivers
            .iter()
            .map(|r| ReceiverLine { position: r.position.map(number), name: r.name.clone().unwrap_or_default() })
            .collect(),
        source_steps: steps(model.source_steps),
        receiver_steps: steps(model.receiver_steps),
        objects,
        geometry_files: model.geometry_files.iter().map(geometry_line).collect(),
        geometry_views: model.geometry_views.iter().map(view_line).collect(),
        snapshots: model.snapshots.iter().map(snapshot_line).collect(),
    })
}

fn directives(model: &Model) -> Vec<String> {
    let order = (model.order != Order::Second).then(|| format!("{DIRECTIVE} order {}", model.order));
    let averaging = model.averaging;
    let averaging = (averaging != Averaging::Cells).then(|| format!("{DIRECTIVE} averaging {}", averaging.name()));
    order.into_iter().chain(averaging).collect()
}

fn geometry_line(asked: &GeometryFile) -> String {
    let [lower, upper] = [asked.lower, asked.upper].map(|corner| corner.map(number).join(" "));
    format!("#geometry_objects_write: {lower} {upper} {}", asked.file)
}

fn view_line(asked: &GeometryView) -> String {
    let numbers = [asked.lower, asked.upper, asked.spacing].map(|three| three.map(number).join(" ")).join(" ");
    let kind = if asked.kind == ViewKind::Edges { "f" } else { "n" };
    format!("#geometry_view: {numbers} {} {kind}", asked.file)
}

fn snapshot_line(asked: &Snapshot) -> String {
    let numbers = [asked.lower, asked.upper, asked.spacing].map(|three| three.map(number).join(" ")).join(" ");
    let at = match asked.at {
        SnapshotTime::Seconds(seconds) => exponent(seconds),
        SnapshotTime::Iteration(step) => step.to_string(),
    };
    format!("#snapshot: {numbers} {at} {}.{}", asked.name, asked.format.ending())
}

fn steps(steps: [f64; 3]) -> Vec<String> {
    if steps == [0.0; 3] { vec![] } else { steps.map(number).into() }
}

fn materials(model: &Model, voxels: &VoxelFiles<'_>) -> Vec<MaterialLine> {
    let line = |(index, m): (usize, &Material)| MaterialLine {
        builtin: index == MaterialId::FREE_SPACE.index(),
        id: m.id.clone(),
        eps_r: number(m.eps_r),
        sigma: number(m.sigma),
        mu_r: number(m.mu_r),
        sigma_magnetic: number(m.sigma_magnetic),
        poles: m.poles.iter().map(|p| PoleLine { delta_eps: number(p.delta_eps), tau: number(p.tau) }).collect(),
        resonance: match m.resonances.first() {
            None => "",
            Some(Resonance::Lorentz { .. }) => "lorentz",
            Some(Resonance::Drude { .. }) => "drude",
        },
        resonances: m.resonances.iter().map(resonance).collect(),
    };
    let listed = |(index, m): &(usize, &Material)| {
        let own = *index > MaterialId::FREE_SPACE.index() && m.directional.is_none() && !voxels.only_in_voxels(*index);
        own || (*index == MaterialId::FREE_SPACE.index() && m.is_dispersive())
    };
    model.materials.iter().enumerate().filter(listed).map(line).collect()
}

fn stretch(stretch: &Stretch) -> String {
    let words = |grading: &Grading| {
        let direction = if grading.reverse { "reverse" } else { "forward" };
        let max = grading.max.map_or("None".into(), number);
        format!("{} {direction} {} {max}", Grading::ORDERS[usize::from(grading.order.min(8))], number(grading.min))
    };
    [stretch.alpha, stretch.kappa, stretch.sigma].iter().map(words).collect::<Vec<_>>().join(" ")
}

fn resonance(resonance: &Resonance) -> String {
    match *resonance {
        Resonance::Lorentz { delta_eps, frequency, damping } => [delta_eps, frequency, damping].map(number).join(" "),
        Resonance::Drude { frequency, collisions } => [frequency, collisions].map(number).join(" "),
    }
}

fn sources(model: &Model) -> Result<Vec<SourceLine>, WriteError> {
    let line = |source: &Source| {
        let (index, excitation) = (source.waveform(), source.excitation());
        let waveform = model.waveforms.get(index).ok_or(WriteError::Dangling { what: "waveform", index })?;
        let (command, resistance) = match source {
            Source::HertzianDipole(_) => ("hertzian_dipole", String::new()),
            Source::MagneticDipole(_) => ("magnetic_dipole", String::new()),
            Source::VoltageSource(VoltageSource { resistance, .. }) => ("voltage_source", number(*resistance)),
        };
        // gprMax knows a start only together with a stop; a stop at the end of the window changes nothing.
        let end = match model.time_window {
            TimeWindow::Seconds(seconds) => seconds,
            TimeWindow::Iterations(count) => count as f64 * model.time_step(),
        };
        let timed = excitation.start != 0.0 || excitation.stop.is_some();
        let text = |value: f64| if timed { number(value) } else { String::new() };
        Ok(SourceLine {
            command,
            resistance,
            polarisation: source.polarisation().name(),
            position: source.position().map(number),
            waveform: waveform.id.clone(),
            start: text(excitation.start),
            stop: text(excitation.stop.unwrap_or(end)),
        })
    };
    model.sources.iter().map(line).collect()
}

fn object_line(
    model: &Model,
    index: usize,
    object: &Object,
    voxels: &VoxelFiles<'_>,
) -> Result<Option<String>, WriteError> {
    let point = |p: &[f64; 3]| p.map(number).join(" ");
    let stuff = |id: &MaterialId, averaging: bool| {
        let dangling = WriteError::Dangling { what: "material", index: id.index() };
        let material = model.materials.get(id.index()).ok_or(dangling)?;
        if let Some(along) = material.directional {
            return Ok(along.map(|id| model.materials[id.index()].id.as_str()).join(" "));
        }
        // `#material` has no word for "not averaged"; the object's own flag says the same.
        let flag =
            if averaging && (material.averagable || material.is_pec() || material.is_dispersive()) { "y" } else { "n" };
        Ok::<_, WriteError>(format!("{} {flag}", material.id))
    };
    let name = |id: &MaterialId| match model.materials.get(id.index()) {
        Some(material) => Ok(&material.id),
        None => Err(WriteError::Dangling { what: "material", index: id.index() }),
    };
    match object {
        Object::Box { lower, upper, material, averaging } => {
            Ok(Some(format!("#box: {} {} {}", point(lower), point(upper), stuff(material, *averaging)?)))
        }
        Object::Cylinder { start, end, radius, material, averaging } => {
            let stuff = stuff(material, *averaging)?;
            Ok(Some(format!("#cylinder: {} {} {} {stuff}", point(start), point(end), number(*radius))))
        }
        Object::Sphere { centre, radius, material, averaging } => {
            let stuff = stuff(material, *averaging)?;
            Ok(Some(format!("#sphere: {} {} {stuff}", point(centre), number(*radius))))
        }
        Object::Ellipsoid { centre, radii, material, averaging } => {
            let stuff = stuff(material, *averaging)?;
            Ok(Some(format!("#ellipsoid: {} {} {stuff}", point(centre), point(radii))))
        }
        Object::Cone { start, end, radii: [first, second], material, averaging } => {
            let (stuff, radii) = (stuff(material, *averaging)?, format!("{} {}", number(*first), number(*second)));
            Ok(Some(format!("#cone: {} {} {radii} {stuff}", point(start), point(end))))
        }
        Object::Sector { axis, centre, extent, radius, start, sweep, material, averaging } => {
            let [a, b] = *centre;
            let numbers = [a, b, extent[0], extent[1], *radius, *start, *sweep].map(number).join(" ");
            Ok(Some(format!("#cylindrical_sector: {} {numbers} {}", axis.name(), stuff(material, *averaging)?)))
        }
        Object::Triangle { corners, thickness, material, averaging, .. } => {
            let corners = corners.each_ref().map(point).join(" ");
            Ok(Some(format!("#triangle: {corners} {} {}", number(*thickness), stuff(material, *averaging)?)))
        }
        Object::Plate { lower, upper, material } => {
            let along = model.materials.get(material.index()).and_then(|m| m.directional);
            let stuff = match along {
                Some(along) => {
                    let node = |axis: usize, metres| model.grid.node(axis, metres);
                    let flat = (0..3).find(|&axis| node(axis, lower[axis]) == node(axis, upper[axis]));
                    let names = (0..3).filter(|&axis| Some(axis) != flat).map(|axis| name(&along[axis]));
                    names.collect::<Result<Vec<_>, _>>()?.into_iter().map(String::as_str).collect::<Vec<_>>().join(" ")
                }
                None => name(material)?.clone(),
            };
            Ok(Some(format!("#plate: {} {} {stuff}", point(lower), point(upper))))
        }
        Object::Edge { lower, upper, material } => {
            Ok(Some(format!("#edge: {} {} {}", point(lower), point(upper), name(material)?)))
        }
        Object::Fractal(fractal) => fractal_lines(model, index, fractal).map(Some),
        Object::Voxels(block) => Ok(voxels.line(index, block)),
    }
}

/// A box of noise with its faces; several materials stand in a list, which is named after the object's place.
fn fractal_lines(model: &Model, index: usize, fractal: &FractalBox) -> Result<String, WriteError> {
    let joined = |numbers: &[f64]| numbers.iter().copied().map(number).collect::<Vec<_>>().join(" ");
    let name = |id: &MaterialId| match model.materials.get(id.index()) {
        Some(material) => Ok(material.id.as_str()),
        None => Err(WriteError::Dangling { what: "material", index: id.index() }),
    };
    let names = fractal.materials.iter().map(name).collect::<Result<Vec<_>, _>>()?;
    let (id, mut lines) = (format!("fractal-{}", index + 1), vec![]);
    let of = match names[..] {
        [only] => only.to_owned(),
        _ => {
            lines.push(format!("#material_list: {} {id}-materials", names.join(" ")));
            format!("{id}-materials")
        }
    };
    let numbers = [&fractal.lower[..], &fractal.upper, &[fractal.dimension], &fractal.weights].concat();
    let (count, flag) = (names.len(), if fractal.averaging { "y" } else { "n" });
    lines.push(format!("#fractal_box: {} {count} {of} {id} {} {flag}", joined(&numbers), fractal.seed));
    for surface in &fractal.surfaces {
        let corners = [surface.lower, surface.upper].concat();
        let numbers = [&corners[..], &[surface.dimension], &surface.weights, &surface.range].concat();
        lines.push(format!("#add_surface_roughness: {} {id} {}", joined(&numbers), surface.seed));
        if let Some((depth, _)) = surface.water {
            lines.push(format!("#add_surface_water: {} {} {id}", joined(&corners), number(depth)));
        }
    }
    Ok(lines.join("\n"))
}

/// Refuses what gprMax would refuse, with the name of the thing.
fn check(model: &Model) -> Result<(), WriteError> {
    let named = |what: &'static str, id: &str, extra: &[char]| {
        let bad = id.is_empty() || id.contains(char::is_whitespace) || id.contains(extra);
        if bad { Err(WriteError::Identifier { what, id: id.into() }) } else { Ok(()) }
    };
    for material in model.materials.iter().skip(2).filter(|material| material.directional.is_none()) {
        named("material", &material.id, &['+'])?;
        let value = |what: &str, value: f64, allowed: bool, limit: &'static str| {
            let what = format!("the {what} of `{}`", material.id);
            if allowed { Ok(()) } else { Err(WriteError::Value { what, value, limit }) }
        };
        value(
            "relative permittivity",
            material.eps_r,
            (1.0..f64::INFINITY).contains(&material.eps_r),
            "finite and at least 1",
        )?;
        value(
            "relative permeability",
            material.mu_r,
            (1.0..f64::INFINITY).contains(&material.mu_r),
            "finite and at least 1",
        )?;
        value("conductivity", material.sigma, material.sigma >= 0.0, "0 or more")?;
        value("magnetic loss", material.sigma_magnetic, material.sigma_magnetic >= 0.0, "0 or more")?;
        let lorentz = |r: &Resonance| matches!(r, Resonance::Lorentz { .. });
        let kinds = usize::from(!material.poles.is_empty())
            + usize::from(material.resonances.iter().any(lorentz))
            + usize::from(!material.resonances.iter().all(lorentz));
        if kinds > 1 {
            return Err(WriteError::KindsOfPoles { id: material.id.clone() });
        }
        for pole in &material.poles {
            value(
                "change of permittivity",
                pole.delta_eps,
                (0.0..f64::INFINITY).contains(&pole.delta_eps),
                "finite and 0 or more",
            )?;
            value("relaxation time", pole.tau, pole.tau > 0.0 && pole.tau.is_finite(), "finite and above 0")?;
        }
    }
    model.geometry_files.iter().try_for_each(|asked| named("geometry file", &asked.file, &[]))?;
    model.geometry_views.iter().try_for_each(|asked| named("geometry view", &asked.file, &[]))?;
    model.snapshots.iter().try_for_each(|asked| named("snapshot", &asked.name, &['/']))?;
    model.waveforms.iter().try_for_each(|waveform| named("waveform", &waveform.id, &[]))?;
    model
        .receivers
        .iter()
        .filter_map(|receiver| receiver.name.as_ref())
        .try_for_each(|name| named("receiver", name, &[]))
}
