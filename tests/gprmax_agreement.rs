//! The built-in solver against gprMax: its stored outputs, and gprMax run here.
//!
//! Tolerances, relative L2 over the whole trace. Double precision, 1e-10: rounding (1e-16) over a few thousand steps of
//! sums of five terms gives 1e-14 to 1e-13; any difference of rule, even of one edge, is far above. Single precision, 2e-5:
//! gprMax's own single precision differs from its double by 1e-6 to 4e-6 of the peak in two dimensions, and late echoes
//! are small beside the peak.

mod common;

use std::fs;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::PathBuf;

use ballast_gpr::compare::relative_l2;
use ballast_gpr::fdtd::{Fdtd, Precision};
use ballast_gpr::forward::Forward as _;
use ballast_gpr::gprmax::{GprMax, read_model, read_traces};
use ballast_gpr::model::Model;
use ballast_gpr::raster::build_model;
use ballast_gpr::scene::{FoulingSpec, GeometryKind, MoistureSpec, SceneSpec, Smoothing, resolve};
use ballast_gpr::trace::{Component, Traces};
use ballast_gpr::units::{Metres, Seconds, Share};
use common::{gprmax, reference_case};

const SINGLE: f64 = 2e-5;
const DOUBLE: f64 = 1e-10;

/// One thread: the traces have the same bits for any number, and a busy machine is kinder to one.
fn ours(model: &Model, precision: Precision) -> Traces {
    let fdtd = Fdtd { precision, threads: NonZeroUsize::new(1), ..Fdtd::default() };
    fdtd.solve(model, &|_| ControlFlow::Continue(())).unwrap()
}

fn norm(samples: &[f64]) -> f64 {
    samples.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// Largest relative L2 difference over the receivers: of Ez, and of H.
///
/// Hx and Hy are each set against both together: beside the source, on an axis through it, one of them is nothing but
/// rounding of the other. The components that a grid along z cannot hold must be zero in both.
fn differences(theirs: &Traces, ours: &Traces) -> [f64; 2] {
    assert_eq!((theirs.receivers.len(), theirs.iterations), (ours.receivers.len(), ours.iterations));
    assert!(!theirs.receivers.is_empty());
    assert_eq!(theirs.cells, ours.cells);
    // The last bit of the step depends on the order of a sum where cells are not square.
    assert!((ours.time_step.si() / theirs.time_step.si() - 1.0).abs() < 1e-15);
    let mut worst: [f64; 2] = [0.0; 2];
    let mut seen = false;
    for (a, b) in theirs.receivers.iter().zip(&ours.receivers) {
        let both = |component| (a.component(component).unwrap(), b.component(component).unwrap());
        let (ez, our_ez) = both(Component::Ez);
        if ez.peak() == 0.0 {
            // A receiver inside metal.
            assert!(a.components.iter().chain(&b.components).all(|trace| trace.peak() == 0.0), "`{}`", a.name);
            continue;
        }
        seen = true;
        worst[0] = worst[0].max(relative_l2(ez, our_ez).unwrap());
        let magnetic = [Component::Hx, Component::Hy].map(both);
        let size = magnetic.map(|(h, _)| norm(&h.samples)).into_iter().fold(0.0, f64::hypot);
        for (h, our_h) in magnetic {
            assert!((h.first_sample.si() - our_h.first_sample.si()).abs() < 1e-20);
            let difference: Vec<f64> = h.samples.iter().zip(&our_h.samples).map(|(x, y)| y - x).collect();
            worst[1] = worst[1].max(norm(&difference) / size);
        }
        for dead in [Component::Ex, Component::Ey, Component::Hz] {
            for trace in [a.component(dead), b.component(dead)].into_iter().flatten() {
                assert_eq!(trace.peak(), 0.0, "{} of `{}`", dead.name(), a.name);
            }
        }
    }
    assert!(seen, "no receiver saw anything");
    worst
}

fn head() {
    println!("{:<42}{:>6}  {:>9}{:>9}  {:>9}{:>9}", "", "steps", "Ez f32", "H f32", "Ez f64", "H f64");
}

/// Sets both of our precisions beside a run of gprMax, prints the line, and says whether all are within `tolerance`.
fn line(name: &str, model: &Model, theirs: &Traces, tolerance: [f64; 2]) -> bool {
    let [single, double] =
        [Precision::Single, Precision::Double].map(|precision| differences(theirs, &ours(model, precision)));
    println!(
        "{name:<42}{:>6}  {:>9.1e}{:>9.1e}  {:>9.1e}{:>9.1e}",
        theirs.iterations, single[0], single[1], double[0], double[1]
    );
    // Not `>`: a value that is no number must not pass.
    single.iter().all(|v| *v <= tolerance[0]) && double.iter().all(|v| *v <= tolerance[1])
}

/// Every folder of `validation/gprmax`; one without its output or its scene fails.
#[test]
fn stored_outputs_of_gprmax_are_met() {
    let all = reference_case("");
    let mut folders: Vec<PathBuf> =
        fs::read_dir(&all).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_dir()).collect();
    folders.sort();
    assert!(folders.len() >= 25, "{} cases", folders.len());
    head();
    let mut missed = vec![];
    for folder in folders {
        let name = folder.file_name().unwrap().to_string_lossy().into_owned();
        let model = read_model(&folder.join("scene.in")).unwrap();
        let theirs = read_traces(&folder.join("out_f64.h5")).unwrap();
        assert!(theirs.double_precision && theirs.solver.contains("gprMax 4."), "{name}: {}", theirs.solver);
        if !line(&name, &model, &theirs, [SINGLE, DOUBLE]) {
            missed.push(name);
        }
    }
    assert!(missed.is_empty(), "differ: {missed:?}");
}

