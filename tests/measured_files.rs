//! Files of instruments: small ones of every format, and real ones where they are at hand.
//!
//! The small ones in `tests/corpus` are written by `tests/python/write_radar_files.py`, which knows nothing of this program.
//! Real files may not be passed on; a folder of them is named by `BALLAST_GPR_MEASURED`, with `first_traces` in it as
//! other readers gave them.

use std::collections::BTreeMap;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use ballast_gpr::measured::{About, Format, MeasuredError, Recording, read, write_csv, write_npz, write_rd3};
use ballast_gpr::trace::{BScan, Component};
use ballast_gpr::units::{Hertz, Metres, Seconds};

/// Traces and samples of the small files.
const SHAPE: (usize, usize) = (5, 12);

fn corpus(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus").join(name)
}

/// As in the script that writes them.
fn amplitude(channel: usize, trace: usize, sample: usize) -> f64 {
    ((29 * channel + 7 * trace + 13 * sample) % 101) as f64 - 50.0
}

fn check(recording: &Recording, factor: f64, step: f64, first: f64) {
    assert_eq!(recording.warnings, []);
    for (index, channel) in recording.channels.iter().enumerate() {
        assert_eq!((channel.count(), channel.samples_per_trace()), SHAPE);
        for (trace, samples) in channel.traces().enumerate() {
            for (sample, value) in samples.iter().enumerate() {
                assert_eq!(*value, factor * amplitude(index, trace, sample), "{index} {trace} {sample}");
            }
        }
        assert!((channel.time_step.si() / step - 1.0).abs() < 1e-12, "{}", channel.time_step);
        assert!((channel.first_sample.si() - first).abs() < 1e-12 * step, "{}", channel.first_sample);
        assert_eq!(channel.component, Component::Recorded);
    }
}

fn last_place(recording: &Recording) -> f64 {
    recording.channels[0].positions().unwrap()[SHAPE.0 - 1][0].si()
}

/// 28 ns in 14 samples, of which the first two are no signal; the window begins at -3 ns.
#[test]
fn dzt_of_every_width() {
    for (name, factor, antenna) in [
        ("dzt/eight-bits.dzt", 1.0, 1e9),
        ("dzt/sixteen-bits.dzt", 300.0, 4e8),
        ("dzt/two-channels.dzt", 300.0, 1e9),
        ("dzt/thirty-two-bits.dzt", 100_003.0, 1e9),
    ] {
        let recording = read(&corpus(name)).unwrap();
        check(&recording, factor, 2e-9, 1e-9);
        assert_eq!(recording.centre_frequency.map(Hertz::si), Some(antenna), "{name}");
        let two = name.contains("channels");
        assert_eq!(recording.channels.len(), if two { 2 } else { 1 });
        // 20 scans to a metre.
        assert_eq!(recording.channels[0].positions().map(|places| places[4][0].si()), (!two).then_some(0.2));
    }
}

#[test]
fn dt1_in_feet_and_metres_by_either_file() {
    for (name, last) in [("feet", 2.0 * 0.3048), ("metres", 11.0)] {
        for ending in ["dt1", "hd"] {
            let recording = read(&corpus(&format!("dt1/{name}.{ending}"))).unwrap();
            check(&recording, 300.0, 0.4e-9, -2.25 * 0.4e-9);
            assert!((last_place(&recording) - last).abs() < 1e-12);
            assert_eq!(recording.centre_frequency.map(Hertz::si), Some(250e6));
        }
    }
}

#[test]
fn mala_of_both_widths_by_either_file() {
    for (name, format, factor) in [("short.rd3", Format::Rd3, 300.0), ("long.rad", Format::Rd7, 100_003.0)] {
        let recording = read(&corpus(&format!("mala/{name}"))).unwrap();
        check(&recording, factor, 0.4e-9, 0.0);
        assert_eq!((recording.format, last_place(&recording)), (format, 1.0));
        assert_eq!(recording.antenna_separation, Some(Metres(0.18)));
    }
}

