//! Echo times of a scene, counted from the emission, by way of a metal plate at the height of the bed's surface.
//!
//! A line source sends no plane wave: its pulse is the antenna's, turned by 45 degrees in phase on the way. A plate at the
//! surface returns the same pulse at a time that is known (`2 h / c`), so an echo's time is its pick minus the plate's pick
//! plus that. The direct wave is taken off with a run in free space. This is what is done with a real horn, too.

use crate::compare::{self, CompareError, Echo, ExpectedEchoes};
use crate::forward::{Forward, ForwardError, OnProgress};
use crate::model::{MaterialId, Model, Object};
use crate::raster::{self, Placement, RasterError};
use crate::scene::Scene;
use crate::trace::AScan;
use crate::units::Seconds;
use crate::units::constants::C0;

/// Why the echoes of a scene could not be had.
#[derive(Debug, thiserror::Error)]
pub enum EchoError {
    /// No model.
    #[error(transparent)]
    Raster(#[from] RasterError),
    /// No traces.
    #[error(transparent)]
    Forward(#[from] ForwardError),
    /// No comparison.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// A run without an electric trace.
    #[error("the run has no electric field at its receiver")]
    NoTrace,
    /// An echo that does not stand out.
    #[error("the {which} echo was not found: {reason}")]
    NotPicked {
        /// Which.
        which: &'static str,
        /// Why.
        reason: String,
    },
}

/// Time of one echo from the emission.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct EchoTime {
    /// By the largest extremum of the waveform.
    pub waveform: Seconds,
    /// By the peak of the envelope.
    pub envelope: Seconds,
    /// Largest extremum over that of the plate at the surface: a reflection coefficient.
    pub relative_amplitude: f64,
}

/// The echoes of a scene.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Echoes {
    /// Of the bed's surface.
    pub surface: EchoTime,
    /// Of the metal plate below.
    pub plate: EchoTime,
}

/// What one antenna over one grid returns from a metal plate at the bed's surface, and from nothing.
#[derive(Debug, Clone)]
pub struct PlateReference {
    /// Trace in free space.
    pub free_space: AScan,
    /// Echo of the plate, direct wave taken off.
    pub plate_echo: AScan,
    echo: Echo,
    travel: f64,
}

/// Electric trace of a model.
pub(super) fn solve(solver: &dyn Forward, model: &Model, on_progress: OnProgress<'_>) -> Result<AScan, EchoError> {
    solver.solve(model, on_progress)?.radar_trace().cloned().ok_or(EchoError::NoTrace)
}

/// Runs the antenna of a scene in free space and over a metal plate at the bed's surface.
///
/// # Errors
/// When a run fails.
pub fn plate_reference(
    solver: &dyn Forward,
    scene: &Scene,
    on_progress: OnProgress<'_>,
) -> Result<PlateReference, EchoError> {
    plate_reference_of(solver, scene, &|model| model, on_progress)
}

/// As [`plate_reference`], with something done to each model before it runs: the antenna turned, for example.
///
/// # Errors
/// When a run fails.
pub fn plate_reference_of(
    solver: &dyn Forward,
    scene: &Scene,
    turn: &dyn Fn(Model) -> Model,
    on_progress: OnProgress<'_>,
) -> Result<PlateReference, EchoError> {
    let mut model = raster::antenna_alone(&raster::build_model(scene)?);
    let free_space = solve(solver, &turn(model.clone()), on_progress)?;
    let placement = Placement::of(&scene.spec);
    let surface = placement.bed_origin[1] + scene.spec.tank.height.si();
    let [nx, _, nz] = [0, 1, 2].map(|axis| model.grid.cells[axis] as f64 * model.grid.spacing[axis]);
    model.objects.push(Object::Box {
        lower: [0.0; 3],
        upper: [nx, surface, nz],
        material: MaterialId::PEC,
        averaging: false,
    });
    let with_plate = solve(solver, &turn(model), on_progress)?;
    let (plate_echo, _) = compare::subtract_reference(&with_plate, &free_space);
    let expected = ExpectedEchoes { no_direct_wave: true, ..Default::default() };
    let echo = pick("plate reference", compare::pick_echoes(&plate_echo, &expected).surface)?;
    let travel = 2.0 * scene.spec.antenna.height.si() / C0;
    Ok(PlateReference { free_space, plate_echo, echo, travel })
}

fn pick(which: &'static str, found: compare::EchoPick) -> Result<Echo, EchoError> {
    match found {
        compare::EchoPick::Picked(echo) => Ok(echo),
        compare::EchoPick::NotPicked(reason) => Err(EchoError::NotPicked { which, reason: reason.to_string() }),
    }
}

impl PlateReference {
    fn time_of(&self, echo: &Echo) -> EchoTime {
        EchoTime {
            waveform: Seconds(echo.waveform.time.si() - self.echo.waveform.time.si() + self.travel),
            envelope: Seconds(echo.envelope.time.si() - self.echo.envelope.time.si() + self.travel),
            relative_amplitude: -echo.waveform.amplitude / self.echo.waveform.amplitude,
        }
    }

    /// The emission's time on the axis of the traces, by the peak of the envelope.
    pub fn zero(&self) -> Seconds {
        Seconds(self.echo.envelope.time.si() - self.travel)
    }

    /// The emission's time on the axis of the traces, by the largest extremum of the waveform.
    pub fn waveform_zero(&self) -> Seconds {
        Seconds(self.echo.waveform.time.si() - self.travel)
    }

    /// Where the surface and the plate echo of a scene lie in a trace: [`Scene::echo_windows`] from the emission.
    pub fn windows(&self, scene: &Scene) -> ((Seconds, Seconds), (Seconds, Seconds)) {
        let zero = self.zero().si();
        let [surface, plate] =
            scene.echo_windows().map(|[from, to]| (Seconds(zero + from.si()), Seconds(zero + to.si())));
        (surface, plate)
    }

    /// Picks the echoes of a scene in a trace of it, in [`windows`](Self::windows).
    ///
    /// # Errors
    /// When an echo does not stand out.
    pub fn echoes(&self, scene: &Scene, trace: &AScan) -> Result<Echoes, EchoError> {
        let (echoes_only, _) = compare::subtract_reference(trace, &self.free_space);
        let (surface, plate) = self.windows(scene);
        let expected = ExpectedEchoes {
            surface: Some(surface),
            plate: Some(plate),
            no_direct_wave: true,
            no_noise: true,
            ..Default::default()
        };
        self.echoes_of(&compare::pick_echoes(&echoes_only, &expected))
    }

    /// The echoes of picks in a trace without its direct wave.
    ///
    /// # Errors
    /// When an echo does not stand out.
    pub fn echoes_of(&self, picks: &compare::Picks) -> Result<Echoes, EchoError> {
        Ok(Echoes {
            surface: self.time_of(&pick("surface", picks.surface)?),
            plate: self.time_of(&pick("plate", picks.plate)?),
        })
    }
}

/// Runs a scene and picks its echoes.
///
/// # Errors
/// When the run fails or an echo does not stand out.
pub fn simulate_echoes(
    solver: &dyn Forward,
    scene: &Scene,
    reference: &PlateReference,
    on_progress: OnProgress<'_>,
) -> Result<(AScan, Echoes), EchoError> {
    let trace = solve(solver, &raster::build_model(scene)?, on_progress)?;
    let echoes = reference.echoes(scene, &trace)?;
    Ok((trace, echoes))
}
