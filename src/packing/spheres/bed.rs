//! The bed of spheres: spheres in a box, whatever made them.

use crate::geometry::{Sphere, SphereGrid};
use crate::packing::bed::{FORMAT_VERSION, Overlap};
use crate::packing::error::{PackingError, positive};
use crate::units::Metres;

/// Two spheres that touch, and what they press with.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SphereContact {
    /// Index of one sphere.
    pub first: u32,
    /// Index of the other.
    pub second: u32,
    /// Normal force between them, N.
    pub normal_force: f64,
}

/// Spheres in a box, with what made them.
///
/// The origin is a lower corner of the box, `z` points up. The order of the spheres means nothing, and is kept.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SphereBed {
    /// The format version of the program that wrote it: that of all packings.
    pub format_version: u32,
    /// What made it: `dem`, `random-addition`, `file`.
    pub generator: String,
    /// The seed that makes it again; none for a bed that was read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// Length, width and height of the box, along x, y and z.
    pub size: [Metres; 3],
    /// Whether the bed repeats itself along x and along y, in place of walls.
    #[serde(default)]
    pub periodic: [bool; 2],
    /// The stones, metres.
    pub spheres: Vec<Sphere>,
    /// Contacts between stones with their forces; empty where the generator knows no forces.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub contacts: Vec<SphereContact>,
}

impl SphereBed {
    /// Puts spheres into a box with walls, without looking at them.
    pub fn new(generator: impl Into<String>, seed: Option<u64>, size: [Metres; 3], spheres: Vec<Sphere>) -> Self {
        Self {
            format_version: FORMAT_VERSION,
            generator: generator.into(),
            seed,
            size,
            periodic: [false; 2],
            spheres,
            contacts: Vec::new(),
        }
    }

    /// The spheres in a grid of their neighbours.
    pub(super) fn grid(&self) -> SphereGrid {
        let mut grid = SphereGrid::new(self.size.map(Metres::si), self.periodic, self.largest_diameter().si());
        for sphere in &self.spheres {
            grid.insert(*sphere);
        }
        grid
    }

    /// The two spheres that overlap most, if any do at all. Stones that settled under their weight overlap by what their
    /// contacts are compressed: judge the depth.
    pub fn deepest_overlap(&self) -> Option<Overlap> {
        let largest = 0.5 * self.largest_diameter().si();
        let grid = self.grid();
        let mut deepest: Option<Overlap> = None;
        for (second, sphere) in self.spheres.iter().enumerate() {
            grid.for_each_within(sphere, 0.0, largest, |first, gap| {
                if first < second && deepest.is_none_or(|found| -gap > found.depth.si()) {
                    deepest = Some(Overlap { first, second, depth: Metres(-gap) });
                }
            });
        }
        deepest
    }

    /// Checks a bed from outside: a box and radii that are lengths, spheres inside it (with their centres, along a direction
    /// in which the bed repeats itself; upwards without a limit), none deeper in another than `tolerance`, contacts of
    /// spheres that are there.
    ///
    /// # Errors
    /// The first sphere that leaves the box by more than `tolerance`, the two that overlap most, the first bad contact.
    pub fn checked(self, tolerance: Metres) -> Result<Self, PackingError> {
        for (what, length) in ["length of the box", "width of the box", "height of the box"].into_iter().zip(self.size)
        {
            positive(what, length)?;
        }
        if self.spheres.is_empty() {
            return Err(PackingError::Empty);
        }
        let allowed = tolerance.si();
        for (k, sphere) in self.spheres.iter().enumerate() {
            positive("radius of a stone", Metres(sphere.radius))?;
            let inside = (0..3).all(|axis| {
                let at = sphere.centre[axis];
                let reach = if axis < 2 && self.periodic[axis] { 0.0 } else { sphere.radius };
                at - reach >= -allowed
                    && (at + reach <= self.size[axis].si() + allowed || (axis == 2 && at.is_finite()))
            });
            if !inside {
                return Err(PackingError::OutsideBox {
                    number: k + 1,
                    centre: sphere.centre.map(Metres),
                    radius: Metres(sphere.radius),
                    size: self.size,
                });
            }
        }
        let count = self.spheres.len();
        if let Some(k) = self.contacts.iter().position(|contact| contact.first.max(contact.second) as usize >= count) {
            return Err(PackingError::NoSuchStone { contact: k + 1, stones: count });
        }
        match self.deepest_overlap() {
            Some(Overlap { first, second, depth }) if depth > tolerance => {
                Err(PackingError::Overlap { first: first + 1, second: second + 1, depth, tolerance })
            }
            _ => Ok(self),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair(gap: f64) -> SphereBed {
        let spheres = vec![
            Sphere { centre: [0.1, 0.1, 0.1], radius: 0.05 },
            Sphere { centre: [0.1, 0.1, 0.2 + gap], radius: 0.05 },
        ];
        SphereBed::new("file", None, [Metres(0.3), Metres(0.2), Metres(0.5)], spheres)
    }

    #[test]
    fn an_overlap_names_both_stones_and_a_periodic_one_is_seen() {
        assert!(pair(1e-3).deepest_overlap().is_none());
        let overlap = pair(-2e-3).deepest_overlap().unwrap();
        assert_eq!((overlap.first, overlap.second), (0, 1));
        assert!((overlap.depth.si() - 2e-3).abs() < 1e-15);
        assert!(pair(-2e-3).checked(Metres(2.5e-3)).is_ok());
        assert!(matches!(pair(-2e-3).checked(Metres(1e-6)), Err(PackingError::Overlap { first: 1, second: 2, .. })));
        let mut round = pair(1e-3);
        round.spheres[0].centre = [0.01, 0.1, 0.1];
        round.spheres[1].centre = [0.25, 0.1, 0.1];
        assert!(round.deepest_overlap().is_none());
        round.periodic = [true, false];
        assert!((round.deepest_overlap().unwrap().depth.si() - 0.04).abs() < 1e-15);
    }

    #[test]
    fn what_is_not_in_the_box_is_named() {
        let mut bed = pair(0.0);
        bed.spheres[1].centre[0] = 0.28;
        assert_eq!(
            bed.clone().checked(Metres(1e-6)).unwrap_err().to_string(),
            "stone 2 at x 0.28 m, y 0.1 m, z 0.2 m with radius 50 mm leaves the box of 0.3 m by 0.2 m by 0.5 m"
        );
        bed.periodic = [true, false];
        assert!(bed.clone().checked(Metres(1e-6)).is_ok());
        bed.contacts.push(SphereContact { first: 0, second: 2, normal_force: 1.0 });
        assert_eq!(
            bed.checked(Metres(1e-6)).unwrap_err().to_string(),
            "contact 1 is one of a stone that is not there: the bed holds 2 stones"
        );
        let mut bed = pair(0.0);
        bed.spheres[0].centre[2] = f64::NAN;
        assert!(matches!(bed.checked(Metres(1e-6)), Err(PackingError::OutsideBox { number: 1, .. })));
    }
}