fn tank(fouling: Option<&str>, cell: f64, window: f64) -> SceneSpec {
    let mut spec = SceneSpec::preset("tank").unwrap();
    spec.fouling = fouling.map(|amount| FoulingSpec::of(amount.parse().unwrap()));
    spec.grid.cell = Metres(cell);
    spec.grid.time_window = Seconds(window);
    spec
}

fn moist(mut spec: SceneSpec) -> SceneSpec {
    spec.moisture = Some(MoistureSpec { fines: Share(0.10), voids: Share(0.0) });
    spec
}

fn model_of(spec: &SceneSpec) -> Model {
    build_model(&resolve(spec).unwrap()).unwrap()
}

fn run_gprmax(model: &Model, double_precision: bool) -> Option<Traces> {
    let solver = GprMax { python: gprmax()?, threads: Some(1), double_precision };
    Some(solver.solve(model, &|_| ControlFlow::Continue(())).unwrap())
}

/// The clean tank at 2 mm, stones as cells, to well past the plate's echo at 9.3 ns.
#[test]
fn gprmax_sees_the_clean_tank_as_we_do() {
    let model = model_of(&tank(None, 0.002, 15e-9));
    let Some(theirs) = run_gprmax(&model, true) else { return };
    assert!(line("clean tank, voxels, 2 mm", &model, &theirs, [SINGLE, DOUBLE]));
}

/// The tank with 20 cm of fouling at 2 mm, stones as cylinders, which gprMax rasters itself.
#[test]
fn gprmax_sees_the_fouled_tank_as_we_do() {
    let mut spec = tank(Some("20cm"), 0.002, 15e-9);
    spec.grid.geometry = GeometryKind::Cylinders;
    let model = model_of(&spec);
    let Some(theirs) = run_gprmax(&model, true) else { return };
    assert!(line("20 cm of fouling, cylinders, 2 mm", &model, &theirs, [SINGLE, DOUBLE]));
}

/// Fines with 10 % of water relax: Debye poles, in gprMax's double and in its single precision.
///
/// Two single-precision runs differ by the sum of what each differs from double, hence the same tolerance for both of ours.
#[test]
fn gprmax_sees_the_moist_tank_as_we_do() {
    let model = model_of(&moist(tank(Some("20cm"), 0.004, 15e-9)));
    assert!(model.materials.iter().any(|material| !material.poles.is_empty()));
    let Some(theirs) = run_gprmax(&model, true) else { return };
    assert!(line("moist fouling, 4 mm, gprMax double", &model, &theirs, [SINGLE, DOUBLE]));
    let single = run_gprmax(&model, false).unwrap();
    assert!(line("moist fouling, 4 mm, gprMax single", &model, &single, [SINGLE, SINGLE]));
}

/// Area smoothing makes dozens of materials, moist ones with the poles of both: 8 mm.
#[test]
fn gprmax_sees_smoothed_stones_as_we_do() {
    for (name, mut spec) in [
        ("20 cm of fouling, area, 8 mm", tank(Some("20cm"), 0.008, 15e-9)),
        ("moist fouling, area, 8 mm", moist(tank(Some("20cm"), 0.008, 15e-9))),
    ] {
        spec.grid.smoothing = Smoothing::Area;
        let model = model_of(&spec);
        assert!(model.materials.len() > 40, "{}", model.materials.len());
        let Some(theirs) = run_gprmax(&model, true) else { return };
        assert!(line(name, &model, &theirs, [SINGLE, DOUBLE]));
    }
}

/// What gprMax refuses, we refuse: too few cells per wavelength, a step beyond the Courant limit, absorbing cells on the
/// invariant axis, ones that meet, a source outside. Just enough cells per wavelength are taken by both.
#[test]
fn what_gprmax_refuses_is_refused() {
    let Some(python) = gprmax() else { return };
    let solver = GprMax { python, threads: Some(1), double_precision: true };
    let scene = |eps: &str, more: &str| {
        format!(
            "#domain: 0.16 0.16 0.004\n#dx_dy_dz: 0.004 0.004 0.004\n#time_window: 600\n#waveform: ricker 1 1e9 w\n\
             #material: {eps} 0 1 0 m\n#box: 0 0 0 0.16 0.08 0.004 m\n#hertzian_dipole: z 0.08 0.12 0 w\n#rx: 0.1 0.12 0\n{more}\n"
        )
    };
    // The shortest wavelength is that of 2.83 GHz, 106 mm in air: 3 cells of 4 mm at eps_r 78.
    for (name, text, accepted) in [
        ("eps_r 70", scene("70", ""), true),
        ("eps_r 85", scene("85", ""), false),
        ("beyond the Courant limit", scene("4", "#time_step_stability_factor: 1.01"), false),
        ("absorbing cells along z", scene("4", "#pml_cells: 10"), false),
        ("absorbing cells that meet", scene("4", "#pml_cells: 20 5 0 20 5 0"), false),
        ("a source outside", scene("4", "#hertzian_dipole: z 0.2 0.12 0 w"), false),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let input = folder.path().join("scene.in");
        fs::write(&input, text).unwrap();
        let theirs = solver.run_file(&input, &folder.path().join("out.h5"), &|_| ControlFlow::Continue(()));
        let ours = read_model(&input).map_err(|error| error.to_string()).and_then(|model| {
            let quiet = |_| ControlFlow::Continue(());
            Fdtd::default().solve(&model, &quiet).map_err(|error| error.to_string())
        });
        let said = (theirs.map_err(|error| error.to_string()).err(), ours.err());
        assert_eq!((said.0.is_none(), said.1.is_none()), (accepted, accepted), "{name}: gprMax, ours: {said:?}");
    }
}
