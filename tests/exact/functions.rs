//! Bessel functions of complex argument, for arguments below about 30 that lie near the real axis.

use rustfft::num_complex::Complex64;

const EULER: f64 = 0.577_215_664_901_532_9;

/// `J_0 … J_last` by recurrence downwards (Miller), scaled by `exp(iz) = J_0 + 2 sum i^k J_k` for an argument below the real
/// axis and by its mirror image above it, so that the sum never cancels (Abramowitz & Stegun 9.1.44 to 9.1.47).
pub fn bessel_j(last: usize, z: Complex64) -> Vec<Complex64> {
    let start = last.max(z.norm() as usize) + 40;
    let unit = if z.im <= 0.0 { Complex64::i() } else { -Complex64::i() };
    let mut values = downwards(start, |n| 2.0 * n as f64 / z);
    let (mut sum, mut turn) = (values[0], Complex64::ONE);
    for value in &values[1..] {
        turn *= unit;
        sum += 2.0 * turn * value;
    }
    let scale = (unit * z).exp() / sum;
    values.truncate(last + 1);
    values.iter_mut().for_each(|value| *value *= scale);
    values
}

/// `f_(n-1) = factor(n) f_n - f_(n+1)` from `start` down, to some scale that keeps clear of overflow.
fn downwards(start: usize, factor: impl Fn(usize) -> Complex64) -> Vec<Complex64> {
    let mut values = vec![Complex64::ZERO; start + 2];
    values[start] = Complex64::ONE;
    for n in (1..=start).rev() {
        values[n - 1] = factor(n) * values[n] - values[n + 1];
        if values[n - 1].norm() > 1e100 {
            values[n - 1..].iter_mut().for_each(|value| *value *= 1e-100);
        }
    }
    values
}

/// `H_0^(2) … H_last^(2)` upwards from Neumann's series of `Y_0` and `Y_1` (Abramowitz & Stegun 9.1.88, 9.1.89).
pub fn hankel_2(last: usize, z: Complex64) -> Vec<Complex64> {
    let j = bessel_j(last.max(z.norm() as usize) + 40, z);
    let log = (z / 2.0).ln() + EULER;
    let pi = std::f64::consts::PI;
    let series = |of: &dyn Fn(usize) -> Complex64| (1..(j.len() - 2) / 2).map(of).sum::<Complex64>();
    let sign = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    let y0 = 2.0 / pi * log * j[0] - 4.0 / pi * series(&|k| sign(k) / k as f64 * j[2 * k]);
    // 9.1.88 for n = 1: psi(2) = 1 - Euler's constant.
    let y1 = -2.0 / (pi * z) * j[0] + 2.0 / pi * (log - 1.0) * j[1]
        - 2.0 / pi * series(&|k| sign(k) * (1 + 2 * k) as f64 / (k * (k + 1)) as f64 * j[2 * k + 1]);
    let mut values = vec![j[0] - Complex64::i() * y0, j[1] - Complex64::i() * y1];
    for n in 1..last.max(1) {
        values.push(2.0 * n as f64 / z * values[n] - values[n - 1]);
    }
    values
}

/// `(x j_n(x))` for n from 0, and its derivative, spherical Bessel functions: downwards, scaled by `sin x`.
pub fn riccati_j(last: usize, x: Complex64) -> Vec<[Complex64; 2]> {
    let start = last.max(x.norm() as usize) + 40;
    let mut values = downwards(start, |n| (2 * n + 1) as f64 / x);
    // Whichever of the first two is larger sets the scale.
    let first = [x.sin(), x.sin() / x - x.cos()];
    let scale = if first[0].norm() > first[1].norm() { first[0] / values[0] } else { first[1] / values[1] };
    values.iter_mut().for_each(|value| *value *= scale);
    with_derivatives(&values[..=last], x.cos(), x)
}

