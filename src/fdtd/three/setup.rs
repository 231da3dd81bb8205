//! A three-dimensional model checked and turned into numbers, before anything of its size is allocated.

use std::borrow::Cow;

use super::super::FdtdError;
use super::super::coefficients::{Edge, check_electric, check_resonances, edge_of};
use super::super::setup::node_in_grid;
use super::super::slab::Slab;
use super::camera::Look;
use super::couple::Couple;
use super::drive::{Drive, Load, drives, loads};
use super::fourth;
use crate::model::{
    Axis, FaceMaterial, Indices, Model, Order, Painted3, available_memory, check_absorbing_cells, check_grid,
    check_mode, check_recording, check_stability_factor,
};
use crate::units::constants::{MU_0, Z0};

/// The two other axes of a component, in cyclic order.
pub const OTHERS: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];

/// All that the planes are built from.
pub struct Setup3<'a> {
    pub painted: Cow<'a, Painted3>,
    pub edges: Vec<Edge>,
    kinds: Kinds,
    /// `da`, `db` of each entry of the face palette.
    pub faces: Vec<[f64; 2]>,
    /// At x0, y0, z0, xmax, ymax, zmax.
    pub slabs: [Slab; 6],
    pub drives: Vec<Drive>,
    /// What couples the axes on surfaces, in the order of the nodes.
    pub couples: Vec<Couple>,
    /// Edges with resistors across them.
    pub loads: Vec<Load>,
    /// Node of each receiver.
    pub receivers: Vec<[usize; 3]>,
    /// Snapshots, in the order of their steps.
    pub looks: Vec<Look>,
    pub order: Order,
    pub iterations: usize,
    pub dt: f64,
    pub spacing: [f64; 3],
    pub active: Active,
}

/// Which components a model has, and in which rows of a plane.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Active {
    /// Ex, Ey, Ez.
    pub e: [bool; 3],
    /// Hx, Hy, Hz.
    pub h: [bool; 3],
    /// Rows of each plane.
    pub rows: std::ops::Range<usize>,
}

impl Active {
    /// All six, or the three of TM and TE; a plane of a two-dimensional model that is invariant along y has one row.
    pub fn of(model: &Model) -> Self {
        let rows = 0..model.grid.cells[1];
        let Some(invariant) = model.invariant_axis() else { return Self { e: [true; 3], h: [true; 3], rows } };
        let along = std::array::from_fn(|axis| axis == invariant);
        let across = std::array::from_fn(|axis| axis != invariant);
        match model.transverse_electric {
            None => Self { e: along, h: across, rows },
            Some(Axis::Y) => Self { e: across, h: along, rows: 1..2 },
            Some(_) => Self { e: across, h: along, rows },
        }
    }
}

/// What kinds of edges there are.
#[derive(Debug, Clone, Copy)]
struct Kinds {
    /// Some conduct.
    lossy: bool,
    /// Some relax or resonate.
    remember: bool,
}

