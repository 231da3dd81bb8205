//! Materials as the solver sees them.

/// Index into [`Model::materials`](super::Model::materials).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MaterialId(pub u16);

impl MaterialId {
    /// The perfect electric conductor, always the first material of a model.
    pub const PEC: Self = Self(0);
    /// Free space, always the second material of a model.
    pub const FREE_SPACE: Self = Self(1);

    /// The position in the list of materials.
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// One Debye relaxation: `eps(w) = ... + delta_eps / (1 + i w tau)`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct DebyePole {
    /// Change of relative permittivity from static to far above the relaxation.
    pub delta_eps: f64,
    /// Relaxation time, s.
    pub tau: f64,
}

/// A material: `#material` and its `#add_dispersion_debye` lines.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Identifier, as in the input file.
    pub id: String,
    /// Relative permittivity (at infinite frequency where there are poles).
    pub eps_r: f64,
    /// Electric conductivity, S/m. Infinite for the perfect electric conductor.
    pub sigma: f64,
    /// Relative permeability.
    pub mu_r: f64,
    /// Magnetic loss, ohm/m.
    pub sigma_magnetic: f64,
    /// Debye relaxations; empty for a material without dispersion.
    pub poles: Vec<DebyePole>,
    /// Whether edges between this and another material may take the mean of both. False for a perfect conductor, for
    /// dispersive materials, and for those that a material database marks so.
    pub averagable: bool,
}

impl Material {
    /// The perfect electric conductor.
    pub fn pec() -> Self {
        Self {
            id: "pec".into(),
            eps_r: 1.0,
            sigma: f64::INFINITY,
            mu_r: 1.0,
            sigma_magnetic: 0.0,
            poles: vec![],
            averagable: false,
        }
    }

    /// Free space.
    pub fn free_space() -> Self {
        Self::dielectric("free_space", 1.0, 0.0)
    }

    /// A non-magnetic material without dispersion.
    pub fn dielectric(id: impl Into<String>, eps_r: f64, sigma: f64) -> Self {
        Self { id: id.into(), eps_r, sigma, mu_r: 1.0, sigma_magnetic: 0.0, poles: vec![], averagable: true }
    }

    /// Whether this is a perfect electric conductor.
    pub fn is_pec(&self) -> bool {
        self.sigma.is_infinite()
    }

    /// Whether the permittivity changes with frequency.
    pub fn is_dispersive(&self) -> bool {
        !self.poles.is_empty()
    }

    /// Whether the material acts on the magnetic field.
    pub fn is_magnetic(&self) -> bool {
        self.mu_r != 1.0 || self.sigma_magnetic != 0.0
    }

    /// Relative permittivity (real part, without conduction) at a frequency in Hz.
    pub fn eps_r_at(&self, frequency: f64) -> f64 {
        let omega = 2.0 * std::f64::consts::PI * frequency;
        self.eps_r + self.poles.iter().map(|pole| pole.delta_eps / (1.0 + (omega * pole.tau).powi(2))).sum::<f64>()
    }
}
