//! Mixtures of materials and the boxes of noise made of them: `#soil_peplinski`, `#material_range`, `#material_list`,
//! `#fractal_box`, `#add_surface_roughness`, `#add_surface_water`.

use std::collections::HashMap;

use super::error::Problem;
use super::lines::Command;
use super::multiple::{inside, material_id};
use super::values::Parameters;
use crate::files::nearest_name;
use crate::material::{Peplinski, WATER_25_C};
use crate::model::{Axis, DebyePole, FractalBox, FractalSurface, Material, MaterialId, Model, Object};
use crate::units::{KilogramsPerCubicMetre, Share};

/// The most cells of a box of noise: its transform takes 33 bytes a cell.
const MOST_CELLS: f64 = 134_217_728.0;
/// Permittivity of water far above its relaxation.
const WATER_EPS_INFINITY: f64 = 4.9;

/// A mixture that may become any number of materials.
enum Mixture {
    /// A soil, and the least and largest content of water.
    Soil(Peplinski, [f64; 2]),
    /// Least and largest permittivity, conductivity, permeability, magnetic loss.
    Range([[f64; 2]; 4]),
    /// These materials, of which the first are taken.
    List(Vec<MaterialId>),
}

/// The mixtures and boxes of a file. All boxes are known, faces and water included, before any object is painted.
#[derive(Default)]
pub(super) struct Fractals {
    mixtures: HashMap<String, Mixture>,
    boxes: Vec<Known>,
}

struct Known {
    id: String,
    line: usize,
    fractal: FractalBox,
}

impl Fractals {
    /// The commands that are read here. A `#fractal_box` is painted where it stands among the other objects.
    pub const COMMANDS: [&'static str; 6] = [
        "soil_peplinski",
        "material_range",
        "material_list",
        "fractal_box",
        "add_surface_roughness",
        "add_surface_water",
    ];

    /// Reads one of the commands; mixtures must come first.
    pub fn read(&mut self, model: &mut Model, command: &Command<'_>) -> Result<(), Problem> {
        match command.name {
            "soil_peplinski" => self.soil(model, command),
            "material_range" => self.range(model, command),
            "material_list" => self.list(model, command),
            "fractal_box" => self.fractal_box(model, command),
            "add_surface_roughness" => self.roughness(model, command),
            _ => self.water(model, command),
        }
    }

    /// The box that stands in a line, as an object; refuses one of a single material that a plain box would be.
    pub fn object(&self, command: &Command<'_>) -> Result<Option<Object>, Problem> {
        let Some(known) = self.boxes.iter().find(|known| known.line == command.line) else { return Ok(None) };
        let FractalBox { materials, surfaces, .. } = &known.fractal;
        if materials.len() == 1 && surfaces.is_empty() {
            let what = "a box of one material without a rough face (gprMax refuses it too: write `#box`)";
            return Err(Problem::UnsupportedForm { command: command.name.into(), what });
        }
        Ok(Some(Object::Fractal(known.fractal.clone())))
    }

    fn add(&mut self, model: &Model, id: &str, mixture: Mixture) -> Result<(), Problem> {
        if model.material_named(id).is_some() || self.mixtures.contains_key(id) {
            return Err(Problem::DefinedTwice { what: "material", id: id.into() });
        }
        self.mixtures.insert(id.into(), mixture);
        Ok(())
    }

    fn soil(&mut self, model: &Model, command: &Command<'_>) -> Result<(), Problem> {
        let form = "SAND CLAY BULK_DENSITY SAND_DENSITY LEAST_WATER MOST_WATER ID";
        let p = Parameters::of(command, form, |n| n == 7)?;
        let share =
            |index, what| p.number(index, what).and_then(|v| p.check(what, v, (0.0..=1.0).contains(&v), "0 to 1"));
        let (sand, clay) = (share(0, "the share of sand")?, share(1, "the share of clay")?);
        let density = |index, what| p.number(index, what).and_then(|v| p.check(what, v, v > 0.0, "above 0"));
        let (bulk, grains) = (density(2, "the bulk density in g/cm3")?, density(3, "the density of sand in g/cm3")?);
        let (least, most) = (p.number(4, "a share of water")?, p.number(5, "a share of water")?);
        p.check("the least water", least, least >= 0.0, "0 or more")?;
        p.check("the most water", most, most >= least, "at least the least water")?;
        let soil = Peplinski {
            sand: Share(sand),
            clay: Share(clay),
            bulk_density: KilogramsPerCubicMetre(bulk * 1000.0),
            grain_density: KilogramsPerCubicMetre(grains * 1000.0),
        };
        self.add(model, p.word(6)?, Mixture::Soil(soil, [least, most]))
    }

