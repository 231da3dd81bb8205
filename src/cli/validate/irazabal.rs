//! Spheres with bounded rolling friction: Irazábal, Salazar & Oñate 2017.

use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::path::Path;

use crate::cli::error::{CliError, Kind};
use crate::cli::experiment::{ExperimentName, Specified, in_sight, side_by_side};
use crate::cli::interrupt;
use crate::cli::validate::{CaseReport, Tier, report_of};
use crate::packing::dem::Stuff;
use crate::study::experiments::{
    ExperimentSpec as _, RollingName, RollingRun, RollingSphereSpec, Running, hertz_depth, hertz_duration,
    run_rolling_cases, settle_on_floor, throw,
};
use crate::study::{Case, MeanAndSpread};
use crate::units::{Metres, Pascals, Seconds};

const CASE: &str = include_str!("../../../validation/irazabal2017/case.toml");
const FULL: &str = include_str!("../../../validation/irazabal2017/full.toml");
/// Seeds for each coefficient of rolling friction and each modulus in the full tier.
const SEEDS: u64 = 5;
/// Heaps of the full tier: name, stones, coefficient of rolling friction, modulus in GPa and time step in µs (Table 2).
const REPOSE: [(&str, usize, f64, f64, f64); 7] = [
    ("0_20", 600, 0.20, 17.7, 5.0),
    ("0_25", 600, 0.25, 17.7, 5.0),
    ("0_30", 600, 0.30, 17.7, 5.0),
    ("5_9_gpa", 600, 0.25, 5.9, 8.0),
    ("11_8_gpa", 600, 0.25, 11.8, 6.0),
    ("23_6_gpa", 600, 0.25, 23.6, 4.0),
    ("1200_stones", 1200, 0.25, 17.7, 5.0),
];
/// Curves of KratosMultiphysics 10.4.4, by case and coefficient.
const KRATOS: [(&str, f64, &str); 4] = [
    ("flat", 0.2, include_str!("../../../validation/brof/ai_case1_kratos_brof_eta0.2_R0.1.csv")),
    ("slope", 0.1, include_str!("../../../validation/brof/ai_case2_kratos_brof_eta0.1_R0.1.csv")),
    ("slope", 0.2, include_str!("../../../validation/brof/ai_case2_kratos_brof_eta0.2_R0.1.csv")),
    ("slope", 0.4, include_str!("../../../validation/brof/ai_case2_kratos_brof_eta0.4_R0.1.csv")),
];

/// The rolling ball, impacts and static overlap; in the full tier the angle of repose and the lateral resistance.
pub fn validate(tier: Tier) -> Result<CaseReport, CliError> {
    let case = Case::read("irazabal2017", CASE)?;
    let mut ours = rolling()?;
    ours.extend(contact()?);
    let named = |ours: &BTreeMap<String, f64>, case: &Case| -> Result<Vec<crate::study::Row>, CliError> {
        Ok(case.compare(&ours.iter().map(|(key, value)| (key.as_str(), *value)).collect())?)
    };
    let mut rows = named(&ours, &case)?;
    if tier == Tier::Full {
        let mut ours = repose()?;
        ours.extend(lateral()?);
        rows.extend(named(&ours, &Case::read("irazabal2017", FULL)?)?);
    }
    report_of(&format!("irazabal2017: {}", case.title), &rows)
}

/// The name of a run in keys: `slope_0_2`.
fn key(run: &RollingRun) -> String {
    format!("{}_{}", run.case, run.rolling_friction.to_string().replace('.', "_"))
}

fn rolling() -> Result<BTreeMap<String, f64>, CliError> {
    let spec = RollingSphereSpec::read(RollingSphereSpec::TEMPLATE, Path::new("template"))?;
    let watch = |_: &_| interrupt::flow();
    let running = Running { threads: NonZeroUsize::MIN, watch: &watch, keep_in: None, fresh: true };
    let runs = run_rolling_cases(&spec, &running)?;
    let mut ours = BTreeMap::new();
    for run in runs.iter().filter(|run| run.model == RollingName::Bounded) {
        let mut tell = |what: &str, value: f64| ours.insert(format!("{}_{what}", key(run)), value);
        tell("stop_s", run.stops_at);
        tell("reach_m", run.reach);
        let off = |torque: f64| (torque / run.exact.torque - 1.0).abs();
        tell("torque_off", off(run.torque[0]).max(off(run.torque[1])));
        if let Some(at_rest) = run.exact.torque_at_rest {
            tell("rest_spin", run.spin_at_rest);
            tell("rest_sign_changes", run.sign_changes as f64);
            if at_rest > 0.0 {
                tell("rest_torque_n_m", run.torque_at_rest);
            }
        }
        if let Some((_, _, curve)) =
            KRATOS.iter().find(|(case, eta, _)| *case == run.case && *eta == run.rolling_friction)
        {
            tell("kratos_percent", 100.0 * off_curve(run, curve)?);
        }
    }
    for model in [RollingName::A, RollingName::C] {
        let found = runs.iter().find(|run| run.case == "flat" && run.model == model);
        let changes = found.map_or(f64::NAN, |run| f64::from(run.sign_changes > 0));
        ours.insert(format!("flat_oscillates_{}", model.name()), changes);
    }
    Ok(ours)
}

