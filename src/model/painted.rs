//! The cells and z edges of a two-dimensional model.

use super::{EdgeMaterial, MaterialId};

/// The cells and edges of a two-dimensional model (invariant along z).
#[derive(Debug, Clone, PartialEq)]
pub struct Painted {
    /// Cells along x and y.
    pub cells_xy: [usize; 2],
    /// Material of each cell: `solid[i * ny + j]`.
    pub solid: Vec<MaterialId>,
    /// Distinct edge materials.
    pub palette: Vec<EdgeMaterial>,
    /// Index into `palette` of the z edge at each node: `edge_z[i * (ny + 1) + j]`.
    pub edge_z: Vec<u32>,
    /// How many z edges hold the mean of two or more different materials.
    pub averaged_edges: usize,
}

impl Painted {
    /// What lies on the z edge at node `(i, j)`.
    pub fn edge(&self, i: usize, j: usize) -> &EdgeMaterial {
        &self.palette[self.edge_z[i * (self.cells_xy[1] + 1) + j] as usize]
    }

    /// How many z edges hold each entry of the palette.
    pub fn edges_per_entry(&self) -> Vec<usize> {
        let mut count = vec![0; self.palette.len()];
        for &entry in &self.edge_z {
            count[entry as usize] += 1;
        }
        count
    }

    /// How many cells hold each of `materials` materials.
    pub fn cells_per_material(&self, materials: usize) -> Vec<usize> {
        let mut count = vec![0; materials];
        for id in &self.solid {
            count[id.index()] += 1;
        }
        count
    }
}
