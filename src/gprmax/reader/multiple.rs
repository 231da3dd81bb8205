//! The commands that may stand any number of times: materials, receivers, objects; for waveforms and sources see
//! `sources`, for files beside the traces `outputs`.

use std::path::Path;

use super::super::geometry::{GeometryError, read_voxels};
use super::boundary::stretch;
use super::build::Note;
use super::dispersion::dispersion;
use super::error::Problem;
use super::excitation::excitation_file;
use super::lines::Command;
use super::outputs;
use super::shapes;
use super::sources;
use super::values::Parameters;
use crate::files::nearest_name;
use crate::model::{Axis, Material, MaterialId, Model, Object, Receiver};

/// Reads one of the commands that may stand any number of times.
pub(super) fn apply(
    model: &mut Model,
    path: &Path,
    command: &Command<'_>,
    notes: &mut Vec<Note>,
) -> Result<(), Problem> {
    match command.name {
        "material" => material(model, command),
        "add_dispersion_debye" | "add_dispersion_lorentz" | "add_dispersion_drude" => dispersion(model, command, notes),
        "pml_cfs" => stretch(model, command),
        "waveform" => sources::waveform(model, command),
        "excitation_file" => excitation_file(model, path, command),
        "hertzian_dipole" | "magnetic_dipole" | "voltage_source" => sources::source(model, command),
        "rx" => receiver(model, command, notes),
        "rx_array" => receiver_array(model, command),
        "box" => cuboid(model, command),
        "sphere" => sphere(model, command),
        "triangle" => shapes::triangle(model, command),
        "ellipsoid" => shapes::ellipsoid(model, command),
        "cone" => shapes::cone(model, command),
        "cylindrical_sector" => shapes::sector(model, command),
        "plate" => shapes::plate(model, command),
        "edge" => shapes::edge(model, command),
        "cylinder" => cylinder(model, command),
        "snapshot" => outputs::snapshot(model, command),
        "geometry_view" => outputs::geometry_view(model, command),
        "geometry_objects_write" => outputs::geometry_objects_write(model, command),
        _ => geometry_objects_read(model, path, command),
    }
}

fn material(model: &mut Model, command: &Command<'_>) -> Result<(), Problem> {
    let p = Parameters::of(command, "EPS_R SIGMA MU_R SIGMA* ID", |n| n == 5)?;
    let (eps_r, sigma) = (p.number(0, "a relative permittivity")?, p.number_or_infinity(1, "a conductivity in S/m")?);
    let (mu_r, sigma_magnetic) = (p.number(2, "a relative permeability")?, p.number_or_infinity(3, "a magnetic loss")?);
    let id = p.word(4)?;
    p.check("the relative permittivity", eps_r, eps_r >= 1.0, "at least 1")?;
    p.check("the conductivity", sigma, sigma >= 0.0, "0 or more, or inf")?;
    p.check("the relative permeability", mu_r, mu_r >= 1.0, "at least 1")?;
    p.check("the magnetic loss", sigma_magnetic, sigma_magnetic >= 0.0, "0 or more")?;
    if sigma_magnetic.is_infinite() {
        return Err(p.unsupported("a perfect magnetic conductor"));
    }
    if id.contains('+') {
        return Err(p.unsupported("an identifier with `+`"));
    }
    if id == "pmc" || model.material_named(id).is_some() {
        return Err(Problem::DefinedTwice { what: "material", id: id.into() });
    }
    if model.materials.len() >= usize::from(u16::MAX) {
        return Err(p.unsupported("the 65536th material"));
    }
    let averagable = sigma.is_finite();
    model.add_material(Material {
        id: id.into(),
        eps_r,
        sigma,
        mu_r,
        sigma_magnetic,
        poles: vec![],
        resonances: vec![],
        averagable,
        directional: None,
    });
    Ok(())
}

fn receiver(model: &mut Model, command: &Command<'_>, notes: &mut Vec<Note>) -> Result<(), Problem> {
    let p = Parameters::of(command, "X Y Z [NAME COMPONENT ...]", |n| n == 3 || n >= 5)?;
    let position = p.point(0)?;
    inside(model, "receiver", position)?;
    let components = p.rest(4);
    for word in components {
        if !["Ex", "Ey", "Ez", "Hx", "Hy", "Hz"].contains(word) {
            return Err(match *word {
                "Ix" | "Iy" | "Iz" => p.unsupported("a current"),
                _ => p.not_one_of(word, "a component", "Ex, Ey, Ez, Hx, Hy, Hz".into()),
            });
        }
    }
    if !components.is_empty() && components.len() < 6 {
        let text = format!("`#rx` asks for {} only: every component of the solver is given", components.join(" "));
        notes.push(Note { line: command.line, text });
    }
    model.receivers.push(Receiver { position, name: p.word(3).ok().map(Into::into) });
    Ok(())
}

