//! Debye relaxation on one run of nodes of the same material.

use super::super::real::Real;

/// The coefficients of a material with `P` Debye poles.
#[derive(Debug, Clone, Copy)]
pub struct Relaxation<T, const P: usize> {
    /// What a unit of polarisation memory takes from E: `eps0 exp(-dt/(2 tau))/(dt EA)`.
    pub give: [T; P],
    /// What remains of the memory after a step: `exp(-dt/tau)`.
    pub keep: [T; P],
    /// What a fall of E adds to the memory: `delta_eps (exp(-dt/tau) - 1)`.
    pub take: [T; P],
}

/// Lets `P` poles act on E after its plain step, the absorbing boundary and the sources.
///
/// Giannakis & Giannopoulos 2014, "A novel piecewise linear recursive convolution approach for dispersive media using the
/// finite-difference time-domain method", IEEE Trans. Antennas Propag. 62, 2669-2678 (doi:10.1109/TAP.2014.2308549):
/// `E <- E - sum c0 T / EA`, `T <- c1 T + c2 (E_old - E)`. Departs from the paper: `T` is scaled by `dt`, and both
/// halves of its update are done at once, so that in single precision the difference of E is formed before the product.
///
/// Shape: `memory[p]`, `ez` and `ez_old` have equal lengths.
#[inline(always)]
pub fn relax<T: Real, const P: usize>(
    ez: &mut [T],
    ez_old: &[T],
    memory: [&mut [T]; P],
    relaxation: &Relaxation<T, P>,
) {
    let n = ez.len();
    let ez_old = &ez_old[..n];
    let memory = memory.map(|pole| &mut pole[..n]);
    let Relaxation { give, keep, take } = *relaxation;
    for j in 0..n {
        let mut e = ez[j];
        for p in 0..P {
            e = e - give[p] * memory[p][j];
        }
        let fall = ez_old[j] - e;
        for p in 0..P {
            memory[p][j] = keep[p] * memory[p][j] + take[p] * fall;
        }
        ez[j] = e;
    }
}
