//! From a sieve curve to a bed at rest.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::Path;

use rand::SeedableRng as _;
use rand_pcg::Pcg64;

use crate::geometry::Sphere;
use crate::packing::error::{PackingError, positive};
use crate::packing::spheres::{SphereBed, mean_stone_volume, place_spheres, stone_diameters};
use crate::units::Metres;

use super::error::SettleError;
use super::keep::{Before, Place};
use super::spec::{SettleInput, Settled, Settling};
use super::stage::{self, FALL, FALL_RUBBING, REST, begin};

/// Solid share that frictionless stones reach at most: as many as that are dropped, and what stands above is struck off.
const DENSEST: f64 = 0.64;

/// Settles a bed: draws stones by mass from the grading, places them loosely in a column above the floor, lets them fall without
/// friction (which packs them densely; with it where [`friction_while_falling`](super::SettleSpec::friction_while_falling) says
/// so), strikes off those whose centres lie above the bed's height (unless their number was given), and lets the rest come to
/// rest with friction.
///
/// Where there is a folder to `keep` things in, a run that is stopped leaves its state there ([`STATE`](super::STATE),
/// [`STAGE`](super::STAGE)); a later call with the same input and seed goes on from it, to the same bits, and removes it when the
/// bed is done.
///
/// The same input and seed give the same bed, bit for bit, on any number of threads.
///
/// # Errors
/// See [`SettleError`]; `Stopped` when `on_progress` asks for it.
pub fn settle(
    input: &SettleInput,
    seed: u64,
    threads: NonZeroUsize,
    keep: Option<&Path>,
    on_progress: &dyn Fn(Settling) -> ControlFlow<()>,
) -> Result<Settled, SettleError> {
    let how = &input.how;
    for (key, value) in [
        ("energy_ratio", how.energy_ratio),
        ("unbalanced_ratio", how.unbalanced_ratio),
        ("longest", how.longest.si()),
        ("column", how.column.si()),
    ] {
        if value.is_nan() || value <= 0.0 {
            return Err(SettleError::NotAboveZero { key, value });
        }
    }
    let mut place = Place { input, seed, threads, keep, on_progress, before: Vec::new() };
    let first = if how.friction_while_falling { FALL_RUBBING } else { FALL };
    let kept_state = place.read();
    let limit = if how.stones.is_some() { f64::INFINITY } else { input.size[2].si() };
    let (mut simulation, name) = match kept_state {
        Some((simulation, before)) => {
            let name = if before.is_empty() { first } else { REST };
            place.before = before;
            (simulation, name)
        }
        None => (begin(input, loose_column(input, seed)?, how.friction_while_falling, threads)?, first),
    };
    if name == first {
        let fallen = stage::run(&place, first, &mut simulation)?;
        let (kept, above): (Vec<Sphere>, Vec<Sphere>) = fallen.spheres.iter().partition(|s| s.centre[2] <= limit);
        place.before = vec![Before { stage: fallen.stage, struck_off: above.len(), lost: fallen.lost }];
        simulation = begin(input, kept, true, threads)?;
    }
    let rested = stage::run(&place, REST, &mut simulation)?;
    place.remove()?;
    let Some(fallen) = place.before.pop() else { return Err(SettleError::Stopped) };
    let mut bed = SphereBed::new("dem", Some(seed), input.size, rested.spheres);
    bed.periodic = input.periodic;
    bed.contacts = rested.contacts;
    Ok(Settled {
        bed,
        struck_off: fallen.struck_off,
        lost: fallen.lost + rested.lost,
        time_step: rested.time_step,
        stages: vec![fallen.stage.clone(), rested.stage],
    })
}

/// The stones in a column over the floor, none touching another.
fn loose_column(input: &SettleInput, seed: u64) -> Result<Vec<Sphere>, PackingError> {
    let length = positive("length of the box", input.size[0])?;
    let width = positive("width of the box", input.size[1])?;
    let height = positive("height of the bed", input.size[2])?;
    let classes = input.grading.classes(input.class_reading)?;
    let largest = classes.iter().map(|class| class.largest.si()).fold(0.0, f64::max);
    let dropped = length * width * (height + 0.5 * largest) * DENSEST;
    let count = input.how.stones.unwrap_or((dropped / mean_stone_volume(&classes)).round() as usize).max(1);
    let mut random = Pcg64::seed_from_u64(seed);
    let diameters = stone_diameters(&classes, count, &mut random);
    let volume: f64 = diameters.iter().map(|d| std::f64::consts::PI / 6.0 * d.powi(3)).sum();
    let column = (volume / (length * width * input.how.column.si())).max(2.0 * largest);
    place_spheres(diameters, [input.size[0], input.size[1], Metres(column)], input.periodic, &mut random)
}
