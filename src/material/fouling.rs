//! Fouling indices of the railway field from the volumes and masses of a bed.

use crate::units::{KilogramsPerCubicMetre, Metres, Share};

/// What a bed holds. Volumes in m³, or in m² (per metre) for a two-dimensional model: only their ratios matter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bed {
    /// Volume of the stones themselves.
    pub stone_volume: f64,
    /// Volume between the stones, whatever fills it.
    pub void_volume: f64,
    /// Bulk volume of the fouling: its grains and the pores between them, as it lies compacted in the voids.
    pub fines_bulk_volume: f64,
    /// Pores of the fouling as a share of its bulk volume.
    pub fines_porosity: Share,
    /// Density of the stone.
    pub stone_density: KilogramsPerCubicMetre,
    /// Density of the grains of the fouling.
    pub fines_density: KilogramsPerCubicMetre,
    /// Height of the bed.
    pub height: Metres,
    /// Height up to which the bed is fouled.
    pub fouled_height: Metres,
}

/// Shares by mass of the fouling material that pass two sieves.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FinesPassing {
    /// Passing 4.75 mm.
    pub at_4_75_mm: Share,
    /// Passing 0.075 mm.
    pub at_0_075_mm: Share,
}

impl FinesPassing {
    /// The A4 silt of the tank of Benedetto et al. 2017: 100 % and 84.7 %.
    pub const A4_SILT: Self = Self { at_4_75_mm: Share(1.0), at_0_075_mm: Share(0.847) };
}

/// Classes of Selig's fouling index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SeligClass {
    /// Below 1.
    Clean,
    /// 1 to 10.
    ModeratelyClean,
    /// 10 to 20.
    ModeratelyFouled,
    /// 20 to 40.
    Fouled,
    /// 40 and above.
    HighlyFouled,
}

impl SeligClass {
    /// The class of an index in percent.
    pub fn of(index: f64) -> Self {
        match index {
            i if i < 1.0 => Self::Clean,
            i if i < 10.0 => Self::ModeratelyClean,
            i if i < 20.0 => Self::ModeratelyFouled,
            i if i < 40.0 => Self::Fouled,
            _ => Self::HighlyFouled,
        }
    }

    /// The name of the class.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Clean => "clean",
            Self::ModeratelyClean => "moderately clean",
            Self::ModeratelyFouled => "moderately fouled",
            Self::Fouled => "fouled",
            Self::HighlyFouled => "highly fouled",
        }
    }
}

/// Classes of the relative ballast fouling ratio.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum RelativeFoulingClass {
    /// Below 2.
    Clean,
    /// 2 to 10.
    SlightlyFouled,
    /// 10 to 20.
    ModeratelyFouled,
    /// 20 to 50.
    Fouled,
    /// 50 and above.
    HighlyFouled,
}

impl RelativeFoulingClass {
    /// The class of a ratio in percent.
    pub fn of(ratio: f64) -> Self {
        match ratio {
            r if r < 2.0 => Self::Clean,
            r if r < 10.0 => Self::SlightlyFouled,
            r if r < 20.0 => Self::ModeratelyFouled,
            r if r < 50.0 => Self::Fouled,
            _ => Self::HighlyFouled,
        }
    }

    /// The name of the class.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Clean => "clean",
            Self::SlightlyFouled => "slightly fouled",
            Self::ModeratelyFouled => "moderately fouled",
            Self::Fouled => "fouled",
            Self::HighlyFouled => "highly fouled",
        }
    }
}

/// The indices of one bed, all in percent.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct FoulingIndices {
    /// Selig's fouling index: passing 4.75 mm plus passing 0.075 mm of the whole sample. None without a sieve curve of
    /// the fines. The stones are taken to pass neither.
    pub selig: Option<f64>,
    /// Class of `selig`.
    pub selig_class: Option<SeligClass>,
    /// Percentage void contamination: `100 V_fouling / V_void`.
    pub percentage_void_contamination: f64,
    /// Void contaminant index: `100 (1 + e_f)/e_b * rho_b/rho_f * M_f/M_b`.
    pub void_contaminant_index: f64,
    /// Relative ballast fouling ratio (Indraratna 2011): `100 (M_f rho_b/rho_f)/M_b`.
    pub relative_ballast_fouling_ratio: f64,
    /// Class of `relative_ballast_fouling_ratio`.
    pub relative_class: RelativeFoulingClass,
    /// Mass of the fouling over that of everything dry.
    pub mass_percent: f64,
    /// Bulk volume of the fouling over that of the bed.
    pub volume_percent: f64,
    /// Fouled height over the height of the bed.
    pub height_percent: f64,
}

impl FoulingIndices {
    /// Computes the indices; `passing` is needed for Selig's only.
    ///
    /// Formulas as in Rojas-Vivanco 2025 and Mbubia 2026. A bed without stones, voids or height gives indices that are not
    /// finite.
    pub fn of(bed: &Bed, passing: Option<FinesPassing>) -> Self {
        let fines_solid = bed.fines_bulk_volume * (1.0 - bed.fines_porosity.si());
        let (rho_b, rho_f) = (bed.stone_density.si(), bed.fines_density.si());
        let (stone_mass, fines_mass) = (bed.stone_volume * rho_b, fines_solid * rho_f);
        let mass_percent = 100.0 * fines_mass / (stone_mass + fines_mass);
        let stone_void_ratio = bed.void_volume / bed.stone_volume;
        let fines_void_ratio = bed.fines_porosity.si() / (1.0 - bed.fines_porosity.si());
        let relative = 100.0 * (fines_mass * rho_b / rho_f) / stone_mass;
        let selig = passing.map(|p| mass_percent * (p.at_4_75_mm.si() + p.at_0_075_mm.si()));
        Self {
            selig,
            selig_class: selig.map(SeligClass::of),
            percentage_void_contamination: 100.0 * bed.fines_bulk_volume / bed.void_volume,
            void_contaminant_index: 100.0 * (1.0 + fines_void_ratio) / stone_void_ratio
                * (rho_b / rho_f)
                * (fines_mass / stone_mass),
            relative_ballast_fouling_ratio: relative,
            relative_class: RelativeFoulingClass::of(relative),
            mass_percent,
            volume_percent: 100.0 * bed.fines_bulk_volume / (bed.stone_volume + bed.void_volume),
            height_percent: 100.0 * bed.fouled_height.si() / bed.height.si(),
        }
    }
}

