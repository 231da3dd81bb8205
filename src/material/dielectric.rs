//! A material by its permittivity, conductivity and Debye poles.

use super::Complex;
use crate::units::constants::EPSILON_0;
use crate::units::{Hertz, Seconds, SiemensPerMetre};

/// One Debye relaxation: `delta_eps / (1 + i omega tau)`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DebyePole {
    /// Relative permittivity far below the relaxation minus that far above it.
    pub delta_eps: f64,
    /// Relaxation time.
    pub tau: Seconds,
}

/// A non-magnetic material: permittivity, conductivity and Debye poles.
///
/// In TOML: `{ eps_r = 6.5, sigma = "1mS/m" }`, or with relaxation
/// `{ eps_r = 4.9, poles = [{ delta_eps = 75.2, tau = "9.231ps" }] }`. Values out of range are refused on reading.
///
/// ```
/// use ballast_gpr::material::Dielectric;
/// use ballast_gpr::units::Hertz;
/// let limestone = Dielectric::lossless(6.5);
/// assert_eq!(limestone.permittivity(Hertz(1e9)).re, 6.5);
/// ```
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(try_from = "Written")]
pub struct Dielectric {
    /// Relative permittivity; where there are poles, that far above the relaxations (often written `eps_inf`).
    pub eps_r: f64,
    /// Conductivity at rest.
    pub sigma: SiemensPerMetre,
    /// Debye relaxations; empty for a material without dispersion.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub poles: Vec<DebyePole>,
}

/// What a file may hold, before it is checked.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    eps_r: f64,
    #[serde(default)]
    sigma: SiemensPerMetre,
    #[serde(default)]
    poles: Vec<DebyePole>,
}

impl TryFrom<Written> for Dielectric {
    type Error = DielectricError;
    fn try_from(written: Written) -> Result<Self, DielectricError> {
        Self::new(written.eps_r, written.sigma, written.poles)
    }
}

/// A value that no passive material has.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DielectricError {
    /// Under one, or not a number.
    #[error(
        "relative permittivity {eps_r} is out of range: it should be 1 (free space) or more\n\nhint: limestone is `eps_r = 6.5`"
    )]
    Permittivity {
        /// The value given.
        eps_r: f64,
    },
    /// Negative or not a number.
    #[error(
        "conductivity {} S/m is out of range: it should be zero or more and finite\n\nhint: a perfect conductor is the material `pec`",
        sigma.si()
    )]
    Conductivity {
        /// The value given.
        sigma: SiemensPerMetre,
    },
    /// A pole of negative strength or without a relaxation time.
    #[error(
        "Debye pole {number} (delta_eps {delta_eps}, tau {tau}) is out of range: delta_eps should be zero or more and tau above zero\n\nhint: water is `{{ delta_eps = 75.2, tau = \"9.231ps\" }}` over `eps_r = 4.9`"
    )]
    Pole {
        /// Which pole, counted from 1.
        number: usize,
        /// Its strength.
        delta_eps: f64,
        /// Its relaxation time.
        tau: Seconds,
    },
}

impl Dielectric {
    /// Checks the values and keeps them.
    ///
    /// # Errors
    /// A permittivity under one, a negative or infinite conductivity, a pole of negative strength or time.
    pub fn new(eps_r: f64, sigma: SiemensPerMetre, poles: Vec<DebyePole>) -> Result<Self, DielectricError> {
        if !(eps_r.is_finite() && eps_r >= 1.0) {
            return Err(DielectricError::Permittivity { eps_r });
        }
        if !(sigma.si().is_finite() && sigma.si() >= 0.0) {
            return Err(DielectricError::Conductivity { sigma });
        }
        for (index, pole) in poles.iter().enumerate() {
            let DebyePole { delta_eps, tau } = *pole;
            if !(delta_eps.is_finite() && delta_eps >= 0.0 && tau.si().is_finite() && tau.si() > 0.0) {
                return Err(DielectricError::Pole { number: index + 1, delta_eps, tau });
            }
        }
        Ok(Self { eps_r, sigma, poles })
    }

    /// Names a material without loss and dispersion.
    pub const fn lossless(eps_r: f64) -> Self {
        Self { eps_r, sigma: SiemensPerMetre(0.0), poles: vec![] }
    }

    /// Complex relative permittivity, conduction included: `eps' - i eps''` for `exp(+i omega t)`.
    ///
    /// `frequency` should be above zero where the material conducts; at zero the imaginary part is minus infinity.
    pub fn permittivity(&self, frequency: Hertz) -> Complex {
        let omega = 2.0 * std::f64::consts::PI * frequency.si();
        let relaxed = self.permittivity_without_conduction(omega);
        if self.sigma.si() == 0.0 {
            relaxed
        } else {
            relaxed - Complex::new(0.0, self.sigma.si() / (omega * EPSILON_0))
        }
    }

    /// Relative permittivity at rest: `eps_r` and all poles.
    pub fn static_permittivity(&self) -> f64 {
        self.eps_r + self.poles.iter().map(|pole| pole.delta_eps).sum::<f64>()
    }

