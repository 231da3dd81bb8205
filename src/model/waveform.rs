//! Pulses over time.

use std::f64::consts::{LN_10, PI, SQRT_2};

use super::Sampled;

/// Shape of a pulse over time.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum WaveformKind {
    /// Second derivative of a Gaussian, sign turned so that the main peak is positive.
    Ricker,
    /// Gaussian.
    Gaussian,
    /// First derivative of a Gaussian.
    GaussianDot,
    /// First derivative of a Gaussian, normalised to a peak of one.
    GaussianDotNorm,
    /// Second derivative of a Gaussian.
    GaussianDotDot,
    /// Second derivative of a Gaussian, normalised to a peak of one.
    GaussianDotDotNorm,
    /// First derivative of [`Gaussian`](Self::Gaussian).
    GaussianPrime,
    /// Second derivative of [`Gaussian`](Self::Gaussian), whose spectrum peaks at a higher frequency.
    GaussianDoublePrime,
    /// A cosine under a Gaussian: half the centre frequency wide at half the peak of its spectrum.
    GausPulse,
    /// One cycle of a sine.
    Sine,
    /// A sine that grows over its first four cycles.
    ContSine,
    /// One at the first time step, then zero.
    Impulse,
    /// Samples of the user: a column of an `#excitation_file`. Amplitude and frequency of the waveform do not count.
    #[serde(skip)]
    User(Sampled),
}

impl WaveformKind {
    /// Every kind that a formula gives, in the order of the documentation.
    pub const ALL: [Self; 12] = [
        Self::Ricker,
        Self::Gaussian,
        Self::GaussianDot,
        Self::GaussianDotNorm,
        Self::GaussianDotDot,
        Self::GaussianDotDotNorm,
        Self::GaussianPrime,
        Self::GaussianDoublePrime,
        Self::GausPulse,
        Self::Sine,
        Self::ContSine,
        Self::Impulse,
    ];

    /// The word used in gprMax input files.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Ricker => "ricker",
            Self::Gaussian => "gaussian",
            Self::GaussianDot => "gaussiandot",
            Self::GaussianDotNorm => "gaussiandotnorm",
            Self::GaussianDotDot => "gaussiandotdot",
            Self::GaussianDotDotNorm => "gaussiandotdotnorm",
            Self::GaussianPrime => "gaussianprime",
            Self::GaussianDoublePrime => "gaussiandoubleprime",
            Self::GausPulse => "gauspulse",
            Self::Sine => "sine",
            Self::ContSine => "contsine",
            Self::Impulse => "impulse",
            Self::User(_) => "user",
        }
    }
}

/// A waveform: `#waveform`, or a column of an `#excitation_file`.
#[derive(Debug, Clone, PartialEq)]
pub struct Waveform {
    /// Identifier, as in the input file.
    pub id: String,
    /// Shape.
    pub kind: WaveformKind,
    /// Factor on the shape.
    pub amplitude: f64,
    /// Centre frequency, Hz.
    pub frequency: f64,
}

/// `ln(10^(6/20))`: a `gauspulse` is as wide as half its centre frequency 6 dB below the peak of its spectrum.
const SIX_DECIBELS: f64 = 0.3 * LN_10;
/// `ln(10^(60/20))`: a `gauspulse` begins 60 dB below its peak.
const SIXTY_DECIBELS: f64 = 3.0 * LN_10;

impl Waveform {
    /// What a source takes from it at time `t`, s, in a run of steps of `time_step`, s, which only an impulse depends on.
    pub fn sample(&self, t: f64, time_step: f64) -> f64 {
        match self.kind {
            WaveformKind::Impulse if (0.0..time_step).contains(&t) => self.amplitude,
            WaveformKind::Impulse => 0.0,
            _ => self.value(t),
        }
    }

