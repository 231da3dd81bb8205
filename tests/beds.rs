//! Beds of spheres on their way to the radar: models in space, sections, and what is refused.

use std::path::Path;

use ballast_gpr::geometry::ball_box_volume;
use ballast_gpr::gprmax::{self, InputOptions};
use ballast_gpr::model::{Averaging, Axis, MaterialId, Object, paint3};
use ballast_gpr::packing::{SphereBed, export};
use ballast_gpr::raster::{Placement, build_model};
use ballast_gpr::scene::{Dimension, FoulingSpec, PackingMethod, Scene, SceneSpec, Smoothing, resolve};
use ballast_gpr::units::{Metres, Seconds, Share};

/// A tank of 30 x 25 x 25 cm with loose spheres, cells of 5 mm, walls and base of two cells.
fn small() -> SceneSpec {
    let mut spec = SceneSpec::preset("tank").unwrap();
    spec.packing.method = PackingMethod::RandomAddition;
    (spec.tank.width, spec.tank.depth, spec.tank.height) = (Metres(0.30), Some(Metres(0.25)), Metres(0.25));
    (spec.tank.wall, spec.tank.base, spec.tank.margin) = (Metres(0.01), Metres(0.01), Metres(0.02));
    spec.antenna.height = Metres(0.10);
    spec.grid.cell = Metres(0.005);
    spec.grid.time_window = Seconds(8e-9);
    spec.grid.dimension = Dimension::Three;
    spec.grid.smoothing = Smoothing::Shapes;
    spec
}

fn bed(scene: &Scene) -> &SphereBed {
    scene.spheres.as_ref().unwrap()
}

/// Every stone is a ball where it lies, the box has walls all round, the dipole lies across, half a cell before the middle.
#[test]
fn a_model_in_space_holds_the_bed() {
    let scene = resolve(&small()).unwrap();
    let model = build_model(&scene).unwrap();
    let placement = Placement::of(&scene.spec);
    assert_eq!(model.averaging, Averaging::Shapes);
    // 10 absorbing cells and 4 of margin at each side, two cells of wall; the plate needs four below, and none absorbing.
    assert_eq!(model.grid.cells, [28 + 64, 4 + 2 + 50 + 20 + 14, 28 + 54]);
    assert_eq!(model.pml_cells, Some([10, 0, 10, 10, 10, 10]));
    let balls: Vec<_> = model
        .objects
        .iter()
        .filter_map(|object| match object {
            Object::Sphere { centre, radius, .. } => Some((*centre, *radius)),
            _ => None,
        })
        .collect();
    assert_eq!(balls.len(), bed(&scene).count());
    let [left, floor] = placement.bed_origin;
    for ((centre, radius), sphere) in balls.iter().zip(&bed(&scene).spheres) {
        let [x, y, z] = sphere.centre;
        assert_eq!((*centre, *radius), ([left + x, floor + z, placement.front + y], sphere.radius));
    }
    let boxes = model.objects.iter().filter(|object| matches!(object, Object::Box { .. })).count();
    assert_eq!(boxes, 1 + 1 + 4, "plate, base, four walls");
    let source = &model.sources[0];
    assert_eq!(source.position()[2], placement.front + 0.125 - 0.0025);
    let ballast_gpr::model::Source::HertzianDipole(dipole) = source else { panic!("{source:?}") };
    assert_eq!(dipole.polarisation, Axis::Z);
}

/// Cells of stone: as many as the balls' volume, to 1 %. By gprMax's rule centres snap to nodes, so balls of like size meet
/// the cells alike and their errors of counting (about 1 % of a ball 9 cells across) do not average out wholly.
#[test]
fn the_cells_hold_as_much_stone_as_the_bed() {
    let scene = resolve(&small()).unwrap();
    let model = build_model(&scene).unwrap();
    let painted = paint3(&model).unwrap();
    let stone = model.material_named("limestone").unwrap();
    let cells = painted.solid.iter().filter(|id| **id == stone).count();
    let volume = cells as f64 * 0.005_f64.powi(3);
    let exact = bed(&scene).solid_volume();
    assert!((volume / exact - 1.0).abs() < 1e-2, "{volume} {exact}");
}

/// A gprMax input with all spheres reads back to the same objects, materials, source and boundary.
#[test]
fn the_gprmax_input_of_a_bed_reads_back() {
    let mut spec = small();
    spec.grid.smoothing = Smoothing::Edges;
    spec.fouling = Some(FoulingSpec::of("10cm".parse().unwrap()));
    let scene = resolve(&spec).unwrap();
    let model = build_model(&scene).unwrap();
    let folder = tempfile::tempdir().unwrap();
    gprmax::write_input(&model, folder.path(), "model", &InputOptions { template: None }).unwrap();
    let read = gprmax::read_input(&folder.path().join("model.in")).unwrap().model;
    assert_eq!(read.objects, model.objects);
    assert_eq!((read.grid, read.pml_cells), (model.grid, model.pml_cells));
    assert_eq!(read.materials.len(), model.materials.len());
    assert_eq!(read.sources, model.sources);
}

