//! What two dimensions cost in accuracy and three in time: one bed in space, sections through it, and discs.

use std::time::Instant;

use crate::forward::{Forward, OnProgress};
use crate::packing::SphereBed;
use crate::scene::{self, Dimension, EquivalentStone, PackingMethod, Scene, SceneError, SceneSpec};
use crate::trace::AScan;
use crate::units::{Metres, Share};

use super::echoes::{EchoError, PlateReference, plate_reference, simulate_echoes};
use super::statistics::MeanAndSpread;

/// Why the dimensions could not be compared.
#[derive(Debug, thiserror::Error)]
pub enum DimensionError {
    /// A scene cannot be.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A run or a pick failed.
    #[error(transparent)]
    Echo(#[from] EchoError),
    /// No section at all.
    #[error("no section was asked for\n\nhint: `--slices 5`")]
    NoSections,
}

/// One way of modelling the bed.
#[derive(Debug, Clone, serde::Serialize)]
pub struct DimensionRow {
    /// What it is: `3-D`, `sections`, `RSA`, `RSA, equivalent stone`, and each without stones.
    pub name: &'static str,
    /// Void share up to the bed's nominal height over the whole width, %; absent without stones.
    pub voids_percent: Option<MeanAndSpread>,
    /// Arrival of the plate's echo from the emission by the largest extremum of the waveform, ns.
    pub plate_ns: Option<MeanAndSpread>,
    /// The same by the peak of the envelope, ns.
    pub plate_envelope_ns: Option<MeanAndSpread>,
    /// Largest extremum of the plate's echo over that of a metal plate at the bed's surface.
    pub amplitude: Option<MeanAndSpread>,
    /// Runs whose plate echo could not be picked.
    pub not_picked: usize,
    /// Wall time of one run from stones to trace, s.
    pub seconds: MeanAndSpread,
    /// Cells of one run.
    pub cells: usize,
    /// Time steps of one run.
    pub steps: usize,
}

/// A trace to draw: the direct wave taken off, over the amplitude of the reference plate's echo, from the emission.
#[derive(Debug, Clone)]
pub struct DimensionTrace {
    /// The row it belongs to.
    pub name: &'static str,
    /// Time from the emission, ns, and amplitude.
    pub points: Vec<(f64, f64)>,
}

/// The comparison.
#[derive(Debug, Clone)]
pub struct DimensionTable {
    /// Arrival of the plate's echo of a plane wave through the bed as a mixture, ns.
    pub mixture_ns: f64,
    /// The rows; the first is the bed in space.
    pub rows: Vec<DimensionRow>,
    /// All traces.
    pub traces: Vec<DimensionTrace>,
}

/// Void share of the bed up to a height over the whole floor.
fn voids_of_bed(bed: &SphereBed, height: Metres) -> f64 {
    1.0 - bed.solid_share_between(Metres(0.0), height).si()
}

/// Void share of the middle below the antenna, half as wide and deep as the bed: there are no walls, which keep stones apart.
fn voids_below_antenna(bed: &SphereBed, spec: &SceneSpec) -> f64 {
    let [length, depth, _] = bed.size.map(Metres::si);
    let at = spec.antenna.position.map_or(0.5 * length, Metres::si).clamp(0.25 * length, 0.75 * length);
    let low = [at - 0.25 * length, 0.25 * depth, 0.0];
    let high = [at + 0.25 * length, 0.75 * depth, spec.tank.height.si()];
    1.0 - bed.solid_share_in(low, high).si()
}

/// Runs the bed of a scene in space, `sections` sections through it, as many packings of discs by random sequential adsorption
/// with the bed's void share (seeds from the scene's on), the same with the equivalent stone, and the bed as a mixture without
/// stones in both dimensions, in space also with the voids of the middle below the antenna. Everything else of the scene is the same in all; the void share that the scene's mixture and echo
/// windows are made from is the bed's.
///
/// # Errors
/// When a scene or a run fails. An echo that cannot be picked is counted, not an error.
pub fn compare_dimensions(
    solver: &dyn Forward,
    spec: &SceneSpec,
    bed: &SphereBed,
    sections: usize,
    on_progress: OnProgress<'_>,
) -> Result<DimensionTable, DimensionError> {
    if sections == 0 {
        return Err(DimensionError::NoSections);
    }
    let mut base = spec.clone();
    base.packing.voids = Share(voids_of_bed(bed, spec.tank.height));
    base.packing.slice = None;
    let in_space = |spec: &SceneSpec| SceneSpec { grid: of_dimension(spec, Dimension::Three), ..spec.clone() };
    let in_plane = |spec: &SceneSpec| SceneSpec { grid: of_dimension(spec, Dimension::Two), ..spec.clone() };
    let whole = scene::resolve_with(&in_space(&base), Some(bed.clone()))?;
    let space = plate_reference(solver, &whole, on_progress)?;
    let mut table = DimensionTable { mixture_ns: 1e9 * whole.arrivals.plate.si(), rows: vec![], traces: vec![] };
    let mut run = Runs { solver, table: &mut table, on_progress };
    run.row("3-D", &space, &mut std::iter::once(Ok(whole)))?;
    let mut homogeneous = base.clone();
    homogeneous.packing.method = PackingMethod::Homogeneous;
    run.row("3-D, mixture", &space, &mut std::iter::once(scene::resolve(&in_space(&homogeneous))))?;
    let mut inside = homogeneous.clone();
    inside.packing.voids = Share(voids_below_antenna(bed, spec));
    run.row("3-D, mixture as below", &space, &mut std::iter::once(scene::resolve(&in_space(&inside))))?;
    let depth = bed.size[1].si();
    let cut = |k: usize| {
        let mut spec = in_plane(&base);
        spec.packing.slice = Some(Metres((k as f64 + 0.5) / sections as f64 * depth));
        scene::resolve_with(&spec, Some(bed.clone()))
    };
    let plane = plate_reference(solver, &cut(0)?, on_progress)?;
    run.row("sections", &plane, &mut (0..sections).map(cut))?;
    for (name, stone) in [("RSA", EquivalentStone::True), ("RSA, equivalent stone", EquivalentStone::Equivalent2d)] {
        let discs = |k: usize| {
            let mut spec = in_plane(&base);
            spec.packing.method = PackingMethod::Rsa;
            spec.packing.stone_permittivity = stone;
            spec.seed = base.seed.wrapping_add(k as u64);
            scene::resolve(&spec)
        };
        run.row(name, &plane, &mut (0..sections).map(discs))?;
    }
    run.row("2-D, mixture", &plane, &mut std::iter::once(scene::resolve(&in_plane(&homogeneous))))?;
    Ok(table)
}

fn of_dimension(spec: &SceneSpec, dimension: Dimension) -> crate::scene::GridSpec {
    crate::scene::GridSpec { dimension, ..spec.grid.clone() }
}

struct Runs<'a> {
    solver: &'a dyn Forward,
    table: &'a mut DimensionTable,
    on_progress: OnProgress<'a>,
}