#[test]
fn segy_of_every_code_in_either_order() {
    for order in ["big", "little"] {
        for (kind, factor) in [("ibm", 0.375), ("thirty-two-bits", 100_003.0), ("sixteen-bits", 300.0), ("ieee", 0.375)]
        {
            let recording = read(&corpus(&format!("segy/{order}-{kind}.sgy"))).unwrap();
            check(&recording, factor, 0.4e-9, 0.0);
            assert!(recording.header.iter().any(|(_, line)| line.contains("A LINE OF TEXT")), "{order} {kind}");
            assert_eq!(last_place(&recording), 1.0);
        }
    }
}

#[test]
fn experimental_formats_as_described() {
    for (name, factor, first) in
        [("iprb/short.iprb", 300.0, -1.2e-9), ("iprb/long.iprh", 100_003.0, -1.2e-9), ("ids/line.dt", 300.0, 0.0)]
    {
        let recording = read(&corpus(name)).unwrap();
        check(&recording, factor, 0.4e-9, first);
        assert!(recording.format.is_experimental() && recording.format.name().contains("experimental"));
        assert!((last_place(&recording) - 0.2).abs() < 1e-12);
    }
}

/// The files are those that the script writes, wherever there is a Python.
#[test]
fn the_small_files_are_those_of_the_script() {
    let folder = tempfile::tempdir().unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python/write_radar_files.py");
    let Ok(output) = Command::new("python3").arg(script).arg(folder.path()).output() else {
        let _ =
            writeln!(std::io::stderr(), "\nSKIPPED: the small files were not written anew: there is no `python3`\n");
        return;
    };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let mut count = 0;
    for kind in ["dzt", "dt1", "mala", "segy", "iprb", "ids"] {
        for entry in fs::read_dir(folder.path().join(kind)).unwrap() {
            let path = entry.unwrap().path();
            let kept = corpus(kind).join(path.file_name().unwrap());
            assert_eq!(fs::read(&path).unwrap(), fs::read(&kept).unwrap(), "{}", kept.display());
            count += 1;
        }
    }
    assert_eq!(count, 25);
}

/// Every file, cut at every byte of its first 4 KiB and behind: read or refused, never more traces than before, and the
/// refusal names the field and its place.
#[test]
fn files_cut_anywhere_are_refused_by_field_and_place() {
    let folder = tempfile::tempdir().unwrap();
    let (mut refused, mut fields) = (0, std::collections::BTreeSet::new());
    for file in small_files() {
        let bytes = fs::read(&file).unwrap();
        let name = file.file_name().unwrap();
        let header = beside(&file);
        for cut in (0..bytes.len()).step_by(if bytes.len() > 1000 { 11 } else { 1 }) {
            let path = folder.path().join(name);
            fs::write(&path, &bytes[..cut]).unwrap();
            if let Some(header) = &header {
                fs::copy(header, folder.path().join(header.file_name().unwrap())).unwrap();
            }
            match read(&path) {
                Ok(recording) => assert!(recording.channels[0].count() <= SHAPE.0, "{name:?} {cut}"),
                Err(error) => {
                    fields.insert(named(&error));
                    refused += 1;
                }
            }
        }
    }
    assert!(refused > 2000, "{refused}");
    assert!(fields.len() > 10, "{fields:?}");
}

