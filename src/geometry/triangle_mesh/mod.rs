//! Surfaces of triangles: walls, boxes, hoppers, sleepers. Their checks, their builders, STL, and where a ball touches them.

mod builders;
mod contact;
mod error;
mod features;
mod mesh;
mod stl;
mod vector;

pub use builders::{closed_box, open_box, rectangle, shoulder_prism, sleeper_block, square_hopper};
pub use contact::{FeatureId, MOST_TOUCHES, Touch, Touches};
pub use error::MeshError;
pub use mesh::TriangleMesh;