    /// Value at time `t`, s; of an impulse, which lasts for one time step, see [`Waveform::sample`].
    ///
    /// Ricker: `(1 - 2 zeta tau²) exp(-zeta tau²)`, `tau = t - sqrt(2)/f`, `zeta = (pi f)²`; peak 1 at `sqrt(2)/f`.
    /// Gaussian family: `exp(-zeta tau²)`, `tau = t - 1/f`, `zeta = 2 (pi f)²`, and its derivatives; `gaussiandotdot` is
    /// centred like the Ricker pulse. Sines: `sin(2 pi f t)`, for `f t <= 1` or times `min(1, f t/4)`. (gprMax user guide,
    /// section on waveforms.) `gauspulse`: `exp(-a tau²) cos(2 pi f tau)`, which gprMax does not write down; its samples
    /// are these with `a = (pi f/2)²/(4 ln 10^0.3)` and `tau = t - sqrt(ln 1000/a)`, to 1e-14.
    pub fn value(&self, t: f64) -> f64 {
        let f = self.frequency;
        let shape = match &self.kind {
            WaveformKind::Ricker | WaveformKind::GaussianDotDot | WaveformKind::GaussianDotDotNorm => {
                let zeta = (PI * f).powi(2);
                let tau = t - SQRT_2 / f;
                let ricker = (1.0 - 2.0 * zeta * tau * tau) * (-zeta * tau * tau).exp();
                match self.kind {
                    WaveformKind::GaussianDotDot => -2.0 * zeta * ricker,
                    WaveformKind::GaussianDotDotNorm => -ricker,
                    _ => ricker,
                }
            }
            WaveformKind::Gaussian
            | WaveformKind::GaussianDot
            | WaveformKind::GaussianDotNorm
            | WaveformKind::GaussianPrime
            | WaveformKind::GaussianDoublePrime => {
                let zeta = 2.0 * (PI * f).powi(2);
                let tau = t - 1.0 / f;
                let gaussian = (-zeta * tau * tau).exp();
                match self.kind {
                    WaveformKind::GaussianDot | WaveformKind::GaussianPrime => -2.0 * zeta * tau * gaussian,
                    WaveformKind::GaussianDotNorm => -2.0 * zeta * tau * (1f64.exp() / (2.0 * zeta)).sqrt() * gaussian,
                    WaveformKind::GaussianDoublePrime => 2.0 * zeta * (2.0 * zeta * tau * tau - 1.0) * gaussian,
                    _ => gaussian,
                }
            }
            WaveformKind::GausPulse => {
                let a = (PI * f / 2.0).powi(2) / (4.0 * SIX_DECIBELS);
                let tau = t - (SIXTY_DECIBELS / a).sqrt();
                (-a * tau * tau).exp() * (2.0 * PI * f * tau).cos()
            }
            WaveformKind::Sine if f * t > 1.0 => 0.0,
            WaveformKind::Sine => (2.0 * PI * f * t).sin(),
            WaveformKind::ContSine => (0.25 * f * t).min(1.0) * (2.0 * PI * f * t).sin(),
            WaveformKind::Impulse => f64::from(t == 0.0),
            WaveformKind::User(sampled) => return sampled.at(t),
        };
        self.amplitude * shape
    }