/// Every word of two bytes of every header, replaced by what counts stumble over.
#[test]
fn absurd_headers_are_refused_or_warned_of() {
    let folder = tempfile::tempdir().unwrap();
    let (mut read_all_the_same, mut refused) = (0, BTreeMap::<String, usize>::new());
    for file in small_files() {
        let header = beside(&file);
        let (victim, other) = match &header {
            Some(header) => (header.clone(), Some(file.clone())),
            None => (file.clone(), None),
        };
        let bytes = fs::read(&victim).unwrap();
        let path = folder.path().join(victim.file_name().unwrap());
        if let Some(other) = other {
            fs::copy(&other, folder.path().join(other.file_name().unwrap())).unwrap();
        }
        for at in places_of_fields(&victim, bytes.len() - 1) {
            for word in [[0, 0], [0xff, 0xff], [0xff, 0x7f], [0x7f, 0xff], *b"-1", *b"e9", [0, 0x80]] {
                let mut bytes = bytes.clone();
                bytes[at..at + 2].copy_from_slice(&word);
                fs::write(&path, &bytes).unwrap();
                match read(&path) {
                    Ok(recording) => {
                        read_all_the_same += 1;
                        for channel in &recording.channels {
                            assert!(channel.samples().len() <= bytes.len().max(100 * 100), "{}", path.display());
                            assert!(channel.time_step.si() > 0.0 && channel.time_step.si().is_finite());
                            assert!(channel.first_sample.si().is_finite());
                            assert!(channel.samples().iter().all(|value| value.is_finite()));
                        }
                    }
                    Err(error) => *refused.entry(named(&error)).or_default() += 1,
                }
            }
        }
    }
    assert!(read_all_the_same > 1000 && refused.values().sum::<usize>() > 1000, "{read_all_the_same} {refused:?}");
    for field in
        ["rh_nsamp", "rh_bits", "rhf_range", "rh_nchan", "NUMBER OF PTS/TRC", "SAMPLES", "format code", "len_rec"]
    {
        assert!(refused.contains_key(field), "{field}: {refused:?}");
    }
}

/// Where a header has its numbers: a text everywhere, the others at the places described.
fn places_of_fields(file: &Path, end: usize) -> Vec<usize> {
    let parts: &[std::ops::Range<usize>] = match file.extension().and_then(|ending| ending.to_str()) {
        Some("dzt") => &[0..120, 1024..1060],
        Some("sgy") => &[3212..3228, 3500..3506, 3664..3720],
        Some("dt") => &[0..8, 1024..1028, 2048..2260, 3072..3076],
        _ => return (0..end).collect(),
    };
    parts.iter().flat_map(|part| part.start..part.end.min(end)).collect()
}

/// The field that an error names; its message must give the place too.
fn named(error: &MeasuredError) -> String {
    let message = error.to_string();
    match error {
        MeasuredError::Ends { field, offset, .. } | MeasuredError::Value { field, offset, .. } => {
            assert!(message.contains(&format!("`{field}` at byte {offset}")), "{message}");
            let known = field.find(|c: char| c.is_ascii_digit()).map_or(field.as_str(), |at| &field[..at]);
            known.trim().into()
        }
        MeasuredError::NoField { field, .. } => {
            assert!(message.contains(&format!("`{field}`")), "{message}");
            (*field).into()
        }
        _ => panic!("{message}"),
    }
}

/// The files with samples among the small ones.
fn small_files() -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = ["dzt", "dt1", "mala", "segy", "iprb", "ids"]
        .iter()
        .flat_map(|kind| fs::read_dir(corpus(kind)).unwrap().map(|entry| entry.unwrap().path()))
        .filter(|path| !path.extension().is_some_and(|end| end == "hd" || end == "rad" || end == "iprh"))
        .collect();
    files.sort();
    files
}

fn beside(file: &Path) -> Option<PathBuf> {
    ["hd", "rad", "iprh"].iter().map(|ending| file.with_extension(ending)).find(|path| path.is_file())
}

