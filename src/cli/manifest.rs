//! The manifest of an output folder: what it was made from, and what it came to.

use std::path::Path;

use crate::cli::cells::Cells;
use crate::cli::error::CliError;
use crate::cli::folder;
use crate::files;
use crate::model::{Effects, Model, Order};
use crate::packing::SphereBed;
use crate::packing::settle::{Settled, Stage};
use crate::scene::{Arrivals, BulkPermittivity, FoulingReport, Layer, Scene, SceneSpec};
use crate::study;

/// Wall times of a build, s. The only figures of a folder that differ between two builds of the same scene.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Seconds {
    /// Sizing, positioning and compaction.
    pub packing: f64,
    /// From discs to cells and edges.
    pub raster: f64,
    /// Writing files and figures.
    pub writing: f64,
}

/// What the packing came to.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct PackingFigures {
    /// Number of stones.
    pub stones: usize,
    /// Height of the highest stone's top, m.
    pub height_m: f64,
    /// Solid share of the rectangle or box up to that height, %.
    pub solid_percent: f64,
    /// Solid share in the interior, away from floor and rough surface, %.
    pub interior_solid_percent: f64,
}

impl PackingFigures {
    fn of(scene: &Scene) -> Option<Self> {
        scene.packing.as_ref().map(|packing| Self {
            stones: packing.count(),
            height_m: packing.top().si(),
            solid_percent: 100.0 * packing.solid_share().si(),
            interior_solid_percent: 100.0 * packing.interior_solid_share().si(),
        })
    }

    fn of_spheres(bed: &SphereBed) -> Self {
        Self {
            stones: bed.count(),
            height_m: bed.top().si(),
            solid_percent: 100.0 * bed.solid_share().si(),
            interior_solid_percent: 100.0 * bed.interior_solid_share().si(),
        }
    }
}

/// Time window in which an echo is to be looked for, s, from the start of the trace.
pub type Window = [f64; 2];

/// Where the echoes of a scene are to be looked for.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ExpectedWindows {
    /// Peak of the emitted pulse, s.
    pub pulse_delay: f64,
    /// Echo of the bed's surface.
    pub surface: Window,
    /// Echo of the metal plate.
    pub plate: Option<Window>,
}

impl ExpectedWindows {
    /// The windows of [`Scene::echo_windows`], counted from the start of a trace: a formula's pulse peaks at `sqrt(2) / f`, one
    /// given as samples where its envelope does.
    pub fn of(scene: &Scene) -> Self {
        let formula = std::f64::consts::SQRT_2 / scene.spec.antenna.frequency.si();
        let pulse_delay = scene.pulse.as_ref().and_then(study::pulse_peak).map_or(formula, |peak| peak.si());
        let [surface, plate] = scene.echo_windows().map(|window| window.map(|travel| pulse_delay + travel.si()));
        Self { pulse_delay, surface, plate: scene.spec.tank.metal_plate.then_some(plate) }
    }
}

/// What an output folder holds.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Manifest {
    /// Version of this file's format.
    pub format_version: u32,
    /// Program, version and commit.
    pub program: String,
    /// Seed of everything random.
    pub seed: u64,
    /// The resolved scene, as in `scene.toml`.
    pub scene: SceneSpec,
    /// What the discs came to; absent for a homogeneous bed and in space.
    pub packing: Option<PackingFigures>,
    /// What the bed of spheres came to, where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spheres: Option<PackingFigures>,
    /// The fouling in every measure; absent for clean ballast.
    pub fouling: Option<FoulingReport>,
    /// Bulk permittivities, as a mixture and as a 2-D section behaves.
    pub bulk_permittivity: Vec<BulkPermittivity>,
    /// The layers that the arrivals are for.
    pub layers: Vec<Layer>,
    /// When a plane wave's echoes would arrive, from the emission.
    pub arrivals: Arrivals,
    /// Where the echoes are to be looked for in a trace.
    pub expected: ExpectedWindows,
    /// Cells along x, y, z.
    pub cells: [usize; 3],
    /// Time step, s.
    pub time_step: f64,
    /// Samples per trace.
    pub iterations: usize,
    /// Order of the differences in space.
    pub order: Order,
    /// What will be simulated, and why.
    pub effects: Effects,
    /// Wall times.
    pub seconds: Seconds,
}

