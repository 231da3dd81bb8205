//! The loops over one row of the grid: chunks of sixteen nodes and numbers in, chunks out.
//!
//! Each is generic over the precision and the registers, and inlined into the variants of
//! [`instructions`](super::instructions). No multiplication is fused with an addition, so every variant gives the same bits.

mod absorb;
mod fourth;
mod relax;
mod second;
mod update;

pub use absorb::{Across, Along, Ends, RowProfile};
pub use fourth::{FourthRowOfE, FourthRowOfH};
pub use relax::{Relaxation, relax};
pub use second::SecondRow;
pub use update::{RowOfE, RowOfH};
