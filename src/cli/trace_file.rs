//! Traces from whatever a user names: a folder of this program, gprMax's HDF5, files of instruments, columns of text.
//!
//! `FILE#12` is trace 12, `FILE#1:` channel 1 and `FILE#1:12` trace 12 of channel 1, all counted from 0.

use std::fs;
use std::path::{Path, PathBuf};

use crate::cli::error::CliError;
use crate::cli::folder;
use crate::compare::text;
use crate::files;
use crate::gprmax;
use crate::measured::{self, Format, Recording};
use crate::trace::{AScan, BScan, Component, ReceiverTraces, Traces};
use crate::units::Seconds;

/// Names of the results in a folder, the preferred first.
const RESULTS: [&str; 2] = ["fdtd.h5", "gprmax.h5"];

/// The result file that a target stands for.
///
/// # Errors
/// When a folder holds no result.
pub fn result_of(target: &Path) -> Result<PathBuf, CliError> {
    if !target.is_dir() {
        return Ok(target.into());
    }
    RESULTS.iter().map(|name| target.join(name)).find(|path| path.is_file()).ok_or_else(|| {
        CliError::input(format!(
            "the folder `{0}` holds no trace (`{1}` or `{2}`)\n\nhint: make one with `ballast-gpr run {0}`",
            target.display(),
            RESULTS[0],
            RESULTS[1]
        ))
    })
}

/// Both solvers' results of a folder, if both are there.
pub fn both_results(target: &Path) -> Option<[PathBuf; 2]> {
    let paths = RESULTS.map(|name| target.join(name));
    paths.iter().all(|path| path.is_file()).then_some(paths)
}

/// Reads one trace.
///
/// Of a file of gprMax it is what a radar would show (`Ez`, or else the strongest electric field) at the first receiver or
/// trace. Of an instrument's file with several traces it is the mean of all but the first, as suits a recording that
/// stood still; this, and what the file's header contradicts, is said on standard error.
///
/// # Errors
/// When the file cannot be read, or has no such trace.
pub fn read(target: &Path) -> Result<AScan, CliError> {
    let named = Named::of(target);
    if named.path.is_dir() && result_of(&named.path).is_err() {
        // The message of a folder without a result, unless it holds numbered ones.
        numbered_results(&named.path)?;
    }
    let Scans { scan, instrument } = load(&named, None, Columns::First)?;
    if let Some(index) = named.trace {
        return picked(&scan, index, &named.path);
    }
    let count = scan.count();
    if instrument && count > 1 {
        eprintln!(
            "`{0}` holds {count} traces: the mean of 1 to {1} is taken (`{0}#K` takes trace K, from 0)",
            named.path.display(),
            count - 1
        );
        return Ok(mean_but_first(&scan));
    }
    if count > 1 {
        eprintln!(
            "`{0}` holds {count} traces: the first is taken (`{0}#K` takes trace K, from 0)",
            named.path.display()
        );
    }
    let name = scan.name.clone();
    Ok(AScan { name, ..picked(&scan, 0, &named.path)? })
}

/// Reads all traces that lie side by side: those of a channel of an instrument's file, of a B-scan of gprMax (merged into
/// one file, or a folder of numbered files), of the columns of a text; a single trace is a radargram of one.
///
/// # Errors
/// When the file cannot be read, or has no such channel or trace.
pub fn read_scan(target: &Path) -> Result<BScan, CliError> {
    read_component(target, None, None)
}

/// As [`read_scan`], of one component of the field where a file of gprMax holds several; each has its own time of the first
/// sample, H half a step before E. Times of a text that are uneven are brought onto an axis of the step `resample`, if given.
///
/// # Errors
/// As [`read_scan`]; when the component was not recorded.
pub fn read_component(
    target: &Path,
    component: Option<Component>,
    resample: Option<Seconds>,
) -> Result<BScan, CliError> {
    let named = Named::of(target);
    let scan = load(&named, component, Columns::All(resample))?.scan;
    match named.trace {
        Some(index) => {
            let trace = picked(&scan, index, &named.path)?;
            let name = trace.name.clone();
            Ok(BScan::of(&[trace], name)?)
        }
        None => Ok(scan),
    }
}

/// Reads an instrument's file, if the name is of one.
///
/// # Errors
/// When it is one and cannot be read.
pub fn read_recording(target: &Path) -> Result<Option<Recording>, CliError> {
    let path = Named::of(target).path;
    Ok(if is_instrument(&path) { Some(measured::read(&path)?) } else { None })
}

/// The folder that `build` made, if the target is one or lies in one.
pub fn built_folder(target: &Path) -> Option<PathBuf> {
    let folder = if target.is_dir() { Some(target) } else { target.parent() };
    folder.filter(|folder| folder::is_built(folder)).map(Path::to_path_buf)
}

/// A path, and which channel and trace of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Named {
    /// The file or folder.
    pub path: PathBuf,
    /// The channel, from 0.
    pub channel: Option<usize>,
    /// The trace, from 0.
    pub trace: Option<usize>,
}

