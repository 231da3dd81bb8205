//! Writing output files in the layout of gprMax 4.

use std::path::Path;

use super::super::hdf5::{Attribute, Data, Dataset, Group, to_bytes};
use super::error::OutputWriteError;
use crate::files::write_bytes;
use crate::model::{Axis, Model, Source, TimeWindow, VoltageSource};
use crate::trace::{AScan, Component, ReceiverTraces, Traces};

/// The version of gprMax whose layout is written.
pub(in super::super) const LAYOUT: &str = "4.0.1";

/// Writes traces as gprMax 4 would, so that its tools, h5py and MATLAB read them.
///
/// Samples are single or double precision as `traces.double_precision` says. Components that vanish in a two-dimensional
/// model are written as zeros, as gprMax does; others that are not in `traces` are left out. The attribute `Solver` of the
/// root names who computed them; `gprMax` is the version of the layout.
///
/// # Errors
/// When the traces are not those of the model, or the system refuses. Nothing is left half-written.
pub fn write_traces(path: &Path, traces: &Traces, model: &Model) -> Result<(), OutputWriteError> {
    write_bytes(path, &traces_to_bytes(traces, model)?)?;
    Ok(())
}

/// As [`write_traces`], but gives the bytes of the file.
///
/// # Errors
/// When the traces are not those of the model.
pub fn traces_to_bytes(traces: &Traces, model: &Model) -> Result<Vec<u8>, OutputWriteError> {
    if traces.receivers.len() != model.receivers.len() {
        let (traces, model) = (traces.receivers.len(), model.receivers.len());
        return Err(OutputWriteError::Receivers { traces, model });
    }
    let receivers =
        (0..traces.receivers.len()).map(|index| receiver(traces, model, index)).collect::<Result<_, _>>()?;
    // In gprMax's order: voltages, currents, magnetic dipoles.
    let mut order: Vec<usize> = (0..model.sources.len()).collect();
    order.sort_by_key(|&index| match &model.sources[index] {
        Source::VoltageSource(_) => 0,
        Source::HertzianDipole(_) => 1,
        Source::MagneticDipole(_) => 2,
    });
    let sources = order.iter().enumerate().map(|(place, &index)| source(traces, model, place, index));
    let sources = sources.collect::<Result<_, _>>()?;
    let steps = || Attribute::Ints32(vec![0; 3]);
    let root = Group {
        name: String::new(),
        attributes: vec![
            ("gprMax", text(LAYOUT)),
            ("Solver", text(&traces.solver)),
            ("Title", text(&traces.title)),
            ("Iterations", Attribute::Int(traces.iterations as i64)),
            ("dt", Attribute::Float(traces.time_step.si())),
            ("dx_dy_dz", Attribute::Floats(traces.spacing.map(|size| size.si()).into())),
            ("nx_ny_nz", Attribute::Ints(traces.cells.map(|count| count as i64).into())),
            ("nrx", Attribute::Int(traces.receivers.len() as i64)),
            ("nsrc", Attribute::Int(model.sources.len() as i64)),
            ("nports", Attribute::Int(0)),
            ("neigenmodeports", Attribute::Int(0)),
            ("srcsteps", steps()),
            ("rxsteps", steps()),
            ("SourceExcitationSchemaVersion", Attribute::Int(1)),
            ("ReceiverTimingSchemaVersion", Attribute::Int(1)),
            ("ReceiverOrder", text("construction")),
            ("ReceiverOrderSchemaVersion", Attribute::Int(1)),
            ("ReceiverLayout", Attribute::Text(layout(model))),
        ],
        datasets: vec![],
        groups: vec![
            Group { name: "rxs".into(), groups: receivers, ..Group::default() },
            Group { name: "srcs".into(), groups: sources, ..Group::default() },
        ],
    };
    Ok(to_bytes(&root)?)
}

