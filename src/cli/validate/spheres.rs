//! Beds of settled spheres: the densest and the loosest of equal ones, and the voids of ballast gradings.

use std::collections::BTreeMap;
use std::num::NonZeroUsize;

use crate::cli::error::CliError;
use crate::cli::interrupt;
use crate::cli::progress::Bar;
use crate::cli::validate::{CaseReport, report_of};
use crate::forward::Progress;
use crate::packing::settle::{SettleInput, SettleSpec, settle};
use crate::packing::{ClassReading, Grading, PackingError, SphereBed};
use crate::study::Case;
use crate::units::Metres;

const CASE: &str = include_str!("../../../validation/spheres/case.toml");
/// Built-in sieve curves that are settled.
const GRADINGS: [&str; 5] = ["benedetto2018", "en13450-a", "sbb-32-50", "arema-4", "as2758-60"];
/// Stones of a bed of ballast.
const STONES: usize = 700;
/// Diameter of equal spheres, m, and their number.
const EQUAL: (f64, usize) = (0.04, 560);

/// Friction of a bed.
#[derive(Debug, Clone, Copy)]
struct Rubbing {
    friction: f64,
    rolling_friction: f64,
    while_falling: bool,
}

/// No friction at all.
const NONE: Rubbing = Rubbing { friction: 0.0, rolling_friction: 0.0, while_falling: false };
/// As the paper packs: friction once the stones lie.
const LATER: Rubbing = Rubbing { friction: 0.6, rolling_friction: 0.25, while_falling: false };
/// Stones that are dropped and rub on each other from the start.
const DROPPED: Rubbing = Rubbing { friction: 0.6, rolling_friction: 0.0, while_falling: true };

/// Settles all beds (a minute or two) and compares.
pub fn validate() -> Result<CaseReport, CliError> {
    let case = Case::read("spheres", CASE)?;
    let total = 4 + 2 * GRADINGS.len();
    let bar = Bar::new("settling beds");
    let mut ours: BTreeMap<String, f64> = BTreeMap::new();
    let told = |done: usize| {
        let _ = bar.update(Progress { done, total });
    };
    let dense = equal(NONE)?;
    ours.insert("equal_dense".into(), share(&dense));
    let contacts = dense.coordination(Metres(0.0)).interior_without_rattlers;
    ours.insert("equal_dense_contacts".into(), contacts);
    told(1);
    for (key, rolling_friction) in [("equal_loose", 0.03), ("equal_friction_only", 0.0)] {
        let bed = equal(Rubbing { friction: 1.0, rolling_friction, while_falling: true })?;
        ours.insert(key.into(), share(&bed));
    }
    told(3);
    for (index, name) in GRADINGS.into_iter().enumerate() {
        let key = format!("voids_{}", name.replace('-', "_"));
        ours.insert(format!("{key}_dense"), voids(&ballast(name, LATER)?));
        ours.insert(key, voids(&ballast(name, DROPPED)?));
        told(5 + 2 * index);
    }
    let loose = ballast(GRADINGS[0], Rubbing { while_falling: true, ..LATER })?;
    ours.insert("voids_benedetto2018_loose".into(), voids(&loose));
    drop(bar);
    let rows = case.compare(&ours.iter().map(|(key, value)| (key.as_str(), *value)).collect())?;
    report_of(&format!("spheres: {}", case.title), &rows)
}

fn settled(grading: Grading, side: f64, stones: usize, rubbing: Rubbing) -> Result<SphereBed, CliError> {
    let how = SettleSpec {
        friction: rubbing.friction,
        rolling_friction: rubbing.rolling_friction,
        friction_while_falling: rubbing.while_falling,
        stones: Some(stones),
        ..SettleSpec::default()
    };
    let input = SettleInput {
        size: [Metres(side), Metres(side), Metres(0.4)],
        periodic: [true; 2],
        grading,
        class_reading: ClassReading::En933,
        how,
    };
    let threads = std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
    Ok(settle(&input, 1, threads, None, &|_| interrupt::flow())?.bed)
}

/// A bed of equal spheres, six diameters wide and without sides.
fn equal(rubbing: Rubbing) -> Result<SphereBed, CliError> {
    let (diameter, stones) = EQUAL;
    let sieves = format!("sieve_mm,passing_percent\n{},0\n{},100\n", 999.5 * diameter, 1000.5 * diameter);
    let grading = Grading::from_csv("equal", &sieves).map_err(PackingError::from)?;
    settled(grading, 6.0 * diameter, stones, rubbing)
}

/// Solid share four diameters above the floor, whose layers are denser, to two below the surface.
fn share(bed: &SphereBed) -> f64 {
    let (diameter, [x, y, _]) = (EQUAL.0, bed.size.map(Metres::si));
    bed.solid_share_in([0.0, 0.0, 4.0 * diameter], [x, y, bed.top().si() - 2.0 * diameter]).si()
}

/// A bed of ballast, five largest stones wide and without sides.
fn ballast(name: &str, rubbing: Rubbing) -> Result<SphereBed, CliError> {
    let grading = Grading::named(name).map_err(PackingError::from)?;
    settled(grading, 0.32, STONES, rubbing)
}

/// Voids a largest stone away from floor and surface, %.
fn voids(bed: &SphereBed) -> f64 {
    100.0 * (1.0 - bed.interior_solid_share().si())
}
