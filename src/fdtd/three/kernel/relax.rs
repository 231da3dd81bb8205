//! Debye relaxation on one run of edges of the same material.

use super::super::super::real::Real;

/// The coefficients of one Debye pole.
#[derive(Debug, Clone, Copy)]
pub struct Pole<T> {
    /// What a unit of polarisation memory takes from E: `eps0 exp(-dt/(2 tau))/(dt EA)`.
    pub give: T,
    /// What remains of the memory after a step: `exp(-dt/tau)`.
    pub keep: T,
    /// What a fall of E adds to the memory: `delta_eps (exp(-dt/tau) - 1)`.
    pub take: T,
}

/// Lets poles act on E after its plain step, the absorbing boundary and the sources.
///
/// Piecewise-linear recursive scheme of Giannakis & Giannopoulos 2014 (doi:10.1109/TAP.2014.2308549):
/// `E <- E - sum c0 T / EA`, `T <- c1 T + c2 (E_old - E)`. Departs from the paper: `T` is scaled by `dt`, and both halves
/// of its update are done at once, so that in single precision the difference of E is formed before the product.
///
/// Shape: `memory` holds the poles one after the other, equally long; `e` begins at place `from` of each.
#[inline(always)]
pub fn relax<T: Real>(e: &mut [T], e_old: &[T], memory: &mut [T], from: usize, poles: &[Pole<T>]) {
    let n = e.len();
    let e_old = &e_old[..n];
    let each = memory.len() / poles.len().max(1);
    for (memory, pole) in memory.chunks_exact(each).zip(poles) {
        let memory = &memory[from..][..n];
        for k in 0..n {
            e[k] = e[k] - pole.give * memory[k];
        }
    }
    for (memory, pole) in memory.chunks_exact_mut(each).zip(poles) {
        let memory = &mut memory[from..][..n];
        for k in 0..n {
            memory[k] = pole.keep * memory[k] + pole.take * (e_old[k] - e[k]);
        }
    }
}
