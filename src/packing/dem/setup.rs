//! What is simulated: grains, walls and how they move.

use super::law::Rolling;
use super::stuff::{Pairing, Stuff};
use crate::geometry::Sphere;
use crate::geometry::triangle_mesh::TriangleMesh;

/// A grain and how it moves; SI units.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Grain {
    /// Where it is and how large.
    pub sphere: Sphere,
    /// Velocity, m/s.
    pub velocity: [f64; 3],
    /// Angular velocity, rad/s.
    pub spin: [f64; 3],
    /// Index of its material.
    pub material: usize,
}

impl Grain {
    /// A grain of the first material at rest.
    pub fn at_rest(sphere: Sphere) -> Self {
        Self { sphere, velocity: [0.0; 3], spin: [0.0; 3], material: 0 }
    }
}

/// The shape of a wall.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WallShape {
    /// A half-space: grains are on the side to which the normal points.
    Plane {
        /// A point of it, m.
        point: [f64; 3],
        /// The normal, of any length.
        normal: [f64; 3],
    },
    /// A surface of triangles, open or closed; it may be touched from both sides.
    Mesh(TriangleMesh),
}

/// How a wall moves.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Motion {
    /// Not at all.
    #[default]
    Fixed,
    /// With a given velocity, whatever pushes against it.
    Prescribed {
        /// Velocity, m/s.
        velocity: [f64; 3],
        /// Angular velocity, rad/s.
        spin: [f64; 3],
        /// The point it turns about, which moves along, m.
        about: [f64; 3],
        /// When it begins, s.
        from: f64,
        /// When it ends, s.
        until: f64,
    },
    /// As the forces on it want, along the axes chosen; along the others with a given velocity. It does not turn.
    Free {
        /// Mass, kg.
        mass: f64,
        /// Axes along which it is free.
        moves: [bool; 3],
        /// Velocity along the axes that are not free, m/s; at the start also along those that are.
        velocity: [f64; 3],
        /// Force on it beside gravity and grains, N.
        load: [f64; 3],
    },
}

/// A wall or a body: plates, gates, sleepers.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Wall {
    /// Its shape at the start.
    pub shape: WallShape,
    /// Index of its material.
    pub material: usize,
    /// How it moves.
    pub motion: Motion,
}

impl Wall {
    /// A fixed plane; grains are on the side to which the normal points.
    pub fn plane(point: [f64; 3], normal: [f64; 3], material: usize) -> Self {
        Self { shape: WallShape::Plane { point, normal }, material, motion: Motion::Fixed }
    }

    /// A fixed surface of triangles.
    pub fn mesh(mesh: TriangleMesh, material: usize) -> Self {
        Self { shape: WallShape::Mesh(mesh), material, motion: Motion::Fixed }
    }

    /// The same wall with another motion.
    pub fn moving(self, motion: Motion) -> Self {
        Self { motion, ..self }
    }
}

/// How long a step is.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TimeStep {
    /// So many seconds, refused beyond the Rayleigh time of the smallest grain.
    Seconds(f64),
    /// A share of the Rayleigh time; 0.2 is usual.
    ShareOfRayleigh(f64),
    /// So many seconds, whatever that leads to; the watchdog stops what blows up.
    Unchecked(f64),
}

/// From which overlap on a contact is taken for a fault.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Limits {
    /// Overlap at the start over the smaller radius.
    pub initial_overlap: f64,
    /// Overlap during the run over the smaller radius.
    pub overlap: f64,
}

impl Default for Limits {
    /// 2 % at the start, 20 % later: settled ballast overlaps by 0.01 %, softened a thousand times by 1 %.
    fn default() -> Self {
        Self { initial_overlap: 0.02, overlap: 0.2 }
    }
}

/// A simulation before it begins; SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup {
    /// The materials.
    pub stuffs: Vec<Stuff>,
    /// What pairs of them do to each other, where it does not follow from each.
    pub pairings: Vec<Pairing>,
    /// The grains.
    pub grains: Vec<Grain>,
    /// The walls.
    pub walls: Vec<Wall>,
    /// Gravity, m/s².
    pub gravity: [f64; 3],
    /// The time step.
    pub time_step: TimeStep,
    /// How rolling is resisted.
    pub rolling: Rolling,
    /// Whether contacts have friction; without, there is neither history nor torque.
    pub friction: bool,
    /// Ends of the periodic box along x and y, where it is periodic, m.
    pub periodic: [Option<[f64; 2]>; 2],
    /// Lower and upper corner of the space in which grains are followed; those that leave it are counted as lost, m.
    pub domain: [[f64; 3]; 2],
    /// From which overlap on a contact is taken for a fault.
    pub limits: Limits,
}

impl Setup {
    /// Grains of one material under gravity of 9.81 m/s² along -z, with bounded rolling friction, no walls, a time step of
    /// 20 % of the Rayleigh time and a domain without ends.
    pub fn new(stuff: Stuff, grains: Vec<Grain>) -> Self {
        Self {
            stuffs: vec![stuff],
            pairings: vec![],
            grains,
            walls: vec![],
            gravity: [0.0, 0.0, -9.81],
            time_step: TimeStep::ShareOfRayleigh(0.2),
            rolling: Rolling::Bounded,
            friction: true,
            periodic: [None, None],
            domain: [[f64::NEG_INFINITY; 3], [f64::INFINITY; 3]],
            limits: Limits::default(),
        }
    }
}
