//! Objects snapped to the grid, and which cells of a plane they fill.

use std::ops::Range;

use super::PaintError;
use super::claims::{Claim, Claims};
use super::layout::Layout;
use crate::model::{Material, MaterialId, Model, Object, Voxels};

/// An object snapped to the grid.
pub struct Solid<'a> {
    /// Place in the list of objects, from 1.
    pub number: usize,
    /// Planes, rows and cells of rows that it may fill.
    pub cells: [Range<usize>; 3],
    shape: Shape<'a>,
    material: MaterialId,
    claims: bool,
}

/// What an object fills.
enum Shape<'a> {
    Box,
    Cylinder { start: [f64; 3], axis: [f64; 3], length_squared: f64, radius: f64 },
    Sphere { centre: [f64; 3], radius: f64 },
    Voxels { voxels: &'a Voxels, origin: [i64; 3], claims: Vec<bool> },
}

/// A plane of cells while it is painted.
pub struct Plane<'a> {
    pub layout: Layout,
    /// Its place along x.
    pub i: usize,
    /// Material of each cell, row by row.
    pub solid: &'a mut [MaterialId],
    pub claims: &'a mut Claims,
}

impl Plane<'_> {
    /// Paints cells of a row.
    #[inline]
    fn run(&mut self, j: usize, run: Range<usize>, claim: Claim, claims: bool) {
        self.solid[j * self.layout.n[2]..][run.clone()].fill(claim.material);
        if claims {
            self.claims.claim_run(j, run, claim);
        } else {
            self.claims.drop_run(j, run);
        }
    }
}

/// The objects of a model, snapped to the grid, in order.
///
/// # Errors
/// When an object has no such material.
pub fn solids<'a>(model: &'a Model, layout: &Layout) -> Result<Vec<Solid<'a>>, PaintError> {
    model.objects.iter().enumerate().map(|(index, object)| Solid::new(model, layout, index + 1, object)).collect()
}

/// What an object is called, its first material, and where it begins.
pub fn description(object: &Object) -> (&'static str, MaterialId, [f64; 3]) {
    match object {
        Object::Box { lower, material, .. } => ("box", *material, *lower),
        Object::Cylinder { start, material, .. } => ("cylinder", *material, *start),
        Object::Sphere { centre, material, .. } => ("sphere", *material, *centre),
        Object::Voxels(voxels) => {
            let first = voxels.cells.iter().flatten().next().copied();
            ("block of voxels", first.unwrap_or(MaterialId::FREE_SPACE), voxels.origin)
        }
    }
}

/// Whether cells of a material claim their edges.
fn claims(model: &Model, material: &Material, averaging: bool) -> bool {
    let dispersive = material.is_dispersive() && !model.dispersive_averaging;
    !averaging || material.is_pec() || dispersive || !material.averagable
}

impl<'a> Solid<'a> {
    fn new(model: &'a Model, layout: &Layout, number: usize, object: &'a Object) -> Result<Self, PaintError> {
        let materials = &model.materials;
        let known = |material: MaterialId| match materials.get(material.index()) {
            Some(found) => Ok(found),
            None => Err(PaintError::NoSuchMaterial { number, material: material.index(), materials: materials.len() }),
        };
        let solid = |shape, [low, high]: [[f64; 3]; 2], material, averaging| {
            let cells = layout.turned(&around(layout, low, high));
            Ok(Self { number, cells, shape, material, claims: claims(model, known(material)?, averaging) })
        };
        match *object {
            Object::Box { lower, upper, material, averaging } => {
                let span = |axis: usize| {
                    let end = layout.grid.cells[axis] as i64;
                    let node = |metres| layout.grid.node(axis, metres).clamp(0, end) as usize;
                    node(lower[axis])..node(upper[axis])
                };
                let cells = layout.turned(&std::array::from_fn(span));
                Ok(Self {
                    number,
                    cells,
                    shape: Shape::Box,
                    material,
                    claims: claims(model, known(material)?, averaging),
                })
            }
            Object::Cylinder { start, end, radius, material, averaging } => {
                let (start, end) = (snap(layout, start), snap(layout, end));
                let axis: [f64; 3] = std::array::from_fn(|a| end[a] - start[a]);
                let length_squared = axis.iter().map(|v| v * v).sum();
                let bounds = [0, 1].map(|high| {
                    std::array::from_fn(|a| match high {
                        0 => start[a].min(end[a]) - radius,
                        _ => start[a].max(end[a]) + radius,
                    })
                });
                solid(Shape::Cylinder { start, axis, length_squared, radius }, bounds, material, averaging)
            }
            Object::Sphere { centre, radius, material, averaging } => {
                let centre = snap(layout, centre);
                let bounds = [centre.map(|v| v - radius), centre.map(|v| v + radius)];
                solid(Shape::Sphere { centre, radius }, bounds, material, averaging)
            }
            Object::Voxels(ref voxels) => {
                if voxels.shape.iter().product::<usize>() != voxels.cells.len() {
                    let (shape, cells) = (voxels.shape, voxels.cells.len());
                    return Err(PaintError::VoxelCount { number, shape, cells });
                }
                for &material in voxels.cells.iter().flatten() {
                    known(material)?;
                }
                let origin: [i64; 3] = std::array::from_fn(|axis| layout.grid.node(axis, voxels.origin[axis]));
                let span = |axis: usize| {
                    let inside = |node: i64| node.clamp(0, layout.grid.cells[axis] as i64) as usize;
                    inside(origin[axis])..inside(origin[axis].saturating_add(voxels.shape[axis] as i64))
                };
                let cells = layout.turned(&std::array::from_fn(span));
                let claims = materials.iter().map(|material| claims(model, material, voxels.averaging)).collect();
                let shape = Shape::Voxels { voxels, origin, claims };
                Ok(Self { number, cells, shape, material: MaterialId::FREE_SPACE, claims: false })
            }
        }
    }

