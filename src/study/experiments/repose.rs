//! The angle of repose: stones fall out of a square hopper onto a floor.

use serde::{Deserialize, Serialize};

use super::bench::{Bench, RestSpec, Running};
use super::error::ExperimentError;
use super::outcome::{Curve, Outcome, Reading};
use super::placing::strew;
use super::slope::{self, Slope};
use super::spec::{ExperimentSpec, RunSpec, SizeSpec, StoneSpec, above_zero};
use crate::geometry::Sphere;
use crate::geometry::triangle_mesh::{rectangle, square_hopper};
use crate::packing::dem::{Grain, Motion, Pairing, Setup, Stuff, Wall};
use crate::units::{Metres, MetresPerSecond, Seconds};

const NAME: &str = "repose";
/// Indices of the walls.
const HOPPER: usize = 1;
const GATE: usize = 2;
/// Time between two samples of the flow, s.
const SAMPLE: f64 = 0.02;

/// What the experiment is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReposeSpec {
    /// The stone; floor and hopper are made of it too.
    pub stone: StoneSpec,
    /// The sizes.
    pub sizes: SizeSpec,
    /// How it is run.
    pub run: RunSpec,
    /// How many stones.
    pub stones: usize,
    /// The hopper.
    pub hopper: HopperSpec,
    /// What is done when the flow jams.
    pub arch: ArchSpec,
    /// When stones count as being at rest.
    pub rest: RestSpec,
}

/// The hopper.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HopperSpec {
    /// Side of the square opening.
    pub opening: Metres,
    /// Height of the opening above the floor.
    pub above_floor: Metres,
    /// Side of the square at the top.
    pub top: Metres,
    /// Slope of the walls, degrees from the horizontal.
    pub wall_degrees: f64,
    /// Coefficient of sliding friction of stones on its walls; they do not resist rolling more or less than the floor.
    pub friction: f64,
    /// Speed at which the gate drops away; faster than stones fall.
    pub gate_speed: MetresPerSecond,
}

/// An arch: stones above the opening, none has passed for `still`, and those in the hopper are at rest by the ratio of `[rest]`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArchSpec {
    /// How long nothing passes.
    pub still: Seconds,
    /// How often the hopper is shaken before the rest is given up.
    pub shakes: u32,
    /// Speed of a shake, along x.
    pub shake_speed: MetresPerSecond,
    /// How long it goes each way.
    pub shake_time: Seconds,
}

impl ExperimentSpec for ReposeSpec {
    const TEMPLATE: &str = include_str!("../../../templates/experiments/repose.toml");

    fn check(&self) -> Result<(), ExperimentError> {
        self.sizes.check(NAME)?;
        let hopper = &self.hopper;
        above_zero(
            NAME,
            &[
                ("stones", self.stones as f64, self.stones.to_string()),
                ("hopper.above_floor", hopper.above_floor.si(), hopper.above_floor.to_string()),
                ("hopper.gate_speed", hopper.gate_speed.si(), hopper.gate_speed.to_string()),
                ("arch.still", self.arch.still.si(), self.arch.still.to_string()),
                ("arch.shake_speed", self.arch.shake_speed.si(), self.arch.shake_speed.to_string()),
                ("arch.shake_time", self.arch.shake_time.si(), self.arch.shake_time.to_string()),
            ],
        )?;
        if !(10.0..=89.0).contains(&hopper.wall_degrees) {
            return Err(ExperimentError::OutOfRange {
                experiment: NAME,
                key: "hopper.wall_degrees",
                value: hopper.wall_degrees.to_string(),
                limit: "from 10 to 89".into(),
            });
        }
        if hopper.opening <= self.sizes.largest {
            return Err(ExperimentError::NarrowerThanAStone {
                what: "opening of the hopper",
                width: hopper.opening,
                diameter: self.sizes.largest,
            });
        }
        Ok(())
    }
}

impl ReposeSpec {
    /// Height of the funnel, m.
    fn funnel(&self) -> f64 {
        0.5 * (self.hopper.top.si() - self.hopper.opening.si()) * self.hopper.wall_degrees.to_radians().tan()
    }

