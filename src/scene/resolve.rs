//! From what the user wrote to a checked and packed scene.

use std::path::Path;
use std::time::Instant;

use crate::files;
use crate::geometry::{Disc, disc_rectangle_area};
use crate::material::{self, BottomFilledBed, FoulingIndices};
use crate::model::{Between, Beyond, PulseTable, Sampled};
use crate::packing::{Packing, Porosity, RsaInput, RsaOutcome, SphereBed};
use crate::units::constants::C0;
use crate::units::{KilogramsPerCubicMetre, Metres, Seconds, Share};

use super::arrivals::{Arrivals, Layer, arrivals};
use super::bed::{Bed, BulkPermittivity};
use super::check::check;
use super::error::SceneError;
use super::fouling::{FoulingAmount, FoulingReport};
use super::medium::{MaterialSpec, Medium};
use super::mixture;
use super::sample::{self, Sample};
use super::spec::{FoulingSpec, GradingSpec, SceneSpec, TankSpec};

/// A scene, checked once, with its packing and the figures derived from it.
#[derive(Debug, Clone)]
pub struct Scene {
    /// What the user wrote, every default and material filled in.
    pub spec: SceneSpec,
    /// The random sequential adsorption, where there was one.
    pub adsorption: Option<RsaOutcome>,
    /// The discs: the packing, or the section through a bed of spheres; absent for a homogeneous bed and in space.
    pub packing: Option<Packing>,
    /// The bed of spheres, where there is one; also when the scene is a section through it.
    pub spheres: Option<SphereBed>,
    /// The pulse as samples, where the antenna has one from a file.
    pub pulse: Option<Sampled>,
    /// Walls and base.
    pub wall: Medium,
    /// What lies where in the bed.
    pub bed: Bed,
    /// Bulk permittivities of the bed's zones, from the bottom's view last.
    pub bulk: Vec<BulkPermittivity>,
    /// The layers from the surface down to the metal plate, with their mixtures' permittivities.
    pub layers: Vec<Layer>,
    /// When a plane wave's echoes would arrive, from the emission.
    pub arrivals: Arrivals,
    /// The fouling in every measure.
    pub fouling: Option<FoulingReport>,
    /// Wall time of the packing, s.
    pub packing_seconds: f64,
}

impl Scene {
    /// The stones of a section; empty for a homogeneous bed and in space. Origin: left lower corner of the bed.
    pub fn discs(&self) -> &[Disc] {
        self.packing.as_ref().map_or(&[], |packing| packing.discs.as_slice())
    }

    /// From and to, counted from the emission, of the surface's and the plate's echo.
    ///
    /// The surface is looked for from 0.6 periods before to one after its arrival: stones stand above and below the nominal
    /// surface, and the loose top lets the wave in. The plate from half a period before the arrival through the mixture to
    /// a period after that through the slowest bed (a 2-D bed of true stones).
    pub fn echo_windows(&self) -> [[Seconds; 2]; 2] {
        let period = 1.0 / self.spec.antenna.frequency.si();
        let (surface, plate) = (self.arrivals.surface.si(), self.arrivals.plate.si());
        let slowest = surface + self.slowest_delay().si();
        [
            [Seconds(surface - 0.6 * period), Seconds(surface + period)],
            [Seconds(plate.min(slowest) - 0.5 * period), Seconds(plate.max(slowest) + period)],
        ]
    }

    /// Two-way travel time through the layers if each were as slow as a 2-D bed of true stones.
    pub fn slowest_delay(&self) -> Seconds {
        let delay = |layer: &Layer| {
            let zone = self.bulk.iter().find(|bulk| layer.name.starts_with(bulk.zone));
            let eps = zone.map_or(layer.eps_r, |bulk| bulk.two_dimensional.max(bulk.mixture));
            2.0 * layer.thickness.si() * eps.sqrt() / C0
        };
        Seconds(self.layers.iter().map(delay).sum())
    }
}

/// Resolves a scene: fills in the materials, checks every quantity, packs the stones and derives the figures.
///
/// # Errors
/// See [`SceneError`].
pub fn resolve(spec: &SceneSpec) -> Result<Scene, SceneError> {
    resolve_with(spec, None)
}

