//! Sensors & Software pulseEKKO: a header of text (HD), and traces that each have a header of 128 bytes (DT1).

use std::path::Path;

use super::block::{differ, is_window, name_of, scan};
use super::cursor::Bytes;
use super::error::MeasuredError;
use super::recording::{Format, Recording, SampleKind, Warning};
use super::text_header::TextHeader;
use crate::units::{Hertz, Metres};

/// Bytes before the samples of a trace.
pub(super) const TRACE_HEADER: usize = 128;
/// Metres in a foot, exactly (international yard and pound agreement of 1959).
const FOOT: f64 = 0.3048;

/// Reads the bytes of both files; paths are for messages and names.
///
/// The time step is `TOTAL TIME WINDOW / NUMBER OF PTS/TRC`, compared with the step in picoseconds that each trace has;
/// time zero lies at `TIMEZERO AT POINT`, which counts from 1 and may have a fraction.
///
/// # Errors
/// See [`MeasuredError`].
pub(super) fn parse(header_path: &Path, header: &[u8], path: &Path, bytes: &[u8]) -> Result<Recording, MeasuredError> {
    let header = TextHeader::read(header_path, header, b'=')?;
    let bytes = Bytes::little(path, bytes);
    let mut warnings = vec![];
    let points = points(&header, &bytes, &mut warnings)?;
    let record = TRACE_HEADER + 2 * points;
    let count = bytes.size() / record;
    if count == 0 {
        return Err(bytes.ends("trace 0", 0, record));
    }
    if let Some(claimed) = header.whole("NUMBER OF TRACES")?.filter(|claimed| *claimed != count as u64) {
        warnings.push(Warning {
            field: "NUMBER OF TRACES".into(),
            offset: header.offset("NUMBER OF TRACES"),
            header: claimed.to_string(),
            found: format!("`{}` holds {count}", path.display()),
            taken: "those that are there are read",
        });
    }
    let rest = bytes.size() % record;
    if rest > 0 {
        warnings.push(Warning {
            field: format!("trace {count}"),
            offset: (count * record) as u64,
            header: format!("{record} bytes"),
            found: format!("only {rest} of them are there"),
            taken: "it is left out",
        });
    }
    let step = step(&header, &bytes, points, &mut warnings)?;
    let zero = match header.number("TIMEZERO AT POINT")? {
        Some(point) => point,
        None => {
            warnings.push(Warning {
                field: "TIMEZERO AT POINT".into(),
                offset: header.offset("TIMEZERO AT POINT"),
                header: "missing".into(),
                found: "time zero must lie somewhere".into(),
                taken: "the first sample is taken for it",
            });
            1.0
        }
    };
    let unit = unit_of_position(&header, &mut warnings);
    let mut samples = Vec::with_capacity(count * points);
    let mut places = vec![];
    for index in 0..count {
        let at = index * record;
        let own = bytes.f32("points of trace", at + 8)?;
        if own != points as f64 && own != 0.0 {
            let limit = format!("all traces must have {points} points, as the first");
            return Err(bytes.wrong(&format!("points of trace {index}"), at + 8, own, limit));
        }
        let place = bytes.f32("position", at + 4)?;
        if let Some(unit) = unit.filter(|_| place.is_finite()) {
            places.push([Metres(place * unit), Metres(0.0), Metres(0.0)]);
        }
        let field = format!("trace {index}");
        bytes.samples(&field, at + TRACE_HEADER, points, SampleKind::Signed16, &mut samples)?;
    }
    let radargram = scan(samples, points, step, -(zero - 1.0) * step, name_of(path))?;
    let placed = if places.len() == count { radargram.with_positions(places)? } else { radargram };
    let frequency = header.number("NOMINAL FREQUENCY")?.filter(|f| *f > 0.0);
    Ok(Recording {
        format: Format::Dt1,
        sample_kind: SampleKind::Signed16,
        channels: vec![placed],
        antenna: frequency.map(|f| format!("{f} MHz")),
        centre_frequency: frequency.map(|f| Hertz(1e6 * f)),
        antenna_separation: header
            .number("ANTENNA SEPARATION")?
            .filter(|s| *s > 0.0)
            .zip(unit)
            .map(|(s, unit)| Metres(s * unit)),
        header: header.all(),
        warnings,
    })
}

