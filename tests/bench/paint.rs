//! Time of painting, best of several runs: a tank of stones in two dimensions, balls in three.
//!
//! `cargo bench --bench paint`; threads as `RAYON_NUM_THREADS` says.

use std::time::Instant;

use ballast_gpr::model::{Averaging, Grid, Material, Model, Object, TimeWindow, paint, paint3};
use ballast_gpr::raster::build_model;
use ballast_gpr::scene::{GeometryKind, SceneSpec, resolve};
use ballast_gpr::units::Metres;

/// Best wall time of several runs, ms.
fn best<T>(work: impl Fn() -> T) -> f64 {
    let once = || {
        let begin = Instant::now();
        std::hint::black_box(work());
        begin.elapsed().as_secs_f64() * 1e3
    };
    (0..15).map(|_| once()).fold(f64::INFINITY, f64::min)
}

/// 500 balls of 20 to 60 mm in 2.3 million cells of 4 mm.
fn balls(averaging: bool) -> Model {
    let d = 0.004;
    let grid = Grid { cells: [150, 125, 125], spacing: [d; 3] };
    let mut model = Model::new("balls", grid, TimeWindow::Iterations(1));
    let stone = model.add_material(Material::dielectric("stone", 5.27, 0.001));
    let place = |n: usize, ratio: f64, cells: usize| (n as f64 * ratio).fract() * cells as f64 * d;
    for n in 1..=500 {
        let centre = [place(n, 0.819_173, 150), place(n, 0.671_044, 125), place(n, 0.549_700, 125)];
        let radius = 0.01 + 0.02 * place(n, 0.445, 1) / d;
        model.objects.push(Object::Sphere { centre, radius, material: stone, averaging });
    }
    model
}

fn tank(cell: f64, geometry: GeometryKind) -> Model {
    let mut spec = SceneSpec::preset("tank").unwrap();
    spec.grid.cell = Metres(cell);
    spec.grid.geometry = geometry;
    build_model(&resolve(&spec).unwrap()).unwrap()
}

fn main() {
    for (name, model) in [
        ("tank, 2 mm, cylinders", tank(0.002, GeometryKind::Cylinders)),
        ("tank, 2 mm, voxels", tank(0.002, GeometryKind::Voxels)),
        ("tank, 1 mm, cylinders", tank(0.001, GeometryKind::Cylinders)),
    ] {
        let [nx, ny, _] = model.grid.cells;
        println!("{name:<28}{:>4} objects {nx:>5} x {ny:<5}{:9.2} ms", model.objects.len(), best(|| paint(&model)));
    }
    let mut shapes = balls(true);
    shapes.averaging = Averaging::Shapes;
    // On a lattice none overlaps, as stones do not.
    let mut apart = shapes.clone();
    for (n, object) in apart.objects.iter_mut().enumerate() {
        if let Object::Sphere { centre, radius, .. } = object {
            *centre = [n % 10, n / 10 % 8, n / 80].map(|at| 0.03 + 0.061 * at as f64);
            *radius = radius.min(0.03);
        }
    }
    let of_balls = [
        ("500 balls", balls(true)),
        ("500 balls without averaging", balls(false)),
        ("500 balls, shapes", shapes),
        ("500 balls apart, shapes", apart),
    ];
    for (name, model) in of_balls {
        println!("{name:<28}{:>11} cells  {:9.2} ms", model.grid.cell_count(), best(|| paint3(&model)));
    }
}
