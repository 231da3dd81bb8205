//! Reading input files.

use std::path::Path;

use ballast_gpr::gprmax::{COMMANDS, CommandKind, Input, read_input, read_model};
use ballast_gpr::model::{Axis, DebyePole, MaterialId, Object, Source, TimeWindow, WaveformKind};
use proptest::prelude::*;

use crate::common::reference_case;

const HEAD: &str = "#domain: 0.4 0.3 0.002\n#dx_dy_dz: 0.002 0.002 0.002\n#time_window: 4e-9\n";

fn read(text: &str) -> Result<Input, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.in");
    std::fs::write(&path, text).unwrap();
    let shown = format!("`{}`", path.display());
    read_input(&path).map_err(|error| error.to_string().replace(&shown, "FILE"))
}

/// The error about one line behind a good head.
fn error(line: &str) -> String {
    read(&format!("{HEAD}{line}\n")).unwrap_err()
}

/// Cell counts and iterations that gprMax 4.0.1 itself records in its output of the same scene.
#[test]
fn grids_and_steps_of_the_reference_cases_are_those_of_gprmax() {
    for case in [
        "01_fs_dipole_2d",
        "03_halfspace_2d",
        "05_cylinder_2d",
        "06_ballast_air_300",
        "08_conductive_layer",
        "09_debye_water_layer",
        "11_geometry_objects_read",
        "11b_geometry_objects_read_noavg",
        "14a_avg_on",
        "14b_avg_off",
        "16_noncubic",
    ] {
        let folder = reference_case(case);
        let input = read_input(&folder.join("scene.in")).unwrap();
        assert_eq!(input.notes, [], "{case}");
        let recorded = ballast_gpr::gprmax::read_traces(&folder.join("out_f64.h5")).unwrap();
        assert_eq!(input.model.grid.cells, recorded.cells, "{case}");
        assert_eq!(input.model.time_step(), recorded.time_step.si(), "{case}");
        assert_eq!(input.model.iterations(), recorded.iterations, "{case}");
        assert_eq!(input.model.receivers.len(), recorded.receivers.len(), "{case}");
        assert_eq!(input.model.title, recorded.title, "{case}");
    }
}

#[test]
fn every_supported_command_lands_in_the_model() {
    let text = "## a scene\n\
        #title: sleepers: two\n#domain: 0.4 0.3 0.004\n#dx_dy_dz: 0.002 0.003 0.004\n#time_window: 300\n\
        #num_threads: 2\n#pml_cells: 8 9 0 10 11 0\n#time_step_stability_factor: 0.5\n\
        #box: 0 0 0 0.4 0.1 0.004 wet n\n#cylinder: 0.1013 0.2 0 0.1013 0.2 0.004 0.03 pec\n\
        #cylinder: 0.2 0.2 0 0.2 0.2 0.004 0.03 stone y left\n\
        #material: 6 0.001 1 0 stone\n#material: 3.5 0.02 1 0.5 wet\n#material: 1 inf 1 0 rail\n\
        #add_dispersion_debye: 2 6 9.23e-12 1.5 1e-10 wet\n\
        #hertzian_dipole: z 0.1 0.15 0 pulse 1e-10 2e-9\n#waveform: gaussiandotnorm 2 1.5e9 pulse\n\
        #rx: 0.2 0.15 0\n#rx: 0.3 0.15 0 right Ez\n\
        #output_dir: elsewhere\n #box: 0 0 0 1 1 1 stone\n#rx_steps: 0.02 0 0\n";
    let Input { model, notes } = read(text).unwrap();
    assert_eq!(model.title, "sleepers: two");
    assert_eq!((model.grid.cells, model.grid.spacing), ([200, 100, 1], [0.002, 0.003, 0.004]));
    assert_eq!(model.time_window, TimeWindow::Iterations(300));
    assert_eq!((model.threads, model.stability_factor), (Some(2), 0.5));
    assert_eq!(model.pml_cells, Some([8, 9, 0, 10, 11, 0]));
    let ids: Vec<_> = model.materials.iter().map(|m| m.id.as_str()).collect();
    assert_eq!(ids, ["pec", "free_space", "stone", "wet", "rail"]);
    assert_eq!(
        model.materials[3].poles,
        [(6.0, 9.23e-12), (1.5, 1e-10)].map(|(delta_eps, tau)| DebyePole { delta_eps, tau })
    );
    assert!(model.materials[2].averagable && !model.materials[3].averagable && model.materials[4].is_pec());
    assert_eq!(model.waveforms[0].kind, WaveformKind::GaussianDotNorm);
    let Source::HertzianDipole(dipole) = &model.sources[0] else { panic!("a current") };
    assert_eq!((dipole.polarisation, dipole.excitation.start, dipole.excitation.stop), (Axis::Z, 1e-10, Some(2e-9)));
    assert_eq!(model.receivers[1].name.as_deref(), Some("right"));
    // Objects keep the user's coordinates, in file order, whatever stands between them.
    assert_eq!(model.objects.len(), 3);
    assert!(matches!(model.objects[0], Object::Box { averaging: false, material: MaterialId(3), .. }));
    assert!(matches!(
        model.objects[1],
        Object::Cylinder { start: [0.1013, 0.2, 0.0], averaging: true, material: MaterialId::PEC, .. }
    ));
    assert!(matches!(model.objects[2], Object::Cylinder { averaging: true, material: MaterialId(2), .. }));
    assert_eq!((model.source_steps, model.receiver_steps), ([0.0; 3], [0.02, 0.0, 0.0]));
    let notes: Vec<_> = notes.iter().map(ToString::to_string).collect();
    assert_eq!(
        notes,
        [
            "line 19: `#rx` asks for Ez only: every component of the solver is given",
            "line 20: `#output_dir` is not acted upon: the output goes where the command line says",
            "line 21: ignored, as gprMax does: a command must start in the first column",
            "line 22: `#rx_steps` moves the receivers from the second trace of a B-scan on (`run --traces`)",
        ]
    );
}

