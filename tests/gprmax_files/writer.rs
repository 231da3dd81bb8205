//! Writing input files.

use std::sync::Arc;

use ballast_gpr::gprmax::{InputOptions, Note, input_files, read_input, read_model, write_input};
use ballast_gpr::model::{
    Axis, DebyePole, Excitation, GeometryFile, Grid, HertzianDipole, MagneticDipole, Material, MaterialId, Model,
    Object, Receiver, Source, TimeWindow, VoltageSource, Voxels, Waveform, WaveformKind,
};
use proptest::prelude::*;

use crate::common::reference_case;

fn small_model() -> Model {
    let grid = Grid { cells: [100, 60, 1], spacing: [0.002, 0.002, 0.004] };
    let mut model = Model::new("two stones in wet fines", grid, TimeWindow::Seconds(4e-9));
    let stone = model.add_material(Material::dielectric("stone", 6.0, 0.001));
    let poles = vec![DebyePole { delta_eps: 75.2, tau: 9.231e-12 }];
    let fines =
        model.add_material(Material { poles, averagable: false, ..Material::dielectric("wet_fines", 4.9, 0.005) });
    model.waveforms.push(Waveform { id: "w".into(), kind: WaveformKind::Ricker, amplitude: 1.0, frequency: 1e9 });
    model.objects = vec![
        Object::Box { lower: [0.0; 3], upper: [0.2, 0.06, 0.004], material: fines, averaging: true },
        Object::Cylinder {
            start: [0.1013, 0.03, 0.0],
            end: [0.1013, 0.03, 0.004],
            radius: 0.02,
            material: stone,
            averaging: false,
        },
        Object::Voxels(Voxels {
            origin: [0.02, 0.08, 0.0],
            shape: [2, 2, 1],
            cells: Arc::from([Some(stone), None, Some(MaterialId::PEC), Some(fines)]),
            averaging: true,
            edges: None,
        }),
    ];
    let excitation = Excitation { start: 0.0, stop: None };
    model.sources = vec![Source::HertzianDipole(HertzianDipole {
        polarisation: Axis::Z,
        position: [0.05, 0.1, 0.0],
        waveform: 0,
        excitation,
    })];
    model.receivers = vec![
        Receiver { position: [0.15, 0.1, 0.0], name: None },
        Receiver { position: [0.16, 0.1, 0.0], name: Some("right".into()) },
    ];
    model
}

fn written(model: &Model, options: &InputOptions) -> (String, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let paths = write_input(model, folder.path(), "bed", options).unwrap();
    let names = paths.iter().map(|path| path.file_name().unwrap().to_string_lossy().into_owned()).collect();
    (std::fs::read_to_string(&paths[0]).unwrap(), names)
}

