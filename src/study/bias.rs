//! How far the permittivity read off echoes is from that of the bed: methods, dimensions and fouling heights.

use crate::compare::permittivity::{from_surface_reflection, from_two_way_time};
use crate::compare::{CompareError, ExpectedEchoes, pick_echoes, subtract_reference};
use crate::forward::{Forward, OnProgress};
use crate::material::{Complex, MixingModel, mix};
use crate::model::Model;
use crate::packing::SphereBed;
use crate::raster;
use crate::scene::{self, Dimension, FoulingAmount, FoulingSpec, PackingMethod, Scene, SceneError, SceneSpec};
use crate::units::{Metres, Seconds, Share};

use super::echoes::{EchoError, Echoes, PlateReference, plate_reference_of, solve};
use super::statistics::MeanAndSpread;

/// How the waves travel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub enum Waves {
    /// In a section, the electric field along the stones: what a section usually means.
    #[serde(rename = "TMz")]
    TransverseMagnetic,
    /// In a section, the electric field in it.
    #[serde(rename = "TEz")]
    TransverseElectric,
    /// In space.
    #[serde(rename = "3-D")]
    Space,
}

impl Waves {
    /// Its name in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::TransverseMagnetic => "TMz",
            Self::TransverseElectric => "TEz",
            Self::Space => "3-D",
        }
    }

    fn turn(self, model: Model) -> Model {
        if self == Self::TransverseElectric { raster::transverse_electric(&model) } else { model }
    }
}

