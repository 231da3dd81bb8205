//! The permittivity map of a painted model, as an array.

use ndarray::Array2;

use crate::model::{Material, Model, Painted, Painted3};
use crate::units::Hertz;

/// Relative permittivity (real part) of every cell at a frequency, shape `(nx, ny)`, y upwards; infinite in a perfect
/// conductor.
pub fn permittivity_map(model: &Model, painted: &Painted, frequency: Hertz) -> Array2<f64> {
    let eps = permittivities(model, frequency);
    let [nx, ny] = painted.cells_xy;
    Array2::from_shape_fn((nx, ny), |(i, j)| eps[painted.solid[i * ny + j].index()])
}

/// The same of the cells of a model in space that lie at `z`, m; at its border where `z` lies beyond it.
pub fn permittivity_section(model: &Model, painted: &Painted3, z: f64, frequency: Hertz) -> Array2<f64> {
    let eps = permittivities(model, frequency);
    let [nx, ny, nz] = painted.cells;
    let k = ((z / model.grid.spacing[2]).max(0.0) as usize).min(nz - 1);
    Array2::from_shape_fn((nx, ny), |(i, j)| eps[painted.solid[(i * ny + j) * nz + k].index()])
}

fn permittivities(model: &Model, frequency: Hertz) -> Vec<f64> {
    let of = |material: &Material| {
        if material.is_pec() { f64::INFINITY } else { material.eps_r_at(frequency.si()) }
    };
    model.materials.iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{DebyePole, Grid, MaterialId, Object, TimeWindow, paint};

    /// A conductor below, water above: infinite, and 4.9 + 75.2 / (1 + (2 pi 17.24 GHz 9.231 ps)²) = 42.5 half relaxed.
    #[test]
    fn the_map_holds_what_each_cell_is_made_of() {
        let grid = Grid { cells: [3, 2, 1], spacing: [0.01; 3] };
        let mut model = Model::new("", grid, TimeWindow::Iterations(1));
        let mut water = Material::dielectric("water", 4.9, 0.0);
        water.poles.push(DebyePole { delta_eps: 75.2, tau: 9.231e-12 });
        water.averagable = false;
        let water = model.add_material(water);
        for (low, material) in [(0.0, MaterialId::PEC), (0.01, water)] {
            model.objects.push(Object::Box {
                lower: [0.0, low, 0.0],
                upper: [0.02, low + 0.01, 0.01],
                material,
                averaging: false,
            });
        }
        let half_relaxed = Hertz(1.0 / (2.0 * std::f64::consts::PI * 9.231e-12));
        let map = permittivity_map(&model, &paint(&model).unwrap(), half_relaxed);
        assert_eq!(map.dim(), (3, 2));
        assert!(map[[0, 0]].is_infinite());
        assert!((map[[1, 1]] - 42.5).abs() < 1e-12);
        assert_eq!(map[[2, 1]], 1.0);
    }
}
