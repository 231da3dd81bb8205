//! Polarisation memory: for dispersive edges, and for no others.

use super::super::coefficients::Edge;
use super::super::dispersion::overlap;
use super::super::real::Real;
use super::super::state::{Numbers, State};
use super::kernel::{Pole, Relax, Ringing};
use super::setup::Setup3;
use super::vector::Set;

/// The dispersive edges of a plane.
pub struct Dispersion<T> {
    /// Sorted by row, then axis, then node.
    runs: Vec<Run>,
    /// First run of each row, and one entry more.
    of_row: Vec<u32>,
    memory: Vec<T>,
}

/// A run of edges of one dispersive material along a row.
struct Run {
    axis: usize,
    k: usize,
    count: usize,
    entry: usize,
    /// Place in the memory, pole after pole.
    place: usize,
}

/// The relaxing and the ringing poles of each entry of the palette.
pub type Poles<T> = Vec<(Vec<Pole<T>>, Vec<Ringing<T>>)>;

/// The poles of each entry of the palette.
pub fn poles<T: Real>(setup: &Setup3<'_>) -> Poles<T> {
    let pole = |&[give, keep, take]: &[f64; 3]| Pole { give: T::of(give), keep: T::of(keep), take: T::of(take) };
    let ringing = |&[a, b, c, d]: &[f64; 4]| Ringing { keep: [T::of(a), T::of(b)], take: [T::of(c), T::of(d)] };
    let of = |edge: &Edge| (edge.poles.iter().map(pole).collect(), edge.ringing.iter().map(ringing).collect());
    setup.edges.iter().map(of).collect()
}

impl<T: Real> State for Dispersion<T> {
    fn visit(&mut self, visitor: &mut dyn FnMut(Numbers<'_>)) {
        let Self { runs: _, of_row: _, memory } = self;
        visitor(T::numbers(memory));
    }
}

impl<T: Real> Dispersion<T> {
    /// Finds the runs of dispersive edges of plane `i`; `None` where there are none. Walls are left out.
    pub fn new(setup: &Setup3<'_>, i: usize) -> Option<Self> {
        let [_, ny, nz] = setup.painted.cells;
        if !setup.remembers() {
            return None;
        }
        let (mut runs, mut of_row, mut place): (Vec<Run>, Vec<u32>, usize) = (vec![], vec![0], 0);
        for j in 0..ny {
            let first = setup.painted.node([i, j, 0]);
            for axis in 0..3 {
                let entry = |k: usize| setup.entry(axis, first + k);
                let mut k = 0;
                while k < nz {
                    let (begin, of) = (k, entry(k));
                    let wall = setup.on_wall(axis, [i, j, k]);
                    while k < nz && entry(k) == of && setup.on_wall(axis, [i, j, k]) == wall {
                        k += 1;
                    }
                    let poles = setup.edges[of].memories();
                    if poles > 0 && !wall && setup.active.e[axis] {
                        runs.push(Run { axis, k: begin, count: k - begin, entry: of, place });
                        place += (k - begin) * poles;
                    }
                }
            }
            of_row.push(runs.len() as u32);
        }
        (!runs.is_empty()).then(|| Self { runs, of_row, memory: vec![T::default(); place] })
    }

    /// Keeps E of a row's dispersive edges before its step; `e` begins at node `begin`.
    #[inline(always)]
    pub fn keep(&self, j: usize, begin: usize, e: [&[T]; 3], old: &mut [Vec<T>; 3]) {
        for run in &self.runs[self.of_row[j] as usize..self.of_row[j + 1] as usize] {
            if let Some((k, count)) = overlap(run.k, run.count, begin, e[run.axis].len()) {
                old[run.axis][k..][..count].copy_from_slice(&e[run.axis][k - begin..][..count]);
            }
        }
    }

    /// Relaxes the dispersive edges of a row; `e` begins at node `begin`.
    #[inline(always)]
    pub fn relax_row<S: Set<T>>(
        &mut self,
        set: S,
        j: usize,
        begin: usize,
        e: [&mut [T]; 3],
        old: &[Vec<T>; 3],
        poles: &Poles<T>,
    ) {
        for run in &self.runs[self.of_row[j] as usize..self.of_row[j + 1] as usize] {
            let e = &mut *e[run.axis];
            let Some((k, count)) = overlap(run.k, run.count, begin, e.len()) else { continue };
            let (relaxing, ringing) = &poles[run.entry];
            let memory = &mut self.memory[run.place..][..run.count * (relaxing.len() + 2 * ringing.len())];
            let (e, old) = (&mut e[k - begin..][..count], &old[run.axis][k..][..count]);
            set.run(Relax { e, e_old: old, memory, each: run.count, from: k - run.k, poles: relaxing, ringing });
        }
    }
}