    /// Fills cells of a plane; whether there were any.
    pub fn fill(&self, plane: &mut Plane<'_>) -> bool {
        let claim = Claim { object: self.number as u32, material: self.material };
        match self.shape {
            Shape::Box => {
                let [_, rows, run] = self.cells.clone();
                if rows.is_empty() || run.is_empty() {
                    return false;
                }
                for j in rows {
                    plane.run(j, run.clone(), claim, self.claims);
                }
                true
            }
            Shape::Cylinder { start, axis, length_squared, radius } => {
                if length_squared == 0.0 {
                    return false;
                }
                // Along a row of a cylinder parallel to an axis the distance falls, then rises: no gap can open.
                let whole = axis.iter().filter(|&&v| v != 0.0).count() == 1;
                self.fill_where(plane, whole, |centre| {
                    let from: [f64; 3] = std::array::from_fn(|a| centre[a] - start[a]);
                    let t = from.iter().zip(axis).map(|(f, a)| f * a).sum::<f64>() / length_squared;
                    let distance_squared: f64 = from.iter().zip(axis).map(|(f, a)| (f - t * a).powi(2)).sum();
                    (0.0..=1.0).contains(&t) && distance_squared <= radius * radius
                })
            }
            Shape::Sphere { centre: middle, radius } => self.fill_where(plane, true, |centre| {
                let distance_squared: f64 = centre.iter().zip(middle).map(|(c, m)| (c - m).powi(2)).sum();
                distance_squared <= radius * radius
            }),
            Shape::Voxels { voxels, origin, ref claims } => self.fill_voxels(plane, voxels, origin, claims),
        }
    }

    /// Fills the cells whose centres fulfil a condition. `whole`: those of a row have no gap between them.
    fn fill_where(&self, plane: &mut Plane<'_>, whole: bool, inside: impl Fn([f64; 3]) -> bool) -> bool {
        let d = plane.layout.grid.spacing;
        let centre = |cell: usize, axis: usize| (cell as f64 + 0.5) * d[axis];
        let x = centre(plane.i, 0);
        if plane.layout.flat {
            self.fill_rows(plane, whole, |j, k| inside([x, centre(k, 1), centre(j, 2)]))
        } else {
            self.fill_rows(plane, whole, |j, k| inside([x, centre(j, 1), centre(k, 2)]))
        }
    }

    #[inline]
    fn fill_rows(&self, plane: &mut Plane<'_>, whole: bool, inside: impl Fn(usize, usize) -> bool) -> bool {
        let claim = Claim { object: self.number as u32, material: self.material };
        let [_, rows, run] = self.cells.clone();
        let mut filled = false;
        for j in rows {
            let mut k = run.start;
            while k < run.end {
                if !inside(j, k) {
                    k += 1;
                    continue;
                }
                let mut end = k + 1;
                if whole {
                    end = run.end;
                    while !inside(j, end - 1) {
                        end -= 1;
                    }
                } else {
                    while end < run.end && inside(j, end) {
                        end += 1;
                    }
                }
                plane.run(j, k..end, claim, self.claims);
                filled = true;
                k = if whole { run.end } else { end + 1 };
            }
        }
        filled
    }

    fn fill_voxels(&self, plane: &mut Plane<'_>, voxels: &Voxels, origin: [i64; 3], claims: &[bool]) -> bool {
        let layout = plane.layout;
        let [_, rows, run] = self.cells.clone();
        let [_, my, mz] = voxels.shape;
        let within = |axis: usize, cell: usize| (cell as i64 - origin[axis]) as usize;
        let i = within(0, plane.i);
        let mut filled = false;
        for j in rows {
            for k in run.clone() {
                let [y, z] = if layout.flat { [within(1, k), within(2, j)] } else { [within(1, j), within(2, k)] };
                let Some(material) = voxels.cells[(i * my + y) * mz + z] else { continue };
                let claim = Claim { object: self.number as u32, material };
                plane.run(j, k..k + 1, claim, claims[material.index()]);
                filled = true;
            }
        }
        filled
    }
}

/// The cells in and around a box, m, cut to the grid.
fn around(layout: &Layout, low: [f64; 3], high: [f64; 3]) -> [Range<usize>; 3] {
    let d = layout.grid.spacing;
    std::array::from_fn(|axis| {
        let clamp = |v: f64| v.clamp(0.0, layout.grid.cells[axis] as f64) as usize;
        clamp((low[axis] / d[axis]).floor() - 1.0)..clamp((high[axis] / d[axis]).ceil() + 1.0)
    })
}

fn snap(layout: &Layout, point: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| layout.grid.node(axis, point[axis]) as f64 * layout.grid.spacing[axis])
}
