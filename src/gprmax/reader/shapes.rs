//! Triangles, ellipsoids, cones, sectors, plates and edges.

use super::error::Problem;
use super::lines::Command;
use super::multiple::{directional, inside, material_id, stuff};
use super::values::Parameters;
use crate::model::{Axis, Model, Object};

const AXES: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

pub(super) fn triangle(model: &mut Model, command: &Command<'_>) -> Result<(), Problem> {
    let form = "X1 Y1 Z1 X2 Y2 Z2 X3 Y3 Z3 THICKNESS MATERIAL [y|n]";
    let p = Parameters::of(command, form, |n| (11..=15).contains(&n))?;
    let corners = [p.point(0)?, p.point(3)?, p.point(6)?];
    for corner in corners {
        inside(model, "corner of the triangle", corner)?;
    }
    let thickness = p.number(9, "a thickness in metres")?;
    p.check("the thickness", thickness, thickness >= 0.0, "0 or more")?;
    let even = |axis: &Axis| {
        let node = |corner: [f64; 3]| model.grid.node(axis.index(), corner[axis.index()]);
        corners.iter().all(|&corner| node(corner) == node(corners[0]))
    };
    let Some(axis) = AXES.into_iter().find(even) else {
        return Err(p.unsupported("a triangle that lies across no axis"));
    };
    let (material, averaging) = stuff(model, &p, 10)?;
    model.objects.push(Object::Triangle { corners, axis, thickness, material, averaging });
    Ok(())
}

pub(super) fn ellipsoid(model: &mut Model, command: &Command<'_>) -> Result<(), Problem> {
    let p = Parameters::of(command, "X Y Z RADIUS_X RADIUS_Y RADIUS_Z MATERIAL [y|n]", |n| (7..=11).contains(&n))?;
    let (centre, radii) = (p.point(0)?, p.point(3)?);
    for radius in radii {
        p.check("a half-axis", radius, radius > 0.0, "above 0")?;
    }
    let (material, averaging) = stuff(model, &p, 6)?;
    model.objects.push(Object::Ellipsoid { centre, radii, material, averaging });
    Ok(())
}

pub(super) fn cone(model: &mut Model, command: &Command<'_>) -> Result<(), Problem> {
    let p = Parameters::of(command, "X1 Y1 Z1 X2 Y2 Z2 RADIUS1 RADIUS2 MATERIAL [y|n]", |n| (9..=13).contains(&n))?;
    if model.invariant_axis().is_some() {
        return Err(p.unsupported("a cone in two dimensions (gprMax refuses it too)"));
    }
    let (start, end) = (p.point(0)?, p.point(3)?);
    let radii = [p.number(6, "a radius in metres")?, p.number(7, "a radius in metres")?];
    for radius in radii {
        p.check("a radius", radius, radius >= 0.0, "0 or more")?;
    }
    p.check("the larger radius", radii[0].max(radii[1]), radii[0].max(radii[1]) > 0.0, "above 0")?;
    let (material, averaging) = stuff(model, &p, 8)?;
    model.objects.push(Object::Cone { start, end, radii, material, averaging });
    Ok(())
}

pub(super) fn sector(model: &mut Model, command: &Command<'_>) -> Result<(), Problem> {
    let form = "x|y|z CENTRE1 CENTRE2 LOWER UPPER RADIUS START_ANGLE SWEEP MATERIAL [y|n]";
    let p = Parameters::of(command, form, |n| (9..=13).contains(&n))?;
    let word = p.word(0)?;
    let axis = AXES.into_iter().find(|axis| axis.name() == word.to_lowercase());
    let axis = axis.ok_or_else(|| p.not_one_of(word, "an axis", "x, y, z".into()))?;
    let metres = |index: usize| p.number(index, "a coordinate in metres");
    let (centre, extent) = ([metres(1)?, metres(2)?], [metres(3)?, metres(4)?]);
    p.check("the upper end", extent[1], extent[1] >= extent[0], "at least the lower end")?;
    let radius = p.number(5, "a radius in metres")?;
    p.check("the radius", radius, radius > 0.0, "above 0")?;
    let (start, sweep) = (p.number(6, "an angle in degrees")?, p.number(7, "an angle in degrees")?);
    p.check("the starting angle", start, (0.0..360.0).contains(&start), "from 0 to below 360 degrees")?;
    p.check("the swept angle", sweep, sweep > 0.0 && sweep < 360.0, "above 0 and below 360 degrees")?;
    let (material, averaging) = stuff(model, &p, 8)?;
    model.objects.push(Object::Sector { axis, centre, extent, radius, start, sweep, material, averaging });
    Ok(())
}

pub(super) fn plate(model: &mut Model, command: &Command<'_>) -> Result<(), Problem> {
    let p = Parameters::of(command, "X1 Y1 Z1 X2 Y2 Z2 MATERIAL [MATERIAL]", |n| n == 7 || n == 8)?;
    let (lower, upper) = ends(model, &p, "corner of the plate")?;
    let flat = extents(model, lower, upper).into_iter().filter(|&cells| cells == 0).count();
    p.check("the number of axes along which it has no extent", flat as f64, flat == 1, "1")?;
    let mut material = material_id(model, &p, p.word(6)?)?;
    if p.len() == 8 {
        // The materials along the first and along the second of its axes; nothing of it lies along the third.
        let second = material_id(model, &p, p.word(7)?)?;
        let across = extents(model, lower, upper).iter().position(|&cells| cells == 0);
        let along = [[second, material, second], [material, second, second], [material, second, second]];
        material = directional(model, &p, along[across.unwrap_or(2)])?;
    }
    model.objects.push(Object::Plate { lower, upper, material });
    Ok(())
}

pub(super) fn edge(model: &mut Model, command: &Command<'_>) -> Result<(), Problem> {
    let p = Parameters::of(command, "X1 Y1 Z1 X2 Y2 Z2 MATERIAL", |n| n == 7)?;
    let (lower, upper) = ends(model, &p, "end of the edge")?;
    let long = extents(model, lower, upper).into_iter().filter(|&cells| cells != 0).count();
    p.check("the number of axes along which it has an extent", long as f64, long == 1, "1")?;
    let material = material_id(model, &p, p.word(6)?)?;
    model.objects.push(Object::Edge { lower, upper, material });
    Ok(())
}

/// Two points on the grid, the second nowhere below the first.
fn ends(model: &Model, p: &Parameters<'_>, what: &'static str) -> Result<([f64; 3], [f64; 3]), Problem> {
    let (lower, upper) = (p.point(0)?, p.point(3)?);
    inside(model, what, lower)?;
    inside(model, what, upper)?;
    for (axis, cells) in AXES.into_iter().zip(extents(model, lower, upper)) {
        if cells < 0 {
            return Err(Problem::NoCells {
                command: p.command().into(),
                axis: axis.name(),
                lower: lower[axis.index()],
                upper: upper[axis.index()],
            });
        }
    }
    Ok((lower, upper))
}

/// Cells between two points along each axis.
fn extents(model: &Model, lower: [f64; 3], upper: [f64; 3]) -> [i64; 3] {
    std::array::from_fn(|axis| model.grid.node(axis, upper[axis]) - model.grid.node(axis, lower[axis]))
}
