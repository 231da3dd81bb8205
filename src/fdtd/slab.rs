//! Absorbing slabs: what stretches the difference across one at each depth.

use super::FdtdError;
use crate::model::{AbsorbingProfile, Formulation, Stretch};
use crate::units::constants::EPSILON_0;

/// A slab of absorbing cells at one end of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slab {
    /// Absorbing cells.
    pub cells: usize,
    formulation: Formulation,
    /// The stretches with their largest conductivities, S/m; the second is there in second order.
    first: (Stretch, f64),
    second: Option<(Stretch, f64)>,
    dt: f64,
}

/// `alpha`, `kappa`, `sigma` at a depth.
type Sample = [f64; 3];

/// A stretch of second order at a depth: what is added to a difference `d`, given two memories, and how these go on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Filter {
    /// Factors of `d`, `phi1`, `phi2`.
    pub add: [f64; 3],
    /// Factors of `phi1`, `phi2`, `d` for the new `phi1` and `phi2`.
    pub next: [[f64; 3]; 2],
}

impl Slab {
    /// No absorbing cells.
    pub fn none() -> Self {
        let first = (Stretch::default(), 0.0);
        Self { cells: 0, formulation: Formulation::Recursive, first, second: None, dt: 0.0 }
    }

    /// A slab of so many cells, `matched` being `0.8/(Z0 d sqrt(eps_r mu_r))` of the media at its entrance: a conductivity
    /// of order `m` that is not given grows to `m + 1` times as much.
    ///
    /// # Errors
    /// A stretch that shrinks, more than two, and two that together amplify some frequency, as gprMax refuses them too.
    pub fn new(profile: &AbsorbingProfile, cells: usize, matched: f64, dt: f64) -> Result<Self, FdtdError> {
        let factors = profile.factors();
        let with_max =
            |stretch: &Stretch| (*stretch, stretch.sigma.max.unwrap_or(matched * f64::from(stretch.sigma.order + 1)));
        let (first, second) = match &factors[..] {
            [one] => (with_max(one), None),
            [one, two] => (with_max(one), Some(with_max(two))),
            _ => return Err(FdtdError::Stretches { count: factors.len() }),
        };
        let slab = Self { cells, formulation: profile.formulation, first, second, dt };
        for half in 0..=2 * cells {
            slab.check(half as f64 / 2.0)?;
        }
        Ok(slab)
    }

    /// Whether it takes two memories for each difference.
    pub fn is_second_order(&self) -> bool {
        self.second.is_some()
    }

    /// Nodes from the lower wall on in which the slab at that end acts: one more than its cells where E at the entrance is
    /// not left as it is.
    pub fn extent(&self) -> usize {
        self.cells + usize::from(self.cells > 0 && !self.begins_with_nothing())
    }

    fn begins_with_nothing(&self) -> bool {
        let nothing = |[_, kappa, sigma]: Sample| kappa == 1.0 && sigma == 0.0;
        let second = self.second.is_none_or(|second| match self.formulation {
            Formulation::Recursive => nothing(sample(&second, 0.0)),
            Formulation::Multipole => matches!(sample(&second, 0.0), [_, 0.0, 0.0]),
        });
        nothing(sample(&self.first, 0.0)) && second
    }

    /// The depth from 0 at the entrance to 1 at the wall; `None` before the entrance.
    fn share(&self, depth: f64) -> Option<f64> {
        (self.cells > 0 && depth >= 0.0).then(|| depth / self.cells as f64)
    }

    /// `RA - 1, RB, RE, RF` of a slab of first order at a depth counted in cells from the entrance; nothing before it.
    ///
    /// Giannopoulos 2012 (doi:10.1109/TAP.2011.2180344), first order.
    pub fn at(&self, depth: f64) -> [f64; 4] {
        self.share(depth).map_or([0.0, 1.0, 1.0, 0.0], |share| self.first_order(sample(&self.first, share)))
    }

