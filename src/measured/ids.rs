//! IDS dt: records of fixed length with a tag each, then traces. Experimental: made from a description alone.

use std::path::Path;

use super::block::{at_even_distances, is_window, name_of, scan};
use super::cursor::Bytes;
use super::error::MeasuredError;
use super::recording::{Format, Recording, SampleKind, Warning};
use crate::units::Hertz;

/// Lengths that records have been described with.
const RECORD_LENGTHS: [i16; 2] = [1024, 2052];
/// Words of 16 bits before the samples of a trace: two marks.
const MARKS: usize = 2;
/// Numbers of text in the header record, 16 characters each, in this order.
const NUMBERS: [&str; 10] = [
    "radar_freq",
    "prop_vel",
    "sweep_time",
    "sweep_time_tot",
    "scan_freq",
    "scan_time_acq",
    "sweep_dx",
    "wheel_dx",
    "x_cell",
    "y_cell",
];

/// Reads the bytes of a file; `path` is for messages and names.
///
/// The time step is `sweep_time_tot / (n_sampler_y - 1)`; the first sample lies at zero.
///
/// # Errors
/// See [`MeasuredError`].
pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<Recording, MeasuredError> {
    let bytes = Bytes::little(path, bytes);
    let letter = bytes.slice("version", 0, 1)?[0];
    if letter != b'V' {
        return Err(bytes.wrong("version", 0, letter, "a file of IDS begins with the letter V (86)"));
    }
    let length = bytes.i16("len_rec", 4)?;
    if !RECORD_LENGTHS.contains(&length) {
        return Err(bytes.wrong("len_rec", 4, length, "it must be 1024 or 2052"));
    }
    let length = length.unsigned_abs() as usize;
    let (header, data) = records(&bytes, length)?;
    let counts = header + 4;
    let claimed = bytes.i32("n_sampler_x", counts + 12)?;
    let points = bytes.i32("n_sampler_y", counts + 16)?;
    let points = usize::try_from(points).ok().filter(|count| *count > 1).ok_or_else(|| {
        bytes.wrong("n_sampler_y", counts + 16, points, "it must be 2 or more, the samples of a trace")
    })?;
    let mut listed = vec![("n_sampler_x".to_owned(), claimed.to_string())];
    let mut number = |index: usize| -> Result<f64, MeasuredError> {
        let at = counts + 44 + 16 * index;
        let text = bytes.text(NUMBERS[index], at, 16)?;
        listed.push((NUMBERS[index].into(), text.clone()));
        Ok(text.parse::<f64>().unwrap_or(f64::NAN))
    };
    let mut numbers = [f64::NAN; NUMBERS.len()];
    for (index, value) in numbers.iter_mut().enumerate() {
        *value = number(index)?;
    }
    let [frequency, _, _, sweep, _, _, _, _, distance, _] = numbers;
    if !is_window(&(1e9 * sweep)) {
        let limit = "it must be a time in s, 1e-15 to 1";
        return Err(bytes.wrong("sweep_time_tot", counts + 44 + 48, sweep, limit));
    }
    let width = 2 * (MARKS + points);
    let count = bytes.size().saturating_sub(data) / width;
    if count == 0 {
        return Err(bytes.ends("trace 0", data, width));
    }
    let mut warnings = vec![];
    if i64::from(claimed) != count as i64 {
        warnings.push(Warning {
            field: "n_sampler_x".into(),
            offset: (counts + 12) as u64,
            header: claimed.to_string(),
            found: format!("`{}` holds {count} traces", path.display()),
            taken: "those that are there are read",
        });
    }
    let mut samples = Vec::with_capacity(count * points);
    for index in 0..count {
        let at = data + index * width + 2 * MARKS;
        bytes.samples(&format!("trace {index}"), at, points, SampleKind::Signed16, &mut samples)?;
    }
    let step = sweep / (points as f64 - 1.0);
    Ok(Recording {
        format: Format::Ids,
        sample_kind: SampleKind::Signed16,
        channels: vec![at_even_distances(scan(samples, points, step, 0.0, name_of(path))?, Some(distance))?],
        antenna: None,
        // The unit of `radar_freq` is not described: what is below 100000 can only be MHz.
        centre_frequency: (frequency > 0.0).then_some(Hertz(if frequency < 1e5 { 1e6 * frequency } else { frequency })),
        antenna_separation: None,
        header: listed,
        warnings,
    })
}

/// Where the record with the tag `H` begins, and where the samples do: at the first tag that begins with `R`.
fn records(bytes: &Bytes<'_>, length: usize) -> Result<(usize, usize), MeasuredError> {
    let mut header = None;
    // The first record, with the version, has its tag at its beginning like the others.
    for at in (0..bytes.size()).step_by(length) {
        match bytes.slice("tag of a record", at, 4)?[0] {
            b'R' => {
                let missing = || bytes.wrong("tag of a record", at, "R", "no record with the tag H comes before it");
                return Ok((header.ok_or_else(missing)?, at));
            }
            b'H' => header = header.or(Some(at)),
            _ => {}
        }
    }
    Err(bytes.ends("record with the tag R", bytes.size(), 4))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(points: i32, traces: &[[i16; 5]]) -> Vec<u8> {
        let mut bytes = vec![0u8; 2048];
        bytes[..4].copy_from_slice(b"V123");
        bytes[4..6].copy_from_slice(&1024i16.to_le_bytes());
        bytes[1024] = b'H';
        for (index, value) in [(3, 2), (4, points)] {
            let at = 1028 + 4 * index;
            bytes[at..at + 4].copy_from_slice(&i32::to_le_bytes(value));
        }
        for (index, text) in [(0, "400"), (3, "8e-9"), (8, "0.05")] {
            let at = 1028 + 44 + 16 * index;
            bytes[at..at + text.len()].copy_from_slice(text.as_bytes());
        }
        // The samples begin with the record whose tag begins with R: its first bytes are the first mark.
        for trace in traces {
            trace.iter().for_each(|word| bytes.extend(word.to_le_bytes()));
        }
        bytes
    }

    const MARK: i16 = b'R' as i16;

    #[test]
    fn a_file_as_described_is_read() {
        let bytes = file(3, &[[MARK, 0, 1, 2, 3], [MARK, 0, -4, -5, -6]]);
        let recording = parse(Path::new("a.dt"), &bytes).unwrap();
        let radargram = &recording.channels[0];
        assert_eq!((radargram.samples(), recording.warnings.len()), (&[1.0, 2.0, 3.0, -4.0, -5.0, -6.0][..], 0));
        assert!((radargram.time_step.si() - 4e-9).abs() < 1e-20);
        assert_eq!(recording.centre_frequency.map(Hertz::si), Some(4e8));
    }

    #[test]
    fn what_cannot_be_right_is_refused() {
        let message = |bytes: &[u8]| parse(Path::new("a.dt"), bytes).unwrap_err().to_string();
        assert_eq!(message(b"X"), "`a.dt`: `version` at byte 0 is 88: a file of IDS begins with the letter V (86)");
        assert_eq!(
            message(&file(i32::MAX, &[[MARK, 0, 1, 2, 3]])),
            "`a.dt` ends too early: `trace 0` at byte 2048 needs 4294967298 bytes, the file has 2058"
        );
        assert_eq!(
            message(&file(-1, &[[MARK, 0, 1, 2, 3]])),
            "`a.dt`: `n_sampler_y` at byte 1044 is -1: it must be 2 or more, the samples of a trace"
        );
        assert_eq!(
            message(&file(3, &[])),
            "`a.dt` ends too early: `record with the tag R` at byte 2048 needs 4 bytes, the file has 2048"
        );
    }
}
