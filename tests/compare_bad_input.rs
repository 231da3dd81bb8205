//! Traces that cannot be compared, each with its message word for word.

use ballast_gpr::compare::{CompareOptions, Normalisation, Polarity, TimeZero, compare};
use ballast_gpr::trace::{AScan, Component};
use ballast_gpr::units::Seconds;
use proptest::prelude::*;

fn trace(name: &str, samples: Vec<f64>) -> AScan {
    AScan {
        samples,
        time_step: Seconds(1e-11),
        first_sample: Seconds(0.0),
        component: Component::Ez,
        position: None,
        name: name.into(),
    }
}

fn good() -> AScan {
    let ricker = |t: f64| {
        let a = (std::f64::consts::PI * t).powi(2);
        (1.0 - 2.0 * a) * (-a).exp()
    };
    trace("good", (0..1000).map(|k| ricker(f64::from(k) * 0.01 - 4.0)).collect())
}

fn message(b: &AScan) -> String {
    compare(&good(), b, &CompareOptions::default()).unwrap_err().to_string()
}

#[test]
fn traces_that_are_none() {
    assert_eq!(message(&trace("empty", vec![])), "trace `empty` has no samples");
    assert_eq!(message(&trace("one", vec![1.0])), "trace `one` has one sample: at least two are needed");
    let zero =
        "is zero everywhere: there is nothing to compare\n\nhint: is it the field component that the source excites?";
    assert_eq!(message(&trace("zero", vec![0.0; 100])), format!("trace `zero` {zero}"));
    assert_eq!(message(&trace("flat", vec![0.1; 100])), format!("trace `flat` {zero}"));
    let mut bad = good();
    bad.name = "bad".into();
    bad.samples[250] = f64::NAN;
    assert_eq!(
        message(&bad),
        "trace `bad` holds NaN at sample 250 (2.5 ns)\n\nhint: a solver that has diverged writes such values"
    );
    bad.samples[30] = f64::INFINITY;
    assert_eq!(
        message(&bad),
        "trace `bad` holds inf at sample 30 (0.3 ns)\n\nhint: a solver that has diverged writes such values"
    );
}

#[test]
fn time_axes_that_do_not_fit() {
    let still = AScan { time_step: Seconds(0.0), name: "still".into(), ..good() };
    assert_eq!(
        message(&still),
        "trace `still` has the time step 0 ns from 0 ns: the step should be above zero and both finite"
    );
    let slow = AScan { time_step: Seconds(1e-2), name: "slow".into(), ..good() };
    assert_eq!(
        message(&slow),
        "the time steps of `good` (0.01 ns) and `slow` (10000000 ns) differ by a factor of 1000000000, more than 1000\n\nhint: is one of the time columns in seconds and the other in nanoseconds?"
    );
    let late = AScan { first_sample: Seconds(20e-9), name: "late".into(), ..good() };
    assert_eq!(
        message(&late),
        "`good` (0 ns to 9.99 ns) and `late` (20 ns to 29.99 ns) share 0 samples: at least 8 are needed\n\nhint: set the time zero of both, for example by the direct wave"
    );
    let options = CompareOptions { window: Some((Seconds(4e-9), Seconds(4.03e-9))), ..Default::default() };
    assert_eq!(
        compare(&good(), &good(), &options).unwrap_err().to_string(),
        "the window 4 ns to 4.03 ns holds 4 samples of `good` (4 ns to 4.03 ns): at least 8 are needed"
    );
    let options = CompareOptions { time_step: Some(Seconds(-1e-12)), ..Default::default() };
    assert_eq!(
        compare(&good(), &good(), &options).unwrap_err().to_string(),
        "a common time step of -0.001 ns is out of range: it should be above zero and make at most 10000000 samples"
    );
    let options = CompareOptions { time_step: Some(Seconds(1e-17)), ..Default::default() };
    assert!(compare(&good(), &good(), &options).is_err());
}

#[test]
fn steps_that_need_an_echo_say_when_there_is_none() {
    let options = CompareOptions { normalisation: Normalisation::PlateEcho, ..Default::default() };
    assert_eq!(
        compare(&good(), &good(), &options).unwrap_err().to_string(),
        "`good` has no plate echo to normalise by: no echo follows the one before it\n\nhint: give its time, or choose another rule"
    );
    let options = CompareOptions {
        time_zero: TimeZero::DirectWave,
        reference_a: Some(trace("free", vec![0.1; 1000])),
        ..Default::default()
    };
    assert_eq!(
        compare(&good(), &good(), &options).unwrap_err().to_string(),
        "`good` has no direct wave to set the time zero by: the direct wave is not in this trace\n\nhint: give its time, or choose another rule"
    );
}

/// Polarity: auto turns an inverted trace, keep leaves it and shows a correlation of -1.
#[test]
fn polarity_is_turned_only_when_asked() {
    let inverted = AScan { samples: good().samples.iter().map(|v| -v).collect(), ..good() };
    let found = |polarity| {
        let options = CompareOptions { polarity, ..Default::default() };
        compare(&good(), &inverted, &options).unwrap().metrics.cross_correlation.maximum
    };
    assert!((found(Polarity::Auto) - 1.0).abs() < 1e-9);
    assert!((found(Polarity::Flip) - 1.0).abs() < 1e-9);
    assert!((found(Polarity::Keep) + 1.0).abs() < 1e-9);
}

proptest! {
    /// Whatever finite numbers two traces hold, the answer is an error or metrics within their ranges.
    #[test]
    fn any_two_traces_give_an_error_or_sound_metrics(
        a in prop::collection::vec(prop_oneof![-1.0..1.0_f64, Just(0.0), Just(1e300), Just(-1e-300)], 0..60),
        b in prop::collection::vec(-1e3..1e3_f64, 0..60),
        step in 1e-13..1e-9_f64,
        first in -1e-9..1e-9_f64,
        rule in 0..4_usize,
    ) {
        let (a, b) = (trace("a", a), AScan { time_step: Seconds(step), first_sample: Seconds(first), ..trace("b", b) });
        let time_zero = [TimeZero::Keep, TimeZero::DirectWave, TimeZero::FirstPeak, TimeZero::Given { a: Seconds(0.0), b: Seconds(1e-10) }][rule];
        if let Ok(found) = compare(&a, &b, &CompareOptions { time_zero, ..Default::default() }) {
            let m = found.metrics;
            for value in [m.cross_correlation.maximum, m.zero_lag_correlation, m.envelope_correlation, m.spectral_correlation] {
                prop_assert!((-1.0..=1.0).contains(&value), "{m:?}");
            }
            prop_assert!(m.rmse >= 0.0 && m.relative_l2 >= 0.0 && m.peak_frequency_shift.si().is_finite(), "{m:?}");
            prop_assert_eq!(found.a.samples.len(), found.b.samples.len());
        }
    }
}
