//! Traces recorded side by side along a line: a radargram.

use crate::trace::{AScan, Component};
use crate::units::{Metres, Seconds};

/// Traces that share one time axis, in the order in which they were recorded or simulated.
///
/// The amplitudes lie trace by trace in one block, so that a column of the radargram is a slice.
#[derive(Debug, Clone, PartialEq)]
pub struct BScan {
    samples: Vec<f64>,
    samples_per_trace: usize,
    positions: Option<Vec<[Metres; 3]>>,
    /// Time between samples.
    pub time_step: Seconds,
    /// Time of the first sample of every trace.
    pub first_sample: Seconds,
    /// What the samples are.
    pub component: Component,
    /// A name to show in legends and messages: usually the file and the channel.
    pub name: String,
}

/// Why traces cannot lie side by side.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum BScanError {
    /// The block is not a whole number of traces.
    #[error("{samples} samples are not a whole number of traces of {samples_per_trace}")]
    Uneven {
        /// Samples in the block.
        samples: usize,
        /// Samples of one trace.
        samples_per_trace: usize,
    },
    /// A trace has another time axis, or holds something else, than the first.
    #[error("trace {trace} (from 0) has another {what} than trace 0")]
    Different {
        /// Which trace, from zero.
        trace: usize,
        /// What differs: `number of samples`, `time step`, `first sample` or `component`.
        what: &'static str,
    },
    /// There is not one position for each trace.
    #[error("{positions} positions for {traces} traces")]
    Positions {
        /// Positions given.
        positions: usize,
        /// Traces there are.
        traces: usize,
    },
    /// There is no trace.
    #[error("a radargram needs at least one trace with at least one sample")]
    Empty,
}

impl BScan {
    /// Makes a radargram of amplitudes that lie trace by trace, `samples[trace * samples_per_trace + sample]`; the positions
    /// start out unknown.
    ///
    /// # Errors
    /// When the block is empty or not a whole number of traces.
    pub fn new(
        samples: Vec<f64>,
        samples_per_trace: usize,
        time_step: Seconds,
        first_sample: Seconds,
        component: Component,
        name: String,
    ) -> Result<Self, BScanError> {
        if samples.is_empty() || samples_per_trace == 0 {
            return Err(BScanError::Empty);
        }
        if !samples.len().is_multiple_of(samples_per_trace) {
            return Err(BScanError::Uneven { samples: samples.len(), samples_per_trace });
        }
        Ok(Self { samples, samples_per_trace, positions: None, time_step, first_sample, component, name })
    }

    /// Puts traces of one time axis side by side; keeps their positions when all of them know theirs.
    ///
    /// # Errors
    /// When there is no trace, or one differs from the first in its axis or component.
    pub fn of(traces: &[AScan], name: String) -> Result<Self, BScanError> {
        let first = traces.first().ok_or(BScanError::Empty)?;
        for (trace, other) in traces.iter().enumerate() {
            let what = if other.samples.len() != first.samples.len() {
                "number of samples"
            } else if other.time_step != first.time_step {
                "time step"
            } else if other.first_sample != first.first_sample {
                "first sample"
            } else if other.component != first.component {
                "component"
            } else {
                continue;
            };
            return Err(BScanError::Different { trace, what });
        }
        let samples = traces.iter().flat_map(|trace| trace.samples.iter().copied()).collect();
        let scan = Self::new(samples, first.samples.len(), first.time_step, first.first_sample, first.component, name)?;
        match traces.iter().map(|trace| trace.position).collect::<Option<Vec<_>>>() {
            Some(positions) => scan.with_positions(positions),
            None => Ok(scan),
        }
    }

    /// The same radargram with one position for each trace, in the coordinates of the model or the survey.
    ///
    /// # Errors
    /// When there is not one for each trace.
    pub fn with_positions(self, positions: Vec<[Metres; 3]>) -> Result<Self, BScanError> {
        if positions.len() != self.count() {
            return Err(BScanError::Positions { positions: positions.len(), traces: self.count() });
        }
        Ok(Self { positions: Some(positions), ..self })
    }

    /// Number of traces.
    pub fn count(&self) -> usize {
        self.samples.len() / self.samples_per_trace
    }

    /// Number of samples of each trace.
    pub const fn samples_per_trace(&self) -> usize {
        self.samples_per_trace
    }

    /// All amplitudes, trace by trace.
    pub fn samples(&self) -> &[f64] {
        &self.samples
    }

    /// All amplitudes, trace by trace, to be changed in place.
    pub fn samples_mut(&mut self) -> &mut [f64] {
        &mut self.samples
    }

    /// The amplitudes of each trace.
    pub fn traces(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        self.samples.chunks_exact(self.samples_per_trace)
    }

    /// Where each trace was taken, if known.
    pub fn positions(&self) -> Option<&[[Metres; 3]]> {
        self.positions.as_deref()
    }

    /// Trace `index` on its own, if there is one; its name carries the number, counted from zero.
    pub fn trace(&self, index: usize) -> Option<AScan> {
        let samples = self.traces().nth(index)?.to_vec();
        Some(AScan {
            samples,
            time_step: self.time_step,
            first_sample: self.first_sample,
            component: self.component,
            position: self.positions.as_ref().map(|positions| positions[index]),
            name: format!("{} trace {index}", self.name),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scan(samples: Vec<f64>, per_trace: usize) -> Result<BScan, BScanError> {
        BScan::new(samples, per_trace, Seconds(1e-10), Seconds(0.0), Component::Recorded, "line".into())
    }

    #[test]
    fn traces_come_back_as_they_were_put_together() {
        let there = scan((0..6).map(f64::from).collect(), 3).unwrap();
        let traces: Vec<_> = (0..2).map(|index| there.trace(index).unwrap()).collect();
        assert_eq!(traces[1].samples, [3.0, 4.0, 5.0]);
        assert_eq!(there.trace(2), None);
        assert_eq!(BScan::of(&traces, "line".into()), Ok(there));
    }

    #[test]
    fn positions_are_kept_when_every_trace_knows_its_own() {
        let places = vec![[Metres(0.0); 3], [Metres(1.0); 3]];
        let there = scan(vec![1.0, 2.0], 1).unwrap().with_positions(places.clone()).unwrap();
        let traces: Vec<_> = (0..2).map(|index| there.trace(index).unwrap()).collect();
        assert_eq!(BScan::of(&traces, "line".into()).unwrap().positions(), Some(places.as_slice()));
        let wrong = scan(vec![1.0, 2.0], 1).unwrap().with_positions(vec![[Metres(0.0); 3]]);
        assert_eq!(wrong, Err(BScanError::Positions { positions: 1, traces: 2 }));
    }

    #[test]
    fn what_does_not_fit_together_is_refused() {
        assert_eq!(scan(vec![], 3), Err(BScanError::Empty));
        assert_eq!(scan(vec![0.0; 5], 3), Err(BScanError::Uneven { samples: 5, samples_per_trace: 3 }));
        let there = scan(vec![0.0; 4], 2).unwrap();
        let mut traces: Vec<_> = (0..2).map(|index| there.trace(index).unwrap()).collect();
        traces[1].time_step = Seconds(2e-10);
        assert_eq!(BScan::of(&traces, "line".into()), Err(BScanError::Different { trace: 1, what: "time step" }));
        assert_eq!(BScan::of(&[], "line".into()), Err(BScanError::Empty));
    }
}
