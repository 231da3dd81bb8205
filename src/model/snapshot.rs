//! Snapshots that a model asks for: all six fields in a box at one time step.

use super::{Axis, Model, ceil_half_down};

/// When a snapshot is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SnapshotTime {
    /// At the step nearest to a time, s.
    Seconds(f64),
    /// Before this step, counted from 0: E of this step, H of half a step before.
    Iteration(usize),
}

/// How a snapshot is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SnapshotFormat {
    /// Six arrays over x, y, z.
    Hdf5,
    /// An image of cells that ParaView opens.
    VtkHdf,
}

impl SnapshotFormat {
    /// The ending of the file.
    pub const fn ending(self) -> &'static str {
        match self {
            Self::Hdf5 => "h5",
            Self::VtkHdf => "vtkhdf",
        }
    }
}

/// All fields in a box at one time step (`#snapshot`).
///
/// The box is cut into cells of its own, as large as those of the grid or larger; a snapshot holds the fields at their
/// centres.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// Lower corner, m.
    pub lower: [f64; 3],
    /// Upper corner, m.
    pub upper: [f64; 3],
    /// Sizes of the snapshot's cells, m.
    pub spacing: [f64; 3],
    /// When it is taken.
    pub at: SnapshotTime,
    /// Name of the file, without a folder and an ending.
    pub name: String,
    /// How it is written.
    pub format: SnapshotFormat,
}

/// Why a snapshot cannot be taken.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SnapshotError {
    /// A time beyond the last step.
    #[error(
        "the snapshot `{name}` is asked for at step {step}, but the model has steps 0 to {last}\n\n\
         hint: a whole number is a step, any other a time in seconds"
    )]
    Time {
        /// Name of the snapshot.
        name: String,
        /// The step asked for.
        step: i64,
        /// The last one.
        last: usize,
    },
    /// A box that leaves the grid, or holds no cell.
    #[error(
        "the snapshot `{name}` reaches from {lower} to {upper} m along {}, the grid from 0 to {size} m",
        axis.name()
    )]
    Extent {
        /// Name of the snapshot.
        name: String,
        /// Along which axis.
        axis: Axis,
        /// Where it begins, m.
        lower: f64,
        /// Where it ends, m.
        upper: f64,
        /// Size of the grid along this axis, m.
        size: f64,
    },
    /// Cells smaller than those of the grid.
    #[error("the snapshot `{name}` has cells of {spacing} m along {}, less than those of the grid", axis.name())]
    Fine {
        /// Name of the snapshot.
        name: String,
        /// Along which axis.
        axis: Axis,
        /// Their size, m.
        spacing: f64,
    },
    /// A two-dimensional model whose one layer of fields is not in the box.
    #[error("the snapshot `{name}` leaves out layer {layer} along {}, the only one that holds fields", axis.name())]
    Layer {
        /// Name of the snapshot.
        name: String,
        /// The axis along which nothing changes.
        axis: Axis,
        /// Index of the layer.
        layer: usize,
    },
    /// A last cell that has its centre too close to the wall, or beyond it.
    #[error(
        "the snapshot `{name}` has a last cell along {} that reaches beyond the grid: {step} cells of the grid from cell {first} on\n\n\
         hint: let the box end where the last whole cell ends, or take smaller steps",
        axis.name()
    )]
    Partial {
        /// Name of the snapshot.
        name: String,
        /// Along which axis.
        axis: Axis,
        /// Cells of the grid in one of the snapshot.
        step: usize,
        /// Where the last cell begins.
        first: usize,
    },
}

/// Where the cells of a snapshot lie on the grid of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SnapshotCells {
    /// Node at which the first begins.
    pub first: [usize; 3],
    /// Cells of the grid in one of them, along each axis.
    pub step: [usize; 3],
    /// How many there are.
    pub count: [usize; 3],
    /// The axis along which nothing changes: one cell, and the fields of layer `first`.
    pub flat: Option<usize>,
}

