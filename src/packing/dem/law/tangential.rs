//! The tangential force of Mindlin as increments, with viscous damping and the limit of Coulomb.

/// The tangential part of a contact.
#[derive(Debug, Clone, Copy)]
pub struct Tangential {
    /// What is kept for the next step: the elastic force, N.
    pub elastic: [f64; 3],
    /// Elastic and viscous force, N.
    pub force: [f64; 3],
}

/// What a contact remembers of the step before.
#[derive(Debug, Clone, Copy)]
pub struct Before {
    /// The elastic tangential force, N.
    pub elastic: [f64; 3],
    /// The overlap, m.
    pub overlap: f64,
}

#[inline(always)]
fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Gives the tangential force at a contact of normal `n` and tangential velocity `velocity`, which is at most `limit`.
///
/// The old elastic force is laid into the new tangent plane with its magnitude kept (to second order in the turn of a
/// step), scaled by `√(δ/δ_old)` on unloading, and grown by `-kt v dt`; the viscous force is `-ct v`. Where their sum
/// exceeds the limit: if both point the same way, the elastic part is scaled to the limit and the viscous one dropped, or
/// the viscous one shrunk to what the elastic one leaves; if they oppose each other, the larger of the two is scaled, the
/// viscous one to the limit plus the elastic one.
///
/// Without branches, so that it can be applied to many contacts at a time.
#[inline(always)]
pub fn tangential(
    before: Before,
    n: [f64; 3],
    velocity: [f64; 3],
    overlap: f64,
    [stiffness_times_dt, damping]: [f64; 2],
    limit: f64,
) -> Tangential {
    let old = before.elastic;
    let along = dot(old, n);
    let square = dot(old, old);
    let turned = 1.0 + 0.5 * (along * along) / (square + f64::MIN_POSITIVE);
    let unloaded = (overlap / (before.overlap + f64::MIN_POSITIVE)).sqrt();
    let keep = turned * if overlap < before.overlap { unloaded } else { 1.0 };
    let mut elastic = [0, 1, 2].map(|k| keep * (old[k] - along * n[k]) - stiffness_times_dt * velocity[k]);
    let mut viscous = velocity.map(|v| -damping * v);

    let (ee, cc, ec) = (dot(elastic, elastic), dot(viscous, viscous), dot(elastic, viscous));
    let exceeded = ee + cc + 2.0 * ec > limit * limit;
    let (e, c) = (ee.sqrt(), cc.sqrt());
    let same_way = ec >= 0.0;
    let cut_elastic = if same_way { e > limit } else { c < e };
    let wanted_viscous = if same_way { limit - e } else { limit + e };
    let elastic_scale = limit / (e + f64::MIN_POSITIVE);
    let viscous_scale = wanted_viscous / (c + f64::MIN_POSITIVE);
    let by_elastic = if exceeded & cut_elastic { elastic_scale } else { 1.0 };
    let by_viscous = if exceeded { if cut_elastic { 0.0 } else { viscous_scale } } else { 1.0 };
    for k in 0..3 {
        elastic[k] *= by_elastic;
        viscous[k] *= by_viscous;
    }
    Tangential { elastic, force: [0, 1, 2].map(|k| elastic[k] + viscous[k]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UP: [f64; 3] = [0.0, 0.0, 1.0];

    fn go(old: [f64; 3], velocity: [f64; 3], k: f64, c: f64, limit: f64) -> Tangential {
        tangential(Before { elastic: old, overlap: 1.0 }, UP, velocity, 1.0, [k, c], limit)
    }

    #[test]
    fn sticking_adds_spring_and_dashpot() {
        let t = go([1.0, 0.0, 0.0], [0.0, 2.0, 0.0], 0.5, 0.25, 100.0);
        assert_eq!(t.elastic, [1.0, -1.0, 0.0]);
        assert_eq!(t.force, [1.0, -1.5, 0.0]);
    }

    /// Spring beyond the limit and dashpot the same way: the spring is cut, the dashpot dropped.
    #[test]
    fn sliding_cuts_the_spring() {
        let t = go([-5.0, 0.0, 0.0], [1.0, 0.0, 0.0], 0.5, 0.25, 3.0);
        assert_eq!((t.elastic, t.force), ([-3.0, 0.0, 0.0], [-3.0, 0.0, 0.0]));
    }

    /// Spring within, sum beyond: the dashpot has what is left.
    #[test]
    fn sliding_shrinks_the_dashpot() {
        let t = go([-1.5, 0.0, 0.0], [1.0, 0.0, 0.0], 0.5, 4.0, 3.0);
        assert_eq!((t.elastic, t.force), ([-2.0, 0.0, 0.0], [-3.0, 0.0, 0.0]));
    }

    /// Opposed: a larger dashpot is cut to the limit plus the spring, a larger spring to the limit.
    #[test]
    fn opposed_parts_are_cut_by_the_larger() {
        let t = go([2.5, 0.0, 0.0], [1.0, 0.0, 0.0], 0.5, 9.0, 3.0);
        assert_eq!((t.elastic, t.force), ([2.0, 0.0, 0.0], [-3.0, 0.0, 0.0]));
        let t = go([9.5, 0.0, 0.0], [1.0, 0.0, 0.0], 0.5, 2.0, 3.0);
        assert_eq!((t.elastic, t.force), ([3.0, 0.0, 0.0], [3.0, 0.0, 0.0]));
    }

    /// Turned by 1e-3 rad in the plane of the force, the magnitude stays to 1e-6 · 1e-6 and the force is tangential.
    #[test]
    fn turning_keeps_the_magnitude() {
        let (s, c) = 1e-3_f64.sin_cos();
        let n = [s, 0.0, c];
        let t = tangential(Before { elastic: [2.0, 0.0, 0.0], overlap: 1.0 }, n, [0.0; 3], 1.0, [1.0; 2], 9.0);
        assert!((dot(t.force, t.force).sqrt() / 2.0 - 1.0).abs() < 1e-11);
        assert!(dot(t.force, n).abs() < 1e-15);
    }

    /// Unloading to a quarter of the overlap halves the spring.
    #[test]
    fn unloading_shrinks_the_spring() {
        let t = tangential(Before { elastic: [2.0, 0.0, 0.0], overlap: 4.0 }, UP, [0.0; 3], 1.0, [1.0; 2], 9.0);
        assert_eq!(t.elastic, [1.0, 0.0, 0.0]);
    }
}
