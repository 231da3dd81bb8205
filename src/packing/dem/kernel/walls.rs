//! The sweep over grains near walls.

use std::ops::Range;

use super::Notice;
use crate::geometry::triangle_mesh::{FeatureId, Touch, Touches};
use crate::packing::dem::bodies::Body;
use crate::packing::dem::law::{
    Before, Laws, Rolling, RollingSpring, constant_torque, elastic_plastic, normal, tangential,
};
use crate::packing::dem::setup::WallShape;
use crate::packing::dem::vector::{Four, add, cross, dot, scale, sub};
use crate::packing::dem::wall_contacts::{MOST_TOUCHES, NO_FEATURE, Slot};

/// What the sweep reads.
pub struct WallSweep<'a> {
    /// Centre and radius.
    pub place: &'a [Four],
    /// Velocity and mass.
    pub velocity: &'a [Four],
    /// Spin and rolling friction times radius.
    pub spin: &'a [Four],
    /// Material of each grain.
    pub material: &'a [u16],
    /// The walls.
    pub bodies: &'a [Body],
    /// Rolling friction of each wall.
    pub rolling_friction: &'a [f64],
    /// Grain of each candidate.
    pub grain: &'a [u32],
    /// Wall of each candidate.
    pub wall: &'a [u32],
    /// First triangle of each candidate.
    pub triangle_starts: &'a [u32],
    /// Triangles near candidates.
    pub triangles: &'a [u32],
    /// First slot of each candidate.
    pub slot_starts: &'a [u32],
    /// What materials do to each other.
    pub laws: &'a Laws,
    /// Whether there is friction.
    pub friction: bool,
    /// How rolling is resisted.
    pub rolling: Rolling,
    /// Time step, s.
    pub dt: f64,
}

/// What the sweep writes: the candidates `first..` and the slots `first_slot..`.
pub struct WallSlots<'a> {
    /// The first candidate.
    pub first: usize,
    /// The first slot.
    pub first_slot: usize,
    /// Slots.
    pub slots: &'a mut [Slot],
    /// Forces.
    pub force: &'a mut [Four],
    /// Torques.
    pub torque: &'a mut [Four],
}

/// A touch in space.
#[derive(Debug, Clone, Copy)]
struct Touched {
    feature: u64,
    triangle: u32,
    normal: [f64; 3],
    depth: f64,
    point: [f64; 3],
}

const NOTHING: Touched = Touched { feature: NO_FEATURE, triangle: 0, normal: [0.0; 3], depth: 0.0, point: [0.0; 3] };

/// Computes the wall contacts of candidates.
pub fn walls(sweep: &WallSweep<'_>, candidates: Range<usize>, out: &mut WallSlots<'_>, notice: &mut Notice) {
    let mut touched = [NOTHING; MOST_TOUCHES];
    let mut touches = Touches::new();
    let mut old = [Slot::default(); MOST_TOUCHES];
    for c in candidates {
        let (i, wall) = (sweep.grain[c] as usize, sweep.wall[c] as usize);
        let (from, to) =
            (sweep.slot_starts[c] as usize - out.first_slot, sweep.slot_starts[c + 1] as usize - out.first_slot);
        let body = &sweep.bodies[wall];
        let triangles = &sweep.triangles[sweep.triangle_starts[c] as usize..sweep.triangle_starts[c + 1] as usize];
        let count = find(body, sweep.place[i], triangles, &mut touches, &mut touched[..to - from]);
        let at = c - out.first;
        let slots = &mut out.slots[from..to];
        if count == 0 {
            if !slots[0].is_empty() {
                slots.fill(Slot::default());
                (out.force[at], out.torque[at]) = (Four::default(), Four::default());
            }
            continue;
        }
        let live = slots.iter().take_while(|slot| !slot.is_empty()).count();
        old[..live].copy_from_slice(&slots[..live]);
        if live > count {
            slots[count..live].fill(Slot::default());
        }
        let (mut force, mut torque) = (Four::default(), Four::default());
        for (slot, touch) in slots.iter_mut().zip(&touched[..count]) {
            notice.deep(touch.depth / sweep.place[i].w(), i);
            let before = remembered(&old[..live], touch, &touched[..count]);
            let (f, t) = contact(sweep, i, wall, body, touch, &before, slot);
            for k in 0..4 {
                force.0[k] += f.0[k];
                torque.0[k] += t.0[k];
            }
        }
        (out.force[at], out.torque[at]) = (force, torque);
    }
}

