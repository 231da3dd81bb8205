//! Which vector instructions the step of a plane uses.
//!
//! The kernels are compiled once per instruction set, and one is chosen at run time. All variants come from the same source
//! without fused multiplication and addition, so every variant gives the same bits.

use super::super::instructions::InstructionSet;
use super::plane::{Plane, Scratch};
use super::step::Step;
use super::vector::{Kernel, Number, Set};

/// Steps a plane with instructions that this machine was found to have.
pub fn step<T: Number>(set: InstructionSet, step: &Step<'_, T>, plane: &mut Plane<T>, scratch: &mut Scratch<T>) {
    let kernel = PlaneStep { step, plane, scratch };
    match set {
        // SAFETY: the set comes from `InstructionSet::resolve`, which refuses what the machine does not have.
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx512 => unsafe { T::avx512() }.run(kernel),
        // SAFETY: as above.
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx2 => unsafe { T::avx2() }.run(kernel),
        _ => T::any().run(kernel),
    }
}

/// The step of a plane as one kernel.
struct PlaneStep<'a, 'b, T> {
    step: &'a Step<'b, T>,
    plane: &'a mut Plane<T>,
    scratch: &'a mut Scratch<T>,
}

impl<T: Number> Kernel<T> for PlaneStep<'_, '_, T> {
    #[inline(always)]
    fn run<S: Set<T>>(self, set: S) {
        self.step.run(set, self.plane, self.scratch);
    }
}