#[test]
fn what_is_missing_or_strange_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        path
    };
    let message = |path: &Path| {
        let text = read(path).unwrap_err().to_string();
        text.replace(&format!("{}/", folder.path().display()), "")
    };
    assert_eq!(
        message(&put("alone.rd3", &[1, 2])),
        "`alone.rd3` needs its other half beside it: a file of the same name that ends with `.rad`"
    );
    assert_eq!(
        message(&put("lonely.HD", b"x")),
        "`lonely.HD` needs its other half beside it: a file of the same name that ends with `.DT1`"
    );
    put("both.rd3", &[0; 8]);
    put("both.rd7", &[0; 8]);
    assert_eq!(
        message(&put("both.rad", b"SAMPLES:2\nFREQUENCY:1000\n")),
        "`both.rad` describes both `both.rd3` and `both.rd7`\n\nhint: name the one to read"
    );
    assert_eq!(read(&folder.path().join("both.rd7")).unwrap().channels[0].samples(), [0.0; 2]);
    let unknown = message(&put("line.xyz", b"x"));
    assert!(
        unknown.starts_with("the ending of `line.xyz` is that of no instrument\n\nhint: known are `.dzt`"),
        "{unknown}"
    );
    fs::create_dir(folder.path().join("folder.dzt")).unwrap();
    assert_eq!(message(&folder.path().join("folder.dzt")), "`folder.dzt` is not a regular file");
    assert_eq!(
        message(&put("empty.dzt", b"")),
        "`empty.dzt` ends too early: `rh_nsamp` at byte 4 needs 2 bytes, the file has 0"
    );
    // Either case of ending, and of the other file's.
    put("CASE.RAD", b"SAMPLES:1\nFREQUENCY:1000\n");
    let one = read(&put("case.Rd3", &[7, 0])).unwrap();
    assert_eq!((one.channels[0].samples(), one.channels[0].count()), (&[7.0][..], 1));
}

/// A trace of zeros and a trace of one sample go through every writer and back.
#[test]
fn zeros_and_single_samples_are_written_and_read() {
    let folder = tempfile::tempdir().unwrap();
    let scan = |samples: Vec<f64>, points| {
        BScan::new(samples, points, Seconds(1e-10), Seconds(0.0), Component::Ez, "zeros".into()).unwrap()
    };
    for scan in [scan(vec![0.0; 6], 3), scan(vec![1.5, -2.5], 1), scan(vec![0.0], 1)] {
        let path = folder.path().join("a.rd3");
        let written = write_rd3(&path, &scan, &About::default()).unwrap();
        let back = read(&path).unwrap();
        assert_eq!(back.channels[0].samples_per_trace(), scan.samples_per_trace());
        for (one, other) in scan.samples().iter().zip(back.channels[0].samples()) {
            assert!((one - other * written.amplitude_of_count).abs() <= 0.5 * written.amplitude_of_count);
        }
        write_csv(&folder.path().join("a.csv"), &scan).unwrap();
        write_npz(&folder.path().join("a.npz"), &scan).unwrap();
    }
}

/// A real file as another reader gave it.
struct Reference {
    file: PathBuf,
    first_trace: Vec<f64>,
    /// Traces and samples, with those that are no signal.
    shape: (usize, usize),
    sum: f64,
    /// Where the samples of DZT begin.
    data_offset: Option<usize>,
}

