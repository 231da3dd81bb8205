//! Shapes and where they are: discs, the areas they share with strips and rectangles, and the grid of their neighbours.

mod area;
mod disc;
mod neighbours;
mod segment;

pub use area::disc_rectangle_area;
pub use disc::Disc;
pub use neighbours::NeighbourGrid;
pub use segment::{area_below, area_between};
