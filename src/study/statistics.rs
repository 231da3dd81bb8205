//! Mean and spread of repeated figures, and the exponent of a power law.

/// Mean and standard deviation of a sample.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct MeanAndSpread {
    /// Number of figures.
    pub count: usize,
    /// Mean.
    pub mean: f64,
    /// Standard deviation of the sample (n - 1); zero for a single figure.
    pub standard_deviation: f64,
}

impl MeanAndSpread {
    /// Of a sample; `None` when it is empty.
    pub fn of(figures: &[f64]) -> Option<Self> {
        let count = figures.len();
        if count == 0 {
            return None;
        }
        let mean = figures.iter().sum::<f64>() / count as f64;
        let squares: f64 = figures.iter().map(|figure| (figure - mean).powi(2)).sum();
        let standard_deviation = if count > 1 { (squares / (count - 1) as f64).sqrt() } else { 0.0 };
        Some(Self { count, mean, standard_deviation })
    }
}

/// Exponent `p` and factor `a` of the power law `y = a x^p` through points, by least squares on logarithms.
///
/// `None` with fewer than two distinct positive points.
pub fn fit_exponent(points: &[(f64, f64)]) -> Option<(f64, f64)> {
    let logs: Vec<(f64, f64)> =
        points.iter().filter(|(x, y)| *x > 0.0 && *y > 0.0).map(|(x, y)| (x.ln(), y.ln())).collect();
    let n = logs.len() as f64;
    let (sx, sy) = logs.iter().fold((0.0, 0.0), |(sx, sy), (x, y)| (sx + x, sy + y));
    let (mx, my) = (sx / n, sy / n);
    let sxx: f64 = logs.iter().map(|(x, _)| (x - mx).powi(2)).sum();
    if logs.len() < 2 || sxx <= 0.0 {
        return None;
    }
    let sxy: f64 = logs.iter().map(|(x, y)| (x - mx) * (y - my)).sum();
    let p = sxy / sxx;
    Some((p, (my - p * mx).exp()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_spread_of_the_counts_on_the_tank_walls() {
        // Benedetto 2018, 5.2.1: 198, 202, 203, 207: mean 202.5; the population's deviation is 3.20, the sample's 3.70.
        let found = MeanAndSpread::of(&[198.0, 202.0, 203.0, 207.0]).unwrap();
        assert_eq!(found.mean, 202.5);
        assert!((found.standard_deviation - 3.201 * (4.0f64 / 3.0).sqrt()).abs() < 1e-3);
        assert_eq!(MeanAndSpread::of(&[]), None);
    }

    #[test]
    fn a_power_law_gives_its_exponent() {
        let points: Vec<_> = [1.0, 2.0, 5.0f64].map(|x| (x, 3.0 * x.powf(1.7))).to_vec();
        let (p, a) = fit_exponent(&points).unwrap();
        assert!((p - 1.7).abs() < 1e-12 && (a - 3.0).abs() < 1e-12);
        assert_eq!(fit_exponent(&[(1.0, 2.0)]), None);
    }
}
