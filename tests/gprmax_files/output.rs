//! Output files.

use std::path::{Path, PathBuf};

use ballast_gpr::gprmax::hdf5::{Attribute, Data, Dataset, Group, write};
use ballast_gpr::gprmax::{read_model, read_traces, write_traces};
use ballast_gpr::trace::Component;
use ballast_gpr::units::Metres;

use crate::common::reference_case;

/// Peaks printed by h5py for gprMax's own output of case 01: `Ez 1457.68, Hx 0.0940308, Hy 4.63821` and the rest zero.
#[test]
fn an_output_of_gprmax_4_is_read() {
    let traces = read_traces(&reference_case("01_fs_dipole_2d").join("out_f64.h5")).unwrap();
    assert_eq!((traces.title.as_str(), traces.solver.as_str()), ("01_fs_dipole_2d", "gprMax 4.0.1"));
    assert_eq!((traces.iterations, traces.cells, traces.double_precision), (849, [200, 200, 1], true));
    assert_eq!(traces.spacing, [Metres(0.002); 3]);
    let receiver = &traces.receivers[0];
    assert_eq!((receiver.name.as_str(), receiver.position), ("Rx(125,100,0)", [0.25, 0.2, 0.0].map(Metres)));
    assert_eq!(traces.receivers[1].position, [0.25, 0.25, 0.0].map(Metres));
    let peak = |component| receiver.component(component).unwrap().peak();
    for (component, printed) in [(Component::Ez, 1457.68), (Component::Hx, 0.0940308), (Component::Hy, 4.63821)] {
        // Six digits are printed, of the single-precision run; the two runs differ by 4e-6 at most.
        assert!((peak(component) / printed - 1.0).abs() < 1e-5, "{component:?} {}", peak(component));
    }
    assert_eq!(peak(Component::Ex), 0.0);
    let first = |component| receiver.component(component).unwrap().first_sample.si();
    assert_eq!((first(Component::Ez), first(Component::Hy)), (0.0, -2.358654336749684e-12));
}

/// What is written reads back to the same bits, whatever of it is stored.
#[test]
fn written_traces_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ours.h5");
    for case in ["01_fs_dipole_2d", "16_noncubic"] {
        let model = read_model(&reference_case(case).join("scene.in")).unwrap();
        let mut traces = read_traces(&reference_case(case).join("out_f64.h5")).unwrap();
        traces.solver = "ballast-gpr test".into();
        write_traces(&path, &traces, &model).unwrap();
        assert_eq!(read_traces(&path).unwrap(), traces);
        // Components that vanish by symmetry come back as zeros when a solver did not compute them.
        let mut computed = traces.clone();
        for receiver in &mut computed.receivers {
            receiver
                .components
                .retain(|trace| matches!(trace.component, Component::Ez | Component::Hx | Component::Hy));
        }
        write_traces(&path, &computed, &model).unwrap();
        assert_eq!(read_traces(&path).unwrap(), traces);
        // In single precision each sample is the nearest single.
        traces.double_precision = false;
        write_traces(&path, &traces, &model).unwrap();
        let single = read_traces(&path).unwrap();
        let (a, b) = (single.radar_trace().unwrap(), traces.radar_trace().unwrap());
        assert!(a.samples.iter().zip(&b.samples).all(|(a, b)| *a == f64::from(*b as f32)));
    }
}

#[test]
fn traces_of_another_model_are_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ours.h5");
    let model = read_model(&reference_case("16_noncubic").join("scene.in")).unwrap();
    let mut traces = read_traces(&reference_case("01_fs_dipole_2d").join("out_f64.h5")).unwrap();
    let message = write_traces(&path, &traces, &model).unwrap_err().to_string();
    assert_eq!(message, "the traces have 2 receivers, the model has 1");
    traces.receivers.pop();
    traces.receivers[0].components[2].samples.pop();
    let message = write_traces(&path, &traces, &model).unwrap_err().to_string();
    assert_eq!(message, "Ez of receiver `Rx(125,100,0)` has 848 samples, the run has 849");
    assert!(!path.exists());
}

fn ez(name: &str, shape: &[usize], samples: &[f32]) -> Dataset {
    Dataset {
        name: name.into(),
        shape: shape.into(),
        data: Data::F32(samples.into()),
        compressed: false,
        attributes: vec![],
    }
}

