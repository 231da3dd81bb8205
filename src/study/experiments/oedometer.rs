//! A plate presses stones in a box and is drawn back: stress over strain, and the stress on the sides.

use serde::{Deserialize, Serialize};

use super::bench::{Bench, RestSpec, Running};
use super::error::ExperimentError;
use super::outcome::{Curve, Outcome, Reading};
use super::placing::strew;
use super::spec::{ExperimentSpec, RunSpec, SizeSpec, StoneSpec, above_zero};
use crate::packing::dem::{Grain, Motion, Setup, Stuff, Wall};
use crate::units::{Metres, MetresPerSecond, Pascals};

const NAME: &str = "oedometer";
/// Indices of the walls: floor, four sides, plate.
const SIDES: std::ops::RangeInclusive<usize> = 1..=4;
const PLATE: usize = 5;
/// Gap that the plate keeps above the highest stone before it presses, m.
const CLEAR: f64 = 2e-4;

/// What the experiment is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OedometerSpec {
    /// The stone; floor and plate are made of it too.
    pub stone: StoneSpec,
    /// The sizes.
    pub sizes: SizeSpec,
    /// How it is run.
    pub run: RunSpec,
    /// How many stones.
    pub stones: usize,
    /// Side of the square box.
    pub width: Metres,
    /// Friction between stones and the sides of the box.
    pub side_friction: f64,
    /// Whether stones have friction while they settle; without they pack densely.
    pub friction_while_settling: bool,
    /// Speed of the plate.
    pub plate_speed: MetresPerSecond,
    /// Stress up to which it presses.
    pub stress: Pascals,
    /// When stones count as being at rest.
    pub rest: RestSpec,
}

impl ExperimentSpec for OedometerSpec {
    const TEMPLATE: &str = include_str!("../../../templates/experiments/oedometer.toml");

    fn check(&self) -> Result<(), ExperimentError> {
        self.sizes.check(NAME)?;
        above_zero(
            NAME,
            &[
                ("stones", self.stones as f64, self.stones.to_string()),
                ("plate_speed", self.plate_speed.si(), self.plate_speed.to_string()),
                ("stress", self.stress.si(), self.stress.to_string()),
            ],
        )?;
        if self.width.si() < 2.0 * self.sizes.largest.si() {
            return Err(ExperimentError::NarrowerThanAStone {
                what: "box",
                width: self.width,
                diameter: self.sizes.largest,
            });
        }
        Ok(())
    }
}

impl OedometerSpec {
    fn setup(&self) -> Setup {
        let width = self.width.si();
        let stones =
            strew(&self.sizes, [0.0; 3], [width, width], self.run.seed, |_| true, |stones| stones.len() == self.stones);
        let top = stones.iter().map(|stone| stone.centre[2] + stone.radius).fold(0.0, f64::max);
        let mut setup = Setup::new(self.stone.stuff(), stones.into_iter().map(Grain::at_rest).collect());
        setup.stuffs.push(Stuff { friction: self.side_friction, ..self.stone.stuff() });
        setup.walls = boxed([0.0, 0.0], [width, width]);
        setup.walls.push(Wall::plane([0.0, 0.0, top + 0.01], [0.0, 0.0, -1.0], 0));
        setup.friction = self.friction_while_settling;
        setup.time_step = self.run.step();
        setup.rolling = self.run.rolling.model();
        setup
    }
}

/// A floor of material 0 at z = 0 and four sides of material 1.
pub(super) fn boxed(low: [f64; 2], high: [f64; 2]) -> Vec<Wall> {
    vec![
        Wall::plane([0.0; 3], [0.0, 0.0, 1.0], 0),
        Wall::plane([low[0], 0.0, 0.0], [1.0, 0.0, 0.0], 1),
        Wall::plane([high[0], 0.0, 0.0], [-1.0, 0.0, 0.0], 1),
        Wall::plane([0.0, low[1], 0.0], [0.0, 1.0, 0.0], 1),
        Wall::plane([0.0, high[1], 0.0], [0.0, -1.0, 0.0], 1),
    ]
}

/// Height of the plate, m.
fn height(bench: &Bench<'_>) -> f64 {
    let at = bench.simulation.wall(PLATE).and_then(|wall| match wall.shape {
        crate::packing::dem::WallShape::Plane { point, .. } => bench.simulation.wall_point(PLATE, point),
        _ => None,
    });
    at.map_or(f64::NAN, |at| at[2])
}

fn move_plate(bench: &mut Bench<'_>, speed: f64) -> Result<(), ExperimentError> {
    let motion = Motion::Prescribed {
        velocity: [0.0, 0.0, speed],
        spin: [0.0; 3],
        about: [0.0; 3],
        from: 0.0,
        until: f64::INFINITY,
    };
    Ok(bench.simulation.set_motion(PLATE, motion)?)
}