/// A ball, and receivers on a lattice with a node at both corners, z fastest.
#[test]
fn three_dimensional_scenes_are_read() {
    let text = "#domain: 0.1 0.1 0.08\n#dx_dy_dz: 0.002 0.002 0.002\n#time_window: 300\n#material: 6 0.001 1 0 stone\n\
        #sphere: 0.0513 0.04 0.03 0.0123 stone n\n#src_steps: 0.01 0 0\n\
        #rx_array: 0.02 0.03 0.04 0.04 0.03 0.06 0.01 0 0.02\n";
    let model = read(text).unwrap().model;
    assert_eq!(model.grid.cells, [50, 50, 40]);
    let stone = MaterialId(2);
    let ball = Object::Sphere { centre: [0.0513, 0.04, 0.03], radius: 0.0123, material: stone, averaging: false };
    assert_eq!(model.objects, [ball]);
    let nodes: Vec<_> =
        model.receivers.iter().map(|r| [0, 1, 2].map(|axis| model.grid.node(axis, r.position[axis]))).collect();
    assert_eq!(nodes, [[10, 15, 20], [10, 15, 30], [15, 15, 20], [15, 15, 30], [20, 15, 20], [20, 15, 30]]);
    assert_eq!(model.source_steps, [0.01, 0.0, 0.0]);
}

/// In a grid along z voltages and currents are along z, magnetic dipoles across; a resistance stands before the pulse.
#[test]
fn voltages_and_magnetic_dipoles_are_read() {
    let text = "#domain: 0.1 0.1 0.002\n#dx_dy_dz: 0.002 0.002 0.002\n#time_window: 300\n#waveform: contsine 2 1e9 w\n\
        #magnetic_dipole: y 0.04 0.05 0 w\n#voltage_source: z 0.05 0.06 0 75 w 1e-10 2e-10\n#voltage_source: Z 0.06 0.06 0 0 w\n";
    let model = read(text).unwrap().model;
    assert!(!model.is_plane());
    let resistances: Vec<_> = model
        .sources
        .iter()
        .map(|source| if let Source::VoltageSource(voltage) = source { Some(voltage.resistance) } else { None })
        .collect();
    assert_eq!(resistances, [None, Some(75.0), Some(0.0)]);
    let axes: Vec<_> = model.sources.iter().map(Source::polarisation).collect();
    assert_eq!(axes, [Axis::Y, Axis::Z, Axis::Z]);
    assert_eq!(model.sources[0].position(), [0.04, 0.05, 0.0]);
    let excitation = model.sources[1].excitation();
    assert_eq!((excitation.start, excitation.stop), (1e-10, Some(2e-10)));
}

