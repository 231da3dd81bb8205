//! Painting against numbers counted by hand and against a plain painter.

use std::collections::HashMap;
use std::sync::Arc;

use proptest::prelude::*;

use crate::model::{
    DebyePole, EdgeMaterial, Grid, Material, MaterialId, Model, Object, TimeWindow, Voxels, paint, paint3,
};

fn plane(nx: usize, ny: usize) -> Model {
    Model::new("", Grid { cells: [nx, ny, 1], spacing: [0.002; 3] }, TimeWindow::Iterations(1))
}

fn cuboid(cells: [usize; 4], material: MaterialId, averaging: bool) -> Object {
    let [i0, j0, i1, j1] = cells.map(|c| c as f64 * 0.002);
    Object::Box { lower: [i0, j0, 0.0], upper: [i1, j1, 0.002], material, averaging }
}

fn cylinder(x: f64, y: f64, radius: f64, material: MaterialId) -> Object {
    Object::Cylinder { start: [x, y, 0.0], end: [x, y, 0.002], radius, material, averaging: true }
}

/// An edge on a flat face between 1 and 6 holds 3.5, on a corner (one cell of 6 in four) 2.25, inside 6.
#[test]
fn edges_hold_the_mean_of_four_cells() {
    let mut model = plane(8, 8);
    let stone = model.add_material(Material::dielectric("stone", 6.0, 0.004));
    model.objects.push(cuboid([2, 2, 5, 5], stone, true));
    let painted = paint(&model).unwrap();
    assert_eq!(painted.edge(2, 2).eps_r, 2.25);
    assert_eq!(painted.edge(2, 3).eps_r, 3.5);
    assert_eq!(painted.edge(2, 3).sigma, 0.002);
    assert_eq!(painted.edge(3, 3).eps_r, 6.0);
    assert_eq!(painted.edge(0, 0).eps_r, 1.0);
    // Rim of 3 x 3 cells: 12 edges.
    assert_eq!(painted.averaged_edges, 12);
}

/// Without averaging the box owns all edges of its cells, rim included.
#[test]
fn a_box_without_averaging_owns_its_rim() {
    let mut model = plane(8, 8);
    let stone = model.add_material(Material::dielectric("stone", 6.0, 0.0));
    model.objects.push(cuboid([2, 2, 5, 5], stone, false));
    let painted = paint(&model).unwrap();
    assert_eq!(painted.edge_z.iter().filter(|&&e| painted.palette[e as usize].eps_r == 6.0).count(), 16);
    assert_eq!(painted.averaged_edges, 0);
}

/// A later averaging cell drops only its own claim: the rim shared with a claiming neighbour keeps the id of the last
/// claimant, even where that one has been painted over since.
#[test]
fn the_last_claim_on_an_edge_stands() {
    let mut model = plane(6, 6);
    let first = model.add_material(Material::dielectric("first", 2.0, 0.0));
    let second = model.add_material(Material::dielectric("second", 3.0, 0.0));
    let third = model.add_material(Material::dielectric("third", 5.0, 0.0));
    model.objects.push(cuboid([1, 1, 3, 5], first, false));
    model.objects.push(cuboid([3, 1, 5, 5], second, false));
    model.objects.push(cuboid([3, 1, 5, 5], third, true));
    let painted = paint(&model).unwrap();
    assert_eq!(painted.edge(3, 3).eps_r, 3.0);
    assert_eq!(painted.edge(4, 3).eps_r, 5.0);
    assert_eq!(painted.edge(5, 3).eps_r, (5.0 + 5.0 + 1.0 + 1.0) / 4.0);
}

