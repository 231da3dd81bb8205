//! The distinct materials on the edges of a grid.

use std::collections::HashMap;

use super::{Material, MaterialId};

/// What lies on one edge of the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeMaterial {
    /// Relative permittivity at infinite frequency.
    pub eps_r: f64,
    /// Conductivity, S/m; infinite on a perfect conductor.
    pub sigma: f64,
    /// The one material whose poles act on this edge, if it is dispersive and not a mean.
    pub dispersive: Option<MaterialId>,
    /// On the mean of four cells of which any is dispersive: their materials, whose poles act a quarter each.
    pub quarters: Option<[MaterialId; 4]>,
}

impl EdgeMaterial {
    /// The materials whose poles act on this edge, each with its share.
    pub fn shares(&self) -> Vec<(MaterialId, f64)> {
        let mut shares: Vec<(MaterialId, f64)> = self.dispersive.iter().map(|&id| (id, 1.0)).collect();
        for &id in self.quarters.iter().flatten() {
            match shares.iter_mut().find(|(known, _)| *known == id) {
                Some((_, share)) => *share += 0.25,
                None => shares.push((id, 0.25)),
            }
        }
        shares
    }
}

/// What lies on one face of the grid, where H lives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaceMaterial {
    /// Relative permeability.
    pub mu_r: f64,
    /// Magnetic loss, ohm/m.
    pub sigma_magnetic: f64,
}

/// How a face between two magnetic materials gets its values (`#magnetic_averaging`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum MagneticAveraging {
    /// The harmonic mean; without loss where either material has none.
    #[default]
    Harmonic,
    /// The arithmetic mean.
    Arithmetic,
}

impl MagneticAveraging {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Harmonic, Self::Arithmetic];

    /// The word of `#magnetic_averaging`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Harmonic => "harmonic",
            Self::Arithmetic => "arithmetic",
        }
    }
}

impl FaceMaterial {
    /// The mean of the two cells that share the face.
    pub(super) fn between(a: &Material, b: &Material, how: MagneticAveraging) -> Self {
        let mean = |a: f64, b: f64| match how {
            _ if a == b => a,
            MagneticAveraging::Harmonic => 2.0 * a * b / (a + b),
            MagneticAveraging::Arithmetic => (a + b) / 2.0,
        };
        Self { mu_r: mean(a.mu_r, b.mu_r), sigma_magnetic: mean(a.sigma_magnetic, b.sigma_magnetic) }
    }
}

/// Bits of permittivity and conductivity, and whose poles act.
type Key = (u64, u64, Option<MaterialId>, Option<[MaterialId; 4]>);

/// The distinct edge materials met so far.
pub(super) struct Palette<'a> {
    materials: &'a [Material],
    entries: Vec<EdgeMaterial>,
    by_value: HashMap<Key, u32>,
    pure: Vec<Option<u32>>,
    means: HashMap<[MaterialId; 4], u32>,
}

impl<'a> Palette<'a> {
    pub(super) fn new(materials: &'a [Material]) -> Self {
        let pure = vec![None; materials.len()];
        Self { materials, entries: vec![], by_value: HashMap::new(), pure, means: HashMap::new() }
    }

    /// The entry of one material.
    pub(super) fn pure(&mut self, id: MaterialId) -> u32 {
        if let Some(entry) = self.pure[id.index()] {
            return entry;
        }
        let material = &self.materials[id.index()];
        let dispersive = material.is_dispersive().then_some(id);
        let entry =
            self.enter(EdgeMaterial { eps_r: material.eps_r, sigma: material.sigma, dispersive, quarters: None });
        self.pure[id.index()] = Some(entry);
        entry
    }

    /// The arithmetic mean; `ids` are sorted first, so that the sum has the same bits however the cells lie.
    pub(super) fn mean(&mut self, mut ids: [MaterialId; 4]) -> u32 {
        ids.sort_unstable();
        if let Some(&entry) = self.means.get(&ids) {
            return entry;
        }
        let of =
            |value: fn(&Material) -> f64| ids.iter().map(|id| value(&self.materials[id.index()])).sum::<f64>() / 4.0;
        let quarters = ids.iter().any(|id| self.materials[id.index()].is_dispersive()).then_some(ids);
        let mean = EdgeMaterial { eps_r: of(|m| m.eps_r), sigma: of(|m| m.sigma), dispersive: None, quarters };
        let entry = self.enter(mean);
        self.means.insert(ids, entry);
        entry
    }

    /// Takes over the entries of another palette; where each of them has gone.
    pub(super) fn merge(&mut self, entries: &[EdgeMaterial]) -> Vec<u32> {
        entries.iter().map(|&entry| self.enter(entry)).collect()
    }

    /// The entries, in the order in which they were met.
    pub(super) fn into_entries(self) -> Vec<EdgeMaterial> {
        self.entries
    }

    /// The entry with exactly these values.
    pub(super) fn enter(&mut self, edge: EdgeMaterial) -> u32 {
        let entries = &mut self.entries;
        *self
            .by_value
            .entry((edge.eps_r.to_bits(), edge.sigma.to_bits(), edge.dispersive, edge.quarters))
            .or_insert_with(|| {
                entries.push(edge);
                entries.len() as u32 - 1
            })
    }
}
