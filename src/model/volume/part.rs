//! One surface of a body that has no closed form: a plane, or the mantle of a cone.

use crate::geometry::half_space_share;

/// A box of space, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Region {
    pub low: [f64; 3],
    pub high: [f64; 3],
}

impl Region {
    pub fn size(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.high[axis] - self.low[axis])
    }

    pub fn middle(&self) -> [f64; 3] {
        std::array::from_fn(|axis| 0.5 * (self.low[axis] + self.high[axis]))
    }

    pub fn volume(&self) -> f64 {
        self.size().iter().product()
    }

    /// The two sides of a plane across an axis.
    pub fn cut(&self, axis: usize, at: f64) -> [Self; 2] {
        let (mut before, mut behind) = (*self, *self);
        before.high[axis] = at;
        behind.low[axis] = at;
        [before, behind]
    }

    /// The eight parts around the middle.
    pub fn eighths(&self) -> [Self; 8] {
        let middle = self.middle();
        std::array::from_fn(|eighth| {
            let mut part = *self;
            for (axis, &at) in middle.iter().enumerate() {
                let side = if eighth >> axis & 1 == 0 { &mut part.high } else { &mut part.low };
                side[axis] = at;
            }
            part
        })
    }
}

/// What lies on the inner side of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Part {
    /// `normal · x < offset`, the normal of length 1.
    HalfSpace { normal: [f64; 3], offset: f64 },
    /// Nearer to an axis than a radius that grows along it; `axis` of length 1.
    Mantle { start: [f64; 3], axis: [f64; 3], radius: f64, growth: f64 },
    /// On the inner side of either of two planes: a wedge of more than half a turn.
    Either([([f64; 3], f64); 2]),
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Half the extent of a box along a direction.
fn reach(direction: [f64; 3], size: [f64; 3]) -> f64 {
    0.5 * direction.iter().zip(size).map(|(d, s)| d.abs() * s).sum::<f64>()
}

impl Part {
    /// Whether a box lies wholly inside (`Some(true)`), wholly outside, or neither.
    pub fn side(&self, region: &Region) -> Option<bool> {
        let (middle, size) = (region.middle(), region.size());
        let plane = |normal, offset| sign(dot(normal, middle) - offset, reach(normal, size));
        match *self {
            Self::HalfSpace { normal, offset } => plane(normal, offset),
            Self::Mantle { .. } => {
                let (value, _, _) = self.mantle(middle);
                sign(value, 0.5 * dot(size, size).sqrt())
            }
            Self::Either([a, b]) => match (plane(a.0, a.1), plane(b.0, b.1)) {
                (Some(true), _) | (_, Some(true)) => Some(true),
                (Some(false), Some(false)) => Some(false),
                _ => None,
            },
        }
    }

    /// Share of a box that lies inside, the surface taken as even but for its mean curvature.
    pub fn share(&self, region: &Region) -> f64 {
        let (middle, size) = (region.middle(), region.size());
        let plane = |normal, offset| half_space_share(dot(normal, middle) - offset, normal, size);
        match *self {
            Self::HalfSpace { normal, offset } => plane(normal, offset),
            Self::Mantle { axis, .. } => {
                let (value, gradient, distance) = self.mantle(middle);
                // The mean of the value over the box: its second derivatives across the axis are those of the distance.
                let round = |a: usize| (1.0 - axis[a].powi(2) - gradient[a].powi(2)).max(0.0) * size[a].powi(2);
                let bulge = (0..3).map(round).sum::<f64>() / 24.0 / distance.max(0.5 * size[0]);
                half_space_share(value + bulge, gradient, size)
            }
            Self::Either([a, b]) => 1.0 - (1.0 - plane(a.0, a.1)) * (1.0 - plane(b.0, b.1)),
        }
    }

    /// The normal of the surface near a point.
    pub fn normal(&self, point: [f64; 3]) -> [f64; 3] {
        match *self {
            Self::HalfSpace { normal, .. } => normal,
            Self::Mantle { .. } => self.mantle(point).1,
            Self::Either([a, b]) => {
                let off = |plane: ([f64; 3], f64)| (dot(plane.0, point) - plane.1).abs();
                if off(a) < off(b) { a.0 } else { b.0 }
            }
        }
    }

    /// Distance from the mantle (below zero inside), its gradient and the distance from the axis.
    fn mantle(&self, point: [f64; 3]) -> (f64, [f64; 3], f64) {
        let Self::Mantle { start, axis, radius, growth } = *self else { return (0.0, [0.0; 3], 0.0) };
        let from: [f64; 3] = std::array::from_fn(|a| point[a] - start[a]);
        let along = dot(from, axis);
        let across: [f64; 3] = std::array::from_fn(|a| from[a] - along * axis[a]);
        let distance = dot(across, across).sqrt();
        let slant = 1.0 / growth.hypot(1.0);
        let unit = |a: usize| if distance > 0.0 { across[a] / distance } else { 0.0 };
        let gradient = std::array::from_fn(|a| slant * (unit(a) - growth * axis[a]));
        (slant * (distance - radius - growth * along), gradient, distance)
    }
}

fn sign(value: f64, reach: f64) -> Option<bool> {
    if value >= reach {
        Some(false)
    } else if value <= -reach {
        Some(true)
    } else {
        None
    }
}
