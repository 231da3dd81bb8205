//! The loops over one row of the grid: slices and numbers in, slices out.
//!
//! Each is generic over the precision and inlined into the variants of [`instructions`](super::instructions), where the
//! compiler widens it. No multiplication is fused with an addition, so every variant gives the same bits.

mod absorb;
mod difference;
mod relax;
mod update;

pub use absorb::{ColumnProfile, RowProfile, absorb_columns_e, absorb_columns_h, absorb_row_e, absorb_row_h};
pub use difference::{Difference, Fourth, Second};
pub use relax::{Relaxation, relax};
pub use update::{update_e, update_e_lossy, update_h};
