//! What an instrument may have done to a trace that no step undoes.

use super::section::Section;
use crate::compare::error::rounded;
use crate::trace::{AScan, BScan};
use crate::units::Seconds;

/// Fewest equal samples in a row, all of them the largest or the smallest of the trace, that count as clipped. A pulse of
/// 1 GHz at 49 ps that is cut at 0.9 of its height gives three.
const CLIPPED_RUN: usize = 3;
/// Places where the level of a trace is compared before and after.
const CUTS: usize = 31;
/// Least change of the median level, as a share of the span of the trace, that counts as a jump.
const JUMP: f64 = 0.1;

/// Something that is wrong with a trace, but does not keep it from being worked on.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case", tag = "flaw")]
pub enum Flaw {
    /// The converter was at its end.
    Clipped {
        /// Name of the section.
        name: String,
        /// Samples in all runs of three or more equal ones at the largest or smallest value.
        samples: usize,
        /// Traces that have such runs.
        traces: usize,
        /// Time of the first.
        first: Seconds,
    },
    /// The level after some time is another than before.
    LevelJump {
        /// Name of the section.
        name: String,
        /// About when.
        time: Seconds,
        /// By how much, as a share of the span of the trace.
        share: f64,
        /// Traces that jump.
        traces: usize,
    },
    /// Traces without any signal.
    NoSignal {
        /// Name of the section.
        name: String,
        /// How many.
        traces: usize,
    },
}

impl std::fmt::Display for Flaw {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let of = |traces: &usize| if *traces == 1 { String::new() } else { format!(" in {traces} traces") };
        match self {
            Self::Clipped { name, samples, traces, first } => write!(
                f,
                "`{name}` is clipped: {samples} samples{} sit in runs of {CLIPPED_RUN} or more at the largest or smallest value, first at {first}; amplitudes and spectra suffer",
                of(traces)
            ),
            Self::LevelJump { name, time, share, traces } => write!(
                f,
                "the level of `{name}`{} changes by {:.0} % of its span at about {time}; `dewow` or `highpass` takes that off",
                of(traces),
                100.0 * share
            ),
            Self::NoSignal { name, traces } => {
                let are = if *traces == 1 { "trace is" } else { "traces are" };
                write!(f, "{traces} {are} zero everywhere in `{name}`")
            }
        }
    }
}

/// Looks for clipped samples, jumps of the level, and traces of zeros.
///
/// *Clipped*: three or more equal samples in a row that are the largest or the smallest of the trace (other than zero). *A
/// jump*: the medians before and after some time differ by a tenth of the span between the largest and smallest sample or
/// more (looked for at 31 times); slow drift counts as well.
pub fn flaws(section: &BScan) -> Vec<Flaw> {
    let name = &section.name;
    let (mut clipped, mut jump, mut silent): (Option<Flaw>, Option<Flaw>, usize) = (None, None, 0);
    for trace in section.traces() {
        if trace.iter().all(|v| *v == 0.0) {
            silent += 1;
            continue;
        }
        if let Some((count, at)) = clipped_samples(trace) {
            let time = rounded(section.time_of(at));
            clipped = Some(match clipped {
                Some(Flaw::Clipped { name, samples, traces, first }) => {
                    let first = if time < first { time } else { first };
                    Flaw::Clipped { name, samples: samples + count, traces: traces + 1, first }
                }
                _ => Flaw::Clipped { name: name.clone(), samples: count, traces: 1, first: time },
            });
        }
        if let Some((found, at)) = level_jump(trace) {
            let moment = rounded(section.time_of(at));
            jump = Some(match jump {
                Some(Flaw::LevelJump { name, time, share, traces }) => {
                    let (time, share) = if found > share { (moment, found) } else { (time, share) };
                    Flaw::LevelJump { name, time, share, traces: traces + 1 }
                }
                _ => Flaw::LevelJump { name: name.clone(), time: moment, share: found, traces: 1 },
            });
        }
    }
    let silent = (silent > 0).then(|| Flaw::NoSignal { name: name.clone(), traces: silent });
    clipped.into_iter().chain(jump).chain(silent).collect()
}

/// As [`flaws`], of one trace.
pub fn flaws_of(trace: &AScan) -> Vec<Flaw> {
    BScan::of(std::slice::from_ref(trace), trace.name.clone()).map(|section| flaws(&section)).unwrap_or_default()
}