    fn range(&mut self, model: &Model, command: &Command<'_>) -> Result<(), Problem> {
        let form = "EPS_R EPS_R SIGMA SIGMA MU_R MU_R SIGMA* SIGMA* ID, the least and the largest of each";
        let p = Parameters::of(command, form, |n| n == 9)?;
        let pair = |index: usize, what: &'static str, least: f64, limit: &'static str| {
            let [low, high] = [p.number(index, what)?, p.number(index + 1, what)?];
            p.check(what, low, low >= least, limit)?;
            p.check(what, high, high >= low, "at least its least value")?;
            Ok::<_, Problem>([low, high])
        };
        let limits = [
            pair(0, "the relative permittivity", 1.0, "at least 1")?,
            pair(2, "the conductivity", 0.0, "0 or more")?,
            pair(4, "the relative permeability", 1.0, "at least 1")?,
            pair(6, "the magnetic loss", 0.0, "0 or more")?,
        ];
        self.add(model, p.word(8)?, Mixture::Range(limits))
    }

    fn list(&mut self, model: &Model, command: &Command<'_>) -> Result<(), Problem> {
        let p = Parameters::of(command, "MATERIAL [MATERIAL ...] ID", |n| n >= 2)?;
        let words = p.rest(0);
        let (id, materials) = (words[words.len() - 1], &words[..words.len() - 1]);
        let materials = materials.iter().map(|id| material_id(model, &p, id)).collect::<Result<_, _>>()?;
        self.add(model, id, Mixture::List(materials))
    }

    fn fractal_box(&mut self, model: &mut Model, command: &Command<'_>) -> Result<(), Problem> {
        let form = "X1 Y1 Z1 X2 Y2 Z2 DIMENSION WEIGHT_X WEIGHT_Y WEIGHT_Z COUNT MATERIALS ID SEED [y|n]";
        let p = Parameters::of(command, form, |n| (13..=16).contains(&n))?;
        if p.len() == 13 {
            return Err(p.unsupported("noise without a seed, other in each run,"));
        }
        let (lower, upper) = (p.point(0)?, p.point(3)?);
        inside(model, "corner of the box", lower)?;
        inside(model, "corner of the box", upper)?;
        for axis in [Axis::X, Axis::Y, Axis::Z] {
            let (low, high) = (lower[axis.index()], upper[axis.index()]);
            if model.grid.node(axis.index(), low) >= model.grid.node(axis.index(), high) {
                return Err(Problem::NoCells {
                    command: p.command().into(),
                    axis: axis.name(),
                    lower: low,
                    upper: high,
                });
            }
        }
        let [dimension, x, y, z] = at_least_0(&p, 6, ["the dimension", "a weight", "a weight", "a weight"])?;
        let count = p.count(10, "a number of materials")?;
        p.check("the number of materials", count as f64, count > 0, "1 or more")?;
        let (mixture, id, seed) = (p.word(11)?, p.word(12)?, seed(&p, 13)?);
        let averaging = p.len() > 14 && p.yes_or_no(14, "an averaging flag")?;
        if self.boxes.iter().any(|known| known.id == id) {
            return Err(Problem::DefinedTwice { what: "fractal box", id: id.into() });
        }
        let materials = self.materials(model, &p, mixture, count)?;
        let (weights, surfaces) = ([x, y, z], vec![]);
        let fractal = FractalBox { lower, upper, dimension, weights, materials, seed, averaging, surfaces };
        check_size(model, &p, &fractal)?;
        self.boxes.push(Known { id: id.into(), line: command.line, fractal });
        Ok(())
    }

