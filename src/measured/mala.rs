//! MALÅ: a header of text (RAD), and nothing but samples (RD3 of 16 bits, RD7 of 32).

use std::path::Path;

use super::block::{at_even_distances, differ, is_window, name_of, scan, traces};
use super::cursor::Bytes;
use super::error::MeasuredError;
use super::recording::{Format, Recording, SampleKind, Warning};
use super::text_header::TextHeader;
use crate::units::{Hertz, Metres};

/// Words before the time of the first sample in a comment that this program writes.
pub(super) const FIRST_SAMPLE: &str = "ballast-gpr first sample ns";

/// Reads the bytes of both files; paths are for messages and names.
///
/// The time step is `1 / FREQUENCY` (the sampling frequency, MHz), which holds where `TIMEWINDOW` has been seen to be
/// wrong. The header tells no time zero that could be relied on: the first sample lies at zero, unless a comment of this
/// program says otherwise.
///
/// # Errors
/// See [`MeasuredError`].
pub(super) fn parse(
    header_path: &Path,
    header: &[u8],
    path: &Path,
    bytes: &[u8],
    format: Format,
) -> Result<Recording, MeasuredError> {
    let header = TextHeader::read(header_path, header, b':')?;
    let bytes = Bytes::little(path, bytes);
    let kind = if format == Format::Rd7 { SampleKind::Signed32 } else { SampleKind::Signed16 };
    let mut warnings = vec![];
    let points = header.count("SAMPLES")?;
    let step = step(&header, points, &mut warnings)?;
    let samples = traces(&header, &bytes, points, kind, &mut warnings)?;
    let radargram = scan(samples, points, step, first_sample(&header), name_of(path))?;
    let antenna = header.text("ANTENNAS").or_else(|| header.text("ANTENNA"));
    Ok(Recording {
        format,
        sample_kind: kind,
        channels: vec![at_even_distances(radargram, header.number("DISTANCE INTERVAL")?)?],
        centre_frequency: antenna.as_deref().and_then(leading_megahertz),
        antenna,
        antenna_separation: header.number("ANTENNA SEPARATION")?.filter(|s| *s > 0.0).map(Metres),
        header: header.all(),
        warnings,
    })
}

/// Time step, s.
fn step(header: &TextHeader<'_>, points: usize, warnings: &mut Vec<Warning>) -> Result<f64, MeasuredError> {
    let window = header.number("TIMEWINDOW")?.filter(is_window);
    let by_window = window.map(|window| window / points as f64 / 1e9);
    match header.number("FREQUENCY")?.filter(|f| *f > 1e-3 && *f < 1e9) {
        Some(frequency) => {
            let step = 1.0 / frequency / 1e6;
            if let (Some(window), Some(other)) = (window, by_window)
                && differ(other, step, 0.01)
                // A window that counts the steps between the samples, and not the samples.
                && differ(other * points as f64, step * (points as f64 - 1.0), 0.01)
            {
                warnings.push(Warning {
                    field: "TIMEWINDOW".into(),
                    offset: header.offset("TIMEWINDOW"),
                    header: format!("{window} ns"),
                    found: format!("{points} samples at {frequency} MHz take {:.3} ns", 1e9 * step * points as f64),
                    taken: "the frequency is believed",
                });
            }
            Ok(step)
        }
        None => {
            let step = by_window.ok_or_else(|| match header.get("FREQUENCY").or_else(|| header.get("TIMEWINDOW")) {
                Some(field) => header.wrong(field, "it, or else `TIMEWINDOW`, must be 1e-6 to 1e9"),
                None => header.missing("FREQUENCY"),
            })?;
            warnings.push(Warning {
                field: "FREQUENCY".into(),
                offset: header.offset("FREQUENCY"),
                header: header.text("FREQUENCY").unwrap_or("missing".into()),
                found: format!("`TIMEWINDOW` is {} ns", window.unwrap_or_default()),
                taken: "the step is the window over the samples",
            });
            Ok(step)
        }
    }
}

