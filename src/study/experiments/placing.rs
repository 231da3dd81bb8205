//! Stones placed without overlap where they will fall from.

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::spec::SizeSpec;
use crate::geometry::Sphere;

/// Least width of a cell over the largest diameter: across, where stones need room to stand askew of those below, and upwards.
const CELL: [f64; 2] = [1.2, 1.02];

/// Strews stones over layers from the height `low[2]` upwards between the vertical planes at `low` and `high`, m, until `enough`
/// says so of what has been placed; `inside` may leave places out.
///
/// A layer is a square lattice, shifted at random, with one stone at a random place in each cell: stones that are set above each
/// other come to rest as towers, which rolling friction keeps upright. The same seed gives the same stones.
pub(super) fn strew(
    sizes: &SizeSpec,
    low: [f64; 3],
    high: [f64; 2],
    seed: u64,
    inside: impl Fn(&Sphere) -> bool,
    mut enough: impl FnMut(&[Sphere]) -> bool,
) -> Vec<Sphere> {
    let mut random = Pcg64::seed_from_u64(seed);
    let least = CELL.map(|share| share * sizes.largest.si());
    let across = [high[0] - low[0], high[1] - low[1]];
    // Half a cell of slack at least, unless there is but one.
    let count = across.map(|width| ((width / least[0] - 0.5).floor() as usize).max(1));
    let cell = [least[0].min(across[0]), least[0].min(across[1]), least[1]];
    let slack: [f64; 2] = std::array::from_fn(|axis| across[axis] - count[axis] as f64 * cell[axis]);
    let mut stones = Vec::new();
    // A funnel or a wedge may leave whole layers out, but never so many.
    for layer in 0..10_000 {
        let shift = slack.map(|slack| slack * random.random::<f64>());
        let first = [low[0] + shift[0], low[1] + shift[1], low[2]];
        for index in 0..count[0] * count[1] {
            if enough(&stones) {
                return stones;
            }
            let at = [index % count[0], index / count[0], layer];
            let diameter = sizes.draw(&mut random);
            let centre = std::array::from_fn(|axis| {
                let room = cell[axis] - diameter;
                first[axis] + at[axis] as f64 * cell[axis] + 0.5 * diameter + room * random.random::<f64>()
            });
            let stone = Sphere { centre, radius: 0.5 * diameter };
            if inside(&stone) {
                stones.push(stone);
            }
        }
    }
    stones
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::experiments::spec::EvenBy;
    use crate::units::Metres;

    #[test]
    fn strewn_stones_do_not_overlap_and_stay_within() {
        let sizes = SizeSpec { smallest: Metres(0.02), largest: Metres(0.05), even_by: EvenBy::Number };
        let strew = |seed| strew(&sizes, [0.1, 0.2, 0.3], [0.6, 0.9], seed, |_| true, |stones| stones.len() == 500);
        let stones = strew(3);
        assert_eq!(stones.len(), 500);
        for (k, a) in stones.iter().enumerate() {
            assert!(a.centre[0] - a.radius >= 0.1 && a.centre[0] + a.radius <= 0.6);
            assert!(a.centre[1] - a.radius >= 0.2 && a.centre[1] + a.radius <= 0.9 && a.centre[2] - a.radius >= 0.3);
            assert!(stones[..k].iter().all(|b| a.gap(b) > 0.0));
        }
        assert_eq!(strew(3), stones);
        assert_ne!(strew(4), stones);
    }
}
