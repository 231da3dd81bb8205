//! Writing radargrams so that other programs read them.

use std::path::{Path, PathBuf};

use super::error::MeasuredError;
use super::npz::{Array, archive};
use super::{dt1, mala, segy, segy_text};
use crate::files;
use crate::trace::BScan;
use crate::units::{Hertz, Metres};

/// What an antenna was, for the headers; what is not known is left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct About {
    /// Its name.
    pub antenna: Option<String>,
    /// Its centre frequency.
    pub centre_frequency: Option<Hertz>,
    /// Distance of transmitter and receiver.
    pub antenna_separation: Option<Metres>,
}

/// What was written.
#[derive(Debug, Clone, PartialEq)]
pub struct Written {
    /// The files.
    pub files: Vec<PathBuf>,
    /// Amplitude of one count; 1 where the numbers are those of the radargram.
    pub amplitude_of_count: f64,
}

/// The count that the largest amplitude becomes: below the 32767 that readers take for clipped.
const LARGEST_COUNT: f64 = 32000.0;

/// Writes 16-bit samples (`.rd3`) and their header beside them (`.rad`) as MALÅ does.
///
/// Amplitudes that are whole numbers within 16 bits are written as they are; others so that the largest becomes 32000
/// counts, each rounded to the nearest. The amplitude of one count and the time of the first sample stand in `COMMENT`.
///
/// # Errors
/// When a file cannot be written, or an amplitude is not finite.
pub fn write_rd3(path: &Path, scan: &BScan, about: &About) -> Result<Written, MeasuredError> {
    let (counts, amplitude) = counts(scan, "RD3")?;
    let step = 1e9 * scan.time_step.si();
    let points = scan.samples_per_trace();
    let first = 1e9 * scan.first_sample.si();
    let note = format!("ballast-gpr amplitude of one count {amplitude:e}; {} {}", mala::FIRST_SAMPLE, number(first));
    let unknown = String::new;
    // Some readers count lines instead of reading keys, so all are there, in the order of the instrument.
    let lines = [
        ("SAMPLES", points.to_string()),
        ("FREQUENCY", number(1e3 / step)),
        ("FREQUENCY STEPS", "1".into()),
        ("SIGNAL POSITION", "0".into()),
        ("RAW SIGNAL POSITION", "0".into()),
        ("DISTANCE FLAG", "1".into()),
        ("TIME FLAG", "0".into()),
        ("PROGRAM FLAG", "0".into()),
        ("EXTERNAL FLAG", "0".into()),
        ("TIME INTERVAL", "0".into()),
        ("DISTANCE INTERVAL", number(spacing(scan).unwrap_or(0.0))),
        ("OPERATOR", unknown()),
        ("CUSTOMER", unknown()),
        ("SITE", unknown()),
        ("ANTENNAS", antenna(about)),
        ("ANTENNA ORIENTATION", unknown()),
        ("ANTENNA SEPARATION", number(about.antenna_separation.map_or(0.0, Metres::si))),
        ("COMMENT", note),
        ("TIMEWINDOW", number(step * points as f64)),
        ("STACKS", "1".into()),
        ("STACK EXPONENT", "0".into()),
        ("STACKING TIME", "0".into()),
        ("LAST TRACE", scan.count().to_string()),
    ];
    let header = lines.iter().map(|(key, value)| format!("{key}:{value}\r\n")).collect();
    let bytes = counts.iter().flat_map(|count| count.to_le_bytes()).collect::<Vec<_>>();
    pair(path, "rad", bytes, header, amplitude)
}

