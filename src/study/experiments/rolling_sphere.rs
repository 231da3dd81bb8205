//! Ai et al. 2011, cases 1 and 2: a ball thrown onto a floor and up a slope, with several models of rolling resistance.

use serde::{Deserialize, Serialize};

use super::bench::{Bench, Running};
use super::closed_form::{Course, ThrownBall};
use super::error::ExperimentError;
use super::outcome::{Curve, Outcome, Reading};
use super::spec::{ExperimentSpec, RollingName, StoneSpec, above_zero};
use crate::geometry::Sphere;
use crate::packing::dem::{Grain, Rolling, Setup, Simulation, TimeStep, Wall, WallContact};
use crate::units::{Metres, MetresPerSecond, Seconds};

const NAME: &str = "rolling-sphere";

/// What the experiment is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RollingSphereSpec {
    /// Radius of the ball.
    pub radius: Metres,
    /// Its speed along the plane at the start.
    pub speed: MetresPerSecond,
    /// Gravity, m/s².
    pub gravity: f64,
    /// Time step.
    pub time_step: Seconds,
    /// How long it is watched.
    pub duration: Seconds,
    /// What ball and plane are made of; each case has its own rolling friction.
    pub stone: StoneSpec,
    /// The cases.
    pub cases: Vec<RollingCaseSpec>,
}

/// A plane, and what is tried on it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RollingCaseSpec {
    /// Name of the case.
    pub name: String,
    /// How steeply the plane rises, degrees.
    pub slope_degrees: f64,
    /// Coefficients of rolling friction.
    pub rolling_frictions: Vec<f64>,
    /// Models of rolling resistance.
    pub models: Vec<RollingName>,
}

impl ExperimentSpec for RollingSphereSpec {
    const TEMPLATE: &str = include_str!("../../../templates/experiments/rolling-sphere.toml");

    fn check(&self) -> Result<(), ExperimentError> {
        above_zero(
            NAME,
            &[
                ("radius", self.radius.si(), self.radius.to_string()),
                ("speed", self.speed.si(), self.speed.to_string()),
                ("gravity", self.gravity, self.gravity.to_string()),
                ("duration", self.duration.si(), self.duration.to_string()),
                ("time_step", self.time_step.si(), self.time_step.to_string()),
            ],
        )?;
        for case in &self.cases {
            if !(0.0..60.0).contains(&case.slope_degrees) {
                return Err(ExperimentError::OutOfRange {
                    experiment: NAME,
                    key: "cases.slope_degrees",
                    value: case.slope_degrees.to_string(),
                    limit: "from 0 to below 60".into(),
                });
            }
        }
        Ok(())
    }
}

impl RollingSphereSpec {
    /// The closed form of a case.
    pub fn ball(&self, slope_degrees: f64, rolling_friction: f64) -> ThrownBall {
        let sphere = Sphere { centre: [0.0; 3], radius: self.radius.si() };
        ThrownBall {
            mass: self.stone.density.si() * sphere.volume(),
            radius: self.radius.si(),
            speed: self.speed.si(),
            slope: slope_degrees.to_radians(),
            gravity: self.gravity,
            friction: self.stone.friction,
            rolling_friction,
        }
    }
}

/// One run: a case, a coefficient, a model.
#[derive(Debug, Clone, PartialEq)]
pub struct RollingRun {
    /// Name of the case.
    pub case: String,
    /// Coefficient of rolling friction.
    pub rolling_friction: f64,
    /// Model of rolling resistance.
    pub model: RollingName,
    /// Time s, displacement m, velocity m/s, angular velocity rad/s and rolling torque N m, after step 1 and then every 10.
    pub samples: Vec<[f64; 5]>,
    /// First time at which the speed is below 1 mm/s, s.
    pub stops_at: f64,
    /// Largest displacement, m.
    pub reach: f64,
    /// Largest and smallest size of the torque from 1.2 times the time at which it rolls to 0.9 times that at which it
    /// stops, N m.
    pub torque: [f64; 2],
    /// Over the last fifth of the time: mean size of the torque, N m.
    pub torque_at_rest: f64,
    /// Over the last fifth: largest angular velocity, rad/s.
    pub spin_at_rest: f64,
    /// How often the torque changes its sign while above 1e-5 of that of rolling: over the last fifth from sample to sample, or
    /// over the last 200 steps from step to step, whichever is more.
    pub sign_changes: usize,
    /// The closed form.
    pub exact: Course,
}

