//! The whole method: a start, stones placed, stones settled.

use std::time::Instant;

use rand::SeedableRng as _;
use rand_pcg::Pcg64;

use crate::units::{Metres, Seconds, Share};

use super::bed::Packing;
use super::compaction::compact;
use super::error::{PackingError, positive};
use super::grading::{ClassReading, Grading};
use super::optimise::{CompactionFit, RsaStart, optimise};
use super::porosity::Porosity;
use super::rsa::{ClassFilled, place};

/// How the height and solid share before compaction are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum InputRule {
    /// By equations 7–19 with the paper's fit ([`CompactionFit::PUBLISHED`]).
    #[default]
    Published,
    /// By equations 7–19 with another fit.
    Fit(CompactionFit),
    /// As given.
    Explicit(RsaStart),
}

/// What an RSA packing is made from.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RsaInput {
    /// Width of the bed, `l`.
    pub width: Metres,
    /// Real height of the bed, `h_real`.
    pub height: Metres,
    /// Void share of the real bed, `100 % - P_c`.
    pub voids: Porosity,
    /// The sieve curve.
    pub grading: Grading,
    /// Which diameters a sieve stands for.
    #[serde(default)]
    pub class_reading: ClassReading,
    /// What the positioning starts from.
    #[serde(default)]
    pub input: InputRule,
    /// Height of the strips of the compaction, 2 cm in the paper.
    #[serde(default = "two_centimetres")]
    pub strip: Metres,
}

fn two_centimetres() -> Metres {
    Metres(0.02)
}

impl RsaInput {
    /// The tank of section 5.2.1 of Benedetto et al. 2018: 1.5 m by 48 cm with 42 % voids.
    ///
    /// # Errors
    /// None in practice: the grading is part of the program.
    pub fn benedetto2018() -> Result<Self, PackingError> {
        Ok(Self {
            width: Metres(1.5),
            height: Metres(0.48),
            voids: Porosity::BENEDETTO_2018,
            grading: Grading::benedetto2018()?,
            class_reading: ClassReading::default(),
            input: InputRule::default(),
            strip: two_centimetres(),
        })
    }

    /// The height and the solid share before compaction.
    ///
    /// # Errors
    /// Lengths that are none, a solid share outside 0–100 %, a fit that has no solution for this height.
    pub fn start(&self) -> Result<RsaStart, PackingError> {
        positive("height of the bed", self.height)?;
        let start = match self.input {
            InputRule::Published => optimise(self.height, self.voids, CompactionFit::PUBLISHED)?,
            InputRule::Fit(fit) => optimise(self.height, self.voids, fit)?,
            InputRule::Explicit(start) => start,
        };
        positive("height before compaction", start.height)?;
        if !(start.solid_share.si() > 0.0 && start.solid_share.si() < 1.0) {
            return Err(PackingError::SolidShareOutOfRange { value: start.solid_share });
        }
        Ok(start)
    }
}

/// A packing before and after compaction, and how it came about.
#[derive(Debug, Clone, PartialEq)]
pub struct RsaOutcome {
    /// Height of the domain before compaction.
    pub input_height: Metres,
    /// Solid share of the domain before compaction, as asked for; the stop rule overshoots it by under a stone per class.
    pub input_solid_share: Share,
    /// The stones placed at random, none touching.
    pub before: Packing,
    /// The same stones in the same order, settled.
    pub after: Packing,
    /// What was placed of each class, coarsest first.
    pub classes: Vec<ClassFilled>,
    /// Wall time of sizing and positioning.
    pub seconds_positioning: Seconds,
    /// Wall time of the compaction.
    pub seconds_compaction: Seconds,
}

/// Packs a bed by random sequential adsorption and vertical compaction (Benedetto et al. 2018, section 4).
///
/// The same input and seed give the same discs, bit for bit; the random numbers are PCG XSL 128/64.
///
/// ```
/// use ballast_gpr::packing::{RsaInput, pack};
///
/// let outcome = pack(&RsaInput::benedetto2018()?, 7)?;
/// // The paper starts from 55 cm and wants 48 cm; one packing scatters by 0.8 cm.
/// assert_eq!((outcome.input_height.si() * 100.0).round(), 55.0);
/// assert!((outcome.after.top().si() - 0.48).abs() < 0.03);
/// # Ok::<(), ballast_gpr::packing::PackingError>(())
/// ```
///
/// # Errors
/// An input that makes no sense, a stone larger than the domain, too many stones, a jam.
pub fn pack(input: &RsaInput, seed: u64) -> Result<RsaOutcome, PackingError> {
    let width = positive("width of the bed", input.width)?;
    let strip = positive("strip height", input.strip)?;
    let start = input.start()?;
    let classes = input.grading.classes(input.class_reading)?;
    let clock = Instant::now();
    let mut random = Pcg64::seed_from_u64(seed);
    let placed = place(&classes, (width, start.height.si()), start.solid_share.si(), &mut random)?;
    let seconds_positioning = Seconds(clock.elapsed().as_secs_f64());
    let before = Packing::new("rsa", Some(seed), (input.width, start.height), placed.discs);
    let clock = Instant::now();
    let settled = compact(&before.discs, width, strip);
    let seconds_compaction = Seconds(clock.elapsed().as_secs_f64());
    let mut after = Packing::new("rsa-compacted", Some(seed), (input.width, input.height), settled);
    after.height = after.top();
    Ok(RsaOutcome {
        input_height: start.height,
        input_solid_share: start.solid_share,
        before,
        after,
        classes: placed.classes,
        seconds_positioning,
        seconds_compaction,
    })
}