/// With fines up to 10 cm the zone of a stone is that of its centre, and what lies between the stones is theirs: their
/// volume in the report is floor times height less the stones, from the exact volumes of balls in boxes.
#[test]
fn fouling_fills_the_voids_of_the_bed() {
    let mut spec = small();
    spec.fouling = Some(FoulingSpec::of("10cm".parse().unwrap()));
    let scene = resolve(&spec).unwrap();
    let below: f64 = bed(&scene)
        .spheres
        .iter()
        .map(|s| {
            let low = [-1.0, -1.0, -s.centre[2]];
            ball_box_volume(s.radius, low, [1.0, 1.0, 0.1 - s.centre[2]])
        })
        .sum();
    let fines = 0.3 * 0.25 * 0.1 - below;
    let voids = 0.3 * 0.25 * 0.25 - bed(&scene).solid_volume();
    let report = scene.fouling.as_ref().unwrap().of_packing.as_ref().unwrap();
    assert!((report.percentage_void_contamination / (100.0 * fines / voids) - 1.0).abs() < 0.05, "{report:?}");
    let model = build_model(&scene).unwrap();
    let filled = model.objects.iter().any(|object| {
        matches!(object, Object::Box { material, .. } if *material != MaterialId::PEC && model.materials[material.index()].id.contains("silt"))
    });
    assert!(filled);
}

/// The same bed in two dimensions is the section through it: 2-D model, discs of the cut, at the place asked for.
#[test]
fn in_a_plane_the_scene_is_a_section() {
    let mut spec = small();
    spec.grid.dimension = Dimension::Two;
    let middle = resolve(&spec).unwrap();
    let cut = bed(&middle).slice(ballast_gpr::packing::SlicePlane::Y(Metres(0.125))).unwrap();
    assert_eq!(middle.packing.as_ref(), Some(&cut));
    assert_eq!(build_model(&middle).unwrap().grid.cells[2], 1);
    spec.packing.slice = Some(Metres(0.05));
    let aside = resolve(&spec).unwrap();
    assert_ne!(aside.discs(), middle.discs());
    assert_eq!(aside.spheres, middle.spheres);
    let text = aside.spec.to_toml().unwrap();
    let again = resolve(&SceneSpec::from_toml(&text, Path::new("scene.toml")).unwrap()).unwrap();
    assert_eq!((again.spec, again.packing, again.spheres), (aside.spec, aside.packing, aside.spheres));
}

/// A bed that was written is the bed of a scene that names its file.
#[test]
fn a_kept_bed_is_read() {
    let scene = resolve(&small()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in
        [("bed.json", export::spheres_json(bed(&scene)).unwrap()), ("bed.csv", export::spheres_csv(bed(&scene)))]
    {
        let file = folder.path().join(name);
        std::fs::write(&file, text).unwrap();
        let mut spec = small();
        (spec.packing.method, spec.packing.file) = (PackingMethod::File, Some(file));
        assert_eq!(resolve(&spec).unwrap().spheres, scene.spheres, "{name}");
        spec.tank.depth = Some(Metres(0.3));
        assert_eq!(
            resolve(&spec).unwrap_err().to_string(),
            "the bed is 0.3 m long and 0.25 m deep, the tank 0.3 m and 0.3 m\n\nhint: write `width = \"0.3 m\"` and `depth = \"0.25 m\"` under `[tank]`"
        );
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let refused = |change: &dyn Fn(&mut SceneSpec)| {
        let mut spec = small();
        change(&mut spec);
        resolve(&spec).unwrap_err().to_string()
    };
    assert_eq!(
        refused(&|spec| spec.packing.method = PackingMethod::Rsa),
        "the packing `rsa` is one of discs, and space has three dimensions\n\nhint: `--dimension 2`, or spheres: `--method dem` or `--method random-addition`"
    );
    assert_eq!(
        refused(&|spec| spec.packing.slice = Some(Metres(0.4))),
        "`packing.slice` is 0.4 m, but must be within the tank (0 m to 0.25 m)\n\nhint: leave it out for the middle"
    );
    assert!(refused(&|spec| spec.packing.solid_share = Some(Share(0.6))).starts_with("no room is left for stone "));
    assert!(refused(&|spec| spec.tank.depth = Some(Metres(0.05))).starts_with("stone larger than the box"));
    let error = SceneSpec::from_toml("[grid]\ndimension = 4\n", Path::new("mine.toml")).unwrap_err().to_string();
    assert!(error.contains("4 is no dimension of a model") && error.contains("`dimension = 3`"), "{error}");
}

/// An embedded piece has no walls: base plate and mixture reach from boundary to boundary, the piece's voids are cut out of
/// them as a box of air, and the balls follow.
#[test]
fn an_embedded_piece_has_no_sides() {
    let mut spec = small();
    (spec.tank.wall, spec.tank.embedded) = (Metres(0.0), true);
    let scene = resolve(&spec).unwrap();
    let model = build_model(&scene).unwrap();
    let painted = paint3(&model).unwrap();
    let [_, ny, nz] = painted.cells;
    let at = |i: usize, j: usize, k: usize| model.materials[painted.solid[(i * ny + j) * nz + k].index()].id.as_str();
    // Four cells of plate, two of base, fifty of bed; above it air.
    for (j, name) in [(3, "pec"), (4, "methacrylate"), (6, "clean_ballast"), (55, "clean_ballast"), (56, "free_space")]
    {
        assert_eq!(at(0, j, nz / 2), name);
        assert_eq!(at(painted.cells[0] / 2, j, 0), name);
    }
    let names = |k: usize| (14..74).flat_map(move |i| (6..56).map(move |j| (i, j, k)));
    let mixture = names(nz / 2).filter(|(i, j, k)| at(*i, *j, *k) == "clean_ballast").count();
    assert_eq!(mixture, 0, "no mixture within the piece");
    spec.tank.wall = Metres(0.01);
    assert_eq!(
        resolve(&spec).unwrap_err().to_string(),
        "`tank.wall` is 0.01 m, but must be 0 m where `embedded = true`\n\nhint: `wall = \"0 m\"` under `[tank]`"
    );
}