/// Why the bias could not be found.
#[derive(Debug, thiserror::Error)]
pub enum BiasError {
    /// A scene cannot be.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A run failed.
    #[error(transparent)]
    Echo(#[from] EchoError),
    /// Parts that do not mix.
    #[error(transparent)]
    Mix(#[from] crate::material::MixError),
}

impl From<CompareError> for BiasError {
    fn from(error: CompareError) -> Self {
        EchoError::from(error).into()
    }
}

/// What one bed reads.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Reading {
    /// Permittivity of the bed, from the mixture of what is in it, layer by layer, averaged as delays are.
    pub truth: f64,
    /// The same of its uppermost layer.
    pub truth_above: f64,
    /// The same from the nominal void share: CRIM from the composition.
    pub mixture: f64,
    /// From the delay between surface and base by the largest extremum of each (TDSP).
    pub delay_waveform: f64,
    /// The same by the peaks of the envelopes.
    pub delay_envelope: f64,
    /// The same by the envelope of the base alone, the surface where the plate was.
    pub delay_base: f64,
    /// Of the uppermost layer, from the surface echo over that of a plate there (SRM); none where that is no reflection.
    pub reflection: Option<f64>,
}

/// Bias of each method, in percent of the truth, over the beds of one kind.
#[derive(Debug, Clone, serde::Serialize)]
pub struct BiasRow {
    /// What the bed is.
    pub bed: String,
    /// How the waves travel.
    pub waves: Waves,
    /// Height of the fouled zone, cm.
    pub fouling_cm: f64,
    /// Beds without an echo that can be picked.
    pub not_picked: usize,
    /// Permittivity of the beds.
    pub truth: Option<MeanAndSpread>,
    /// See [`Reading::delay_waveform`].
    pub delay_waveform: Option<MeanAndSpread>,
    /// See [`Reading::delay_envelope`].
    pub delay_envelope: Option<MeanAndSpread>,
    /// See [`Reading::delay_base`].
    pub delay_base: Option<MeanAndSpread>,
    /// See [`Reading::reflection`].
    pub reflection: Option<MeanAndSpread>,
    /// See [`Reading::mixture`].
    pub mixture: Option<MeanAndSpread>,
    /// Every reading.
    pub readings: Vec<Reading>,
}

impl BiasRow {
    /// Sets readings beside the truth.
    pub fn of(bed: &str, waves: Waves, fouling: Metres, readings: Vec<Reading>, not_picked: usize) -> Self {
        let percent = |of: fn(&Reading) -> Option<(f64, f64)>| {
            let found: Vec<f64> =
                readings.iter().filter_map(of).map(|(found, truth)| 100.0 * (found / truth - 1.0)).collect();
            MeanAndSpread::of(&found)
        };
        Self {
            bed: bed.into(),
            waves,
            fouling_cm: 100.0 * fouling.si(),
            not_picked,
            truth: MeanAndSpread::of(&readings.iter().map(|r| r.truth).collect::<Vec<_>>()),
            delay_waveform: percent(|r| Some((r.delay_waveform, r.truth))),
            delay_envelope: percent(|r| Some((r.delay_envelope, r.truth))),
            delay_base: percent(|r| Some((r.delay_base, r.truth))),
            reflection: percent(|r| Some((r.reflection?, r.truth_above))),
            mixture: percent(|r| Some((r.mixture, r.truth))),
            readings,
        }
    }
}

/// Permittivity of a stack, as its delay has it, and of its uppermost layer.
pub fn of_layers(scene: &Scene) -> (f64, f64) {
    let bed = scene.layers.iter().filter(|layer| layer.name != "base plate");
    let (mut delay, mut thickness, mut above) = (0.0, 0.0, None);
    for layer in bed {
        delay += layer.thickness.si() * layer.eps_r.sqrt();
        thickness += layer.thickness.si();
        above.get_or_insert(layer.eps_r);
    }
    ((delay / thickness).powi(2), above.unwrap_or(1.0))
}

/// The scene as layers of mixtures with the void share that its stones leave up to the nominal height.
fn as_layers(scene: &Scene) -> Result<Scene, SceneError> {
    let mut spec = scene.spec.clone();
    spec.packing.method = PackingMethod::Homogeneous;
    let height = spec.tank.height;
    let solid = match (&scene.spheres, &scene.packing) {
        (Some(bed), _) if scene.spec.grid.dimension == Dimension::Three => {
            Some(bed.solid_share_between(Metres(0.0), height))
        }
        (_, Some(packing)) => Some(packing.solid_share_between(Metres(0.0), height)),
        _ => None,
    };
    if let Some(solid) = solid {
        spec.packing.voids = Share(1.0 - solid.si());
    }
    scene::resolve(&spec)
}

/// The base's echo comes earlier than through the mixture where the field lies across the stones: as through Maxwell Garnett's
/// mixture of cylinders.
fn earliest(scene: &Scene) -> Result<f64, BiasError> {
    let centre = scene.spec.antenna.frequency;
    let solid = Share(1.0 - scene.spec.packing.voids.si());
    let mut delay = 0.0;
    for layer in scene.layers.iter().filter(|layer| layer.name != "base plate") {
        let fouled = layer.name.starts_with("fouled");
        let (void, stone) = if fouled {
            (&scene.bed.void_fouled, &scene.bed.stone_fouled)
        } else {
            (&scene.bed.void_clean, &scene.bed.stone_clean)
        };
        let parts: [(Share, Complex); 2] =
            [(scene.spec.packing.voids, void.eps_at(centre)), (solid, stone.eps_at(centre))];
        let eps = mix(MixingModel::MaxwellGarnett2dTe, &parts)?.re;
        delay += layer.thickness.si() * (layer.eps_r.sqrt() - eps.sqrt());
    }
    Ok(2.0 * delay / crate::units::constants::C0)
}

/// Runs one scene and reads it; none where an echo cannot be picked.
///
/// # Errors
/// When a run fails.
pub fn read_bed(
    solver: &dyn Forward,
    scene: &Scene,
    waves: Waves,
    reference: &PlateReference,
    on_progress: OnProgress<'_>,
) -> Result<Option<Reading>, BiasError> {
    let trace = solve(solver, &waves.turn(raster::build_model(scene).map_err(EchoError::from)?), on_progress)?;
    let (echoes_only, _) = subtract_reference(&trace, &reference.free_space);
    let (surface, mut plate) = reference.windows(scene);
    if waves == Waves::TransverseElectric {
        plate.0 = Seconds(plate.0.si() - earliest(scene)?);
    }
    let expected = ExpectedEchoes {
        surface: Some(surface),
        plate: Some(plate),
        no_direct_wave: true,
        no_noise: true,
        ..ExpectedEchoes::default()
    };
    let Echoes { surface, plate } = match reference.echoes_of(&pick_echoes(&echoes_only, &expected)) {
        Ok(echoes) => echoes,
        Err(EchoError::NotPicked { .. }) => return Ok(None),
        Err(error) => return Err(error.into()),
    };
    let thickness = scene.spec.tank.height;
    let delay = |from: Seconds, to: Seconds| from_two_way_time(Seconds(to.si() - from.si()), thickness);
    let (truth, truth_above) = of_layers(&as_layers(scene)?);
    Ok(Some(Reading {
        truth,
        truth_above,
        mixture: of_layers(scene).0,
        delay_waveform: delay(surface.waveform, plate.waveform),
        delay_envelope: delay(surface.envelope, plate.envelope),
        delay_base: delay(scene.arrivals.surface, plate.envelope),
        reflection: from_surface_reflection(surface.relative_amplitude, -1.0).ok(),
    }))
}

/// The beds that are read.
#[derive(Debug, Clone, Copy)]
pub enum Beds<'a> {
    /// As the scene makes them, seeds from the scene's on.
    Seeds(u64),
    /// Beds of spheres that have been settled, the antenna above each of these places, as shares of width and depth; a section
    /// goes through it.
    Spheres(&'a [SphereBed], &'a [[f64; 2]]),
}