/// The voxels of case 11: -1 leaves a cell, 0 is stone, 1 is fines; counts by h5py.
#[test]
fn voxels_bring_their_materials() {
    let model = read_model(&reference_case("11_geometry_objects_read").join("scene.in")).unwrap();
    let [Object::Voxels(voxels)] = &model.objects[..] else { panic!("one block of voxels") };
    assert_eq!((voxels.shape, voxels.averaging), ([300, 250, 1], true));
    let ids: Vec<_> = model.materials.iter().map(|m| (m.id.as_str(), m.eps_r, m.sigma)).collect();
    assert_eq!(ids[2..], [("stone", 6.0, 0.001), ("fines", 4.0, 0.005)]);
    let count = |id: Option<MaterialId>| voxels.cells.iter().filter(|cell| **cell == id).count();
    let counts = [count(None), count(Some(MaterialId(2))), count(Some(MaterialId(3)))];
    assert_eq!(counts, [VOID_CELLS, STONE_CELLS, FINES_CELLS]);
    let model = read_model(&reference_case("11b_geometry_objects_read_noavg").join("scene.in")).unwrap();
    assert!(matches!(&model.objects[0], Object::Voxels(voxels) if !voxels.averaging));
}
const VOID_CELLS: usize = 31_500;
const STONE_CELLS: usize = 13_472;
const FINES_CELLS: usize = 30_028;

#[test]
fn errors_name_the_line_and_what_to_do() {
    assert_eq!(
        error("#cilinder: 1"),
        "FILE line 4: `#cilinder` is not a gprMax command\n\nhint: did you mean `#cylinder`?"
    );
    assert_eq!(
        error("#thin_wire: 0.1 0.1 0.1 0.05 0.05 0.05 0.001"),
        "FILE line 4: `#thin_wire` is not supported by the embedded solver\n\nhint: `--solver gprmax` runs the file in gprMax itself"
    );
    assert_eq!(error("#domain: 1 1 1"), "FILE line 4: `#domain` stands for the second time, first in line 1");
    assert_eq!(
        error("#pml_cells: 10"),
        "FILE line 4: 10 + 10 absorbing cells do not fit into the 1 along z\n\nhint: a two-dimensional model needs six values, for example `#pml_cells: 10 10 0 10 10 0`"
    );
    assert_eq!(
        error("#material: 6 0 1 0 stone\n#box: 0 0 0 0.4 0.1 0.002 stine"),
        "FILE line 5: the material `stine` is not defined\n\nhint: did you mean `stone`?"
    );
    assert_eq!(
        error("#material: 6 0 1 0 a\n#box: 0 0 0 0.4 0.1 0.002 a a pec"),
        "FILE line 5: a perfect conductor among three identifiers of `#box` is not supported by the embedded solver\n\nhint: `--solver gprmax` runs the file in gprMax itself"
    );
    assert_eq!(
        error("#material: 0.5 0 1 0 a"),
        "FILE line 4: the relative permittivity of `#material` is 0.5, it should be at least 1"
    );
    assert_eq!(
        error("#material: nan 0 1 0 a"),
        "FILE line 4: `nan` is not a number: `#material` wants a relative permittivity there"
    );
    assert_eq!(
        error("#material: 6 0 1 0"),
        "FILE line 4: `#material` has 4 parameters\n\nhint: `#material: EPS_R SIGMA MU_R SIGMA* ID`"
    );
    assert_eq!(error("#material: 6 0 1 0 pec"), "FILE line 4: the material `pec` is defined already");
    assert_eq!(error("#hertzian_dipole: z 0.1 0.1 0 w"), "FILE line 4: the waveform `w` is not defined");
    assert_eq!(
        error("#rx: 0.1 0.5 0"),
        "FILE line 4: the receiver at 0.1 0.5 0 m lies outside the domain of 0.4 x 0.3 x 0.002 m"
    );
    assert_eq!(
        error("#rx: 0.1 0.1 0 name"),
        "FILE line 4: `#rx` has 4 parameters\n\nhint: `#rx: X Y Z [NAME COMPONENT ...]`"
    );
    assert_eq!(
        error("#waveform: user 1 1e9 w"),
        "FILE line 4: `user` is not a waveform that the embedded solver knows, which `#waveform` wants there: one of ricker, gaussian, gaussiandot, gaussiandotnorm, gaussiandotdot, gaussiandotdotnorm, \
         gaussianprime, gaussiandoubleprime, gauspulse, sine, contsine, impulse"
    );
    assert_eq!(
        error("#dispersive_averaging: perhaps"),
        "FILE line 4: `perhaps` is not a flag, which `#dispersive_averaging` wants there: one of y, n"
    );
    assert_eq!(
        error("#box: 0.2 0 0 0.1 0.1 0.002 pec"),
        "FILE line 4: `#box` fills no cell along x: it reaches from 0.2 m to 0.1 m"
    );
    assert_eq!(
        error("#box: 0 0 0 0.1 0.1 0.001 pec"),
        "FILE line 4: `#box` fills no cell along z: it reaches from 0 m to 0.001 m"
    );
    assert_eq!(
        error("#box: 0 0 0 0.5 0.1 0.002 pec"),
        "FILE line 4: the corner of the box at 0.5 0.1 0.002 m lies outside the domain of 0.4 x 0.3 x 0.002 m"
    );
    assert_eq!(
        error("#waveform: ricker 1 1e9 w\n#hertzian_dipole: x 0.1 0.1 0 w"),
        "FILE line 5: a source along x in a model of one cell along z: it must point along z"
    );
    assert!(
        error("#geometry_objects_read: 0 0 0 none.h5 mats").contains("none.h5"),
        "{}",
        error("#geometry_objects_read: 0 0 0 none.h5 mats")
    );
    assert!(error("#geometry_objects_read: 0 0 0 none.h5 mats.txt").contains("convert-geometry"));
    assert_eq!(
        read("#domain: 1 1 1\n#dx_dy_dz: 0.01 0.01 0.01\n").unwrap_err(),
        "FILE has no `#time_window`\n\nhint: write for example `#time_window: 8e-9`"
    );
    assert_eq!(
        read("#domain: 1e9 1e9 0.002\n#dx_dy_dz: 0.002 0.002 0.002\n#time_window: 1e-9").unwrap_err(),
        "FILE line 1: a domain of 500000000000 x 500000000000 x 1 cells (2.5e23 in all) is beyond the limit of 4.3e9 cells\n\nhint: `#domain` and `#dx_dy_dz` are in metres"
    );
    assert!(
        read("#domain: 0.4 0.03 0.002\n#dx_dy_dz: 0.002 0.002 0.002\n#time_window: 1e-9")
            .unwrap_err()
            .contains("default of 10 absorbing cells")
    );
    assert!(
        read("#domain: 0.4 0.3 0.002\n#dx_dy_dz: 0.002 0.002 0.002\n#time_window: 1e9")
            .unwrap_err()
            .contains("at most 1e9")
    );
    assert!(read_model(Path::new("/nowhere/scene.in")).unwrap_err().to_string().contains("/nowhere/scene.in"));
}

