//! The model itself.

use super::{
    AbsorbingProfile, Averaging, Axis, GeometryFile, GeometryView, Grid, MagneticAveraging, Material, MaterialId,
    Object, Order, Receiver, Snapshot, Source, Waveform,
};

/// Largest stable time step with axes coupled on surfaces, as a share of the Courant step: `1/sqrt(1.1)`, where the least
/// permittivity of the grid may lie a tenth below that of free space.
pub const COUPLED_STABLE_SHARE: f64 = 0.953_462_589_245_592_3;

/// How long to simulate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TimeWindow {
    /// A time, s.
    Seconds(f64),
    /// A number of time steps.
    Iterations(usize),
}

/// All that an electromagnetic solver needs.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// A line for people.
    pub title: String,
    /// Cells and their sizes.
    pub grid: Grid,
    /// The axis that the electric field lies across (`#domain_mode: TE`): two cells along it, of which only the node between
    /// them holds fields. `None`: three-dimensional, or TM where the grid has one cell along an axis.
    pub transverse_electric: Option<Axis>,
    /// Factor on the largest stable step, in (0, 1].
    pub stability_factor: f64,
    /// Order of the differences in space. It stands here because time step and number of steps follow from it.
    pub order: Order,
    /// How the edges between materials get their values.
    pub averaging: Averaging,
    /// How long to simulate.
    pub time_window: TimeWindow,
    /// Absorbing cells at x0, y0, z0, xmax, ymax, zmax; `None` is gprMax's default of 10 on every side of a changing axis.
    pub pml_cells: Option<[usize; 6]>,
    /// What they do (`#pml_cfs`, `#pml_formulation`).
    pub absorbing_profile: AbsorbingProfile,
    /// Threads asked for by the model (`#omp_threads`).
    pub threads: Option<usize>,
    /// Materials; the first is the perfect conductor, the second free space.
    pub materials: Vec<Material>,
    /// Whether edges between dispersive materials take the mean of both, poles included (`#dispersive_averaging`).
    pub dispersive_averaging: bool,
    /// How a face between two magnetic materials gets its values (`#magnetic_averaging`).
    pub magnetic_averaging: MagneticAveraging,
    /// Waveforms that sources refer to.
    pub waveforms: Vec<Waveform>,
    /// Objects, painted in order.
    pub objects: Vec<Object>,
    /// Sources.
    pub sources: Vec<Source>,
    /// Receivers.
    pub receivers: Vec<Receiver>,
    /// How far all sources move from one trace of a B-scan to the next, m (`#src_steps`).
    pub source_steps: [f64; 3],
    /// How far all receivers move from one trace of a B-scan to the next, m (`#rx_steps`).
    pub receiver_steps: [f64; 3],
    /// Geometry files to write (`#geometry_objects_write`); no trace depends on them.
    pub geometry_files: Vec<GeometryFile>,
    /// Views of the geometry to write (`#geometry_view`); no trace depends on them.
    pub geometry_views: Vec<GeometryView>,
    /// Snapshots to take (`#snapshot`); no trace depends on them.
    pub snapshots: Vec<Snapshot>,
}

impl Model {
    /// An empty model: free space, no sources, gprMax's defaults.
    pub fn new(title: impl Into<String>, grid: Grid, time_window: TimeWindow) -> Self {
        Self {
            title: title.into(),
            grid,
            transverse_electric: None,
            stability_factor: 1.0,
            order: Order::Second,
            averaging: Averaging::Cells,
            time_window,
            pml_cells: None,
            absorbing_profile: AbsorbingProfile::default(),
            threads: None,
            materials: vec![Material::pec(), Material::free_space()],
            dispersive_averaging: false,
            magnetic_averaging: MagneticAveraging::default(),
            waveforms: vec![],
            objects: vec![],
            sources: vec![],
            receivers: vec![],
            source_steps: [0.0; 3],
            receiver_steps: [0.0; 3],
            geometry_files: vec![],
            geometry_views: vec![],
            snapshots: vec![],
        }
    }

    /// Adds a material and returns its id.
    pub fn add_material(&mut self, material: Material) -> MaterialId {
        self.materials.push(material);
        MaterialId((self.materials.len() - 1) as u16)
    }

    /// The material that consists of one material along each axis, which is added where there is none yet.
    ///
    /// Its own values are the means of the three: the cells that hold it count with them for the absorbing boundary.
    pub fn add_directional(&mut self, along: [MaterialId; 3]) -> MaterialId {
        if let Some(known) = self.materials.iter().position(|material| material.directional == Some(along)) {
            return MaterialId(known as u16);
        }
        let parts = along.map(|id| &self.materials[id.index()]);
        let mean = |of: fn(&Material) -> f64| parts.iter().map(|part| of(part)).sum::<f64>() / 3.0;
        self.add_material(Material {
            id: parts.map(|part| part.id.as_str()).join("+"),
            mu_r: mean(|m| m.mu_r),
            sigma_magnetic: mean(|m| m.sigma_magnetic),
            averagable: false,
            directional: Some(along),
            ..Material::dielectric("", mean(|m| m.eps_r), mean(|m| m.sigma))
        })
    }

