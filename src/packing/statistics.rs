//! What a packing is like: how many stones, how dense and where, which sizes.

use crate::geometry::{Disc, area_between};
use crate::units::{Metres, Share};

use super::bed::Packing;
use super::grading::Grading;

/// The void share of a horizontal slice of a packing.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct ProfileRow {
    /// Lower edge of the slice.
    pub bottom: Metres,
    /// Upper edge of the slice.
    pub top: Metres,
    /// Void share over the full width.
    pub voids: Share,
}

/// A sieve with what passes it in the grading and in the packing, by area.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct GradingRow {
    /// The sieve.
    pub sieve: Metres,
    /// What should pass.
    pub wanted: Share,
    /// What passes: share of the disc area with diameters up to the sieve.
    pub found: Share,
}

impl GradingRow {
    /// Found less wanted; +1 % means that one percent of the area too much passes.
    pub fn deviation(&self) -> Share {
        Share(self.found.si() - self.wanted.si())
    }
}

impl Packing {
    /// Number of stones.
    pub fn count(&self) -> usize {
        self.discs.len()
    }

    /// Area covered by stones, m².
    pub fn solid_area(&self) -> f64 {
        self.discs.iter().map(Disc::area).sum()
    }

    /// Top of the highest stone, `h_final` of the paper.
    pub fn top(&self) -> Metres {
        Metres(self.discs.iter().map(|disc| disc.y + disc.radius).fold(0.0, f64::max))
    }

    /// Solid share of the rectangle that the stones take up, `P_c,final = A_solid/(l h_final)` (eq. 3).
    pub fn solid_share(&self) -> Share {
        Share(self.solid_area() / (self.width.si() * self.top().si()))
    }

    /// Solid share of the slice between two heights over the full width, from exact circular segments.
    pub fn solid_share_between(&self, bottom: Metres, top: Metres) -> Share {
        let solid: f64 = self.discs.iter().map(|disc| area_between(disc, bottom.si(), top.si())).sum();
        Share(solid / (self.width.si() * (top.si() - bottom.si())))
    }

    /// Solid share away from the floor and from the rough top surface.
    ///
    /// The slice begins one largest diameter above the floor and ends two below the top of the highest stone (the surface
    /// of a bed compacted without rolling is rough by more than one). A bed too shallow for that gives its middle half.
    pub fn interior_solid_share(&self) -> Share {
        let (bottom, top) = self.interior();
        self.solid_share_between(bottom, top)
    }

    /// The slice that [`Packing::interior_solid_share`] looks at.
    pub fn interior(&self) -> (Metres, Metres) {
        let (height, stone) = (self.top().si(), self.largest_diameter().si());
        let (bottom, top) = (stone, height - 2.0 * stone);
        if top - bottom >= stone {
            (Metres(bottom), Metres(top))
        } else {
            (Metres(0.25 * height), Metres(0.75 * height))
        }
    }

    /// Void share slice by slice from the floor to the top of the highest stone; the last slice is as high as what is left.
    ///
    /// Empty for a slice height that is not above zero.
    pub fn porosity_profile(&self, slice: Metres) -> Vec<ProfileRow> {
        let (height, slice) = (self.top().si(), slice.si());
        if slice.is_nan() || slice <= 0.0 {
            return Vec::new();
        }
        let count = (height / slice - 1e-9).ceil().max(0.0) as usize;
        let mut solid = vec![0.0; count];
        for disc in &self.discs {
            let first = ((disc.y - disc.radius) / slice).max(0.0) as usize;
            let last = (((disc.y + disc.radius) / slice).max(0.0) as usize).min(count.saturating_sub(1));
            for (k, area) in solid.iter_mut().enumerate().take(last + 1).skip(first) {
                *area += area_between(disc, k as f64 * slice, (k + 1) as f64 * slice);
            }
        }
        let row = |(k, area): (usize, f64)| {
            let (bottom, top) = (k as f64 * slice, ((k + 1) as f64 * slice).min(height));
            let voids = Share(1.0 - area / (self.width.si() * (top - bottom)));
            ProfileRow { bottom: Metres(bottom), top: Metres(top), voids }
        };
        solid.into_iter().enumerate().map(row).collect()
    }

