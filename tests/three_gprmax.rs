//! The embedded solver against gprMax 4.0.1 in three dimensions: every scene of `validation/gprmax3d`, all six components.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use ballast_gpr::compare::worst_field_difference;
use ballast_gpr::fdtd::{Fdtd, Precision};
use ballast_gpr::gprmax::{read_model, read_traces};
use ballast_gpr::trace::Traces;

fn scenes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/gprmax3d");
    let mut scenes: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.join("scene.in").is_file())
        .collect();
    scenes.sort();
    scenes
}

fn solve(scene: &Path, precision: Precision) -> Traces {
    let model = read_model(&scene.join("scene.in")).unwrap();
    Fdtd { precision, ..Fdtd::default() }.solve_stats(&model, &|_| ControlFlow::Continue(())).unwrap().0
}

/// The largest `|ours - theirs| / |theirs|` over receivers and components.
fn worst(ours: &Traces, theirs: &Traces) -> f64 {
    assert_eq!((ours.cells, ours.iterations), (theirs.cells, theirs.iterations));
    assert!((ours.time_step.si() / theirs.time_step.si() - 1.0).abs() < 1e-15);
    worst_field_difference(theirs, ours).unwrap()
}

/// The same sums in another order: round-off of 1e-16 grows to 4e-13 at most over some hundred steps (780 of them in
/// free space, whose H along the dipole is nothing but round-off).
#[test]
fn every_scene_agrees_in_double_precision() {
    let scenes = scenes();
    assert!(scenes.len() >= 14, "{}", scenes.len());
    for scene in scenes {
        let theirs = read_traces(&scene.join("out_f64.h5")).unwrap();
        let worst = worst(&solve(&scene, Precision::Double), &theirs);
        println!("{:<26}{worst:9.1e}", scene.file_name().unwrap().to_string_lossy());
        assert!(worst < 1e-10, "{}: {worst:e}", scene.display());
    }
}

/// Single precision differs from double as gprMax's own does: by 2e-5 to 2e-4 in three dimensions.
#[test]
fn every_scene_agrees_in_single_precision() {
    for scene in scenes() {
        let theirs = read_traces(&scene.join("out_f64.h5")).unwrap();
        let worst = worst(&solve(&scene, Precision::Single), &theirs);
        println!("{:<26}{worst:9.1e}", scene.file_name().unwrap().to_string_lossy());
        assert!(worst < 1e-3, "{}: {worst:e}", scene.display());
    }
}

/// A scene with one effect taken out differs from gprMax's by more than the tolerance: the agreement is no accident.
#[test]
fn a_scene_without_its_spheres_does_not_agree() {
    let scene = scenes().into_iter().find(|scene| scene.ends_with("spheres_off_grid")).unwrap();
    let mut model = read_model(&scene.join("scene.in")).unwrap();
    model.objects.clear();
    let theirs = read_traces(&scene.join("out_f64.h5")).unwrap();
    let fdtd = Fdtd { precision: Precision::Double, ..Fdtd::default() };
    let (ours, _) = fdtd.solve_stats(&model, &|_| ControlFlow::Continue(())).unwrap();
    assert!(worst(&ours, &theirs) > 1e-2);
}