/// Runs all cases.
///
/// # Errors
/// When the simulation cannot be made or goes bad, or on request.
pub fn run_cases(spec: &RollingSphereSpec, running: &Running<'_>) -> Result<Vec<RollingRun>, ExperimentError> {
    let mut runs = Vec::new();
    for case in &spec.cases {
        for &rolling_friction in &case.rolling_frictions {
            for &model in &case.models {
                runs.push(run_case(spec, case, rolling_friction, model, running)?);
            }
        }
    }
    Ok(runs)
}

/// The ball where its weight and the floor are in balance: `(3/4 m g cos b/(E* sqrt R))^(2/3)` deep, with `1/E*` twice
/// `(1 - nu²)/E`.
fn setup(spec: &RollingSphereSpec, slope: f64, rolling_friction: f64, model: RollingName) -> Setup {
    let (radius, g) = (spec.radius.si(), spec.gravity);
    let stuff = StoneSpec { rolling_friction, ..spec.stone }.stuff();
    let ball = spec.ball(slope.to_degrees(), rolling_friction);
    let effective = stuff.young / (2.0 * (1.0 - stuff.poisson * stuff.poisson));
    let depth = (0.75 * ball.mass * g * slope.cos() / (effective * radius.sqrt())).powf(2.0 / 3.0);
    let sphere = Sphere { centre: [0.0, 0.0, radius - depth], radius };
    let thrown = Grain { velocity: [spec.speed.si(), 0.0, 0.0], ..Grain::at_rest(sphere) };
    let mut setup = Setup::new(stuff, vec![thrown]);
    setup.gravity = [-g * slope.sin(), 0.0, -g * slope.cos()];
    setup.time_step = TimeStep::Seconds(spec.time_step.si());
    setup.rolling = model.model();
    setup.walls = vec![Wall::plane([0.0; 3], [0.0, 0.0, 1.0], 0)];
    setup
}

fn run_case(
    spec: &RollingSphereSpec,
    case: &RollingCaseSpec,
    rolling_friction: f64,
    model: RollingName,
    running: &Running<'_>,
) -> Result<RollingRun, ExperimentError> {
    let slope = case.slope_degrees.to_radians();
    // Seconds of work: nothing of it is kept when it is stopped.
    let unkept = Running { keep_in: None, ..running.clone() };
    let mut bench = Bench::open(NAME, spec, &unkept, || Ok(setup(spec, slope, rolling_friction, model)))?;
    bench.simulation.keep_rolling_torque(true);
    let steps = bench.count_of(spec.duration.si());
    let (mut samples, mut done) = (Vec::new(), 0);
    while done < steps {
        let share = done as f64 / steps as f64;
        if done > 0 {
            bench.steps("rolling", 9, share)?;
            done += 9;
        }
        let before = bench.simulation.grain(0);
        bench.steps("rolling", 1, share)?;
        done += 1;
        samples.extend(before.and_then(|before| sample(&bench.simulation, &before)));
    }
    let mut chatter = Vec::new();
    for _ in 0..200 {
        let before = bench.simulation.grain(0);
        bench.steps("resting", 1, 1.0)?;
        chatter.extend(before.and_then(|before| sample(&bench.simulation, &before)));
    }
    let exact = spec.ball(case.slope_degrees, rolling_friction).course();
    Ok(read_off(case, rolling_friction, model, samples, &chatter, exact))
}

/// What is read off after a step; `before` is the ball before it.
fn sample(simulation: &Simulation, before: &Grain) -> Option<[f64; 5]> {
    let ball = simulation.grain(0)?;
    // The bounded model tells its torque; of the others it is what changed the spin beside the moment of the contact.
    let of_model = matches!(simulation.rolling(), Rolling::Bounded).then(|| simulation.rolling_torque(0)).flatten();
    let torque = of_model.map_or_else(
        || {
            let mass = simulation.stuffs()[0].density * ball.sphere.volume();
            let inertia = 0.4 * mass * ball.sphere.radius.powi(2);
            let change = inertia * (ball.spin[1] - before.spin[1]) / simulation.step_length().seconds;
            let contact = |c: &WallContact| -(ball.sphere.radius - c.overlap.si()) * c.force[0];
            change - simulation.wall_contacts().iter().map(contact).sum::<f64>()
        },
        |torque| torque[1],
    );
    Some([simulation.time().si(), ball.sphere.centre[0], ball.velocity[0], ball.spin[1], torque])
}

