//! What the files of all experiments share: the stone, the sizes, how it is run.

use std::path::Path;

use rand::{Rng, RngExt as _};
use serde::{Deserialize, Serialize};

use super::error::ExperimentError;
use crate::packing::dem::{Rolling, Stuff, TimeStep};
use crate::units::{KilogramsPerCubicMetre, Metres, Pascals, Seconds};

/// The stone.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoneSpec {
    /// Density of the solid.
    pub density: KilogramsPerCubicMetre,
    /// Modulus of Young; far below that of stone it softens the contacts, which is faster and changes the result.
    pub young: Pascals,
    /// Ratio of Poisson.
    pub poisson: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// Coefficient of sliding friction.
    pub friction: f64,
    /// Coefficient of rolling friction.
    pub rolling_friction: f64,
}

/// The modulus of the paper's runs, below which results count as softened.
const PAPERS_YOUNG: Pascals = Pascals(17.7e9);

impl StoneSpec {
    /// The material for the simulation, which checks it.
    pub fn stuff(&self) -> Stuff {
        Stuff {
            density: self.density.si(),
            young: self.young.si(),
            poisson: self.poisson,
            restitution: self.restitution,
            friction: self.friction,
            rolling_friction: self.rolling_friction,
        }
    }

    /// What must be said of the modulus, if it is below the one that the paper found to be enough.
    pub fn softened(&self) -> Option<String> {
        (self.young < PAPERS_YOUNG).then(|| {
            format!(
                "softened: E = {} in place of {}; contacts are {:.0} times as soft",
                self.young.in_unit("GPa"),
                PAPERS_YOUNG.in_unit("GPa"),
                PAPERS_YOUNG.si() / self.young.si()
            )
        })
    }
}

/// What the sizes are spread evenly by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EvenBy {
    /// As many stones of each diameter.
    Number,
    /// As much mass of each diameter.
    Mass,
}

/// The sizes of the stones.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SizeSpec {
    /// Smallest diameter.
    pub smallest: Metres,
    /// Largest diameter.
    pub largest: Metres,
    /// What is spread evenly between them.
    pub even_by: EvenBy,
}

impl SizeSpec {
    /// Draws a diameter, m.
    pub fn draw(&self, random: &mut impl Rng) -> f64 {
        let (low, high) = (self.smallest.si(), self.largest.si());
        let share: f64 = random.random();
        match self.even_by {
            EvenBy::Number => low + share * (high - low),
            // The number density falls as d^-3, so that its sum is a parabola of 1/d.
            EvenBy::Mass => (low.powi(-2) + share * (high.powi(-2) - low.powi(-2))).powf(-0.5),
        }
    }

    /// Mean volume of a stone, m³: pi/6 of the mean cube of the diameter.
    pub fn mean_volume(&self) -> f64 {
        let (a, b) = (self.smallest.si(), self.largest.si());
        let mean_cube = match self.even_by {
            EvenBy::Number => 0.25 * (a + b) * (a * a + b * b),
            // (b - a) of mass over the integral of d^-3, which is (a^-2 - b^-2)/2.
            EvenBy::Mass => 2.0 * a * a * b * b / (a + b),
        };
        std::f64::consts::PI / 6.0 * mean_cube
    }

    pub(super) fn check(&self, experiment: &'static str) -> Result<(), ExperimentError> {
        let out = |key, value: Metres, limit: String| {
            Err(ExperimentError::OutOfRange { experiment, key, value: value.in_unit("mm"), limit })
        };
        if self.smallest.si() <= 0.0 {
            return out("sizes.smallest", self.smallest, "above 0 mm".into());
        }
        if self.largest < self.smallest {
            let limit = format!("at least `sizes.smallest`, {}", self.smallest.in_unit("mm"));
            return out("sizes.largest", self.largest, limit);
        }
        if self.largest.si() > 1.0 {
            let limit = "at most 1000 mm; stones of ballast have 20 to 80 mm".into();
            return out("sizes.largest", self.largest, limit);
        }
        Ok(())
    }
}

