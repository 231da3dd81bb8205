//! What two materials do to each other, computed once.

use super::damping::damping_share;
use crate::packing::dem::stuff::{Pairing, Stuff};

/// The numbers of a pair of materials.
#[derive(Debug, Clone, Copy, Default)]
pub struct Law {
    /// `2 E*`: the normal stiffness over `√(R* δ)`, Pa.
    pub normal_stiffness: f64,
    /// `8 G*`: the tangential stiffness over `√(R* δ)`, Pa.
    pub tangential_stiffness: f64,
    /// `2 g`: the coefficient of damping over `√(m* k)`.
    pub damping: f64,
    /// `√(kt/kn)`.
    pub damping_ratio: f64,
    /// Coefficient of sliding friction.
    pub friction: f64,
    /// Share of the overlap that shortens the lever of the first: `E_j/(E_i + E_j)`.
    pub lever_share: f64,
}

/// The laws of all pairs of materials.
#[derive(Debug, Clone, Default)]
pub struct Laws {
    count: usize,
    laws: Vec<Law>,
    /// Whether all materials are equally stiff, so that every lever is shortened by half the overlap.
    pub equal_levers: bool,
}

impl Laws {
    /// Computes the table. Where no pairing says otherwise the friction is the smaller of the two and the restitution
    /// their mean.
    pub fn new(stuffs: &[Stuff], pairings: &[Pairing]) -> Self {
        let mut laws = Vec::with_capacity(stuffs.len() * stuffs.len());
        for (i, a) in stuffs.iter().enumerate() {
            for (j, b) in stuffs.iter().enumerate() {
                let named = pairings.iter().find(|p| p.materials == [i, j] || p.materials == [j, i]);
                let friction = named.and_then(|p| p.friction).unwrap_or(a.friction.min(b.friction));
                let restitution = named.and_then(|p| p.restitution).unwrap_or(0.5 * (a.restitution + b.restitution));
                laws.push(law(a, b, friction, restitution));
            }
        }
        let equal_levers = stuffs.windows(2).all(|two| two[0].young == two[1].young);
        Self { count: stuffs.len(), laws, equal_levers }
    }

    /// Whether any pair has friction.
    pub fn any_friction(&self) -> bool {
        self.laws.iter().any(|law| law.friction > 0.0)
    }

    /// Gives the law of two materials.
    #[inline(always)]
    pub fn of(&self, first: u16, second: u16) -> &Law {
        &self.laws[first as usize * self.count + second as usize]
    }
}

fn law(a: &Stuff, b: &Stuff, friction: f64, restitution: f64) -> Law {
    let e_star = effective_young(a, b);
    let g_star = 1.0 / ((2.0 - a.poisson) / a.shear() + (2.0 - b.poisson) / b.shear());
    Law {
        normal_stiffness: 2.0 * e_star,
        tangential_stiffness: 8.0 * g_star,
        damping: 2.0 * damping_share(restitution),
        damping_ratio: (4.0 * g_star / e_star).sqrt(),
        friction,
        lever_share: b.young / (a.young + b.young),
    }
}

/// Gives `E* = E1 E2/(E2 (1 - ν1²) + E1 (1 - ν2²))`, Pa.
pub fn effective_young(a: &Stuff, b: &Stuff) -> f64 {
    a.young * b.young / (b.young * (1.0 - a.poisson.powi(2)) + a.young * (1.0 - b.poisson.powi(2)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Equal materials: `E* = E/(2 (1 - ν²))`, `G* = G/(2 (2 - ν))`, and `kt/kn = 2 (1 - ν)/(2 - ν)` (Mindlin).
    #[test]
    fn equal_materials_have_the_stiffness_of_mindlin() {
        let stuff = Stuff { young: 4e7, poisson: 0.49, ..Stuff::BALLAST };
        let laws = Laws::new(&[stuff], &[]);
        let law = laws.of(0, 0);
        assert!((law.normal_stiffness / (4e7 / (1.0 - 0.49_f64.powi(2))) - 1.0).abs() < 1e-14);
        let ratio = law.tangential_stiffness / law.normal_stiffness;
        assert!((ratio / (2.0 * 0.51 / 1.51) - 1.0).abs() < 1e-14);
        assert!((law.damping_ratio.powi(2) / ratio - 1.0).abs() < 1e-14);
        assert_eq!(law.lever_share, 0.5);
    }

    #[test]
    fn a_pairing_overrides_the_smaller_friction() {
        let smooth = Stuff { friction: 0.1, ..Stuff::BALLAST };
        let pairing = Pairing { materials: [1, 0], friction: Some(0.5), restitution: None };
        assert_eq!(Laws::new(&[Stuff::BALLAST, smooth], &[]).of(0, 1).friction, 0.1);
        let laws = Laws::new(&[Stuff::BALLAST, smooth], &[pairing]);
        assert_eq!((laws.of(0, 1).friction, laws.of(1, 0).friction, laws.of(0, 0).friction), (0.5, 0.5, 0.6));
    }
}