/// How dense the stones lie, for [`selig_from_height`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Compaction {
    /// Void ratio 0.7.
    Loose,
    /// Void ratio 0.6.
    Medium,
    /// Void ratio 0.53.
    Compact,
}

/// Selig's fouling index from the fouled height in percent of the bed, for fines all between 0.075 and 4.75 mm.
///
/// The fitted parabolas of Rojas-Vivanco 2025, for `height_percent` in 0…100.
pub fn selig_from_height(height_percent: f64, compaction: Compaction) -> f64 {
    let (square, slope, offset) = match compaction {
        Compaction::Loose => (-0.0013, 0.5570, 0.4170),
        Compaction::Medium => (-0.0017, 0.6311, 0.4933),
        Compaction::Compact => (-0.0022, 0.7248, 0.6753),
    };
    offset + height_percent * (slope + height_percent * square)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tank(porosity: f64, fouled: f64) -> Bed {
        Bed {
            stone_volume: 0.48 * (1.0 - porosity),
            void_volume: 0.48 * porosity,
            fines_bulk_volume: fouled * porosity,
            fines_porosity: Share(0.36),
            stone_density: KilogramsPerCubicMetre(2800.0),
            fines_density: KilogramsPerCubicMetre(2500.0),
            height: Metres(0.48),
            fouled_height: Metres(fouled),
        }
    }

    /// Closed form of the compilation: n 0.42 and n_f 0.36 give 7.9, 14.7, 20.5 % of the mass and PVC 21, 42, 62 %;
    /// n 0.39 gives 7.1, 13.2, 18.6 %. Half a unit of the last digit.
    #[test]
    fn the_tank_in_every_index() {
        for (fouled, mass, mass_39, pvc) in [(0.1, 7.9, 7.1, 21.0), (0.2, 14.7, 13.2, 42.0), (0.3, 20.5, 18.6, 62.0)] {
            let indices = FoulingIndices::of(&tank(0.42, fouled), Some(FinesPassing::A4_SILT));
            assert!((indices.mass_percent - mass).abs() <= 0.051, "{indices:?}");
            assert!((FoulingIndices::of(&tank(0.39, fouled), None).mass_percent - mass_39).abs() <= 0.051);
            // 62.5 is printed as 62.
            assert!((indices.percentage_void_contamination - pvc).abs() <= 0.501, "{indices:?}");
            assert!((indices.void_contaminant_index / indices.percentage_void_contamination - 1.0).abs() < 1e-12);
            assert!((indices.height_percent - indices.percentage_void_contamination).abs() < 1e-9);
        }
    }

    /// By hand for 0.20 m, n 0.42: M_f/M_b = 0.42*(0.2/0.48)*0.64*2500/(0.58*2800) = 0.172414; mass 14.706 %; Selig
    /// 14.706*1.847 = 27.16 (fouled); R_b-f = 0.172414*2800/2500 = 19.31 % (moderately fouled).
    #[test]
    fn twenty_centimetres_by_hand() {
        let indices = FoulingIndices::of(&tank(0.42, 0.2), Some(FinesPassing::A4_SILT));
        assert!((indices.selig.unwrap() - 27.162).abs() < 1e-3, "{indices:?}");
        assert_eq!(indices.selig_class.unwrap().name(), "fouled");
        assert!((indices.relative_ballast_fouling_ratio - 19.3103).abs() < 1e-4, "{indices:?}");
        assert_eq!(indices.relative_class.name(), "moderately fouled");
    }

    #[test]
    fn a_clean_bed_is_clean_in_every_class() {
        let indices = FoulingIndices::of(&tank(0.42, 0.0), Some(FinesPassing::A4_SILT));
        assert_eq!((indices.selig, indices.selig_class), (Some(0.0), Some(SeligClass::Clean)));
        assert_eq!(indices.relative_class, RelativeFoulingClass::Clean);
        assert_eq!((indices.mass_percent, indices.volume_percent), (0.0, 0.0));
    }

    /// The edges belong to the class above: 1, 10, 20, 40 and 2, 10, 20, 50.
    #[test]
    fn class_edges() {
        let selig: Vec<_> = [0.99, 1.0, 10.0, 20.0, 40.0].map(SeligClass::of).to_vec();
        assert!(selig.windows(2).all(|pair| pair[0] < pair[1]));
        let relative: Vec<_> = [1.99, 2.0, 10.0, 20.0, 50.0].map(RelativeFoulingClass::of).to_vec();
        assert!(relative.windows(2).all(|pair| pair[0] < pair[1]));
    }

    /// At half the height by hand: -0.0017*2500 + 0.6311*50 + 0.4933 = 27.7983.
    #[test]
    fn selig_from_half_the_height() {
        assert!((selig_from_height(50.0, Compaction::Medium) - 27.7983).abs() < 1e-10);
        assert!(selig_from_height(50.0, Compaction::Loose) < selig_from_height(50.0, Compaction::Compact));
    }
}
