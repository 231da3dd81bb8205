//! Checkpoints: the state of a run between two passes, in a file from which another process goes on to the same bits.
//!
//! A file begins with a line of text, `ballast-gpr checkpoint` and a JSON object that says what it is of; behind it are all
//! numbers of the state, little-endian, and eight bytes of checksum. It is written beside its place and renamed, so that
//! there is always a whole one. Whether it belongs to a model is told by a fingerprint of the model as it was read, with
//! everything that other files brought into it, and of the precision and the version of this program.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::Precision;
use super::state::{Numbers, State};
use crate::files;
use crate::model::Model;

/// The first words of a checkpoint.
const MAGIC: &str = "ballast-gpr checkpoint ";
/// Version of what follows.
const FORMAT: u32 = 1;
/// Longest first line that is read.
const LONGEST_HEADER: u64 = 4096;
/// Some thirty years: as good as never, and far from the end of any clock.
const LONGEST_WAIT: Duration = Duration::from_secs(1 << 30);
/// Numbers that are turned into bytes at a time.
const CHUNK: usize = 8192;

/// Where a run keeps its state, and when.
#[derive(Clone)]
pub struct Checkpoints<'a> {
    /// The file.
    pub path: PathBuf,
    /// Wall time from one to the next.
    pub every: Duration,
    /// A run that is asked to stop writes a last one if it has been stepping for this long, or has gone on from one.
    pub stop_after: Duration,
    /// Goes on from the file if it is there; otherwise it is left alone until it is written over.
    pub go_on: bool,
    /// Is told what happens to the file.
    pub tell: &'a (dyn Fn(CheckpointEvent<'_>) + Sync),
}

/// What happened to a checkpoint.
#[derive(Debug, Clone, Copy)]
pub enum CheckpointEvent<'a> {
    /// The run goes on from the file.
    Resumed {
        /// Steps done already.
        step: usize,
        /// Steps in all.
        iterations: usize,
    },
    /// The file was written.
    Written {
        /// Steps done.
        step: usize,
        /// Steps in all.
        iterations: usize,
        /// Its size.
        bytes: u64,
        /// How long the run stood still for it.
        took: Duration,
    },
    /// The file could not be written; the run goes on without.
    Failed {
        /// What the system said.
        error: &'a files::FileError,
    },
}

/// Why a run cannot go on from a checkpoint.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CheckpointError {
    /// The system does not let us read it.
    #[error("failed to read the checkpoint `{}`: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        reason: String,
    },
    /// Some other file.
    #[error("`{}` is not a checkpoint\n\nhint: begin anew with `--fresh`, which writes over it", path.display())]
    NotOne {
        /// The file.
        path: PathBuf,
    },
    /// A checkpoint of something else.
    #[error("the checkpoint `{}` has another {what}: {found}, wanted {wanted}\n\nhint: begin anew with `--fresh`", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// What differs.
        what: &'static str,
        /// What the file says.
        found: String,
        /// What the run would need.
        wanted: String,
    },
    /// A checkpoint that is cut short or changed.
    #[error("the checkpoint `{}` is damaged: {what}\n\nhint: begin anew with `--fresh`", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// How this shows.
        what: &'static str,
    },
}

/// The first line of a checkpoint.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
struct Header {
    format: u32,
    program: String,
    model: String,
    precision: String,
    iterations: usize,
    step: usize,
    bytes: u64,
}

/// Writes and reads the checkpoints of one run.
pub struct Keeper<'a> {
    settings: &'a Checkpoints<'a>,
    model: &'a Model,
    precision: Precision,
    /// Once it is known.
    fingerprint: Option<String>,
    /// From when on a request to stop makes a last one.
    stop_from: Instant,
    last: Instant,
}

impl<'a> Keeper<'a> {
    /// Starts the clock.
    pub fn new(settings: &'a Checkpoints<'a>, model: &'a Model, precision: Precision) -> Self {
        let now = Instant::now();
        let stop_from = now + settings.stop_after.min(LONGEST_WAIT);
        Self { settings, model, precision, fingerprint: None, stop_from, last: now }
    }

    /// When the next one is due.
    pub fn due(&self) -> Instant {
        self.last + self.settings.every.min(LONGEST_WAIT)
    }

