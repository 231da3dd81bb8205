//! A model checked and turned into numbers, before anything of its size is allocated.

use super::FdtdError;
use super::coefficients::{Edge, edges, slabs};
use super::slab::Slab;
use crate::model::{
    Axis, Model, Order, Painted, Source, available_memory, check_absorbing_cells, check_recording,
    check_stability_factor, check_two_dimensional,
};
use crate::units::constants::MU_0;

/// All that the blocks are built from.
#[derive(Clone)]
pub struct Setup<'a> {
    pub painted: &'a Painted,
    pub edges: Vec<Edge>,
    /// At x0, y0, xmax, ymax.
    pub slabs: [Slab; 4],
    pub drives: Vec<NodeDrive>,
    /// Node of each receiver.
    pub receivers: Vec<[usize; 3]>,
    pub order: Order,
    pub iterations: usize,
    pub dt: f64,
    pub spacing: [f64; 3],
}

/// A source at a node.
#[derive(Clone)]
pub struct NodeDrive {
    pub i: usize,
    pub j: usize,
    /// What it takes from E at each step, V/m.
    pub series: Vec<f64>,
}

impl<'a> Setup<'a> {
    /// Checks a model and settles its numbers.
    ///
    /// # Errors
    /// Whatever the solver cannot do, naming it.
    pub fn new(model: &Model, painted: &'a Painted) -> Result<Self, FdtdError> {
        check_model(model)?;
        let edges = edges(model, painted)?;
        let drives = model.sources.iter().enumerate();
        let drives = drives.map(|(index, source)| drive(model, painted, &edges, index + 1, source));
        let receivers = model.receivers.iter().enumerate();
        let receivers = receivers.map(|(index, receiver)| {
            node_in_grid(model, receiver.position, || {
                receiver.name.clone().unwrap_or(format!("receiver {}", index + 1))
            })
        });
        Ok(Self {
            drives: drives.collect::<Result<_, _>>()?,
            receivers: receivers.collect::<Result<_, _>>()?,
            painted,
            slabs: slabs(model, painted)?,
            edges,
            order: model.order,
            iterations: model.iterations(),
            dt: model.time_step(),
            spacing: model.grid.spacing,
        })
    }

    /// Takes so many samples in place of those that the model asks for; sources that have come to their end stay silent.
    pub fn set_iterations(&mut self, iterations: usize) {
        self.iterations = iterations;
        self.drives.iter_mut().for_each(|drive| drive.series.resize(iterations, 0.0));
    }

    /// Whether any edge conducts.
    pub fn lossy(&self) -> bool {
        self.edges.iter().any(Edge::is_lossy)
    }

    /// `dx²/dy²`
    pub fn ratio(&self) -> f64 {
        (self.spacing[0] / self.spacing[1]).powi(2)
    }

    /// Factors that turn the scaled Hx and Hy into A/m.
    pub fn magnetic_scale(&self) -> [f64; 2] {
        [self.dt / (MU_0 * self.spacing[1]), self.dt / (MU_0 * self.spacing[0])]
    }

    /// A field that no sound run reaches: 10⁸ times what all sources together put in at one step.
    pub fn limit(&self) -> f64 {
        let strongest = |drive: &NodeDrive| drive.series.iter().fold(0.0f64, |peak, v| peak.max(v.abs()));
        match self.drives.iter().map(strongest).sum::<f64>() {
            0.0 => f64::from(f32::MAX),
            sum => (1e8 * sum).min(f64::from(f32::MAX)),
        }
    }
}

/// The checks that need no painting.
///
/// # Errors
/// A grid, a time step or absorbing cells that cannot be, samples beyond the memory.
pub fn check_model(model: &Model) -> Result<(), FdtdError> {
    check_stability_factor(model)?;
    check_two_dimensional(model)?;
    check_recording(model, available_memory())?;
    Ok(check_absorbing_cells(model)?)
}

/// Node of a position, if it lies in the grid.
pub fn node_in_grid(model: &Model, position: [f64; 3], name: impl Fn() -> String) -> Result<[usize; 3], FdtdError> {
    let grid = &model.grid;
    let node: [i64; 3] = std::array::from_fn(|axis| grid.node(axis, position[axis]));
    for (axis, of) in [Axis::X, Axis::Y, Axis::Z].into_iter().enumerate() {
        if !(0..=grid.cells[axis] as i64).contains(&node[axis]) {
            let size = grid.cells[axis] as f64 * grid.spacing[axis];
            return Err(FdtdError::OutsideGrid { what: name(), axis: of, position: position[axis], size });
        }
    }
    Ok(node.map(|index| index as usize))
}

fn drive(
    model: &Model,
    painted: &Painted,
    edges: &[Edge],
    number: usize,
    source: &Source,
) -> Result<NodeDrive, FdtdError> {
    let Source::HertzianDipole(dipole) = source else {
        return Err(FdtdError::NotInPlane { number, kind: source.kind() });
    };
    let [i, j, _] = node_in_grid(model, dipole.position, || format!("source {number}"))?;
    if dipole.polarisation != Axis::Z {
        return Err(FdtdError::Polarisation { number, axis: dipole.polarisation });
    }
    let [nx, ny] = painted.cells_xy;
    if i == 0 || j == 0 || i == nx || j == ny {
        return Err(FdtdError::SourceOnWall { number, i, j });
    }
    let edge = &edges[painted.edge_z[i * (ny + 1) + j] as usize];
    if edge.cb == 0.0 {
        return Err(FdtdError::SourceInConductor { number, i, j });
    }
    let waveforms = model.waveforms.len();
    let waveform = model.waveforms.get(dipole.waveform);
    let waveform = waveform.ok_or(FdtdError::NoSuchWaveform { number, waveform: dipole.waveform, waveforms })?;
    let (dt, [dx, dy, _]) = (model.time_step(), model.grid.spacing);
    let excitation = dipole.excitation;
    let series = (0..model.iterations()).map(|n| {
        let t = n as f64 * dt;
        if !excitation.is_on(t) {
            return 0.0;
        }
        // A line current of 1 A: dl/(dx dy dz) with dl = dz.
        edge.source * waveform.sample(t + 0.5 * dt - excitation.start, dt) / (dx * dy)
    });
    Ok(NodeDrive { i, j, series: series.collect() })
}
