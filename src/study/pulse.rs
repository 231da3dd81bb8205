//! The pulse of an antenna from its echo on a metal plate, with a solver for what the source and the way do to it.

use crate::compare::pulse::{
    self, AnalyticPulse, DeconvolutionOptions, Deconvolved, Gate, PlateEcho, PlateOptions, PulseFit,
};
use crate::compare::{CompareError, envelope};
use crate::forward::{Forward, OnProgress};
use crate::model::{Sampled, Waveform, WaveformKind};
use crate::scene::{self, Dimension, PackingMethod, SceneError, SceneSpec};
use crate::trace::{AScan, Component};
use crate::units::constants::C0;
use crate::units::{Hertz, Metres, Seconds};

use super::echoes::{EchoError, PlateReference, plate_reference};

/// Why there is no pulse.
#[derive(Debug, thiserror::Error)]
pub enum PulseError {
    /// Antenna or grid cannot be.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A run failed.
    #[error(transparent)]
    Echo(#[from] EchoError),
    /// The measured trace has no echo, or is no trace.
    #[error(transparent)]
    Compare(#[from] CompareError),
}

/// An antenna above a metal plate.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct PlateSetup {
    /// Height of the antenna above the plate.
    pub height: Metres,
    /// Distance between source and receiver.
    pub separation: Metres,
    /// Nominal frequency.
    pub frequency: Hertz,
    /// Cell size.
    pub cell: Metres,
    /// In how many dimensions.
    pub dimension: Dimension,
}

impl PlateSetup {
    /// A setup with the separation of the scenes and cells of a 150th of the wavelength, in space of a 60th (2 and 5 mm at 1 GHz).
    pub fn new(height: Metres, frequency: Hertz, dimension: Dimension) -> Self {
        let share = if dimension == Dimension::Two { 150.0 } else { 60.0 };
        let separation = SceneSpec::default().antenna.separation;
        Self { height, separation, frequency, cell: Metres(C0 / frequency.si() / share), dimension }
    }

    /// The scene: no stones, and sides so far that what they send back comes after the gate and through an absorbing boundary.
    fn spec(&self) -> SceneSpec {
        let mut spec = SceneSpec { title: "plate".into(), ..SceneSpec::default() };
        let (height, cell) = (self.height.si(), self.cell.si());
        spec.tank.width = Metres(0.4 + height);
        spec.tank.depth = Some(Metres(0.3 + height));
        spec.tank.height = Metres(20.0 * cell);
        (spec.tank.wall, spec.tank.base, spec.tank.margin) = (Metres(0.0), Metres(0.0), Metres(0.1));
        spec.packing.method = PackingMethod::Homogeneous;
        (spec.antenna.height, spec.antenna.separation) = (self.height, self.separation);
        (spec.antenna.frequency, spec.antenna.waveform) = (self.frequency, WaveformKind::GaussianDotNorm);
        (spec.grid.cell, spec.grid.dimension) = (self.cell, self.dimension);
        spec.grid.time_window = Seconds(2.0 * height / C0 + 8.0 / self.frequency.si());
        spec
    }
}

/// The simulated echo of a plate.
#[derive(Debug, Clone)]
pub struct SimulatedPlate {
    /// The pulse that the source was driven by.
    pub pulse: AScan,
    /// Echo and free space.
    pub reference: PlateReference,
}

/// Simulates the echo of a plate: of a broad pulse (the first derivative of a Gaussian), or of samples.
///
/// # Errors
/// A setup that is none, a run that fails.
pub fn simulate_plate(
    solver: &dyn Forward,
    setup: &PlateSetup,
    pulse: Option<&Sampled>,
    on_progress: OnProgress<'_>,
) -> Result<SimulatedPlate, PulseError> {
    let mut scene = scene::resolve(&setup.spec())?;
    scene.pulse = pulse.cloned();
    if let Some(pulse) = pulse {
        let window = &mut scene.spec.grid.time_window;
        *window = Seconds(window.si() + pulse.times().last().copied().unwrap_or(0.0));
    }
    let reference = plate_reference(solver, &scene, on_progress)?;
    let kind = pulse.cloned().map_or(WaveformKind::GaussianDotNorm, WaveformKind::User);
    let waveform = Waveform { id: "pulse".into(), kind, amplitude: 1.0, frequency: setup.frequency.si() };
    let echo = &reference.plate_echo;
    let pulse = AScan {
        samples: echo.times().map(|t| waveform.value(t)).collect(),
        first_sample: echo.first_sample,
        time_step: echo.time_step,
        component: Component::Recorded,
        position: None,
        name: "pulse".into(),
    };
    Ok(SimulatedPlate { pulse, reference })
}

/// What a plate measurement came to.
#[derive(Debug, Clone)]
pub struct PulseOfPlate {
    /// The measured echo.
    pub measured: PlateEcho,
    /// The simulated echo of the known broad pulse.
    pub simulated: SimulatedPlate,
    /// The pulse.
    pub found: Deconvolved,
    /// The echo of a Ricker pulse of the nominal frequency against the measured one.
    pub ricker: PulseFit,
    /// Analytic pulses of the frequency that fits best, from 0.4 to 1.6 times the nominal one.
    pub fits: Vec<PulseFit>,
}

/// Takes the pulse out of a measured plate echo; see [`compare::pulse`](crate::compare::pulse) for the theory.
///
/// # Errors
/// A run that fails, no echo in the measured trace.
pub fn pulse_of_plate(
    solver: &dyn Forward,
    measured: &AScan,
    free_space: Option<&AScan>,
    setup: &PlateSetup,
    window: Option<(Seconds, Seconds)>,
    options: &DeconvolutionOptions,
    on_progress: OnProgress<'_>,
) -> Result<PulseOfPlate, PulseError> {
    let gate = Gate::of_frequency(setup.frequency.si());
    let measured = pulse::plate_echo(measured, free_space, &PlateOptions { gate, window })?;
    let simulated = simulate_plate(solver, setup, None, on_progress)?;
    let (known, response) = (&simulated.pulse, &simulated.reference.plate_echo);
    let found = pulse::deconvolve(known, response, &measured.trace, &measured.echo, options)?;
    let fit = |kind, range| pulse::fit_pulse(kind, range, known, response, &measured.trace);
    let ricker = fit(AnalyticPulse::Ricker, (setup.frequency, setup.frequency))?;
    let range = (Hertz(0.4 * setup.frequency.si()), Hertz(1.6 * setup.frequency.si()));
    let fits = AnalyticPulse::ALL.into_iter().map(|kind| fit(kind, range)).collect::<Result<_, _>>()?;
    Ok(PulseOfPlate { measured, simulated, found, ricker, fits })
}

/// Time at which the envelope of a pulse given as samples is largest; none where it is zero everywhere.
pub fn pulse_peak(pulse: &Sampled) -> Option<Seconds> {
    const SAMPLES: usize = 4096;
    let (first, last) = (*pulse.times().first()?, *pulse.times().last()?);
    let step = (last - first) / (SAMPLES - 1) as f64;
    let trace = AScan {
        samples: (0..SAMPLES).map(|k| pulse.at(first + k as f64 * step)).collect(),
        time_step: Seconds(step),
        first_sample: Seconds(first),
        component: Component::Recorded,
        position: None,
        name: "pulse".into(),
    };
    let envelope = envelope(&trace);
    let largest = envelope.peak();
    let index = envelope.samples.iter().position(|v| *v == largest).filter(|_| largest > 0.0)?;
    Some(Seconds(trace.time(index)))
}
