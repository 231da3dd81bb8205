//! The watchdog: mechanical energy must not grow without a source.

use super::DemError;
use super::simulation::Simulation;
use super::vector::{dot, norm};

/// What the watchdog remembers.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Watch {
    /// Work of walls on grains since the last change, J.
    pub work: f64,
    /// Least energy less work since the last change, J.
    pub least: f64,
    /// Greatest kinetic energy since the last change, J.
    pub most_kinetic: f64,
    /// Greatest elastic energy since the last change, J.
    pub most_elastic: f64,
    /// What the step's number times its length lacks of the time, s.
    pub time_offset: f64,
}

/// Growth that is let pass, over the greatest kinetic energy: the scheme itself keeps energy to a few per cent in an impact.
const KINETIC_MARGIN: f64 = 0.1;
/// Growth that is let pass, over the greatest elastic energy: tangential springs hold about as much and are not counted.
const ELASTIC_MARGIN: f64 = 2.0;
/// Growth that is let pass, over the energy to lift all grains by a radius.
const LIFTING_MARGIN: f64 = 1e-6;

impl Simulation {
    /// Begins to watch anew, from the state as it is.
    pub(super) fn begin_watch(&mut self) {
        if self.step == 0 {
            // Contacts of the set-up are not yet known.
            return self.begin_watch_without_forces();
        }
        let (kinetic, elastic) = (self.kinetic_energy(), self.elastic_energy());
        self.watch.work = 0.0;
        self.watch.least = kinetic + elastic + self.potential_energy();
        (self.watch.most_kinetic, self.watch.most_elastic) = (kinetic, elastic);
    }

    /// As `begin_watch`, while the list of contacts does not fit the grains: the next look takes the energy as it finds it.
    pub(super) fn begin_watch_without_forces(&mut self) {
        self.watch.work = 0.0;
        self.watch.least = f64::INFINITY;
    }

    /// Stops a simulation whose energy has grown.
    pub(super) fn look_at_energy(&mut self) -> Result<(), DemError> {
        let (kinetic, elastic) = (self.kinetic_energy(), self.elastic_energy());
        let now = kinetic + elastic + self.potential_energy() - self.watch.work;
        let watch = &mut self.watch;
        watch.most_kinetic = watch.most_kinetic.max(if now <= watch.least { kinetic } else { 0.0 });
        watch.most_elastic = watch.most_elastic.max(if now <= watch.least { elastic } else { 0.0 });
        let (before, most_kinetic, most_elastic) = (watch.least, watch.most_kinetic, watch.most_elastic);
        let lifting = self.lifting_energy();
        let margin = KINETIC_MARGIN * most_kinetic + ELASTIC_MARGIN * most_elastic + LIFTING_MARGIN * lifting;
        if now - before <= margin || before == f64::INFINITY {
            self.watch.least = before.min(now);
            return Ok(());
        }
        let energy = |i: usize| {
            let velocity = self.grains.velocity[i];
            velocity.w() * dot(velocity.xyz(), velocity.xyz())
        };
        let most = (0..self.grains.len()).max_by(|&a, &b| energy(a).total_cmp(&energy(b))).unwrap_or(0);
        Err(DemError::EnergyGrows {
            step: self.step,
            before,
            now,
            grain: self.grains.id[most] as usize,
            speed: norm(self.grains.velocity[most].xyz()),
            share: 100.0 * self.length.share_of_rayleigh(),
        })
    }

    /// Energy to lift every grain by its radius against gravity, J.
    fn lifting_energy(&self) -> f64 {
        let grains = self.grains.velocity.iter().zip(&self.grains.place);
        norm(self.gravity) * grains.map(|(velocity, place)| velocity.w() * place.w()).sum::<f64>()
    }
}