/// The axis snaps to the nearest node, half going down; the radius does not: r = 1.6 cells about a node holds the
/// 4 x 4 cells less the corners (centres at 0.71, 1.58 and 2.12 cells).
#[test]
fn cylinders_snap_their_axis_but_not_their_radius() {
    for x in [0.0091, 0.0109, 0.011] {
        let mut model = plane(10, 10);
        let stone = model.add_material(Material::dielectric("stone", 6.0, 0.0));
        model.objects.push(cylinder(x, 0.010, 0.0032, stone));
        let painted = paint(&model).unwrap();
        let inside = |i: usize, j: usize| painted.solid[i * 10 + j] == stone;
        assert_eq!(painted.cells_per_material(3)[2], 12, "x = {x}");
        assert!(inside(3, 4) && inside(4, 3) && inside(6, 5) && !inside(3, 3), "x = {x}");
    }
}

#[test]
fn objects_that_fill_no_cell_are_named() {
    let mut model = plane(10, 10);
    let stone = model.add_material(Material::dielectric("stone", 6.0, 0.0));
    model.objects.push(cylinder(0.01, 0.01, 0.0005, stone));
    let message = paint(&model).unwrap_err().to_string();
    assert!(message.starts_with("object 1, a cylinder of `stone` at (0.01 m, 0.01 m), fills no cell of 0.002 m"));
}

/// Boxes are cut to the grid; one outside fills nothing.
#[test]
fn boxes_are_cut_to_the_grid() {
    let mut m = plane(4, 4);
    let stone = m.add_material(Material::dielectric("stone", 6.0, 0.0));
    m.objects = vec![Object::Box { lower: [-1.0; 3], upper: [1.0; 3], material: stone, averaging: true }];
    assert_eq!(paint(&m).unwrap().palette.len(), 1);
    m.objects = vec![cuboid([5, 5, 7, 7], stone, true)];
    assert!(paint(&m).is_err());
}

/// Voxels of a conductor and of "leave as it is", in a block that hangs over the grid's corner.
#[test]
fn voxels_leave_cells_that_hold_nothing() {
    let mut model = plane(3, 3);
    let cells: Arc<[_]> = vec![Some(MaterialId::PEC), None, None, Some(MaterialId::PEC)].into();
    model.objects.push(Object::Voxels(Voxels {
        origin: [0.004, 0.004, 0.0],
        shape: [2, 2, 1],
        cells,
        averaging: true,
        edges: None,
    }));
    let painted = paint(&model).unwrap();
    assert_eq!(painted.cells_per_material(2), [1, 8]);
    assert!(painted.edge(2, 2).sigma.is_infinite() && painted.edge(3, 3).sigma.is_infinite());
    assert_eq!(painted.edge(1, 2).sigma, 0.0);
}

fn block(cells: [usize; 3]) -> Model {
    Model::new("", Grid { cells, spacing: [0.002; 3] }, TimeWindow::Iterations(1))
}

/// The cells whose centres lie within 3.3 cells of a node, counted by hand in octants of 3 x 3 x 3: with half-integer
/// offsets, `a² + b² + c² <= 10.89` holds for 19 of 27 (not for 2.5 with 2.5, 1.5 and up).
#[test]
fn a_sphere_fills_the_cells_whose_centres_it_holds() {
    let mut model = block([12, 11, 10]);
    let stone = model.add_material(Material::dielectric("stone", 6.0, 0.0));
    let by_hand = (0..27)
        .filter(|n| [n % 3, n / 3 % 3, n / 9].iter().map(|&c| (f64::from(c) + 0.5).powi(2)).sum::<f64>() <= 10.89)
        .count();
    // The centre, 0.4 of a cell off its node, snaps to it.
    let centre = [0.0128, 0.0092, 0.0108];
    model.objects.push(Object::Sphere { centre, radius: 0.0066, material: stone, averaging: true });
    let painted = paint3(&model).unwrap();
    assert_eq!(painted.cells_per_material(3)[2], 8 * by_hand);
    assert_eq!(painted.solid[(6 * 11 + 5) * 10 + 5], stone);
    // Its own edges hold stone, those far away free space, those on its surface the mean.
    assert_eq!(painted.edge(0, [6, 5, 5]).eps_r, 6.0);
    assert_eq!(painted.edge(2, [0, 0, 0]).eps_r, 1.0);
    assert!(painted.averaged_edges.iter().all(|&count| count > 0));
}

