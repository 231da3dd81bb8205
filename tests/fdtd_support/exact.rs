//! Closed forms for a line current in the plane: free space, and above a layered medium.
//!
//! Time factor `exp(+i w t)`. Spectra are taken at `w - i alpha`, which moves the branch points off the path of
//! integration; the factor `exp(alpha t)` puts it right in time. Both sums are trapezoidal and converge exponentially.

use std::f64::consts::PI;

use ballast_gpr::units::constants::{C0, EPSILON_0, MU_0};
use rustfft::num_complex::Complex64;

/// Damping of the spectra, 1/s.
const ALPHA: f64 = 1e9;
/// Step of the frequencies, Hz: the trace repeats after 50 ns, damped by `exp(-50)`.
const STEP: f64 = 20e6;

/// A medium by its permittivity at a complex angular frequency.
pub type Permittivity<'a> = &'a dyn Fn(Complex64) -> Complex64;

/// Permittivity with conductivity and one Debye pole.
pub fn debye(eps_r: f64, sigma: f64, delta_eps: f64, tau: f64) -> impl Fn(Complex64) -> Complex64 {
    move |w| {
        let i = Complex64::i();
        eps_r + delta_eps / (1.0 + i * w * tau) - i * sigma / (w * EPSILON_0)
    }
}

/// Spectrum of the Ricker pulse `(1 - 2 z s²) exp(-z s²)`, `s = t - sqrt(2)/f`, `z = (pi f)²`:
/// `sqrt(pi/z) w²/(2 z) exp(-w²/(4 z)) exp(-i w sqrt(2)/f)`.
fn ricker(w: Complex64, f: f64) -> Complex64 {
    let zeta = (PI * f).powi(2);
    let delay = Complex64::i() * w * (2f64.sqrt() / f);
    (PI / zeta).sqrt() * w * w / (2.0 * zeta) * (-(w * w) / (4.0 * zeta) - delay).exp()
}

/// Ez at each time from its response to a line current of 1 A; a Ricker pulse of frequency `f`.
pub fn trace(times: impl Iterator<Item = f64>, f: f64, response: impl Fn(Complex64) -> Complex64) -> Vec<f64> {
    let highest = (6.5 * f / STEP) as usize;
    let spectrum: Vec<Complex64> = (0..highest)
        .map(|k| {
            let w = Complex64::new(2.0 * PI * STEP * k as f64, -ALPHA);
            ricker(w, f) * response(w) * if k == 0 { 0.5 } else { 1.0 }
        })
        .collect();
    let at = |t: f64| {
        let turn = Complex64::from_polar(1.0, 2.0 * PI * STEP * t);
        let sum = spectrum.iter().rev().fold(Complex64::ZERO, |sum, value| sum * turn + value);
        2.0 * STEP * (ALPHA * t).exp() * sum.re
    };
    times.map(at).collect()
}

/// Free space at distance `rho`: `-(w mu0/4) H0^(2)(k rho)`.
pub fn free_space(rho: f64) -> impl Fn(Complex64) -> Complex64 {
    move |w| -w * MU_0 / 4.0 * hankel_0_2(w / C0 * rho)
}

/// What a slab from depth 0 to `thickness` (`None`: a half-space), air above and below, sends back; source and receiver
/// `height` in all above it and `offset` apart. Sommerfeld's integral over Fresnel's coefficient for E along the line:
/// `-(w mu0/(4 pi)) integral of R exp(-i ky height - i kx offset)/ky dkx`.
pub fn reflected(w: Complex64, eps: Permittivity<'_>, thickness: Option<f64>, height: f64, offset: f64) -> Complex64 {
    let i = Complex64::i();
    let (air, inside) = ((w / C0).powi(2), (w / C0).powi(2) * eps(w));
    let at = |kx: f64| {
        let (k1, k2) = (down(kx, air), down(kx, inside));
        let r = (k1 - k2) / (k1 + k2);
        let r = thickness.map_or(r, |thickness| {
            let echo = (-2.0 * i * k2 * thickness).exp();
            r * (1.0 - echo) / (1.0 - r * r * echo)
        });
        r * (-i * k1 * height).exp() / k1 * (kx * offset).cos()
    };
    -w * MU_0 / (4.0 * PI) * over_kx(w.re / C0 + 40.0 / height, at)
}

/// What reaches a receiver right below the source, `depth` into a half-space; the source `height` above it:
/// `-(w mu0/(2 pi)) integral of exp(-i ky1 height - i ky2 depth)/(ky1 + ky2) dkx`.
pub fn transmitted(w: Complex64, eps: Permittivity<'_>, height: f64, depth: f64) -> Complex64 {
    let i = Complex64::i();
    let (air, inside) = ((w / C0).powi(2), (w / C0).powi(2) * eps(w));
    let at = |kx: f64| {
        let (k1, k2) = (down(kx, air), down(kx, inside));
        (-i * (k1 * height + k2 * depth)).exp() / (k1 + k2)
    };
    -w * MU_0 / (2.0 * PI) * over_kx(w.re / C0 + 40.0 / height, at)
}

