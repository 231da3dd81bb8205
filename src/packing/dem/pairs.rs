//! The list of near pairs, with what each contact remembers and does.

use super::grains::Grains;
use super::vector::Four;

/// Near pairs, those of one grain side by side; each pair is at the grain of the earlier turn.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Pairs {
    /// The pairs of grain `i` are `starts[i]..starts[i + 1]`.
    pub starts: Vec<u32>,
    /// The other grain of each pair.
    pub partner: Vec<u32>,
    /// The pairs in which grain `i` is the other one are `incoming[incoming_starts[i]..incoming_starts[i + 1]]`.
    pub incoming_starts: Vec<u32>,
    /// See `incoming_starts`.
    pub incoming: Vec<u32>,
    /// One where the grains of the pair touched in the last step.
    pub touching: Vec<u8>,
    /// Elastic tangential force on the first grain, N, and overlap, m; without friction there is none.
    pub history: Vec<Four>,
    /// Elastic rolling torque on the first grain, N m; only with the rolling spring.
    pub rolling: Vec<Four>,
    /// Force on the first grain, N, and bound of the rolling friction, N m.
    pub force: Vec<Four>,
    /// Force × normal, N, and overlap, m; without friction there is none. Times the lever of either grain it is its torque.
    pub moment: Vec<Four>,
    /// Torque of rolling resistance on the first grain, N m; only with models that have it contact by contact.
    pub resistance: Vec<Four>,
}

/// Which arrays a simulation needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Needs {
    /// Tangential history and moments.
    pub friction: bool,
    /// A torque of resistance for each contact.
    pub resistance: bool,
    /// A rolling spring.
    pub rolling_spring: bool,
}

impl Pairs {
    /// Makes the list from pairs found; nothing touches yet.
    pub fn new(starts: Vec<u32>, partner: Vec<u32>, needs: Needs) -> Self {
        let grains = starts.len() - 1;
        let mut incoming_starts = vec![0_u32; grains + 1];
        for &j in &partner {
            incoming_starts[j as usize + 1] += 1;
        }
        for i in 0..grains {
            incoming_starts[i + 1] += incoming_starts[i];
        }
        let mut next = incoming_starts.clone();
        let mut incoming = vec![0; partner.len()];
        for (pair, &j) in partner.iter().enumerate() {
            incoming[next[j as usize] as usize] = pair as u32;
            next[j as usize] += 1;
        }
        let mut made = Self { starts, partner, incoming_starts, incoming, ..Self::default() };
        made.touching = vec![0; made.partner.len()];
        made.fit(needs);
        made
    }

    /// Gives the arrays that are needed their length and drops the others.
    pub fn fit(&mut self, needs: Needs) {
        let count = self.partner.len();
        let fit = |array: &mut Vec<Four>, needed: bool| array.resize(if needed { count } else { 0 }, Four::default());
        fit(&mut self.force, true);
        fit(&mut self.moment, needs.friction);
        fit(&mut self.history, needs.friction);
        fit(&mut self.resistance, needs.resistance);
        fit(&mut self.rolling, needs.rolling_spring);
    }

    /// The contacts with their first grain.
    pub fn touching(&self) -> impl Iterator<Item = (usize, usize)> {
        let firsts = self.starts.windows(2).enumerate();
        firsts
            .flat_map(|(i, ends)| (ends[0] as usize..ends[1] as usize).map(move |pair| (i, pair)))
            .filter(|&(_, pair)| self.touching[pair] == 1)
    }

    /// What the contacts remember, by the numbers of their grains.
    pub fn memory(&self, grains: &Grains) -> PairMemory {
        let mut kept: Vec<Kept> = Vec::new();
        for (i, pair) in self.touching() {
            let (a, b) = (grains.id[i], grains.id[self.partner[pair] as usize]);
            let sign = if a < b { 1.0 } else { -1.0 };
            let turned = |array: &[Four]| array.get(pair).map_or(Four::default(), |four| flip(*four, sign));
            let (history, rolling, force) = (turned(&self.history), turned(&self.rolling), turned(&self.force));
            kept.push(Kept { ids: [a.min(b), a.max(b)], history, rolling, force });
        }
        kept.sort_unstable_by_key(|kept| kept.ids);
        PairMemory(kept)
    }

    /// Takes over what contacts remember.
    pub fn remember(&mut self, grains: &Grains, memory: &PairMemory) {
        for i in 0..self.starts.len() - 1 {
            for pair in self.starts[i] as usize..self.starts[i + 1] as usize {
                let (a, b) = (grains.id[i], grains.id[self.partner[pair] as usize]);
                let sign = if a < b { 1.0 } else { -1.0 };
                let ids = [a.min(b), a.max(b)];
                let Ok(found) = memory.0.binary_search_by_key(&ids, |kept| kept.ids) else { continue };
                let kept = &memory.0[found];
                self.touching[pair] = 1;
                self.force[pair] = flip(kept.force, sign);
                if let Some(history) = self.history.get_mut(pair) {
                    *history = flip(kept.history, sign);
                }
                if let Some(rolling) = self.rolling.get_mut(pair) {
                    *rolling = flip(kept.rolling, sign);
                }
            }
        }
    }
}

fn flip(four: Four, sign: f64) -> Four {
    let [x, y, z, w] = four.0;
    if sign < 0.0 { Four([-x, -y, -z, w]) } else { four }
}

struct Kept {
    ids: [u32; 2],
    history: Four,
    rolling: Four,
    /// For reports between this step and the next.
    force: Four,
}

/// What contacts remember while the grains change their order, seen from the grain of the lower number.
pub struct PairMemory(Vec<Kept>);
