//! The slope of a heap.
//!
//! The rule: the surface is the height of the highest stone above each point of a square grid of an eighth of the mean
//! diameter, seen from above. Around the axis of the heap it is averaged over rings as wide as a quarter of the mean
//! diameter, in each of eight sectors. The height of the heap is the highest such mean within one diameter of the axis; in each
//! sector a straight line is fitted to the rings that lie between 20 % and 80 % of that height, inside the first ring that
//! falls below 20 %. The angle of repose is the mean of the eight slopes' angles.
//!
//! Heaps have a rounded top and a foot that runs out, so that this middle is their steepest part; beside it stands the angle of
//! the cone of the same height and volume.

use crate::geometry::Sphere;

/// Sectors around the axis.
pub const SECTORS: usize = 8;
/// Of the height of the heap, where the slope begins and ends.
pub const BETWEEN: [f64; 2] = [0.2, 0.8];

/// What is read off the surface of a heap.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Slope {
    /// Mean angle of the sectors that could be fitted, degrees.
    pub degrees: f64,
    /// Standard deviation between the sectors, degrees.
    pub spread: f64,
    /// Angle of each sector, degrees; NaN, as `null`, where fewer than three rings lie on the slope.
    pub sectors: Vec<Option<f64>>,
    /// Slope of the cone that has the height of the heap and the volume under its surface, degrees.
    pub cone_degrees: f64,
    /// Height of the heap, m.
    pub height: f64,
    /// Mean height over all sectors, by the radius of each ring, m.
    pub profile: Vec<[f64; 2]>,
}

/// Measures the slope of a heap around the vertical through `axis`, on a floor at z = 0.
///
/// `None` when no sector has a slope that can be fitted.
pub fn measure(stones: &[Sphere], axis: [f64; 2]) -> Option<Slope> {
    let diameter = 2.0 * stones.iter().map(|stone| stone.radius).sum::<f64>() / stones.len().max(1) as f64;
    let reach = stones
        .iter()
        .map(|stone| (stone.centre[0] - axis[0]).hypot(stone.centre[1] - axis[1]) + stone.radius)
        .fold(0.0, f64::max);
    if !(diameter > 0.0 && reach.is_finite()) {
        return None;
    }
    // Stones that rolled far away do not make the grid grow without end.
    let reach = reach.min(200.0 * diameter);
    let (grid, ring) = (diameter / 8.0, diameter / 4.0);
    let half = (reach / grid).ceil() as i64 + 1;
    let side = (2 * half + 1) as usize;
    let mut surface = vec![0.0_f64; side * side];
    for stone in stones {
        let at = [stone.centre[0] - axis[0], stone.centre[1] - axis[1]];
        let span = at.map(|v| {
            let ends = [(v - stone.radius) / grid, (v + stone.radius) / grid];
            [(ends[0].ceil() as i64).max(-half), (ends[1].floor() as i64).min(half)]
        });
        for j in span[1][0]..=span[1][1] {
            for i in span[0][0]..=span[0][1] {
                let [dx, dy] = [i as f64 * grid - at[0], j as f64 * grid - at[1]];
                let rest = stone.radius * stone.radius - dx * dx - dy * dy;
                if rest > 0.0 {
                    let cell = &mut surface[((j + half) as usize) * side + (i + half) as usize];
                    *cell = cell.max(stone.centre[2] + rest.sqrt());
                }
            }
        }
    }
    let rings = (reach / ring).ceil() as usize + 1;
    let mut sums = vec![[0.0_f64; 2]; SECTORS * rings];
    for (index, height) in surface.iter().enumerate() {
        let [x, y] = [(index % side) as f64 - half as f64, (index / side) as f64 - half as f64].map(|v| v * grid);
        let at = (x.hypot(y) / ring) as usize;
        if at < rings {
            let turn = (y.atan2(x) / std::f64::consts::TAU).rem_euclid(1.0);
            let sector = ((turn * SECTORS as f64) as usize).min(SECTORS - 1);
            let sum = &mut sums[sector * rings + at];
            *sum = [sum[0] + height, sum[1] + 1.0];
        }
    }
    fit(&sums, rings, ring, diameter)
}

