//! Steps across traces: background removal and stacking.

use super::error::ProcessError;
use super::running::running_mean;
use super::section::Section as _;
use crate::compare::Step;
use crate::compare::metrics::pearson;
use crate::trace::{AScan, BScan};

/// Without a limit of the user's: a trace is dropped when what its correlation with the median trace lacks of one is over
/// this many times the median of that. In nine recordings of a horn at rest (six traces each) the first lacks 4.4 to 213
/// times the median and of the others one 21 times, all else at most 3.1: from 3.2 to 4.3 the same traces are dropped.
const OUTLIER: f64 = 4.0;
/// A trace that lacks less than this of a perfect correlation is never dropped.
const ALIKE: f64 = 1e-3;
/// Traces whose median correlation with their median trace is below this are no repetitions of one another.
const REPEATED: f64 = 0.5;

/// Sample-by-sample mean of all traces.
pub fn mean_trace(section: &BScan) -> AScan {
    let all: Vec<usize> = (0..section.count()).collect();
    as_trace(section, mean_of(section, &all))
}

/// Sample-by-sample median of all traces; of an even number the mean of the two in the middle.
pub fn median_trace(section: &BScan) -> AScan {
    let all: Vec<usize> = (0..section.count()).collect();
    as_trace(section, median_of(section, &all))
}

fn as_trace(section: &BScan, samples: Vec<f64>) -> AScan {
    AScan {
        samples,
        time_step: section.time_step,
        first_sample: section.first_sample,
        component: section.component,
        position: None,
        name: section.name.clone(),
    }
}

fn row(section: &BScan, trace: usize) -> &[f64] {
    let length = section.samples_per_trace();
    section.samples().get(trace * length..(trace + 1) * length).unwrap_or(&[])
}

fn mean_of(section: &BScan, traces: &[usize]) -> Vec<f64> {
    let mut sum = vec![0.0; section.samples_per_trace()];
    for &trace in traces {
        for (sum, v) in sum.iter_mut().zip(row(section, trace)) {
            *sum += v;
        }
    }
    sum.iter().map(|v| v / traces.len().max(1) as f64).collect()
}

fn median_of(section: &BScan, traces: &[usize]) -> Vec<f64> {
    let mut column = Vec::with_capacity(traces.len());
    let median = |sample: usize| {
        column.clear();
        column.extend(traces.iter().map(|&trace| row(section, trace)[sample]));
        middle(&mut column)
    };
    (0..section.samples_per_trace()).map(median).collect()
}

/// The median; of an even number the mean of the two in the middle, of none zero.
fn middle(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    let half = values.len() / 2;
    match values.len() {
        0 => 0.0,
        n if n % 2 == 1 => values[half],
        _ => 0.5 * (values[half - 1] + values[half]),
    }
}

/// Takes the mean over traces off each trace: what is the same in all of them (direct wave, ringing) goes.
///
/// `window`: the mean of so many traces about each (made odd; the traces are mirrored beyond the first and the last), which
/// keeps what is level for longer than that; all traces where none is given.
///
/// # Errors
/// One trace alone, of which nothing would stay; a window of fewer than two traces or more than there are.
pub fn remove_background(section: &BScan, window: Option<usize>) -> Result<(BScan, Step), ProcessError> {
    let traces = section.count();
    let too_few = |traces: usize, purpose, needed| {
        Err(ProcessError::Traces { name: section.name.clone(), traces, purpose, needed })
    };
    if traces < 2 {
        return too_few(traces, "background removal", 2);
    }
    let Some(asked) = window else {
        let mean = mean_trace(section).samples;
        let new = section.mapped(|trace| trace.iter().zip(&mean).map(|(v, mean)| v - mean).collect());
        return Ok((new, Step::BackgroundRemoved { traces, moving: false }));
    };
    let count = asked | 1;
    if count < 3 {
        return too_few(1, "a moving background", 2);
    }
    if count > traces {
        return too_few(traces, "this moving background", count);
    }
    let length = section.samples_per_trace();
    let mut new = section.clone();
    let mut column = vec![0.0; traces];
    for sample in 0..length {
        for (place, trace) in column.iter_mut().zip(section.traces()) {
            *place = trace[sample];
        }
        for (trace, mean) in running_mean(&column, count).iter().enumerate() {
            new.samples_mut()[trace * length + sample] -= mean;
        }
    }
    Ok((new, Step::BackgroundRemoved { traces: count, moving: true }))
}

