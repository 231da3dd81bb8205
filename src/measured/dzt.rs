//! GSSI DZT: a header of 1024 bytes for each channel, then scans in which the channels follow one another.

use std::path::Path;

use super::block::{at_even_distances, is_window, name_of, scan};
use super::cursor::Bytes;
use super::error::MeasuredError;
use super::recording::{Format, Recording, SampleKind, Warning};
use crate::units::Hertz;

/// Bytes of a header.
const HEADER: usize = 1024;
/// Samples at the beginning of each scan that are no signal: a counter of scans, and a marker.
const NO_SIGNAL: usize = 2;
/// Where the samples of newer systems begin, whatever the header says.
const NEWER_OFFSET: usize = 128 * HEADER;

/// What one header says.
struct Header {
    samples: usize,
    bits: u16,
    position: f64,
    range: f64,
    antenna: String,
}

impl Header {
    /// The header at byte `at`.
    fn read(bytes: &Bytes<'_>, at: usize) -> Result<Self, MeasuredError> {
        let samples = bytes.count16("rh_nsamp", at + 4)?;
        if samples <= NO_SIGNAL {
            let limit = "it must be 3 or more, since the first two samples of a scan are a counter and a marker";
            return Err(bytes.wrong("rh_nsamp", at + 4, samples, limit));
        }
        let bits = bytes.u16("rh_bits", at + 6)?;
        if !matches!(bits, 8 | 16 | 32) {
            return Err(bytes.wrong("rh_bits", at + 6, bits, "it must be 8, 16 or 32"));
        }
        let position = bytes.f32("rhf_position", at + 22)?;
        if !(-1e9..=1e9).contains(&position) {
            return Err(bytes.wrong("rhf_position", at + 22, position, "it must be a time in ns"));
        }
        let range = bytes.f32("rhf_range", at + 26)?;
        if !is_window(&range) {
            return Err(bytes.wrong("rhf_range", at + 26, range, "it must be a time window in ns, 1e-6 to 1e9"));
        }
        Ok(Self { samples, bits, position, range, antenna: bytes.text("rh_antname", at + 98, 14)? })
    }
}

/// Reads the bytes of a file; `path` is for messages and names.
///
/// Samples of 8 and 16 bits are unsigned, around 128 and 32768; those of 32 bits have a sign. The first two samples of a
/// scan are a counter and a marker and are left out: the first sample of a trace lies two steps after `rhf_position`. The
/// counter proves where the samples begin; where it contradicts the header, the place at which it counts is taken.
///
/// # Errors
/// See [`MeasuredError`].
pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<Recording, MeasuredError> {
    let bytes = Bytes::little(path, bytes);
    let mut warnings = vec![];
    let first = Header::read(&bytes, 0)?;
    let channels = bytes.count16("rh_nchan", 52)?;
    let (kind, width) = match first.bits {
        8 => (SampleKind::Unsigned8, 1),
        16 => (SampleKind::Unsigned16, 2),
        _ => (SampleKind::Signed32, 4),
    };
    let scan_bytes = first.samples * width * channels;
    let offset = data_offset(&bytes, channels, scan_bytes, first.bits, &mut warnings)?;
    let scans = (bytes.size() - offset.min(bytes.size())) / scan_bytes;
    if scans == 0 {
        return Err(bytes.ends("the first scan", offset, scan_bytes));
    }
    let rest = (bytes.size() - offset) % scan_bytes;
    if rest > 0 {
        warnings.push(Warning {
            field: "rh_nsamp".into(),
            offset: 4,
            header: format!("{} samples of {} bits in {channels} channels", first.samples, first.bits),
            found: format!("{rest} bytes are left over behind scan {}", scans - 1),
            taken: "they are left out",
        });
    }
    let per_metre = bytes.f32("rhf_spm", 14)?;
    let header_of = |channel: usize| -> Result<Header, MeasuredError> { Header::read(&bytes, HEADER * channel) };
    let mut radargrams = vec![];
    for channel in 0..channels {
        let own = match channel {
            0 => None,
            // The header of a channel may be blank: then it is that of the first.
            _ if HEADER * (channel + 1) > offset => None,
            _ => header_of(channel).ok().filter(|own| own.samples == first.samples && own.bits == first.bits),
        };
        let about = own.as_ref().unwrap_or(&first);
        if channel > 0 && own.is_none() {
            warnings.push(Warning {
                field: format!("header of channel {channel}"),
                offset: (HEADER * channel) as u64,
                header: "not one of this recording".into(),
                found: format!("rh_nchan at byte 52 is {channels}"),
                taken: "time window and position of channel 0 are taken",
            });
        }
        let mut samples = Vec::with_capacity(scans * (first.samples - NO_SIGNAL));
        for index in 0..scans {
            let at = offset + index * scan_bytes + (channel * first.samples + NO_SIGNAL) * width;
            bytes.samples(&format!("scan {index}"), at, first.samples - NO_SIGNAL, kind, &mut samples)?;
        }
        let step = about.range / first.samples as f64 / 1e9;
        let start = about.position / 1e9 + NO_SIGNAL as f64 * step;
        let name = if channels == 1 { name_of(path) } else { format!("{} channel {channel}", name_of(path)) };
        let radargram = scan(samples, first.samples - NO_SIGNAL, step, start, name)?;
        radargrams.push(at_even_distances(radargram, Some(1.0 / per_metre))?);
    }
    let name = |at| bytes.text("rh_antname", at, 14).unwrap_or_default();
    let antennas: Vec<String> = (0..channels)
        .map(|channel| name(HEADER * channel + 98))
        .take_while(|name| !name.is_empty() && !name.contains('?'))
        .collect();
    Ok(Recording {
        format: Format::Dzt,
        sample_kind: kind,
        channels: radargrams,
        centre_frequency: antenna_frequency(&first.antenna),
        antenna: (!antennas.is_empty()).then(|| antennas.join(", ")),
        antenna_separation: None,
        header: listed(&bytes, offset)?,
        warnings,
    })
}