/// Writes 16-bit samples (`.dt1`) and their header beside them (`.hd`) as pulseEKKO does.
///
/// Amplitudes become counts as in [`write_rd3`]. The time of the first sample is `TIMEZERO AT POINT`.
///
/// # Errors
/// When a file cannot be written, or an amplitude is not finite.
pub fn write_dt1(path: &Path, scan: &BScan, about: &About) -> Result<Written, MeasuredError> {
    let (counts, amplitude) = counts(scan, "DT1")?;
    let step = 1e9 * scan.time_step.si();
    let (points, count) = (scan.samples_per_trace(), scan.count());
    let places: Vec<f64> = (0..count).map(|trace| distance(scan, trace)).collect();
    let zero = 1.0 - scan.first_sample.si() / scan.time_step.si();
    let lines = [
        ("NUMBER OF TRACES", count.to_string()),
        ("NUMBER OF PTS/TRC", points.to_string()),
        ("TIMEZERO AT POINT", number(zero)),
        ("TOTAL TIME WINDOW", number(step * points as f64)),
        ("STARTING POSITION", number(places.first().copied().unwrap_or(0.0))),
        ("FINAL POSITION", number(places.last().copied().unwrap_or(0.0))),
        ("STEP SIZE USED", number(spacing(scan).unwrap_or(0.0))),
        ("POSITION UNITS", "m".into()),
        ("NOMINAL FREQUENCY", number(about.centre_frequency.map_or(0.0, |f| 1e-6 * f.si()))),
        ("ANTENNA SEPARATION", number(about.antenna_separation.map_or(0.0, Metres::si))),
        ("PULSER VOLTAGE (V)", "0".into()),
        ("NUMBER OF STACKS", "1".into()),
        ("SURVEY MODE", "Reflection".into()),
    ];
    // Other readers look for dates in both lines; that of the survey is not known. Lines end as the instrument ends them.
    let start = format!(
        "1234\r\r\n01/01/2000 written by ballast-gpr, amplitude of one count {amplitude:e} \r\r\n2000-01-01 \r\r\n"
    );
    let header = lines.iter().fold(start, |text, (key, value)| text + &format!("{key:<18} = {value} \r\r\n"));
    let mut bytes = Vec::with_capacity(count * (dt1::TRACE_HEADER + 2 * points));
    for (index, samples) in counts.chunks_exact(points).enumerate() {
        let mut words = [0f32; 8];
        words[0] = index as f32 + 1.0;
        words[1] = places[index] as f32;
        words[2] = points as f32;
        words[5] = 2.0;
        words[6] = (1e3 * step) as f32;
        words[7] = 1.0;
        let start = bytes.len();
        bytes.extend(words.iter().flat_map(|word| word.to_le_bytes()));
        bytes.resize(start + dt1::TRACE_HEADER, 0);
        bytes.extend(samples.iter().flat_map(|count| count.to_le_bytes()));
    }
    pair(path, "hd", bytes, header, amplitude)
}

