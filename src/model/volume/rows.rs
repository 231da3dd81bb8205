//! The means on all inner edges, row by row.

use rayon::prelude::*;

use super::body::{Body, NEGLIGIBLE, Side, Slope};
use super::mix::Mixture;
use super::part::Region;
use crate::model::palette::{EdgeMaterial, Palette};
use crate::model::{Averaging, Coupling, Grid, Indices, MaterialId, Model, PaintError, Painted3};

/// Gives the inner edges of a painted model their means over the true shapes. Conductors keep their cells and take no part
/// in a mean; an edge with a dispersive medium takes the one material that fills most of its box; faces stay as they are.
///
/// Later bodies lie over earlier ones. What is computed for an edge depends on nothing but its place, so that the result
/// does not depend on the number of threads.
///
/// # Errors
/// When an object that does not conduct perfectly has no volume.
pub(in crate::model) fn average_volumes(model: &Model, painted: &mut Painted3) -> Result<(), PaintError> {
    let mut bodies = vec![];
    for (index, object) in model.objects.iter().enumerate() {
        match Body::of(object, &model.grid) {
            Some(body) => bodies.push(body),
            None if object.holds(MaterialId::PEC) => {}
            None => return Err(PaintError::NoVolume { number: index + 1 }),
        }
    }
    let job = Job { model, painted, bodies: &bodies };
    let mut planes: Vec<Done> = (0..=painted.cells[0]).into_par_iter().map(|i| job.plane(i)).collect();
    let mut palette = Palette::new(&model.materials);
    let maps: Vec<_> = planes.iter().map(|plane| palette.merge(&plane.palette)).collect();
    let edges = std::array::from_fn(|axis| {
        let take = |plane: &mut Done| std::mem::replace(&mut plane.edges[axis], Indices::with_capacity(0));
        let lists: Vec<_> = planes.iter_mut().map(take).collect();
        Indices::joined(&lists, &maps)
    });
    painted.averaged_edges = std::array::from_fn(|axis| planes.iter().map(|plane| plane.averaged[axis]).sum());
    painted.couplings = planes.iter_mut().flat_map(|plane| std::mem::take(&mut plane.couplings)).collect();
    (painted.edges, painted.palette) = (edges, palette.into_entries());
    Ok(())
}

/// What all planes share.
struct Job<'a> {
    model: &'a Model,
    painted: &'a Painted3,
    bodies: &'a [Body<'a>],
}

/// The edges of a plane of nodes, as indices into its own list of entries.
struct Done {
    palette: Vec<EdgeMaterial>,
    edges: [Indices; 3],
    averaged: [usize; 3],
    couplings: Vec<Coupling>,
}

/// What an edge holds.
enum Value {
    Pure(MaterialId),
    Mean(EdgeMaterial),
}

/// No body more.
const NONE: u32 = u32::MAX;

/// What lies on the boxes of a row while bodies are laid down: the one that fills it last, and those that cut it since.
struct Row {
    base: Vec<MaterialId>,
    /// The last that cuts, as a place in `links`.
    head: Vec<u32>,
    /// A body, and the one before it.
    links: Vec<(u32, u32)>,
}

impl Row {
    fn clear(&mut self, boxes: usize) {
        self.base.clear();
        self.base.resize(boxes, MaterialId::FREE_SPACE);
        self.head.clear();
        self.head.resize(boxes, NONE);
        self.links.clear();
    }

    fn fill(&mut self, k: usize, material: MaterialId) {
        (self.base[k], self.head[k]) = (material, NONE);
    }

    fn cut(&mut self, k: usize, body: usize) {
        self.links.push((body as u32, self.head[k]));
        self.head[k] = self.links.len() as u32 - 1;
    }

    /// The one that cuts a box, if it is one.
    fn only(&self, k: usize) -> Option<usize> {
        let &(body, before) = self.links.get(self.head[k] as usize)?;
        (before == NONE).then_some(body as usize)
    }

