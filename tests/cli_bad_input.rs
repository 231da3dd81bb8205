//! Bad input, one case per file in `tests/bad`: what is typed, the exit code, and standard error word for word.
//!
//! No case may change, add or remove a file: nothing half-written stays, and what was there is as it was. What a failure is
//! meant to leave is listed under `leaves`.

// The messages hold words of the system.
#![cfg(unix)]

mod cli_support;

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;

use ballast_gpr::gprmax::hdf5::{Attribute, Data, Dataset, Group, write};
use cli_support::Place;

/// A case as its file says it.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Case {
    /// What the case is about.
    about: String,
    /// What is done before, in words of the command line; must succeed.
    #[serde(default)]
    before: Vec<String>,
    /// Files that lie in the folder; those that begin with `#!` can be run.
    #[serde(default)]
    files: BTreeMap<String, String>,
    /// Largest file that the system lets the program write, in blocks of 512 bytes: a disk that is full.
    #[serde(default)]
    largest_file: Option<u32>,
    /// What is typed, in words of the command line.
    command: String,
    /// The exit code.
    exit: i32,
    /// Standard error, whole.
    stderr: String,
    /// Files that may be there afterwards, and were not before.
    #[serde(default)]
    leaves: Vec<String>,
}

fn words(line: &str) -> Vec<String> {
    let mut words = vec![];
    for (index, part) in line.split('\'').enumerate() {
        if index % 2 == 1 {
            words.push(part.to_string());
        } else {
            words.extend(part.split_whitespace().map(String::from));
        }
    }
    words
}

/// HDF5 files that TOML cannot hold.
fn write_hdf5(place: &Place) {
    let root = |attributes, datasets, groups| Group { name: String::new(), attributes, datasets, groups };
    let numbers = Dataset {
        name: "numbers".into(),
        shape: vec![3],
        data: Data::F64(vec![1.0, 2.0, 3.0]),
        compressed: false,
        attributes: vec![],
    };
    write(&place.path("foreign.h5"), &root(vec![], vec![numbers], vec![])).unwrap();
    let rx = Group { name: "rx1".into(), ..Group::default() };
    let rxs = Group { name: "rxs".into(), groups: vec![rx], ..Group::default() };
    let attributes = vec![("gprMax", Attribute::Text("4.0.1".into())), ("nrx", Attribute::Int(1))];
    write(&place.path("no-attribute.h5"), &root(attributes, vec![], vec![rxs])).unwrap();
    place.write("corrupt.h5", [&b"\x89HDF\r\n\x1a\n"[..], &[0xa5; 600]].concat());
}

fn check(file: &Path) -> Result<(), String> {
    let case: Case = toml::from_str(&fs::read_to_string(file).unwrap()).map_err(|error| error.to_string())?;
    let place = Place::new();
    for (name, text) in &case.files {
        place.write(name, text);
        if text.starts_with("#!") {
            fs::set_permissions(place.path(name), fs::Permissions::from_mode(0o755)).unwrap();
        }
    }
    if case.command.contains(".h5") {
        write_hdf5(&place);
    }
    for line in &case.before {
        place.program().args(words(line)).assert().success();
    }
    let before = place.files("");
    let arguments = words(&case.command);
    let output = match case.largest_file {
        None => place.program().args(&arguments).output().unwrap(),
        Some(blocks) => {
            let program = place.program().get_program().to_owned();
            let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"");
            let mut shell = std::process::Command::new("sh");
            shell.arg("-c").arg(script).arg(program).args(&arguments).current_dir(place.path(""));
            shell.output().unwrap()
        }
    };
    let folder = format!("{}/", place.path("").display().to_string().trim_end_matches('/'));
    let stderr = String::from_utf8(output.stderr).unwrap().replace(&folder, "");
    if stderr != case.stderr {
        return Err(format!("{}: standard error is\n{stderr}\nwanted was\n{}", case.about, case.stderr));
    }
    if output.status.code() != Some(case.exit) {
        return Err(format!("{}: the exit code is {:?}, wanted was {}", case.about, output.status.code(), case.exit));
    }
    let mut after = place.files("");
    for name in &case.leaves {
        after.remove(Path::new(name)).ok_or_else(|| format!("{}: no `{name}` was left", case.about))?;
    }
    for (path, bytes) in &before {
        if after.remove(path).as_ref() != Some(bytes) {
            return Err(format!("{}: `{}` was changed or removed", case.about, path.display()));
        }
    }
    if !after.is_empty() {
        return Err(format!("{}: left behind: {:?}", case.about, after.keys()));
    }
    Ok(())
}

#[test]
fn every_bad_input_is_refused_word_for_word() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad");
    let mut files: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(files.len() >= 40, "{} cases", files.len());
    let failures: Vec<_> = files
        .iter()
        .filter_map(|file| Some(format!("{}\n{}", file.file_name()?.display(), check(file).err()?)))
        .collect();
    assert!(failures.is_empty(), "{}", failures.join("\n----\n"));
}
