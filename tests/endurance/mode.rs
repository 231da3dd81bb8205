//! Scenes as input files, in every mode that the solver knows, and their runs.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;

use ballast_gpr::fdtd::{Fdtd, FdtdError, InstructionSet, Precision, Stats};
use ballast_gpr::gprmax::{InFileError, read_model};
use ballast_gpr::model::Model;
use ballast_gpr::trace::{Component, Traces};

/// Which fields there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// E along z, nothing changes along z: the fast solver.
    Tmz,
    /// E along x, nothing changes along x.
    Tmx,
    /// E along y, nothing changes along y.
    Tmy,
    /// E across z, nothing changes along z.
    Te,
    /// All six components.
    Three,
}

impl Mode {
    pub const ALL: [Self; 5] = [Self::Tmz, Self::Tmx, Self::Tmy, Self::Te, Self::Three];

    /// Cells of a grid, of those wanted in three dimensions.
    pub fn cells(self, [x, y, z]: [usize; 3]) -> [usize; 3] {
        match self {
            Self::Tmz => [x, y, 1],
            Self::Tmx => [1, y, z],
            Self::Tmy => [x, 1, z],
            Self::Te => [x, y, 2],
            Self::Three => [x, y, z],
        }
    }

    /// Axes along which sources may point.
    pub fn polarisations(self) -> &'static [&'static str] {
        match self {
            Self::Tmz => &["z"],
            Self::Tmx => &["x"],
            Self::Tmy => &["y"],
            Self::Te => &["x", "y"],
            Self::Three => &["x", "y", "z"],
        }
    }

    /// Axes along which magnetic dipoles may point.
    pub fn magnetic_polarisations(self) -> &'static [&'static str] {
        match self {
            Self::Tmz => &["x", "y"],
            Self::Tmx => &["y", "z"],
            Self::Tmy => &["x", "z"],
            Self::Te => &["z"],
            Self::Three => &["x", "y", "z"],
        }
    }

    /// The axis along which nothing changes.
    pub fn invariant(self) -> Option<usize> {
        match self {
            Self::Tmz | Self::Te => Some(2),
            Self::Tmx => Some(0),
            Self::Tmy => Some(1),
            Self::Three => None,
        }
    }

    /// The node of a source or receiver: on the plane that holds the fields.
    pub fn node(self, mut node: [usize; 3]) -> [usize; 3] {
        if let Some(axis) = self.invariant() {
            node[axis] = usize::from(self == Self::Te);
        }
        node
    }

    /// `#domain`, `#dx_dy_dz` and `#pml_cells` with as many absorbing cells on every side that may have some.
    pub fn grid(self, cells: [usize; 3], spacing: [f64; 3], absorbing: [usize; 6]) -> String {
        let cells = self.cells(cells);
        let extent = |axis: usize| {
            let whole = format!("{:.7}", cells[axis] as f64 * spacing[axis]);
            if self == Self::Te && axis == 2 { "inf".to_owned() } else { whole }
        };
        let absorbing: Vec<String> = (0..6)
            .map(|side| if Some(side % 3) == self.invariant() { 0 } else { absorbing[side] }.to_string())
            .collect();
        let mode = if self == Self::Te { "#domain_mode: TE\n" } else { "" };
        format!(
            "#domain: {} {} {}\n{mode}#dx_dy_dz: {} {} {}\n#pml_cells: {}\n",
            extent(0),
            extent(1),
            extent(2),
            spacing[0],
            spacing[1],
            spacing[2],
            absorbing.join(" ")
        )
    }

    /// A point as words: a node times the cell size; the far side of the grid along the invariant axis with `far`.
    pub fn point(self, node: [usize; 3], spacing: [f64; 3]) -> String {
        let of = |axis: usize| format!("{:.7}", node[axis] as f64 * spacing[axis]);
        format!("{} {} {}", of(0), of(1), of(2))
    }
}

/// Reads a scene.
pub fn read(text: &str) -> Result<Model, InFileError> {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), text).unwrap();
    read_model(file.path())
}

/// Runs a model.
pub fn run(
    model: &Model,
    precision: Precision,
    threads: usize,
    set: InstructionSet,
) -> Result<(Traces, Stats), FdtdError> {
    let fdtd = Fdtd { precision, threads: NonZeroUsize::new(threads), instruction_set: set };
    fdtd.solve_stats(model, &|_| ControlFlow::Continue(()))
}

/// Every sample of E, or of H.
pub fn fields(traces: &Traces, magnetic: bool) -> impl Iterator<Item = &[f64]> {
    let components = traces.receivers.iter().flat_map(|receiver| &receiver.components);
    components.filter(move |trace| trace.component.is_magnetic() == magnetic).map(|trace| &trace.samples[..])
}

/// The largest magnitude; infinite where a sample is not finite.
pub fn peak(samples: &[f64]) -> f64 {
    samples.iter().fold(0.0, |peak, v| if v.is_finite() { v.abs().max(peak) } else { f64::INFINITY })
}

/// The largest of E, or of H, within some steps.
pub fn largest(traces: &Traces, magnetic: bool, steps: std::ops::Range<usize>) -> f64 {
    fields(traces, magnetic).map(|samples| peak(&samples[steps.clone()])).fold(0.0, f64::max)
}

/// The components that are stored, for messages.
pub fn components() -> usize {
    Component::FIELDS.len()
}
