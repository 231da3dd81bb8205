//! Waveforms and sources.

use super::error::Problem;
use super::lines::Command;
use super::multiple::{between_walls, inside};
use super::values::Parameters;
use crate::files::nearest_name;
use crate::model::{
    Axis, Excitation, HertzianDipole, MagneticDipole, Model, Source, VoltageSource, Waveform, WaveformKind,
};

/// Reads a `#waveform`.
pub(super) fn waveform(model: &mut Model, command: &Command<'_>) -> Result<(), Problem> {
    let p = Parameters::of(command, "TYPE AMPLITUDE FREQUENCY ID", |n| n == 4)?;
    let (word, id) = (p.word(0)?.to_lowercase(), p.word(3)?);
    let Some(kind) = WaveformKind::ALL.into_iter().find(|kind| kind.name() == word) else {
        let known = WaveformKind::ALL.map(|kind| kind.name()).join(", ");
        return Err(p.not_one_of(&word, "a waveform that the embedded solver knows", known));
    };
    let (amplitude, frequency) = (p.number(1, "an amplitude")?, p.number(2, "a frequency in Hz")?);
    p.check("the frequency", frequency, frequency > 0.0, "above 0")?;
    add_waveform(model, Waveform { id: id.into(), kind, amplitude, frequency })
}

/// Adds a waveform whose name is free.
pub(super) fn add_waveform(model: &mut Model, waveform: Waveform) -> Result<(), Problem> {
    if model.waveforms.iter().any(|known| known.id == waveform.id) {
        return Err(Problem::DefinedTwice { what: "waveform", id: waveform.id });
    }
    model.waveforms.push(waveform);
    Ok(())
}

/// Reads a `#hertzian_dipole`, `#magnetic_dipole` or `#voltage_source`.
pub(super) fn source(model: &mut Model, command: &Command<'_>) -> Result<(), Problem> {
    let voltage = command.name == "voltage_source";
    // How many parameters stand before the waveform.
    let before = if voltage { 5 } else { 4 };
    let form = if voltage { "x|y|z X Y Z OHM WAVEFORM [START STOP]" } else { "x|y|z X Y Z WAVEFORM [START STOP]" };
    let most = if voltage { before + 5 } else { before + 3 };
    let p = Parameters::of(command, form, |n| n == before + 1 || (before + 3..=most).contains(&n))?;
    if p.len() > before + 3 {
        return Err(p.unsupported("a port"));
    }
    let polarisation = polarisation(model, command, &p)?;
    let position = p.point(1)?;
    inside(model, "source", position)?;
    if let Some(axis) = model.transverse_electric {
        between_walls(model, axis, position)?;
    }
    let resistance = if voltage { p.number(4, "a resistance in ohm")? } else { 0.0 };
    p.check("the resistance", resistance, resistance >= 0.0, "0 or more")?;
    let id = p.word(before)?;
    let waveform = model.waveforms.iter().position(|known| known.id == id).ok_or_else(|| Problem::Undefined {
        what: "waveform",
        id: id.into(),
        nearest: nearest_name(id, model.waveforms.iter().map(|known| known.id.as_str())).map(Into::into),
    })?;
    let mut excitation = Excitation { start: 0.0, stop: None };
    if p.len() > before + 1 {
        let (start, stop) = (p.number(before + 1, "a time in seconds")?, p.number(before + 2, "a time in seconds")?);
        p.check("the start", start, start >= 0.0, "0 or later")?;
        p.check("the stop", stop, stop > start, "later than the start")?;
        excitation = Excitation { start, stop: Some(stop) };
    }
    model.sources.push(match command.name {
        "magnetic_dipole" => Source::MagneticDipole(MagneticDipole { polarisation, position, waveform, excitation }),
        "voltage_source" => {
            Source::VoltageSource(VoltageSource { polarisation, position, resistance, waveform, excitation })
        }
        _ => Source::HertzianDipole(HertzianDipole { polarisation, position, waveform, excitation }),
    });
    Ok(())
}

/// The direction of a source. On a grid of one cell along an axis, currents and voltages are along it, magnetic dipoles
/// across; in a TE model the other way round.
fn polarisation(model: &Model, command: &Command<'_>, p: &Parameters<'_>) -> Result<Axis, Problem> {
    const AXES: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];
    let word = p.word(0)?;
    let found = AXES.into_iter().find(|axis| axis.name() == word.to_lowercase());
    let found = found.ok_or_else(|| p.not_one_of(word, "a polarisation", "x, y, z".into()))?;
    let Some(invariant) = AXES.into_iter().find(|axis| model.invariant_axis() == Some(axis.index())) else {
        return Ok(found);
    };
    let (magnetic, along) = (command.name == "magnetic_dipole", found == invariant);
    let (polarisation, axis) = (found.name(), invariant.name());
    match (model.transverse_electric.is_some(), magnetic) {
        (true, true) if !along => Err(Problem::MagneticTransverseElectric { polarisation, axis }),
        (true, false) if along => Err(Problem::AcrossTransverseElectric { polarisation }),
        (false, true) if along => Err(Problem::Polarisation { polarisation, axis, how: "across" }),
        (false, false) if !along => Err(Problem::Polarisation { polarisation, axis, how: "along" }),
        _ => Ok(found),
    }
}
