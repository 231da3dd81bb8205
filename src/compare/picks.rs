//! Finding the direct wave, the surface echo and the plate echo.

use super::spectrum::{envelope, vertex};
use crate::trace::AScan;
use crate::units::Seconds;

/// The echoes that are looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Event {
    /// What goes straight from transmitter to receiver.
    DirectWave,
    /// The echo of the ballast surface.
    SurfaceEcho,
    /// The echo of the base: the plate of a tank, the lower end of the bed.
    PlateEcho,
}

impl std::fmt::Display for Event {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::DirectWave => "direct wave",
            Self::SurfaceEcho => "surface echo",
            Self::PlateEcho => "plate echo",
        })
    }
}

/// What a pick was made on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum PickedOn {
    /// A maximum or minimum of the samples themselves.
    Waveform,
    /// A maximum of the envelope.
    Envelope,
}

/// A time and an amplitude, between samples by a parabola through three of them.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Pick {
    /// When.
    pub time: Seconds,
    /// How large; signed for a waveform.
    pub amplitude: f64,
    /// What it was read off.
    pub on: PickedOn,
}

/// One echo, read off the waveform and off the envelope.
///
/// The waveform pick is the largest extremum under the envelope's peak. Where two lobes are nearly as large it can fall on
/// the other one in another trace (half a period away); the envelope pick cannot.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Echo {
    /// Largest extremum of the samples.
    pub waveform: Pick,
    /// Peak of the envelope.
    pub envelope: Pick,
}

/// Why an echo was not picked.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, thiserror::Error)]
#[serde(rename_all = "kebab-case")]
pub enum NoEcho {
    /// Nothing above the noise.
    #[error("nothing stands out of the noise (strongest {strongest:.3e}, at least {needed:.3e} needed)")]
    BelowNoise {
        /// Largest envelope peak looked at.
        strongest: f64,
        /// What it would have had to be.
        needed: f64,
    },
    /// The envelope only rises or falls in the window: the peak is outside.
    #[error("the envelope has no peak between {from} and {to}")]
    NoPeakInWindow {
        /// Start of the window.
        from: Seconds,
        /// End of the window.
        to: Seconds,
    },
    /// The window is not on the trace.
    #[error("the window {from} to {to} holds no samples")]
    EmptyWindow {
        /// Start of the window.
        from: Seconds,
        /// End of the window.
        to: Seconds,
    },
    /// Nothing follows the echo before.
    #[error("no echo follows the one before it")]
    NothingLater,
    /// The direct wave was taken out, so it is not looked for.
    #[error("the direct wave is not in this trace")]
    Removed,
}

/// An echo, or why there is none.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum EchoPick {
    /// The echo.
    Picked(Echo),
    /// Why there is none.
    NotPicked(NoEcho),
}

impl EchoPick {
    /// The echo, if there is one.
    pub fn echo(&self) -> Option<&Echo> {
        match self {
            Self::Picked(echo) => Some(echo),
            Self::NotPicked(_) => None,
        }
    }
}

/// Windows in which echoes are expected; where none is given, the rule of [`pick_echoes`] finds them.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct ExpectedEchoes {
    /// From and to of the direct wave.
    pub direct: Option<(Seconds, Seconds)>,
    /// From and to of the surface echo.
    pub surface: Option<(Seconds, Seconds)>,
    /// From and to of the plate echo.
    pub plate: Option<(Seconds, Seconds)>,
    /// Whether the trace has no direct wave (a plane-wave solution, or after it was subtracted).
    pub no_direct_wave: bool,
    /// Whether the trace is free of noise, as a simulated one is: then the strongest peak in a window counts, however long
    /// the reverberation of the stones, which would else be taken for noise.
    pub no_noise: bool,
}

/// The three echoes of a trace.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Picks {
    /// The direct wave.
    pub direct: EchoPick,
    /// The surface echo.
    pub surface: EchoPick,
    /// The plate echo.
    pub plate: EchoPick,
}

