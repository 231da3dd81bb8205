//! From objects to cells and edges, by gprMax's rules.
//!
//! Coordinates snap to the nearest node (halves go down). A cell belongs to a cylinder when its centre does. Objects are
//! painted in order, the later over the earlier. An edge takes the arithmetic mean of the four cells around it, unless one
//! of them *claims* it: cells painted without averaging, of a perfect conductor or of a dispersive material claim their
//! edges, and the last to claim an edge gives it its material. Painting a cell anew drops only that cell's own claim.

use super::palette::{EdgeMaterial, Palette};
use super::{Grid, Material, MaterialId, Model, Object, Voxels, paint3};

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

/// Why a model could not be painted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PaintError {
    /// The grid is not two-dimensional with z as the invariant axis.
    #[error(
        "a grid of {0} x {1} x {2} cells is not two-dimensional along z\n\n\
         hint: give z a single cell, and x and y more than one; other grids run with `--solver gprmax`",
        cells[0], cells[1], cells[2]
    )]
    NotTwoDimensional {
        /// Cell counts.
        cells: [usize; 3],
    },
    /// An object that fills no cell; gprMax refuses it too.
    #[error(
        "object {number}, a {kind} of `{material}` at ({x} m, {y} m), fills no cell of {cell} m\n\n\
         hint: make the object larger than a cell, make the cells smaller, or leave it out"
    )]
    FillsNoCell {
        /// Place in the list of objects, from 1.
        number: usize,
        /// `box`, `cylinder`, `sphere` or `block of voxels`.
        kind: &'static str,
        /// Identifier of its material.
        material: String,
        /// Where it begins, m.
        x: f64,
        /// Where it begins, m.
        y: f64,
        /// The longer side of a cell, m.
        cell: f64,
    },
    /// An object of a material that the model does not hold.
    #[error("object {number} asks for material number {material}, but the model has {materials}")]
    NoSuchMaterial {
        /// Place in the list of objects, from 1.
        number: usize,
        /// The index asked for.
        material: usize,
        /// How many there are.
        materials: usize,
    },
    /// A block of voxels whose list of cells has another length than its shape says.
    #[error("object {number}, a block of {0} x {1} x {2} voxels, holds {cells} of them", shape[0], shape[1], shape[2])]
    VoxelCount {
        /// Place in the list of objects, from 1.
        number: usize,
        /// Cells along x, y, z.
        shape: [usize; 3],
        /// Cells given.
        cells: usize,
    },
}

/// Paints the objects of a model that is invariant along z.
///
/// Takes about 10 ns per painted cell; a cylinder visits only the cells of its bounding box.
///
/// # Errors
/// When the grid is not two-dimensional along z, or an object fills no cell or has no such material.
pub fn paint(model: &Model) -> Result<Painted, PaintError> {
    check_two_dimensional(model)?;
    if model.objects.iter().any(|object| matches!(object, Object::Sphere { .. })) {
        return Ok(paint3(model)?.into_plane());
    }
    let mut canvas = Canvas::new(model);
    for (index, object) in model.objects.iter().enumerate() {
        canvas.object(index + 1, object)?;
    }
    Ok(canvas.edges())
}

/// Refuses grids that are not two-dimensional along z.
///
/// # Errors
/// With the cell counts, when z has more than one cell, or x or y only one.
pub fn check_two_dimensional(model: &Model) -> Result<(), PaintError> {
    let cells = model.grid.cells;
    if model.grid.invariant_axis() != Some(2) || cells.contains(&0) {
        return Err(PaintError::NotTwoDimensional { cells });
    }
    Ok(())
}

/// Cells and claims while objects are being painted.
struct Canvas<'a> {
    grid: Grid,
    materials: &'a [Material],
    nx: usize,
    ny: usize,
    solid: Vec<MaterialId>,
    /// Whether the cell claims its edges.
    claims: Vec<bool>,
    /// The last material that claimed the z edge at a node.
    claimed_by: Vec<MaterialId>,
}

impl<'a> Canvas<'a> {
    fn new(model: &'a Model) -> Self {
        let [nx, ny, _] = model.grid.cells;
        Self {
            grid: model.grid,
            materials: &model.materials,
            nx,
            ny,
            solid: vec![MaterialId::FREE_SPACE; nx * ny],
            claims: vec![false; nx * ny],
            claimed_by: vec![MaterialId::FREE_SPACE; (nx + 1) * (ny + 1)],
        }
    }

