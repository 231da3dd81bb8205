//! Whether a set-up can be simulated.

use super::DemError;
use super::setup::{Motion, Setup, WallShape};
use super::stuff::Stuff;
use super::vector::norm;
use crate::units::Metres;

/// Checks a set-up, all but the overlaps at the start.
pub fn check(setup: &Setup) -> Result<(), DemError> {
    for (material, stuff) in setup.stuffs.iter().enumerate() {
        check_stuff(material, stuff)?;
    }
    let materials = setup.stuffs.len();
    let known = |who, index, material| {
        if material < materials.min(1 << 16) {
            Ok(())
        } else {
            Err(DemError::NoSuchMaterial { who, index, material, materials })
        }
    };
    for (index, pairing) in setup.pairings.iter().enumerate() {
        pairing.materials.into_iter().try_for_each(|material| known("pairing", index, material))?;
        let number = |what, value: f64, good: bool, wanted| {
            if good { Ok(()) } else { Err(DemError::BadNumber { who: "pairing", index, what, value, wanted }) }
        };
        let friction = pairing.friction.unwrap_or(0.0);
        number("friction", friction, friction >= 0.0 && friction.is_finite(), "zero or above")?;
        let restitution = pairing.restitution.unwrap_or(0.0);
        number("restitution", restitution, (0.0..=1.0).contains(&restitution), "between 0 and 1")?;
    }
    for (index, grain) in setup.grains.iter().enumerate() {
        known("grain", index, grain.material)?;
        let bad = |what, value, wanted| Err(DemError::BadNumber { who: "grain", index, what, value, wanted });
        if !(grain.sphere.radius > 0.0 && grain.sphere.radius.is_finite()) {
            return bad("radius", grain.sphere.radius, "above zero");
        }
        for (what, vector) in [("place", grain.sphere.centre), ("velocity", grain.velocity), ("spin", grain.spin)] {
            if let Some(value) = vector.into_iter().find(|v| !v.is_finite()) {
                return bad(what, value, "finite");
            }
        }
    }
    for (index, wall) in setup.walls.iter().enumerate() {
        known("wall", index, wall.material)?;
        check_motion(index, &wall.shape, &wall.motion)?;
    }
    if let Some(&value) = setup.gravity.iter().find(|v| !v.is_finite()) {
        return Err(DemError::BadNumber { who: "simulation", index: 0, what: "gravity", value, wanted: "finite" });
    }
    check_boxes(setup)
}

fn check_stuff(material: usize, stuff: &Stuff) -> Result<(), DemError> {
    let above = |v: f64| v > 0.0 && v.is_finite();
    for (property, value, good, wanted) in [
        ("density", stuff.density, above(stuff.density), "above zero, in kg/m³"),
        ("modulus of Young", stuff.young, above(stuff.young), "above zero, in Pa"),
        ("ratio of Poisson", stuff.poisson, (0.0..=0.5).contains(&stuff.poisson), "between 0 and 0.5"),
        ("restitution", stuff.restitution, (0.0..=1.0).contains(&stuff.restitution), "between 0 and 1"),
        ("friction", stuff.friction, stuff.friction >= 0.0 && stuff.friction.is_finite(), "zero or above"),
        (
            "rolling friction",
            stuff.rolling_friction,
            stuff.rolling_friction >= 0.0 && stuff.rolling_friction.is_finite(),
            "zero or above",
        ),
    ] {
        if !good {
            return Err(DemError::Property { material, property, value, wanted });
        }
    }
    Ok(())
}

/// Checks how a wall is to move.
pub fn check_motion(wall: usize, shape: &WallShape, motion: &Motion) -> Result<(), DemError> {
    if let WallShape::Plane { point, normal } = shape {
        let length = norm(*normal);
        if !(length > 0.0 && length.is_finite() && point.iter().all(|v| v.is_finite())) {
            return Err(DemError::BadNumber {
                who: "wall",
                index: wall,
                what: "normal's length",
                value: length,
                wanted: "above zero and finite",
            });
        }
    }
    let refuse = |why| Err(DemError::Motion { wall, why });
    match motion {
        Motion::Fixed => Ok(()),
        Motion::Prescribed { velocity, spin, about, from, until } => {
            if [velocity, spin, about].into_iter().flatten().any(|v| !v.is_finite()) {
                refuse("its velocity, spin and centre must be finite")
            } else if from.is_nan() || until.is_nan() {
                refuse("the times at which it begins and ends must be numbers")
            } else if *spin != [0.0; 3] && matches!(shape, WallShape::Plane { .. }) {
                refuse("a plane has no end and cannot turn; make it a mesh")
            } else {
                Ok(())
            }
        }
        Motion::Free { mass, velocity, load, .. } => {
            if !(*mass > 0.0 && mass.is_finite()) {
                refuse("the mass of a free body must be above zero and finite, in kg")
            } else if [velocity, load].into_iter().flatten().any(|v| !v.is_finite()) {
                refuse("its velocity and load must be finite")
            } else {
                Ok(())
            }
        }
    }
}

fn check_boxes(setup: &Setup) -> Result<(), DemError> {
    let largest = 2.0 * setup.grains.iter().map(|grain| grain.sphere.radius).fold(0.0, f64::max);
    let fits = |what, axis: usize, size: f64, least: f64| {
        if size >= least && size > 0.0 {
            Ok(())
        } else {
            Err(DemError::BoxTooSmall {
                what,
                axis: ['x', 'y', 'z'][axis],
                size: Metres(size),
                diameter: Metres(largest),
                least: Metres(least),
            })
        }
    };
    for (axis, ends) in setup.periodic.iter().enumerate() {
        // Twice the reach of a contact with some skin, so that a pair meets by one image only.
        ends.map_or(Ok(()), |[from, to]| fits("periodic box", axis, to - from, 2.5 * largest))?;
    }
    (0..3).try_for_each(|axis| fits("domain", axis, setup.domain[1][axis] - setup.domain[0][axis], largest))
}
