//! The media of the bed: from materials, fouling and moisture to what fills stones and voids.

use crate::material::{self, Complex, Dielectric, JudgedBy, MixingModel};
use crate::units::{Hertz, Share, SiemensPerMetre};

use super::bed::{Bed, BulkPermittivity};
use super::error::SceneError;
use super::medium::Medium;
use super::spec::{EquivalentStone, SceneSpec};

/// Looks up the dielectric of a named material of the scene.
pub(super) fn medium(spec: &SceneSpec, name: &str) -> Result<Medium, SceneError> {
    let found = spec.materials.get(name).ok_or_else(|| SceneError::Conductor { name: name.into() })?;
    let dielectric = found.dielectric().map_err(|source| SceneError::Dielectric { name: name.into(), source })?;
    if dielectric == Dielectric::lossless(1.0) {
        return Ok(Medium::air());
    }
    Ok(Medium { name: name.replace([' ', '+'], "_"), dielectric })
}

/// Mixes media by the scene's rule; mixtures with loss or relaxation become one Debye pole and a conductivity, fitted
/// from a tenth to three times the centre frequency.
fn mixed(name: &str, model: MixingModel, parts: &[(Share, &Medium)], centre: Hertz) -> Result<Medium, SceneError> {
    if let Some((_, whole)) = parts.iter().find(|(share, _)| share.si() == 1.0) {
        return Ok((*whole).clone());
    }
    let plain = parts.iter().all(|(_, part)| part.dielectric.sigma.si() == 0.0 && part.dielectric.poles.is_empty());
    let dielectrics: Vec<(Share, &Dielectric)> = parts.iter().map(|(share, part)| (*share, &part.dielectric)).collect();
    let dielectric = if plain {
        Dielectric::lossless(material::mix_dielectrics(model, &dielectrics, centre)?.re)
    } else {
        material::effective_debye(model, &dielectrics, Hertz(0.1 * centre.si()), Hertz(3.0 * centre.si()))?.dielectric()
    };
    Ok(Medium { name: name.into(), dielectric })
}

/// Fines with water added in their pores: `sqrt(eps) = sqrt(fines) + theta (sqrt(water) - 1)`, the refractive index
/// model (CRIM) with water in the place of air.
fn moistened(fines: &Medium, theta: Share, centre: Hertz) -> Result<Medium, SceneError> {
    if theta.si() == 0.0 {
        return Ok(fines.clone());
    }
    let water = material::water();
    let wet = |frequency: f64| -> Complex {
        let frequency = Hertz(frequency);
        let index = fines.eps_at(frequency).sqrt() + theta.si() * (water.permittivity(frequency).sqrt() - 1.0);
        index * index
    };
    let fitted = material::debye_fit(wet, Hertz(0.1 * centre.si()), Hertz(3.0 * centre.si()))?;
    Ok(Medium { name: format!("moist_{}", fines.name), dielectric: fitted.dielectric() })
}

/// Excess of a 2-D bed over the arithmetic mean, for a contrast between stone and fill.
///
/// The published excess (`JudgedBy::factor`) was measured for stone 6.5 in air. The excess comes from scattering, whose
/// first order goes with the square of the contrast; so it is scaled by that. Assumed, not measured, for other contrasts.
fn excess(judged_by: JudgedBy, stone: f64, fill: f64) -> f64 {
    1.0 + (judged_by.factor() - 1.0) * ((stone - fill) / (6.5 - 1.0)).powi(2).min(1.0)
}

/// The media of the bed, its bulk permittivities by zone.
pub(super) fn bed(spec: &SceneSpec, fouled_height: f64) -> Result<(Bed, Vec<BulkPermittivity>), SceneError> {
    let centre = spec.antenna.frequency;
    let packing = &spec.packing;
    let solid = Share(1.0 - packing.voids.si());
    let stone = medium(spec, &packing.stone)?;
    let air = Medium::air();
    let void_water = spec.moisture.map_or(Share(0.0), |moisture| moisture.voids);
    let void_clean = if void_water.si() == 0.0 {
        air.clone()
    } else {
        let water = Medium { name: "water".into(), dielectric: material::water() };
        mixed("moist_voids", packing.mixing, &[(Share(1.0 - void_water.si()), &air), (void_water, &water)], centre)?
    };
    let void_fouled = match &spec.fouling {
        Some(fouling) if fouled_height > 0.0 => {
            let dry = medium(spec, &fouling.material)?;
            let fines = moistened(&dry, spec.moisture.map_or(Share(0.0), |moisture| moisture.fines), centre)?;
            let name = format!("{}_and_voids", fines.name);
            mixed(
                &name,
                packing.mixing,
                &[(fouling.filling, &fines), (Share(1.0 - fouling.filling.si()), &void_clean)],
                centre,
            )?
        }
        _ => void_clean.clone(),
    };
    let bulk =
        |name: &str, void: &Medium| mixed(name, packing.mixing, &[(solid, &stone), (packing.voids, void)], centre);
    let (bulk_clean, bulk_fouled) = (bulk("clean_ballast", &void_clean)?, bulk("fouled_ballast", &void_fouled)?);
    let equivalent = |suffix: &str, void: &Medium| -> Result<Medium, SceneError> {
        if packing.stone_permittivity == EquivalentStone::True {
            return Ok(stone.clone());
        }
        let (rock, fill) = (stone.eps_at(centre), void.eps_at(centre));
        let factor = excess(packing.judged_by, rock.re, fill.re);
        let found = material::equivalent_2d(rock, fill, solid, JudgedBy::Factor(factor))?;
        let dielectric = Dielectric {
            eps_r: found.stone.re,
            sigma: SiemensPerMetre(stone.dielectric.sigma.si()),
            poles: stone.dielectric.poles.clone(),
        };
        Ok(Medium { name: format!("{}_2d_{suffix}", stone.name), dielectric })
    };
    let (stone_clean, stone_fouled) = (equivalent("clean", &void_clean)?, equivalent("fouled", &void_fouled)?);
    let zone = |zone, void: &Medium, bulk: &Medium, in_model: &Medium| {
        let (rock, fill, model) = (stone.eps_r_at(centre), void.eps_r_at(centre), in_model.eps_r_at(centre));
        let arithmetic = |stone: f64| solid.si() * stone + packing.voids.si() * fill;
        BulkPermittivity {
            zone,
            solid_share: solid.si(),
            mixture: bulk.eps_r_at(centre),
            two_dimensional: arithmetic(rock) * excess(packing.judged_by, rock, fill),
            stone_in_model: model,
            two_dimensional_in_model: arithmetic(model) * excess(packing.judged_by, rock, fill),
        }
    };
    let mut zones = vec![zone("clean", &void_clean, &bulk_clean, &stone_clean)];
    if fouled_height > 0.0 {
        zones.push(zone("fouled", &void_fouled, &bulk_fouled, &stone_fouled));
    }
    Ok((Bed { fouled_height, stone_clean, stone_fouled, void_clean, void_fouled, bulk_clean, bulk_fouled }, zones))
}