/// Clipped samples and the first of them.
fn clipped_samples(trace: &[f64]) -> Option<(usize, usize)> {
    let largest = trace.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let smallest = trace.iter().copied().fold(f64::INFINITY, f64::min);
    let (mut count, mut first, mut at) = (0, None, 0);
    for run in trace.chunk_by(|a, b| a == b) {
        let extreme = run[0] != 0.0 && (run[0] == largest || run[0] == smallest);
        if run.len() >= CLIPPED_RUN && extreme && largest > smallest {
            count += run.len();
            first = first.or(Some(at));
        }
        at += run.len();
    }
    first.map(|first| (count, first))
}

/// Largest change of the median level as a share of the span, and after which sample, if it is a jump.
fn level_jump(trace: &[f64]) -> Option<(f64, usize)> {
    let span =
        trace.iter().copied().fold(f64::NEG_INFINITY, f64::max) - trace.iter().copied().fold(f64::INFINITY, f64::min);
    let median = |part: &[f64]| {
        let mut sorted = part.to_vec();
        sorted.sort_by(f64::total_cmp);
        sorted[sorted.len() / 2]
    };
    let cuts = (1..=CUTS).map(|k| k * trace.len() / (CUTS + 1)).filter(|cut| *cut >= 2 && *cut + 2 <= trace.len());
    let change = |cut: usize| ((median(&trace[cut..]) - median(&trace[..cut])).abs() / span, cut);
    cuts.map(change).filter(|(share, _)| *share >= JUMP && share.is_finite()).max_by(|a, b| a.0.total_cmp(&b.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::steps::test_traces::{noise, ricker, trace};

    fn pulses() -> AScan {
        let mut pulses = trace("horn", 512, 25e-9 / 512.0, |t| ricker(t - 5e-9) - 0.4 * ricker(t - 11e-9));
        pulses.samples.iter_mut().zip(noise(512, 4)).for_each(|(v, e)| *v += 0.002 * e);
        pulses
    }

    /// The pulse cut at 0.7 of its height: the samples above that, counted.
    #[test]
    fn clipped_samples_are_counted() {
        assert_eq!(flaws_of(&pulses()), []);
        let mut cut = pulses();
        let above = cut.samples.iter().filter(|v| **v >= 0.7).count();
        let first = cut.samples.iter().position(|v| *v >= 0.7).unwrap();
        cut.samples.iter_mut().for_each(|v| *v = v.min(0.7));
        let first = rounded(cut.time(first));
        assert_eq!(flaws_of(&cut), [Flaw::Clipped { name: "horn".into(), samples: above, traces: 1, first }]);
        assert!(above >= 3 && flaws_of(&cut)[0].to_string().contains(&format!("is clipped: {above} samples sit")));
    }

    /// Coarse steps of 8 bits make equal neighbours, but no clipping; zeros at the start of a positive trace neither.
    #[test]
    fn eight_bits_and_muted_samples_are_not_clipped() {
        let coarse = AScan { samples: pulses().samples.iter().map(|v| (v * 120.0).round()).collect(), ..pulses() };
        assert_eq!(flaws_of(&coarse), []);
        let mut muted = AScan { samples: pulses().samples.iter().map(|v| v.abs()).collect(), ..pulses() };
        muted.samples[..50].fill(0.0);
        assert_eq!(flaws_of(&muted), []);
    }

    #[test]
    fn a_jump_of_the_level_is_placed() {
        let mut jump = pulses();
        jump.samples[300..].iter_mut().for_each(|v| *v += 0.5);
        let found = flaws_of(&jump);
        let [Flaw::LevelJump { time, share, .. }] = found.as_slice() else { panic!("{found:?}") };
        assert!((time.si() - jump.time(300)).abs() < 25e-9 / 32.0, "{time}");
        assert!((0.15..0.45).contains(share), "{share}");
    }

    #[test]
    fn silent_traces_are_counted() {
        let silent = AScan { samples: vec![0.0; 512], ..pulses() };
        let scan = BScan::of(&[pulses(), silent.clone(), silent], "line".into()).unwrap();
        assert_eq!(flaws(&scan), [Flaw::NoSignal { name: "line".into(), traces: 2 }]);
        assert_eq!(flaws(&scan)[0].to_string(), "2 traces are zero everywhere in `line`");
    }
}