    /// Those that cut a box, the last first.
    fn bodies<'a>(&self, k: usize, all: &[&'a Body<'a>], found: &mut Vec<&'a Body<'a>>) {
        found.clear();
        let mut at = self.head[k];
        while at != NONE {
            let (body, before) = self.links[at as usize];
            found.push(all[body as usize]);
            at = before;
        }
    }
}

/// What a ball fills of the boxes of a row: the lower face of a box is the upper one of the box before.
struct Column {
    /// A body, a height, and what it fills beyond.
    known: Option<(usize, f64, f64)>,
}

impl Column {
    /// Share of a box that a ball fills; `None` for other bodies.
    fn share(&mut self, index: usize, body: &Body<'_>, region: &Region) -> Option<f64> {
        let low = match self.known {
            Some((of, at, beyond)) if of == index && at == region.low[2] => beyond,
            _ => body.beyond(region, region.low[2])?,
        };
        let high = body.beyond(region, region.high[2])?;
        self.known = Some((index, region.high[2], high));
        Some(low - high)
    }
}

/// Stands for no axis: the box is that around a node.
const NODE: usize = 3;

/// The box around the middle of an edge along an axis from a node, or around the node.
fn region(grid: &Grid, axis: usize, node: [usize; 3]) -> Region {
    let from: [f64; 3] = std::array::from_fn(|a| node[a] as f64 - if a == axis { 0.0 } else { 0.5 });
    Region {
        low: std::array::from_fn(|a| from[a] * grid.spacing[a]),
        high: std::array::from_fn(|a| (from[a] + 1.0) * grid.spacing[a]),
    }
}

