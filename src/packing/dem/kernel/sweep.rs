//! The sweep over grains: gathering what their contacts do, bounding the rolling friction, and moving them.

use std::ops::Range;

use super::Notice;
use crate::packing::dem::law::{Bounded, Laws, bounded};
use crate::packing::dem::vector::Four;

/// What the sweep reads.
pub struct GrainSweep<'a> {
    /// First pair of each grain.
    pub starts: &'a [u32],
    /// Other grain of each pair.
    pub partner: &'a [u32],
    /// First incoming pair of each grain.
    pub incoming_starts: &'a [u32],
    /// Incoming pairs.
    pub incoming: &'a [u32],
    /// Forces of the pairs.
    pub force: &'a [Four],
    /// Moments of the pairs.
    pub moment: &'a [Four],
    /// Rolling resistance of the pairs.
    pub resistance: &'a [Four],
    /// First candidate at a wall of each grain.
    pub wall_starts: &'a [u32],
    /// Forces of the candidates.
    pub wall_force: &'a [Four],
    /// Torques of the candidates.
    pub wall_torque: &'a [Four],
    /// Material of each grain.
    pub material: &'a [u16],
    /// What materials do to each other.
    pub laws: &'a Laws,
    /// Whether grains have rolling friction by the bounded model.
    pub bounded: bool,
    /// Gravity, m/s².
    pub gravity: [f64; 3],
    /// Time step, s.
    pub dt: f64,
    /// Square of the speed from which on a grain is too fast, m²/s².
    pub too_fast: f64,
}

/// What the sweep writes: the grains `first..`.
pub struct GrainSlots<'a> {
    /// The first grain.
    pub first: usize,
    /// Centre and radius.
    pub place: &'a mut [Four],
    /// Velocity and mass.
    pub velocity: &'a mut [Four],
    /// Spin and rolling friction times radius.
    pub spin: &'a mut [Four],
    /// Torque of the rolling friction in the bounded model, N m; empty unless it is wanted.
    pub rolling_torque: &'a mut [Four],
}

/// Adds `sign` times a force; what is in the fourth place is always added.
#[inline(always)]
fn plus(sum: &mut [f64; 4], four: Four, sign: [f64; 4]) {
    for k in 0..4 {
        sum[k] += sign[k] * four.0[k];
    }
}

/// Gathers force and torque of grain `i`, in the order of its contacts.
#[inline(always)]
fn gather<const FRICTION: bool, const RESISTANCE: bool>(
    sweep: &GrainSweep<'_>,
    i: usize,
    radius: f64,
) -> ([f64; 4], [f64; 4]) {
    let (mut force, mut torque) = ([0.0; 4], [0.0; 4]);
    let own = sweep.starts[i] as usize..sweep.starts[i + 1] as usize;
    let share = |pair: usize, j: usize, first: bool| {
        if sweep.laws.equal_levers {
            0.5
        } else if first {
            sweep.laws.of(sweep.material[i], sweep.material[sweep.partner[pair] as usize]).lever_share
        } else {
            sweep.laws.of(sweep.material[i], sweep.material[j]).lever_share
        }
    };
    for pair in own {
        plus(&mut force, sweep.force[pair], [1.0; 4]);
        if FRICTION {
            let moment = sweep.moment[pair];
            let lever = radius - share(pair, 0, true) * moment.w();
            plus(&mut torque, moment, [lever; 4]);
        }
        if RESISTANCE {
            plus(&mut torque, sweep.resistance[pair], [1.0; 4]);
        }
    }
    for &pair in &sweep.incoming[sweep.incoming_starts[i] as usize..sweep.incoming_starts[i + 1] as usize] {
        let pair = pair as usize;
        plus(&mut force, sweep.force[pair], [-1.0, -1.0, -1.0, 1.0]);
        if FRICTION {
            let moment = sweep.moment[pair];
            let first = if sweep.laws.equal_levers { 0 } else { first_of(sweep.starts, pair) };
            let lever = radius - share(pair, first, false) * moment.w();
            plus(&mut torque, moment, [lever; 4]);
        }
        if RESISTANCE {
            plus(&mut torque, sweep.resistance[pair], [-1.0; 4]);
        }
    }
    for c in sweep.wall_starts[i] as usize..sweep.wall_starts[i + 1] as usize {
        plus(&mut force, sweep.wall_force[c], [1.0; 4]);
        plus(&mut torque, sweep.wall_torque[c], [1.0; 4]);
    }
    (force, torque)
}

