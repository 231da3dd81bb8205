//! The sources of a three-dimensional model, as tables of what they do to one component at each step.

use std::ops::Range;

use super::super::FdtdError;
use super::super::coefficients::{Edge, edge_of};
use super::super::setup::node_in_grid;
use super::setup::{Active, OTHERS, axis_of, on_wall};
use crate::model::{EdgeMaterial, Model, Painted3, Source, VoltageSource};

/// What a source does to its component.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Act {
    /// Takes from E after its step.
    TakeE,
    /// Sets E after its step, whatever the fields around it are.
    SetE,
    /// Takes from H after its step.
    TakeH,
}

/// A source at a node.
#[derive(Debug, Clone)]
pub struct Drive {
    pub act: Act,
    pub axis: usize,
    pub node: [usize; 3],
    /// What it takes from the scaled field at each step, or sets it to, V.
    pub series: Vec<f64>,
    /// Steps at which it acts; the series is zero at all others.
    pub on: Range<usize>,
    /// What it sets the scaled E to before the first step, V.
    pub initial: Option<f64>,
}

/// An edge with a resistor across it, which makes it a material of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Load {
    pub axis: usize,
    /// Place of the node in the list of edges.
    pub place: usize,
    /// Its entry, behind those of the palette.
    pub entry: usize,
}

/// The edges that resistive voltage sources lie on; adds the entry of each to `edges`.
///
/// `sigma` rises by `d/(R A)`, `d` being the length of the edge and `A` the area across it; several sources on one edge add up.
///
/// # Errors
/// A source outside the grid, or with a resistance that is none.
pub fn loads(model: &Model, painted: &Painted3, edges: &mut Vec<Edge>) -> Result<Vec<Load>, FdtdError> {
    let mut materials: Vec<(Load, EdgeMaterial)> = vec![];
    for (index, source) in model.sources.iter().enumerate() {
        let Source::VoltageSource(VoltageSource { polarisation, resistance, position, .. }) = source else { continue };
        let number = index + 1;
        if !(*resistance >= 0.0 && resistance.is_finite()) {
            return Err(FdtdError::Resistance { number, resistance: *resistance });
        }
        let axis = polarisation.index();
        let node = node_in_grid(model, *position, || format!("source {number}"))?;
        if *resistance == 0.0 || on_wall(painted.cells, axis, node) {
            continue;
        }
        let ([a, b], d, place) = (OTHERS[axis], model.grid.spacing, painted.node(node));
        let sigma = d[axis] / (resistance * d[a] * d[b]);
        if let Some((_, material)) = materials.iter_mut().find(|(load, _)| (load.axis, load.place) == (axis, place)) {
            material.sigma += sigma;
            continue;
        }
        let mut material = *painted.edge(axis, node);
        material.sigma += sigma;
        materials.push((Load { axis, place, entry: edges.len() + materials.len() }, material));
    }
    edges.extend(materials.iter().map(|(_, material)| edge_of(model, material)));
    Ok(materials.into_iter().map(|(load, _)| load).collect())
}

/// The sources in the order in which they act: voltages first, then dipoles, each in the order of the model.
///
/// `edge` gives what lies on an edge, resistors included, and `db` what takes the curl of E on a face.
///
/// # Errors
/// Sources that cannot act where they are.
pub fn drives<'a>(
    model: &Model,
    painted: &Painted3,
    edge: impl Fn(usize, usize) -> &'a Edge,
    db: impl Fn(usize, usize) -> f64,
) -> Result<Vec<Drive>, FdtdError> {
    let mut drives = vec![];
    for (index, source) in model.sources.iter().enumerate() {
        drives.push(drive(model, painted, &edge, &db, index + 1, source)?);
    }
    let mut order: Vec<_> = model.sources.iter().zip(drives).collect();
    order.sort_by_key(|(source, _)| !matches!(source, Source::VoltageSource(_)));
    Ok(order.into_iter().map(|(_, drive)| drive).collect())
}

fn drive<'a>(
    model: &Model,
    painted: &Painted3,
    edge: &impl Fn(usize, usize) -> &'a Edge,
    db: &impl Fn(usize, usize) -> f64,
    number: usize,
    source: &Source,
) -> Result<Drive, FdtdError> {
    let node = node_in_grid(model, source.position(), || format!("source {number}"))?;
    let (axis, place, n) = (source.polarisation().index(), painted.node(node), painted.cells);
    let (dt, d, excitation) = (model.time_step(), model.grid.spacing, source.excitation());
    let magnetic = matches!(source, Source::MagneticDipole(_));
    if let Some(invariant) = model.invariant_axis() {
        let (mode, active) = (if model.transverse_electric.is_some() { "TE" } else { "TM" }, Active::of(model));
        if !(if magnetic { active.h } else { active.e })[axis] {
            let (axis, invariant) = (source.polarisation(), axis_of(invariant));
            return Err(FdtdError::Across { number, axis, invariant, mode });
        }
        if model.transverse_electric.is_some() && node[invariant] != 1 {
            return Err(FdtdError::BetweenWalls { number, axis: axis_of(invariant), node: node[invariant] });
        }
    }
    let waveforms = model.waveforms.len();
    let waveform = model.waveforms.get(source.waveform());
    let waveform = waveform.ok_or(FdtdError::NoSuchWaveform { number, waveform: source.waveform(), waveforms })?;
    let sample = |t: f64| waveform.sample(t - excitation.start, dt);
    if magnetic {
        if (0..3).any(|a| node[a] >= n[a]) || node[axis] == 0 {
            return Err(FdtdError::MagneticOnWall { number, axis: source.polarisation(), node });
        }
    } else if on_wall(n, axis, node) {
        return Err(FdtdError::OnWall { number, axis: source.polarisation(), node });
    } else if edge(axis, place).source == 0.0 {
        return Err(FdtdError::InConductor { number, node });
    }
    // A current of 1 A over one edge: dl/(dx dy dz), and once more dl to make a voltage of E.
    let moment = || edge(axis, place).source * d[axis] * d[axis] / (d[0] * d[1] * d[2]);
    // Where and when in a step a source acts, the times at which its waveform is taken, and what of it is taken. All found
    // by running gprMax: with these the traces agree to 1e-14, half a step off they differ by 7 %.
    let (act, is_on_after, sampled_after, factor) = match source {
        Source::HertzianDipole(_) => (Act::TakeE, 0.0, 0.5, moment()),
        Source::MagneticDipole(_) => (Act::TakeH, 0.0, 0.0, db(axis, place) / d[axis]),
        Source::VoltageSource(VoltageSource { resistance: 0.0, .. }) => (Act::SetE, 1.0, 1.0, -1.0),
        Source::VoltageSource(VoltageSource { resistance, .. }) => (Act::TakeE, 0.0, 0.5, moment() / resistance),
    };
    // Relaxation acts on E after the sources.
    if act == Act::SetE && !edge(axis, place).poles.is_empty() {
        return Err(FdtdError::SetInDispersive { number, node });
    }
    let is_on = |n: usize| excitation.is_on((n as f64 + is_on_after) * dt);
    let value = |n: usize| if is_on(n) { factor * sample((n as f64 + sampled_after) * dt) } else { 0.0 };
    let steps = model.iterations();
    let first = (0..steps).find(|&n| is_on(n)).unwrap_or(steps);
    let end = (first..steps).find(|&n| !is_on(n)).unwrap_or(steps);
    let initial = (act == Act::SetE && excitation.is_on(0.0)).then(|| factor * sample(0.0));
    Ok(Drive { act, axis, node, series: (0..steps).map(value).collect(), on: first..end, initial })
}
