//! The materials of a model as gprMax numbers them, those of averaged edges and faces among them.

use std::collections::BTreeSet;

use crate::model::{DebyePole, Finished, MagneticAveraging, Material, MaterialId, Model, Parts};

/// Number of the perfect magnetic conductor, which no model lists.
const MAGNETIC_CONDUCTOR: u32 = 1;

/// All materials that the cells, edges and faces of a painted model hold, in gprMax's order: perfect conductors, free space
/// and those of the file in their order, then means in the order of their names.
pub struct Catalogue {
    /// Each with its name.
    pub materials: Vec<Material>,
    /// Number of each entry of [`Finished::parts`].
    pub of_parts: Vec<u32>,
    /// What each of these is made of.
    parts: Vec<Parts>,
}

impl Catalogue {
    /// The materials that are no means.
    pub fn plain(model: &Model) -> Vec<Material> {
        let (first, rest) = model.materials.split_at(1.min(model.materials.len()));
        let pmc = Material { id: "pmc".into(), sigma: 0.0, sigma_magnetic: f64::INFINITY, ..Material::pec() };
        first.iter().cloned().chain([pmc]).chain(rest.iter().cloned()).collect()
    }

    /// Number of a material of the model.
    pub fn number(id: MaterialId) -> u32 {
        if id == MaterialId::PEC { 0 } else { u32::from(id.0) + 1 }
    }

    /// The first material with Lorentz or Drude poles among some numbers, alone or in a mean.
    pub fn resonant<'a>(&self, model: &'a Model, used: &BTreeSet<u32>) -> Option<&'a Material> {
        let resonant = |id: &MaterialId| {
            let material = &model.materials[id.index()];
            (!material.resonances.is_empty()).then_some(material)
        };
        let parts = self.parts.iter().zip(&self.of_parts).filter(|(_, number)| used.contains(number));
        let in_parts = parts.map(|(parts, _)| *parts).find_map(|parts| match parts {
            Parts::One(id) => resonant(&id),
            Parts::MagneticConductor => None,
            Parts::Edge(ids) => ids.iter().find_map(resonant),
            Parts::Face(ids) => ids.iter().find_map(resonant),
        });
        let cells = (0..model.materials.len()).map(|index| MaterialId(index as u16));
        in_parts.or_else(|| cells.filter(|&id| used.contains(&Self::number(id))).find_map(|id| resonant(&id)))
    }

    /// Numbers all materials of a painted model.
    pub fn of(model: &Model, finished: &Finished) -> Self {
        let mut materials = Self::plain(model);
        let mut means: Vec<(usize, Material)> = finished
            .parts
            .iter()
            .map(|parts| mean(model, *parts))
            .enumerate()
            .filter_map(|(place, mean)| Some((place, mean?)))
            .collect();
        means.sort_by(|(_, a), (_, b)| a.id.cmp(&b.id));
        let number = |parts: &Parts| match parts {
            Parts::One(id) => Self::number(*id),
            _ => MAGNETIC_CONDUCTOR,
        };
        let mut of_parts: Vec<u32> = finished.parts.iter().map(number).collect();
        for (place, mean) in means {
            of_parts[place] = materials.len() as u32;
            materials.push(mean);
        }
        Self { materials, of_parts, parts: finished.parts.clone() }
    }
}

/// The material of a mean; none for what is no mean.
///
/// An edge takes arithmetic means of four cells; a face arithmetic means of two, but for permeability and magnetic loss. Names
/// are gprMax's: those of the cells, sorted, `Hmag_` and each twice for a face.
fn mean(model: &Model, parts: Parts) -> Option<Material> {
    let material = |id: MaterialId| &model.materials[id.index()];
    let (ids, prefix): (Vec<MaterialId>, _) = match parts {
        Parts::One(_) | Parts::MagneticConductor => return None,
        Parts::Edge(ids) => (ids.into(), ""),
        Parts::Face([a, b]) => (vec![a, a, b, b], "Hmag_"),
    };
    let mut names: Vec<&str> = ids.iter().map(|&id| material(id).id.as_str()).collect();
    names.sort_unstable();
    let of = |value: fn(&Material) -> f64| ids.iter().map(|&id| value(material(id))).sum::<f64>() / 4.0;
    let magnetic = |value: fn(&Material) -> f64| match parts {
        Parts::Face([a, b]) if model.magnetic_averaging == MagneticAveraging::Harmonic => {
            let (a, b) = (value(material(a)), value(material(b)));
            if a == b { a } else { 2.0 * a * b / (a + b) }
        }
        _ => of(value),
    };
    let share = |pole: &DebyePole| DebyePole { delta_eps: pole.delta_eps / 4.0, tau: pole.tau };
    let poles = || ids.iter().flat_map(|&id| material(id).poles.iter().map(share)).collect();
    Some(Material {
        id: format!("{prefix}{}", names.join("+")),
        eps_r: of(|m| m.eps_r),
        sigma: of(|m| m.sigma),
        mu_r: magnetic(|m| m.mu_r),
        sigma_magnetic: magnetic(|m| m.sigma_magnetic),
        poles: if matches!(parts, Parts::Edge(_)) { poles() } else { vec![] },
        resonances: vec![],
        averagable: true,
        directional: None,
    })
}
