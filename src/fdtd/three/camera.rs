//! Snapshots of a run: which are due, and reading the fields off the planes.

use super::super::FdtdError;
use super::super::keeping::Snapshots;
use super::plane::Plane;
use super::setup::Setup3;
use super::turn::Turn;
use super::vector::Number;
use crate::model::{Model, SnapshotCells, SnapshotError};
use crate::trace::{FieldSnapshot, FieldValues};
use crate::units::{Metres, Seconds};

/// A box of nodes whose fields somebody looks at before one step.
#[derive(Debug, Clone, Copy)]
pub struct Look {
    /// Place in the model's list of snapshots.
    place: usize,
    /// The step.
    pub step: usize,
    /// The cells whose centres are looked at.
    cells: SnapshotCells,
    /// Where the first begins and how large they are, m.
    frame: [[f64; 3]; 2],
}

impl Look {
    /// All that a model asks for, in the order of their steps.
    ///
    /// # Errors
    /// When one cannot be taken.
    pub fn all(model: &Model) -> Result<Vec<Self>, SnapshotError> {
        let look = |(place, asked): (usize, &crate::model::Snapshot)| {
            Ok(Self { place, step: asked.step(model)?, cells: asked.cells(model)?, frame: asked.frame(model)? })
        };
        let mut looks = model.snapshots.iter().enumerate().map(look).collect::<Result<Vec<_>, _>>()?;
        looks.sort_by_key(|look| look.step);
        Ok(looks)
    }

    /// The first and the last node looked at.
    pub fn corners(&self) -> [[usize; 3]; 2] {
        [self.cells.first, std::array::from_fn(|axis| self.cells.last(axis))]
    }

    /// Memory of the values and of the file that is made of them, bytes.
    pub fn bytes(&self, bytes_per_number: usize) -> u64 {
        (2 * 6 * self.cells.len() * bytes_per_number) as u64
    }
}

/// Takes the snapshots of one run.
pub struct Camera<'a> {
    settings: Snapshots<'a>,
    /// Those that are still to take, the last one first.
    looks: Vec<Look>,
    /// What gives the model back its axes.
    turn: Option<Turn>,
}

impl<'a> Camera<'a> {
    /// A camera for all snapshots of a model, turned or not.
    pub fn new(settings: Snapshots<'a>, setup: &Setup3<'_>, turn: Option<Turn>) -> Self {
        Self { settings, looks: setup.looks.iter().rev().copied().collect(), turn }
    }

    /// Leaves out what has been taken already by a run that got to step `begun`.
    ///
    /// # Errors
    /// When one of them is not there.
    pub fn go_on(&mut self, begun: usize) -> Result<(), FdtdError> {
        while let Some(look) = self.looks.pop_if(|look| look.step < begun) {
            if !(self.settings.is_there)(look.place) {
                return Err(FdtdError::SnapshotGone { number: look.place + 1, step: look.step, begun });
            }
        }
        Ok(())
    }

    /// The step of the next one, if there is one.
    pub fn next(&self) -> Option<usize> {
        self.looks.last().map(|look| look.step)
    }

    /// Takes those that are due when all planes have made `begun` steps; `planes` without those beyond the walls.
    ///
    /// # Errors
    /// What became of a snapshot.
    pub fn take<T: Number>(&mut self, begun: usize, setup: &Setup3<'_>, planes: &[&Plane<T>]) -> Result<(), FdtdError> {
        while let Some(look) = self.looks.pop_if(|look| look.step == begun) {
            let snapshot = snapshot(&look, setup, planes);
            let snapshot = match self.turn {
                Some(turn) => turn.snapshot_back(snapshot),
                None => snapshot,
            };
            (self.settings.take)(look.place, snapshot)
                .map_err(|reason| FdtdError::Snapshot { number: look.place + 1, reason })?;
        }
        Ok(())
    }
}

fn snapshot<T: Number>(look: &Look, setup: &Setup3<'_>, planes: &[&Plane<T>]) -> FieldSnapshot {
    let [origin, spacing] = look.frame.map(|lengths| lengths.map(Metres));
    let time = look.step as f64 * setup.dt;
    let scale = setup.scale();
    FieldSnapshot {
        step: look.step,
        time: Seconds(time),
        magnetic_time: Seconds(time - 0.5 * setup.dt),
        origin,
        spacing,
        shape: look.cells.count,
        fields: std::array::from_fn(|field| values(look, field, scale[field], planes)),
    }
}

/// One field at the centres of all cells: the mean of the one to eight values around each.
fn values<T: Number>(look: &Look, field: usize, scale: f64, planes: &[&Plane<T>]) -> FieldValues {
    let SnapshotCells { count: [nx, ny, nz], .. } = look.cells;
    let axis = field % 3;
    // E lies half a cell up along its own axis, H along the two others.
    let half = |of: usize| (of == axis) == (field < 3);
    let around = |of: usize, cell: usize| look.cells.indices(of, cell, half(of));
    let columns: Vec<[usize; 2]> = (0..nz).map(|cell| around(2, cell)).collect();
    let width = look.cells.last(2) + 1;
    let nothing = vec![T::default(); width];
    let mut doubles = Vec::with_capacity(if size_of::<T>() == 8 { look.cells.len() } else { 0 });
    let mut singles = Vec::with_capacity(if size_of::<T>() == 4 { look.cells.len() } else { 0 });
    for i in 0..nx {
        let across = around(0, i).map(|i| planes.get(i));
        for j in 0..ny {
            let rows = across.map(|plane| {
                // Beyond the last plane lies the wall, where all that is read is zero.
                around(1, j).map(|j| plane.map_or(&nothing[..], |plane| plane.row(field, j, width)))
            });
            for &[low, high] in &columns {
                let [[a, b], [c, d]] = rows.map(|pair| pair.map(|row| row[low].double() + row[high].double()));
                let mean = scale * (((a + b) + (c + d)) / 8.0);
                if size_of::<T>() == 8 { doubles.push(mean) } else { singles.push(mean as f32) }
            }
        }
    }
    if size_of::<T>() == 8 { FieldValues::Double(doubles) } else { FieldValues::Single(singles) }
}
