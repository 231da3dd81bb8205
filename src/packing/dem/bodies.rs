//! The walls while they move.

use super::setup::{Motion, Wall, WallShape};
use super::vector::{add, cross, norm, scale, sub};

/// The quaternion of no turn.
const UNTURNED: [f64; 4] = [1.0, 0.0, 0.0, 0.0];

/// Where a wall is and how it moves.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct BodyState {
    /// How far it has moved, m.
    pub displacement: [f64; 3],
    /// How far it has turned, as a quaternion (real part first).
    pub turned: [f64; 4],
    /// The point of the set-up that it turns about, m.
    pub about: [f64; 3],
    /// Velocity, m/s.
    pub velocity: [f64; 3],
    /// Angular velocity, rad/s.
    pub spin: [f64; 3],
}

/// A wall, its state and how far from the point it turns about it reaches.
#[derive(Debug, Clone)]
pub struct Body {
    /// The wall as set up; its motion may have been changed since.
    pub wall: Wall,
    /// Of length one; only of a plane.
    pub normal: [f64; 3],
    /// Whether it is there at all.
    pub present: bool,
    /// Where it is.
    pub state: BodyState,
    /// Greatest distance of its points from the one it turns about, m.
    pub extent: f64,
}

impl Body {
    /// Takes a checked wall.
    pub fn new(wall: Wall) -> Self {
        let normal = match wall.shape {
            WallShape::Plane { normal, .. } => scale(1.0 / norm(normal), normal),
            WallShape::Mesh(_) => [0.0; 3],
        };
        let state =
            BodyState { displacement: [0.0; 3], turned: UNTURNED, about: [0.0; 3], velocity: [0.0; 3], spin: [0.0; 3] };
        let mut made = Self { wall, normal, present: true, state, extent: 0.0 };
        made.set_motion(made.wall.motion, 0.0);
        made
    }

    /// Changes the motion at a time.
    pub fn set_motion(&mut self, motion: Motion, time: f64) {
        self.wall.motion = motion;
        if let Motion::Prescribed { about, .. } = motion {
            // A point that moved along with the wall: bring it back to the set-up.
            self.turn_about(self.to_body(about));
        }
        if let Motion::Free { velocity, .. } = motion {
            self.state.velocity = velocity;
            self.state.spin = [0.0; 3];
        }
        self.settle_velocity(time);
    }

    /// Lets it turn about another of its points, without moving it.
    fn turn_about(&mut self, about: [f64; 3]) {
        let at = self.to_space(about);
        self.state.about = about;
        self.state.displacement = sub(at, about);
        if let WallShape::Mesh(mesh) = &self.wall.shape {
            self.extent = mesh.points().iter().map(|&point| norm(sub(point, about))).fold(0.0, f64::max);
        }
    }

    /// Whether it may move.
    pub fn moves(&self) -> bool {
        self.present && self.wall.motion != Motion::Fixed
    }

    /// The greatest speed of its points, m/s.
    pub fn speed(&self) -> f64 {
        norm(self.state.velocity) + norm(self.state.spin) * self.extent
    }

    /// A place in space as a place of the set-up.
    pub fn to_body(&self, place: [f64; 3]) -> [f64; 3] {
        let from = sub(sub(place, self.state.displacement), self.state.about);
        let untwisted = if self.state.turned == UNTURNED { from } else { turn(conjugate(self.state.turned), from) };
        add(self.state.about, untwisted)
    }

    /// A place of the set-up as a place in space.
    pub fn to_space(&self, place: [f64; 3]) -> [f64; 3] {
        add(add(self.state.about, self.state.displacement), self.direction(sub(place, self.state.about)))
    }

    /// A direction of the set-up as a direction in space.
    pub fn direction(&self, direction: [f64; 3]) -> [f64; 3] {
        if self.state.turned == UNTURNED { direction } else { turn(self.state.turned, direction) }
    }

    /// The velocity of a point in space that moves with the wall, m/s.
    pub fn velocity_at(&self, place: [f64; 3]) -> [f64; 3] {
        let lever = sub(sub(place, self.state.displacement), self.state.about);
        add(self.state.velocity, cross(self.state.spin, lever))
    }

