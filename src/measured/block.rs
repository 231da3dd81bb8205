//! What readers share: traces of equal length one behind the other, and small helpers.

use std::path::Path;

use super::cursor::Bytes;
use super::error::MeasuredError;
use super::recording::{SampleKind, Warning};
use super::text_header::TextHeader;
use crate::trace::{BScan, Component};
use crate::units::{Metres, Seconds};

/// Reads a file of nothing but traces of `points` samples, and holds their number against `LAST TRACE` of the header.
pub(super) fn traces(
    header: &TextHeader<'_>,
    bytes: &Bytes<'_>,
    points: usize,
    kind: SampleKind,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<f64>, MeasuredError> {
    let width = points.saturating_mul(kind.bytes());
    let count = bytes.size() / width;
    if count == 0 {
        return Err(bytes.ends("trace 0", 0, width));
    }
    if let Some(claimed) = header.whole("LAST TRACE")?.filter(|claimed| *claimed != count as u64) {
        warnings.push(Warning {
            field: "LAST TRACE".into(),
            offset: header.offset("LAST TRACE"),
            header: claimed.to_string(),
            found: format!("`{}` holds {count} traces", bytes.path.display()),
            taken: "those that are there are read",
        });
    }
    let rest = bytes.size() % width;
    if rest > 0 {
        warnings.push(Warning {
            field: "SAMPLES".into(),
            offset: header.offset("SAMPLES"),
            header: points.to_string(),
            found: format!("`{}` has {rest} bytes behind its last whole trace", bytes.path.display()),
            taken: "they are left out",
        });
    }
    let mut samples = Vec::with_capacity(count * points);
    for index in 0..count {
        bytes.samples(&format!("trace {index}"), index * width, points, kind, &mut samples)?;
    }
    Ok(samples)
}

/// A time window in ns that a radar can have.
pub(super) fn is_window(nanoseconds: &f64) -> bool {
    (1e-6..=1e9).contains(nanoseconds)
}

/// Puts traces at even distances along the line, where the header gives one above zero.
pub(super) fn at_even_distances(radargram: BScan, distance: Option<f64>) -> Result<BScan, MeasuredError> {
    let Some(distance) = distance.filter(|d| *d > 0.0 && *d < 1e6) else { return Ok(radargram) };
    let places = (0..radargram.count()).map(|k| [Metres(k as f64 * distance), Metres(0.0), Metres(0.0)]).collect();
    Ok(radargram.with_positions(places)?)
}

/// Makes a radargram of what an instrument recorded; times in s.
pub(super) fn scan(
    samples: Vec<f64>,
    points: usize,
    step: f64,
    first: f64,
    name: String,
) -> Result<BScan, MeasuredError> {
    Ok(BScan::new(samples, points, Seconds(step), Seconds(first), Component::Recorded, name)?)
}

/// The name of a file, without its folders.
pub(super) fn name_of(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}

/// Whether two finite numbers differ by more than a share of the second.
pub(super) fn differ(one: f64, other: f64, share: f64) -> bool {
    (one - other).abs() > share * other.abs()
}
