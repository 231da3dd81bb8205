//! Shapes and where they are: discs and the grid that finds their neighbours.

mod disc;

pub use disc::Disc;
