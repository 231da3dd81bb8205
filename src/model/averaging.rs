//! Each edge as the mean over the cell-sized square around it, from the true shapes.
//!
//! gprMax snaps shapes to cells and gives an edge the mean of the four cells around it. With Ez along the shapes the mean
//! that keeps the wave right is the arithmetic one over the edge's own square, `1/d² ∫ eps dA` (Kaneda, Houshmand & Itoh
//! 1997, IEEE Trans. Microw. Theory Tech. 45, 1645-1649), from the shapes where they are, not where they snap to.

use std::collections::HashMap;

use super::palette::{EdgeMaterial, Palette};
use super::{MaterialId, Model, Object, PaintError, Painted};
use crate::geometry::disc_rectangle_area;

/// How the edges between materials get their values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Averaging {
    /// By gprMax's rules: snapped shapes, the mean of the four cells around an edge.
    #[default]
    Cells,
    /// The arithmetic mean over the edge's own square or, in space, box, from the true shapes: in a plane of boxes and of
    /// cylinders along z, in space of all that have a volume. The shapes' own averaging flags have no say; conductors keep
    /// their cells.
    Volumes,
    /// As `Volumes`, and between the arithmetic and the harmonic mean as the surface in the box lies: an edge along a
    /// surface takes the first, one across it the second. In a plane edges lie along all surfaces.
    Shapes,
    /// As `Shapes`, and on surfaces that lie aslant the axes are coupled, which makes errors fall with the square of the cell;
    /// time steps are shorter by 5 %. With one component of E, and with differences of fourth order, the same as `Shapes`.
    Tensors,
}

impl Averaging {
    /// `cells`, `volumes`, `shapes` or `tensors`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Cells => "cells",
            Self::Volumes => "volumes",
            Self::Shapes => "shapes",
            Self::Tensors => "tensors",
        }
    }
}

/// A share that is left out of account: of single precision, and less than any coordinate in a file is good for.
const NEGLIGIBLE: f64 = 1e-7;

/// A material that fills part of an edge's square.
#[derive(Debug, Clone, Copy)]
struct Part {
    material: MaterialId,
    share: f64,
    round: bool,
}

/// What fills the quarters of the nodes' squares while objects are being laid down. A face on a node parts quarters, so
/// that what lies on either side of it is known exactly.
struct Quarters {
    /// Half the size of a cell along x and y, m.
    half: [f64; 2],
    /// Quarters along x and y.
    count: [usize; 2],
    whole: Vec<MaterialId>,
    mixed: HashMap<usize, Vec<Part>>,
}

/// Gives the inner edges of a painted model their means over the true shapes.
///
/// Discs that share a quarter of a square are taken not to overlap: each takes its share from what lies below all of them.
/// Of boxes the earlier yield to the later, so that two with a common face meet there. An edge with
/// a dispersive medium takes the one material that fills most of its square.
///
/// # Errors
/// When an object has another shape than a box or a cylinder along z.
pub(super) fn average_shapes(model: &Model, painted: &mut Painted) -> Result<(), PaintError> {
    let [nx, ny] = painted.cells_xy;
    let [dx, dy, _] = model.grid.spacing;
    let whole = vec![MaterialId::FREE_SPACE; 4 * nx * ny];
    let mut quarters = Quarters { half: [0.5 * dx, 0.5 * dy], count: [2 * nx, 2 * ny], whole, mixed: HashMap::new() };
    let along_z = |id: MaterialId| model.materials.get(id.index()).map_or(id, |material| material.along(2, id));
    for (index, object) in model.objects.iter().enumerate() {
        match *object {
            Object::Box { lower, upper, material, .. } => quarters.rectangle(lower, upper, along_z(material)),
            Object::Cylinder { start, end, radius, material, .. } if start[..2] == end[..2] => {
                quarters.disc([start[0], start[1]], radius, along_z(material));
            }
            _ => return Err(PaintError::NoShare { number: index + 1 }),
        }
    }
    let mut palette = Palette::new(&model.materials);
    let mut kept: Vec<Option<u32>> = vec![None; painted.palette.len()];
    painted.averaged_edges = 0;
    for node in 0..painted.edge_z.len() {
        let (i, j) = (node / (ny + 1), node % (ny + 1));
        let old = painted.edge_z[node] as usize;
        let inside = i > 0 && i < nx && j > 0 && j < ny;
        let value =
            if inside && !painted.palette[old].sigma.is_infinite() { quarters.value(model, i, j) } else { None };
        painted.edge_z[node] = match value {
            Some(Value::Pure(material)) => palette.pure(material),
            Some(Value::Mean(edge)) => {
                painted.averaged_edges += 1;
                palette.enter(edge)
            }
            None => *kept[old].get_or_insert_with(|| palette.enter(painted.palette[old])),
        };
    }
    painted.palette = palette.into_entries();
    Ok(())
}