impl Runs<'_> {
    fn row(
        &mut self,
        name: &'static str,
        reference: &PlateReference,
        scenes: &mut dyn Iterator<Item = Result<Scene, SceneError>>,
    ) -> Result<(), DimensionError> {
        let (mut voids, mut waveform, mut envelope, mut amplitude) = (vec![], vec![], vec![], vec![]);
        let (mut seconds, mut not_picked, mut cells, mut steps) = (vec![], 0, 0, 0);
        for scene in scenes {
            let scene = scene?;
            let clock = Instant::now();
            let trace = match simulate_echoes(self.solver, &scene, reference, self.on_progress) {
                Ok((trace, echoes)) => {
                    waveform.push(1e9 * echoes.plate.waveform.si());
                    envelope.push(1e9 * echoes.plate.envelope.si());
                    amplitude.push(echoes.plate.relative_amplitude);
                    Some(trace)
                }
                Err(EchoError::NotPicked { .. }) => {
                    not_picked += 1;
                    None
                }
                Err(error) => return Err(error.into()),
            };
            seconds.push(clock.elapsed().as_secs_f64());
            voids.extend(voids_percent(&scene));
            let placement = crate::raster::Placement::of(&scene.spec);
            cells = placement.grid.cells.iter().product();
            if let Some(trace) = trace {
                steps = trace.samples.len();
                self.table.traces.push(DimensionTrace { name, points: points(&trace, reference) });
            }
        }
        self.table.rows.push(DimensionRow {
            name,
            voids_percent: MeanAndSpread::of(&voids),
            plate_ns: MeanAndSpread::of(&waveform),
            plate_envelope_ns: MeanAndSpread::of(&envelope),
            amplitude: MeanAndSpread::of(&amplitude),
            not_picked,
            seconds: MeanAndSpread::of(&seconds).unwrap_or(MeanAndSpread {
                count: 0,
                mean: 0.0,
                standard_deviation: 0.0,
            }),
            cells,
            steps,
        });
        Ok(())
    }
}

/// Void share of what a scene shows, up to its nominal height over the whole width, %; none without stones.
pub fn voids_percent(scene: &Scene) -> Option<f64> {
    let height = scene.spec.tank.height;
    let section = scene.packing.as_ref().map(|discs| 1.0 - discs.solid_share_between(Metres(0.0), height).si());
    section.or_else(|| scene.spheres.as_ref().map(|bed| voids_of_bed(bed, height))).map(|voids| 100.0 * voids)
}

/// A trace without the direct wave, over the reference echo's largest extremum, from the emission.
fn points(trace: &AScan, reference: &PlateReference) -> Vec<(f64, f64)> {
    let (echoes, _) = crate::compare::subtract_reference(trace, &reference.free_space);
    let largest = reference.plate_echo.samples.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let zero = reference.waveform_zero().si();
    echoes.samples.iter().enumerate().map(|(k, v)| (1e9 * (echoes.time(k) - zero), v / largest)).collect()
}
