//! `/ID`, `/rigidE` and `/rigidH` of geometry files against gprMax 4.0.1: the blocks of `validation/gprmax/geometry_edges_plane` and
//! `validation/gprmax3d/geometry_edges`. That files with them are read as gprMax reads them, the traces of these cases show
//! (`tests/gprmax_agreement.rs`, `tests/three_gprmax.rs`).

mod cli_support;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use ballast_gpr::gprmax::hdf5::H5File;
use ballast_gpr::gprmax::{geometry_files, read_model};
use ballast_gpr::model::{paint_finished, paint3};
use cli_support::Place;

fn cases() -> [PathBuf; 2] {
    let all = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation");
    ["gprmax/geometry_edges_plane", "gprmax3d/geometry_edges"].map(|case| all.join(case))
}

/// Names and values of the materials of a file, in the order of their indices.
fn materials(geometry: &Path) -> Vec<(String, [f64; 4])> {
    let database = fs::read_to_string(geometry.with_file_name("block_materials.json")).unwrap();
    let database: serde_json::Value = serde_json::from_str(&database).unwrap();
    let keys = H5File::open(geometry).unwrap().read_texts("/material_keys").unwrap();
    let material = |key: &String| {
        let entry = &database["materials"][key];
        let name = entry["metadata"]["original_id"].as_str().unwrap().to_owned();
        let names = [
            "relative_permittivity",
            "electric_conductivity_s_per_m",
            "relative_permeability",
            "magnetic_conductivity_s_per_m",
        ];
        let of = |name: &str| match &entry["base"][name] {
            serde_json::Value::Null => f64::NAN,
            value => value.as_f64().unwrap_or(f64::INFINITY),
        };
        (name, names.map(of))
    };
    keys.iter().map(material).collect()
}

/// What is written is what gprMax writes: materials of cells, claims, and what every edge and face is made of.
#[test]
fn geometry_files_hold_the_edges_of_gprmax() {
    for case in cases() {
        let model = read_model(&case.join("block.in")).unwrap();
        let place = tempfile::tempdir().unwrap();
        for (path, bytes) in geometry_files(&model, place.path()).unwrap() {
            fs::write(path, bytes).unwrap();
        }
        let paths = [place.path().join("block.h5"), case.join("block.h5")];
        let [ours, theirs] = paths.each_ref().map(|path| H5File::open(path).unwrap());
        assert_eq!(ours.children("/").unwrap(), theirs.children("/").unwrap());
        let [our_materials, their_materials] = paths.each_ref().map(|path| materials(path));
        assert_eq!(our_materials.len(), their_materials.len());
        for ((name, values), (their_name, their_values)) in our_materials.iter().zip(&their_materials) {
            assert_eq!(name, their_name);
            // Perfect conductors and free space are named, not described.
            let near = |(a, b): (&f64, &f64)| a.is_nan() || a == b || (a / b - 1.0).abs() < 1e-14;
            assert!(values.iter().zip(their_values).all(near), "{name}: {values:?}, {their_values:?}");
        }
        for dataset in ["/data", "/rigidE", "/rigidH", "/ID"] {
            assert_eq!(ours.shape(dataset).unwrap(), theirs.shape(dataset).unwrap(), "{dataset}");
            let [a, b] = [&ours, &theirs].map(|file| file.read_i64(dataset).unwrap());
            let differ = a.iter().zip(&b).filter(|(a, b)| a != b).count();
            assert_eq!(differ, 0, "{dataset} of {}: of {}", case.display(), a.len());
            assert!(b.iter().any(|value| *value != b[0]), "{dataset} is all the same");
        }
    }
}

/// A painting edge by edge says of every edge and face what the painting for the solver says.
#[test]
fn both_paintings_agree() {
    for case in cases() {
        for file in ["scene.in", "block.in"] {
            let model = read_model(&case.join(file)).unwrap();
            let (finished, painted) = (paint_finished(&model).unwrap(), paint3(&model).unwrap());
            assert_eq!(finished.solid, painted.solid);
            let [nx, ny, nz] = model.grid.cells;
            // Entries of the one list and of the other go together: no part with two materials but for walls and dead axes.
            let mut seen: BTreeMap<u32, f64> = BTreeMap::new();
            for axis in 0..3 {
                if model.invariant_axis().is_some_and(|invariant| invariant != axis) {
                    continue;
                }
                for node in (1..nx).flat_map(|i| (1..ny).map(move |j| [i, j, nz / 2])) {
                    let place = painted.node(node);
                    let edge = painted.edge(axis, node);
                    let value = edge.eps_r + if edge.sigma.is_finite() { 1e3 * edge.sigma } else { 1e9 };
                    assert_eq!(*seen.entry(finished.fields[axis][place]).or_insert(value), value, "{node:?}");
                }
            }
            assert!(seen.len() >= 5, "{file}");
        }
    }
}

/// What is read, painted and written again is the same.
#[test]
fn a_block_survives_writing_and_reading() {
    for case in cases() {
        let place = Place::new();
        for name in ["block.h5", "block_materials.json"] {
            fs::copy(case.join(name), place.path(name)).unwrap();
        }
        let text = fs::read_to_string(case.join("block.in")).unwrap();
        let head: String = text
            .lines()
            .filter(|line| !line.starts_with("#box") && !line.starts_with("#geometry"))
            .filter(|line| {
                !["#sphere", "#cylinder", "#plate", "#edge", "#material", "#add_disp"]
                    .iter()
                    .any(|c| line.starts_with(c))
            })
            .map(|line| format!("{line}\n"))
            .collect();
        let write = text.lines().find(|line| line.starts_with("#geometry_objects_write")).unwrap();
        let origin: Vec<&str> = write.split_whitespace().skip(1).take(3).collect();
        let read = format!("#geometry_objects_read: {} block.h5 block_materials\n", origin.join(" "));
        place.write("again.in", format!("{head}{read}{}\n", write.replace("block", "again")));
        let model = read_model(&place.path("again.in")).unwrap();
        for (path, bytes) in geometry_files(&model, &place.path("")).unwrap() {
            fs::write(path, bytes).unwrap();
        }
        let [ours, theirs] = ["again.h5", "block.h5"].map(|name| H5File::open(&place.path(name)).unwrap());
        for dataset in ["/rigidE", "/rigidH"] {
            assert_eq!(ours.read_i64(dataset).unwrap(), theirs.read_i64(dataset).unwrap(), "{dataset}");
        }
    }
}
