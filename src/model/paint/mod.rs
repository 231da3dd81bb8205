//! From objects to cells, edges and faces, by gprMax's rules, on any grid.
//!
//! Coordinates snap to the nearest node (halves go down). A cell belongs to a round object when its centre does. Objects
//! are painted in order, the later over the earlier. An edge takes the arithmetic mean of the four cells around it, unless
//! one of them *claims* it: cells painted without averaging, of a perfect conductor or of a dispersive material claim their
//! edges, and the last to claim an edge gives it its material. Painting a cell anew drops only that cell's own claims.
//! Faces, where H lives, do the same with the harmonic mean of two cells.
//!
//! The grid is cut into chunks of planes across x, which are painted and settled one beside the other on all threads.
//! Where the cuts lie depends on the grid only, so the result does not depend on the number of threads.

mod chunk;
mod claims;
mod error;
mod finished;
mod layout;
mod settle;
mod solid;
#[cfg(test)]
mod tests;
mod whole;

pub use claims::{edge_flag, face_flag};
pub use error::PaintError;
pub use finished::{Finished, Parts, paint_finished};
pub use layout::{check_grid, check_two_dimensional};
pub use whole::{paint, paint3};
