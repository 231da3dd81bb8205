//! The steps between two looks at the whole: a team of threads makes them without allocating.

use std::ops::Range;

use super::barrier::Barrier;
use super::bodies::Body;
use super::cells::Period;
use super::instructions;
use super::kernel::{
    ContactSweep, GrainSlots, GrainSweep, Notice, PairSlots, WallSlots, WallSweep, contacts, grains, walls,
};
use super::law::{Laws, Rolling};
use super::shared::Shared;
use super::vector::{Four, sub};
use super::wall_contacts::Slot;

/// What a team works on; see [`Simulation`](super::Simulation) for what the fields are.
pub struct Work<'a> {
    /// Centre and radius of each grain.
    pub place: Shared<'a, Four>,
    /// Velocity and mass.
    pub velocity: Shared<'a, Four>,
    /// Spin and rolling friction times radius.
    pub spin: Shared<'a, Four>,
    /// Rolling torque of each grain, if wanted.
    pub rolling_torque: Shared<'a, Four>,
    /// Material of each grain.
    pub material: &'a [u16],
    /// First pair of each grain.
    pub starts: &'a [u32],
    /// Other grain of each pair.
    pub partner: &'a [u32],
    /// First incoming pair of each grain.
    pub incoming_starts: &'a [u32],
    /// Incoming pairs.
    pub incoming: &'a [u32],
    /// Of each pair.
    pub touching: Shared<'a, u8>,
    /// Of each pair.
    pub history: Shared<'a, Four>,
    /// Of each pair.
    pub rolling_history: Shared<'a, Four>,
    /// Of each pair.
    pub force: Shared<'a, Four>,
    /// Of each pair.
    pub moment: Shared<'a, Four>,
    /// Of each pair.
    pub resistance: Shared<'a, Four>,
    /// First candidate of each grain.
    pub wall_starts: &'a [u32],
    /// Grain of each candidate.
    pub wall_grain: &'a [u32],
    /// Wall of each candidate.
    pub wall_wall: &'a [u32],
    /// First triangle of each candidate.
    pub triangle_starts: &'a [u32],
    /// Triangles near candidates.
    pub triangles: &'a [u32],
    /// First slot of each candidate.
    pub slot_starts: &'a [u32],
    /// Slots.
    pub slots: Shared<'a, Slot>,
    /// Of each candidate.
    pub wall_force: Shared<'a, Four>,
    /// Of each candidate.
    pub wall_torque: Shared<'a, Four>,
    /// Candidates at walls that may move.
    pub of_moving: &'a [(u32, Vec<u32>)],
    /// The walls.
    pub bodies: Shared<'a, Body>,
    /// Rolling friction of each wall.
    pub wall_rolling_friction: &'a [f64],
    /// What materials do to each other.
    pub laws: &'a Laws,
    /// The periodic box.
    pub period: Period,
    /// How rolling is resisted, `None` where no coefficient is above zero.
    pub rolling: Rolling,
    /// Whether there is friction anywhere.
    pub friction: bool,
    /// Gravity, m/s².
    pub gravity: [f64; 3],
    /// Time step, s.
    pub dt: f64,
    /// Speed from which on a grain is too fast, m/s.
    pub too_fast: f64,
    /// Overlap over the smaller radius from which on a contact is too deep.
    pub too_deep: f64,
    /// Distance up to which the list is complete, m.
    pub skin: f64,
    /// Steps to make.
    pub steps: u64,
    /// Steps made before.
    pub step: u64,
    /// What the step's number times its length lacks of the time, s.
    pub time_offset: f64,
}

/// How a segment ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct End {
    /// Steps made.
    pub steps: u64,
    /// Bound of the travel of any grain since the list was made, m.
    pub travel: f64,
    /// Bound of the travel of any point of a wall, m.
    pub body_travel: f64,
    /// Work of the walls that may move on the grains, J.
    pub work: f64,
    /// What was noticed in the last step.
    pub notice: Notice,
}

impl End {
    /// Whether a contact could be missing from a list with this skin.
    pub fn list_is_old(&self, skin: f64) -> bool {
        2.0 * self.travel >= skin || self.travel + self.body_travel >= skin
    }
}

/// What a thread tells the others after each step, on its own lines of the cache.
#[derive(Debug, Clone, Copy)]
#[repr(align(128))]
struct Told {
    notice: Notice,
    body_speed: f64,
}

/// The team at work.
pub struct Team<'a> {
    work: &'a Work<'a>,
    barrier: Barrier,
    told: Shared<'a, Told>,
    /// First grain of each thread, and the end.
    bounds: Vec<usize>,
    begin: End,
}