impl<'a> Setup3<'a> {
    /// Checks a model and settles its numbers.
    ///
    /// # Errors
    /// Whatever the solver cannot do, naming it.
    pub fn new(model: &Model, painted: Cow<'a, Painted3>) -> Result<Self, FdtdError> {
        check_model(model)?;
        let present = model.acting(painted.cells_per_material(model.materials.len()));
        for (material, _) in model.materials.iter().zip(present).filter(|(_, cells)| *cells > 0) {
            check_electric(material)?;
            check_resonances(material, model.time_step())?;
        }
        let mut edges: Vec<Edge> = painted.palette.iter().map(|entry| edge_of(model, entry)).collect();
        let loads = loads(model, &painted, &mut edges)?;
        let dt = model.time_step();
        let face = |face: &FaceMaterial| {
            let (storage, loss) = (MU_0 * face.mu_r / dt, face.sigma_magnetic / 2.0);
            [(storage - loss) / (storage + loss), MU_0 / dt / (storage + loss)]
        };
        let faces: Vec<[f64; 2]> = painted.face_palette.iter().map(face).collect();
        // Asked for every row; true shapes make a palette of a million entries.
        let kinds = Kinds { lossy: edges.iter().any(Edge::is_lossy), remember: edges.iter().any(|e| e.memories() > 0) };
        let edge = |axis, place| &edges[entry(&painted, &loads, axis, place)];
        let db = |axis: usize, place| {
            if faces.is_empty() { 1.0 } else { faces[painted.faces[axis].get(place) as usize][1] }
        };
        let drives = drives(model, &painted, edge, db)?;
        let receivers = model.receivers.iter().enumerate();
        let receivers = receivers.map(|(index, receiver)| {
            node_in_grid(model, receiver.position, || {
                receiver.name.clone().unwrap_or(format!("receiver {}", index + 1))
            })
        });
        let mut setup = Self {
            couples: vec![],
            drives,
            loads,
            receivers: receivers.collect::<Result<_, _>>()?,
            looks: Look::all(model)?,
            faces,
            slabs: slabs(model, &painted)?,
            painted,
            edges,
            kinds,
            order: model.order,
            iterations: model.iterations(),
            dt,
            spacing: model.grid.spacing,
            active: Active::of(model),
        };
        setup.couples = Couple::all(&setup);
        match fourth::refusal(model, &setup) {
            Some(what) if model.order == Order::Fourth => Err(FdtdError::OrderInThree { order: model.order, what }),
            _ => Ok(setup),
        }
    }

    /// The nodes that sources act on, each with the first step at which it does.
    pub fn begins(&self) -> impl Iterator<Item = ([usize; 3], usize)> {
        let begin = |drive: &Drive| {
            let at_once = drive.initial.is_some_and(|v| v != 0.0).then_some(0);
            Some((drive.node, at_once.or_else(|| drive.series.iter().position(|&v| v != 0.0))?))
        };
        self.drives.iter().filter_map(begin)
    }

    /// By how many cells E moves in one step: see `reach`.
    pub fn pace(&self) -> i32 {
        // Between edges whose axes are coupled lies one cell more.
        if self.couples.is_empty() { 1 } else { 2 }
    }

    /// Frees the lists of cells, edges and faces where nobody else holds them: once the planes are built, nothing needs them.
    pub fn forget_painting(&mut self) {
        if let Cow::Owned(painted) = &mut self.painted {
            let none = || std::array::from_fn(|_| Indices::with_capacity(0));
            (painted.solid, painted.edges, painted.faces) = (vec![], none(), none());
            painted.couplings = vec![];
        }
        self.couples = vec![];
    }

    /// Index into `edges` of the edge along an axis from the node at a place in the list of edges.
    #[inline]
    pub fn entry(&self, axis: usize, place: usize) -> usize {
        entry(&self.painted, &self.loads, axis, place)
    }

    /// Whether any edge conducts.
    pub fn lossy(&self) -> bool {
        self.kinds.lossy
    }

    /// Whether any edge relaxes or resonates.
    pub fn remembers(&self) -> bool {
        self.kinds.remember
    }

    /// Whether anything is magnetic.
    pub fn magnetic(&self) -> bool {
        !self.faces.is_empty()
    }

    /// `dt d/(mu0 A)` along each axis: turns the scaled H of a component into a current along its axis, A.
    fn current(&self) -> [f64; 3] {
        let d = self.spacing;
        std::array::from_fn(|axis| {
            let [a, b] = OTHERS[axis];
            self.dt * d[axis] / (MU_0 * d[a] * d[b])
        })
    }

    /// Factors that turn the scaled fields into V/m and A/m: Ex, Ey, Ez, Hx, Hy, Hz.
    pub fn scale(&self) -> [f64; 6] {
        let (d, current) = (self.spacing, self.current());
        std::array::from_fn(|f| if f < 3 { 1.0 / d[f] } else { current[f - 3] / d[f - 3] })
    }

    /// `ca` and `cb` of an entry of the palette for the edges along an axis.
    pub fn coefficients(&self, axis: usize, entry: usize) -> [f64; 2] {
        let edge = &self.edges[entry];
        [edge.ca, self.scale_of_curl(axis, edge.source)]
    }