/// A claimed cell gives its material to its twelve edges and to no other.
#[test]
fn a_claimed_cell_gives_its_material_to_twelve_edges() {
    let mut model = block([5, 5, 5]);
    let stone = model.add_material(Material::dielectric("stone", 6.0, 0.0));
    let (lower, upper) = ([0.004; 3], [0.006; 3]);
    model.objects.push(Object::Box { lower, upper, material: stone, averaging: false });
    let painted = paint3(&model).unwrap();
    let of_stone = painted.palette.iter().position(|edge| edge.eps_r == 6.0).unwrap();
    assert_eq!((painted.edges_per_entry()[of_stone], painted.averaged_edges), (12, [0; 3]));
    model.objects[0] = Object::Box { lower, upper, material: stone, averaging: true };
    // With averaging each of the twelve takes a quarter of it: 1 + 5/4.
    let painted = paint3(&model).unwrap();
    let mean = painted.palette.iter().position(|edge| edge.eps_r == 2.25).unwrap();
    assert_eq!((painted.edges_per_entry()[mean], painted.averaged_edges), (12, [4; 3]));
}

/// Only magnetic grids have faces; one between permeabilities 1 and 3 has 1.5.
#[test]
fn faces_take_the_harmonic_mean() {
    let mut model = block([5, 5, 5]);
    let ore = model.add_material(Material { mu_r: 3.0, ..Material::dielectric("ore", 1.0, 0.0) });
    assert!(paint3(&model).unwrap().faces[0].is_empty());
    let (lower, upper) = ([0.004; 3], [0.006; 3]);
    model.objects.push(Object::Box { lower, upper, material: ore, averaging: true });
    let painted = paint3(&model).unwrap();
    let face = |axis: usize, node| painted.face_palette[painted.faces[axis].get(painted.node(node)) as usize].mu_r;
    assert_eq!([face(0, [2, 2, 2]), face(1, [2, 3, 2]), face(2, [2, 2, 3]), face(0, [1, 2, 2])], [1.5, 1.5, 1.5, 1.0]);
}

/// A plain painter of boxes.
struct Naive {
    solid: Vec<MaterialId>,
    edges: [HashMap<[usize; 3], EdgeMaterial>; 3],
}

impl Naive {
    fn new(model: &Model) -> Self {
        let n = model.grid.cells;
        let place = |[i, j, k]: [usize; 3]| (i * n[1] + j) * n[2] + k;
        let mut solid = vec![MaterialId::FREE_SPACE; n.iter().product()];
        let mut claims = vec![false; solid.len()];
        let mut last: [HashMap<[usize; 3], MaterialId>; 3] = Default::default();
        for object in &model.objects {
            let Object::Box { lower, upper, material, averaging } = object else { unreachable!() };
            let stuff = &model.materials[material.index()];
            let claim = !averaging || stuff.is_pec() || stuff.is_dispersive();
            let span =
                |axis: usize| model.grid.node(axis, lower[axis]) as usize..model.grid.node(axis, upper[axis]) as usize;
            for i in span(0) {
                for j in span(1) {
                    for k in span(2) {
                        (solid[place([i, j, k])], claims[place([i, j, k])]) = (*material, claim);
                        for (axis, ends) in (0..3)
                            .flat_map(|axis| [[0, 0], [0, 1], [1, 0], [1, 1]].map(|e| (axis, e)))
                            .filter(|_| claim)
                        {
                            let mut node = [i, j, k];
                            let [p, q] = others(axis);
                            (node[p], node[q]) = (node[p] + ends[0], node[q] + ends[1]);
                            last[axis].insert(node, *material);
                        }
                    }
                }
            }
        }
        let edges = [0, 1, 2].map(|axis| {
            let mut edges = HashMap::new();
            let [p, q] = others(axis);
            for place_of in 0..(n[0] + 1) * (n[1] + 1) * (n[2] + 1) {
                let node =
                    [place_of / ((n[1] + 1) * (n[2] + 1)), place_of / (n[2] + 1) % (n[1] + 1), place_of % (n[2] + 1)];
                if node[axis] == n[axis] {
                    continue;
                }
                let around = [[0, 0], [0, 1], [1, 0], [1, 1]].map(|down: [usize; 2]| {
                    let mut cell = node;
                    for (of, down) in [(p, down[0]), (q, down[1])] {
                        cell[of] = if cell[of] == 0 { 0 } else { (cell[of] - down).min(n[of] - 1) };
                    }
                    place(cell)
                });
                let ids = around.map(|cell| solid[cell]);
                let claimed = around.iter().any(|&cell| claims[cell]).then(|| last[axis][&node]);
                let of = |id: MaterialId| {
                    let stuff = &model.materials[id.index()];
                    let dispersive = stuff.is_dispersive().then_some(id);
                    EdgeMaterial { eps_r: stuff.eps_r, sigma: stuff.sigma, dispersive, quarters: None }
                };
                let mean = |value: fn(&EdgeMaterial) -> f64| {
                    let mut ids = ids;
                    ids.sort_unstable();
                    ids.iter().map(|id| value(&of(*id))).sum::<f64>() / 4.0
                };
                let single = claimed.or(Some(ids[0]).filter(|id| ids == [*id; 4]));
                let averaged = || EdgeMaterial {
                    eps_r: mean(|e| e.eps_r),
                    sigma: mean(|e| e.sigma),
                    dispersive: None,
                    quarters: None,
                };
                edges.insert(node, single.map_or_else(averaged, of));
            }
            edges
        });
        Self { solid, edges }
    }
}

