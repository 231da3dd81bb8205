//! Where the tank stands on the grid.

use crate::model::{Grid, ceil_half_down};
use crate::scene::{Dimension, SceneSpec};

/// Cells of the metal plate below the tank: enough that no field reaches its lower side.
const PLATE_CELLS: usize = 4;

/// The tank on the grid: x to the right, y up, z to the back (in a section one cell, along the stones).
///
/// A bed of spheres has its height along z; its y becomes the z of the model, so that a section is the model at one z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// The grid.
    pub grid: Grid,
    /// Absorbing cells at x0, y0, z0, xmax, ymax, zmax.
    pub absorbing_cells: [usize; 6],
    /// Model coordinates of the bed's left lower corner (inner face of the wall, top of the base plate), m.
    pub bed_origin: [f64; 2],
    /// Where the bed begins along z, m; zero in a section.
    pub front: f64,
    /// Height of the metal plate, m; zero without one.
    pub plate_height: f64,
    /// Position of the source, m.
    pub source: [f64; 3],
    /// Position of the receiver, m.
    pub receiver: [f64; 3],
}

impl Placement {
    /// Places the tank of a scene.
    pub fn of(spec: &SceneSpec) -> Self {
        let cell = spec.grid.cell.si();
        let whole = |metres: f64| ceil_half_down(metres / cell).max(0) as usize;
        let up = |metres: f64| (metres / cell - 1e-9).ceil().max(0.0) as usize;
        let (tank, pml) = (&spec.tank, spec.grid.absorbing_cells);
        let side = pml + up(tank.margin.si());
        let below = if tank.metal_plate { PLATE_CELLS } else { side };
        let wall = tank.wall.si();
        let nx = 2 * side + whole(tank.width.si() + 2.0 * wall);
        let stack = tank.base.si() + tank.height.si() + spec.antenna.height.si();
        let ny = below + whole(stack) + side;
        let bed_origin = [side as f64 * cell + wall, below as f64 * cell + tank.base.si()];
        let middle = bed_origin[0] + spec.antenna.position.map_or(0.5 * tank.width.si(), |position| position.si());
        let y = bed_origin[1] + tank.height.si() + spec.antenna.height.si();
        let half = 0.5 * spec.antenna.separation.si();
        let (nz, pml_z, front, across) = match spec.grid.dimension {
            Dimension::Two => (1, 0, 0.0, 0.0),
            Dimension::Three => {
                let (depth, front) = (tank.inner_depth().si(), side as f64 * cell + wall);
                // Where the section that the 2-D model shows lies; the dipole's edge begins half a cell before it.
                let across = front + spec.packing.slice.map_or(0.5 * depth, |slice| slice.si()) - 0.5 * cell;
                (2 * side + whole(depth + 2.0 * wall), pml, front, across)
            }
        };
        Self {
            grid: Grid { cells: [nx, ny, nz], spacing: [cell; 3] },
            absorbing_cells: [pml, if tank.metal_plate { 0 } else { pml }, pml_z, pml, pml, pml_z],
            bed_origin,
            front,
            plate_height: if tank.metal_plate { below as f64 * cell } else { 0.0 },
            source: [middle - half, y, across],
            receiver: [middle + half, y, across],
        }
    }
}
