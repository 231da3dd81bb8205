//! One Debye pole and a conductivity that behave like a mixture over a band.

use super::{Complex, DebyePole, Dielectric, MixError, MixingModel, mix_dielectrics};
use crate::units::constants::EPSILON_0;
use crate::units::{Hertz, Seconds, Share, SiemensPerMetre};

/// How many frequencies the fit looks at, spread evenly in the logarithm.
const FREQUENCIES: usize = 41;
/// How many relaxation times are tried before the best is refined.
const TIMES: usize = 81;

/// A permittivity curve as one Debye pole and a conductivity, and how well they fit.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct FittedDielectric {
    /// Relative permittivity far above the relaxation.
    pub eps_inf: f64,
    /// Strength of the relaxation; exactly zero where the curve needs none.
    pub delta_eps: f64,
    /// Relaxation time; zero where there is no relaxation.
    pub tau: Seconds,
    /// Conductivity at rest.
    pub sigma: SiemensPerMetre,
    /// Largest `|fitted - wanted| / |wanted|` over the band.
    pub worst_error: f64,
}

impl FittedDielectric {
    /// The fit as a material.
    pub fn dielectric(&self) -> Dielectric {
        let pole = DebyePole { delta_eps: self.delta_eps, tau: self.tau };
        let poles = if self.delta_eps > 0.0 { vec![pole] } else { vec![] };
        Dielectric { eps_r: self.eps_inf, sigma: self.sigma, poles }
    }
}

/// Why a curve could not be fitted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FitError {
    /// A band that is none.
    #[error(
        "the band {low} to {high} of the fit is empty or not finite\n\nhint: use 0.1 to 3 times the centre frequency"
    )]
    Band {
        /// Lower end.
        low: Hertz,
        /// Upper end.
        high: Hertz,
    },
    /// The curve is not that of a passive material.
    #[error(
        "the permittivity at {frequency} is {eps}: its real part should be 1 or more and its imaginary part 0 or below"
    )]
    NotPassive {
        /// Where.
        frequency: Hertz,
        /// What the curve gives there.
        eps: Complex,
    },
    /// The mixture itself failed.
    #[error(transparent)]
    Mix(#[from] MixError),
}

/// Fits one Debye pole and a conductivity to `mix(f)`, the complex relative permittivity at `f` in Hz.
///
/// Least squares of the relative error over frequencies spread evenly in the logarithm between `f_lo` and `f_hi` (0.1 to 3
/// times the centre frequency is a good band). For each relaxation time the three other unknowns are solved for with
/// `eps_inf >= 1`, `delta_eps >= 0`, `sigma >= 0`; the time is searched between a tenth of the period of `f_hi` over 2 pi
/// and ten times that of `f_lo`, then refined to 1e-10.
///
/// # Errors
/// An empty band, or a curve that is not of a passive material.
pub fn debye_fit(mix: impl Fn(f64) -> Complex, f_lo: Hertz, f_hi: Hertz) -> Result<FittedDielectric, FitError> {
    let (low, high) = (f_lo.si(), f_hi.si());
    if !(low > 0.0 && high > low && high.is_finite()) {
        return Err(FitError::Band { low: f_lo, high: f_hi });
    }
    let mut curve = Vec::with_capacity(FREQUENCIES);
    for k in 0..FREQUENCIES {
        let frequency = low * (high / low).powf(k as f64 / (FREQUENCIES - 1) as f64);
        let eps = mix(frequency);
        if !(eps.re >= 1.0 - 1e-9 && eps.im <= 1e-9 && eps.re.is_finite() && eps.im.is_finite()) {
            return Err(FitError::NotPassive { frequency: Hertz(frequency), eps });
        }
        curve.push((2.0 * std::f64::consts::PI * frequency, eps));
    }
    let without = solve(&curve, None);
    if without.worst < 1e-9 {
        return Ok(finish(without, 0.0));
    }
    let (first, last) = ((0.1 / curve[FREQUENCIES - 1].0).ln(), (10.0 / curve[0].0).ln());
    let step = (last - first) / (TIMES - 1) as f64;
    let misfit = |ln_tau: f64| solve(&curve, Some(ln_tau.exp())).squares;
    let best = (0..TIMES).map(|k| first + step * k as f64).map(|t| (misfit(t), t)).min_by(|a, b| a.0.total_cmp(&b.0));
    let centre = best.map_or(first, |(_, t)| t);
    let tau = golden_section(misfit, centre - step, centre + step).exp();
    let fitted = solve(&curve, Some(tau));
    Ok(if fitted.unknowns[1] > 0.0 { finish(fitted, tau) } else { finish(without, 0.0) })
}

