//! The absorbing cells of differences of fourth order: profiles by place, memory by plane.

use super::super::real::Real;
use super::kernel::{ColumnProfile, RowProfile, absorb_columns_by, absorb_row_by};
use super::setup::{OTHERS, Setup3};

/// The four coefficients at each place along an axis, `None` outside the slabs, and which place of the memory is whose.
pub struct AxisProfile<T> {
    rows: Vec<Option<(usize, RowProfile<T>)>>,
    /// `RA - 1`, `RB`, `RE`, `RF` at each place, one after the other, for rows along the axis.
    columns: [Vec<T>; 4],
    /// The slabs at both ends: first place, how many, and where their memory begins.
    ends: [(usize, usize, usize); 2],
}

/// The profiles of E and H along x, y, z.
pub struct Profiles4<T> {
    e: [AxisProfile<T>; 3],
    h: [AxisProfile<T>; 3],
    pub ones: Vec<T>,
}

impl<T: Real> Profiles4<T> {
    /// Samples the slabs of a model.
    pub fn new(setup: &Setup3<'_>) -> Self {
        let of = |shift: f64| std::array::from_fn(|axis| AxisProfile::new(setup, axis, shift));
        let most = setup.painted.cells.iter().copied().max().unwrap_or(0) + 1;
        Self { e: of(0.0), h: of(0.5), ones: vec![T::of(1.0); most] }
    }

    pub fn e(&self) -> &[AxisProfile<T>; 3] {
        &self.e
    }

    pub fn h(&self) -> &[AxisProfile<T>; 3] {
        &self.h
    }
}

/// First place and number of places of the slabs at both ends of an axis.
fn ends(setup: &Setup3<'_>, axis: usize) -> [(usize, usize, usize); 2] {
    let (low, high, n) = (setup.slabs[axis].extent(), setup.slabs[axis + 3].cells, setup.painted.cells[axis]);
    [(0, low, 0), (n - high, high, low)]
}

/// Places of an axis that need memory.
fn slots(setup: &Setup3<'_>, axis: usize) -> usize {
    ends(setup, axis).iter().map(|end| end.1).sum()
}

impl<T: Real> AxisProfile<T> {
    fn new(setup: &Setup3<'_>, axis: usize, shift: f64) -> Self {
        let (low, high, n) = (&setup.slabs[axis], &setup.slabs[axis + 3], setup.painted.cells[axis]);
        let ends = ends(setup, axis);
        let at = |index: usize| {
            let place = index as f64 + shift;
            let below = low.cells as f64 - place;
            if low.cells > 0 && below >= 0.0 { low.at(below) } else { high.at(place - (n - high.cells) as f64) }
        };
        let slot = |index: usize| {
            ends.iter().find(|(first, count, _)| (*first..first + count).contains(&index)).map(|e| e.2 + index - e.0)
        };
        let row = |index: usize| {
            let [ra_less_one, rb, re, rf] = at(index).map(T::of);
            Some((slot(index)?, RowProfile { ra_less_one, rb, re, rf }))
        };
        let columns = std::array::from_fn(|of| (0..n).map(|index| T::of(at(index)[of])).collect());
        Self { rows: (0..=n).map(row).collect(), columns, ends }
    }
}

/// What a plane of a component remembers of its two differences.
pub struct Memory4<T> {
    /// Axis of each difference, and its numbers: all of a plane within a slab across x, rows of the slabs across y, ends of rows.
    parts: [(usize, Vec<T>); 2],
    run: usize,
    slots: usize,
}

/// The memory of all planes of each component.
pub struct Absorbing4<T> {
    pub e: [Vec<Memory4<T>>; 3],
    pub h: [Vec<Memory4<T>>; 3],
}

impl<T: Real> Absorbing4<T> {
    /// Allocates what the planes need.
    pub fn new(setup: &Setup3<'_>) -> Self {
        let [nx, ny, nz] = setup.painted.cells;
        let in_x = |i: usize| ends(setup, 0).iter().any(|(first, count, _)| (*first..first + count).contains(&i));
        let one = |component: usize| -> Vec<Memory4<T>> {
            let of_plane = |i: usize| {
                let part = |axis: usize| {
                    let numbers = match axis {
                        0 if in_x(i) => (ny + 1) * (nz + 1),
                        0 => 0,
                        1 => slots(setup, 1) * (nz + 1),
                        _ => (ny + 1) * slots(setup, 2),
                    };
                    (axis, vec![T::default(); numbers])
                };
                Memory4 { parts: OTHERS[component].map(part), run: nz + 1, slots: slots(setup, 2) }
            };
            (0..=nx).map(of_plane).collect()
        };
        Self { e: std::array::from_fn(one), h: std::array::from_fn(one) }
    }

    /// Memory that it takes, bytes.
    pub fn bytes(setup: &Setup3<'_>) -> u64 {
        let n = setup.painted.cells;
        let all: usize = (0..3).map(|axis| slots(setup, axis) * n[(axis + 1) % 3] * n[(axis + 2) % 3]).sum();
        (4 * all * size_of::<T>()) as u64
    }
}

impl<T: Real> Memory4<T> {
    /// Corrects a row by its two differences, along `axes`, that stand with `factors` in the curl.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "a row, its coefficients and its differences")]
    pub fn correct(
        &mut self,
        field: &mut [T],
        scale: &[T],
        axes: [usize; 2],
        factors: [T; 2],
        differences: &[Vec<T>; 2],
        profiles: &[AxisProfile<T>; 3],
        [i, j]: [usize; 2],
    ) {
        let run = field.len();
        for ((axis, factor), d) in axes.into_iter().zip(factors).zip(differences) {
            let profile = &profiles[axis];
            let Some((_, phi)) = self.parts.iter_mut().find(|(of, _)| *of == axis) else { continue };
            match axis {
                0 => {
                    if let Some((_, p)) = profile.rows[i] {
                        absorb_row_by(field, scale, (factor, d), &mut phi[j * self.run..][..run], p);
                    }
                }
                1 => {
                    if let Some((slot, p)) = profile.rows[j] {
                        absorb_row_by(field, scale, (factor, d), &mut phi[slot * self.run..][..run], p);
                    }
                }
                _ => {
                    for (first, count, slot) in profile.ends.into_iter().filter(|end| end.1 > 0) {
                        let count = count.min(run - first);
                        let phi = &mut phi[j * self.slots + slot..][..count];
                        let [ra_less_one, rb, re, rf] = profile.columns.each_ref().map(|list| &list[first..][..count]);
                        let (field, p) = (&mut field[first..][..count], ColumnProfile { ra_less_one, rb, re, rf });
                        absorb_columns_by(field, &scale[first..], (factor, &d[first..]), phi, p);
                    }
                }
            }
        }
    }
}
