//! Diameters of spheres from a sieve curve, by mass.

use std::f64::consts::PI;

use rand::RngExt as _;
use rand_pcg::Pcg64;

use crate::packing::grading::SizeClass;

/// Mean volume of the stones of a class whose mass is spread evenly over its diameters, m³.
///
/// With `dm/dD` constant the number goes as `D^-3`; so many stones per mass weigh on average
/// `pi/6 (b - a) / ((a^-2 - b^-2)/2)` for diameters from `a` to `b`.
fn mean_volume(class: &SizeClass) -> f64 {
    let (a, b) = (class.smallest.si(), class.largest.si());
    if b - a < 1e-9 * b {
        return PI / 6.0 * b.powi(3);
    }
    PI / 6.0 * (b - a) / (0.5 * (a.powi(-2) - b.powi(-2)))
}

/// Mean volume of a stone, by number, m³: the volume of a bed's stones over this is their number.
///
/// Shape: shares of the mass that add up to 1, as [`Grading::classes`](crate::packing::Grading::classes) gives them.
pub fn mean_stone_volume(classes: &[SizeClass]) -> f64 {
    // Stones per volume of stone add up over the classes.
    1.0 / classes.iter().map(|class| class.share.si() / mean_volume(class)).sum::<f64>()
}

/// Draws the diameters of `count` stones, m, coarsest class first.
///
/// Each class gets its number of stones by largest remainder. Within a class the mass is spread evenly over the diameters,
/// which keeps the curve straight between sieves; the draws are stratified, so that even some hundred stones follow it.
pub fn stone_diameters(classes: &[SizeClass], count: usize, random: &mut Pcg64) -> Vec<f64> {
    let per_volume: Vec<f64> = classes.iter().map(|class| class.share.si() / mean_volume(class)).collect();
    let whole: f64 = per_volume.iter().sum();
    let exact: Vec<f64> = per_volume.iter().map(|number| number / whole * count as f64).collect();
    let mut numbers: Vec<usize> = exact.iter().map(|number| number.floor() as usize).collect();
    let mut order: Vec<usize> = (0..classes.len()).collect();
    order.sort_by(|&i, &j| exact[j].fract().total_cmp(&exact[i].fract()));
    let missing = count.saturating_sub(numbers.iter().sum());
    for &class in order.iter().cycle().take(if classes.is_empty() { 0 } else { missing }) {
        numbers[class] += 1;
    }
    let mut diameters = Vec::with_capacity(count);
    for (class, number) in classes.iter().zip(numbers) {
        let (a, b) = (class.smallest.si().powi(-2), class.largest.si().powi(-2));
        for k in 0..number {
            let share = (k as f64 + random.random::<f64>()) / number as f64;
            diameters.push((a - share * (a - b)).powf(-0.5));
        }
    }
    diameters
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packing::{ClassReading, Grading};
    use crate::units::Metres;
    use rand::SeedableRng as _;

    /// 2,000 stones by number follow the curve by mass: within 0.5 % at and between the sieves, and their volume is their
    /// number times the mean. One stone in a stratum of 1/2000 leaves less than that.
    #[test]
    fn sizes_follow_the_curve_by_mass() {
        let grading = Grading::benedetto2018().unwrap();
        let classes = grading.classes(ClassReading::En933).unwrap();
        let diameters = stone_diameters(&classes, 2000, &mut Pcg64::seed_from_u64(3));
        assert_eq!(diameters.len(), 2000);
        let volume = |limit: f64| diameters.iter().filter(|d| **d <= limit).map(|d| PI / 6.0 * d.powi(3)).sum::<f64>();
        let total = volume(1.0);
        assert!((total / (2000.0 * mean_stone_volume(&classes)) - 1.0).abs() < 5e-3, "{total}");
        for size in [0.0315, 0.036, 0.04, 0.045, 0.05, 0.056, 0.063] {
            let (found, wanted) = (volume(size) / total, grading.passing_at(Metres(size)).si());
            assert!((found - wanted).abs() < 5e-3, "{size}: {found} {wanted}");
        }
    }

    /// Stones per cubic metre of solid of the tank's grading: against the integral of `dm / (pi/6 D³)` along the curve by the
    /// midpoint rule with 0.02 mm steps. The 0.3 % below the smallest sieve, which the classes give to the finest class, is
    /// taken at that class's own mean.
    #[test]
    fn the_number_of_stones_is_that_of_the_grading() {
        let grading = Grading::benedetto2018().unwrap();
        let classes = grading.classes(ClassReading::En933).unwrap();
        let number_between = |from: f64, to: f64| -> f64 {
            let steps = ((to - from) / 2e-5).round() as usize;
            let width = (to - from) / steps as f64;
            let passing = |d: f64| grading.passing_at(Metres(d)).si();
            (0..steps)
                .map(|k| from + k as f64 * width)
                .map(|d| (passing(d + width) - passing(d)) / (PI / 6.0 * (d + 0.5 * width).powi(3)))
                .sum()
        };
        let finest = number_between(0.0224, 0.0315);
        let wanted = number_between(0.0315, 0.063) + finest * 1.2 / 0.9;
        let found = 1.0 / mean_stone_volume(&classes);
        assert!((found / wanted - 1.0).abs() < 1e-3, "{found} {wanted}");
    }
}