impl Job<'_> {
    fn plane(&self, i: usize) -> Done {
        let [nx, ny, nz] = self.painted.cells;
        let mut palette = Palette::new(&self.model.materials);
        let mut kept: Vec<Option<u32>> = vec![None; self.painted.palette.len()];
        let mut row = Row { base: vec![], head: vec![], links: vec![] };
        let (mut cutting, mut mixture) = (vec![], Mixture::default());
        let mut averaged = [0; 3];
        let mut out = vec![];
        let edges = std::array::from_fn(|axis| {
            let grid = &self.model.grid;
            let wide = region(grid, axis, [i, 0, 0]);
            let near = |body: &&Body<'_>| body.high[0] > wide.low[0] && body.low[0] < wide.high[0];
            let bodies: Vec<&Body<'_>> = self.bodies.iter().filter(near).collect();
            let mut edges = Indices::with_capacity((ny + 1) * (nz + 1));
            for j in 0..=ny {
                let inside = |node: usize, a: usize, n: usize| node < n && (a == axis || node > 0);
                let inner = inside(i, 0, nx) && inside(j, 1, ny);
                if inner {
                    self.lay(&mut row, axis, [i, j], &bodies);
                }
                let first = self.painted.node([i, j, 0]);
                out.clear();
                let mut last: Option<(MaterialId, u32)> = None;
                let mut column = Column { known: None };
                for k in 0..=nz {
                    let old = self.painted.edges[axis].get(first + k) as usize;
                    let keeps = !inner || !inside(k, 2, nz) || self.painted.palette[old].sigma.is_infinite();
                    let value = if keeps {
                        None
                    } else if row.head[k] == NONE {
                        let base = self.along(axis, row.base[k]);
                        (!self.model.materials[base.index()].is_pec()).then_some(Value::Pure(base))
                    } else {
                        let region = region(grid, axis, [i, j, k]);
                        row.bodies(k, &bodies, &mut cutting);
                        mixture.parts.clear();
                        match row.only(k).and_then(|index| Some((index, column.share(index, bodies[index], &region)?)))
                        {
                            Some((index, share)) => mixture.fill_with(bodies[index].material, share, row.base[k]),
                            None => mixture.fill(&region, &cutting, row.base[k], 1.0),
                        }
                        mixture.settle(|id| self.along(axis, id));
                        let across = match self.model.averaging {
                            // How far the edge lies across the surfaces in its box, `n_a²`.
                            Averaging::Shapes | Averaging::Tensors => self.slope(&region, &cutting).squares[axis],
                            _ => 0.0,
                        };
                        self.value(&mixture, across)
                    };
                    out.push(match value {
                        Some(Value::Pure(material)) => match last {
                            Some((known, entry)) if known == material => entry,
                            _ => {
                                let entry = palette.pure(material);
                                last = Some((material, entry));
                                entry
                            }
                        },
                        Some(Value::Mean(edge)) => {
                            averaged[axis] += 1;
                            palette.enter(edge)
                        }
                        None => *kept[old].get_or_insert_with(|| palette.enter(self.painted.palette[old])),
                    });
                }
                edges.extend(&out);
            }
            edges
        });
        let couplings = if self.model.couples_axes() { self.couplings(i, &mut row) } else { vec![] };
        Done { palette: palette.into_entries(), edges, averaged, couplings }
    }

    /// What couples the axes at the nodes of a plane.
    fn couplings(&self, i: usize, row: &mut Row) -> Vec<Coupling> {
        let ([nx, ny, nz], grid) = (self.painted.cells, &self.model.grid);
        let wide = region(grid, NODE, [i, 0, 0]);
        let near = |body: &&Body<'_>| body.high[0] > wide.low[0] && body.low[0] < wide.high[0];
        let bodies: Vec<&Body<'_>> = self.bodies.iter().filter(near).collect();
        let (mut cutting, mut mixture, mut found) = (vec![], Mixture::default(), vec![]);
        let inner = |node: usize, n: usize| node > 0 && node < n;
        for j in (1..ny).filter(|_| inner(i, nx) && !bodies.is_empty()) {
            self.lay(row, NODE, [i, j], &bodies);
            let mut column = Column { known: None };
            for k in (1..nz).filter(|&k| row.head[k] != NONE).collect::<Vec<_>>() {
                let region = region(grid, NODE, [i, j, k]);
                row.bodies(k, &bodies, &mut cutting);
                mixture.parts.clear();
                match row.only(k).and_then(|index| Some((index, column.share(index, bodies[index], &region)?))) {
                    Some((index, share)) => mixture.fill_with(bodies[index].material, share, row.base[k]),
                    None => mixture.fill(&region, &cutting, row.base[k], 1.0),
                }
                mixture.settle(|id| id);
                let Some(excess) = self.excess(&mixture) else { continue };
                let inverse = self.slope(&region, &cutting).products.map(|product| product * excess);
                if inverse.iter().any(|value| value.abs() > NEGLIGIBLE) {
                    found.push(Coupling { node: self.painted.node([i, j, k]), inverse });
                }
            }
        }
        found
    }

    /// By how much `<1/eps>` is more than `1/<eps>`; `None` where one material fills a box, or any conducts, relaxes or is
    /// another one along another axis.
    fn excess(&self, mixture: &Mixture) -> Option<f64> {
        let of = |id: MaterialId| &self.model.materials[id.index()];
        let plain = |id: MaterialId| {
            let material = of(id);
            !material.is_pec() && !material.is_dispersive() && (0..3).all(|axis| material.along(axis, id) == id)
        };
        if mixture.parts.len() < 2 || !mixture.parts.iter().all(|(id, _)| plain(*id)) {
            return None;
        }
        let total: f64 = mixture.parts.iter().map(|(_, share)| share).sum();
        let mean = |value: fn(f64) -> f64| {
            mixture.parts.iter().map(|(id, share)| share / total * value(of(*id).eps_r)).sum::<f64>()
        };
        Some(mean(|eps_r| 1.0 / eps_r) - 1.0 / mean(|eps_r| eps_r))
    }

    /// Lays the bodies over the boxes of a row.
    fn lay(&self, row: &mut Row, axis: usize, [i, j]: [usize; 2], bodies: &[&Body<'_>]) {
        let grid = &self.model.grid;
        let boxes = grid.cells[2] + 1;
        row.clear(boxes);
        let (first, dz) = (region(grid, axis, [i, j, 0]), grid.spacing[2]);
        // A coordinate in boxes from the beginning of the first.
        let at = |z: f64| (z - first.low[2]) / dz;
        let whole = |boxes_along: f64| boxes_along.clamp(0.0, boxes as f64) as usize;
        for (index, body) in bodies.iter().enumerate() {
            if body.high[1] <= first.low[1] || body.low[1] >= first.high[1] {
                continue;
            }
            match body.run(&first) {
                Some([filled, touched]) => {
                    let (begin, end) = (whole(at(touched[0]).floor()), whole(at(touched[1]).ceil()));
                    let (low, high) = (whole(at(filled[0]).ceil()), whole(at(filled[1]).floor()));
                    for k in begin..end {
                        if (low..high).contains(&k) {
                            row.fill(k, body.material);
                        } else {
                            row.cut(k, index);
                        }
                    }
                }
                None => {
                    for k in whole(at(body.low[2]).floor())..whole(at(body.high[2]).ceil()) {
                        match body.side(&region(grid, axis, [i, j, k])) {
                            Side::Outside => {}
                            Side::Inside(material) => row.fill(k, material),
                            Side::Cut => row.cut(k, index),
                        }
                    }
                }
            }
        }
    }

    /// The material of edges along an axis where an object has three.
    fn along(&self, axis: usize, id: MaterialId) -> MaterialId {
        self.model.materials[id.index()].along(axis, id)
    }

    /// How the surfaces in a box lie: those of the bodies, by what they fill and leave free.
    fn slope(&self, region: &Region, bodies: &[&Body<'_>]) -> Slope {
        if let [body] = bodies {
            return body.slope(region);
        }
        let (mut sum, mut total) = (Slope { squares: [0.0; 3], products: [0.0; 3] }, 0.0);
        for body in bodies {
            let (share, slope) = (body.share_of_part(region), body.slope(region));
            let weight = share * (1.0 - share) + NEGLIGIBLE;
            for axis in 0..3 {
                sum.squares[axis] += weight * slope.squares[axis];
                sum.products[axis] += weight * slope.products[axis];
            }
            total += weight;
        }
        Slope { squares: sum.squares.map(|v| v / total), products: sum.products.map(|v| v / total) }
    }

    /// What an edge holds that lies `across` the surfaces in its box (0: along them); `None` where conductors fill its box
    /// and yet it does not conduct.
    fn value(&self, mixture: &Mixture, across: f64) -> Option<Value> {
        let of = |id: MaterialId| &self.model.materials[id.index()];
        let parts = || mixture.parts.iter().filter(|(id, _)| !of(*id).is_pec());
        let (count, relaxes) = (parts().count(), parts().any(|(id, _)| of(*id).is_dispersive()));
        if count < 2 || relaxes {
            let most = parts().max_by(|a, b| a.1.total_cmp(&b.1))?;
            return Some(Value::Pure(most.0));
        }
        let total = parts().map(|(_, share)| share).sum::<f64>();
        let mean = |value: fn(f64, f64) -> f64| {
            parts().map(|(id, share)| share / total * value(of(*id).eps_r, of(*id).sigma)).sum::<f64>()
        };
        let (mut eps_r, mut sigma) = (mean(|eps_r, _| eps_r), mean(|_, sigma| sigma));
        if across > 0.0 {
            // The same of `eps - i sigma/w`, to first order in sigma.
            let inverse = across * mean(|eps_r, _| 1.0 / eps_r) + (1.0 - across) / eps_r;
            let loss = across * mean(|eps_r, sigma| sigma / (eps_r * eps_r)) + (1.0 - across) * sigma / (eps_r * eps_r);
            (eps_r, sigma) = (1.0 / inverse, loss / (inverse * inverse));
        }
        Some(Value::Mean(EdgeMaterial { eps_r, sigma, dispersive: None, quarters: None }))
    }
}