impl Picks {
    /// One of the three.
    pub fn of(&self, event: Event) -> &EchoPick {
        match event {
            Event::DirectWave => &self.direct,
            Event::SurfaceEcho => &self.surface,
            Event::PlateEcho => &self.plate,
        }
    }
}

/// Noise is taken as the lower quartile of the envelope. For white noise 8 times that is passed by one sample in 1e8, 6
/// times by one in 3e4; pulses may fill three quarters of a trace before they raise it.
const NOISE_FACTOR: f64 = 8.0;
const NOISE_FACTOR_IN_WINDOW: f64 = 6.0;
/// Smallest echo looked for, as a share of the largest envelope.
const LEAST_ECHO: f64 = 0.02;
/// How strong the first strong arrival is, as a share of the largest envelope.
const STRONG: f64 = 0.25;
/// Two peaks are two echoes when the envelope between them falls below this share of the smaller.
const DIP: f64 = 0.7;

/// Picks the three echoes.
///
/// With a window: the strongest peak of the envelope inside it, if it is 6 times the noise (the lower quartile of the
/// envelope) or the trace is said to have none. Without: peaks of the envelope that are 8 times the noise and 2 % of the strongest, two of them separate when
/// the envelope between them dips below 0.7 of the smaller. The *direct wave* is the first of these that has a quarter of
/// the strongest; the *surface echo* the first after it (the first of all where there is no direct wave); the *plate echo*
/// the strongest after the surface echo. Where nothing stands out, the reason is returned and no pick.
///
/// A trace that is empty gives no picks.
pub fn pick_echoes(trace: &AScan, expected: &ExpectedEchoes) -> Picks {
    let finder = Finder { no_noise: expected.no_noise, ..Finder::new(trace) };
    let candidates = finder.candidates();
    let below_noise = NoEcho::BelowNoise { strongest: finder.largest, needed: finder.threshold };
    let strong = |index: &&usize| finder.envelope[**index] >= STRONG * finder.largest;
    let after = |earlier: Option<usize>| candidates.iter().copied().filter(move |c| earlier.is_none_or(|e| *c > e));

    let direct = match expected.direct {
        _ if expected.no_direct_wave => Err(NoEcho::Removed),
        Some(window) => finder.in_window(window),
        None => candidates.iter().find(strong).copied().ok_or(below_noise),
    };
    let surface = match (expected.surface, direct) {
        (Some(window), _) => finder.in_window(window),
        (None, Ok(direct)) => after(Some(direct)).next().ok_or(NoEcho::NothingLater),
        (None, Err(_)) => after(None).next().ok_or(below_noise),
    };
    let plate = match expected.plate {
        Some(window) => finder.in_window(window),
        None => {
            let earlier = surface.or(direct).ok();
            let strongest = after(earlier).max_by(|a, b| finder.envelope[*a].total_cmp(&finder.envelope[*b]));
            strongest.ok_or(if candidates.is_empty() { below_noise } else { NoEcho::NothingLater })
        }
    };
    let echo = |found: Result<usize, NoEcho>| match found {
        Ok(index) => EchoPick::Picked(finder.echo(index)),
        Err(reason) => EchoPick::NotPicked(reason),
    };
    Picks { direct: echo(direct), surface: echo(surface), plate: echo(plate) }
}

/// The echo where the envelope of a trace is largest; none in a trace without samples or of zeros.
pub(super) fn strongest(trace: &AScan) -> Option<Echo> {
    let finder = Finder::new(trace);
    let peak = (0..finder.envelope.len()).max_by(|a, b| finder.envelope[*a].total_cmp(&finder.envelope[*b]))?;
    (finder.largest > 0.0).then(|| finder.echo(peak))
}

/// The envelope of a trace and what counts as an echo in it.
struct Finder<'a> {
    trace: &'a AScan,
    envelope: Vec<f64>,
    noise: f64,
    largest: f64,
    threshold: f64,
    no_noise: bool,
}

