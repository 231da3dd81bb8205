//! Pulses given as samples.

use std::sync::Arc;

/// What lies between two samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Between {
    /// A straight line.
    Linear,
    /// The nearer of the two; half-way, the earlier.
    Nearest,
    /// The earlier.
    Previous,
    /// The later.
    Next,
}

impl Between {
    /// Every way, in the order of the documentation.
    pub const ALL: [Self; 4] = [Self::Linear, Self::Nearest, Self::Previous, Self::Next];

    /// The word used in gprMax input files.
    pub const fn name(self) -> &'static str {
        ["linear", "nearest", "previous", "next"][self as usize]
    }
}

/// What lies before the first sample and after the last.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Beyond {
    /// A number.
    Value(f64),
    /// The line through the first two samples, or through the last two; the first or last sample where nothing is
    /// interpolated.
    Extrapolate,
}

/// A pulse given as samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampled {
    times: Arc<[f64]>,
    values: Arc<[f64]>,
    between: Between,
    beyond: Beyond,
}

impl Sampled {
    /// A pulse from samples at times, s; `None` unless there are two or more, as many of one as of the other, all finite, the
    /// times growing.
    pub fn new(times: Vec<f64>, values: Vec<f64>, between: Between, beyond: Beyond) -> Option<Self> {
        let growing = times.windows(2).all(|pair| pair[0] < pair[1]);
        let finite = times.iter().chain(&values).all(|number| number.is_finite());
        let sound = growing && finite && times.len() >= 2 && times.len() == values.len();
        sound.then(|| Self { times: times.into(), values: values.into(), between, beyond })
    }

    /// Times of the samples, s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The samples.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// What lies between two samples.
    pub fn between(&self) -> Between {
        self.between
    }

    /// What lies before the first and after the last.
    pub fn beyond(&self) -> Beyond {
        self.beyond
    }

    /// Value at time `t`, s.
    pub fn at(&self, t: f64) -> f64 {
        let (times, last) = (&self.times, self.times.len() - 1);
        if let (true, Beyond::Value(value)) = (t < times[0] || t > times[last], self.beyond) {
            return value;
        }
        // The interval that holds `t`, the first or last one beyond the ends.
        let next = times.partition_point(|&time| time < t).clamp(1, last);
        let (earlier, later) = (self.values[next - 1], self.values[next]);
        let (from, to) = (times[next - 1], times[next]);
        match self.between {
            Between::Linear => (later - earlier) / (to - from) * (t - from) + earlier,
            Between::Nearest if t > from + (to - from) / 2.0 => later,
            Between::Previous if t >= to => later,
            Between::Next if t > from => later,
            Between::Nearest | Between::Previous | Between::Next => earlier,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(between: Between, beyond: Beyond) -> Sampled {
        Sampled::new(vec![1.0, 2.0, 4.0], vec![10.0, 20.0, 0.0], between, beyond).unwrap()
    }

    /// The values of `scipy.interpolate.interp1d`, which gprMax passes the two words on to.
    #[test]
    fn samples_are_interpolated_as_in_gprmax() {
        let times = [0.5, 1.0, 1.5, 1.7, 2.0, 3.0, 4.0, 5.0];
        for (between, theirs) in [
            (Between::Linear, [7.0, 10.0, 15.0, 17.0, 20.0, 10.0, 0.0, 7.0]),
            (Between::Nearest, [7.0, 10.0, 10.0, 20.0, 20.0, 20.0, 0.0, 7.0]),
            (Between::Previous, [7.0, 10.0, 10.0, 10.0, 20.0, 20.0, 0.0, 7.0]),
            (Between::Next, [7.0, 10.0, 20.0, 20.0, 20.0, 0.0, 0.0, 7.0]),
        ] {
            let sampled = of(between, Beyond::Value(7.0));
            assert_eq!(times.map(|t| sampled.at(t)), theirs, "{between:?}");
        }
        let linear = of(Between::Linear, Beyond::Extrapolate);
        assert_eq!([0.5, 5.0].map(|t| linear.at(t)), [5.0, -10.0]);
        let nearest = of(Between::Nearest, Beyond::Extrapolate);
        assert_eq!([0.5, 5.0].map(|t| nearest.at(t)), [10.0, 0.0]);
    }

    #[test]
    fn samples_that_make_no_pulse_are_refused() {
        let new = |times: &[f64], values: &[f64]| {
            Sampled::new(times.into(), values.into(), Between::Linear, Beyond::Value(0.0)).is_some()
        };
        assert!(new(&[0.0, 1.0], &[0.0, 1.0]));
        assert!(!new(&[0.0], &[0.0]) && !new(&[0.0, 1.0], &[0.0]) && !new(&[1.0, 0.0], &[0.0, 1.0]));
        assert!(!new(&[0.0, f64::NAN], &[0.0, 1.0]) && !new(&[0.0, 1.0], &[0.0, f64::INFINITY]));
    }
}