/// As [`resolve`], with a bed of spheres that has been made already in place of the one that the scene would make or read.
///
/// # Errors
/// See [`SceneError`].
pub fn resolve_with(spec: &SceneSpec, spheres: Option<SphereBed>) -> Result<Scene, SceneError> {
    let mut spec = spec.clone();
    check(&spec)?;
    let voids = Porosity::new(spec.packing.voids)?;
    spec.packing.grading = GradingSpec::Curve(spec.packing.grading.curve()?);
    fill_in_materials(&mut spec)?;
    let pulse = spec.antenna.pulse.as_deref().map(read_pulse).transpose()?;
    let fouled_height = fouled_height(&spec)?;
    let wall = mixture::medium(&spec, &spec.tank.wall_material)?;
    let (bed, bulk) = mixture::bed(&spec, fouled_height)?;
    let layers = layers(&spec, &bed, &wall);
    let started = Instant::now();
    let Sample { adsorption, packing, spheres } = sample::take(&spec, voids, spheres)?;
    let packing_seconds = started.elapsed().as_secs_f64();
    let fouling = spec.fouling.as_ref().filter(|_| fouled_height > 0.0);
    let stones = Stones { packing: packing.as_ref(), spheres: spheres.as_ref() };
    let fouling = fouling.map(|fouling| report(&spec, fouling, fouled_height, stones)).transpose()?;
    let arrivals = arrivals(spec.antenna.height, &layers);
    Ok(Scene { adsorption, packing, spheres, pulse, wall, bed, bulk, layers, arrivals, fouling, packing_seconds, spec })
}

/// The input of the adsorption that a scene asks for.
///
/// # Errors
/// When there is no built-in sieve curve of the name given.
pub fn rsa_input(spec: &SceneSpec, voids: Porosity) -> Result<RsaInput, SceneError> {
    Ok(RsaInput {
        width: spec.tank.width,
        height: spec.tank.height,
        voids,
        grading: spec.packing.grading.curve()?,
        class_reading: spec.packing.class_reading,
        input: spec.packing.input,
        strip: spec.packing.strip,
    })
}

/// Reads the file of a pulse.
fn read_pulse(file: &Path) -> Result<Sampled, SceneError> {
    let text = files::read_text(file)?;
    let wrong = |line: usize, what: String| SceneError::Pulse { file: file.into(), line, what };
    let table = PulseTable::read(&text).map_err(|error| wrong(error.line, error.what))?;
    let Some(times) = table.times else {
        return Err(wrong(1, "the first column is not called `time`".into()));
    };
    let [(_, values)] = <[_; 1]>::try_from(table.pulses)
        .map_err(|pulses| wrong(1, format!("there are {} pulses, where a scene has one", pulses.len())))?;
    Sampled::new(times, values, Between::Linear, Beyond::Value(0.0))
        .ok_or_else(|| wrong(2, "the times do not grow from line to line".into()))
}

/// Puts every material that the scene names into its table, so that the file that is kept holds all values.
fn fill_in_materials(spec: &mut SceneSpec) -> Result<(), SceneError> {
    let mut names = vec![spec.packing.stone.clone(), spec.tank.wall_material.clone()];
    names.extend(spec.fouling.as_ref().map(|fouling| fouling.material.clone()));
    for name in names {
        if spec.materials.contains_key(&name) {
            continue;
        }
        let known = material::named(&name)?;
        let dielectric = known.dielectric().ok_or_else(|| SceneError::Conductor { name: name.clone() })?;
        let entry = MaterialSpec {
            eps_r: dielectric.eps_r,
            sigma: dielectric.sigma,
            density: density(&name),
            source: known.source.into(),
            assumed: known.confidence != material::Confidence::ReadInSource,
            poles: dielectric.poles,
        };
        spec.materials.insert(name, entry);
    }
    Ok(())
}

/// Grain densities of the tank's limestone and silt (Constr. Build. Mater. 140, 2017).
fn density(name: &str) -> Option<KilogramsPerCubicMetre> {
    match name {
        "limestone" => Some(KilogramsPerCubicMetre(2800.0)),
        "silt" => Some(KilogramsPerCubicMetre(2500.0)),
        _ => None,
    }
}

/// Density where a material gives none: quartz. Assumed; enters masses only.
const USUAL_DENSITY: KilogramsPerCubicMetre = KilogramsPerCubicMetre(2650.0);

fn bottom_filled(spec: &SceneSpec, fouling: &FoulingSpec) -> BottomFilledBed {
    let density = |name: &str| spec.materials.get(name).and_then(|material| material.density).unwrap_or(USUAL_DENSITY);
    BottomFilledBed {
        height: spec.tank.height,
        porosity: spec.packing.voids,
        stone_density: density(&spec.packing.stone),
        fines_porosity: fouling.porosity,
        fines_density: density(&fouling.material),
    }
}

