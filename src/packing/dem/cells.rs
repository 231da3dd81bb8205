//! A grid of cells over the grains, and the pairs of grains that are near each other.

use super::vector::Four;

/// A grid whose cells are at least as wide as the reach of a pair.
#[derive(Debug)]
pub struct Cells {
    lower: [f64; 3],
    per_metre: [f64; 3],
    count: [usize; 3],
    /// The axes, the one with most cells first: cells along it are furthest apart in memory, so that the slice of cells
    /// between two neighbours along it is as small as can be.
    axes: [usize; 3],
    periodic: [bool; 3],
    starts: Vec<u32>,
}

/// Most cells per grain: enough for a loose bed, few enough that a stray grain does not fill the memory.
const CELLS_PER_GRAIN: usize = 8;

impl Cells {
    /// Lays a grid for a reach (m) over places inside a periodic box, where there is one.
    pub fn new(places: &[Four], reach: f64, periodic: [Option<[f64; 2]>; 2]) -> Self {
        let (mut lower, mut upper) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for place in places {
            for k in 0..3 {
                lower[k] = lower[k].min(place.0[k]);
                upper[k] = upper[k].max(place.0[k]);
            }
        }
        for (k, ends) in periodic.iter().enumerate() {
            if let Some([from, to]) = ends {
                (lower[k], upper[k]) = (*from, *to);
            }
        }
        let most = (CELLS_PER_GRAIN * places.len()).max(64);
        let mut width = reach;
        let mut count = [1; 3];
        if !places.is_empty() {
            loop {
                // Saturates on places far away.
                count = [0, 1, 2].map(|k| (((upper[k] - lower[k]) / width) as usize).max(1));
                if count[0].saturating_mul(count[1]).saturating_mul(count[2]) <= most {
                    break;
                }
                width *= 1.25;
            }
        }
        let per_metre = [0, 1, 2].map(|k| {
            let size = upper[k] - lower[k];
            if size > 0.0 { count[k] as f64 / size } else { 0.0 }
        });
        let periodic = [periodic[0].is_some(), periodic[1].is_some(), false];
        let mut axes = [2, 1, 0];
        axes.sort_by_key(|&k| std::cmp::Reverse(count[k]));
        Self { lower, per_metre, count, axes, periodic, starts: vec![] }
    }

    fn cell_along(&self, k: usize, at: f64) -> usize {
        (((at - self.lower[k]) * self.per_metre[k]) as usize).min(self.count[k] - 1)
    }

    /// The number of a cell from its places along the axes.
    fn index(&self, [far, middle, near]: [usize; 3]) -> usize {
        (far * self.count[self.axes[1]] + middle) * self.count[self.axes[2]] + near
    }

    fn cell(&self, place: &Four) -> usize {
        self.index(self.axes.map(|k| self.cell_along(k, place.0[k])))
    }

    /// Gives the order of the places by cell, stable; afterwards the grid is that of the places in this order.
    pub fn sort(&mut self, places: &[Four]) -> Vec<u32> {
        let cells = self.count.iter().product::<usize>();
        let of: Vec<u32> = places.iter().map(|place| self.cell(place) as u32).collect();
        self.starts = vec![0; cells + 1];
        for &cell in &of {
            self.starts[cell as usize + 1] += 1;
        }
        for cell in 0..cells {
            self.starts[cell + 1] += self.starts[cell];
        }
        let mut next = self.starts.clone();
        let mut order = vec![0; places.len()];
        for (i, &cell) in of.iter().enumerate() {
            order[next[cell as usize] as usize] = i as u32;
            next[cell as usize] += 1;
        }
        order
    }

    /// Cells beside a cell along an axis, itself among them; each once.
    fn beside(&self, k: usize, at: usize) -> ([usize; 3], usize) {
        let n = self.count[k];
        if self.periodic[k] && n > 2 {
            ([(at + n - 1) % n, at, (at + 1) % n], 3)
        } else if n <= 2 {
            ([0, 1, 0], n)
        } else {
            let (from, to) = (at.saturating_sub(1), (at + 1).min(n - 1));
            ([from, from + 1, to], to - from + 1)
        }
    }

