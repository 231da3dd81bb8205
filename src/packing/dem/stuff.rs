//! What grains and walls are made of.

/// A material, in SI units.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Stuff {
    /// Density of the solid, kg/m³.
    pub density: f64,
    /// Modulus of Young, Pa.
    pub young: f64,
    /// Ratio of Poisson, dimensionless.
    pub poisson: f64,
    /// Coefficient of restitution, dimensionless; clipped to the range of the fit, see
    /// [`damping_share`](super::damping_share).
    pub restitution: f64,
    /// Coefficient of sliding friction, dimensionless.
    pub friction: f64,
    /// Coefficient of rolling friction `η`, dimensionless: the eccentricity of a contact over the radius of the grain. For a
    /// wall, that of grains on it.
    pub rolling_friction: f64,
}

impl Stuff {
    /// The ballast of Irazábal et al. 2017: 2700 kg/m³, 17.7 GPa, 0.18, restitution 0.4, friction 0.6, rolling friction 0.25.
    pub const BALLAST: Self =
        Self { density: 2700.0, young: 17.7e9, poisson: 0.18, restitution: 0.4, friction: 0.6, rolling_friction: 0.25 };

    /// Gives the shear modulus `E/(2 (1 + ν))`, Pa.
    pub fn shear(&self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }
}

/// What two materials do to each other where it does not follow from each: without it the friction is the smaller of the
/// two and the restitution their mean.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Pairing {
    /// The two materials, in either order.
    pub materials: [usize; 2],
    /// Coefficient of sliding friction.
    pub friction: Option<f64>,
    /// Coefficient of restitution.
    pub restitution: Option<f64>,
}
