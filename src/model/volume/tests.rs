//! Means over volumes against closed forms.

use std::f64::consts::PI;

use proptest::prelude::*;

use crate::model::{
    Averaging, Axis, DebyePole, EdgeMaterial, Grid, Material, MaterialId, Model, Object, Painted3, TimeWindow, Voxels,
    paint3,
};

const D: [f64; 3] = [0.002, 0.0025, 0.003];

fn block(cells: [usize; 3]) -> (Model, MaterialId) {
    let mut model = Model::new("", Grid { cells, spacing: D }, TimeWindow::Iterations(1));
    model.averaging = Averaging::Volumes;
    let stone = model.add_material(Material::dielectric("stone", 6.0, 0.004));
    (model, stone)
}

fn sphere(centre: [f64; 3], radius: f64, material: MaterialId) -> Object {
    Object::Sphere { centre, radius, material, averaging: true }
}

/// The sum over all edges along each axis of a value times the volume of a cell.
fn sums(painted: &Painted3, of: fn(&EdgeMaterial) -> f64) -> [f64; 3] {
    let cell: f64 = D.iter().product();
    std::array::from_fn(|axis| {
        let list = painted.edges[axis].to_vec();
        list.iter().map(|&entry| of(&painted.palette[entry as usize])).sum::<f64>() * cell
    })
}

/// The excess `(eps - 1) dV` over all edges, and the conductivity with it, against 5 times the volume of the bodies; `error`
/// relative.
fn holds(objects: Vec<Object>, volume: f64, error: f64) {
    let (mut model, _) = block([22, 20, 18]);
    let kind = format!("{:?}", objects[0]);
    model.objects = objects;
    let painted = paint3(&model).unwrap();
    let (eps, sigma) = (sums(&painted, |e| e.eps_r - 1.0), sums(&painted, |e| e.sigma));
    for axis in 0..3 {
        let found = [eps[axis] / (5.0 * volume) - 1.0, sigma[axis] / (0.004 * volume) - 1.0];
        assert!(found.iter().all(|off| off.abs() < error), "{kind}: axis {axis}, off by {found:?}");
    }
}

const STONE: MaterialId = MaterialId(2);
const MIDDLE: [f64; 3] = [0.0221, 0.0253, 0.0268];

/// Bodies with closed forms, wherever they lie and where two touch. Shares are rounded to 2⁻²⁴ (6e-8) and left out below
/// 1e-7: over the thousands of boxes on a surface that is less than 1e-6 of the volume.
#[test]
fn volumes_are_kept() {
    for shift in [0.0, 0.0003, 0.00071, 0.0013] {
        let centre = [MIDDLE[0] + shift, MIDDLE[1] - 0.004, MIDDLE[2] + 0.3 * shift];
        let r = [0.0096, 0.0051];
        let next = [centre[0], centre[1] + 0.6 * (r[0] + r[1]), centre[2] + 0.8 * (r[0] + r[1])];
        let volume = 4.0 * PI / 3.0 * (r[0].powi(3) + r[1].powi(3));
        holds(vec![sphere(centre, r[0], STONE), sphere(next, r[1], STONE)], volume, 1e-6);
    }
    let radii = [0.0103, 0.0071, 0.0132];
    let ellipsoid = Object::Ellipsoid { centre: MIDDLE, radii, material: STONE, averaging: true };
    holds(vec![ellipsoid], 4.0 * PI / 3.0 * radii.iter().product::<f64>(), 1e-6);
    let (lower, upper) = ([0.0101, 0.0122, 0.0133], [0.0307, 0.0314, 0.0325]);
    let cuboid = Object::Box { lower, upper, material: STONE, averaging: false };
    holds(vec![cuboid], (0..3).map(|a| upper[a] - lower[a]).product(), 1e-6);
    for axis in 0..3 {
        let (mut start, mut end) = (MIDDLE, MIDDLE);
        (start[axis], end[axis]) = (0.0111, 0.0318);
        let rod = Object::Cylinder { start, end, radius: 0.0082, material: STONE, averaging: true };
        holds(vec![rod], PI * 0.0082f64.powi(2) * (0.0318 - 0.0111), 1e-6);
    }
}

