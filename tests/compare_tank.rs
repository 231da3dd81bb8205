//! The comparison on the exact plane-wave traces of the tank of Benedetto et al. 2018 (`validation/tank/`), which another
//! program computed by recursion of the layer reflections.

use ballast_gpr::compare::permittivity::from_two_way_time;
use ballast_gpr::compare::text::{Column, TextOptions, read_trace};
use ballast_gpr::compare::{
    CompareOptions, Comparison, ExpectedEchoes, Normalisation, Step, TimeZero, compare, pick_echoes,
};
use ballast_gpr::material::{MixingModel, mix};
use ballast_gpr::trace::AScan;
use ballast_gpr::units::{Metres, Seconds, Share};

const TRACES: &str = include_str!("../validation/tank/analytic_tank_traces_ricker1GHz.csv");
const ARRIVALS: &str = include_str!("../validation/tank/analytic_tank_arrivals.csv");
/// The incident pulse leaves at this time, ns.
const EMITTED: f64 = 1.5;

fn trace(column: &str) -> AScan {
    let options = TextOptions { column: Column::Named(column.into()), resample: None };
    AScan { name: column.into(), ..read_trace(TRACES, column, &options).unwrap() }
}

/// Rows of the arrival table: name of the trace, then the numbers (NaN where empty).
fn arrivals() -> Vec<(String, Vec<f64>)> {
    let rows: Vec<_> = ARRIVALS
        .lines()
        .skip(1)
        .map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            let numbers = fields.iter().map(|f| f.parse().unwrap_or(f64::NAN)).collect();
            (format!("n{}_S{}", fields[0], fields[1]), numbers)
        })
        .collect();
    assert_eq!(rows.len(), 8);
    rows
}

/// Options for traces without a direct wave.
fn plane_wave() -> CompareOptions {
    let expected = ExpectedEchoes { no_direct_wave: true, ..Default::default() };
    CompareOptions { expected, ..Default::default() }
}

fn compared(a: &str, b: &str) -> Comparison {
    compare(&trace(a), &trace(b), &plane_wave()).unwrap()
}

#[test]
fn the_file_has_0_01_ns_and_2500_samples() {
    let read = trace("n0.39_S0");
    assert_eq!((read.samples.len(), read.time_step), (2500, Seconds(0.01e-9)));
}

/// Surface echoes stand alone: the time of emission plus 2.6685 ns within half a sample, the height of the peak is the
/// reflection of the surface (4 digits printed, parabola through a Ricker 1e-5).
#[test]
fn surface_echoes_are_where_and_as_large_as_they_should_be() {
    for (name, row) in arrivals() {
        let picks = pick_echoes(&trace(&name), &plane_wave().expected);
        let echo = picks.surface.echo().unwrap();
        let (time, expected) = (echo.waveform.time.si() * 1e9, EMITTED + row[6]);
        assert!((time - expected).abs() < 0.005, "{name}: {time} for {expected}");
        assert!((echo.waveform.amplitude - row[5]).abs() < 1e-4, "{name}: {echo:?}");
    }
}

/// Plate echoes have two weak neighbours: the ballast base 0.534 ns ahead and the multiple in the methacrylate 0.534 ns
/// behind, each at most 0.097 of the plate's. Each pulls the peak by 0.097 r'(0.534 ns)/r''(0) = 0.0027 ns (r the Ricker), so
/// 0.0055 ns together; the bound is one sample, a seventieth of the shift by 20 cm of fouling.
#[test]
fn plate_echoes_are_where_they_should_be() {
    for (name, row) in arrivals() {
        let picks = pick_echoes(&trace(&name), &plane_wave().expected);
        let time = picks.plate.echo().unwrap().waveform.time.si() * 1e9;
        assert!((time - EMITTED - row[9]).abs() < 0.01, "{name}: {time} for {}", EMITTED + row[9]);
    }
}

/// Clean against 20 cm of fouling: the plate echo comes 0.697 ns later (9.979 - 9.282, 42 % voids), the surface not at all.
#[test]
fn fouling_moves_the_plate_echo_and_not_the_surface() {
    for (voids, shift) in [("0.42", 0.697), ("0.39", 0.6466)] {
        let metrics = compared(&format!("n{voids}_S0"), &format!("n{voids}_SII")).metrics;
        let plate = metrics.plate_time_error.waveform.unwrap().si() * 1e9;
        let surface = metrics.surface_time_error.waveform.unwrap().si() * 1e9;
        assert!((plate - shift).abs() < 0.01 && surface.abs() < 1e-3, "{plate} for {shift}, {surface}");
        assert!(metrics.zero_lag_correlation < 0.5, "{metrics:?}");
    }
}