/// Fits one Debye pole and a conductivity to a mixture of materials by [`debye_fit`].
///
/// # Errors
/// What [`mix_dielectrics`] or [`debye_fit`] refuses.
pub fn effective_debye(
    model: MixingModel,
    parts: &[(Share, &Dielectric)],
    f_lo: Hertz,
    f_hi: Hertz,
) -> Result<FittedDielectric, FitError> {
    mix_dielectrics(model, parts, f_hi)?;
    debye_fit(
        |frequency| mix_dielectrics(model, parts, Hertz(frequency)).unwrap_or(Complex::new(f64::NAN, f64::NAN)),
        f_lo,
        f_hi,
    )
}

/// Solution for one relaxation time.
struct Solved {
    /// `eps_inf - 1`, `delta_eps`, `sigma / eps_0 / omega_0`.
    unknowns: [f64; 3],
    omega_0: f64,
    squares: f64,
    worst: f64,
}

fn finish(solved: Solved, tau: f64) -> FittedDielectric {
    let [above_one, delta_eps, conduction] = solved.unknowns;
    FittedDielectric {
        eps_inf: 1.0 + above_one,
        delta_eps,
        tau: Seconds(tau),
        sigma: SiemensPerMetre(conduction * EPSILON_0 * solved.omega_0),
        worst_error: solved.worst,
    }
}

/// Non-negative least squares in three unknowns: the best of the eight sets of unknowns held at zero.
fn solve(curve: &[(f64, Complex)], tau: Option<f64>) -> Solved {
    let omega_0 = curve[0].0;
    let columns = |omega: f64| {
        let relaxed = tau.map_or(Complex::new(0.0, 0.0), |tau| 1.0 / Complex::new(1.0, omega * tau));
        [Complex::new(1.0, 0.0), relaxed, Complex::new(0.0, -omega_0 / omega)]
    };
    let mut normal = nalgebra::Matrix3::<f64>::zeros();
    let mut right = nalgebra::Vector3::<f64>::zeros();
    for &(omega, eps) in curve {
        let weight = 1.0 / eps.norm_sqr();
        let (row, wanted) = (columns(omega), eps - 1.0);
        for i in 0..3 {
            right[i] += weight * (row[i].re * wanted.re + row[i].im * wanted.im);
            for j in 0..3 {
                normal[(i, j)] += weight * (row[i].re * row[j].re + row[i].im * row[j].im);
            }
        }
    }
    let misfit = |unknowns: [f64; 3]| {
        let (mut squares, mut worst) = (0.0, 0.0_f64);
        for &(omega, eps) in curve {
            let row = columns(omega);
            let fitted = row[0] * unknowns[0] + row[1] * unknowns[1] + row[2] * unknowns[2] + 1.0;
            let error = (fitted - eps).norm_sqr() / eps.norm_sqr();
            squares += error;
            worst = worst.max(error.sqrt());
        }
        Solved { unknowns, omega_0, squares, worst }
    };
    let mut best = misfit([0.0; 3]);
    for held in 0..7_u8 {
        let free = |i: usize| held & (1 << i) == 0 && !(i == 1 && tau.is_none());
        let (mut matrix, mut vector) = (normal, right);
        for i in (0..3).filter(|&i| !free(i)) {
            matrix.row_mut(i).fill(0.0);
            matrix.column_mut(i).fill(0.0);
            matrix[(i, i)] = 1.0;
            vector[i] = 0.0;
        }
        let Some(found) = matrix.lu().solve(&vector) else { continue };
        if found.iter().all(|v| v.is_finite() && *v >= 0.0) {
            let solved = misfit([found[0], found[1], found[2]]);
            if solved.squares < best.squares {
                best = solved;
            }
        }
    }
    best
}

