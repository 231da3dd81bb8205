//! Two traces through the same steps, and what comes out.

use super::error::{CompareError, check, rounded};
use super::metrics::{self, Metrics, TimeError};
use super::picks::{Event, ExpectedEchoes, Picks, pick_echoes};
use super::plate::PlateEcho;
use super::process::{Flaw, flaws_of};
use super::resample::resample;
use super::spectrum::{Spectrum, envelope, spectrum};
use super::steps::{self, Step};
use super::warp::time_warp;
use crate::trace::{AScan, Component};
use crate::units::constants::C0;
use crate::units::{Metres, Seconds};

/// What is put at a known time in both traces.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TimeZero {
    /// Nothing: the times of both traces stand.
    #[default]
    Keep,
    /// These times of the two traces become zero.
    Given {
        /// Time in the first trace.
        a: Seconds,
        /// Time in the second.
        b: Seconds,
    },
    /// The extremum of the direct wave becomes zero.
    DirectWave,
    /// The first extremum of a quarter of the largest amplitude becomes zero.
    FirstPeak,
    /// The plate echo comes to `2 height / c`, as from a plate under air.
    PlateEcho {
        /// Height of the antenna over the plate.
        height: Metres,
    },
    /// The same by the measurements of a plate ([`CompareOptions::plate_a`], [`CompareOptions::plate_b`]); a trace without one
    /// keeps its times.
    PlateMeasured {
        /// Height of the antenna over the plate.
        height: Metres,
    },
}

/// By what the amplitudes are divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Normalisation {
    /// Nothing.
    None,
    /// The largest absolute amplitude, after cropping.
    #[default]
    Maximum,
    /// The size of the direct wave.
    DirectWave,
    /// The size of the plate echo.
    PlateEcho,
    /// The size of the echo of a plate measured by itself ([`CompareOptions::plate_a`], [`CompareOptions::plate_b`]), so that
    /// amplitudes are reflections. A trace without one is fitted to the other by least squares at the best lag.
    PlateMeasured,
}

/// What happens to the sign of the second trace.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Polarity {
    /// It stays.
    Keep,
    /// It is turned when the cross-correlation of largest size is negative.
    #[default]
    Auto,
    /// It is turned.
    Flip,
}

/// How two traces are compared. Times are those after the time zero is set.
#[derive(Debug, Clone, PartialEq)]
pub struct CompareOptions {
    /// Taken off the first trace before anything else; it then counts as without direct wave.
    pub reference_a: Option<AScan>,
    /// Taken off the second trace before anything else.
    pub reference_b: Option<AScan>,
    /// Echo of a plate under the antenna of the first trace.
    pub plate_a: Option<PlateEcho>,
    /// Echo of a plate under the antenna of the second trace.
    pub plate_b: Option<PlateEcho>,
    /// Whether the mean of each trace is taken off.
    pub remove_dc: bool,
    /// What is put at a known time.
    pub time_zero: TimeZero,
    /// Step of the common time axis; the finer of the two where none is given.
    pub time_step: Option<Seconds>,
    /// What part is kept; all that both cover where none is given.
    pub window: Option<(Seconds, Seconds)>,
    /// What happens to the sign of the second trace.
    pub polarity: Polarity,
    /// By what the amplitudes are divided.
    pub normalisation: Normalisation,
    /// Where echoes are expected.
    pub expected: ExpectedEchoes,
    /// Largest lag looked at; half the shared time where none is given.
    pub max_lag: Option<Seconds>,
}

impl Default for CompareOptions {
    /// Mean off, times as they are, finer step, normalised by the maximum, sign by correlation.
    fn default() -> Self {
        Self {
            reference_a: None,
            reference_b: None,
            plate_a: None,
            plate_b: None,
            remove_dc: true,
            time_zero: TimeZero::default(),
            time_step: None,
            window: None,
            polarity: Polarity::default(),
            normalisation: Normalisation::default(),
            expected: ExpectedEchoes::default(),
            max_lag: None,
        }
    }
}

