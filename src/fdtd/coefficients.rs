//! From materials to the numbers of the kernels, in double precision.

use super::FdtdError;
use crate::model::{DebyePole, EdgeMaterial, Material, Model, Painted};
use crate::units::constants::{EPSILON_0, MU_0, Z0};

/// The most Debye poles a material may have.
pub const MOST_POLES: usize = 3;

/// What lies on an edge, as the kernels want it.
#[derive(Debug, Clone, PartialEq)]
pub struct Edge {
    /// `(eps/dt - sigma/2)/(eps/dt + sigma/2)`; 1 on a perfect conductor, whose field starts at zero.
    pub ca: f64,
    /// `dt/(mu0 dx² EA)`, which takes the scaled H.
    pub cb: f64,
    /// `1/EA`: what a unit of current density takes from E in a step.
    pub source: f64,
    /// One entry per pole: `give`, `keep`, `take` of [`Relaxation`](super::kernel::Relaxation).
    pub poles: Vec<[f64; 3]>,
}

impl Edge {
    /// Whether E decays by conduction.
    pub fn is_lossy(&self) -> bool {
        self.ca != 1.0
    }
}

/// The coefficients of every entry of the palette.
///
/// # Errors
/// Materials on the grid that the solver does not know: magnetic ones, and those with more than three Debye poles.
pub fn edges(model: &Model, painted: &Painted) -> Result<Vec<Edge>, FdtdError> {
    let present = painted.cells_per_material(model.materials.len());
    for (material, _) in model.materials.iter().zip(present).filter(|(_, cells)| *cells > 0) {
        check_material(material)?;
    }
    Ok(painted.palette.iter().map(|entry| edge_of(model, entry)).collect())
}

/// The coefficients of one entry of a palette.
pub fn edge_of(model: &Model, entry: &EdgeMaterial) -> Edge {
    if entry.sigma.is_infinite() {
        return Edge { ca: 1.0, cb: 0.0, source: 0.0, poles: vec![] };
    }
    let poles = entry.dispersive.map_or(&[][..], |id| &model.materials[id.index()].poles);
    edge(entry.eps_r, entry.sigma, poles, model.time_step(), model.grid.spacing[0])
}

/// `EA = eps0 eps_r/dt + sigma/2 + (eps0/dt) sum delta_eps (1 - exp(-dt/(2 tau)))`; the sum stands in `EB` too, so a
/// pole far faster than `dt` adds its whole strength to the permittivity. A pole of no strength is dropped.
fn edge(eps_r: f64, sigma: f64, poles: &[DebyePole], dt: f64, dx: f64) -> Edge {
    let poles = || poles.iter().filter(|pole| pole.delta_eps != 0.0);
    let relaxed: f64 = poles().map(|pole| -pole.delta_eps * (-dt / (2.0 * pole.tau)).exp_m1()).sum();
    let storage = EPSILON_0 * (eps_r + relaxed) / dt;
    let (ea, eb) = (storage + sigma / 2.0, storage - sigma / 2.0);
    let source = 1.0 / ea;
    let triple = |pole: &DebyePole| {
        let step = -dt / pole.tau;
        [source * EPSILON_0 / dt * (step / 2.0).exp(), step.exp(), pole.delta_eps * step.exp_m1()]
    };
    Edge { ca: eb / ea, cb: source * dt / (MU_0 * dx * dx), source, poles: poles().map(triple).collect() }
}

fn check_material(material: &Material) -> Result<(), FdtdError> {
    let id = || material.id.clone();
    if material.mu_r != 1.0 || material.sigma_magnetic != 0.0 {
        let (mu_r, sigma_magnetic) = (material.mu_r, material.sigma_magnetic);
        return Err(FdtdError::Magnetic { material: id(), mu_r, sigma_magnetic });
    }
    check_electric(material)
}

/// Refuses what no solver here can do with a material's electric side.
///
/// # Errors
/// With the material, its value and the limit.
pub fn check_electric(material: &Material) -> Result<(), FdtdError> {
    let id = || material.id.clone();
    let poles = material.poles.iter().filter(|pole| pole.delta_eps != 0.0).count();
    if poles > MOST_POLES {
        return Err(FdtdError::TooManyPoles { material: id(), poles, most: MOST_POLES });
    }
    if material.is_pec() {
        return Ok(());
    }
    let at_least = |quantity, value: f64, least| {
        if value >= least && value.is_finite() {
            return Ok(());
        }
        Err(FdtdError::Material { material: id(), quantity, value, least })
    };
    at_least("relative permittivity", material.eps_r, 1.0)?;
    at_least("conductivity in S/m", material.sigma, 0.0)?;
    for pole in &material.poles {
        at_least("Debye strength", pole.delta_eps, 0.0)?;
        at_least("relaxation time in s", pole.tau, f64::MIN_POSITIVE)?;
    }
    Ok(())
}

