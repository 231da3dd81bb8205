//! Dynamic time warping in a band: how far apart two traces are when each echo may come a little early or late.

use super::error::CompareError;
use super::metrics::same_axis;
use crate::trace::AScan;
use crate::units::Seconds;

/// Most pairs of samples that are looked at: some seconds.
const MOST_PAIRS: f64 = 1e9;

/// How far apart two traces are after warping.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct TimeWarp {
    /// Sum of `|a(t) - b(s)|` along the best warping path, over the number of samples of one trace.
    pub distance: f64,
    /// The same without warping, the mean of `|a(t) - b(t)|`: never smaller.
    pub unwarped: f64,
    /// By how much `s` and `t` may differ.
    pub band: Seconds,
}

/// Computes the distance of dynamic time warping within a band: `D(i, j) = |a_i - b_j| + min(D(i-1, j), D(i, j-1),
/// D(i-1, j-1))`, from both first samples to both last ones, with `|i - j| dt <= band` (Sakoe and Chiba 1978,
/// doi:10.1109/TASSP.1978.1163055, with unit weights).
///
/// Time grows with the samples times the band, memory with the band. None where that would be more than 10^9 pairs.
///
/// # Errors
/// Different axes, no samples.
pub fn time_warp(a: &AScan, b: &AScan, band: Seconds) -> Result<Option<TimeWarp>, CompareError> {
    same_axis(a, b)?;
    let (x, y) = (&a.samples, &b.samples);
    let n = x.len();
    let half = (band.si() / a.time_step.si() + 1e-9).floor().clamp(0.0, (n - 1) as f64);
    if n as f64 * (2.0 * half + 1.0) > MOST_PAIRS {
        return Ok(None);
    }
    let unwarped = x.iter().zip(y).map(|(a, b)| (a - b).abs()).sum::<f64>() / n as f64;
    let distance = path_cost(x, y, half as usize) / n as f64;
    Ok(Some(TimeWarp { distance, unwarped, band: Seconds(half * a.time_step.si()) }))
}

/// Cost of the best path; row `i` holds `j` from `i - half` to `i + half`.
fn path_cost(x: &[f64], y: &[f64], half: usize) -> f64 {
    let width = 2 * half + 1;
    let mut above = vec![f64::INFINITY; width + 1];
    let mut row = vec![f64::INFINITY; width + 1];
    for (i, value) in x.iter().enumerate() {
        let mut left = f64::INFINITY;
        for k in 0..width {
            let Some(other) = (i + k).checked_sub(half).and_then(|j| y.get(j)) else {
                row[k] = f64::INFINITY;
                left = f64::INFINITY;
                continue;
            };
            // The same `j` lies one place further on in the row above, `j - 1` at the same place.
            let best = above[k + 1].min(above[k]).min(left);
            let start = i == 0 && i + k == half;
            left = (value - other).abs() + if start { 0.0 } else { best };
            row[k] = left;
        }
        std::mem::swap(&mut above, &mut row);
    }
    above[half]
}

#[cfg(test)]
mod tests {
    use super::super::steps::test_traces::{ricker, trace};
    use super::*;
    use proptest::prelude::*;

    /// The definition, with the whole matrix.
    fn plain(x: &[f64], y: &[f64], half: usize) -> f64 {
        let mut d = vec![vec![f64::INFINITY; y.len()]; x.len()];
        for i in 0..x.len() {
            for j in 0..y.len() {
                if i.abs_diff(j) > half {
                    continue;
                }
                let mut best = if (i, j) == (0, 0) { 0.0 } else { f64::INFINITY };
                if i > 0 {
                    best = d[i - 1][j].min(best);
                }
                if j > 0 {
                    best = d[i][j - 1].min(best);
                }
                if i > 0 && j > 0 {
                    best = d[i - 1][j - 1].min(best);
                }
                d[i][j] = (x[i] - y[j]).abs() + best;
            }
        }
        d[x.len() - 1][y.len() - 1]
    }

    proptest! {
        #[test]
        fn the_band_gives_the_plain_recursion(
            x in prop::collection::vec(-1.0..1.0_f64, 1..40),
            y in prop::collection::vec(-1.0..1.0_f64, 1..40),
            half in 0..50_usize,
        ) {
            let n = x.len().min(y.len());
            let (x, y) = (&x[..n], &y[..n]);
            let found = path_cost(x, y, half.min(n - 1));
            prop_assert!((found - plain(x, y, half)).abs() < 1e-12);
            // A wider band never costs more, the order of the traces does not matter, and a trace is at no distance from itself.
            prop_assert!(path_cost(x, y, (half + 3).min(n - 1)) <= found + 1e-12);
            prop_assert!((path_cost(y, x, half.min(n - 1)) - found).abs() < 1e-12);
            prop_assert_eq!(path_cost(x, x, half.min(n - 1)), 0.0);
        }
    }

    /// A pulse 0.3 ns late is nearly undone by a band of 0.5 ns and not by one of 0.1 ns.
    #[test]
    fn a_delay_within_the_band_is_undone() {
        let pulse = |at: f64| trace("pulse", 1000, 1e-11, move |t| ricker(t - at));
        let warped = |band: f64| time_warp(&pulse(4e-9), &pulse(4.3e-9), Seconds(band)).unwrap().unwrap();
        let (wide, narrow, none) = (warped(0.5e-9), warped(0.1e-9), warped(0.0));
        assert!(wide.distance < 0.02 * wide.unwarped, "{wide:?}");
        assert!(narrow.distance > 0.4 * narrow.unwarped, "{narrow:?}");
        assert_eq!(none.distance, none.unwarped);
        assert!((wide.band.si() - 0.5e-9).abs() < 1e-20);
    }

    #[test]
    fn a_band_of_too_many_pairs_is_left_out() {
        let long = trace("long", 200_000, 1e-13, |_| 1.0);
        assert_eq!(time_warp(&long, &long, Seconds(0.5e-9)), Ok(None));
    }
}
