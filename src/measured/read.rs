//! Reading any instrument's file by its ending.

use std::fs;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use super::error::MeasuredError;
use super::recording::{Format, Recording};
use super::{dt1, dzt, ids, iprb, mala, segy};
use crate::files::FileError;

/// Reads a file of an instrument: the kind by its ending, in either case. Of a format of two files either may be named.
///
/// Amplitudes come as the file has them, in counts, around zero. The time axis is that of the instrument: the first sample
/// lies at the position that the header gives (DZT), or so that time zero falls on the sample that it names (DT1, IPRB).
///
/// # Errors
/// See [`MeasuredError`]; what a header contradicts without making the file unreadable is in [`Recording::warnings`].
pub fn read(path: &Path) -> Result<Recording, MeasuredError> {
    let mut formats = Format::of(path);
    let is_header = formats.first().is_some_and(|format| format.header_ending().is_some_and(|end| ends(path, end)));
    let data = if is_header {
        let found: Vec<_> = formats.iter().filter_map(|f| beside(path, f.endings()).map(|data| (*f, data))).collect();
        match &found[..] {
            [] => return Err(MeasuredError::NoCompanion { path: path.into(), wanted: data_endings(&formats) }),
            [(format, data)] => {
                formats = vec![*format];
                data.clone()
            }
            [(_, first), (_, second), ..] => {
                let (path, first, second) = (path.into(), first.clone(), second.clone());
                return Err(MeasuredError::TwoCompanions { path, first, second });
            }
        }
    } else {
        path.into()
    };
    let Some(&format) = formats.first() else {
        let known = Format::ALL.iter().flat_map(|f| f.endings()).map(|e| format!("`.{e}`")).collect::<Vec<_>>();
        return Err(MeasuredError::UnknownFormat { path: path.into(), known: known.join(", ") });
    };
    let bytes = whole(&data)?;
    let Some(ending) = format.header_ending() else {
        return match format {
            Format::SegY => segy::parse(&data, &bytes),
            Format::Ids => ids::parse(&data, &bytes),
            _ => dzt::parse(&data, &bytes),
        };
    };
    let header = if is_header { Some(path.to_path_buf()) } else { beside(&data, &[ending]) };
    let header =
        header.ok_or_else(|| MeasuredError::NoCompanion { path: data.clone(), wanted: header_name(format) })?;
    let text = whole(&header)?;
    match format {
        Format::Dt1 => dt1::parse(&header, &text, &data, &bytes),
        Format::Iprb => iprb::parse(&header, &text, &data, &bytes),
        _ => mala::parse(&header, &text, &data, &bytes, format),
    }
}

/// All bytes of a regular file: a device or a pipe may never end.
fn whole(path: &Path) -> Result<Vec<u8>, MeasuredError> {
    let mut file = fs::File::open(path).map_err(FileError::of("read", path))?;
    let about = file.metadata().map_err(FileError::of("read", path))?;
    if !about.is_file() {
        return Err(MeasuredError::NotAFile { path: path.into() });
    }
    let mut bytes = vec![];
    file.by_ref().take(about.len()).read_to_end(&mut bytes).map_err(FileError::of("read", path))?;
    Ok(bytes)
}

fn ends(path: &Path, ending: &str) -> bool {
    path.extension().is_some_and(|found| found.to_string_lossy().eq_ignore_ascii_case(ending))
}

/// The file of the same name with another ending, in whatever case.
fn beside(path: &Path, endings: &[&str]) -> Option<PathBuf> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let stem = path.file_stem()?;
    let fits = |name: &Path| endings.iter().any(|ending| ends(name, ending));
    let same = |name: &Path, exactly: bool| {
        name.file_stem().is_some_and(|found| found == stem || (!exactly && found.eq_ignore_ascii_case(stem)))
    };
    let names: Vec<PathBuf> =
        fs::read_dir(folder).ok()?.flatten().map(|entry| PathBuf::from(entry.file_name())).collect();
    let found = [true, false].iter().find_map(|exactly| names.iter().find(|name| fits(name) && same(name, *exactly)));
    found.map(|name| path.with_file_name(name))
}

fn header_name(format: Format) -> &'static str {
    match format {
        Format::Dt1 => "`.HD`",
        Format::Iprb => "`.iprh`",
        _ => "`.rad`",
    }
}

fn data_endings(formats: &[Format]) -> &'static str {
    match formats.first() {
        Some(Format::Dt1) => "`.DT1`",
        Some(Format::Iprb) => "`.iprb`",
        _ => "`.rd3` or `.rd7`",
    }
}
