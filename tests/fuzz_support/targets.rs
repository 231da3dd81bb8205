//! What is fuzzed: every reader of files that somebody else may have written.

use std::fs;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Duration;

use ballast_gpr::compare::text::{Column, TextOptions, read_trace};
use ballast_gpr::fdtd::Fdtd;
use ballast_gpr::gprmax::hdf5::H5File;
use ballast_gpr::gprmax::{COMMANDS, read_input, read_traces};
use ballast_gpr::measured;
use ballast_gpr::model::{Model, TimeWindow};
use ballast_gpr::packing::Grading;
use ballast_gpr::packing::export::{OVERLAP_TOLERANCE, from_csv, from_json};
use ballast_gpr::scene::SceneSpec;
use ballast_gpr::units::Seconds;
use rand::RngExt as _;
use rand_pcg::Pcg64;

use super::mutate::{self, number, one};

/// A reader.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// gprMax input files; small models are run for a few steps too.
    In,
    /// Output files of gprMax.
    Traces,
    /// The voxels of `#geometry_objects_read`, and everything else that an HDF5 file can be asked.
    Voxels,
    /// The material database beside them.
    Database,
    /// Packings as CSV.
    PackingCsv,
    /// Packings as JSON.
    PackingJson,
    /// Sieve curves.
    Grading,
    /// Traces as text.
    TraceText,
    /// Scenes as TOML.
    Scene,
    /// Files of instruments; those of two files as one input, with the length of the header before it.
    Dzt,
    Dt1,
    Mala,
    SegY,
    Iprb,
    Ids,
}

impl Target {
    pub const ALL: [Self; 15] = [
        Self::In,
        Self::Traces,
        Self::Voxels,
        Self::Database,
        Self::PackingCsv,
        Self::PackingJson,
        Self::Grading,
        Self::TraceText,
        Self::Scene,
        Self::Dzt,
        Self::Dt1,
        Self::Mala,
        Self::SegY,
        Self::Iprb,
        Self::Ids,
    ];