fn read_off(
    case: &RollingCaseSpec,
    rolling_friction: f64,
    model: RollingName,
    samples: Vec<[f64; 5]>,
    chatter: &[[f64; 5]],
    exact: Course,
) -> RollingRun {
    let stops_at = samples.iter().find(|s| s[2].abs() < 1e-3).map_or(f64::NAN, |s| s[0]);
    let rolling = samples.iter().filter(|s| (1.2 * exact.rolls_at..0.9 * exact.stops_at).contains(&s[0]));
    let torque = rolling.fold([0.0, f64::INFINITY], |[most, least], s| [s[4].abs().max(most), s[4].abs().min(least)]);
    let rest = &samples[samples.len() - samples.len() / 5..];
    let changes = |of: &[[f64; 5]]| {
        let torques: Vec<f64> = of.iter().map(|s| s[4]).filter(|torque| torque.abs() > 1e-5 * exact.torque).collect();
        torques.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count()
    };
    RollingRun {
        case: case.name.clone(),
        rolling_friction,
        model,
        stops_at,
        reach: samples.iter().map(|s| s[1]).fold(0.0, f64::max),
        torque,
        torque_at_rest: rest.iter().map(|s| s[4].abs()).sum::<f64>() / rest.len().max(1) as f64,
        spin_at_rest: rest.iter().map(|s| s[3].abs()).fold(0.0, f64::max),
        sign_changes: changes(rest).max(changes(chatter)),
        exact,
        samples,
    }
}

/// Runs the experiment.
///
/// # Errors
/// As [`run_cases`].
pub fn run(spec: &RollingSphereSpec, running: &Running<'_>) -> Result<Outcome, ExperimentError> {
    let runs = run_cases(spec, running)?;
    let mut curve = Curve::new(&["time_s"]);
    let longest = runs.iter().map(|run| run.samples.len()).max().unwrap_or(0);
    curve.rows = vec![vec![]; longest];
    let mut readings = Vec::new();
    for (index, run) in runs.iter().enumerate() {
        let label = format!("{}-eta{}-{}", run.case, run.rolling_friction, run.model.name());
        for what in ["displacement_m", "velocity_m_per_s", "spin_rad_per_s", "torque_n_m"] {
            curve.columns.push(format!("{label}_{what}"));
        }
        for (row, sample) in curve.rows.iter_mut().zip(&run.samples) {
            row.extend(&sample[usize::from(index > 0)..]);
        }
        let mut tell = |key: &str, quantity: &str, value, decimals| {
            readings.push(Reading::new(&format!("{label}_{key}"), &format!("{label}: {quantity}"), value, decimals));
        };
        tell("stop_s", "time to stop, s", run.stops_at, 4);
        tell("stop_exact_s", "the same, closed form, s", run.exact.stops_at, 4);
        tell("reach_m", "reach, m", run.reach, 5);
        tell("reach_exact_m", "the same, closed form, m", run.exact.reach, 5);
        tell("torque_n_m", "largest torque while rolling, N m", run.torque[0], 5);
        tell("torque_exact_n_m", "the same, closed form, N m", run.exact.torque, 5);
        tell("torque_rest_n_m", "mean torque in the last fifth, N m", run.torque_at_rest, 5);
        tell("spin_rest_rad_per_s", "largest spin in the last fifth, rad/s", run.spin_at_rest, 6);
        tell("sign_changes", "changes of sign of the torque at rest", run.sign_changes as f64, 0);
    }
    let mut notes = vec!["samples: after the first step, then every ten".to_owned()];
    if runs.iter().any(|run| run.model == RollingName::A && run.sign_changes > 0) {
        notes.push(
            "model A at rest turns its torque round from step to step; every tenth may show but one side of it".into(),
        );
    }
    Ok(Outcome { experiment: NAME.into(), readings, curve, notes, stones: vec![] })
}
