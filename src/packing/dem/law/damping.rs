//! How much of the critical damping gives a coefficient of restitution.

/// Restitution below which the fit is not used.
pub const LEAST_RESTITUTION: f64 = 0.001;
/// Restitution from which on a contact counts as undamped.
pub const UNDAMPED_RESTITUTION: f64 = 0.999;

/// Coefficients of the fit, lowest power of the restitution first.
const FIT: [f64; 10] =
    [-6.918798, -16.41105, 146.8049, -796.4559, 2928.711, -7206.864, 11494.29, -11342.18, 6276.757, -1489.915];

/// Gives the share of critical damping `g` of a Hertzian contact whose impacts have the coefficient of restitution `e`.
///
/// Fit of Thornton, Cummins & Cleary 2013: `a = e (h1 + e (h2 + … + e h10))`, `g = sqrt(1 / (1 - (1 + e)² exp(a)) - 1)`.
/// `e` is raised to [`LEAST_RESTITUTION`]; from [`UNDAMPED_RESTITUTION`] on the contact is undamped.
///
/// ```
/// use ballast_gpr::packing::dem::damping_share;
/// assert!((damping_share(0.4) - 0.323759).abs() < 1e-6);
/// assert!((damping_share(0.2) - 0.666814).abs() < 1e-6);
/// assert_eq!(damping_share(1.0), 0.0);
/// ```
pub fn damping_share(restitution: f64) -> f64 {
    if restitution >= UNDAMPED_RESTITUTION {
        return 0.0;
    }
    let e = restitution.max(LEAST_RESTITUTION);
    let a = FIT.iter().rev().fold(0.0, |sum, h| (sum + h) * e);
    (1.0 / (1.0 - (1.0 + e).powi(2) * a.exp()) - 1.0).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Integrates `m x'' = -Fn` through one impact and gives the speed after it over that before it.
    fn rebound(g: f64) -> f64 {
        let (mut x, mut v, dt) = (0.0_f64, 1.0_f64, 1e-6);
        loop {
            v -= dt * ((x.powf(1.5) * 1e4) + 2.0 * g * (1.5e4 * x.sqrt()).sqrt() * v).max(0.0);
            x += dt * v;
            if x <= 0.0 {
                return -v;
            }
        }
    }

    /// The fit is good to a few parts in a thousand over the whole range.
    #[test]
    fn an_impact_gives_back_the_restitution() {
        for e in [0.1, 0.2, 0.4, 0.6, 0.8, 0.95] {
            let back = rebound(damping_share(e));
            assert!((back - e).abs() < 4e-3, "{back} for {e}");
        }
    }

    #[test]
    fn the_ends_are_clipped() {
        assert_eq!(damping_share(0.0), damping_share(LEAST_RESTITUTION));
        assert!(damping_share(0.0).is_finite());
        assert_eq!(damping_share(0.9995), 0.0);
    }
}