/// Reads the beds of a scene for each fouling height: one row each. The tank has no base plate, so that its depth is the bed's.
///
/// # Errors
/// When a scene or a run fails.
pub fn bias_rows(
    solver: &dyn Forward,
    name: &str,
    base: &SceneSpec,
    beds: Beds<'_>,
    waves: Waves,
    heights: &[Metres],
    on_progress: OnProgress<'_>,
) -> Result<Vec<BiasRow>, BiasError> {
    let mut base = base.clone();
    base.tank.base = Metres(0.0);
    base.grid.dimension = if waves == Waves::Space { Dimension::Three } else { Dimension::Two };
    let mut rows = vec![];
    let mut reference: Option<PlateReference> = None;
    for height in heights {
        let mut spec = base.clone();
        spec.fouling = (height.si() > 0.0).then(|| FoulingSpec::of(FoulingAmount::Height(*height)));
        let (mut readings, mut not_picked) = (vec![], 0);
        for scene in scenes(&spec, beds) {
            let scene = scene?;
            let reference = match &mut reference {
                Some(reference) => &*reference,
                none => none.insert(plate_reference_of(solver, &scene, &|model| waves.turn(model), on_progress)?),
            };
            match read_bed(solver, &scene, waves, reference, on_progress)? {
                Some(reading) => readings.push(reading),
                None => not_picked += 1,
            }
        }
        rows.push(BiasRow::of(name, waves, *height, readings, not_picked));
    }
    Ok(rows)
}

fn scenes<'a>(spec: &'a SceneSpec, beds: Beds<'a>) -> Box<dyn Iterator<Item = Result<Scene, SceneError>> + 'a> {
    match beds {
        Beds::Seeds(count) => Box::new(
            (0..count).map(move |k| scene::resolve(&SceneSpec { seed: spec.seed.wrapping_add(k), ..spec.clone() })),
        ),
        Beds::Spheres(beds, places) => Box::new(beds.iter().flat_map(move |bed| {
            places.iter().map(move |[x, y]| {
                let mut spec = spec.clone();
                spec.antenna.position = Some(Metres(x * bed.size[0].si()));
                spec.packing.slice = Some(Metres(y * bed.size[1].si()));
                scene::resolve_with(&spec, Some(bed.clone()))
            })
        })),
    }
}