/// Samples of a trace: as the header says, unless the traces say otherwise and fill the file.
fn points(header: &TextHeader<'_>, bytes: &Bytes<'_>, warnings: &mut Vec<Warning>) -> Result<usize, MeasuredError> {
    let claimed = header.count("NUMBER OF PTS/TRC")?;
    let own = bytes.f32("points of trace 0", 8)?;
    let width = bytes.f32("bytes per sample of trace 0", 20)?;
    if width != 2.0 && width != 0.0 {
        return Err(bytes.wrong("bytes per sample of trace 0", 20, width, "only samples of 2 bytes are read"));
    }
    if own == claimed as f64 || own == 0.0 {
        return Ok(claimed);
    }
    let fills = |points: usize| bytes.size().is_multiple_of(TRACE_HEADER + 2 * points);
    let whole = (1.0..=1e7).contains(&own) && own.fract() == 0.0;
    if !(whole && fills(own as usize)) {
        let limit = format!("`NUMBER OF PTS/TRC` is {claimed}, and one of the two must fill the file");
        return Err(bytes.wrong("points of trace 0", 8, own, limit));
    }
    warnings.push(Warning {
        field: "NUMBER OF PTS/TRC".into(),
        offset: header.offset("NUMBER OF PTS/TRC"),
        header: claimed.to_string(),
        found: format!("the traces in `{}` have {own}", bytes.path.display()),
        taken: "the traces are believed",
    });
    Ok(own as usize)
}

/// Time step, s.
fn step(
    header: &TextHeader<'_>,
    bytes: &Bytes<'_>,
    points: usize,
    warnings: &mut Vec<Warning>,
) -> Result<f64, MeasuredError> {
    let field = header.needed("TOTAL TIME WINDOW")?;
    let window = header.number("TOTAL TIME WINDOW")?.filter(is_window);
    let window = window.ok_or_else(|| header.wrong(field, "it must be a time in ns, 1e-6 to 1e9"))?;
    let claimed = header.count("NUMBER OF PTS/TRC")?;
    let step = window / claimed as f64 / 1e9;
    let own = bytes.f32("sample interval of trace 0", 24)? / 1e12;
    // Some programs write the time window, in ns, where the instrument writes the step.
    let tells_window = !differ(own * 1e12, window, 1e-3);
    if own > 0.0 && own < 1.0 && !tells_window && (points != claimed || differ(own, step, 1e-3)) {
        warnings.push(Warning {
            field: "TOTAL TIME WINDOW".into(),
            offset: header.offset("TOTAL TIME WINDOW"),
            header: format!("{window} ns, a step of {} ps", shown(1e12 * step)),
            found: format!("byte 24 of the first trace says {} ps", shown(1e12 * own)),
            taken: if points == claimed { "the header is believed" } else { "the trace is believed" },
        });
        if points != claimed {
            return Ok(own);
        }
    }
    Ok(step)
}

fn shown(value: f64) -> String {
    format!("{:.6}", value).trim_end_matches('0').trim_end_matches('.').into()
}

