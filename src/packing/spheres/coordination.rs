//! How many others a stone touches.

use super::bed::SphereBed;
use crate::units::{Metres, Share};

/// The gap up to which two stones of a bed without known forces are counted as touching: a hundredth of a millimetre.
pub const TOUCHING: Metres = Metres(1e-5);

/// A stone with fewer contacts than this carries nothing in space, with or without its weight.
const LEAST_CONTACTS: u32 = 4;

/// Coordination of a bed.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Coordination {
    /// Mean number of contacts with other stones, over all stones: `2 contacts / stones`.
    pub mean: f64,
    /// The same over the stones of the interior (see [`SphereBed::interior`]); `mean` where there are none.
    pub interior: f64,
    /// The same without rattlers.
    pub interior_without_rattlers: f64,
    /// Share of the stones of the interior with fewer than four contacts.
    pub rattlers: Share,
    /// Number of stones of the interior by their number of contacts, from 0.
    pub histogram: Vec<usize>,
}

impl SphereBed {
    /// Number of contacts of each stone with other stones: those of the list of contacts where there is one, else the stones
    /// with gaps up to `touching`.
    pub fn contact_numbers(&self, touching: Metres) -> Vec<u32> {
        let mut numbers = vec![0; self.spheres.len()];
        if self.contacts.is_empty() {
            let (grid, largest) = (self.grid(), 0.5 * self.largest_diameter().si());
            for (k, sphere) in self.spheres.iter().enumerate() {
                grid.for_each_within(sphere, touching.si(), largest, |other, _| numbers[k] += u32::from(other != k));
            }
            return numbers;
        }
        for contact in &self.contacts {
            for end in [contact.first, contact.second] {
                numbers[end as usize] += 1;
            }
        }
        numbers
    }

    /// Coordination of the bed; walls do not count as neighbours.
    pub fn coordination(&self, touching: Metres) -> Coordination {
        let numbers = self.contact_numbers(touching);
        let (low, high) = self.interior();
        let inside = |centre: [f64; 3]| (0..3).all(|axis| (low[axis]..=high[axis]).contains(&centre[axis]));
        let of_interior: Vec<u32> =
            self.spheres.iter().zip(&numbers).filter(|(sphere, _)| inside(sphere.centre)).map(|(_, n)| *n).collect();
        let mean = |numbers: &[u32]| numbers.iter().sum::<u32>() as f64 / numbers.len().max(1) as f64;
        let considered = if of_interior.is_empty() { &numbers } else { &of_interior };
        let carrying: Vec<u32> = considered.iter().copied().filter(|n| *n >= LEAST_CONTACTS).collect();
        let mut histogram = vec![0; considered.iter().max().map_or(0, |most| *most as usize + 1)];
        for number in considered {
            histogram[*number as usize] += 1;
        }
        Coordination {
            mean: mean(&numbers),
            interior: mean(considered),
            interior_without_rattlers: mean(&carrying),
            rattlers: Share(1.0 - carrying.len() as f64 / considered.len().max(1) as f64),
            histogram,
        }
    }
}
