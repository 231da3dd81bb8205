//! The packing of Benedetto et al. 2018: every number of section 5.2.1.

use std::collections::BTreeMap;
use std::time::Instant;

use rayon::prelude::*;

use crate::cli::error::CliError;
use crate::cli::validate::{CaseReport, report_of};
use crate::packing::{self, ClassReading, PackingError, RsaInput, RsaOutcome};
use crate::study::{Case, MeanAndSpread};

const CASE: &str = include_str!("../../../validation/benedetto2018/case.toml");
/// Seeds of the ensemble.
const SEEDS: u64 = 20;

/// Packs the paper's sample 20 times under both readings of its sieve table.
pub fn validate() -> Result<CaseReport, CliError> {
    let case = Case::read("benedetto2018", CASE)?;
    let input = RsaInput::benedetto2018()?;
    let ensemble = |reading| -> Result<Vec<RsaOutcome>, PackingError> {
        let input = RsaInput { class_reading: reading, ..input.clone() };
        (1..=SEEDS).into_par_iter().map(|seed| packing::pack(&input, seed)).collect()
    };
    let (standard, shifted) = (ensemble(ClassReading::En933)?, ensemble(ClassReading::OneSieveUp)?);
    let mean = |outcomes: &[RsaOutcome], of: &dyn Fn(&RsaOutcome) -> f64| {
        let figures: Vec<f64> = outcomes.iter().map(of).collect();
        MeanAndSpread::of(&figures).map_or((f64::NAN, f64::NAN), |found| (found.mean, found.standard_deviation))
    };
    let start = input.start()?;
    let (height, spread) = mean(&standard, &|outcome| 100.0 * outcome.after.top().si());
    let grading = input.grading.clone();
    let deviation = |sieve: f64| {
        mean(&standard, &|outcome| {
            let rows = outcome.after.grading_table(&grading);
            let row = rows.iter().find(|row| (row.sieve.si() - sieve).abs() < 1e-9);
            row.map_or(f64::NAN, |row| 100.0 * row.deviation().si())
        })
        .0
    };
    let mut times: Vec<f64> = Vec::new();
    for seed in 1..=9 {
        let started = Instant::now();
        packing::pack(&input, seed)?;
        times.push(1e3 * started.elapsed().as_secs_f64());
    }
    times.sort_by(f64::total_cmp);
    let largest = |outcomes: &[RsaOutcome]| {
        outcomes.iter().map(|outcome| 1e3 * outcome.after.largest_diameter().si()).fold(0.0, f64::max)
    };
    let ours = BTreeMap::from([
        ("input_height_cm", 100.0 * start.height.si()),
        ("input_solid_percent", 100.0 * start.solid_share.si()),
        ("final_height_cm", height),
        ("final_height_spread_cm", spread),
        ("final_solid_percent", mean(&standard, &|o| 100.0 * o.after.solid_share().si()).0),
        ("interior_solid_percent", mean(&standard, &|o| 100.0 * o.after.interior_solid_share().si()).0),
        ("stones_en_933", mean(&standard, &|o| o.after.count() as f64).0),
        ("stones_one_sieve_up", mean(&shifted, &|o| o.after.count() as f64).0),
        ("largest_diameter_en_933_mm", largest(&standard)),
        ("largest_diameter_one_sieve_up_mm", largest(&shifted)),
        ("grading_deviation_50mm", deviation(0.05)),
        ("grading_deviation_40mm", deviation(0.04)),
        ("grading_deviation_31_5mm", deviation(0.0315)),
        ("milliseconds", times[times.len() / 2]),
    ]);
    report_of(&format!("benedetto2018: {} ({SEEDS} seeds)", case.title), &case.compare(&ours)?)
}