    /// Frequency above which the spectrum stays 40 dB below its peak, Hz: about `3 f` for a Ricker pulse.
    ///
    /// The spectrum of a sine that begins or ends falls slowly: four times its frequency is taken, as gprMax does. `None`
    /// for an impulse and for samples of the user, whose spectrum gprMax does not look at either.
    pub fn highest_frequency(&self) -> Option<f64> {
        // Spectra: Ricker x² exp(-x²) with x = f/fc; Gaussian exp(-f²/(2 fc²)); its derivatives f exp(-f²/(2 fc²)) and
        // f² exp(-f²/(2 fc²)); a gauspulse exp(-pi² (f - fc)²/a).
        let (spectrum, peak): (fn(f64) -> f64, f64) = match self.kind {
            WaveformKind::Ricker | WaveformKind::GaussianDotDot | WaveformKind::GaussianDotDotNorm => {
                (|x| x * x * (-x * x).exp(), (-1f64).exp())
            }
            WaveformKind::Gaussian => (|x| (-x * x / 2.0).exp(), 1.0),
            WaveformKind::GaussianDot | WaveformKind::GaussianDotNorm | WaveformKind::GaussianPrime => {
                (|x| x * (-x * x / 2.0).exp(), (-0.5f64).exp())
            }
            WaveformKind::GaussianDoublePrime => (|x| x * x * (-x * x / 2.0).exp(), 2.0 * (-1f64).exp()),
            WaveformKind::GausPulse => (|x| (-16.0 * SIX_DECIBELS * (x - 1.0).powi(2)).exp(), 1.0),
            WaveformKind::Sine | WaveformKind::ContSine => return Some(4.0 * self.frequency),
            WaveformKind::Impulse | WaveformKind::User(_) => return None,
        };
        let (mut low, mut high) = (SQRT_2, 10.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if spectrum(middle) > 0.01 * peak { low = middle } else { high = middle }
        }
        Some(high * self.frequency)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(kind: WaveformKind) -> Waveform {
        Waveform { id: "w".into(), kind, amplitude: 1.0, frequency: 1e9 }
    }

    /// Facts of gprMax's Ricker: 1 at sqrt(2)/f, -1.03e-7 at t = 0, -40 dB at about 3 f.
    #[test]
    fn ricker_is_that_of_gprmax() {
        let w = of(WaveformKind::Ricker);
        assert!((w.value(SQRT_2 / 1e9) - 1.0).abs() < 1e-15);
        assert!((w.value(0.0) / -1.03e-7 - 1.0).abs() < 5e-3, "{:e}", w.value(0.0));
        let highest = w.highest_frequency().unwrap();
        assert!((highest / 3e9 - 1.0).abs() < 0.1, "{highest:e}");
    }

    /// The spatial-resolution analysis of gprMax 4.0.1 for pulses of 2 GHz: it reads the frequency off bins of 0.2 to 0.5 GHz
    /// and takes the one above.
    #[test]
    fn highest_frequencies_are_those_of_gprmax() {
        for (kind, theirs) in [
            (WaveformKind::Gaussian, 6.49955e9),
            (WaveformKind::GausPulse, 3.41622e9),
            (WaveformKind::GaussianPrime, 7.49948e9),
            (WaveformKind::GaussianDoublePrime, 7.99944e9),
            (WaveformKind::Ricker, 5.65294e9),
            (WaveformKind::Sine, 8e9),
            (WaveformKind::ContSine, 8e9),
        ] {
            let ours = Waveform { frequency: 2e9, ..of(kind.clone()) }.highest_frequency().unwrap();
            assert!((theirs - 0.5e9..=theirs).contains(&ours), "{kind:?}: {ours:e}, gprMax {theirs:e}");
        }
    }

    /// Samples that gprMax 4.0.1 wrote beside its output: amplitude 1.5, 1 GHz, half a step of 2 mm cells in two dimensions
    /// after the beginning.
    #[test]
    fn first_samples_are_those_of_gprmax() {
        let t = 0.5 * 4.717308673499368e-12;
        for (kind, theirs) in [
            (WaveformKind::Gaussian, 4.404066283988848e-09),
            (WaveformKind::GausPulse, 0.00027441400479551073),
            (WaveformKind::GaussianPrime, 173.4554791408044),
            (WaveformKind::GaussianDoublePrime, 6657730803225.191),
            (WaveformKind::Ricker, -1.643473730348976e-07),
            (WaveformKind::Sine, 0.022228979703651952),
            (WaveformKind::ContSine, 1.3107619844884846e-05),
            (WaveformKind::Impulse, 1.5),
        ] {
            let ours = Waveform { amplitude: 1.5, ..of(kind.clone()) }.sample(t, 2.0 * t);
            assert!((ours / theirs - 1.0).abs() < 1e-12, "{kind:?}: {ours:e}, gprMax {theirs:e}");
        }
    }
}