/// Two prepared traces on one time axis, and what was found.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Comparison {
    /// The metrics, second trace minus first.
    pub metrics: Metrics,
    /// Echoes of the first trace.
    pub picks_a: Picks,
    /// Echoes of the second trace.
    pub picks_b: Picks,
    /// What was done to the first trace, in order.
    pub steps_a: Vec<Step>,
    /// What was done to the second trace, in order.
    pub steps_b: Vec<Step>,
    /// The first trace after all steps.
    #[serde(serialize_with = "as_curve")]
    pub a: AScan,
    /// The second trace after all steps.
    #[serde(serialize_with = "as_curve")]
    pub b: AScan,
    /// Envelope of the first.
    #[serde(serialize_with = "as_curve")]
    pub envelope_a: AScan,
    /// Envelope of the second.
    #[serde(serialize_with = "as_curve")]
    pub envelope_b: AScan,
    /// Spectrum of the first.
    pub spectrum_a: Spectrum,
    /// Spectrum of the second.
    pub spectrum_b: Spectrum,
    /// What was wrong with recorded traces and stays so.
    pub flaws: Vec<Flaw>,
}

/// How early or late a sample may come in dynamic time warping.
const WARPING_BAND: Seconds = Seconds(0.5e-9);
/// Fewest samples that two traces must share.
const LEAST_SAMPLES: usize = 8;
/// Most samples on the common axis.
const MOST_SAMPLES: usize = 10_000_000;
/// Largest ratio of time steps: a radar at 50 ps against a solver at 0.1 ps is 500.
const LARGEST_STEP_RATIO: f64 = 1000.0;

/// Takes two traces through the same steps and measures how far the second is from the first.
///
/// In this order: subtraction of the references, mean, time zero, common time axis (band-limited, over the time that both
/// cover), window, sign of the second trace, normalisation; then picks, envelopes, spectra and metrics. What was done is in
/// [`Comparison::steps_a`] and [`Comparison::steps_b`].
///
/// ```
/// use ballast_gpr::compare::{compare, text, CompareOptions};
/// let pulse = |at: f64| {
///     let line = |k: i32| {
///         let t = f64::from(k) * 0.01;
///         format!("{t:.2} {}\n", (-(t - at).powi(2) / 0.02).exp())
///     };
///     text::read_trace(&(0..1000).map(line).collect::<String>(), "pulse", &Default::default())
/// };
/// let found = compare(&pulse(4.0)?, &pulse(4.697)?, &CompareOptions::default())?;
/// assert!((found.metrics.cross_correlation.lag.si() - 0.697e-9).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Traces that are empty, of one sample, zero, not finite or without a time axis; steps a thousandfold apart; fewer than
/// eight samples in common or in the window; a common step that makes over ten million samples; a time zero or normalisation by an echo that is not there.
pub fn compare(a: &AScan, b: &AScan, options: &CompareOptions) -> Result<Comparison, CompareError> {
    check(a)?;
    check(b)?;
    check_steps(a, b)?;
    let given = |of: fn(Seconds, Seconds) -> Seconds| match options.time_zero {
        TimeZero::Given { a, b } => Some(of(a, b)),
        _ => None,
    };
    let recorded = [a, b].into_iter().filter(|trace| trace.component == Component::Recorded);
    let flaws = recorded.flat_map(flaws_of).collect();
    let [plate_a, plate_b] = [options.plate_a.as_ref(), options.plate_b.as_ref()];
    let mut a = Prepared::new(a, options, options.reference_a.as_ref(), plate_a, given(|a, _| a))?;
    let mut b = Prepared::new(b, options, options.reference_b.as_ref(), plate_b, given(|_, b| b))?;
    onto_common_axis(&mut a, &mut b, options.time_step)?;
    if let Some((from, to)) = options.window {
        for prepared in [&mut a, &mut b] {
            prepared.try_apply(|trace| steps::crop(trace, from, to))?;
            prepared.refuse_short_window(from, to)?;
        }
    }
    check(&a.trace)?;
    check(&b.trace)?;

    let shared = a.trace.samples.len() as f64 * a.trace.time_step.si();
    let max_lag = options.max_lag.unwrap_or(Seconds(0.5 * shared));
    let flip = match options.polarity {
        Polarity::Keep => false,
        Polarity::Flip => true,
        Polarity::Auto => metrics::cross_correlation(&a.trace, &b.trace, max_lag)?.maximum < 0.0,
    };
    if flip {
        b.apply(steps::flip);
    }
    if options.normalisation == Normalisation::PlateMeasured {
        by_plates(&mut a, &mut b, [plate_a, plate_b], max_lag)?;
    } else {
        a.normalise(options.normalisation)?;
        b.normalise(options.normalisation)?;
    }
    finish(a, b, flaws, max_lag)
}

