//! What can be wrong with a set-up, and what stops a run.

use crate::files::FileError;
use crate::units::{Metres, Seconds};

/// Why spheres cannot be simulated, or why a run was stopped.
#[derive(Debug, thiserror::Error)]
pub enum DemError {
    /// A property of a material outside its range.
    #[error("the {property} of material {material} is {value}, and must be {wanted}")]
    Property {
        /// Index of the material.
        material: usize,
        /// Name of the property.
        property: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        wanted: &'static str,
    },
    /// An index of a material that does not exist.
    #[error("{who} {index} is of material {material}, and there are {materials} (counted from 0)")]
    NoSuchMaterial {
        /// `grain`, `wall` or `pairing`.
        who: &'static str,
        /// Its index.
        index: usize,
        /// The material it names.
        material: usize,
        /// How many there are.
        materials: usize,
    },
    /// A number that is not finite, or a length that is not above zero.
    #[error("the {what} of {who} {index} is {value}, and must be {wanted}")]
    BadNumber {
        /// `grain`, `wall`, …
        who: &'static str,
        /// Its index.
        index: usize,
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        wanted: &'static str,
    },
    /// A box that is too small.
    #[error(
        "the {what} is {size} wide along {axis}, and the largest stone has {diameter}\n\nhint: make it at least {least} wide"
    )]
    BoxTooSmall {
        /// `domain` or `periodic box`.
        what: &'static str,
        /// The axis.
        axis: char,
        /// Its width.
        size: Metres,
        /// Diameter of the largest grain.
        diameter: Metres,
        /// The least width.
        least: Metres,
    },
    /// A time step beyond what is stable.
    #[error(
        "the time step of {} is beyond the limit of {} (Rayleigh time of grain {grain}, diameter {:.1} mm)\n\nhint: take 20 % of it, {}",
        readable(*step), readable(*limit), 1e3 * diameter.si(), readable(*good)
    )]
    TimeStepTooLong {
        /// What was asked for.
        step: Seconds,
        /// The Rayleigh time.
        limit: Seconds,
        /// The grain that gives the limit.
        grain: usize,
        /// Its diameter.
        diameter: Metres,
        /// A fifth of the limit.
        good: Seconds,
    },
    /// Grains that overlap so deeply that they would be shot apart.
    #[error(
        "grains {first} and {second} overlap by {:.4} mm at the start, {share:.1} % of the smaller radius; the limit is {limit:.1} %\n\nhint: place them without overlap, or relax the packing with softer grains first",
        1e3 * overlap.si()
    )]
    DeepOverlap {
        /// One grain.
        first: usize,
        /// The other.
        second: usize,
        /// Their overlap.
        overlap: Metres,
        /// In per cent of the smaller radius.
        share: f64,
        /// The limit, per cent.
        limit: f64,
    },
    /// A grain that is too deep in a wall at the start.
    #[error(
        "grain {grain} lies {:.4} mm deep in wall {wall} at the start, {share:.1} % of its radius; the limit is {limit:.1} %\n\nhint: move it off the wall",
        1e3 * overlap.si()
    )]
    DeepInWall {
        /// The grain.
        grain: usize,
        /// The wall.
        wall: usize,
        /// How deep.
        overlap: Metres,
        /// In per cent of the radius.
        share: f64,
        /// The limit, per cent.
        limit: f64,
    },
    /// A motion that a wall cannot make.
    #[error("wall {wall} cannot move so: {why}")]
    Motion {
        /// The wall.
        wall: usize,
        /// The reason.
        why: &'static str,
    },
    /// A grain that moves so fast that it may pass through others.
    #[error(
        "stopped at step {step}: grain {grain} moves at {speed:.3} m/s, {share:.0} % of the smallest radius in one step; the limit is 10 %\n\nhint: take a shorter time step, or look for overlaps at the start"
    )]
    TooFast {
        /// The step.
        step: u64,
        /// The grain.
        grain: usize,
        /// Its speed, m/s.
        speed: f64,
        /// What it travels in a step, per cent of the smallest radius.
        share: f64,
    },
    /// A contact that is too deep.
    #[error(
        "stopped at step {step}: grain {grain} is pressed {share:.0} % of a radius into its neighbour or a wall; the limit is {limit:.0} %\n\nhint: take stiffer grains, a shorter time step, or slower bodies"
    )]
    TooDeep {
        /// The step.
        step: u64,
        /// The grain.
        grain: usize,
        /// The overlap, per cent of the smaller radius.
        share: f64,
        /// The limit, per cent.
        limit: f64,
    },
    /// Energy that comes from nowhere.
    #[error(
        "stopped at step {step}: the energy has grown from {before:.3e} J to {now:.3e} J without a source; grain {grain} has the most, at {speed:.3} m/s\n\nhint: take a shorter time step; {share:.0} % of the Rayleigh time is in use, and 20 % is usual"
    )]
    EnergyGrows {
        /// The step.
        step: u64,
        /// Least mechanical energy so far, from the state of the last change, J.
        before: f64,
        /// Mechanical energy now, J.
        now: f64,
        /// The grain with the most kinetic energy.
        grain: usize,
        /// Its speed, m/s.
        speed: f64,
        /// The time step, per cent of the Rayleigh time.
        share: f64,
    },
    /// The caller asked to stop; the simulation can go on.
    #[error("stopped as asked for at step {step}")]
    Stopped {
        /// The step.
        step: u64,
    },
    /// A file that is not a state of a simulation.
    #[error("`{}` cannot be gone on from: {what}", path.display())]
    NotAState {
        /// The file.
        path: std::path::PathBuf,
        /// How this shows.
        what: String,
    },
    /// The system does not let us read or write a file.
    #[error("failed to {0}")]
    File(#[from] FileError),
}

/// A time with three digits in the unit that fits it, as it can be typed.
fn readable(time: Seconds) -> String {
    let seconds = time.si();
    let (unit, scale) = match seconds {
        _ if seconds >= 1.0 => ("s", 1.0),
        _ if seconds >= 1e-3 => ("ms", 1e3),
        _ if seconds >= 1e-6 => ("us", 1e6),
        _ => ("ns", 1e9),
    };
    let value = scale * seconds;
    let digits = if value < 10.0 { 2 } else { usize::from(value < 100.0) };
    format!("{value:.digits$} {unit}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_has_three_digits_and_reads_back() {
        for (seconds, said) in [
            (5e-3, "5.00 ms"),
            (46.907_138e-6, "46.9 us"),
            (9.381_427e-6, "9.38 us"),
            (123.4e-9, "123 ns"),
            (2.0, "2.00 s"),
        ] {
            assert_eq!(readable(Seconds(seconds)), said);
            let again: Seconds = said.parse().unwrap();
            assert!((again.si() / seconds - 1.0).abs() < 5e-3);
        }
    }
}