/// The grain at which a pair is listed.
fn first_of(starts: &[u32], pair: usize) -> usize {
    starts.partition_point(|&start| start as usize <= pair) - 1
}

/// Moves `grains` by one step of the symplectic Euler scheme: `v += dt F/m`, `x += dt v`, and so the spin.
#[inline(always)]
pub fn grains<const FRICTION: bool, const RESISTANCE: bool>(
    sweep: &GrainSweep<'_>,
    grains: Range<usize>,
    slots: &mut GrainSlots<'_>,
    notice: &mut Notice,
) {
    let dt = sweep.dt;
    let [gx, gy, gz] = sweep.gravity;
    for i in grains {
        let at = i - slots.first;
        let velocity = &mut slots.velocity[at].0;
        let place = &mut slots.place[at].0;
        let mass = velocity[3];
        let lonely = sweep.starts[i] == sweep.starts[i + 1]
            && sweep.incoming_starts[i] == sweep.incoming_starts[i + 1]
            && sweep.wall_starts[i] == sweep.wall_starts[i + 1];
        let mut acceleration = [gx, gy, gz];
        if !lonely {
            let (force, torque) = gather::<FRICTION, RESISTANCE>(sweep, i, place[3]);
            let inverse = 1.0 / mass;
            for k in 0..3 {
                acceleration[k] += force[k] * inverse;
            }
            if FRICTION || RESISTANCE || sweep.bounded {
                let inertia = 0.4 * mass * (place[3] * place[3]);
                let spin = &mut slots.spin[at].0;
                let turning = [torque[0], torque[1], torque[2]];
                turn(sweep, inertia, spin, turning, force[3], slots.rolling_torque.get_mut(at));
            }
        }
        let mut square = 0.0;
        for k in 0..3 {
            velocity[k] += dt * acceleration[k];
            place[k] += dt * velocity[k];
            square += velocity[k] * velocity[k];
        }
        if square > notice.fastest {
            notice.fastest = square;
        }
        // Not a number is too fast.
        let slow_enough = square <= sweep.too_fast;
        if !slow_enough && notice.too_fast == usize::MAX {
            notice.too_fast = i;
        }
    }
}

/// Changes the spin of a grain.
#[inline(always)]
fn turn(
    sweep: &GrainSweep<'_>,
    inertia: f64,
    spin: &mut [f64; 4],
    contact_torque: [f64; 3],
    most: f64,
    told: Option<&mut Four>,
) {
    let mut torque = contact_torque;
    let mut friction = [0.0; 3];
    if sweep.bounded {
        let before = [spin[0], spin[1], spin[2]];
        match bounded(inertia / sweep.dt, before, contact_torque, most) {
            Bounded::Turns(turning) => {
                torque = turning;
                friction = [0, 1, 2].map(|k| turning[k] - contact_torque[k]);
            }
            Bounded::Stops => {
                (spin[0], spin[1], spin[2]) = (0.0, 0.0, 0.0);
                if let Some(told) = told {
                    *told = Four::new(contact_torque.map(|v| -v), 0.0);
                }
                return;
            }
        }
    }
    let rate = sweep.dt / inertia;
    for k in 0..3 {
        spin[k] += rate * torque[k];
    }
    if let Some(told) = told {
        *told = Four::new(friction, 0.0);
    }
}