/// The wave number downwards of a wave that decays downwards.
fn down(kx: f64, k_squared: Complex64) -> Complex64 {
    let ky = (k_squared - kx * kx).sqrt();
    if ky.im > 0.0 { -ky } else { ky }
}

/// The integral over `kx` from `-last` to `last` of an even function.
fn over_kx(last: f64, at: impl Fn(f64) -> Complex64) -> Complex64 {
    let step = 0.5;
    let sum = at(0.0) + (1..(last / step) as usize).map(|k| 2.0 * at(k as f64 * step)).sum::<Complex64>();
    sum * step
}

/// `J0 - i Y0` by their power series (Abramowitz & Stegun 9.1.12, 9.1.13); good to 1e-12 for `|z| < 10`.
pub fn hankel_0_2(z: Complex64) -> Complex64 {
    const EULER: f64 = 0.577_215_664_901_532_9;
    let quarter = -(z * z) / 4.0;
    let (mut term, mut j0, mut rest, mut harmonic) = (Complex64::ONE, Complex64::ONE, Complex64::ZERO, 0.0);
    for k in 1..60 {
        term = term * quarter / f64::from(k * k);
        harmonic += 1.0 / f64::from(k);
        j0 += term;
        rest -= term * harmonic;
    }
    let y0 = 2.0 / PI * (((z / 2.0).ln() + EULER) * j0 + rest);
    j0 - Complex64::i() * y0
}

/// What a cylinder of radius `radius` and permittivity `eps_r` in air sends back to a receiver at `(rho, phi)` from its axis,
/// the line current at `(rho_source, 0)`: the series of cylinder functions (Harrington 1961, section 5-9, continuity of E and
/// of H along the rim), `-(w mu0/4) sum e_n c_n H_n(k rho) H_n(k rho_source) cos(n phi)`.
pub fn cylinder(w: Complex64, eps_r: f64, radius: f64, rho_source: f64, rho: f64, phi: f64) -> Complex64 {
    const TERMS: usize = 36;
    let k = w / C0;
    let inside = k * eps_r.sqrt();
    let (outer, inner) = (cylinder_functions(k * radius, TERMS), cylinder_functions(inside * radius, TERMS));
    let (source, receiver) = (cylinder_functions(k * rho_source, TERMS), cylinder_functions(k * rho, TERMS));
    let slope = |f: &[Complex64], n: usize, z: Complex64| {
        if n == 0 { -f[1] } else { f[n - 1] - f[n] * n as f64 / z }
    };
    let mut sum = Complex64::ZERO;
    for n in 0..TERMS - 1 {
        let (j, h, j1) = (outer.0[n], outer.1[n], inner.0[n]);
        let j1_slope = inside * slope(&inner.0, n, inside * radius);
        let (j_slope, h_slope) = (k * slope(&outer.0, n, k * radius), k * slope(&outer.1, n, k * radius));
        let c = -(j * j1_slope - j_slope * j1) / (h * j1_slope - h_slope * j1);
        let term = c * source.1[n] * receiver.1[n] * (n as f64 * phi).cos();
        if term.is_finite() {
            sum += term * if n == 0 { 1.0 } else { 2.0 };
        }
    }
    -w * MU_0 / 4.0 * sum
}

/// `J_n` by power series and `H_n^(2)` by upward recurrence, `n` below `terms`.
fn cylinder_functions(z: Complex64, terms: usize) -> (Vec<Complex64>, Vec<Complex64>) {
    let series = |n: usize| {
        let quarter = -(z * z) / 4.0;
        let mut term = (1..=n).fold(Complex64::ONE, |term, k| term * z / (2.0 * k as f64));
        let mut sum = term;
        for k in 1..90 {
            term = term * quarter / (k * (k + n)) as f64;
            sum += term;
        }
        sum
    };
    let j: Vec<Complex64> = (0..terms).map(series).collect();
    let h0 = hankel_0_2(z);
    // The Wronskian, J1 Y0 - J0 Y1 = 2/(pi z), with H = J - i Y.
    let i = Complex64::i();
    let y0 = i * (h0 - j[0]);
    let y1 = (j[1] * y0 - 2.0 / (PI * z)) / j[0];
    let mut y = vec![y0, y1];
    for n in 1..terms - 1 {
        y.push(y[n] * (2.0 * n as f64) / z - y[n - 1]);
    }
    let h = j.iter().zip(&y).map(|(j, y)| j - i * y).collect();
    (j, h)
}
