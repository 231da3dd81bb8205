//! From materials to the numbers of the kernels, in double precision.

use std::f64::consts::PI;

use super::FdtdError;
use super::slab::Slab;
use crate::model::{DebyePole, EdgeMaterial, MOST_POLES_IN_A_PLANE, Material, Model, Painted, Resonance};
use crate::units::constants::{EPSILON_0, MU_0, Z0};

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
    /// One entry per Lorentz pole: `keep` and `take` of `Ringing`, real and imaginary parts.
    pub ringing: Vec<[f64; 4]>,
}

impl Edge {
    /// Numbers of polarisation memory: one for a pole, two for one that rings.
    pub fn memories(&self) -> usize {
        self.poles.len() + 2 * self.ringing.len()
    }

    /// Whether E decays by conduction.
    pub fn is_lossy(&self) -> bool {
        self.ca != 1.0
    }
}

/// The coefficients of every entry of the palette.
///
/// # Errors
/// Materials on the grid that the plane does not know: magnetic ones, those that ring, and those with more than three poles.
pub fn edges(model: &Model, painted: &Painted) -> Result<Vec<Edge>, FdtdError> {
    let present = model.acting(painted.cells_per_material(model.materials.len()));
    for (material, _) in model.materials.iter().zip(present).filter(|(_, cells)| *cells > 0) {
        check_material(material)?;
    }
    let of_entry = |entry: &EdgeMaterial| {
        let edge = edge_of(model, entry);
        if edge.poles.len() <= MOST_POLES_IN_A_PLANE && edge.ringing.is_empty() {
            return Ok(edge);
        }
        // Several materials, averaged: the route of three dimensions knows them.
        let first = entry.shares().first().map(|(id, _)| model.materials[id.index()].id.clone());
        let (material, most) = (first.unwrap_or_default(), MOST_POLES_IN_A_PLANE);
        Err(FdtdError::TooManyPoles { material, poles: edge.poles.len(), most })
    };
    painted.palette.iter().map(of_entry).collect()
}

/// The coefficients of one entry of a palette.
pub fn edge_of(model: &Model, entry: &EdgeMaterial) -> Edge {
    if entry.sigma.is_infinite() {
        return Edge { ca: 1.0, cb: 0.0, source: 0.0, poles: vec![], ringing: vec![] };
    }
    let (mut poles, mut resonances) = (vec![], vec![]);
    for (id, share) in entry.shares() {
        let material = &model.materials[id.index()];
        poles.extend(material.poles.iter().map(|p| DebyePole { delta_eps: share * p.delta_eps, tau: p.tau }));
        resonances.extend(material.resonances.iter().map(|resonance| (*resonance, share)));
    }
    edge(entry.eps_r, entry.sigma, &poles, &resonances, model.time_step(), model.grid.spacing[0])
}

/// The largest angle by which a Lorentz pole may turn in a time step, rad: beyond it the eigenvalues of the scheme leave the unit
/// circle (by 0.4 in a step at 3 rad, with `eps_r` 4 and any strength), within it they lie on it or inside for `eps_r` 4. A
/// material of `eps_r` 1 needs a time step below the Courant limit too.
const MOST_TURN: f64 = 2.0;

/// Refuses Lorentz poles that the time step cannot follow.
///
/// # Errors
/// With the material and its pole.
pub fn check_resonances(material: &Material, dt: f64) -> Result<(), FdtdError> {
    for resonance in material.resonances.iter().filter(|resonance| !resonance.is_absent()) {
        let Resonance::Lorentz { frequency, .. } = *resonance else { continue };
        let turn = 2.0 * PI * frequency * dt;
        if turn > MOST_TURN {
            let material = material.id.clone();
            return Err(FdtdError::ResonanceTooFast { material, frequency, turn, most: MOST_TURN });
        }
    }
    Ok(())
}

