//! Normal numbers as NumPy draws them.
//!
//! gprMax takes its random numbers from `numpy.random.default_rng(seed)`, so that a box made of many soils can only be made
//! again from its seed by drawing the same numbers. Three public algorithms make them: `SeedSequence` spreads the seed
//! (O'Neill 2015, "Developing a seed_seq alternative"), PCG-64 (O'Neill 2014) draws bits, and a ziggurat of 256 steps
//! (Marsaglia & Tsang 2000, doi:10.18637/jss.v005.i08, in the layout of Doornik 2005) makes normal numbers of them.

use rand::Rng as _;
use rand_pcg::Pcg64;

/// Where the tail of the ziggurat begins.
const TAIL: f64 = 3.654_152_885_361_009;
/// Area of each of its steps: `r f(r) + sqrt(pi/2) erfc(r/sqrt 2)` with `f(x) = exp(-x²/2)`.
const AREA: f64 = 0.004_928_673_233_974_655;
/// Steps of the ziggurat are cut into so many parts.
const PARTS: f64 = (1u64 << 52) as f64;

/// Draws normal numbers of mean 0 and variance 1: those of `numpy.random.default_rng(seed).standard_normal()`, to a few units
/// of the last place.
pub struct Normal {
    bits: Pcg64,
    /// Parts of each step that lie under the curve in any case.
    under: [u64; 256],
    /// Width of a part.
    width: [f64; 256],
    /// Height of the curve at the end of each step.
    height: [f64; 256],
}

impl Normal {
    /// Begins with a seed.
    pub fn new(seed: u64) -> Self {
        let [a, b, c, d] = spread(seed).map(u128::from);
        let (mut under, mut width, mut height) = ([0; 256], [0.0; 256], [1.0; 256]);
        let curve = |x: f64| (-0.5 * x * x).exp();
        let base = AREA / curve(TAIL);
        under[0] = (TAIL / base * PARTS) as u64;
        (width[0], width[255], height[255]) = (base / PARTS, TAIL / PARTS, curve(TAIL));
        let mut outer = TAIL;
        for step in (1..255).rev() {
            let inner = (-2.0 * (AREA / outer + curve(outer)).ln()).sqrt();
            under[step + 1] = (inner / outer * PARTS) as u64;
            (width[step], height[step]) = (inner / PARTS, curve(inner));
            outer = inner;
        }
        Self { bits: Pcg64::new(a << 64 | b, c << 64 | d), under, width, height }
    }

    /// A number from 0 to below 1.
    fn uniform(&mut self) -> f64 {
        (self.bits.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// The next number.
    pub fn draw(&mut self) -> f64 {
        loop {
            let bits = self.bits.next_u64();
            let (step, negative, part) = ((bits & 0xff) as usize, bits >> 8 & 1 == 1, bits >> 9 & ((1 << 52) - 1));
            let x = part as f64 * self.width[step];
            let signed = if negative { -x } else { x };
            if part < self.under[step] {
                return signed;
            }
            if step == 0 {
                return self.tail(part >> 8 & 1 == 1);
            }
            let (above, here) = (self.height[step - 1], self.height[step]);
            if (above - here) * self.uniform() + here < (-0.5 * x * x).exp() {
                return signed;
            }
        }
    }

    fn tail(&mut self, negative: bool) -> f64 {
        loop {
            let beyond = -(-self.uniform()).ln_1p() / TAIL;
            let level = -(-self.uniform()).ln_1p();
            if level + level > beyond * beyond {
                return if negative { -(TAIL + beyond) } else { TAIL + beyond };
            }
        }
    }
}

/// Spreads a seed over 256 bits.
fn spread(seed: u64) -> [u64; 4] {
    fn hash(value: u32, constant: &mut u32, factor: u32) -> u32 {
        let value = value ^ *constant;
        *constant = constant.wrapping_mul(factor);
        let value = value.wrapping_mul(*constant);
        value ^ value >> 16
    }
    let mut constant = 0x43b0_d7e5;
    let mut pool = [seed as u32, (seed >> 32) as u32, 0, 0].map(|word| hash(word, &mut constant, 0x931e_8875));
    for from in 0..4 {
        for to in (0..4).filter(|&to| to != from) {
            let mixed = hash(pool[from], &mut constant, 0x931e_8875);
            let both = 0xca01_f9dd_u32.wrapping_mul(pool[to]).wrapping_sub(0x4973_f715_u32.wrapping_mul(mixed));
            pool[to] = both ^ both >> 16;
        }
    }
    let mut constant = 0x8b51_f9dd;
    let words: [u32; 8] = std::array::from_fn(|word| hash(pool[word % 4], &mut constant, 0x58f3_8ded));
    std::array::from_fn(|pair| u64::from(words[2 * pair]) | u64::from(words[2 * pair + 1]) << 32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `numpy.random.default_rng(seed).standard_normal(n)` of NumPy 2.4.6: the first ones, and one out of the tail.
    #[test]
    fn numbers_are_those_of_numpy() {
        for (seed, first, place, far) in [
            (
                0u64,
                [0.1257302210933933, -0.1321048632913019, 0.6404226504432821, 0.10490011715303971],
                36758,
                4.731957688635529,
            ),
            (
                1u64,
                [0.345584192064786, 0.8216181435011584, 0.33043707618338714, -1.303157231604361],
                30266,
                4.406353522522504,
            ),
            (
                1099511627779u64,
                [-0.17721801709757748, -1.066969250545342, 1.2488199830485363, -0.5686661867267221],
                183412,
                -4.688487901997532,
            ),
        ] {
            let mut normal = Normal::new(seed);
            let drawn: Vec<f64> = (0..=place).map(|_| normal.draw()).collect();
            for (ours, theirs) in drawn.iter().zip(&first).chain([(&drawn[place], &far)]) {
                assert!((ours - theirs).abs() < 1e-13, "{seed}: {ours} {theirs}");
            }
        }
    }

    /// Mean 0 and variance 1: of 400 000 numbers within four standard errors, 4/sqrt(n) and 4 sqrt(2/n).
    #[test]
    fn numbers_are_normal() {
        let (count, mut normal) = (400_000, Normal::new(9));
        let (mut sum, mut squares) = (0.0, 0.0);
        (0..count).map(|_| normal.draw()).for_each(|x| (sum, squares) = (sum + x, squares + x * x));
        assert!((sum / count as f64).abs() < 0.0063 && (squares / count as f64 - 1.0).abs() < 0.009, "{sum} {squares}");
    }
}
