//! Which physical effects a model calls for, read off the model and never off a flag.

use super::{EdgeMaterial, Material, Model, Painted, Painted3, Resonance, Route};

/// One effect: on or off, and why.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Effect {
    /// The field's word for it.
    pub name: String,
    /// Whether the model calls for it.
    pub on: bool,
    /// What in the model calls for it, or what is missing.
    pub reason: String,
    /// Memory it adds, bytes (single precision).
    pub bytes: u64,
    /// Share of the grid's edges (of its cells for the absorbing boundary) that it touches, 0 to 1.
    pub share: f64,
}

/// The effects of a model.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Effects {
    /// Each effect the embedded solver knows, on or off.
    pub list: Vec<Effect>,
}

/// Bytes of a number in single precision.
const NUMBER: u64 = 4;

impl Effects {
    /// Reads the effects off a model.
    pub fn of(model: &Model, painted: &Painted) -> Self {
        let [nx, ny] = painted.cells_xy;
        Self::of_survey(&Survey {
            present: present(model, painted.cells_per_material(model.materials.len())),
            model,
            palette: &painted.palette,
            per_entry: painted.edges_per_entry(),
            edges: painted.edge_z.len(),
            averaged: painted.averaged_edges,
            cells: [nx, ny, 1],
            three: false,
            conducting_bytes: painted.edge_z.len() as u64 * NUMBER,
        })
    }

    /// As [`Effects::of`], for any grid.
    pub fn of_three(model: &Model, painted: &Painted3) -> Self {
        Self::of_survey(&Survey {
            present: present(model, painted.cells_per_material(model.materials.len())),
            model,
            palette: &painted.palette,
            per_entry: painted.edges_per_entry(),
            edges: painted.edges.iter().map(super::Indices::len).sum(),
            averaged: painted.averaged_edges.iter().sum(),
            cells: painted.cells,
            three: true,
            // Looked up in the table that also holds what takes the curl.
            conducting_bytes: 0,
        })
    }

    fn of_survey(survey: &Survey<'_>) -> Self {
        let list = vec![
            survey.conductivity(),
            survey.debye(),
            survey.resonance(),
            survey.averaging(),
            survey.conductor(),
            survey.absorbing(),
            survey.magnetic(),
            survey.components(),
        ];
        Self { list }
    }

    /// The effect whose name begins so.
    pub fn named(&self, name: &str) -> Option<&Effect> {
        self.list.iter().find(|effect| effect.name.starts_with(name))
    }
}

/// The materials that any cell holds.
fn present(model: &Model, cells: Vec<usize>) -> Vec<&Material> {
    let acting = model.materials.iter().zip(model.acting(cells));
    acting.filter(|(m, cells)| *cells > 0 && m.directional.is_none()).map(|(material, _)| material).collect()
}

/// What the effects are read off: the materials on the grid and what lies on its edges.
struct Survey<'a> {
    model: &'a Model,
    /// Materials on the grid.
    present: Vec<&'a Material>,
    palette: &'a [EdgeMaterial],
    per_entry: Vec<usize>,
    /// Edges that hold a field.
    edges: usize,
    averaged: usize,
    /// Cells along x, y, z.
    cells: [usize; 3],
    /// Whether all six components are computed.
    three: bool,
    /// Memory of conductivity, bytes.
    conducting_bytes: u64,
}