/// Writes IEEE floats of 32 bits as SEG-Y (revision 1, big-endian), the time step in picoseconds, as radars have it.
///
/// # Errors
/// When the file cannot be written, an amplitude is not finite in 32 bits, the time step is no whole number of picoseconds
/// to 1e-6, or a trace has more than 32767 samples.
pub fn write_segy(path: &Path, scan: &BScan, about: &About) -> Result<Written, MeasuredError> {
    let cannot = |what, value: String, limit: &str| MeasuredError::CannotHold {
        format: "SEG-Y",
        what,
        value,
        limit: limit.into(),
    };
    let picoseconds = 1e12 * scan.time_step.si();
    let step = picoseconds.round();
    if !((1.0..=32767.0).contains(&step) && (picoseconds - step).abs() <= 1e-6 * step) {
        let limit = "it must be a whole number of picoseconds, 1 to 32767";
        return Err(cannot("a time step", format!("{} ps", number(picoseconds)), limit));
    }
    let points = scan.samples_per_trace();
    let Ok(points16) = i16::try_from(points) else {
        return Err(cannot("traces", format!("{points} samples"), "a trace has at most 32767"));
    };
    if let Some(bad) = scan.samples().iter().find(|value| !(**value as f32).is_finite()) {
        return Err(cannot("an amplitude", bad.to_string(), "it must be finite in 32 bits"));
    }
    let lines = [
        format!("WRITTEN BY BALLAST-GPR: {}", scan.name.to_ascii_uppercase()),
        format!("{} {}", segy::FIRST_SAMPLE, number(1e9 * scan.first_sample.si())),
        "SAMPLE INTERVAL IN PICOSECONDS".into(),
        format!("ANTENNA {}", antenna(about).to_ascii_uppercase()),
    ];
    let mut bytes = segy_text::header(&lines);
    bytes.resize(segy::FILE_HEADER, 0);
    let put16 = |bytes: &mut [u8], at: usize, value: i16| bytes[at..at + 2].copy_from_slice(&value.to_be_bytes());
    let put32 = |bytes: &mut [u8], at: usize, value: i32| bytes[at..at + 4].copy_from_slice(&value.to_be_bytes());
    let step = step as i16;
    // One trace an ensemble, step, samples, IEEE floats, metres, revision 1.0, all traces alike.
    for (at, value) in [(3212, 1), (3216, step), (3220, points16), (3224, 5), (3254, 1), (3500, 0x0100), (3502, 1)] {
        put16(&mut bytes, at, value);
    }
    for (index, samples) in scan.traces().enumerate() {
        let start = bytes.len();
        bytes.resize(start + segy::TRACE_HEADER, 0);
        let header = &mut bytes[start..];
        let serial = i32::try_from(index + 1).unwrap_or(i32::MAX);
        [0, 4, 8].iter().for_each(|&at| put32(header, at, serial));
        // Coordinates in millimetres: the scalar -1000 divides.
        let [x, y, _] = scan.positions().map_or([Metres(0.0); 3], |places| places[index]);
        for (at, value) in [(72, x), (76, y), (80, x), (84, y)] {
            put32(header, at, (1e3 * value.si()).round() as i32);
        }
        for (at, value) in [(28, 1), (70, -1000), (88, 1), (114, points16), (116, step)] {
            put16(header, at, value);
        }
        bytes.extend(samples.iter().flat_map(|value| (*value as f32).to_be_bytes()));
    }
    files::write_bytes(path, &bytes)?;
    Ok(Written { files: vec![path.into()], amplitude_of_count: 1.0 })
}

/// Writes columns of text: the time in ns, then one column for each trace, with all digits.
///
/// # Errors
/// When the file cannot be written.
pub fn write_csv(path: &Path, scan: &BScan) -> Result<Written, MeasuredError> {
    let points = scan.samples_per_trace();
    files::write_atomically(path, |file| {
        let names: String = (0..scan.count()).map(|trace| format!(",trace_{trace}")).collect();
        writeln!(file, "time_ns{names}")?;
        for index in 0..points {
            let time = scan.first_sample.si() + index as f64 * scan.time_step.si();
            write!(file, "{}", number(1e9 * time))?;
            for value in scan.samples().iter().skip(index).step_by(points) {
                write!(file, ",{value}")?;
            }
            writeln!(file)?;
        }
        Ok(())
    })?;
    Ok(Written { files: vec![path.into()], amplitude_of_count: 1.0 })
}

/// Writes the arrays of NumPy: `samples` (traces by samples), `time_s`, and `positions_m` (traces by 3) where they are known.
///
/// # Errors
/// When the file cannot be written or would have more than 4 GiB.
pub fn write_npz(path: &Path, scan: &BScan) -> Result<Written, MeasuredError> {
    let (points, count) = (scan.samples_per_trace(), scan.count());
    let times: Vec<f64> =
        (0..points).map(|index| scan.first_sample.si() + index as f64 * scan.time_step.si()).collect();
    let places: Vec<f64> = scan.positions().unwrap_or_default().iter().flatten().map(|c| c.si()).collect();
    let mut arrays = vec![
        Array { name: "samples", shape: vec![count, points], values: scan.samples() },
        Array { name: "time_s", shape: vec![points], values: &times },
    ];
    if !places.is_empty() {
        arrays.push(Array { name: "positions_m", shape: vec![count, 3], values: &places });
    }
    let bytes = archive(&arrays).ok_or_else(|| MeasuredError::CannotHold {
        format: "npz",
        what: "samples",
        value: scan.samples().len().to_string(),
        limit: "the file may have at most 4 GiB".into(),
    })?;
    files::write_bytes(path, &bytes)?;
    Ok(Written { files: vec![path.into()], amplitude_of_count: 1.0 })
}

