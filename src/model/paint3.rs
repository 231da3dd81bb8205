//! From objects to cells, edges and faces on any grid, by gprMax's rules: those of `paint`, along three axes.

use std::ops::Range;

use super::palette::{FaceMaterial, Palette};
use super::{CheckError, Grid, Indices, Material, MaterialId, Model, Object, PaintError, Painted3, Voxels};

/// Paints the objects of a model on any grid; [`paint`](super::paint) does the same for a plane along z in less memory.
///
/// Takes about 10 ns per painted cell and 10 ns per edge; round objects visit only the cells of their bounding box. Holds
/// nine bytes a cell while it paints, and five when it is done (with up to 256 distinct edge materials).
///
/// # Errors
/// When an object fills no cell or has no such material.
pub fn paint3(model: &Model) -> Result<Painted3, PaintError> {
    let mut canvas = Canvas::new(model);
    for (index, object) in model.objects.iter().enumerate() {
        canvas.object(index + 1, object)?;
    }
    Ok(canvas.settle())
}

/// Refuses grids without cells and grids with more than one axis of a single cell.
///
/// # Errors
/// With the cell counts and sizes.
pub fn check_grid(grid: &Grid) -> Result<(), CheckError> {
    let Grid { cells, spacing } = *grid;
    if cells.contains(&0) || cells.iter().filter(|&&count| count == 1).count() > 1 {
        return Err(CheckError::Grid { cells, spacing });
    }
    Ok(())
}

/// Cells and claims while objects are being painted.
struct Canvas<'a> {
    grid: Grid,
    materials: &'a [Material],
    /// Cells along x, y, z.
    n: [usize; 3],
    solid: Vec<MaterialId>,
    /// Whether the cell claims its edges; empty while no cell does.
    claims: Vec<bool>,
    /// The last material that claimed the x, y and z edge at a node; empty while no cell claims.
    claimed_by: [Vec<MaterialId>; 3],
    /// The same for the x, y and z face at a node; empty while no cell claims, and where no material is magnetic.
    face_claimed_by: [Vec<MaterialId>; 3],
}

impl<'a> Canvas<'a> {
    fn new(model: &'a Model) -> Self {
        let n = model.grid.cells;
        let solid = vec![MaterialId::FREE_SPACE; n.iter().product()];
        let none = || [vec![], vec![], vec![]];
        let (claimed_by, face_claimed_by) = (none(), none());
        Self { grid: model.grid, materials: &model.materials, n, solid, claims: vec![], claimed_by, face_claimed_by }
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
            &Object::Sphere { centre, radius, material, averaging } => {
                self.known(number, material)?;
                ("sphere", material, centre, self.fill_sphere(centre, radius, material, averaging))
            }
            Object::Voxels(voxels) => {
                if voxels.shape.iter().product::<usize>() != voxels.cells.len() {
                    let (shape, cells) = (voxels.shape, voxels.cells.len());
                    return Err(PaintError::VoxelCount { number, shape, cells });
                }
                for &material in voxels.cells.iter().flatten() {
                    self.known(number, material)?;
                }
                let material = voxels.cells.iter().flatten().next().copied().unwrap_or(MaterialId::FREE_SPACE);
                ("block of voxels", material, voxels.origin, self.fill_voxels(voxels))
            }
        };
        if filled > 0 {
            return Ok(());
        }
        let material = self.materials[material.index()].id.clone();
        let cell = self.grid.spacing.iter().fold(0.0f64, |longest, d| longest.max(*d));
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