impl Survey<'_> {
    fn edges(&self) -> usize {
        self.edges
    }

    /// Edges whose entry in the palette fulfils a condition.
    fn edges_where(&self, condition: impl Fn(&super::EdgeMaterial) -> bool) -> usize {
        self.palette.iter().zip(&self.per_entry).filter(|(e, _)| condition(e)).map(|(_, count)| count).sum()
    }

    /// The identifiers of the materials that fulfil a condition, in backquotes, at most three.
    fn who(&self, condition: impl Fn(&Material) -> bool) -> Option<String> {
        let ids: Vec<_> = self.present.iter().filter(|m| condition(m)).map(|m| format!("`{}`", m.id)).collect();
        match ids.len() {
            0 => None,
            1..=3 => Some(ids.join(", ")),
            many => Some(format!("{} and {} more", ids[..3].join(", "), many - 3)),
        }
    }

    fn effect(&self, name: impl Into<String>, reason: Result<String, &str>, bytes: u64, touched: usize) -> Effect {
        let on = reason.is_ok();
        let (bytes, touched) = if on { (bytes, touched) } else { (0, 0) };
        let reason = reason.unwrap_or_else(str::to_owned);
        Effect { name: name.into(), on, reason, bytes, share: touched as f64 / self.edges() as f64 }
    }

    fn conductivity(&self) -> Effect {
        let who = self.who(|m| m.sigma > 0.0 && !m.is_pec());
        let touched = self.edges_where(|e| e.sigma > 0.0 && e.sigma.is_finite());
        let reason = who.map(|who| format!("{who} conducts")).ok_or("nothing on the grid conducts");
        self.effect("electric conductivity", reason, self.conducting_bytes, touched)
    }

    fn debye(&self) -> Effect {
        let strong = |m: &Material| m.poles.iter().filter(|pole| pole.delta_eps != 0.0).count();
        let poles = self.present.iter().map(|m| strong(m)).max().unwrap_or(0);
        let of = |e: &super::EdgeMaterial| self.numbers(e, strong);
        let memory: usize = self.palette.iter().zip(&self.per_entry).map(|(e, count)| of(e) * count).sum();
        let who = self.who(|m| strong(m) > 0);
        let reason = who.map(|who| format!("the permittivity of {who} falls with frequency"));
        let reason = reason.ok_or("no material on the grid relaxes");
        let name = match poles {
            0 => "Debye relaxation".into(),
            1 => "Debye relaxation (1 pole)".into(),
            poles => format!("Debye relaxation ({poles} poles)"),
        };
        self.effect(name, reason, memory as u64 * NUMBER, self.edges_where(|e| of(e) > 0))
    }

    /// Numbers of memory on an edge, of all materials whose poles act there.
    fn numbers(&self, edge: &super::EdgeMaterial, of: impl Fn(&Material) -> usize) -> usize {
        edge.shares().into_iter().map(|(id, _)| of(&self.model.materials[id.index()])).sum()
    }

    fn resonance(&self) -> Effect {
        let numbers = |m: &Material| {
            let acting = m.resonances.iter().filter(|resonance| !resonance.is_absent());
            acting.map(|resonance| if matches!(resonance, Resonance::Lorentz { .. }) { 2 } else { 1 }).sum::<usize>()
        };
        let of = |e: &super::EdgeMaterial| self.numbers(e, numbers);
        let memory: usize = self.palette.iter().zip(&self.per_entry).map(|(e, count)| of(e) * count).sum();
        let who = self.who(|m| numbers(m) > 0);
        let reason = who.map(|who| format!("{who} resonates or holds free charges"));
        let reason = reason.ok_or("no material on the grid has Lorentz or Drude poles");
        self.effect("Lorentz and Drude poles", reason, memory as u64 * NUMBER, self.edges_where(|e| of(e) > 0))
    }

    fn averaging(&self) -> Effect {
        let touched = self.averaged;
        let reason = (touched > 0).then(|| format!("{touched} edges lie between materials that may be averaged"));
        self.effect("edge averaging", reason.ok_or("no edge lies between materials that may be averaged"), 0, touched)
    }

    fn conductor(&self) -> Effect {
        let touched = self.edges_where(|e| e.sigma.is_infinite());
        let reason = self.who(Material::is_pec).map(|who| format!("{who} holds E at zero"));
        self.effect("perfect conductor", reason.ok_or("nothing on the grid conducts perfectly"), 0, touched)
    }

    fn absorbing(&self) -> Effect {
        let layers = self.model.absorbing_cells();
        let across: [usize; 3] = std::array::from_fn(|axis| (layers[axis] + layers[axis + 3]).min(self.cells[axis]));
        let all: usize = self.cells.iter().product();
        let cells = all - (0..3).map(|axis| self.cells[axis] - across[axis]).product::<usize>();
        let [x0, y0, z0, x1, y1, z1] = layers;
        let reason = (cells > 0).then(|| {
            if self.three {
                format!("{x0}, {y0}, {z0}, {x1}, {y1}, {z1} absorbing cells at x0, y0, z0, xmax, ymax, zmax")
            } else {
                format!("{x0}, {y0}, {x1}, {y1} absorbing cells at x0, y0, xmax, ymax")
            }
        });
        // One number per cell of a slab for each component of E and of H along it; the rims belong to two or three slabs.
        let numbers: usize = (0..3).map(|axis| across[axis] * all / self.cells[axis]).sum();
        let bytes = if self.three { 4 } else { 2 } * numbers as u64 * NUMBER;
        let effect = self.effect("absorbing boundary", reason.ok_or("the model asks for no absorbing cells"), bytes, 0);
        Effect { share: cells as f64 / all as f64, ..effect }
    }

    fn magnetic(&self) -> Effect {
        let who = self.who(|m| m.mu_r != 1.0 || m.sigma_magnetic != 0.0);
        let reason = who.map(|who| format!("{who} is magnetic")).ok_or("nothing on the grid is magnetic");
        // Two numbers for each component of H, where anything is magnetic.
        self.effect("magnetic loss / permeability", reason, 2 * self.edges as u64 * NUMBER, 0)
    }

    fn components(&self) -> Effect {
        let reason = match self.model.route() {
            Route::Space { why } if self.model.invariant_axis().is_some() => Ok(format!("{why}; three components")),
            Route::Space { why } => Ok(format!("{why}; all six components")),
            Route::Plane => Err("two-dimensional along z: Ez, Hx and Hy"),
        };
        self.effect("solver for three dimensions", reason, 0, self.edges)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{DebyePole, Grid, MaterialId, Object, TimeWindow, paint};

    fn model() -> Model {
        Model::new("", Grid { cells: [40, 30, 1], spacing: [0.002; 3] }, TimeWindow::Iterations(1))
    }

    fn effects(model: &Model) -> Effects {
        Effects::of(model, &paint(model).unwrap())
    }

    /// Free space calls for its absorbing boundary only: 40 x 30 cells less the 20 x 10 inside.
    #[test]
    fn free_space_calls_for_nothing_but_its_boundary() {
        let effects = effects(&model());
        let on: Vec<_> = effects.list.iter().filter(|effect| effect.on).collect();
        assert_eq!(on.len(), 1);
        assert_eq!((on[0].name.as_str(), on[0].share), ("absorbing boundary", 1000.0 / 1200.0));
        // E and H in 20 rows of 30 and 20 columns of 40, 4 bytes each.
        assert_eq!(on[0].bytes, 2 * (20 * 30 + 20 * 40) * 4);
        assert!(effects.list.iter().filter(|effect| !effect.on).all(|effect| effect.bytes == 0 && effect.share == 0.0));
    }

    /// In three dimensions: 40 x 30 x 25 cells less the 20 x 10 x 5 inside absorb, four numbers for each cell of a slab.
    #[test]
    fn three_dimensions_have_their_own_counts() {
        let grid = Grid { cells: [40, 30, 25], spacing: [0.002; 3] };
        let mut model = Model::new("", grid, TimeWindow::Iterations(1));
        let stone = model.add_material(Material { mu_r: 1.2, ..Material::dielectric("ore", 6.0, 0.01) });
        model.objects.push(Object::Sphere {
            centre: [0.04, 0.03, 0.024],
            radius: 0.01,
            material: stone,
            averaging: true,
        });
        let effects = Effects::of_three(&model, &crate::model::paint3(&model).unwrap());
        let absorbing = effects.named("absorbing").unwrap();
        assert_eq!(absorbing.share, 1.0 - 1000.0 / 30_000.0);
        assert_eq!(absorbing.bytes, 4 * 4 * (20 * 30 * 25 + 20 * 40 * 25 + 20 * 40 * 30));
        assert_eq!(effects.named("magnetic").unwrap().reason, "`ore` is magnetic");
        assert!(effects.named("edge averaging").unwrap().on && effects.named("electric").unwrap().on);
    }

    #[test]
    fn each_effect_names_what_calls_for_it() {
        let mut model = model();
        let mut wet = Material::dielectric("wet_fines", 5.0, 0.01);
        wet.poles = vec![DebyePole { delta_eps: 3.0, tau: 9e-12 }, DebyePole { delta_eps: 1.0, tau: 9e-11 }];
        wet.averagable = false;
        let wet = model.add_material(wet);
        let stone = model.add_material(Material::dielectric("stone", 6.0, 0.0));
        let mut cuboid = |i: f64, material: MaterialId| {
            let (lower, upper) = ([i * 0.002, 0.02, 0.0], [i * 0.002 + 0.008, 0.028, 0.002]);
            model.objects.push(Object::Box { lower, upper, material, averaging: true });
        };
        cuboid(4.0, wet);
        cuboid(14.0, stone);
        cuboid(24.0, MaterialId::PEC);
        let effects = effects(&model);
        let called_for = effects.list.iter().filter(|effect| !effect.name.starts_with("Lorentz"));
        assert!(called_for.take(5).all(|effect| effect.on), "{effects:?}");
        assert_eq!(effects.named("electric").unwrap().reason, "`wet_fines` conducts");
        let debye = effects.named("Debye").unwrap();
        assert_eq!(debye.name, "Debye relaxation (2 poles)");
        // 4 x 4 cells own 5 x 5 edges, two poles of 4 bytes each.
        assert_eq!((debye.bytes, debye.share), (25 * 2 * 4, 25.0 / (41.0 * 31.0)));
        assert_eq!(effects.named("edge averaging").unwrap().share, 16.0 / (41.0 * 31.0));
        assert_eq!(effects.named("perfect").unwrap().share, 25.0 / (41.0 * 31.0));
        assert!(!effects.named("magnetic").unwrap().on);
    }
}
