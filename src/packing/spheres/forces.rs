//! How the contact forces of a bed are spread.

use super::bed::SphereBed;
use crate::units::Share;

/// A bin of the distribution of contact forces.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct ForceBin {
    /// Lower end, over the mean force.
    pub from: f64,
    /// Upper end, over the mean force.
    pub to: f64,
    /// Probability density of the force over the mean force.
    pub density: f64,
}

/// The distribution of the normal forces between stones.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct ForceDistribution {
    /// Number of contacts that carry a force.
    pub contacts: usize,
    /// Mean normal force, N.
    pub mean_newtons: f64,
    /// Largest normal force, N.
    pub largest_newtons: f64,
    /// Share of the contacts that carry less than the mean.
    pub below_the_mean: Share,
    /// Density in bins of a quarter of the mean force, to six times the mean; what is beyond is left out of the bins.
    pub bins: Vec<ForceBin>,
}

/// Width of a bin, over the mean force.
const BIN: f64 = 0.25;
/// Number of bins.
const BINS: usize = 24;

impl SphereBed {
    /// The distribution of the contact forces; none without contacts that carry one.
    pub fn force_distribution(&self) -> Option<ForceDistribution> {
        let forces: Vec<f64> = self.contacts.iter().map(|contact| contact.normal_force).filter(|f| *f > 0.0).collect();
        if forces.is_empty() {
            return None;
        }
        let mean = forces.iter().sum::<f64>() / forces.len() as f64;
        let mut counts = [0_usize; BINS];
        for force in &forces {
            if let Some(count) = counts.get_mut((force / mean / BIN) as usize) {
                *count += 1;
            }
        }
        let bins = counts.iter().enumerate().map(|(k, count)| ForceBin {
            from: k as f64 * BIN,
            to: (k + 1) as f64 * BIN,
            density: *count as f64 / (forces.len() as f64 * BIN),
        });
        Some(ForceDistribution {
            contacts: forces.len(),
            mean_newtons: mean,
            largest_newtons: forces.iter().copied().fold(0.0, f64::max),
            below_the_mean: Share(forces.iter().filter(|f| **f < mean).count() as f64 / forces.len() as f64),
            bins: bins.collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Sphere;
    use crate::packing::spheres::SphereContact;
    use crate::units::Metres;

    /// Forces 1, 1, 1, 5 N and one of nothing: mean 2, three of four below it, densities 3/4 and 1/4 over bins of 1/4.
    #[test]
    fn the_distribution_of_four_forces() {
        let spheres = vec![Sphere { centre: [0.1; 3], radius: 0.05 }, Sphere { centre: [0.1, 0.1, 0.2], radius: 0.05 }];
        let mut bed = SphereBed::new("file", None, [Metres(0.3); 3], spheres);
        assert!(bed.force_distribution().is_none());
        let contact = |normal_force| SphereContact { first: 0, second: 1, normal_force };
        bed.contacts = [1.0, 1.0, 1.0, 5.0, 0.0].map(contact).to_vec();
        let found = bed.force_distribution().unwrap();
        assert_eq!((found.contacts, found.mean_newtons, found.largest_newtons), (4, 2.0, 5.0));
        assert_eq!(found.below_the_mean, Share(0.75));
        let filled: Vec<_> =
            found.bins.iter().filter(|bin| bin.density > 0.0).map(|b| (b.from, b.to, b.density)).collect();
        assert_eq!(filled, [(0.5, 0.75, 3.0), (2.5, 2.75, 1.0)]);
    }
}
