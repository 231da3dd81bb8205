//! What a bed of spheres is like: how many stones, how dense and where, which sizes.

use crate::geometry::{Sphere, ball_box_volume};
use crate::packing::grading::Grading;
use crate::packing::statistics::{GradingRow, ProfileRow};
use crate::units::{Metres, Share};

use super::bed::SphereBed;

impl SphereBed {
    /// Number of stones.
    pub fn count(&self) -> usize {
        self.spheres.len()
    }

    /// Volume of the stones, m³.
    pub fn solid_volume(&self) -> f64 {
        self.spheres.iter().map(Sphere::volume).sum()
    }

    /// Area of the floor, m².
    pub fn floor_area(&self) -> f64 {
        self.size[0].si() * self.size[1].si()
    }

    /// Top of the highest stone.
    pub fn top(&self) -> Metres {
        Metres(self.spheres.iter().map(|sphere| sphere.centre[2] + sphere.radius).fold(0.0, f64::max))
    }

    /// Diameter of the smallest stone.
    pub fn smallest_diameter(&self) -> Metres {
        Metres(self.spheres.iter().map(|sphere| 2.0 * sphere.radius).reduce(f64::min).unwrap_or(0.0))
    }

    /// Diameter of the largest stone.
    pub fn largest_diameter(&self) -> Metres {
        Metres(self.spheres.iter().map(|sphere| 2.0 * sphere.radius).fold(0.0, f64::max))
    }

    /// Mean diameter, by number.
    pub fn mean_diameter(&self) -> Metres {
        Metres(self.spheres.iter().map(|sphere| 2.0 * sphere.radius).sum::<f64>() / self.count().max(1) as f64)
    }

    /// Solid share of the box up to the top of the highest stone.
    pub fn solid_share(&self) -> Share {
        Share(self.solid_volume() / (self.floor_area() * self.top().si()))
    }

    /// Solid share between two heights over the whole floor, from exact spherical segments.
    pub fn solid_share_between(&self, bottom: Metres, top: Metres) -> Share {
        let solid: f64 = self.spheres.iter().map(|sphere| sphere.volume_between(bottom.si(), top.si())).sum();
        Share(solid / (self.floor_area() * (top.si() - bottom.si())))
    }

    /// Solid share of a box within the bed, from the exact volume that each ball has in common with it.
    ///
    /// Where the bed repeats itself the box counts the images of the stones too.
    pub fn solid_share_in(&self, low: [f64; 3], high: [f64; 3]) -> Share {
        let shifts = |axis: usize| {
            let period = self.size[axis].si();
            if self.periodic[axis] { vec![-period, 0.0, period] } else { vec![0.0] }
        };
        let mut solid = 0.0;
        for dx in shifts(0) {
            for dy in shifts(1) {
                for sphere in &self.spheres {
                    let centre = [sphere.centre[0] + dx, sphere.centre[1] + dy, sphere.centre[2]];
                    let apart = |axis: usize| {
                        centre[axis] + sphere.radius <= low[axis] || centre[axis] - sphere.radius >= high[axis]
                    };
                    if !(0..3).any(apart) {
                        let from = std::array::from_fn(|axis| low[axis] - centre[axis]);
                        let to = std::array::from_fn(|axis| high[axis] - centre[axis]);
                        solid += ball_box_volume(sphere.radius, from, to);
                    }
                }
            }
        }
        Share(solid / (0..3).map(|axis| high[axis] - low[axis]).product::<f64>())
    }

    /// The part of the bed away from walls, floor and surface, as its lowest and highest corner, m.
    ///
    /// It begins a largest diameter from each wall and from the floor and ends a largest diameter below the top of the
    /// highest stone; all of a direction in which the bed repeats itself. Where that leaves less than a diameter, it is the
    /// middle half.
    pub fn interior(&self) -> ([f64; 3], [f64; 3]) {
        let stone = self.largest_diameter().si();
        let size = [self.size[0].si(), self.size[1].si(), self.top().si()];
        let rim = |axis: usize| match () {
            () if axis < 2 && self.periodic[axis] => 0.0,
            () if size[axis] >= 3.0 * stone => stone,
            () => 0.25 * size[axis],
        };
        (std::array::from_fn(rim), std::array::from_fn(|axis| size[axis] - rim(axis)))
    }

    /// Solid share of the [`interior`](Self::interior).
    pub fn interior_solid_share(&self) -> Share {
        let (low, high) = self.interior();
        self.solid_share_in(low, high)
    }

    /// Void share layer by layer from the floor to the top of the highest stone, over the whole floor; the last layer is as
    /// high as what is left. Empty for a layer height that is not above zero.
    pub fn porosity_profile(&self, layer: Metres) -> Vec<ProfileRow> {
        let (height, layer) = (self.top().si(), layer.si());
        if layer.is_nan() || layer <= 0.0 {
            return Vec::new();
        }
        let count = (height / layer - 1e-9).ceil().max(0.0) as usize;
        let mut solid = vec![0.0; count];
        for sphere in &self.spheres {
            let at = |z: f64| ((z / layer).max(0.0) as usize).min(count.saturating_sub(1));
            let (first, last) = (at(sphere.centre[2] - sphere.radius), at(sphere.centre[2] + sphere.radius));
            for (k, volume) in solid.iter_mut().enumerate().take(last + 1).skip(first) {
                *volume += sphere.volume_between(k as f64 * layer, (k + 1) as f64 * layer);
            }
        }
        let row = |(k, volume): (usize, f64)| {
            let (bottom, top) = (k as f64 * layer, ((k + 1) as f64 * layer).min(height));
            let voids = Share(1.0 - volume / (self.floor_area() * (top - bottom)));
            ProfileRow { bottom: Metres(bottom), top: Metres(top), voids }
        };
        solid.into_iter().enumerate().map(row).collect()
    }