    fn object(&mut self, number: usize, object: &Object) -> Result<(), PaintError> {
        let (kind, material, start, filled) = match object {
            &Object::Box { lower, upper, material, averaging } => {
                self.known(number, material)?;
                ("box", material, lower, self.fill_box(lower, upper, material, averaging))
            }
            &Object::Cylinder { start, end, radius, material, averaging } => {
                self.known(number, material)?;
                ("cylinder", material, start, self.fill_cylinder(start, end, radius, material, averaging))
            }
            &Object::Sphere { centre, material, .. } => {
                self.known(number, material)?;
                // `paint` hands models with spheres to `paint3`.
                ("sphere", material, centre, 0)
            }
            Object::Voxels(voxels) => {
                if voxels.shape.iter().product::<usize>() != voxels.cells.len() {
                    let (shape, cells) = (voxels.shape, voxels.cells.len());
                    return Err(PaintError::VoxelCount { number, shape, cells });
                }
                let first = voxels.cells.iter().flatten().copied();
                for material in first.clone() {
                    self.known(number, material)?;
                }
                let material = first.clone().next().unwrap_or(MaterialId::FREE_SPACE);
                ("block of voxels", material, voxels.origin, self.fill_voxels(voxels))
            }
        };
        if filled > 0 {
            return Ok(());
        }
        let material = self.materials[material.index()].id.clone();
        let cell = self.grid.spacing[0].max(self.grid.spacing[1]);
        Err(PaintError::FillsNoCell { number, kind, material, x: start[0], y: start[1], cell })
    }

    fn known(&self, number: usize, material: MaterialId) -> Result<(), PaintError> {
        let materials = self.materials.len();
        if material.index() < materials {
            return Ok(());
        }
        Err(PaintError::NoSuchMaterial { number, material: material.index(), materials })
    }

    /// Whether a cell of this material claims its edges.
    fn rigid(&self, material: MaterialId, averaging: bool) -> bool {
        let material = &self.materials[material.index()];
        !averaging || material.is_pec() || material.is_dispersive() || !material.averagable
    }

    #[inline]
    fn cell(&mut self, i: usize, j: usize, material: MaterialId, rigid: bool) {
        let cell = i * self.ny + j;
        self.solid[cell] = material;
        self.claims[cell] = rigid;
        if rigid {
            let node = i * (self.ny + 1) + j;
            self.claimed_by[node..node + 2].fill(material);
            self.claimed_by[node + self.ny + 1..node + self.ny + 3].fill(material);
        }
    }

    /// Nodes `[lower, upper)` along an axis, cut to the grid.
    fn span(&self, axis: usize, lower: f64, upper: f64) -> std::ops::Range<usize> {
        let end = self.grid.cells[axis] as i64;
        let node = |metres| self.grid.node(axis, metres).clamp(0, end) as usize;
        node(lower)..node(upper)
    }

    fn fill_box(&mut self, lower: [f64; 3], upper: [f64; 3], material: MaterialId, averaging: bool) -> usize {
        let [x, y, z] = std::array::from_fn(|axis| self.span(axis, lower[axis], upper[axis]));
        if z.is_empty() || y.is_empty() {
            return 0;
        }
        let rigid = self.rigid(material, averaging);
        for i in x.clone() {
            if rigid {
                for j in y.clone() {
                    self.cell(i, j, material, true);
                }
            } else {
                self.solid[i * self.ny..][y.clone()].fill(material);
                self.claims[i * self.ny..][y.clone()].fill(false);
            }
        }
        x.len() * y.len()
    }

    fn fill_cylinder(
        &mut self,
        start: [f64; 3],
        end: [f64; 3],
        radius: f64,
        material: MaterialId,
        averaging: bool,
    ) -> usize {
        let d = self.grid.spacing;
        let snap = |p: [f64; 3]| -> [f64; 3] { std::array::from_fn(|a| self.grid.node(a, p[a]) as f64 * d[a]) };
        let (start, end) = (snap(start), snap(end));
        let axis: [f64; 3] = std::array::from_fn(|a| end[a] - start[a]);
        let length_squared: f64 = axis.iter().map(|v| v * v).sum();
        if length_squared == 0.0 {
            return 0;
        }
        let bounds = |a: usize| {
            let (low, high) = (start[a].min(end[a]) - radius, start[a].max(end[a]) + radius);
            let clamp = |v: f64| v.clamp(0.0, self.grid.cells[a] as f64) as usize;
            clamp((low / d[a]).floor() - 1.0)..clamp((high / d[a]).ceil() + 1.0)
        };
        let (x, y) = (bounds(0), bounds(1));
        let rigid = self.rigid(material, averaging);
        let mut filled = 0;
        for i in x {
            for j in y.clone() {
                let centre = [(i as f64 + 0.5) * d[0], (j as f64 + 0.5) * d[1], 0.5 * d[2]];
                let from: [f64; 3] = std::array::from_fn(|a| centre[a] - start[a]);
                let t = from.iter().zip(axis).map(|(f, a)| f * a).sum::<f64>() / length_squared;
                let distance_squared: f64 = from.iter().zip(axis).map(|(f, a)| (f - t * a).powi(2)).sum();
                if (0.0..=1.0).contains(&t) && distance_squared <= radius * radius {
                    self.cell(i, j, material, rigid);
                    filled += 1;
                }
            }
        }
        filled
    }