/// Makes steps until they are done, a contact could be missing from the list, or something is wrong.
pub fn run(work: &Work<'_>, threads: usize, begin: End) -> End {
    let bounds = bounds(work, threads);
    let threads = bounds.len() - 1;
    let mut told = vec![Told { notice: Notice::NONE, body_speed: 0.0 }; threads];
    let team = Team { work, barrier: Barrier::new(threads), told: Shared::new(&mut told), bounds, begin };
    let member = instructions::member(work.friction, work.period.any(), per_contact(work.rolling));
    if threads == 1 {
        return member.call(&team, 0);
    }
    std::thread::scope(|scope| {
        let team = &team;
        let others: Vec<_> = (1..threads).map(|me| scope.spawn(move || member.call(team, me))).collect();
        let end = member.call(team, 0);
        for other in others {
            if let Err(panic) = other.join() {
                std::panic::resume_unwind(panic);
            }
        }
        end
    })
}

/// Whether rolling is resisted contact by contact.
pub fn per_contact(rolling: Rolling) -> bool {
    matches!(rolling, Rolling::ConstantTorque | Rolling::ElasticPlastic { .. })
}

/// Estimated work of a step on one thread, ns: 6 for a grain, 2 for a pair that is near and 25 for one that touches (or a grain near a
/// wall). That gives 76 for a stone of a settled bed and 6 for one in free fall; the bench `dem` measured 81 and 6 to 8.
pub fn work_of_step(grains: usize, pairs: usize, touching: usize) -> f64 {
    6.0 * grains as f64 + 2.0 * pairs as f64 + 25.0 * touching as f64
}

/// What a grain costs beside its pairs, in pairs.
const PAIRS_PER_GRAIN: usize = 2;
/// Fewest pairs that are worth a thread.
const LEAST_WORK_PER_THREAD: usize = 400;

/// Shares out the grains so that each thread has as many pairs.
fn bounds(work: &Work<'_>, threads: usize) -> Vec<usize> {
    let grains = work.starts.len() - 1;
    let cost = |i: usize| work.starts[i] as usize + PAIRS_PER_GRAIN * i;
    let total = cost(grains);
    let threads = threads.min(total / LEAST_WORK_PER_THREAD).max(1);
    let mut bounds = vec![0];
    for thread in 1..threads {
        let goal = total * thread / threads;
        let (mut low, mut high) = (bounds[thread - 1], grains);
        while low < high {
            let middle = (low + high) / 2;
            if cost(middle) < goal { low = middle + 1 } else { high = middle }
        }
        bounds.push(low);
    }
    bounds.push(grains);
    bounds
}

