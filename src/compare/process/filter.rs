//! Zero-phase Butterworth filters: second-order sections run forwards and backwards.

use rustfft::num_complex::Complex;

use super::error::ProcessError;
use super::section::Section;
use crate::compare::Step;
use crate::units::Hertz;

/// Highest order that is taken: beyond it narrow bands lose their digits.
const MOST_ORDER: usize = 12;

/// What a filter lets through.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Band {
    /// From the first corner to the second.
    Pass(Hertz, Hertz),
    /// What is above the corner.
    High(Hertz),
    /// What is below the corner.
    Low(Hertz),
}

/// One section, `y = (b0 + b1/z + b2/z^2) / (1 + a1/z + a2/z^2) x`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct SecondOrder {
    b: [f64; 3],
    a: [f64; 2],
}

/// Filters each trace forwards and backwards with a Butterworth filter of `order`, so that no echo is moved in time.
///
/// At a corner the amplitude is halved (-6 dB: -3 dB each way), and the slopes have twice the order. The filter is made by the
/// bilinear transform with the corners prewarped; each end is extended oddly by three times the number of coefficients and
/// the filter starts in its steady state there, as SciPy's `butter(..., output="sos")` and `sosfiltfilt` do.
///
/// # Errors
/// A corner at or above half the sampling rate, or not above zero; an empty band; an order of 0 or above 12; traces shorter
/// than the extension.
pub fn filter<T: Section>(section: &T, band: Band, order: usize) -> Result<(T, Step), ProcessError> {
    let nyquist = 0.5 / section.time_step().si();
    let corners = match band {
        Band::Pass(from, to) => vec![from, to],
        Band::High(corner) | Band::Low(corner) => vec![corner],
    };
    for corner in corners {
        if corner.si().is_nan() || corner.si() <= 0.0 {
            return Err(ProcessError::Corner { corner });
        }
        if corner.si() >= nyquist {
            let name = section.name().to_string();
            return Err(ProcessError::AboveNyquist { name, corner, nyquist: Hertz(nyquist) });
        }
    }
    if let Band::Pass(from, to) = band
        && from.si() >= to.si()
    {
        return Err(ProcessError::Band { from, to });
    }
    if order == 0 || order > MOST_ORDER {
        return Err(ProcessError::Order { order, most: MOST_ORDER });
    }
    let sections = design(band, order, section.time_step().si());
    let padding = match band {
        Band::Pass(..) => 3 * (2 * order + 1),
        Band::High(_) | Band::Low(_) => 3 * (order + 1),
    };
    if section.length() <= padding {
        let (name, samples) = (section.name().to_string(), section.length());
        return Err(ProcessError::FilterLong { name, samples, needed: padding });
    }
    let new = section.mapped(|trace| forward_and_backward(&sections, trace, padding));
    let (from, to) = match band {
        Band::Pass(from, to) => (Some(from), Some(to)),
        Band::High(from) => (Some(from), None),
        Band::Low(to) => (None, Some(to)),
    };
    Ok((new, Step::Filtered { from, to, order }))
}

/// The sections of a Butterworth filter by the bilinear transform, in time steps: `s = 2 (z - 1) / (z + 1)`.
fn design(band: Band, order: usize, dt: f64) -> Vec<SecondOrder> {
    let warped = |corner: Hertz| 2.0 * (std::f64::consts::PI * corner.si() * dt).tan();
    // The poles of the prototype in the upper half plane, and the real one of an odd order.
    let prototype = |k: usize| {
        let angle = std::f64::consts::PI * (2 * k + order + 1) as f64 / (2 * order) as f64;
        Complex::from_polar(1.0, angle)
    };
    let upper = (0..order / 2).map(prototype);
    let has_real = order % 2 == 1;
    let mut sections = Vec::with_capacity(order);
    match band {
        Band::Pass(from, to) => {
            let (low, high) = (warped(from), warped(to));
            let (width, centre_squared) = (high - low, low * high);
            let pair = |half: Complex<f64>| {
                let root = (half * half - centre_squared).sqrt();
                [half + root, half - root]
            };
            for pole in upper {
                for pole in pair(pole * (0.5 * width)) {
                    sections.push(SecondOrder::of([pole, pole.conj()], [width, 0.0]));
                }
            }
            if has_real {
                sections.push(SecondOrder::of(pair(Complex::new(-0.5 * width, 0.0)), [width, 0.0]));
            }
        }
        Band::Low(to) => {
            let corner = warped(to);
            for pole in upper {
                let pole = pole * corner;
                sections.push(SecondOrder::of([pole, pole.conj()], [0.0, corner * corner]));
            }
            if has_real {
                let scale = corner / (2.0 + corner);
                let pole = (2.0 - corner) / (2.0 + corner);
                sections.push(SecondOrder { b: [scale, scale, 0.0], a: [-pole, 0.0] });
            }
        }
        Band::High(from) => {
            let corner = warped(from);
            for pole in upper {
                let pole = pole.inv() * corner;
                sections.push(SecondOrder::high([pole, pole.conj()]));
            }
            if has_real {
                let scale = 2.0 / (2.0 + corner);
                let pole = (2.0 - corner) / (2.0 + corner);
                sections.push(SecondOrder { b: [scale, -scale, 0.0], a: [-pole, 0.0] });
            }
        }
    }
    sections
}

