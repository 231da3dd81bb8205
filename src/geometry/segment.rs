//! How much of a disc lies in a horizontal band: exact areas of circular segments.

use super::disc::Disc;

/// Area of the part of a disc that lies below the horizontal line at `y`, m².
///
/// `A = R² (π/2 + asin t + t √(1 - t²))` with `t = (y - y_c)/R` held in -1…1: the circular segment.
pub fn area_below(disc: &Disc, y: f64) -> f64 {
    let t = ((y - disc.y) / disc.radius).clamp(-1.0, 1.0);
    disc.radius * disc.radius * (std::f64::consts::FRAC_PI_2 + t.asin() + t * (1.0 - t * t).sqrt())
}

/// Area of the part of a disc between the horizontal lines at `bottom` and `top`, m².
pub fn area_between(disc: &Disc, bottom: f64, top: f64) -> f64 {
    (area_below(disc, top) - area_below(disc, bottom)).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const DISC: Disc = Disc { x: 0.3, y: 1.0, radius: 2.0 };

    #[test]
    fn the_whole_the_half_and_nothing() {
        assert_eq!(area_below(&DISC, -1.0), 0.0);
        assert!((area_below(&DISC, 1.0) - DISC.area() / 2.0).abs() < 1e-14);
        assert!((area_below(&DISC, 9.0) - DISC.area()).abs() < 1e-14);
    }

    /// A segment of half-angle 60° (height R/2) has the area R² (π/3 - √3/4), any handbook.
    #[test]
    fn a_segment_of_sixty_degrees() {
        let segment = 4.0 * (std::f64::consts::FRAC_PI_3 - 3.0_f64.sqrt() / 4.0);
        assert!((area_below(&DISC, 0.0) - segment).abs() < 1e-14);
        assert!((area_between(&DISC, 0.0, 2.0) - (DISC.area() - 2.0 * segment)).abs() < 1e-13);
    }
}
