//! What no wave has reached yet, and what can no longer reach a receiver: neither is stepped. In three dimensions; the
//! argument is that of the two-dimensional [`reach`](super::super::reach), with another measure of distance.
//!
//! The curl joins a field to those half a cell away along one axis (one and a half at fourth order), and each step takes
//! one curl for H and one for E. Along the edges and faces where the fields lie, distances being `|dx| + |dy| + |dz|` in
//! cells, E therefore moves by one cell a step (three): the *pace*. The nodes that fields are counted by lie up to half a
//! cell aside along one axis (E) or two (H), so that distances between nodes are up to two cells less, or more. Conduction,
//! the absorbing boundary and polarisation memory join values of one place only.
//!
//! *Forwards.* All fields begin at zero, and a step makes zero from zero. By the end of step `k` a source that first acts at
//! step `b`, on E or on H, has moved nothing farther away than `pace (k - b + 1) + 1` nodes.
//!
//! *Backwards.* Of `N` samples the last is taken after step `N - 2`. A field of step `k` bears on a sample only within
//! `pace (N - 1 - k) + 1` nodes of a receiver, E or H; on a snapshot of step `n`, within `pace (n - k) + 1` of its box.
//!
//! A node is stepped where both hold for some source and some receiver. Every other value is still zero, or nobody looks at
//! what follows from it; so the samples keep their bits (but for the sign of a zero in a conductor, as in two dimensions).

use super::super::reach::Reach;
use super::setup::Setup3;
use super::sheet::{LANES, padded};

/// For every row of the grid, which of its nodes a step must touch.
pub struct Cones {
    /// Of row `(i, j)` at `i * ny + j`; empty where all is stepped.
    rows: Vec<Cone>,
    /// First and last step that moves any row of a plane.
    planes: Vec<[i32; 2]>,
    cells: [usize; 3],
    width: usize,
    /// Steps, one fewer than samples.
    steps: i32,
    /// Nodes that E moves by in one step.
    pace: i32,
}

/// The light cones of all sources and receivers, cut by one row. All numbers are distances, so that `k` steps may be told
/// off against them by their pace.
#[derive(Debug, Clone, Copy)]
struct Cone {
    /// Nodes to the nearest source, those it keeps still included.
    from: i32,
    /// Nodes to the nearest receiver.
    until: i32,
    /// Forwards, `r` nodes of way reach `low - r ..= r - high`.
    low: i32,
    high: i32,
    /// Backwards, `r` nodes of way matter in `low_back - r ..= r - high_back`.
    low_back: i32,
    high_back: i32,
}

/// What a row costs beside its nodes, in nodes: coefficients to find, ends that absorb, waiting for memory (two cores of
/// Zen 5; for predictions only).
const NODES_OF_A_ROW: usize = 100;
/// Beyond any grid, and far enough from the limits of the type to be added to.
const FAR: i32 = i32::MAX / 8;

impl Cones {
    /// `skip`: false steps every node every time.
    pub fn new(setup: &Setup3<'_>, skip: bool) -> Self {
        let cells = setup.painted.cells;
        let [nx, ny, nz] = cells;
        let (steps, pace) = (setup.iterations as i32 - 1, setup.pace());
        let mut cones = Self { rows: vec![], planes: vec![], cells, width: padded(nz), steps, pace };
        // Numbers of steps and of nodes whose sums could overflow: grids and runs that no machine finishes.
        let longest = setup.iterations as u64 * pace as u64 + (nx + ny + nz) as u64;
        if !skip || longest > FAR as u64 / 4 {
            return cones;
        }
        let spread = |seeds: &mut dyn Iterator<Item = ([usize; 3], i32)>| {
            let mut field = vec![FAR; nx * ny];
            for ([i, j, _], value) in seeds {
                let place = &mut field[i.min(nx - 1) * ny + j.min(ny - 1)];
                *place = value.min(*place);
            }
            spread(&mut field, nx, ny);
            field
        };
        let sources = || setup.begins().map(|(node, step)| (node, (step as i32).min(steps) * pace));
        // A snapshot looks at its box before one step only: for all later ones it is farther away than any wave gets.
        let looks = || {
            setup.looks.iter().flat_map(|look| {
                let [[i0, j0, k0], [i1, j1, k1]] = look.corners();
                let early = (steps - look.step as i32) * pace;
                let rows = (i0..=i1).flat_map(move |i| (j0..=j1).map(move |j| [i, j]));
                rows.flat_map(move |[i, j]| [([i, j, k0], early), ([i, j, k1], early)])
            })
        };
        let receivers = || setup.receivers.iter().map(|&node| (node, 0)).chain(looks());
        let from = spread(&mut sources());
        let low = spread(&mut sources().map(|(node, late)| (node, node[2] as i32 + late)));
        let high = spread(&mut sources().map(|(node, late)| (node, late - node[2] as i32)));
        let until = spread(&mut receivers());
        let low_back = spread(&mut receivers().map(|(node, early)| (node, node[2] as i32 + early)));
        let high_back = spread(&mut receivers().map(|(node, early)| (node, early - node[2] as i32)));
        let cone = |row: usize| Cone {
            from: from[row],
            until: until[row],
            low: low[row],
            high: high[row],
            low_back: low_back[row],
            high_back: high_back[row],
        };
        cones.rows = (0..nx * ny).map(cone).collect();
        let nearest = |of: &[i32]| of.iter().copied().min().unwrap_or(FAR);
        let plane = |(from, until): (&[i32], &[i32])| {
            // Each the other way round than in `span`, rounded to the side of more steps.
            [(nearest(from) - 1) / pace - 1, steps - (nearest(until) - 1).div_euclid(pace)]
        };
        cones.planes = from.chunks(ny).zip(until.chunks(ny)).map(plane).collect();
        cones
    }