    /// From when on a request to stop makes a last one.
    pub fn stop_from(&self) -> Instant {
        self.stop_from
    }

    fn header(&mut self, step: usize, bytes: u64) -> Header {
        let model = self.fingerprint.get_or_insert_with(|| fingerprint(self.model)).clone();
        Header {
            format: FORMAT,
            program: env!("CARGO_PKG_VERSION").into(),
            model,
            precision: self.precision.name().into(),
            iterations: self.model.iterations(),
            step,
            bytes,
        }
    }

    /// Writes the state after `step` steps; a failure is told, and the run may go on.
    pub fn write(&mut self, step: usize, state: &mut (impl State + ?Sized)) {
        let begin = Instant::now();
        let header = self.header(step, bytes_of(state));
        let written = files::write_atomically(&self.settings.path, |out| {
            let text = serde_json::to_string(&header)?;
            writeln!(out, "{MAGIC}{text}")?;
            let (mut sum, mut outcome, mut buffer) = (Checksum::default(), Ok(()), Vec::with_capacity(8 * CHUNK));
            state.visit(&mut |numbers| {
                if outcome.is_ok() {
                    outcome = each_chunk(numbers, &mut buffer, &mut |bytes| {
                        sum.add(bytes);
                        out.write_all(bytes)
                    });
                }
            });
            outcome?;
            out.write_all(&sum.value().to_le_bytes())
        });
        let iterations = header.iterations;
        (self.settings.tell)(match &written {
            Ok(()) => CheckpointEvent::Written { step, iterations, bytes: header.bytes, took: begin.elapsed() },
            Err(error) => CheckpointEvent::Failed { error },
        });
        self.last = Instant::now();
    }

    /// Loads the state from the file where there is one and it is wanted; the number of steps done.
    ///
    /// # Errors
    /// When the file is of something else, or damaged.
    pub fn load(&mut self, state: &mut (impl State + ?Sized)) -> Result<usize, CheckpointError> {
        let path = self.settings.path.clone();
        if !self.settings.go_on || !path.exists() {
            return Ok(0);
        }
        let unreadable =
            |error: io::Error| CheckpointError::Unreadable { path: path.clone(), reason: error.to_string() };
        let damaged = |what| CheckpointError::Damaged { path: path.clone(), what };
        let file = File::open(&path).map_err(unreadable)?;
        let length = file.metadata().map_err(unreadable)?.len();
        let mut file = BufReader::new(file);
        let mut line = vec![];
        (&mut file).take(LONGEST_HEADER).read_until(b'\n', &mut line).map_err(unreadable)?;
        let text = std::str::from_utf8(&line).ok().and_then(|line| line.strip_prefix(MAGIC));
        let Some(text) = text else { return Err(CheckpointError::NotOne { path }) };
        let found: Header = serde_json::from_str(text).map_err(|_| damaged("its first line cannot be read"))?;
        let wanted = self.header(found.step, bytes_of(state));
        check(&path, &found, &wanted)?;
        if length != line.len() as u64 + found.bytes + 8 {
            return Err(damaged("it is cut short or has something behind its end"));
        }
        let (mut sum, mut outcome, mut buffer) = (Checksum::default(), Ok(()), Vec::with_capacity(8 * CHUNK));
        state.visit(&mut |numbers| {
            if outcome.is_ok() {
                outcome = fill(numbers, &mut buffer, &mut file, &mut sum);
            }
        });
        outcome.map_err(unreadable)?;
        let mut said = [0; 8];
        file.read_exact(&mut said).map_err(unreadable)?;
        if u64::from_le_bytes(said) != sum.value() {
            return Err(damaged("its checksum is wrong"));
        }
        let iterations = found.iterations;
        // The steps of the process before are worth another one.
        self.stop_from = Instant::now();
        (self.settings.tell)(CheckpointEvent::Resumed { step: found.step, iterations });
        Ok(found.step)
    }
}