/// Claims and edges that do not fit the cells of their file are refused.
#[test]
fn edges_that_do_not_fit_their_cells_are_refused() {
    use ballast_gpr::gprmax::hdf5::{Attribute, Data, Dataset, Group, write};
    let folder = tempfile::tempdir().unwrap();
    let dataset = |name: &str, data| Dataset {
        name: name.into(),
        shape: vec![1, 1, 1],
        data,
        compressed: false,
        attributes: vec![],
    };
    let keys = Dataset {
        name: "material_keys".into(),
        shape: vec![1],
        data: Data::Texts(vec!["a".into()]),
        compressed: false,
        attributes: vec![],
    };
    let mut datasets: Vec<_> = ["data", "ID", "rigidE", "rigidH"].map(|name| dataset(name, Data::I16(vec![0]))).into();
    datasets.push(keys);
    let group =
        Group { attributes: vec![("dx_dy_dz", Attribute::Floats(vec![0.002; 3]))], datasets, ..Group::default() };
    write(&folder.path().join("g.h5"), &group).unwrap();
    let path = folder.path().join("scene.in");
    std::fs::write(&path, format!("{HEAD}#geometry_objects_read: 0 0 0 g.h5 mats\n")).unwrap();
    let message = read_model(&path).unwrap_err().to_string();
    // One cell has twelve edges and six faces that it may claim.
    let wanted = "`/rigidE` in `";
    assert!(
        message.contains(wanted) && message.contains("has the shape [1, 1, 1], it should be [12, 1, 1, 1]"),
        "{message}"
    );
}