fn root(attributes: Vec<(&'static str, Attribute)>, receiver: Group) -> Group {
    let mut all = vec![
        ("Title", Attribute::Text("old".into())),
        ("Iterations", Attribute::Int(3)),
        ("dt", Attribute::Float(2e-12)),
    ];
    all.extend(attributes);
    Group {
        attributes: all,
        groups: vec![Group { name: "rxs".into(), groups: vec![receiver], ..Group::default() }],
        ..Group::default()
    }
}

fn place(folder: &Path, group: &Group) -> PathBuf {
    let path = folder.join("old.out");
    write(&path, group).unwrap();
    path
}

/// gprMax 3.1: attributes `dx_dy_dz` and `Position`, no time offsets; H lies half a step early.
#[test]
fn an_output_of_gprmax_3_1_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let receiver = Group {
        name: "rx1".into(),
        attributes: vec![
            ("Name", Attribute::Text("Rx(1,2,0)".into())),
            ("Position", Attribute::Floats(vec![0.002, 0.004, 0.0])),
        ],
        datasets: vec![ez("Ez", &[3], &[0.0, 1.0, -2.0]), ez("Hx", &[3], &[0.0, 0.5, 0.25])],
        groups: vec![],
    };
    let attributes = vec![
        ("gprMax", Attribute::Text("3.1.6".into())),
        ("dx_dy_dz", Attribute::Floats(vec![0.002; 3])),
        ("nx_ny_nz", Attribute::Ints(vec![750, 865, 1])),
    ];
    let traces = read_traces(&place(folder.path(), &root(attributes, receiver))).unwrap();
    assert_eq!((traces.solver.as_str(), traces.cells, traces.double_precision), ("gprMax 3.1.6", [750, 865, 1], false));
    let components = &traces.receivers[0].components;
    assert_eq!(components[0].samples, [0.0, 1.0, -2.0]);
    assert_eq!((components[0].first_sample.si(), components[1].first_sample.si()), (0.0, -1e-12));
}

/// Before 3.1: the attribute is called `dx, dy, dz`, the position is a dataset, version and cell counts are not recorded.
#[test]
fn an_output_of_gprmax_3_0_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let position = Dataset {
        name: "Position".into(),
        shape: vec![3],
        data: Data::F64(vec![0.1, 0.2, 0.3]),
        compressed: false,
        attributes: vec![],
    };
    let receiver =
        Group { name: "rx1".into(), datasets: vec![ez("Ey", &[3], &[1.0, 2.0, 3.0]), position], ..Group::default() };
    let attributes = vec![("dx, dy, dz", Attribute::Floats(vec![0.001; 3]))];
    let traces = read_traces(&place(folder.path(), &root(attributes, receiver))).unwrap();
    assert_eq!((traces.solver.as_str(), traces.cells), ("gprMax before 3.1", [0; 3]));
    assert_eq!((traces.receivers[0].name.as_str(), traces.receivers[0].position), ("rx1", [0.1, 0.2, 0.3].map(Metres)));
}

/// A merged file of gprMax 3: one receiver per column, moved by `rxsteps` cells each.
#[test]
fn a_merged_output_gives_a_receiver_per_trace() {
    let folder = tempfile::tempdir().unwrap();
    let receiver = Group {
        name: "rx1".into(),
        attributes: vec![("Name", Attribute::Text("Rx".into())), ("Position", Attribute::Floats(vec![0.5, 0.0, 0.0]))],
        datasets: vec![ez("Ez", &[3, 2], &[1.0, 10.0, 2.0, 20.0, 3.0, 30.0])],
        groups: vec![],
    };
    let attributes = vec![
        ("gprMax", Attribute::Text("3.1.7".into())),
        ("dx_dy_dz", Attribute::Floats(vec![0.25, 0.5, 0.5])),
        ("nx_ny_nz", Attribute::Ints(vec![9, 9, 1])),
        ("rxsteps", Attribute::Ints32(vec![2, 0, 0])),
    ];
    let traces = read_traces(&place(folder.path(), &root(attributes, receiver))).unwrap();
    let seen: Vec<_> = traces
        .receivers
        .iter()
        .map(|r| (r.name.as_str(), r.position[0].si(), r.components[0].samples.clone()))
        .collect();
    assert_eq!(seen, [("Rx trace 1", 0.5, vec![1.0, 2.0, 3.0]), ("Rx trace 2", 1.0, vec![10.0, 20.0, 30.0])]);
}

