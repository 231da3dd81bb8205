//! Which triangles of a mesh may be near a grain.

use crate::geometry::triangle_mesh::TriangleMesh;

/// Most cells along an axis.
const MOST_CELLS: usize = 48;

/// A grid over a mesh: each cell knows the triangles nearer to it than a reach.
#[derive(Debug, Clone, Default)]
pub struct MeshGrid {
    lower: [f64; 3],
    upper: [f64; 3],
    per_metre: [f64; 3],
    count: [usize; 3],
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl MeshGrid {
    /// Lays a grid for grains whose radius and skin are together at most `reach`, m.
    pub fn new(mesh: &TriangleMesh, reach: f64) -> Self {
        let [lower, upper] = mesh.bounds();
        let (lower, upper) = (lower.map(|v| v - reach), upper.map(|v| v + reach));
        let size = [0, 1, 2].map(|k| upper[k] - lower[k]);
        let count = size.map(|size| ((size / reach).ceil() as usize).clamp(1, MOST_CELLS));
        let per_metre = [0, 1, 2].map(|k| count[k] as f64 / size[k]);
        let mut made = Self { lower, upper, per_metre, count, ..Self::default() };
        let boxes: Vec<_> = (0..mesh.triangles().len())
            .map(|triangle| {
                let [from, to] = mesh.triangle_bounds(triangle);
                (made.cell_of(from.map(|v| v - reach)), made.cell_of(to.map(|v| v + reach)))
            })
            .collect();
        let within = |(from, to): &([usize; 3], [usize; 3]), cell: [usize; 3]| {
            (0..3).all(|k| from[k] <= cell[k] && cell[k] <= to[k])
        };
        made.starts.push(0);
        for z in 0..count[2] {
            for y in 0..count[1] {
                for x in 0..count[0] {
                    let near = boxes.iter().enumerate().filter(|(_, ends)| within(ends, [x, y, z]));
                    made.triangles.extend(near.map(|(triangle, _)| triangle as u32));
                    made.starts.push(made.triangles.len() as u32);
                }
            }
        }
        made
    }

    fn cell_of(&self, place: [f64; 3]) -> [usize; 3] {
        [0, 1, 2].map(|k| (((place[k] - self.lower[k]) * self.per_metre[k]) as usize).min(self.count[k] - 1))
    }

    /// Triangles that may be within the reach of a place in the frame of the mesh.
    pub fn near(&self, place: [f64; 3]) -> &[u32] {
        if (0..3).any(|k| !(place[k] >= self.lower[k] && place[k] <= self.upper[k])) {
            return &[];
        }
        let [x, y, z] = self.cell_of(place);
        let cell = (z * self.count[1] + y) * self.count[0] + x;
        &self.triangles[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::triangle_mesh::square_hopper;
    use crate::units::Metres;

    /// Every triangle within the reach of a place is among those the grid gives.
    #[test]
    fn the_grid_misses_no_triangle() {
        let mesh = square_hopper([0.0, 0.0, 0.7], Metres(0.25), Metres(1.0), Metres(0.6), true).unwrap();
        let reach = 0.06;
        let grid = MeshGrid::new(&mesh, reach);
        let mut seen = 0;
        for n in 0..20_000_u32 {
            let part = |k: u32| f64::from(n.wrapping_mul(2_654_435_761 + 40_503 * k) >> 8) / f64::from(1 << 24);
            let place = [part(1) * 1.6 - 0.8, part(2) * 1.6 - 0.8, part(3) * 1.0 + 0.5];
            for triangle in 0..mesh.triangles().len() as u32 {
                if mesh.distance_to(triangle, place) < reach {
                    seen += 1;
                    assert!(grid.near(place).contains(&triangle), "{triangle} near {place:?}");
                }
            }
        }
        assert!(seen > 100, "{seen}");
    }
}