fn fit(sums: &[[f64; 2]], rings: usize, ring: f64, diameter: f64) -> Option<Slope> {
    let radius = |at: usize| (at as f64 + 0.5) * ring;
    let mean = |of: [f64; 2]| if of[1] > 0.0 { of[0] / of[1] } else { f64::NAN };
    let profile: Vec<[f64; 2]> = (0..rings)
        .map(|at| {
            let all = (0..SECTORS).map(|sector| sums[sector * rings + at]);
            [radius(at), mean(all.fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]))]
        })
        .collect();
    let near = profile.iter().take_while(|[r, _]| *r < diameter.max(ring));
    let height = near.map(|[_, z]| *z).fold(0.0, f64::max);
    let sectors: Vec<Option<f64>> = (0..SECTORS)
        .map(|sector| {
            let heights = (0..rings).map(|at| [radius(at), mean(sums[sector * rings + at])]);
            let slope: Vec<[f64; 2]> = heights
                .filter(|[_, z]| z.is_finite())
                .take_while(|[_, z]| *z >= BETWEEN[0] * height)
                .filter(|[_, z]| *z <= BETWEEN[1] * height)
                .collect();
            line(&slope).map(|fall| (-fall).atan().to_degrees())
        })
        .collect();
    // Rings of a disc: 2 pi r dr; a cone of volume V and height h has the radius sqrt(3 V/(pi h)).
    let volume: f64 =
        profile.iter().filter(|[_, z]| z.is_finite()).map(|[r, z]| std::f64::consts::TAU * r * ring * z).sum();
    let cone_degrees = (height / (3.0 * volume / (std::f64::consts::PI * height)).sqrt()).atan().to_degrees();
    let found: Vec<f64> = sectors.iter().flatten().copied().collect();
    let spread = crate::study::MeanAndSpread::of(&found)?;
    Some(Slope { degrees: spread.mean, spread: spread.standard_deviation, sectors, cone_degrees, height, profile })
}

/// Slope of the straight line through points, by least squares; `None` with fewer than three.
pub(super) fn line(points: &[[f64; 2]]) -> Option<f64> {
    let n = points.len() as f64;
    let [sx, sy] = points.iter().fold([0.0; 2], |sum, point| [sum[0] + point[0], sum[1] + point[1]]);
    let sxx: f64 = points.iter().map(|[x, _]| (x - sx / n).powi(2)).sum();
    let sxy: f64 = points.iter().map(|[x, y]| (x - sx / n) * (y - sy / n)).sum();
    (points.len() >= 3 && sxx > 0.0).then_some(sxy / sxx)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Small stones set densely on cones of known slope, away from the origin: the angle comes back within half a degree
    /// (a lattice of 10 mm on a heap of 0.4 m), also where a part of the heap is missing.
    #[test]
    fn cones_have_their_slope() {
        for degrees in [20.0_f64, 33.7, 40.0] {
            let (axis, height, step) = ([0.3, -0.2], 0.4, 0.01);
            let fall = degrees.to_radians().tan();
            let reach = height / fall;
            let n = (reach / step) as i64;
            let mut stones = Vec::new();
            for j in -n..=n {
                for i in -n..=n {
                    let [x, y] = [i as f64 * step, j as f64 * step];
                    let z = height - fall * x.hypot(y);
                    if z > 0.0 {
                        stones.push(Sphere { centre: [axis[0] + x, axis[1] + y, z], radius: 0.01 });
                    }
                }
            }
            // A stone that rolled away, and one that lies near the foot.
            stones.push(Sphere { centre: [50.0, 3.0, 0.01], radius: 0.01 });
            stones.push(Sphere { centre: [axis[0] + reach + 0.05, axis[1], 0.01], radius: 0.01 });
            let found = measure(&stones, axis).unwrap();
            assert!((found.degrees - degrees).abs() < 0.5, "{degrees}: {found:?}");
            assert!(found.sectors.iter().all(|sector| sector.is_some_and(|angle| (angle - degrees).abs() < 1.0)));
            // A skin of half a stone makes the cone wider at its foot.
            assert!((found.cone_degrees - degrees).abs() < 2.0, "{degrees}: {}", found.cone_degrees);
            assert!((found.height - height).abs() < 0.02, "{}", found.height);
        }
    }

    #[test]
    fn what_is_no_heap_has_no_slope() {
        assert_eq!(measure(&[], [0.0; 2]), None);
        assert_eq!(
            measure(&[Sphere { centre: [0.0, 0.0, 0.01], radius: 0.01 }], [0.0; 2]).map(|s| s.degrees > 80.0),
            None
        );
        assert_eq!(line(&[[0.0, 1.0], [1.0, 3.0], [2.0, 5.0]]), Some(2.0));
        assert_eq!(line(&[[0.0, 1.0], [0.0, 3.0], [0.0, 5.0]]), None);
    }
}
