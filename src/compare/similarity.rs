//! Structural similarity of two radargrams.

use super::error::CompareError;
use crate::trace::BScan;

/// Side of the window, samples and traces.
pub const SIMILARITY_WINDOW: usize = 7;

/// Computes the mean structural similarity (SSIM) of two radargrams, 1 for equal ones (Wang et al. 2004,
/// doi:10.1109/TIP.2003.819861).
///
/// Windows of 7 × 7 of equal weight, sample covariance, `K1 = 0.01`, `K2 = 0.03`, the dynamic range that of the first
/// radargram; only windows that lie inside. These are the defaults of scikit-image's `structural_similarity`.
///
/// # Errors
/// Different numbers of traces or samples, fewer than seven of either, a first radargram of one constant.
pub fn structural_similarity(a: &BScan, b: &BScan) -> Result<f64, CompareError> {
    let shape = |scan: &BScan| (scan.count(), scan.samples_per_trace());
    let least = shape(a).0.min(shape(a).1);
    if shape(a) != shape(b) || least < SIMILARITY_WINDOW {
        let ((traces_a, samples_a), (traces_b, samples_b)) = (shape(a), shape(b));
        return Err(CompareError::Shapes {
            a: a.name.clone(),
            traces_a,
            samples_a,
            b: b.name.clone(),
            traces_b,
            samples_b,
            least: SIMILARITY_WINDOW,
        });
    }
    let (low, high) = a.samples().iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    if low.is_nan() || high <= low {
        return Err(CompareError::AllZero { name: a.name.clone() });
    }
    let (c1, c2) = ((0.01 * (high - low)).powi(2), (0.03 * (high - low)).powi(2));
    let mean = |of: fn(f64, f64) -> f64| {
        let values: Vec<f64> = a.samples().iter().zip(b.samples()).map(|(a, b)| of(*a, *b)).collect();
        window_means(&values, a.samples_per_trace())
    };
    let (x, y) = (mean(|a, _| a), mean(|_, b| b));
    let (xx, yy, xy) = (mean(|a, _| a * a), mean(|_, b| b * b), mean(|a, b| a * b));
    let pixels = (SIMILARITY_WINDOW * SIMILARITY_WINDOW) as f64;
    let sample = pixels / (pixels - 1.0);
    let total: f64 = (0..x.len())
        .map(|k| {
            let (vx, vy) = (sample * (xx[k] - x[k] * x[k]), sample * (yy[k] - y[k] * y[k]));
            let vxy = sample * (xy[k] - x[k] * y[k]);
            (2.0 * x[k] * y[k] + c1) * (2.0 * vxy + c2) / ((x[k] * x[k] + y[k] * y[k] + c1) * (vx + vy + c2))
        })
        .sum();
    Ok(total / x.len() as f64)
}

/// Means over all windows that lie inside.
fn window_means(values: &[f64], samples: usize) -> Vec<f64> {
    let inside = samples - SIMILARITY_WINDOW + 1;
    let along: Vec<f64> = values
        .chunks_exact(samples)
        .flat_map(|trace| trace.windows(SIMILARITY_WINDOW).map(|window| window.iter().sum::<f64>()))
        .collect();
    let traces = values.len() / samples;
    let pixels = (SIMILARITY_WINDOW * SIMILARITY_WINDOW) as f64;
    let mut means = Vec::with_capacity(inside * (traces - SIMILARITY_WINDOW + 1));
    for first in 0..=traces - SIMILARITY_WINDOW {
        for sample in 0..inside {
            let sum: f64 = (first..first + SIMILARITY_WINDOW).map(|trace| along[trace * inside + sample]).sum();
            means.push(sum / pixels);
        }
    }
    means
}

#[cfg(test)]
mod tests {
    use super::super::steps::test_traces::{noise, ricker, trace};
    use super::*;

    fn line(level: f64, seed: u64) -> BScan {
        let traces: Vec<_> = (0..12_u64)
            .map(|k| {
                let mut one = trace("line", 200, 5e-11, |t| ricker(t - 4e-9 - 0.1e-9 * k as f64));
                one.samples.iter_mut().zip(noise(200, seed + k)).for_each(|(v, e)| *v += level * e);
                one
            })
            .collect();
        BScan::of(&traces, "line".into()).unwrap()
    }

    #[test]
    fn equal_radargrams_have_one_and_noise_takes_off() {
        let clean = line(0.0, 0);
        assert!((structural_similarity(&clean, &clean).unwrap() - 1.0).abs() < 1e-12);
        let found: Vec<f64> =
            [0.01, 0.1, 1.0].map(|level| structural_similarity(&clean, &line(level, 7)).unwrap()).into();
        assert!(found[0] > found[1] && found[1] > found[2] && found[0] < 1.0, "{found:?}");
    }

    #[test]
    fn other_shapes_are_refused() {
        let few = BScan::of(&[line(0.0, 0).trace(0).unwrap()], "few".into()).unwrap();
        assert_eq!(
            structural_similarity(&line(0.0, 0), &few).unwrap_err().to_string(),
            "`line` (12 traces of 200 samples) and `few` (1 of 200) have no structural similarity: both need the same shape and at least 7 of each"
        );
    }
}
