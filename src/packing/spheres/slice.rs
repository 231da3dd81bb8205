//! The discs that an upright plane cuts out of a bed of spheres.

use crate::geometry::Disc;
use crate::packing::bed::Packing;
use crate::packing::error::PackingError;
use crate::units::Metres;

use super::bed::SphereBed;

/// An upright plane across a bed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SlicePlane {
    /// Across x: the section shows y and z.
    X(Metres),
    /// Across y: the section shows x and z.
    Y(Metres),
}

impl SlicePlane {
    const fn axis(self) -> usize {
        match self {
            Self::X(_) => 0,
            Self::Y(_) => 1,
        }
    }

    const fn at(self) -> Metres {
        match self {
            Self::X(at) | Self::Y(at) => at,
        }
    }
}

/// Cut discs smaller than this are left out, m: a micrometre, no more than rounding where a plane is a tangent.
const THINNEST: f64 = 1e-6;

impl SphereBed {
    /// Cuts the bed with a plane: discs with the radii of the cut, `sqrt(r² - d²)`, not of the spheres.
    ///
    /// The discs of a section are smaller than the stones and few of them touch: the stones that hold them lie before and
    /// behind the plane. The share of the section that is stone is on average that of the bed (Delesse 1847). Where the bed
    /// repeats itself along the section, a stone on the rim is there twice, once at either side.
    ///
    /// # Errors
    /// A plane outside the box, or one that meets no stone.
    pub fn slice(&self, plane: SlicePlane) -> Result<Packing, PackingError> {
        let (axis, at) = (plane.axis(), plane.at().si());
        let along = 1 - axis;
        let (depth, width) = (self.size[axis].si(), self.size[along].si());
        if !(0.0..=depth).contains(&at) {
            return Err(PackingError::PlaneOutside { axis: ["x", "y"][axis], at: plane.at(), limit: self.size[axis] });
        }
        let mut discs = Vec::new();
        for sphere in &self.spheres {
            let straight = at - sphere.centre[axis];
            let away = if self.periodic[axis] { straight - depth * (straight / depth).round() } else { straight };
            let radius = (sphere.radius * sphere.radius - away * away).max(0.0).sqrt();
            if radius < THINNEST {
                continue;
            }
            let (x, y) = (sphere.centre[along], sphere.centre[2]);
            discs.push(Disc { x, y, radius });
            if self.periodic[along] {
                let images = [x - width, x + width].into_iter().filter(|x| x + radius > 0.0 && x - radius < width);
                discs.extend(images.map(|x| Disc { x, y, radius }));
            }
        }
        if discs.is_empty() {
            return Err(PackingError::EmptySlice { axis: ["x", "y"][axis], at: plane.at() });
        }
        let mut packing = Packing::new("slice", self.seed, (Metres(width), Metres(0.0)), discs);
        packing.height = packing.top();
        Ok(packing)
    }

    /// Cuts the bed with `count` planes across an axis (0 for x, 1 for y), each in the middle of one of as many equal parts.
    ///
    /// # Errors
    /// See [`slice`](Self::slice).
    pub fn slices(&self, axis: usize, count: usize) -> Result<Vec<Packing>, PackingError> {
        (0..count).map(|k| self.slice(self.slice_plane(axis, k, count))).collect()
    }

    /// The plane in the middle of part `k` of `count` equal parts across an axis (0 for x, otherwise y).
    pub fn slice_plane(&self, axis: usize, k: usize, count: usize) -> SlicePlane {
        let at = |axis: usize| Metres((k as f64 + 0.5) / count as f64 * self.size[axis].si());
        if axis == 0 { SlicePlane::X(at(0)) } else { SlicePlane::Y(at(1)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Sphere, disc_rectangle_area};
    use crate::packing::spheres::{RandomAddition, random_addition};
    use crate::packing::{ClassReading, Grading};
    use crate::units::Share;

    /// A 3-4-5 triangle: a sphere of 50 mm cut 30 mm off its centre shows a disc of 40 mm, at its height.
    #[test]
    fn a_cut_has_the_radius_of_pythagoras() {
        let sphere = Sphere { centre: [0.1, 0.2, 0.07], radius: 0.05 };
        let mut bed = SphereBed::new("file", None, [Metres(0.3), Metres(0.4), Metres(0.5)], vec![sphere]);
        let cut = bed.slice(SlicePlane::Y(Metres(0.23))).unwrap();
        assert_eq!((cut.discs.len(), cut.width), (1, Metres(0.3)));
        let disc = cut.discs[0];
        assert!((disc.radius - 0.04).abs() < 1e-15 && disc.x == 0.1 && disc.y == 0.07);
        let cut = bed.slice(SlicePlane::X(Metres(0.06))).unwrap();
        assert!((cut.discs[0].radius - 0.03).abs() < 1e-15 && cut.discs[0].x == 0.2 && cut.width == Metres(0.4));
        assert_eq!(
            bed.slice(SlicePlane::Y(Metres(0.25))).unwrap_err().to_string(),
            "the plane y = 0.25 m meets no stone\n\nhint: take one further inside"
        );
        assert_eq!(
            bed.slice(SlicePlane::Y(Metres(0.5))).unwrap_err().to_string(),
            "the plane y = 0.5 m lies outside the bed\n\nhint: take one from 0 m to 0.4 m"
        );
        bed.periodic = [true, true];
        bed.spheres[0].centre = [0.01, 0.39, 0.07];
        let cut = bed.slice(SlicePlane::Y(Metres(0.02))).unwrap();
        let places: Vec<f64> = cut.discs.iter().map(|disc| (disc.x * 100.0).round()).collect();
        assert_eq!(places, [1.0, 31.0]);
        assert!(cut.discs.iter().all(|disc| (disc.radius - 0.04).abs() < 1e-15));
    }

    /// Cavalieri: the mean area of evenly spaced sections times the depth is the volume. Delesse: so the share of a section
    /// is that of the bed, within the standard error of the sections. Sums over 400 planes of the smooth part err by less
    /// than 1e-3.
    #[test]
    fn sections_hold_on_average_what_the_bed_holds() {
        let input = RandomAddition {
            size: [Metres(0.5), Metres(0.4), Metres(0.3)],
            periodic: [true, true],
            grading: Grading::benedetto2018().unwrap(),
            class_reading: ClassReading::En933,
            solid_share: Share(0.3),
        };
        let bed = random_addition(&input, 2).unwrap();
        let share = bed.solid_volume() / (0.5 * 0.4 * 0.3);
        let area = |packing: &Packing| -> f64 {
            let (w, h) = (packing.width.si(), 0.3);
            packing.discs.iter().map(|d| disc_rectangle_area(d.radius, -d.x, w - d.x, -d.y, h - d.y)).sum::<f64>()
                / (w * h)
        };
        for axis in [0, 1] {
            let many: Vec<f64> = bed.slices(axis, 400).unwrap().iter().map(area).collect();
            let mean = many.iter().sum::<f64>() / 400.0;
            assert!((mean / share - 1.0).abs() < 1e-3, "axis {axis}: {mean} {share}");
            let few: Vec<f64> = bed.slices(axis, 8).unwrap().iter().map(area).collect();
            let mean = few.iter().sum::<f64>() / 8.0;
            let error = (few.iter().map(|a| (a - mean).powi(2)).sum::<f64>() / 7.0 / 8.0).sqrt();
            // Three standard errors: one run in a hundred or so would miss two, and this one is always the same.
            assert!((mean - share).abs() < 3.0 * error, "axis {axis}: {mean} ± {error}, {share}");
        }
    }
}