    /// Makes all cones too narrow, to see that this shows.
    #[cfg(test)]
    pub fn narrow(&mut self, by: i32) {
        for cone in &mut self.rows {
            for distance in [&mut cone.from, &mut cone.low, &mut cone.high] {
                *distance += by;
            }
        }
    }

    /// Memory that it takes, bytes.
    pub fn bytes(cells: [usize; 3]) -> u64 {
        (cells[0] * (cells[1] * size_of::<Cone>() + size_of::<[i32; 2]>())) as u64
    }

    /// Whether a step touches any row of a plane (or may, where this is not known).
    #[inline(always)]
    pub fn touches(&self, i: usize, step: usize) -> bool {
        self.planes.get(i).is_none_or(|&[from, until]| (from..=until).contains(&(step as i32)))
    }

    /// First node and number of nodes of a row that a step must touch, whole vectors; `None` for none.
    #[inline(always)]
    pub fn span(&self, i: usize, j: usize, step: usize) -> Option<(usize, usize)> {
        let Some(cone) = self.rows.get(i * self.cells[1] + j) else { return Some((0, self.width)) };
        let k = step as i32;
        let (way, left) = (self.pace * (k + 1) + 1, self.pace * (self.steps - k) + 1);
        if cone.from > way || cone.until > left {
            return None;
        }
        let low = (cone.low - way).max(cone.low_back - left).max(0);
        let high = (way - cone.high).min(left - cone.high_back).min(self.cells[2] as i32 - 1);
        if low > high {
            return None;
        }
        let begin = low as usize / LANES * LANES;
        Some((begin, (high as usize + 1).next_multiple_of(LANES) - begin))
    }

    /// How much of a run is left out: counted exactly for up to four million rows times steps, from every 2nd, 3rd, … step
    /// beyond.
    pub fn reach(&self) -> Reach {
        let [nx, ny, nz] = self.cells;
        let Counted { nodes, steps, .. } = self.count();
        let all = nx * ny * self.width * steps;
        let share = if all > 0 { nodes as f64 / all as f64 } else { 1.0 };
        let cell_steps = share * (nx * ny * nz) as f64 * (self.steps.max(0) as usize + 1) as f64;
        Reach { share_saved: 1.0 - share, cell_steps: cell_steps.round() as u64 }
    }

    /// The share of the time of all cell-steps that the rest takes: a row costs what [`NODES_OF_A_ROW`] nodes do, and its
    /// nodes.
    pub fn share_of_time(&self) -> f64 {
        let [nx, ny, _] = self.cells;
        let Counted { rows, nodes, steps } = self.count();
        let all = nx * ny * (self.width + NODES_OF_A_ROW) * steps;
        if all > 0 { (rows * NODES_OF_A_ROW + nodes) as f64 / all as f64 } else { 1.0 }
    }

    fn count(&self) -> Counted {
        let [nx, ny, _] = self.cells;
        let steps = self.steps.max(0) as usize;
        let every = (nx * ny * steps / 4_000_000).max(1);
        let mut counted = Counted { rows: 0, nodes: 0, steps: 0 };
        for step in (0..steps).step_by(every) {
            counted.steps += 1;
            for i in (0..nx).filter(|&i| self.touches(i, step)) {
                for (_, nodes) in (0..ny).filter_map(|j| self.span(i, j, step)) {
                    counted.rows += 1;
                    counted.nodes += nodes;
                }
            }
        }
        counted
    }
}

/// What the counted steps touch.
struct Counted {
    rows: usize,
    nodes: usize,
    steps: usize,
}

