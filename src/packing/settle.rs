//! A bed of spheres that fell into its box: gravitational packing with the discrete elements.

use std::fs;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use rand::SeedableRng as _;
use rand_pcg::Pcg64;

use crate::files::{self, FileError};
use crate::geometry::Sphere;
use crate::units::{KilogramsPerCubicMetre, Metres, Pascals, Seconds, Share};

use super::dem::{DemError, Grain, Setup, Simulation, Stuff, TimeStep, Wall};
use super::error::{PackingError, positive};
use super::grading::{ClassReading, Grading};
use super::spheres::{SphereBed, SphereContact, mean_stone_volume, place_spheres, stone_diameters};

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

impl Default for SettleSpec {
    fn default() -> Self {
        Self {
            density: KilogramsPerCubicMetre(2700.0),
            young: Pascals(1e9),
            poisson: 0.18,
            restitution: 0.4,
            friction: 0.6,
            rolling_friction: 0.25,
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
    /// `fall, without friction` or `rest, with friction`.
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

/// Why a bed did not settle.
#[derive(Debug, thiserror::Error)]
pub enum SettleError {
    /// The stones cannot be had.
    #[error(transparent)]
    Packing(#[from] PackingError),
    /// The motion failed.
    #[error(transparent)]
    Dem(#[from] DemError),
    /// The caller asked to stop.
    #[error("stopped on request")]
    Stopped,
    /// The state to go on from could not be kept or read.
    #[error(transparent)]
    File(#[from] FileError),
    /// A ratio or a time that is not above zero.
    #[error("`packing.dem.{key}` is {value}, but must be above 0")]
    NotAboveZero {
        /// Key in the scene file.
        key: &'static str,
        /// What it is.
        value: f64,
    },
}

/// Solid share that frictionless stones reach at most: as many as that are dropped, and what stands above is struck off.
const DENSEST: f64 = 0.64;
/// Simulated time between two looks at the energy, s.
const LOOK: f64 = 0.01;

/// Settles a bed: draws stones by mass from the grading, places them loosely in a column above the floor, lets them fall without
/// friction (which packs them densely), strikes off those whose centres lie above the bed's height (unless their number was given),
/// and lets the rest come to rest with friction.
///
/// Where there is a folder to `keep` things in, a run that is stopped leaves its state there ([`STATE`], [`STAGE`]); a later call
/// with the same input and seed goes on from it, to the same bits, and removes it when the bed is done.
///
/// The same input and seed give the same bed, bit for bit, on any number of threads.
///
/// # Errors
/// See [`SettleError`]; `Stopped` when `on_progress` asks for it.
pub fn settle(
    input: &SettleInput,
    seed: u64,
    threads: NonZeroUsize,
    keep: Option<&Path>,
    on_progress: &dyn Fn(Settling) -> ControlFlow<()>,
) -> Result<Settled, SettleError> {
    let how = &input.how;
    for (key, value) in [
        ("energy_ratio", how.energy_ratio),
        ("unbalanced_ratio", how.unbalanced_ratio),
        ("longest", how.longest.si()),
        ("column", how.column.si()),
    ] {
        if value.is_nan() || value <= 0.0 {
            return Err(SettleError::NotAboveZero { key, value });
        }
    }
    let mut place = Place { input, seed, threads, keep, on_progress, before: Vec::new() };
    let kept_state = place.read();
    let limit = if how.stones.is_some() { f64::INFINITY } else { input.size[2].si() };
    let (mut simulation, name) = match kept_state {
        Some((simulation, before)) => {
            let name = if before.is_empty() { FALL } else { REST };
            place.before = before;
            (simulation, name)
        }
        None => (begin(input, loose_column(input, seed)?, false, threads)?, FALL),
    };
    if name == FALL {
        let fallen = place.run(FALL, &mut simulation)?;
        let (kept, above): (Vec<Sphere>, Vec<Sphere>) = fallen.spheres.iter().partition(|s| s.centre[2] <= limit);
        place.before = vec![Before { stage: fallen.stage, struck_off: above.len(), lost: fallen.lost }];
        simulation = begin(input, kept, true, threads)?;
    }
    let rested = place.run(REST, &mut simulation)?;
    place.remove()?;
    let Some(fallen) = place.before.pop() else { return Err(SettleError::Stopped) };
    let mut bed = SphereBed::new("dem", Some(seed), input.size, rested.spheres);
    bed.periodic = input.periodic;
    bed.contacts = rested.contacts;
    Ok(Settled {
        bed,
        struck_off: fallen.struck_off,
        lost: fallen.lost + rested.lost,
        time_step: rested.time_step,
        stages: vec![fallen.stage.clone(), rested.stage],
    })
}

/// The stones in a column over the floor, none touching another.
fn loose_column(input: &SettleInput, seed: u64) -> Result<Vec<Sphere>, PackingError> {
    let length = positive("length of the box", input.size[0])?;
    let width = positive("width of the box", input.size[1])?;
    let height = positive("height of the bed", input.size[2])?;
    let classes = input.grading.classes(input.class_reading)?;
    let largest = classes.iter().map(|class| class.largest.si()).fold(0.0, f64::max);
    let dropped = length * width * (height + 0.5 * largest) * DENSEST;
    let count = input.how.stones.unwrap_or((dropped / mean_stone_volume(&classes)).round() as usize).max(1);
    let mut random = Pcg64::seed_from_u64(seed);
    let diameters = stone_diameters(&classes, count, &mut random);
    let volume: f64 = diameters.iter().map(|d| std::f64::consts::PI / 6.0 * d.powi(3)).sum();
    let column = (volume / (length * width * input.how.column.si())).max(2.0 * largest);
    place_spheres(diameters, [input.size[0], input.size[1], Metres(column)], input.periodic, &mut random)
}

/// The end of a stage.
struct Ended {
    spheres: Vec<Sphere>,
    contacts: Vec<SphereContact>,
    lost: usize,
    time_step: Seconds,
    stage: Stage,
}

/// Name of the first stage.
const FALL: &str = "fall, without friction";
/// Name of the second stage.
const REST: &str = "rest, with friction";

/// Name of the file with the state of a bed that was stopped.
pub const STATE: &str = "settling.state";
/// Name of the file that says what the state belongs to.
pub const STAGE: &str = "settling.json";

/// A stage that is over.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
struct Before {
    stage: Stage,
    struck_off: usize,
    lost: usize,
}

/// What a kept state belongs to.
#[derive(Debug, serde::Serialize, serde::Deserialize)]
struct Kept {
    format_version: u32,
    input: serde_json::Value,
    seed: u64,
    before: Vec<Before>,
}

/// A bed that is being settled.
struct Place<'a> {
    input: &'a SettleInput,
    seed: u64,
    threads: NonZeroUsize,
    keep: Option<&'a Path>,
    on_progress: &'a dyn Fn(Settling) -> ControlFlow<()>,
    before: Vec<Before>,
}

impl Place<'_> {
    fn kept(&self) -> Kept {
        let input = serde_json::to_value(self.input).unwrap_or_default();
        Kept { format_version: 1, input, seed: self.seed, before: self.before.clone() }
    }

    /// The state that was kept of the same bed, with the stages before it.
    fn read(&self) -> Option<(Simulation, Vec<Before>)> {
        let folder = self.keep?;
        let kept: Kept = serde_json::from_str(&fs::read_to_string(folder.join(STAGE)).ok()?).ok()?;
        let own = self.kept();
        let same = kept.format_version == own.format_version && kept.input == own.input && kept.seed == own.seed;
        let simulation = Simulation::load(&folder.join(STATE)).ok().filter(|_| same)?;
        Some((simulation, kept.before))
    }

    fn write(&self, simulation: &Simulation) -> Result<(), SettleError> {
        let Some(folder) = self.keep else { return Ok(()) };
        files::create_folder(folder)?;
        simulation.save(&folder.join(STATE))?;
        let text = serde_json::to_string_pretty(&self.kept()).unwrap_or_default();
        Ok(files::write_bytes(&folder.join(STAGE), text.as_bytes())?)
    }

    fn remove(&self) -> Result<(), SettleError> {
        for path in self.keep.iter().flat_map(|folder| [folder.join(STATE), folder.join(STAGE)]) {
            if path.exists() {
                fs::remove_file(&path).map_err(FileError::of("remove", &path))?;
            }
        }
        Ok(())
    }

    fn run(&self, name: &'static str, simulation: &mut Simulation) -> Result<Ended, SettleError> {
        let run = Run { place: self, name, clock: Instant::now() };
        run.to_rest(simulation)
    }
}

/// Stones at rest where they are, in their box, after one step: stones that lie pressed on each other hold energy that the
/// watchdog knows after a step only, and a switch makes it begin anew.
fn begin(
    input: &SettleInput,
    spheres: Vec<Sphere>,
    friction: bool,
    threads: NonZeroUsize,
) -> Result<Simulation, SettleError> {
    let mut simulation = Simulation::new(setup(input, spheres, friction))?;
    simulation.run_quietly(1, threads)?;
    simulation.set_friction(friction);
    Ok(simulation)
}

/// One stage on its way.
struct Run<'a> {
    place: &'a Place<'a>,
    name: &'static str,
    clock: Instant,
}

impl Run<'_> {
    fn to_rest(&self, simulation: &mut Simulation) -> Result<Ended, SettleError> {
        let (input, how, stones) = (self.place.input, &self.place.input.how, simulation.count());
        let grains = simulation.grains();
        // What lifts every stone by the mean diameter, J.
        let mass: f64 = grains.iter().map(|grain| grain.sphere.volume() * how.density.si()).sum();
        let mean = grains.iter().map(|grain| 2.0 * grain.sphere.radius).sum::<f64>() / stones.max(1) as f64;
        let lift = mass * 9.81 * mean;
        let dt = simulation.step_length().seconds;
        let most = (how.longest.si() / dt).ceil() as u64;
        let chunk = ((LOOK / dt).round() as u64).max(1);
        // Nothing is at rest before a stone could have fallen from the column's top.
        let volume: f64 = grains.iter().map(|grain| grain.sphere.volume()).sum();
        let column = volume / (input.size[0].si() * input.size[1].si() * how.column.si());
        let earliest = if self.name == FALL { ((2.0 * column / 9.81).sqrt() / dt) as u64 } else { 0 };
        let (mut energy_ratio, mut unbalanced_ratio, mut at_rest) = (f64::INFINITY, 1.0, false);
        while simulation.step() < most && !at_rest {
            let of_longest = simulation.step() as f64 / most as f64;
            let now = Settling { stage: self.name, of_longest, energy_ratio, unbalanced_ratio };
            if (self.place.on_progress)(now).is_break() {
                self.place.write(simulation)?;
                return Err(SettleError::Stopped);
            }
            simulation.run_quietly(chunk.min(most - simulation.step()), self.place.threads)?;
            energy_ratio = simulation.kinetic_energy() / lift;
            unbalanced_ratio = simulation.unbalanced_force_ratio();
            let low = energy_ratio < how.energy_ratio && unbalanced_ratio < how.unbalanced_ratio;
            at_rest = simulation.step() > earliest && low;
        }
        Ok(self.ended(simulation, (energy_ratio, unbalanced_ratio, at_rest)))
    }

    fn ended(&self, simulation: &Simulation, (energy_ratio, unbalanced_ratio, at_rest): (f64, f64, bool)) -> Ended {
        let (input, stones, dt) = (self.place.input, simulation.count(), simulation.step_length().seconds);
        let lost: Vec<usize> = (0..stones).filter(|number| simulation.grain(*number).is_none()).collect();
        let mut place = vec![u32::MAX; stones];
        let mut left = Vec::with_capacity(stones);
        for (number, place) in place.iter_mut().enumerate() {
            if let Some(grain) = simulation.grain(number) {
                *place = left.len() as u32;
                left.push(within_period(grain.sphere, input));
            }
        }
        let contacts = simulation
            .contacts()
            .iter()
            .map(|contact| SphereContact {
                first: place[contact.grains[0]],
                second: place[contact.grains[1]],
                normal_force: contact.normal_force,
            })
            .collect();
        Ended {
            spheres: left,
            contacts,
            lost: lost.len(),
            time_step: Seconds(dt),
            stage: Stage {
                name: self.name.into(),
                stones,
                steps: simulation.step(),
                simulated_seconds: simulation.step() as f64 * dt,
                wall_seconds: self.clock.elapsed().as_secs_f64(),
                energy_ratio,
                unbalanced_ratio,
                at_rest,
            },
        }
    }
}

/// The sphere with its centre in the box along the directions in which the bed repeats itself.
fn within_period(sphere: Sphere, input: &SettleInput) -> Sphere {
    let mut centre = sphere.centre;
    for ((at, size), periodic) in centre.iter_mut().zip(input.size).zip(input.periodic) {
        if periodic {
            *at = at.rem_euclid(size.si());
        }
    }
    Sphere { centre, ..sphere }
}

/// Floor, walls where the bed does not repeat itself, and the stones at rest.
fn setup(input: &SettleInput, spheres: Vec<Sphere>, friction: bool) -> Setup {
    let how = &input.how;
    let stuff = Stuff {
        density: how.density.si(),
        young: how.young.si(),
        poisson: how.poisson,
        restitution: how.restitution,
        friction: how.friction,
        rolling_friction: how.rolling_friction,
    };
    let mut setup = Setup::new(stuff, spheres.into_iter().map(Grain::at_rest).collect());
    setup.friction = friction;
    setup.time_step = TimeStep::ShareOfRayleigh(how.time_step.si());
    setup.walls.push(Wall::plane([0.0; 3], [0.0, 0.0, 1.0], 0));
    for axis in 0..2 {
        let far = input.size[axis].si();
        if input.periodic[axis] {
            setup.periodic[axis] = Some([0.0, far]);
            continue;
        }
        for (at, inwards) in [(0.0, 1.0), (far, -1.0)] {
            let (mut point, mut normal) = ([0.0; 3], [0.0; 3]);
            (point[axis], normal[axis]) = (at, inwards);
            setup.walls.push(Wall::plane(point, normal, 0));
        }
    }
    setup
}