impl<'a> Finder<'a> {
    fn new(trace: &'a AScan) -> Self {
        let envelope = envelope(trace).samples;
        let mut sorted = envelope.clone();
        sorted.sort_by(f64::total_cmp);
        let noise = sorted.get(sorted.len() / 4).copied().unwrap_or(0.0);
        let largest = sorted.last().copied().unwrap_or(0.0);
        let threshold = (NOISE_FACTOR * noise).max(LEAST_ECHO * largest);
        Self { trace, envelope, noise, largest, threshold, no_noise: false }
    }

    fn is_peak(&self, k: usize) -> bool {
        k > 0
            && k + 1 < self.envelope.len()
            && self.envelope[k - 1] < self.envelope[k]
            && self.envelope[k] >= self.envelope[k + 1]
    }

    /// Separate peaks above the threshold, in time.
    fn candidates(&self) -> Vec<usize> {
        let mut kept: Vec<usize> = vec![];
        for k in (0..self.envelope.len()).filter(|k| self.is_peak(*k) && self.envelope[*k] >= self.threshold) {
            let Some(&last) = kept.last() else {
                kept.push(k);
                continue;
            };
            let dip = self.envelope[last..k].iter().copied().fold(f64::INFINITY, f64::min);
            if dip < DIP * self.envelope[last].min(self.envelope[k]) {
                kept.push(k);
            } else if self.envelope[k] > self.envelope[last] {
                kept.pop();
                kept.push(k);
            }
        }
        kept
    }

    fn in_window(&self, (from, to): (Seconds, Seconds)) -> Result<usize, NoEcho> {
        let inside = |k: &usize| (from.si()..=to.si()).contains(&self.trace.time(*k));
        let indices: Vec<usize> = (0..self.envelope.len()).filter(inside).collect();
        if indices.is_empty() {
            return Err(NoEcho::EmptyWindow { from, to });
        }
        let peaks = indices.iter().copied().filter(|k| self.is_peak(*k));
        let best = peaks.max_by(|a, b| self.envelope[*a].total_cmp(&self.envelope[*b]));
        let best = best.ok_or(NoEcho::NoPeakInWindow { from, to })?;
        let needed = if self.no_noise { 0.0 } else { NOISE_FACTOR_IN_WINDOW * self.noise };
        if self.envelope[best] < needed {
            return Err(NoEcho::BelowNoise { strongest: self.envelope[best], needed });
        }
        Ok(best)
    }

    fn pick(&self, samples: &[f64], index: usize, on: PickedOn) -> Pick {
        let (offset, amplitude) = vertex(samples, index);
        Pick { time: Seconds(self.trace.time(index) + offset * self.trace.time_step.si()), amplitude, on }
    }