/// Divides each trace by the echo of its plate; the one without is fitted to the other.
fn by_plates(
    a: &mut Prepared,
    b: &mut Prepared,
    plates: [Option<&PlateEcho>; 2],
    max_lag: Seconds,
) -> Result<(), CompareError> {
    let divide = |side: &mut Prepared, plate: &PlateEcho| {
        let by = format!("plate echo of `{}`", plate.name);
        side.apply(|trace| steps::normalise(trace, plate.amplitude, &by));
    };
    let fit = |side: &mut Prepared, other: &Prepared| -> Result<(), CompareError> {
        let best = metrics::cross_correlation(&other.trace, &side.trace, max_lag)?.maximum.abs();
        let divisor = metrics::norm(&side.trace.samples) / (best * metrics::norm(&other.trace.samples));
        let by = format!("least-squares fit to `{}` at the best lag", other.trace.name);
        if divisor.is_finite() && divisor > 0.0 {
            side.apply(|trace| steps::normalise(trace, divisor, &by));
        }
        Ok(())
    };
    match plates {
        [None, None] => {
            return Err(CompareError::NoPlate { a: a.trace.name.clone(), b: b.trace.name.clone() });
        }
        [Some(first), Some(second)] => {
            divide(a, first);
            divide(b, second);
        }
        [Some(first), None] => {
            divide(a, first);
            fit(b, a)?;
        }
        [None, Some(second)] => {
            divide(b, second);
            fit(a, b)?;
        }
    }
    Ok(())
}

fn finish(a: Prepared, b: Prepared, flaws: Vec<Flaw>, max_lag: Seconds) -> Result<Comparison, CompareError> {
    let (picks_a, picks_b) = (a.picks(), b.picks());
    let (envelope_a, envelope_b) = (envelope(&a.trace), envelope(&b.trace));
    let (spectrum_a, spectrum_b) = (spectrum(&a.trace), spectrum(&b.trace));
    let shift = spectrum_b.peak_frequency.si() - spectrum_a.peak_frequency.si();
    let metrics = Metrics {
        surface_time_error: TimeError::of(&picks_a.surface, &picks_b.surface),
        plate_time_error: TimeError::of(&picks_a.plate, &picks_b.plate),
        cross_correlation: metrics::cross_correlation(&a.trace, &b.trace, max_lag)?,
        zero_lag_correlation: metrics::correlation(&a.trace, &b.trace)?,
        rmse: metrics::rmse(&a.trace, &b.trace)?,
        relative_l2: metrics::relative_l2(&a.trace, &b.trace)?,
        time_warp: time_warp(&a.trace, &b.trace, WARPING_BAND)?,
        envelope_correlation: metrics::pearson(&envelope_a.samples, &envelope_b.samples),
        spectral_correlation: metrics::spectral_correlation(&spectrum_a, &spectrum_b),
        peak_frequency_shift: crate::units::Hertz(shift),
    };
    Ok(Comparison {
        metrics,
        picks_a,
        picks_b,
        steps_a: a.steps,
        steps_b: b.steps,
        a: a.trace,
        b: b.trace,
        envelope_a,
        envelope_b,
        spectrum_a,
        spectrum_b,
        flaws,
    })
}

/// A trace under way, and what was done to it.
struct Prepared {
    trace: AScan,
    steps: Vec<Step>,
    expected: ExpectedEchoes,
}