/// The real files, unpacked where need be.
fn references(unpacked: &Path) -> Option<Vec<Reference>> {
    let Some(folder) = std::env::var_os("BALLAST_GPR_MEASURED").map(PathBuf::from) else {
        let _ =
            writeln!(std::io::stderr(), "\nSKIPPED: no real files: `BALLAST_GPR_MEASURED` names no folder of them\n");
        return None;
    };
    let mut found = vec![];
    for (stem, file) in [
        ("dt1_gprpy__ComOffs__XLINE00", "dt1_gprpy/ComOffs/XLINE00.DT1"),
        ("dt1_gprpy__WARR__XLINE00", "dt1_gprpy/WARR/XLINE00.DT1"),
        ("dt1_rgpr__dt1_rgpr__cmp", "dt1_rgpr/cmp.DT1"),
        ("dzt_gprpy__FILE____032", "dzt_gprpy/FILE____032.DZT"),
        ("dzt_impdar__test_gssi", "dzt_impdar/test_gssi.DZT"),
        ("dzt_sbb_hellerlu__Antenna", "dzt_sbb_hellerlu/basecase/Antenna.DZT"),
        ("dzt_sbb_hellerlu__High_asphalt", "dzt_sbb_hellerlu/basecase/High_asphalt.DZT"),
        ("dzt_sbb_hellerlu__High_metal", "dzt_sbb_hellerlu/basecase/High_metal.DZT"),
        ("dzt_sbb_hellerlu__Low_asphalt", "dzt_sbb_hellerlu/basecase/Low_asphalt.DZT"),
        ("dzt_sbb_hellerlu__Low_metal", "dzt_sbb_hellerlu/basecase/Low_metal.DZT"),
        ("dzt_sbb_hellerlu__Medium_asphalt", "dzt_sbb_hellerlu/basecase/Medium_asphalt.DZT"),
        ("dzt_sbb_hellerlu__Medium_metal", "dzt_sbb_hellerlu/basecase/Medium_metal.DZT"),
        ("dzt_sbb_hellerlu__Trolley", "dzt_sbb_hellerlu/basecase/Trolley.DZT"),
        ("dzt_sbb_hellerlu__Trolley_rails", "dzt_sbb_hellerlu/basecase/Trolley_rails.DZT"),
        ("mala_impdar__ten_col", "mala_impdar/ten_col.rd3"),
        ("segy_rgpr__test", "segy_rgpr/test.sgy"),
    ] {
        let text = fs::read_to_string(folder.join(format!("first_traces/{stem}.first_trace.csv"))).unwrap();
        let first_trace = text.lines().skip(1).map(|line| line.rsplit(',').next().unwrap().parse().unwrap()).collect();
        let meta: serde_json::Value =
            serde_json::from_str(&fs::read_to_string(folder.join(format!("first_traces/{stem}.meta.json"))).unwrap())
                .unwrap();
        let shape = if meta["array_shape"].is_array() { &meta["array_shape"] } else { &meta["shape"] };
        let length = |index: usize| shape[index].as_u64().unwrap() as usize;
        let sum = meta["all_sum"].as_f64().or(meta["sum_all"].as_f64()).unwrap();
        let file = unpack(&folder.join(file), &unpacked.join(stem));
        found.push(Reference {
            data_offset: meta["data_offset"].as_u64().map(|offset| offset as usize),
            file,
            first_trace,
            shape: (length(1), length(0)),
            sum,
        });
    }
    Some(found)
}

/// The file itself, or what `gzip` makes of the packed one, with the header that belongs to it.
fn unpack(file: &Path, into: &Path) -> PathBuf {
    if file.is_file() {
        return file.into();
    }
    fs::create_dir_all(into).unwrap();
    let packed = PathBuf::from(format!("{}.gz", file.display()));
    let output = Command::new("gzip").arg("-dc").arg(&packed).output().unwrap();
    assert!(output.status.success(), "{}", packed.display());
    let plain = into.join(file.file_name().unwrap());
    fs::write(&plain, output.stdout).unwrap();
    let header = file.with_extension("HD");
    if header.is_file() {
        fs::copy(&header, into.join(header.file_name().unwrap())).unwrap();
    }
    plain
}

