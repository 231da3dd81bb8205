//! The lateral resistance of a sleeper in a bed, between mirrors half-way to its neighbours.
//!
//! 1. Stones settle without friction around an auxiliary sleeper that is held a little higher than the real one, between upright
//!    ends. The paper holds the slopes by surfaces that sink with the stones; here the bed is packed level and the stones above
//!    crest and slopes are taken away afterwards, so that nothing presses on the slopes at all.
//! 2. Friction is switched on; the sleeper is let down onto the bed with its weight, and all comes to rest.
//! 3. The sleeper is pushed along x, free to rise and sink; it does not turn.

use serde::{Deserialize, Serialize};

use super::bench::{Bench, RestSpec, Running};
use super::error::ExperimentError;
use super::outcome::{Curve, Outcome, Reading};
use super::placing::strew;
use super::spec::{ExperimentSpec, RunSpec, SizeSpec, StoneSpec, above_zero};
use crate::geometry::Sphere;
use crate::geometry::triangle_mesh::{TriangleMesh, sleeper_block};
use crate::packing::dem::{Grain, Motion, Pairing, Setup, Stuff, Wall};
use crate::units::{Kilograms, Metres, MetresPerSecond, Seconds};

const NAME: &str = "lateral";
/// Index of the sleeper among the walls.
const SLEEPER: usize = 3;
/// The faces, in the order of the columns.
const FACES: [&str; 5] = ["bottom", "shoulder", "crib", "far-end", "top"];
/// Grains of the paper's model.
pub const PAPERS_STONES: usize = 21_708;

/// What the experiment is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LateralSpec {
    /// The stone; the floor is made of it too.
    pub stone: StoneSpec,
    /// The sizes.
    pub sizes: SizeSpec,
    /// How it is run.
    pub run: RunSpec,
    /// The sleeper.
    pub sleeper: SleeperSpec,
    /// The bed.
    pub bed: BedSpec,
    /// How the bed is packed.
    pub packing: GravityPackingSpec,
    /// How the sleeper is pushed.
    pub push: PushSpec,
    /// When stones count as being at rest.
    pub rest: RestSpec,
}

/// The sleeper.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SleeperSpec {
    /// Length, along x.
    pub length: Metres,
    /// Width, along y.
    pub width: Metres,
    /// Height.
    pub height: Metres,
    /// Mass with its share of the rails.
    pub mass: Kilograms,
    /// Friction between it and stones.
    pub friction: f64,
}

/// The bed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BedSpec {
    /// Distance of sleepers, along y.
    pub spacing: Metres,
    /// Depth under the sleeper.
    pub under: Metres,
    /// Width of the crest beyond each end of the sleeper.
    pub shoulder: Metres,
    /// Run of the slopes on one metre of rise.
    pub slope_run: f64,
}

/// Packing without friction under gravity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GravityPackingSpec {
    /// How long stones settle.
    pub time: Seconds,
    /// How much higher the auxiliary sleeper is held.
    pub sleeper_raised: Metres,
    /// Solid share for which stones are strewn; more than they reach, so that the bed is full to its crest.
    pub solid_share: f64,
}

/// The push.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PushSpec {
    /// Speed.
    pub speed: MetresPerSecond,
    /// Distance.
    pub distance: Metres,
    /// Distance between two samples, each the mean over it.
    pub sample: Metres,
}

impl ExperimentSpec for LateralSpec {
    const TEMPLATE: &str = include_str!("../../../templates/experiments/lateral.toml");

    fn check(&self) -> Result<(), ExperimentError> {
        self.sizes.check(NAME)?;
        let (sleeper, bed, push) = (&self.sleeper, &self.bed, &self.push);
        above_zero(
            NAME,
            &[
                ("sleeper.length", sleeper.length.si(), sleeper.length.to_string()),
                ("sleeper.width", sleeper.width.si(), sleeper.width.to_string()),
                ("sleeper.height", sleeper.height.si(), sleeper.height.to_string()),
                ("sleeper.mass", sleeper.mass.si(), sleeper.mass.to_string()),
                ("bed.under", bed.under.si(), bed.under.to_string()),
                ("bed.shoulder", bed.shoulder.si(), bed.shoulder.to_string()),
                ("bed.slope_run", bed.slope_run, bed.slope_run.to_string()),
                ("packing.time", self.packing.time.si(), self.packing.time.to_string()),
                ("packing.sleeper_raised", self.packing.sleeper_raised.si(), self.packing.sleeper_raised.to_string()),
                ("push.speed", push.speed.si(), push.speed.to_string()),
                ("push.distance", push.distance.si(), push.distance.to_string()),
                ("push.sample", push.sample.si(), push.sample.to_string()),
            ],
        )?;
        if !(0.3..=0.74).contains(&self.packing.solid_share) {
            return Err(ExperimentError::OutOfRange {
                experiment: NAME,
                key: "packing.solid_share",
                value: self.packing.solid_share.to_string(),
                limit: "from 0.3 to 0.74".into(),
            });
        }
        let crib = Metres(bed.spacing.si() - sleeper.width.si());
        if crib <= self.sizes.largest {
            let diameter = self.sizes.largest;
            return Err(ExperimentError::NarrowerThanAStone {
                what: "crib between two sleepers",
                width: crib,
                diameter,
            });
        }
        Ok(())
    }
}

