//! The sweep over near pairs: which touch, and what they do to each other.

use std::ops::Range;

use super::Notice;
use super::batch::{Batch, LANES};
use crate::packing::dem::cells::Period;
use crate::packing::dem::law::{Laws, Rolling};
use crate::packing::dem::vector::Four;

/// What the sweep reads: all grains and the list of near pairs.
pub struct ContactSweep<'a> {
    /// Centre and radius.
    pub place: &'a [Four],
    /// Velocity and mass.
    pub velocity: &'a [Four],
    /// Spin and rolling friction times radius.
    pub spin: &'a [Four],
    /// Material of each grain.
    pub material: &'a [u16],
    /// First pair of each grain.
    pub starts: &'a [u32],
    /// Other grain of each pair.
    pub partner: &'a [u32],
    /// What materials do to each other.
    pub laws: &'a Laws,
    /// The periodic box.
    pub period: Period,
    /// How rolling is resisted.
    pub rolling: Rolling,
    /// Time step, s.
    pub dt: f64,
}

/// What the sweep writes: the pairs `first..`, see [`Pairs`](crate::packing::dem::pairs::Pairs).
pub struct PairSlots<'a> {
    /// The first pair.
    pub first: usize,
    /// Whether they touch.
    pub touching: &'a mut [u8],
    /// Tangential history.
    pub history: &'a mut [Four],
    /// Rolling history.
    pub rolling: &'a mut [Four],
    /// Forces.
    pub force: &'a mut [Four],
    /// Moments.
    pub moment: &'a mut [Four],
    /// Rolling resistance.
    pub resistance: &'a mut [Four],
}

impl PairSlots<'_> {
    /// Forgets a contact that has opened.
    #[cold]
    fn clear(&mut self, slot: usize) {
        self.force[slot] = Four::default();
        for array in [&mut *self.history, &mut *self.rolling, &mut *self.moment, &mut *self.resistance] {
            if let Some(four) = array.get_mut(slot) {
                *four = Four::default();
            }
        }
    }
}

/// Computes the contacts of the pairs of `grains`.
///
/// Each pair writes its own slots only, and its numbers do not depend on which pairs are computed along with it, so that
/// the bits are the same however the grains are shared out.
#[inline(always)]
pub fn contacts<const FRICTION: bool, const PERIODIC: bool, const RESISTANCE: bool>(
    sweep: &ContactSweep<'_>,
    grains: Range<usize>,
    slots: &mut PairSlots<'_>,
    notice: &mut Notice,
) {
    let mut batch = Batch::EMPTY;
    for i in grains {
        let here = sweep.place[i].0;
        for pair in sweep.starts[i] as usize..sweep.starts[i + 1] as usize {
            let j = sweep.partner[pair] as usize;
            let there = sweep.place[j].0;
            let mut d = [here[0] - there[0], here[1] - there[1], here[2] - there[2]];
            if PERIODIC {
                d = sweep.period.nearest(d);
            }
            let reach = here[3] + there[3];
            let touch = d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach * reach;
            let slot = pair - slots.first;
            if slots.touching[slot] != u8::from(touch) {
                slots.touching[slot] = u8::from(touch);
                if !touch {
                    slots.clear(slot);
                }
            }
            batch.offer(slot, i, j, touch);
            if batch.count == LANES {
                batch.solve::<FRICTION, PERIODIC, RESISTANCE>(sweep, slots, notice);
                batch.count = 0;
            }
        }
    }
    if batch.count > 0 {
        batch.solve::<FRICTION, PERIODIC, RESISTANCE>(sweep, slots, notice);
    }
}
