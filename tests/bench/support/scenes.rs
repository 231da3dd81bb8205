//! Beds of stones to measure on: the more the wave has to do in each cell, the closer to a ballast scene.

use ballast_gpr::model::{
    Axis, DebyePole, Excitation, Grid, HertzianDipole, Material, Model, Object, Receiver, Source, TimeWindow, Waveform,
    WaveformKind,
};

/// Air or a lossless host around stones of permittivity 6.
pub fn host() -> Material {
    Material::dielectric("host", 1.0, 0.0)
}

/// Moist fines, one Debye pole (facts of the reference run: eps_inf 3.5, delta 6, tau 9.231 ps).
pub fn moist() -> Material {
    let poles = vec![DebyePole { delta_eps: 6.0, tau: 9.231e-12 }];
    Material { poles, averagable: false, ..Material::dielectric("host", 3.5, 0.005) }
}

fn place(k: usize, factor: f64, size: f64) -> f64 {
    (k as f64 * factor).fract() * size
}

fn antenna(model: &mut Model, polarisation: Axis, position: [f64; 3], offset: f64) {
    model.waveforms.push(Waveform { id: "w".into(), kind: WaveformKind::Ricker, amplitude: 1.0, frequency: 1e9 });
    let excitation = Excitation { start: 0.0, stop: None };
    let dipole = HertzianDipole { polarisation, position, waveform: 0, excitation };
    model.sources.push(Source::HertzianDipole(dipole));
    let [x, y, z] = position;
    model.receivers.push(Receiver { position: [x + offset, y, z], name: None });
}

/// Cylinders of 4 cm in a host that fills all cells; 2 mm cells, nothing changes along z.
pub fn bed_2d(nx: usize, ny: usize, steps: usize, host: Material, stones: usize) -> Model {
    let d = 0.002;
    let (width, height) = (nx as f64 * d, ny as f64 * d);
    let mut model = Model::new("bench", Grid { cells: [nx, ny, 1], spacing: [d; 3] }, TimeWindow::Iterations(steps));
    let (host, stone) = (model.add_material(host), model.add_material(Material::dielectric("stone", 6.0, 0.0)));
    model.objects.push(Object::Box { lower: [0.0; 3], upper: [width, height, d], material: host, averaging: true });
    for k in 0..stones {
        let (x, y) = (place(k, 0.618_034, width), place(k, 0.754_878, 0.6 * height));
        let (start, end) = ([x, y, 0.0], [x, y, d]);
        model.objects.push(Object::Cylinder { start, end, radius: 0.02, material: stone, averaging: true });
    }
    antenna(&mut model, Axis::Z, [0.5 * width, 0.8 * height, 0.0], 0.05 * width);
    model
}

/// Spheres of 4.4 cm in a host that fills all cells; 4 mm cells.
pub fn bed_3d(cells: [usize; 3], steps: usize, host: Material, stones: usize) -> Model {
    let d = 0.004;
    let size = cells.map(|count| count as f64 * d);
    let mut model = Model::new("bench", Grid { cells, spacing: [d; 3] }, TimeWindow::Iterations(steps));
    let (host, stone) = (model.add_material(host), model.add_material(Material::dielectric("stone", 6.0, 0.0)));
    model.objects.push(Object::Box { lower: [0.0; 3], upper: size, material: host, averaging: true });
    for k in 0..stones {
        let centre = [place(k, 0.618_034, size[0]), place(k, 0.754_878, size[1]), place(k, 0.569_84, 0.66 * size[2])];
        model.objects.push(Object::Sphere { centre, radius: 0.022, material: stone, averaging: true });
    }
    antenna(&mut model, Axis::X, [0.5 * size[0], 0.5 * size[1], 0.8 * size[2]], 0.05 * size[0]);
    model
}

/// The same section with its invariant axis along y, which suits gprMax best: its innermost loop runs along z.
pub fn across_y(model: &Model) -> Model {
    let turn = |[x, y, z]: [f64; 3]| [x, z, y];
    let mut turned = model.clone();
    let [nx, ny, nz] = model.grid.cells;
    turned.grid = Grid { cells: [nx, nz, ny], spacing: turn(model.grid.spacing) };
    turned.pml_cells = model.pml_cells.map(|[x0, y0, z0, x1, y1, z1]| [x0, z0, y0, x1, z1, y1]);
    for object in &mut turned.objects {
        match object {
            Object::Box { lower, upper, .. } => (*lower, *upper) = (turn(*lower), turn(*upper)),
            Object::Cylinder { start, end, .. } => (*start, *end) = (turn(*start), turn(*end)),
            Object::Sphere { centre, .. } => *centre = turn(*centre),
            // One cell deep either way, so the cells keep their order.
            Object::Voxels(voxels) if voxels.edges.is_none() && voxels.shape[2] == 1 => {
                voxels.origin = turn(voxels.origin);
                voxels.shape.swap(1, 2);
            }
            other => panic!("{other:?} has not been taught to turn"),
        }
    }
    for source in &mut turned.sources {
        let Source::HertzianDipole(dipole) = source else { panic!("{source:?} has not been taught to turn") };
        dipole.position = turn(dipole.position);
        dipole.polarisation = match dipole.polarisation {
            Axis::X => Axis::X,
            Axis::Y => Axis::Z,
            Axis::Z => Axis::Y,
        };
    }
    for receiver in &mut turned.receivers {
        receiver.position = turn(receiver.position);
    }
    turned.source_steps = turn(model.source_steps);
    turned.receiver_steps = turn(model.receiver_steps);
    turned
}
