//! The ranges of a scene's quantities, checked once.

use crate::units::{Metres, Share};

use super::error::SceneError;
use super::spec::SceneSpec;

/// Checks every quantity that no type has checked yet.
pub(super) fn check(spec: &SceneSpec) -> Result<(), SceneError> {
    let tank = &spec.tank;
    positive("tank.width", tank.width, "`width = \"1.47 m\"` under `[tank]`")?;
    positive("tank.height", tank.height, "`height = \"48 cm\"` under `[tank]`")?;
    not_negative("tank.wall", tank.wall)?;
    not_negative("tank.base", tank.base)?;
    not_negative("tank.margin", tank.margin)?;
    require(
        !tank.embedded || tank.wall.si() == 0.0,
        "tank.wall",
        &tank.wall,
        "0 m where `embedded = true`",
        "`wall = \"0 m\"` under `[tank]`",
    )?;
    positive("grid.cell", spec.grid.cell, "`--cell 2mm`")?;
    positive("antenna.height", spec.antenna.height, "`height = \"40 cm\"` under `[antenna]`")?;
    not_negative("antenna.separation", spec.antenna.separation)?;
    positive("packing.strip", spec.packing.strip, "`strip = \"2 cm\"` under `[packing]`")?;
    require(
        spec.antenna.frequency.si() > 0.0,
        "antenna.frequency",
        &spec.antenna.frequency,
        "above 0 GHz",
        "`--frequency 1GHz`",
    )?;
    require(
        spec.grid.time_window.si() > 0.0,
        "grid.time_window",
        &spec.grid.time_window,
        "above 0 ns",
        "`--time-window 25ns`",
    )?;
    if let Some(depth) = tank.depth {
        positive("tank.depth", depth, "`depth = \"0.5 m\"` under `[tank]`")?;
    }
    if let Some(slice) = spec.packing.slice {
        let depth = tank.inner_depth();
        require(
            (0.0..=depth.si()).contains(&slice.si()),
            "packing.slice",
            &slice,
            &format!("within the tank (0 m to {depth})"),
            "leave it out for the middle",
        )?;
    }
    let widest = tank.width.si().min(tank.height.si());
    require(
        spec.grid.cell.si() <= widest / 10.0,
        "grid.cell",
        &spec.grid.cell.in_unit("mm"),
        &format!("at most a tenth of the tank ({})", Metres(widest / 10.0).in_unit("mm")),
        "`--cell 2mm`",
    )?;
    if let Some(position) = spec.antenna.position {
        require(
            (0.0..=tank.width.si()).contains(&position.si()),
            "antenna.position",
            &position,
            &format!("within the tank (0 m to {})", tank.width),
            "leave it out to stand in the middle",
        )?;
    }
    if let Some(fouling) = &spec.fouling {
        require(
            fouling.filling.si() > 0.0 && fouling.filling.si() <= 1.0,
            "fouling.filling",
            &fouling.filling,
            "above 0% and up to 100%",
            "`filling = \"100%\"` under `[fouling]`",
        )?;
        require(
            (0.0..1.0).contains(&fouling.porosity.si()),
            "fouling.porosity",
            &fouling.porosity,
            "from 0% to below 100%",
            "`porosity = \"36%\"` under `[fouling]`",
        )?;
    }
    if let Some(moisture) = &spec.moisture {
        let most = spec.fouling.as_ref().map_or(Share(1.0), |fouling| fouling.porosity);
        require(
            (0.0..=most.si()).contains(&moisture.fines.si()),
            "moisture.fines",
            &moisture.fines,
            &format!("from 0% to the porosity of the fines ({most})"),
            "`--moisture 10%`",
        )?;
        if moisture.fines.si() > 0.0 && spec.fouling.is_none() {
            return Err(SceneError::NoFines { moisture: moisture.fines });
        }
        require(
            (0.0..=1.0).contains(&moisture.voids.si()),
            "moisture.voids",
            &moisture.voids,
            "from 0% to 100%",
            "`voids = \"5%\"` under `[moisture]`",
        )?;
    }
    Ok(())
}

fn require(
    holds: bool,
    key: &'static str,
    value: &dyn std::fmt::Display,
    limit: &str,
    hint: &str,
) -> Result<(), SceneError> {
    if holds {
        return Ok(());
    }
    Err(SceneError::OutOfRange { key, value: value.to_string(), limit: limit.into(), hint: hint.into() })
}

fn positive(key: &'static str, value: Metres, hint: &str) -> Result<(), SceneError> {
    require(value.si() > 0.0, key, &value, "above 0 m", hint)
}

fn not_negative(key: &'static str, value: Metres) -> Result<(), SceneError> {
    require(value.si() >= 0.0, key, &value, "0 m or more", "leave it out for the default")
}