#[test]
fn what_is_missing_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let receiver = || Group { name: "rx1".into(), datasets: vec![ez("Ez", &[3], &[0.0; 3])], ..Group::default() };
    let message = |group: &Group| read_traces(&place(folder.path(), group)).unwrap_err().to_string();
    let of_version = |version: &str| {
        vec![
            ("gprMax", Attribute::Text(version.into())),
            ("dx_dy_dz", Attribute::Floats(vec![0.002; 3])),
            ("nx_ny_nz", Attribute::Ints(vec![2, 2, 1])),
        ]
    };
    let mut without_dt = root(of_version("4.0.1"), receiver());
    without_dt.attributes.retain(|(name, _)| *name != "dt");
    assert!(message(&without_dt).starts_with("attribute `dt` of `/` is missing in "), "{}", message(&without_dt));
    assert!(
        message(&root(of_version("4.0.1"), receiver())).starts_with("attribute `Name` of `/rxs/rx1` is missing in ")
    );
    assert!(
        message(&root(of_version("3.1.6"), receiver()))
            .starts_with("attribute `Position` of `/rxs/rx1` is missing in ")
    );
    assert!(message(&root(vec![], receiver())).starts_with("attribute `dx_dy_dz` of `/` is missing in "));
    let mut named = receiver();
    named.attributes = vec![("Name", Attribute::Text("a".into())), ("Position", Attribute::Floats(vec![0.0; 3]))];
    assert!(
        message(&root(of_version("4.0.1"), named.clone()))
            .starts_with("attribute `TimeSampleOffset` of `/rxs/rx1/Ez` is missing in ")
    );
    named.datasets = vec![ez("Ez", &[4], &[0.0; 4])];
    assert!(message(&root(of_version("3.1.6"), named)).contains("`/rxs/rx1/Ez`"));
    assert!(message(&Group::default()).contains("holds no receivers"));
}

/// Each byte of a small output file and of a small geometry file is turned over: an answer, never a panic.
#[test]
fn damaged_files_give_an_answer() {
    let folder = tempfile::tempdir().unwrap();
    let mut receiver = Group { name: "rx1".into(), ..Group::default() };
    receiver.attributes = vec![("Name", Attribute::Text("a".into())), ("Position", Attribute::Floats(vec![0.0; 3]))];
    receiver.datasets = vec![ez("Ez", &[3, 2], &[1.0; 6])];
    let attributes = vec![
        ("gprMax", Attribute::Text("3.1.7".into())),
        ("dx_dy_dz", Attribute::Floats(vec![0.25; 3])),
        ("nx_ny_nz", Attribute::Ints(vec![9, 9, 1])),
        ("rxsteps", Attribute::Ints32(vec![2, 0, 0])),
    ];
    let path = place(folder.path(), &root(attributes, receiver));
    read_traces(&path).unwrap();
    let scene = folder.path().join("scene.in");
    let text = "#domain: 0.08 0.08 0.002\n#dx_dy_dz: 0.002 0.002 0.002\n#time_window: 9\n#geometry_objects_read: 0 0 0 g.h5 m y\n";
    std::fs::write(&scene, text).unwrap();
    let database = std::fs::read_to_string(reference_case("11_geometry_objects_read").join("mats.json")).unwrap();
    std::fs::write(folder.path().join("m.json"), database).unwrap();
    let keys = Dataset {
        name: "material_keys".into(),
        shape: vec![2],
        data: Data::Texts(vec!["stone".into(), "fines".into()]),
        compressed: false,
        attributes: vec![],
    };
    let data = Dataset {
        name: "data".into(),
        shape: vec![3, 2, 1],
        data: Data::I16(vec![0, 1, -1, 0, 1, 1]),
        compressed: false,
        attributes: vec![],
    };
    let group = Group {
        attributes: vec![("dx_dy_dz", Attribute::Floats(vec![0.002; 3]))],
        datasets: vec![data, keys],
        ..Group::default()
    };
    let geometry = folder.path().join("g.h5");
    write(&geometry, &group).unwrap();
    read_model(&scene).unwrap();
    let mut refused = 0;
    for (file, read) in
        [(&path, &(|| read_traces(&path).is_err()) as &dyn Fn() -> bool), (&geometry, &|| read_model(&scene).is_err())]
    {
        let content = std::fs::read(file).unwrap();
        for position in 0..content.len() {
            let mut damaged = content.clone();
            damaged[position] ^= 0xff;
            std::fs::write(file, &damaged).unwrap();
            refused += usize::from(read());
        }
        std::fs::write(file, &content).unwrap();
    }
    assert!(refused > 500, "{refused}");
}