/// Where the samples begin.
fn data_offset(
    bytes: &Bytes<'_>,
    channels: usize,
    scan_bytes: usize,
    bits: u16,
    warnings: &mut Vec<Warning>,
) -> Result<usize, MeasuredError> {
    let data = usize::from(bytes.u16("rh_data", 2)?);
    let by_rule = if data < HEADER { HEADER * data } else { HEADER * channels };
    let counts = |offset: usize| if offset >= HEADER { counter(bytes, offset, scan_bytes, bits) } else { None };
    let counted = counts(by_rule);
    // Where it counts, but from a later scan on, the scans before may lie where another rule looks for them.
    if counted == Some(0) {
        return Ok(by_rule);
    }
    let others = [data, HEADER * channels, HEADER, NEWER_OFFSET];
    let better = |other: &&usize| match counts(**other) {
        Some(first) => **other != by_rule && (counted.is_none() || first == 0),
        None => false,
    };
    if let Some(&other) = others.iter().find(better) {
        warnings.push(Warning {
            field: "rh_data".into(),
            offset: 2,
            header: format!("{data} (samples from byte {by_rule})"),
            found: format!("the counter of scans counts from byte {other}"),
            taken: "the counter is believed",
        });
        return Ok(other);
    }
    if counted.is_some() {
        return Ok(by_rule);
    }
    if by_rule < HEADER {
        return Err(bytes.wrong("rh_data", 2, data, "it must be 1 or more, since a header has 1024 bytes"));
    }
    if by_rule > bytes.size() {
        return Err(bytes.ends(&format!("samples (rh_data is {data})"), by_rule, scan_bytes));
    }
    let scans = (bytes.size() - by_rule) / scan_bytes;
    if scans > 1 {
        warnings.push(Warning {
            field: "rh_data".into(),
            offset: 2,
            header: format!("{data} (samples from byte {by_rule})"),
            found: "no counter of scans there proves it".into(),
            taken: "the header is believed, and the first two samples of each scan are left out",
        });
    }
    Ok(by_rule)
}

/// The first word of the first scan, if that of each scan counts up by one: two scans at least, or a zero in the only one.
fn counter(bytes: &Bytes<'_>, offset: usize, scan_bytes: usize, bits: u16) -> Option<u32> {
    let scans = bytes.size().saturating_sub(offset) / scan_bytes;
    let word = |index: usize| {
        let at = offset + index * scan_bytes;
        match bits {
            8 => bytes.slice("counter", at, 1).ok().map(|byte| u32::from(byte[0])),
            16 => bytes.u16("counter", at).ok().map(u32::from),
            _ => bytes.i32("counter", at).ok().map(i32::cast_unsigned),
        }
    };
    let mask = u32::MAX >> (32 - u32::from(bits));
    let rises = |index: usize| match (word(index), word(index + 1)) {
        (Some(one), Some(next)) => one.wrapping_add(1) & mask == next,
        _ => false,
    };
    let first = word(0).filter(|_| scans > 0)?;
    let counts = if scans == 1 { first == 0 } else { (0..scans - 1).all(rises) };
    counts.then_some(first)
}