impl Named {
    /// Takes `#TRACE`, `#CHANNEL:` or `#CHANNEL:TRACE` off the end, unless there is a file of the whole name.
    pub fn of(target: &Path) -> Self {
        let whole = Self { path: target.into(), channel: None, trace: None };
        let text = target.to_string_lossy();
        let Some((path, choice)) = text.rsplit_once('#').filter(|_| !target.exists()) else { return whole };
        let number = |text: &str| text.parse::<usize>().ok();
        let (channel, trace) = match choice.split_once(':') {
            Some((channel, "")) => (number(channel), None),
            Some((channel, trace)) => (number(channel), number(trace)),
            None => (None, number(choice)),
        };
        let understood = channel.is_some() || (trace.is_some() && !choice.contains(':'));
        if understood { Self { path: path.into(), channel, trace } } else { whole }
    }
}

/// Traces, and whether an instrument recorded them.
struct Scans {
    scan: BScan,
    instrument: bool,
}

/// Which columns of a text are read when none is named.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Columns {
    First,
    /// All, onto an axis of this step where one is given.
    All(Option<Seconds>),
}

fn load(named: &Named, component: Option<Component>, columns: Columns) -> Result<Scans, CliError> {
    let path = &named.path;
    if path.is_dir() && result_of(path).is_err() {
        let traces = numbered_results(path)?
            .iter()
            .map(|file| Ok(gprmax_scan(file, component)?.trace(0)))
            .collect::<Result<Vec<_>, CliError>>()?;
        let scan = BScan::of(&traces.into_iter().flatten().collect::<Vec<_>>(), short_name(path))?;
        return Ok(Scans { scan, instrument: false });
    }
    let path = result_of(path)?;
    if is_instrument(&path) {
        return Ok(Scans { scan: instrument_scan(&path, named.channel)?, instrument: true });
    }
    if let Some(channel) = named.channel.filter(|channel| *channel > 0) {
        return Err(no_such("channel", channel, 1, &path));
    }
    let scan = if is_hdf5(&path)? {
        gprmax_scan(&path, component)?
    } else {
        let (name, text) = (short_name(&path), files::read_text(&path)?);
        let traces = match columns {
            Columns::First if named.trace.is_none() => {
                vec![text::read_trace(&text, &name, &text::TextOptions::default())?]
            }
            Columns::First => text::read_traces(&text, &name, None)?,
            Columns::All(resample) => text::read_traces(&text, &name, resample)?,
        };
        BScan::of(&traces, name)?
    };
    Ok(Scans { scan, instrument: false })
}

/// One channel of an instrument's file; warnings go to standard error.
fn instrument_scan(path: &Path, channel: Option<usize>) -> Result<BScan, CliError> {
    let recording = measured::read(path)?;
    for warning in &recording.warnings {
        eprintln!("warning: `{}`: {warning}", path.display());
    }
    let count = recording.channels.len();
    if count > 1 && channel.is_none() {
        eprintln!("`{0}` holds {count} channels: 0 is taken (`{0}#1:` takes channel 1)", path.display());
    }
    let channel = channel.unwrap_or(0);
    let mut scan =
        recording.channels.into_iter().nth(channel).ok_or_else(|| no_such("channel", channel, count, path))?;
    scan.name = if count > 1 { format!("{}#{channel}:", short_name(path)) } else { short_name(path) };
    Ok(scan)
}

/// The traces of the first receiver of a file of gprMax: one, or as many as were merged.
fn gprmax_scan(path: &Path, component: Option<Component>) -> Result<BScan, CliError> {
    let traces = gprmax::read_traces(path)?;
    let name = short_name(path);
    let component = match component {
        Some(component) => Some(component),
        None => traces.radar_trace().map(|trace| trace.component),
    };
    let component = component
        .ok_or_else(|| CliError::input(format!("`{}` holds no electric field at a receiver", path.display())))?;
    let found: Vec<AScan> =
        merged_receivers(&traces).iter().filter_map(|receiver| receiver.component(component)).cloned().collect();
    if found.is_empty() {
        let there: Vec<_> =
            traces.receivers.iter().take(1).flat_map(|r| &r.components).map(|trace| trace.component.name()).collect();
        return Err(CliError::input(format!(
            "`{}` holds no {} at its first receiver\n\nhint: it holds {}",
            path.display(),
            component.name(),
            there.join(", ")
        )));
    }
    Ok(BScan::of(&found, name)?)
}

/// The receivers that are the traces of the first one: merged files name them `NAME trace 1`, `NAME trace 2`, ….
fn merged_receivers(traces: &Traces) -> &[ReceiverTraces] {
    let base = |receiver: &ReceiverTraces| {
        let (base, number) = receiver.name.rsplit_once(" trace ")?;
        number.parse::<usize>().ok().map(|_| base.to_owned())
    };
    let first = traces.receivers.first().and_then(base);
    let same = |receiver: &&ReceiverTraces| first.is_some() && base(receiver) == first;
    let count = traces.receivers.iter().take_while(same).count().max(1);
    &traces.receivers[..count.min(traces.receivers.len())]
}