fn any_line() -> impl Strategy<Value = String> {
    let names: Vec<&'static str> = COMMANDS
        .iter()
        .filter(|(_, kind)| matches!(kind, CommandKind::Single | CommandKind::Multiple))
        .map(|(name, _)| *name)
        .collect();
    let word = prop_oneof![
        any::<f64>().prop_map(|v| format!("{v:e}")),
        (-2i64..400).prop_map(|v| v.to_string()),
        (0.0..0.5f64).prop_map(|v| format!("{v:.3}")),
        Just("stone".to_owned()),
        Just("pec".into()),
        Just("w".into()),
        Just("z".into()),
        Just("y".into()),
        Just("n".into()),
        Just("ricker".into()),
        Just("inf".into()),
        Just("g.h5".into()),
        "\\PC{0,6}",
    ];
    prop_oneof![
        4 => (proptest::sample::select(names), prop::collection::vec(word, 0..12)).prop_map(|(name, words)| format!("#{name}: {}", words.join(" "))),
        1 => "\\PC{0,30}",
        1 => "#\\PC{0,20}",
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Any lines behind a good head: an answer, never a panic.
    #[test]
    fn random_lines_never_panic(lines in prop::collection::vec(any_line(), 0..6), head in any::<bool>()) {
        let head = if head { format!("{HEAD}#material: 6 0 1 0 stone\n#waveform: ricker 1 1e9 w\n") } else { String::new() };
        let _ = read(&format!("{head}{}", lines.join("\n")));
    }

    /// Real files with bytes changed, taken out and put in: an answer, never a panic.
    #[test]
    fn mutated_files_never_panic(
        case in proptest::sample::select(vec!["05_cylinder_2d", "09_debye_water_layer", "14a_avg_on", "16_noncubic"]),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..3), 1..6),
    ) {
        let mut bytes = std::fs::read(reference_case(case).join("scene.in")).unwrap();
        for (place, byte, kind) in changes {
            let at = place.index(bytes.len());
            match kind {
                0 => bytes[at] = byte,
                1 => { bytes.remove(at); }
                _ => bytes.insert(at, byte),
            }
        }
        let _ = read(&String::from_utf8_lossy(&bytes));
    }
}

/// Shapes that cannot be. gprMax 4.0.1 was seen to refuse the negative thickness, the cone in a plane, and the plates and
/// edges with wrong or turned extents.
#[test]
fn shapes_that_cannot_be_are_refused_by_line() {
    for (line, said) in [
        ("#triangle: 0 0 0 0.1 0 0 0 0.1 0 -0.002 pec", "the thickness"),
        ("#triangle: 0 0 0 0.1 0.1 0.002 0 0.1 0 0 pec", "a triangle that lies across no axis"),
        ("#triangle: 0 0 0 0.1 0 0 0 9 0 0.002 pec", "corner of the triangle"),
        ("#ellipsoid: 0.1 0.1 0 0.1 0 0.1 pec", "a half-axis"),
        ("#cone: 0.1 0.1 0 0.1 0.1 0.002 0.1 0.05 pec", "a cone in two dimensions"),
        ("#cylindrical_sector: w 0.1 0.1 0 0.002 0.05 0 90 pec", "an axis"),
        ("#cylindrical_sector: z 0.1 0.1 0 0.002 0.05 360 90 pec", "the starting angle"),
        ("#cylindrical_sector: z 0.1 0.1 0 0.002 0 0 90 pec", "the radius"),
        ("#plate: 0.1 0.1 0 0.1 0.1 0.002 pec", "the number of axes along which it has no extent"),
        ("#plate: 0.1 0.1 0 0.2 0.2 0.002 pec", "the number of axes along which it has no extent"),
        ("#plate: 0.1 0.2 0 0.1 0.1 0.002 pec", "0.2 m"),
        ("#plate: 0.1 0.1 0 0.1 0.2 0.002 pec free_space pec", "parameters"),
        ("#box: 0.1 0.1 0 0.2 0.2 0.002 free_space free_space free_space tag", "one word behind three identifiers"),
        ("#magnetic_averaging: geometric", "harmonic, arithmetic"),
        ("#symmetry_boundary: x0 pmc", "a perfect magnetic conductor"),
        ("#symmetry_boundary: z0 pec", "along which nothing changes"),
        ("#symmetry_boundary: w0 pec", "x0, y0, z0, xmax, ymax, zmax"),
        ("#edge: 0.1 0.1 0 0.1 0.1 0 pec", "the number of axes along which it has an extent"),
        ("#edge: 0.1 0.1 0 0.2 0.2 0 pec", "the number of axes along which it has an extent"),
        ("#edge: 0.1 0.1 0 0.2 0.1 0 nothing", "nothing"),
        ("#edge: 0.1 0.1 0 0.2 0.1 pec", "parameters"),
    ] {
        let message = error(line);
        assert!(message.contains("line 4") && message.contains(said), "{line}: {message}");
    }
}
