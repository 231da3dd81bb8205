//! Sizing and positioning of the stones: equations 20–28 of Benedetto et al. 2018.

use rand::RngExt as _;
use rand_pcg::Pcg64;

use crate::geometry::{Disc, NeighbourGrid};
use crate::units::Metres;

use super::error::{PackingError, rounded};
use super::grading::SizeClass;
use super::void_cells::{Draw, VoidCells};

/// The most stones that one packing holds.
pub(super) const MOST_STONES: u64 = 20_000_000;

/// What was placed of one class.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ClassFilled {
    /// The class.
    pub class: SizeClass,
    /// Area that it should fill, `A_i` of eq. 20, m².
    pub wanted_area: f64,
    /// Area of the stones placed, m².
    pub placed_area: f64,
    /// Number of stones placed.
    pub stones: usize,
    /// Diameters that were drawn again because no room was left for them (the paper would search for ever).
    pub redrawn: usize,
}

/// Stones in a rectangle, none touching another.
pub(super) struct Placed {
    pub(super) discs: Vec<Disc>,
    pub(super) classes: Vec<ClassFilled>,
}

/// Draws and places stones, coarsest class first, until every class fills its area.
///
/// - Class area, eq. 20: `A_i = F_i P l h'`. `F_i` are sieve *masses*; reading them as areas is the method's 2-D
///   convention.
/// - Diameter, eq. 21: `D = D_min + (D_max - D_min)/100 · C`, `C` an integer from 0 to 100.
/// - Centre: redrawn until the stone touches no other, `d >= R_1 + R_2` (eqs. 24, 25; eq. 25 prints `d < s`), and lies in
///   the domain, `R <= x <= l - R`, `R <= y <= h' - R` (eqs. 26, 27 print the signs the wrong way round and test the
///   right and upper side only). [`VoidCells`] gives the same distribution with fewer draws.
/// - Next class, eq. 23: when `A_i < Σ <= A_i + π R_max²` (printed without the square); `Σ` is the class's own area, not
///   that of all stones (eq. 22 is ambiguous).
///
/// The order of the list is the order of placing. Where no room is left for a diameter (proven, see [`VoidCells`]), this
/// diameter and larger ones of the class are drawn no more, which [`ClassFilled::redrawn`] counts; when not even the
/// smallest fits, the domain is jammed.
///
/// # Errors
/// A stone larger than the domain, too many stones, a jam.
pub(super) fn place(
    classes: &[SizeClass],
    (width, height): (f64, f64),
    solid_share: f64,
    random: &mut Pcg64,
) -> Result<Placed, PackingError> {
    let largest = classes.iter().map(|class| class.largest.si()).fold(0.0, f64::max);
    if largest > width.min(height) {
        let to_a_tenth_of_a_millimetre = |length: f64| Metres((length * 1e4).round() / 1e4);
        let diameter = Metres(largest);
        let (width, height) = (to_a_tenth_of_a_millimetre(width), to_a_tenth_of_a_millimetre(height));
        return Err(PackingError::StoneLargerThanTank { diameter, width, height });
    }
    let wanted = |class: &SizeClass| class.share.si() * solid_share * width * height;
    for class in classes {
        let expected = expected_stones(class, wanted(class)).round() as u64;
        if expected > MOST_STONES {
            let (smallest, largest) = (class.smallest, class.largest);
            return Err(PackingError::TooManyStones { expected, limit: MOST_STONES, smallest, largest });
        }
    }
    let mut grid = NeighbourGrid::new(width, height, largest);
    let mut filled = Vec::new();
    for class in classes {
        let class = fill(class, wanted(class), (width, height), &mut grid, random).map_err(|placed| {
            let covered: f64 = grid.discs().iter().map(Disc::area).sum();
            PackingError::Jammed {
                smallest: class.smallest,
                largest: class.largest,
                placed: rounded(placed),
                solid_share: rounded(covered / (width * height)),
                wanted: rounded(solid_share),
            }
        })?;
        filled.push(class);
    }
    Ok(Placed { discs: grid.into_discs(), classes: filled })
}