/// `EA = eps0 eps_r/dt + sigma/2 + (eps0/dt) sum delta_eps (1 - exp(-dt/(2 tau)))`; the sum stands in `EB` too, so a
/// pole far faster than `dt` adds its whole strength to the permittivity. A pole of no strength is dropped.
///
/// A pole of the scheme of Giannakis & Giannopoulos 2014 is `w exp(q t)`. Debye: `w = delta_eps/tau`, `q = -1/tau`. Drude:
/// `w = -wp²/g`, `q = -g` with a conductivity of `eps0 wp²/g`, so it is a relaxation of strength `-(wp/g)²`. Lorentz:
/// `w = -i delta_eps w0²/b`, `q = -delta + i b`, `b = sqrt(w0² - delta²)`, and its real part acts.
fn edge(eps_r: f64, sigma: f64, poles: &[DebyePole], resonances: &[(Resonance, f64)], dt: f64, dx: f64) -> Edge {
    let mut poles: Vec<DebyePole> = poles.iter().filter(|pole| pole.delta_eps != 0.0).copied().collect();
    let (mut sigma, mut lorentz) = (sigma, vec![]);
    for &(resonance, share) in resonances {
        match resonance {
            Resonance::Drude { frequency, collisions } => {
                let strength = share * (2.0 * PI * frequency / collisions).powi(2);
                if strength != 0.0 {
                    sigma += EPSILON_0 * strength * collisions;
                    poles.push(DebyePole { delta_eps: -strength, tau: 1.0 / collisions });
                }
            }
            Resonance::Lorentz { delta_eps, frequency, damping } if share * delta_eps != 0.0 => {
                let resonant = 2.0 * PI * frequency;
                let ringing = ((resonant - damping) * (resonant + damping)).sqrt();
                let (w, q) = ((0.0, -share * delta_eps * resonant * resonant / ringing), (-damping, ringing));
                let norm = q.0 * q.0 + q.1 * q.1;
                let over = ((w.0 * q.0 + w.1 * q.1) / norm, (w.1 * q.0 - w.0 * q.1) / norm);
                lorentz.push((over, q));
            }
            Resonance::Lorentz { .. } => {}
        }
    }
    let poles = || poles.iter();
    let ringing = |&((a, b), (decay, turn)): &((f64, f64), (f64, f64))| {
        let (re, im) = complex_exp_m1(0.5 * dt * decay, 0.5 * dt * turn);
        a * re - b * im
    };
    let relaxed: f64 = poles().map(|pole| -pole.delta_eps * (-dt / (2.0 * pole.tau)).exp_m1()).sum();
    let relaxed = lorentz.iter().map(ringing).fold(relaxed, |sum, part| sum + part);
    let storage = EPSILON_0 * (eps_r + relaxed) / dt;
    let (ea, eb) = (storage + sigma / 2.0, storage - sigma / 2.0);
    let source = 1.0 / ea;
    let triple = |pole: &DebyePole| {
        let step = -dt / pole.tau;
        [source * EPSILON_0 / dt * (step / 2.0).exp(), step.exp(), pole.delta_eps * step.exp_m1()]
    };
    let quadruple = |&((a, b), (decay, turn)): &((f64, f64), (f64, f64))| {
        let (re, im) = complex_exp_m1(dt * decay, dt * turn);
        // - (w/q) expm1(q dt), once more turned by exp(q dt/2) and scaled as what a unit takes from E.
        let (re, im) = (-(a * re - b * im), -(a * im + b * re));
        let (half, scale) = ((0.5 * dt * decay).exp(), source * EPSILON_0 / dt);
        let (cos, sin) = (half * (0.5 * dt * turn).cos(), half * (0.5 * dt * turn).sin());
        let keep = (dt * decay).exp();
        [
            keep * (dt * turn).cos(),
            keep * (dt * turn).sin(),
            scale * (re * cos - im * sin),
            scale * (re * sin + im * cos),
        ]
    };
    Edge {
        ca: eb / ea,
        cb: source * dt / (MU_0 * dx * dx),
        source,
        poles: poles().map(triple).collect(),
        ringing: lorentz.iter().map(quadruple).collect(),
    }
}

/// `exp(a + i b) - 1` without cancellation near zero.
fn complex_exp_m1(a: f64, b: f64) -> (f64, f64) {
    let half = (0.5 * b).sin();
    (a.exp_m1() * b.cos() - 2.0 * half * half, a.exp() * b.sin())
}

