//! The same scene and seed make the same bytes, from whatever folder and on any number of threads.

mod cli_support;

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

use cli_support::{COARSE, Place};

/// The files of a folder with the wall times taken out: those of the manifest, and the two of the packing's report.
fn timeless(place: &Place, folder: &str) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = place.files(folder);
    for (path, bytes) in &mut files {
        let text = String::from_utf8_lossy(bytes);
        if path.ends_with("manifest.json") {
            let mut manifest: serde_json::Value = serde_json::from_str(&text).unwrap();
            let seconds = manifest.as_object_mut().unwrap().remove("seconds").unwrap();
            let keys: Vec<_> = seconds.as_object().unwrap().keys().cloned().collect();
            assert_eq!(keys, ["packing", "raster", "writing"]);
            *bytes = manifest.to_string().into_bytes();
        } else if path.ends_with("packing.txt") {
            let (timed, rest): (Vec<_>, Vec<_>) = text.lines().partition(|line| line.ends_with(" s"));
            assert_eq!(timed.len(), 2, "{text}");
            *bytes = rest.join("\n").into_bytes();
        }
    }
    files
}

fn assert_same(a: &BTreeMap<PathBuf, Vec<u8>>, b: &BTreeMap<PathBuf, Vec<u8>>) {
    assert_eq!(a.keys().collect::<Vec<_>>(), b.keys().collect::<Vec<_>>());
    for (path, bytes) in a {
        assert!(&b[path] == bytes, "{} differs", path.display());
    }
}

/// What `build` keeps makes the same folder again, whichever way the geometry is written and the stones came.
#[test]
fn the_kept_scene_makes_the_same_bytes() {
    let place = Place::new();
    place.build("voxels", &["--fouling", "20cm", "--moisture", "5%"]);
    place.build("cylinders", &["--geometry", "cylinders", "--seed", "7"]);
    place.build("area", &["--smoothing", "area", "--equivalent-2d"]);
    fs::copy(place.path("voxels/packing.csv"), place.path("stones.csv")).unwrap();
    place.build("from-file", &["--packing", "stones.csv"]);
    place.build("homogeneous", &["--homogeneous", "--fouling", "40% of voids", "--smoothing", "none"]);
    for name in ["voxels", "cylinders", "area", "from-file", "homogeneous"] {
        let again = format!("{name}-again");
        place.ok(&["build", &format!("{name}/scene.toml"), "--out", &again]);
        assert_same(&timeless(&place, name), &timeless(&place, &again));
    }
    assert!(place.files("voxels").len() >= 16, "{:?}", place.names("voxels"));
    assert!(place.read("cylinders/model.in").contains("#cylinder:"));
}

/// A sieve curve from a file is kept in the scene itself, so the file may go.
#[test]
fn a_folder_needs_nothing_outside_itself() {
    let place = Place::new();
    place.write("mine.csv", "sieve_mm,passing_percent\n31.5,0\n40,35\n50,80\n63,100\n");
    place.build("first", &["--grading", "mine.csv"]);
    place.write("stones.csv", place.read("first/packing.csv"));
    place.build("second", &["--packing", "stones.csv"]);
    fs::create_dir(place.path("elsewhere")).unwrap();
    for name in ["first", "second"] {
        fs::rename(place.path(name), place.path(&format!("elsewhere/{name}"))).unwrap();
    }
    for name in ["mine.csv", "stones.csv"] {
        fs::remove_file(place.path(name)).unwrap();
    }
    for name in ["elsewhere/first", "elsewhere/second"] {
        assert!(place.ok(&["explain", name]).contains("Bulk permittivity"));
        let run = place.json(&["run", name, "--json"]);
        assert_eq!(run["kept"], false);
        place.ok(&["build", name, "--out", &format!("{name}-again")]);
    }
}

/// Siblings differ, and each is what a single build with its seed gives.
#[test]
fn each_sibling_is_a_single_build() {
    let place = Place::new();
    let told = place.ok(&[&["build", "--out", "many", "--realisations", "3", "--seed", "5"], &COARSE[..]].concat());
    assert_eq!(told.lines().count(), 3, "{told}");
    for seed in ["5", "6", "7"] {
        let single = format!("single-{seed}");
        place.build(&single, &["--seed", seed]);
        assert_same(&timeless(&place, &single), &timeless(&place, &format!("many/seed-{seed}")));
    }
    let stones = |seed: u32| place.read(&format!("many/seed-{seed}/packing.csv"));
    assert!(stones(5) != stones(6) && stones(6) != stones(7) && stones(5) != stones(7));
}

/// Siblings that were stopped half-way go on: what is whole stays untouched, what was begun is finished.
#[test]
fn stopped_siblings_go_on() {
    let place = Place::new();
    let build = [&["build", "--out", "many", "--realisations", "3"], &COARSE[..]].concat();
    place.ok(&build);
    let whole = timeless(&place, "many/seed-2");
    fs::remove_file(place.path("many/seed-2/manifest.json")).unwrap();
    fs::remove_file(place.path("many/seed-2/model.in")).unwrap();
    fs::remove_dir_all(place.path("many/seed-3")).unwrap();
    let told = place.ok(&build);
    let lines: Vec<_> = told.lines().collect();
    assert_eq!(lines[0], "many/seed-1: was there already", "{told}");
    assert!(lines[1].contains("stones") && lines[2].contains("stones"), "{told}");
    assert_same(&whole, &timeless(&place, "many/seed-2"));
}

/// One thread or four: the same model and the same trace, bit by bit.
#[test]
fn threads_change_no_byte() {
    let place = Place::new();
    for threads in ["1", "4"] {
        let build = [&["build", "--out", threads, "--fouling", "20cm"], &COARSE[..]].concat();
        place.program().args(build).env("RAYON_NUM_THREADS", threads).assert().success();
        let run = ["run", threads, "--threads", threads];
        place.program().args(run).env("RAYON_NUM_THREADS", threads).assert().success();
        fs::remove_file(place.path(threads).join("fdtd.run.json")).unwrap();
    }
    assert_same(&timeless(&place, "1"), &timeless(&place, "4"));
    place.ok(&["run", "1", "--threads", "2", "--out", "two.h5"]);
    assert!(fs::read(place.path("two.h5")).unwrap() == fs::read(place.path("1/fdtd.h5")).unwrap());
}