impl LateralSpec {
    /// Height of the crest, m: the crib is full.
    fn crest(&self) -> f64 {
        self.bed.under.si() + self.sleeper.height.si()
    }

    /// Half of the bed's width at its foot, m.
    fn toe(&self) -> f64 {
        0.5 * self.sleeper.length.si() + self.bed.shoulder.si() + self.bed.slope_run * self.crest()
    }

    /// Volume of the bed without the sleeper, m³.
    pub fn bulk_volume(&self) -> f64 {
        let crest = 0.5 * self.sleeper.length.si() + self.bed.shoulder.si();
        let section = (crest + self.toe()) * self.crest();
        let sleeper = self.sleeper.length.si() * self.sleeper.width.si() * self.sleeper.height.si();
        section * self.bed.spacing.si() - sleeper
    }

    /// Whether a stone belongs to the bed: its centre is below crest and slopes.
    fn belongs(&self, stone: &Sphere) -> bool {
        let [x, _, z] = stone.centre;
        z < self.crest() && z * self.bed.slope_run < self.toe() - x.abs()
    }

    fn block(&self) -> Result<TriangleMesh, ExperimentError> {
        let (sleeper, low) = (&self.sleeper, self.bed.under.si() + self.packing.sleeper_raised.si());
        let half = [0.5 * sleeper.length.si(), 0.5 * sleeper.width.si()];
        Ok(sleeper_block([-half[0], -half[1], low], [half[0], half[1], low + sleeper.height.si()])?)
    }

    fn setup(&self, stones: Vec<Grain>) -> Result<Setup, ExperimentError> {
        let stone = self.stone.stuff();
        let side = 0.5 * self.bed.spacing.si();
        let mut setup = Setup::new(stone, stones);
        setup.stuffs.push(Stuff { friction: 0.0, rolling_friction: 0.0, ..stone });
        setup.stuffs.push(Stuff { friction: self.sleeper.friction, ..stone });
        setup.pairings = vec![Pairing { materials: [0, 2], friction: Some(self.sleeper.friction), restitution: None }];
        setup.walls = vec![
            Wall::plane([0.0; 3], [0.0, 0.0, 1.0], 0),
            Wall::plane([0.0, -side, 0.0], [0.0, 1.0, 0.0], 1),
            Wall::plane([0.0, side, 0.0], [0.0, -1.0, 0.0], 1),
            Wall::mesh(self.block()?, 2),
        ];
        setup.time_step = self.run.step();
        setup.rolling = self.run.rolling.model();
        setup.domain = [[-20.0, -20.0, -1.0], [20.0, 20.0, 100.0]];
        Ok(setup)
    }

    /// Stones in the air around and above the auxiliary sleeper, between upright ends at the toes.
    fn packing_setup(&self) -> Result<Setup, ExperimentError> {
        let (side, toe) = (0.5 * self.bed.spacing.si(), self.toe());
        let [low, high] = self.block()?.bounds();
        let inside = |stone: &Sphere| {
            let apart = |k: usize| (low[k] - stone.centre[k]).max(stone.centre[k] - high[k]) - stone.radius;
            apart(0).max(apart(1)) > 0.0 || stone.centre[2] + stone.radius < low[2]
        };
        let sleeper: f64 = (0..3).map(|k| high[k] - low[k]).product();
        let wanted = self.packing.solid_share * (2.0 * toe * 2.0 * side * self.crest() - sleeper);
        let mut solid = 0.0;
        let mut counted = 0;
        let stones = strew(&self.sizes, [-toe, -side, 0.0], [toe, side], self.run.seed, inside, |stones| {
            solid += stones[counted..].iter().map(Sphere::volume).sum::<f64>();
            counted = stones.len();
            solid >= wanted
        });
        let mut setup = self.setup(stones.into_iter().map(Grain::at_rest).collect())?;
        setup.friction = false;
        setup.walls.push(Wall::plane([-toe, 0.0, 0.0], [1.0, 0.0, 0.0], 1));
        setup.walls.push(Wall::plane([toe, 0.0, 0.0], [-1.0, 0.0, 0.0], 1));
        Ok(setup)
    }
}

