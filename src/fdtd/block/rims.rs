//! What a block sends to its neighbours, and takes from them, between two passes.

use super::super::real::Real;
use super::Block;
use crate::model::Order;

impl<T: Real> Block<T> {
    /// Copies the state of the first or the last rows of the block's own into a letter.
    pub fn pack(&mut self, last: bool, rim: usize, letter: &mut Vec<T>) {
        letter.clear();
        let begin = if last { self.own.end - rim } else { self.own.start };
        for row in begin..begin + rim {
            self.each_of_row(row - self.base, &mut |values| letter.extend_from_slice(values));
        }
    }

    /// Takes the state of the neighbour's rows next to the block's last or first row from a letter.
    pub fn unpack(&mut self, last: bool, rim: usize, letter: &[T]) {
        let begin = if last { self.own.end } else { self.own.start - rim };
        let mut rest = letter;
        for row in begin..begin + rim {
            self.each_of_row(row - self.base, &mut |values| {
                let (mine, others) = rest.split_at(values.len());
                values.copy_from_slice(mine);
                rest = others;
            });
            if self.order == Order::Fourth {
                self.image_h(row - self.base);
                self.image_e(row - self.base);
            }
        }
    }

    /// All that a step changes in a row.
    fn each_of_row(&mut self, r: usize, visit: &mut impl FnMut(&mut [T])) {
        visit(self.ez.at_mut(r, 1, self.width));
        visit(self.hx.at_mut(r, 1, self.width));
        visit(self.hy.at_mut(r, 1, self.width));
        if let Some((slot, _)) = self.absorb_e[r] {
            visit(self.phi_e.at_mut(slot, 1, self.width));
        }
        if let Some((slot, _)) = self.absorb_h[r] {
            visit(self.phi_h.at_mut(slot, 1, self.width));
        }
        visit(self.columns.e.memory(r));
        visit(self.columns.h.memory(r));
        if let Some(dispersion) = &mut self.dispersion {
            visit(dispersion.memory_of_row(r));
        }
    }
}
