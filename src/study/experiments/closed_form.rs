//! A ball that is thrown onto a plane and comes to rest: closed form (rigid contact).

/// A ball with translational speed and no spin on a plane that rises by `slope` in the direction of its motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThrownBall {
    /// Mass, kg.
    pub mass: f64,
    /// Radius, m.
    pub radius: f64,
    /// Speed, m/s.
    pub speed: f64,
    /// Slope, rad.
    pub slope: f64,
    /// Gravity, m/s².
    pub gravity: f64,
    /// Sliding friction.
    pub friction: f64,
    /// Rolling friction.
    pub rolling_friction: f64,
}

/// What becomes of it.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Course {
    /// When it begins to roll, s.
    pub rolls_at: f64,
    /// Speed at that time, m/s.
    pub rolls_with: f64,
    /// When it stands, s.
    pub stops_at: f64,
    /// How far it has come by then, m.
    pub reach: f64,
    /// Torque of the rolling friction while it moves, N m.
    pub torque: f64,
    /// Torque of the rolling friction at rest, N m; `None` when it rolls back.
    pub torque_at_rest: Option<f64>,
}

impl ThrownBall {
    /// Sliding: `v' = -g (sin b + mu cos b)`, `R w' = 2.5 g cos b (mu - eta)`, until `v = R w`; then rolling:
    /// `v' = -(5/7) g (sin b + eta cos b)`. At rest `m g sin b R` holds it if `eta >= tan b`.
    pub fn course(&self) -> Course {
        let (sin, cos) = self.slope.sin_cos();
        let (g, eta) = (self.gravity, self.rolling_friction);
        let brake = g * (sin + self.friction * cos);
        let spin_up = 2.5 * g * cos * (self.friction - eta);
        let rolls_at = self.speed / (brake + spin_up);
        let rolls_with = self.speed - brake * rolls_at;
        let slow = 5.0 / 7.0 * g * (sin + eta * cos);
        Course {
            rolls_at,
            rolls_with,
            stops_at: rolls_at + rolls_with / slow,
            reach: 0.5 * (self.speed + rolls_with) * rolls_at + rolls_with * rolls_with / (2.0 * slow),
            torque: eta * self.mass * g * cos * self.radius,
            torque_at_rest: (eta >= self.slope.tan()).then_some(self.mass * g * sin * self.radius),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Slip end, speed there, stop, reach and torques of the four cases, as worked out by hand to five digits: a ball of 0.1 m
    /// and 1056 kg/m³ with 1 m/s, mu 0.8, g 9.8.
    #[test]
    fn the_four_cases() {
        let ball = |degrees: f64, rolling_friction| ThrownBall {
            mass: 4.0 / 3.0 * std::f64::consts::PI * 1e-3 * 1056.0,
            radius: 0.1,
            speed: 1.0,
            slope: degrees.to_radians(),
            gravity: 9.8,
            friction: 0.8,
            rolling_friction,
        };
        for (degrees, eta, wanted, at_rest) in [
            (0.0, 0.2, [0.04437, 0.65217, 0.51020, 0.18855, 0.86698], Some(0.0)),
            (10.0, 0.1, [0.03801, 0.64189, 0.37497, 0.13935, 0.42690], None),
            (10.0, 0.2, [0.04184, 0.60574, 0.27533, 0.10431, 0.85381], Some(0.75275)),
            (10.0, 0.4, [0.05243, 0.50599, 0.17979, 0.07170, 1.70762], Some(0.75275)),
        ] {
            let found = ball(degrees, eta).course();
            let numbers = [found.rolls_at, found.rolls_with, found.stops_at, found.reach, found.torque];
            for (found, wanted) in numbers.iter().zip(wanted) {
                assert!((found - wanted).abs() < 6e-6, "{degrees} {eta}: {numbers:?}");
            }
            assert_eq!(found.torque_at_rest.is_some(), at_rest.is_some());
            assert!((found.torque_at_rest.unwrap_or(0.0) - at_rest.unwrap_or(0.0)).abs() < 6e-6);
        }
    }
}
