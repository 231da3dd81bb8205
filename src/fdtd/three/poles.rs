//! Polarisation memory: for dispersive edges, and for no others.

use super::super::real::Real;
use super::kernel::{Pole, relax};
use super::setup::Setup3;

/// The dispersive edges of a plane.
pub struct Dispersion<T> {
    /// Sorted by row, then axis, then node.
    runs: Vec<Run>,
    memory: Vec<T>,
}

/// A run of edges of one dispersive material along a row.
struct Run {
    j: usize,
    axis: usize,
    k: usize,
    count: usize,
    entry: usize,
    /// Place in the memory, pole after pole.
    place: usize,
}

/// The poles of each entry of the palette.
pub type Poles<T> = Vec<Vec<Pole<T>>>;

/// The poles of each entry of the palette.
pub fn poles<T: Real>(setup: &Setup3<'_>) -> Poles<T> {
    let pole = |&[give, keep, take]: &[f64; 3]| Pole { give: T::of(give), keep: T::of(keep), take: T::of(take) };
    setup.edges.iter().map(|edge| edge.poles.iter().map(pole).collect()).collect()
}

impl<T: Real> Dispersion<T> {
    /// Finds the runs of dispersive edges of plane `i`; `None` where there are none. Walls are left out.
    pub fn new(setup: &Setup3<'_>, i: usize) -> Option<Self> {
        let [_, ny, nz] = setup.painted.cells;
        if setup.edges.iter().all(|edge| edge.poles.is_empty()) {
            return None;
        }
        let (mut runs, mut place): (Vec<Run>, usize) = (vec![], 0);
        for j in 0..ny {
            let first = setup.painted.node([i, j, 0]);
            for axis in 0..3 {
                let entry = |k: usize| setup.painted.edges[axis].get(first + k) as usize;
                let mut k = 0;
                while k < nz {
                    let (begin, of) = (k, entry(k));
                    let wall = setup.on_wall(axis, [i, j, k]);
                    while k < nz && entry(k) == of && setup.on_wall(axis, [i, j, k]) == wall {
                        k += 1;
                    }
                    let poles = setup.edges[of].poles.len();
                    if poles > 0 && !wall && setup.active.e[axis] {
                        runs.push(Run { j, axis, k: begin, count: k - begin, entry: of, place });
                        place += (k - begin) * poles;
                    }
                }
            }
        }
        (!runs.is_empty()).then(|| Self { runs, memory: vec![T::default(); place] })
    }

    /// Keeps E of a row's dispersive edges before its step; `next` is the first run not yet done.
    #[inline(always)]
    pub fn keep(&self, j: usize, e: [&[T]; 3], old: &mut [Vec<T>; 3], next: usize) {
        for run in self.runs[next..].iter().take_while(|run| run.j == j) {
            let nodes = run.k..run.k + run.count;
            old[run.axis][nodes.clone()].copy_from_slice(&e[run.axis][nodes]);
        }
    }

    /// Relaxes the dispersive edges of a row.
    #[inline(always)]
    pub fn relax_row(&mut self, j: usize, e: [&mut [T]; 3], old: &[Vec<T>; 3], poles: &Poles<T>, next: &mut usize) {
        while let Some(run) = self.runs.get(*next).filter(|run| run.j == j) {
            let nodes = run.k..run.k + run.count;
            let poles = &poles[run.entry];
            let memory = &mut self.memory[run.place..][..run.count * poles.len()];
            relax(&mut e[run.axis][nodes.clone()], &old[run.axis][nodes], memory, poles);
            *next += 1;
        }
    }
}
