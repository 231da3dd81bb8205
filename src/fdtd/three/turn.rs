//! Turning a two-dimensional model so that its invariant axis is y.
//!
//! Rows run along z and are contiguous, planes lie across x and are shared out among threads: a model whose invariant axis is
//! y has long rows and many planes, one or two rows in each. The axes move in cyclic order, so that no sign changes.

use super::super::FdtdError;
use crate::model::{Axis, Coupling, Grid, Model, Painted3, Receiver, Snapshot, SnapshotError, Source};
use crate::trace::{Component, FieldSnapshot, Traces};
use crate::units::Metres;

/// How many places each axis moves on in cyclic order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Turn(usize);

impl Turn {
    /// What makes y the invariant axis; `None` where it is, or where there is none.
    pub fn of(model: &Model) -> Option<Self> {
        let invariant = model.invariant_axis()?;
        (invariant != 1).then(|| Self((4 - invariant) % 3))
    }

    fn back(self) -> Self {
        Self((3 - self.0) % 3)
    }

    fn axis(self, axis: usize) -> usize {
        (axis + self.0) % 3
    }

    /// One value per axis.
    fn triple<T: Copy>(self, values: [T; 3]) -> [T; 3] {
        std::array::from_fn(|axis| values[self.back().axis(axis)])
    }

    fn direction(self, axis: Axis) -> Axis {
        [Axis::X, Axis::Y, Axis::Z][self.axis(axis.index())]
    }

    /// The model turned, without its objects, which have been painted.
    pub fn model(self, model: &Model) -> Model {
        let source = |source: &Source| {
            let mut source = source.clone();
            *source.polarisation_mut() = self.direction(source.polarisation());
            *source.position_mut() = self.triple(source.position());
            source
        };
        let receiver =
            |receiver: &Receiver| Receiver { position: self.triple(receiver.position), name: receiver.name.clone() };
        let snapshot = |asked: &Snapshot| Snapshot {
            lower: self.triple(asked.lower),
            upper: self.triple(asked.upper),
            spacing: self.triple(asked.spacing),
            ..asked.clone()
        };
        let sides = |[x0, y0, z0, x1, y1, z1]: [usize; 6]| {
            let ([x0, y0, z0], [x1, y1, z1]) = (self.triple([x0, y0, z0]), self.triple([x1, y1, z1]));
            [x0, y0, z0, x1, y1, z1]
        };
        Model {
            title: model.title.clone(),
            grid: Grid { cells: self.triple(model.grid.cells), spacing: self.triple(model.grid.spacing) },
            transverse_electric: model.transverse_electric.map(|axis| self.direction(axis)),
            stability_factor: model.stability_factor,
            order: model.order,
            averaging: model.averaging,
            time_window: model.time_window,
            pml_cells: model.pml_cells.map(sides),
            absorbing_profile: model.absorbing_profile.clone(),
            threads: model.threads,
            materials: model.materials.clone(),
            dispersive_averaging: model.dispersive_averaging,
            magnetic_averaging: model.magnetic_averaging,
            waveforms: model.waveforms.clone(),
            objects: vec![],
            sources: model.sources.iter().map(source).collect(),
            receivers: model.receivers.iter().map(receiver).collect(),
            source_steps: self.triple(model.source_steps),
            receiver_steps: self.triple(model.receiver_steps),
            geometry_files: vec![],
            geometry_views: vec![],
            snapshots: model.snapshots.iter().map(snapshot).collect(),
        }
    }

    /// The painted grid turned.
    pub fn painted(self, painted: &Painted3) -> Painted3 {
        let cells = self.triple(painted.cells);
        let [nx, ny, nz] = cells;
        let mut solid = Vec::with_capacity(painted.solid.len());
        let [_, my, mz] = painted.cells;
        let mut nodes = Vec::with_capacity((nx + 1) * (ny + 1) * (nz + 1));
        for i in 0..=nx {
            for j in 0..=ny {
                for k in 0..=nz {
                    let from @ [a, b, c] = self.back().triple([i, j, k]);
                    nodes.push(painted.node(from));
                    if i < nx && j < ny && k < nz {
                        solid.push(painted.solid[(a * my + b) * mz + c]);
                    }
                }
            }
        }
        let of = |axis: usize| self.back().axis(axis);
        let [_, py, pz] = painted.cells.map(|count| count + 1);
        let couple = |coupling: &Coupling| {
            let [i, j, k] = self.triple([coupling.node / (py * pz), coupling.node / pz % py, coupling.node % pz]);
            Coupling { node: (i * (ny + 1) + j) * (nz + 1) + k, inverse: self.triple(coupling.inverse) }
        };
        let mut couplings: Vec<Coupling> = painted.couplings.iter().map(couple).collect();
        couplings.sort_unstable_by_key(|coupling| coupling.node);
        Painted3 {
            cells,
            solid,
            palette: painted.palette.clone(),
            edges: std::array::from_fn(|axis| painted.edges[of(axis)].picked(&nodes)),
            face_palette: painted.face_palette.clone(),
            faces: std::array::from_fn(|axis| painted.faces[of(axis)].picked(&nodes)),
            averaged_edges: self.triple(painted.averaged_edges),
            couplings,
        }
    }

