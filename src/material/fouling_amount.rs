//! The same amount of fouling as a height, a share of the voids, of the mass, of the volume.

use super::{Bed, FinesPassing, FoulingIndices};
use crate::units::{KilogramsPerCubicMetre, Metres, Share};

/// A bed of stones fouled from the bottom: below the fouled height the voids are full, above they are empty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BottomFilledBed {
    /// Height of the bed.
    pub height: Metres,
    /// Voids between the stones as a share of the bed.
    pub porosity: Share,
    /// Density of the stone.
    pub stone_density: KilogramsPerCubicMetre,
    /// Pores of the fouling as a share of its bulk volume.
    pub fines_porosity: Share,
    /// Density of the grains of the fouling.
    pub fines_density: KilogramsPerCubicMetre,
}

/// How much fouling is asked for, in the unit in which it was said.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FoulingAmount {
    /// Fouled height from the bottom.
    Height(Metres),
    /// Share of all voids of the bed that is full.
    VoidsFilled(Share),
    /// Dry mass of the fouling over that of stones and fouling.
    Mass(Share),
    /// Bulk volume of the fouling over that of the bed.
    Volume(Share),
}

/// The same amount of fouling in every unit.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Fouling {
    /// Fouled height from the bottom.
    pub height: Metres,
    /// Share of all voids of the bed that is full.
    pub voids_filled: Share,
    /// Dry mass of the fouling over that of stones and fouling.
    pub mass: Share,
    /// Bulk volume of the fouling over that of the bed.
    pub volume: Share,
}

/// Why an amount of fouling cannot be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FoulingError {
    /// More than fits.
    #[error(
        "fouling {asked} is more than the bed takes: with all voids full it is {most}\n\nhint: ask for {most} or less"
    )]
    TooMuch {
        /// What was asked for, in words.
        asked: Described,
        /// The most that fits, in the same unit.
        most: Described,
    },
    /// Less than nothing.
    #[error("fouling {asked} is out of range: it should be zero or more")]
    Negative {
        /// What was asked for.
        asked: Described,
    },
    /// A bed that is none.
    #[error(
        "the bed is not one that can be fouled: height {}, voids {}, pores of the fouling {}, densities {} and {}\n\nhint: shares lie between 0% and 100%, heights and densities above zero",
        bed.height, bed.porosity, bed.fines_porosity, bed.stone_density, bed.fines_density
    )]
    Bed {
        /// The bed given.
        bed: BottomFilledBed,
    },
}

/// An amount of fouling that writes itself as "of 20 cm height", "of 8% of the mass", ….
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Described(pub FoulingAmount);

impl std::fmt::Display for Described {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let percent = |share: Share| (share.si() * 1e4).round() / 1e2;
        match self.0 {
            FoulingAmount::Height(height) => write!(f, "{} cm high", (height.si() * 1e4).round() / 1e2),
            FoulingAmount::VoidsFilled(share) => write!(f, "{}% of the voids", percent(share)),
            FoulingAmount::Mass(share) => write!(f, "{}% of the mass", percent(share)),
            FoulingAmount::Volume(share) => write!(f, "{}% of the volume", percent(share)),
        }
    }
}

/// Rounding in decimal that is let pass at the upper limit.
const SLACK: f64 = 1e-9;