/// Bodies that are cut into eighths: what is left is taken as flat but for its mean curvature, and its rims as right-angled.
#[test]
fn volumes_without_a_closed_form() {
    let (start, end): ([f64; 3], [f64; 3]) = ([0.0141, 0.0152, 0.0163], [0.0287, 0.0311, 0.0338]);
    let length = (0..3).map(|a| (end[a] - start[a]).powi(2)).sum::<f64>().sqrt();
    let radius = 0.0072;
    let rod = Object::Cylinder { start, end, radius, material: STONE, averaging: true };
    holds(vec![rod], PI * radius * radius * length, 3e-4);
    let radii = [0.0031, 0.0083];
    let cone = Object::Cone { start, end, radii, material: STONE, averaging: true };
    holds(vec![cone], PI / 3.0 * length * (radii[0].powi(2) + radii[0] * radii[1] + radii[1].powi(2)), 3e-4);
    for axis in [Axis::X, Axis::Y, Axis::Z] {
        for sweep in [77.0, 180.0, 250.0, 360.0] {
            let across: Vec<f64> = (0..3).filter(|a| *a != axis.index()).map(|a| MIDDLE[a]).collect();
            let (centre, extent) = ([across[0], across[1]], [0.0131, 0.0308]);
            let object = Object::Sector {
                axis,
                centre,
                extent,
                radius: 0.0121,
                start: 33.0,
                sweep,
                material: STONE,
                averaging: true,
            };
            holds(vec![object], PI * 0.0121f64.powi(2) * sweep / 360.0 * (0.0308 - 0.0131), 1e-3);
        }
        let mut corners = [[0.0131; 3]; 3];
        let others: Vec<usize> = (0..3).filter(|a| *a != axis.index()).collect();
        for (corner, [p, q]) in corners.iter_mut().zip([[0.0112, 0.0123], [0.0333, 0.0171], [0.0154, 0.0322]]) {
            (corner[others[0]], corner[others[1]]) = (p, q);
        }
        let area = 0.5 * (0.0221f64 * 0.0199 - 0.0048 * 0.0042).abs();
        let prism = Object::Triangle { corners, axis, thickness: 0.0177, material: STONE, averaging: true };
        holds(vec![prism], area * 0.0177, 1e-3);
    }
}

/// The edge below the pole of a ball that reaches 0.4 of a cell into its box: a cap, `pi h² (3 R - h)/3`, of which the box
/// holds all where it is wide enough.
#[test]
fn a_cap_fills_its_share_of_a_box() {
    let (mut model, stone) = block([20, 20, 20]);
    // The box of the x edge at node (10, 10, 10) begins at z = 9.5 cells.
    let (height, radius) = (0.00015, 0.003);
    let centre = [10.5 * D[0], 10.0 * D[1], 9.5 * D[2] + height - radius];
    model.objects.push(sphere(centre, radius, stone));
    let painted = paint3(&model).unwrap();
    let cap = PI * height * height * (3.0 * radius - height) / 3.0;
    let exact = 1.0 + 5.0 * cap / D.iter().product::<f64>();
    let found = painted.edge(0, [10, 10, 10]).eps_r;
    assert!((found - exact).abs() < 5.0 * 6e-8, "{found} {exact}");
}

/// Later bodies lie over earlier ones: a box over a ball, a ball over a box, a ball within another.
#[test]
fn the_last_painted_wins() {
    let volume = |r: f64| 4.0 * PI / 3.0 * r.powi(3);
    let excess = |objects: Vec<Object>| {
        let (mut model, _) = block([22, 20, 18]);
        model.add_material(Material::dielectric("dense", 11.0, 0.0));
        model.objects = objects;
        sums(&paint3(&model).unwrap(), |e| e.eps_r - 1.0)
    };
    let dense = MaterialId(3);
    let close = |found: [f64; 3], exact: f64, error: f64| {
        assert!(found.iter().all(|v| (v / exact - 1.0).abs() < error), "{found:?} {exact}");
    };
    // A block that hides the half of the ball beyond its middle, and reaches further on every side.
    let upper = MIDDLE.map(|v| v + 0.0112);
    let lower = [MIDDLE[0], MIDDLE[1] - 0.0113, MIDDLE[2] - 0.0114];
    let cuboid = Object::Box { lower, upper, material: dense, averaging: true };
    let block_volume: f64 = (0..3).map(|a| upper[a] - lower[a]).product();
    let ball = sphere(MIDDLE, 0.0101, STONE);
    close(excess(vec![ball.clone(), cuboid.clone()]), 5.0 * volume(0.0101) / 2.0 + 10.0 * block_volume, 1e-6);
    close(excess(vec![cuboid, ball]), 5.0 * volume(0.0101) + 10.0 * (block_volume - volume(0.0101) / 2.0), 1e-6);
    let kernel = sphere([MIDDLE[0] + 0.001, MIDDLE[1], MIDDLE[2] - 0.0005], 0.0063, dense);
    let shell = sphere(MIDDLE, 0.0101, STONE);
    // Where both surfaces pass through one box, it is cut into eighths.
    close(excess(vec![shell, kernel]), 5.0 * (volume(0.0101) - volume(0.0063)) + 10.0 * volume(0.0063), 3e-5);
}

