//! Settles, presses and sounds the beds.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::time::Instant;

use crate::compare;
use crate::forward::{Forward, OnProgress, Progress};
use crate::packing::settle::{SettleError, settle};
use crate::packing::spheres::{RandomAddition, random_addition};
use crate::packing::{PackingError, SphereBed};
use crate::raster;
use crate::scene::{self, EquivalentStone, PackingMethod, Scene, SceneError, SceneSpec};
use crate::study::echoes::{EchoError, PlateReference, plate_reference, solve};
use crate::units::{Metres, Share};

use super::plan::{DemCostPlan, DemKnob, DemSetting};
use super::press::settlement;
use super::table::{DemCostRow, DemCostTable, Judged, mean_trace, off};

/// Why there is no cost curve of settling.
#[derive(Debug, thiserror::Error)]
pub enum DemCostError {
    /// No scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// No stones.
    #[error(transparent)]
    Packing(#[from] PackingError),
    /// No bed, for another reason than motion that went bad, which is a result.
    #[error(transparent)]
    Settle(#[from] SettleError),
    /// No trace.
    #[error(transparent)]
    Echo(#[from] EchoError),
}

/// Solid share of spheres that are placed at random: little under where no more find a place.
const PLACED: Share = Share(0.35);

/// What the beds of a setting came to.
#[derive(Debug, Clone, Default)]
struct Found {
    stones: Vec<f64>,
    seconds: Vec<f64>,
    voids: Vec<f64>,
    /// Up to the nominal height, which discs are packed to.
    voids_to_height: Vec<f64>,
    strain: Vec<f64>,
    plate_ns: Vec<f64>,
    traces: Vec<Vec<f64>>,
    not_picked: usize,
    stopped: Option<String>,
}

/// Measures all settings of a plan on one thread, each with all seeds; beds that several knobs share are settled once.
///
/// # Errors
/// See [`DemCostError`]. A bed that the watchdog stops is told in its row.
pub fn settling_cost(
    plan: &DemCostPlan,
    solver: &dyn Forward,
    on_point: &dyn Fn(usize, usize),
    on_progress: OnProgress<'_>,
) -> Result<DemCostTable, DemCostError> {
    let settings = plan.settings();
    let mut known: Vec<(DemSetting, Found)> = vec![];
    let mut study = Study { plan, solver, on_progress, references: vec![] };
    for (done, (_, setting)) in settings.iter().enumerate() {
        on_point(done, settings.len());
        if known.iter().all(|(other, _)| other != setting) {
            known.push((*setting, study.settled(*setting)?));
        }
    }
    let of = |setting: DemSetting| known.iter().find(|(other, _)| *other == setting).map(|(_, found)| found);
    let reference =
        |knob: DemKnob| settings.iter().find(|(other, _)| *other == knob).and_then(|(_, setting)| of(*setting));
    let mut rows = vec![];
    for (index, (knob, setting)) in settings.iter().enumerate() {
        let first = index == 0 || settings[index - 1].0 != *knob;
        if let (Some(found), Some(reference)) = (of(*setting), reference(*knob)) {
            rows.push(row(*knob, name_of(*knob, *setting), Some(*setting), first, found, reference));
        }
    }
    if let Some(reference) = reference(DemKnob::Stiffness) {
        for placed in
            [Placed::Spheres, Placed::Discs(EquivalentStone::True), Placed::Discs(EquivalentStone::Equivalent2d)]
        {
            let found = study.placed(placed, reference)?;
            rows.push(row(DemKnob::Placed, placed.name().into(), None, false, &found, reference));
        }
    }
    let (height_m, base) = (plan.scene.tank.height.si(), plan.base);
    Ok(DemCostTable { format_version: 1, height_m, base, seeds: plan.seeds, sections: plan.sections, rows })
}

fn name_of(knob: DemKnob, setting: DemSetting) -> String {
    match knob {
        DemKnob::Stiffness => format!("{:.4} GPa", 1e-9 * setting.young.si()),
        DemKnob::TimeStep => format!("{:.0} % of Rayleigh", 100.0 * setting.time_step.si()),
        DemKnob::Stones | DemKnob::Placed => format!("for {} stones", setting.stones),
    }
}

fn row(
    knob: DemKnob,
    name: String,
    setting: Option<DemSetting>,
    reference: bool,
    found: &Found,
    by: &Found,
) -> DemCostRow {
    let trace = mean_trace(&found.traces).zip(mean_trace(&by.traces)).map(|(own, by)| off(&own, &by));
    let mut seconds = found.seconds.clone();
    seconds.sort_by(f64::total_cmp);
    DemCostRow {
        knob,
        name,
        setting,
        reference,
        stones: found.stones.iter().sum::<f64>() / found.stones.len().max(1) as f64,
        seconds: seconds.get(seconds.len() / 2).copied().unwrap_or(f64::NAN),
        voids_percent: Judged::of(&found.voids, &by.voids),
        strain_percent: Judged::of(&found.strain, &by.strain),
        plate_ns: Judged::of(&found.plate_ns, &by.plate_ns),
        trace_percent: trace.map(|(error, _)| 100.0 * error),
        trace_noise_percent: trace.map(|(_, noise)| 100.0 * noise),
        not_picked: found.not_picked,
        stopped: found.stopped.clone(),
    }
}

/// Stones that are placed and not settled.
#[derive(Debug, Clone, Copy)]
enum Placed {
    Spheres,
    Discs(EquivalentStone),
}

impl Placed {
    const fn name(self) -> &'static str {
        match self {
            Self::Spheres => "spheres, random addition",
            Self::Discs(EquivalentStone::True) => "discs, RSA",
            Self::Discs(EquivalentStone::Equivalent2d) => "discs, RSA, equivalent stone",
        }
    }
}

struct Study<'a> {
    plan: &'a DemCostPlan,
    solver: &'a dyn Forward,
    on_progress: OnProgress<'a>,
    /// By the width of the tank.
    references: Vec<(f64, PlateReference)>,
}

impl Study<'_> {
    fn settled(&mut self, setting: DemSetting) -> Result<Found, DemCostError> {
        let input = self.plan.input(setting)?;
        let mut found = Found::default();
        for seed in 1..=self.plan.seeds {
            let stop = |_| self.go_on();
            let settled = match settle(&input, seed, NonZeroUsize::MIN, None, &stop) {
                Err(SettleError::Dem(error)) => {
                    found.stopped = Some(first_line(&error));
                    continue;
                }
                other => other?,
            };
            found.seconds.push(settled.stages.iter().map(|stage| stage.wall_seconds).sum());
            self.look(&mut found, &settled.bed)?;
            match settlement(&input, &settled.bed) {
                Ok(strain) => found.strain.extend(strain.map(|strain| 100.0 * strain)),
                Err(error) => found.stopped = Some(first_line(&error)),
            }
        }
        Ok(found)
    }