/// Runs the experiment.
///
/// # Errors
/// When the simulation cannot be made or goes bad, or on request.
pub fn run(spec: &OedometerSpec, running: &Running<'_>) -> Result<Outcome, ExperimentError> {
    spec.check()?;
    let mut bench = Bench::open(NAME, spec, running, || Ok(spec.setup()))?;
    if bench.journal.stage == 0 {
        bench.until_rest("settling", &spec.rest)?;
        bench.simulation.set_friction(true);
        bench.next_stage();
    }
    if bench.journal.stage == 1 {
        bench.until_rest("settling with friction", &spec.rest)?;
        let grains = bench.simulation.grains();
        let top = grains.iter().map(|g| g.sphere.centre[2] + g.sphere.radius).fold(0.0, f64::max);
        let way = height(&bench) - top - CLEAR;
        bench.journal.memo.insert("top".into(), top);
        // Down to the stones in a tenth of a second, whatever the way; nothing is in it.
        move_plate(&mut bench, -way / 0.1)?;
        bench.next_stage();
    }
    if bench.journal.stage == 2 {
        bench.for_time("lowering the plate", 0.1, 0.01, |_| {})?;
        move_plate(&mut bench, -spec.plate_speed.si())?;
        bench.next_stage();
    }
    let area = spec.width.si().powi(2);
    if bench.journal.stage == 3 {
        press(spec, &mut bench, "pressing", |stress| stress >= spec.stress.si())?;
        move_plate(&mut bench, spec.plate_speed.si())?;
        bench.next_stage();
    }
    if bench.journal.stage == 4 {
        press(spec, &mut bench, "drawing back", |stress| stress <= 0.01 * spec.stress.si())?;
        bench.next_stage();
    }
    let outcome = read_off(spec, &bench, area);
    bench.forget();
    Ok(outcome)
}

/// Moves the plate and takes samples until its stress (Pa) says so.
fn press(
    spec: &OedometerSpec,
    bench: &mut Bench<'_>,
    stage: &'static str,
    done: impl Fn(f64) -> bool,
) -> Result<(), ExperimentError> {
    let area = spec.width.si().powi(2);
    // A sample every 10 µm, at least every 200 steps, as the mean of five.
    let slice = (bench.count_of(1e-5 / spec.plate_speed.si()) / 5).clamp(1, 200);
    let top = bench.journal.memo.get("top").copied().unwrap_or(0.0);
    loop {
        let mut means = [0.0; 3];
        for part in 0..5 {
            if part == 0 {
                bench.steps(stage, slice, 0.0)?;
            } else {
                bench.steps_on(stage, slice, 0.0)?;
            }
            let loads = bench.simulation.wall_loads();
            let side = |wall: usize| loads[wall].force[0].hypot(loads[wall].force[1]);
            means[0] += 0.2 * loads[PLATE].force[2] / area;
            means[1] += 0.05 * SIDES.map(side).sum::<f64>() / (spec.width.si() * height(bench));
            means[2] += 0.2 * -loads[0].force[2] / area;
        }
        let strain = (top - height(bench)) / top;
        bench.journal.rows.push(vec![strain, means[0], means[1], means[2]]);
        if done(means[0]) {
            return Ok(());
        }
        if !(-0.01..=0.3).contains(&strain) {
            return Err(ExperimentError::NeverEnds {
                stage,
                limit: bench.in_stage(),
                what: format!("strain {strain:.3}, stress {:.1} kPa", 1e-3 * means[0]),
                hint: "ask for a lower `stress`, or for more stones",
            });
        }
    }
}

fn read_off(spec: &OedometerSpec, bench: &Bench<'_>, area: f64) -> Outcome {
    let rows = &bench.journal.rows;
    let top = bench.journal.memo.get("top").copied().unwrap_or(f64::NAN);
    let solid: f64 = bench.simulation.grains().iter().map(|grain| grain.sphere.volume()).sum();
    let peak = rows.iter().enumerate().max_by(|a, b| a.1[1].total_cmp(&b.1[1])).map_or(0, |(at, _)| at);
    let loading = &rows[..=peak.min(rows.len().saturating_sub(1))];
    let at = |share: f64| loading.iter().find(|row| row[1] >= share * spec.stress.si());
    let modulus = match (at(0.25), at(0.75)) {
        (Some(a), Some(b)) if b[0] > a[0] => (b[1] - a[1]) / (b[0] - a[0]),
        _ => f64::NAN,
    };
    let most = rows.get(peak).cloned().unwrap_or_else(|| vec![f64::NAN; 4]);
    let left = rows.last().map_or(f64::NAN, |row| row[0]);
    let readings = vec![
        Reading::new("stones", "stones", bench.simulation.count() as f64, 0),
        Reading::new("height_m", "height before pressing, to the highest stone, m", top, 4),
        Reading::new("porosity_percent", "porosity up to that height, %", 100.0 * (1.0 - solid / (area * top)), 2),
        Reading::new("stress_kpa", "largest stress, kPa", 1e-3 * most[1], 2),
        Reading::new("strain_percent", "strain at that stress, %", 100.0 * most[0], 3),
        Reading::new("strain_left_percent", "strain left when drawn back, %", 100.0 * left, 3),
        Reading::new(
            "modulus_mpa",
            "modulus between a quarter and three quarters of the stress, MPa",
            1e-6 * modulus,
            3,
        ),
        Reading::new("side_ratio", "stress on the sides over that of the plate at its largest", most[2] / most[1], 3),
        Reading::new("coordination", "coordination number at the end", bench.simulation.coordination_number(), 2),
    ];
    let mut notes = bench.notes();
    notes.extend(spec.stone.softened());
    let columns = ["strain", "stress_pa", "side_stress_pa", "floor_stress_pa"].map(String::from).to_vec();
    let stones = bench.simulation.grains().iter().map(|grain| grain.sphere).collect();
    Outcome { experiment: NAME.into(), readings, curve: Curve { columns, rows: rows.clone() }, notes, stones }
}