/// What an edge holds.
enum Value {
    Pure(MaterialId),
    Mean(EdgeMaterial),
}

impl Quarters {
    /// Quarters that a span along an axis touches.
    fn touched(&self, axis: usize, low: f64, high: f64) -> std::ops::Range<usize> {
        let last = self.count[axis];
        let at = |metres: f64| (metres / self.half[axis]).clamp(0.0, last as f64);
        at(low) as usize..at(high).ceil() as usize
    }

    /// Share of a quarter along an axis that lies between two coordinates.
    fn overlap(&self, axis: usize, quarter: usize, low: f64, high: f64) -> f64 {
        let (at, half) = (quarter as f64, self.half[axis]);
        ((high / half).min(at + 1.0) - (low / half).max(at)).clamp(0.0, 1.0)
    }

    fn rectangle(&mut self, lower: [f64; 3], upper: [f64; 3], material: MaterialId) {
        for p in self.touched(0, lower[0], upper[0]) {
            let along_x = self.overlap(0, p, lower[0], upper[0]);
            for q in self.touched(1, lower[1], upper[1]) {
                let share = along_x * self.overlap(1, q, lower[1], upper[1]);
                self.put(p * self.count[1] + q, Part { material, share, round: false });
            }
        }
    }

    fn disc(&mut self, [x, y]: [f64; 2], radius: f64, material: MaterialId) {
        let [dx, dy] = self.half;
        let half_diagonal = 0.5 * dx.hypot(dy);
        for p in self.touched(0, x - radius, x + radius) {
            let x0 = p as f64 * dx - x;
            for q in self.touched(1, y - radius, y + radius) {
                let y0 = q as f64 * dy - y;
                let distance = (x0 + 0.5 * dx).hypot(y0 + 0.5 * dy);
                let share = if distance + half_diagonal <= radius {
                    1.0
                } else if distance - half_diagonal >= radius {
                    0.0
                } else {
                    disc_rectangle_area(radius, x0, x0 + dx, y0, y0 + dy) / (dx * dy)
                };
                self.put(p * self.count[1] + q, Part { material, share, round: true });
            }
        }
    }

    /// Lays a part over what is there. A box takes its share from what was laid first; a disc from what is no disc, alike.
    fn put(&mut self, quarter: usize, part: Part) {
        if part.share < NEGLIGIBLE {
            return;
        }
        if part.share > 1.0 - NEGLIGIBLE {
            self.whole[quarter] = part.material;
            self.mixed.remove(&quarter);
            return;
        }
        let below = Part { material: self.whole[quarter], share: 1.0, round: false };
        let parts = self.mixed.entry(quarter).or_insert_with(|| vec![below]);
        if part.round {
            let sum = |round: bool| parts.iter().filter(|p| p.round == round).map(|p| p.share).sum::<f64>();
            let (flat, round) = (sum(false), sum(true));
            let from_flat = part.share.min(flat);
            for old in parts.iter_mut() {
                let (taken, of) = if old.round { (part.share - from_flat, round) } else { (from_flat, flat) };
                old.share *= 1.0 - taken / of.max(NEGLIGIBLE);
            }
        } else {
            let mut wanted = part.share;
            for old in parts.iter_mut() {
                let taken = wanted.min(old.share);
                old.share -= taken;
                wanted -= taken;
            }
        }
        parts.push(part);
    }

    /// What the edge at an inner node holds; `None` where a conductor fills its square and yet the edge does not conduct.
    fn value(&self, model: &Model, i: usize, j: usize) -> Option<Value> {
        let material = |id: MaterialId| &model.materials[id.index()];
        let around = [[1, 1], [1, 0], [0, 1], [0, 0]].map(|[p, q]| (2 * i - p) * self.count[1] + 2 * j - q);
        let first = self.whole[around[0]];
        if around.iter().all(|quarter| self.whole[*quarter] == first && !self.mixed.contains_key(quarter)) {
            return (!material(first).is_pec()).then_some(Value::Pure(first));
        }
        let (mut total, mut eps_r, mut sigma, mut relaxes) = (0.0, 0.0, 0.0, false);
        let mut shares: Vec<(MaterialId, f64)> = vec![];
        for quarter in around {
            let whole = [Part { material: self.whole[quarter], share: 1.0, round: false }];
            let parts = self.mixed.get(&quarter).map_or(&whole[..], Vec::as_slice);
            for part in parts.iter().filter(|part| part.share > 0.0 && !material(part.material).is_pec()) {
                let of = material(part.material);
                total += part.share;
                eps_r += part.share * of.eps_r;
                sigma += part.share * of.sigma;
                relaxes |= of.is_dispersive() && part.share > NEGLIGIBLE;
                match shares.iter_mut().find(|(id, _)| *id == part.material) {
                    Some((_, share)) => *share += part.share,
                    None => shares.push((part.material, part.share)),
                }
            }
        }
        if relaxes || shares.len() == 1 {
            let most = shares.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
            return Some(Value::Pure(most.0));
        }
        let mean = EdgeMaterial { eps_r: eps_r / total, sigma: sigma / total, dispersive: None, quarters: None };
        (total > NEGLIGIBLE).then_some(Value::Mean(mean))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Grid, Material, TimeWindow, paint};