    fn first_order(&self, [alpha, kappa, sigma]: Sample) -> [f64; 4] {
        let dt = self.dt;
        let below = 2.0 * EPSILON_0 * kappa + dt * (alpha * kappa + sigma);
        // RA - 1 without cancellation.
        let less_one = 2.0 * EPSILON_0 * (1.0 - kappa) + dt * (alpha * (1.0 - kappa) - sigma);
        let keep = 2.0 * EPSILON_0 * kappa - dt * (alpha * kappa + sigma);
        [less_one / below, 2.0 * EPSILON_0 * kappa / below, keep / below, 2.0 * sigma * dt / (kappa * below)]
    }

    /// A slab of second order at a depth counted in cells from the entrance; nothing before it.
    ///
    /// Recursive: the stretched difference of the first factor is that which the second stretches (Giannopoulos 2012, as
    /// above). Multipole: `kappa + sum sigma/(alpha + i w eps0)`, its memories those of the terms, with the trapezoidal rule
    /// (Giannopoulos 2018, "Multipole perfectly matched layer for finite-difference time-domain electromagnetic modeling",
    /// IEEE Trans. Antennas Propag., doi:10.1109/TAP.2018.2823864).
    pub fn filter(&self, depth: f64) -> Filter {
        let identity = Filter { add: [0.0; 3], next: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] };
        let (Some(share), Some(second)) = (self.share(depth), &self.second) else { return identity };
        let (one, two) = (sample(&self.first, share), sample(second, share));
        match self.formulation {
            Formulation::Recursive => {
                let ([a1, b1, e1, f1], [a2, b2, e2, f2]) = (self.first_order(one), self.first_order(two));
                let (ra1, ra2) = (1.0 + a1, 1.0 + a2);
                Filter { add: [a1 + a2 + a1 * a2, ra2 * b1, b2], next: [[e1, 0.0, -f1], [-f2 * b1, e2, -f2 * ra1]] }
            }
            Formulation::Multipole => {
                let term = |[alpha, _, sigma]: Sample| {
                    let below = 2.0 * EPSILON_0 + alpha * self.dt;
                    let keep = (2.0 * EPSILON_0 - alpha * self.dt) / below;
                    [2.0 * EPSILON_0 / below, keep, 2.0 * sigma * self.dt / below]
                };
                let ([b1, e1, f1], [b2, e2, f2]) = (term(one), term(two));
                let whole = one[1] + two[1] + 0.5 * (f1 + f2);
                let (a, b1, b2) = (1.0 / whole, -b1 / whole, -b2 / whole);
                Filter {
                    add: [(1.0 - whole) / whole, b1, b2],
                    next: [[e1 + f1 * b1, f1 * b2, f1 * a], [f2 * b1, e2 + f2 * b2, f2 * a]],
                }
            }
        }
    }

    /// Refuses what shrinks, and what amplifies: the real part of the stretch must not be negative at any frequency.
    fn check(&self, depth: f64) -> Result<(), FdtdError> {
        let share = depth / self.cells as f64;
        let one = sample(&self.first, share);
        let two = self.second.as_ref().map(|second| sample(second, share));
        let is_sum = self.formulation == Formulation::Multipole;
        let kappa = match two {
            None => one[1],
            Some(two) if is_sum => one[1] + two[1],
            Some(two) => one[1].min(two[1]),
        };
        let least = one.iter().chain(two.iter().flatten()).fold(0.0f64, |least, v| least.min(*v));
        let (Some([alpha2, kappa2, sigma2]), false) = (two, is_sum || kappa <= 0.0 || least < 0.0) else {
            let sound = kappa > 0.0 && least >= 0.0;
            return if sound { Ok(()) } else { Err(FdtdError::Shrinks { depth, kappa, least }) };
        };
        let [alpha1, kappa1, sigma1] = one;
        // Re(S) times (alpha1² + u)(alpha2² + u) is a u² + b u + c, u = (w eps0)².
        let a = kappa1 * kappa2;
        let b = a * (alpha1 * alpha1 + alpha2 * alpha2) + kappa1 * sigma2 * alpha2 + kappa2 * sigma1 * alpha1
            - sigma1 * sigma2;
        let c = alpha1 * alpha2 * (kappa1 * alpha1 + sigma1) * (kappa2 * alpha2 + sigma2);
        if b < 0.0 && b * b > 4.0 * a * c {
            return Err(FdtdError::Amplifies { depth });
        }
        Ok(())
    }
}

