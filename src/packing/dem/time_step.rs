//! How long a step may be.

use std::f64::consts::PI;

use super::setup::{Grain, TimeStep};
use super::stuff::Stuff;
use super::{DemError, law::effective_young};
use crate::units::{Metres, Seconds};

/// Share of the Rayleigh time from which on a time step is worth a warning.
pub const WARN_RAYLEIGH: f64 = 0.2;
/// Share of the contact time from which on a time step is worth a warning.
pub const WARN_CONTACT: f64 = 0.1;

/// Gives the time a Rayleigh wave takes around a grain: `π R √(ρ/G)/(0.1631 ν + 0.8766)`.
///
/// ```
/// use ballast_gpr::packing::dem::{Stuff, rayleigh_time};
/// use ballast_gpr::units::Metres;
/// // 25 mm of ballast: 5 µs are 19 % of it.
/// assert!((5e-6 / rayleigh_time(&Stuff::BALLAST, Metres(0.0125)).si() - 0.19).abs() < 0.005);
/// ```
pub fn rayleigh_time(stuff: &Stuff, radius: Metres) -> Seconds {
    Seconds(PI * radius.si() * (stuff.density / stuff.shear()).sqrt() / (0.1631 * stuff.poisson + 0.8766))
}

/// Gives the duration of the elastic impact of two equal grains at `speed` (m/s): `2.87 (m*²/(R* E*² v))^(1/5)` (Hertz).
pub fn contact_time(stuff: &Stuff, radius: Metres, speed: f64) -> Seconds {
    let (r, m) = (radius.si() / 2.0, stuff.density * 2.0 * PI / 3.0 * radius.si().powi(3));
    Seconds(2.87 * (m * m / (r * effective_young(stuff, stuff).powi(2) * speed)).powf(0.2))
}

/// The time step of a simulation and what it is measured by.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct StepLength {
    /// The time step, s.
    pub seconds: f64,
    /// Least Rayleigh time of all grains, s.
    pub rayleigh: f64,
    /// The grain that has it.
    pub grain: usize,
    /// Least duration of the impact of two equal grains at 1 m/s, s.
    pub contact: f64,
}

impl StepLength {
    /// The time step over the Rayleigh time; above [`WARN_RAYLEIGH`] it is worth a warning.
    pub fn share_of_rayleigh(&self) -> f64 {
        self.seconds / self.rayleigh
    }

    /// The time step over the duration of an impact at 1 m/s; above [`WARN_CONTACT`] it is worth a warning.
    pub fn share_of_contact(&self) -> f64 {
        self.seconds / self.contact
    }

    /// Whether the time step is longer than is usual.
    pub fn is_worth_a_warning(&self) -> bool {
        self.share_of_rayleigh() > WARN_RAYLEIGH * (1.0 + 1e-9) || self.share_of_contact() > WARN_CONTACT
    }
}

/// Settles the time step of checked grains.
pub fn settle(asked: TimeStep, grains: &[Grain], stuffs: &[Stuff]) -> Result<StepLength, DemError> {
    let time = |grain: &Grain| rayleigh_time(&stuffs[grain.material], Metres(grain.sphere.radius)).si();
    let of_contact = |grain: &Grain| contact_time(&stuffs[grain.material], Metres(grain.sphere.radius), 1.0).si();
    let least = grains.iter().map(time).enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
    let (grain, rayleigh) = least.unwrap_or((0, f64::INFINITY));
    let contact = grains.iter().map(of_contact).fold(f64::INFINITY, f64::min);
    let (what, seconds) = match asked {
        TimeStep::Seconds(seconds) | TimeStep::Unchecked(seconds) => ("time step", seconds),
        TimeStep::ShareOfRayleigh(share) => ("share of the Rayleigh time", share * rayleigh),
    };
    if !(seconds > 0.0 && seconds.is_finite()) {
        return Err(DemError::BadNumber {
            who: "simulation of",
            index: grains.len(),
            what,
            value: seconds,
            wanted: "above zero and finite (grains are needed for a share of the Rayleigh time)",
        });
    }
    if seconds > rayleigh && !matches!(asked, TimeStep::Unchecked(_)) {
        return Err(DemError::TimeStepTooLong {
            step: Seconds(seconds),
            limit: Seconds(rayleigh),
            grain,
            diameter: Metres(2.0 * grains[grain].sphere.radius),
            good: Seconds(0.2 * rayleigh),
        });
    }
    Ok(StepLength { seconds, rayleigh, grain, contact })
}