fn receiver(traces: &Traces, model: &Model, index: usize) -> Result<Group, OutputWriteError> {
    let (receiver, asked) = (&traces.receivers[index], &model.receivers[index]);
    let (node, position) = on_grid(model, asked.position);
    let datasets = Component::FIELDS
        .into_iter()
        .filter_map(|component| dataset(traces, model, receiver, component).transpose())
        .collect::<Result<_, _>>()?;
    Ok(Group {
        name: format!("rx{}", index + 1),
        attributes: vec![
            ("Name", asked.name.as_deref().map_or_else(|| text(&generated("Rx", &node)), text)),
            ("NameKind", text(if asked.name.is_some() { "user" } else { "generated" })),
            ("Position", position),
            ("GridPosition", Attribute::Ints32(node)),
            ("BuildIndex", Attribute::Int(index as i64)),
        ],
        datasets,
        groups: vec![],
    })
}

/// The samples of one component; none where the traces lack it and it is not zero by symmetry.
fn dataset(
    traces: &Traces,
    model: &Model,
    receiver: &ReceiverTraces,
    component: Component,
) -> Result<Option<Dataset>, OutputWriteError> {
    let time_step = traces.time_step.si();
    let zeros;
    let (samples, first): (&[f64], f64) = match receiver.component(component) {
        Some(AScan { samples, first_sample, .. }) => (samples, first_sample.si()),
        None if vanishes(model, component) => {
            zeros = vec![0.0; traces.iterations];
            (&zeros, if component.is_magnetic() { -0.5 * time_step } else { 0.0 })
        }
        None => return Ok(None),
    };
    if samples.len() != traces.iterations {
        let (receiver, component) = (receiver.name.clone(), component.name());
        return Err(OutputWriteError::Length { receiver, component, found: samples.len(), wanted: traces.iterations });
    }
    Ok(Some(Dataset {
        name: component.name().into(),
        shape: vec![traces.iterations],
        data: data(samples, traces.double_precision),
        compressed: false,
        attributes: vec![
            ("SampleInterval", Attribute::Float(time_step)),
            ("TimeSampleOffset", Attribute::Float(first)),
            ("Quantity", text(component.name())),
        ],
    }))
}

/// Whether a component is zero everywhere in a two-dimensional model: with axis a invariant, E along the others and H along a
/// in TM, the other three in TE.
fn vanishes(model: &Model, component: Component) -> bool {
    let along = match component {
        Component::Ex | Component::Hx => Axis::X,
        Component::Ey | Component::Hy => Axis::Y,
        _ => Axis::Z,
    };
    let electric_across = model.transverse_electric.is_some();
    model.invariant_axis().is_some_and(|axis| ((axis == along.index()) == component.is_magnetic()) != electric_across)
}