fn check(path: &Path, found: &Header, wanted: &Header) -> Result<(), CheckpointError> {
    let same = |what, found: String, wanted: String| {
        if found == wanted {
            return Ok(());
        }
        Err(CheckpointError::Foreign { path: path.into(), what, found, wanted })
    };
    same("format", found.format.to_string(), wanted.format.to_string())?;
    same("version of the program", found.program.clone(), wanted.program.clone())?;
    same("precision", found.precision.clone(), wanted.precision.clone())?;
    same("model", found.model.clone(), wanted.model.clone())?;
    same("number of steps", found.iterations.to_string(), wanted.iterations.to_string())?;
    if found.step == 0 || found.step >= found.iterations {
        return Err(CheckpointError::Damaged { path: path.into(), what: "its step is none of the run's" });
    }
    same("size", found.bytes.to_string(), wanted.bytes.to_string())
}

/// A fingerprint of a model, with all that other files brought into it (FNV-1a, 64 bit, hexadecimal).
fn fingerprint(model: &Model) -> String {
    struct Hash(u64);
    impl std::fmt::Write for Hash {
        fn write_str(&mut self, text: &str) -> std::fmt::Result {
            self.0 = text.bytes().fold(self.0, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
            Ok(())
        }
    }
    let mut hash = Hash(0xcbf2_9ce4_8422_2325);
    // What is printed is the whole model: a field that is added later counts without a word here. The number of threads is
    // left out, since it changes no bit.
    let _ = write!(hash, "{:?}", Model { threads: None, ..model.clone() });
    format!("{:016x}", hash.0)
}

fn bytes_of(state: &mut (impl State + ?Sized)) -> u64 {
    let mut bytes = 0;
    state.visit(&mut |numbers| bytes += numbers.bytes());
    bytes
}

/// Turns numbers into bytes, a chunk at a time.
fn each_chunk(
    numbers: Numbers<'_>,
    buffer: &mut Vec<u8>,
    take: &mut dyn FnMut(&[u8]) -> io::Result<()>,
) -> io::Result<()> {
    match numbers {
        Numbers::Single(numbers) => numbers.chunks(CHUNK).try_for_each(|chunk| {
            buffer.clear();
            buffer.extend(chunk.iter().flat_map(|number| number.to_le_bytes()));
            take(buffer)
        }),
        Numbers::Double(numbers) => numbers.chunks(CHUNK).try_for_each(|chunk| {
            buffer.clear();
            buffer.extend(chunk.iter().flat_map(|number| number.to_le_bytes()));
            take(buffer)
        }),
    }
}

/// Reads numbers from bytes, a chunk at a time.
fn fill(numbers: Numbers<'_>, buffer: &mut Vec<u8>, file: &mut dyn Read, sum: &mut Checksum) -> io::Result<()> {
    let mut next = |bytes: usize, take: &mut dyn FnMut(&[u8])| {
        buffer.resize(bytes, 0);
        file.read_exact(buffer)?;
        sum.add(buffer);
        take(buffer);
        Ok(())
    };
    match numbers {
        Numbers::Single(numbers) => numbers.chunks_mut(CHUNK).try_for_each(|chunk| {
            next(4 * chunk.len(), &mut |bytes| {
                let (words, _) = bytes.as_chunks();
                chunk.iter_mut().zip(words).for_each(|(number, word)| *number = f32::from_le_bytes(*word));
            })
        }),
        Numbers::Double(numbers) => numbers.chunks_mut(CHUNK).try_for_each(|chunk| {
            next(8 * chunk.len(), &mut |bytes| {
                let (words, _) = bytes.as_chunks();
                chunk.iter_mut().zip(words).for_each(|(number, word)| *number = f64::from_le_bytes(*word));
            })
        }),
    }
}

/// A checksum that a flipped bit, or numbers that have changed places, show in.
#[derive(Default)]
struct Checksum(u64);

impl Checksum {
    fn add(&mut self, bytes: &[u8]) {
        let (words, rest) = bytes.as_chunks();
        let mut last = [0; 8];
        last[..rest.len()].copy_from_slice(rest);
        for word in words.iter().chain([&last]) {
            // The multiplier of splitmix64; odd, so that no step loses a bit.
            self.0 = (self.0 ^ u64::from_le_bytes(*word)).rotate_left(23).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        }
    }

    fn value(&self) -> u64 {
        self.0 ^ (self.0 >> 31)
    }
}