    /// Traces of a turned model, as those of the model.
    pub fn traces_back(self, model: &Model, mut traces: Traces) -> Traces {
        traces.cells = model.grid.cells;
        traces.spacing = model.grid.spacing.map(Metres);
        for (receiver, wanted) in traces.receivers.iter_mut().zip(&model.receivers) {
            let position = self.back().triple(receiver.position);
            let node: [i64; 3] = std::array::from_fn(|axis| model.grid.node(axis, position[axis].si()));
            let name = wanted.name.clone().unwrap_or_else(|| format!("Rx({},{},{})", node[0], node[1], node[2]));
            receiver.position = position;
            receiver.name.clone_from(&name);
            for scan in &mut receiver.components {
                let field = Component::FIELDS.iter().position(|&component| component == scan.component);
                if let Some(field) = field {
                    scan.component = Component::FIELDS[field / 3 * 3 + self.back().axis(field % 3)];
                }
                scan.position = Some(position);
                scan.name.clone_from(&name);
            }
            let order = |component: Component| Component::FIELDS.iter().position(|&known| known == component);
            receiver.components.sort_by_key(|scan| order(scan.component));
        }
        traces
    }

    /// A snapshot of a turned model, as one of the model.
    pub fn snapshot_back(self, snapshot: FieldSnapshot) -> FieldSnapshot {
        let back = self.back();
        let shape = back.triple(snapshot.shape);
        let [_, ny, nz] = snapshot.shape;
        let places = || {
            let rows = (0..shape[0]).flat_map(move |i| (0..shape[1]).map(move |j| [i, j]));
            rows.flat_map(move |[i, j]| {
                (0..shape[2]).map(move |k| {
                    let [a, b, c] = self.triple([i, j, k]);
                    (a * ny + b) * nz + c
                })
            })
        };
        FieldSnapshot {
            origin: back.triple(snapshot.origin),
            spacing: back.triple(snapshot.spacing),
            shape,
            fields: std::array::from_fn(|field| snapshot.fields[field / 3 * 3 + self.axis(field % 3)].picked(places())),
            ..snapshot
        }
    }

    /// An error about a turned model, as one about the model.
    pub fn error_back(self, error: FdtdError) -> FdtdError {
        let (axis, triple) = (|axis| self.back().direction(axis), |node| self.back().triple(node));
        match error {
            FdtdError::OnWall { number, axis: of, node } => {
                FdtdError::OnWall { number, axis: axis(of), node: triple(node) }
            }
            FdtdError::MagneticOnWall { number, axis: of, node } => {
                FdtdError::MagneticOnWall { number, axis: axis(of), node: triple(node) }
            }
            FdtdError::SetInDispersive { number, node } => FdtdError::SetInDispersive { number, node: triple(node) },
            FdtdError::InConductor { number, node } => FdtdError::InConductor { number, node: triple(node) },
            FdtdError::Across { number, axis: of, invariant, mode } => {
                FdtdError::Across { number, axis: axis(of), invariant: axis(invariant), mode }
            }
            FdtdError::BetweenWalls { number, axis: of, node } => {
                FdtdError::BetweenWalls { number, axis: axis(of), node }
            }
            FdtdError::OutsideGrid { what, axis: of, position, size } => {
                FdtdError::OutsideGrid { what, axis: axis(of), position, size }
            }
            FdtdError::DivergedAt { step, axis: of, node, position, value } => FdtdError::DivergedAt {
                step,
                axis: axis(of),
                node: triple(node),
                position: self.back().triple(position),
                value,
            },
            FdtdError::NoSnapshot(error) => FdtdError::NoSnapshot(match error {
                SnapshotError::Extent { name, axis: of, lower, upper, size } => {
                    SnapshotError::Extent { name, axis: axis(of), lower, upper, size }
                }
                SnapshotError::Fine { name, axis: of, spacing } => {
                    SnapshotError::Fine { name, axis: axis(of), spacing }
                }
                SnapshotError::Layer { name, axis: of, layer } => SnapshotError::Layer { name, axis: axis(of), layer },
                SnapshotError::Partial { name, axis: of, step, first } => {
                    SnapshotError::Partial { name, axis: axis(of), step, first }
                }
                time @ SnapshotError::Time { .. } => time,
            }),
            other => other,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Material, Object, TimeWindow, paint3};

    /// A turn and its way back change nothing; what lay on the x edges lies on the edges along the axis that x became.
    #[test]
    fn a_turn_and_its_way_back_change_nothing() {
        let mut model =
            Model::new("", Grid { cells: [7, 5, 1], spacing: [0.002, 0.003, 0.004] }, TimeWindow::Iterations(9));
        let ore = model.add_material(Material { mu_r: 2.0, ..Material::dielectric("ore", 6.0, 0.01) });
        let (lower, upper) = ([0.004, 0.003, 0.0], [0.01, 0.009, 0.004]);
        model.objects.push(Object::Box { lower, upper, material: ore, averaging: true });
        let turn = Turn::of(&model).unwrap();
        let (painted, turned) = (paint3(&model).unwrap(), turn.model(&model));
        assert_eq!((turned.grid.cells, turned.grid.spacing), ([5, 1, 7], [0.003, 0.004, 0.002]));
        let there = turn.painted(&painted);
        assert_eq!(there.edge(2, [1, 0, 2]).eps_r, painted.edge(0, [2, 1, 0]).eps_r);
        assert_eq!(turn.back().painted(&there), painted);
        let mut back = turn.back().model(&turned);
        back.objects = model.objects.clone();
        assert_eq!(back, model);
    }
}
