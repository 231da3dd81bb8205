//! Which way through the embedded solver a model takes.

use super::{Material, MaterialId, Model, Object, Source};

/// The most Debye and Drude poles of a material that the plane knows.
pub const MOST_POLES_IN_A_PLANE: usize = 3;

/// The way through the embedded solver that a model takes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Route {
    /// Two-dimensional along z, Ez, Hx and Hy only, and nothing that the loops made for this do not know.
    Plane,
    /// All six components, on any grid; one along z that asks for more than the plane knows is a single cell thick.
    Space {
        /// What in the model asks for it.
        why: String,
    },
}

impl Model {
    /// Tells which way the model takes: the one place that decides.
    pub fn route(&self) -> Route {
        let why = match self.grid.invariant_axis() {
            Some(2) => self.beyond_the_plane(),
            Some(axis) => Some(format!("the grid is one cell thick along {}", ["x", "y", "z"][axis])),
            None if self.transverse_electric.is_some() => Some("E lies across the invariant axis (TE)".into()),
            None => Some("the grid has three dimensions".into()),
        };
        why.map_or(Route::Plane, |why| Route::Space { why })
    }

    /// Whether the loops for two dimensions along z run the model.
    pub fn is_plane(&self) -> bool {
        self.route() == Route::Plane
    }

    /// What a model along z asks for that the plane does not know.
    fn beyond_the_plane(&self) -> Option<String> {
        // Whatever an object is made of counts, whether or not a cell of it stays after painting.
        let holds = |id: MaterialId| self.objects.iter().any(|object| object.holds(id));
        let directional =
            self.materials.iter().zip(0..).filter_map(|(m, whole)| Some((m.directional?, MaterialId(whole))));
        let parts: Vec<MaterialId> =
            directional.filter(|(_, whole)| holds(*whole)).flat_map(|(along, _)| along).collect();
        let used = |index: usize| {
            let id = MaterialId(index as u16);
            holds(id) || parts.contains(&id)
        };
        if !self.absorbing_profile.fits_a_plane() {
            return Some(
                "the profile of the absorbing boundary is more than one stretch that begins with nothing".into(),
            );
        }
        let why = |(index, material): (usize, &Material)| {
            let free_space = index == MaterialId::FREE_SPACE.index();
            let id = &material.id;
            let (poles, ringing) = material.pole_counts();
            let why = if material.is_magnetic() {
                Some(format!("`{id}` is magnetic"))
            } else if ringing > 0 {
                Some(format!("`{id}` has a Lorentz pole"))
            } else if poles > MOST_POLES_IN_A_PLANE {
                Some(format!("`{id}` has {poles} poles"))
            } else if poles > 0 && (free_space || self.dispersive_averaging) {
                Some(format!("`{id}` relaxes and is averaged"))
            } else {
                None
            };
            // Whether it is used takes long to find out.
            why.filter(|_| free_space || used(index))
        };
        if let Some(why) = self.materials.iter().enumerate().find_map(why) {
            return Some(why);
        }
        let known = |source: &Source| matches!(source, Source::HertzianDipole(_));
        if let Some(unknown) = self.sources.iter().position(|source| !known(source)) {
            return Some(format!("source {} is a {}", unknown + 1, self.sources[unknown].kind()));
        }
        let edges = |object: &Object| matches!(object, Object::Voxels(block) if block.edges.is_some());
        if self.objects.iter().any(edges) {
            return Some("a block of cells brings its own edges".into());
        }
        (!self.snapshots.is_empty()).then(|| "it asks for snapshots".into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Grid, TimeWindow};

    fn why(model: &Model) -> Option<String> {
        match model.route() {
            Route::Plane => None,
            Route::Space { why } => Some(why),
        }
    }

    #[test]
    fn a_magnetic_material_leaves_the_plane_once_an_object_is_made_of_it() {
        let grid = Grid { cells: [40, 30, 1], spacing: [0.002; 3] };
        let mut model = Model::new("", grid, TimeWindow::Iterations(1));
        let material = model.add_material(Material { mu_r: 2.0, ..Material::dielectric("ore", 5.0, 0.0) });
        assert!(model.is_plane());
        let (lower, upper) = ([0.02, 0.02, 0.0], [0.03, 0.03, 0.002]);
        model.objects.push(Object::Box { lower, upper, material, averaging: true });
        assert_eq!(why(&model).unwrap(), "`ore` is magnetic");
    }

    #[test]
    fn any_other_grid_leaves_the_plane() {
        for (cells, said) in
            [([40, 1, 30], "the grid is one cell thick along y"), ([40, 30, 20], "the grid has three dimensions")]
        {
            let model = Model::new("", Grid { cells, spacing: [0.002; 3] }, TimeWindow::Iterations(1));
            assert_eq!(why(&model).unwrap(), said);
        }
    }
}