/// Nominal frequency of an antenna: from a name that says it, or a model number that is known. Other numbers are model
/// numbers and no frequencies: `41000SA` is a horn of 1 GHz.
fn antenna_frequency(name: &str) -> Option<Hertz> {
    const KNOWN: [(&str, f64); 3] = [("41000S", 1e9), ("42000S", 2e9), ("5106", 200e6)];
    let upper = name.to_ascii_uppercase();
    for (unit, factor) in [("MHZ", 1e6), ("GHZ", 1e9)] {
        if let Some(number) = upper.strip_suffix(unit) {
            return number.trim().parse::<f64>().ok().filter(|n| *n > 0.0 && *n < 1e5).map(|n| Hertz(n * factor));
        }
    }
    KNOWN.iter().find(|(model, _)| upper.starts_with(model)).map(|(_, frequency)| Hertz(*frequency))
}

/// The other fields, for people to read.
fn listed(bytes: &Bytes<'_>, offset: usize) -> Result<Vec<(String, String)>, MeasuredError> {
    let date = |at: usize| -> Result<String, MeasuredError> {
        let word = bytes.i32("date", at)?.cast_unsigned();
        if word == 0 {
            return Ok("–".into());
        }
        let part = |from: u32, width: u32| word >> from & ((1 << width) - 1);
        let (second, minute, hour) = (2 * part(0, 5), part(5, 6), part(11, 5));
        let (day, month, year) = (part(16, 5), part(21, 4), 1980 + part(25, 7));
        Ok(format!("{year}-{month:02}-{day:02} {hour:02}:{minute:02}:{second:02}"))
    };
    let mut fields = vec![("data offset".to_owned(), format!("{offset}"))];
    for (name, at) in [("rh_tag", 0), ("rh_data", 2), ("rh_nsamp", 4), ("rh_bits", 6)] {
        fields.push((name.into(), bytes.u16(name, at)?.to_string()));
    }
    fields.push(("rh_zero".into(), bytes.i16("rh_zero", 8)?.to_string()));
    for (name, at) in [("rhf_sps", 10), ("rhf_spm", 14), ("rhf_mpm", 18), ("rhf_position", 22), ("rhf_range", 26)] {
        fields.push((name.into(), bytes.f32(name, at)?.to_string()));
    }
    fields.push(("rh_npass".into(), bytes.u16("rh_npass", 30)?.to_string()));
    fields.push(("created".into(), date(32)?));
    fields.push(("modified".into(), date(36)?));
    for (name, at) in [("rh_rgain", 40), ("rh_nrgain", 42), ("rh_text", 44), ("rh_ntext", 46)] {
        fields.push((name.into(), bytes.u16(name, at)?.to_string()));
    }
    for (name, at) in [("rh_proc", 48), ("rh_nproc", 50), ("rh_nchan", 52)] {
        fields.push((name.into(), bytes.u16(name, at)?.to_string()));
    }
    for (name, at) in [("rhf_epsr", 54), ("rhf_top", 58), ("rhf_depth", 62)] {
        fields.push((name.into(), bytes.f32(name, at)?.to_string()));
    }
    Ok(fields)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn model_numbers_are_no_frequencies() {
        let frequency = |name| antenna_frequency(name).map(Hertz::si);
        assert_eq!(frequency("41000SA"), Some(1e9));
        assert_eq!(frequency("42000S"), Some(2e9));
        assert_eq!(frequency("400MHz"), Some(4e8));
        assert_eq!(frequency("2.6 GHz"), Some(2.6e9));
        assert_eq!(frequency("5100"), None);
        assert_eq!(frequency("GHz"), None);
    }

    /// A file of `scans` scans of 4 samples, 16 bits, in `channels` channels, behind `headers` headers.
    fn file(data: u16, headers: usize, channels: u16, scans: u16) -> Vec<u8> {
        let mut bytes = vec![0; HEADER * headers];
        for start in (0..usize::from(channels).min(headers)).map(|channel| HEADER * channel) {
            for (at, value) in [(2, data), (4, 4), (6, 16), (52, channels)] {
                bytes[start + at..start + at + 2].copy_from_slice(&u16::to_le_bytes(value));
            }
            bytes[start + 22..start + 26].copy_from_slice(&(-1.0f32).to_le_bytes());
            bytes[start + 26..start + 30].copy_from_slice(&(8.0f32 + 8.0 * (start / HEADER) as f32).to_le_bytes());
        }
        for scan in 0..scans {
            for channel in 0..channels {
                for word in [scan, 0, 32768 + 10 * (scan % 100) + channel, 32767] {
                    bytes.extend(word.to_le_bytes());
                }
            }
        }
        bytes
    }

    fn read(bytes: &[u8]) -> Result<Recording, MeasuredError> {
        parse(Path::new("a.dzt"), bytes)
    }

    #[test]
    fn channels_lie_side_by_side_in_a_scan_each_with_its_own_window() {
        let recording = read(&file(2048, 2, 2, 3)).unwrap();
        assert_eq!(recording.warnings, []);
        let samples: Vec<_> = recording.channels.iter().map(|channel| channel.samples().to_vec()).collect();
        assert_eq!(samples, [[0.0, -1.0, 10.0, -1.0, 20.0, -1.0], [1.0, -1.0, 11.0, -1.0, 21.0, -1.0]]);
        // A step of 2 ns, then of 4 ns; the first sample two steps after -1 ns.
        for (channel, (step, first)) in recording.channels.iter().zip([(2e-9, 3e-9), (4e-9, 7e-9)]) {
            assert!((channel.time_step.si() - step).abs() < 1e-20 && (channel.first_sample.si() - first).abs() < 1e-20);
        }
    }

    #[test]
    fn the_counter_is_believed_over_the_header() {
        for (data, headers) in [(128, 128), (1024, 1), (1, 1)] {
            let recording = read(&file(data, headers, 1, 4)).unwrap();
            assert_eq!((recording.warnings.len(), recording.channels[0].count()), (0, 4), "{data}");
        }
        // The header says 128 kB of header, the samples begin behind one.
        let mut bytes = file(128, 1, 1, 20_000);
        let recording = read(&bytes).unwrap();
        assert_eq!(recording.channels[0].count(), 20_000);
        assert_eq!(
            recording.warnings[0].to_string(),
            "`rh_data` at byte 2 is 128 (samples from byte 131072), but the counter of scans counts from byte 1024: \
             the counter is believed"
        );
        bytes.truncate(1024 + 4 * 8 + 3);
        assert_eq!(read(&bytes).unwrap().warnings.len(), 2);
    }

    #[test]
    fn what_cannot_be_right_is_named_with_its_place() {
        let message = |at: usize, new: &[u8]| {
            let mut bytes = file(1024, 1, 1, 2);
            bytes[at..at + new.len()].copy_from_slice(new);
            read(&bytes).unwrap_err().to_string()
        };
        assert_eq!(message(4, &[0, 0]), "`a.dzt`: `rh_nsamp` at byte 4 is 0: it must be 1 or more");
        assert!(message(4, &[1, 0]).starts_with("`a.dzt`: `rh_nsamp` at byte 4 is 1: it must be 3 or more"));
        assert_eq!(message(6, &[12, 0]), "`a.dzt`: `rh_bits` at byte 6 is 12: it must be 8, 16 or 32");
        assert_eq!(
            message(26, &f32::NAN.to_le_bytes()),
            "`a.dzt`: `rhf_range` at byte 26 is NaN: it must be a time window in ns, 1e-6 to 1e9"
        );
        assert_eq!(message(52, &[0, 0]), "`a.dzt`: `rh_nchan` at byte 52 is 0: it must be 1 or more");
        assert_eq!(
            message(4, &[0xff, 0xff]),
            "`a.dzt` ends too early: `the first scan` at byte 1024 needs 131070 bytes, the file has 1040"
        );
        let cut = read(&file(1024, 1, 1, 2)[..27]).unwrap_err().to_string();
        assert_eq!(cut, "`a.dzt` ends too early: `rhf_range` at byte 26 needs 4 bytes, the file has 27");
    }
}