fn check_material(material: &Material) -> Result<(), FdtdError> {
    let id = || material.id.clone();
    if material.mu_r != 1.0 || material.sigma_magnetic != 0.0 {
        let (mu_r, sigma_magnetic) = (material.mu_r, material.sigma_magnetic);
        return Err(FdtdError::Magnetic { material: id(), mu_r, sigma_magnetic });
    }
    check_electric(material)?;
    match material.pole_counts() {
        (0..=MOST_POLES_IN_A_PLANE, 0) => Ok(()),
        (poles, 0) => Err(FdtdError::TooManyPoles { material: id(), poles, most: MOST_POLES_IN_A_PLANE }),
        _ => Err(FdtdError::Rings { material: id() }),
    }
}

/// Refuses what no solver here can do with a material's electric side.
///
/// # Errors
/// With the material, its value and the limit.
pub fn check_electric(material: &Material) -> Result<(), FdtdError> {
    let id = || material.id.clone();
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
    for resonance in &material.resonances {
        match *resonance {
            Resonance::Lorentz { delta_eps, frequency, damping } => {
                at_least("Lorentz strength", delta_eps, 0.0)?;
                at_least("damping of a resonance in 1/s", damping, 0.0)?;
                at_least("resonance frequency in Hz", frequency, f64::MIN_POSITIVE)?;
                if damping >= 2.0 * PI * frequency {
                    return Err(FdtdError::Overdamped { material: id(), frequency, damping });
                }
            }
            Resonance::Drude { frequency, collisions } => {
                at_least("plasma frequency in Hz", frequency, 0.0)?;
                at_least("collision rate in 1/s", collisions, f64::MIN_POSITIVE)?;
            }
        }
    }
    Ok(())
}

/// The absorbing slabs at x0, y0, xmax, ymax.
///
/// `sigma_max = 0.8 * 5/(Z0 d sqrt(eps_r))`, `eps_r` being the mean over the layer of absorbing
/// cells next to the slab's entrance, corners and conductors (as `eps_r` 1) included. Which layer gprMax takes was found by
/// running it on a scene with different materials in each layer: with this one traces agree to 1e-14, with its
/// neighbour to 1e-4.
///
/// # Errors
/// See [`Slab::new`].
pub fn slabs(model: &Model, painted: &Painted) -> Result<[Slab; 4], FdtdError> {
    let [x0, y0, _, x1, y1, _] = model.absorbing_cells();
    let [nx, ny] = painted.cells_xy;
    let dt = model.time_step();
    let eps_r = |i: usize, j: usize| model.materials[painted.solid[i * ny + j].index()].eps_r;
    let across_y = |i: usize| (0..ny).map(|j| eps_r(i, j)).sum::<f64>() / ny as f64;
    let across_x = |j: usize| (0..nx).map(|i| eps_r(i, j)).sum::<f64>() / nx as f64;
    let [dx, dy, _] = model.grid.spacing;
    let profile = &model.absorbing_profile;
    let slab = |cells: usize, d: f64, mean: &dyn Fn() -> f64| match cells {
        0 => Ok(Slab::none()),
        _ => Slab::new(profile, cells, 0.8 / (Z0 * d * mean().sqrt()), dt),
    };
    Ok([
        slab(x0, dx, &|| across_y(x0 - 1))?,
        slab(y0, dy, &|| across_x(y0 - 1))?,
        slab(x1, dx, &|| across_y(nx - x1))?,
        slab(y1, dy, &|| across_x(ny - y1))?,
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pole with tau far below dt is plain permittivity, to the bit; one far above dt gives E its full memory.
    #[test]
    fn fast_poles_are_static_permittivity() {
        let fast = [DebyePole { delta_eps: 75.0, tau: 1e-18 }];
        let (with, without) = (edge(5.0, 0.01, &fast, &[], 4.7e-12, 0.002), edge(80.0, 0.01, &[], &[], 4.7e-12, 0.002));
        assert_eq!((with.ca, with.cb, with.source), (without.ca, without.cb, without.source));
        assert_eq!(with.poles, vec![[0.0, 0.0, -75.0]]);
    }
}