/// Metres in the unit of positions.
fn unit_of_position(header: &TextHeader<'_>, warnings: &mut Vec<Warning>) -> Option<f64> {
    let unit = header.text("POSITION UNITS")?;
    match unit.to_ascii_lowercase().as_str() {
        "m" | "metre" | "metres" | "meter" | "meters" => Some(1.0),
        "ft" | "foot" | "feet" => Some(FOOT),
        _ => {
            warnings.push(Warning {
                field: "POSITION UNITS".into(),
                offset: header.offset("POSITION UNITS"),
                header: format!("`{unit}`"),
                found: "known are `m` and `ft`".into(),
                taken: "the traces have no positions",
            });
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HD: &str = "1234\nx\n2022-01-01\nNUMBER OF TRACES   = 2\nNUMBER OF PTS/TRC  = 3\nTIMEZERO AT POINT  = 1.5\n\
                      TOTAL TIME WINDOW  = 6.0\nPOSITION UNITS     = ft\nNOMINAL FREQUENCY  = 50\n";

    fn traces(points: f32, traces: &[[i16; 3]]) -> Vec<u8> {
        let mut bytes = vec![];
        for (index, samples) in traces.iter().enumerate() {
            let mut header = [0u8; TRACE_HEADER];
            let words = [index as f32 + 1.0, 10.0 * index as f32, points, 0.0, 0.0, 2.0, 2000.0, 8.0];
            for (place, word) in header.chunks_exact_mut(4).zip(words) {
                place.copy_from_slice(&word.to_le_bytes());
            }
            bytes.extend(header);
            samples.iter().for_each(|sample| bytes.extend(sample.to_le_bytes()));
        }
        bytes
    }

    fn read(header: &str, bytes: &[u8]) -> Result<Recording, MeasuredError> {
        parse(Path::new("a.hd"), header.as_bytes(), Path::new("a.dt1"), bytes)
    }

    #[test]
    fn feet_and_a_fractional_time_zero() {
        let recording = read(HD, &traces(3.0, &[[1, -2, 3], [4, 5, -32768]])).unwrap();
        let radargram = &recording.channels[0];
        assert_eq!(recording.warnings, []);
        assert_eq!(radargram.samples(), [1.0, -2.0, 3.0, 4.0, 5.0, -32768.0]);
        assert!((radargram.time_step.si() - 2e-9).abs() < 1e-22 && (radargram.first_sample.si() + 1e-9).abs() < 1e-22);
        assert!((radargram.positions().unwrap()[1][0].si() - 3.048).abs() < 1e-12);
    }

    #[test]
    fn contradictions_carry_both_values() {
        let bytes = traces(3.0, &[[1, 2, 3]]);
        let text = HD.replace("6.0", "9.0");
        let told: Vec<_> = read(&text, &bytes).unwrap().warnings.iter().map(ToString::to_string).collect();
        assert_eq!(
            told,
            [
                "`NUMBER OF TRACES` at byte 39 is 2, but `a.dt1` holds 1: those that are there are read",
                "`TOTAL TIME WINDOW` at byte 110 is 9 ns, a step of 3000 ps, but byte 24 of the first trace says 2000 ps: \
                 the header is believed"
            ]
        );
        let told = read(&HD.replace("PTS/TRC  = 3", "PTS/TRC  = 4"), &bytes).unwrap();
        assert_eq!(told.channels[0].samples_per_trace(), 3);
        assert!((told.channels[0].time_step.si() - 2e-9).abs() < 1e-15);
    }

    #[test]
    fn what_cannot_be_right_is_refused() {
        let message = |header: &str, bytes: &[u8]| read(header, bytes).unwrap_err().to_string();
        let bytes = traces(3.0, &[[1, 2, 3]]);
        assert_eq!(message("", &bytes), "`a.hd` has no field `NUMBER OF PTS/TRC` in its 0 bytes");
        let claim = HD.replace("PTS/TRC  = 3", "PTS/TRC  = 4000000000");
        assert_eq!(
            message(&claim, &traces(0.0, &[[1, 2, 3]])),
            "`a.dt1` ends too early: `trace 0` at byte 0 needs 8000000128 bytes, the file has 134"
        );
        assert_eq!(
            message(&HD.replace("PTS/TRC  = 3", "PTS/TRC  = -3"), &bytes),
            "`a.hd`: `NUMBER OF PTS/TRC` at byte 62 is `-3`: it must be a whole number of 1 or more"
        );
        assert_eq!(
            message(HD, &traces(f32::NAN, &[[1, 2, 3]])),
            "`a.dt1`: `points of trace 0` at byte 8 is NaN: `NUMBER OF PTS/TRC` is 3, and one of the two must fill the file"
        );
    }
}