    /// Its name, which is also that of its folder of seeds.
    pub fn name(self) -> &'static str {
        match self {
            Self::In => "in",
            Self::Traces => "traces",
            Self::Voxels => "voxels",
            Self::Database => "database",
            Self::PackingCsv => "packing_csv",
            Self::PackingJson => "packing_json",
            Self::Grading => "grading",
            Self::TraceText => "trace_text",
            Self::Scene => "scene",
            Self::Dzt => "dzt",
            Self::Dt1 => "dt1",
            Self::Mala => "mala",
            Self::SegY => "segy",
            Self::Iprb => "iprb",
            Self::Ids => "ids",
        }
    }

    /// The longest that one input may take: some hundred times what the slowest takes on a quiet machine.
    pub fn most_time(self) -> Duration {
        Duration::from_secs(10)
    }

    /// The most memory that one input may take.
    ///
    /// Input files: a million receivers of 56 bytes, in a list that doubles. HDF5: what deflate can unpack (1032 for one)
    /// twice over, with ids of four bytes for stored ones of two. Texts: rows of 64 bytes for lines of two, doubling, and
    /// the ten million samples of 8 bytes that a curve may be resampled to. Packings: a million boxes of 16 bytes, in which
    /// neighbours are looked for.
    pub fn most_memory(self, input: usize) -> usize {
        let base = 4 << 20;
        match self {
            Self::In => 320 << 20,
            Self::Traces | Self::Voxels => base + 1032 * 6 * input.max(6202),
            Self::TraceText => (400 << 20) + 256 * input,
            Self::PackingCsv | Self::PackingJson => (64 << 20) + 256 * input,
            _ => base + 256 * input,
        }
    }

    /// What mutations start from: every file of its folder, by name.
    pub fn seeds(self) -> Vec<Vec<u8>> {
        let found = files(self.name());
        assert!(!found.is_empty(), "{}", self.name());
        let Some((header, _)) = self.pair() else { return found.into_iter().map(|(_, bytes)| bytes).collect() };
        let header_of = |name: &str| fs::read(Path::new(name).with_extension(header)).unwrap();
        let is_header = |name: &str| Path::new(name).extension().is_some_and(|ending| ending == header);
        found
            .into_iter()
            .filter(|(name, _)| !is_header(name))
            .map(|(name, data)| joined(&header_of(&name), &data))
            .collect()
    }

    /// Endings of the header and of the samples, of formats with two files.
    fn pair(self) -> Option<(&'static str, &'static str)> {
        match self {
            Self::Dt1 => Some(("hd", "dt1")),
            Self::Mala => Some(("rad", "rd3")),
            Self::Iprb => Some(("iprh", "iprb")),
            _ => None,
        }
    }

    /// What once was not survived, with the names of the files.
    pub fn kept(self) -> Vec<(String, Vec<u8>)> {
        files(&format!("kept/{}", self.name()))
    }

    /// Lays the files beside the input that it asks for.
    pub fn prepare(self, folder: &Path) {
        let corpus = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/corpus");
        for (from, to) in
            [("voxels/plain.h5", "voxels.h5"), ("database/mats.json", "mats.json"), ("in/voxels.in", "input.in")]
        {
            fs::copy(corpus.join(from), folder.join(to)).unwrap();
        }
    }

    /// A new input from the seeds.
    pub fn mutate(self, seeds: &[Vec<u8>], random: &mut Pcg64) -> Vec<u8> {
        let (seed, other) = (&seeds[random.random_range(0..seeds.len())], &seeds[random.random_range(0..seeds.len())]);
        match self {
            Self::Traces | Self::Voxels | Self::Dzt | Self::Ids => mutate::bytes(seed, random),
            // Half of the changes behind the 3200 bytes of text.
            Self::SegY if seed.len() > 3200 && random.random_bool(0.5) => {
                [&seed[..3200], &mutate::bytes(&seed[3200..], random)].concat()
            }
            Self::SegY => mutate::bytes(seed, random),
            Self::Dt1 | Self::Mala | Self::Iprb => {
                let ((header, data), (other, _)) = (parted(seed), parted(other));
                if random.random_bool(0.5) {
                    return joined(header, &mutate::bytes(data, random));
                }
                let line = |random: &mut Pcg64| format!("{} = {}", one(random, &WORDS_RADAR), number(random));
                joined(&mutate::text(header, other, &WORDS_RADAR, &line, random), data)
            }
            Self::In => mutate::text(seed, other, &WORDS_IN, &command, random),
            _ => mutate::text(
                seed,
                other,
                &WORDS,
                &|random| format!("{} = {}", one(random, &WORDS), number(random)),
                random,
            ),
        }
    }

    /// Reads an input; whether it was found to be sound.
    pub fn run(self, folder: &Path, input: &[u8]) -> bool {
        let write = |name: &str| {
            let path = folder.join(name);
            fs::write(&path, input).unwrap();
            path
        };
        let text = || std::str::from_utf8(input).ok();
        match self {
            Self::In => match read_input(&write("input.in")) {
                Ok(read) => {
                    run_if_small(read.model);
                    true
                }
                Err(error) => said(&error),
            },
            Self::Traces => read_traces(&write("traces.h5")).map_or_else(|error| said(&error), |_| true),
            Self::Voxels => {
                let path = write("voxels.h5");
                visit(&path);
                read_input(&folder.join("input.in")).map_or_else(|error| said(&error), |_| true)
            }
            Self::Database => {
                write("mats.json");
                read_input(&folder.join("input.in")).map_or_else(|error| said(&error), |_| true)
            }
            Self::PackingCsv => text().is_some_and(|text| {
                from_csv(text, None, OVERLAP_TOLERANCE).map_or_else(|error| said(&error), |_| true)
            }),
            Self::PackingJson => text()
                .is_some_and(|text| from_json(text, OVERLAP_TOLERANCE).map_or_else(|error| said(&error), |_| true)),
            Self::Grading => {
                text().is_some_and(|text| Grading::from_csv("fuzz", text).map_or_else(|error| said(&error), |_| true))
            }
            Self::TraceText => text().is_some_and(|text| {
                let resampled = TextOptions { column: Column::Number(2), resample: Some(Seconds(1e-11)) };
                let _ = read_trace(text, "fuzz", &resampled);
                let plain = TextOptions::default();
                read_trace(text, "fuzz", &plain).map_or_else(|error| said(&error), |_| true)
            }),
            Self::Dzt => measured::read(&write("line.dzt")).map_or_else(|error| said(&error), |_| true),
            Self::SegY => measured::read(&write("line.sgy")).map_or_else(|error| said(&error), |_| true),
            Self::Ids => measured::read(&write("line.dt")).map_or_else(|error| said(&error), |_| true),
            Self::Dt1 | Self::Mala | Self::Iprb => {
                let Some((ending_of_header, ending)) = self.pair() else { return false };
                let (header, data) = parted(input);
                fs::write(folder.join(format!("line.{ending_of_header}")), header).unwrap();
                let path = folder.join(format!("line.{ending}"));
                fs::write(&path, data).unwrap();
                measured::read(&path).map_or_else(|error| said(&error), |_| true)
            }
            Self::Scene => text().is_some_and(|text| {
                SceneSpec::from_toml(text, Path::new("fuzz.toml")).map_or_else(|error| said(&error), |_| true)
            }),
        }
    }
}