    /// What takes the scaled curl along an axis where a unit of current density takes `source` from E.
    pub fn scale_of_curl(&self, axis: usize, source: f64) -> f64 {
        let ([a, b], d) = (OTHERS[axis], self.spacing);
        source * d[axis] / (d[a] * d[b]) * self.current()[b]
    }

    /// What the second difference of the curl is multiplied by, for the edges along an axis.
    pub fn ratio(&self, axis: usize) -> f64 {
        let ([a, b], current) = (OTHERS[axis], self.current());
        current[a] / current[b]
    }

    /// A scaled field that no sound run reaches: 10⁸ times what all sources together put in at one step.
    pub fn limit(&self) -> f64 {
        let strongest = |drive: &Drive| drive.series.iter().fold(0.0f64, |peak, v| peak.max(v.abs()));
        match self.drives.iter().map(strongest).sum::<f64>() {
            0.0 => f64::from(f32::MAX),
            sum => (1e8 * sum).min(f64::from(f32::MAX)),
        }
    }

    /// Whether E along an axis lies on the outer wall at a node (or beyond the last edge of its axis).
    pub fn on_wall(&self, axis: usize, node: [usize; 3]) -> bool {
        on_wall(self.painted.cells, axis, node)
    }
}

#[inline]
fn entry(painted: &Painted3, loads: &[Load], axis: usize, place: usize) -> usize {
    let load = loads.iter().find(|load| load.place == place && load.axis == axis);
    load.map_or_else(|| painted.edges[axis].get(place) as usize, |load| load.entry)
}

/// Whether E along an axis lies on the outer wall at a node (or beyond the last edge of its axis).
pub fn on_wall(cells: [usize; 3], axis: usize, node: [usize; 3]) -> bool {
    (0..3).any(|a| if a == axis { node[a] >= cells[a] } else { node[a] == 0 || node[a] >= cells[a] })
}

/// The checks that need no painting.
///
/// # Errors
/// A grid, a time step or absorbing cells that cannot be, samples beyond the memory.
pub fn check_model(model: &Model) -> Result<(), FdtdError> {
    check_stability_factor(model)?;
    check_grid(&model.grid)?;
    check_recording(model, available_memory())?;
    check_mode(model)?;
    Ok(check_absorbing_cells(model)?)
}

/// The absorbing slabs at x0, y0, z0, xmax, ymax, zmax.
///
/// `sigma_max = 0.8 * 5/(Z0 d sqrt(eps_r mu_r))`, both being the mean over the layer of absorbing cells next to the
/// slab's entrance, rims and conductors (as `eps_r` 1) included.
///
/// # Errors
/// See [`Slab::new`].
fn slabs(model: &Model, painted: &Painted3) -> Result<[Slab; 6], FdtdError> {
    let absorbing = model.absorbing_cells();
    let n = painted.cells;
    let mut slabs = [Slab::none(); 6];
    for (side, slab) in slabs.iter_mut().enumerate().filter(|(side, _)| absorbing[*side] > 0) {
        let (axis, cells) = (side % 3, absorbing[side]);
        let layer = if side < 3 { cells - 1 } else { n[axis] - cells };
        let [a, b] = OTHERS[axis];
        let (mut eps_r, mut mu_r) = (0.0, 0.0);
        for p in 0..n[a] {
            for q in 0..n[b] {
                let mut at = [layer; 3];
                (at[a], at[b]) = (p, q);
                let material = &model.materials[painted.solid[(at[0] * n[1] + at[1]) * n[2] + at[2]].index()];
                eps_r += material.eps_r;
                mu_r += material.mu_r;
            }
        }
        let count = (n[a] * n[b]) as f64;
        let (eps_r, mu_r) = (eps_r / count, mu_r / count);
        let matched = 0.8 / (Z0 * model.grid.spacing[axis] * (eps_r * mu_r).sqrt());
        *slab = Slab::new(&model.absorbing_profile, cells, matched, model.time_step())?;
    }
    Ok(slabs)
}

/// The axis with an index.
pub fn axis_of(index: usize) -> Axis {
    [Axis::X, Axis::Y, Axis::Z][index]
}
