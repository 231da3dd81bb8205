//! What the absorbing boundary does: `#pml_formulation` and `#pml_cfs`.

use super::error::Problem;
use super::lines::Command;
use super::values::Parameters;
use crate::model::{Formulation, Grading, Model, Stretch};

/// Reads `#pml_formulation`.
pub(super) fn formulation(command: &Command<'_>) -> Result<Formulation, Problem> {
    let p = Parameters::of(command, "HORIPML|MRIPML", |n| n == 1 || n == 2)?;
    if p.len() == 2 {
        return Err(p.unsupported("a profile of its own"));
    }
    let word = p.word(0)?;
    let known = [Formulation::Recursive, Formulation::Multipole];
    let found = known.into_iter().find(|formulation| formulation.name() == word.to_uppercase());
    found.ok_or_else(|| p.not_one_of(word, "a formulation", known.map(Formulation::name).join(", ")))
}

/// Reads one `#pml_cfs`.
pub(super) fn stretch(model: &mut Model, command: &Command<'_>) -> Result<(), Problem> {
    let form = "PROFILE forward|reverse MIN MAX of alpha, then of kappa, then of sigma (MAX of sigma may be None)";
    let p = Parameters::of(command, form, |n| n == 12 || n == 13)?;
    if p.len() == 13 {
        return Err(p.unsupported("a profile of its own"));
    }
    if model.absorbing_profile.stretches.len() == 2 {
        return Err(p.unsupported("the third"));
    }
    let alpha = grading(&p, 0, false)?;
    let kappa = grading(&p, 4, false)?;
    let sigma = grading(&p, 8, true)?;
    model.absorbing_profile.stretches.push(Stretch { alpha, kappa, sigma });
    Ok(())
}

/// Reads a `#symmetry_boundary`: the outer walls conduct perfectly in any case, so a plane on which the electric field stands
/// upright is a side without absorbing cells.
pub(super) fn symmetry(model: &mut Model, command: &Command<'_>) -> Result<(), Problem> {
    const FACES: [&str; 6] = ["x0", "y0", "z0", "xmax", "ymax", "zmax"];
    let p = Parameters::of(command, "x0|y0|z0|xmax|ymax|zmax pec|pmc", |n| n == 2)?;
    let (face, kind) = (p.word(0)?.to_lowercase(), p.word(1)?.to_lowercase());
    let side = FACES.iter().position(|known| *known == face);
    let side = side.ok_or_else(|| p.not_one_of(p.word(0).unwrap_or(""), "a face", FACES.join(", ")))?;
    match kind.as_str() {
        "pec" if model.invariant_axis() != Some(side % 3) => {}
        "pec" => return Err(p.unsupported("a face across the axis along which nothing changes")),
        "pmc" => return Err(p.unsupported("a perfect magnetic conductor")),
        _ => return Err(p.not_one_of(p.word(1)?, "a kind of symmetry", "pec, pmc".into())),
    }
    let mut cells = model.absorbing_cells();
    cells[side] = 0;
    model.pml_cells = Some(cells);
    Ok(())
}

fn grading(p: &Parameters<'_>, first: usize, may_be_chosen: bool) -> Result<Grading, Problem> {
    let word = p.word(first)?;
    let order = Grading::ORDERS.iter().position(|known| *known == word.to_lowercase());
    let order = order.ok_or_else(|| p.not_one_of(word, "a profile", Grading::ORDERS.join(", ")))?;
    let direction = p.word(first + 1)?;
    let reverse = match direction.to_lowercase().as_str() {
        "forward" => false,
        "reverse" => true,
        _ => return Err(p.not_one_of(direction, "a direction", "forward, reverse".into())),
    };
    let at_least_0 = |what, value| p.check(what, value, value >= 0.0, "0 or more");
    let min = at_least_0("the least value", p.number(first + 2, "the least value")?)?;
    let max = match p.word(first + 3)? {
        "None" if may_be_chosen => None,
        _ => Some(at_least_0("the largest value", p.number(first + 3, "the largest value")?)?),
    };
    Ok(Grading { order: order as u8, reverse, min, max })
}
