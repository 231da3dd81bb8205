//! Which vector instructions the sweep uses: with its registers (`lanes`) the one place with `unsafe`.
//!
//! A sweep is compiled once per instruction set and chosen at run time. All variants come from the same source without
//! fused multiplication and addition, so they give the same bits.

use super::FdtdError;
use super::block::Block;
use super::reach::Cones;
use super::real::Real;

/// Vector instructions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum InstructionSet {
    /// The widest that this machine has.
    #[default]
    Auto,
    /// What every machine of this architecture has.
    Scalar,
    /// 256 bits wide (x86-64).
    Avx2,
    /// 512 bits wide (x86-64).
    Avx512,
}

impl InstructionSet {
    /// Its name in messages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Scalar => "scalar",
            Self::Avx2 => "AVX2",
            Self::Avx512 => "AVX-512",
        }
    }

    fn is_there(self) -> bool {
        match self {
            Self::Auto | Self::Scalar => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => is_x86_feature_detected!("avx2"),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl"),
            #[cfg(not(target_arch = "x86_64"))]
            Self::Avx2 | Self::Avx512 => false,
        }
    }

    /// Settles `Auto`, and makes sure that the machine has what was asked for.
    ///
    /// # Errors
    /// When it has not.
    pub fn resolve(self) -> Result<Sweep, FdtdError> {
        let set = match self {
            Self::Auto => [Self::Avx512, Self::Avx2].into_iter().find(|set| set.is_there()).unwrap_or(Self::Scalar),
            named => named,
        };
        if set.is_there() { Ok(Sweep(set)) } else { Err(FdtdError::NoSuchInstructions { set }) }
    }
}

/// An instruction set that this machine has; only [`InstructionSet::resolve`] makes one.
#[derive(Debug, Clone, Copy)]
pub struct Sweep(InstructionSet);

impl Sweep {
    /// The instruction set.
    pub fn set(self) -> InstructionSet {
        self.0
    }

    /// Makes the steps `first..first + count` of a block.
    pub fn run<T: Real>(self, block: &mut Block<T>, cones: &Cones, first: usize, count: usize) {
        match self.0 {
            // SAFETY: a `Sweep` of this set exists only where the machine was found to have these instructions.
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx512 => unsafe { sweep_avx512(block, cones, first, count) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx2 => unsafe { sweep_avx2(block, cones, first, count) },
            _ => block.pass::<T::Basic>(cones, first, count),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn sweep_avx2<T: Real>(block: &mut Block<T>, cones: &Cones, first: usize, count: usize) {
    block.pass::<T::Avx2>(cones, first, count);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl")]
fn sweep_avx512<T: Real>(block: &mut Block<T>, cones: &Cones, first: usize, count: usize) {
    block.pass::<T::Avx512>(cones, first, count);
}