fn golden_section(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    const RATIO: f64 = 0.618_033_988_749_894_8;
    let (mut a, mut b) = (high - RATIO * (high - low), low + RATIO * (high - low));
    let (mut at_a, mut at_b) = (f(a), f(b));
    while high - low > 1e-10 {
        if at_a < at_b {
            (high, b, at_b) = (b, a, at_a);
            a = high - RATIO * (high - low);
            at_a = f(a);
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = low + RATIO * (high - low);
            at_b = f(b);
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::super::water;
    use super::*;

    const BAND: (Hertz, Hertz) = (Hertz(0.1e9), Hertz(3e9));

    /// A curve that is one pole and a conductivity is found again. The relaxation is far above the band, so the unknowns
    /// are weakly held; double precision leaves about 1e-6.
    #[test]
    fn a_debye_material_is_found_again() {
        let wanted =
            Dielectric::new(3.5, SiemensPerMetre(0.02), vec![DebyePole { delta_eps: 6.0, tau: Seconds(9.231e-12) }])
                .unwrap();
        let fit = debye_fit(|f| wanted.permittivity(Hertz(f)), BAND.0, BAND.1).unwrap();
        assert!(fit.worst_error < 1e-6, "{fit:?}");
        for (ours, exact) in
            [(fit.eps_inf, 3.5), (fit.delta_eps, 6.0), (fit.tau.si() / 9.231e-12, 1.0), (fit.sigma.si(), 0.02)]
        {
            assert!((ours / exact - 1.0).abs() < 1e-4, "{ours} for {exact}: {fit:?}");
        }
    }

    #[test]
    fn dry_ballast_needs_no_pole() {
        let (stone, air) = (Dielectric::lossless(6.5), Dielectric::lossless(1.0));
        let parts = [(Share(0.58), &stone), (Share(0.42), &air)];
        let fit = effective_debye(MixingModel::Crim, &parts, BAND.0, BAND.1).unwrap();
        assert!((fit.eps_inf - 3.6051).abs() < 5e-5 && fit.delta_eps == 0.0 && fit.sigma.si() < 1e-12, "{fit:?}");
        assert!(fit.dielectric().poles.is_empty());
    }

    /// Refractive mixing distorts the relaxation of water only a little: over 0.1 to 3 GHz one pole is within 0.01 %, and
    /// the permittivity at rest is the mixture's.
    #[test]
    fn wet_ballast_is_one_pole_to_a_ten_thousandth() {
        let (stone, air, water) = (Dielectric::lossless(6.5), Dielectric::lossless(1.0), water());
        for (saturation, at_rest) in [(0.1, 4.98), (0.5, 12.7), (1.0, 27.4)] {
            let voids = 0.42;
            let parts =
                [(Share(0.58), &stone), (Share(voids * saturation), &water), (Share(voids * (1.0 - saturation)), &air)];
            let fit = effective_debye(MixingModel::Crim, &parts, BAND.0, BAND.1).unwrap();
            assert!(fit.worst_error < 1e-4, "{saturation}: {fit:?}");
            assert!((fit.dielectric().static_permittivity() / at_rest - 1.0).abs() < 5e-3, "{saturation}: {fit:?}");
        }
    }

    #[test]
    fn messages_word_for_word() {
        let fit = |low, high, eps| debye_fit(|_| eps, Hertz(low), Hertz(high)).unwrap_err().to_string();
        assert_eq!(
            fit(2e9, 1e9, Complex::new(2.0, 0.0)),
            "the band 2 GHz to 1 GHz of the fit is empty or not finite\n\nhint: use 0.1 to 3 times the centre frequency"
        );
        assert_eq!(
            fit(1e9, 2e9, Complex::new(2.0, 1.0)),
            "the permittivity at 1 GHz is 2+1i: its real part should be 1 or more and its imaginary part 0 or below"
        );
    }
}
