//! Relaxation and resonance on one run of edges of the same material.

use super::super::super::real::Real;
use super::super::vector::{Kernel, Set};

/// The coefficients of one Debye or Drude pole.
#[derive(Debug, Clone, Copy)]
pub struct Pole<T> {
    /// What a unit of polarisation memory takes from E: `eps0 exp(-dt/(2 tau))/(dt EA)`.
    pub give: T,
    /// What remains of the memory after a step: `exp(-dt/tau)`.
    pub keep: T,
    /// What a fall of E adds to the memory: `delta_eps (exp(-dt/tau) - 1)`.
    pub take: T,
}

/// The coefficients of one Lorentz pole, real and imaginary part; its memory holds what it takes from E.
#[derive(Debug, Clone, Copy)]
pub struct Ringing<T> {
    /// What remains of the memory after a step: `exp(q dt)`.
    pub keep: [T; 2],
    /// What a fall of E adds to the memory: `-eps0/(dt EA) exp(q dt/2) (w/q) (exp(q dt) - 1)`.
    pub take: [T; 2],
}

/// Lets poles act on E after its plain step, the absorbing boundary and the sources.
///
/// Piecewise-linear recursive scheme of Giannakis & Giannopoulos 2014 (doi:10.1109/TAP.2014.2308549):
/// `E <- E - sum Re(c0 T) / EA`, `T <- c1 T + c2 (E_old - E)`. Departs from the paper: `T` is scaled by `dt`, that of a
/// Lorentz pole by `c0/EA` too, and both halves of its update are done at once, so that in single precision the difference of
/// E is formed before the product.
///
/// Shape: `memory` holds the poles one after the other, `each` numbers for one, then two such parts, real and imaginary, for
/// each Lorentz pole; `e` begins at place `from` of each.
pub struct Relax<'a, T> {
    /// E after its step.
    pub e: &'a mut [T],
    /// E before.
    pub e_old: &'a [T],
    /// The poles' memory.
    pub memory: &'a mut [T],
    /// Numbers of each part of the memory.
    pub each: usize,
    /// Place of `e` in each.
    pub from: usize,
    /// Debye and Drude.
    pub poles: &'a [Pole<T>],
    /// Lorentz.
    pub ringing: &'a [Ringing<T>],
}

impl<T: Real> Kernel<T> for Relax<'_, T> {
    #[inline(always)]
    fn run<S: Set<T>>(self, _: S) {
        relax(self);
    }
}

#[inline(always)]
fn relax<T: Real>(relax: Relax<'_, T>) {
    let Relax { e, e_old, memory, each, from, poles, ringing } = relax;
    let n = e.len();
    let e_old = &e_old[..n];
    // The most common case in one go; the same operations in the same order.
    if let ([pole], []) = (poles, ringing) {
        let memory = &mut memory[from..][..n];
        for k in 0..n {
            let relaxed = e[k] - pole.give * memory[k];
            memory[k] = pole.keep * memory[k] + pole.take * (e_old[k] - relaxed);
            e[k] = relaxed;
        }
        return;
    }
    let (relaxing, resonant) = memory.split_at_mut(each * poles.len());
    for (memory, pole) in relaxing.chunks_exact(each).zip(poles) {
        let memory = &memory[from..][..n];
        for k in 0..n {
            e[k] = e[k] - pole.give * memory[k];
        }
    }
    for memory in resonant.chunks_exact(2 * each) {
        let memory = &memory[from..][..n];
        for k in 0..n {
            e[k] = e[k] - memory[k];
        }
    }
    for (memory, pole) in relaxing.chunks_exact_mut(each).zip(poles) {
        let memory = &mut memory[from..][..n];
        for k in 0..n {
            memory[k] = pole.keep * memory[k] + pole.take * (e_old[k] - e[k]);
        }
    }
    for (memory, pole) in resonant.chunks_exact_mut(2 * each).zip(ringing) {
        let (re, im) = memory.split_at_mut(each);
        let (re, im) = (&mut re[from..][..n], &mut im[from..][..n]);
        let ([keep_re, keep_im], [take_re, take_im]) = (pole.keep, pole.take);
        for k in 0..n {
            let (fall, a, b) = (e_old[k] - e[k], re[k], im[k]);
            re[k] = keep_re * a - keep_im * b + take_re * fall;
            im[k] = keep_im * a + keep_re * b + take_im * fall;
        }
    }
}
