//! Stones rain into a box layer by layer: height, porosity and contacts after each layer.

use serde::{Deserialize, Serialize};

use super::bench::{Bench, RestSpec, Running};
use super::error::ExperimentError;
use super::oedometer::boxed;
use super::outcome::{Curve, Outcome, Reading};
use super::placing::strew;
use super::spec::{ExperimentSpec, RunSpec, SizeSpec, StoneSpec, above_zero};
use crate::geometry::Sphere;
use crate::packing::dem::{Grain, Setup, Stuff};
use crate::units::Metres;

const NAME: &str = "pluviation";

/// What the experiment is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PluviationSpec {
    /// The stone; the floor is made of it too.
    pub stone: StoneSpec,
    /// The sizes.
    pub sizes: SizeSpec,
    /// How it is run.
    pub run: RunSpec,
    /// Side of the square box.
    pub width: Metres,
    /// Friction between stones and the sides of the box.
    pub side_friction: f64,
    /// How many layers.
    pub layers: usize,
    /// Stones of a layer.
    pub stones_per_layer: usize,
    /// Height from which the lowest stone of a layer falls onto the highest of the bed.
    pub drop: Metres,
    /// When stones count as being at rest.
    pub rest: RestSpec,
}

impl ExperimentSpec for PluviationSpec {
    const TEMPLATE: &str = include_str!("../../../templates/experiments/pluviation.toml");

    fn check(&self) -> Result<(), ExperimentError> {
        self.sizes.check(NAME)?;
        above_zero(
            NAME,
            &[
                ("layers", self.layers as f64, self.layers.to_string()),
                ("stones_per_layer", self.stones_per_layer as f64, self.stones_per_layer.to_string()),
                ("drop", self.drop.si(), self.drop.to_string()),
            ],
        )?;
        if self.width.si() < 2.0 * self.sizes.largest.si() {
            let (width, diameter) = (self.width, self.sizes.largest);
            return Err(ExperimentError::NarrowerThanAStone { what: "box", width, diameter });
        }
        Ok(())
    }
}

impl PluviationSpec {
    /// A layer above a bed.
    fn layer(&self, bed: &[Grain], layer: usize) -> Vec<Grain> {
        let (width, lowest) = (self.width.si(), top(bed) + self.drop.si());
        let seed = self.run.seed.wrapping_mul(1_000_003).wrapping_add(layer as u64);
        let falling = strew(
            &self.sizes,
            [0.0, 0.0, lowest],
            [width, width],
            seed,
            |_| true,
            |stones| stones.len() == self.stones_per_layer,
        );
        falling.into_iter().map(Grain::at_rest).collect()
    }

    /// The first layer over the floor.
    fn setup(&self) -> Setup {
        let width = self.width.si();
        let mut setup = Setup::new(self.stone.stuff(), self.layer(&[], 0));
        setup.stuffs.push(Stuff { friction: self.side_friction, ..self.stone.stuff() });
        setup.walls = boxed([0.0, 0.0], [width, width]);
        setup.time_step = self.run.step();
        setup.rolling = self.run.rolling.model();
        setup
    }
}

fn top(bed: &[Grain]) -> f64 {
    bed.iter().map(|grain| grain.sphere.centre[2] + grain.sphere.radius).fold(0.0, f64::max)
}

/// Runs the experiment.
///
/// # Errors
/// When the simulation cannot be made or goes bad, or on request.
pub fn run(spec: &PluviationSpec, running: &Running<'_>) -> Result<Outcome, ExperimentError> {
    spec.check()?;
    let mut bench = Bench::open(NAME, spec, running, || Ok(spec.setup()))?;
    while bench.journal.stage < spec.layers {
        bench.until_rest("raining", &spec.rest)?;
        let stones: Vec<Sphere> = bench.simulation.grains().iter().map(|grain| grain.sphere).collect();
        let layer = bench.journal.stage + 1;
        let row = vec![
            layer as f64,
            bench.time(),
            stones.len() as f64,
            top(&bench.simulation.grains()),
            porosity(&stones, spec.width.si()),
            bench.simulation.coordination_number(),
        ];
        bench.journal.rows.push(row);
        if layer < spec.layers {
            let falling = spec.layer(&bench.simulation.grains(), layer);
            bench.insert(&falling)?;
        }
        bench.next_stage();
    }
    let outcome = read_off(spec, &bench);
    bench.forget();
    Ok(outcome)
}

/// Porosity between 15 % and 75 % of the heights of the centres: away from the floor and from the rough surface.
fn porosity(stones: &[Sphere], width: f64) -> f64 {
    let mut heights: Vec<f64> = stones.iter().map(|stone| stone.centre[2]).collect();
    heights.sort_by(f64::total_cmp);
    let (Some(lowest), Some(highest)) = (heights.first(), heights.last()) else { return f64::NAN };
    let (low, high) = (lowest + 0.15 * (highest - lowest), lowest + 0.75 * (highest - lowest));
    let solid: f64 = stones.iter().map(|stone| stone.volume_between(low, high)).sum();
    1.0 - solid / (width * width * (high - low))
}

fn read_off(spec: &PluviationSpec, bench: &Bench<'_>) -> Outcome {
    let last = bench.journal.rows.last().cloned().unwrap_or_else(|| vec![f64::NAN; 6]);
    let readings = vec![
        Reading::new("stones", "stones", last[2], 0),
        Reading::new("height_m", "height of the highest stone, m", last[3], 4),
        Reading::new("porosity_percent", "porosity inside, %", 100.0 * last[4], 2),
        Reading::new("coordination", "coordination number", last[5], 2),
        Reading::new("time_s", "time simulated, s", last[1], 3),
    ];
    let mut notes = bench.notes();
    notes.extend(spec.stone.softened());
    notes.push("inside: from 15 % to 75 % of the heights of the centres".into());
    let columns = ["layer", "time_s", "stones", "height_m", "porosity", "coordination"].map(String::from).to_vec();
    let stones = bench.simulation.grains().iter().map(|grain| grain.sphere).collect();
    Outcome {
        experiment: NAME.into(),
        readings,
        curve: Curve { columns, rows: bench.journal.rows.clone() },
        notes,
        stones,
    }
}
