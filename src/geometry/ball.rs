//! The exact volume that a ball and a box have in common.

use std::f64::consts::{FRAC_PI_2, PI};

/// Volume of the ball of `radius` around the origin that lies in the box from `low` to `high`; any unit, cubed.
///
/// By inclusion and exclusion of what lies beyond the eight corners, each in closed form; a box on the other side of the
/// centre gives the same bits. The error is of the order of 1e-15 of the ball's volume, whatever the size of the box.
pub fn ball_box_volume(radius: f64, low: [f64; 3], high: [f64; 3]) -> f64 {
    let ends: [[f64; 2]; 3] = std::array::from_fn(|axis| {
        let [a, b] = [low[axis] / radius, high[axis] / radius];
        if a + b < 0.0 { [-b, -a] } else { [a, b] }
    });
    let [x, y, z] = ends;
    (column(x, y, z[0]) - column(x, y, z[1])).max(0.0) * radius.powi(3)
}

/// Volume of the unit ball around the origin within the column of rectangle `x` times `y`, beyond `z`.
///
/// The difference of two such volumes is that of a box; boxes that follow each other along z share one.
pub fn ball_column_volume(x: [f64; 2], y: [f64; 2], z: f64) -> f64 {
    let positive = |[a, b]: [f64; 2]| if a + b < 0.0 { [-b, -a] } else { [a, b] };
    column(positive(x), positive(y), z)
}

fn column(x: [f64; 2], y: [f64; 2], z: f64) -> f64 {
    let at = |i: usize, j: usize| beyond_three([x[i], y[j], z]);
    (at(0, 0) - at(0, 1)) - (at(1, 0) - at(1, 1))
}

/// Volume of the unit ball where `X > a`, `Y > b` and `Z > c`.
fn beyond_three([a, b, c]: [f64; 3]) -> f64 {
    if a < 0.0 {
        beyond_two(b, c) - beyond_three([-a, b, c])
    } else if b < 0.0 {
        beyond_two(a, c) - beyond_three([a, -b, c])
    } else if c < 0.0 {
        beyond_two(a, b) - beyond_three([a, b, -c])
    } else {
        corner(a, b, c)
    }
}

/// Volume of the unit ball where `X > a` and `Y > b`.
fn beyond_two(a: f64, b: f64) -> f64 {
    if a < 0.0 {
        beyond_one(b) - beyond_two(-a, b)
    } else if b < 0.0 {
        beyond_one(a) - beyond_two(a, -b)
    } else {
        2.0 * corner(a, b, 0.0)
    }
}

/// Volume of the unit ball where `X > a`: a cap.
fn beyond_one(a: f64) -> f64 {
    match a {
        a if a < 0.0 => 4.0 * PI / 3.0 - beyond_one(-a),
        a if a >= 1.0 => 0.0,
        a => PI / 3.0 * (1.0 - a).powi(2) * (2.0 + a),
    }
}

/// As [`beyond_three`], none of the three below zero.
///
/// A third of the flux of the place through the surface: one spherical triangle between three circles, whose area is
/// `sum alpha - pi - sum a phi_a` by Gauss and Bonnet (`alpha` the angles at its corners, `phi` those of its sides around
/// their circles), and three faces of discs cut twice.
fn corner(a: f64, b: f64, c: f64) -> f64 {
    if a * a + b * b + c * c >= 1.0 {
        return 0.0;
    }
    let over = |p: f64, q: f64| (1.0 - p * p - q * q).max(0.0).sqrt();
    let (ab, bc, ca) = (over(a, b), over(b, c), over(c, a));
    // The three angles, each `atan2(w, p q)` and not over a right one, added as arguments of complex numbers.
    let (re, im) = times(times((a * b, ab), (b * c, bc)), (c * a, ca));
    let turned = im.atan2(re);
    let angles = if turned < 0.0 { turned + 2.0 * PI } else { turned };
    // What is left of a right angle when those of both other planes are taken off.
    let side = |q: f64, wq: f64, r: f64, wr: f64| {
        let (re, im) = times((wq, q), (wr, r));
        re.atan2(im)
    };
    let sides = a * (3.0 - a * a) * side(b, ab, c, ca)
        + b * (3.0 - b * b) * side(c, bc, a, ab)
        + c * (3.0 - c * c) * side(a, ca, b, bc);
    let flat = a * b * ab + b * c * bc + c * a * ca - 3.0 * a * b * c;
    (angles - 2.0 * FRAC_PI_2 - 0.5 * sides + flat) / 3.0
}