    /// The echo whose envelope peaks at `peak`: its waveform is searched where the envelope stays above half of that.
    fn echo(&self, peak: usize) -> Echo {
        let half = 0.5 * self.envelope[peak];
        let from = (0..peak).rev().find(|k| self.envelope[*k] < half).map_or(0, |k| k + 1);
        let to = (peak..self.envelope.len()).find(|k| self.envelope[*k] < half).unwrap_or(self.envelope.len());
        let samples = &self.trace.samples;
        let extremum = (from..to).max_by(|a, b| samples[*a].abs().total_cmp(&samples[*b].abs())).unwrap_or(peak);
        Echo {
            waveform: self.pick(samples, extremum, PickedOn::Waveform),
            envelope: self.pick(&self.envelope, peak, PickedOn::Envelope),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::steps::test_traces::{noise, ricker, trace};
    use super::*;

    fn three_pulses() -> AScan {
        trace("three", 2500, 1e-11, |t| ricker(t - 2.0e-9) - 0.12 * ricker(t - 6.003e-9) - 0.5 * ricker(t - 11.0074e-9))
    }

    fn time(pick: &EchoPick) -> f64 {
        pick.echo().unwrap().waveform.time.si() * 1e9
    }

    /// Pulses put between samples are found within 1e-3 ns on the waveform: the parabola misses by under 1e-2 of a sample.
    /// The envelope of the weak pulse rides on the tail of the strong one's Hilbert transform, which falls only as the cube
    /// of time: 4 ns later that moves it by 3e-3 ns.
    #[test]
    fn three_pulses_are_found_between_samples() {
        let picks = pick_echoes(&three_pulses(), &ExpectedEchoes::default());
        for (pick, at, amplitude) in
            [(picks.direct, 2.0, 1.0), (picks.surface, 6.003, -0.12), (picks.plate, 11.0074, -0.5)]
        {
            assert!((time(&pick) - at).abs() < 1e-3, "{pick:?}");
            let echo = pick.echo().unwrap();
            assert!((echo.envelope.time.si() * 1e9 - at).abs() < 5e-3, "{pick:?}");
            assert!((echo.waveform.amplitude - amplitude).abs() < 1e-3, "{pick:?}");
        }
    }

    /// White noise of standard deviation 0.01: the top of a pulse of height A falls by two of these within
    /// sqrt(0.04/(6 pi^2 A)) ns, 0.075 ns for the surface and 0.037 ns for the plate; twice that is allowed. Noise alone gives
    /// no picks in twenty traces.
    #[test]
    fn noise_moves_the_picks_but_makes_none() {
        let mut noisy = three_pulses();
        for (v, e) in noisy.samples.iter_mut().zip(noise(2500, 7)) {
            *v += 0.01 * e;
        }
        let picks = pick_echoes(&noisy, &ExpectedEchoes::default());
        assert!(
            (time(&picks.surface) - 6.003).abs() < 0.15 && (time(&picks.plate) - 11.0074).abs() < 0.075,
            "{picks:?}"
        );
        for seed in 0..20 {
            let only = AScan { samples: noise(2500, seed), ..three_pulses() };
            let picks = pick_echoes(&only, &ExpectedEchoes::default());
            assert!(matches!(picks.surface, EchoPick::NotPicked(NoEcho::BelowNoise { .. })), "{seed}: {picks:?}");
            assert!(picks.direct.echo().is_none() && picks.plate.echo().is_none());
        }
    }

    #[test]
    fn windows_are_obeyed_and_say_why_not() {
        let window = |from: f64, to: f64| Some((Seconds(from / 1e9), Seconds(to / 1e9)));
        let expected = ExpectedEchoes { surface: window(10.0, 12.0), plate: window(5.0, 7.0), ..Default::default() };
        let picks = pick_echoes(&three_pulses(), &expected);
        assert!((time(&picks.surface) - 11.0074).abs() < 1e-3 && (time(&picks.plate) - 6.003).abs() < 1e-3);
        let expected = ExpectedEchoes { surface: window(2.1, 2.4), plate: window(30.0, 40.0), ..Default::default() };
        let picks = pick_echoes(&three_pulses(), &expected);
        let reason = |pick: EchoPick| match pick {
            EchoPick::NotPicked(reason) => reason.to_string(),
            EchoPick::Picked(_) => "picked".into(),
        };
        assert_eq!(reason(picks.surface), "the envelope has no peak between 2.1 ns and 2.4 ns");
        assert_eq!(reason(picks.plate), "the window 30 ns to 40 ns holds no samples");
    }

    #[test]
    fn without_a_direct_wave_the_first_echo_is_the_surface() {
        let expected = ExpectedEchoes { no_direct_wave: true, ..Default::default() };
        let picks = pick_echoes(&three_pulses(), &expected);
        assert_eq!(picks.direct, EchoPick::NotPicked(NoEcho::Removed));
        assert!((time(&picks.surface) - 2.0).abs() < 1e-3 && (time(&picks.plate) - 11.0074).abs() < 1e-3);
    }

    #[test]
    fn one_pulse_has_nothing_later() {
        let one = trace("one", 2500, 1e-11, |t| ricker(t - 2.0e-9));
        let picks = pick_echoes(&one, &ExpectedEchoes::default());
        assert!((time(&picks.direct) - 2.0).abs() < 1e-3);
        assert_eq!(picks.surface, EchoPick::NotPicked(NoEcho::NothingLater));
        assert_eq!(picks.plate, EchoPick::NotPicked(NoEcho::NothingLater));
    }
}