fn sample((stretch, sigma_max): &(Stretch, f64), share: f64) -> Sample {
    let of = |grading: &crate::model::Grading| grading.at(share, grading.max.unwrap_or(0.0));
    [of(&stretch.alpha), of(&stretch.kappa), stretch.sigma.at(share, *sigma_max)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Grading;

    const DT: f64 = 4.7e-12;

    fn growing(order: u8, max: f64) -> Grading {
        Grading { order, reverse: false, min: 0.0, max: Some(max) }
    }

    fn slab(formulation: Formulation, stretches: Vec<Stretch>) -> Result<Slab, FdtdError> {
        Slab::new(&AbsorbingProfile { formulation, stretches }, 10, 0.5, DT)
    }

    /// At the entrance nothing is absorbed: the correction is exactly zero while `phi` is.
    #[test]
    fn the_entrance_absorbs_nothing() {
        let slab = slab(Formulation::Recursive, vec![]).unwrap();
        assert_eq!(slab.at(0.0), [0.0, 1.0, 1.0, 0.0]);
        assert_eq!((slab.at(-3.0), slab.extent()), (slab.at(0.0), 10));
    }

    /// A second factor that does nothing leaves the first as it is, in both formulations.
    #[test]
    fn a_second_stretch_that_does_nothing_changes_nothing() {
        let first = Stretch { alpha: Grading::constant(0.05), kappa: Grading::constant(2.0), sigma: growing(4, 3.0) };
        let alone = slab(Formulation::Recursive, vec![first]).unwrap();
        for (formulation, kappa) in [(Formulation::Recursive, 1.0), (Formulation::Multipole, 0.0)] {
            let nothing = Stretch { kappa: Grading::constant(kappa), sigma: Grading::constant(0.0), ..first };
            let both = slab(formulation, vec![first, nothing]).unwrap();
            let (wanted, found) = (respond(alone.at(7.0)), respond_two(both.filter(7.0)));
            assert!(wanted.iter().zip(&found).all(|(a, b)| (a - b).abs() < 1e-12), "{wanted:?} {found:?}");
        }
    }

    fn respond([a, b, e, f]: [f64; 4]) -> Vec<f64> {
        let mut phi = 0.0;
        let mut step = |d: f64| {
            let out = a * d + b * phi;
            phi = e * phi - f * d;
            out
        };
        [1.0, 0.0, 0.0, -2.0, 0.5].map(&mut step).into()
    }

    fn respond_two(Filter { add, next }: Filter) -> Vec<f64> {
        let mut phi = [0.0; 2];
        let mut step = |d: f64| {
            let out = add[0] * d + add[1] * phi[0] + add[2] * phi[1];
            phi = next.map(|[p, q, r]| p * phi[0] + q * phi[1] + r * d);
            out
        };
        [1.0, 0.0, 0.0, -2.0, 0.5].map(&mut step).into()
    }

    /// The profile that gprMax 4.0.1 refuses, with its advice: `alpha2 = 1.1 sigma1`.
    #[test]
    fn two_stretches_that_amplify_are_refused() {
        let first = Stretch { sigma: growing(4, 0.5), ..Stretch::default() };
        let second = |alpha| Stretch { alpha, sigma: growing(4, 1.0), ..first };
        let refused = slab(Formulation::Recursive, vec![first, second(growing(4, 0.1))]);
        assert!(matches!(refused, Err(FdtdError::Amplifies { .. })), "{refused:?}");
        assert!(slab(Formulation::Recursive, vec![first, second(growing(4, 0.55))]).is_ok());
        assert!(slab(Formulation::Multipole, vec![first, second(growing(4, 0.1))]).is_ok());
        let shrinking = Stretch { kappa: Grading::constant(0.0), ..first };
        assert!(matches!(slab(Formulation::Recursive, vec![shrinking]), Err(FdtdError::Shrinks { .. })));
        let many = slab(Formulation::Recursive, vec![first; 3]);
        assert_eq!(many, Err(FdtdError::Stretches { count: 3 }));
    }
}