impl BottomFilledBed {
    /// Turns an amount of fouling into every unit.
    ///
    /// `M_f/M_b = n s (1 - n_f) rho_f / ((1 - n) rho_b)` with `s` the share of the voids that is full, which for a bed
    /// filled from the bottom is the share of its height.
    ///
    /// ```
    /// use ballast_gpr::material::{BottomFilledBed, FoulingAmount};
    /// use ballast_gpr::units::{KilogramsPerCubicMetre, Metres, Share};
    /// let tank = BottomFilledBed {
    ///     height: Metres(0.48), porosity: Share(0.39), fines_porosity: Share(0.36),
    ///     stone_density: KilogramsPerCubicMetre(2800.0), fines_density: KilogramsPerCubicMetre(2500.0),
    /// };
    /// let fouling = tank.fouling(FoulingAmount::Volume(Share(0.1625)))?;
    /// assert!((fouling.height.si() - 0.20).abs() < 1e-12);
    /// # Ok::<(), ballast_gpr::material::FoulingError>(())
    /// ```
    ///
    /// # Errors
    /// A bed that is none, an amount below zero, or one above what all its voids take (the message names that).
    pub fn fouling(&self, amount: FoulingAmount) -> Result<Fouling, FoulingError> {
        self.check()?;
        let voids_filled = match amount {
            FoulingAmount::Height(height) => height.si() / self.height.si(),
            FoulingAmount::VoidsFilled(share) => share.si(),
            FoulingAmount::Volume(share) => share.si() / self.porosity.si(),
            FoulingAmount::Mass(share) if share.si() >= 1.0 => f64::INFINITY,
            FoulingAmount::Mass(share) => share.si() / (1.0 - share.si()) / self.mass_ratio_when_full(),
        };
        if voids_filled.is_nan() || voids_filled < 0.0 {
            return Err(FoulingError::Negative { asked: Described(amount) });
        }
        if voids_filled > 1.0 + SLACK {
            return Err(FoulingError::TooMuch { asked: Described(amount), most: Described(self.most(amount)) });
        }
        Ok(self.of_voids_filled(voids_filled.min(1.0)))
    }

    /// The indices of the bed with an amount of fouling in it, per square metre of plan.
    ///
    /// # Errors
    /// As [`BottomFilledBed::fouling`].
    pub fn indices(
        &self,
        amount: FoulingAmount,
        passing: Option<FinesPassing>,
    ) -> Result<FoulingIndices, FoulingError> {
        let fouling = self.fouling(amount)?;
        let (height, n) = (self.height.si(), self.porosity.si());
        let bed = Bed {
            stone_volume: height * (1.0 - n),
            void_volume: height * n,
            fines_bulk_volume: height * fouling.volume.si(),
            fines_porosity: self.fines_porosity,
            stone_density: self.stone_density,
            fines_density: self.fines_density,
            height: self.height,
            fouled_height: fouling.height,
        };
        Ok(FoulingIndices::of(&bed, passing))
    }

    fn check(&self) -> Result<(), FoulingError> {
        let share = |s: Share| s.si() > 0.0 && s.si() < 1.0;
        let positive = |v: f64| v > 0.0 && v.is_finite();
        let sound = positive(self.height.si())
            && share(self.porosity)
            && (share(self.fines_porosity) || self.fines_porosity.si() == 0.0)
            && positive(self.stone_density.si())
            && positive(self.fines_density.si());
        if sound { Ok(()) } else { Err(FoulingError::Bed { bed: *self }) }
    }

    fn mass_ratio_when_full(&self) -> f64 {
        let n = self.porosity.si();
        n * (1.0 - self.fines_porosity.si()) * self.fines_density.si() / ((1.0 - n) * self.stone_density.si())
    }

    fn of_voids_filled(&self, s: f64) -> Fouling {
        let ratio = s * self.mass_ratio_when_full();
        Fouling {
            height: Metres(s * self.height.si()),
            voids_filled: Share(s),
            mass: Share(ratio / (1.0 + ratio)),
            volume: Share(s * self.porosity.si()),
        }
    }

