//! Eight contacts at a time, so that the law is computed in vector registers.

use super::Notice;
use super::contacts::{ContactSweep, PairSlots};
use crate::packing::dem::law::{Before, Rolling, RollingSpring, constant_torque, elastic_plastic, normal, tangential};
use crate::packing::dem::vector::{Four, cross, dot, sub};

/// Contacts of a batch.
pub const LANES: usize = 8;

type Lane = [f64; LANES];
const ZERO: Lane = [0.0; LANES];

/// Contacts that wait to be computed.
pub struct Batch {
    /// How many.
    pub count: usize,
    slot: [usize; LANES],
    first: [usize; LANES],
    second: [usize; LANES],
}

impl Batch {
    /// None.
    pub const EMPTY: Self = Self { count: 0, slot: [0; LANES], first: [0; LANES], second: [0; LANES] };

    /// Takes a pair if it touches. There must be room.
    #[inline(always)]
    pub fn offer(&mut self, slot: usize, first: usize, second: usize, touches: bool) {
        let at = self.count % LANES;
        (self.slot[at], self.first[at], self.second[at]) = (slot, first, second);
        self.count += usize::from(touches);
    }

    /// Computes the contacts and writes their slots.
    #[inline(always)]
    pub fn solve<const FRICTION: bool, const PERIODIC: bool, const RESISTANCE: bool>(
        &mut self,
        sweep: &ContactSweep<'_>,
        slots: &mut PairSlots<'_>,
        notice: &mut Notice,
    ) {
        // Lanes without a contact repeat the last one.
        let last = self.count - 1;
        for l in self.count..LANES {
            (self.slot[l], self.first[l], self.second[l]) = (self.slot[last], self.first[last], self.second[last]);
        }
        let (mut d, mut v, mut wi, mut wj) = ([ZERO; 3], [ZERO; 3], [ZERO; 3], [ZERO; 3]);
        let (mut ri, mut rj, mut mi, mut mj, mut eccentricity) = (ZERO, ZERO, ZERO, ZERO, ZERO);
        let mut old = [ZERO; 4];
        let mut laws = [sweep.laws.of(0, 0); LANES];
        for l in 0..LANES {
            let (i, j) = (self.first[l], self.second[l]);
            let (a, b) = (sweep.place[i].0, sweep.place[j].0);
            let mut apart = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
            if PERIODIC {
                apart = sweep.period.nearest(apart);
            }
            let (va, vb) = (sweep.velocity[i].0, sweep.velocity[j].0);
            let (sa, sb) = (sweep.spin[i].0, sweep.spin[j].0);
            laws[l] = sweep.laws.of(sweep.material[i], sweep.material[j]);
            (ri[l], rj[l], mi[l], mj[l]) = (a[3], b[3], va[3], vb[3]);
            eccentricity[l] = if sa[3] < sb[3] { sa[3] } else { sb[3] };
            for k in 0..3 {
                d[k][l] = apart[k];
                v[k][l] = va[k] - vb[k];
                if FRICTION {
                    (wi[k][l], wj[k][l]) = (sa[k], sb[k]);
                }
            }
            if FRICTION {
                let history = slots.history[self.slot[l]].0;
                for k in 0..4 {
                    old[k][l] = history[k];
                }
            }
        }
        let mut force = [ZERO; 4];
        let mut moment = [ZERO; 4];
        let mut elastic = [ZERO; 3];
        let mut pressing = ZERO;
        let mut deep = ZERO;
        for l in 0..LANES {
            let distance = (d[0][l] * d[0][l] + d[1][l] * d[1][l] + d[2][l] * d[2][l]).sqrt();
            let inverse = 1.0 / distance;
            let n = [d[0][l] * inverse, d[1][l] * inverse, d[2][l] * inverse];
            let sum = ri[l] + rj[l];
            let overlap = sum - distance;
            let radius = ri[l] * rj[l] / sum;
            let mass = mi[l] * mj[l] / (mi[l] + mj[l]);
            let at_centres = [v[0][l], v[1][l], v[2][l]];
            let receding = dot(at_centres, n);
            let pressed = normal(laws[l], radius, mass, overlap, -receding);
            pressing[l] = pressed.force;
            let mut f = [pressed.force * n[0], pressed.force * n[1], pressed.force * n[2]];
            if FRICTION {
                let share = laws[l].lever_share;
                let (li, lj) = (ri[l] - share * overlap, rj[l] - (1.0 - share) * overlap);
                let turning = cross([0, 1, 2].map(|k| li * wi[k][l] + lj * wj[k][l]), n);
                let along = [0, 1, 2].map(|k| at_centres[k] - receding * n[k] - turning[k]);
                let before = Before { elastic: [old[0][l], old[1][l], old[2][l]], overlap: old[3][l] };
                let coefficients = [pressed.tangential_stiffness * sweep.dt, pressed.tangential_damping];
                let t = tangential(before, n, along, overlap, coefficients, laws[l].friction * pressed.force);
                let m = cross(t.force, n);
                for k in 0..3 {
                    f[k] += t.force[k];
                    elastic[k][l] = t.elastic[k];
                    moment[k][l] = m[k];
                }
            }
            for k in 0..3 {
                force[k][l] = f[k];
            }
            force[3][l] = pressed.force * eccentricity[l];
            moment[3][l] = overlap;
            let smaller = if ri[l] < rj[l] { ri[l] } else { rj[l] };
            deep[l] = overlap / smaller;
        }
        for l in 0..self.count {
            let slot = self.slot[l];
            notice.deep(deep[l], self.first[l]);
            slots.force[slot] = Four([force[0][l], force[1][l], force[2][l], force[3][l]]);
            if FRICTION {
                slots.history[slot] = Four([elastic[0][l], elastic[1][l], elastic[2][l], moment[3][l]]);
                slots.moment[slot] = Four([moment[0][l], moment[1][l], moment[2][l], moment[3][l]]);
            }
            if RESISTANCE {
                self.resist(l, [d[0][l], d[1][l], d[2][l]], pressing[l], sweep, slots);
            }
        }
    }