impl Team<'_> {
    /// The steps of one thread.
    #[inline(always)]
    pub(super) fn steps<const FRICTION: bool, const PERIODIC: bool, const RESISTANCE: bool>(&self, me: usize) -> End {
        let _guard = self.barrier.guard();
        let work = self.work;
        let mine = self.bounds[me]..self.bounds[me + 1];
        let mut end = self.begin;
        while end.steps < work.steps {
            let mut notice = Notice::NONE;
            self.contacts::<FRICTION, PERIODIC, RESISTANCE>(mine.clone(), &mut notice);
            if !self.barrier.wait() {
                break;
            }
            self.grains::<FRICTION, RESISTANCE>(mine.clone(), &mut notice);
            let mut body_speed = 0.0;
            if me == 0 && !work.of_moving.is_empty() {
                body_speed = self.bodies(&mut end);
            }
            // SAFETY: each thread writes its own; the others read it after the barrier and before their next.
            let mine_told = unsafe { self.told.write(me..me + 1) };
            mine_told[0] = Told { notice, body_speed };
            if !self.barrier.wait() {
                break;
            }
            end.steps += 1;
            // SAFETY: everybody has written theirs before the barrier, and writes again only behind the next.
            let told = unsafe { self.told.read() };
            end.notice = Notice::NONE;
            for told in told {
                end.notice.join(&told.notice);
            }
            end.travel += work.dt * end.notice.fastest.sqrt();
            end.body_travel += work.dt * told[0].body_speed;
            let wrong = end.notice.too_fast != usize::MAX || end.notice.deepest > work.too_deep;
            if wrong || end.list_is_old(work.skin) {
                break;
            }
        }
        end
    }

    #[inline(always)]
    fn contacts<const FRICTION: bool, const PERIODIC: bool, const RESISTANCE: bool>(
        &self,
        mine: Range<usize>,
        notice: &mut Notice,
    ) {
        let work = self.work;
        let pairs = work.starts[mine.start] as usize..work.starts[mine.end] as usize;
        // SAFETY: between this barrier and the next nobody writes to grains or walls.
        let (place, velocity, spin, bodies) =
            unsafe { (work.place.read(), work.velocity.read(), work.spin.read(), work.bodies.read()) };
        let sweep = ContactSweep {
            place,
            velocity,
            spin,
            material: work.material,
            starts: work.starts,
            partner: work.partner,
            laws: work.laws,
            period: work.period,
            rolling: work.rolling,
            dt: work.dt,
        };
        // SAFETY: each thread writes the pairs of its own grains, and nobody reads any.
        let mut slots = unsafe {
            PairSlots {
                first: pairs.start,
                touching: work.touching.write(pairs.clone()),
                history: work.history.write(pairs.clone()),
                rolling: work.rolling_history.write(pairs.clone()),
                force: work.force.write(pairs.clone()),
                moment: work.moment.write(pairs.clone()),
                resistance: work.resistance.write(pairs),
            }
        };
        contacts::<FRICTION, PERIODIC, RESISTANCE>(&sweep, mine.clone(), &mut slots, notice);

        let candidates = work.wall_starts[mine.start] as usize..work.wall_starts[mine.end] as usize;
        if candidates.is_empty() {
            return;
        }
        let slots = work.slot_starts[candidates.start] as usize..work.slot_starts[candidates.end] as usize;
        let sweep = WallSweep {
            place,
            velocity,
            spin,
            material: work.material,
            bodies,
            rolling_friction: work.wall_rolling_friction,
            grain: work.wall_grain,
            wall: work.wall_wall,
            triangle_starts: work.triangle_starts,
            triangles: work.triangles,
            slot_starts: work.slot_starts,
            laws: work.laws,
            friction: FRICTION,
            rolling: work.rolling,
            dt: work.dt,
        };
        // SAFETY: each thread writes the candidates of its own grains, and nobody reads any.
        let mut out = unsafe {
            WallSlots {
                first: candidates.start,
                first_slot: slots.start,
                slots: work.slots.write(slots),
                force: work.wall_force.write(candidates.clone()),
                torque: work.wall_torque.write(candidates.clone()),
            }
        };
        walls(&sweep, candidates, &mut out, notice);
    }

    #[inline(always)]
    fn grains<const FRICTION: bool, const RESISTANCE: bool>(&self, mine: Range<usize>, notice: &mut Notice) {
        let work = self.work;
        // SAFETY: between this barrier and the next nobody writes to pairs or candidates.
        let sweep = unsafe {
            GrainSweep {
                starts: work.starts,
                partner: work.partner,
                incoming_starts: work.incoming_starts,
                incoming: work.incoming,
                force: work.force.read(),
                moment: work.moment.read(),
                resistance: work.resistance.read(),
                wall_starts: work.wall_starts,
                wall_force: work.wall_force.read(),
                wall_torque: work.wall_torque.read(),
                material: work.material,
                laws: work.laws,
                bounded: work.rolling == Rolling::Bounded,
                gravity: work.gravity,
                dt: work.dt,
                too_fast: work.too_fast * work.too_fast,
            }
        };
        // SAFETY: each thread writes its own grains, and reads no other.
        let mut slots = unsafe {
            GrainSlots {
                first: mine.start,
                place: work.place.write(mine.clone()),
                velocity: work.velocity.write(mine.clone()),
                spin: work.spin.write(mine.clone()),
                rolling_torque: work.rolling_torque.write(mine.clone()),
            }
        };
        grains::<FRICTION, RESISTANCE>(&sweep, mine, &mut slots, notice);
    }

    /// Moves the walls that may move; gives the greatest speed of any of their points, before or after.
    fn bodies(&self, end: &mut End) -> f64 {
        let work = self.work;
        // SAFETY: between this barrier and the next nobody writes to candidates, and nobody else touches walls.
        let (forces, torques, bodies) =
            unsafe { (work.wall_force.read(), work.wall_torque.read(), work.bodies.write(0..usize::MAX)) };
        let time = (work.step + end.steps + 1) as f64 * work.dt + work.time_offset;
        let mut fastest = 0.0_f64;
        for (wall, candidates) in work.of_moving {
            let mut force = [0.0; 3];
            for &c in candidates {
                force = sub(force, forces[c as usize].xyz());
                end.work += work.dt * torques[c as usize].w();
            }
            let body = &mut bodies[*wall as usize];
            let before = body.speed();
            body.advance(force, work.gravity, work.dt, time);
            fastest = fastest.max(before).max(body.speed());
        }
        fastest
    }
}
