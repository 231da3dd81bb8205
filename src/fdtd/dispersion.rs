//! Polarisation memory: for dispersive nodes, and for no others.

use super::coefficients::Edge;
use super::kernel::{self, Relaxation};
use super::layout::padded_width;
use super::real::Real;
use super::setup::Setup;

/// Polarisation memory of the dispersive nodes, and of no others.
pub struct Dispersion<T> {
    /// Sorted by row.
    spans: Vec<Span>,
    /// First run of each stored row, and one entry more.
    of_row: Vec<usize>,
    memory: Vec<T>,
    /// E of a row before its step.
    ez_old: Vec<T>,
    materials: Vec<Poles<T>>,
}

/// A run of nodes of one dispersive material.
struct Span {
    j: usize,
    count: usize,
    material: usize,
    /// Place in the memory, pole after pole.
    place: usize,
}

/// The coefficients of a dispersive material.
#[derive(Clone, Copy)]
enum Poles<T> {
    One(Relaxation<T, 1>),
    Two(Relaxation<T, 2>),
    Three(Relaxation<T, 3>),
}

impl<T: Real> Dispersion<T> {
    /// Finds the runs of dispersive nodes in stored rows, which begin at row `base` of the grid; `None` where there are
    /// none.
    pub fn new(setup: &Setup<'_>, base: usize, stored: usize) -> Option<Self> {
        let materials: Vec<(u32, Poles<T>)> =
            setup.edges.iter().enumerate().filter_map(|(entry, edge)| Some((entry as u32, Poles::of(edge)?))).collect();
        let [nx, ny] = setup.painted.cells_xy;
        let (mut spans, mut of_row, mut place): (Vec<Span>, Vec<usize>, usize) = (vec![], vec![0], 0);
        for row in base..base + stored {
            let inside = if row > 0 && row < nx { 1..ny } else { 1..1 };
            let mut j = 1;
            for run in setup.painted.edge_z[row * (ny + 1)..][inside].chunk_by(|a, b| a == b) {
                if let Some(material) = materials.iter().position(|(entry, _)| *entry == run[0]) {
                    spans.push(Span { j, count: run.len(), material, place });
                    place += run.len() * materials[material].1.count();
                }
                j += run.len();
            }
            of_row.push(spans.len());
        }
        let materials = materials.into_iter().map(|(_, poles)| poles).collect();
        let ez_old = vec![T::default(); padded_width(ny)];
        (!spans.is_empty()).then(|| Self { spans, of_row, memory: vec![T::default(); place], ez_old, materials })
    }

    /// Keeps E of a row's dispersive nodes before its step; `ez` begins at node `j`.
    #[inline(always)]
    pub fn keep(&mut self, row: usize, j: usize, ez: &[T]) {
        for span in &self.spans[self.of_row[row]..self.of_row[row + 1]] {
            if let Some((begin, count)) = overlap(span.j, span.count, j, ez.len()) {
                self.ez_old[begin - 1..][..count].copy_from_slice(&ez[begin - j..][..count]);
            }
        }
    }

    /// Relaxes the dispersive nodes of a row; `ez` begins at node `j`.
    #[inline(always)]
    pub fn relax_row(&mut self, row: usize, j: usize, ez: &mut [T]) {
        for span in &self.spans[self.of_row[row]..self.of_row[row + 1]] {
            let Some((begin, count)) = overlap(span.j, span.count, j, ez.len()) else { continue };
            let (ez, ez_old) = (&mut ez[begin - j..][..count], &self.ez_old[begin - 1..][..count]);
            let memory = &mut self.memory[span.place..];
            let inside = begin - span.j..begin - span.j + count;
            match &self.materials[span.material] {
                Poles::One(c) => {
                    kernel::relax(ez, ez_old, [&mut memory[inside]], c);
                }
                Poles::Two(c) => {
                    let (first, rest) = memory.split_at_mut(span.count);
                    kernel::relax(ez, ez_old, [&mut first[inside.clone()], &mut rest[inside]], c);
                }
                Poles::Three(c) => {
                    let (first, rest) = memory.split_at_mut(span.count);
                    let (second, rest) = rest.split_at_mut(span.count);
                    let third = &mut rest[inside.clone()];
                    kernel::relax(ez, ez_old, [&mut first[inside.clone()], &mut second[inside], third], c);
                }
            }
        }
    }

    /// The memory of a stored row.
    pub fn memory_of_row(&mut self, row: usize) -> &mut [T] {
        let place = |span: usize| self.spans.get(span).map_or(self.memory.len(), |span| span.place);
        let (begin, end) = (place(self.of_row[row]), place(self.of_row[row + 1]));
        &mut self.memory[begin..end]
    }
}

/// First node and number of nodes that two runs share.
#[inline(always)]
pub fn overlap(a: usize, a_count: usize, b: usize, b_count: usize) -> Option<(usize, usize)> {
    let (begin, end) = (a.max(b), (a + a_count).min(b + b_count));
    (begin < end).then(|| (begin, end - begin))
}

impl<T: Real> Poles<T> {
    fn of(edge: &Edge) -> Option<Self> {
        fn relaxation<T: Real, const P: usize>(poles: &[[f64; 3]; P]) -> Relaxation<T, P> {
            let [give, keep, take] = std::array::from_fn(|k| poles.map(|pole| T::of(pole[k])));
            Relaxation { give, keep, take }
        }
        match *edge.poles.as_slice() {
            [one] => Some(Self::One(relaxation(&[one]))),
            [one, two] => Some(Self::Two(relaxation(&[one, two]))),
            [one, two, three] => Some(Self::Three(relaxation(&[one, two, three]))),
            _ => None,
        }
    }

    fn count(&self) -> usize {
        match self {
            Self::One(_) => 1,
            Self::Two(_) => 2,
            Self::Three(_) => 3,
        }
    }
}
