//! How a bed is settled, and what it came to.

use crate::packing::grading::{ClassReading, Grading};
use crate::packing::spheres::SphereBed;
use crate::units::{KilogramsPerCubicMetre, Metres, Pascals, Seconds, Share};

/// How stones are settled. The defaults are those of Irazábal, Salazar & Oñate 2017 but for what is marked as assumed.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SettleSpec {
    /// Density of the stone.
    pub density: KilogramsPerCubicMetre,
    /// Modulus of Young. The paper has 17.7 GPa; assumed: softened to 1 GPa, which makes steps four times as long and overlaps
    /// seven times as deep (some hundredths of a millimetre under half a metre of ballast).
    pub young: Pascals,
    /// Ratio of Poisson.
    pub poisson: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// Coefficient of sliding friction once the bed has settled; also on walls (assumed).
    pub friction: f64,
    /// Coefficient of rolling friction once the bed has settled.
    pub rolling_friction: f64,
    /// Whether stones rub on each other while they fall. Without friction, as in the paper, they pack densely; with it loosely.
    #[serde(skip_serializing_if = "is_off")]
    pub friction_while_falling: bool,
    /// Time step as a share of the Rayleigh time. Assumed.
    pub time_step: Share,
    /// Solid share of the loose column that the stones fall from. Assumed.
    pub column: Share,
    /// Rest is reached when the kinetic energy is below this share of what lifts every stone by the mean diameter, and ...
    /// Assumed.
    pub energy_ratio: f64,
    /// ... the force left over on a stone is on average below this share of the mean contact force. Assumed.
    pub unbalanced_ratio: f64,
    /// Longest simulated time of each stage. Assumed.
    pub longest: Seconds,
    /// Number of stones; as many as the bed's height takes when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stones: Option<usize>,
}

fn is_off(rubbing: &bool) -> bool {
    !*rubbing
}

impl Default for SettleSpec {
    fn default() -> Self {
        Self {
            density: KilogramsPerCubicMetre(2700.0),
            young: Pascals(1e9),
            poisson: 0.18,
            restitution: 0.4,
            friction: 0.6,
            rolling_friction: 0.25,
            friction_while_falling: false,
            time_step: Share(0.2),
            column: Share(0.25),
            energy_ratio: 1e-7,
            unbalanced_ratio: 1e-2,
            longest: Seconds(5.0),
            stones: None,
        }
    }
}

/// What a settled bed is made from.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct SettleInput {
    /// Length, width and height of the bed.
    pub size: [Metres; 3],
    /// Whether the bed repeats itself along x and y, in place of walls.
    pub periodic: [bool; 2],
    /// The sieve curve, by mass.
    pub grading: Grading,
    /// Which diameters a sieve stands for.
    pub class_reading: ClassReading,
    /// How it is settled.
    pub how: SettleSpec,
}

/// What a stage came to.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Stage {
    /// `fall, without friction` (or `with`) and `rest, with friction`.
    pub name: String,
    /// Stones in it.
    pub stones: usize,
    /// Time steps.
    pub steps: u64,
    /// Simulated time, s.
    pub simulated_seconds: f64,
    /// Wall time, s; of the last part where it was stopped in between.
    pub wall_seconds: f64,
    /// Kinetic energy at its end over that which lifts every stone by the mean diameter.
    pub energy_ratio: f64,
    /// Mean force left over on a stone over the mean contact force.
    pub unbalanced_ratio: f64,
    /// Whether both fell below what was asked for; otherwise the longest time ran out.
    pub at_rest: bool,
}

/// A settled bed and how it came about.
#[derive(Debug, Clone, PartialEq)]
pub struct Settled {
    /// The bed, with its contact forces.
    pub bed: SphereBed,
    /// The stages.
    pub stages: Vec<Stage>,
    /// Stones that were struck off above the bed's height.
    pub struck_off: usize,
    /// Stones that left the box: none should.
    pub lost: usize,
    /// Time step, s.
    pub time_step: Seconds,
}

/// How far a bed has settled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settling {
    /// Name of the stage.
    pub stage: &'static str,
    /// Simulated time of the stage over the longest.
    pub of_longest: f64,
    /// Energy ratio of now.
    pub energy_ratio: f64,
    /// Unbalanced-force ratio of now.
    pub unbalanced_ratio: f64,
}
