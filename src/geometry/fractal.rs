//! Noise whose strength falls with a power of the frequency: volumes and surfaces alike at every scale.
//!
//! White noise is filtered with `1/f^D`, `D` being called the fractal dimension (Turcotte 1997, "Fractals and chaos in geology
//! and geophysics"; for soils Giannakis, Giannopoulos & Warren 2016, doi:10.1109/JSTARS.2015.2468597). The filter is
//! gprMax's: found by comparing the cells that gprMax 4.0.1 writes with those made here, which are the same.

use rayon::prelude::*;
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftDirection, FftPlanner};

use super::normal::Normal;

/// Noise in a volume, from 0 (its least) to 1 (its greatest), z fastest.
///
/// `weights` stretch it along x, y, z: the noise changes the less along an axis, the larger its weight. They hold for a cube,
/// that is, they are scaled by the shortest axis; an axis of a single cell (the first of several) counts as it is.
/// All zero where nothing changes, as in a single cell.
pub fn fractal_volume(shape: [usize; 3], weights: [f64; 3], dimension: f64, seed: u64) -> Vec<f64> {
    let single = shape.iter().position(|&count| count == 1);
    let rest = shape.iter().enumerate().filter(|(axis, _)| Some(*axis) != single).map(|(_, &count)| count);
    let shortest = rest.min().unwrap_or(1) as f64;
    let scaled = |axis: usize| match single {
        Some(single) if single == axis => weights[axis],
        _ => weights[axis] * (shortest / shape[axis] as f64),
    };
    noise(shape, std::array::from_fn(scaled), dimension, seed)
}

/// Noise on a rectangle, from 0 to 1, the second axis fastest; the weights are not scaled.
pub fn fractal_surface(shape: [usize; 2], weights: [f64; 2], dimension: f64, seed: u64) -> Vec<f64> {
    noise([shape[0], shape[1], 1], [weights[0], weights[1], 0.0], dimension, seed)
}

fn noise(shape: [usize; 3], weights: [f64; 3], dimension: f64, seed: u64) -> Vec<f64> {
    let count: usize = shape.iter().product();
    let mut normal = Normal::new(seed);
    let mut data: Vec<Complex<f64>> = (0..count).map(|_| Complex::new(normal.draw(), 0.0)).collect();
    let mut planner = FftPlanner::new();
    transform(&mut data, shape, &mut planner, FftDirection::Forward);
    // Squared distance along an axis from the middle of the spectrum, which begins at the most negative frequency.
    let squares: [Vec<f64>; 3] = std::array::from_fn(|axis| {
        let (n, weight) = (shape[axis], weights[axis]);
        let middle = weight * n as f64 / 2.0;
        (0..n).map(|k| (weight * ((k + n / 2) % n) as f64 - middle).powi(2)).collect()
    });
    let [_, ny, nz] = shape;
    data.par_chunks_mut((ny * nz).max(1)).zip(&squares[0]).for_each(|(plane, x)| {
        for (row, y) in plane.chunks_mut(nz).zip(&squares[1]) {
            for (value, z) in row.iter_mut().zip(&squares[2]) {
                let filter = (x + y + z).sqrt().powf(dimension);
                *value /= if filter == 0.0 { 0.9 } else { filter };
            }
        }
    });
    transform(&mut data, shape, &mut planner, FftDirection::Inverse);
    let real = |value: &Complex<f64>| value.re;
    let least = data.par_iter().map(real).reduce(|| f64::INFINITY, f64::min);
    let most = data.par_iter().map(real).reduce(|| f64::NEG_INFINITY, f64::max);
    let over = if most > least { most - least } else { 1.0 };
    data.into_par_iter().map(|value| (value.re - least) / over).collect()
}

/// Transforms along all three axes; not scaled.
fn transform(data: &mut Vec<Complex<f64>>, shape: [usize; 3], planner: &mut FftPlanner<f64>, direction: FftDirection) {
    let [mut a, mut b, mut c] = shape;
    for _ in 0..3 {
        let plan = planner.plan_fft(c, direction);
        data.par_chunks_mut(b * c).for_each(|plane| rows(plane, &*plan));
        // The last axis becomes the first: after three turns all are where they were.
        let from: &[Complex<f64>] = data;
        let mut turned = vec![Complex::new(0.0, 0.0); data.len()];
        turned.par_chunks_mut(a * b).enumerate().for_each(|(k, plane)| {
            plane.iter_mut().enumerate().for_each(|(row, value)| *value = from[row * c + k]);
        });
        *data = turned;
        (a, b, c) = (c, a, b);
    }
}

fn rows(plane: &mut [Complex<f64>], plan: &dyn Fft<f64>) {
    let mut scratch = vec![Complex::new(0.0, 0.0); plan.get_inplace_scratch_len()];
    plan.process_with_scratch(plane, &mut scratch);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(ours: &[f64], theirs: &[f64]) {
        for (ours, theirs) in ours.iter().zip(theirs) {
            assert!((ours - theirs).abs() < 1e-12, "{ours} {theirs}");
        }
    }

    /// The same filter in NumPy 2.4.6 on `default_rng(11)` and `default_rng(4)`, in a script that gives the cells which gprMax
    /// 4.0.1 writes; odd and even axes.
    #[test]
    fn noise_is_that_of_a_script_in_numpy() {
        let volume = fractal_volume([5, 4, 3], [1.0, 2.0, 0.5], 1.7, 11);
        close(
            &volume,
            &[0.37568242746180297, 0.8457556527887357, 0.8812715500164054, 0.41349988213275385, 0.7129871179530012],
        );
        close(&volume[58..], &[0.13897935485317983, 0.9361931855257107]);
        let surface = fractal_surface([6, 5], [1.0, 3.0], 1.2, 4);
        close(&surface, &[0.24873538574228227, 0.5840510979890075, 0.9743579581098875, 0.693708860062565]);
    }

    /// The larger the dimension, the smoother: the mean square of the difference of neighbours falls.
    #[test]
    fn noise_of_a_larger_dimension_is_smoother() {
        let roughness = |dimension: f64| {
            let noise = fractal_surface([64, 64], [1.0, 1.0], dimension, 3);
            noise.windows(2).map(|pair| (pair[0] - pair[1]).powi(2)).sum::<f64>()
        };
        let of = [0.0, 1.0, 2.0, 3.0].map(roughness);
        assert!(of.windows(2).all(|pair| pair[0] > 1.5 * pair[1]), "{of:?}");
        let noise = fractal_volume([7, 1, 1], [1.0; 3], 1.5, 0);
        assert!(noise.contains(&0.0) && noise.contains(&1.0));
        assert_eq!(fractal_volume([1, 1, 1], [1.0; 3], 1.5, 0), [0.0]);
    }
}
