//! What accuracy costs in time: the error of a trace beside wall time and memory, over cell size, smoothing and precision.

use std::time::Instant;

use crate::compare;
use crate::forward::{Forward, ForwardError, OnProgress};
use crate::model::{Model, Order};
use crate::raster;
use crate::scene::{Scene, SceneError, SceneSpec, Smoothing, resolve};
use crate::trace::{AScan, Component};
use crate::units::{Metres, Seconds, Share};

use super::echoes::EchoError;

/// One setting of the knobs that a user can turn.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct CostSetting {
    /// Cell size.
    pub cell: Metres,
    /// What happens where two materials meet.
    pub smoothing: Smoothing,
    /// Order of the differences in space.
    #[serde(default)]
    pub order: Order,
    /// Whether the fields are in double precision.
    pub double_precision: bool,
}

/// What a setting gives and costs.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct CostPoint {
    /// The setting.
    pub setting: CostSetting,
    /// Relative L2 error of the echoes (direct wave taken off), against the extrapolated trace.
    pub error: f64,
    /// Wall time of the run, s.
    pub seconds: f64,
    /// Memory of fields and coefficients, bytes.
    pub bytes: u64,
    /// Cells times steps.
    pub cell_steps: u64,
}

/// A scene whose trace is judged.
pub trait CostSubject {
    /// The scene with a setting.
    ///
    /// # Errors
    /// When it cannot be built.
    fn model(&self, setting: CostSetting) -> Result<Model, CostError>;
    /// Centre frequency, Hz.
    fn frequency(&self) -> f64;
    /// Time window, s.
    fn window(&self) -> f64;
    /// The component that is judged, at the first receiver.
    fn component(&self) -> Component;
    /// What can happen where two materials meet. The reference is the limit of the second-order runs with the first.
    fn smoothings(&self) -> &'static [Smoothing];
    /// Orders of differences, each with the finest cells that it is run on, m; the second order on all.
    fn orders(&self) -> &'static [(Order, f64)];
    /// Duration of a step of order 4, in steps of order 2.
    fn step_of_order_four(&self) -> f64;
}

/// The tank, narrower, with 20 cm of fouling, in two dimensions.
#[derive(Debug, Clone)]
pub struct CostScene {
    spec: SceneSpec,
}

/// All points, and how the reference came about.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct CostTable {
    /// Version of the format.
    pub format_version: u32,
    /// Centre frequency that the cell sizes are for, Hz.
    pub frequency: f64,
    /// Order of convergence measured on the three finest area-smoothed runs; the reference is extrapolated with it.
    pub measured_order: f64,
    /// Relative L2 difference of the two finest area-smoothed runs: the scale of the reference's own uncertainty.
    pub finest_difference: f64,
    /// Order of convergence of the runs of order 4 from the true shapes.
    #[serde(default)]
    pub order_of_shapes: f64,
    /// Relative L2 difference between their limit and the reference: an upper bound of the reference's own error.
    #[serde(default)]
    pub limits_differ: f64,
    /// Duration of a step of order 4, in steps of order 2.
    #[serde(default = "step_of_order_four")]
    pub step_of_order_four: f64,
    /// The points.
    pub points: Vec<CostPoint>,
}

impl CostScene {
    /// The tank at 64 cm width, antenna and walls on nodes of every cell size that divides 8 mm.
    ///
    /// The narrower tank keeps stones, layers and plate; it saves half the time.
    pub fn standard() -> Result<Self, SceneError> {
        let mut spec = SceneSpec::preset("tank")?;
        spec.title = "cost curve".into();
        spec.tank.width = Metres(0.64);
        spec.antenna.separation = Metres(0.032);
        spec.grid.time_window = Seconds(15e-9);
        spec.fouling = Some(crate::scene::FoulingSpec::of("20cm".parse()?));
        Ok(Self { spec })
    }

    /// The scene with a setting.
    ///
    /// # Errors
    /// When it cannot be resolved.
    pub fn with(&self, setting: CostSetting) -> Result<Scene, SceneError> {
        let mut spec = self.spec.clone();
        (spec.grid.cell, spec.grid.smoothing, spec.grid.order) = (setting.cell, setting.smoothing, setting.order);
        spec.grid.absorbing_cells = absorbing_cells(setting.cell);
        resolve(&spec)
    }
}

impl CostSubject for CostScene {
    fn model(&self, setting: CostSetting) -> Result<Model, CostError> {
        Ok(raster::build_model(&self.with(setting)?).map_err(EchoError::from)?)
    }