    /// Compares the sizes with a grading, sieve by sieve, by mass (all stones have one density).
    ///
    /// Stones as large as a sieve pass it, to 1e-9 of its size: class edges are sieves.
    pub fn grading_table(&self, grading: &Grading) -> Vec<GradingRow> {
        let total = self.solid_volume();
        let row = |sieve: Metres, wanted: Share| {
            let limit = 0.5 * sieve.si() * (1.0 + 1e-9);
            let passes = self.spheres.iter().filter(|sphere| sphere.radius <= limit);
            // A sum of nothing is minus zero, which tables show; a fold from zero is not.
            let passing = passes.map(Sphere::volume).fold(0.0, |a, b| a + b);
            GradingRow { sieve, wanted, found: Share(passing / total) }
        };
        grading.sieves().iter().map(|sieve| row(sieve.size, sieve.passing)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packing::spheres::TOUCHING;
    use std::f64::consts::PI;

    /// A lattice of touching spheres of 20 mm in a periodic box of `n` cubic cells each way.
    fn lattice(n: usize, cell: f64, basis: &[[f64; 3]]) -> SphereBed {
        let mut spheres = Vec::new();
        for k in 0..n.pow(3) {
            for place in basis {
                let cell_at = [k % n, k / n % n, k / n / n];
                let centre = std::array::from_fn(|axis| {
                    (cell_at[axis] as f64 + place[axis]) * cell + 0.01 * f64::from(axis == 2)
                });
                spheres.push(Sphere { centre, radius: 0.01 });
            }
        }
        let side = Metres(n as f64 * cell);
        let mut bed = SphereBed::new("file", None, [side; 3], spheres);
        bed.periodic = [true; 2];
        bed
    }

    /// Simple cubic: pi/6 of the volume, six neighbours. One period of height anywhere inside holds exactly a layer.
    #[test]
    fn a_simple_cubic_bed() {
        let bed = lattice(6, 0.02, &[[0.0; 3]]);
        assert!((bed.solid_share().si() - PI / 6.0).abs() < 1e-12, "{}", bed.solid_share());
        let (low, high) = ([0.0, 0.0, 0.03], [0.12, 0.12, 0.09]);
        assert!((bed.solid_share_in(low, high).si() - PI / 6.0).abs() < 1e-12);
        // Any box whose sides are whole periods, wherever it begins, also across the rim of the box.
        let (low, high) = ([0.0137, 0.0291, 0.0223], [0.0537, 0.1091, 0.0623]);
        assert!((bed.solid_share_in(low, high).si() - PI / 6.0).abs() < 1e-12);
        assert!((bed.interior_solid_share().si() - PI / 6.0).abs() < 1e-12);
        let coordination = bed.coordination(TOUCHING);
        assert_eq!((coordination.interior, coordination.interior_without_rattlers), (6.0, 6.0));
        assert_eq!(coordination.histogram[6], 4 * 36);
        // All but the two outer layers have six, those five.
        assert!((coordination.mean - (4.0 * 6.0 + 2.0 * 5.0) / 6.0).abs() < 1e-12);
        for row in bed.porosity_profile(Metres(0.02)) {
            assert!((row.voids.si() - (1.0 - PI / 6.0)).abs() < 1e-12);
        }
    }

    /// Face-centred cubic: pi/(3 sqrt 2) = 0.7405 of the volume, twelve neighbours.
    #[test]
    fn a_face_centred_cubic_bed() {
        let cell = 0.02 * std::f64::consts::SQRT_2;
        let bed = lattice(4, cell, &[[0.0; 3], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]]);
        let share = PI / (3.0 * std::f64::consts::SQRT_2);
        let (low, high) = ([0.003, 0.0, 0.031], [0.003 + cell, 2.0 * cell, 0.031 + 2.0 * cell]);
        assert!((bed.solid_share_in(low, high).si() - share).abs() < 1e-12, "{}", bed.solid_share_in(low, high));
        let coordination = bed.coordination(TOUCHING);
        assert_eq!(coordination.interior, 12.0);
        assert_eq!(coordination.rattlers, Share(0.0));
        assert!(bed.deepest_overlap().is_none_or(|overlap| overlap.depth.si() < 1e-15));
    }

    /// The layers of a profile hold all the stone, also when the last is a thin rest.
    #[test]
    fn a_profile_loses_nothing() {
        let spheres =
            vec![Sphere { centre: [0.1, 0.1, 0.1], radius: 0.1 }, Sphere { centre: [0.3, 0.2, 0.25], radius: 0.05 }];
        let bed = SphereBed::new("file", None, [Metres(0.5), Metres(0.4), Metres(0.6)], spheres);
        for layer in [0.3, 0.07, 0.02, 0.0113] {
            let rows = bed.porosity_profile(Metres(layer));
            let solid: f64 =
                rows.iter().map(|row| (1.0 - row.voids.si()) * 0.2 * (row.top.si() - row.bottom.si())).sum();
            assert!((solid / bed.solid_volume() - 1.0).abs() < 1e-12, "{layer}: {solid}");
        }
        assert!(bed.porosity_profile(Metres(0.0)).is_empty());
    }
}
