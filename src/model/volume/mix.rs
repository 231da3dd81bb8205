//! Which materials fill a box, and what share of it each.

use super::body::{Body, NEGLIGIBLE, Side};
use super::part::Region;
use crate::model::MaterialId;

/// How often a box is cut into eighths where bodies overlap or have no closed form.
const DEPTH: usize = 3;

/// The materials in a box with their shares, which add up to 1.
#[derive(Debug, Default)]
pub struct Mixture {
    pub parts: Vec<(MaterialId, f64)>,
}

impl Mixture {
    /// Adds what fills a box of `weight`: `bodies` over `base`, the last painted first.
    pub fn fill(&mut self, region: &Region, bodies: &[&Body<'_>], base: MaterialId, weight: f64) {
        self.fill_to(region, bodies, base, weight, 0);
    }

    /// Adds what fills a box that one body takes a share of.
    pub fn fill_with(&mut self, material: MaterialId, share: f64, base: MaterialId) {
        let share = share.clamp(0.0, 1.0);
        self.add(material, share);
        self.add(base, 1.0 - share);
    }

    fn fill_to(&mut self, region: &Region, bodies: &[&Body<'_>], mut base: MaterialId, weight: f64, depth: usize) {
        let mut cut: Vec<&Body<'_>> = vec![];
        for &body in bodies {
            match body.side(region) {
                Side::Outside => {}
                Side::Cut => cut.push(body),
                Side::Inside(material) => {
                    base = material;
                    break;
                }
            }
        }
        let apart = || cut.iter().enumerate().all(|(n, a)| cut[..n].iter().all(|b| a.is_apart(b)));
        if cut.iter().all(|body| body.is_exact()) && apart() {
            let mut left = 1.0f64;
            for body in cut {
                let share = if depth == 0 { body.share(region) } else { body.share_of_part(region) }.min(left);
                self.add(body.material, weight * share);
                left -= share;
            }
            self.add(base, weight * left);
        } else if let Some((axis, at)) = cut.iter().find_map(|body| body.plane(region)) {
            let whole = region.volume();
            for part in region.cut(axis, at) {
                self.fill_to(&part, &cut, base, weight * part.volume() / whole, depth);
            }
        } else if depth < DEPTH {
            for part in region.eighths() {
                self.fill_to(&part, &cut, base, weight / 8.0, depth + 1);
            }
        } else {
            // In what is left of a box the surfaces are taken to cross each other anyhow.
            let mut left = 1.0;
            for body in cut {
                let share = left * body.share_of_part(region);
                self.add(body.material, weight * share);
                left -= share;
            }
            self.add(base, weight * left);
        }
    }

    fn add(&mut self, material: MaterialId, share: f64) {
        if share <= 0.0 {
            return;
        }
        match self.parts.iter_mut().find(|(known, _)| *known == material) {
            Some((_, sum)) => *sum += share,
            None => self.parts.push((material, share)),
        }
    }

    /// Leaves out what is negligible and rounds the shares to 2⁻²⁴, what single precision holds, so that equal boxes have
    /// equal bits wherever they are; sorted by material. `along` names the material of an axis.
    pub fn settle(&mut self, along: impl Fn(MaterialId) -> MaterialId) {
        const STEPS: f64 = (1u32 << 24) as f64;
        self.parts.retain(|(_, share)| *share > NEGLIGIBLE);
        for (material, share) in &mut self.parts {
            (*material, *share) = (along(*material), (*share * STEPS).round() / STEPS);
        }
        self.parts.sort_unstable_by_key(|(material, _)| *material);
    }
}