impl Prepared {
    fn new(
        trace: &AScan,
        options: &CompareOptions,
        reference: Option<&AScan>,
        plate: Option<&PlateEcho>,
        given: Option<Seconds>,
    ) -> Result<Self, CompareError> {
        let mut prepared = Self { trace: trace.clone(), steps: vec![], expected: options.expected };
        if let Some(reference) = reference {
            check(reference)?;
            check_steps(trace, reference)?;
            prepared.apply(|trace| steps::subtract_reference(trace, reference));
            prepared.expected.no_direct_wave = true;
        }
        if options.remove_dc {
            prepared.apply(steps::remove_dc);
        }
        if prepared.trace.peak() <= 1e-13 * trace.peak() {
            return Err(CompareError::AllZero { name: trace.name.clone() });
        }
        let zero = Seconds(0.0);
        match (options.time_zero, given) {
            (_, Some(time)) => prepared.apply(|trace| steps::set_time_zero(trace, time, zero, "time given")),
            (TimeZero::Keep | TimeZero::Given { .. }, None) => {}
            (TimeZero::FirstPeak, None) => {
                let time = steps::first_peak(&prepared.trace)?;
                prepared.apply(|trace| steps::set_time_zero(trace, time, zero, "first peak"));
            }
            (TimeZero::DirectWave, None) => prepared.zero_at(Event::DirectWave, zero)?,
            (TimeZero::PlateMeasured { height }, None) => {
                if let Some(plate) = plate {
                    let becomes = Seconds(2.0 * height.si() / C0);
                    let by = format!("plate echo of `{}`", plate.name);
                    prepared.apply(|trace| steps::set_time_zero(trace, plate.time, becomes, &by));
                }
            }
            (TimeZero::PlateEcho { height }, None) => {
                prepared.zero_at(Event::PlateEcho, Seconds(2.0 * height.si() / C0))?;
            }
        }
        Ok(prepared)
    }

    fn apply(&mut self, step: impl FnOnce(&AScan) -> (AScan, Step)) {
        let (trace, record) = step(&self.trace);
        self.trace = trace;
        self.steps.push(record);
    }

    fn try_apply(
        &mut self,
        step: impl FnOnce(&AScan) -> Result<(AScan, Step), CompareError>,
    ) -> Result<(), CompareError> {
        let (trace, record) = step(&self.trace)?;
        self.trace = trace;
        self.steps.push(record);
        Ok(())
    }

    fn picks(&self) -> Picks {
        pick_echoes(&self.trace, &self.expected)
    }

    /// Puts an echo, found without windows because those are in the times to come, at the time `becomes`.
    fn zero_at(&mut self, event: Event, becomes: Seconds) -> Result<(), CompareError> {
        let anywhere = ExpectedEchoes { no_direct_wave: self.expected.no_direct_wave, ..ExpectedEchoes::default() };
        let picks = pick_echoes(&self.trace, &anywhere);
        let echo = wanted(&self.trace, &picks, event, "set the time zero by")?;
        self.apply(|trace| steps::set_time_zero(trace, echo.waveform.time, becomes, &event.to_string()));
        Ok(())
    }

    fn normalise(&mut self, by: Normalisation) -> Result<(), CompareError> {
        let amplitude =
            |event| wanted(&self.trace, &self.picks(), event, "normalise by").map(|echo| echo.waveform.amplitude.abs());
        let (divisor, name) = match by {
            Normalisation::None | Normalisation::PlateMeasured => return Ok(()),
            Normalisation::Maximum => (self.trace.peak(), "largest amplitude"),
            Normalisation::DirectWave => (amplitude(Event::DirectWave)?, "direct wave"),
            Normalisation::PlateEcho => (amplitude(Event::PlateEcho)?, "plate echo"),
        };
        self.apply(|trace| steps::normalise(trace, divisor, name));
        Ok(())
    }

    fn refuse_short_window(&self, from: Seconds, to: Seconds) -> Result<(), CompareError> {
        let samples = self.trace.samples.len();
        if samples >= LEAST_SAMPLES {
            return Ok(());
        }
        let (first, last) = (rounded(self.trace.first_sample.si()), rounded(self.trace.time(samples - 1)));
        Err(CompareError::Window {
            name: self.trace.name.clone(),
            from,
            to,
            samples,
            first,
            last,
            least: LEAST_SAMPLES,
        })
    }
}