    fn go_on(&self) -> ControlFlow<()> {
        (self.on_progress)(Progress { done: 0, total: 0 })
    }

    /// Voids and traces of a bed of spheres.
    fn look(&mut self, found: &mut Found, bed: &SphereBed) -> Result<(), DemCostError> {
        found.stones.push(bed.count() as f64);
        let voids = |height: Metres| 100.0 * (1.0 - bed.solid_share_between(Metres(0.0), height).si());
        found.voids.push(voids(self.plan.judged_height()));
        found.voids_to_height.push(voids(self.plan.scene.tank.height));
        let mut spec = self.plan.scene.clone();
        (spec.tank.width, spec.tank.depth) = (bed.size[0], Some(bed.size[1]));
        let cut = |k: usize| {
            let at = (k as f64 + 0.5) / self.plan.sections as f64 * bed.size[1].si();
            let mut spec = spec.clone();
            spec.packing.slice = Some(Metres(at));
            scene::resolve_with(&spec, Some(bed.clone()))
        };
        let scenes = (0..self.plan.sections).map(cut).collect::<Result<Vec<_>, _>>()?;
        self.sound(found, &scenes)
    }

    /// Runs the sections of one bed.
    fn sound(&mut self, found: &mut Found, scenes: &[Scene]) -> Result<(), DemCostError> {
        let mut times = vec![];
        for scene in scenes {
            let reference = self.reference(scene)?;
            let trace = solve(self.solver, &raster::build_model(scene).map_err(EchoError::from)?, self.on_progress)?;
            let (echoes, _) = compare::subtract_reference(&trace, &reference.free_space);
            match reference.echoes(scene, &trace) {
                Ok(echoes) => times.push(1e9 * echoes.plate.envelope.si()),
                Err(EchoError::NotPicked { .. }) => found.not_picked += 1,
                Err(error) => return Err(error.into()),
            }
            found.traces.push(echoes.samples);
        }
        if !times.is_empty() {
            found.plate_ns.push(times.iter().sum::<f64>() / times.len() as f64);
        }
        Ok(())
    }