/// The counts of 16 bits, and the amplitude of one.
fn counts(scan: &BScan, format: &'static str) -> Result<(Vec<i16>, f64), MeasuredError> {
    if let Some(bad) = scan.samples().iter().find(|value| !value.is_finite()) {
        let (value, limit) = (bad.to_string(), "it must be finite".into());
        return Err(MeasuredError::CannotHold { format, what: "an amplitude", value, limit });
    }
    let whole = |value: &f64| value.fract() == 0.0 && (-32768.0..=32767.0).contains(value);
    let peak = scan.samples().iter().fold(0.0f64, |peak, value| peak.max(value.abs()));
    let amplitude = peak / LARGEST_COUNT;
    let amplitude = if amplitude.is_normal() && !scan.samples().iter().all(whole) { amplitude } else { 1.0 };
    Ok((scan.samples().iter().map(|value| (value / amplitude).round() as i16).collect(), amplitude))
}

/// Writes the samples, and the header beside them, both or neither.
fn pair(path: &Path, ending: &str, samples: Vec<u8>, header: String, amplitude: f64) -> Result<Written, MeasuredError> {
    let beside = header_path(path, ending);
    files::write_together(&[(path, &samples), (&beside, header.as_bytes())])?;
    Ok(Written { files: vec![path.into(), beside], amplitude_of_count: amplitude })
}

/// The header beside a file of samples, in capitals where that is.
fn header_path(path: &Path, ending: &str) -> PathBuf {
    let capital = path.extension().is_some_and(|e| e.to_string_lossy().chars().any(|c| c.is_ascii_uppercase()));
    path.with_extension(if capital { ending.to_ascii_uppercase() } else { ending.into() })
}

/// Distance of a trace along the line, m: zero where places are not known.
fn distance(scan: &BScan, trace: usize) -> f64 {
    let Some(places) = scan.positions() else { return 0.0 };
    let from = places[0];
    let length = (0..3).map(|axis| (places[trace][axis].si() - from[axis].si()).powi(2)).sum::<f64>().sqrt();
    let on_axis = places.iter().all(|place| place[1] == from[1] && place[2] == from[2]);
    if on_axis { places[trace][0].si() } else { length }
}

/// Mean distance between traces, m, where they move.
fn spacing(scan: &BScan) -> Option<f64> {
    let steps = scan.count().checked_sub(1).filter(|steps| *steps > 0)?;
    let length = distance(scan, steps) - distance(scan, 0);
    Some(length / steps as f64).filter(|spacing| *spacing > 0.0)
}

fn antenna(about: &About) -> String {
    match (&about.antenna, about.centre_frequency) {
        (Some(name), _) => name.clone(),
        (None, Some(frequency)) => format!("{} MHz", number(1e-6 * frequency.si())),
        (None, None) => "not known".into(),
    }
}

