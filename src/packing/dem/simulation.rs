//! A simulation: made from a set-up, run step by step, asked for what it has come to.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use super::DemError;
use super::bodies::Body;
use super::cells::Period;
use super::check;
use super::grains::Grains;
use super::law::{Laws, Rolling};
use super::mesh_grid::MeshGrid;
use super::pairs::{Needs, Pairs};
use super::rebuild::Lost;
use super::segment::{self, End, Work, per_contact};
use super::setup::{Grain, Limits, Motion, Setup, TimeStep};
use super::shared::Shared;
use super::stuff::{Pairing, Stuff};
use super::time_step::{self, StepLength};
use super::vector::{Four, norm};
use super::wall_contacts::WallContacts;
use super::watch::Watch;
use crate::units::Seconds;

/// Least estimated work of a step for which a thread is taken, ns. Two threads meet twice in a step, which takes a microsecond where
/// both have a core and many where they have not: 5,000 stones in free fall, 30 µs a step, went a third as fast on two as on one.
const LEAST_WORK: f64 = 40e3;
/// Steps between two looks of the watchdog at the energy.
const STEPS_BETWEEN_LOOKS: u64 = 256;
/// Time between two calls of `on_progress`.
const PROGRESS_INTERVAL: Duration = Duration::from_millis(100);
/// Share of the smallest radius that a grain may travel in a step.
const MOST_TRAVEL: f64 = 0.1;

/// Grains in the middle of their motion.
///
/// The same set-up gives the same bits on any number of threads, however the steps are split into calls, and after
/// [`save`](Self::save) and [`load`](Self::load).
#[derive(Debug, Clone)]
pub struct Simulation {
    pub(super) stuffs: Vec<Stuff>,
    pub(super) pairings: Vec<Pairing>,
    pub(super) laws: Laws,
    pub(super) gravity: [f64; 3],
    pub(super) periodic: [Option<[f64; 2]>; 2],
    pub(super) domain: [[f64; 3]; 2],
    pub(super) limits: Limits,
    /// As asked for; what is done is told by `effective_friction`.
    pub(super) friction: bool,
    /// As asked for; what is done is told by `effective_rolling`.
    pub(super) rolling: Rolling,
    pub(super) length: StepLength,
    pub(super) grains: Grains,
    pub(super) pairs: Pairs,
    pub(super) walls: WallContacts,
    pub(super) bodies: Vec<Body>,
    /// Which triangles are near a place, for each wall; and up to which distance, m.
    pub(super) mesh_grids: Vec<MeshGrid>,
    pub(super) mesh_reach: f64,
    pub(super) list: ListState,
    pub(super) step: u64,
    pub(super) lost: Vec<Lost>,
    pub(super) watch: Watch,
    /// The turn of each grain by its number; `u32::MAX` of the lost.
    pub(super) turns: Vec<u32>,
    /// Torque of the rolling friction of each grain, where it is kept.
    pub(super) rolling_torque: Vec<Four>,
    pub(super) keep_rolling_torque: bool,
    /// How many grains there were at the start.
    pub(super) count: usize,
    /// Radii of all grains: least and greatest, m.
    pub(super) radii: [f64; 2],
    /// See [`set_least_work`](Self::set_least_work), ns.
    pub(super) least_work: f64,
}

/// How old the list of near pairs is.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct ListState {
    /// Distance up to which the list was complete when it was made, m.
    pub skin: f64,
    /// Step at which it was made.
    pub made_at: u64,
    /// Bound of the travel of any grain since, m.
    pub travel: f64,
    /// Bound of the travel of any point of a wall since, m.
    pub body_travel: f64,
    /// Where the grains were.
    pub place: Vec<Four>,
}

/// What a run tells while it goes on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Steps made since the set-up.
    pub step: u64,
    /// Steps of this call still to make.
    pub to_go: u64,
    /// Time since the start.
    pub time: Seconds,
    /// Kinetic energy of the grains, J.
    pub kinetic_energy: f64,
    /// See [`Simulation::unbalanced_force_ratio`].
    pub unbalanced_force_ratio: f64,
    /// Grains that have left the domain.
    pub lost: usize,
}