#[test]
fn a_small_model_is_laid_out_for_people_too() {
    let (text, names) = written(&small_model(), &InputOptions::default());
    // The version in the first line is that of the package.
    let text = text.replace(env!("CARGO_PKG_VERSION"), "0.1.0");
    assert_eq!(names, ["bed.in", "bed_geometry.h5", "bed_materials.json"]);
    insta::assert_snapshot!(text, @r"
    ## written by ballast-gpr 0.1.0
    #title: two stones in wet fines
    #domain: 0.2 0.12 0.004
    #dx_dy_dz: 0.002 0.002 0.004
    #time_window: 4e-9

    #material: 6 0.001 1 0 stone
    #material: 4.9 0.005 1 0 wet_fines
    #add_dispersion_debye: 1 75.2 9.231e-12 wet_fines
    #waveform: ricker 1 1e9 w
    #hertzian_dipole: z 0.05 0.1 0 w
    #rx: 0.15 0.1 0
    #rx: 0.16 0.1 0 right Ex Ey Ez Hx Hy Hz

    #box: 0 0 0 0.2 0.06 0.004 wet_fines y
    #cylinder: 0.1013 0.03 0 0.1013 0.03 0.004 0.02 stone n
    #geometry_objects_read: 0.02 0.08 0 bed_geometry.h5 bed_materials y
    ");
    let mut model = small_model();
    model.objects.truncate(1);
    model.pml_cells = Some([8, 8, 0, 8, 8, 0]);
    model.threads = Some(2);
    model.stability_factor = 0.99;
    model.time_window = TimeWindow::Iterations(500);
    let Source::HertzianDipole(dipole) = &mut model.sources[0] else { panic!("a current") };
    dipole.excitation = Excitation { start: 1e-10, stop: Some(2e-9) };
    let (text, names) = written(&model, &InputOptions::default());
    let text = text.replace(env!("CARGO_PKG_VERSION"), "0.1.0");
    assert_eq!(names, ["bed.in"]);
    insta::assert_snapshot!(text, @r"
    ## written by ballast-gpr 0.1.0
    #title: two stones in wet fines
    #domain: 0.2 0.12 0.004
    #dx_dy_dz: 0.002 0.002 0.004
    #time_window: 500
    #time_step_stability_factor: 0.99
    #pml_cells: 8 8 0 8 8 0
    #omp_threads: 2

    #material: 6 0.001 1 0 stone
    #material: 4.9 0.005 1 0 wet_fines
    #add_dispersion_debye: 1 75.2 9.231e-12 wet_fines
    #waveform: ricker 1 1e9 w
    #hertzian_dipole: z 0.05 0.1 0 w 1e-10 2e-9
    #rx: 0.15 0.1 0
    #rx: 0.16 0.1 0 right Ex Ey Ez Hx Hy Hz

    #box: 0 0 0 0.2 0.06 0.004 wet_fines y
    ");
}

#[test]
fn a_template_of_the_user_takes_the_place_of_the_built_in_one() {
    let options = |text: &str| InputOptions { template: Some(("mine.in".into(), text.into())) };
    let (text, _) = written(
        &small_model(),
        &options(
            "#title: mine, {{ materials | length }} materials, {{ cells[0] }} cells\n{% for o in objects %}{{ o }}\n{% endfor %}",
        ),
    );
    assert!(
        text.starts_with("#title: mine, 2 materials, 100 cells\n#box: 0 0 0 0.2 0.06 0.004 wet_fines y\n"),
        "{text}"
    );
    let folder = tempfile::tempdir().unwrap();
    let message =
        write_input(&small_model(), folder.path(), "bed", &options("#title: x\n{{ tite }}")).unwrap_err().to_string();
    assert_eq!(message, "the template `mine.in` could not be filled in: undefined value in line 2: {{ tite }}");
    assert_eq!(
        std::fs::read_dir(folder.path()).unwrap().filter(|e| e.as_ref().unwrap().file_name() == "bed.in").count(),
        0
    );
}

#[test]
fn what_gprmax_would_refuse_is_refused_here() {
    let folder = tempfile::tempdir().unwrap();
    let message = |change: &dyn Fn(&mut Model)| {
        let mut model = small_model();
        change(&mut model);
        write_input(&model, folder.path(), "bed", &InputOptions::default()).unwrap_err().to_string()
    };
    assert_eq!(
        message(&|m| m.materials[2].id = "wet stone".into()),
        "gprMax does not take `wet stone` as the name of a material: it must not be empty, nor hold blanks or `+`"
    );
    assert_eq!(
        message(&|m| m.materials[2].eps_r = 0.8),
        "gprMax does not take 0.8 as the relative permittivity of `stone`: it must be finite and at least 1"
    );
    assert_eq!(
        message(&|m| m.receivers[1].name = Some("a b".into())),
        "gprMax does not take `a b` as the name of a receiver: it must not be empty, nor hold blanks"
    );
    assert_eq!(message(&|m| m.waveforms.clear()), "waveform number 0 of the model is not there");
    let dangling = |m: &mut Model| {
        m.objects[0] = Object::Box { lower: [0.0; 3], upper: [0.1; 3], material: MaterialId(9), averaging: true }
    };
    assert_eq!(message(&dangling), "material number 9 of the model is not there");
}

/// What a model means once painted: materials by value, without those that nothing uses, and with the flags that decide.
#[derive(Debug, PartialEq)]
struct Meaning {
    head: String,
    objects: Vec<String>,
}

fn meaning(model: &Model) -> Meaning {
    let end = match model.time_window {
        TimeWindow::Seconds(seconds) => seconds,
        TimeWindow::Iterations(count) => count as f64 * model.time_step(),
    };
    let value = |id: MaterialId, in_voxels: bool| {
        let mut material = model.materials[id.index()].clone();
        // gprMax renames a material of a database that differs from one of the same name in the input file.
        material.id.truncate(material.id.find('{').unwrap_or(material.id.len()));
        material.averagable &= in_voxels;
        format!("{material:?}")
    };
    let averaged = |id: MaterialId, averaging: bool| {
        let material = &model.materials[id.index()];
        averaging && material.averagable && !material.is_pec() && !material.is_dispersive()
    };
    let objects = model.objects.iter().filter_map(|object| match object {
        Object::Box { lower, upper, material, averaging } => {
            Some(format!("box {lower:?} {upper:?} {} {}", value(*material, false), averaged(*material, *averaging)))
        }
        Object::Cylinder { start, end, radius, material, averaging } => {
            let flag = averaged(*material, *averaging);
            Some(format!("cylinder {start:?} {end:?} {radius:?} {} {flag}", value(*material, false)))
        }
        Object::Sphere { centre, radius, material, averaging } => {
            let flag = averaged(*material, *averaging);
            Some(format!("sphere {centre:?} {radius:?} {} {flag}", value(*material, false)))
        }
        Object::Ellipsoid { .. }
        | Object::Cone { .. }
        | Object::Sector { .. }
        | Object::Triangle { .. }
        | Object::Plate { .. }
        | Object::Edge { .. }
        | Object::Fractal(_) => Some(format!("{object:?}")),
        Object::Voxels(block) => block.cells.iter().any(Option::is_some).then(|| {
            let cells: Vec<_> = block.cells.iter().map(|cell| cell.map(|id| value(id, true))).collect();
            format!("voxels {:?} {:?} {} {cells:?}", block.origin, block.shape, block.averaging)
        }),
    });
    let sources: Vec<_> = model
        .sources
        .iter()
        .map(|source| {
            let Excitation { start, stop } = source.excitation();
            let (stop, wave) = (stop.unwrap_or(end).min(end), &model.waveforms[source.waveform()]);
            let resistance = if let Source::VoltageSource(voltage) = source { Some(voltage.resistance) } else { None };
            let (axis, position) = (source.polarisation(), source.position());
            format!("{} {axis:?} {position:?} {resistance:?} {wave:?} {start:?} {stop:?}", source.kind())
        })
        .collect();
    Meaning {
        head: format!(
            "{:?} {:?} {:?} {:?} {:?} {:?} {sources:?} {:?} {:?} {:?}",
            model.title,
            model.grid,
            model.stability_factor,
            model.time_window,
            model.pml_cells,
            model.threads,
            model.receivers,
            model.source_steps,
            model.receiver_steps
        ),
        objects: objects.collect(),
    }
}

/// Pulses given as samples go into files beside the input file, and come back with the same bits.
#[test]
fn pulses_of_the_user_are_written_and_read_back() {
    let case = reference_case("excitation_file");
    let model = read_model(&case.join("scene.in")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let paths = write_input(&model, folder.path(), "model", &InputOptions::default()).unwrap();
    assert_eq!(paths.len(), 1 + 5);
    let again = read_model(&paths[0]).unwrap();
    assert_eq!(again, model);
    assert_eq!(input_files(&paths[0]).unwrap().len(), 1 + 5);
    let WaveformKind::User(chirp) = &model.waveforms[0].kind else { panic!("samples") };
    // One sample for each of 500 steps: 150 of the file, then zeros.
    assert_eq!((chirp.times().len(), chirp.times()[499], chirp.values()[150]), (500, 499.0 * model.time_step(), 0.0));
}

/// The reference cases say the same after reading, writing and reading again.
#[test]
fn reference_cases_survive_a_round_trip() {
    let folder = tempfile::tempdir().unwrap();
    for case in ["06_ballast_air_300", "09_debye_water_layer", "11_geometry_objects_read", "16_noncubic"] {
        let model = read_model(&reference_case(case).join("scene.in")).unwrap();
        // A stem that starts with a digit is no name for a database; the writer sees to that.
        let paths = write_input(&model, folder.path(), case, &InputOptions::default()).unwrap();
        assert_eq!(meaning(&read_model(&paths[0]).unwrap()), meaning(&model), "{case}");
    }
}

/// A request for a geometry file stays in the file, and a name that no command can hold is refused.
#[test]
fn requests_for_geometry_files_survive_a_round_trip() {
    let folder = tempfile::tempdir().unwrap();
    let asked = |file: &str| GeometryFile { lower: [0.02, 0.0, 0.0], upper: [0.2, 0.1, 0.004], file: file.into() };
    let mut model = small_model();
    model.geometry_files = vec![asked("out.h5"), asked("other")];
    let paths = write_input(&model, folder.path(), "bed", &InputOptions::default()).unwrap();
    assert_eq!(read_model(&paths[0]).unwrap().geometry_files, model.geometry_files);
    model.geometry_files[0].file = "two words".into();
    let error = write_input(&model, folder.path(), "bed", &InputOptions::default()).unwrap_err().to_string();
    assert!(error.starts_with("gprMax does not take `two words` as the name of a geometry file"), "{error}");
}

/// Snapshots at steps and at times, in both layouts.
#[test]
fn snapshots_survive_a_round_trip() {
    let folder = tempfile::tempdir().unwrap();
    for case in ["gprmax/snapshots_plane", "gprmax3d/snapshots_te", "gprmax3d/snapshots"] {
        let scene = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("validation").join(case).join("scene.in");
        let model = read_model(&scene).unwrap();
        assert!(model.snapshots.len() >= 3, "{case}");
        let paths = write_input(&model, folder.path(), "shots", &InputOptions::default()).unwrap();
        assert_eq!(read_model(&paths[0]).unwrap().snapshots, model.snapshots, "{case}");
    }
}

/// Every kind of object that fills cells or claims edges says the same after reading, writing and reading again.
#[test]
fn shapes_survive_a_round_trip() {
    let folder = tempfile::tempdir().unwrap();
    let validation = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("validation");
    for case in ["gprmax3d/shapes_solid", "gprmax3d/shapes_sheets", "gprmax/shapes_plane"] {
        let model = read_model(&validation.join(case).join("scene.in")).unwrap();
        assert!(model.objects.len() >= 8, "{case}");
        let paths = write_input(&model, folder.path(), "shapes", &InputOptions::default()).unwrap();
        assert_eq!(meaning(&read_model(&paths[0]).unwrap()), meaning(&model), "{case}");
        assert_eq!(read_model(&paths[0]).unwrap().objects, model.objects, "{case}");
    }
}

fn material(index: usize) -> impl Strategy<Value = Material> {
    let pole = (0.0..100.0f64, 1e-13..1e-9f64).prop_map(|(delta_eps, tau)| DebyePole { delta_eps, tau });
    let sigma = prop_oneof![4 => 0.0..1.0f64, 1 => Just(f64::INFINITY)];
    let poles = prop_oneof![2 => Just(vec![]), 1 => prop::collection::vec(pole, 1..3)];
    (1.0..81.0f64, sigma, 1.0..2.0f64, 0.0..1.0f64, poles, any::<bool>()).prop_map(
        move |(eps_r, sigma, mu_r, sigma_magnetic, poles, averagable)| {
            let poles = if sigma.is_infinite() { vec![] } else { poles };
            let averagable = averagable && sigma.is_finite() && poles.is_empty();
            let id = format!("m.{index}-é");
            Material {
                id,
                eps_r,
                sigma,
                mu_r,
                sigma_magnetic,
                poles,
                resonances: vec![],
                averagable,
                directional: None,
            }
        },
    )
}

fn object(materials: u16, spacing: [f64; 3], cells: (usize, usize)) -> impl Strategy<Value = Object> {
    let id = move || (0..materials).prop_map(MaterialId);
    let point = || prop::array::uniform3(0.0..0.2f64);
    let cuboid =
        (prop::array::uniform4(0.0..1.0f64), id(), any::<bool>()).prop_map(move |(share, material, averaging)| {
            // Inside the domain and at least one cell long, as gprMax demands.
            let extent = [cells.0 as f64 * spacing[0], cells.1 as f64 * spacing[1]];
            let lower = [0, 1].map(|axis| 0.5 * share[axis] * extent[axis]);
            let upper = [0, 1].map(|axis| lower[axis] + 1.01 * spacing[axis] + 0.4 * share[axis + 2] * extent[axis]);
            let (lower, upper) = ([lower[0], lower[1], 0.0], [upper[0], upper[1], spacing[2]]);
            Object::Box { lower, upper, material, averaging }
        });
    let cylinder =
        (point(), point(), 1e-6..0.1f64, id(), any::<bool>()).prop_map(|(start, end, radius, material, averaging)| {
            Object::Cylinder { start, end, radius, material, averaging }
        });
    let sphere = (point(), 1e-6..0.1f64, id(), any::<bool>())
        .prop_map(|(centre, radius, material, averaging)| Object::Sphere { centre, radius, material, averaging });
    let cells = (1usize..6, 1usize..6)
        .prop_flat_map(move |(nx, ny)| (Just([nx, ny, 1]), prop::collection::vec(prop::option::of(id()), nx * ny)));
    let voxels = (cells, any::<bool>(), 0..9u8).prop_map(move |((shape, cells), averaging, node)| {
        let origin = spacing.map(|size| f64::from(node) * size);
        Object::Voxels(Voxels { origin, shape, cells: Arc::from(cells), averaging, edges: None })
    });
    prop_oneof![cuboid, cylinder, sphere, voxels]
}

prop_compose! {
    fn any_model()(
        cells in (25..300usize, 25..300usize), spacing in prop::array::uniform3(1e-4..0.02f64), count in 0..5usize,
    )(
        materials in (0..count).map(material).collect::<Vec<_>>(),
        objects in prop::collection::vec(object(2 + count as u16, spacing, cells), 0..6),
        window in prop_oneof![(1e-12..1e-7f64).prop_map(TimeWindow::Seconds), (1..5000usize).prop_map(TimeWindow::Iterations)],
        pml in prop::option::of(prop::array::uniform4(0..12usize)), threads in prop::option::of(1..9usize), factor in 0.01..=1.0f64,
        wave in (proptest::sample::select(WaveformKind::ALL.to_vec()), -10.0..10.0f64, 1e8..5e9f64),
        at in (0.0..1.0f64, 0.0..1.0f64), start in prop_oneof![Just(0.0), 1e-13..1e-12f64], stop in prop::option::of(1e-11..1e-10f64),
        source in prop::option::of((any::<bool>(), prop_oneof![Just(0.0), 1e-3..1e4f64])),
        steps in prop::array::uniform2(prop_oneof![Just([0.0; 3]), prop::array::uniform3(-0.1..0.1f64)]),
        name in prop::option::of("[a-zA-Z0-9_.-]{1,8}"), title in "[ -~é]{0,20}",
        cells in Just(cells), spacing in Just(spacing),
    ) -> Model {
        let grid = Grid { cells: [cells.0, cells.1, 1], spacing };
        let mut model = Model::new(title.split_whitespace().collect::<Vec<_>>().join(" "), grid, window);
        model.materials.extend(materials);
        model.objects = objects;
        model.pml_cells = pml.map(|p| [p[0], p[1], 0, p[2], p[3], 0]);
        model.threads = threads;
        model.stability_factor = factor;
        let (kind, amplitude, frequency) = wave;
        model.waveforms.push(Waveform { id: "w1".into(), kind, amplitude, frequency });
        let position = [at.0 * cells.0 as f64 * spacing[0], at.1 * cells.1 as f64 * spacing[1], 0.0];
        let (polarisation, waveform, excitation) = (Axis::Z, 0, Excitation { start, stop });
        model.sources.push(match source {
            None => Source::HertzianDipole(HertzianDipole { polarisation, position, waveform, excitation }),
            Some((true, resistance)) => {
                Source::VoltageSource(VoltageSource { polarisation, position, resistance, waveform, excitation })
            }
            Some((false, _)) => {
                Source::MagneticDipole(MagneticDipole { polarisation: Axis::Y, position, waveform, excitation })
            }
        });
        model.receivers.push(Receiver { position, name });
        [model.source_steps, model.receiver_steps] = steps;
        model
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    /// A model that is written and read again paints the same cells and edges, bit for bit.
    #[test]
    fn a_written_model_reads_back_with_the_same_meaning(model in any_model()) {
        let folder = tempfile::tempdir().unwrap();
        let paths = write_input(&model, folder.path(), "model", &InputOptions::default()).unwrap();
        let input = read_input(&paths[0]).unwrap();
        prop_assert_eq!(meaning(&input.model), meaning(&model));
        let moves = |note: &&Note| !note.text.contains("second trace of a B-scan");
        let notes: Vec<_> = input.notes.iter().filter(moves).map(ToString::to_string).collect();
        prop_assert!(notes.is_empty(), "{:?}", notes);
    }
}