    fn strewn(&self) -> Vec<Sphere> {
        let hopper = &self.hopper;
        let (low, half, top) = (hopper.above_floor.si(), 0.5 * hopper.top.si(), self.funnel());
        let (sin, tan) = (hopper.wall_degrees.to_radians().sin(), hopper.wall_degrees.to_radians().tan());
        let inside = |stone: &Sphere| {
            let height = (stone.centre[2] - low).min(top);
            let wall = 0.5 * hopper.opening.si() + height / tan;
            // Beside the sloped wall, and above it within its upper rim.
            stone.centre[..2].iter().all(|at| (wall - at.abs()) * sin > stone.radius)
        };
        // A lattice around the axis, so that the narrow end is not left out.
        strew(&self.sizes, [-half, -half, low], [half, half], self.run.seed, inside, |stones| {
            stones.len() == self.stones
        })
    }

    fn setup(&self) -> Result<Setup, ExperimentError> {
        let hopper = &self.hopper;
        let low = hopper.above_floor.si();
        let axis = [0.0, 0.0, low];
        let funnel = square_hopper(axis, hopper.opening, hopper.top, Metres(self.funnel()), false)?;
        // Wider than the opening, so that no rim of it is near a stone.
        let side = 1.2 * hopper.opening.si();
        let gate = rectangle([-0.5 * side, -0.5 * side, low], [side, 0.0, 0.0], [0.0, side, 0.0])?.named("gate");
        let stones = self.strewn().into_iter().map(Grain::at_rest).collect();
        let stone = self.stone.stuff();
        let mut setup = Setup::new(stone, stones);
        setup.stuffs.push(Stuff { friction: hopper.friction, ..stone });
        setup.pairings = vec![Pairing { materials: [0, 1], friction: Some(hopper.friction), restitution: None }];
        setup.walls = vec![Wall::plane([0.0; 3], [0.0, 0.0, 1.0], 0), Wall::mesh(funnel, 1), Wall::mesh(gate, 1)];
        setup.time_step = self.run.step();
        setup.rolling = self.run.rolling.model();
        setup.domain = [[-20.0, -20.0, -1.0], [20.0, 20.0, 100.0]];
        Ok(setup)
    }
}

/// What became of the stones.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReposeResult {
    /// The slope of the heap; `None` when there is none.
    pub slope: Option<Slope>,
    /// How often the hopper was shaken.
    pub shakes: u32,
    /// Stones that an arch kept in the hopper to the end.
    pub kept_back: usize,
    /// What the command shows.
    pub outcome: Outcome,
}

/// Runs the experiment.
///
/// # Errors
/// When the simulation cannot be made or goes bad, or on request.
pub fn run(spec: &ReposeSpec, running: &Running<'_>) -> Result<ReposeResult, ExperimentError> {
    spec.check()?;
    let mut bench = Bench::open(NAME, spec, running, || spec.setup())?;
    if bench.journal.stage == 0 {
        bench.until_rest("filling the hopper", &spec.rest)?;
        open_gate(spec, &mut bench)?;
        bench.next_stage();
    }
    if bench.journal.stage == 1 {
        flow(spec, &mut bench)?;
        bench.next_stage();
    }
    if bench.journal.stage == 2 {
        bench.until_rest("coming to rest", &spec.rest)?;
        bench.next_stage();
    }
    let result = read_off(spec, &bench);
    bench.forget();
    Ok(result)
}

/// The gate drops through the floor, which it does not feel, to where no stone comes.
fn open_gate(spec: &ReposeSpec, bench: &mut Bench<'_>) -> Result<(), ExperimentError> {
    let (now, speed) = (bench.time(), spec.hopper.gate_speed.si());
    let motion = Motion::Prescribed {
        velocity: [0.0, 0.0, -speed],
        spin: [0.0; 3],
        about: [0.0; 3],
        from: now,
        until: now + (spec.hopper.above_floor.si() + 2.0 * spec.sizes.largest.si()) / speed,
    };
    Ok(bench.simulation.set_motion(GATE, motion)?)
}