/// How many stones of a class fill an area, for diameters spread evenly over the class.
fn expected_stones(class: &SizeClass, area: f64) -> f64 {
    let (smallest, largest) = (class.smallest.si(), class.largest.si());
    area / (std::f64::consts::PI / 12.0 * (smallest * smallest + smallest * largest + largest * largest))
}

/// Fills one class; on a jam returns the share of its area that was placed.
fn fill(
    class: &SizeClass,
    wanted_area: f64,
    domain: (f64, f64),
    grid: &mut NeighbourGrid,
    random: &mut Pcg64,
) -> Result<ClassFilled, f64> {
    let (smallest, largest) = (class.smallest.si(), class.largest.si());
    let mut cells = VoidCells::new(domain.0, domain.1, 0.5 * smallest, expected_stones(class, wanted_area));
    let mut filled = ClassFilled { class: *class, wanted_area, placed_area: 0.0, stones: 0, redrawn: 0 };
    let mut largest_step = 100_u32;
    while filled.placed_area <= wanted_area {
        let step = random.random_range(0..=100_u32);
        if step > largest_step {
            filled.redrawn += 1;
            continue;
        }
        let radius = 0.5 * (smallest + (largest - smallest) / 100.0 * f64::from(step));
        if let Some((x, y)) = find_centre(radius, &mut cells, grid, random) {
            let disc = Disc { x, y, radius };
            filled.placed_area += disc.area();
            filled.stones += 1;
            grid.insert(disc);
        } else if step == 0 {
            return Err(filled.placed_area / wanted_area);
        } else {
            filled.redrawn += 1;
            largest_step = step - 1;
        }
    }
    Ok(filled)
}

/// Finds a centre for one stone, or none when there is none.
///
/// The cells of the class serve first. After as many refusals as there are cells (and 100), cells for just this radius
/// are made from them, once; their making then costs no more than the refusals did. They end in a centre or in no cell.
fn find_centre(radius: f64, cells: &mut VoidCells, grid: &NeighbourGrid, random: &mut Pcg64) -> Option<(f64, f64)> {
    let patience = 100 + cells.count();
    for _ in 0..patience {
        match cells.draw(radius, grid, random) {
            Draw::Fits(x, y) => return Some((x, y)),
            Draw::Full => return None,
            Draw::Refused => {}
        }
    }
    let mut own = cells.for_larger(radius, grid);
    let patience = 10_000 + 1_000 * own.count();
    for _ in 0..patience {
        match own.draw(radius, grid, random) {
            Draw::Fits(x, y) => return Some((x, y)),
            Draw::Full => return None,
            Draw::Refused => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng as _;

    /// A unit square with a disc of radius 0.3 in its middle. The largest disc that fits beside it lies in a corner and
    /// touches two walls: √2 (0.5 - r) = 0.3 + r, r = 0.16863. The cells are those of a class that begins at 0.05, so that
    /// refusals run out and cells for just this radius are made.
    #[test]
    fn the_last_place_for_a_large_stone_of_a_class_is_found_or_disproven() {
        let corner = (0.5 * 2.0_f64.sqrt() - 0.3) / (1.0 + 2.0_f64.sqrt());
        let mut grid = NeighbourGrid::new(1.0, 1.0, 0.3);
        grid.insert(Disc { x: 0.5, y: 0.5, radius: 0.3 });
        let mut corners = [0; 4];
        for seed in 0..40 {
            let mut random = Pcg64::seed_from_u64(seed);
            let mut cells = VoidCells::new(1.0, 1.0, 0.05, 50.0);
            assert_eq!(find_centre(1.001 * corner, &mut cells, &grid, &mut random), None);
            let (x, y) = find_centre(0.995 * corner, &mut cells, &grid, &mut random).unwrap();
            corners[usize::from(x > 0.5) + 2 * usize::from(y > 0.5)] += 1;
        }
        // Each corner with probability 1/4: fewer than 2 of 40 in a given one happens once in 7 000 times.
        assert!(corners.iter().all(|&count| count >= 2), "{corners:?}");
    }
}
