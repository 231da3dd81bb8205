//! The same section for waves whose electric field lies across the stones.

use std::sync::Arc;

use crate::model::{Axis, Model, Object, Voxels};

/// The model of a section with the electric field in the section (TEz) in place of along the stones (TMz): antenna and receiver
/// turned along x, everything two cells thick, as gprMax's `#domain_mode: TE` wants it.
///
/// A model in space is returned as it is.
pub fn transverse_electric(model: &Model) -> Model {
    let mut turned = model.clone();
    if model.grid.cells[2] != 1 {
        return turned;
    }
    let depth = model.grid.spacing[2];
    turned.grid.cells[2] = 2;
    turned.transverse_electric = Some(Axis::Z);
    for object in &mut turned.objects {
        match object {
            Object::Box { upper, .. } => upper[2] = 2.0 * depth,
            Object::Cylinder { end, .. } => end[2] = 2.0 * depth,
            Object::Voxels(voxels) => *voxels = doubled(voxels),
            _ => {}
        }
    }
    for source in &mut turned.sources {
        *source.polarisation_mut() = Axis::X;
        source.position_mut()[2] = depth;
    }
    for receiver in &mut turned.receivers {
        receiver.position[2] = depth;
    }
    turned
}

fn doubled(voxels: &Voxels) -> Voxels {
    let [nx, ny, _] = voxels.shape;
    let cells: Vec<_> = voxels.cells.iter().flat_map(|cell| [*cell, *cell]).collect();
    Voxels { shape: [nx, ny, 2], cells: Arc::from(cells), ..voxels.clone() }
}