fn others(axis: usize) -> [usize; 2] {
    [[1, 2], [0, 2], [0, 1]][axis]
}

/// Two plain materials, a dispersive one and a conductor: 2 to 5.
fn stuffs(model: &mut Model) {
    model.add_material(Material::dielectric("stone", 6.0, 0.01));
    model.add_material(Material::dielectric("sand", 3.0, 0.0));
    let pole = DebyePole { delta_eps: 2.0, tau: 1e-11 };
    model.add_material(Material { poles: vec![pole], averagable: false, ..Material::dielectric("wet", 4.0, 0.0) });
    model.add_material(Material { id: "rail".into(), ..Material::pec() });
}

proptest! {
    /// Cells painted one after the other over the whole grid, each with its own claim and edges that remember the last
    /// claimant, hold the same: no matter how the grid is cut into chunks of planes, and by how many threads.
    #[test]
    fn chunks_of_planes_change_nothing(
        boxes in prop::collection::vec((prop::array::uniform6(0..30usize), 1..6u16, any::<bool>()), 1..9),
        threads in 1..5usize,
    ) {
        let mut model = block([30, 5, 6]);
        stuffs(&mut model);
        for (nodes, material, averaging) in &boxes {
            let corner = |from: usize| [0, 1, 2].map(|axis| (nodes[from + axis] % (model.grid.cells[axis] + 1)) as f64 * 0.002);
            let (a, b) = (corner(0), corner(3));
            let lower = std::array::from_fn(|axis: usize| a[axis].min(b[axis]));
            let upper = std::array::from_fn(|axis: usize| a[axis].max(b[axis]));
            model.objects.push(Object::Box { lower, upper, material: MaterialId(*material), averaging: *averaging });
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let Ok(painted) = pool.install(|| paint3(&model)) else { return Ok(()) };
        prop_assert_eq!(&painted, &paint3(&model).unwrap());
        let naive = Naive::new(&model);
        prop_assert_eq!(&painted.solid, &naive.solid);
        for axis in 0..3 {
            for (node, expected) in &naive.edges[axis] {
                prop_assert_eq!(painted.edge(axis, *node), expected, "axis {}, node {:?}", axis, node);
            }
        }
    }

    /// A box painted as a box and as voxels yields the same edges.
    #[test]
    fn voxels_and_boxes_agree(i0 in 0usize..5, j0 in 0usize..5, wide in 1usize..5, high in 1usize..5, averaging: bool) {
        let mut with_box = plane(9, 9);
        let stone = with_box.add_material(Material::dielectric("stone", 6.0, 0.01));
        let mut with_voxels = with_box.clone();
        with_box.objects.push(cuboid([i0, j0, i0 + wide, j0 + high], stone, averaging));
        let origin = [i0 as f64 * 0.002, j0 as f64 * 0.002, 0.0];
        let cells = vec![Some(stone); wide * high].into();
        with_voxels.objects.push(Object::Voxels(Voxels { origin, shape: [wide, high, 1], cells, averaging, edges: None }));
        prop_assert_eq!(paint(&with_box).unwrap(), paint(&with_voxels).unwrap());
    }

    /// A model of one layer has the same cells and z edges in both ways of painting.
    #[test]
    fn a_plane_is_painted_alike_in_both_ways(
        objects in prop::collection::vec((0..3usize, prop::array::uniform4(0.0..0.04f64), 2..6u16, any::<bool>()), 1..6),
    ) {
        let mut model = block([17, 13, 1]);
        stuffs(&mut model);
        for (kind, [x, y, a, b], material, averaging) in objects {
            let (material, reach) = (MaterialId(material), [x + 0.003 + a, y + 0.003 + b, 0.002]);
            model.objects.push(match kind {
                0 => Object::Box { lower: [x.min(0.03), y.min(0.02), 0.0], upper: reach, material, averaging },
                _ => {
                    let (start, end) = ([x.min(0.03), y.min(0.02), 0.0], [x.min(0.03), y.min(0.02), 0.002]);
                    Object::Cylinder { start, end, radius: 0.002 + a / 4.0, material, averaging }
                }
            });
        }
        let (plane, layer) = (paint(&model).unwrap(), paint3(&model).unwrap());
        prop_assert_eq!((&plane.solid, plane.averaged_edges), (&layer.solid, layer.averaged_edges[2]));
        for i in 0..=17 {
            for j in 0..=13 {
                prop_assert_eq!(plane.edge(i, j), layer.edge(2, [i, j, 0]));
            }
        }
    }
}

/// An edge takes the material of its own axis, whoever of the cells around it claims it; gprMax's `/ID` of the same scene holds
/// 48 edges of each of the three and 36 faces.
#[test]
fn edges_of_a_directional_material_take_that_of_their_axis() {
    let grid = Grid { cells: [10, 10, 10], spacing: [0.004; 3] };
    let mut model = Model::new("", grid, TimeWindow::Iterations(1));
    let values = [(4.0, 1.0), (6.0, 1.5), (9.0, 2.0)];
    let along = values.map(|(eps_r, mu_r)| {
        model.add_material(Material { mu_r, ..Material::dielectric(format!("m{eps_r}"), eps_r, 0.0) })
    });
    let material = model.add_directional(along);
    assert_eq!(model.add_directional(along), material);
    assert!((model.materials[material.index()].eps_r - 19.0 / 3.0).abs() < 1e-14);
    let (lower, upper) = ([0.012; 3], [0.024; 3]);
    model.objects.push(Object::Box { lower, upper, material, averaging: false });
    let painted = paint3(&model).unwrap();
    for (axis, (eps_r, mu_r)) in values.into_iter().enumerate() {
        let edges = painted.edges[axis].to_vec().into_iter().map(|entry| painted.palette[entry as usize]);
        let others: Vec<_> = edges.filter(|edge| edge.eps_r != 1.0).collect();
        assert!(others.len() == 48 && others.iter().all(|edge| edge.eps_r == eps_r), "{axis}: {others:?}");
        let faces = painted.faces[axis].to_vec().into_iter().map(|entry| painted.face_palette[entry as usize]);
        let others = faces.filter(|face| face.mu_r == mu_r && mu_r != 1.0).count();
        assert_eq!(others, if mu_r == 1.0 { 0 } else { 36 });
    }
}