/// Sixteen real files, to the last sample: the first trace sample by sample, and the sum of all, as other readers have them.
#[test]
fn real_files_are_what_other_readers_say() {
    let folder = tempfile::tempdir().unwrap();
    let Some(references) = references(folder.path()) else { return };
    for Reference { file, first_trace, shape, sum, data_offset } in references {
        let is_dzt = data_offset.is_some();
        let recording = read(&file).unwrap_or_else(|error| panic!("{error}"));
        let scan = &recording.channels[0];
        // The others give DZT as it is stored: two words that are no signal, and 16 bits around 32768.
        let (hidden, zero) = match (is_dzt, recording.sample_kind.bytes()) {
            (true, 2) => (2, 32768.0),
            (true, _) => (2, 0.0),
            _ => (0, 0.0),
        };
        assert_eq!((scan.count(), scan.samples_per_trace() + hidden), shape, "{}", file.display());
        assert_eq!(first_trace.len(), shape.1);
        for (index, (ours, theirs)) in scan.traces().next().unwrap().iter().zip(&first_trace[hidden..]).enumerate() {
            // The references of floats have nine digits.
            assert!((ours + zero - theirs).abs() <= 1e-8 * theirs.abs(), "{} sample {index}", file.display());
        }
        // What is left out: the counters 0, 1, 2, …, and the marks, which a user sets here and there.
        let counters: usize = if is_dzt { (0..scan.count()).sum() } else { 0 };
        let marks = data_offset.map_or(0.0, |offset| marks(&file, offset, shape.1, recording.sample_kind.bytes()));
        let all = scan.samples().iter().sum::<f64>() + zero * scan.samples().len() as f64 + counters as f64 + marks;
        assert!((all - sum).abs() <= 1e-9 * sum.abs(), "{}: {all} {sum}", file.display());
        let warned = file.ends_with("mala_impdar/ten_col.rd3");
        assert_eq!(recording.warnings.len(), usize::from(warned), "{}", file.display());
        if file.ends_with("FILE____032.DZT") {
            assert_eq!((scan.count(), scan.samples_per_trace()), (1040, 510));
        }
    }
}

/// The sum of the second words of all scans.
fn marks(file: &Path, offset: usize, samples: usize, width: usize) -> f64 {
    let bytes = fs::read(file).unwrap();
    let word = |scan: &[u8]| match width {
        2 => f64::from(u16::from_le_bytes([scan[2], scan[3]])),
        _ => f64::from(i32::from_le_bytes([scan[4], scan[5], scan[6], scan[7]])),
    };
    bytes[offset..].chunks_exact(samples * width).map(word).sum()
}

/// Real files with bytes changed at random: read or refused in words that name field and place, and never more samples than
/// the file has bytes.
#[test]
fn mutated_real_files_are_survived() {
    let folder = tempfile::tempdir().unwrap();
    let Some(references) = references(folder.path()) else { return };
    let mut state = 1_u64;
    // Numbers that look random and are the same in every run (Knuth's MMIX).
    let mut next = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below.max(1)
    };
    let (mut sound, mut refused) = (0, 0);
    for reference in references.iter().filter(|reference| fs::metadata(&reference.file).unwrap().len() < 1_100_000) {
        let header = ["HD", "rad"].iter().map(|e| reference.file.with_extension(e)).find(|path| path.is_file());
        let bytes = fs::read(&reference.file).unwrap();
        let text = header.as_ref().map(|header| fs::read(header).unwrap());
        let place = folder.path().join("mutated");
        fs::create_dir_all(&place).unwrap();
        for _ in 0..60 {
            let (mut bytes, mut text) = (bytes.clone(), text.clone());
            for _ in 0..1 + next(4) {
                let victim = match &mut text {
                    Some(text) if next(2) == 0 => text,
                    _ => &mut bytes,
                };
                let (near, length) = (if next(2) == 0 { 128 } else { 4000 }, victim.len());
                let at = next(length.min(near));
                match next(6) {
                    0 => victim.truncate(next(length)),
                    1 => victim[at..(at + 4).min(length)].fill(0xff),
                    2 => victim[at..(at + 4).min(length)].fill(0),
                    3 => victim[at] = b'0' + next(10) as u8,
                    _ => victim[at] = next(256) as u8,
                }
                if victim.is_empty() {
                    break;
                }
            }
            let path = place.join(reference.file.file_name().unwrap());
            fs::write(&path, &bytes).unwrap();
            if let (Some(header), Some(text)) = (&header, &text) {
                fs::write(place.join(header.file_name().unwrap()), text).unwrap();
            }
            match read(&path) {
                Ok(recording) => {
                    sound += 1;
                    let samples: usize = recording.channels.iter().map(|channel| channel.samples().len()).sum();
                    assert!(samples <= bytes.len());
                }
                Err(error) => {
                    named(&error);
                    refused += 1;
                }
            }
        }
    }
    assert!(sound > 100 && refused > 100, "{sound} {refused}");
}
