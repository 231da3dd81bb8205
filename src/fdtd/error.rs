//! Why the embedded solver gave no traces.

use super::checkpoint::CheckpointError;
use super::instructions::InstructionSet;
use crate::forward::ForwardError;
use crate::model::{Axis, CheckError, Order, PaintError, SnapshotError};

/// Why the embedded solver gave no traces.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FdtdError {
    /// The objects cannot be painted.
    #[error(transparent)]
    Paint(#[from] PaintError),
    /// The model cannot be run on this grid or machine.
    #[error(transparent)]
    Check(#[from] CheckError),
    /// Differences of fourth order in three dimensions, with something that they do not take.
    #[error(
        "differences of order {order} in three dimensions do not take {what}\n\nhint: `--order 2`, or `## ballast-gpr: order 2` in the file"
    )]
    OrderInThree {
        /// What the model asks for.
        order: Order,
        /// What it holds.
        what: &'static str,
    },
    /// A magnetic material.
    #[error(
        "`{material}` is magnetic (mu_r {mu_r}, magnetic loss {sigma_magnetic} ohm/m), which the embedded solver does not \
         know\n\nhint: run it with `--solver gprmax`"
    )]
    Magnetic {
        /// Identifier of the material.
        material: String,
        /// Its relative permeability.
        mu_r: f64,
        /// Its magnetic loss, ohm/m.
        sigma_magnetic: f64,
    },
    /// A material with more Debye poles than there are kernels for.
    #[error("`{material}` has {poles} Debye poles, at most {most} are known\n\nhint: run it with `--solver gprmax`")]
    TooManyPoles {
        /// Identifier of the material.
        material: String,
        /// Its poles.
        poles: usize,
        /// The most that are known.
        most: usize,
    },
    /// A material with a Lorentz pole, in the loops for two dimensions along z.
    #[error("`{material}` has a Lorentz pole, which the loops for two dimensions do not know")]
    Rings {
        /// Identifier of the material.
        material: String,
    },
    /// A Lorentz pole that does not ring.
    #[error(
        "`{material}` has a Lorentz pole of {frequency} Hz damped by {damping} 1/s, which must be below 2 pi times its frequency\n\n\
         hint: two Debye poles describe a resonance that does not ring"
    )]
    Overdamped {
        /// Identifier of the material.
        material: String,
        /// Frequency of the resonance, Hz.
        frequency: f64,
        /// Its damping, 1/s.
        damping: f64,
    },
    /// A Lorentz pole that the time step cannot follow.
    #[error(
        "`{material}` has a Lorentz pole of {frequency} Hz, which turns by {turn:.2} rad in a time step, more than the {most} \
         that the scheme can follow\n\nhint: smaller cells, or the pole's strength as plain permittivity"
    )]
    ResonanceTooFast {
        /// Identifier of the material.
        material: String,
        /// Frequency of the resonance, Hz.
        frequency: f64,
        /// Its angle in a time step, rad.
        turn: f64,
        /// The largest angle.
        most: f64,
    },
    /// A material with a value that nature does not have.
    #[error("`{material}` has a {quantity} of {value}, but at least {least} is needed")]
    Material {
        /// Identifier of the material.
        material: String,
        /// Which value.
        quantity: &'static str,
        /// The value.
        value: f64,
        /// The least it may be.
        least: f64,
    },
    /// A source or receiver outside the grid.
    #[error("{what} lies outside the grid: {} = {position} m, but the grid ends at {size} m", axis.name())]
    OutsideGrid {
        /// Its name, or `source 1`.
        what: String,
        /// Along which axis.
        axis: Axis,
        /// Where, m.
        position: f64,
        /// Size of the grid along this axis, m.
        size: f64,
    },
    /// A source on the outer wall, where E is zero.
    #[error("source {number} lies on the outer wall, at node ({i}, {j}), where E stays zero\n\nhint: move it inwards")]
    SourceOnWall {
        /// Place in the list of sources, from 1.
        number: usize,
        /// Node along x.
        i: usize,
        /// Node along y.
        j: usize,
    },
    /// A source in a perfect conductor, where E is zero.
    #[error("source {number} lies in a perfect conductor, at node ({i}, {j}), where E stays zero\n\nhint: move it out")]
    SourceInConductor {
        /// Place in the list of sources, from 1.
        number: usize,
        /// Node along x.
        i: usize,
        /// Node along y.
        j: usize,
    },
    /// A source across the plane, which drives fields that a grid along z does not hold.
    #[error(
        "source {number} is polarised along {}: a two-dimensional grid along z holds only sources along z\n\n\
         hint: turn it to z, or run it with `--solver gprmax`",
        axis.name()
    )]
    Polarisation {
        /// Place in the list of sources, from 1.
        number: usize,
        /// Its direction.
        axis: Axis,
    },
    /// A source that only the way of three dimensions knows, in a painted model of the plane.
    #[error("source {number} is a {kind}, which the loops for two dimensions do not know")]
    NotInPlane {
        /// Place in the list of sources, from 1.
        number: usize,
        /// What it is.
        kind: &'static str,
    },
    /// A voltage source with a resistance that is none.
    #[error("source {number} has a resistance of {resistance} ohm, it must be 0 or more and finite")]
    Resistance {
        /// Place in the list of sources, from 1.
        number: usize,
        /// Its resistance, ohm.
        resistance: f64,
    },
    /// A voltage without resistance in a dispersive material.
    #[error(
        "source {number}, a voltage without resistance, lies in a dispersive material, at node ({}, {}, {})\n\n\
         hint: `--solver gprmax` runs the file in gprMax itself",
        node[0], node[1], node[2]
    )]
    SetInDispersive {
        /// Place in the list of sources, from 1.
        number: usize,
        /// Its node.
        node: [usize; 3],
    },
    /// A magnetic dipole on the outer wall, where H across it is zero, or beyond the last face.
    #[error(
        "source {number}, a magnetic dipole along {}, lies on the outer wall or at its last node, ({}, {}, {}), where H stays \
         zero\n\nhint: move it inwards",
        axis.name(), node[0], node[1], node[2]
    )]
    MagneticOnWall {
        /// Place in the list of sources, from 1.
        number: usize,
        /// Its direction.
        axis: Axis,
        /// Its node.
        node: [usize; 3],
    },
    /// A source with a waveform that the model does not hold.
    #[error("source {number} asks for waveform number {waveform}, but the model has {waveforms}")]
    NoSuchWaveform {
        /// Place in the list of sources, from 1.
        number: usize,
        /// The index asked for.
        waveform: usize,
        /// How many there are.
        waveforms: usize,
    },
    /// Instructions that this machine does not have.
    #[error("this machine has no {} instructions\n\nhint: leave the choice to the program", set.name())]
    NoSuchInstructions {
        /// What was asked for.
        set: InstructionSet,
    },
    /// Fields that grew beyond reason.
    #[error(
        "the field at step {step} is {value:e} V/m at node ({i}, {j}), ({x} m, {y} m): the run diverged\n\n\
         hint: please report the model; a smaller `#time_step_stability_factor` may help"
    )]
    Diverged {
        /// Step at which it was seen.
        step: usize,
        /// Node along x.
        i: usize,
        /// Node along y.
        j: usize,
        /// Position of the node, m.
        x: f64,
        /// Position of the node, m.
        y: f64,
        /// E there, V/m.
        value: f64,
    },
    /// A source on the outer wall of a three-dimensional grid, where E is zero.
    #[error(
        "source {number}, along {}, lies on the outer wall, at node ({}, {}, {}), where E stays zero\n\n\
         hint: move it inwards",
        axis.name(), node[0], node[1], node[2]
    )]
    OnWall {
        /// Place in the list of sources, from 1.
        number: usize,
        /// Its direction.
        axis: Axis,
        /// Its node.
        node: [usize; 3],
    },
    /// A source in a perfect conductor of a three-dimensional grid, where E is zero.
    #[error(
        "source {number} lies in a perfect conductor, at node ({}, {}, {}), where E stays zero\n\nhint: move it out",
        node[0], node[1], node[2]
    )]
    InConductor {
        /// Place in the list of sources, from 1.
        number: usize,
        /// Its node.
        node: [usize; 3],
    },
    /// A source along an axis along which a two-dimensional model holds no field.
    #[error(
        "source {number} drives a field along {}, which a two-dimensional model ({mode} across {}) does not hold",
        axis.name(), invariant.name()
    )]
    Across {
        /// Place in the list of sources, from 1.
        number: usize,
        /// Direction of the field.
        axis: Axis,
        /// The axis along which nothing changes.
        invariant: Axis,
        /// `TM` or `TE`.
        mode: &'static str,
    },
    /// A source that does not lie on the one layer of nodes that holds the fields of a TE model.
    #[error(
        "source {number} lies at node {node} along {}, but the fields of a TE model are at node 1\n\n\
         hint: move it one cell size up from 0 along {}",
        axis.name(), axis.name()
    )]
    BetweenWalls {
        /// Place in the list of sources, from 1.
        number: usize,
        /// The axis along which nothing changes.
        axis: Axis,
        /// Its node along this axis.
        node: usize,
    },
    /// More stretches than a boundary of second order has.
    #[error("the absorbing boundary has {count} stretches (`#pml_cfs`), at most 2 are known")]
    Stretches {
        /// How many there are.
        count: usize,
    },
    /// A stretch that is none.
    #[error(
        "the absorbing boundary has a kappa of {kappa} at {depth} cells from its entrance, and a least value of {least}: kappa \
         must be above 0, alpha and sigma 0 or more"
    )]
    Shrinks {
        /// Depth, cells.
        depth: f64,
        /// The real stretch there.
        kappa: f64,
        /// The least of all values there.
        least: f64,
    },
    /// Two stretches that together amplify some frequency.
    #[error(
        "the two stretches of the absorbing boundary together amplify some frequency at {depth} cells from the entrance\n\n\
         hint: give the second an alpha of 1.1 times the sigma of the first, or leave one `#pml_cfs` out"
    )]
    Amplifies {
        /// Depth, cells.
        depth: f64,
    },
    /// Fields of a three-dimensional run that grew beyond reason.
    #[error(
        "E{} at step {step} is {value:e} V/m at node ({}, {}, {}), ({} m, {} m, {} m): the run diverged\n\n\
         hint: please report the model; a smaller `#time_step_stability_factor` may help",
        axis.name(), node[0], node[1], node[2], position[0], position[1], position[2]
    )]
    DivergedAt {
        /// Step at which it was seen.
        step: usize,
        /// Component of E.
        axis: Axis,
        /// Where.
        node: [usize; 3],
        /// Position of the node, m.
        position: [f64; 3],
        /// E there, V/m.
        value: f64,
    },
    /// A checkpoint that the run cannot go on from.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// A snapshot that cannot be taken of this model.
    #[error(transparent)]
    NoSnapshot(#[from] SnapshotError),
    /// A snapshot that was taken, and then could not be kept.
    #[error("snapshot {number}: failed to {reason}")]
    Snapshot {
        /// Place in the list of snapshots, from 1.
        number: usize,
        /// What the system said.
        reason: String,
    },
    /// A snapshot of an earlier part of the run that is not there any more.
    #[error(
        "the checkpoint was written after step {begun}, but snapshot {number}, of step {step}, is not there\n\n\
         hint: begin anew with `--fresh`"
    )]
    SnapshotGone {
        /// Place in the list of snapshots, from 1.
        number: usize,
        /// Its step.
        step: usize,
        /// Steps made by the checkpoint.
        begun: usize,
    },
    /// The caller asked to stop.
    #[error("stopped on request")]
    Stopped,
}

impl From<FdtdError> for ForwardError {
    fn from(error: FdtdError) -> Self {
        match error {
            FdtdError::Stopped => Self::Stopped,
            FdtdError::Diverged { .. }
            | FdtdError::DivergedAt { .. }
            | FdtdError::NoSuchInstructions { .. }
            | FdtdError::Snapshot { .. } => Self::Solver(Box::new(error)),
            model => Self::Model(Box::new(model)),
        }
    }
}