    /// Attenuation of a plane wave, dB/m, at a frequency above zero.
    pub fn attenuation_db_per_metre(&self, frequency: Hertz) -> f64 {
        let omega = 2.0 * std::f64::consts::PI * frequency.si();
        let index = self.permittivity(frequency).sqrt();
        -index.im * omega / crate::units::constants::C0 * 20.0 * std::f64::consts::LOG10_E
    }

    fn permittivity_without_conduction(&self, omega: f64) -> Complex {
        self.poles.iter().fold(Complex::new(self.eps_r, 0.0), |eps, pole| {
            eps + pole.delta_eps / Complex::new(1.0, omega * pole.tau.si())
        })
    }
}

/// The relaxation of water at 20 °C as gprMax ships it (`gprMax/materials.py`): 80.1 at rest, 4.9 at infinite frequency,
/// 9.231 ps.
pub const WATER: DebyePole = DebyePole { delta_eps: 80.1 - WATER_EPS_INFINITY, tau: Seconds(9.231e-12) };
/// Permittivity of water far above its relaxation.
pub(super) const WATER_EPS_INFINITY: f64 = 4.9;

/// Water at 20 °C, one Debye pole ([`WATER`]), without conduction.
pub fn water() -> Dielectric {
    Dielectric { eps_r: WATER_EPS_INFINITY, sigma: SiemensPerMetre(0.0), poles: vec![WATER] }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At f = 1/(2 pi tau) = 17.24 GHz a Debye pole is half relaxed: 42.5 and 37.6, exactly.
    #[test]
    fn water_is_half_relaxed_at_its_relaxation_frequency() {
        let frequency = Hertz(1.0 / (2.0 * std::f64::consts::PI * 9.231e-12));
        assert!((frequency.si() / 17.24e9 - 1.0).abs() < 1e-3);
        let eps = water().permittivity(frequency);
        assert!((eps - Complex::new(42.5, -37.6)).norm() < 1e-12, "{eps}");
        assert!((water().static_permittivity() - 80.1).abs() < 1e-12);
    }

    /// sigma/(omega eps_0) at 1 GHz is 17.975 per S/m: 2 pi 1e9 * 8.854188e-12 = 0.0556325.
    #[test]
    fn conduction_is_an_imaginary_part_that_falls_with_frequency() {
        let moist = Dielectric::new(4.0, SiemensPerMetre(0.01), vec![]).unwrap();
        assert!((moist.permittivity(Hertz(1e9)).im + 0.01 / 0.055_632_5).abs() < 1e-6);
        assert!((moist.permittivity(Hertz(2e9)).im + 0.005 / 0.055_632_5).abs() < 1e-6);
    }

    /// Low loss: alpha = sigma Z0 / (2 sqrt eps) Np/m = 0.01 * 376.730 / 4 = 0.94183 Np/m = 8.181 dB/m; the next term of
    /// the series is (eps''/eps')^2 / 8 = 2.5e-4 of it.
    #[test]
    fn attenuation_is_the_low_loss_formula() {
        let moist = Dielectric::new(4.0, SiemensPerMetre(0.01), vec![]).unwrap();
        assert!((moist.attenuation_db_per_metre(Hertz(1e9)) / 8.1806 - 1.0).abs() < 4e-4);
    }

    #[test]
    fn it_reads_from_toml_and_back() {
        let text = "eps_r = 4.9\nsigma = \"1mS/m\"\npoles = [{ delta_eps = 75.2, tau = \"9.231ps\" }]\n";
        let read: Dielectric = toml::from_str(text).unwrap();
        assert_eq!(read.poles, vec![DebyePole { delta_eps: 75.2, tau: Seconds(9.231e-12) }]);
        assert_eq!(toml::from_str::<Dielectric>(&toml::to_string(&read).unwrap()).unwrap(), read);
        assert_eq!(toml::from_str::<Dielectric>("eps_r = 6.5").unwrap(), Dielectric::lossless(6.5));
        assert!(toml::from_str::<Dielectric>("eps_r = 6.5\nepsr = 2").is_err());
    }

    #[test]
    fn what_no_material_has_is_refused_word_for_word() {
        let message = |eps, sigma, poles| Dielectric::new(eps, SiemensPerMetre(sigma), poles).unwrap_err().to_string();
        assert_eq!(
            message(0.5, 0.0, vec![]),
            "relative permittivity 0.5 is out of range: it should be 1 (free space) or more\n\nhint: limestone is `eps_r = 6.5`"
        );
        assert_eq!(
            message(2.0, -1.0, vec![]),
            "conductivity -1 S/m is out of range: it should be zero or more and finite\n\nhint: a perfect conductor is the material `pec`"
        );
        assert_eq!(
            message(2.0, 0.0, vec![WATER, DebyePole { delta_eps: 1.0, tau: Seconds(0.0) }]),
            "Debye pole 2 (delta_eps 1, tau 0 ns) is out of range: delta_eps should be zero or more and tau above zero\n\nhint: water is `{ delta_eps = 75.2, tau = \"9.231ps\" }` over `eps_r = 4.9`"
        );
        assert!(toml::from_str::<Dielectric>("eps_r = nan").is_err());
    }
}
