//! The HDF5 border: what is written is read, and nothing that comes from outside can end the program.

use std::path::Path;

use ballast_gpr::gprmax::hdf5::{Attribute, Data, Dataset, Group, H5File, Hdf5Error, to_bytes, write};

use crate::common::reference_case;

fn dataset(name: &str, shape: &[usize], data: Data, compressed: bool) -> Dataset {
    Dataset { name: name.into(), shape: shape.into(), data, compressed, attributes: vec![] }
}

fn tree() -> Group {
    let floats: Vec<f64> = (0..60).map(|n| (n as f64 * 0.3).sin()).collect();
    let mut traces = dataset("Ez", &[20, 3], Data::F64(floats), false);
    traces.attributes.push(("TimeSampleOffset", Attribute::Float(-2.5e-12)));
    Group {
        name: String::new(),
        attributes: vec![
            ("Title", Attribute::Text("a ballast bed, 40 µm".into())),
            ("Iterations", Attribute::Int(20)),
            ("nx_ny_nz", Attribute::Ints(vec![3, 4, 1])),
            ("dx_dy_dz", Attribute::Floats(vec![0.002, 0.003, 0.1 + 0.2])),
        ],
        datasets: vec![
            dataset("data", &[4, 5, 2], Data::I16((0..40).map(|n| n - 1).collect()), true),
            dataset("keys", &[2], Data::Texts(vec!["a".into(), "long key".into()]), false),
        ],
        groups: ["rx10", "rx2"]
            .map(|name| Group { name: name.into(), datasets: vec![traces.clone()], ..Group::default() })
            .into(),
    }
}

#[test]
fn a_tree_is_read_as_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tree.h5");
    write(&path, &tree()).unwrap();
    let file = H5File::open(&path).unwrap();
    assert_eq!(file.children("/").unwrap(), (vec!["rx2".into(), "rx10".into()], vec!["data".into(), "keys".into()]));
    assert_eq!(file.shape("/rx2/Ez").unwrap(), [20, 3]);
    assert!(file.is_f64("/rx2/Ez").unwrap());
    assert_eq!(file.read_f64("/rx10/Ez").unwrap()[59].to_bits(), (59.0f64 * 0.3).sin().to_bits());
    assert_eq!(file.read_i16("/data").unwrap(), (0..40).map(|n| n - 1).collect::<Vec<i16>>());
    assert_eq!(file.read_texts("/keys").unwrap(), ["a", "long key"]);
    assert_eq!(file.text("/", "Title").unwrap(), "a ballast bed, 40 µm");
    assert_eq!(file.integers("/", "Iterations").unwrap(), [20]);
    assert_eq!(file.floats("/", "dx_dy_dz").unwrap()[2].to_bits(), (0.1f64 + 0.2).to_bits());
    assert_eq!(file.float("/rx2/Ez", "TimeSampleOffset").unwrap(), -2.5e-12);
}

#[test]
fn what_is_missing_or_of_another_kind_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tree.h5");
    write(&path, &tree()).unwrap();
    let file = H5File::open(&path).unwrap();
    let shown = path.display();
    let message = file.read_f64("/rx3/Ez").unwrap_err().to_string();
    assert_eq!(message, format!("`/rx3/Ez` is missing in `{shown}`"));
    let message = file.float("/", "dt").unwrap_err().to_string();
    assert!(message.starts_with(&format!("attribute `dt` of `/` is missing in `{shown}`\n\nhint: ")), "{message}");
    let message = file.read_i16("/rx2/Ez").unwrap_err().to_string();
    assert_eq!(message, format!("`/rx2/Ez` in `{shown}` should hold 16-bit integers with sign but holds f64"));
    let message = file.float("/", "Title").unwrap_err().to_string();
    assert_eq!(message, format!("`/ @ Title` in `{shown}` should hold floats but holds a text"));
    assert!(H5File::open(&folder.path().join("none.h5")).unwrap_err().to_string().contains("none.h5"));
}

