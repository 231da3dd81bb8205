//! The cells, edges and faces of a three-dimensional model.

use super::{EdgeMaterial, FaceMaterial, Indices, MaterialId};

/// The cells, edges and faces of a model on any grid.
///
/// Node `(i, j, k)` has the place `(i * (ny + 1) + j) * (nz + 1) + k` in the lists of edges and faces: the x edge there
/// runs from this node to the next along x, and so on; the x face there lies between this node and the next along y and z.
#[derive(Debug, Clone, PartialEq)]
pub struct Painted3 {
    /// Cells along x, y, z.
    pub cells: [usize; 3],
    /// Material of each cell: `solid[(i * ny + j) * nz + k]`.
    pub solid: Vec<MaterialId>,
    /// Distinct edge materials.
    pub palette: Vec<EdgeMaterial>,
    /// Index into `palette` of the x, y and z edge at each node.
    pub edges: [Indices; 3],
    /// Distinct face materials; empty where nothing on the grid is magnetic.
    pub face_palette: Vec<FaceMaterial>,
    /// Index into `face_palette` of the x, y and z face at each node; empty where nothing on the grid is magnetic.
    pub faces: [Indices; 3],
    /// How many x, y and z edges hold the mean of two or more different materials.
    pub averaged_edges: [usize; 3],
    /// What couples the axes at nodes on surfaces, in the order of the nodes; empty but for
    /// [`Averaging::Tensors`](super::Averaging::Tensors).
    pub couplings: Vec<Coupling>,
}

/// The part of the inverse permittivity at a node on a surface that lets D along one axis make E along another.
///
/// Kottke, Farjadpour & Johnson 2008 (doi:10.1103/PhysRevE.77.036611): with the normal `n` of the surface and means over the
/// box around the node, `(1/eps)_ab = n_a n_b (<1/eps> - 1/<eps>)`, `a != b`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coupling {
    /// Place of the node.
    pub node: usize,
    /// Between y and z, z and x, x and y.
    pub inverse: [f64; 3],
}

impl Painted3 {
    /// Place of a node in the lists of edges and faces.
    #[inline]
    pub fn node(&self, [i, j, k]: [usize; 3]) -> usize {
        let [_, ny, nz] = self.cells;
        (i * (ny + 1) + j) * (nz + 1) + k
    }

    /// What lies on the edge along `axis` (0, 1, 2) from a node.
    pub fn edge(&self, axis: usize, node: [usize; 3]) -> &EdgeMaterial {
        &self.palette[self.edges[axis].get(self.node(node)) as usize]
    }

    /// How many edges hold each entry of the palette.
    pub fn edges_per_entry(&self) -> Vec<usize> {
        let mut count = vec![0; self.palette.len()];
        self.edges.iter().for_each(|edges| edges.count_into(&mut count));
        count
    }

    /// How many cells hold each of `materials` materials.
    pub fn cells_per_material(&self, materials: usize) -> Vec<usize> {
        let mut count = vec![0; materials];
        self.solid.iter().for_each(|id| count[id.index()] += 1);
        count
    }

    /// Memory that it takes, bytes.
    pub fn bytes(&self) -> usize {
        let indices: usize = self.edges.iter().chain(&self.faces).map(Indices::bytes).sum();
        indices + self.solid.len() * size_of::<MaterialId>() + self.couplings.len() * size_of::<Coupling>()
    }

    /// The planes of cells `planes` only, as a grid of its own; `averaged_edges` stays that of the whole.
    ///
    /// # Panics
    /// When a plane lies beyond the grid.
    pub fn cut_x(&self, planes: std::ops::Range<usize>) -> Self {
        let [_, ny, nz] = self.cells;
        let nodes = planes.start * (ny + 1) * (nz + 1)..(planes.end + 1) * (ny + 1) * (nz + 1);
        let cut = |list: &Indices| if list.is_empty() { list.clone() } else { list.cut(nodes.clone()) };
        let within = self.couplings.iter().filter(|coupling| nodes.contains(&coupling.node));
        let couplings = within.map(|coupling| Coupling { node: coupling.node - nodes.start, ..*coupling }).collect();
        Self {
            cells: [planes.len(), ny, nz],
            solid: self.solid[planes.start * ny * nz..planes.end * ny * nz].into(),
            palette: self.palette.clone(),
            edges: self.edges.each_ref().map(cut),
            face_palette: self.face_palette.clone(),
            faces: self.faces.each_ref().map(cut),
            averaged_edges: self.averaged_edges,
            couplings,
        }
    }
}
