//! Shapes and where they are: discs and the grid that finds their neighbours.

mod disc;
mod neighbours;
mod segment;

pub use disc::Disc;
pub use neighbours::NeighbourGrid;
pub use segment::{area_below, area_between};
