//! Soils: Topp's polynomial and Peplinski's semi-empirical model.

use super::dielectric::{WATER, WATER_EPS_INFINITY};
use super::{DebyePole, Dielectric};
use crate::units::{KilogramsPerCubicMetre, Seconds, Share, SiemensPerMetre};

/// Relative permittivity of a soil from its volumetric water content (Topp, Davis and Annan 1980).
///
/// `3.03 + 9.3 th + 146 th^2 - 76.7 th^3`, fitted to mineral soils between 20 MHz and 1 GHz.
pub fn topp_permittivity(water_content: Share) -> f64 {
    let th = water_content.si();
    3.03 + th * (9.3 + th * (146.0 - th * 76.7))
}

/// Volumetric water content of a soil from its relative permittivity (Topp, Davis and Annan 1980).
///
/// `-0.053 + 0.0292 e - 5.5e-4 e^2 + 4.3e-6 e^3`, a fit of its own: going there and back misses by up to 0.02. Below
/// `eps_r` 1.88 it is negative.
pub fn topp_water_content(eps_r: f64) -> Share {
    Share(-0.053 + eps_r * (0.0292 + eps_r * (-5.5e-4 + eps_r * 4.3e-6)))
}

/// A soil by its texture and densities, for Peplinski's model.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Peplinski {
    /// Share of sand by mass.
    pub sand: Share,
    /// Share of clay by mass.
    pub clay: Share,
    /// Density of the dry soil with its pores.
    pub bulk_density: KilogramsPerCubicMetre,
    /// Density of its grains.
    pub grain_density: KilogramsPerCubicMetre,
}

/// Why Peplinski's model could not be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SoilError {
    /// Shares of texture that are no shares.
    #[error("sand {sand} and clay {clay} should each be 0% or more and together at most 100%")]
    Texture {
        /// Share of sand.
        sand: Share,
        /// Share of clay.
        clay: Share,
    },
    /// A soil as dense as its grains, or denser.
    #[error("bulk density {bulk} should be above 0 and below the density of the grains, {grains}")]
    Density {
        /// Density of the dry soil.
        bulk: KilogramsPerCubicMetre,
        /// Density of the grains.
        grains: KilogramsPerCubicMetre,
    },
    /// No water, or more than the pores hold.
    #[error("water content {water} is out of range: it should be above 0% and at most the porosity, {porosity}")]
    WaterContent {
        /// Volumetric water content.
        water: Share,
        /// Pores of the soil.
        porosity: Share,
    },
    /// A combination on which the fit gives what no material has.
    #[error(
        "Peplinski's fit gives an impossible soil here: permittivity {eps_infinity:.3} at high frequency, {eps_static:.3} at rest, conductivity {sigma:.4} S/m\n\nhint: it holds for moist loams at 0.3 to 1.3 GHz; use a mixing model instead"
    )]
    OutsideTheFit {
        /// Relative permittivity far above the relaxation.
        eps_infinity: f64,
        /// Relative permittivity at rest.
        eps_static: f64,
        /// Conductivity, S/m.
        sigma: f64,
    },
}

/// What Peplinski's fit gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mixture {
    /// Relative permittivity far above the relaxation.
    pub eps_infinity: f64,
    /// Strength of the pole.
    pub delta_eps: f64,
    /// Conductivity, S/m.
    pub sigma: f64,
}

/// Pure water at 25 °C above a permittivity of 4.9, as gprMax 4 has it: the polynomials of Ulaby, Moore & Fung 1986,
/// "Microwave remote sensing" vol. III, appendix E (Klein & Swift 1977), at that temperature.
pub const WATER_25_C: DebyePole =
    DebyePole { delta_eps: 73.338_906_250_000_01, tau: Seconds(8.099_395_053_946_554e-12) };

impl Peplinski {
    /// The soil at a volumetric water content: one Debye pole of water and a conductivity.
    ///
    /// Peplinski, Ulaby and Dobson 1995 with the real part at 1.3 GHz and the correction `1.15 e - 0.68`, in the form that
    /// gprMax uses for `#soil_peplinski`: the pole has the relaxation time of water and strength `th^(b''/a) 75.2`. Holds
    /// for 0.3 to 1.3 GHz. It under-reads dense dry silt (3.7 where 5.0 was measured at 4 % water).
    ///
    /// # Errors
    /// Texture, densities or water content out of range, or a result that no material has.
    pub fn at(&self, water_content: Share) -> Result<Dielectric, SoilError> {
        let (s, c, th) = (self.sand.si(), self.clay.si(), water_content.si());
        if !(s >= 0.0 && c >= 0.0 && s + c <= 1.0 + 1e-9) {
            return Err(SoilError::Texture { sand: self.sand, clay: self.clay });
        }
        let (rho_b, rho_s) = (self.bulk_density.si() / 1000.0, self.grain_density.si() / 1000.0);
        if !(rho_b > 0.0 && rho_b < rho_s && rho_s.is_finite()) {
            return Err(SoilError::Density { bulk: self.bulk_density, grains: self.grain_density });
        }
        let porosity = 1.0 - rho_b / rho_s;
        if !(th > 0.0 && th <= porosity + 1e-9) {
            return Err(SoilError::WaterContent { water: water_content, porosity: Share(porosity) });
        }
        let Mixture { eps_infinity, delta_eps, sigma } = self.fit(th, WATER);
        let eps_static = eps_infinity + delta_eps;
        Dielectric::new(eps_infinity, SiemensPerMetre(sigma), vec![DebyePole { delta_eps, tau: WATER.tau }])
            .map_err(|_| SoilError::OutsideTheFit { eps_infinity, eps_static, sigma })
    }