impl SnapshotCells {
    /// How many cells there are.
    pub fn len(&self) -> usize {
        self.count.iter().product()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The two indices along an axis between which a field lies half-way at the centre of a cell; one and the same where the
    /// field has a value there. `half`: the field lies half a cell up from its node along this axis.
    ///
    /// gprMax's rule, found by setting its snapshots against the samples of receivers on all nodes.
    pub fn indices(&self, axis: usize, cell: usize, half: bool) -> [usize; 2] {
        let first = self.first[axis] + cell * self.step[axis];
        if self.flat == Some(axis) {
            return [first; 2];
        }
        let twice = 2 * first + self.step[axis] - usize::from(half);
        [twice / 2, twice.div_ceil(2)]
    }

    /// The last node along an axis that any field is read at.
    pub fn last(&self, axis: usize) -> usize {
        let cell = self.count[axis].saturating_sub(1);
        self.indices(axis, cell, false)[1].max(self.indices(axis, cell, true)[1])
    }
}

impl Snapshot {
    /// The step before which it is taken, by gprMax's rounding.
    ///
    /// # Errors
    /// When the model has no such step.
    pub fn step(&self, model: &Model) -> Result<usize, SnapshotError> {
        let step = match self.at {
            SnapshotTime::Seconds(seconds) => ceil_half_down(seconds / model.time_step()),
            SnapshotTime::Iteration(step) => i64::try_from(step).unwrap_or(i64::MAX),
        };
        let last = model.iterations().saturating_sub(1);
        usize::try_from(step).ok().filter(|&step| step <= last).ok_or(SnapshotError::Time {
            name: self.name.clone(),
            step,
            last,
        })
    }

    /// Where its cells lie; in a two-dimensional model only the layer that holds fields counts.
    ///
    /// # Errors
    /// When the box leaves the grid, holds no cell, or has a last cell that is cut short.
    pub fn cells(&self, model: &Model) -> Result<SnapshotCells, SnapshotError> {
        let (grid, name) = (model.grid, || self.name.clone());
        let invariant = model.invariant_axis();
        let layer = usize::from(model.transverse_electric.is_some());
        let mut cells = SnapshotCells { first: [0; 3], step: [1; 3], count: [1; 3], flat: invariant };
        for (index, axis) in [Axis::X, Axis::Y, Axis::Z].into_iter().enumerate() {
            let (lower, upper, spacing) = (self.lower[index], self.upper[index], self.spacing[index]);
            let [low, high] = [lower, upper].map(|metres| grid.node(index, metres));
            let all = grid.cells[index];
            if low < 0 || high > all as i64 || low > high || (low == high && invariant != Some(index)) {
                let size = all as f64 * grid.spacing[index];
                return Err(SnapshotError::Extent { name: name(), axis, lower, upper, size });
            }
            let step = grid.node(index, spacing);
            if step < 1 {
                return Err(SnapshotError::Fine { name: name(), axis, spacing });
            }
            if invariant == Some(index) {
                if !(low..high).contains(&(layer as i64)) {
                    return Err(SnapshotError::Layer { name: name(), axis, layer });
                }
                cells.first[index] = layer;
                continue;
            }
            // A step of more cells than there are is caught below, whatever its size.
            let (first, step) = (low as usize, (step as usize).min(2 * all + 2));
            let count = ((high - low) as usize).div_ceil(step);
            let begin = first + (count - 1) * step;
            if begin + step / 2 + 1 > all {
                return Err(SnapshotError::Partial { name: name(), axis, step, first: begin });
            }
            (cells.first[index], cells.step[index], cells.count[index]) = (first, step, count);
        }
        Ok(cells)
    }

    /// Where the first cell begins and how large the cells are, m; along the invariant axis of a TE model the cell lies around
    /// its layer of nodes.
    ///
    /// # Errors
    /// See [`Snapshot::cells`].
    pub fn frame(&self, model: &Model) -> Result<[[f64; 3]; 2], SnapshotError> {
        let (cells, d) = (self.cells(model)?, model.grid.spacing);
        let shift = |axis| if cells.flat == Some(axis) && cells.first[axis] == 1 { 0.5 } else { 0.0 };
        let origin = std::array::from_fn(|axis| (cells.first[axis] as f64 - shift(axis)) * d[axis]);
        Ok([origin, std::array::from_fn(|axis| cells.step[axis] as f64 * d[axis])])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Grid, TimeWindow};

    fn model(cells: [usize; 3]) -> Model {
        Model::new("", Grid { cells, spacing: [0.002; 3] }, TimeWindow::Iterations(30))
    }

    fn snapshot(lower: [f64; 3], upper: [f64; 3], spacing: [f64; 3], at: SnapshotTime) -> Snapshot {
        Snapshot { lower, upper, spacing, at, name: "a".into(), format: SnapshotFormat::Hdf5 }
    }