fn wanted(
    trace: &AScan,
    picks: &Picks,
    event: Event,
    purpose: &'static str,
) -> Result<super::picks::Echo, CompareError> {
    match picks.of(event) {
        super::picks::EchoPick::Picked(echo) => Ok(*echo),
        super::picks::EchoPick::NotPicked(reason) => {
            Err(CompareError::NoEvent { name: trace.name.clone(), event, purpose, reason: *reason })
        }
    }
}

fn check_steps(a: &AScan, b: &AScan) -> Result<(), CompareError> {
    let ratio = a.time_step.si() / b.time_step.si();
    let factor = ratio.max(1.0 / ratio);
    if factor <= LARGEST_STEP_RATIO {
        return Ok(());
    }
    Err(CompareError::TimeStepsApart {
        a: a.name.clone(),
        step_a: a.time_step,
        b: b.name.clone(),
        step_b: b.time_step,
        factor,
        limit: LARGEST_STEP_RATIO,
    })
}

/// Puts both traces on the grid of the finer one (of the first, where they are equal), over the time that both cover.
fn onto_common_axis(a: &mut Prepared, b: &mut Prepared, step: Option<Seconds>) -> Result<(), CompareError> {
    const SLACK: f64 = 1e-6;
    let end = |trace: &AScan| trace.time(trace.samples.len() - 1);
    let finer = if b.trace.time_step < a.trace.time_step { &b.trace } else { &a.trace };
    let dt = step.unwrap_or(finer.time_step).si();
    let from = a.trace.first_sample.si().max(b.trace.first_sample.si());
    let to = end(&a.trace).min(end(&b.trace));
    let samples = (to - from).abs() / dt;
    if !(dt > 0.0 && dt.is_finite() && samples <= MOST_SAMPLES as f64) {
        return Err(CompareError::CommonStep { step: Seconds(dt), most: MOST_SAMPLES });
    }
    let start = finer.first_sample.si() + ((from - finer.first_sample.si()) / dt - SLACK).ceil().max(0.0) * dt;
    let count = if to + SLACK * dt < start { 0 } else { ((to - start) / dt + SLACK).floor() as usize + 1 };
    if count < LEAST_SAMPLES {
        let (a, b) = (&a.trace, &b.trace);
        return Err(CompareError::NoOverlap {
            a: a.name.clone(),
            from_a: rounded(a.first_sample.si()),
            to_a: rounded(end(a)),
            b: b.name.clone(),
            from_b: rounded(b.first_sample.si()),
            to_b: rounded(end(b)),
            shared: count,
            least: LEAST_SAMPLES,
        });
    }
    for prepared in [a, b] {
        let old = &prepared.trace;
        let new = resample(old, Seconds(start), Seconds(dt), count);
        let shortened = Step::Cropped { from: Seconds(start), to: Seconds(start + (count - 1) as f64 * dt) };
        let moved = ((start - old.first_sample.si()) / old.time_step.si()).fract().abs();
        if old.time_step.si() != dt || (moved > SLACK && moved < 1.0 - SLACK) {
            prepared.steps.push(Step::Resampled { from: old.time_step, to: Seconds(dt) });
        }
        if (old.samples.len() - 1) as f64 * old.time_step.si() > (count as f64 - 0.5) * dt {
            prepared.steps.push(shortened);
        }
        prepared.trace = new;
    }
    Ok(())
}

/// A trace as its name, first time, step (both in s) and samples.
fn as_curve<S: serde::Serializer>(trace: &AScan, serializer: S) -> Result<S::Ok, S::Error> {
    use serde::ser::SerializeStruct as _;
    let mut curve = serializer.serialize_struct("Curve", 4)?;
    curve.serialize_field("name", &trace.name)?;
    curve.serialize_field("first_sample_s", &trace.first_sample.si())?;
    curve.serialize_field("time_step_s", &trace.time_step.si())?;
    curve.serialize_field("samples", &trace.samples)?;
    curve.end()
}