/// Runs the experiment.
///
/// # Errors
/// When the simulation cannot be made or goes bad, or on request.
pub fn run(spec: &LateralSpec, running: &Running<'_>) -> Result<Outcome, ExperimentError> {
    spec.check()?;
    let mut bench = Bench::open(NAME, spec, running, || spec.packing_setup())?;
    let free = |speed: f64| Motion::Free {
        mass: spec.sleeper.mass.si(),
        moves: [false, false, true],
        velocity: [speed, 0.0, 0.0],
        load: [0.0; 3],
    };
    if bench.journal.stage == 0 {
        let time = spec.packing.time.si();
        bench.for_time("settling without friction", time, 0.004 * time, |_| {})?;
        let ratio = bench.energy_ratio();
        bench.journal.memo.insert("energy_ratio_packed".into(), ratio);
        bench.journal.memo.insert("unbalanced_packed".into(), bench.simulation.unbalanced_force_ratio());
        let bed = bench.simulation.grains().into_iter().filter(|grain| spec.belongs(&grain.sphere));
        let bed: Vec<Grain> = bed.map(|grain| Grain::at_rest(grain.sphere)).collect();
        let solid: f64 = bed.iter().map(|grain| grain.sphere.volume()).sum();
        bench.journal.memo.insert("solid_packed".into(), solid);
        bench.rebuild(spec.setup(bed)?)?;
        bench.simulation.set_motion(SLEEPER, free(0.0))?;
        bench.next_stage();
    }
    if bench.journal.stage == 1 {
        bench.until_rest("settling with friction and sleeper", &spec.rest)?;
        let sunk = displacement(&bench);
        bench.journal.memo.insert("sunk".into(), sunk[2]);
        bench.simulation.set_motion(SLEEPER, free(spec.push.speed.si()))?;
        bench.next_stage();
    }
    if bench.journal.stage == 2 {
        push(spec, &mut bench)?;
        bench.next_stage();
    }
    let outcome = read_off(spec, &bench);
    bench.forget();
    Ok(outcome)
}

fn displacement(bench: &Bench<'_>) -> [f64; 3] {
    bench.simulation.wall_state(SLEEPER).map_or([0.0; 3], |state| state.displacement)
}

/// Looks taken in each sample.
const LOOKS: u64 = 20;

fn push(spec: &LateralSpec, bench: &mut Bench<'_>) -> Result<(), ExperimentError> {
    let seconds = spec.push.distance.si() / spec.push.speed.si();
    let look = (bench.count_of(spec.push.sample.si() / spec.push.speed.si()) / LOOKS).max(1);
    let order: Vec<Option<usize>> = {
        let block = spec.block()?;
        FACES.iter().map(|face| block.patches().iter().position(|patch| patch == face)).collect()
    };
    while bench.in_stage() < seconds {
        let mut forces = [0.0; FACES.len()];
        let share = bench.in_stage() / seconds;
        for part in 0..LOOKS {
            if part == 0 {
                bench.steps("pushing", look, share)?;
            } else {
                bench.steps_on("pushing", look, share)?;
            }
            let loads = bench.simulation.wall_loads();
            for (force, patch) in forces.iter_mut().zip(&order) {
                let on = patch.and_then(|patch| loads[SLEEPER].patches.get(patch)).map_or(0.0, |force| force[0]);
                *force -= on / LOOKS as f64;
            }
        }
        let at = displacement(bench);
        let risen = at[2] - bench.journal.memo.get("sunk").copied().unwrap_or(0.0);
        let mut row = vec![1e3 * at[0], forces.iter().sum::<f64>()];
        row.extend(forces);
        row.push(1e3 * risen);
        bench.journal.rows.push(row);
    }
    Ok(())
}

