//! The loops over one row of a three-dimensional grid: slices and numbers in, slices out.
//!
//! Each is generic over the precision and inlined into the variants of `instructions`, where the compiler widens it. No
//! multiplication is fused with an addition, so every variant gives the same bits.

mod absorb;
mod relax;
mod update;

pub use absorb::{
    ColumnFilter, ColumnProfile, RowFilter, RowProfile, absorb_columns, absorb_columns_scaled, absorb_columns_twice,
    absorb_row, absorb_row_scaled, absorb_row_twice,
};
pub use relax::{Pole, Ringing, relax};
pub use update::{EdgeRow, add_curl, add_curl_lossy, add_h, add_h_magnetic};
