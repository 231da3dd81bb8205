//! A box of noise: many materials in it, its faces rough or wet.

use super::{Axis, Grid, MaterialId, Voxels};
use crate::geometry::{fractal_surface, fractal_volume};

/// A box whose cells take one of several materials by the strength of noise: `#fractal_box`.
///
/// The materials are spread evenly over the range of the noise, the first for its least value only, as in gprMax.
#[derive(Debug, Clone, PartialEq)]
pub struct FractalBox {
    /// Corner with the smallest coordinates, m.
    pub lower: [f64; 3],
    /// Corner with the largest coordinates, m.
    pub upper: [f64; 3],
    /// Power with which the noise falls with frequency, 0 or more.
    pub dimension: f64,
    /// How far the noise is stretched along x, y, z.
    pub weights: [f64; 3],
    /// Materials from the least noise to the greatest.
    pub materials: Vec<MaterialId>,
    /// Seed of the noise.
    pub seed: u64,
    /// Whether the edges between cells take the mean of the materials around them.
    pub averaging: bool,
    /// Rough faces, in the order in which they are cut.
    pub surfaces: Vec<FractalSurface>,
}

/// A rough part of a face of a box of noise: `#add_surface_roughness`, `#add_surface_water`.
#[derive(Debug, Clone, PartialEq)]
pub struct FractalSurface {
    /// Axis that the face lies across.
    pub axis: Axis,
    /// Whether it is the face with the larger coordinate.
    pub upper_face: bool,
    /// Corner with the smallest coordinates, m; along `axis` the same as in `upper`.
    pub lower: [f64; 3],
    /// Corner with the largest coordinates, m.
    pub upper: [f64; 3],
    /// Power with which the noise falls with frequency, 0 or more.
    pub dimension: f64,
    /// How far the noise is stretched along the two other axes.
    pub weights: [f64; 2],
    /// Least and largest coordinate of the surface, m.
    pub range: [f64; 2],
    /// Seed of the noise.
    pub seed: u64,
    /// Coordinate up to which water stands on it, m, and the water.
    pub water: Option<(f64, MaterialId)>,
}

impl FractalSurface {
    /// The cells along the axis between which the surface runs.
    fn range_in_cells(&self, grid: &Grid) -> [usize; 2] {
        let axis = self.axis.index();
        self.range.map(|metres| grid.node(axis, metres).clamp(0, grid.cells[axis] as i64) as usize)
    }
}

impl FractalBox {
    /// First and last node along each axis, rough faces included.
    pub fn span(&self, grid: &Grid) -> [[usize; 3]; 2] {
        let [mut first, mut last] = self.own_span(grid);
        for surface in &self.surfaces {
            let (axis, [low, high]) = (surface.axis.index(), surface.range_in_cells(grid));
            if surface.upper_face {
                last[axis] = last[axis].max(high);
            } else {
                first[axis] = first[axis].min(low);
            }
        }
        [first, last]
    }

    fn own_span(&self, grid: &Grid) -> [[usize; 3]; 2] {
        let node = |axis: usize, metres| grid.node(axis, metres).clamp(0, grid.cells[axis] as i64) as usize;
        [self.lower, self.upper].map(|corner| std::array::from_fn(|axis| node(axis, corner[axis])))
    }

    /// Whether any of it is made of a material.
    pub fn holds(&self, id: MaterialId) -> bool {
        let wet = |surface: &FractalSurface| surface.water.is_some_and(|(_, water)| water == id);
        self.materials.contains(&id) || self.surfaces.iter().any(wet)
    }

    /// Its cells.
    pub fn voxels(&self, grid: &Grid) -> Voxels {
        let [first, last] = self.span(grid);
        let shape: [usize; 3] = std::array::from_fn(|axis| last[axis].saturating_sub(first[axis]));
        let origin = grid.node_position(first);
        let place = |node: [usize; 3]| {
            let [i, j, k]: [usize; 3] = std::array::from_fn(|axis| node[axis] - first[axis]);
            (i * shape[1] + j) * shape[2] + k
        };
        let count = shape.iter().product();
        let (mut filled, mut wet) = (vec![false; count], vec![]);
        let [own_first, own_last] = self.own_span(grid);
        for i in own_first[0]..own_last[0] {
            for j in own_first[1]..own_last[1] {
                let row = place([i, j, own_first[2]]);
                filled[row..row + (own_last[2] - own_first[2])].fill(true);
            }
        }
        for surface in &self.surfaces {
            self.cut(grid, surface, place, &mut filled, &mut wet);
        }
        let mut cells: Vec<Option<MaterialId>> = match self.materials[..] {
            [] => vec![None; count],
            [only] => vec![Some(only); count],
            ref many => {
                let classes = (many.len() - 1) as f64;
                let noise =
                    if count == 0 { vec![] } else { fractal_volume(shape, self.weights, self.dimension, self.seed) };
                noise.into_iter().map(|noise| many.get((noise * classes).ceil() as usize).copied()).collect()
            }
        };
        cells.iter_mut().zip(filled).filter(|(_, filled)| !filled).for_each(|(cell, _)| *cell = None);
        cells.iter_mut().zip(wet).for_each(|(cell, wet)| *cell = wet.or(*cell));
        Voxels { origin, shape, cells: cells.into(), averaging: self.averaging, edges: None }
    }