    /// The fit itself, whatever comes of it, with another water: one Debye pole with the relaxation time of the water, above the
    /// permittivity `eps_infinity`, and a conductivity in S/m. gprMax 4 takes [`WATER_25_C`] for `#soil_peplinski`.
    pub fn fit(&self, water_content: f64, water: DebyePole) -> Mixture {
        const A: f64 = 0.65;
        let (s, c, th) = (self.sand.si(), self.clay.si(), water_content);
        let (rho_b, rho_s) = (self.bulk_density.si() / 1000.0, self.grain_density.si() / 1000.0);
        let omega = 2.0 * std::f64::consts::PI * 1.3e9;
        let wet = WATER_EPS_INFINITY + water.delta_eps / (1.0 + (omega * water.tau.si()).powi(2));
        let grains = (1.01 + 0.44 * rho_s).powi(2) - 0.062;
        let b_real = 1.2748 - 0.519 * s - 0.152 * c;
        let b_imaginary = 1.33797 - 0.603 * s - 0.166 * c;
        let conduction = 0.0467 + 0.2204 * rho_b - 0.411 * s + 0.6614 * c;
        let mixed = 1.0 + rho_b / rho_s * (grains.powf(A) - 1.0) + th.powf(b_real) * wet.powf(A) - th;
        let eps_static = 1.15 * mixed.powf(1.0 / A) - 0.68;
        let delta_eps = th.powf(b_imaginary / A) * water.delta_eps;
        let sigma = th.powf(b_imaginary / A) * (conduction * (rho_s - rho_b)) / (rho_s * th);
        Mixture { eps_infinity: eps_static - delta_eps, delta_eps, sigma }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn loam() -> Peplinski {
        Peplinski {
            sand: Share(0.15),
            clay: Share(0.10),
            bulk_density: KilogramsPerCubicMetre(1600.0),
            grain_density: KilogramsPerCubicMetre(2500.0),
        }
    }

    /// Recomputed from gprMax's formulas in another language: S 0.15, C 0.10, 1.6 and 2.5 g/cm3. Half a unit of the last
    /// digit printed.
    #[test]
    fn peplinskis_worked_example() {
        for (th, eps, millisiemens) in [(0.04, 3.68, 8.2), (0.10, 5.77, 18.6), (0.20, 10.57, 34.5), (0.30, 16.89, 49.6)]
        {
            let soil = loam().at(Share(th)).unwrap();
            assert!((soil.static_permittivity() - eps).abs() <= 0.0051, "{th}: {}", soil.static_permittivity());
            assert!((soil.sigma.si() * 1e3 - millisiemens).abs() <= 0.051, "{th}: {}", soil.sigma.si());
        }
    }

    /// By hand: th 0.2 gives 3.03 + 1.86 + 5.84 - 0.6136 = 10.1164; the inverse fit brings 0.1912 back.
    #[test]
    fn topp_and_its_inverse() {
        assert!((topp_permittivity(Share(0.2)) - 10.1164).abs() < 1e-12);
        for th in [0.05, 0.1, 0.2, 0.3, 0.4] {
            let back = topp_water_content(topp_permittivity(Share(th))).si();
            assert!((back - th).abs() < 0.02, "{th} came back as {back}");
        }
    }

    #[test]
    fn messages_word_for_word() {
        assert_eq!(
            loam().at(Share(0.5)).unwrap_err().to_string(),
            "water content 50% is out of range: it should be above 0% and at most the porosity, 36%"
        );
        assert_eq!(
            Peplinski { clay: Share(0.9), ..loam() }.at(Share(0.1)).unwrap_err().to_string(),
            "sand 15% and clay 90% should each be 0% or more and together at most 100%"
        );
        assert_eq!(
            Peplinski { bulk_density: KilogramsPerCubicMetre(2600.0), ..loam() }
                .at(Share(0.1))
                .unwrap_err()
                .to_string(),
            "bulk density 2600 kg/m3 should be above 0 and below the density of the grains, 2500 kg/m3"
        );
    }

    /// Pure dense sand: the fit of the conduction, 0.0467 + 0.2204 rho_b - 0.411 S, turns negative below 1.65 g/cm3.
    #[test]
    fn a_negative_conductivity_is_refused() {
        let sand = Peplinski { sand: Share(1.0), clay: Share(0.0), ..loam() };
        assert!(matches!(sand.at(Share(0.1)), Err(SoilError::OutsideTheFit { sigma, .. }) if sigma < 0.0));
    }
}
