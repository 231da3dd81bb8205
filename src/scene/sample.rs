//! The stones of a scene: made, read, or cut out of a bed.

use std::path::Path;

use crate::files;
use crate::packing::export::{self, Particles};
use crate::packing::settle::SettleInput;
use crate::packing::spheres::{RandomAddition, random_addition};
use crate::packing::{self, Packing, Porosity, RsaOutcome, SlicePlane, SphereBed};
use crate::units::{Metres, Share};

use super::error::SceneError;
use super::resolve::rsa_input;
use super::spec::{Dimension, PackingMethod, SceneSpec};

/// The stones of a scene.
#[derive(Debug, Default)]
pub(super) struct Sample {
    pub(super) adsorption: Option<RsaOutcome>,
    pub(super) packing: Option<Packing>,
    pub(super) spheres: Option<SphereBed>,
}

/// Stones of a packing from outside may be this deep in one another, m: coordinates rounded to a tenth of a millimetre.
const FOREIGN_OVERLAP: Metres = Metres(2e-4);

/// Share of the box that random addition fills where the scene does not say: well below its end at 38 %.
const LOOSE: Share = Share(0.30);

/// Takes the stones that a scene asks for; `given` in place of spheres that it would make or read.
pub(super) fn take(spec: &SceneSpec, voids: Porosity, given: Option<SphereBed>) -> Result<Sample, SceneError> {
    if let Some(bed) = given {
        return of_spheres(spec, bed);
    }
    match spec.packing.method {
        PackingMethod::Homogeneous => Ok(Sample::default()),
        PackingMethod::Rsa => {
            in_a_plane(spec)?;
            let outcome = packing::pack(&rsa_input(spec, voids)?, spec.seed)?;
            Ok(Sample { packing: Some(outcome.after.clone()), adsorption: Some(outcome), spheres: None })
        }
        PackingMethod::RandomAddition => {
            let input = RandomAddition {
                size: [spec.tank.width, spec.tank.inner_depth(), spec.tank.height],
                periodic: [false; 2],
                grading: spec.packing.grading.curve()?,
                class_reading: spec.packing.class_reading,
                solid_share: spec.packing.solid_share.unwrap_or(LOOSE),
            };
            of_spheres(spec, random_addition(&input, spec.seed)?)
        }
        PackingMethod::Dem => Err(SceneError::NotSettled),
        PackingMethod::File => {
            let file = spec.packing.file.as_ref().ok_or(SceneError::NoPackingFile)?;
            match read(file, spec.tank.width)? {
                Particles::Space(bed) => of_spheres(spec, bed),
                Particles::Plane(discs) => {
                    in_a_plane(spec)?;
                    Ok(Sample { packing: Some(discs), ..Sample::default() })
                }
            }
        }
    }
}

fn in_a_plane(spec: &SceneSpec) -> Result<(), SceneError> {
    match spec.grid.dimension {
        Dimension::Two => Ok(()),
        Dimension::Three => Err(SceneError::DiscsInSpace { method: spec.packing.method.name() }),
    }
}

/// What the bed of a scene is settled from, for `method = "dem"`.
///
/// # Errors
/// When there is no built-in sieve curve of the name given.
pub fn settle_input(spec: &SceneSpec) -> Result<SettleInput, SceneError> {
    Ok(SettleInput {
        size: [spec.tank.width, spec.tank.inner_depth(), spec.tank.height],
        periodic: [false; 2],
        grading: spec.packing.grading.curve()?,
        class_reading: spec.packing.class_reading,
        how: spec.packing.dem.unwrap_or_default(),
    })
}

/// A bed as it is, with the section through it where the waves travel in a plane.
fn of_spheres(spec: &SceneSpec, bed: SphereBed) -> Result<Sample, SceneError> {
    let tank = [spec.tank.width, spec.tank.inner_depth()];
    let [length, width, _] = bed.size;
    if (length.si() - tank[0].si()).abs() > 1e-9 || (width.si() - tank[1].si()).abs() > 1e-9 {
        return Err(SceneError::BedSize { length, width, tank });
    }
    if bed.periodic != [false; 2] {
        return Err(SceneError::PeriodicBed);
    }
    let packing = match spec.grid.dimension {
        Dimension::Three => None,
        Dimension::Two => {
            let at = spec.packing.slice.unwrap_or(Metres(0.5 * width.si()));
            Some(bed.slice(SlicePlane::Y(at))?)
        }
    };
    Ok(Sample { adsorption: None, packing, spheres: Some(bed) })
}

/// Reads a packing of discs or spheres: JSON as this program writes it, else CSV in metres. The height of discs from a table is
/// that of its stones, its width the tank's.
fn read(file: &Path, width: Metres) -> Result<Particles, SceneError> {
    let text = files::read_text(file)?;
    if file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json")) {
        let particles = export::particles_from_json(&text, FOREIGN_OVERLAP)?;
        if let Particles::Plane(packing) = &particles
            && (packing.width.si() - width.si()).abs() > 1e-9
        {
            return Err(SceneError::PackingWidth { file: file.into(), packing: packing.width, tank: width });
        }
        return Ok(particles);
    }
    if export::is_csv_of_spheres(&text) {
        return Ok(Particles::Space(export::spheres_from_csv(&text, FOREIGN_OVERLAP)?));
    }
    let free = export::from_csv(&text, None, FOREIGN_OVERLAP)?;
    let height = free.top();
    Ok(Particles::Plane(export::from_csv(&text, Some((width, height)), FOREIGN_OVERLAP)?))
}