    /// The rolling resistance of a contact by the models that have it contact by contact.
    #[inline(never)]
    fn resist(&self, l: usize, d: [f64; 3], pressing: f64, sweep: &ContactSweep<'_>, slots: &mut PairSlots<'_>) {
        let (i, j, slot) = (self.first[l], self.second[l], self.slot[l]);
        let (a, b) = (sweep.spin[i], sweep.spin[j]);
        let (ri, rj) = (sweep.place[i].w(), sweep.place[j].w());
        let spin = sub(a.xyz(), b.xyz());
        let radius = ri * rj / (ri + rj);
        let friction = (a.w() / ri).min(b.w() / rj);
        match sweep.rolling {
            Rolling::ConstantTorque => {
                slots.resistance[slot] = Four::new(constant_torque(friction * radius * pressing, spin), 0.0);
            }
            Rolling::ElasticPlastic { damping } => {
                let (mi, mj) = (sweep.velocity[i].w(), sweep.velocity[j].w());
                let about = |m: f64, r: f64| 1.4 * m * r * r;
                let distance = dot(d, d).sqrt();
                let law = sweep.laws.of(sweep.material[i], sweep.material[j]);
                let spring = RollingSpring {
                    friction,
                    radius,
                    normal_stiffness: law.normal_stiffness * (radius * (ri + rj - distance)).sqrt(),
                    normal_force: pressing,
                    inertia: 1.0 / (1.0 / about(mi, ri) + 1.0 / about(mj, rj)),
                    damping,
                };
                let n = d.map(|v| v / distance);
                let (elastic, torque) = elastic_plastic(&spring, slots.rolling[slot].xyz(), n, spin, sweep.dt);
                slots.rolling[slot] = Four::new(elastic, 0.0);
                slots.resistance[slot] = Four::new(torque, 0.0);
            }
            Rolling::None | Rolling::Bounded => {}
        }
    }
}