/// Two balls that overlap count once, up to what is not known of the lens in the last eighths.
#[test]
fn balls_that_overlap_count_once() {
    let (r, distance) = (0.0091f64, 0.0153f64);
    let lens = PI * (4.0 * r + distance) * (2.0 * r - distance).powi(2) / 12.0;
    let other = [MIDDLE[0], MIDDLE[1] + 0.6 * distance, MIDDLE[2] - 0.8 * distance];
    let volume = 8.0 * PI / 3.0 * r.powi(3) - lens;
    holds(vec![sphere(MIDDLE, r, STONE), sphere(other, r, STONE)], volume, 1e-4);
}

/// A ball in the middle of the grid: mirrored places hold the same, to the last bit that is kept.
#[test]
fn a_ball_in_the_middle_is_symmetric() {
    let (mut model, stone) = block([16, 18, 14]);
    let centre = [8.0 * D[0], 9.0 * D[1], 7.0 * D[2]];
    model.objects.push(sphere(centre, 0.0117, stone));
    let painted = paint3(&model).unwrap();
    let n = painted.cells;
    for axis in 0..3 {
        for i in 0..n[0] {
            for j in 0..n[1] {
                for k in 0..n[2] {
                    let node = [i, j, k];
                    if (0..3).any(|a| a != axis && node[a] == 0) {
                        continue;
                    }
                    let other: [usize; 3] = std::array::from_fn(|a| n[a] - node[a] - usize::from(a == axis));
                    let (here, there) = (painted.edge(axis, node).eps_r, painted.edge(axis, other).eps_r);
                    assert!((here - there).abs() < 5.0 * 1.3e-7, "{axis} {node:?}: {here} {there}");
                }
            }
        }
    }
}

/// Cells of a block give what gprMax's rule gives: the mean of the four around an edge.
#[test]
fn cells_of_a_block_are_as_they_are() {
    let (mut model, stone) = block([6, 6, 6]);
    let dense = model.add_material(Material::dielectric("dense", 11.0, 0.0));
    let cells = (0..27).map(|c| [Some(stone), None, Some(dense)][c * 7 % 5 % 3]).collect();
    let origin = [D[0], D[1], D[2]];
    model.objects.push(Object::Voxels(Voxels { origin, shape: [3; 3], cells, averaging: true, edges: None }));
    let shapes = paint3(&model).unwrap();
    model.averaging = Averaging::Cells;
    let snapped = paint3(&model).unwrap();
    for axis in 0..3 {
        for node in 0..7 * 7 * 7 {
            let node = [node / 49, node / 7 % 7, node % 7];
            if (0..3).all(|a| node[a] < 6 && (a == axis || node[a] > 0)) {
                let (a, b) = (shapes.edge(axis, node), snapped.edge(axis, node));
                assert!((a.eps_r - b.eps_r).abs() < 2e-6, "{axis} {node:?}: {a:?} {b:?}");
            }
        }
    }
}

/// A layer whose face lies off the nodes has two different means, wherever the edges are; a third is gprMax's on the walls.
#[test]
fn equal_boxes_share_an_entry() {
    let (mut model, stone) = block([12, 14, 16]);
    let upper = [1.0, 1.0, 0.0211];
    model.objects.push(Object::Box { lower: [-1.0; 3], upper, material: stone, averaging: true });
    let painted = paint3(&model).unwrap();
    assert_eq!(painted.palette.len(), 5, "{:?}", painted.palette);
}