/// Finds where a grain touches a wall.
fn find(body: &Body, place: Four, triangles: &[u32], touches: &mut Touches, touched: &mut [Touched]) -> usize {
    match &body.wall.shape {
        WallShape::Plane { point, .. } => {
            let height = dot(sub(place.xyz(), add(*point, body.state.displacement)), body.normal);
            if height >= place.w() {
                return 0;
            }
            touched[0] = Touched {
                feature: 0,
                triangle: 0,
                normal: body.normal,
                depth: place.w() - height,
                point: sub(place.xyz(), scale(height, body.normal)),
            };
            1
        }
        WallShape::Mesh(mesh) => {
            mesh.touches(body.to_body(place.xyz()), place.w(), triangles, touches);
            let mut found = touches.as_slice().iter();
            let mut count = 0;
            for touch in found.by_ref().take(touched.len()) {
                touched[count] = in_space(body, touch);
                count += 1;
            }
            for touch in found {
                if let Some(least) = touched.iter_mut().min_by(|a, b| a.depth.total_cmp(&b.depth))
                    && least.depth < touch.depth
                {
                    *least = in_space(body, touch);
                }
            }
            count
        }
    }
}

/// A touch in the frame of its mesh as one in space.
fn in_space(body: &Body, touch: &Touch) -> Touched {
    let (kind, index) = match touch.feature {
        FeatureId::Face(index) => (0, index),
        FeatureId::Edge(index) => (1, index),
        FeatureId::Corner(index) => (2, index),
    };
    Touched {
        feature: (kind << 32) | u64::from(index),
        triangle: touch.triangle,
        normal: body.direction(touch.normal),
        depth: touch.depth,
        point: body.to_space(touch.point),
    }
}

/// Cosine of the angle up to which a new contact goes on with the history of one that has just ended: 25 degrees.
const SAME_CONTACT: f64 = 0.9;

/// The history of the same feature, or of a contact of nearly the same direction that has ended in this step: a grain that
/// rolls from a face onto its edge keeps its tangential force.
fn remembered(old: &[Slot], touch: &Touched, now: &[Touched]) -> Slot {
    if let Some(same) = old.iter().find(|slot| slot.feature == touch.feature) {
        return *same;
    }
    let ended = |slot: &&Slot| now.iter().all(|now| now.feature != slot.feature);
    let near = |slot: &&Slot| dot(slot.normal, touch.normal) > SAME_CONTACT;
    old.iter().filter(ended).find(near).copied().unwrap_or_default()
}

/// One contact: force and bound of the rolling friction, torque and power of the wall.
fn contact(
    sweep: &WallSweep<'_>,
    i: usize,
    wall: usize,
    body: &Body,
    touch: &Touched,
    before: &Slot,
    slot: &mut Slot,
) -> (Four, Four) {
    let (radius, mass) = (sweep.place[i].w(), sweep.velocity[i].w());
    let law = sweep.laws.of(sweep.material[i], body.wall.material as u16);
    let n = touch.normal;
    let lever = radius - touch.depth;
    let wall_velocity = body.velocity_at(touch.point);
    let spin = sweep.spin[i].xyz();
    let at_centre = sub(sweep.velocity[i].xyz(), wall_velocity);
    let receding = dot(at_centre, n);
    let pressed = normal(law, radius, mass, touch.depth, -receding);
    let mut force = scale(pressed.force, n);
    let mut torque = [0.0; 3];
    *slot = Slot {
        feature: touch.feature,
        triangle: touch.triangle,
        normal: n,
        point: touch.point,
        history: Four::new([0.0; 3], touch.depth),
        ..Slot::default()
    };
    if sweep.friction {
        let turning = cross(scale(lever, spin), n);
        let along = [0, 1, 2].map(|k| at_centre[k] - receding * n[k] - turning[k]);
        let memory = Before { elastic: before.history.xyz(), overlap: before.history.w() };
        let coefficients = [pressed.tangential_stiffness * sweep.dt, pressed.tangential_damping];
        let t = tangential(memory, n, along, touch.depth, coefficients, law.friction * pressed.force);
        slot.history = Four::new(t.elastic, touch.depth);
        // The contact lies at -lever n from the centre.
        torque = scale(-lever, cross(n, t.force));
        force = add(force, t.force);
    }
    let friction = sweep.rolling_friction[wall];
    let relative_spin = sub(spin, body.state.spin);
    match sweep.rolling {
        Rolling::None | Rolling::Bounded => {}
        Rolling::ConstantTorque => {
            torque = add(torque, constant_torque(friction * radius * pressed.force, relative_spin));
        }
        Rolling::ElasticPlastic { damping } => {
            let spring = RollingSpring {
                friction,
                radius,
                normal_stiffness: law.normal_stiffness * (radius * touch.depth).sqrt(),
                normal_force: pressed.force,
                inertia: 1.4 * mass * radius * radius,
                damping,
            };
            let (elastic, resistance) = elastic_plastic(&spring, before.rolling, n, relative_spin, sweep.dt);
            slot.rolling = elastic;
            torque = add(torque, resistance);
        }
    }
    slot.force = force;
    (Four::new(force, pressed.force * friction * radius), Four::new(torque, dot(force, wall_velocity)))
}
