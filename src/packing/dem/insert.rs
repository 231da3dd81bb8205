//! Grains that come in while a simulation goes on: rain, and what a hopper is filled up with.

use std::ops::Range;

use super::DemError;
use super::check;
use super::setup::{Grain, Setup, TimeStep};
use super::simulation::Simulation;
use super::time_step::{self, StepLength};

impl Simulation {
    /// Puts further grains in and gives their numbers, which go on from those there are. Contacts keep what they remember, and
    /// the time step stays.
    ///
    /// # Errors
    /// As [`Simulation::new`] (grains are counted from the first of these), with overlaps of the new grains among each other,
    /// with the others and with walls; also when the time step is beyond the Rayleigh time of one of them and was within that
    /// of all before. Nothing has changed then.
    pub fn insert(&mut self, grains: &[Grain]) -> Result<Range<usize>, DemError> {
        let first = self.count;
        if grains.is_empty() {
            return Ok(first..first);
        }
        let mut setup = Setup::new(super::Stuff::BALLAST, grains.to_vec());
        setup.stuffs.clone_from(&self.stuffs);
        (setup.periodic, setup.domain) = (self.periodic, self.domain);
        check::check(&setup)?;
        let (own, seconds) = (self.length, self.length.seconds);
        let asked = if seconds > own.rayleigh { TimeStep::Unchecked(seconds) } else { TimeStep::Seconds(seconds) };
        let theirs = time_step::settle(asked, grains, &self.stuffs)?;
        let before = self.clone();
        self.grains.append(grains, &self.stuffs, first);
        self.count += grains.len();
        if theirs.rayleigh < own.rayleigh {
            self.length = StepLength { grain: first + theirs.grain, rayleigh: theirs.rayleigh, ..own };
        }
        self.length.contact = own.contact.min(theirs.contact);
        for grain in grains {
            let [least, greatest] = self.radii;
            self.radii = [least.min(grain.sphere.radius), greatest.max(grain.sphere.radius)];
        }
        self.renew_list_for_all();
        if let Err(error) = self.check_overlaps(first) {
            *self = before;
            return Err(error);
        }
        self.changed();
        Ok(first..self.count)
    }
}
