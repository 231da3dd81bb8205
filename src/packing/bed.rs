//! The packing: discs in a rectangle, whatever made them.

use crate::geometry::{Disc, NeighbourGrid};
use crate::units::Metres;

use super::error::{PackingError, positive};

/// The version of the JSON form of a [`Packing`].
pub const FORMAT_VERSION: u32 = 1;

/// Stones in a rectangular domain, with what made them.
///
/// The origin is the lower left corner of the domain, `y` points up. The order of the discs means nothing, and is kept.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Packing {
    /// [`FORMAT_VERSION`] of the program that wrote it.
    pub format_version: u32,
    /// What made it: `rsa`, `rsa-compacted`, `file`.
    pub generator: String,
    /// The seed that makes it again; none for a packing that was read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// Width of the domain.
    pub width: Metres,
    /// Height of the domain: for a compacted packing the top of its highest stone.
    pub height: Metres,
    /// The stones, metres.
    pub discs: Vec<Disc>,
}

/// Two discs that overlap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// Index of one disc.
    pub first: usize,
    /// Index of the other, larger.
    pub second: usize,
    /// How deep they overlap.
    pub depth: Metres,
}

impl Packing {
    /// Puts discs into a domain, without looking at them.
    pub fn new(
        generator: impl Into<String>,
        seed: Option<u64>,
        (width, height): (Metres, Metres),
        discs: Vec<Disc>,
    ) -> Self {
        Self { format_version: FORMAT_VERSION, generator: generator.into(), seed, width, height, discs }
    }

    /// The two discs that overlap most, if any do at all.
    ///
    /// Rounding makes resting discs overlap by up to 1e-15 m or so; judge the depth.
    pub fn deepest_overlap(&self) -> Option<Overlap> {
        let largest = self.discs.iter().map(|disc| disc.radius).fold(0.0, f64::max);
        let mut grid = NeighbourGrid::new(self.width.si(), self.height.si(), 2.0 * largest);
        let mut deepest: Option<Overlap> = None;
        for (second, disc) in self.discs.iter().enumerate() {
            grid.for_each(disc.x, disc.y, disc.radius + largest, |first, other| {
                let depth = -disc.gap(other);
                if depth > 0.0 && deepest.is_none_or(|found| depth > found.depth.si()) {
                    deepest = Some(Overlap { first, second, depth: Metres(depth) });
                }
            });
            grid.insert(*disc);
        }
        deepest
    }

    /// Checks a packing from outside: a domain and radii that are lengths, discs inside it, and none deeper in one another
    /// than `tolerance`.
    ///
    /// # Errors
    /// The first disc that leaves the domain by more than `tolerance`, or the two that overlap most.
    pub fn checked(self, tolerance: Metres) -> Result<Self, PackingError> {
        let (width, height) =
            (positive("width of the domain", self.width)?, positive("height of the domain", self.height)?);
        if self.discs.is_empty() {
            return Err(PackingError::Empty);
        }
        let allowed = tolerance.si();
        for (k, disc) in self.discs.iter().enumerate() {
            positive("radius of a stone", Metres(disc.radius))?;
            let inside = disc.x - disc.radius >= -allowed
                && disc.x + disc.radius <= width + allowed
                && disc.y - disc.radius >= -allowed
                && disc.y + disc.radius <= height + allowed;
            if !inside {
                return Err(PackingError::Outside {
                    number: k + 1,
                    x: Metres(disc.x),
                    y: Metres(disc.y),
                    radius: Metres(disc.radius),
                    width: self.width,
                    height: self.height,
                });
            }
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

    fn pair(gap: f64) -> Packing {
        let discs = vec![Disc { x: 0.1, y: 0.1, radius: 0.05 }, Disc { x: 0.2 + gap, y: 0.1, radius: 0.05 }];
        Packing::new("file", None, (Metres(0.5), Metres(0.2)), discs)
    }

    #[test]
    fn an_overlap_beyond_the_tolerance_names_both_stones() {
        assert!(pair(0.001).deepest_overlap().is_none());
        let overlap = pair(-0.002).deepest_overlap().unwrap();
        assert_eq!((overlap.first, overlap.second), (0, 1));
        assert!((overlap.depth.si() - 0.002).abs() < 1e-15);
        assert!(pair(-0.002).checked(Metres(0.0025)).is_ok());
        let mut packing = pair(-0.25e-1);
        packing.discs[1].x = 0.175;
        let error = packing.checked(Metres(1e-6)).unwrap_err();
        let PackingError::Overlap { first: 1, second: 2, depth, .. } = error else { panic!("{error}") };
        assert!((depth.si() - 0.025).abs() < 1e-15);
        let error = PackingError::Overlap { first: 1, second: 2, depth: Metres(0.025), tolerance: Metres(1e-6) };
        assert_eq!(
            error.to_string(),
            "stones 1 and 2 overlap by 25 mm, more than the 0.001 mm allowed\n\nhint: stones are counted from 1 in the order of the file"
        );
    }

    #[test]
    fn a_stone_outside_the_domain_is_named() {
        let mut packing = pair(0.0);
        packing.discs[1].x = 0.48;
        assert_eq!(
            packing.checked(Metres(1e-6)).unwrap_err().to_string(),
            "stone 2 at x 0.48 m, y 0.1 m with radius 50 mm leaves the domain of 0.5 m by 0.2 m"
        );
        let mut packing = pair(0.0);
        packing.discs[0].y = f64::NAN;
        assert!(matches!(packing.checked(Metres(1e-6)), Err(PackingError::Outside { number: 1, .. })));
        let mut packing = pair(0.0);
        packing.discs.clear();
        assert!(packing.checked(Metres(1e-6)).unwrap_err().to_string().starts_with("the packing holds no stones"));
    }
}
