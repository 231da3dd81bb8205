//! What can be wrong with a grading.

use crate::units::{Metres, Share};

/// Why a sieve curve is not one.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GradingError {
    /// Fewer than two sieves.
    #[error(
        "a grading needs at least 2 sieves, and this one has {found}\n\nhint: list every sieve with what passes it, from the smallest to the largest"
    )]
    TooFewSieves {
        /// Sieves given.
        found: usize,
    },
    /// A sieve of no size.
    #[error("a sieve of {} is no sieve: its size must be above 0 mm and finite", size.in_unit("mm"))]
    NotASize {
        /// Size given.
        size: Metres,
    },
    /// A share outside 0–100 %.
    #[error("the {} sieve passes {passing}, which is not between 0% and 100%", size.in_unit("mm"))]
    PassingOutOfRange {
        /// Sieve.
        size: Metres,
        /// Share given.
        passing: Share,
    },
    /// A sieve listed twice.
    #[error("the {} sieve is listed twice\n\nhint: keep one row per sieve", size.in_unit("mm"))]
    Duplicate {
        /// Sieve.
        size: Metres,
    },
    /// Sieves out of order.
    #[error(
        "the {} sieve follows the {} sieve: sieves go from the smallest to the largest\n\nhint: put the {} sieve before it",
        size.in_unit("mm"), previous.in_unit("mm"), size.in_unit("mm")
    )]
    NotAscending {
        /// The sieve before.
        previous: Metres,
        /// The sieve that should have been larger.
        size: Metres,
    },
    /// Less passes a larger sieve than a smaller one.
    #[error(
        "the {} sieve passes {larger_passing} but the smaller {} sieve passes {smaller_passing}: what passes a sieve passes every larger one\n\nhint: give the share that passes, not the share retained",
        larger.in_unit("mm"), smaller.in_unit("mm")
    )]
    NotMonotone {
        /// Smaller sieve.
        smaller: Metres,
        /// What passes it.
        smaller_passing: Share,
        /// Larger sieve.
        larger: Metres,
        /// What passes it.
        larger_passing: Share,
    },
    /// Stones lie on the top sieve, so that nothing says how large they are.
    #[error(
        "the top sieve of {} passes {passing}, so nothing says how large the other stones are\n\nhint: add a larger sieve that passes 100%",
        size.in_unit("mm")
    )]
    TopSieveRetains {
        /// Largest sieve.
        size: Metres,
        /// What passes it.
        passing: Share,
    },
    /// Too much passes the smallest sieve.
    #[error(
        "{passing} passes the smallest sieve of {}, and nothing says how small that is: at most {limit} is given the size of the class above\n\nhint: add a smaller sieve",
        size.in_unit("mm")
    )]
    UnsizedShare {
        /// Smallest sieve.
        size: Metres,
        /// What passes it.
        passing: Share,
        /// [`super::LARGEST_UNSIZED_SHARE`].
        limit: Share,
    },
    /// No built-in grading of that name.
    #[error("no grading is called `{name}`\n\nhint: {hint}")]
    UnknownName {
        /// What was asked for.
        name: String,
        /// The nearest name or all of them.
        hint: String,
    },
    /// A CSV without the two columns.
    #[error("the grading begins with `{found}`\n\nhint: the first line must be `sieve_mm,passing_percent`")]
    BadHeader {
        /// The header found.
        found: String,
    },
    /// A CSV row that is not two numbers.
    #[error(
        "line {line} of the grading is `{text}`, not a sieve and what passes it\n\nhint: write for example `31.5,1.2`"
    )]
    BadRow {
        /// Line number, from 1.
        line: u64,
        /// The line.
        text: String,
    },
}
