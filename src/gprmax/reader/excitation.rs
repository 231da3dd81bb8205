//! Files of pulses: `#excitation_file`.

use std::path::Path;

use super::error::Problem;
use super::lines::Command;
use super::sources::add_waveform;
use super::values::Parameters;
use crate::files::read_text;
use crate::model::{Between, Beyond, Model, PulseTable, Sampled, Waveform, WaveformKind};

/// Reads an `#excitation_file`: names in the first row, numbers below. A first column called `time` holds the times of the
/// samples; without it there is one for each time step, and zeros after the last.
pub(super) fn excitation_file(model: &mut Model, path: &Path, command: &Command<'_>) -> Result<(), Problem> {
    let p = Parameters::of(command, "FILE [KIND FILL]", |n| n == 1 || n == 3)?;
    let (between, beyond) = if p.len() == 3 { interpolation(&p)? } else { (Between::Linear, Beyond::Value(0.0)) };
    let file = path.with_file_name("").join(p.word(0)?);
    let text = read_text(&file)?;
    let wrong = |line: usize, what: String| Problem::Excitation { file: file.clone(), line, what };
    let mut table = PulseTable::read(&text).map_err(|error| wrong(error.line, error.what))?;
    let steps = model.iterations().max(2);
    let times = table.times.unwrap_or_else(|| {
        table.pulses.iter_mut().for_each(|(_, column)| column.resize(steps, 0.0));
        (0..steps).map(|n| n as f64 * model.time_step()).collect()
    });
    for (id, values) in table.pulses {
        let sampled = Sampled::new(times.clone(), values, between, beyond);
        let sampled = sampled.ok_or_else(|| wrong(2, "the times do not grow from line to line".into()))?;
        let kind = WaveformKind::User(sampled);
        add_waveform(model, Waveform { id, kind, amplitude: 1.0, frequency: 0.0 })?;
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