    /// Paints the cells `z` of a column.
    #[inline]
    fn run(&mut self, i: usize, j: usize, z: Range<usize>, material: MaterialId, rigid: bool) {
        let [_, ny, nz] = self.n;
        let first = (i * ny + j) * nz;
        self.solid[first..][z.clone()].fill(material);
        if rigid {
            self.begin_claims();
        }
        if !self.claims.is_empty() {
            self.claims[first..][z.clone()].fill(rigid);
        }
        if !rigid || z.is_empty() {
            return;
        }
        let node = |i: usize, j: usize| (i * (ny + 1) + j) * (nz + 1);
        let [x, y, along_z] = &mut self.claimed_by;
        for (di, dj) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            along_z[node(i + di, j + dj)..][z.clone()].fill(material);
        }
        let both = z.start..z.end + 1;
        for d in [0, 1] {
            x[node(i, j + d)..][both.clone()].fill(material);
            y[node(i + d, j)..][both.clone()].fill(material);
        }
        let [x, y, across_z] = &mut self.face_claimed_by;
        if !x.is_empty() {
            for d in [0, 1] {
                x[node(i + d, j)..][z.clone()].fill(material);
                y[node(i, j + d)..][z.clone()].fill(material);
            }
            across_z[node(i, j)..][both].fill(material);
        }
    }

    fn begin_claims(&mut self) {
        if self.claims.is_empty() {
            self.claims = vec![false; self.solid.len()];
            let nodes = self.n.iter().map(|n| n + 1).product();
            self.claimed_by = std::array::from_fn(|_| vec![MaterialId::FREE_SPACE; nodes]);
            if self.materials.iter().any(Material::is_magnetic) {
                self.face_claimed_by = self.claimed_by.clone();
            }
        }
    }

    /// Nodes `[lower, upper)` along an axis, cut to the grid.
    fn span(&self, axis: usize, lower: f64, upper: f64) -> Range<usize> {
        let end = self.grid.cells[axis] as i64;
        let node = |metres| self.grid.node(axis, metres).clamp(0, end) as usize;
        node(lower)..node(upper)
    }

    fn fill_box(&mut self, lower: [f64; 3], upper: [f64; 3], material: MaterialId, averaging: bool) -> usize {
        let [x, y, z] = std::array::from_fn(|axis| self.span(axis, lower[axis], upper[axis]));
        let rigid = self.rigid(material, averaging);
        for i in x.clone() {
            for j in y.clone() {
                self.run(i, j, z.clone(), material, rigid);
            }
        }
        x.len() * y.len() * z.len()
    }

    /// Paints the cells whose centres fulfil a condition, within a box around `low` and `high`, m.
    fn fill_where(
        &mut self,
        [low, high]: [[f64; 3]; 2],
        material: MaterialId,
        averaging: bool,
        inside: impl Fn([f64; 3]) -> bool,
    ) -> usize {
        let d = self.grid.spacing;
        let [x, y, z] = std::array::from_fn(|axis| {
            let clamp = |v: f64| v.clamp(0.0, self.n[axis] as f64) as usize;
            clamp((low[axis] / d[axis]).floor() - 1.0)..clamp((high[axis] / d[axis]).ceil() + 1.0)
        });
        let rigid = self.rigid(material, averaging);
        let centre = |cell: usize, axis: usize| (cell as f64 + 0.5) * d[axis];
        let mut filled = 0;
        for i in x {
            for j in y.clone() {
                let (at_x, at_y) = (centre(i, 0), centre(j, 1));
                let mut k = z.start;
                while k < z.end {
                    let begin = k;
                    while k < z.end && inside([at_x, at_y, centre(k, 2)]) {
                        k += 1;
                    }
                    if k > begin {
                        self.run(i, j, begin..k, material, rigid);
                        filled += k - begin;
                    }
                    k += 1;
                }
            }
        }
        filled
    }

    fn snap(&self, point: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|axis| self.grid.node(axis, point[axis]) as f64 * self.grid.spacing[axis])
    }

    fn fill_cylinder(
        &mut self,
        start: [f64; 3],
        end: [f64; 3],
        radius: f64,
        material: MaterialId,
        averaging: bool,
    ) -> usize {
        let (start, end) = (self.snap(start), self.snap(end));
        let axis: [f64; 3] = std::array::from_fn(|a| end[a] - start[a]);
        let length_squared: f64 = axis.iter().map(|v| v * v).sum();
        if length_squared == 0.0 {
            return 0;
        }
        let low = std::array::from_fn(|a| start[a].min(end[a]) - radius);
        let high = std::array::from_fn(|a| start[a].max(end[a]) + radius);
        self.fill_where([low, high], material, averaging, |centre| {
            let from: [f64; 3] = std::array::from_fn(|a| centre[a] - start[a]);
            let t = from.iter().zip(axis).map(|(f, a)| f * a).sum::<f64>() / length_squared;
            let distance_squared: f64 = from.iter().zip(axis).map(|(f, a)| (f - t * a).powi(2)).sum();
            (0.0..=1.0).contains(&t) && distance_squared <= radius * radius
        })
    }

    fn fill_sphere(&mut self, centre: [f64; 3], radius: f64, material: MaterialId, averaging: bool) -> usize {
        let middle = self.snap(centre);
        let bounds = [middle.map(|v| v - radius), middle.map(|v| v + radius)];
        self.fill_where(bounds, material, averaging, |centre| {
            let distance_squared: f64 = centre.iter().zip(middle).map(|(c, m)| (c - m).powi(2)).sum();
            distance_squared <= radius * radius
        })
    }

    fn fill_voxels(&mut self, voxels: &Voxels) -> usize {
        let origin: [i64; 3] = std::array::from_fn(|axis| self.grid.node(axis, voxels.origin[axis]));
        let [_, my, mz] = voxels.shape;
        let mut filled = 0;
        for (index, material) in voxels.cells.iter().enumerate() {
            let Some(material) = *material else { continue };
            let at = [index / (my * mz), index / mz % my, index % mz];
            let cell: [i64; 3] = std::array::from_fn(|axis| origin[axis] + at[axis] as i64);
            if (0..3).all(|axis| (0..self.n[axis] as i64).contains(&cell[axis])) {
                let rigid = self.rigid(material, voxels.averaging);
                let [i, j, k] = cell.map(|index| index as usize);
                self.run(i, j, k..k + 1, material, rigid);
                filled += 1;
            }
        }
        filled
    }

    /// Settles what lies on each edge and face.
    fn settle(self) -> Painted3 {
        let mut palette = Palette::new(self.materials);
        let mut averaged_edges = [0; 3];
        let edges = std::array::from_fn(|axis| self.edges(axis, &mut palette, &mut averaged_edges[axis]));
        let (faces, face_palette) = self.faces();
        let palette = palette.into_entries();
        Painted3 { cells: self.n, solid: self.solid, palette, edges, face_palette, faces, averaged_edges }
    }

    /// The edges along an axis. Of the four cells around one, those beyond the outer wall are the ones within.
    fn edges(&self, axis: usize, palette: &mut Palette<'_>, averaged: &mut usize) -> Indices {
        let [nx, ny, nz] = self.n;
        let below = |node: usize, of: usize| if axis == of { node.min(self.n[of] - 1) } else { node.saturating_sub(1) };
        let above = |node: usize, of: usize| node.min(self.n[of] - 1);
        let mut edges = Indices::with_capacity((nx + 1) * (ny + 1) * (nz + 1));
        let mut node = 0;
        for i in 0..=nx {
            for j in 0..=ny {
                let column = |i: usize, j: usize| (i * ny + j) * nz;
                let (low_i, high_i, low_j, high_j) = (below(i, 0), above(i, 0), below(j, 1), above(j, 1));
                for k in 0..=nz {
                    let (low_k, high_k) = (below(k, 2), above(k, 2));
                    let around = match axis {
                        0 => [(i, low_j, low_k), (i, low_j, high_k), (i, high_j, low_k), (i, high_j, high_k)],
                        1 => [(low_i, j, low_k), (low_i, j, high_k), (high_i, j, low_k), (high_i, j, high_k)],
                        _ => [(low_i, low_j, k), (low_i, high_j, k), (high_i, low_j, k), (high_i, high_j, k)],
                    };
                    let around = around.map(|(i, j, k)| column(i.min(nx - 1), j.min(ny - 1)) + k.min(nz - 1));
                    let claimed = !self.claims.is_empty() && around.iter().any(|&cell| self.claims[cell]);
                    let entry = if claimed {
                        palette.pure(self.claimed_by[axis][node])
                    } else {
                        let ids = around.map(|cell| self.solid[cell]);
                        if ids.iter().all(|&id| id == ids[0]) {
                            palette.pure(ids[0])
                        } else {
                            *averaged += usize::from([i, j, k][axis] < self.n[axis]);
                            palette.mean(ids)
                        }
                    };
                    edges.push(entry);
                    node += 1;
                }
            }
        }
        edges
    }

    /// The faces, where anything on the grid is magnetic: the harmonic mean of the two cells that share one, unless either
    /// claims it.
    fn faces(&self) -> ([Indices; 3], Vec<FaceMaterial>) {
        let magnetic: Vec<bool> = self.materials.iter().map(Material::is_magnetic).collect();
        let none = || Indices::with_capacity(0);
        if !self.solid.iter().any(|id| magnetic[id.index()]) {
            return ([none(), none(), none()], vec![]);
        }
        let [nx, ny, nz] = self.n;
        let mut entries: Vec<FaceMaterial> = vec![];
        let faces = std::array::from_fn(|axis| {
            let mut faces = none();
            for node in 0..(nx + 1) * (ny + 1) * (nz + 1) {
                let at = [node / ((ny + 1) * (nz + 1)), node / (nz + 1) % (ny + 1), node % (nz + 1)];
                let cell = |low: bool| {
                    let mut at = at;
                    at[axis] = if low { at[axis].saturating_sub(1) } else { at[axis] };
                    let [i, j, k] = std::array::from_fn(|a| at[a].min(self.n[a] - 1));
                    (i * ny + j) * nz + k
                };
                let sides = [cell(true), cell(false)];
                let claimed = !self.claims.is_empty() && sides.iter().any(|&side| self.claims[side]);
                let [a, b] =
                    if claimed { [self.face_claimed_by[axis][node]; 2] } else { sides.map(|side| self.solid[side]) };
                let face = FaceMaterial::between(&self.materials[a.index()], &self.materials[b.index()]);
                let entry = entries.iter().position(|known| *known == face).unwrap_or_else(|| {
                    entries.push(face);
                    entries.len() - 1
                });
                faces.push(entry as u32);
            }
            faces
        });
        (faces, entries)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{DebyePole, TimeWindow, paint};
    use proptest::prelude::*;

    fn model(cells: [usize; 3]) -> Model {
        Model::new("", Grid { cells, spacing: [0.002; 3] }, TimeWindow::Iterations(1))
    }

    /// The cells whose centres lie within 3.3 cells of a node, counted by hand in octants of 3 x 3 x 3: with half-integer
    /// offsets, `a² + b² + c² <= 10.89` holds for 19 of 27 (not for 2.5 with 2.5, 1.5 and up).
    #[test]
    fn a_sphere_fills_the_cells_whose_centres_it_holds() {
        let mut model = model([12, 11, 10]);
        let stone = model.add_material(Material::dielectric("stone", 6.0, 0.0));
        let by_hand = (0..27)
            .filter(|n| [n % 3, n / 3 % 3, n / 9].iter().map(|&c| (f64::from(c) + 0.5).powi(2)).sum::<f64>() <= 10.89)
            .count();
        // The centre, 0.4 of a cell off its node, snaps to it.
        let centre = [0.0128, 0.0092, 0.0108];
        model.objects.push(Object::Sphere { centre, radius: 0.0066, material: stone, averaging: true });
        let painted = paint3(&model).unwrap();
        assert_eq!(painted.cells_per_material(3)[2], 8 * by_hand);
        assert_eq!(painted.solid[(6 * 11 + 5) * 10 + 5], stone);
        // Its own edges hold stone, those far away free space, those on its surface the mean.
        assert_eq!(painted.edge(0, [6, 5, 5]).eps_r, 6.0);
        assert_eq!(painted.edge(2, [0, 0, 0]).eps_r, 1.0);
        assert!(painted.averaged_edges.iter().all(|&count| count > 0));
    }

    /// A claimed cell gives its material to its twelve edges and to no other.
    #[test]
    fn a_claimed_cell_gives_its_material_to_twelve_edges() {
        let mut model = model([5, 5, 5]);
        let stone = model.add_material(Material::dielectric("stone", 6.0, 0.0));
        let (lower, upper) = ([0.004; 3], [0.006; 3]);
        model.objects.push(Object::Box { lower, upper, material: stone, averaging: false });
        let painted = paint3(&model).unwrap();
        let of_stone = painted.palette.iter().position(|edge| edge.eps_r == 6.0).unwrap();
        assert_eq!((painted.edges_per_entry()[of_stone], painted.averaged_edges), (12, [0; 3]));
        model.objects[0] = Object::Box { lower, upper, material: stone, averaging: true };
        // With averaging each of the twelve takes a quarter of it: 1 + 5/4.
        let painted = paint3(&model).unwrap();
        let mean = painted.palette.iter().position(|edge| edge.eps_r == 2.25).unwrap();
        assert_eq!((painted.edges_per_entry()[mean], painted.averaged_edges), (12, [4; 3]));
    }

    /// Only magnetic grids have faces; one between permeabilities 1 and 3 has 1.5.
    #[test]
    fn faces_take_the_harmonic_mean() {
        let mut model = model([5, 5, 5]);
        let ore = model.add_material(Material { mu_r: 3.0, ..Material::dielectric("ore", 1.0, 0.0) });
        assert!(paint3(&model).unwrap().faces[0].is_empty());
        let (lower, upper) = ([0.004; 3], [0.006; 3]);
        model.objects.push(Object::Box { lower, upper, material: ore, averaging: true });
        let painted = paint3(&model).unwrap();
        let face = |axis: usize, node| painted.face_palette[painted.faces[axis].get(painted.node(node)) as usize].mu_r;
        assert_eq!(
            [face(0, [2, 2, 2]), face(1, [2, 3, 2]), face(2, [2, 2, 3]), face(0, [1, 2, 2])],
            [1.5, 1.5, 1.5, 1.0]
        );
    }

    proptest! {
        /// A model of one layer has the same cells and z edges in both ways of painting.
        #[test]
        fn a_plane_is_painted_alike_in_both_ways(
            objects in prop::collection::vec((0..3usize, prop::array::uniform4(0.0..0.04f64), 2..6u16, any::<bool>()), 1..6),
        ) {
            let mut model = model([17, 13, 1]);
            model.add_material(Material::dielectric("stone", 6.0, 0.01));
            model.add_material(Material::dielectric("sand", 3.0, 0.0));
            let pole = DebyePole { delta_eps: 2.0, tau: 1e-11 };
            model.add_material(Material { poles: vec![pole], averagable: false, ..Material::dielectric("wet", 4.0, 0.0) });
            model.add_material(Material { id: "rail".into(), ..Material::pec() });
            for (kind, [x, y, a, b], material, averaging) in objects {
                let (material, reach) = (MaterialId(material), [x + 0.003 + a, y + 0.003 + b, 0.002]);
                model.objects.push(match kind {
                    0 => Object::Box { lower: [x.min(0.03), y.min(0.02), 0.0], upper: reach, material, averaging },
                    _ => {
                        let (start, end) = ([x.min(0.03), y.min(0.02), 0.0], [x.min(0.03), y.min(0.02), 0.002]);
                        Object::Cylinder { start, end, radius: 0.002 + a / 4.0, material, averaging }
                    }
                });
            }
            let (plane, layer) = (paint(&model).unwrap(), paint3(&model).unwrap().into_plane());
            prop_assert_eq!((&plane.solid, plane.averaged_edges), (&layer.solid, layer.averaged_edges));
            for i in 0..=17 {
                for j in 0..=13 {
                    prop_assert_eq!(plane.edge(i, j), layer.edge(i, j));
                }
            }
        }
    }
}