/// The most receivers that a file may make with `#rx_array`.
const MOST_RECEIVERS: f64 = 1e6;

/// Receivers on a lattice of nodes, z fastest. Both corners are nodes of it where the steps divide the distance; a step of
/// zero stands for no lattice along that axis.
fn receiver_array(model: &mut Model, command: &Command<'_>) -> Result<(), Problem> {
    let p = Parameters::of(command, "X1 Y1 Z1 X2 Y2 Z2 DX DY DZ", |n| n == 9)?;
    let (lower, upper, steps) = (p.point(0)?, p.point(3)?, p.point(6)?);
    inside(model, "receiver", lower)?;
    inside(model, "receiver", upper)?;
    let grid = model.grid;
    // First and last node and step; counted before a receiver is made, for a domain may have billions of nodes.
    let (mut lattice, mut count) = ([(0i64, 0i64, 1usize); 3], 1.0);
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let (low, high) = (grid.node(axis, lower[axis]), grid.node(axis, upper[axis]));
        if low > high {
            return Err(Problem::ArrayCorners { axis: name, lower: lower[axis], upper: upper[axis] });
        }
        let step = grid.node(axis, steps[axis]);
        p.check("the step", steps[axis], steps[axis] >= 0.0, "0 or more")?;
        p.check("the step", steps[axis], step > 0 || low == high || steps[axis] == 0.0, "at least one cell")?;
        lattice[axis] = if step == 0 { (low, low, 1) } else { (low, high, step as usize) };
        let (first, last, step) = lattice[axis];
        count *= (((last - first) as usize) / step + 1) as f64;
    }
    let all = model.receivers.len() as f64 + count;
    p.check("the number of receivers", all, all <= MOST_RECEIVERS, "at most 1e6")?;
    let [xs, ys, zs] = lattice.map(|(first, last, step)| (first..=last).step_by(step));
    for i in xs {
        for j in ys.clone() {
            for k in zs.clone() {
                let node = [i, j, k];
                let position = std::array::from_fn(|axis| node[axis] as f64 * grid.spacing[axis]);
                model.receivers.push(Receiver { position, name: None });
            }
        }
    }
    Ok(())
}

fn cuboid(model: &mut Model, command: &Command<'_>) -> Result<(), Problem> {
    let p = Parameters::of(command, "X1 Y1 Z1 X2 Y2 Z2 MATERIAL [y|n]", |n| (7..=11).contains(&n))?;
    let (lower, upper) = (p.point(0)?, p.point(3)?);
    for axis in [Axis::X, Axis::Y, Axis::Z] {
        let (low, high) = (lower[axis.index()], upper[axis.index()]);
        if model.grid.node(axis.index(), low) >= model.grid.node(axis.index(), high) {
            return Err(Problem::NoCells { command: p.command().into(), axis: axis.name(), lower: low, upper: high });
        }
    }
    inside(model, "corner of the box", lower)?;
    inside(model, "corner of the box", upper)?;
    let (material, averaging) = stuff(model, &p, 6)?;
    model.objects.push(Object::Box { lower, upper, material, averaging });
    Ok(())
}

fn cylinder(model: &mut Model, command: &Command<'_>) -> Result<(), Problem> {
    let p = Parameters::of(command, "X1 Y1 Z1 X2 Y2 Z2 RADIUS MATERIAL [y|n]", |n| (8..=12).contains(&n))?;
    let (start, end) = (p.point(0)?, p.point(3)?);
    let radius = p.number(6, "a radius in metres")?;
    p.check("the radius", radius, radius > 0.0, "above 0")?;
    let (material, averaging) = stuff(model, &p, 7)?;
    model.objects.push(Object::Cylinder { start, end, radius, material, averaging });
    Ok(())
}

