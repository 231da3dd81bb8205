//! What can go wrong between a grading and a packing.

use crate::units::{Metres, Share};

use super::grading::GradingError;

/// Why a packing could not be made, read or calibrated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PackingError {
    /// The grading is not one, or cannot be split into classes.
    #[error(transparent)]
    Grading(#[from] GradingError),
    /// Voids of 0 % or less.
    #[error("voids of {voids} leave no space between the stones\n\nhint: the tank of Benedetto et al. 2018 had 42%")]
    NoVoids {
        /// What was asked for.
        voids: Share,
    },
    /// Voids of 100 % or more.
    #[error("voids of {voids} leave no stones\n\nhint: the tank of Benedetto et al. 2018 had 42%")]
    NoStones {
        /// What was asked for.
        voids: Share,
    },
    /// Voids that are not a number.
    #[error("the voids are not a number\n\nhint: the tank of Benedetto et al. 2018 had 42%")]
    VoidsNotANumber,
    /// A length that is zero, negative or infinite.
    #[error("the {what} of {value} is not a length to build with: it must be above 0 m and finite")]
    NotALength {
        /// `width of the tank`, `strip height`, …
        what: &'static str,
        /// What was asked for.
        value: Metres,
    },
    /// An input solid share outside 0–100 %.
    #[error("an input solid share of {value} is not between 0% and 100%\n\nhint: the paper's tank starts from 50%")]
    SolidShareOutOfRange {
        /// What was asked for.
        value: Share,
    },
    /// Equations 7–19 have no solution, or a useless one, for this height.
    #[error(
        "the compaction fit (alpha {}, beta {}) gives no input height for a bed of {}: it holds from {} upwards\n\nhint: refit it to this grading and height with `--calibrate`",
        alpha.in_unit("cm"), beta.in_unit("cm"), height.in_unit("cm"), lowest.in_unit("cm")
    )]
    FitDiverges {
        /// Slope of the fit.
        alpha: Metres,
        /// Offset of the fit.
        beta: Metres,
        /// The height asked for.
        height: Metres,
        /// The lowest height for which the input height is at most double the real one.
        lowest: Metres,
    },
    /// A fit whose slope does not exceed its offset.
    #[error(
        "the compaction fit (alpha {}, beta {}) says that a bed does not settle: alpha must be above beta\n\nhint: the paper has alpha 22.5 cm and beta 18.6 cm",
        alpha.in_unit("cm"), beta.in_unit("cm")
    )]
    FitDoesNotSettle {
        /// Slope of the fit.
        alpha: Metres,
        /// Offset of the fit.
        beta: Metres,
    },
    /// A class holds stones that are larger than the domain.
    #[error(
        "stone larger than the tank: stones reach {} but the tank is {} wide and {} high before compaction\n\nhint: choose a finer grading, or widen the tank (the paper keeps it ten stones wide)",
        diameter.in_unit("mm"), width.in_unit("m"), height.in_unit("m")
    )]
    StoneLargerThanTank {
        /// Largest diameter of the coarsest class.
        diameter: Metres,
        /// Width of the domain.
        width: Metres,
        /// Height of the domain before compaction.
        height: Metres,
    },
    /// More stones than a packing can hold.
    #[error(
        "this bed needs about {expected} stones of {} to {}, and at most {limit} are packed\n\nhint: leave the finest sieves out of the grading, or take a smaller tank",
        smallest.in_unit("mm"), largest.in_unit("mm")
    )]
    TooManyStones {
        /// Expected number of stones in the class.
        expected: u64,
        /// What is allowed.
        limit: u64,
        /// Smallest diameter of the class.
        smallest: Metres,
        /// Largest diameter of the class.
        largest: Metres,
    },
    /// No room is left for any stone of a class.
    #[error(
        "jammed: no room is left for a stone of the class {} to {} after {placed} of its area, with {solid_share} of the domain covered and {wanted} wanted\n\nhint: try another `--seed`, or a higher input height with a lower input solid share",
        smallest.in_unit("mm"), largest.in_unit("mm")
    )]
    Jammed {
        /// Smallest diameter of the class.
        smallest: Metres,
        /// Largest diameter of the class.
        largest: Metres,
        /// Share of the class area that was placed (rounded to 0.1 %).
        placed: Share,
        /// Share of the domain that is covered (rounded to 0.1 %).
        solid_share: Share,
        /// Share of the domain that was to be covered (rounded to 0.1 %).
        wanted: Share,
    },
    /// Two discs of a packing that was read overlap.
    #[error(
        "stones {first} and {second} overlap by {}, more than the {} allowed\n\nhint: stones are counted from 1 in the order of the file",
        depth.in_unit("mm"), tolerance.in_unit("mm")
    )]
    Overlap {
        /// Number of one disc, counted from 1.
        first: usize,
        /// Number of the other.
        second: usize,
        /// How deep they overlap.
        depth: Metres,
        /// What is allowed.
        tolerance: Metres,
    },
    /// A disc of a packing that was read leaves its domain.
    #[error(
        "stone {number} at x {}, y {} with radius {} leaves the domain of {} by {}",
        x.in_unit("m"), y.in_unit("m"), radius.in_unit("mm"), width.in_unit("m"), height.in_unit("m")
    )]
    Outside {
        /// Number of the disc, counted from 1.
        number: usize,
        /// Its centre.
        x: Metres,
        /// Its centre.
        y: Metres,
        /// Its radius.
        radius: Metres,
        /// Width of the domain.
        width: Metres,
        /// Height of the domain.
        height: Metres,
    },
    /// A stone that is larger than the box it is to lie in.
    #[error(
        "stone larger than the box: stones reach {} but the box is {} by {} by {}\n\nhint: choose a finer grading or a larger box",
        tenth_of_a_millimetre(*diameter).in_unit("mm"), size[0].in_unit("m"), size[1].in_unit("m"), size[2].in_unit("m")
    )]
    StoneLargerThanBox {
        /// Diameter of the largest stone.
        diameter: Metres,
        /// Length, width and height of the box.
        size: [Metres; 3],
    },
    /// Random addition found no room for a sphere.
    #[error(
        "no room is left for stone {} of {stones} ({}): {solid_share} of the box is stone, and {wanted} was wanted\n\nhint: random addition of spheres ends near 38%; ask for less, or let them settle with `--method dem`",
        placed + 1, tenth_of_a_millimetre(*diameter).in_unit("mm")
    )]
    BoxIsFull {
        /// Diameter of the stone that found no room.
        diameter: Metres,
        /// Stones placed before it.
        placed: usize,
        /// Stones in all.
        stones: usize,
        /// Share of the box that is stone (rounded to 0.1 %).
        solid_share: Share,
        /// Share that was to be (rounded to 0.1 %).
        wanted: Share,
    },
    /// A sphere of a bed that was read leaves its box.
    #[error(
        "stone {number} at x {}, y {}, z {} with radius {} leaves the box of {} by {} by {}",
        centre[0].in_unit("m"), centre[1].in_unit("m"), centre[2].in_unit("m"), radius.in_unit("mm"),
        size[0].in_unit("m"), size[1].in_unit("m"), size[2].in_unit("m")
    )]
    OutsideBox {
        /// Number of the sphere, counted from 1.
        number: usize,
        /// Its centre.
        centre: [Metres; 3],
        /// Its radius.
        radius: Metres,
        /// Length, width and height of the box.
        size: [Metres; 3],
    },
    /// A contact of a sphere that is not in the bed.
    #[error("contact {contact} is one of a stone that is not there: the bed holds {stones} stones")]
    NoSuchStone {
        /// Number of the contact, counted from 1.
        contact: usize,
        /// Number of stones.
        stones: usize,
    },
    /// A section outside the bed.
    #[error("the plane {axis} = {} lies outside the bed\n\nhint: take one from 0 m to {}", at.in_unit("m"), limit.in_unit("m"))]
    PlaneOutside {
        /// `x` or `y`.
        axis: &'static str,
        /// Where the plane lies.
        at: Metres,
        /// How far the bed reaches.
        limit: Metres,
    },
    /// A section without a single stone.
    #[error("the plane {axis} = {} meets no stone\n\nhint: take one further inside", at.in_unit("m"))]
    EmptySlice {
        /// `x` or `y`.
        axis: &'static str,
        /// Where the plane lies.
        at: Metres,
    },
    /// A row of a CSV packing that cannot be read.
    #[error("line {line} of the packing is `{text}`, not a stone\n\nhint: {hint}")]
    BadRow {
        /// Line number, from 1.
        line: u64,
        /// The line.
        text: String,
        /// What is expected.
        hint: &'static str,
    },
    /// A packing without a single disc.
    #[error(
        "the packing holds no stones\n\nhint: one stone per line: x,y,radius in metres, below the header `x,y,radius`"
    )]
    Empty,
    /// A JSON packing that cannot be read.
    #[error("the packing is not valid JSON of this program: {reason}")]
    BadJson {
        /// What the reader said.
        reason: String,
    },
    /// A JSON packing from a later program.
    #[error("the packing has format version {found}, and this program reads {known}")]
    FormatVersion {
        /// What the file says.
        found: u32,
        /// What is known.
        known: u32,
    },
    /// The DXF writer refused.
    #[error("the drawing could not be made: {reason}")]
    Drawing {
        /// What the writer said.
        reason: String,
    },
    /// Too few calibration runs got through.
    #[error(
        "the compaction fit needs at least 2 steps that do not jam, and {worked} of {tried} worked\n\nhint: step further up: a larger last step gives a looser start"
    )]
    CalibrationTooFewPoints {
        /// Steps that worked.
        worked: usize,
        /// Steps tried.
        tried: usize,
    },
    /// A calibration asked for with steps or repeats that make no sense.
    #[error(
        "a calibration from {first} to {last} in steps of {step} with {arrangements} arrangements has no runs\n\nhint: the paper steps by 2.5% with 5 arrangements"
    )]
    CalibrationHasNoRuns {
        /// First step.
        first: Share,
        /// Last step.
        last: Share,
        /// Step.
        step: Share,
        /// Arrangements per step.
        arrangements: usize,
    },
}

/// Refuses lengths that are not above zero and finite.
pub(super) fn positive(what: &'static str, value: Metres) -> Result<f64, PackingError> {
    if value.si() > 0.0 && value.si().is_finite() {
        Ok(value.si())
    } else {
        Err(PackingError::NotALength { what, value })
    }
}

/// A share rounded to 0.1 %, for messages.
pub(super) fn rounded(share: f64) -> Share {
    format!("{:.1}%", share * 100.0).parse().unwrap_or(Share(share))
}

/// A length rounded to a tenth of a millimetre, for messages.
fn tenth_of_a_millimetre(length: Metres) -> Metres {
    Metres((length.si() * 1e4).round() / 1e4)
}