/// `(x h_n^(2)(x))` for n from 0, and its derivative: upwards from `i exp(-ix)`.
pub fn riccati_h(last: usize, x: Complex64) -> Vec<[Complex64; 2]> {
    let i = Complex64::i();
    let wave = (-i * x).exp();
    let mut values = vec![i * wave, (i / x - 1.0) * wave];
    for n in 1..last.max(1) {
        values.push((2 * n + 1) as f64 / x * values[n] - values[n - 1]);
    }
    with_derivatives(&values[..=last], wave, x)
}

/// `f_n' = f_(n-1) - n/x f_n`, with the derivative of the first given.
fn with_derivatives(values: &[Complex64], first: Complex64, x: Complex64) -> Vec<[Complex64; 2]> {
    let derivative = |n: usize| if n == 0 { first } else { values[n - 1] - n as f64 / x * values[n] };
    (0..values.len()).map(|n| [values[n], derivative(n)]).collect()
}

/// Derivatives of cylinder functions: `f_n' = n/z f_n - f_(n+1)`; one fewer than given.
pub fn derivatives(values: &[Complex64], z: Complex64) -> Vec<Complex64> {
    (0..values.len() - 1).map(|n| n as f64 / z * values[n] - values[n + 1]).collect()
}

/// Against tables: Abramowitz & Stegun 9.1 to 9.4 (J and Y at 1, 5, 10), 10.1 (spherical functions at 1 and 10), and for
/// complex arguments the Wronskians `J_(n+1) H_n - J_n H_(n+1) = 2i/(pi z)` (9.1.17) and `psi zeta' - psi' zeta = -i` (10.1.31).
#[test]
fn special_functions_are_those_of_the_tables() {
    for (x, n, j, y) in [
        (1.0, 0, 0.765_197_686_557_966_6, 0.088_256_964_215_677),
        (1.0, 1, 0.440_050_585_744_933_5, -0.781_212_821_300_288_7),
        (5.0, 0, -0.177_596_771_314_338_3, -0.308_517_625_249_033_8),
        (5.0, 1, -0.327_579_137_591_465_2, 0.147_863_143_391_227),
        (10.0, 2, 0.254_630_313_685_121, -0.005_868_082_442_208_6),
    ] {
        let h = hankel_2(4, Complex64::from(x))[n];
        assert!((h.re - j).abs() < 1e-12 && (h.im + y).abs() < 1e-12, "{x} {n}: {h}");
    }
    for (x, n, j, y) in [
        (1.0, 1, 0.301_168_678_939_756_8, -1.381_773_290_676_036),
        (1.0, 2, 0.062_035_052_011_373_86, -3.605_017_566_159_969),
        (10.0, 2, 0.077_942_193_628_562_45, -0.065_069_304_993_733),
    ] {
        let (psi, zeta) = (riccati_j(4, Complex64::from(x))[n][0], riccati_h(4, Complex64::from(x))[n][0]);
        assert!((psi.re / x - j).abs() < 1e-12, "{x} {n}: {}", psi / x);
        assert!((zeta.re / x - j).abs() < 1e-12 && (zeta.im / x + y).abs() < 1e-10, "{x} {n}: {}", zeta / x);
    }
    for z in
        [Complex64::new(0.3, -0.1), Complex64::new(3.0, -2.0), Complex64::new(12.0, -0.5), Complex64::new(25.0, -3.0)]
    {
        let (j, h) = (bessel_j(31, z), hankel_2(31, z));
        let (psi, zeta) = (riccati_j(31, z), riccati_h(31, z));
        for n in 0..31 {
            let wronskian = (j[n + 1] * h[n] - j[n] * h[n + 1]) * std::f64::consts::PI * z / 2.0 / Complex64::i();
            assert!((wronskian.norm() - 1.0).abs() < 1e-9, "{z} {n}: {wronskian}");
            let wronskian = (psi[n][0] * zeta[n][1] - psi[n][1] * zeta[n][0]) * Complex64::i();
            assert!((wronskian - 1.0).norm() < 1e-9, "{z} {n}: {wronskian}");
        }
    }
}