    /// Steps that gprMax 4.0.1 printed for 2 mm cells, 3-D, and what it refused.
    #[test]
    fn times_become_the_steps_of_gprmax() {
        let model = model([10, 9, 8]);
        let step = |at| snapshot([0.0; 3], [0.02, 0.018, 0.016], [0.002; 3], at).step(&model);
        for (seconds, wanted) in
            [(4.85e-11, 13), (4.7e-11, 12), (0.0, 0), (1.12e-10, 29), (1e-12, 0), (9.9999999e-12, 3)]
        {
            assert_eq!(step(SnapshotTime::Seconds(seconds)), Ok(wanted), "{seconds}");
        }
        assert_eq!(step(SnapshotTime::Iteration(29)), Ok(29));
        assert!(step(SnapshotTime::Iteration(30)).is_err() && step(SnapshotTime::Seconds(20.0)).is_err());
    }

    /// Shapes and origins of gprMax 4.0.1, and boxes that it refused.
    #[test]
    fn boxes_are_cut_as_gprmax_cuts_them() {
        let space = model([10, 9, 8]);
        let cells = |upper: [f64; 3], step: [f64; 3]| {
            let of = snapshot([0.002, 0.0, 0.0], upper, step, SnapshotTime::Iteration(0)).cells(&space);
            of.map(|cells| cells.count)
        };
        assert_eq!(cells([0.016, 0.014, 0.014], [0.004, 0.006, 0.006]), Ok([4, 3, 3]));
        assert_eq!(cells([0.014, 0.018, 0.016], [0.0031, 0.003, 0.0019]), Ok([3, 9, 8]));
        for (upper, step) in [
            ([0.02, 0.018, 0.016], [0.002, 0.008, 0.002]),
            ([0.02, 0.018, 0.016], [0.05, 0.002, 0.002]),
            ([0.02, 0.018, 0.016], [0.001, 0.002, 0.002]),
            ([0.022, 0.018, 0.016], [0.002; 3]),
            ([0.002, 0.018, 0.016], [0.002; 3]),
            ([0.0, 0.018, 0.016], [0.002; 3]),
        ] {
            assert!(cells(upper, step).is_err(), "{upper:?} {step:?}");
        }
    }

    /// In two dimensions there is one layer: the first in TM, the second in TE, where the cell lies around the nodes.
    #[test]
    fn one_layer_holds_the_fields_of_two_dimensions() {
        let plane = model([10, 9, 1]);
        let asked = snapshot([0.0; 3], [0.02, 0.018, 0.002], [0.002, 0.002, 0.006], SnapshotTime::Iteration(0));
        assert_eq!(asked.cells(&plane).unwrap().count, [10, 9, 1]);
        assert_eq!(asked.frame(&plane).unwrap(), [[0.0; 3], [0.002; 3]]);
        let mut across = model([10, 2, 9]);
        across.transverse_electric = Some(Axis::Y);
        let mut asked = snapshot([0.0; 3], [0.02, 0.004, 0.018], [0.002, 0.004, 0.002], SnapshotTime::Iteration(0));
        let cells = asked.cells(&across).unwrap();
        assert_eq!((cells.count, cells.indices(1, 0, false), cells.indices(1, 0, true)), ([10, 1, 9], [1, 1], [1, 1]));
        assert_eq!(asked.frame(&across).unwrap(), [[0.0, 0.001, 0.0], [0.002; 3]]);
        asked.upper[1] = 0.002;
        assert!(matches!(asked.cells(&across), Err(SnapshotError::Layer { layer: 1, .. })));
    }

    /// Three cells of the grid have their centre at a half node; two, at a node.
    #[test]
    fn fields_lie_half_way_between_indices() {
        let space = model([10, 9, 8]);
        let asked = snapshot([0.0; 3], [0.02, 0.018, 0.012], [0.004, 0.002, 0.006], SnapshotTime::Iteration(0));
        let cells = asked.cells(&space).unwrap();
        assert_eq!((cells.indices(0, 1, false), cells.indices(0, 1, true)), ([3, 3], [2, 3]));
        assert_eq!((cells.indices(1, 1, false), cells.indices(1, 1, true)), ([1, 2], [1, 1]));
        assert_eq!((cells.indices(2, 1, false), cells.indices(2, 1, true)), ([4, 5], [4, 4]));
        assert_eq!([0, 1, 2].map(|axis| cells.last(axis)), [9, 9, 5]);
    }
}
