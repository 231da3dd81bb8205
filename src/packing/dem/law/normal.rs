//! The normal force of Hertz with viscous damping.

use super::table::Law;

/// The normal part of a contact.
#[derive(Debug, Clone, Copy)]
pub struct Normal {
    /// Elastic and viscous force, never pulling, N.
    pub force: f64,
    /// Tangential stiffness at this overlap, N/m.
    pub tangential_stiffness: f64,
    /// Coefficient of tangential damping, N s/m.
    pub tangential_damping: f64,
}

/// Gives the normal force: `Fn = max(0, 2/3 kn δ + cn v)`, with `kn = 2 E* √(R* δ)`, `cn = 2 g √(m* kn)` and `v` the speed
/// of approach; and of the tangential law `kt = 8 G* √(R* δ)`, `ct = 2 g √(m* kt)`.
///
/// Without branches, so that it can be applied to many contacts at a time.
#[inline(always)]
pub fn normal(law: &Law, radius: f64, mass: f64, overlap: f64, approach: f64) -> Normal {
    let root = (radius * overlap).sqrt();
    let stiffness = law.normal_stiffness * root;
    let damping = law.damping * (mass * stiffness).sqrt();
    let force = 2.0 / 3.0 * stiffness * overlap + damping * approach;
    Normal {
        force: if force > 0.0 { force } else { 0.0 },
        tangential_stiffness: law.tangential_stiffness * root,
        tangential_damping: damping * law.damping_ratio,
    }
}