    /// How many cells each material acts in, from how many hold it: those of a direction-dependent material count for each of
    /// its three.
    pub fn acting(&self, mut cells: Vec<usize>) -> Vec<usize> {
        for (index, material) in self.materials.iter().enumerate() {
            let own = cells[index];
            for part in material.directional.into_iter().flatten() {
                cells[part.index()] += own;
            }
        }
        cells
    }

    /// The model of one trace of a B-scan, counted from 0: sources and receivers moved by so many steps.
    ///
    /// A position and a step are rounded to whole cells each, as in gprMax, so that no trace is a cell off.
    pub fn at_trace(&self, trace: usize) -> Self {
        let grid = self.grid;
        let moved = |position: [f64; 3], steps: [f64; 3]| {
            std::array::from_fn(|axis| {
                let step = grid.node(axis, steps[axis]);
                if step == 0 || trace == 0 {
                    return position[axis];
                }
                (grid.node(axis, position[axis]) + step * trace as i64) as f64 * grid.spacing[axis]
            })
        };
        let mut model = self.clone();
        for source in &mut model.sources {
            *source.position_mut() = moved(source.position(), self.source_steps);
        }
        for receiver in &mut model.receivers {
            receiver.position = moved(receiver.position, self.receiver_steps);
        }
        model
    }

    /// Looks a material up by its identifier.
    pub fn material_named(&self, id: &str) -> Option<MaterialId> {
        self.materials.iter().position(|material| material.id == id).map(|index| MaterialId(index as u16))
    }

    /// The axis along which nothing changes, if the model is two-dimensional, TM or TE.
    pub fn invariant_axis(&self) -> Option<usize> {
        self.transverse_electric.map(Axis::index).or_else(|| self.grid.invariant_axis())
    }

    /// Whether D along one axis makes E along another on surfaces that lie aslant: where asked for, with differences of second
    /// order and more than one component of E.
    pub fn couples_axes(&self) -> bool {
        let components = self.invariant_axis().is_none() || self.transverse_electric.is_some();
        self.averaging == Averaging::Tensors && self.order == Order::Second && components
    }

    /// Time step, s: the stability factor times the Courant step, 6/7 of it with differences of fourth order, and 0.953 of
    /// it with [axes that are coupled](Model::couples_axes).
    pub fn time_step(&self) -> f64 {
        let coupled = if self.couples_axes() { COUPLED_STABLE_SHARE } else { 1.0 };
        let share = self.order.stable_share() * coupled;
        self.grid.courant_step_without(self.invariant_axis()) * share * self.stability_factor
    }

    /// Number of time steps, and so of samples: `ceil(window/dt) + 1` for a time, exactly `n` for a count.
    pub fn iterations(&self) -> usize {
        match self.time_window {
            TimeWindow::Seconds(seconds) => (seconds / self.time_step()).ceil() as usize + 1,
            TimeWindow::Iterations(count) => count,
        }
    }

    /// Absorbing cells at x0, y0, z0, xmax, ymax, zmax, defaults filled in.
    pub fn absorbing_cells(&self) -> [usize; 6] {
        let invariant = self.invariant_axis();
        self.pml_cells.unwrap_or(std::array::from_fn(|side| if Some(side % 3) == invariant { 0 } else { 10 }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Case `15_bscan5` of gprMax 4.0.1, `-n 5`, steps of 40 mm: the source of the fifth run stands at node 170, the receiver
    /// at node 190 (90 and 110, moved by four times 20 nodes).
    #[test]
    fn traces_of_a_b_scan_move_by_whole_cells() {
        use crate::model::{Axis, Excitation, HertzianDipole};
        let grid = Grid { cells: [300, 200, 1], spacing: [0.002; 3] };
        let mut model = Model::new("", grid, TimeWindow::Iterations(1));
        let excitation = Excitation { start: 0.0, stop: None };
        let position = [0.18, 0.3, 0.0];
        let dipole = HertzianDipole { polarisation: Axis::Z, position, waveform: 0, excitation };
        model.sources.push(Source::HertzianDipole(dipole));
        model.receivers.push(Receiver { position: [0.22, 0.3, 0.0], name: None });
        (model.source_steps, model.receiver_steps) = ([0.04, 0.0, 0.0], [0.04, 0.0, 0.0]);
        assert_eq!(model.at_trace(0), model);
        let fifth = model.at_trace(4);
        let source = fifth.sources[0].position();
        let node = |x: f64| grid.node(0, x);
        assert_eq!((node(source[0]), node(fifth.receivers[0].position[0])), (170, 190));
        assert_eq!(source[1], 0.3);
    }

    /// Iterations that gprMax 4.0.1 reports for its window and step (`#time_window: 4e-9`, 2 mm, 2-D).
    #[test]
    fn iterations_are_those_of_gprmax() {
        let grid = Grid { cells: [200, 200, 1], spacing: [0.002; 3] };
        assert_eq!(Model::new("", grid, TimeWindow::Seconds(4e-9)).iterations(), 849);
        assert_eq!(Model::new("", grid, TimeWindow::Seconds(15e-9)).iterations(), 3181);
        assert_eq!(Model::new("", grid, TimeWindow::Iterations(3000)).iterations(), 3000);
    }
}