/// Gives every row the least of all values plus the way from there, in rows.
fn spread(field: &mut [i32], nx: usize, ny: usize) {
    let mut pull = |row: usize, from: usize| field[row] = field[row].min(field[from].saturating_add(1));
    for i in 0..nx {
        for j in 0..ny {
            if i > 0 {
                pull(i * ny + j, (i - 1) * ny + j);
            }
            if j > 0 {
                pull(i * ny + j, i * ny + j - 1);
            }
        }
    }
    for i in (0..nx).rev() {
        for j in (0..ny).rev() {
            if i + 1 < nx {
                pull(i * ny + j, (i + 1) * ny + j);
            }
            if j + 1 < ny {
                pull(i * ny + j, i * ny + j + 1);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::borrow::Cow;

    use proptest::prelude::*;

    use super::*;
    use crate::model::{
        Axis, Excitation, Grid, HertzianDipole, Model, Receiver, Source, TimeWindow, Waveform, WaveformKind, paint3,
    };

    fn model(cells: [usize; 3], steps: usize, source: [usize; 3], receiver: [usize; 3]) -> Model {
        let mut model = Model::new("", Grid { cells, spacing: [0.002; 3] }, TimeWindow::Iterations(steps));
        model.pml_cells = Some([0; 6]);
        model.waveforms.push(Waveform { id: "w".into(), kind: WaveformKind::Ricker, amplitude: 1.0, frequency: 1e9 });
        let place = |node: [usize; 3]| node.map(|index| index as f64 * 0.002);
        let excitation = Excitation { start: 0.0, stop: None };
        let dipole = HertzianDipole { polarisation: Axis::Z, position: place(source), waveform: 0, excitation };
        model.sources.push(Source::HertzianDipole(dipole));
        model.receivers.push(Receiver { position: place(receiver), name: None });
        model
    }

    fn cones(model: &Model, skip: bool) -> Cones {
        Cones::new(&Setup3::new(model, Cow::Owned(paint3(model).unwrap())).unwrap(), skip)
    }

    /// The source's octahedron grows by a node a step and is rounded to vectors; the receiver's shrinks to it at the end.
    #[test]
    fn spans_are_those_of_two_octahedra() {
        let model = model([40, 50, 100], 61, [20, 25, 40], [20, 25, 41]);
        let cones = cones(&model, true);
        // Step 3 reaches five nodes away: 35..=45.
        assert_eq!(cones.span(20, 25, 3), Some((32, 16)));
        assert_eq!(cones.span(20, 25, 10), Some((16, 48)));
        // Four rows away one node is left; six rows away none is.
        assert_eq!(cones.span(22, 22, 3), Some((32, 16)));
        assert_eq!(cones.span(22, 21, 3), None);
        assert_eq!((cones.span(0, 0, 42), cones.span(0, 0, 43)), (None, None));
        // Of 60 steps the last one matters two nodes from the receiver.
        assert!(cones.span(21, 25, 59).is_some() && cones.span(20, 23, 59).is_some());
        assert!(cones.span(20, 22, 59).is_none() && !cones.touches(23, 59) && cones.touches(22, 59));
        assert!(!cones.touches(0, 10) && cones.touches(20, 0));
        assert!((0.8..1.0).contains(&cones.reach().share_saved), "{:?}", cones.reach());
    }

    /// Without skipping, all nodes of all rows are stepped and nothing is saved; without a receiver nothing is stepped.
    #[test]
    fn nothing_is_left_out_on_request() {
        let mut model = model([10, 12, 20], 30, [5, 6, 10], [5, 6, 10]);
        let all = cones(&model, false);
        assert_eq!((all.span(0, 0, 0), all.touches(3, 29), all.reach().share_saved), (Some((0, 32)), true, 0.0));
        assert_eq!(all.reach().cell_steps, 10 * 12 * 20 * 30);
        model.receivers.clear();
        assert_eq!(cones(&model, true).reach().share_saved, 1.0);
    }

    proptest! {
        /// Spreading gives every row the least value plus distance, and a plane is touched wherever one of its rows is.
        #[test]
        fn planes_and_rows_agree(
            seeds in prop::collection::vec(([0usize..9, 0..11, 0..40], 0i32..30), 1..5),
            ends in [[0usize..9, 0..11, 0..40], [0usize..9, 0..11, 0..40]], steps in 2usize..60,
        ) {
            let mut field = vec![FAR; 99];
            seeds.iter().for_each(|([i, j, _], v)| field[i * 11 + j] = field[i * 11 + j].min(*v));
            spread(&mut field, 9, 11);
            for (row, &found) in field.iter().enumerate() {
                let way = |[i, j, _]: [usize; 3]| (i.abs_diff(row / 11) + j.abs_diff(row % 11)) as i32;
                prop_assert_eq!(found, seeds.iter().map(|&(node, v)| v + way(node)).min().unwrap());
            }
            let [source, receiver] = ends.map(|[i, j, k]| [i.max(1), j.max(1), k]);
            let cones = cones(&model([9, 11, 40], steps, source, receiver), true);
            for step in 0..steps {
                for i in 0..9 {
                    let any = (0..11).any(|j| cones.span(i, j, step).is_some());
                    prop_assert!(cones.touches(i, step) || !any, "plane {} in step {}", i, step);
                }
            }
        }
    }
}