impl Simulation {
    /// Checks a set-up and makes the first list of neighbours.
    ///
    /// # Errors
    /// When a property, a size or the time step is out of range, or grains overlap deeply.
    pub fn new(setup: Setup) -> Result<Self, DemError> {
        check::check(&setup)?;
        let length = time_step::settle(setup.time_step, &setup.grains, &setup.stuffs)?;
        let radius = |pick: fn(f64, f64) -> f64, from| setup.grains.iter().map(|g| g.sphere.radius).fold(from, pick);
        let radii = [radius(f64::min, f64::INFINITY), radius(f64::max, 0.0)];
        let mut made = Self {
            laws: Laws::new(&setup.stuffs, &setup.pairings),
            grains: Grains::new(&setup.grains, &setup.stuffs),
            count: setup.grains.len(),
            stuffs: setup.stuffs,
            pairings: setup.pairings,
            gravity: setup.gravity,
            periodic: setup.periodic,
            domain: setup.domain,
            limits: setup.limits,
            friction: setup.friction,
            rolling: setup.rolling,
            length,
            bodies: setup.walls.into_iter().map(Body::new).collect(),
            radii,
            ..Self::empty()
        };
        made.pairs = Pairs::new(vec![0; made.grains.len() + 1], vec![], made.needs());
        made.walls = WallContacts::new(&[], &[], &[], 0.0);
        made.first_list();
        made.check_overlaps(0)?;
        made.begin_watch();
        Ok(made)
    }

    /// A simulation of nothing, to be filled from a file.
    pub(super) fn empty() -> Self {
        Self {
            stuffs: vec![],
            pairings: vec![],
            laws: Laws::default(),
            gravity: [0.0; 3],
            periodic: [None, None],
            domain: [[0.0; 3]; 2],
            limits: Limits::default(),
            friction: false,
            rolling: Rolling::None,
            length: StepLength { seconds: 0.0, rayleigh: 0.0, grain: 0, contact: 0.0 },
            grains: Grains::default(),
            pairs: Pairs::default(),
            walls: WallContacts::default(),
            bodies: vec![],
            mesh_grids: vec![],
            mesh_reach: 0.0,
            list: ListState::default(),
            step: 0,
            lost: vec![],
            watch: Watch::default(),
            turns: vec![],
            rolling_torque: vec![],
            keep_rolling_torque: false,
            count: 0,
            radii: [0.0; 2],
            least_work: LEAST_WORK,
        }
    }

    /// Makes `steps` steps on at most `threads` threads, fewer where a step is too little work (see
    /// [`set_least_work`](Self::set_least_work)). `on_progress` is called some ten times a second and may stop the
    /// run between two steps; it goes on with the next call.
    ///
    /// # Errors
    /// When a grain is too fast, a contact too deep or the energy grows without a source, each with the step and the
    /// grain; when `on_progress` asks to stop.
    pub fn run(
        &mut self,
        steps: u64,
        threads: NonZeroUsize,
        on_progress: &dyn Fn(&Progress) -> ControlFlow<()>,
    ) -> Result<(), DemError> {
        let goal = self.step + steps;
        let mut last = Instant::now();
        while self.step < goal {
            let look = STEPS_BETWEEN_LOOKS - self.step % STEPS_BETWEEN_LOOKS;
            let end = self.segment(look.min(goal - self.step), threads);
            self.take(end)?;
            if self.step.is_multiple_of(STEPS_BETWEEN_LOOKS) {
                self.look_at_energy()?;
            }
            if end.list_is_old(self.list.skin) {
                self.renew_list_if_old();
            }
            if last.elapsed() >= PROGRESS_INTERVAL {
                last = Instant::now();
                if on_progress(&self.progress(goal - self.step)).is_break() {
                    return Err(DemError::Stopped { step: self.step });
                }
            }
        }
        Ok(())
    }