impl SecondOrder {
    /// From the analogue `(c1 s + c0) / ((s - p) (s - q))`, one of `c1` and `c0` being zero.
    fn of([p, q]: [Complex<f64>; 2], [c1, c0]: [f64; 2]) -> Self {
        let (a, scale) = Self::denominator([p, q]);
        // s is 2 (z - 1)/(z + 1): over the common denominator c1 s gives 2 c1 (z^2 - 1), c0 gives c0 (z + 1)^2.
        let b = [(2.0 * c1 + c0) / scale, 2.0 * c0 / scale, (c0 - 2.0 * c1) / scale];
        Self { b, a }
    }

    /// From the analogue `s^2 / ((s - p) (s - q))`.
    fn high(poles: [Complex<f64>; 2]) -> Self {
        let (a, scale) = Self::denominator(poles);
        Self { b: [4.0 / scale, -8.0 / scale, 4.0 / scale], a }
    }

    /// `a1`, `a2` and the factor `(2 - p) (2 - q)`, for two poles that are real or conjugate.
    fn denominator([p, q]: [Complex<f64>; 2]) -> ([f64; 2], f64) {
        let digital = |pole: Complex<f64>| (pole + 2.0) / (2.0 - pole);
        let (first, second) = (digital(p), digital(q));
        ([-(first + second).re, (first * second).re], ((2.0 - p) * (2.0 - q)).re)
    }

    /// Output for a constant input of one, once steady.
    fn at_zero(&self) -> f64 {
        self.b.iter().sum::<f64>() / (1.0 + self.a[0] + self.a[1])
    }

    /// Filters in place; before the first sample the input was `level` for ever.
    fn run(&self, samples: &mut [f64], level: f64) {
        let steady = self.at_zero();
        let mut state = [(steady - self.b[0]) * level, (self.b[2] - self.a[1] * steady) * level];
        for sample in samples {
            let (x, y) = (*sample, self.b[0] * *sample + state[0]);
            state = [self.b[1] * x - self.a[0] * y + state[1], self.b[2] * x - self.a[1] * y];
            *sample = y;
        }
    }
}