#[test]
fn foreign_files_are_not_hdf5() {
    let folder = tempfile::tempdir().unwrap();
    for (name, content) in
        [("empty", &b""[..]), ("text", b"#title: x\n"), ("png", b"\x89PNG\r\n\x1a\n0000"), ("short", b"\x89HDF")]
    {
        let path = folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        assert!(matches!(H5File::open(&path), Err(Hdf5Error::NotHdf5 { .. })), "{name}");
    }
}

/// Reads everything there is, as far as it can be read. Returns whether all of it could.
fn read_all(path: &Path) -> bool {
    fn walk(file: &H5File, group: &str, depth: usize, fine: &mut bool) {
        let Ok((groups, datasets)) = file.children(group) else {
            *fine = false;
            return;
        };
        for name in ["Title", "dt", "MaterialDatabase"] {
            *fine &= file.attribute(group, name).is_ok();
        }
        let prefix = group.trim_end_matches('/');
        for dataset in datasets.iter().map(|name| format!("{prefix}/{name}")) {
            let read = [
                file.read_f64(&dataset).map(|_| ()),
                file.read_i64(&dataset).map(|_| ()),
                file.read_i16(&dataset).map(|_| ()),
                file.read_texts(&dataset).map(|_| ()),
            ];
            *fine &= read.iter().any(Result::is_ok) && file.attribute(&dataset, "Quantity").is_ok();
        }
        for inner in groups.iter().filter(|_| depth < 6).map(|name| format!("{prefix}/{name}")) {
            walk(file, &inner, depth + 1, fine);
        }
    }
    let mut fine = true;
    match H5File::open(path) {
        Ok(file) => walk(&file, "/", 0, &mut fine),
        Err(_) => fine = false,
    }
    fine
}

/// Three files (ours, h5py's, gprMax's) are cut at many lengths: never a panic, always an error.
#[test]
fn a_truncated_file_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cut.h5");
    for content in samples() {
        std::fs::write(&path, &content).unwrap();
        assert!(read_all(&path), "the whole file is fine");
        for share in 0..100 {
            std::fs::write(&path, &content[..content.len() * share / 100]).unwrap();
            assert!(!read_all(&path), "cut at {share} % of {} bytes", content.len());
        }
    }
}

/// One byte in each of many places is turned over: never a panic that gets out, never an absurd request for memory (which
/// would end the test), never an endless loop.
#[test]
fn a_damaged_file_ends_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("damaged.h5");
    for content in samples() {
        let step = (content.len() / 700).max(1);
        // The structure lies at the start and, in our own files, at the end: there every byte is tried.
        let dense = (0..content.len().min(800)).chain(content.len().saturating_sub(400)..content.len());
        for position in dense.chain((0..content.len()).step_by(step)) {
            for mask in [0xff, 0x01] {
                let mut damaged = content.clone();
                damaged[position] ^= mask;
                std::fs::write(&path, &damaged).unwrap();
                read_all(&path);
            }
        }
    }
}

/// A shape that no file could fill is refused before memory is asked for.
#[test]
fn an_absurd_shape_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("absurd.h5");
    let root = Group { datasets: vec![dataset("data", &[251], Data::I16(vec![7; 251]), true)], ..Group::default() };
    let good = to_bytes(&root).unwrap();
    let extent = 251u64.to_le_bytes();
    let places: Vec<usize> = (0..good.len() - 8).filter(|&at| good[at..at + 8] == extent).collect();
    assert!(!places.is_empty());
    for at in places {
        let mut bad = good.clone();
        bad[at..at + 8].copy_from_slice(&(1u64 << 50).to_le_bytes());
        std::fs::write(&path, &bad).unwrap();
        assert!(H5File::open(&path).and_then(|file| file.read_i16("/data")).is_err());
    }
}

fn samples() -> [Vec<u8>; 3] {
    [
        to_bytes(&tree()).unwrap(),
        std::fs::read(reference_case("11_geometry_objects_read").join("geom.h5")).unwrap(),
        std::fs::read(reference_case("16_noncubic").join("out_f64.h5")).unwrap(),
    ]
}
