//! What a step works on: one trace, or several on one time axis.

use crate::trace::{AScan, BScan, BScanError};
use crate::units::Seconds;

/// One trace, or several on one time axis.
pub trait Section: Clone {
    /// Name for messages.
    fn name(&self) -> &str;

    /// Time between samples.
    fn time_step(&self) -> Seconds;

    /// Time of the first sample.
    fn first_sample(&self) -> Seconds;

    /// Number of samples of each trace.
    fn length(&self) -> usize;

    /// Number of traces.
    fn traces(&self) -> usize;

    /// The same section with each trace replaced by one of the same length; samples beyond it are left out, missing ones
    /// stay as they are.
    #[must_use]
    fn mapped(&self, of: impl FnMut(&[f64]) -> Vec<f64>) -> Self;

    /// The same section with each trace replaced, on another time axis; all new traces should have one length.
    ///
    /// # Errors
    /// New traces that are empty or of different lengths.
    fn rebuilt(
        &self,
        first_sample: Seconds,
        time_step: Seconds,
        of: impl FnMut(&[f64]) -> Vec<f64>,
    ) -> Result<Self, BScanError>;

    /// The same section with its time axis moved.
    #[must_use]
    fn moved(&self, first_sample: Seconds) -> Self;

    /// Time of sample `index`, s.
    fn time_of(&self, index: usize) -> f64 {
        self.first_sample().si() + index as f64 * self.time_step().si()
    }
}

impl Section for AScan {
    fn name(&self) -> &str {
        &self.name
    }

    fn time_step(&self) -> Seconds {
        self.time_step
    }

    fn first_sample(&self) -> Seconds {
        self.first_sample
    }

    fn length(&self) -> usize {
        self.samples.len()
    }

    fn traces(&self) -> usize {
        1
    }

    fn mapped(&self, mut of: impl FnMut(&[f64]) -> Vec<f64>) -> Self {
        let mut new = self.clone();
        for (sample, value) in new.samples.iter_mut().zip(of(&self.samples)) {
            *sample = value;
        }
        new
    }

    fn rebuilt(
        &self,
        first_sample: Seconds,
        time_step: Seconds,
        mut of: impl FnMut(&[f64]) -> Vec<f64>,
    ) -> Result<Self, BScanError> {
        Ok(Self { samples: of(&self.samples), first_sample, time_step, ..self.clone() })
    }

    fn moved(&self, first_sample: Seconds) -> Self {
        Self { first_sample, ..self.clone() }
    }
}

impl Section for BScan {
    fn name(&self) -> &str {
        &self.name
    }

    fn time_step(&self) -> Seconds {
        self.time_step
    }

    fn first_sample(&self) -> Seconds {
        self.first_sample
    }

    fn length(&self) -> usize {
        self.samples_per_trace()
    }

    fn traces(&self) -> usize {
        self.count()
    }

    fn mapped(&self, mut of: impl FnMut(&[f64]) -> Vec<f64>) -> Self {
        let mut new = self.clone();
        let length = self.samples_per_trace();
        for (place, trace) in new.samples_mut().chunks_exact_mut(length).zip(self.traces()) {
            for (sample, value) in place.iter_mut().zip(of(trace)) {
                *sample = value;
            }
        }
        new
    }

    fn rebuilt(
        &self,
        first_sample: Seconds,
        time_step: Seconds,
        mut of: impl FnMut(&[f64]) -> Vec<f64>,
    ) -> Result<Self, BScanError> {
        let (mut samples, mut length) = (Vec::new(), 0);
        for (trace, old) in self.traces().enumerate() {
            let new = of(old);
            if trace == 0 {
                length = new.len();
            } else if new.len() != length {
                return Err(BScanError::Different { trace, what: "number of samples" });
            }
            samples.extend(new);
        }
        let new = Self::new(samples, length, time_step, first_sample, self.component, self.name.clone())?;
        match self.positions() {
            Some(positions) => new.with_positions(positions.to_vec()),
            None => Ok(new),
        }
    }

    fn moved(&self, first_sample: Seconds) -> Self {
        let mut new = self.clone();
        new.first_sample = first_sample;
        new
    }
}