/// The profile of an absorbing slab: `RA - 1, RB, RE, RF` at a depth, 0 at the entrance and 1 at the wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slab {
    /// Absorbing cells.
    pub cells: usize,
    /// Conductivity at the wall, S/m.
    pub sigma_max: f64,
    dt: f64,
}

impl Slab {
    /// A slab whose wall conducts so much.
    pub fn new(cells: usize, sigma_max: f64, dt: f64) -> Self {
        Self { cells, sigma_max, dt }
    }

    /// `RA - 1, RB, RE, RF` at a depth counted in cells from the entrance; no absorption at or before it.
    ///
    /// First-order HORIPML with `kappa = 1`, `alpha = 0` and `sigma = sigma_max depth⁴`.
    pub fn at(&self, depth: f64) -> [f64; 4] {
        let sigma = self.sigma_max * (depth.max(0.0) / self.cells as f64).powi(4);
        let below = 2.0 * EPSILON_0 + self.dt * sigma;
        let ra = 2.0 * EPSILON_0 / below;
        [-self.dt * sigma / below, ra, (2.0 * EPSILON_0 - self.dt * sigma) / below, 2.0 * sigma * self.dt / below]
    }
}

/// The absorbing slabs at x0, y0, xmax, ymax.
///
/// `sigma_max = 0.8 * 5/(Z0 d sqrt(eps_r))`, `eps_r` being the mean over the layer of absorbing
/// cells next to the slab's entrance, corners and conductors (as `eps_r` 1) included. Which layer gprMax takes was found by
/// running it on a scene with different materials in each layer: with this one traces agree to 1e-14, with its
/// neighbour to 1e-4.
pub fn slabs(model: &Model, painted: &Painted) -> [Slab; 4] {
    let [x0, y0, _, x1, y1, _] = model.absorbing_cells();
    let [nx, ny] = painted.cells_xy;
    let dt = model.time_step();
    let eps_r = |i: usize, j: usize| model.materials[painted.solid[i * ny + j].index()].eps_r;
    let across_y = |i: usize| (0..ny).map(|j| eps_r(i, j)).sum::<f64>() / ny as f64;
    let across_x = |j: usize| (0..nx).map(|i| eps_r(i, j)).sum::<f64>() / nx as f64;
    let [dx, dy, _] = model.grid.spacing;
    let slab = |cells: usize, d: f64, mean: &dyn Fn() -> f64| Slab {
        cells,
        sigma_max: if cells == 0 { 0.0 } else { 0.8 * 5.0 / (Z0 * d * mean().sqrt()) },
        dt,
    };
    [
        slab(x0, dx, &|| across_y(x0 - 1)),
        slab(y0, dy, &|| across_x(y0 - 1)),
        slab(x1, dx, &|| across_y(nx - x1)),
        slab(y1, dy, &|| across_x(ny - y1)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pole with tau far below dt is plain permittivity, to the bit; one far above dt gives E its full memory.
    #[test]
    fn fast_poles_are_static_permittivity() {
        let fast = [DebyePole { delta_eps: 75.0, tau: 1e-18 }];
        let (with, without) = (edge(5.0, 0.01, &fast, 4.7e-12, 0.002), edge(80.0, 0.01, &[], 4.7e-12, 0.002));
        assert_eq!((with.ca, with.cb, with.source), (without.ca, without.cb, without.source));
        assert_eq!(with.poles, vec![[0.0, 0.0, -75.0]]);
    }

    /// At the entrance nothing is absorbed: the correction is exactly zero while `phi` is.
    #[test]
    fn the_entrance_absorbs_nothing() {
        let slab = Slab { cells: 10, sigma_max: 5.0, dt: 4.7e-12 };
        assert_eq!(slab.at(0.0), [0.0, 1.0, 1.0, 0.0]);
        assert_eq!(slab.at(-3.0), slab.at(0.0));
    }
}
