//! SEG-Y: 3200 bytes of text, 400 of numbers, then traces that each have a header of 240 bytes.

use std::path::Path;

use super::block::{name_of, scan};
use super::cursor::{ByteOrder, Bytes};
use super::error::MeasuredError;
use super::recording::{Format, Recording, SampleKind, Warning};
use super::segy_text::{self, TEXT};
use crate::units::Metres;

/// Bytes before the first trace.
pub(super) const FILE_HEADER: usize = 3600;
/// Bytes before the samples of a trace.
pub(super) const TRACE_HEADER: usize = 240;
/// Words before the time of the first sample in a header that this program writes.
pub(super) const FIRST_SAMPLE: &str = "BALLAST-GPR FIRST SAMPLE NS";

/// How a file is laid out, in one byte order.
#[derive(Debug, Clone, Copy)]
struct Layout {
    order: ByteOrder,
    kind: SampleKind,
    points: usize,
    data: usize,
    /// Whether whole traces fill the file to its end.
    fills: bool,
}

/// Reads the bytes of a file; `path` is for messages and names.
///
/// The standard is big-endian, and files of radars are often little-endian: the order in which the header makes whole
/// traces fill the file is taken. The time step is in **picoseconds**, as radars write it (in the standard, which is of
/// seismics, microseconds).
///
/// # Errors
/// See [`MeasuredError`].
pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<Recording, MeasuredError> {
    let mut warnings = vec![];
    let layout = layout(path, bytes, &mut warnings)?;
    let Layout { order, kind, points, data, fills } = layout;
    let bytes = Bytes { path, bytes, order };
    let record = TRACE_HEADER + points * kind.bytes();
    let count = bytes.size().saturating_sub(data) / record;
    if count == 0 {
        return Err(bytes.ends("trace 0", data, record));
    }
    if !fills {
        let rest = (bytes.size() - data) % record;
        warnings.push(Warning {
            field: "samples per trace".into(),
            offset: 3220,
            header: format!("{points} of {}", kind.name()),
            found: format!("{rest} bytes are left over behind trace {}", count - 1),
            taken: "they are left out",
        });
    }
    let step = step(&bytes, data, &mut warnings)?;
    let mut samples = Vec::with_capacity(count * points);
    let mut places = vec![];
    for index in 0..count {
        let at = data + index * record;
        let own = usize::from(bytes.u16("samples of trace", at + 114)?);
        if own != points && own != 0 {
            let limit = format!("all traces must have {points}, as byte 3220 says");
            return Err(bytes.wrong(&format!("samples of trace {index}"), at + 114, own, limit));
        }
        places.push(place(&bytes, at)?);
        bytes.samples(&format!("trace {index}"), at + TRACE_HEADER, points, kind, &mut samples)?;
    }
    let text = segy_text::lines(bytes.bytes);
    let radargram = scan(samples, points, step, first_sample(&text), name_of(path))?;
    // Zeros everywhere are no positions.
    let known = places.iter().any(|place| place.iter().any(|c| c.si() != 0.0));
    let placed = if known { radargram.with_positions(places)? } else { radargram };
    let mut header = vec![("byte order".to_owned(), order.name().to_owned())];
    header.push(("format code".into(), bytes.u16("format code", 3224)?.to_string()));
    let shown = text.into_iter().enumerate().filter(|(_, line)| line.len() > 3);
    header.extend(shown.map(|(index, line)| (format!("line {}", index + 1), line)));
    Ok(Recording {
        format: Format::SegY,
        sample_kind: kind,
        channels: vec![placed],
        antenna: None,
        centre_frequency: None,
        antenna_separation: None,
        header,
        warnings,
    })
}

/// Finds the byte order in which the file makes sense.
fn layout(path: &Path, bytes: &[u8], warnings: &mut Vec<Warning>) -> Result<Layout, MeasuredError> {
    let in_order = |order: ByteOrder| -> Result<Layout, MeasuredError> {
        let bytes = Bytes { path, bytes, order };
        let code = bytes.u16("format code", 3224)?;
        let kind = match code {
            1 => SampleKind::Ibm32,
            2 => SampleKind::Signed32,
            3 => SampleKind::Signed16,
            5 => SampleKind::Float32,
            _ => {
                let limit = "1 (IBM float), 2 (32 bits), 3 (16 bits) and 5 (IEEE float) are read, in either byte order";
                return Err(bytes.wrong("format code", 3224, code, limit));
            }
        };
        let further = usize::from(bytes.u16("number of further text headers", 3504)?);
        let data = FILE_HEADER + TEXT * if further < 1000 { further } else { 0 };
        let mut points = usize::from(bytes.u16("samples per trace", 3220)?);
        if points == 0 {
            points = bytes.count16("samples of trace 0", data + 114)?;
        }
        let record = TRACE_HEADER + points * kind.bytes();
        let traces = bytes.size().saturating_sub(data);
        Ok(Layout { order, kind, points, data, fills: traces >= record && traces.is_multiple_of(record) })
    };
    let (big, little) = (in_order(ByteOrder::Big), in_order(ByteOrder::Little));
    match (big, little) {
        (Ok(big), Ok(little)) => {
            if big.fills == little.fills {
                warnings.push(Warning {
                    field: "byte order".into(),
                    offset: 3220,
                    header: format!("{} samples if big-endian", big.points),
                    found: format!("{} if little-endian would do as well", little.points),
                    taken: "it is taken as big-endian",
                });
            }
            Ok(if little.fills && !big.fills { little } else { big })
        }
        (Ok(layout), Err(_)) | (Err(_), Ok(layout)) => Ok(layout),
        (Err(error), Err(_)) => Err(error),
    }
}