    /// So many materials of a mixture, from the least to the most of it.
    fn materials(
        &self,
        model: &mut Model,
        p: &Parameters<'_>,
        id: &str,
        count: usize,
    ) -> Result<Vec<MaterialId>, Problem> {
        let Some(mixture) = self.mixtures.get(id) else {
            let known = self.mixtures.keys().map(String::as_str).chain(model.materials.iter().map(|m| m.id.as_str()));
            let nearest = nearest_name(id, known).map(Into::into);
            let undefined = Problem::Undefined { what: "material", id: id.into(), nearest };
            let material = model.material_named(id).ok_or(undefined)?;
            return match count {
                1 => Ok(vec![material]),
                _ => Err(p.unsupported("several materials out of one that is no mixture")),
            };
        };
        if count == 1 {
            return Err(p.unsupported("one material of a mixture (gprMax refuses it too)"));
        }
        let room = usize::from(u16::MAX) - model.materials.len();
        p.check("the number of materials", count as f64, count <= room, "at most 65535 with all others")?;
        let middle = |[low, high]: [f64; 2], index: usize| {
            let step = (high - low) / count as f64;
            let end = |index: usize| if index == count { high } else { index as f64 * step + low };
            0.5 * (end(index) + end(index + 1))
        };
        let averagable = model.dispersive_averaging;
        // Looked up by name for each of thousands of materials.
        let known: HashMap<String, MaterialId> =
            model.materials.iter().zip(0..).map(|(material, id)| (material.id.clone(), MaterialId(id))).collect();
        let named = |index: usize| format!("{id}-{}of{count}", index + 1);
        match mixture {
            Mixture::List(materials) => materials.get(..count).map(Into::into).ok_or(Problem::OutOfRange {
                command: p.command().into(),
                what: "the number of materials",
                value: count as f64,
                limit: "at most those of the list",
            }),
            Mixture::Range(limits) => (0..count)
                .map(|index| {
                    let [eps_r, sigma, mu_r, sigma_magnetic] = limits.map(|limits| middle(limits, index));
                    let plain = Material::dielectric(named(index), eps_r, sigma);
                    add_material(model, known.get(&plain.id), Material { mu_r, sigma_magnetic, ..plain })
                })
                .collect(),
            Mixture::Soil(soil, limits) => (0..count)
                .map(|index| {
                    let fit = soil.fit(middle(*limits, index), WATER_25_C);
                    let (eps, sigma) = (fit.eps_infinity, fit.sigma);
                    p.check("the permittivity that follows from the soil", eps, eps >= 1.0, "at least 1")?;
                    p.check("the conductivity that follows from the soil", sigma, sigma >= 0.0, "0 or more")?;
                    let pole = DebyePole { delta_eps: fit.delta_eps, tau: WATER_25_C.tau.si() };
                    let plain = Material::dielectric(named(index), eps, sigma);
                    add_material(model, known.get(&plain.id), Material { poles: vec![pole], averagable, ..plain })
                })
                .collect(),
        }
    }

    /// The box of an identifier.
    fn known(&mut self, id: &str) -> Result<&mut FractalBox, Problem> {
        let names = self.boxes.iter().map(|known| known.id.as_str());
        let nearest = nearest_name(id, names).map(Into::into);
        let undefined = Problem::Undefined { what: "fractal box", id: id.into(), nearest };
        self.boxes.iter_mut().find(|known| known.id == id).map(|known| &mut known.fractal).ok_or(undefined)
    }

    fn roughness(&mut self, model: &Model, command: &Command<'_>) -> Result<(), Problem> {
        let form = "X1 Y1 Z1 X2 Y2 Z2 DIMENSION WEIGHT1 WEIGHT2 LEAST LARGEST BOX SEED";
        let p = Parameters::of(command, form, |n| n == 12 || n == 13)?;
        if p.len() == 12 {
            return Err(p.unsupported("noise without a seed, other in each run,"));
        }
        let [dimension, first, second] = at_least_0(&p, 6, ["the dimension", "a weight", "a weight"])?;
        let range = [p.number(9, "a coordinate in metres")?, p.number(10, "a coordinate in metres")?];
        let seed = seed(&p, 12)?;
        let fractal = self.known(p.word(11)?)?;
        let (lower, upper) = (p.point(0)?, p.point(3)?);
        let (axis, upper_face) = face(model, &p, fractal, lower, upper)?;
        if fractal.surfaces.iter().any(|known| (known.axis, known.upper_face) == (axis, upper_face)) {
            return Err(p.unsupported("a second rough face on one side (gprMax refuses it too)"));
        }
        let node = |metres| model.grid.node(axis.index(), metres);
        let own = [fractal.lower, fractal.upper].map(|corner| node(corner[axis.index()]));
        let (least, largest) = if upper_face { (own[0], model.grid.cells[axis.index()] as i64) } else { (0, own[1]) };
        p.check("the least coordinate", range[0], node(range[0]) >= least, "within the box and the domain")?;
        p.check("the largest coordinate", range[1], node(range[1]) <= largest, "within the box and the domain")?;
        let (weights, water) = ([first, second], None);
        fractal.surfaces.push(FractalSurface {
            axis,
            upper_face,
            lower,
            upper,
            dimension,
            weights,
            range,
            seed,
            water,
        });
        check_size(model, &p, fractal)
    }

