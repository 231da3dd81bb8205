//! Sources, waveforms and receivers.

use std::f64::consts::{PI, SQRT_2};

/// A coordinate axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// x
    X,
    /// y
    Y,
    /// z
    Z,
}

impl Axis {
    /// 0, 1 or 2.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// `x`, `y` or `z`.
    pub const fn name(self) -> &'static str {
        ["x", "y", "z"][self as usize]
    }
}

/// Shape of a pulse over time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
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
}

impl WaveformKind {
    /// Every kind, in the order of the documentation.
    pub const ALL: [Self; 6] = [
        Self::Ricker,
        Self::Gaussian,
        Self::GaussianDot,
        Self::GaussianDotNorm,
        Self::GaussianDotDot,
        Self::GaussianDotDotNorm,
    ];

    /// The word used in gprMax input files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ricker => "ricker",
            Self::Gaussian => "gaussian",
            Self::GaussianDot => "gaussiandot",
            Self::GaussianDotNorm => "gaussiandotnorm",
            Self::GaussianDotDot => "gaussiandotdot",
            Self::GaussianDotDotNorm => "gaussiandotdotnorm",
        }
    }
}

/// A waveform: `#waveform`.
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

impl Waveform {
    /// Value at time `t`, s.
    ///
    /// Ricker: `(1 - 2 zeta tau²) exp(-zeta tau²)`, `tau = t - sqrt(2)/f`, `zeta = (pi f)²`; peak 1 at `sqrt(2)/f`.
    /// Gaussian family: `exp(-zeta tau²)`, `tau = t - 1/f`, `zeta = 2 (pi f)²`, and its derivatives; the second
    /// derivative is centred like the Ricker pulse. (gprMax user guide, section on waveforms.)
    pub fn value(&self, t: f64) -> f64 {
        let f = self.frequency;
        let shape = match self.kind {
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
            WaveformKind::Gaussian | WaveformKind::GaussianDot | WaveformKind::GaussianDotNorm => {
                let zeta = 2.0 * (PI * f).powi(2);
                let tau = t - 1.0 / f;
                let gaussian = (-zeta * tau * tau).exp();
                match self.kind {
                    WaveformKind::GaussianDot => -2.0 * zeta * tau * gaussian,
                    WaveformKind::GaussianDotNorm => -2.0 * zeta * tau * (1f64.exp() / (2.0 * zeta)).sqrt() * gaussian,
                    _ => gaussian,
                }
            }
        };
        self.amplitude * shape
    }

    /// Frequency above which the spectrum stays 40 dB below its peak, Hz. About `3 f` for a Ricker pulse.
    pub fn highest_frequency(&self) -> f64 {
        // Spectra: Ricker x² exp(-x²) with x = f/fc; Gaussian exp(-f²/(2 fc²)); its derivative f exp(-f²/(2 fc²)).
        let (spectrum, peak): (fn(f64) -> f64, f64) = match self.kind {
            WaveformKind::Ricker | WaveformKind::GaussianDotDot | WaveformKind::GaussianDotDotNorm => {
                (|x| x * x * (-x * x).exp(), (-1f64).exp())
            }
            WaveformKind::Gaussian => (|x| (-x * x / 2.0).exp(), 1.0),
            WaveformKind::GaussianDot | WaveformKind::GaussianDotNorm => {
                (|x| x * (-x * x / 2.0).exp(), (-0.5f64).exp())
            }
        };
        let (mut low, mut high) = (1.0, 10.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if spectrum(middle) > 0.01 * peak { low = middle } else { high = middle }
        }
        high * self.frequency
    }
}

/// When a source is on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Excitation {
    /// First time at which the source is on, s.
    pub start: f64,
    /// Last time at which the source is on, s; `None`: to the end of the time window.
    pub stop: Option<f64>,
}

/// An infinitesimal electric dipole: `#hertzian_dipole`. In two dimensions a line of current.
#[derive(Debug, Clone, PartialEq)]
pub struct HertzianDipole {
    /// Direction of the current.
    pub polarisation: Axis,
    /// Position as the user wrote it, m.
    pub position: [f64; 3],
    /// Index into [`Model::waveforms`](super::Model::waveforms).
    pub waveform: usize,
    /// When it is on.
    pub excitation: Excitation,
}

/// A source.
#[derive(Debug, Clone, PartialEq)]
pub enum Source {
    /// See [`HertzianDipole`].
    HertzianDipole(HertzianDipole),
}

/// A receiver: `#rx`.
#[derive(Debug, Clone, PartialEq)]
pub struct Receiver {
    /// Position as the user wrote it, m.
    pub position: [f64; 3],
    /// Name; gprMax writes `Rx(i,j,k)` with the node indices where the user gives none.
    pub name: Option<String>,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Facts of gprMax's Ricker: 1 at sqrt(2)/f, -1.03e-7 at t = 0, -40 dB at about 3 f.
    #[test]
    fn ricker_is_that_of_gprmax() {
        let w = Waveform { id: "w".into(), kind: WaveformKind::Ricker, amplitude: 1.0, frequency: 1e9 };
        assert!((w.value(SQRT_2 / 1e9) - 1.0).abs() < 1e-15);
        assert!((w.value(0.0) / -1.03e-7 - 1.0).abs() < 5e-3, "{:e}", w.value(0.0));
        assert!((w.highest_frequency() / 3e9 - 1.0).abs() < 0.1, "{:e}", w.highest_frequency());
    }
}
