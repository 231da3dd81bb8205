//! Echo times of real packings: ten seeds, clean and fouled, with the true and with the equivalent stone.

use std::path::Path;

use crate::cli::error::CliError;
use crate::cli::interrupt;
use crate::cli::progress::Bar;
use crate::cli::table::Report;
use crate::cli::validate::CaseReport;
use crate::compare;
use crate::fdtd::Fdtd;
use crate::forward::Progress;
use crate::material::JudgedBy;
use crate::plot::{Axis, Band, Chart, Figure as _, Panels, ReferenceLine, Series, Stroke};
use crate::scene::{EquivalentStone, FoulingSpec, Scene, SceneSpec, resolve};
use crate::study::{Echoes, MeanAndSpread, PlateReference, plate_reference, simulate_echoes};
use crate::trace::AScan;

/// Seeds of each ensemble.
const SEEDS: u64 = 10;

struct Ensemble {
    name: String,
    scene: Scene,
    traces: Vec<AScan>,
    echoes: Vec<Echoes>,
    missed: usize,
}

/// Runs the four ensembles.
pub fn validate(out: Option<&Path>) -> Result<CaseReport, CliError> {
    let solver = Fdtd::default();
    let on_progress = |_| interrupt::flow();
    let spec = SceneSpec::preset("tank")?;
    let reference = plate_reference(&solver, &resolve(&spec)?, &on_progress)?;
    let bar = Bar::new("packings");
    let mut ensembles = Vec::new();
    let variants = [
        (false, EquivalentStone::True),
        (true, EquivalentStone::True),
        (false, EquivalentStone::Equivalent2d),
        (true, EquivalentStone::Equivalent2d),
    ];
    for (number, (fouled, stone)) in variants.into_iter().enumerate() {
        let mut spec = spec.clone();
        spec.fouling = fouled.then(|| "20cm".parse().map(FoulingSpec::of)).transpose()?;
        spec.packing.stone_permittivity = stone;
        spec.packing.judged_by = JudgedBy::EnvelopePeak;
        let what = if fouled { "20 cm of fouling" } else { "clean" };
        let how = if stone == EquivalentStone::True { "true stone" } else { "equivalent stone" };
        let mut ensemble = Ensemble {
            name: format!("{what}, {how}"),
            scene: resolve(&spec)?,
            traces: vec![],
            echoes: vec![],
            missed: 0,
        };
        for seed in 1..=SEEDS {
            let scene = resolve(&SceneSpec { seed, ..spec.clone() })?;
            match simulate_echoes(&solver, &scene, &reference, &on_progress) {
                Ok((trace, echoes)) => {
                    ensemble.traces.push(trace);
                    ensemble.echoes.push(echoes);
                }
                Err(crate::study::EchoError::NotPicked { .. }) => ensemble.missed += 1,
                Err(other) => return Err(other.into()),
            }
            let done = number * SEEDS as usize + seed as usize;
            let _ = bar.update(Progress { done, total: variants.len() * SEEDS as usize });
        }
        ensembles.push(ensemble);
    }
    drop(bar);
    if let Some(folder) = out {
        figure(&ensembles, &reference).write(folder, "tank-echoes")?;
    }
    report(&ensembles)
}

fn spread(ensemble: &Ensemble, of: impl Fn(&Echoes) -> f64) -> Option<MeanAndSpread> {
    MeanAndSpread::of(&ensemble.echoes.iter().map(|echoes| 1e9 * of(echoes)).collect::<Vec<_>>())
}

fn report(ensembles: &[Ensemble]) -> Result<CaseReport, CliError> {
    let title =
        format!("tank-echoes: echoes of packings from the emission, ns, mean ± standard deviation of {SEEDS} seeds");
    let mut table = Report::new(
        title.clone(),
        [
            "bed",
            "surface, layers",
            "surface, waveform",
            "plate, layers",
            "plate, waveform",
            "plate, envelope",
            "envelope late by",
            "found",
        ],
    );
    let mut json = Vec::new();
    for ensemble in ensembles {
        let show = |found: &Option<MeanAndSpread>| {
            found.as_ref().map_or("–".into(), |s| format!("{:.3} ± {:.3}", s.mean, s.standard_deviation))
        };
        let surface = spread(ensemble, |e| e.surface.waveform.si());
        let (waveform, envelope) =
            (spread(ensemble, |e| e.plate.waveform.si()), spread(ensemble, |e| e.plate.envelope.si()));
        let (exact_surface, exact) =
            (1e9 * ensemble.scene.arrivals.surface.si(), 1e9 * ensemble.scene.arrivals.plate.si());
        let late = envelope.as_ref().map_or("–".into(), |found| format!("{:+.3}", found.mean - exact));
        table.row([
            ensemble.name.clone(),
            format!("{exact_surface:.3}"),
            show(&surface),
            format!("{exact:.3}"),
            show(&waveform),
            show(&envelope),
            late,
            format!("{} of {}", ensemble.echoes.len(), ensemble.echoes.len() + ensemble.missed),
        ]);
        json.push(serde_json::json!({
            "bed": ensemble.name, "surface_layers_ns": exact_surface, "surface_waveform_ns": surface,
            "plate_layers_ns": exact, "plate_waveform_ns": waveform, "plate_envelope_ns": envelope, "not_found": ensemble.missed,
        }));
    }
    Ok(CaseReport { title, table, json: json.into(), misses: 0 })
}

/// Mean and band of each ensemble, true stones above, equivalent ones below, with the arrivals of the layers.
fn figure(ensembles: &[Ensemble], reference: &PlateReference) -> Panels {
    let charts = [("true stone", 0), ("equivalent stone", 2)].map(|(how, first)| {
        let mut chart = Chart::new(
            &format!("Ten packings, {how}: mean and standard deviation"),
            Axis::linear("time from the emission", "ns").between(1.0, 14.0),
            Axis::linear("echo / plate echo", ""),
        );
        for (index, ensemble) in ensembles[first..first + 2].iter().enumerate() {
            let zero = reference.zero().si();
            let echoes: Vec<AScan> = ensemble
                .traces
                .iter()
                .map(|trace| compare::subtract_reference(trace, &reference.free_space).0)
                .collect();
            let peak = reference.plate_echo.peak();
            let times: Vec<f64> =
                echoes.first().map_or(vec![], |trace| trace.times().map(|t| 1e9 * (t - zero)).collect());
            let bands: Vec<MeanAndSpread> = (0..times.len())
                .filter_map(|k| {
                    MeanAndSpread::of(&echoes.iter().map(|trace| trace.samples[k] / peak).collect::<Vec<_>>())
                })
                .collect();
            let style = if index == 0 { Stroke::Solid } else { Stroke::Dashed };
            let name = if index == 0 { "clean" } else { "20 cm of fouling" };
            chart.bands.push(Band {
                name: String::new(),
                x: times.clone(),
                lower: bands.iter().map(|b| b.mean - b.standard_deviation).collect(),
                upper: bands.iter().map(|b| b.mean + b.standard_deviation).collect(),
                colour: index,
            });
            chart.series.push(
                Series::line(name, times.iter().copied().zip(bands.iter().map(|b| b.mean)).collect())
                    .drawn(style, index),
            );
            let label = format!("plate, {name}, layers");
            chart.lines.push(ReferenceLine::vertical(1e9 * ensemble.scene.arrivals.plate.si(), &label));
        }
        chart
    });
    Panels::stacked("Echoes of the tank", charts.into())
}