/// Until all stones have passed, or the rest is given up.
fn flow(spec: &ReposeSpec, bench: &mut Bench<'_>) -> Result<(), ExperimentError> {
    let stage = "flowing out";
    let slice = bench.count_of(SAMPLE);
    let in_all = bench.simulation.count();
    loop {
        let above = above(spec, bench);
        let last = bench.journal.memo.get("above").copied();
        if last != Some(above as f64) {
            let now = bench.time();
            bench.journal.memo.insert("above".into(), above as f64);
            bench.journal.memo.insert("passed_at".into(), now);
        }
        if above == 0 {
            return Ok(());
        }
        let since = bench.time() - bench.journal.memo.get("passed_at").copied().unwrap_or(0.0);
        if since > spec.arch.still.si() {
            let shakes = bench.journal.memo.get("shakes").copied().unwrap_or(0.0);
            if shakes >= f64::from(spec.arch.shakes) {
                return Ok(());
            }
            bench.journal.memo.insert("shakes".into(), shakes + 1.0);
            shake(spec, bench)?;
            let now = bench.time();
            bench.journal.memo.insert("passed_at".into(), now);
        }
        if bench.in_stage() > spec.rest.within.si() {
            return Err(ExperimentError::NeverEnds {
                stage,
                limit: spec.rest.within.si(),
                what: format!("{above} of {in_all} stones are still in the hopper"),
                hint: "raise `rest.within`",
            });
        }
        bench.steps(stage, slice, 1.0 - above as f64 / in_all as f64)?;
        let row = vec![bench.in_stage(), (in_all - above) as f64, bench.energy_ratio()];
        bench.journal.rows.push(row);
    }
}

/// To and fro, and back to the place: a shake is short and is not stopped half-way.
fn shake(spec: &ReposeSpec, bench: &mut Bench<'_>) -> Result<(), ExperimentError> {
    let steps = bench.count_of(spec.arch.shake_time.si());
    for (sign, times) in [(1.0, 1), (-1.0, 2), (1.0, 1)] {
        let now = bench.time();
        let motion = Motion::Prescribed {
            velocity: [sign * spec.arch.shake_speed.si(), 0.0, 0.0],
            spin: [0.0; 3],
            about: [0.0; 3],
            from: now,
            until: f64::INFINITY,
        };
        bench.simulation.set_motion(HOPPER, motion)?;
        bench.steps_on("shaking", times * steps, 0.0)?;
    }
    Ok(bench.simulation.set_motion(HOPPER, Motion::Fixed)?)
}

/// Stones whose centre is still above the opening.
fn above(spec: &ReposeSpec, bench: &Bench<'_>) -> usize {
    let opening = spec.hopper.above_floor.si();
    bench.simulation.grains().iter().filter(|grain| grain.sphere.centre[2] > opening).count()
}

fn read_off(spec: &ReposeSpec, bench: &Bench<'_>) -> ReposeResult {
    let opening = spec.hopper.above_floor.si();
    let lost: Vec<usize> = bench.simulation.lost().iter().map(|lost| lost.grain).collect();
    let grains = bench.simulation.grains();
    let all = grains.iter().enumerate().filter(|(number, _)| !lost.contains(number));
    let (heap, kept_back): (Vec<Sphere>, Vec<Sphere>) =
        all.map(|(_, grain)| grain.sphere).partition(|stone| stone.centre[2] <= opening);
    let slope = slope::measure(&heap, [0.0; 2]);
    let shakes = bench.journal.memo.get("shakes").map_or(0, |shakes| *shakes as u32);
    let mut readings = vec![Reading::new("stones", "stones on the heap", heap.len() as f64, 0)];
    if let Some(slope) = &slope {
        readings.push(Reading::new("angle_degrees", "angle of repose, degrees", slope.degrees, 2));
        readings.push(Reading::new("spread_degrees", "its standard deviation between sectors", slope.spread, 2));
        let cone = "angle of the cone of the same height and volume, degrees";
        readings.push(Reading::new("cone_degrees", cone, slope.cone_degrees, 2));
        readings.push(Reading::new("height_m", "height of the heap, m", slope.height, 3));
    }
    readings.push(Reading::new("kept_back", "stones kept back by an arch", kept_back.len() as f64, 0));
    readings.push(Reading::new("shakes", "shakes of the hopper", f64::from(shakes), 0));
    readings.push(Reading::new("time_s", "time simulated, s", bench.time(), 3));
    let mut notes = bench.notes();
    notes.extend(spec.stone.softened());
    if !kept_back.is_empty() {
        notes.push(format!("an arch over the opening kept {} stones back: the heap is smaller", kept_back.len()));
    }
    notes.push(
        "angle: lines through the surface between 20 % and 80 % of the height in 8 sectors, floor friction as between stones"
            .into(),
    );
    let curve = Curve {
        columns: ["time_s", "stones_passed", "energy_ratio"].map(String::from).to_vec(),
        rows: bench.journal.rows.clone(),
    };
    let outcome = Outcome { experiment: NAME.into(), readings, curve, notes, stones: heap };
    ReposeResult { slope, shakes, kept_back: kept_back.len(), outcome }
}
