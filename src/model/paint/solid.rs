//! Objects snapped to the grid, and which cells of a plane they fill.

use std::borrow::Cow;
use std::ops::Range;

use super::PaintError;
use super::claims::{Claim, Claims};
use super::layout::Layout;
use crate::model::{BlockEdges, Material, MaterialId, Model, Object, Voxels};

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
    Cylinder {
        start: [f64; 3],
        axis: [f64; 3],
        length_squared: f64,
        radius: f64,
    },
    Sphere {
        centre: [f64; 3],
        radius: f64,
    },
    Ellipsoid {
        centre: [f64; 3],
        radii: [f64; 3],
    },
    Cone {
        start: [f64; 3],
        axis: [f64; 3],
        length_squared: f64,
        radii: [f64; 2],
    },
    /// A figure across an axis of the grid, as thick as the cells to visit.
    Prism {
        across: usize,
        figure: Figure,
    },
    /// The same on the plane of nodes `at`: the edges around its faces.
    Sheet {
        across: usize,
        at: usize,
        faces: [Range<usize>; 2],
        figure: Figure,
    },
    /// A line of edges along an axis of the grid, between two nodes.
    Line {
        along: usize,
        from: [usize; 3],
        to: usize,
    },
    Voxels {
        voxels: Cow<'a, Voxels>,
        origin: [i64; 3],
        claims: Vec<bool>,
    },
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
        Object::Ellipsoid { centre, material, .. } => ("ellipsoid", *material, *centre),
        Object::Cone { start, material, .. } => ("cone", *material, *start),
        Object::Triangle { corners, material, .. } => ("triangle", *material, corners[0]),
        Object::Plate { lower, material, .. } => ("plate", *material, *lower),
        Object::Edge { lower, material, .. } => ("edge", *material, *lower),
        Object::Sector { axis, centre, extent, material, .. } => {
            let mut at = [extent[0]; 3];
            let [p, q] = others(axis.index());
            (at[p], at[q]) = (centre[0], centre[1]);
            ("cylindrical sector", *material, at)
        }
        Object::Fractal(fractal) => {
            let first = fractal.materials.first().copied();
            ("fractal box", first.unwrap_or(MaterialId::FREE_SPACE), fractal.lower)
        }
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
            Object::Ellipsoid { centre, radii, material, averaging } => {
                let centre = snap(layout, centre);
                let reach = |sign: f64| std::array::from_fn(|a| centre[a] + sign * radii[a]);
                solid(Shape::Ellipsoid { centre, radii }, [reach(-1.0), reach(1.0)], material, averaging)
            }
            Object::Cone { start, end, radii, material, averaging } => {
                let (start, end) = (snap(layout, start), snap(layout, end));
                let axis: [f64; 3] = std::array::from_fn(|a| end[a] - start[a]);
                let length_squared = axis.iter().map(|v| v * v).sum();
                let widest = radii[0].max(radii[1]);
                let low = std::array::from_fn(|a| start[a].min(end[a]) - widest);
                let high = std::array::from_fn(|a| start[a].max(end[a]) + widest);
                solid(Shape::Cone { start, axis, length_squared, radii }, [low, high], material, averaging)
            }
            Object::Sector { axis, centre, extent, radius, start, sweep, material, averaging } => {
                let across = axis.index();
                let [p, q] = others(across);
                let node = |axis: usize, metres| layout.grid.node(axis, metres);
                let centre = [node(p, centre[0]) as f64, node(q, centre[1]) as f64];
                let d = [layout.grid.spacing[p], layout.grid.spacing[q]];
                let figure = Figure::Sector { centre: [centre[0] * d[0], centre[1] * d[1]], radius, start, sweep, d };
                let reach = |o: usize| {
                    let (middle, cells) = (centre[o], radius / d[o] + 1.0);
                    [(middle - cells).floor() as i64, (middle + cells).ceil() as i64]
                };
                let ends = [node(across, extent[0]), node(across, extent[1] - extent[0])];
                let claims = claims(model, known(material)?, averaging);
                Ok(Self::flat(layout, number, across, [reach(0), reach(1)], ends, figure, (material, claims)))
            }
            Object::Triangle { corners, axis, thickness, material, averaging } => {
                let across = axis.index();
                let [p, q] = others(across);
                let node = |axis: usize, metres| layout.grid.node(axis, metres);
                let corner = corners.map(|corner| [node(p, corner[p]), node(q, corner[q])]);
                let reach = |o: usize| {
                    let at = corner.map(|corner| corner[o]);
                    [at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2])]
                };
                let figure = Figure::Triangle { corners: corner.map(|corner| corner.map(|node| node as f64)) };
                let ends = [node(across, corners[0][across]), node(across, thickness)];
                let claims = claims(model, known(material)?, averaging);
                Ok(Self::flat(layout, number, across, [reach(0), reach(1)], ends, figure, (material, claims)))
            }
            Object::Plate { lower, upper, material } => {
                known(material)?;
                let node = |axis: usize, metres| layout.grid.node(axis, metres);
                let across = (0..3).find(|&axis| node(axis, lower[axis]) == node(axis, upper[axis])).unwrap_or(0);
                let reach = others(across).map(|axis| [node(axis, lower[axis]), node(axis, upper[axis])]);
                let ends = [node(across, lower[across]), 0];
                Ok(Self::flat(layout, number, across, reach, ends, Figure::All, (material, true)))
            }
            Object::Edge { lower, upper, material } => {
                known(material)?;
                let n = layout.grid.cells;
                let node = |point: [f64; 3], axis: usize| {
                    layout.grid.node(axis, point[axis]).clamp(0, n[axis] as i64) as usize
                };
                let along = (0..3).find(|&axis| node(lower, axis) < node(upper, axis)).unwrap_or(0);
                let from: [usize; 3] = std::array::from_fn(|axis| node(lower, axis));
                let to = node(upper, along);
                let cells = std::array::from_fn(|axis| {
                    if axis == along {
                        from[axis]..to
                    } else {
                        from[axis].saturating_sub(1)..(from[axis] + 1).min(n[axis])
                    }
                });
                let shape = Shape::Line { along, from, to };
                Ok(Self { number, cells: layout.turned(&cells), shape, material, claims: true })
            }
            Object::Voxels(ref voxels) => Self::block(model, layout, number, Cow::Borrowed(voxels)),
            Object::Fractal(ref fractal) => {
                Self::block(model, layout, number, Cow::Owned(fractal.voxels(&layout.grid)))
            }
        }
    }

    /// A block of cells.
    fn block(model: &'a Model, layout: &Layout, number: usize, voxels: Cow<'a, Voxels>) -> Result<Self, PaintError> {
        let materials = &model.materials;
        if voxels.shape.iter().product::<usize>() != voxels.cells.len() {
            let (shape, cells) = (voxels.shape, voxels.cells.len());
            return Err(PaintError::VoxelCount { number, shape, cells });
        }
        for &material in voxels.cells.iter().flatten() {
            if material.index() >= materials.len() {
                let (material, materials) = (material.index(), materials.len());
                return Err(PaintError::NoSuchMaterial { number, material, materials });
            }
        }
        if let Some(edges) = &voxels.edges {
            let nodes: usize = voxels.shape.iter().map(|cells| cells + 1).product();
            let fits =
                edges.claims.len() == voxels.cells.len() && edges.fields.iter().all(|field| field.len() == nodes);
            let known = edges.fields.iter().flatten().all(|material| material.index() < materials.len());
            if layout.flat || !fits || !known {
                return Err(PaintError::BlockEdges { number });
            }
        }
        let origin: [i64; 3] = std::array::from_fn(|axis| layout.grid.node(axis, voxels.origin[axis]));
        let span = |axis: usize| {
            let inside = |node: i64| node.clamp(0, layout.grid.cells[axis] as i64) as usize;
            inside(origin[axis])..inside(origin[axis].saturating_add(voxels.shape[axis] as i64))
        };
        let mut cells = layout.turned(&std::array::from_fn(span));
        if voxels.edges.is_some() {
            // Its last plane of nodes has edges in the next plane of cells.
            cells[0].end = (cells[0].end + 1).min(layout.n[0]);
        }
        let claims = materials.iter().map(|material| claims(model, material, voxels.averaging)).collect();
        let shape = Shape::Voxels { voxels, origin, claims };
        Ok(Self { number, cells, shape, material: MaterialId::FREE_SPACE, claims: false })
    }

    /// A prism or, where it is no cell thick, a sheet. `reach`: nodes along the two other axes; `ends`: node and cells across.
    fn flat(
        layout: &Layout,
        number: usize,
        across: usize,
        reach: [[i64; 2]; 2],
        [at, thick]: [i64; 2],
        figure: Figure,
        (material, claims): (MaterialId, bool),
    ) -> Self {
        let n = layout.grid.cells;
        let inside = |node: i64, axis: usize| node.clamp(0, n[axis] as i64) as usize;
        let mut cells = [0..0, 0..0, 0..0];
        for (axis, [low, high]) in others(across).into_iter().zip(reach) {
            cells[axis] = inside(low, axis)..inside(high, axis);
        }
        cells[across] = inside(at, across)..inside(at.saturating_add(thick), across);
        let faces = others(across).map(|axis| cells[axis].clone());
        let shape = if thick <= 0 {
            let at = inside(at, across);
            // The cells on both sides of it hold its claims.
            cells[across] = at.saturating_sub(1)..(at + 1).min(n[across]);
            if across != 0 {
                // Edges at the far end of the faces along x belong to the next plane of cells too.
                cells[0] = cells[0].start.saturating_sub(1)..(cells[0].end + 1).min(n[0]);
            }
            Shape::Sheet { across, at, faces, figure }
        } else {
            Shape::Prism { across, figure }
        };
        Self { number, cells: layout.turned(&cells), shape, material, claims }
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
            Shape::Ellipsoid { centre: middle, radii } => self.fill_where(plane, false, |centre| {
                (0..3).map(|a| ((centre[a] - middle[a]) / radii[a]).powi(2)).sum::<f64>() <= 1.0
            }),
            Shape::Cone { start, axis, length_squared, radii } => self.fill_where(plane, false, |centre| {
                let from: [f64; 3] = std::array::from_fn(|a| centre[a] - start[a]);
                let t = from.iter().zip(axis).map(|(f, a)| f * a).sum::<f64>() / length_squared;
                let distance_squared: f64 = from.iter().zip(axis).map(|(f, a)| (f - t * a).powi(2)).sum();
                let radius = radii[0] + t * (radii[1] - radii[0]);
                (0.0..=1.0).contains(&t) && distance_squared <= radius * radius
            }),
            Shape::Prism { across, ref figure } => {
                let [p, q] = others(across);
                let (i, flat) = (plane.i, plane.layout.flat);
                self.fill_rows(plane, false, |j, k| {
                    let cell = if flat { [i, k, j] } else { [i, j, k] };
                    figure.holds([cell[p], cell[q]])
                })
            }
            Shape::Sheet { across, at, ref faces, ref figure } => self.fill_sheet(plane, across, at, faces, figure),
            Shape::Line { along, from, to } => {
                let along = plane.layout.turned(&[0, 1, 2]).iter().position(|&axis| axis == along).unwrap_or(0);
                let from = plane.layout.turned(&from);
                let mut filled = false;
                for step in 0..to.saturating_sub(from[along]) {
                    let mut node = from;
                    node[along] += step;
                    filled |= claim_edge(plane, along, node, claim);
                }
                filled
            }
            Shape::Voxels { ref voxels, origin, ref claims } => self.fill_voxels(plane, voxels, origin, claims),
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

    /// Claims the edges around the faces of a sheet.
    fn fill_sheet(
        &self,
        plane: &mut Plane<'_>,
        across: usize,
        at: usize,
        faces: &[Range<usize>; 2],
        figure: &Figure,
    ) -> bool {
        let claim = Claim { object: self.number as u32, material: self.material };
        let [p, q] = others(across);
        let layout = plane.layout;
        let axes = layout.axes();
        let turned = |axis: usize| axes.iter().position(|&of| of == axis).unwrap_or(0);
        let mut filled = false;
        // Only faces beside this plane of cells: along x from the one before it to the one behind it.
        let here = plane.i;
        let near = |axis: usize, range: &Range<usize>| match axis {
            0 => range.start.max(here.saturating_sub(1))..range.end.min(here + 2),
            _ => range.clone(),
        };
        for a in near(p, &faces[0]) {
            for b in near(q, &faces[1]) {
                if !figure.holds([a, b]) {
                    continue;
                }
                for (along, more) in [(p, [0, 0]), (p, [0, 1]), (q, [0, 0]), (q, [1, 0])] {
                    let mut node = [at; 3];
                    (node[p], node[q]) = (a + more[0], b + more[1]);
                    filled |= claim_edge(plane, turned(along), layout.turned(&node), claim);
                }
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
        if let Some(edges) = &voxels.edges {
            return self.fill_edges(plane, voxels, edges, origin);
        }
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

impl Solid<'_> {
    /// Fills a plane with the cells of a block that brings its own edges: its cells hold the claims that it says, and every
    /// edge and face of the block takes its material wherever a cell claims it.
    fn fill_edges(&self, plane: &mut Plane<'_>, voxels: &Voxels, edges: &BlockEdges, origin: [i64; 3]) -> bool {
        let [_, rows, cells] = plane.layout.n;
        let [mx, my, mz] = voxels.shape;
        let at = plane.i as i64 - origin[0];
        let mut filled = false;
        let on_grid = |axis: usize, index: usize, most: usize| {
            usize::try_from(origin[axis] + index as i64).ok().filter(|&found| found < most)
        };
        if let Some(i) = usize::try_from(at).ok().filter(|&i| i < mx) {
            for (y, j) in (0..my).filter_map(|y| Some((y, on_grid(1, y, rows)?))) {
                for (z, k) in (0..mz).filter_map(|z| Some((z, on_grid(2, z, cells)?))) {
                    let place = (i * my + y) * mz + z;
                    if let Some(material) = voxels.cells[place] {
                        plane.solid[j * cells + k] = material;
                    }
                    plane.claims.hold(j, k, edges.claims[place]);
                    filled = true;
                }
            }
        }
        // The plane of nodes before these cells, and for what lies on it the one behind them.
        for side in [0, 1] {
            let Some(i) = usize::try_from(at + side as i64).ok().filter(|&i| i <= mx) else { continue };
            for (y, j) in (0..=my).filter_map(|y| Some((y, on_grid(1, y, rows + 1)?))) {
                for (z, k) in (0..=mz).filter_map(|z| Some((z, on_grid(2, z, cells + 1)?))) {
                    let place = (i * (my + 1) + y) * (mz + 1) + z;
                    for (field, materials) in edges.fields.iter().enumerate() {
                        if side == 1 && !(1..=3).contains(&field) {
                            continue;
                        }
                        let claim = Claim { object: self.number as u32, material: materials[place] };
                        plane.claims.note(field, side, [j, k], claim);
                    }
                }
            }
        }
        filled
    }
}

/// A figure across an axis: which cells of a plane it holds.
enum Figure {
    All,
    /// Corners at nodes. A centre on a side is outside.
    Triangle {
        corners: [[f64; 2]; 3],
    },
    /// Centre, radius, m, angles in degrees, sizes of cells, m.
    Sector {
        centre: [f64; 2],
        radius: f64,
        start: f64,
        sweep: f64,
        d: [f64; 2],
    },
}

impl Figure {
    #[inline]
    fn holds(&self, cell: [usize; 2]) -> bool {
        let at = cell.map(|index| index as f64 + 0.5);
        match *self {
            Self::All => true,
            Self::Triangle { corners } => {
                // In halves of cells all of this is exact.
                let side = |from: usize| {
                    let ([ax, ay], [bx, by]) = (corners[from], corners[(from + 1) % 3]);
                    (bx - ax) * (at[1] - ay) - (by - ay) * (at[0] - ax)
                };
                let sides = [side(0), side(1), side(2)];
                sides.iter().all(|&side| side > 0.0) || sides.iter().all(|&side| side < 0.0)
            }
            Self::Sector { centre, radius, start, sweep, d } => {
                let [x, y] = [at[0] * d[0] - centre[0], at[1] * d[1] - centre[1]];
                let angle = y.atan2(x).to_degrees();
                x * x + y * y <= radius * radius && (angle - start).rem_euclid(360.0) <= sweep
            }
        }
    }
}

/// The two other axes, in order.
fn others(axis: usize) -> [usize; 2] {
    [[1, 2], [0, 2], [0, 1]][axis]
}

/// Claims an edge from a node, in the order of the layout, where it bounds cells of a plane; whether it does.
fn claim_edge(plane: &mut Plane<'_>, axis: usize, node: [usize; 3], claim: Claim) -> bool {
    let beside = node[0] == plane.i || (axis != 0 && node[0] == plane.i + 1);
    if beside {
        plane.claims.claim_edge(plane.i, axis, node, claim);
    }
    beside
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
