//! All fields in a box at one time.

use crate::units::{Metres, Seconds};

/// The values of one field, in the precision in which they were computed.
#[derive(Debug, Clone, PartialEq)]
pub enum FieldValues {
    /// 32 bits each.
    Single(Vec<f32>),
    /// 64 bits each.
    Double(Vec<f64>),
}

impl FieldValues {
    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Single(values) => values.len(),
            Self::Double(values) => values.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The same in double precision.
    pub fn doubles(&self) -> Vec<f64> {
        match self {
            Self::Single(values) => values.iter().copied().map(f64::from).collect(),
            Self::Double(values) => values.clone(),
        }
    }

    /// The values at these places, in this order.
    pub fn picked(&self, places: impl Iterator<Item = usize>) -> Self {
        match self {
            Self::Single(values) => Self::Single(places.map(|place| values[place]).collect()),
            Self::Double(values) => Self::Double(places.map(|place| values[place]).collect()),
        }
    }
}

/// The six fields at the centres of the cells of a box, at one time step.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldSnapshot {
    /// The step before which it was taken.
    pub step: usize,
    /// Time of E.
    pub time: Seconds,
    /// Time of H, half a step before.
    pub magnetic_time: Seconds,
    /// Where the first cell begins.
    pub origin: [Metres; 3],
    /// Sizes of the cells.
    pub spacing: [Metres; 3],
    /// Cells along x, y, z.
    pub shape: [usize; 3],
    /// Ex, Ey, Ez in V/m and Hx, Hy, Hz in A/m, each with `shape` values, z fastest.
    pub fields: [FieldValues; 6],
}