impl Manifest {
    /// Collects the figures of a built scene.
    pub fn of(scene: &Scene, model: &Model, cells: &Cells, seconds: Seconds) -> Self {
        Self {
            format_version: 1,
            program: folder::program(),
            seed: scene.spec.seed,
            scene: scene.spec.clone(),
            packing: PackingFigures::of(scene),
            spheres: scene.spheres.as_ref().map(PackingFigures::of_spheres),
            fouling: scene.fouling.clone(),
            bulk_permittivity: scene.bulk.clone(),
            layers: scene.layers.clone(),
            arrivals: scene.arrivals.clone(),
            expected: ExpectedWindows::of(scene),
            cells: model.grid.cells,
            time_step: model.time_step(),
            iterations: model.iterations(),
            order: model.order,
            effects: cells.effects(model),
            seconds,
        }
    }

    /// One line for people.
    pub fn summary(&self) -> String {
        let stones = self.packing.as_ref().or(self.spheres.as_ref()).map_or("homogeneous bed".to_string(), |packing| {
            format!(
                "{} stones, {:.1} cm, {:.1} % solid",
                packing.stones,
                100.0 * packing.height_m,
                packing.solid_percent
            )
        });
        let fouling =
            self.fouling.as_ref().map_or("clean".to_string(), |f| format!("fouled to {}", f.height.in_unit("cm")));
        let [nx, ny, nz] = self.cells;
        let deep = if nz > 1 { format!(" x {nz}") } else { String::new() };
        format!("{stones}, {fouling}, {nx} x {ny}{deep} cells")
    }

    /// Writes the manifest.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), CliError> {
        let mut text = serde_json::to_string_pretty(self)?;
        text.push('\n');
        Ok(files::write_bytes(path, text.as_bytes())?)
    }
}

/// Wall times of a packing, s: what differs between two calls with the same scene.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct PackSeconds {
    /// Until the stones lie where they do.
    pub packing: f64,
    /// Writing files and figures.
    pub writing: f64,
}

/// What a folder with a packing alone holds.
#[derive(Debug, Clone, serde::Serialize)]
pub struct PackManifest {
    /// Version of this file's format.
    pub format_version: u32,
    /// Program, version and commit.
    pub program: String,
    /// Seed of everything random.
    pub seed: u64,
    /// The resolved scene, as in `scene.toml`.
    pub scene: SceneSpec,
    /// What the discs came to; absent in space.
    pub packing: Option<PackingFigures>,
    /// What the bed of spheres came to, where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spheres: Option<PackingFigures>,
    /// How the bed settled, where it did.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub settled: Option<SettledFigures>,
    /// Wall times.
    pub seconds: PackSeconds,
}

/// How a bed settled.
#[derive(Debug, Clone, serde::Serialize)]
pub struct SettledFigures {
    /// Time step, s.
    pub time_step_s: f64,
    /// Steps and state at the end of each stage, without wall times.
    pub stages: Vec<serde_json::Value>,
    /// Stones that were struck off above the bed's height.
    pub struck_off: usize,
    /// Stones that left the box.
    pub lost: usize,
}

impl SettledFigures {
    fn of(settled: &Settled) -> Self {
        let stage = |stage: &Stage| {
            serde_json::json!({
                "name": stage.name,
                "stones": stage.stones,
                "steps": stage.steps,
                "simulated_seconds": stage.simulated_seconds,
                "energy_ratio": stage.energy_ratio,
                "unbalanced_ratio": stage.unbalanced_ratio,
                "at_rest": stage.at_rest,
            })
        };
        Self {
            time_step_s: settled.time_step.si(),
            stages: settled.stages.iter().map(stage).collect(),
            struck_off: settled.struck_off,
            lost: settled.lost,
        }
    }
}

impl PackManifest {
    /// Collects the figures of a packed scene.
    pub fn of(scene: &Scene, settled: Option<&Settled>, seconds: PackSeconds) -> Self {
        Self {
            format_version: 1,
            program: folder::program(),
            seed: scene.spec.seed,
            scene: scene.spec.clone(),
            packing: PackingFigures::of(scene),
            spheres: scene.spheres.as_ref().map(PackingFigures::of_spheres),
            settled: settled.map(SettledFigures::of),
            seconds,
        }
    }

    /// Writes the manifest.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), CliError> {
        let text = serde_json::to_string_pretty(self)? + "\n";
        Ok(files::write_bytes(path, text.as_bytes())?)
    }
}

/// Reads the echo windows out of a folder's manifest.
///
/// # Errors
/// When there is no manifest or it holds none.
pub fn expected_windows(folder: &Path) -> Result<ExpectedWindows, CliError> {
    #[derive(serde::Deserialize)]
    struct Part {
        expected: ExpectedWindows,
    }
    let path = folder.join(folder::MANIFEST);
    let text = files::read_text(&path)?;
    let part: Part = serde_json::from_str(&text)
        .map_err(|error| CliError::input(format!("the manifest `{}` cannot be read: {error}", path.display())))?;
    Ok(part.expected)
}
