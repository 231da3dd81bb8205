//! Each edge in space as the mean over the cell-sized box around its middle, from the true shapes.
//!
//! With `Averaging::Volumes` the mean is the arithmetic one, `<eps> = 1/(dx dy dz) ∫ eps dV`, of permittivity and conductivity
//! alike. It is right where the field lies along the surface; across it D is continuous and the harmonic mean is right. The
//! arithmetic mean makes every stone larger by a share of a cell. `Averaging::Shapes` gives an edge along axis `a` the
//! diagonal of the inverse of the tensor of Farjadpour et al. 2006 (doi:10.1364/OL.31.002972),
//! `1/eps = n_a² <1/eps> + (1 - n_a²)/<eps>` with `n` the normal of the surface; what couples the axes is left out.
//!
//! Balls, ellipsoids, boxes, cylinders along an axis and cells of a block have closed forms; cones, oblique cylinders, sectors
//! and prisms are cut into eighths until a plane tells what is left. Only boxes that a surface passes through cost anything.

mod body;
mod mix;
mod part;
mod rows;
#[cfg(test)]
mod tests;

pub(super) use rows::average_volumes;
