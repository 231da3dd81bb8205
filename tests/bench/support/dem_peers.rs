//! The same scene through other programs, where they are installed: LIGGGHTS (Debian: `apt-get install liggghts`) on the PATH,
//! and Kratos in the Python named by `KRATOS_PYTHON` (see `dem_kratos.py`). Neither is part of any test.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use ballast_gpr::packing::dem::Setup;

/// A program that runs the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Peer {
    /// LIGGGHTS, with MPI.
    Liggghts,
    /// Kratos with bounded rolling friction, with OpenMP.
    Kratos,
}

impl Peer {
    /// Those that are installed.
    pub fn installed() -> Vec<Self> {
        let liggghts = Command::new("liggghts").arg("-help").output().is_ok();
        let kratos = std::env::var_os("KRATOS_PYTHON").is_some();
        [liggghts.then_some(Self::Liggghts), kratos.then_some(Self::Kratos)].into_iter().flatten().collect()
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Liggghts => "LIGGGHTS",
            Self::Kratos => "Kratos (BROF)",
        }
    }

    /// Particle-steps per second of its loop; none, with its last words, when it fails.
    pub fn rate(self, setup: &Setup, wide: Option<f64>, steps: u64, threads: usize) -> Option<f64> {
        let folder = tempfile::tempdir().ok()?;
        let support = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bench/support");
        let walls = if wide.is_some() { "1" } else { "0" };
        let wide = wide.map_or("none".to_string(), |wide| wide.to_string());
        let output = match self {
            Self::Liggghts => {
                let data = folder.path().join("bed.data");
                std::fs::write(&data, atoms(setup)).ok()?;
                Command::new("mpirun")
                    .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
                    .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
                    .args(["--oversubscribe", "-np", &threads.to_string(), "liggghts", "-log", "none", "-in"])
                    .arg(support.join("dem_liggghts.in"))
                    .args(["-var", "data"])
                    .arg(&data)
                    .args(["-var", "steps", &steps.to_string(), "-var", "procs", &threads.to_string()])
                    .args(["-var", "skin", "0.002", "-var", "walls", walls, "-var", "wide", &wide])
                    .current_dir(folder.path())
                    .output()
            }
            Self::Kratos => {
                let bed: PathBuf = folder.path().join("bed.csv");
                std::fs::write(&bed, rows(setup)).ok()?;
                Command::new(std::env::var_os("KRATOS_PYTHON")?)
                    .arg(support.join("dem_kratos.py"))
                    .arg(&bed)
                    .args([steps.to_string(), threads.to_string(), wide])
                    .output()
            }
        }
        .ok()?;
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        let key = if self == Self::Liggghts { "Loop time of " } else { "loop " };
        let seconds =
            said.lines().rev().find_map(|line| line.strip_prefix(key)?.split(' ').next()?.parse::<f64>().ok());
        if seconds.is_none() {
            let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
            let words: Vec<&str> = said.lines().chain(complaint.lines()).collect();
            eprintln!("{} failed:\n{}", self.name(), words[words.len().saturating_sub(12)..].join("\n"));
        }
        seconds.map(|seconds| steps as f64 * setup.grains.len() as f64 / seconds)
    }
}

/// The data file of LIGGGHTS: number, type, diameter, density, place.
fn atoms(setup: &Setup) -> String {
    let highest = |k: usize| setup.grains.iter().map(|grain| grain.sphere.centre[k]).fold(0.0, f64::max) + 0.2;
    let mut text = format!("stones\n\n{} atoms\n1 atom types\n\n", setup.grains.len());
    // Room below for stones that fall.
    let _ = write!(
        text,
        "-0.2 {} xlo xhi\n-0.2 {} ylo yhi\n-3.0 {} zlo zhi\n\nAtoms\n\n",
        highest(0),
        highest(1),
        highest(2)
    );
    for (n, grain) in setup.grains.iter().enumerate() {
        let [x, y, z] = grain.sphere.centre;
        let _ = writeln!(text, "{} 1 {} 2700 {x} {y} {z}", n + 1, 2.0 * grain.sphere.radius);
    }
    text
}

fn rows(setup: &Setup) -> String {
    let mut text = String::new();
    for grain in &setup.grains {
        let [x, y, z] = grain.sphere.centre;
        let _ = writeln!(text, "{x},{y},{z},{}", grain.sphere.radius);
    }
    text
}