fn times((a, b): (f64, f64), (c, d): (f64, f64)) -> (f64, f64) {
    (a * c - b * d, a * d + b * c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::disc_rectangle_area;
    use proptest::prelude::*;

    /// The whole ball, half, a quarter, an eighth, a cap and a small box inside.
    #[test]
    fn known_parts_of_a_ball() {
        let ball = 4.0 * PI / 3.0;
        let close = |low: [f64; 3], high: [f64; 3], exact: f64| {
            let found = ball_box_volume(1.0, low, high);
            assert!((found - exact).abs() < 1e-14, "{low:?} {high:?}: {found} {exact}");
        };
        close([-2.0; 3], [2.0; 3], ball);
        close([0.0, -2.0, -2.0], [2.0; 3], ball / 2.0);
        close([0.0, -2.0, 0.0], [2.0; 3], ball / 4.0);
        close([-2.0; 3], [0.0; 3], ball / 8.0);
        // A cap of height 0.3: pi h² (3 - h)/3.
        close([-2.0, 0.7, -2.0], [2.0; 3], PI * 0.09 * 2.7 / 3.0);
        close([-0.1, 0.2, -0.3], [0.2, 0.4, 0.1], 0.3 * 0.2 * 0.4);
        close([1.0, -1.0, -1.0], [2.0, 1.0, 1.0], 0.0);
        // Of a ball of 3: 27 times as much.
        assert!((ball_box_volume(3.0, [0.0; 3], [3.0; 3]) / (27.0 * ball / 8.0) - 1.0).abs() < 1e-14);
    }

    proptest! {
        /// Against Gauss-free sums: 400 slices of the exact area. A slice errs by less than its width times the rectangle.
        #[test]
        fn volume_is_the_sum_of_its_slices(at in prop::array::uniform3(-1.3..1.3f64), size in prop::array::uniform3(0.01..1.6f64)) {
            let high: [f64; 3] = std::array::from_fn(|axis| at[axis] + size[axis]);
            let n = 400;
            let mut sum = 0.0;
            for k in 0..n {
                let z = at[2] + size[2] * (f64::from(k) + 0.5) / f64::from(n);
                if z.abs() < 1.0 {
                    let radius = (1.0 - z * z).sqrt();
                    sum += disc_rectangle_area(radius, at[0], high[0], at[1], high[1]) * size[2] / f64::from(n);
                }
            }
            let volume = ball_box_volume(1.0, at, high);
            let tolerance = size[0].min(2.0) * size[1].min(2.0) * size[2] / f64::from(n) + 1e-14;
            prop_assert!((volume - sum).abs() < tolerance, "{} {}", volume, sum);
        }

        /// The other side of the centre has the same bits; other orders of the axes the same within rounding.
        #[test]
        fn volume_is_symmetric(at in prop::array::uniform3(-1.3..1.3f64), size in prop::array::uniform3(0.01..1.6f64)) {
            let high: [f64; 3] = std::array::from_fn(|axis| at[axis] + size[axis]);
            let volume = ball_box_volume(1.0, at, high);
            prop_assert_eq!(ball_box_volume(1.0, high.map(|v| -v), at.map(|v| -v)), volume);
            let turned = ball_box_volume(1.0, [at[2], at[0], at[1]], [high[2], high[0], high[1]]);
            prop_assert!((turned - volume).abs() < 1e-14);
        }
    }
}
