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
    memory: Vec<T>,
    /// E of a row before its step.
    ez_old: Vec<T>,
    materials: Vec<Poles<T>>,
}

/// A run of nodes of one dispersive material.
struct Span {
    row: usize,
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
    /// Finds the runs of dispersive nodes; `None` where there are none.
    pub fn new(setup: &Setup<'_>, first: usize, rows: usize) -> Option<Self> {
        let materials: Vec<(u32, Poles<T>)> =
            setup.edges.iter().enumerate().filter_map(|(entry, edge)| Some((entry as u32, Poles::of(edge)?))).collect();
        let ny = setup.painted.cells_xy[1];
        let (mut spans, mut place): (Vec<Span>, usize) = (vec![], 0);
        for row in 1..=rows {
            let entries = &setup.painted.edge_z[(first - 1 + row) * (ny + 1)..][..ny];
            let mut j = 1;
            for run in entries[1..].chunk_by(|a, b| a == b) {
                if let Some(material) = materials.iter().position(|(entry, _)| *entry == run[0]) {
                    spans.push(Span { row, j, count: run.len(), material, place });
                    place += run.len() * materials[material].1.count();
                }
                j += run.len();
            }
        }
        let materials = materials.into_iter().map(|(_, poles)| poles).collect();
        let ez_old = vec![T::default(); padded_width(ny)];
        (!spans.is_empty()).then(|| Self { spans, memory: vec![T::default(); place], ez_old, materials })
    }

    /// Keeps E of a row's dispersive nodes before its step; `ez` begins at node 1, `next` is the first run not yet done.
    #[inline(always)]
    pub fn keep(&mut self, r: usize, ez: &[T], next: usize) {
        for span in self.spans[next..].iter().take_while(|span| span.row == r) {
            let nodes = span.j - 1..span.j - 1 + span.count;
            self.ez_old[nodes.clone()].copy_from_slice(&ez[nodes]);
        }
    }

    /// Relaxes the dispersive nodes of a row; `ez` begins at node 1.
    #[inline(always)]
    pub fn relax_row(&mut self, r: usize, ez: &mut [T], next: &mut usize) {
        while let Some(span) = self.spans.get(*next).filter(|span| span.row == r) {
            let nodes = span.j - 1..span.j - 1 + span.count;
            let (ez, ez_old) = (&mut ez[nodes.clone()], &self.ez_old[nodes]);
            let memory = &mut self.memory[span.place..];
            match &self.materials[span.material] {
                Poles::One(c) => {
                    kernel::relax(ez, ez_old, [&mut memory[..span.count]], c);
                }
                Poles::Two(c) => {
                    let (first, rest) = memory.split_at_mut(span.count);
                    kernel::relax(ez, ez_old, [first, &mut rest[..span.count]], c);
                }
                Poles::Three(c) => {
                    let (first, rest) = memory.split_at_mut(span.count);
                    let (second, rest) = rest.split_at_mut(span.count);
                    kernel::relax(ez, ez_old, [first, second, &mut rest[..span.count]], c);
                }
            }
            *next += 1;
        }
    }
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
