//! The embedded solver, in two and three dimensions, against closed forms: strips of plane waves, cavities, cylinders,
//! spheres, and the order of its accuracy.

mod cavity;
mod cylinder;
mod functions;
mod order;
mod setting;
mod sphere;
mod strip;
