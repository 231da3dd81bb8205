//! Which beds are settled.

use crate::packing::settle::{SettleInput, SettleSpec};
use crate::packing::spheres::mean_stone_volume;
use crate::packing::{ClassReading, Grading, PackingError};
use crate::scene::{Dimension, PackingMethod, SceneError, SceneSpec};
use crate::units::{Metres, Pascals, Seconds, Share};

/// Modulus of Young of Irazábal, Salazar & Oñate 2017.
const STIFFEST: Pascals = Pascals(17.7e9);
/// Height of all beds, m: seven mean stones; the compaction fit of the discs begins at 26 cm.
const HEIGHT: f64 = 0.30;
/// Solid share that the floor is laid out for, so that a bed of this height has about the stones asked for.
const SOLID: f64 = 0.6;

/// What is turned while the rest stays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DemKnob {
    /// Softened stones. The reference is the modulus of the paper.
    Stiffness,
    /// Time step as a share of the Rayleigh time. The reference is the shortest.
    TimeStep,
    /// Stones: the same height on a wider floor. The reference has most.
    Stones,
    /// Stones that are placed and not settled. The reference is that of the stiffness.
    Placed,
}

impl DemKnob {
    /// The word for it in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stiffness => "stiffness",
            Self::TimeStep => "time step",
            Self::Stones => "stones",
            Self::Placed => "not settled",
        }
    }
}

/// How a bed is settled.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct DemSetting {
    /// Modulus of Young.
    pub young: Pascals,
    /// Time step as a share of the Rayleigh time.
    pub time_step: Share,
    /// Stones that the floor is laid out for.
    pub stones: usize,
}

/// Which beds are settled, and how often.
#[derive(Debug, Clone)]
pub struct DemCostPlan {
    /// The setting that the knobs are turned about: a tenth of the stiffest modulus, a fifth of the Rayleigh time.
    pub base: DemSetting,
    /// Seeds of each setting, counted from 1.
    pub seeds: u64,
    /// Sections through each bed that the radar sees.
    pub sections: usize,
    /// The scene of a section.
    pub scene: SceneSpec,
    grading: Grading,
}

impl DemCostPlan {
    /// Beds of the tank's ballast, 30 cm high, with about this many stones; sections with cells of 5 mm under 1 GHz.
    ///
    /// # Errors
    /// When there is no such scene.
    pub fn standard(stones: usize, seeds: u64, sections: usize) -> Result<Self, SceneError> {
        let mut scene = SceneSpec::preset("bed")?;
        scene.title = "cost of settling".into();
        scene.tank.height = Metres(HEIGHT);
        scene.packing.method = PackingMethod::Dem;
        (scene.grid.dimension, scene.grid.time_window) = (Dimension::Two, Seconds(9e-9));
        let grading = scene.packing.grading.curve()?;
        let base = DemSetting { young: Pascals(0.1 * STIFFEST.si()), time_step: Share(0.2), stones };
        Ok(Self { base, seeds, sections, scene, grading })
    }

    /// The settings of each knob, the reference first.
    pub fn settings(&self) -> Vec<(DemKnob, DemSetting)> {
        let base = self.base;
        let stiffness = [1.0, 10.0, 100.0, 1000.0]
            .map(|softer| (DemKnob::Stiffness, DemSetting { young: Pascals(STIFFEST.si() / softer), ..base }));
        let steps =
            [0.05, 0.1, 0.2, 0.4, 0.8].map(|share| (DemKnob::TimeStep, DemSetting { time_step: Share(share), ..base }));
        let stones = [4.0, 2.0, 1.0, 0.5, 0.25].map(|times| {
            let stones = ((base.stones as f64 * times).round() as usize).max(1);
            (DemKnob::Stones, DemSetting { stones, ..base })
        });
        stiffness.into_iter().chain(steps).chain(stones).collect()
    }

    /// What a bed of a setting is settled from.
    ///
    /// # Errors
    /// When the grading cannot be split into classes.
    pub fn input(&self, setting: DemSetting) -> Result<SettleInput, PackingError> {
        let class_reading = self.scene.packing.class_reading;
        let side = self.side(setting.stones, class_reading)?;
        let how = SettleSpec { young: setting.young, time_step: setting.time_step, ..SettleSpec::default() };
        Ok(SettleInput {
            size: [side, side, self.scene.tank.height],
            periodic: [false; 2],
            grading: self.grading.clone(),
            class_reading,
            how,
        })
    }

    /// Side of the square floor for a number of stones, in whole centimetres so that cells fit.
    fn side(&self, stones: usize, class_reading: ClassReading) -> Result<Metres, PackingError> {
        let mean = mean_stone_volume(&self.grading.classes(class_reading)?);
        let floor = stones as f64 * mean / (SOLID * self.scene.tank.height.si());
        Ok(Metres((100.0 * floor.sqrt()).round().max(8.0) / 100.0))
    }

    /// Up to which height voids are judged: four fifths of the bed, below its rough surface.
    pub fn judged_height(&self) -> Metres {
        Metres(0.8 * self.scene.tank.height.si())
    }
}
