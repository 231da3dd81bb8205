//! The loops over one row of a three-dimensional grid: slices and numbers in, slices out.
//!
//! Each is generic over the precision and the vector instructions. No multiplication is fused with an addition, so every
//! variant gives the same bits.

mod absorb;
mod fourth;
mod grade;
mod relax;
mod update;

pub use absorb::{AbsorbEndTwice, AbsorbEnds, AbsorbRowTwice, ColumnFilter, ColumnProfile, RowFilter, RowProfile};
pub use fourth::{absorb_columns_by, absorb_row_by, difference, take_e, take_h};
pub use grade::{Bare, Even, Grade, Indexed, Lossless, Lossy, Stored, WriteOut};
pub use relax::{Pole, Relax, Ringing};
pub use update::{Absorb, Absorbs, Curl, StepAll, StepE, StepH};