/// Largest distance between our displacement and that of a curve at the same times, over the largest of the curve.
fn off_curve(run: &RollingRun, curve: &str) -> Result<f64, CliError> {
    let broken = || CliError::new(Kind::Fault, "a stored curve of Kratos cannot be read");
    let (mut most, mut reach, mut count) = (0.0_f64, 0.0_f64, 0);
    for (line, sample) in curve.lines().filter(|line| !line.starts_with(['#', 't'])).zip(&run.samples) {
        let mut cells = line.split(',').map(str::parse::<f64>);
        let (Some(Ok(time)), Some(Ok(way))) = (cells.next(), cells.next()) else { return Err(broken()) };
        if (time - sample[0]).abs() > 1e-6 {
            return Err(broken());
        }
        most = most.max((way - sample[1]).abs());
        reach = reach.max(way.abs());
        count += 1;
    }
    if count < 1000 { Err(broken()) } else { Ok(most / reach) }
}

fn contact() -> Result<BTreeMap<String, f64>, CliError> {
    let (radius, stone) = (Metres(0.025), Stuff::BALLAST);
    let with = |restitution| Stuff { restitution, ..stone };
    let elastic = throw(with(1.0), radius, 1.0)?;
    let off = |found: f64, exact: f64| (found / exact - 1.0).abs();
    Ok(BTreeMap::from([
        ("impact_duration_off".into(), off(elastic.duration, hertz_duration(&with(1.0), radius, 1.0))),
        ("restitution_0_4".into(), throw(with(0.4), radius, 1.0)?.restitution),
        ("restitution_0_2".into(), throw(with(0.2), radius, 1.0)?.restitution),
        ("static_overlap_off".into(), off(settle_on_floor(stone, radius, 9.81)?, hertz_depth(&stone, radius, 9.81))),
    ]))
}

/// Mean angles over the seeds, by coefficient and by modulus, and whether they grow with the coefficient.
fn repose() -> Result<BTreeMap<String, f64>, CliError> {
    let template = Specified::read(ExperimentName::Repose, ExperimentName::Repose.template(), Path::new("template"))?;
    let Specified::Repose(template) = template else {
        return Err(CliError::new(Kind::Fault, "the template of `repose` is one of another experiment"));
    };
    let mut runs = vec![];
    for (name, stones, eta, young, step) in REPOSE {
        for seed in 1..=SEEDS {
            let mut spec = template.clone();
            (spec.stones, spec.stone.rolling_friction, spec.stone.young) = (stones, eta, Pascals(1e9 * young));
            (spec.run.time_step, spec.run.seed) = (Seconds(1e-6 * step), seed);
            runs.push((name, Specified::Repose(spec)));
        }
    }
    let outcomes = side_by_side(runs.len(), None, |index, place| place.run(&runs[index].1, None, true))?;
    let mut ours = BTreeMap::new();
    let mut tell = |name: &str, what: &str, of: &str| {
        let of_name = runs.iter().zip(&outcomes).filter(|((run, _), _)| *run == name);
        let found: Vec<f64> = of_name.filter_map(|(_, outcome)| outcome.reading(of)).collect();
        let spread = MeanAndSpread::of(&found);
        let mean = spread.map_or(f64::NAN, |spread| spread.mean);
        ours.insert(format!("repose_{name}{what}"), mean);
        (mean, spread.map_or(f64::NAN, |spread| spread.standard_deviation))
    };
    let mut spreads = vec![];
    let mut means = vec![];
    for (name, ..) in REPOSE {
        let (mean, spread) = tell(name, "", "angle_degrees");
        tell(name, "_cone", "cone_degrees");
        tell(name, "_kept_back", "kept_back");
        spreads.push((format!("repose_{name}_spread"), spread));
        means.push(mean);
    }
    ours.extend(spreads);
    ours.insert("repose_grows".into(), f64::from(means[..3].windows(2).all(|pair| pair[1] > pair[0])));
    let of_moduli = [means[1], means[3], means[4], means[5]];
    let [most, least] = [f64::max, f64::min].map(|of| of_moduli.into_iter().fold(of_moduli[0], of));
    ours.insert("repose_over_moduli".into(), most - least);
    Ok(ours)
}

fn lateral() -> Result<BTreeMap<String, f64>, CliError> {
    let spec = Specified::read(ExperimentName::Lateral, ExperimentName::Lateral.template(), Path::new("template"))?;
    let outcome = in_sight(&spec, None, None, true)?;
    let read = |key: &str| outcome.reading(key).unwrap_or(f64::NAN);
    Ok(BTreeMap::from([
        ("lateral_stones".into(), read("stones")),
        ("lateral_peak_kn".into(), read("peak_kn")),
        ("lateral_peak_mm".into(), read("peak_mm")),
        ("lateral_bottom_start_percent".into(), read("bottom_percent_at_0.25_mm")),
        ("lateral_bottom_3mm_percent".into(), read("bottom_percent_at_3_mm")),
    ]))
}