    /// Cuts a rough face: within its range a column is filled up to the surface, whatever an earlier face left there, beyond it
    /// nothing changes.
    fn cut(
        &self,
        grid: &Grid,
        surface: &FractalSurface,
        place: impl Fn([usize; 3]) -> usize,
        filled: &mut [bool],
        wet: &mut Vec<Option<MaterialId>>,
    ) {
        let axis = surface.axis.index();
        let [p, q] = [[1, 2], [0, 2], [0, 1]][axis];
        let [low, high] = surface.range_in_cells(grid);
        let node = |axis: usize, metres| grid.node(axis, metres).clamp(0, grid.cells[axis] as i64) as usize;
        let [from, to] = [surface.lower, surface.upper].map(|corner| [node(p, corner[p]), node(q, corner[q])]);
        let shape = [to[0].saturating_sub(from[0]), to[1].saturating_sub(from[1])];
        if shape.contains(&0) || low >= high {
            return;
        }
        let noise = fractal_surface(shape, surface.weights, surface.dimension, surface.seed);
        if surface.water.is_some() && wet.is_empty() {
            *wet = vec![None; filled.len()];
        }
        let depth = surface.water.map(|(depth, water)| (node(axis, depth), water));
        for (column, noise) in noise.into_iter().enumerate() {
            let height = low as f64 + noise * (high - low) as f64;
            for k in low..high {
                let mut at = [k; 3];
                (at[p], at[q]) = (from[0] + column / shape[1], from[1] + column % shape[1]);
                let at = place(at);
                let upper = surface.upper_face;
                filled[at] = if upper { (k as f64) < height } else { k as f64 > height };
                if !wet.is_empty() {
                    let under = |depth: usize| if upper { k < depth } else { k > depth };
                    let water = depth.filter(|&(depth, _)| under(depth) && !filled[at]);
                    wet[at] = water.map(|(_, water)| water);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fractal(surfaces: Vec<FractalSurface>) -> FractalBox {
        FractalBox {
            lower: [0.002, 0.0, 0.004],
            upper: [0.022, 0.02, 0.014],
            dimension: 1.5,
            weights: [1.0; 3],
            materials: vec![MaterialId(2), MaterialId(3), MaterialId(4)],
            seed: 4,
            averaging: false,
            surfaces,
        }
    }

    fn surface() -> FractalSurface {
        FractalSurface {
            axis: Axis::Z,
            upper_face: true,
            lower: [0.002, 0.0, 0.014],
            upper: [0.022, 0.02, 0.014],
            dimension: 1.5,
            weights: [1.0; 2],
            range: [0.01, 0.018],
            seed: 5,
            water: Some((0.014, MaterialId(5))),
        }
    }

    const GRID: Grid = Grid { cells: [20, 20, 20], spacing: [0.002; 3] };

    /// The least noise stands in one cell, and is the only one of the first material.
    #[test]
    fn the_first_material_is_in_one_cell() {
        let voxels = fractal(vec![]).voxels(&GRID);
        assert_eq!((voxels.shape, voxels.cells.len()), ([10, 10, 5], 500));
        let of = |id: u16| voxels.cells.iter().filter(|cell| **cell == Some(MaterialId(id))).count();
        assert_eq!(of(2), 1);
        assert!(of(3) > 100 && of(4) > 100 && of(2) + of(3) + of(4) == 500);
    }

    /// A rough face from node 5 to node 9: a column ends between, water fills it up to node 7, and never lies above stuff.
    #[test]
    fn columns_end_at_the_surface_and_water_stands_on_it() {
        let voxels = fractal(vec![surface()]).voxels(&GRID);
        assert_eq!(voxels.shape, [10, 10, 7]);
        let mut ends = vec![];
        for column in voxels.cells.chunks(7) {
            let solid = column.iter().take_while(|cell| cell.is_some_and(|id| id != MaterialId(5))).count();
            let wet = column[solid..].iter().take_while(|cell| **cell == Some(MaterialId(5))).count();
            assert!(column[solid + wet..].iter().all(Option::is_none), "{column:?}");
            assert_eq!(solid + wet, solid.max(5));
            ends.push(solid);
        }
        // At its least the surface lies on node 5, 3 cells above the bottom, and at its greatest on node 9.
        assert_eq!((ends.iter().min(), ends.iter().max()), (Some(&3), Some(&7)));
    }

    /// Of two rough faces the later decides what lies in the range of both, water included: of the first face's water nothing
    /// is left within the second's range (as in 14 boxes of gprMax 4.0.1 with two to five rough faces).
    #[test]
    fn the_later_face_decides() {
        let side = FractalSurface {
            axis: Axis::X,
            lower: [0.022, 0.0, 0.004],
            upper: [0.022, 0.02, 0.014],
            range: [0.012, 0.022],
            water: None,
            ..surface()
        };
        let wet = |surfaces| {
            let voxels = fractal(surfaces).voxels(&GRID);
            let rows = voxels.cells.chunks(10 * voxels.shape[2]);
            rows.map(|plane| plane.iter().filter(|cell| **cell == Some(MaterialId(5))).count()).collect::<Vec<_>>()
        };
        let (alone, both) = (wet(vec![surface()]), wet(vec![surface(), side.clone()]));
        assert!(alone[5..].iter().sum::<usize>() > 0 && alone[..5] == both[..5]);
        assert_eq!(both[5..], [0; 5]);
        assert_eq!(wet(vec![side, surface()]), alone);
    }
}