    fn model(nx: usize, ny: usize) -> (Model, MaterialId) {
        let mut model = Model::new("", Grid { cells: [nx, ny, 1], spacing: [0.002; 3] }, TimeWindow::Iterations(1));
        model.averaging = Averaging::Shapes;
        let stone = model.add_material(Material::dielectric("stone", 6.0, 0.004));
        (model, stone)
    }

    fn cylinder(x: f64, y: f64, radius: f64, material: MaterialId) -> Object {
        Object::Cylinder { start: [x, y, 0.0], end: [x, y, 0.002], radius, material, averaging: true }
    }

    /// The sum of `(eps - 1) d²` over all edges is 5 times the discs' area, whatever their place on the grid, also where two
    /// touch; and the conductivity goes with it.
    #[test]
    fn the_area_is_kept() {
        for shift in [0.0, 0.0003, 0.00071, 0.0013] {
            let (mut model, stone) = model(60, 60);
            let r = [0.0171, 0.0123];
            model.objects.push(cylinder(0.04 + shift, 0.05, r[0], stone));
            model.objects.push(cylinder(0.04 + shift, 0.05 + r[0] + r[1], r[1], stone));
            let painted = paint(&model).unwrap();
            let over = |of: fn(&EdgeMaterial) -> f64| {
                painted.edge_z.iter().map(|&e| of(&painted.palette[e as usize])).sum::<f64>() * 4e-6
            };
            let area = std::f64::consts::PI * (r[0] * r[0] + r[1] * r[1]);
            assert!((over(|e| e.eps_r - 1.0) / (5.0 * area) - 1.0).abs() < 1e-5, "{shift}");
            assert!((over(|e| e.sigma) / (0.004 * area) - 1.0).abs() < 1e-5, "{shift}");
        }
    }

    /// A box whose face lies a quarter of a cell behind a node fills three quarters of that node's squares.
    #[test]
    fn boxes_fill_what_they_cover() {
        let (mut model, stone) = model(10, 10);
        let upper = [0.0105, 1.0, 0.002];
        model.objects.push(Object::Box { lower: [0.0; 3], upper, material: stone, averaging: false });
        let painted = paint(&model).unwrap();
        let close = |i: usize, eps_r: f64| assert!((painted.edge(i, 5).eps_r - eps_r).abs() < 1e-9, "{i}");
        close(4, 6.0);
        close(5, 1.0 + 5.0 * 0.75);
        close(6, 1.0);
    }

    /// Two boxes with a common face, on a node and off it, leave no room for air between them.
    #[test]
    fn boxes_that_touch_leave_no_gap() {
        for face in [0.01, 0.0104, 0.0117] {
            let (mut model, stone) = model(10, 10);
            let dense = model.add_material(Material::dielectric("dense", 10.0, 0.0));
            for (low, high, material) in [(0.0, face, stone), (face, 1.0, dense)] {
                let (lower, upper) = ([low, 0.0, 0.0], [high, 1.0, 0.002]);
                model.objects.push(Object::Box { lower, upper, material, averaging: true });
            }
            let painted = paint(&model).unwrap();
            let sum: f64 = (1..10).map(|i| painted.edge(i, 5).eps_r).sum();
            let exact = 6.0 * (face / 0.002 - 0.5) + 10.0 * (9.5 - face / 0.002);
            assert!((sum - exact).abs() < 1e-9, "{face}: {sum} {exact}");
        }
    }

    /// Conductors stay where gprMax has them, and take no part in a mean; an object of another shape is named.
    #[test]
    fn conductors_keep_their_cells() {
        let (mut model, stone) = model(10, 10);
        model.objects.push(cylinder(0.01, 0.01, 0.0045, stone));
        let lower = [0.0, 0.0, 0.0];
        model.objects.push(Object::Box {
            lower,
            upper: [0.02, 0.0081, 0.002],
            material: MaterialId::PEC,
            averaging: true,
        });
        let painted = paint(&model).unwrap();
        assert!(painted.edge(5, 4).sigma.is_infinite() && !painted.edge(5, 5).sigma.is_infinite());
        assert_eq!(painted.edge(5, 5).eps_r, 6.0);
        model.objects.push(Object::Cylinder {
            start: [0.0, 0.01, 0.001],
            end: [0.02, 0.01, 0.001],
            radius: 0.004,
            material: stone,
            averaging: true,
        });
        let message = paint(&model).unwrap_err().to_string();
        assert!(message.starts_with("object 3 has no true shape in the plane"), "{message}");
    }
}
