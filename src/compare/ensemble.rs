//! Many simulations against one measurement: their mean, their band, and where the measurement leaves it.

use super::comparison::Comparison;
use super::error::CompareError;
use super::metrics::Metrics;
use super::resample::resample;
use crate::trace::AScan;
use crate::units::Seconds;

/// Mean, deviation and span of one number over the members.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Spread {
    /// Members that have it.
    pub members: usize,
    /// Mean.
    pub mean: f64,
    /// Sample standard deviation; zero for one member.
    pub deviation: f64,
    /// Smallest.
    pub low: f64,
    /// Largest.
    pub high: f64,
}

impl Spread {
    /// The spread of some numbers; none where there are none.
    pub fn of(values: &[f64]) -> Option<Self> {
        let members = values.len();
        let mean = values.iter().sum::<f64>() / members as f64;
        let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let deviation = (squares / members.saturating_sub(1).max(1) as f64).sqrt();
        (members > 0).then_some(Self { members, mean, deviation, low, high })
    }
}

/// An ensemble of simulations and the measurement that they should hold, on one time axis.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Ensemble {
    /// Number of simulations.
    pub members: usize,
    /// Time of the first sample, s.
    pub first_sample_s: f64,
    /// Time between samples, s.
    pub time_step_s: f64,
    /// The measurement, prepared as in the comparisons.
    pub measured: Vec<f64>,
    /// Mean of the simulations, sample by sample.
    pub mean: Vec<f64>,
    /// Their sample standard deviation.
    pub deviation: Vec<f64>,
    /// The smallest.
    pub low: Vec<f64>,
    /// The largest.
    pub high: Vec<f64>,
    /// Share of the samples of the measurement within the mean ± one standard deviation.
    pub inside_deviation: f64,
    /// Share of the samples of the measurement between the smallest and the largest simulation.
    pub inside_span: f64,
    /// What that share is on average for one more member of the ensemble, `(n - 1) / (n + 1)`.
    pub inside_span_of_a_member: f64,
    /// Each metric by name (simulation minus measurement) over the members that have it.
    pub metrics: Vec<(&'static str, Spread)>,
    /// Name of the measurement.
    pub measured_name: String,
}

impl Ensemble {
    /// Which samples of the measurement lie between the smallest and the largest simulation.
    pub fn inside(&self) -> impl Iterator<Item = bool> + '_ {
        self.measured.iter().zip(self.low.iter().zip(&self.high)).map(|(v, (low, high))| (low..=high).contains(&v))
    }

    /// Time of sample `index`, s.
    pub fn time(&self, index: usize) -> f64 {
        self.first_sample_s + index as f64 * self.time_step_s
    }

    /// One of its curves as a trace, for metrics and figures.
    pub fn curve(&self, name: &str, samples: &[f64], like: &AScan) -> AScan {
        AScan {
            samples: samples.to_vec(),
            time_step: Seconds(self.time_step_s),
            first_sample: Seconds(self.first_sample_s),
            name: name.into(),
            ..like.clone()
        }
    }
}

/// Puts comparisons of one measurement (first) with many simulations (second) together.
///
/// The axis is that of the first comparison over the time that all of them cover; the others are resampled onto it.
///
/// # Errors
/// Fewer than two comparisons, or no time that all cover.
pub fn ensemble(comparisons: &[Comparison]) -> Result<Ensemble, CompareError> {
    let [first, _, ..] = comparisons else {
        return Err(CompareError::FewMembers { members: comparisons.len() });
    };
    let (dt, start) = (first.a.time_step.si(), first.a.first_sample.si());
    let last = |trace: &AScan| trace.time(trace.samples.len().saturating_sub(1));
    let from = comparisons.iter().map(|c| c.a.first_sample.si()).fold(f64::NEG_INFINITY, f64::max);
    let to = comparisons.iter().map(|c| last(&c.a)).fold(f64::INFINITY, f64::min);
    let skipped = ((from - start) / dt - 1e-6).ceil().max(0.0);
    let begin = start + skipped * dt;
    let count = ((to - begin) / dt + 1e-6).floor() + 1.0;
    if count.is_nan() || count < 2.0 {
        return Err(CompareError::NoCommonTime { members: comparisons.len() });
    }
    let onto = |trace: &AScan| resample(trace, Seconds(begin), Seconds(dt), count as usize).samples;
    let measured = onto(&first.a);
    let members: Vec<Vec<f64>> = comparisons.iter().map(|comparison| onto(&comparison.b)).collect();
    let spreads: Vec<Spread> = (0..measured.len())
        .filter_map(|k| Spread::of(&members.iter().map(|samples| samples[k]).collect::<Vec<_>>()))
        .collect();
    let share = |inside: &dyn Fn(f64, &Spread) -> bool| {
        let count = measured.iter().zip(&spreads).filter(|(v, spread)| inside(**v, spread)).count();
        count as f64 / measured.len() as f64
    };
    let names = first.metrics.named();
    let metrics = names.iter().enumerate().filter_map(|(index, (name, _))| {
        let values: Vec<f64> = comparisons.iter().filter_map(|c| Metrics::named(&c.metrics)[index].1).collect();
        Some((*name, Spread::of(&values)?))
    });
    let n = comparisons.len();
    Ok(Ensemble {
        members: n,
        first_sample_s: begin,
        time_step_s: dt,
        inside_deviation: share(&|v, spread| (v - spread.mean).abs() <= spread.deviation),
        inside_span: share(&|v, spread| (spread.low..=spread.high).contains(&v)),
        inside_span_of_a_member: (n - 1) as f64 / (n + 1) as f64,
        mean: spreads.iter().map(|spread| spread.mean).collect(),
        deviation: spreads.iter().map(|spread| spread.deviation).collect(),
        low: spreads.iter().map(|spread| spread.low).collect(),
        high: spreads.iter().map(|spread| spread.high).collect(),
        metrics: metrics.collect(),
        measured_name: first.a.name.clone(),
        measured,
    })
}

