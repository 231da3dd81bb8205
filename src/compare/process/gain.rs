//! Gains over time, and the envelope.

use super::error::ProcessError;
use super::running::{odd_count, running_mean};
use super::section::Section;
use crate::compare::Step;
use crate::compare::spectrum::envelope_of;
use crate::units::Seconds;

/// Largest gain that is taken: 10^12 is past what any converter resolves.
const MOST_GAIN: f64 = 1e12;
/// Level below which the gain by level grows no further, as a share of the largest level of the trace.
const LEAST_LEVEL: f64 = 1e-6;

/// Multiplies each sample by `exp(rate t) t^power`, with the time t in ns and the rate per ns.
///
/// The spreading-and-exponential-compensation (SEC) gain: the power undoes spreading, the rate loss. Times count from time
/// zero, so set that first; those before the first step after it have the gain of that step.
///
/// # Errors
/// A gain that is no number or grows past 10^12.
pub fn gain_by_time<T: Section>(section: &T, rate: f64, power: f64) -> Result<(T, Step), ProcessError> {
    let dt = section.time_step().si();
    let gain = |index: usize| {
        let t = 1e9 * section.time_of(index).max(dt);
        (rate * t).exp() * t.powf(power)
    };
    let gains: Vec<f64> = (0..section.length()).map(gain).collect();
    if !gains.iter().all(|gain| *gain <= MOST_GAIN) {
        let duration = crate::compare::error::rounded(section.length() as f64 * dt);
        return Err(ProcessError::Gain { name: section.name().into(), rate, power, most: MOST_GAIN, duration });
    }
    let new = section.mapped(|trace| trace.iter().zip(&gains).map(|(v, gain)| v * gain).collect());
    Ok((new, Step::GainByTime { rate_per_ns: rate, power }))
}

/// Divides each sample by the root of the mean square in a window about it: the automatic gain control (AGC).
///
/// The window is that of [`dewow`](super::dewow). Where the level is below a millionth of the largest in the trace, it counts
/// as that. Amplitudes mean nothing afterwards.
///
/// # Errors
/// A window of fewer than three samples or longer than the trace.
pub fn gain_by_level<T: Section>(section: &T, window: Seconds) -> Result<(T, Step), ProcessError> {
    let count = odd_count(section, window)?;
    let new = section.mapped(|trace| {
        let largest = trace.iter().fold(0.0_f64, |largest, v| largest.max(v.abs()));
        if largest == 0.0 {
            return trace.to_vec();
        }
        let squares: Vec<f64> = trace.iter().map(|v| (v / largest).powi(2)).collect();
        let levels: Vec<f64> = running_mean(&squares, count).iter().map(|square| square.sqrt()).collect();
        let least = LEAST_LEVEL * levels.iter().copied().fold(0.0, f64::max);
        trace.iter().zip(levels).map(|(v, level)| v / largest / level.max(least)).collect()
    });
    let window = Seconds(count as f64 * section.time_step().si());
    Ok((new, Step::GainByLevel { window, samples: count }))
}

/// Puts the envelope of each trace in its place: the modulus of the analytic signal of the mirrored trace.
pub fn take_envelope<T: Section>(section: &T) -> (T, Step) {
    (section.mapped(envelope_of), Step::EnvelopeTaken)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::steps::test_traces::{noise, ricker, trace};

    /// A wave that falls as exp(-0.3 t)/t comes back level; before time zero the gain does not change.
    #[test]
    fn spreading_and_loss_are_undone() {
        let falling = trace("falling", 400, 5e-11, |t| if t > 0.0 { (-0.3e9 * t).exp() / (1e9 * t) } else { 1.0 });
        let (level, step) = gain_by_time(&falling, 0.3, 1.0).unwrap();
        assert!(level.samples[1..].iter().all(|v| (v - 1.0).abs() < 1e-12));
        assert_eq!(step.to_string(), "gain of exp(0.3 t/ns) (t/ns)^1");
        let early = falling.moved(Seconds(-5e-9));
        let (gained, _) = gain_by_time(&early, 0.3, 1.0).unwrap();
        let gain = |k: usize| gained.samples[k] / early.samples[k];
        assert!((gain(20) / gain(80) - 1.0).abs() < 1e-12 && gain(150) > gain(80));
    }

    #[test]
    fn a_gain_out_of_bounds_is_refused() {
        let pulse = trace("pulse", 400, 5e-11, |t| ricker(t - 4e-9));
        for (rate, power) in [(3.0, 0.0), (f64::NAN, 0.0), (0.0, 40.0), (f64::INFINITY, 1.0)] {
            assert!(gain_by_time(&pulse, rate, power).is_err(), "{rate} {power}");
        }
        assert_eq!(
            gain_by_time(&pulse, 3.0, 1.0).unwrap_err().to_string(),
            "a gain of exp(3 t/ns) (t/ns)^1 grows past 1e12 within the 20 ns of `pulse`\n\nhint: 0.1 to 0.5 per ns is usual at 1 GHz"
        );
    }

    /// White noise that grows a hundredfold comes out with a level of one; zeros stay zeros, as does a trace of them.
    #[test]
    fn levels_become_one() {
        let mut growing = trace("noise", 2000, 1e-11, |t| 1.0 + 99.0 * t / 20e-9);
        growing.samples.iter_mut().zip(noise(2000, 3)).for_each(|(v, e)| *v *= e);
        growing.samples[..300].fill(0.0);
        let (level, _) = gain_by_level(&growing, Seconds(2e-9)).unwrap();
        assert!(level.samples[..150].iter().all(|v| *v == 0.0));
        for part in level.samples[500..].chunks(500) {
            let rms = (part.iter().map(|v| v * v).sum::<f64>() / 500.0).sqrt();
            assert!((rms - 1.0).abs() < 0.1, "{rms}");
        }
        let nothing = trace("nothing", 100, 1e-11, |_| 0.0);
        assert_eq!(gain_by_level(&nothing, Seconds(2e-10)).unwrap().0, nothing);
    }
}