/// Puts the mean of each `group` of traces in their place (of all traces where none is given), without the outliers.
///
/// A trace is an outlier when its correlation (about the means) with the sample-by-sample median trace of its group is below
/// `least`. Where none is given: when `1 - correlation` is over four times the median of that in the group, and over 0.001.
/// The first trace of a recording often is one. The last group may be smaller.
///
/// # Errors
/// A group of no traces; a least correlation that is none; fewer than half of a group kept by it, or, without it, a median
/// correlation below 0.5: the traces are then no repetitions of one another.
pub fn stack(section: &BScan, group: Option<usize>, least: Option<f64>) -> Result<(BScan, Step), ProcessError> {
    let size = group.unwrap_or(section.count());
    let name = || section.name.clone();
    if size == 0 {
        return Err(ProcessError::Traces { name: name(), traces: 0, purpose: "a stack", needed: 1 });
    }
    if let Some(least) = least.filter(|least| !(-1.0..=1.0).contains(least)) {
        return Err(ProcessError::Correlation { least });
    }
    let (mut samples, mut positions, mut dropped) = (Vec::new(), Vec::new(), Vec::new());
    let numbers: Vec<usize> = (0..section.count()).collect();
    for group in numbers.chunks(size) {
        let kept = repetitions(section, group, least)?;
        samples.extend(mean_of(section, &kept));
        dropped.extend(group.iter().copied().filter(|trace| !kept.contains(trace)));
        positions.extend(section.positions().and_then(|places| places.get(group[group.len() / 2])).copied());
    }
    let (dt, first) = (section.time_step, section.first_sample);
    let new = BScan::new(samples, section.samples_per_trace(), dt, first, section.component, name())?;
    let new = if positions.len() == new.count() { new.with_positions(positions)? } else { new };
    Ok((new, Step::Stacked { traces: section.count(), into: numbers.len().div_ceil(size), dropped }))
}