    fn frequency(&self) -> f64 {
        self.spec.antenna.frequency.si()
    }

    fn window(&self) -> f64 {
        self.spec.grid.time_window.si()
    }

    fn component(&self) -> Component {
        Component::Ez
    }

    fn smoothings(&self) -> &'static [Smoothing] {
        &[Smoothing::Area, Smoothing::None, Smoothing::Edges, Smoothing::Shapes]
    }

    fn orders(&self) -> &'static [(Order, f64)] {
        &[(Order::Second, 0.0), (Order::Fourth, 0.0)]
    }

    /// 2.3 to 2.6 were measured.
    fn step_of_order_four(&self) -> f64 {
        2.4
    }
}

/// Absorbing cells that keep the boundary's part in the error below that of the cells: ten, and as many as 40 mm take.
///
/// Ten cells get thinner with the cells, and then echo more of what grazes them: beside the tank of [`CostScene::standard`],
/// against a boundary far away, 0.13, 0.26 and 0.39 % of the echoes with cells of 4, 2 and 1 mm and differences of second
/// order, 0.19, 0.38 and 0.54 % with those of fourth. With 40 mm it is 0.02 % at 2 mm and less than 0.001 % at 1 mm.
pub fn absorbing_cells(cell: Metres) -> usize {
    ((ABSORBING_DEPTH / cell.si()).round() as usize).max(10)
}

/// What a solver of one precision is, and what it says of its memory.
pub struct CostSolver<'a> {
    /// The solver.
    pub solver: &'a dyn Forward,
    /// Whether it computes in double precision.
    pub double_precision: bool,
    /// Finer cells than this are left out.
    pub finest: Metres,
    /// Memory for a model, bytes.
    pub bytes: &'a dyn Fn(&Model) -> Result<u64, ForwardError>,
}