    fn most(&self, like: FoulingAmount) -> FoulingAmount {
        let full = self.of_voids_filled(1.0);
        match like {
            FoulingAmount::Height(_) => FoulingAmount::Height(full.height),
            FoulingAmount::VoidsFilled(_) => FoulingAmount::VoidsFilled(full.voids_filled),
            FoulingAmount::Mass(_) => FoulingAmount::Mass(full.mass),
            FoulingAmount::Volume(_) => FoulingAmount::Volume(full.volume),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn tank(porosity: f64) -> BottomFilledBed {
        BottomFilledBed {
            height: Metres(0.48),
            porosity: Share(porosity),
            stone_density: KilogramsPerCubicMetre(2800.0),
            fines_porosity: Share(0.36),
            fines_density: KilogramsPerCubicMetre(2500.0),
        }
    }

    /// Table 4 of Benedetto et al. 2017 prints 8, 16, 24 % of the volume for 10, 20, 30 cm. With 39 % voids that is the
    /// bed of 0.48 m; with 42 % it is the column of 0.52 m that counts the methacrylate.
    #[test]
    fn eight_sixteen_twentyfour_percent_are_ten_twenty_thirty_centimetres() {
        for (centimetres, printed) in [(10.0, 0.08), (20.0, 0.16), (30.0, 0.24)] {
            let amount = FoulingAmount::Height(Metres(centimetres / 100.0));
            let of_the_bed = tank(0.39).fouling(amount).unwrap().volume.si();
            assert!((of_the_bed - printed).abs() < 0.005, "{of_the_bed}");
            let of_the_column = tank(0.42).fouling(amount).unwrap().volume.si() * 0.48 / 0.52;
            assert!((of_the_column - printed).abs() < 0.005, "{of_the_column}");
        }
    }

    #[test]
    fn messages_word_for_word() {
        let message = |amount| tank(0.42).fouling(amount).unwrap_err().to_string();
        assert_eq!(
            message(FoulingAmount::Height(Metres(0.5))),
            "fouling 50 cm high is more than the bed takes: with all voids full it is 48 cm high\n\nhint: ask for 48 cm high or less"
        );
        // Full: 0.42*0.64*2500/(0.58*2800) = 0.41379 of the stone, 29.27 % of all.
        assert_eq!(
            message(FoulingAmount::Mass(Share(0.4))),
            "fouling 40% of the mass is more than the bed takes: with all voids full it is 29.27% of the mass\n\nhint: ask for 29.27% of the mass or less"
        );
        assert_eq!(
            message(FoulingAmount::Volume(Share(0.43))),
            "fouling 43% of the volume is more than the bed takes: with all voids full it is 42% of the volume\n\nhint: ask for 42% of the volume or less"
        );
        assert_eq!(
            message(FoulingAmount::VoidsFilled(Share(-0.1))),
            "fouling -10% of the voids is out of range: it should be zero or more"
        );
        assert_eq!(
            BottomFilledBed { porosity: Share(1.0), ..tank(0.42) }
                .fouling(FoulingAmount::Mass(Share(0.1)))
                .unwrap_err()
                .to_string(),
            "the bed is not one that can be fouled: height 0.48 m, voids 100%, pores of the fouling 36%, densities 2800 kg/m3 and 2500 kg/m3\n\nhint: shares lie between 0% and 100%, heights and densities above zero"
        );
        assert!(tank(0.42).fouling(FoulingAmount::Mass(Share(f64::NAN))).is_err());
    }

    proptest! {
        /// Every unit says the same: from any of the four back to the share of the voids. The indices agree: PVC is the
        /// share of the voids, and the mass is that of the closed form.
        #[test]
        fn the_units_agree(s in 0.0..1.0_f64, porosity in 0.1..0.6_f64) {
            let bed = tank(porosity);
            let fouling = bed.fouling(FoulingAmount::VoidsFilled(Share(s))).unwrap();
            for amount in [FoulingAmount::Height(fouling.height), FoulingAmount::Mass(fouling.mass), FoulingAmount::Volume(fouling.volume)] {
                prop_assert!((bed.fouling(amount).unwrap().voids_filled.si() - s).abs() < 1e-12);
            }
            let indices = bed.indices(FoulingAmount::VoidsFilled(Share(s)), None).unwrap();
            prop_assert!((indices.percentage_void_contamination - 100.0 * s).abs() < 1e-9);
            prop_assert!((indices.mass_percent - 100.0 * fouling.mass.si()).abs() < 1e-9);
        }
    }
}