/// A layer's face: edges along it hold the arithmetic mean, edges across it the harmonic one, of loss to first order
/// `eps² <sigma/eps²>`; a ball's pole the same. Between them `1/eps = n² <1/eps> + (1 - n²)/<eps>`.
#[test]
fn edges_across_a_surface_hold_the_harmonic_mean() {
    let (mut model, stone) = block([12, 12, 12]);
    model.averaging = Averaging::Shapes;
    let upper = [1.0, 1.0, 5.3 * D[2]];
    model.objects.push(Object::Box { lower: [-1.0; 3], upper, material: stone, averaging: true });
    let painted = paint3(&model).unwrap();
    let (along, across) = (painted.edge(0, [5, 5, 5]), painted.edge(2, [5, 5, 5]));
    assert!((along.eps_r - (1.0 + 5.0 * 0.8)).abs() < 1e-6 && (along.sigma - 0.8 * 0.004).abs() < 1e-9);
    let harmonic = 1.0 / (0.3 / 6.0 + 0.7);
    assert!((across.eps_r - harmonic).abs() < 1e-6, "{across:?}");
    assert!((across.sigma - harmonic * harmonic * 0.3 * 0.004 / 36.0).abs() < 1e-9, "{across:?}");
    // A ball whose surface passes node (6, 6, k) at 45 degrees between x and z.
    let middle = [6.0 * D[0], 6.0 * D[1], 6.0 * D[2]];
    let centre = [middle[0] - 0.007, middle[1], middle[2] - 0.007];
    model.objects = vec![sphere(centre, 0.007 * 2f64.sqrt(), stone)];
    let edge = |model: &Model| paint3(model).unwrap().edge(1, [6, 5, 6]).eps_r;
    let shapes = edge(&model);
    model.averaging = Averaging::Volumes;
    let mean = edge(&model);
    let share = (mean - 1.0) / 5.0;
    // The box's middle lies half a cell along y beside the plane of the normal.
    let across = (0.5 * D[1]).powi(2) / ((0.5 * D[1]).powi(2) + 2.0 * 0.007f64.powi(2));
    let exact = 1.0 / (across * (share / 6.0 + 1.0 - share) + (1.0 - across) / mean);
    assert!((shapes - exact).abs() < 1e-9, "{shapes} {exact}");
}

/// Conductors keep their cells and take no part; a dispersive medium takes an edge or leaves it; what has no volume is
/// refused by name unless it conducts.
#[test]
fn conductors_and_dispersive_media() {
    let (mut model, stone) = block([10, 10, 10]);
    let mut wet = Material::dielectric("wet", 20.0, 0.0);
    wet.poles.push(DebyePole { delta_eps: 3.0, tau: 1e-11 });
    let wet = model.add_material(wet);
    let layer = |low: f64, high: f64, material| {
        let (lower, upper) = ([-1.0, -1.0, low * D[2]], [1.0, 1.0, high * D[2]]);
        Object::Box { lower, upper, material, averaging: true }
    };
    let plate = |material| Object::Plate { lower: [0.0, 0.0, 8.0 * D[2]], upper: [0.02, 0.025, 8.0 * D[2]], material };
    model.objects = vec![layer(0.0, 3.3, stone), layer(0.0, 1.2, MaterialId::PEC), layer(5.1, 6.2, wet)];
    model.objects.push(plate(MaterialId::PEC));
    let painted = paint3(&model).unwrap();
    let at = |k: usize| painted.edge(0, [4, 4, k]);
    assert!(at(1).sigma.is_infinite() && at(8).sigma.is_infinite() && !at(2).sigma.is_infinite());
    assert_eq!((at(2).eps_r, at(4).eps_r), (6.0, 1.0));
    assert!((at(3).eps_r - (1.0 + 5.0 * 0.8)).abs() < 1e-6);
    // The box from 4.5 to 5.5 holds 0.4 of it, that from 5.5 to 6.5 holds 0.7.
    assert_eq!((at(5).eps_r, at(6).eps_r, at(6).dispersive), (1.0, 20.0, Some(wet)));
    model.objects.push(plate(stone));
    let message = paint3(&model).unwrap_err().to_string();
    assert!(message.starts_with("object 5 has no volume"), "{message}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    /// The same on any number of threads; and every mean lies between the materials.
    #[test]
    fn threads_change_nothing(
        balls in prop::collection::vec((prop::array::uniform3(0.0..0.05f64), 0.002..0.015f64, any::<bool>()), 1..9),
        threads in 1usize..5,
    ) {
        let (mut model, stone) = block([21, 17, 19]);
        for (centre, radius, round) in balls {
            let (start, end) = (centre, [centre[0] + 0.01, centre[1] + 0.004, centre[2] + 0.007]);
            model.objects.push(match round {
                true => sphere(centre, radius, stone),
                false => Object::Cylinder { start, end, radius, material: stone, averaging: true },
            });
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let Ok(painted) = pool.install(|| paint3(&model)) else { return Ok(()) };
        prop_assert!(painted.palette.iter().all(|e| (1.0..=6.0 + 1e-12).contains(&e.eps_r)));
        prop_assert_eq!(painted, paint3(&model).unwrap());
    }
}
