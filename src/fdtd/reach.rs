//! What no wave has reached yet, and what can no longer reach a receiver: neither is stepped.
//!
//! Step `k` makes H and E of each node from E of the step before. E at `(i, j)` takes Hy at `(i, j)` and `(i - 1, j)` and
//! Hx at `(i, j)` and `(i, j + 1)`; Hy at `(i, j)` takes E at `(i, j)` and `(i + 1, j)`, Hx E at `(i, j)` and `(i, j - 1)`
//! (places as in [`layout`](super::layout)). So E moves by one cell a step, along x or along y: distances are
//! `|di| + |dj|`. Conduction, the absorbing boundary and Debye memory join values of one node only. With differences of
//! fourth order E moves by up to three cells a step, one and a half by each of the two differences: distances are
//! `ceil(|di|/3) + ceil(|dj|/3)` steps.
//!
//! *Forwards.* All fields begin at zero, and a step makes zero from zero. A source that first acts at step `n` has moved
//! nothing farther away than `k - n` by the end of step `k`.
//!
//! *Backwards.* Of `N` samples the last is taken after step `N - 2`. E of step `k` bears on a sample only within `N - 2 - k`
//! of a receiver: true of the receiver's own node at `k = N - 2`, and one step earlier one node farther. H of step `k`
//! bears on such an E, or is a sample itself, at most one node farther: within `N - 1 - k`.
//!
//! A node is stepped where both hold, its distance being within `k - n` of some source and within `N - 1 - k` of some
//! receiver; every other value is still zero, or nobody looks at what follows from it. Hence the samples keep their bits.
//! (Skipped steps leave `+0` in the absorbing boundary's memory where others leave `±0`. It is added to fields that are
//! never `-0`, but for a field in a conductor that has decayed below the smallest number, so no sample can show it but as
//! the sign of a zero.)

use super::FdtdError;
use super::layout::{LANES, padded_width};
use super::setup::Setup;
use crate::model::{Model, Painted};

/// What need not be stepped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// Share of the cells times steps that is left out, in [0, 1].
    pub share_saved: f64,
    /// Cells times steps that are done.
    pub cell_steps: u64,
}

/// Tells how much of a run is left out because no wave is there that a receiver will see.
///
/// Counted exactly, whole vectors of 16 nodes included, for up to a million pairs of row and step; from every 2nd, 3rd, …
/// step beyond.
///
/// # Errors
/// Whatever the solver cannot do, as [`Fdtd::solve_stats`](super::Fdtd::solve_stats) would say it.
pub fn reach(model: &Model, painted: &Painted) -> Result<Reach, FdtdError> {
    Ok(Cones::new(&Setup::new(model, painted)?, true).reach())
}

/// For every row of the grid, which of its nodes a step must touch.
pub struct Cones {
    rows: Vec<Cone>,
    ny: i64,
    /// Cells that a value moves along y in a step.
    pace: i64,
    /// Steps, one fewer than samples.
    steps: i64,
}

/// The light cones of all sources and receivers, cut by one row.
#[derive(Clone, Copy)]
struct Cone {
    /// First step that moves the row.
    from: i64,
    /// Last step that a receiver feels.
    until: i64,
    /// Forwards, step `k` reaches `south - pace k ..= north + pace k`.
    south: i64,
    north: i64,
    /// Backwards, `k` steps before the end matters `south_back - pace k ..= north_back + pace k`.
    south_back: i64,
    north_back: i64,
    /// First step that touches every node.
    all_from: i64,
    /// Last step that does.
    all_until: i64,
}

/// Beyond any grid, and far enough from the limits of the type to be added to.
const FAR: i64 = i64::MAX / 8;

impl Cones {
    /// `skip`: false steps every node every time.
    pub fn new(setup: &Setup<'_>, skip: bool) -> Self {
        let [nx, ny] = setup.painted.cells_xy;
        let (steps, pace) = (setup.iterations as i64 - 1, setup.order.cells_per_step() as i64);
        let everything = Cone {
            from: 0,
            until: FAR,
            south: -FAR,
            north: FAR,
            south_back: -FAR,
            north_back: FAR,
            all_from: 0,
            all_until: FAR,
        };
        let nothing = Cone {
            from: FAR,
            until: -FAR,
            south: FAR,
            north: -FAR,
            south_back: FAR,
            north_back: -FAR,
            all_from: FAR,
            all_until: -FAR,
        };
        let mut rows = vec![if skip { nothing } else { everything }; nx + 1];
        if skip {
            for drive in &setup.drives {
                let Some(begin) = drive.series.iter().position(|&v| v != 0.0) else { continue };
                let (begin, j) = (begin as i64, drive.j as i64);
                for (i, cone) in rows.iter_mut().enumerate() {
                    let late = begin + i.abs_diff(drive.i).div_ceil(pace as usize) as i64;
                    cone.from = cone.from.min(late);
                    cone.south = cone.south.min(j + pace * late);
                    cone.north = cone.north.max(j - pace * late);
                }
            }
            for &[row, j, _] in &setup.receivers {
                for (i, cone) in rows.iter_mut().enumerate() {
                    let (away, j) = (i.abs_diff(row).div_ceil(pace as usize) as i64, j as i64);
                    cone.until = cone.until.max(steps - away);
                    cone.south_back = cone.south_back.min(j + pace * away);
                    cone.north_back = cone.north_back.max(j - pace * away);
                }
            }
        }
        let mut cones = Self { rows, ny: ny as i64, pace, steps };
        if skip {
            for row in 0..=nx {
                (cones.rows[row].all_from, cones.rows[row].all_until) = cones.all(&cones.rows[row]);
            }
        }
        cones
    }