    /// Lists the pairs `i < j` of sorted places whose surfaces are nearer than `skin`, grain by grain: the pairs of grain
    /// `i` are `starts[i]..starts[i + 1]` of the partners.
    pub fn pairs(&self, places: &[Four], skin: f64, period: &Period) -> (Vec<u32>, Vec<u32>) {
        let mut starts = Vec::with_capacity(places.len() + 1);
        let mut partners = Vec::with_capacity(4 * places.len());
        starts.push(0);
        let periodic = period.any();
        let mut ranges = [(0, 0); 27];
        for cell in 0..self.starts.len().saturating_sub(1) {
            let mine = self.starts[cell] as usize..self.starts[cell + 1] as usize;
            if mine.is_empty() {
                continue;
            }
            let [_, middles, nears] = self.axes.map(|k| self.count[k]);
            let at = [cell / nears / middles, cell / nears % middles, cell % nears];
            let [zs, ys, xs] = [0, 1, 2].map(|n| self.beside(self.axes[n], at[n]));
            let mut found = 0;
            for &z in &zs.0[..zs.1] {
                for &y in &ys.0[..ys.1] {
                    for &x in &xs.0[..xs.1] {
                        let other = self.index([z, y, x]);
                        let (from, to) = (self.starts[other] as usize, self.starts[other + 1] as usize);
                        if to > from.max(mine.start) {
                            ranges[found] = (from, to);
                            found += 1;
                        }
                    }
                }
            }
            for i in mine {
                let place = places[i];
                for &(from, to) in &ranges[..found] {
                    let after = from.max(i + 1)..to.max(i + 1);
                    for (j, other) in after.clone().zip(&places[after]) {
                        let mut d = [0, 1, 2].map(|k| place.0[k] - other.0[k]);
                        if periodic {
                            d = period.nearest(d);
                        }
                        let reach = place.w() + other.w() + skin;
                        if d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach * reach {
                            partners.push(j as u32);
                        }
                    }
                }
                starts.push(partners.len() as u32);
            }
        }
        (starts, partners)
    }
}

/// The periodic box: how wide it is along x and y, zero where it has no period.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Period {
    /// Widths, m.
    pub width: [f64; 2],
    per_metre: [f64; 2],
    lower: [f64; 2],
}

impl Period {
    /// Takes the ends of the box.
    pub fn new(ends: [Option<[f64; 2]>; 2]) -> Self {
        let width = ends.map(|ends| ends.map_or(0.0, |[from, to]| to - from));
        let per_metre = width.map(|width| if width > 0.0 { 1.0 / width } else { 0.0 });
        Self { width, per_metre, lower: ends.map(|ends| ends.map_or(0.0, |[from, _]| from)) }
    }

    /// Whether there is any.
    pub fn any(&self) -> bool {
        self.width != [0.0; 2]
    }

    /// The shortest of the images of a difference of places.
    #[inline(always)]
    pub fn nearest(&self, d: [f64; 3]) -> [f64; 3] {
        let turns = |k: usize| (d[k] * self.per_metre[k]).round_ties_even() * self.width[k];
        [d[0] - turns(0), d[1] - turns(1), d[2]]
    }

    /// How far a place is to be shifted into the box.
    pub fn shift_into_box(&self, place: [f64; 3]) -> [f64; 2] {
        [0, 1].map(|k| -((place[k] - self.lower[k]) * self.per_metre[k]).floor() * self.width[k])
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// The grid finds the pairs that trying all finds, with and without periods.
        #[test]
        fn the_grid_finds_every_pair(
            places in prop::collection::vec((0.0..1.0_f64, 0.0..0.7_f64, 0.0..1.5_f64, 0.02..0.1_f64), 1..80),
            periodic in any::<[bool; 2]>(),
        ) {
            let ends = [periodic[0].then_some([0.0, 1.0]), periodic[1].then_some([0.0, 0.7])];
            let period = Period::new(ends);
            let places: Vec<Four> = places.iter().map(|&(x, y, z, r)| Four([x, y, z, r])).collect();
            let skin = 0.01;
            let mut cells = Cells::new(&places, 0.2 + skin, ends);
            let order = cells.sort(&places);
            let sorted: Vec<Four> = order.iter().map(|&i| places[i as usize]).collect();
            let (starts, partners) = cells.pairs(&sorted, skin, &period);
            let mut found = vec![];
            for i in 0..sorted.len() {
                found.extend(partners[starts[i] as usize..starts[i + 1] as usize].iter().map(|&j| (i, j as usize)));
            }
            found.sort_unstable();
            let mut wanted = vec![];
            for i in 0..sorted.len() {
                for j in i + 1..sorted.len() {
                    let images = [-1.0, 0.0, 1.0];
                    let near = images.iter().any(|sx| images.iter().any(|sy| {
                        let d = [
                            sorted[i].0[0] - sorted[j].0[0] + sx * period.width[0],
                            sorted[i].0[1] - sorted[j].0[1] + sy * period.width[1],
                            sorted[i].0[2] - sorted[j].0[2],
                        ];
                        let reach = sorted[i].w() + sorted[j].w() + skin;
                        d.iter().map(|d| d * d).sum::<f64>() < reach * reach
                    }));
                    if near {
                        wanted.push((i, j));
                    }
                }
            }
            prop_assert_eq!(found, wanted);
        }
    }
}