    fn settle_velocity(&mut self, time: f64) {
        match self.wall.motion {
            Motion::Fixed => (self.state.velocity, self.state.spin) = ([0.0; 3], [0.0; 3]),
            Motion::Prescribed { velocity, spin, from, until, .. } => {
                let on = if time >= from && time < until { 1.0 } else { 0.0 };
                (self.state.velocity, self.state.spin) = (scale(on, velocity), scale(on, spin));
            }
            Motion::Free { .. } => {}
        }
    }

    /// Makes one step under the force of the grains (N); `time` is that of its end.
    pub fn advance(&mut self, force: [f64; 3], gravity: [f64; 3], dt: f64, time: f64) {
        if let Motion::Free { mass, moves, velocity, load } = self.wall.motion {
            for k in 0..3 {
                self.state.velocity[k] = if moves[k] {
                    self.state.velocity[k] + dt * ((force[k] + load[k]) / mass + gravity[k])
                } else {
                    velocity[k]
                };
            }
        }
        self.state.displacement = add(self.state.displacement, scale(dt, self.state.velocity));
        let rate = norm(self.state.spin);
        if rate > 0.0 {
            let (sin, cos) = (0.5 * rate * dt).sin_cos();
            let [x, y, z] = scale(sin / rate, self.state.spin);
            let turned = product([cos, x, y, z], self.state.turned);
            let length = turned.iter().map(|v| v * v).sum::<f64>().sqrt();
            self.state.turned = turned.map(|v| v / length);
        }
        self.settle_velocity(time);
    }
}

fn conjugate([w, x, y, z]: [f64; 4]) -> [f64; 4] {
    [w, -x, -y, -z]
}

fn product([a, b, c, d]: [f64; 4], [w, x, y, z]: [f64; 4]) -> [f64; 4] {
    [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    ]
}

fn turn([w, x, y, z]: [f64; 4], v: [f64; 3]) -> [f64; 3] {
    let axis = [x, y, z];
    let t = scale(2.0, cross(axis, v));
    add(add(v, scale(w, t)), cross(axis, t))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter turn in 1000 steps about (1, 0, 0), with a shift: (2, 0, 0) goes to (1, 1, 0) + (0, 0, 3).
    #[test]
    fn a_turning_body_takes_its_points_along() {
        let motion = Motion::Prescribed {
            velocity: [0.0, 0.0, 3.0],
            spin: [0.0, 0.0, std::f64::consts::FRAC_PI_2],
            about: [1.0, 0.0, 0.0],
            from: 0.0,
            until: 1.0,
        };
        let mut body = Body::new(Wall::plane([0.0; 3], [0.0, 0.0, 1.0], 0));
        body.set_motion(motion, 0.0);
        for step in 1..=1500 {
            body.advance([0.0; 3], [0.0; 3], 1e-3, f64::from(step) * 1e-3);
        }
        let at = body.to_space([2.0, 0.0, 0.0]);
        for (at, wanted) in at.into_iter().zip([1.0, 1.0, 3.0]) {
            assert!((at - wanted).abs() < 1e-11, "{at} for {wanted}");
        }
        assert!(norm(sub(body.to_body(at), [2.0, 0.0, 0.0])) < 1e-11);
        assert_eq!(body.speed(), 0.0);
    }

    /// A free body falls by g dt² n (n + 1)/2 along the axis that is free, and is led along another.
    #[test]
    fn a_free_body_falls() {
        let mut body = Body::new(Wall::plane([0.0; 3], [0.0, 0.0, 1.0], 0));
        let motion =
            Motion::Free { mass: 2.0, moves: [false, false, true], velocity: [0.5, 0.0, 0.0], load: [0.0, 9.0, 1.62] };
        body.set_motion(motion, 0.0);
        for step in 1..=100 {
            body.advance([0.0; 3], [0.0, 0.0, -9.81], 1e-3, f64::from(step) * 1e-3);
        }
        assert!((body.state.displacement[2] + 9.0 * 1e-6 * 5050.0).abs() < 1e-12);
        assert!((body.state.displacement[0] - 0.05).abs() < 1e-12 && body.state.displacement[1] == 0.0);
    }
}
