//! The share of a box that lies on one side of a plane.

/// Share of a box of sizes `size` around the origin where `value + gradient · x < 0`, 0 to 1.
///
/// The plane is shifted into the corner where the sum begins; beyond each of the other corners a pyramid is taken off
/// (Scardovelli & Zaleski 2000, J. Comput. Phys. 164, 228-237, section 3). An axis along which the plane hardly tilts has no part.
pub fn half_space_share(value: f64, gradient: [f64; 3], size: [f64; 3]) -> f64 {
    let mut across: [f64; 3] = std::array::from_fn(|axis| (gradient[axis] * size[axis]).abs());
    across.sort_by(|a, b| b.total_cmp(a));
    let whole: f64 = across.iter().sum();
    let depth = 0.5 * whole - value;
    if depth <= 0.0 || whole == 0.0 {
        return if whole == 0.0 && value < 0.0 { 1.0 } else { 0.0 };
    }
    if depth >= whole {
        return 1.0;
    }
    // The smaller side keeps its digits.
    if depth > 0.5 * whole {
        return 1.0 - part(whole - depth, across);
    }
    part(depth, across)
}

/// As [`half_space_share`]: how far the plane has come into the box, and how far it goes along each axis, largest first.
fn part(depth: f64, [a, b, c]: [f64; 3]) -> f64 {
    let tiny = 1e-5 * a;
    let over = |of: f64| (depth - of).max(0.0);
    if b <= tiny {
        return (depth / a).min(1.0);
    }
    if c <= tiny {
        let square = |of: f64| over(of).powi(2);
        return (square(0.0) - square(a) - square(b) + square(a + b)) / (2.0 * a * b);
    }
    let cube = |of: f64| over(of).powi(3);
    let corners = cube(0.0) - cube(a) - cube(b) - cube(c) + cube(a + b) + cube(b + c) + cube(a + c);
    corners / (6.0 * a * b * c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn planes_across_an_edge_a_corner_and_a_face() {
        let share = |value, gradient| half_space_share(value, gradient, [2.0, 1.0, 1.0]);
        assert_eq!(share(-0.25, [1.0, 0.0, 0.0]), 0.625);
        assert!((share(0.0, [0.3, -0.4, 0.2]) - 0.5).abs() < 1e-14);
        // A pyramid of legs 0.5 at a corner: 1/48 of a volume of 2.
        assert!((share(1.5, [1.0, 1.0, 1.0]) - 1.0 / 96.0).abs() < 1e-14);
        assert_eq!((share(3.0, [1.0, 1.0, 1.0]), share(-3.0, [1.0, 1.0, 1.0])), (0.0, 1.0));
    }

    proptest! {
        /// Against columns of a hundred by a hundred, whose error is a few of their own widths squared.
        #[test]
        fn share_is_the_sum_of_columns(value in -1.0..1.0f64, gradient in prop::array::uniform3(-1.0..1.0f64)) {
            let n = 100;
            let place = |k: usize| (k as f64 + 0.5) / n as f64 - 0.5;
            let mut sum = 0.0;
            for i in 0..n {
                for j in 0..n {
                    let at = value + gradient[0] * place(i) + gradient[1] * place(j);
                    let low = at - 0.5 * gradient[2].abs();
                    sum += if gradient[2] == 0.0 { f64::from(at < 0.0) } else { (-low / gradient[2].abs()).clamp(0.0, 1.0) };
                }
            }
            let share = half_space_share(value, gradient, [1.0; 3]);
            prop_assert!((share - sum / (n * n) as f64).abs() < 0.02, "{} {}", share, sum);
        }
    }
}
