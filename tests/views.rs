//! Views of the geometry against gprMax 4.0.1: every `#geometry_view` of `validation/gprmax` and `validation/gprmax3d`, data set by
//! data set.

mod cli_support;

use std::fs;
use std::path::{Path, PathBuf};

use ballast_gpr::gprmax::hdf5::H5File;
use ballast_gpr::gprmax::{read_model, view_files};
use cli_support::Place;

/// The scenes that ask for views.
fn scenes() -> Vec<PathBuf> {
    let all = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation");
    let folders = ["gprmax", "gprmax3d"].map(|name| fs::read_dir(all.join(name)).unwrap());
    let scenes = folders.into_iter().flatten().map(|entry| entry.unwrap().path().join("scene.in"));
    let asks = |path: &PathBuf| fs::read_to_string(path).is_ok_and(|text| text.contains("\n#geometry_view:"));
    let mut scenes: Vec<_> = scenes.filter(asks).collect();
    scenes.sort();
    scenes
}

/// Every data set of a group and of the groups in it is the same: texts and whole numbers exactly, lengths to the last bits.
fn same(ours: &H5File, theirs: &H5File, group: &str) -> usize {
    let (groups, datasets) = theirs.children(group).unwrap();
    assert_eq!(ours.children(group).unwrap(), (groups.clone(), datasets.clone()), "{group}");
    let join = |name: &str| format!("{}/{name}", group.trim_end_matches('/'));
    for name in datasets.iter().map(|name| join(name)) {
        assert_eq!(ours.shape(&name).unwrap(), theirs.shape(&name).unwrap(), "{name}");
        if let Ok(wanted) = theirs.read_texts(&name) {
            assert_eq!(ours.read_texts(&name).unwrap(), wanted, "{name}");
        } else if let Ok(wanted) = theirs.read_i64(&name) {
            let found = ours.read_i64(&name).unwrap();
            let differ: Vec<_> = (0..wanted.len()).filter(|&at| found[at] != wanted[at]).collect();
            assert!(differ.is_empty(), "{name}: {} of {} differ, first at {}", differ.len(), wanted.len(), differ[0]);
        } else {
            let wanted = theirs.read_f64(&name).unwrap();
            let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-15;
            assert!(ours.read_f64(&name).unwrap().iter().zip(&wanted).all(near), "{name}");
        }
    }
    datasets.len() + groups.iter().map(|name| same(ours, theirs, &join(name))).sum::<usize>()
}

#[test]
fn views_are_those_of_gprmax() {
    let scenes = scenes();
    assert!(scenes.len() >= 3, "{scenes:?}");
    for scene in scenes {
        let model = read_model(&scene).unwrap();
        let place = tempfile::tempdir().unwrap();
        for (path, bytes) in view_files(&model, &place.path().join("out.h5"), None).unwrap() {
            println!("{} {}", scene.display(), path.display());
            fs::write(&path, bytes).unwrap();
            let theirs = H5File::open(&scene.with_file_name(path.file_name().unwrap())).unwrap();
            let ours = H5File::open(&path).unwrap();
            assert!(same(&ours, &theirs, "/") >= 20);
            let image = theirs.attribute("/VTKHDF", "WholeExtent").unwrap().is_some();
            let names: &[&str] = if image {
                &["Direction", "Origin", "Spacing", "Type", "Version", "WholeExtent"]
            } else {
                &["Type", "Version"]
            };
            for name in names {
                let [a, b] = [&ours, &theirs].map(|file| file.attribute("/VTKHDF", name).unwrap().expect(name));
                assert_eq!(a, b, "{name}");
            }
        }
    }
}

/// Views lie beside the traces, those of a B-scan with its numbers, and nothing is overwritten unasked.
#[test]
fn views_lie_beside_their_traces() {
    let place = Place::new();
    let text = "#domain: 0.06 0.05 0.002\n#dx_dy_dz: 0.002 0.002 0.002\n#time_window: 20\n#pml_cells: 0\n#material: 5 0 1 0 stone\n\
        #waveform: ricker 1 2e9 w\n#hertzian_dipole: z 0.02 0.03 0 w\n#rx: 0.04 0.03 0\n#src_steps: 0.002 0 0\n\
        #cylinder: 0.03 0.02 0 0.03 0.02 0.002 0.01 stone\n";
    place.write("a.in", format!("{text}#geometry_view: 0 0 0 0.06 0.05 0.002 0.002 0.002 0.002 bed n\n"));
    fs::create_dir(place.path("out")).unwrap();
    let said = place.ok(&["run", "a.in", "--out", "out/b.h5"]);
    assert!(said.contains("out/bed.vtkhdf written\n"), "{said}");
    let bytes = fs::read(place.path("out/bed.vtkhdf")).unwrap();
    place.ok(&["run", "a.in", "--out", "out/c.h5"]);
    assert_eq!(fs::read(place.path("out/bed.vtkhdf")).unwrap(), bytes, "the same bytes in the way are no obstacle");
    place.write("out/bed.vtkhdf", "of somebody else");
    let error = place.fails(&["run", "a.in", "--out", "out/d.h5"], 2);
    assert!(error.contains("`#geometry_view` would write `out/bed.vtkhdf`, which exists already with another content"));
    assert!(!place.path("out/d.h5").exists());
    place.ok(&["run", "a.in", "--out", "out/d.h5", "--force"]);
    assert_eq!(fs::read(place.path("out/bed.vtkhdf")).unwrap(), bytes);
    place.ok(&["run", "a.in", "-n", "2"]);
    let place_of =
        |name: &str| H5File::open(&place.path(name)).unwrap().read_f64("/VTKHDF/FieldData/sources").unwrap()[0];
    assert!((place_of("bed1.vtkhdf") - 0.02).abs() < 1e-15 && (place_of("bed2.vtkhdf") - 0.022).abs() < 1e-15);
    for (line, said) in [
        ("0 0 0 0.06 0.05 0.002 0.004 0.002 0.002 bed f", "that of the grid's to show edges"),
        ("0 0 0 0.06 0.05 0.002 0.0001 0.002 0.002 bed n", "at least that of the grid's"),
        ("0 0 0 0.06 0.05 0.002 0.002 0.002 0.002 bed x", "`x`"),
        ("0 0 0 0.07 0.05 0.002 0.002 0.002 0.002 bed n", "corner of the block"),
    ] {
        place.write("e.in", format!("{text}#geometry_view: {line}\n"));
        let error = place.fails(&["run", "e.in"], 2);
        assert!(error.contains(said), "{line}: {error}");
    }
}