/// A header and samples in one, with the length of the header before.
fn joined(header: &[u8], data: &[u8]) -> Vec<u8> {
    [&(header.len() as u32).to_le_bytes()[..], header, data].concat()
}

/// The two again.
fn parted(input: &[u8]) -> (&[u8], &[u8]) {
    let Some((length, rest)) = input.split_first_chunk::<4>() else { return (&[], input) };
    rest.split_at((u32::from_le_bytes(*length) as usize).min(rest.len()))
}

/// Name and content of the files in a folder of the corpus; none where it is missing.
fn files(folder: &str) -> Vec<(String, Vec<u8>)> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/corpus").join(folder);
    let mut paths: Vec<PathBuf> =
        fs::read_dir(&folder).map_or(vec![], |entries| entries.map(|entry| entry.unwrap().path()).collect());
    paths.sort();
    paths.into_iter().map(|path| (path.display().to_string(), fs::read(&path).unwrap())).collect()
}

/// Every error can be said, in words.
fn said(error: &dyn std::error::Error) -> bool {
    assert!(!error.to_string().is_empty());
    false
}

/// Words of input files; commands are taken from the reader's own table.
const WORDS_IN: [&str; 46] = [
    "x",
    "y",
    "z",
    "n",
    "pec",
    "pmc",
    "free_space",
    "stone",
    "fines",
    "ferrite",
    "w",
    "g",
    "ricker",
    "gaussian",
    "gaussiandot",
    "gaussianprime",
    "impulse",
    "user",
    "sine",
    "Ez",
    "Hx",
    "Ix",
    "inf",
    "voxels.h5",
    "mats",
    "mats.txt",
    "input.in",
    "TM",
    "TE",
    "3D",
    "harmonic",
    "arithmetic",
    "constant",
    "linear",
    "quartic",
    "forward",
    "reverse",
    "HORIPML",
    "MRIPML",
    "view.vtkhdf",
    "soil",
    "ores",
    "ground",
    "x0",
    "zmax",
    "snap.h5",
];

