//! A sphere in space: the stone of a 3-D packing.

use std::f64::consts::PI;

/// A sphere; all in metres, z upwards.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Centre: x and y horizontal, z vertical.
    pub centre: [f64; 3],
    /// Radius.
    pub radius: f64,
}

impl Sphere {
    /// Volume, m³.
    pub fn volume(&self) -> f64 {
        4.0 * PI / 3.0 * self.radius.powi(3)
    }

    /// Distance between the surfaces; negative when the spheres overlap.
    pub fn gap(&self, other: &Self) -> f64 {
        let [dx, dy, dz]: [f64; 3] = std::array::from_fn(|axis| self.centre[axis] - other.centre[axis]);
        (dx * dx + dy * dy + dz * dz).sqrt() - self.radius - other.radius
    }

    /// Volume between two heights, m³: a spherical segment, in closed form.
    pub fn volume_between(&self, bottom: f64, top: f64) -> f64 {
        // Below the height t (in radii, from the centre) lies pi r^3 (2/3 + t - t^3/3).
        let below = |height: f64| {
            let t = ((height - self.centre[2]) / self.radius).clamp(-1.0, 1.0);
            t - t * t * t / 3.0
        };
        PI * self.radius.powi(3) * (below(top) - below(bottom)).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_measures_of_a_sphere() {
        let sphere = Sphere { centre: [0.1, 0.2, 0.3], radius: 0.05 };
        assert!((sphere.volume() - 5.235987755982989e-4).abs() < 1e-18);
        let other = Sphere { centre: [0.1, 0.5, 0.7], radius: 0.1 };
        assert!((sphere.gap(&other) - 0.35).abs() < 1e-15);
        assert!((other.gap(&sphere) - 0.35).abs() < 1e-15);
    }

    /// The whole, half, and a cap of height h: pi h² (3 r - h)/3.
    #[test]
    fn a_segment_is_the_difference_of_two_caps() {
        let sphere = Sphere { centre: [0.0, 0.0, 1.0], radius: 0.5 };
        assert!((sphere.volume_between(0.0, 2.0) / sphere.volume() - 1.0).abs() < 1e-14);
        assert!((sphere.volume_between(1.0, 2.0) / sphere.volume() - 0.5).abs() < 1e-14);
        let cap = PI * 0.2_f64.powi(2) * (1.5 - 0.2) / 3.0;
        assert!((sphere.volume_between(0.4, 0.7) - cap).abs() < 1e-15);
        assert_eq!(sphere.volume_between(1.6, 1.8), 0.0);
    }
}
