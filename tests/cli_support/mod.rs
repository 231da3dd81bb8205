//! The program in a folder of its own, as a user would start it.

#![allow(dead_code, reason = "not every test file uses all of it")]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use tempfile::TempDir;

/// Flags of a scene that packs, draws and runs in a tenth of a second: 8 mm cells are fine for 500 MHz.
pub const COARSE: [&str; 6] = ["--cell", "8mm", "--time-window", "6ns", "--frequency", "500MHz"];

/// An empty folder to work in.
pub struct Place {
    folder: TempDir,
}

impl Place {
    pub fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    /// A path in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The program, to be started in the folder, without what the environment might say of gprMax.
    pub fn program(&self) -> Command {
        let mut command = Command::cargo_bin("ballast-gpr").unwrap();
        command.current_dir(self.folder.path());
        command.env_remove("BALLAST_GPR_GPRMAX_PYTHON").env("BALLAST_GPR_CACHE", self.path("cache"));
        command.env("NO_COLOR", "1");
        command
    }

    /// Starts the program, expects success and gives what it printed on standard output.
    pub fn ok(&self, arguments: &[&str]) -> String {
        let output = self.program().args(arguments).assert().success().get_output().clone();
        String::from_utf8(output.stdout).unwrap()
    }

    /// As [`ok`](Self::ok), with the output read as JSON.
    pub fn json(&self, arguments: &[&str]) -> serde_json::Value {
        serde_json::from_str(&self.ok(arguments)).unwrap()
    }

    /// Starts the program, expects an exit code and gives what it printed on standard error.
    pub fn fails(&self, arguments: &[&str], code: i32) -> String {
        let output = self.program().args(arguments).assert().code(code).get_output().clone();
        String::from_utf8(output.stderr).unwrap()
    }

    /// Builds a coarse scene into `out`.
    pub fn build(&self, out: &str, more: &[&str]) {
        self.ok(&[&["build", "--out", out], &COARSE[..], more].concat());
    }

    /// Every file below the folder, or below one in it, by its path there.
    pub fn files(&self, below: &str) -> BTreeMap<PathBuf, Vec<u8>> {
        let root = self.path(below);
        let mut files = BTreeMap::new();
        collect(&root, &root, &mut files);
        files
    }

    /// Names of all files below the folder.
    pub fn names(&self, below: &str) -> Vec<String> {
        self.files(below).keys().map(|path| path.display().to_string()).collect()
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        fs::write(self.path(name), bytes).unwrap();
    }

    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }
}

fn collect(root: &Path, folder: &Path, files: &mut BTreeMap<PathBuf, Vec<u8>>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(root, &path, files);
        } else {
            files.insert(path.strip_prefix(root).unwrap().into(), fs::read(&path).unwrap());
        }
    }
}