    /// Makes steps without telling anybody.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn run_quietly(&mut self, steps: u64, threads: NonZeroUsize) -> Result<(), DemError> {
        self.run(steps, threads, &|_| ControlFlow::Continue(()))
    }

    fn progress(&self, to_go: u64) -> Progress {
        Progress {
            step: self.step,
            to_go,
            time: self.time(),
            kinetic_energy: self.kinetic_energy(),
            unbalanced_force_ratio: self.unbalanced_force_ratio(),
            lost: self.lost.len(),
        }
    }

    /// Steps until a look is due, the list is old or something is wrong.
    fn segment(&mut self, steps: u64, threads: NonZeroUsize) -> End {
        self.rolling_torque.resize(if self.keep_rolling_torque { self.grains.len() } else { 0 }, Four::default());
        let (friction, rolling) = (self.effective_friction(), self.effective_rolling());
        let wall_rolling_friction: Vec<f64> =
            self.bodies.iter().map(|body| self.stuffs[body.wall.material].rolling_friction).collect();
        let threads = self.worthwhile(threads.get());
        let begin = End {
            steps: 0,
            travel: self.list.travel,
            body_travel: self.list.body_travel,
            work: 0.0,
            notice: super::kernel::Notice::NONE,
        };
        let work = Work {
            place: Shared::new(&mut self.grains.place),
            velocity: Shared::new(&mut self.grains.velocity),
            spin: Shared::new(&mut self.grains.spin),
            rolling_torque: Shared::new(&mut self.rolling_torque),
            material: &self.grains.material,
            starts: &self.pairs.starts,
            partner: &self.pairs.partner,
            incoming_starts: &self.pairs.incoming_starts,
            incoming: &self.pairs.incoming,
            touching: Shared::new(&mut self.pairs.touching),
            history: Shared::new(&mut self.pairs.history),
            rolling_history: Shared::new(&mut self.pairs.rolling),
            force: Shared::new(&mut self.pairs.force),
            moment: Shared::new(&mut self.pairs.moment),
            resistance: Shared::new(&mut self.pairs.resistance),
            wall_starts: &self.walls.starts,
            wall_grain: &self.walls.grain,
            wall_wall: &self.walls.wall,
            triangle_starts: &self.walls.triangle_starts,
            triangles: &self.walls.triangles,
            slot_starts: &self.walls.slot_starts,
            slots: Shared::new(&mut self.walls.slots),
            wall_force: Shared::new(&mut self.walls.force),
            wall_torque: Shared::new(&mut self.walls.torque),
            of_moving: &self.walls.of_moving,
            bodies: Shared::new(&mut self.bodies),
            wall_rolling_friction: &wall_rolling_friction,
            laws: &self.laws,
            period: Period::new(self.periodic),
            rolling,
            friction,
            gravity: self.gravity,
            dt: self.length.seconds,
            too_fast: MOST_TRAVEL * self.radii[0] / self.length.seconds,
            too_deep: self.limits.overlap,
            skin: self.list.skin,
            steps,
            step: self.step,
            time_offset: self.watch.time_offset,
        };
        segment::run(&work, threads, begin)
    }

    /// As many of the threads allowed as the work of a step is worth.
    fn worthwhile(&self, threads: usize) -> usize {
        let touching = self.pairs.touching.iter().filter(|touches| **touches == 1).count();
        let work =
            segment::work_of_step(self.grains.len(), self.pairs.partner.len(), touching + self.walls.grain.len());
        if self.least_work > 0.0 { threads.min((work / self.least_work) as usize).max(1) } else { threads }
    }

    fn take(&mut self, end: End) -> Result<(), DemError> {
        self.step += end.steps;
        self.list.travel = end.travel;
        self.list.body_travel = end.body_travel;
        self.watch.work += end.work;
        let notice = end.notice;
        if notice.too_fast != usize::MAX {
            let speed = norm(self.grains.velocity[notice.too_fast].xyz());
            return Err(DemError::TooFast {
                step: self.step,
                grain: self.grains.id[notice.too_fast] as usize,
                speed,
                share: 100.0 * speed * self.length.seconds / self.radii[0],
            });
        }
        if notice.deepest > self.limits.overlap {
            return Err(DemError::TooDeep {
                step: self.step,
                grain: self.grains.id[notice.deepest_grain] as usize,
                share: 100.0 * notice.deepest,
                limit: 100.0 * self.limits.overlap,
            });
        }
        Ok(())
    }

    /// Whether any contact has friction.
    pub(super) fn effective_friction(&self) -> bool {
        self.friction && self.laws.any_friction()
    }

    /// How rolling is resisted where any coefficient is above zero.
    pub(super) fn effective_rolling(&self) -> Rolling {
        if self.stuffs.iter().any(|stuff| stuff.rolling_friction > 0.0) { self.rolling } else { Rolling::None }
    }

    pub(super) fn needs(&self) -> Needs {
        let rolling = self.effective_rolling();
        Needs {
            friction: self.effective_friction(),
            resistance: per_contact(rolling),
            rolling_spring: matches!(rolling, Rolling::ElasticPlastic { .. }),
        }
    }

    /// The turn of a grain; none when it is lost or there never was one.
    pub(super) fn turn_of(&self, grain: usize) -> Option<usize> {
        self.turns.get(grain).map(|&turn| turn as usize).filter(|&turn| turn < self.grains.len())
    }

    /// Switches friction on or off; contacts start without tangential force.
    pub fn set_friction(&mut self, on: bool) {
        self.friction = on;
        self.changed();
    }

    /// Changes how rolling is resisted.
    pub fn set_rolling(&mut self, rolling: Rolling) {
        self.rolling = rolling;
        self.changed();
    }

    /// Changes gravity, m/s².
    pub fn set_gravity(&mut self, gravity: [f64; 3]) {
        self.gravity = gravity;
        self.changed();
    }

    /// Changes how a wall moves, from now on. A point it turns about is one of space now; times are those of the simulation.
    ///
    /// # Errors
    /// When there is no such wall, or it cannot move so.
    pub fn set_motion(&mut self, wall: usize, motion: Motion) -> Result<(), DemError> {
        let time = self.time().si();
        let Some(body) = self.bodies.get_mut(wall) else {
            return Err(DemError::Motion { wall, why: "there is no such wall" });
        };
        check::check_motion(wall, &body.wall.shape, &motion)?;
        body.set_motion(motion, time);
        self.walls.finish_moving(&self.bodies);
        self.changed();
        Ok(())
    }

    /// Takes a wall away or puts it back where it was, as auxiliary surfaces and gates are; it stands still meanwhile.
    ///
    /// # Errors
    /// When there is no such wall, or a grain is deep in the wall that is put back.
    pub fn set_present(&mut self, wall: usize, present: bool) -> Result<(), DemError> {
        let Some(body) = self.bodies.get_mut(wall) else {
            return Err(DemError::Motion { wall, why: "there is no such wall" });
        };
        body.present = present;
        self.make_list();
        self.changed();
        if present { self.check_overlaps(0) } else { Ok(()) }
    }

    /// Gives a grain a velocity (m/s) and a spin (rad/s); false when it is lost.
    pub fn set_velocity(&mut self, grain: usize, velocity: [f64; 3], spin: [f64; 3]) -> bool {
        let Some(i) = self.turn_of(grain) else { return false };
        self.grains.velocity[i] = Four::new(velocity, self.grains.velocity[i].w());
        self.grains.spin[i] = Four::new(spin, self.grains.spin[i].w());
        self.changed();
        true
    }

    /// Brings all grains to rest where they are.
    pub fn stop_grains(&mut self) {
        for four in self.grains.velocity.iter_mut().chain(&mut self.grains.spin) {
            *four = Four::new([0.0; 3], four.w());
        }
        self.changed();
    }

    /// Changes the time step from now on.
    ///
    /// # Errors
    /// When it is out of range, as in [`Simulation::new`].
    pub fn set_time_step(&mut self, time_step: TimeStep) -> Result<(), DemError> {
        // Steps and times stay tied together: the time so far is kept as an offset.
        let length = time_step::settle(time_step, &self.all_grains_by_turn(), &self.stuffs)?;
        let grain = self.grains.id.get(length.grain).map_or(length.grain, |&id| id as usize);
        self.watch.time_offset += self.step as f64 * (self.length.seconds - length.seconds);
        self.length = StepLength { grain, ..length };
        self.changed();
        Ok(())
    }

    /// Keeps the torque of the rolling friction of each grain in every step, for [`rolling_torque`](Self::rolling_torque).
    pub fn keep_rolling_torque(&mut self, keep: bool) {
        self.keep_rolling_torque = keep;
    }

    /// Changes the least estimated work of a step for which a further thread is taken; with zero all that are allowed are taken.
    /// It changes no bit of the result.
    pub fn set_least_work(&mut self, work: Seconds) {
        self.least_work = 1e9 * work.si();
    }

    /// What has to be done when anything but time has changed the state.
    pub(super) fn changed(&mut self) {
        self.pairs.fit(self.needs());
        self.begin_watch();
    }

    fn all_grains_by_turn(&self) -> Vec<Grain> {
        (0..self.grains.len()).map(|i| self.grains.grain(i)).collect()
    }
}