#[cfg(test)]
mod tests {
    use super::super::comparison::{CompareOptions, Normalisation, Polarity, compare};
    use super::super::steps::test_traces::{noise, ricker, trace};
    use super::*;

    fn plain() -> CompareOptions {
        CompareOptions {
            normalisation: Normalisation::None,
            polarity: Polarity::Keep,
            remove_dc: false,
            ..CompareOptions::default()
        }
    }

    fn noisy(seed: u64) -> AScan {
        let mut one = trace("member", 2000, 1e-11, |t| ricker(t - 5e-9));
        one.samples.iter_mut().zip(noise(2000, seed)).for_each(|(v, e)| *v += 0.1 * e);
        one
    }

    /// By hand: 1, 2, 6 have the mean 3 and the deviation sqrt(7).
    #[test]
    fn a_spread_by_hand() {
        let spread = Spread::of(&[1.0, 2.0, 6.0]).unwrap();
        assert_eq!((spread.mean, spread.low, spread.high, spread.members), (3.0, 1.0, 6.0, 3));
        assert!((spread.deviation - 7.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(Spread::of(&[4.0]).unwrap().deviation, 0.0);
        assert_eq!(Spread::of(&[]), None);
    }

    /// A measurement drawn as the members are lies between the smallest and the largest of n in (n - 1)/(n + 1) of the
    /// samples: 0.8182 of 2000 independent ones for n = 10, with a standard deviation of 0.009. One that is offset by ten
    /// deviations lies outside.
    #[test]
    fn one_more_member_is_inside_as_often_as_it_should() {
        let against = |measured: &AScan| {
            let found: Vec<_> = (1..=10).map(|seed| compare(measured, &noisy(seed), &plain()).unwrap()).collect();
            ensemble(&found).unwrap()
        };
        let found = against(&noisy(99));
        assert!((found.inside_span_of_a_member - 9.0 / 11.0).abs() < 1e-12);
        assert!((found.inside_span - 9.0 / 11.0).abs() < 0.03, "{}", found.inside_span);
        assert_eq!(found.inside().filter(|inside| *inside).count() as f64 / 2000.0, found.inside_span);
        let far = AScan { samples: noisy(99).samples.iter().map(|v| v + 1.0).collect(), ..noisy(99) };
        assert_eq!(against(&far).inside_span, 0.0);
    }

    /// Members of other steps and times come onto one axis: noise-free, all are the same curve there, to the 1e-5 of the
    /// resampling.
    #[test]
    fn members_of_other_steps_lie_on_one_axis() {
        let measured = trace("measured", 500, 4e-11, |t| ricker(t - 5e-9));
        let member = |dt: f64, first: f64| {
            let at = trace("member", 1600, dt, |t| ricker(t + first - 5e-9));
            AScan { first_sample: Seconds(first), ..at }
        };
        let options = CompareOptions { time_step: Some(Seconds(1e-11)), ..plain() };
        let found: Vec<_> = [(1e-11, 0.0), (1.3e-11, 0.4e-9), (0.9e-11, -1e-9)]
            .map(|(dt, first)| compare(&measured, &member(dt, first), &options).unwrap())
            .into();
        let found = ensemble(&found).unwrap();
        assert_eq!(found.members, 3);
        assert!(found.first_sample_s >= 0.4e-9 - 1e-20 && found.deviation.iter().all(|v| *v < 1e-4));
        assert_eq!(found.mean.len(), found.measured.len());
        let time_errors = found.metrics.iter().find(|(name, _)| name.contains("lag")).unwrap();
        assert!(time_errors.1.mean.abs() < 1e-3);
    }

    #[test]
    fn one_simulation_is_no_ensemble() {
        assert_eq!(ensemble(&[]).unwrap_err().to_string(), "0 simulations make no ensemble: at least 2 are needed");
    }
}