    /// Mean diameter, by number.
    pub fn mean_diameter(&self) -> Metres {
        Metres(self.discs.iter().map(|disc| 2.0 * disc.radius).sum::<f64>() / self.discs.len().max(1) as f64)
    }

    /// Diameter of the smallest stone.
    pub fn smallest_diameter(&self) -> Metres {
        Metres(self.discs.iter().map(|disc| 2.0 * disc.radius).reduce(f64::min).unwrap_or(0.0))
    }

    /// Diameter of the largest stone.
    pub fn largest_diameter(&self) -> Metres {
        Metres(self.discs.iter().map(|disc| 2.0 * disc.radius).fold(0.0, f64::max))
    }

    /// Compares the sizes with a grading, sieve by sieve, by area (Figure 8 of Benedetto et al. 2018).
    ///
    /// Stones as large as a sieve pass it, to 1e-9 of its size: class edges are sieves.
    pub fn grading_table(&self, grading: &Grading) -> Vec<GradingRow> {
        let total = self.solid_area();
        let row = |sieve: Metres, wanted: Share| {
            let limit = 0.5 * sieve.si() * (1.0 + 1e-9);
            // A sum of nothing is minus zero, which tables show; a fold from zero is not.
            let passing = self.discs.iter().filter(|disc| disc.radius <= limit).map(Disc::area).fold(0.0, |a, b| a + b);
            GradingRow { sieve, wanted, found: Share(passing / total) }
        };
        grading.sieves().iter().map(|sieve| row(sieve.size, sieve.passing)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two() -> Packing {
        let discs = vec![Disc { x: 0.1, y: 0.1, radius: 0.1 }, Disc { x: 0.35, y: 0.25, radius: 0.05 }];
        Packing::new("file", None, (Metres(0.5), Metres(0.4)), discs)
    }

    #[test]
    fn the_numbers_of_two_discs() {
        let (packing, pi) = (two(), std::f64::consts::PI);
        assert_eq!(packing.count(), 2);
        assert!((packing.solid_area() - pi * 0.0125).abs() < 1e-15);
        assert!((packing.top().si() - 0.3).abs() < 1e-15);
        assert!((packing.solid_share().si() - pi * 0.0125 / 0.15).abs() < 1e-14);
        assert!((packing.mean_diameter().si() - 0.15).abs() < 1e-15);
        assert_eq!((packing.smallest_diameter(), packing.largest_diameter()), (Metres(0.1), Metres(0.2)));
        assert!((packing.solid_share_between(Metres(0.0), Metres(0.1)).si() - pi * 0.005 / 0.05).abs() < 1e-14);
    }

    /// The slices of a profile hold all the stone, also when the last is a thin rest.
    #[test]
    fn a_profile_loses_nothing() {
        for slice in [0.3, 0.07, 0.02, 0.0113] {
            let rows = two().porosity_profile(Metres(slice));
            let solid: f64 =
                rows.iter().map(|row| (1.0 - row.voids.si()) * 0.5 * (row.top.si() - row.bottom.si())).sum();
            assert!((solid - two().solid_area()).abs() < 1e-14, "{slice}: {solid}");
            assert!((rows.last().unwrap().top.si() - 0.3).abs() < 1e-15);
        }
        assert!(two().porosity_profile(Metres(0.0)).is_empty());
    }

    /// Areas 0.0025 π of 100 mm and 0.01 π of 200 mm: one fifth passes 100 mm.
    #[test]
    fn the_grading_table_is_by_area() {
        let grading = Grading::from_csv("two", "sieve_mm,passing_percent\n50,0\n100,25\n200,100\n").unwrap();
        let rows = two().grading_table(&grading);
        let found: Vec<f64> = rows.iter().map(|row| (row.found.si() * 1e9).round() / 1e9).collect();
        assert_eq!(found, [0.0, 0.2, 1.0]);
        assert!((rows[1].deviation().si() + 0.05).abs() < 1e-12);
    }
}
