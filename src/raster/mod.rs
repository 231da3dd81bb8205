//! From a scene to a model: the tank, the layers and the stones on a grid.

mod build;
mod discs;
mod map;
mod placement;
mod turn;

pub use build::{RasterError, antenna_alone, build_model};
pub use map::{permittivity_map, permittivity_section};
pub use placement::Placement;
pub use turn::transverse_electric;