/// Time step, s.
fn step(bytes: &Bytes<'_>, data: usize, warnings: &mut Vec<Warning>) -> Result<f64, MeasuredError> {
    let (of_file, of_trace) = (bytes.u16("sample interval", 3216)?, bytes.u16("sample interval", data + 116)?);
    let step = match (of_file, of_trace) {
        (0, 0) => {
            let limit = "it must be a time in ps, above 0, here or in the header of the first trace";
            return Err(bytes.wrong("sample interval", 3216, 0, limit));
        }
        (0, step) | (step, _) => step,
    };
    if of_file != 0 && of_trace != 0 && of_file != of_trace {
        warnings.push(Warning {
            field: "sample interval".into(),
            offset: 3216,
            header: format!("{of_file} ps"),
            found: format!("the first trace says {of_trace} ps at byte {}", data + 116),
            taken: "the header of the file is believed",
        });
    }
    Ok(f64::from(step) / 1e12)
}

/// Where the receiver of the trace at byte `at` was: group coordinates in m, under the scalar of the header.
fn place(bytes: &Bytes<'_>, at: usize) -> Result<[Metres; 3], MeasuredError> {
    let scalar = f64::from(bytes.i16("coordinate scalar", at + 70)?);
    let factor = match scalar {
        0.0 => 1.0,
        s if s < 0.0 => -1.0 / s,
        s => s,
    };
    let [x, y] = [bytes.i32("group x", at + 80)?, bytes.i32("group y", at + 84)?].map(f64::from);
    // Only lengths: arc seconds (units 2) and degrees (3, 4) are no metres.
    let is_length = matches!(bytes.i16("coordinate units", at + 88)?, 0 | 1);
    Ok(if is_length { [Metres(factor * x), Metres(factor * y), Metres(0.0)] } else { [Metres(0.0); 3] })
}

/// The time of the first sample that this program wrote into the header, s; else zero.
fn first_sample(text: &[String]) -> f64 {
    let written = text.iter().find_map(|line| line.split_once(FIRST_SAMPLE)?.1.trim().parse::<f64>().ok());
    written.filter(|t| t.abs() < 1e9).unwrap_or(0.0) / 1e9
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(order: ByteOrder, code: u16, points: u16, traces: &[Vec<u8>]) -> Vec<u8> {
        let two = |value: u16| if order == ByteOrder::Big { value.to_be_bytes() } else { value.to_le_bytes() };
        let mut bytes = vec![0u8; FILE_HEADER];
        for (at, value) in [(3216, 400), (3220, points), (3224, code)] {
            bytes[at..at + 2].copy_from_slice(&two(value));
        }
        for trace in traces {
            let at = bytes.len();
            bytes.resize(at + TRACE_HEADER, 0);
            bytes[at + 114..at + 116].copy_from_slice(&two(points));
            bytes.extend(trace);
        }
        bytes
    }

    fn read(bytes: &[u8]) -> Result<Recording, MeasuredError> {
        parse(Path::new("a.sgy"), bytes)
    }

    #[test]
    fn either_order_is_found_by_the_size() {
        let values = [1.5f32, -2.25, 3.0];
        let big: Vec<u8> = values.iter().flat_map(|v| v.to_be_bytes()).collect();
        let little: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        for (order, trace) in [(ByteOrder::Big, big), (ByteOrder::Little, little)] {
            let recording = read(&file(order, 5, 3, &[trace.clone(), trace])).unwrap();
            assert_eq!(recording.channels[0].samples(), [1.5, -2.25, 3.0, 1.5, -2.25, 3.0]);
            assert!((recording.channels[0].time_step.si() - 400e-12).abs() < 1e-24);
            assert_eq!((recording.header[0].1.as_str(), recording.warnings.len()), (order.name(), 0));
        }
        // 3 is the format code 768 in the other order, which there is none of.
        let short = read(&file(ByteOrder::Big, 3, 2, &[vec![0xff, 0xfe, 0, 7]])).unwrap();
        assert_eq!(short.channels[0].samples(), [-2.0, 7.0]);
        let ibm = read(&file(ByteOrder::Big, 1, 1, &[vec![0xc2, 0x76, 0xa0, 0x00]])).unwrap();
        assert_eq!(ibm.channels[0].samples(), [-118.625]);
    }

    #[test]
    fn what_cannot_be_right_is_refused() {
        let message = |bytes: &[u8]| read(bytes).unwrap_err().to_string();
        let whole = file(ByteOrder::Big, 3, 2, &[vec![0, 1, 0, 2]]);
        let with = |at: usize, new: &[u8]| {
            let mut bytes = whole.clone();
            bytes[at..at + new.len()].copy_from_slice(new);
            bytes
        };
        assert_eq!(
            message(&whole[..3000]),
            "`a.sgy` ends too early: `format code` at byte 3224 needs 2 bytes, the file has 3000"
        );
        assert!(message(&with(3224, &[0, 9])).starts_with("`a.sgy`: `format code` at byte 3224 is 9: 1 (IBM float)"));
        assert_eq!(
            message(&with(3220, &[0xff, 0xff])),
            "`a.sgy` ends too early: `trace 0` at byte 3600 needs 131310 bytes, the file has 3844"
        );
        assert!(message(&with(3216, &[0, 0])).starts_with("`a.sgy`: `sample interval` at byte 3216 is 0"));
        assert_eq!(
            message(&with(3600 + 114, &[0, 3])),
            "`a.sgy`: `samples of trace 0` at byte 3714 is 3: all traces must have 2, as byte 3220 says"
        );
        assert_eq!(read(&[whole, vec![0; 5]].concat()).unwrap().warnings.len(), 1);
    }
}