/// The model of rolling resistance, as files name it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RollingName {
    /// The bounded model of Irazábal et al. 2017.
    Bounded,
    /// Type A of Ai et al. 2011: a constant torque against the rotation.
    A,
    /// Type C of Ai et al. 2011: a spring that slips, with a dashpot of 0.3 of the critical.
    C,
}

impl RollingName {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Bounded, Self::A, Self::C];

    /// The word in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bounded => "bounded",
            Self::A => "A",
            Self::C => "C",
        }
    }

    /// The model; the damping of type C is that of the paper's Fig. 6.
    pub fn model(self) -> Rolling {
        match self {
            Self::Bounded => Rolling::Bounded,
            Self::A => Rolling::ConstantTorque,
            Self::C => Rolling::ElasticPlastic { damping: 0.3 },
        }
    }
}

/// How it is run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunSpec {
    /// Time step; refused beyond the Rayleigh time of the smallest stone.
    pub time_step: Seconds,
    /// Model of rolling resistance.
    pub rolling: RollingName,
    /// Seed of sizes and places.
    pub seed: u64,
}

impl RunSpec {
    /// The time step for the simulation, which checks it.
    pub fn step(&self) -> TimeStep {
        TimeStep::Seconds(self.time_step.si())
    }
}

/// The file of an experiment: all numbers it needs, in TOML.
pub trait ExperimentSpec: Sized + serde::de::DeserializeOwned {
    /// The file to begin with.
    const TEMPLATE: &str;

    /// Checks what can be known before anything runs.
    ///
    /// # Errors
    /// With the value that is out of range.
    fn check(&self) -> Result<(), ExperimentError>;

    /// Reads and checks a file; `file` names it in messages.
    ///
    /// # Errors
    /// With the line, or the value that is out of range.
    fn read(text: &str, file: &Path) -> Result<Self, ExperimentError> {
        let spec: Self = toml::from_str(text).map_err(|error| ExperimentError::toml(file, text, &error))?;
        spec.check()?;
        Ok(spec)
    }
}

/// Refuses a value that is not above zero and finite.
pub(super) fn above_zero(
    experiment: &'static str,
    values: &[(&'static str, f64, String)],
) -> Result<(), ExperimentError> {
    match values.iter().find(|(_, value, _)| !(*value > 0.0 && value.is_finite())) {
        Some((key, _, shown)) => Err(ExperimentError::OutOfRange {
            experiment,
            key,
            value: shown.clone(),
            limit: "above zero and finite".into(),
        }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng as _;

    fn sizes(even_by: EvenBy) -> SizeSpec {
        SizeSpec { smallest: Metres(0.0315), largest: Metres(0.063), even_by }
    }

    /// The mean of 200 000 draws against the closed form; its standard error is 0.7/sqrt(200 000) = 0.16 %.
    #[test]
    fn drawn_sizes_have_the_mean_volume() {
        for even_by in [EvenBy::Number, EvenBy::Mass] {
            let (sizes, mut random) = (sizes(even_by), rand_pcg::Pcg64::seed_from_u64(7));
            let n = 200_000;
            let drawn: Vec<f64> = (0..n).map(|_| sizes.draw(&mut random)).collect();
            assert!(drawn.iter().all(|d| (0.0315..=0.063).contains(d)));
            let mean = std::f64::consts::PI / 6.0 * drawn.iter().map(|d| d.powi(3)).sum::<f64>() / f64::from(n);
            assert!((mean / sizes.mean_volume() - 1.0).abs() < 0.006, "{even_by:?}");
        }
        // By mass, half of it lies below the middle diameter.
        let (sizes, mut random) = (sizes(EvenBy::Mass), rand_pcg::Pcg64::seed_from_u64(8));
        let drawn: Vec<f64> = (0..200_000).map(|_| sizes.draw(&mut random).powi(3)).collect();
        let below: f64 = drawn.iter().filter(|cube| cube.cbrt() < 0.04725).sum();
        assert!((below / drawn.iter().sum::<f64>() - 0.5).abs() < 0.005);
    }
}
