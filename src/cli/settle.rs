//! Settling the bed of a scene, with progress on the screen.

use std::num::NonZeroUsize;
use std::path::Path;
use std::time::Instant;

use crate::cli::error::CliError;
use crate::cli::progress::Bar;
use crate::forward::{ForwardError, Progress};
use crate::packing::SphereBed;
use crate::packing::settle::{self, SettleError, Settled};
use crate::scene::{self, PackingMethod, Scene, SceneSpec};
use crate::units::Metres;

/// Parts of the progress bar.
const PARTS: f64 = 1000.0;

/// Resolves a scene; one whose bed has to settle is settled first, with what a stop leaves in the folder `keep`.
///
/// # Errors
/// When the bed does not settle or the scene cannot be resolved.
pub fn resolve(spec: &SceneSpec, keep: Option<&Path>) -> Result<(Scene, Option<Settled>), CliError> {
    if spec.packing.method != PackingMethod::Dem {
        return Ok((scene::resolve(spec)?, None));
    }
    let clock = Instant::now();
    let settled = settle_bed(spec, keep)?;
    let mut spec = spec.clone();
    if spec.packing.dem.is_some_and(|how| how.stones.is_some()) {
        spec.tank.height = level(&settled.bed);
    }
    let mut bed = settled.bed.clone();
    bed.size[2] = spec.tank.height;
    let mut scene = scene::resolve_with(&spec, Some(bed))?;
    scene.packing_seconds = clock.elapsed().as_secs_f64();
    Ok((scene, Some(settled)))
}

/// Settles the bed of a scene; a stop leaves its state in `keep`, where the next call takes it up.
///
/// # Errors
/// When it does not settle.
pub fn settle_bed(spec: &SceneSpec, keep: Option<&Path>) -> Result<Settled, CliError> {
    let input = scene::settle_input(spec)?;
    let threads = std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
    let bar = Bar::new("settling");
    let settled = settle::settle(&input, spec.seed, threads, keep, &|now| {
        let said = format!("({}; energy ratio {:.1e}, at most)", now.stage, now.energy_ratio);
        let done = (now.of_longest * PARTS) as usize;
        bar.update_saying(Progress { done, total: PARTS as usize }, &said)
    });
    drop(bar);
    if let (Err(SettleError::Stopped), Some(folder)) = (&settled, keep) {
        eprintln!("the state is kept in `{}`: the same command goes on from there", folder.display());
    }
    let settled = settled?;
    if settled.lost > 0 {
        eprintln!("warning: {} stones left the box", settled.lost);
    }
    for stage in settled.stages.iter().filter(|stage| !stage.at_rest) {
        eprintln!("warning: not at rest after {:.1} s ({})", stage.simulated_seconds, stage.name);
    }
    Ok(settled)
}

/// What the stages of a settled bed came to, a line each.
pub fn told(settled: &Settled) -> Vec<String> {
    let stage = |stage: &settle::Stage| {
        format!(
            "{}: {} stones, {:.2} s in {} steps of {:.1} µs, energy ratio {:.1e}, unbalanced force {:.1e}, took {:.1} s",
            stage.name,
            stage.stones,
            stage.simulated_seconds,
            stage.steps,
            1e6 * settled.time_step.si(),
            stage.energy_ratio,
            stage.unbalanced_ratio,
            stage.wall_seconds
        )
    };
    let mut lines: Vec<String> = settled.stages.iter().map(stage).collect();
    if settled.struck_off > 0 {
        lines.push(format!("{} stones struck off above the bed's height", settled.struck_off));
    }
    lines
}

/// Level of a bed's surface: its stone over the solid share away from floor and surface and over the floor.
fn level(bed: &SphereBed) -> Metres {
    let (low, high) = bed.interior();
    let share = bed.solid_share_between(Metres(low[2]), Metres(high[2]));
    Metres(bed.solid_volume() / bed.floor_area() / share.si())
}

impl From<SettleError> for CliError {
    fn from(error: SettleError) -> Self {
        match error {
            SettleError::Packing(error) => error.into(),
            SettleError::Stopped => ForwardError::Stopped.into(),
            SettleError::File(error) => error.into(),
            error @ (SettleError::Dem(_) | SettleError::NotAboveZero { .. }) => Self::input(error.to_string()),
        }
    }
}
