//! Files of pulses: `#excitation_file`.

use std::path::Path;

use super::error::Problem;
use super::lines::Command;
use super::sources::add_waveform;
use super::values::Parameters;
use crate::files::read_text;
use crate::model::{Between, Beyond, Model, Sampled, Waveform, WaveformKind};

/// Reads an `#excitation_file`: names in the first row, numbers below. A first column called `time` holds the times of the
/// samples; without it there is one for each time step, and zeros after the last.
pub(super) fn excitation_file(model: &mut Model, path: &Path, command: &Command<'_>) -> Result<(), Problem> {
    let p = Parameters::of(command, "FILE [KIND FILL]", |n| n == 1 || n == 3)?;
    let (between, beyond) = if p.len() == 3 { interpolation(&p)? } else { (Between::Linear, Beyond::Value(0.0)) };
    let file = path.with_file_name("").join(p.word(0)?);
    let text = read_text(&file)?;
    let wrong = |line: usize, what: String| Problem::Excitation { file: file.clone(), line, what };
    let mut rows = text.lines().enumerate().filter(|(_, row)| !row.trim().is_empty());
    let names: Vec<&str> = rows.next().map_or(vec![], |(_, row)| row.split_whitespace().collect());
    let mut columns = vec![vec![]; names.len()];
    for (index, row) in rows {
        let line = index + 1;
        let words: Vec<_> = row.split_whitespace().collect();
        if words.len() != names.len() {
            return Err(wrong(
                line,
                format!("there are {} numbers, but {} names in the first line", words.len(), names.len()),
            ));
        }
        for (column, word) in columns.iter_mut().zip(words) {
            let number = word.parse::<f64>().ok().filter(|number| number.is_finite());
            column.push(number.ok_or_else(|| wrong(line, format!("`{word}` is not a number")))?);
        }
    }
    let timed = names.first() == Some(&"time");
    if names.len() < 1 + usize::from(timed) {
        return Err(wrong(1, "there is no name of a pulse".into()));
    }
    let samples = columns[0].len();
    if samples < 2 {
        return Err(wrong(samples + 1, format!("there are {samples} samples, at least 2 are needed")));
    }
    let steps = model.iterations().max(2);
    let times = if timed {
        columns.remove(0)
    } else {
        columns.iter_mut().for_each(|column| column.resize(steps, 0.0));
        (0..steps).map(|n| n as f64 * model.time_step()).collect()
    };
    for (name, values) in names.iter().skip(usize::from(timed)).zip(columns) {
        let sampled = Sampled::new(times.clone(), values, between, beyond);
        let sampled = sampled.ok_or_else(|| wrong(2, "the times do not grow from line to line".into()))?;
        let kind = WaveformKind::User(sampled);
        add_waveform(model, Waveform { id: (*name).into(), kind, amplitude: 1.0, frequency: 0.0 })?;
    }
    Ok(())
}

/// The two words that gprMax passes on to `scipy.interpolate.interp1d`.
fn interpolation(p: &Parameters<'_>) -> Result<(Between, Beyond), Problem> {
    let kind = p.word(1)?;
    let between = match kind {
        "slinear" => Between::Linear,
        "nearest-up" | "zero" | "quadratic" | "cubic" => {
            return Err(p.unsupported("an interpolation other than linear, nearest, previous or next"));
        }
        _ => Between::ALL
            .into_iter()
            .find(|between| between.name() == kind)
            .ok_or_else(|| p.not_one_of(kind, "an interpolation", Between::ALL.map(Between::name).join(", ")))?,
    };
    if p.word(2)? != "extrapolate" {
        return Ok((between, Beyond::Value(p.number(2, "a number or `extrapolate`")?)));
    }
    match between {
        Between::Linear | Between::Nearest => Ok((between, Beyond::Extrapolate)),
        Between::Previous | Between::Next => Err(p.unsupported("`extrapolate` with `previous` or `next`")),
    }
}