    fn fill_voxels(&mut self, voxels: &Voxels) -> usize {
        let origin: [i64; 3] = std::array::from_fn(|axis| self.grid.node(axis, voxels.origin[axis]));
        let [_, my, mz] = voxels.shape;
        let mut filled = 0;
        for (index, material) in voxels.cells.iter().enumerate() {
            let Some(material) = *material else { continue };
            let at = [index / (my * mz), index / mz % my, index % mz];
            let [i, j, k]: [i64; 3] = std::array::from_fn(|axis| origin[axis] + at[axis] as i64);
            if k == 0 && (0..self.nx as i64).contains(&i) && (0..self.ny as i64).contains(&j) {
                let rigid = self.rigid(material, voxels.averaging);
                self.cell(i as usize, j as usize, material, rigid);
                filled += 1;
            }
        }
        filled
    }

    /// Settles what lies on each edge.
    fn edges(self) -> Painted {
        let (nx, ny) = (self.nx, self.ny);
        let mut palette = Palette::new(self.materials);
        let mut edge_z = Vec::with_capacity((nx + 1) * (ny + 1));
        let mut averaged_edges = 0;
        for i in 0..=nx {
            let (west, east) = (i.saturating_sub(1) * ny, i.min(nx - 1) * ny);
            for j in 0..=ny {
                let (south, north) = (j.saturating_sub(1), j.min(ny - 1));
                let around = [west + south, west + north, east + south, east + north];
                if around.iter().any(|&cell| self.claims[cell]) {
                    edge_z.push(palette.pure(self.claimed_by[i * (ny + 1) + j]));
                    continue;
                }
                let ids = around.map(|cell| self.solid[cell]);
                if ids.iter().all(|&id| id == ids[0]) {
                    edge_z.push(palette.pure(ids[0]));
                } else {
                    edge_z.push(palette.mean(ids));
                    averaged_edges += 1;
                }
            }
        }
        Painted { cells_xy: [nx, ny], solid: self.solid, palette: palette.into_entries(), edge_z, averaged_edges }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::model::TimeWindow;

    fn model(nx: usize, ny: usize) -> Model {
        Model::new("", Grid { cells: [nx, ny, 1], spacing: [0.002; 3] }, TimeWindow::Iterations(1))
    }

    fn cuboid(cells: [usize; 4], material: MaterialId, averaging: bool) -> Object {
        let [i0, j0, i1, j1] = cells.map(|c| c as f64 * 0.002);
        Object::Box { lower: [i0, j0, 0.0], upper: [i1, j1, 0.002], material, averaging }
    }

    fn cylinder(x: f64, y: f64, radius: f64, material: MaterialId) -> Object {
        Object::Cylinder { start: [x, y, 0.0], end: [x, y, 0.002], radius, material, averaging: true }
    }

    /// An edge on a flat face between 1 and 6 holds 3.5, on a corner (one cell of 6 in four) 2.25, inside 6.
    #[test]
    fn edges_hold_the_mean_of_four_cells() {
        let mut model = model(8, 8);
        let stone = model.add_material(Material::dielectric("stone", 6.0, 0.004));
        model.objects.push(cuboid([2, 2, 5, 5], stone, true));
        let painted = paint(&model).unwrap();
        assert_eq!(painted.edge(2, 2).eps_r, 2.25);
        assert_eq!(painted.edge(2, 3).eps_r, 3.5);
        assert_eq!(painted.edge(2, 3).sigma, 0.002);
        assert_eq!(painted.edge(3, 3).eps_r, 6.0);
        assert_eq!(painted.edge(0, 0).eps_r, 1.0);
        // Rim of 3 x 3 cells: 12 edges.
        assert_eq!(painted.averaged_edges, 12);
    }

    /// Without averaging the box owns all edges of its cells, rim included.
    #[test]
    fn a_box_without_averaging_owns_its_rim() {
        let mut model = model(8, 8);
        let stone = model.add_material(Material::dielectric("stone", 6.0, 0.0));
        model.objects.push(cuboid([2, 2, 5, 5], stone, false));
        let painted = paint(&model).unwrap();
        assert_eq!(painted.edge_z.iter().filter(|&&e| painted.palette[e as usize].eps_r == 6.0).count(), 16);
        assert_eq!(painted.averaged_edges, 0);
    }

    /// A later averaging cell drops only its own claim: the rim shared with a claiming neighbour keeps the id of the last
    /// claimant, even where that one has been painted over since.
    #[test]
    fn the_last_claim_on_an_edge_stands() {
        let mut model = model(6, 6);
        let first = model.add_material(Material::dielectric("first", 2.0, 0.0));
        let second = model.add_material(Material::dielectric("second", 3.0, 0.0));
        let third = model.add_material(Material::dielectric("third", 5.0, 0.0));
        model.objects.push(cuboid([1, 1, 3, 5], first, false));
        model.objects.push(cuboid([3, 1, 5, 5], second, false));
        model.objects.push(cuboid([3, 1, 5, 5], third, true));
        let painted = paint(&model).unwrap();
        assert_eq!(painted.edge(3, 3).eps_r, 3.0);
        assert_eq!(painted.edge(4, 3).eps_r, 5.0);
        assert_eq!(painted.edge(5, 3).eps_r, (5.0 + 5.0 + 1.0 + 1.0) / 4.0);
    }

    /// The axis snaps to the nearest node, half going down; the radius does not: r = 1.6 cells about a node holds the
    /// 4 x 4 cells less the corners (centres at 0.71, 1.58 and 2.12 cells).
    #[test]
    fn cylinders_snap_their_axis_but_not_their_radius() {
        for x in [0.0091, 0.0109, 0.011] {
            let mut model = model(10, 10);
            let stone = model.add_material(Material::dielectric("stone", 6.0, 0.0));
            model.objects.push(cylinder(x, 0.010, 0.0032, stone));
            let painted = paint(&model).unwrap();
            let inside = |i: usize, j: usize| painted.solid[i * 10 + j] == stone;
            assert_eq!(painted.cells_per_material(3)[2], 12, "x = {x}");
            assert!(inside(3, 4) && inside(4, 3) && inside(6, 5) && !inside(3, 3), "x = {x}");
        }
    }

    #[test]
    fn objects_that_fill_no_cell_are_named() {
        let mut model = model(10, 10);
        let stone = model.add_material(Material::dielectric("stone", 6.0, 0.0));
        model.objects.push(cylinder(0.01, 0.01, 0.0005, stone));
        let message = paint(&model).unwrap_err().to_string();
        assert!(message.starts_with("object 1, a cylinder of `stone` at (0.01 m, 0.01 m), fills no cell of 0.002 m"));
    }

    /// Boxes are cut to the grid; one outside fills nothing.
    #[test]
    fn boxes_are_cut_to_the_grid() {
        let mut m = model(4, 4);
        let stone = m.add_material(Material::dielectric("stone", 6.0, 0.0));
        m.objects = vec![Object::Box { lower: [-1.0; 3], upper: [1.0; 3], material: stone, averaging: true }];
        assert_eq!(paint(&m).unwrap().palette.len(), 1);
        m.objects = vec![cuboid([5, 5, 7, 7], stone, true)];
        assert!(paint(&m).is_err());
    }

    /// Voxels of a conductor and of "leave as it is", in a block that hangs over the grid's corner.
    #[test]
    fn voxels_leave_cells_that_hold_nothing() {
        let mut model = model(3, 3);
        let cells: Arc<[_]> = vec![Some(MaterialId::PEC), None, None, Some(MaterialId::PEC)].into();
        model.objects.push(Object::Voxels(Voxels {
            origin: [0.004, 0.004, 0.0],
            shape: [2, 2, 1],
            cells,
            averaging: true,
        }));
        let painted = paint(&model).unwrap();
        assert_eq!(painted.cells_per_material(2), [1, 8]);
        assert!(painted.edge(2, 2).sigma.is_infinite() && painted.edge(3, 3).sigma.is_infinite());
        assert_eq!(painted.edge(1, 2).sigma, 0.0);
    }

    proptest::proptest! {
        /// A box painted as a box and as voxels yields the same edges.
        #[test]
        fn voxels_and_boxes_agree(i0 in 0usize..5, j0 in 0usize..5, wide in 1usize..5, high in 1usize..5, averaging: bool) {
            let mut with_box = model(9, 9);
            let stone = with_box.add_material(Material::dielectric("stone", 6.0, 0.01));
            let mut with_voxels = with_box.clone();
            with_box.objects.push(cuboid([i0, j0, i0 + wide, j0 + high], stone, averaging));
            let origin = [i0 as f64 * 0.002, j0 as f64 * 0.002, 0.0];
            let cells = vec![Some(stone); wide * high].into();
            with_voxels.objects.push(Object::Voxels(Voxels { origin, shape: [wide, high, 1], cells, averaging }));
            proptest::prop_assert_eq!(paint(&with_box).unwrap(), paint(&with_voxels).unwrap());
        }
    }
}
