//! ImpulseRadar: a header of text (IPRH), and nothing but samples (IPRB). Experimental: made from a description alone.

use std::path::Path;

use super::block::{at_even_distances, is_window, name_of, scan, traces};
use super::cursor::Bytes;
use super::error::MeasuredError;
use super::recording::{Format, Recording, SampleKind};
use super::text_header::TextHeader;
use crate::units::Metres;

/// Reads the bytes of both files; paths are for messages and names.
///
/// `DATA VERSION` is the number of bits of a sample, 16 or 32; the time step is `TIMEWINDOW / SAMPLES`; time zero lies at
/// sample `ZERO LEVEL`.
///
/// # Errors
/// See [`MeasuredError`].
pub(super) fn parse(header_path: &Path, header: &[u8], path: &Path, bytes: &[u8]) -> Result<Recording, MeasuredError> {
    let header = TextHeader::read(header_path, header, b':')?;
    let bytes = Bytes::little(path, bytes);
    let points = header.count("SAMPLES")?;
    let kind = match header.needed("DATA VERSION")? {
        field if field.value == "16" => SampleKind::Signed16,
        field if field.value == "32" => SampleKind::Signed32,
        field => return Err(header.wrong(field, "it must be 16 or 32, the bits of a sample")),
    };
    let field = header.needed("TIMEWINDOW")?;
    let window = header.number("TIMEWINDOW")?.filter(is_window);
    let window = window.ok_or_else(|| header.wrong(field, "it must be a time in ns, 1e-6 to 1e9"))?;
    let step = window / points as f64 / 1e9;
    let zero = header.number("ZERO LEVEL")?.unwrap_or(0.0);
    let mut warnings = vec![];
    let samples = traces(&header, &bytes, points, kind, &mut warnings)?;
    let radargram = scan(samples, points, step, -zero * step, name_of(path))?;
    Ok(Recording {
        format: Format::Iprb,
        sample_kind: kind,
        channels: vec![at_even_distances(radargram, header.number("USER DISTANCE INTERVAL")?)?],
        antenna: header.text("ANTENNA"),
        centre_frequency: None,
        antenna_separation: header.number("ANTENNA SEPARATION")?.filter(|s| *s > 0.0).map(Metres),
        header: header.all(),
        warnings,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_widths_are_read() {
        let header = "HEADER VERSION: 20\nDATA VERSION: 16\nSAMPLES: 2\nLAST TRACE: 2\nTIMEWINDOW: 8\nZERO LEVEL: 1\n";
        let read =
            |header: &str, bytes: &[u8]| parse(Path::new("a.iprh"), header.as_bytes(), Path::new("a.iprb"), bytes);
        let short = read(header, &[1, 0, 2, 0, 3, 0, 0xff, 0xff]).unwrap();
        assert_eq!(short.channels[0].samples(), [1.0, 2.0, 3.0, -1.0]);
        assert!((short.channels[0].first_sample.si() + 4e-9).abs() < 1e-20);
        let long = read(&header.replace("16", "32"), &[1, 0, 0, 0, 0xff, 0xff, 0xff, 0xff]).unwrap();
        assert_eq!((long.channels[0].samples(), long.warnings.len()), (&[1.0, -1.0][..], 1));
        assert_eq!(
            read(&header.replace("16", "24"), &[0; 8]).unwrap_err().to_string(),
            "`a.iprh`: `DATA VERSION` at byte 33 is `24`: it must be 16 or 32, the bits of a sample"
        );
    }
}
