//! The exact area that a disc and a rectangle have in common.

/// Area of the disc of `radius` around the origin that lies in `[x0, x1] × [y0, y1]`; any unit, squared.
///
/// By inclusion and exclusion of four quarter planes, each in closed form.
pub fn disc_rectangle_area(radius: f64, x0: f64, x1: f64, y0: f64, y1: f64) -> f64 {
    let quarter = |x: f64, y: f64| below_and_left(radius, x, y);
    (quarter(x1, y1) - quarter(x0, y1) - quarter(x1, y0) + quarter(x0, y0)).max(0.0)
}

/// Area of the disc where `X <= x` and `Y <= y`.
fn below_and_left(r: f64, x: f64, y: f64) -> f64 {
    if x <= -r || y <= -r {
        return 0.0;
    }
    if x >= r {
        return left_of(r, y);
    }
    if y >= r {
        return left_of(r, x);
    }
    // The chord at `X` reaches from -sqrt(r²-X²) to min(y, sqrt(r²-X²)); `y` cuts it where |X| < sqrt(r²-y²).
    let reach = half_chord(r, y);
    let under = |a: f64| 0.5 * (a * half_chord(r, a) + r * r * a.atan2(half_chord(r, a)));
    let lower_half = |a: f64, b: f64| if b > a { under(b) - under(a) } else { 0.0 };
    if y >= 0.0 {
        // Both halves everywhere, the upper one cut to `y` in the middle.
        let from = -r;
        let mut area = lower_half(from, x);
        area += lower_half(from, x.min(-reach));
        let (a, b) = (-reach, x.min(reach));
        if b > a {
            area += y * (b - a);
        }
        area + lower_half(reach, x)
    } else {
        // Only where the disc reaches below `y`: |X| < reach.
        let (a, b) = (-reach, x.min(reach));
        if b > a { lower_half(a, b) + y * (b - a) } else { 0.0 }
    }
}

/// Area of the disc where `X <= x`.
fn left_of(r: f64, x: f64) -> f64 {
    if x <= -r {
        0.0
    } else if x >= r {
        std::f64::consts::PI * r * r
    } else {
        x * half_chord(r, x) + r * r * x.atan2(half_chord(r, x)) + 0.5 * std::f64::consts::PI * r * r
    }
}

/// Half the chord at a distance `a` from the centre. As a product it keeps its digits near the rim, where `r² - a²` and an
/// arc sine would lose half of them.
fn half_chord(r: f64, a: f64) -> f64 {
    ((r - a) * (r + a)).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn quarter_half_and_whole_disc() {
        let pi = std::f64::consts::PI;
        assert!((disc_rectangle_area(1.0, -2.0, 2.0, -2.0, 2.0) - pi).abs() < 1e-14);
        assert!((disc_rectangle_area(1.0, 0.0, 2.0, -2.0, 2.0) - pi / 2.0).abs() < 1e-14);
        assert!((disc_rectangle_area(1.0, 0.0, 2.0, 0.0, 2.0) - pi / 4.0).abs() < 1e-14);
        assert!((disc_rectangle_area(1.0, -0.1, 0.1, -0.1, 0.1) - 0.04).abs() < 1e-14);
        assert_eq!(disc_rectangle_area(1.0, 1.0, 2.0, 1.0, 2.0), 0.0);
    }

    proptest! {
        /// Against a sum over 400 chords, whose error is below the width of a chord times the height of the rectangle.
        #[test]
        fn area_is_the_sum_of_its_chords(x0 in -1.5..1.5f64, w in 0.01..2.0f64, y0 in -1.5..1.5f64, h in 0.01..2.0f64) {
            let (x1, y1) = (x0 + w, y0 + h);
            let n = 400;
            let mut sum = 0.0;
            for k in 0..n {
                let x: f64 = x0 + w * (k as f64 + 0.5) / n as f64;
                if x.abs() < 1.0 {
                    let half = (1.0 - x * x).sqrt();
                    sum += (y1.min(half) - y0.max(-half)).max(0.0) * w / n as f64;
                }
            }
            prop_assert!((disc_rectangle_area(1.0, x0, x1, y0, y1) - sum).abs() < 2.0 * w / n as f64);
        }
    }
}