fn read_off(spec: &LateralSpec, bench: &Bench<'_>) -> Outcome {
    let rows = &bench.journal.rows;
    let memo = |key: &str| bench.journal.memo.get(key).copied().unwrap_or(f64::NAN);
    let count = bench.simulation.count();
    let peak = rows.iter().max_by(|a, b| a[1].total_cmp(&b[1])).cloned().unwrap_or_else(|| vec![f64::NAN; 8]);
    let reached = |share: f64| rows.iter().find(|row| row[1] >= share * peak[1]);
    let stiffness = match (reached(0.1), reached(0.5)) {
        (Some(a), Some(b)) if b[0] > a[0] => (b[1] - a[1]) / (b[0] - a[0]),
        _ => f64::NAN,
    };
    let mut readings = vec![
        Reading::new("stones", "stones of the bed", count as f64, 0),
        Reading::new("papers_stones", "stones of the paper's bed", PAPERS_STONES as f64, 0),
        Reading::new("bulk_m3", "volume of the bed without the sleeper, m³", spec.bulk_volume(), 4),
        Reading::new("solid_percent", "solid share of it, %", 100.0 * memo("solid_packed") / spec.bulk_volume(), 2),
        Reading::new("energy_ratio_packed", "energy ratio after packing, 1e-6", 1e6 * memo("energy_ratio_packed"), 3),
        Reading::new("sunk_mm", "sleeper sank by, mm", -1e3 * memo("sunk"), 2),
        Reading::new("peak_kn", "largest lateral force, kN", 1e-3 * peak[1], 3),
        Reading::new("peak_mm", "displacement at that force, mm", peak[0], 2),
        Reading::new("stiffness_kn_per_mm", "stiffness between 10 % and 50 % of it, kN/mm", 1e-3 * stiffness, 3),
    ];
    let window = 5.0 * 1e3 * spec.push.sample.si();
    for at in [0.25, 1.0, 3.0] {
        let near: Vec<_> = rows.iter().filter(|row| (row[0] - at).abs() <= window).collect();
        let sum = |column: usize| near.iter().map(|row| row[column]).sum::<f64>();
        if near.is_empty() || sum(1) <= 0.0 {
            continue;
        }
        for (k, face) in FACES.iter().take(3).enumerate() {
            let share = 100.0 * sum(k + 2) / sum(1);
            readings.push(Reading::new(
                &format!("{face}_percent_at_{at}_mm"),
                &format!("share of {face} at {at} mm, %"),
                share,
                1,
            ));
        }
    }
    let mut notes = bench.notes();
    notes.extend(spec.stone.softened());
    // Shear rate over the depth under the sleeper, against the pressure of its weight.
    let pressure = 9.81 * spec.sleeper.mass.si() / (spec.sleeper.length.si() * spec.sleeper.width.si());
    let inertial = spec.push.speed.si() / spec.bed.under.si()
        * spec.sizes.largest.si()
        * (spec.stone.density.si() / pressure).sqrt();
    notes.push(format!("inertial number of the push {inertial:.1e}; quasi-static below about 1e-3"));
    notes.push("slopes: packed level, then the stones above crest and slopes taken away".into());
    let columns = ["displacement_mm", "force_n"].iter().map(ToString::to_string);
    let columns = columns.chain(FACES.iter().map(|face| format!("{}_n", face.replace('-', "_"))));
    let columns = columns.chain(["risen_mm".to_string()]).collect();
    let stones = bench.simulation.grains().iter().map(|grain| grain.sphere).collect();
    Outcome { experiment: NAME.into(), readings, curve: Curve { columns, rows: rows.clone() }, notes, stones }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 2.025 m² of section over 0.6 m, less 0.13 m³ of sleeper.
    #[test]
    fn the_bed_of_the_template_has_the_volume_worked_out_by_hand() {
        let spec = LateralSpec::read(LateralSpec::TEMPLATE, std::path::Path::new("template")).unwrap();
        assert!((spec.bulk_volume() - (2.025 * 0.6 - 2.5 * 0.26 * 0.2)).abs() < 1e-12);
        assert!(spec.belongs(&Sphere { centre: [2.3, 0.0, 0.02], radius: 0.02 }));
        assert!(!spec.belongs(&Sphere { centre: [2.3, 0.0, 0.1], radius: 0.02 }));
        assert!(!spec.belongs(&Sphere { centre: [0.0, 0.2, 0.51], radius: 0.02 }));
    }
}