/// The files of gprMax in a folder, by their numbers: `scan1.h5`, `scan2.h5`, ….
fn numbered_results(folder: &Path) -> Result<Vec<PathBuf>, CliError> {
    let number = |path: &Path| -> Option<(String, u64)> {
        let stem = path.file_stem()?.to_str()?;
        let base = stem.trim_end_matches(|c: char| c.is_ascii_digit());
        has_hdf5_ending(path).then(|| stem[base.len()..].parse().ok().map(|number| (base.to_owned(), number)))?
    };
    let entries = fs::read_dir(folder).map_err(files::FileError::of("read", folder))?;
    let mut found: Vec<((String, u64), PathBuf)> =
        entries.flatten().filter_map(|entry| Some((number(&entry.path())?, entry.path()))).collect();
    found.sort();
    match (found.first(), found.last()) {
        (Some(((first, _), _)), Some(((last, _), _))) if first != last => Err(CliError::input(format!(
            "the folder `{}` holds more than one series of traces: `{first}…` and `{last}…`",
            folder.display()
        ))),
        (None, _) => Err(result_of(folder).err().unwrap_or_else(|| CliError::input("no trace"))),
        _ => Ok(found.into_iter().map(|(_, path)| path).collect()),
    }
}

fn picked(scan: &BScan, index: usize, path: &Path) -> Result<AScan, CliError> {
    let trace = scan.trace(index).ok_or_else(|| no_such("trace", index, scan.count(), path))?;
    Ok(AScan { name: format!("{}#{index}", short_name(path)), ..trace })
}

fn no_such(what: &str, index: usize, count: usize, path: &Path) -> CliError {
    CliError::input(format!(
        "`{}` has no {what} {index}: {what}s are counted from 0, and it has {count}",
        path.display()
    ))
}

/// The mean of all traces but the first, which instruments often record while they start.
fn mean_but_first(scan: &BScan) -> AScan {
    let rest = scan.count().saturating_sub(1).max(1);
    let mut samples = vec![0.0; scan.samples_per_trace()];
    for trace in scan.traces().skip(scan.count() - rest) {
        samples.iter_mut().zip(trace).for_each(|(sum, value)| *sum += value / rest as f64);
    }
    AScan {
        samples,
        time_step: scan.time_step,
        first_sample: scan.first_sample,
        component: scan.component,
        position: None,
        name: scan.name.clone(),
    }
}

/// The last two parts of a path: enough to tell siblings apart.
fn short_name(path: &Path) -> String {
    let parts: Vec<_> =
        path.components().rev().take(2).map(|part| part.as_os_str().to_string_lossy().into_owned()).collect();
    parts.into_iter().rev().collect::<Vec<_>>().join("/")
}

fn is_instrument(path: &Path) -> bool {
    !Format::of(path).is_empty()
}

fn has_hdf5_ending(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "h5" || extension == "out")
}

/// Whether a file is HDF5: by its ending (`.h5`, `.out`) or its first bytes.
///
/// # Errors
/// When it cannot be read.
pub fn is_hdf5(path: &Path) -> Result<bool, CliError> {
    if has_hdf5_ending(path) {
        return Ok(true);
    }
    let mut head = [0; 8];
    let mut file = fs::File::open(path).map_err(files::FileError::of("read", path))?;
    let count = std::io::Read::read(&mut file, &mut head).map_err(files::FileError::of("read", path))?;
    Ok(count == 8 && head == *b"\x89HDF\r\n\x1a\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trace_is_named_behind_the_path() {
        let named = |text: &str| {
            let named = Named::of(Path::new(text));
            (named.path.display().to_string(), named.channel, named.trace)
        };
        assert_eq!(named("a.dzt"), ("a.dzt".into(), None, None));
        assert_eq!(named("a#1.dzt#12"), ("a#1.dzt".into(), None, Some(12)));
        assert_eq!(named("a.dzt#1:"), ("a.dzt".into(), Some(1), None));
        assert_eq!(named("a.dzt#1:12"), ("a.dzt".into(), Some(1), Some(12)));
        assert_eq!(named("runs/#3a"), ("runs/#3a".into(), None, None));
    }

    #[test]
    fn the_mean_leaves_the_first_trace_out() {
        let scan = |samples: Vec<f64>| {
            BScan::new(samples, 2, Seconds(1.0), Seconds(0.0), Component::Recorded, "line".into()).unwrap()
        };
        assert_eq!(mean_but_first(&scan(vec![9.0, 9.0, 1.0, 2.0, 3.0, 6.0])).samples, [2.0, 4.0]);
        assert_eq!(mean_but_first(&scan(vec![9.0, 8.0])).samples, [9.0, 8.0]);
    }
}
