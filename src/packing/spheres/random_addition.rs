//! Random sequential addition of spheres in a box.

use rand::RngExt as _;
use rand::SeedableRng as _;
use rand_pcg::Pcg64;

use crate::geometry::{Sphere, SphereGrid};
use crate::packing::error::{PackingError, positive, rounded};
use crate::packing::grading::{ClassReading, Grading};
use crate::units::{Metres, Share};

use super::bed::SphereBed;
use super::sizes::{mean_stone_volume, stone_diameters};

/// Centres tried for one sphere before the box is said to be full.
const MOST_TRIES: usize = 200_000;

/// Most stones of one bed.
const MOST_STONES: usize = 5_000_000;

/// What a bed of random sequential addition is made from.
#[derive(Debug, Clone, PartialEq)]
pub struct RandomAddition {
    /// Length, width and height of the box.
    pub size: [Metres; 3],
    /// Whether the bed repeats itself along x and y.
    pub periodic: [bool; 2],
    /// The sieve curve, by mass.
    pub grading: Grading,
    /// Which diameters a sieve stands for.
    pub class_reading: ClassReading,
    /// Share of the box that is to be stone.
    ///
    /// Spheres of one size jam at 0.38 (Feder 1980 gives the plane's 0.547; Torquato, Uche & Stillinger 2006 the space's
    /// 0.384); walls take more. A bed of ballast has 0.55 to 0.62: this one is loose, and says so by its figures.
    pub solid_share: Share,
}

/// Makes a bed by random sequential addition: spheres at random places, none touching another, none resting on anything.
///
/// The same input and seed give the same spheres, bit for bit.
///
/// # Errors
/// Lengths and shares that are none, a stone larger than the box, too many stones, no room left.
pub fn random_addition(input: &RandomAddition, seed: u64) -> Result<SphereBed, PackingError> {
    let mut volume = 1.0;
    for (what, length) in ["length of the box", "width of the box", "height of the box"].into_iter().zip(input.size) {
        volume *= positive(what, length)?;
    }
    let share = input.solid_share.si();
    if !(share > 0.0 && share < 1.0) {
        return Err(PackingError::SolidShareOutOfRange { value: input.solid_share });
    }
    let classes = input.grading.classes(input.class_reading)?;
    let expected = share * volume / mean_stone_volume(&classes);
    if expected > MOST_STONES as f64 {
        let (smallest, largest) = classes.iter().fold((Metres(f64::MAX), Metres(0.0)), |(low, high), class| {
            (Metres(low.si().min(class.smallest.si())), Metres(high.si().max(class.largest.si())))
        });
        let (expected, limit) = (expected as u64, MOST_STONES as u64);
        return Err(PackingError::TooManyStones { expected, limit, smallest, largest });
    }
    let mut random = Pcg64::seed_from_u64(seed);
    let diameters = stone_diameters(&classes, (expected.round() as usize).max(1), &mut random);
    let spheres = place_spheres(diameters, input.size, input.periodic, &mut random)?;
    let mut bed = SphereBed::new("random-addition", Some(seed), input.size, spheres);
    bed.periodic = input.periodic;
    Ok(bed)
}

/// Places spheres of given diameters, m, at random in a box, the largest first, none touching another or a wall.
///
/// # Errors
/// A stone larger than the box; no room left, with how far it got.
pub fn place_spheres(
    mut diameters: Vec<f64>,
    size: [Metres; 3],
    periodic: [bool; 2],
    random: &mut Pcg64,
) -> Result<Vec<Sphere>, PackingError> {
    diameters.sort_by(|a, b| b.total_cmp(a));
    let largest = diameters.first().copied().unwrap_or(0.0);
    let box_size = size.map(Metres::si);
    if largest > box_size.into_iter().fold(f64::INFINITY, f64::min) {
        return Err(PackingError::StoneLargerThanBox { diameter: Metres(largest), size });
    }
    let wanted: f64 = diameters.iter().map(|d| volume(*d)).sum();
    let mut grid = SphereGrid::new(box_size, periodic, largest);
    for (number, diameter) in diameters.iter().enumerate() {
        let radius = 0.5 * diameter;
        let place = (0..MOST_TRIES).find_map(|_| {
            let centre = std::array::from_fn(|axis| {
                let rim = if axis < 2 && periodic[axis] { 0.0 } else { radius };
                rim + (box_size[axis] - 2.0 * rim) * random.random::<f64>()
            });
            let touches = |_: usize, other: &Sphere, way: [f64; 3]| {
                way.iter().map(|d| d * d).sum::<f64>() < (radius + other.radius).powi(2)
            };
            grid.find(centre, radius + 0.5 * largest, touches).is_none().then_some(centre)
        });
        let Some(centre) = place else {
            let whole: f64 = box_size.iter().product();
            let placed: f64 = diameters[..number].iter().map(|d| volume(*d)).sum();
            return Err(PackingError::BoxIsFull {
                diameter: Metres(*diameter),
                placed: number,
                stones: diameters.len(),
                solid_share: rounded(placed / whole),
                wanted: rounded(wanted / whole),
            });
        };
        grid.insert(Sphere { centre, radius });
    }
    Ok(grid.into_spheres())
}

fn volume(diameter: f64) -> f64 {
    std::f64::consts::PI / 6.0 * diameter.powi(3)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn input(share: f64) -> RandomAddition {
        RandomAddition {
            size: [Metres(0.4), Metres(0.3), Metres(0.3)],
            periodic: [false, true],
            grading: Grading::benedetto2018().unwrap(),
            class_reading: ClassReading::En933,
            solid_share: Share(share),
        }
    }

    #[test]
    fn the_same_seed_gives_the_same_bed_and_no_stone_touches_another() {
        let bed = random_addition(&input(0.28), 5).unwrap();
        assert_eq!(random_addition(&input(0.28), 5).unwrap(), bed);
        assert_ne!(random_addition(&input(0.28), 6).unwrap(), bed);
        assert!(bed.deepest_overlap().is_none());
        let share = bed.solid_volume() / 0.036;
        // 250 stones: the number is whole, and their sizes stratified.
        assert!((share / 0.28 - 1.0).abs() < 0.02, "{share}");
        assert!(bed.checked(Metres(0.0)).is_ok());
    }

    /// Random sequential addition of spheres cannot reach half of the volume.
    #[test]
    fn a_full_box_says_how_full_it_is() {
        let error = random_addition(&input(0.5), 1).unwrap_err();
        let PackingError::BoxIsFull { solid_share, .. } = error else { panic!("{error}") };
        assert!((0.3..0.42).contains(&solid_share.si()), "{error}");
        let small = RandomAddition { size: [Metres(0.4), Metres(0.05), Metres(0.3)], ..input(0.3) };
        assert_eq!(
            random_addition(&small, 1).unwrap_err().to_string().lines().next(),
            Some("stone larger than the box: stones reach 62.9 mm but the box is 0.4 m by 0.05 m by 0.3 m")
        );
    }
}