    fn reference(&mut self, scene: &Scene) -> Result<PlateReference, DemCostError> {
        let width = scene.spec.tank.width.si();
        if let Some((_, known)) = self.references.iter().find(|(other, _)| *other == width) {
            return Ok(known.clone());
        }
        let made = plate_reference(self.solver, scene, self.on_progress)?;
        self.references.push((width, made.clone()));
        Ok(made)
    }

    /// Stones that are placed at random, with the voids of the reference where they can have them.
    fn placed(&mut self, placed: Placed, reference: &Found) -> Result<Found, DemCostError> {
        let input = self.plan.input(self.plan.base)?;
        let voids = reference.voids_to_height.iter().sum::<f64>() / reference.voids_to_height.len().max(1) as f64;
        let mut found = Found::default();
        for seed in 1..=self.plan.seeds {
            let clock = Instant::now();
            let Placed::Discs(stone) = placed else {
                let input = RandomAddition {
                    size: input.size,
                    periodic: [false; 2],
                    grading: input.grading.clone(),
                    class_reading: input.class_reading,
                    solid_share: PLACED,
                };
                let bed = random_addition(&input, seed)?;
                found.seconds.push(clock.elapsed().as_secs_f64());
                self.look(&mut found, &bed)?;
                continue;
            };
            let mut spec: SceneSpec = self.plan.scene.clone();
            (spec.tank.width, spec.tank.depth) = (input.size[0], None);
            (spec.packing.method, spec.packing.stone_permittivity) = (PackingMethod::Rsa, stone);
            spec.packing.voids = Share(0.01 * voids);
            let sections = self.plan.sections as u64;
            let scene = |k: u64| scene::resolve(&SceneSpec { seed: seed * sections + k, ..spec.clone() });
            let scenes = (0..sections).map(scene).collect::<Result<Vec<_>, _>>()?;
            found.seconds.push(clock.elapsed().as_secs_f64());
            let judged = self.plan.judged_height();
            let packings: Vec<_> = scenes.iter().filter_map(|scene| scene.packing.as_ref()).collect();
            let mean = |of: &dyn Fn(&crate::packing::Packing) -> f64| {
                packings.iter().map(|packing| of(packing)).sum::<f64>() / packings.len().max(1) as f64
            };
            found.stones.push(mean(&|packing| packing.count() as f64));
            found.voids.push(mean(&|discs| 100.0 * (1.0 - discs.solid_share_between(Metres(0.0), judged).si())));
            self.sound(&mut found, &scenes)?;
        }
        Ok(found)
    }
}

fn first_line(error: &dyn std::error::Error) -> String {
    error.to_string().lines().next().unwrap_or_default().to_string()
}