fn forward_and_backward(sections: &[SecondOrder], trace: &[f64], padding: usize) -> Vec<f64> {
    let (first, last) = (trace[0], trace[trace.len() - 1]);
    let before = trace[1..=padding].iter().rev().map(|v| 2.0 * first - v);
    let after = trace[trace.len() - 1 - padding..trace.len() - 1].iter().rev().map(|v| 2.0 * last - v);
    let mut samples: Vec<f64> = before.chain(trace.iter().copied()).chain(after).collect();
    for _ in 0..2 {
        let mut level = samples[0];
        for section in sections {
            section.run(&mut samples, level);
            level *= section.at_zero();
        }
        samples.reverse();
    }
    samples[padding..padding + trace.len()].to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::steps::test_traces::trace;
    use crate::trace::AScan;
    use crate::units::Seconds;

    fn tone(frequency: f64) -> AScan {
        trace("tone", 4000, 1e-11, move |t| (2.0 * std::f64::consts::PI * frequency * t).cos())
    }

    /// In the middle of a long tone the filter has settled: forwards and backwards the gain is |H|^2 = 1/(1 + x^(2 order)),
    /// x the prewarped frequency over that of the corner, and there is no delay.
    #[test]
    fn tones_come_through_by_the_square_of_the_butterworth_gain() {
        let warped = |f: f64| (std::f64::consts::PI * f * 1e-11).tan();
        for order in [1, 2, 3, 4, 5] {
            for f in [0.5e9, 0.9e9, 1.0e9, 1.3e9, 3e9] {
                let above = (warped(f) / warped(1e9)).powi(2 * order as i32);
                let (low, high) = (warped(0.6e9), warped(1.8e9));
                let x = (warped(f).powi(2) - low * high) / (warped(f) * (high - low));
                for (band, gain) in [
                    (Band::Low(Hertz(1e9)), 1.0 / (1.0 + above)),
                    (Band::High(Hertz(1e9)), above / (1.0 + above)),
                    (Band::Pass(Hertz(0.6e9), Hertz(1.8e9)), 1.0 / (1.0 + x.powi(2 * order as i32))),
                ] {
                    let (filtered, _) = filter(&tone(f), band, order).unwrap();
                    for k in 1900..2100 {
                        let wanted = gain * tone(f).samples[k];
                        assert!((filtered.samples[k] - wanted).abs() < 1e-5, "{band:?} {order} at {f}");
                    }
                }
            }
        }
    }

    /// A constant goes in a band, and stays below a corner, up to both ends.
    #[test]
    fn a_constant_stays_or_goes_to_the_ends() {
        let flat = trace("flat", 300, 1e-11, |_| 7.0);
        let (low, _) = filter(&flat, Band::Low(Hertz(2e9)), 4).unwrap();
        assert!(low.samples.iter().all(|v| (v - 7.0).abs() < 1e-9));
        let (band, step) = filter(&flat, Band::Pass(Hertz(0.3e9), Hertz(2e9)), 4).unwrap();
        assert!(band.samples.iter().all(|v| v.abs() < 1e-9));
        assert_eq!(step.to_string(), "band-pass 0.3 GHz to 2 GHz, Butterworth order 4 forwards and backwards");
    }

    /// Wide band on a real pole of the prototype: both its poles are real there. At 1 GHz the gain lacks 1e-4.
    #[test]
    fn a_wide_band_of_odd_order_has_real_poles() {
        let (filtered, _) = filter(&tone(1e9), Band::Pass(Hertz(0.3e9), Hertz(12e9)), 3).unwrap();
        assert!((1900..2100).all(|k| (filtered.samples[k] - tone(1e9).samples[k]).abs() < 1e-3));
    }

    #[test]
    fn bands_that_cannot_be_are_refused_word_for_word() {
        let message = |band, order| filter(&tone(1e9), band, order).unwrap_err().to_string();
        let pass = |from, to| Band::Pass(Hertz(from), Hertz(to));
        assert_eq!(
            message(pass(0.3e9, 50e9), 4),
            "the corner at 50 GHz is not below half the sampling rate of `tone`, 50 GHz\n\nhint: lower the corner, or leave it out with `highpass=FROM`"
        );
        assert_eq!(
            message(pass(2e9, 1e9), 4),
            "the band 2 GHz to 1 GHz is empty\n\nhint: write the lower corner first, for example `bandpass=300MHz..1.5GHz`"
        );
        assert_eq!(
            message(pass(0.0, 1e9), 4),
            "a corner at 0 GHz is out of range: it should be above zero\n\nhint: `lowpass=TO` has no lower corner"
        );
        assert_eq!(message(pass(1e9, 2e9), 13), "a Butterworth filter of order 13 is out of range: 1 to 12");
        assert!(message(Band::Low(Hertz(f64::NAN)), 4).starts_with("a corner at NaN"));
        let short = AScan { samples: vec![1.0; 27], time_step: Seconds(1e-11), ..tone(1e9) };
        assert_eq!(
            filter(&short, pass(1e9, 2e9), 4).unwrap_err().to_string(),
            "the traces of `tone` have 27 samples: this filter needs more than 27\n\nhint: a lower order, for example `bandpass=300MHz..1.5GHz:2`"
        );
    }
}