fn source(traces: &Traces, model: &Model, place: usize, index: usize) -> Result<Group, OutputWriteError> {
    let source = &model.sources[index];
    let waveform = model.waveforms.get(source.waveform()).ok_or(OutputWriteError::Waveform(source.waveform()))?;
    let (node, position) = on_grid(model, source.position());
    let time_step = traces.time_step.si();
    let start = source.excitation().start;
    let end = match model.time_window {
        TimeWindow::Seconds(seconds) => seconds,
        TimeWindow::Iterations(count) => count.saturating_sub(1) as f64 * time_step,
    };
    let stop = source.excitation().stop.map_or(end, |stop| stop.min(end));
    // A current acts half a step late: on while start <= n dt <= stop, with the waveform at (n + 1/2) dt.
    let (kind, quantity, units, lattice, late) = match source {
        Source::HertzianDipole(_) => ("HertzianDipole", "electric_current", "A", "electric_half_step", 0.5),
        Source::MagneticDipole(_) => ("MagneticDipole", "magnetic_dipole_waveform", "", "magnetic_whole_step", 0.0),
        Source::VoltageSource(VoltageSource { resistance: 0.0, .. }) => {
            ("VoltageSource", "imposed_gap_voltage", "V", "electric", 0.0)
        }
        Source::VoltageSource(_) => ("VoltageSource", "generator_voltage", "V", "electric_half_step", 0.5),
    };
    let current = |step: usize| {
        let time = step as f64 * time_step;
        let on = (start..=stop).contains(&time);
        if on { waveform.sample(time + late * time_step - start, time_step) } else { 0.0 }
    };
    let samples: Vec<f64> = (0..traces.iterations).map(current).collect();
    let polarisation = || text(source.polarisation().name());
    let scale = match source {
        Source::HertzianDipole(_) => vec![
            ("SpatialScale", Attribute::Float(model.grid.spacing[source.polarisation().index()])),
            ("SpatialScaleQuantity", text("dipole_length")),
            ("SpatialScaleUnits", text("m")),
        ],
        Source::MagneticDipole(_) => vec![("SpatialScale", Attribute::Float(1.0))],
        Source::VoltageSource(VoltageSource { resistance, .. }) => {
            vec![("SpatialScale", Attribute::Float(1.0)), ("Resistance", Attribute::Float(*resistance))]
        }
    };
    let excitation = Group {
        name: "excitation".into(),
        attributes: vec![
            ("SchemaVersion", Attribute::Int(1)),
            ("SourceType", text(kind)),
            ("DrivingQuantity", text(quantity)),
            ("Units", text(units)),
            ("Polarisation", polarisation()),
            ("SampleInterval", Attribute::Float(time_step)),
            ("TimeSampleOffset", Attribute::Float(late * time_step)),
            ("WaveformEvaluationTimeOffset", Attribute::Float(late * time_step)),
            ("UpdateLattice", text(lattice)),
            ("SourceStartTime", Attribute::Float(start)),
            ("SourceStopTime", Attribute::Float(stop)),
            ("WaveformID", text(&waveform.id)),
            ("WaveformType", text(waveform.kind.name())),
            ("WaveformAmplitude", Attribute::Float(waveform.amplitude)),
            ("WaveformFrequency", Attribute::Float(waveform.frequency)),
        ]
        .into_iter()
        .chain(scale)
        .collect(),
        datasets: vec![Dataset {
            name: "samples".into(),
            shape: vec![samples.len()],
            data: data(&samples, traces.double_precision),
            compressed: true,
            attributes: vec![("SampleCount", Attribute::Int(samples.len() as i64))],
        }],
        groups: vec![],
    };
    Ok(Group {
        name: format!("src{}", place + 1),
        attributes: vec![
            ("Type", text(kind)),
            ("ID", text(&generated(kind, &node))),
            ("Polarisation", polarisation()),
            ("Position", position),
            ("GridPosition", Attribute::Ints32(node)),
        ],
        datasets: vec![],
        groups: vec![excitation],
    })
}

/// Node of a position, and where that node lies.
fn on_grid(model: &Model, position: [f64; 3]) -> (Vec<i32>, Attribute) {
    let node: [i64; 3] = std::array::from_fn(|axis| model.grid.node(axis, position[axis]));
    let snapped = (0..3).map(|axis| node[axis] as f64 * model.grid.spacing[axis]).collect();
    (node.map(|index| index as i32).into(), Attribute::Floats(snapped))
}

pub(in super::super) fn generated(kind: &str, node: &[i32]) -> String {
    format!("{kind}({})", node.iter().map(i32::to_string).collect::<Vec<_>>().join(","))
}

/// A text that is equal for models with the same receivers in the same order, wherever these stand: gprMax's tools use it to
/// tell which receivers of several files belong together.
fn layout(model: &Model) -> String {
    let names: Vec<_> = model.receivers.iter().map(|receiver| receiver.name.as_deref().unwrap_or("")).collect();
    format!("ballast-gpr receivers: {names:?}")
}

fn data(samples: &[f64], double_precision: bool) -> Data {
    if double_precision { Data::F64(samples.into()) } else { Data::F32(samples.iter().map(|&v| v as f32).collect()) }
}

fn text(text: &str) -> Attribute {
    Attribute::Text(text.into())
}
