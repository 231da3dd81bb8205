//! The built-in solver on the homogenised tank against the exact arrivals of plane waves.

use std::collections::BTreeMap;
use std::path::Path;

use crate::cli::error::CliError;
use crate::cli::interrupt;
use crate::cli::validate::{CaseReport, report_of};
use crate::fdtd::Fdtd;
use crate::plot::{Axis, Chart, Figure as _, ReferenceLine, Series, Stroke};
use crate::scene::{FoulingSpec, PackingMethod, SceneSpec, resolve};
use crate::study::{Case, plate_reference, simulate_echoes};

const CASE: &str = include_str!("../../../validation/tank-arrivals/case.toml");

/// Runs the clean and the fouled homogeneous tank.
pub fn validate(out: Option<&Path>) -> Result<CaseReport, CliError> {
    let case = Case::read("tank-arrivals", CASE)?;
    let mut spec = SceneSpec::preset("tank")?;
    spec.packing.method = PackingMethod::Homogeneous;
    let clean = resolve(&spec)?;
    spec.fouling = Some(FoulingSpec::of("20cm".parse()?));
    let fouled = resolve(&spec)?;
    let solver = Fdtd::default();
    let on_progress = |_| interrupt::flow();
    let reference = plate_reference(&solver, &clean, &on_progress)?;
    let (clean_trace, clean_echoes) = simulate_echoes(&solver, &clean, &reference, &on_progress)?;
    let (fouled_trace, fouled_echoes) = simulate_echoes(&solver, &fouled, &reference, &on_progress)?;
    let nanoseconds = |time: crate::units::Seconds| 1e9 * time.si();
    let ours = BTreeMap::from([
        ("surface_clean_ns", nanoseconds(clean_echoes.surface.waveform)),
        ("plate_clean_ns", nanoseconds(clean_echoes.plate.waveform)),
        ("surface_fouled_ns", nanoseconds(fouled_echoes.surface.waveform)),
        ("plate_fouled_ns", nanoseconds(fouled_echoes.plate.waveform)),
        ("surface_reflection_clean", clean_echoes.surface.relative_amplitude),
    ]);
    if let Some(folder) = out {
        let line = |trace: &crate::trace::AScan, name: &str, style, colour| {
            let (echoes, _) = crate::compare::subtract_reference(trace, &reference.free_space);
            let peak = reference.plate_echo.peak();
            let points = echoes.times().zip(&echoes.samples).map(|(t, v)| (1e9 * t, v / peak)).collect();
            Series::line(name, points).drawn(style, colour)
        };
        let mut chart =
            Chart::new("Homogenised tank", Axis::linear("time", "ns"), Axis::linear("echo / plate echo", ""))
                .with(line(&clean_trace, "clean", Stroke::Solid, 0))
                .with(line(&fouled_trace, "20 cm of fouling", Stroke::Dashed, 1));
        let zero = nanoseconds(reference.waveform_zero());
        for (label, scene) in [("plate, clean", &clean), ("plate, fouled", &fouled)] {
            chart.lines.push(ReferenceLine::vertical(zero + nanoseconds(scene.arrivals.plate), label));
        }
        chart.lines.push(ReferenceLine::vertical(zero + nanoseconds(clean.arrivals.surface), "surface"));
        chart.write(folder, "tank-arrivals")?;
    }
    report_of(&format!("tank-arrivals: {}", case.title), &case.compare(&ours)?)
}