    /// The first and the last step that touch every chunk of a row.
    fn all(&self, cone: &Cone) -> (i64, i64) {
        let (low, high) = (LANES as i64, padded_width(self.ny as usize) as i64 - LANES as i64 + 1);
        // Steps until the reach has moved on by as much as it lacks at either end.
        let lack = |south: i64, north: i64| {
            let lack = (south - low).max(high - north).max(0);
            lack / self.pace + i64::from(lack % self.pace != 0)
        };
        let (forwards, backwards) = (lack(cone.south, cone.north), lack(cone.south_back, cone.north_back));
        (forwards.max(cone.from), (self.steps - backwards).min(cone.until))
    }

    /// First node and number of nodes of a row that a step must touch, whole vectors; `None` for none.
    #[inline(always)]
    pub fn span(&self, row: usize, step: usize) -> Option<(usize, usize)> {
        let (cone, k) = (&self.rows[row], step as i64);
        if k < cone.from || k > cone.until {
            return None;
        }
        if k >= cone.all_from && k <= cone.all_until {
            return Some((1, padded_width(self.ny as usize)));
        }
        let (gone, left) = (self.pace * k, self.pace * (self.steps - k));
        let low = (cone.south - gone).max(cone.south_back - left).max(1);
        let high = (cone.north + gone).min(cone.north_back + left).min(self.ny);
        if low > high {
            return None;
        }
        let begin = (low as usize - 1) / LANES * LANES;
        Some((1 + begin, (high as usize).next_multiple_of(LANES) - begin))
    }

    /// Nodes times steps of every row, from a sample of the steps; the number of steps that one of the sample stands for.
    pub fn work_per_row(&self) -> (Vec<u64>, usize) {
        let every = (self.rows.len() * self.steps.max(0) as usize / 1_000_000).max(1);
        let steps = || (0..self.steps.max(0) as usize).step_by(every);
        let of_row = |row| steps().filter_map(|step| self.span(row, step)).map(|(_, count)| count as u64).sum();
        ((0..self.rows.len()).map(of_row).collect(), every)
    }

    /// The sum over the rows that are stepped.
    pub fn reach(&self) -> Reach {
        let (work, every) = self.work_per_row();
        let done: u64 = work[..work.len() - 1].iter().sum();
        let steps = (self.steps.max(0) as usize).div_ceil(every);
        let rows = work.len() - 1;
        let all = (rows * padded_width(self.ny as usize) * steps) as f64;
        let share = if all > 0.0 { done as f64 / all } else { 1.0 };
        let cell_steps = share * (rows as i64 * self.ny * (self.steps + 1)) as f64;
        Reach { share_saved: 1.0 - share, cell_steps: cell_steps.round() as u64 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{
        Axis, Excitation, Grid, HertzianDipole, Model, Receiver, Source, TimeWindow, Waveform, WaveformKind, paint,
    };

    /// 100 x 200 cells of 2 mm, a source that acts from step 0 on at (50, 60), a receiver at `receiver`.
    fn model(steps: usize, receiver: [usize; 2]) -> Model {
        let grid = Grid { cells: [100, 200, 1], spacing: [0.002; 3] };
        let mut model = Model::new("", grid, TimeWindow::Iterations(steps));
        model.waveforms.push(Waveform { id: "w".into(), kind: WaveformKind::Ricker, amplitude: 1.0, frequency: 1e9 });
        let at = |[i, j]: [usize; 2]| [i as f64 * 0.002, j as f64 * 0.002, 0.0];
        let excitation = Excitation { start: 0.0, stop: None };
        let dipole = HertzianDipole { polarisation: Axis::Z, position: at([50, 60]), waveform: 0, excitation };
        model.sources.push(Source::HertzianDipole(dipole));
        model.receivers.push(Receiver { position: at(receiver), name: None });
        model
    }

    /// By hand: 40 samples are 39 steps. Step 0 touches the source's node (in the vector of nodes 49 to 64). Step 19 touches
    /// the rows 31 to 69 of which 25 to 65 matter, and at row 55 the nodes 46 to 74 of which 50 to 70 matter. Step 38 matters
    /// within one node of the receiver.
    #[test]
    fn cones_open_and_close() {
        let model = model(40, [45, 60]);
        let painted = paint(&model).unwrap();
        let cones = Cones::new(&Setup::new(&model, &painted).unwrap(), true);
        let rows = |step| -> Vec<usize> { (0..=100).filter(|&row| cones.span(row, step).is_some()).collect() };
        assert_eq!(rows(0), [50]);
        assert_eq!(cones.span(50, 0), Some((49, 16)));
        assert_eq!((rows(19).first(), rows(19).last()), (Some(&31), Some(&65)));
        assert_eq!(cones.span(55, 19), Some((49, 32)));
        assert_eq!(rows(38), [44, 45, 46]);
    }

    /// A receiver that the wave cannot reach in time needs no step at all: 40 cells away, 39 steps and one for Hx.
    #[test]
    fn nothing_is_stepped_in_vain() {
        let saved = |steps, receiver| {
            let model = model(steps, receiver);
            reach(&model, &paint(&model).unwrap()).unwrap()
        };
        let in_vain = saved(40, [50, 140]);
        assert_eq!((in_vain.share_saved, in_vain.cell_steps), (1.0, 0));
        // Two cones over 30 000 steps: what they save is within the first and last 150 of them.
        let long = saved(30_000, [50, 60]);
        assert!(long.share_saved > 0.0 && long.share_saved < 300.0 / 30_000.0, "{long:?}");
    }
}