/// Why there is no cost curve.
#[derive(Debug, thiserror::Error)]
pub enum CostError {
    /// No scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// No trace.
    #[error(transparent)]
    Echo(#[from] EchoError),
    /// Fewer than three cell sizes.
    #[error("{cells} cell sizes cannot be extrapolated: at least 3 are needed, each half the one before")]
    TooFewCells {
        /// How many there are.
        cells: usize,
    },
}

/// Least depth of the absorbing cells, m.
const ABSORBING_DEPTH: f64 = 0.04;

/// Step of the common time axis on which traces are compared, s: a fiftieth of the shortest period that matters (3 GHz).
const COMMON_STEP: f64 = 5e-12;

/// Measures the curve over `cells` (each half the one before, coarsest first), every smoothing, all orders of differences
/// and every solver.
///
/// The reference is the limit of the runs of order 2 with the subject's first smoothing in the most precise solver that takes
/// all cells, by Richardson extrapolation of the traces with the order measured on the three finest cells; the limit of those
/// of order 4 (of order 2 where there are too few) from the true shapes, found in the same way, tells how far it can be trusted.
///
/// # Errors
/// See [`CostError`].
pub fn cost_curve(
    subject: &dyn CostSubject,
    cells: &[Metres],
    solvers: &[CostSolver<'_>],
    on_point: &dyn Fn(usize, usize),
    on_progress: OnProgress<'_>,
) -> Result<CostTable, CostError> {
    let Some(finest) = cells.last().filter(|_| cells.len() >= 3) else {
        return Err(CostError::TooFewCells { cells: cells.len() });
    };
    let (smoothings, orders) = (subject.smoothings(), subject.orders());
    let takes = |solver: &CostSolver<'_>, cell: &Metres| cell.si() >= solver.finest.si() * (1.0 - 1e-9);
    let settings = |solver: &CostSolver<'_>| -> Vec<(Metres, Order)> {
        let each =
            cells.iter().filter(|cell| takes(solver, cell)).flat_map(|&cell| orders.iter().map(move |o| (cell, o)));
        let fine_enough = |(cell, (_, least)): &(Metres, &(Order, f64))| cell.si() >= least * (1.0 - 1e-9);
        each.filter(fine_enough).map(|(cell, (order, _))| (cell, *order)).collect()
    };
    // Tensors are of second order only.
    let with = |order: Order| smoothings.iter().filter(move |s| **s != Smoothing::Tensors || order == Order::Second);
    let count = |solver| settings(solver).iter().map(|(_, order)| with(*order).count()).sum::<usize>();
    let total = solvers.iter().map(count).sum();
    let mut runs: Vec<(CostPoint, AScan)> = Vec::new();
    for solver in solvers {
        for (cell, order) in settings(solver) {
            let mut alone = None;
            for &smoothing in with(order) {
                let setting = CostSetting { cell, smoothing, order, double_precision: solver.double_precision };
                runs.push(one_run(subject, setting, solver, &mut alone, on_progress)?);
                on_point(runs.len(), total);
            }
        }
    }
    let most_precise = solvers.iter().any(|solver| solver.double_precision && takes(solver, finest));
    let limit_of = |smoothing: Smoothing, order: Order| {
        let of = |p: &CostSetting| p.smoothing == smoothing && p.order == order && p.double_precision == most_precise;
        let traces: Vec<&AScan> = runs.iter().filter(|(p, _)| of(&p.setting)).map(|(_, trace)| trace).collect();
        limit(&traces).ok_or(CostError::TooFewCells { cells: traces.len() })
    };
    let (limit, measured_order, last) = limit_of(smoothings[0], Order::Second)?;
    let (other, order_of_shapes, _) =
        limit_of(Smoothing::Shapes, Order::Fourth).or_else(|_| limit_of(Smoothing::Shapes, Order::Second))?;
    let size = norm(&limit.samples);
    let finest_difference = last / size;
    let limits_differ = distance(&limit, &other) / size;
    let points = runs
        .iter()
        .map(|(point, trace)| CostPoint { error: distance(trace, &limit) / size, ..point.clone() })
        .collect();
    Ok(CostTable {
        format_version: 1,
        frequency: subject.frequency(),
        measured_order,
        finest_difference,
        order_of_shapes,
        limits_differ,
        step_of_order_four: subject.step_of_order_four(),
        points,
    })
}

/// The errors of some settings alone, against the limit of the second-order runs with the subject's first smoothing on
/// `cells` (three or more, each half the one before), as [`cost_curve`] finds it.
///
/// # Errors
/// See [`CostError`].
pub fn cost_of(
    subject: &dyn CostSubject,
    cells: &[Metres],
    settings: &[CostSetting],
    solver: &CostSolver<'_>,
    on_progress: OnProgress<'_>,
) -> Result<Vec<CostPoint>, CostError> {
    let run = |setting| one_run(subject, setting, solver, &mut None, on_progress);
    let of_cell = |&cell| {
        let smoothing = subject.smoothings()[0];
        run(CostSetting { cell, smoothing, order: Order::Second, double_precision: solver.double_precision })
    };
    let reference: Vec<AScan> = cells.iter().map(|cell| Ok(of_cell(cell)?.1)).collect::<Result<_, CostError>>()?;
    let too_few = CostError::TooFewCells { cells: cells.len() };
    let (limit, _, _) = limit(&reference.iter().collect::<Vec<_>>()).ok_or(too_few)?;
    let size = norm(&limit.samples);
    let of_setting = |&setting| {
        let (point, trace) = run(setting)?;
        Ok(CostPoint { error: distance(&trace, &limit) / size, ..point })
    };
    settings.iter().map(of_setting).collect()
}

/// The limit of traces on cells that halve, with the order measured on the three finest and the difference of the last two.
fn limit(traces: &[&AScan]) -> Option<(AScan, f64, f64)> {
    let [.., coarse, middle, fine] = traces else { return None };
    let (first, last) = (distance(coarse, middle), distance(middle, fine));
    let order = (first / last).log2().clamp(0.5, 4.0);
    let weight = 1.0 / (2f64.powf(order) - 1.0);
    let samples =
        fine.samples.iter().zip(&middle.samples).map(|(fine, middle)| fine + weight * (fine - middle)).collect();
    Some((AScan { samples, ..(*fine).clone() }, order, last))
}

/// Runs a setting, and once per cell size, order and time step the antenna alone; the difference holds the echoes alone.
fn one_run(
    subject: &dyn CostSubject,
    setting: CostSetting,
    solver: &CostSolver<'_>,
    alone: &mut Option<AScan>,
    on_progress: OnProgress<'_>,
) -> Result<(CostPoint, AScan), CostError> {
    let model = subject.model(setting)?;
    let started = Instant::now();
    let trace = radar_trace(solver.solver, &model, subject.component(), on_progress)?;
    let seconds = started.elapsed().as_secs_f64();
    // Tensors take shorter steps than the other smoothings.
    let direct = match alone.take().filter(|direct| direct.time_step == trace.time_step) {
        Some(direct) => direct,
        None => radar_trace(solver.solver, &raster::antenna_alone(&model), subject.component(), on_progress)?,
    };
    let (echoes, _) = compare::subtract_reference(&trace, &direct);
    *alone = Some(direct);
    let window = subject.window();
    let trace = compare::resample(&echoes, Seconds(0.0), Seconds(COMMON_STEP), (window / COMMON_STEP) as usize);
    let cell_steps = (model.grid.cell_count() * model.iterations()) as u64;
    let point = CostPoint { setting, error: f64::NAN, seconds, bytes: (solver.bytes)(&model)?, cell_steps };
    Ok((point, trace))
}

fn radar_trace(
    solver: &dyn Forward,
    model: &Model,
    component: Component,
    on_progress: OnProgress<'_>,
) -> Result<AScan, EchoError> {
    let traces = solver.solve(model, on_progress).map_err(EchoError::from)?;
    let first = traces.receivers.first().and_then(|receiver| receiver.component(component));
    first.cloned().ok_or(EchoError::NoTrace)
}

fn norm(samples: &[f64]) -> f64 {
    samples.iter().map(|v| v * v).sum::<f64>().sqrt()
}

fn distance(a: &AScan, b: &AScan) -> f64 {
    a.samples.iter().zip(&b.samples).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// For tables of an earlier version.
fn step_of_order_four() -> f64 {
    2.4
}

impl CostTable {
    /// The setting of least work (single precision) whose error is at most `tolerance` at `frequency`.
    ///
    /// The error is taken to depend on cells per wavelength, so that a cell size scales with the wavelength; an error
    /// counts only if every finer cell of the same smoothing keeps it too.
    pub fn cheapest(&self, tolerance: Share) -> Option<&CostPoint> {
        let holds = |point: &CostPoint| {
            self.points
                .iter()
                .filter(|other| {
                    other.setting.smoothing == point.setting.smoothing
                        && other.setting.order == point.setting.order
                        && other.setting.double_precision == point.setting.double_precision
                        && other.setting.cell.si() <= point.setting.cell.si()
                })
                .all(|other| other.error <= tolerance.si())
        };
        // Cell-steps in those of order 2.
        let work = |point: &CostPoint| {
            let fourth = point.setting.order == Order::Fourth;
            point.cell_steps as f64 * if fourth { self.step_of_order_four } else { 1.0 }
        };
        self.points
            .iter()
            .filter(|point| !point.setting.double_precision && holds(point))
            .min_by(|a, b| work(a).total_cmp(&work(b)).then(a.error.total_cmp(&b.error)))
    }

    /// The smallest error that any setting reaches.
    pub fn best(&self) -> Option<&CostPoint> {
        self.points.iter().min_by(|a, b| a.error.total_cmp(&b.error))
    }
}

/// `ForwardError` reaches [`CostError`] through [`EchoError`], so that a stop stays a stop.
impl From<ForwardError> for CostError {
    fn from(error: ForwardError) -> Self {
        Self::Echo(EchoError::Forward(error))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(cell: f64, smoothing: Smoothing, error: f64) -> CostPoint {
        let setting = CostSetting { cell: Metres(cell), smoothing, order: Order::Second, double_precision: false };
        CostPoint { setting, error, seconds: 1.0, bytes: 1, cell_steps: (1.0 / cell.powi(3)) as u64 }
    }

    #[test]
    fn the_cheapest_setting_keeps_the_tolerance_also_when_refined() {
        let table = CostTable {
            format_version: 1,
            frequency: 1e9,
            measured_order: 2.0,
            finest_difference: 1e-3,
            order_of_shapes: 2.0,
            limits_differ: 0.0,
            step_of_order_four: 2.4,
            points: vec![
                point(0.008, Smoothing::Edges, 0.015), // by luck: the next finer one is worse
                point(0.004, Smoothing::Edges, 0.05),
                point(0.002, Smoothing::Edges, 0.01),
                point(0.004, Smoothing::Area, 0.018),
                point(0.002, Smoothing::Area, 0.004),
            ],
        };
        let chosen = table.cheapest(Share(0.02)).unwrap().setting;
        assert_eq!((chosen.cell, chosen.smoothing), (Metres(0.004), Smoothing::Area));
        assert!(table.cheapest(Share(0.001)).is_none());
    }
}
