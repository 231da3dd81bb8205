//! Poles: `#add_dispersion_debye`, `#add_dispersion_lorentz` and `#add_dispersion_drude`.

use std::f64::consts::PI;

use super::build::Note;
use super::error::Problem;
use super::lines::Command;
use super::multiple::material_id;
use super::values::Parameters;
use crate::model::{DebyePole, Model, Resonance};

/// Reads one of the three commands. gprMax takes all Debye commands first, then Lorentz, then Drude, and the last that names a
/// material replaces the poles that it had.
pub(super) fn dispersion(model: &mut Model, command: &Command<'_>, notes: &mut Vec<Note>) -> Result<(), Problem> {
    let (form, per_pole) = match command.name {
        "add_dispersion_debye" => ("POLES DELTA_EPS TAU [DELTA_EPS TAU ...] ID [ID ...]", 2),
        "add_dispersion_lorentz" => {
            ("POLES DELTA_EPS FREQUENCY DAMPING [DELTA_EPS FREQUENCY DAMPING ...] ID [ID ...]", 3)
        }
        _ => ("POLES FREQUENCY COLLISIONS [FREQUENCY COLLISIONS ...] ID [ID ...]", 2),
    };
    let p = Parameters::of(command, form, |n| n >= 2 + per_pole)?;
    let count = p.count(0, "a number of poles")?;
    p.check("the number of poles", count as f64, count > 0, "1 or more")?;
    if count.saturating_mul(per_pole).saturating_add(2) > p.len() {
        return Err(Problem::Parameters { command: command.name.into(), found: p.len(), form });
    }
    let (mut poles, mut resonances) = (vec![], vec![]);
    for first in (0..count).map(|pole| 1 + per_pole * pole) {
        match command.name {
            "add_dispersion_debye" => poles.push(debye(&p, first)?),
            "add_dispersion_lorentz" => resonances.push(lorentz(&p, first)?),
            _ => resonances.push(drude(&p, first)?),
        }
    }
    for id in p.rest(1 + per_pole * count) {
        let index = material_id(model, &p, id)?.index();
        let averaged = model.dispersive_averaging;
        let material = &mut model.materials[index];
        if material.is_pec() {
            return Err(p.unsupported("a perfect conductor with dispersion"));
        }
        if material.is_dispersive() {
            let text = format!("`#{}` replaces the poles that `{id}` had, as in gprMax", command.name);
            notes.push(Note { line: command.line, text });
        }
        material.poles.clone_from(&poles);
        material.resonances.clone_from(&resonances);
        material.averagable &= averaged;
    }
    Ok(())
}

fn debye(p: &Parameters<'_>, first: usize) -> Result<DebyePole, Problem> {
    let delta_eps = p.number(first, "a change of permittivity")?;
    let tau = p.number(first + 1, "a relaxation time in seconds")?;
    p.check("the change of permittivity", delta_eps, delta_eps >= 0.0, "0 or more")?;
    p.check("the relaxation time", tau, tau > 0.0, "above 0")?;
    Ok(DebyePole { delta_eps, tau })
}

fn lorentz(p: &Parameters<'_>, first: usize) -> Result<Resonance, Problem> {
    let delta_eps = p.number(first, "a change of permittivity")?;
    let frequency = p.number(first + 1, "a frequency in Hz")?;
    let damping = p.number(first + 2, "a damping in 1/s")?;
    p.check("the change of permittivity", delta_eps, delta_eps >= 0.0, "0 or more")?;
    p.check("the frequency", frequency, frequency > 0.0, "above 0")?;
    p.check("the damping", damping, damping >= 0.0, "0 or more")?;
    p.check("the damping", damping, damping < 2.0 * PI * frequency, "below 2 pi times the frequency")?;
    Ok(Resonance::Lorentz { delta_eps, frequency, damping })
}

fn drude(p: &Parameters<'_>, first: usize) -> Result<Resonance, Problem> {
    let frequency = p.number(first, "a frequency in Hz")?;
    let collisions = p.number(first + 1, "a collision rate in 1/s")?;
    p.check("the frequency", frequency, frequency >= 0.0, "0 or more")?;
    p.check("the collision rate", collisions, collisions > 0.0, "above 0")?;
    Ok(Resonance::Drude { frequency, collisions })
}