    fn water(&mut self, model: &mut Model, command: &Command<'_>) -> Result<(), Problem> {
        let p = Parameters::of(command, "X1 Y1 Z1 X2 Y2 Z2 DEPTH BOX", |n| n == 8)?;
        let depth = p.number(6, "a coordinate in metres")?;
        let fractal = self.known(p.word(7)?)?;
        let (axis, upper_face) = face(model, &p, fractal, p.point(0)?, p.point(3)?)?;
        let mut surfaces = fractal.surfaces.iter_mut();
        let Some(surface) = surfaces.find(|known| (known.axis, known.upper_face) == (axis, upper_face)) else {
            return Err(p.unsupported("water on a face that is not rough (gprMax refuses it too)"));
        };
        let [node, low, high] = [depth, surface.range[0], surface.range[1]].map(|v| model.grid.node(axis.index(), v));
        p.check("the level of the water", depth, (low..=high).contains(&node), "within the range of the rough face")?;
        let pole = DebyePole { delta_eps: WATER_25_C.delta_eps, tau: WATER_25_C.tau.si() };
        let step = model.time_step();
        p.check("the time step in s", step, step < pole.tau, "below the relaxation time of water, 8.099e-12 s")?;
        let averagable = model.dispersive_averaging;
        let plain = Material::dielectric("water", WATER_EPS_INFINITY, 0.0);
        let known = model.material_named(&plain.id);
        let water = add_material(model, known.as_ref(), Material { poles: vec![pole], averagable, ..plain })?;
        surface.water = Some((depth, water));
        Ok(())
    }
}

/// Numbers from 0 up, from a parameter on.
fn at_least_0<const N: usize>(p: &Parameters<'_>, first: usize, what: [&'static str; N]) -> Result<[f64; N], Problem> {
    let mut numbers = [0.0; N];
    for (index, (number, what)) in numbers.iter_mut().zip(what).enumerate() {
        *number = p.number(first + index, what)?;
        p.check(what, *number, *number >= 0.0, "0 or more")?;
    }
    Ok(numbers)
}

fn seed(p: &Parameters<'_>, index: usize) -> Result<u64, Problem> {
    p.count(index, "a seed, a whole number,").map(|seed| seed as u64)
}

/// Adds a material unless it is the one of its name.
fn add_material(model: &mut Model, known: Option<&MaterialId>, material: Material) -> Result<MaterialId, Problem> {
    match known {
        Some(known) if model.materials[known.index()] == material => Ok(*known),
        Some(_) => Err(Problem::DefinedTwice { what: "material", id: material.id }),
        None if model.materials.len() >= usize::from(u16::MAX) => {
            Err(Problem::UnsupportedForm { command: "fractal_box".into(), what: "the 65536th material" })
        }
        None => Ok(model.add_material(material)),
    }
}

/// Axis and side of a face of a box.
fn face(
    model: &Model,
    p: &Parameters<'_>,
    fractal: &FractalBox,
    lower: [f64; 3],
    upper: [f64; 3],
) -> Result<(Axis, bool), Problem> {
    let nodes = |corner: [f64; 3]| -> [i64; 3] { std::array::from_fn(|axis| model.grid.node(axis, corner[axis])) };
    let [low, high, first, last] = [lower, upper, fractal.lower, fractal.upper].map(nodes);
    let flat: Vec<Axis> =
        [Axis::X, Axis::Y, Axis::Z].into_iter().filter(|a| low[a.index()] == high[a.index()]).collect();
    let within = (0..3).all(|axis| first[axis] <= low[axis] && low[axis] <= high[axis] && high[axis] <= last[axis]);
    let at = flat.first().map(|axis| low[axis.index()]);
    let of = |corner: [i64; 3]| flat.first().map(|axis| corner[axis.index()]);
    match flat[..] {
        [axis] if within && at == of(last) => Ok((axis, true)),
        [axis] if within && at == of(first) => Ok((axis, false)),
        _ => Err(p.unsupported("anything but a rectangle on an outer face of the box (gprMax refuses it too)")),
    }
}

fn check_size(model: &Model, p: &Parameters<'_>, fractal: &FractalBox) -> Result<(), Problem> {
    let [first, last] = fractal.span(&model.grid);
    let cells: f64 = (0..3).map(|axis| last[axis].saturating_sub(first[axis]) as f64).product();
    p.check("the number of cells", cells, cells <= MOST_CELLS, "at most 1.3e8").map(|_| ())
}
