//! A grid of cells in space that finds the spheres near a point.

use super::sphere::Sphere;

const NONE: u32 = u32::MAX;

/// Spheres sorted into cells by their centres, so that the neighbours of a point are found without looking at all.
///
/// The space may repeat itself along x or y: then the nearest image of each sphere is looked at, which is the right one as
/// long as `reach` is at most half the period. Centres outside the grid belong to its border cells, so nothing is missed.
#[derive(Debug, Clone)]
pub struct SphereGrid {
    side: [f64; 3],
    count: [usize; 3],
    period: [Option<f64>; 3],
    first: Vec<u32>,
    next: Vec<u32>,
    spheres: Vec<Sphere>,
}

impl SphereGrid {
    /// Lays cells of at least `side` over the box from the origin to `size`, m; `periodic` along x and y.
    ///
    /// A good side is the largest diameter. The side grows when the box would need more than eight million cells.
    pub fn new(size: [f64; 3], periodic: [bool; 2], side: f64) -> Self {
        let side = side.max((size.iter().product::<f64>() / 8e6).cbrt());
        let count = size.map(|length| ((length / side).floor().clamp(1.0, 4e6)) as usize);
        let side = std::array::from_fn(|axis| size[axis] / count[axis] as f64);
        let period = [periodic[0].then_some(size[0]), periodic[1].then_some(size[1]), None];
        let first = vec![NONE; count.iter().product()];
        Self { side, count, period, first, next: Vec::new(), spheres: Vec::new() }
    }

    /// Adds a sphere; its index is the number of spheres added before it.
    pub fn insert(&mut self, sphere: Sphere) {
        let at: [usize; 3] = std::array::from_fn(|axis| self.wrapped(axis, self.cell(axis, sphere.centre[axis])));
        let cell = (at[2] * self.count[1] + at[1]) * self.count[0] + at[0];
        self.next.push(self.first[cell]);
        self.first[cell] = self.spheres.len() as u32;
        self.spheres.push(sphere);
    }

    /// The spheres in the order in which they were added.
    pub fn spheres(&self) -> &[Sphere] {
        &self.spheres
    }

    /// Hands the spheres back in the order in which they were added.
    pub fn into_spheres(self) -> Vec<Sphere> {
        self.spheres
    }

    /// Finds a sphere near a point that passes `test`, which gets its index, itself and the way from the point to its
    /// (nearest image's) centre; stops at the first. Spheres with centres farther than `reach` may or may not be asked.
    pub fn find(
        &self,
        centre: [f64; 3],
        reach: f64,
        mut test: impl FnMut(usize, &Sphere, [f64; 3]) -> bool,
    ) -> Option<usize> {
        let range = |axis: usize| {
            let low = self.cell(axis, centre[axis] - reach);
            let high = self.cell(axis, centre[axis] + reach);
            // No cell twice where the reach goes round a short period.
            low..=high.min(low + self.count[axis] as i64 - 1)
        };
        for k in range(2) {
            for j in range(1) {
                for i in range(0) {
                    let [x, y, z] = [self.wrapped(0, i), self.wrapped(1, j), self.wrapped(2, k)];
                    let mut index = self.first[(z * self.count[1] + y) * self.count[0] + x];
                    while index != NONE {
                        let sphere = &self.spheres[index as usize];
                        let way = std::array::from_fn(|axis| {
                            let straight = sphere.centre[axis] - centre[axis];
                            self.period[axis].map_or(straight, |period| straight - period * (straight / period).round())
                        });
                        if test(index as usize, sphere, way) {
                            return Some(index as usize);
                        }
                        index = self.next[index as usize];
                    }
                }
            }
        }
        None
    }

    /// Shows every sphere whose surface is nearer than `gap` to that of `sphere`, with the gap between them.
    ///
    /// A sphere that is in the grid meets itself with a gap of minus its diameter.
    pub fn for_each_within(&self, sphere: &Sphere, gap: f64, largest_radius: f64, mut visit: impl FnMut(usize, f64)) {
        self.find(sphere.centre, sphere.radius + largest_radius + gap, |index, other, way| {
            let between = way.iter().map(|d| d * d).sum::<f64>().sqrt() - sphere.radius - other.radius;
            if between < gap {
                visit(index, between);
            }
            false
        });
    }

    /// The cell along an axis, which may lie outside the grid where the space repeats itself.
    fn cell(&self, axis: usize, at: f64) -> i64 {
        let cell = (at / self.side[axis]).floor() as i64;
        if self.period[axis].is_some() { cell } else { cell.clamp(0, self.count[axis] as i64 - 1) }
    }

    fn wrapped(&self, axis: usize, cell: i64) -> usize {
        cell.rem_euclid(self.count[axis] as i64) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// The grid finds what looking at every sphere and every image finds, for any cell size.
        #[test]
        fn the_grid_misses_nobody(
            centres in prop::collection::vec((0.0..2.0_f64, 0.0..1.0_f64, -0.2..1.2_f64), 1..60),
            at in (0.0..2.0_f64, 0.0..1.0_f64, -0.2..1.2_f64), reach in 0.01..0.49_f64, side in 0.05..3.0_f64,
            periodic in prop::array::uniform2(any::<bool>()),
        ) {
            let mut grid = SphereGrid::new([2.0, 1.0, 1.0], periodic, side);
            for &(x, y, z) in &centres {
                grid.insert(Sphere { centre: [x, y, z], radius: 0.01 });
            }
            let at = [at.0, at.1, at.2];
            let mut found = Vec::new();
            grid.find(at, reach, |index, _, way| {
                if way.iter().map(|d| d * d).sum::<f64>().sqrt() <= reach {
                    found.push(index);
                }
                false
            });
            found.sort_unstable();
            let shifts = |on: bool, period: f64| if on { vec![-period, 0.0, period] } else { vec![0.0] };
            let near = |c: &[f64; 3]| {
                shifts(periodic[0], 2.0).iter().any(|sx| shifts(periodic[1], 1.0).iter().any(|sy| {
                    (c[0] + sx - at[0]).powi(2) + (c[1] + sy - at[1]).powi(2) + (c[2] - at[2]).powi(2) <= reach * reach
                }))
            };
            let all: Vec<usize> = (0..centres.len()).filter(|&k| near(&grid.spheres()[k].centre)).collect();
            prop_assert_eq!(found, all);
        }
    }
}