#[test]
fn a_trace_is_equal_to_itself_in_every_metric() {
    let metrics = compared("n0.42_SI", "n0.42_SI").metrics;
    assert!((metrics.cross_correlation.maximum - 1.0).abs() < 1e-12);
    assert_eq!(metrics.cross_correlation.lag, Seconds(0.0));
    assert_eq!((metrics.rmse, metrics.relative_l2, metrics.peak_frequency_shift.si()), (0.0, 0.0, 0.0));
    assert_eq!(metrics.plate_time_error.envelope, Some(Seconds(0.0)));
    for one in [metrics.zero_lag_correlation, metrics.envelope_correlation, metrics.spectral_correlation] {
        assert!((one - 1.0).abs() < 1e-12);
    }
}

/// The same trace as another instrument would give it: 49 ps, other scale, other sign, an offset, 3.217 ns later. After the
/// steps it is the same trace; what is left is the 1e-5 of the resampling (both ways) and of the offset.
#[test]
fn scale_sign_offset_delay_and_step_are_undone() {
    let clean = trace("n0.42_SII");
    let coarse = ballast_gpr::compare::resample(&clean, Seconds(0.0), Seconds(25e-9 / 512.0), 512);
    let samples = coarse.samples.iter().map(|v| -33.0 * v + 4.0).collect();
    let other = AScan { samples, first_sample: Seconds(3.217e-9), name: "measured".into(), ..coarse };
    let options = CompareOptions { time_zero: TimeZero::FirstPeak, ..plane_wave() };
    let result = compare(&clean, &other, &options).unwrap();
    assert!(result.steps_b.contains(&Step::Flipped) && !result.steps_a.contains(&Step::Flipped));
    assert!(result.metrics.relative_l2 < 5e-3, "{:?}", result.metrics);
    assert!(result.metrics.cross_correlation.maximum > 0.99999, "{:?}", result.metrics);
    assert!(result.metrics.cross_correlation.lag.si().abs() < 1e-12, "{:?}", result.metrics);
    let plate = CompareOptions { normalisation: Normalisation::PlateEcho, ..options };
    let result = compare(&clean, &other, &plate).unwrap();
    assert!((result.picks_b.plate.echo().unwrap().waveform.amplitude.abs() - 1.0).abs() < 1e-3);
}

/// Permittivity from the table's own times and the 0.48 m of ballast, to the four digits of the table; the mixture of the
/// layers gives the clean one too.
#[test]
fn times_give_the_permittivity_of_the_table() {
    for (name, row) in arrivals() {
        let two_way = Seconds((row[8] - row[6]) * 1e-9);
        let found = from_two_way_time(two_way, Metres(0.48));
        assert!((found - row[10]).abs() < 5e-4, "{name}: {found} for {}", row[10]);
        let real = |eps: f64| ballast_gpr::material::Complex::new(eps, 0.0);
        let clean = mix(MixingModel::Crim, &[(Share(1.0 - row[0]), real(6.5)), (Share(row[0]), real(1.0))]).unwrap();
        assert!((clean.re - row[3]).abs() < 5e-4, "{name}: {clean} for {}", row[3]);
    }
}

/// The report for other programs holds the metrics first and the curves with their axes in s.
#[test]
fn the_comparison_writes_itself_as_json() {
    let json = serde_json::to_value(compared("n0.42_S0", "n0.42_SII")).unwrap();
    assert_eq!(json["metrics"]["surface_time_error"]["waveform"].as_str().map(|s| s.ends_with("ns")), Some(true));
    assert_eq!(json["a"]["samples"].as_array().unwrap().len(), 2500);
    assert_eq!(json["a"]["time_step_s"].as_f64(), Some(1e-11));
    assert_eq!(json["steps_a"][0]["step"], "mean-removed");
    assert!(json["picks_a"]["plate"]["picked"]["envelope"]["amplitude"].as_f64().unwrap() > 0.9);
}