/// The amount in the bed's own measures: a share of the column becomes one of the bed.
fn amount_of_bed(spec: &SceneSpec, amount: FoulingAmount) -> material::FoulingAmount {
    match amount {
        FoulingAmount::Height(height) => material::FoulingAmount::Height(height),
        FoulingAmount::OfVoids(share) => material::FoulingAmount::VoidsFilled(share),
        FoulingAmount::ByMass(share) => material::FoulingAmount::Mass(share),
        FoulingAmount::ByVolume(share) => {
            let column = (spec.tank.height.si() + spec.tank.base.si()) / spec.tank.height.si();
            material::FoulingAmount::Volume(Share(share.si() * column))
        }
    }
}

/// Height of the fouled zone, m. Fines that fill only part of the voids need a zone that much higher.
fn fouled_height(spec: &SceneSpec) -> Result<f64, SceneError> {
    let Some(fouling) = &spec.fouling else { return Ok(0.0) };
    let bed = bottom_filled(spec, fouling);
    let full = bed.fouling(amount_of_bed(spec, fouling.amount))?;
    if matches!(fouling.amount, FoulingAmount::Height(_)) {
        return Ok(full.height.si());
    }
    let height = full.height.si() / fouling.filling.si();
    bed.fouling(material::FoulingAmount::Height(Metres(height)))?;
    Ok(height)
}

fn layers(spec: &SceneSpec, bed: &Bed, wall: &Medium) -> Vec<Layer> {
    let centre = spec.antenna.frequency;
    let (height, fouled) = (spec.tank.height.si(), bed.fouled_height);
    let mut layers = Vec::new();
    let mut add = |name: &str, thickness: f64, medium: &Medium| {
        if thickness > 0.0 {
            layers.push(Layer { name: name.into(), thickness: Metres(thickness), eps_r: medium.eps_r_at(centre) });
        }
    };
    add("clean ballast", height - fouled, &bed.bulk_clean);
    add("fouled ballast", fouled, &bed.bulk_fouled);
    add("base plate", spec.tank.base.si(), wall);
    layers
}

fn report(
    spec: &SceneSpec,
    fouling: &FoulingSpec,
    fouled_height: f64,
    stones: Stones<'_>,
) -> Result<FoulingReport, SceneError> {
    let bed = bottom_filled(spec, fouling);
    let in_full_voids = material::FoulingAmount::Height(Metres(fouled_height * fouling.filling.si()));
    let nominal = FoulingIndices {
        height_percent: 100.0 * fouled_height / spec.tank.height.si(),
        ..bed.indices(in_full_voids, Some(fouling.passing))?
    };
    let of_packing = stones.area_of_bed(&spec.tank).map(|floor| {
        let stone = stones.below(&spec.tank, spec.tank.height.si());
        FoulingIndices::of(
            &material::Bed {
                stone_volume: stone,
                void_volume: floor * spec.tank.height.si() - stone,
                fines_bulk_volume: (floor * fouled_height - stones.below(&spec.tank, fouled_height))
                    * fouling.filling.si(),
                fines_porosity: bed.fines_porosity,
                stone_density: bed.stone_density,
                fines_density: bed.fines_density,
                height: spec.tank.height,
                fouled_height: Metres(fouled_height),
            },
            Some(fouling.passing),
        )
    });
    let column = spec.tank.height.si() / (spec.tank.height.si() + spec.tank.base.si());
    Ok(FoulingReport {
        height: Metres(fouled_height),
        volume_percent_of_column: nominal.volume_percent * column,
        nominal,
        of_packing,
    })
}

/// The stones that a report counts: in space where the bed is there, else those of the section.
#[derive(Clone, Copy)]
struct Stones<'a> {
    packing: Option<&'a Packing>,
    spheres: Option<&'a SphereBed>,
}

impl Stones<'_> {
    /// Floor of the bed: m² in space, m in a section; none without stones.
    fn area_of_bed(self, tank: &TankSpec) -> Option<f64> {
        let section = self.packing.map(|_| tank.width.si());
        self.spheres.map(SphereBed::floor_area).or(section)
    }

    /// Stone below a height, m³ or m².
    fn below(self, tank: &TankSpec, height: f64) -> f64 {
        if let Some(bed) = self.spheres {
            return bed.spheres.iter().map(|sphere| sphere.volume_between(0.0, height)).sum();
        }
        let width = tank.width.si();
        let discs = self.packing.map_or(&[][..], |packing| packing.discs.as_slice());
        discs.iter().map(|d| disc_rectangle_area(d.radius, -d.x, width - d.x, -d.y, height - d.y)).sum()
    }
}
