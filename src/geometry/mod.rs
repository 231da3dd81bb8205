//! Shapes and where they are: discs and balls, what they share with strips, rectangles and boxes, and the grids of their
//! neighbours; noise in volumes and on surfaces; meshes of triangles and where a ball touches them.

mod area;
mod ball;
mod disc;
mod fractal;
mod half_space;
mod neighbours;
mod normal;
mod segment;
mod sphere;
mod sphere_grid;
pub mod triangle_mesh;

pub use area::disc_rectangle_area;
pub use ball::{ball_box_volume, ball_column_volume};
pub use disc::Disc;
pub use fractal::{fractal_surface, fractal_volume};
pub use half_space::half_space_share;
pub use neighbours::NeighbourGrid;
pub use segment::{area_below, area_between};
pub use sphere::Sphere;
pub use sphere_grid::SphereGrid;