/// A decimal number of 15 digits without an exponent: as many as a double surely keeps.
fn number(value: f64) -> String {
    let digits = if value == 0.0 { 0 } else { (14 - value.abs().log10().floor() as i64).clamp(0, 30) as usize };
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

#[cfg(test)]
mod tests {
    use super::super::{Format, read};
    use super::*;
    use crate::trace::Component;
    use crate::units::Seconds;

    fn scan(samples: Vec<f64>, points: usize, step: f64, first: f64) -> BScan {
        BScan::new(samples, points, Seconds(step), Seconds(first), Component::Ez, "line 1".into()).unwrap()
    }

    #[test]
    fn numbers_have_no_exponent_and_no_noise() {
        assert_eq!(
            [0.0, 1.0, -0.25, 1e3 / 0.05, 4.717308673499368e-3].map(number),
            ["0", "1", "-0.25", "20000", "0.00471730867349937"]
        );
    }

    /// Whole numbers come back as they are, others to half a count, with their time axis.
    #[test]
    fn pairs_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let about = About { centre_frequency: Some(Hertz(9e8)), antenna_separation: Some(Metres(0.1)), antenna: None };
        let whole = scan(vec![1.0, -32768.0, 32767.0, 0.0], 2, 4.717e-12, -2.3585e-12);
        let wave = scan((0..60).map(|k| 1e-3 * (f64::from(k) * 0.3).sin()).collect(), 20, 0.1e-9, 0.25e-9);
        let wave = wave
            .with_positions((0..3).map(|k| [Metres(0.5 + 0.1 * f64::from(k)), Metres(0.0), Metres(0.0)]).collect())
            .unwrap();
        type Write = fn(&Path, &BScan, &About) -> Result<Written, MeasuredError>;
        for (name, write, format) in [
            ("a.rd3", write_rd3 as Write, Format::Rd3),
            ("b.DT1", write_dt1, Format::Dt1),
            ("c.sgy", write_segy, Format::SegY),
        ] {
            for scan in [&whole, &wave] {
                let path = folder.path().join(name);
                let written = match write(&path, scan, &about) {
                    Err(MeasuredError::CannotHold { what: "a time step", .. }) if format == Format::SegY => continue,
                    written => written.unwrap(),
                };
                let recording = read(&written.files[written.files.len() - 1]).unwrap();
                assert_eq!((recording.format, recording.warnings.as_slice()), (format, &[][..]));
                let back = &recording.channels[0];
                assert!((back.time_step.si() / scan.time_step.si() - 1.0).abs() < 1e-13, "{name}");
                assert!((back.first_sample.si() - scan.first_sample.si()).abs() < 1e-13 * 1e-9, "{name}");
                let half = if format == Format::SegY { 1e-10 } else { 0.5 * written.amplitude_of_count };
                let near = |(one, other): (&f64, &f64)| {
                    let told = other * written.amplitude_of_count;
                    assert!((one - told).abs() <= half * (1.0 + 1e-12), "{name}: {one} {told}");
                };
                scan.samples().iter().zip(back.samples()).for_each(near);
            }
        }
        assert!(folder.path().join("b.HD").is_file() && folder.path().join("a.rad").is_file());
    }

    #[test]
    fn what_a_format_cannot_hold_is_said() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sgy");
        let message = |scan: &BScan| write_segy(&path, scan, &About::default()).unwrap_err().to_string();
        assert_eq!(
            message(&scan(vec![0.0; 2], 2, 48.828125e-12, 0.0)),
            "SEG-Y cannot hold a time step of 48.828125 ps: it must be a whole number of picoseconds, 1 to 32767"
        );
        assert_eq!(
            message(&scan(vec![0.0; 40_000], 40_000, 1e-12, 0.0)),
            "SEG-Y cannot hold traces of 40000 samples: a trace has at most 32767"
        );
        let odd = scan(vec![0.0, f64::NAN], 2, 1e-12, 0.0);
        assert_eq!(message(&odd), "SEG-Y cannot hold an amplitude of NaN: it must be finite in 32 bits");
        assert_eq!(
            write_rd3(&folder.path().join("a.rd3"), &odd, &About::default()).unwrap_err().to_string(),
            "RD3 cannot hold an amplitude of NaN: it must be finite"
        );
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
