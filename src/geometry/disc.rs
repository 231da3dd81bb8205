//! A disc in the plane: the stone of a 2-D packing.

/// A disc; all in metres, y upwards.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Disc {
    /// Centre, horizontal.
    pub x: f64,
    /// Centre, vertical.
    pub y: f64,
    /// Radius.
    pub radius: f64,
}

impl Disc {
    /// Area, m².
    pub fn area(&self) -> f64 {
        std::f64::consts::PI * self.radius * self.radius
    }

    /// Whether a point lies in the disc (its rim belongs to it).
    pub fn contains(&self, x: f64, y: f64) -> bool {
        let (dx, dy) = (x - self.x, y - self.y);
        dx * dx + dy * dy <= self.radius * self.radius
    }

    /// Distance between the rims; negative when the discs overlap.
    pub fn gap(&self, other: &Self) -> f64 {
        (self.x - other.x).hypot(self.y - other.y) - self.radius - other.radius
    }
}
