//! Each edge in space as the mean over the cell-sized box around its middle, from the true shapes.
//!
//! The mean is the arithmetic one over the volume, `1/(dx dy dz) ∫ eps dV`, of permittivity and conductivity alike. Balls,
//! ellipsoids, boxes, cylinders along an axis and cells of a block have closed forms; cones, oblique cylinders, sectors and
//! prisms are cut into eighths until a plane tells what is left. Only boxes that a surface passes through cost anything.

mod body;
mod mix;
mod part;
mod rows;
#[cfg(test)]
mod tests;

pub(super) use rows::average_volumes;