fn sphere(model: &mut Model, command: &Command<'_>) -> Result<(), Problem> {
    let p = Parameters::of(command, "X Y Z RADIUS MATERIAL [y|n]", |n| (5..=9).contains(&n))?;
    let (centre, radius) = (p.point(0)?, p.number(3, "a radius in metres")?);
    p.check("the radius", radius, radius > 0.0, "above 0")?;
    let (material, averaging) = stuff(model, &p, 4)?;
    model.objects.push(Object::Sphere { centre, radius, material, averaging });
    Ok(())
}

/// The material of an object and its averaging flag, from parameter `first` on; a tag may stand behind the flag.
/// Three identifiers are the materials along x, y and z, which are never averaged; behind them may stand a flag, which means
/// nothing, together with a tag.
pub(super) fn stuff(model: &mut Model, p: &Parameters<'_>, first: usize) -> Result<(MaterialId, bool), Problem> {
    let is_flag = |index: usize| p.word(index).is_ok_and(|word| matches!(word, "y" | "Y" | "n" | "N"));
    match p.len() - first {
        1 => Ok((material_id(model, p, p.word(first)?)?, true)),
        2 => Ok((material_id(model, p, p.word(first)?)?, p.yes_or_no(first + 1, "an averaging flag")?)),
        3 if is_flag(first + 1) => {
            Ok((material_id(model, p, p.word(first)?)?, p.yes_or_no(first + 1, "an averaging flag")?))
        }
        4 => Err(p.unsupported("one word behind three identifiers (gprMax refuses it too)")),
        words => {
            if words == 5 {
                p.yes_or_no(first + 3, "an averaging flag")?;
            }
            let along = [first, first + 1, first + 2].map(|index| material_id(model, p, p.word(index)?));
            let [x, y, z] = along;
            let along = [x?, y?, z?];
            if along.iter().any(|id| model.materials[id.index()].is_pec()) {
                return Err(p.unsupported("a perfect conductor among three identifiers"));
            }
            Ok((directional(model, p, along)?, false))
        }
    }
}

/// The material that has one material along each axis.
pub(super) fn directional(
    model: &mut Model,
    p: &Parameters<'_>,
    along: [MaterialId; 3],
) -> Result<MaterialId, Problem> {
    if model.materials.len() >= usize::from(u16::MAX) {
        return Err(p.unsupported("the 65536th material"));
    }
    Ok(model.add_directional(along))
}

fn geometry_objects_read(model: &mut Model, path: &Path, command: &Command<'_>) -> Result<(), Problem> {
    let p = Parameters::of(command, "X Y Z FILE.h5 DATABASE [y|n]", |n| n == 5 || n == 6)?;
    let origin = p.point(0)?;
    let (file, database) = (path.with_file_name("").join(p.word(3)?), p.word(4)?);
    let averaging = p.len() == 6 && p.yes_or_no(5, "an averaging flag")?;
    if database.ends_with(".txt") {
        return Err(GeometryError::OldFormat { path: file }.into());
    }
    let voxels = read_voxels(model, &file, database, origin, averaging)?;
    model.objects.push(Object::Voxels(voxels));
    Ok(())
}

pub(super) fn material_id(model: &Model, p: &Parameters<'_>, id: &str) -> Result<MaterialId, Problem> {
    if id == "pmc" {
        return Err(p.unsupported("a perfect magnetic conductor"));
    }
    model.material_named(id).ok_or_else(|| Problem::Undefined {
        what: "material",
        id: id.into(),
        nearest: nearest_name(id, model.materials.iter().map(|known| known.id.as_str())).map(Into::into),
    })
}

/// Sources of a TE model must lie on the layer of nodes that holds its fields.
pub(super) fn between_walls(model: &Model, axis: Axis, position: [f64; 3]) -> Result<(), Problem> {
    match model.grid.node(axis.index(), position[axis.index()]) {
        1 => Ok(()),
        node => Err(Problem::BetweenWalls { axis: axis.name(), node, spacing: model.grid.spacing[axis.index()] }),
    }
}

/// Sources, receivers and corners of boxes must lie on a node of the grid.
pub(super) fn inside(model: &Model, what: &'static str, position: [f64; 3]) -> Result<(), Problem> {
    let grid = &model.grid;
    let within = |axis: usize| (0..=grid.cells[axis] as i64).contains(&grid.node(axis, position[axis]));
    if (0..3).all(within) {
        return Ok(());
    }
    let ([x, y, z], domain) = (position, std::array::from_fn(|axis| grid.cells[axis] as f64 * grid.spacing[axis]));
    Err(Problem::Outside { what, x, y, z, domain })
}