/// The time of the first sample that this program wrote into a comment, s; else zero.
fn first_sample(header: &TextHeader<'_>) -> f64 {
    let comment = header.text("COMMENT").unwrap_or_default();
    let number = comment.split_once(FIRST_SAMPLE).and_then(|(_, rest)| rest.split([';', ' ']).find(|w| !w.is_empty()));
    let nanoseconds = number.and_then(|number| number.parse::<f64>().ok()).filter(|t| t.abs() < 1e9);
    nanoseconds.unwrap_or(0.0) / 1e9
}

/// `500 MHz shielded` and `500_shielded` are of 500 MHz.
fn leading_megahertz(antenna: &str) -> Option<Hertz> {
    let digits: String = antenna.chars().take_while(|c| c.is_ascii_digit()).collect();
    let rest = antenna[digits.len()..].trim_start_matches([' ', '_']).to_ascii_uppercase();
    let frequency = digits.parse::<f64>().ok().filter(|f| *f > 0.0 && *f < 1e5)?;
    if rest.starts_with("GHZ") { Some(Hertz(1e9 * frequency)) } else { Some(Hertz(1e6 * frequency)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RAD: &str = "SAMPLES:3\r\nFREQUENCY:1000.0\r\nTIMEWINDOW:3.0\r\nLAST TRACE:2\r\nDISTANCE INTERVAL: 0.5\r\n\
                       ANTENNAS:500_shielded\r\nANTENNA SEPARATION: 0.18\r\n";

    fn read(header: &str, words: &[i16]) -> Result<Recording, MeasuredError> {
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        parse(Path::new("a.rad"), header.as_bytes(), Path::new("a.rd3"), &bytes, Format::Rd3)
    }

    #[test]
    fn a_pair_is_read() {
        let recording = read(RAD, &[1, 2, 3, -4, -5, -6]).unwrap();
        let radargram = &recording.channels[0];
        assert_eq!((recording.warnings.as_slice(), radargram.count()), (&[][..], 2));
        assert_eq!(radargram.samples(), [1.0, 2.0, 3.0, -4.0, -5.0, -6.0]);
        assert!((radargram.time_step.si() - 1e-9).abs() < 1e-22);
        assert_eq!(radargram.positions().unwrap()[1][0].si(), 0.5);
        assert_eq!(recording.centre_frequency.map(Hertz::si), Some(500e6));
    }

    /// As in a real file, whose window is twice its samples over its frequency.
    #[test]
    fn the_frequency_is_believed_over_the_window() {
        let recording = read(&RAD.replace("TIMEWINDOW:3.0", "TIMEWINDOW:6.0"), &[1, 2, 3, 4, 5, 6, 7]).unwrap();
        let told: Vec<_> = recording.warnings.iter().map(ToString::to_string).collect();
        assert_eq!(
            told,
            [
                "`TIMEWINDOW` at byte 40 is 6 ns, but 3 samples at 1000 MHz take 3.000 ns: the frequency is believed",
                "`SAMPLES` at byte 8 is 3, but `a.rd3` has 2 bytes behind its last whole trace: they are left out"
            ]
        );
        assert!((recording.channels[0].time_step.si() - 1e-9).abs() < 1e-22);
        let by_window = read(&RAD.replace("FREQUENCY:1000.0", "FREQUENCY:0"), &[1, 2, 3, 4, 5, 6]).unwrap();
        assert!((by_window.channels[0].time_step.si() - 1e-9).abs() < 1e-22);
        assert_eq!(by_window.warnings.len(), 1);
    }

    #[test]
    fn claims_beyond_the_file_are_refused() {
        assert_eq!(
            read(&RAD.replace("SAMPLES:3", "SAMPLES:4294967295"), &[1, 2, 3]).unwrap_err().to_string(),
            "`a.rd3` ends too early: `trace 0` at byte 0 needs 8589934590 bytes, the file has 6"
        );
        assert_eq!(
            read("SAMPLES:3\n", &[1, 2, 3]).unwrap_err().to_string(),
            "`a.rad` has no field `FREQUENCY` in its 10 bytes"
        );
    }
}