/// The traces of a group that are no outliers.
fn repetitions(section: &BScan, group: &[usize], least: Option<f64>) -> Result<Vec<usize>, ProcessError> {
    if group.len() < 2 {
        return Ok(group.to_vec());
    }
    let median = median_of(section, group);
    // Two traces without any signal are alike, whatever their correlation.
    let lacking = |trace: &usize| {
        let samples = row(section, *trace);
        if samples == median { 0.0 } else { 1.0 - pearson(samples, &median) }
    };
    let lacks: Vec<f64> = group.iter().map(lacking).collect();
    let usual = middle(&mut lacks.clone());
    let most = least.map_or((OUTLIER * usual).max(ALIKE), |least| 1.0 - least + 1e-12);
    let kept: Vec<usize> =
        group.iter().zip(&lacks).filter(|(_, lack)| **lack <= most).map(|(trace, _)| *trace).collect();
    let repeated = match least {
        Some(_) => 2 * kept.len() >= group.len(),
        None => usual <= 1.0 - REPEATED,
    };
    if repeated {
        return Ok(kept);
    }
    let least = least.unwrap_or(REPEATED);
    let alike = lacks.iter().filter(|lack| **lack <= 1.0 - least).count();
    Err(ProcessError::NoRepetitions {
        name: section.name.clone(),
        first: group[0],
        traces: group.len(),
        kept: alike,
        least,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::steps::test_traces::{noise, ricker, trace};

    /// Traces of one pulse each with white noise of their own.
    fn repeated(traces: usize, level: f64) -> BScan {
        let one = |seed: usize| {
            let mut one = trace("line", 400, 2e-11, |t| ricker(t - 4e-9));
            one.samples.iter_mut().zip(noise(400, seed as u64)).for_each(|(v, e)| *v += level * e);
            one
        };
        BScan::of(&(0..traces).map(one).collect::<Vec<_>>(), "line".into()).unwrap()
    }

    /// 64 traces with noise of 0.1: what is left of it has a standard deviation of 0.1/8 within 15 % (400 samples: its own
    /// relative error is 1/sqrt(800) = 3.5 %).
    #[test]
    fn noise_falls_as_the_root_of_the_number() {
        let (stacked, step) = stack(&repeated(64, 0.1), None, None).unwrap();
        let left = stacked.trace(0).unwrap();
        let squares: f64 = left.times().zip(&left.samples).map(|(t, v)| (v - ricker(t - 4e-9)).powi(2)).sum();
        let deviation = (squares / 400.0).sqrt();
        assert!((deviation / 0.0125 - 1.0).abs() < 0.15, "{deviation}");
        assert_eq!(step, Step::Stacked { traces: 64, into: 1, dropped: vec![] });
    }

    /// The first trace of a recording is another, as real instruments make it; groups of four drop it in their own group.
    #[test]
    fn an_outlier_is_dropped_and_named() {
        let mut scan = repeated(10, 0.005);
        for (v, e) in scan.samples_mut()[..400].iter_mut().zip(noise(400, 99)) {
            *v += 0.2 * e;
        }
        for (group, least, into) in [(None, None, 1), (Some(4), None, 3), (None, Some(0.99), 1)] {
            let (stacked, step) = stack(&scan, group, least).unwrap();
            assert_eq!(step, Step::Stacked { traces: 10, into, dropped: vec![0] });
            assert_eq!(stacked.count(), into);
        }
        assert_eq!(stack(&scan, None, Some(-1.0)).unwrap().1, Step::Stacked { traces: 10, into: 1, dropped: vec![] });
    }

    #[test]
    fn what_is_no_repetition_is_not_stacked() {
        let strangers: Vec<_> =
            (0..5).map(|k| trace("s", 300, 1e-11, move |t| ricker(t - f64::from(k) * 0.6e-9))).collect();
        let scan = BScan::of(&strangers, "line".into()).unwrap();
        let message = stack(&scan, None, None).unwrap_err().to_string();
        assert!(
            message.contains("of the 5 traces from trace 0 of `line` correlate with their median trace by 0.5"),
            "{message}"
        );
        assert_eq!(
            stack(&scan, Some(0), None).unwrap_err().to_string(),
            "`line` has 0 traces: a stack needs at least 1"
        );
        assert!(stack(&scan, None, Some(1.5)).is_err());
        assert!(stack(&scan, None, Some(f64::NAN)).is_err());
    }

    /// What is the same in all traces goes to the last bits; a target in one of eleven keeps 10/11 of itself.
    #[test]
    fn background_goes_and_the_target_stays() {
        let mut scan = repeated(11, 0.0);
        scan.samples_mut()[5 * 400 + 300] += 1.0;
        let (clean, step) = remove_background(&scan, None).unwrap();
        assert_eq!(step, Step::BackgroundRemoved { traces: 11, moving: false });
        assert!((clean.samples()[5 * 400 + 300] - 10.0 / 11.0).abs() < 1e-12);
        assert!((clean.samples()[300] + 1.0 / 11.0).abs() < 1e-12 && clean.samples()[200].abs() < 1e-14);
        let (clean, step) = remove_background(&scan, Some(4)).unwrap();
        assert_eq!(step, Step::BackgroundRemoved { traces: 5, moving: true });
        assert!((clean.samples()[5 * 400 + 300] - 0.8).abs() < 1e-12 && clean.samples()[300].abs() < 1e-14);
    }

    #[test]
    fn one_trace_has_no_background() {
        let message = |scan: &BScan, window| remove_background(scan, window).unwrap_err().to_string();
        let one = repeated(1, 0.0);
        assert_eq!(message(&one, None), "`line` has 1 trace: background removal needs at least 2");
        assert_eq!(message(&repeated(4, 0.0), Some(9)), "`line` has 4 traces: this moving background needs at least 9");
        assert!(message(&repeated(4, 0.0), Some(0)).contains("a moving background needs at least 2"));
        assert_eq!(stack(&one, None, None).unwrap().0, one);
    }
}