/// Keys and values of headers of instruments.
const WORDS_RADAR: [&str; 20] = [
    "SAMPLES",
    "FREQUENCY",
    "TIMEWINDOW",
    "LAST TRACE",
    "DISTANCE INTERVAL",
    "ANTENNAS",
    "COMMENT",
    "DATA VERSION",
    "ZERO LEVEL",
    "16",
    "32",
    ":",
    "NUMBER OF TRACES",
    "NUMBER OF PTS/TRC",
    "TIMEZERO AT POINT",
    "TOTAL TIME WINDOW",
    "POSITION UNITS",
    "ft",
    "m",
    "NOMINAL FREQUENCY",
];

/// Words of the other formats.
const WORDS: [&str; 44] = [
    "null",
    "true",
    "false",
    "{",
    "}",
    "[",
    "]",
    "\"inf\"",
    "inf",
    "stone",
    "model",
    "debye",
    "constant",
    "builtin",
    "pec",
    "base",
    "poles",
    "alias",
    "metadata",
    "x,y,radius",
    "width",
    "1 m",
    "5 %",
    "-3 dB",
    "2 GHz",
    "0.1 nm",
    "format_version",
    "sieve_mm",
    "t_ns,Ez",
    "time",
    "[ps]",
    "#",
    "//",
    ";",
    ",",
    "\"",
    "'''",
    "[tank]",
    "[[x]]",
    "\\u0000",
    "materials",
    "schema",
    "seed",
    "discs",
];

/// A line with any command that the reader knows, and as many words as it may want.
fn command(random: &mut Pcg64) -> String {
    // One that the reader acts on more often than one that it refuses.
    let mut name = COMMANDS[random.random_range(0..COMMANDS.len())];
    for _ in 0..3 {
        if matches!(name.1, ballast_gpr::gprmax::CommandKind::GprMaxOnly | ballast_gpr::gprmax::CommandKind::Retired(_))
        {
            name = COMMANDS[random.random_range(0..COMMANDS.len())];
        }
    }
    let count = random.random_range(0..14);
    let words: Vec<String> = (0..count)
        .map(|_| if random.random_bool(0.7) { number(random) } else { one(random, &WORDS_IN).into() })
        .collect();
    format!("#{}: {}", name.0, words.join(" "))
}

/// Runs a small model for a few steps, in whatever way it goes; asks a huge one to be refused.
fn run_if_small(mut model: Model) {
    let cells = model.grid.cells.iter().fold(1u64, |product, &count| product.saturating_mul(count as u64));
    let fdtd = Fdtd { threads: NonZeroUsize::new(1), ..Fdtd::default() };
    let go_on = |_: ballast_gpr::forward::Progress| ControlFlow::Continue(());
    if cells <= 20_000 && model.receivers.len() <= 500 {
        if model.iterations() > 30 {
            model.time_window = TimeWindow::Iterations(30);
        }
        if let Err(error) = fdtd.solve_stats(&model, &go_on) {
            said(&error);
        }
    } else if cells > 1 << 40 {
        // More than any memory holds: refused before anything is asked for.
        assert!(fdtd.solve_stats(&model, &go_on).is_err());
    }
}

/// Asks a file for everything that it says it has.
fn visit(path: &Path) {
    let Ok(file) = H5File::open(path) else { return };
    let mut groups = vec![("/".to_owned(), 0)];
    let mut seen = 0;
    while let Some((group, depth)) = groups.pop() {
        let _ = file.attribute(&group, "dx_dy_dz");
        let Ok((inner, datasets)) = file.children(&group) else { continue };
        let below = |name: &str| format!("{}/{name}", group.trim_end_matches('/'));
        for dataset in datasets.iter().map(|name| below(name)) {
            let _ = (file.shape(&dataset), file.is_f64(&dataset), file.attribute(&dataset, "Quantity"));
            let _ =
                (file.read_f64(&dataset).is_ok(), file.read_i64(&dataset).is_ok(), file.read_texts(&dataset).is_ok());
        }
        seen += 1;
        // A damaged file may have a group in itself.
        if depth < 4 && seen < 50 {
            groups.extend(inner.iter().map(|name| (below(name), depth + 1)));
        }
    }
}
