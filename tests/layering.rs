//! The module map of the crate doc (`src/lib.rs`), as a test. Edit the table, the crate doc and the code together.

use std::fs;
use std::path::{Path, PathBuf};

/// Module and the modules it may import. `cli` may import everything and is not listed.
const MAY_IMPORT: &[(&str, &[&str])] = &[
    ("units", &[]),
    ("files", &[]),
    ("trace", &["units"]),
    ("geometry", &["units"]),
    ("material", &["units", "files"]),
    ("model", &["units", "geometry", "material"]),
    ("packing", &["units", "geometry", "files"]),
    ("scene", &["units", "files", "geometry", "material", "model", "packing"]),
    ("raster", &["units", "geometry", "material", "scene", "model"]),
    ("forward", &["units", "trace", "model"]),
    ("gprmax", &["units", "trace", "material", "model", "geometry", "forward", "files"]),
    ("fdtd", &["units", "trace", "material", "model", "forward", "files"]),
    ("measured", &["units", "files", "trace"]),
    ("compare", &["units", "trace"]),
    (
        "study",
        &[
            "units", "files", "trace", "geometry", "material", "model", "packing", "scene", "raster", "forward",
            "compare",
        ],
    ),
    ("plot", &["units", "files"]),
];
/// A kernel file computes; it never reads, writes, logs, allocates or fails.
const BANNED_IN_KERNELS: &[&str] =
    &["std::fs", "std::io", "serde", "log::", "Vec::new", "vec![", "Result<", "format!", "Box<", "println!"];

fn rust_files(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            rust_files(&path, out);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            out.push(path);
        }
    }
}

fn sources() -> Vec<(String, String, String)> {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    rust_files(&src, &mut files);
    assert!(files.len() > 50, "only {} source files found", files.len());
    files
        .into_iter()
        .map(|file| {
            let inside = file.strip_prefix(&src).unwrap();
            let module =
                inside.components().next().unwrap().as_os_str().to_str().unwrap().trim_end_matches(".rs").to_string();
            (module, inside.display().to_string(), fs::read_to_string(&file).unwrap())
        })
        .collect()
}

#[test]
fn modules_only_import_downwards() {
    let mut broken = Vec::new();
    for (module, file, text) in sources() {
        if matches!(module.as_str(), "lib" | "main" | "cli") {
            continue;
        }
        let Some((_, allowed)) = MAY_IMPORT.iter().find(|(name, _)| *name == module) else {
            broken.push(format!("{file}: module `{module}` is not in the table"));
            continue;
        };
        for (number, line) in text.lines().enumerate() {
            let code = line.split("//").next().unwrap();
            for hit in code.split("crate::").skip(1) {
                if hit.starts_with('{') {
                    broken.push(format!("{file}:{}: write one `use crate::module::..` per module", number + 1));
                    continue;
                }
                let target: String = hit.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
                if !target.is_empty() && target != module && !allowed.contains(&target.as_str()) {
                    broken.push(format!("{file}:{}: `{module}` must not import `{target}`", number + 1));
                }
            }
            if file.contains("kernel") {
                for word in BANNED_IN_KERNELS.iter().filter(|word| code.contains(**word)) {
                    broken.push(format!("{file}:{}: `{word}` in a kernel", number + 1));
                }
            }
        }
    }
    assert!(broken.is_empty(), "\n{}", broken.join("\n"));
}

/// The table is one direction: ordered so that every module imports only from those above it.
#[test]
fn the_table_has_no_circle() {
    let mut known = vec![];
    let mut open: Vec<_> = MAY_IMPORT.to_vec();
    while !open.is_empty() {
        let before = open.len();
        open.retain(|(name, allowed)| {
            let ready = allowed.iter().all(|module| known.contains(module));
            if ready {
                known.push(*name);
            }
            !ready
        });
        assert!(open.len() < before, "a circle among {:?}", open.iter().map(|(name, _)| name).collect::<Vec<_>>());
    }
}

/// The crate doc shows the same table, row by row.
#[test]
fn the_crate_doc_shows_the_same_table() {
    let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("src/lib.rs")).unwrap();
    for (module, allowed) in MAY_IMPORT {
        let imports = if allowed.is_empty() { "–".to_string() } else { allowed.join(", ") };
        let row = format!("| {imports} |");
        let line = text.lines().find(|line| line.starts_with(&format!("//! | [`{module}`] |")));
        let line = line.unwrap_or_else(|| panic!("the crate doc has no row for `{module}`"));
        assert!(line.ends_with(&row), "crate doc: {line}\ntable: {row}");
    }
    let declared: Vec<_> = text.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';')).collect();
    for module in &declared {
        assert!(
            *module == "cli" || MAY_IMPORT.iter().any(|(name, _)| name == module),
            "`{module}` is not in the table"
        );
    }
    assert_eq!(declared.len(), MAY_IMPORT.len() + 1);
}

/// Only one module speaks HDF5, so that the library can be exchanged.
#[test]
fn one_module_speaks_hdf5() {
    for (_, file, text) in sources() {
        assert!(file.starts_with("gprmax/hdf5") || !text.contains("hdf5_pure"), "{file} uses hdf5_pure");
    }
}

/// `gprmax` and `fdtd` are siblings: agreement between them is a comparison of two things.
#[test]
fn the_two_solvers_do_not_know_each_other() {
    let row = |name| MAY_IMPORT.iter().find(|(module, _)| *module == name).unwrap().1;
    assert!(!row("fdtd").contains(&"gprmax") && !row("gprmax").contains(&"fdtd"));
    assert!(!row("compare").contains(&"fdtd") && !row("compare").contains(&"gprmax"));
    assert!(!row("study").contains(&"fdtd") && !row("study").contains(&"gprmax"));
}
