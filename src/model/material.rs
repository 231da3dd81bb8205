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

/// A pole that is no relaxation.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Resonance {
    /// `#add_dispersion_lorentz`: `delta_eps w0² / (w0² + 2 i w delta - w²)`, `w0 = 2 pi frequency`.
    Lorentz {
        /// Change of relative permittivity from static to far above the resonance.
        delta_eps: f64,
        /// Frequency of the resonance, Hz.
        frequency: f64,
        /// Damping, 1/s; below `2 pi frequency`.
        damping: f64,
    },
    /// `#add_dispersion_drude`: `- wp² / (w² - i w collisions)`, `wp = 2 pi frequency`.
    Drude {
        /// Plasma frequency, Hz.
        frequency: f64,
        /// Collisions, 1/s.
        collisions: f64,
    },
}

impl Resonance {
    /// Whether it does nothing.
    pub fn is_absent(&self) -> bool {
        match *self {
            Self::Lorentz { delta_eps, .. } => delta_eps == 0.0,
            Self::Drude { frequency, .. } => frequency == 0.0,
        }
    }

    /// What it adds to the relative permittivity at an angular frequency, 1/s: real part and loss `-Im`.
    pub fn eps_r_at(&self, omega: f64) -> (f64, f64) {
        let over = |strength: f64, re: f64, im: f64| {
            let norm = re * re + im * im;
            (strength * re / norm, strength * im / norm)
        };
        match *self {
            Self::Lorentz { delta_eps, frequency, damping } => {
                let resonant = (2.0 * std::f64::consts::PI * frequency).powi(2);
                over(delta_eps * resonant, resonant - omega * omega, 2.0 * omega * damping)
            }
            Self::Drude { frequency, collisions } => {
                let plasma = (2.0 * std::f64::consts::PI * frequency).powi(2);
                over(plasma, -omega * omega, omega * collisions)
            }
        }
    }
}

/// A material: `#material` and the `#add_dispersion_...` line that names it.
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
    /// Lorentz and Drude poles; empty for a material without.
    pub resonances: Vec<Resonance>,
    /// Whether edges between this and another material may take the mean of both. False for a perfect conductor, for
    /// dispersive materials, and for those that a material database marks so.
    pub averagable: bool,
    /// The materials along x, y and z of a direction-dependent material, of which the fields above are the mean: an edge or face takes the one of
    /// its own axis.
    pub directional: Option<[MaterialId; 3]>,
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
            resonances: vec![],
            averagable: false,
            directional: None,
        }
    }

    /// Free space.
    pub fn free_space() -> Self {
        Self::dielectric("free_space", 1.0, 0.0)
    }

    /// A non-magnetic material without dispersion.
    pub fn dielectric(id: impl Into<String>, eps_r: f64, sigma: f64) -> Self {
        Self {
            id: id.into(),
            eps_r,
            sigma,
            mu_r: 1.0,
            sigma_magnetic: 0.0,
            poles: vec![],
            resonances: vec![],
            averagable: true,
            directional: None,
        }
    }

    /// The material of edges along an axis, and of faces across it; `own` is its own place in the list of materials.
    pub fn along(&self, axis: usize, own: MaterialId) -> MaterialId {
        self.directional.map_or(own, |materials| materials[axis])
    }

    /// Whether this is a perfect electric conductor.
    pub fn is_pec(&self) -> bool {
        self.sigma.is_infinite()
    }

    /// Whether the permittivity changes with frequency.
    pub fn is_dispersive(&self) -> bool {
        !self.poles.is_empty() || !self.resonances.is_empty()
    }

    /// Whether the material acts on the magnetic field.
    pub fn is_magnetic(&self) -> bool {
        self.mu_r != 1.0 || self.sigma_magnetic != 0.0
    }

    /// How many Debye and Drude poles act, and how many Lorentz poles.
    pub fn pole_counts(&self) -> (usize, usize) {
        let lorentz = |resonance: &&Resonance| matches!(resonance, Resonance::Lorentz { .. });
        let acting = || self.resonances.iter().filter(|resonance| !resonance.is_absent());
        let ringing = acting().filter(lorentz).count();
        let debye = self.poles.iter().filter(|pole| pole.delta_eps != 0.0).count();
        (debye + acting().count() - ringing, ringing)
    }

    /// Relative permittivity (real part, without conduction) at a frequency in Hz; where a pole resonates, what a wave of the
    /// same length without loss would need: `Re(sqrt(eps_r))²`.
    pub fn eps_r_at(&self, frequency: f64) -> f64 {
        let omega = 2.0 * std::f64::consts::PI * frequency;
        if !self.resonances.is_empty() {
            let relaxed = self.poles.iter().map(|pole| {
                let turns = omega * pole.tau;
                (pole.delta_eps / (1.0 + turns * turns), pole.delta_eps * turns / (1.0 + turns * turns))
            });
            let parts = relaxed.chain(self.resonances.iter().map(|resonance| resonance.eps_r_at(omega)));
            let (re, loss) = parts.fold((self.eps_r, 0.0), |(re, loss), (a, b)| (re + a, loss + b));
            return 0.5 * (re.hypot(loss) + re);
        }
        self.eps_r + self.poles.iter().map(|pole| pole.delta_eps / (1.0 + (omega * pole.tau).powi(2))).sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// At its resonance a Lorentz pole is pure loss, `delta_eps w0/(2 damping)`; at rest it is its strength. A Drude pole far
    /// above its collisions is `-(fp/f)²`.
    #[test]
    fn resonances_are_those_of_their_formulas() {
        let lorentz = Resonance::Lorentz { delta_eps: 2.0, frequency: 4e9, damping: 1e9 };
        let (re, loss) = lorentz.eps_r_at(2.0 * PI * 4e9);
        assert!(re.abs() < 1e-12 && (loss / (2.0 * 2.0 * PI * 4e9 / 2e9) - 1.0).abs() < 1e-12, "{re} {loss}");
        assert_eq!(lorentz.eps_r_at(0.0), (2.0, 0.0));
        let (re, _) = Resonance::Drude { frequency: 1e9, collisions: 1.0 }.eps_r_at(2.0 * PI * 2e9);
        assert!((re / -0.25 - 1.0).abs() < 1e-12, "{re}");
    }
}
