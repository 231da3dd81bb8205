//! Resistance to rolling: the bounded model and the two it is compared with.

use crate::packing::dem::vector::{dot, norm, scale, sub};

/// How rolling is resisted.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rolling {
    /// Not at all: no torque of resistance is computed.
    None,
    /// Bounded rolling friction (Irazábal, Salazar & Oñate 2017): once per grain, `Σ min(η_i R_i, η_j R_j) |Fn|` against
    /// `I ω/dt` plus the moment of its contacts, and at most as much as stops it within the step. Eq. 9 of the paper prints
    /// `I ω dt` for `I ω/dt`, opposite signs in that sum, and opposite directions in its two branches.
    #[default]
    Bounded,
    /// Model A of Ai et al. 2011: a constant torque against the relative spin at each contact. It chatters at rest.
    ConstantTorque,
    /// Model C of Ai et al. 2011: a rolling spring with a limit, and a dashpot of this share of critical damping.
    ElasticPlastic {
        /// Share of critical damping.
        damping: f64,
    },
}

/// What the bounded model makes of the torque on a grain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bounded {
    /// The grain goes on turning under this torque, N m.
    Turns([f64; 3]),
    /// The grain stands still at the end of the step.
    Stops,
}

/// Bounds the rolling friction of a grain by the moment that stops it within the step.
///
/// Once per grain, after all its contacts: with `T` the moment of the contact forces, `ω` the spin at the start of the
/// step and `RR = Σ |Fn| e`, `e = min(η_i R_i, η_j R_j)`, the moment to overcome is `T_max = (I/dt) ω + T`. If
/// `|T_max| > RR` the friction is `-RR T_max/|T_max|`, else it is `-T_max`, which leaves the grain at rest exactly.
///
/// Departs from the print of Irazábal et al. 2017, eq. 9, which is wrong in three places: `ω I dt` has the dimension of
/// no torque and must be `ω I / dt`; the two terms of `T_max` must carry the same sign; and its two branches point in
/// opposite directions. The inequality is right if `|T_r|` is read as the unbounded magnitude `e |Fn|`. The result
/// depends on no other grain's spin, so it is the same in every frame that does not turn, but the friction of the two
/// sides of a contact do not cancel: pairs do not keep their angular momentum.
#[inline(always)]
pub fn bounded(inertia_over_dt: f64, spin: [f64; 3], contact_torque: [f64; 3], most: f64) -> Bounded {
    let stopping = [0, 1, 2].map(|k| inertia_over_dt * spin[k] + contact_torque[k]);
    let square = dot(stopping, stopping);
    if square > most * most {
        let share = most / square.sqrt();
        Bounded::Turns([0, 1, 2].map(|k| contact_torque[k] - share * stopping[k]))
    } else {
        Bounded::Stops
    }
}

/// Gives the constant torque of model A on the first of two bodies: `-η R_r |Fn| ω_rel/|ω_rel|` (Irazábal et al. 2017,
/// eq. 7), nothing where they do not turn against each other.
pub fn constant_torque(most: f64, relative_spin: [f64; 3]) -> [f64; 3] {
    let spin = norm(relative_spin);
    if spin > 0.0 { scale(-most / spin, relative_spin) } else { [0.0; 3] }
}

/// What the rolling spring of model C needs to know of a contact.
#[derive(Debug, Clone, Copy)]
pub struct RollingSpring {
    /// The rolling friction, dimensionless.
    pub friction: f64,
    /// Effective radius of rolling `R_i R_j/(R_i + R_j)`, m.
    pub radius: f64,
    /// Normal stiffness, N/m.
    pub normal_stiffness: f64,
    /// Normal force, N.
    pub normal_force: f64,
    /// `1/(1/(I_i + m_i R_i²) + 1/(I_j + m_j R_j²))`, kg m².
    pub inertia: f64,
    /// Share of critical damping.
    pub damping: f64,
}

/// Gives the elastic part (kept for the next step) and the whole torque of model C on the first of two bodies.
///
/// Ai et al. 2011: `k_r = 2.25 k_n η² R_r²`, spring at most `η R_r |Fn|`, dashpot `2 δ √(I_r k_r)` while the spring is
/// below its limit and none at the limit. The part about the normal (drilling) is left out.
pub fn elastic_plastic(
    spring: &RollingSpring,
    old: [f64; 3],
    normal: [f64; 3],
    relative_spin: [f64; 3],
    dt: f64,
) -> ([f64; 3], [f64; 3]) {
    let across = |v: [f64; 3]| sub(v, scale(dot(v, normal), normal));
    let rate = across(relative_spin);
    let stiffness = 2.25 * spring.normal_stiffness * (spring.friction * spring.radius).powi(2);
    let most = spring.friction * spring.radius * spring.normal_force;
    let elastic = sub(across(old), scale(stiffness * dt, rate));
    let size = norm(elastic);
    if size > most {
        let elastic = scale(most / size, elastic);
        return (elastic, elastic);
    }
    let damping = 2.0 * spring.damping * (spring.inertia * stiffness).sqrt();
    (elastic, sub(elastic, scale(damping, rate)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_weak_friction_acts_against_what_turns_the_grain() {
        assert_eq!(bounded(2.0, [0.0, 3.0, 0.0], [0.0, 4.0, 0.0], 1.0), Bounded::Turns([0.0, 3.0, 0.0]));
        assert_eq!(bounded(2.0, [0.0, -3.0, 0.0], [0.0, 4.0, 0.0], 1.0), Bounded::Turns([0.0, 5.0, 0.0]));
    }

    #[test]
    fn a_strong_friction_stops_the_grain() {
        assert_eq!(bounded(2.0, [0.0, 3.0, 0.0], [0.0, 4.0, 0.0], 10.0), Bounded::Stops);
        assert_eq!(bounded(2.0, [0.0; 3], [0.0; 3], 0.0), Bounded::Stops);
    }

    #[test]
    fn a_constant_torque_opposes_the_spin() {
        assert_eq!(constant_torque(2.0, [0.0, 0.5, 0.0]), [0.0, -2.0, 0.0]);
        assert_eq!(constant_torque(2.0, [0.0; 3]), [0.0; 3]);
    }

    /// `k_r = 2.25 · 100 · (0.2 · 0.5)² = 2.25`; the limit `0.2 · 0.5 · 10 = 1`.
    #[test]
    fn a_rolling_spring_grows_to_its_limit() {
        let spring = RollingSpring {
            friction: 0.2,
            radius: 0.5,
            normal_stiffness: 100.0,
            normal_force: 10.0,
            inertia: 1.0,
            damping: 0.0,
        };
        let up = [0.0, 0.0, 1.0];
        let (elastic, torque) = elastic_plastic(&spring, [0.0; 3], up, [0.0, 0.2, 7.0], 0.1);
        assert!((elastic[1] + 0.045).abs() < 1e-15 && elastic == torque && elastic[2] == 0.0);
        let (elastic, _) = elastic_plastic(&spring, [0.0, -0.99, 0.0], up, [0.0, 0.2, 0.0], 0.1);
        assert!((elastic[1] + 1.0).abs() < 1e-15);
    }
}
