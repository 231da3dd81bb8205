//! Which vector instructions the steps use. With `shared` the one place of the engine with `unsafe`.
//!
//! The steps are compiled once per instruction set and chosen at run time. All variants come from the same source without
//! fused multiplication and addition, so they give the same bits.

use super::segment::{End, Team};

/// The steps of a thread, compiled for some instruction set.
#[derive(Debug, Clone, Copy)]
pub struct Member(for<'a, 'b> fn(&'b Team<'a>, usize) -> End);

impl Member {
    /// Makes the steps of a thread.
    pub fn call(self, team: &Team<'_>, me: usize) -> End {
        (self.0)(team, me)
    }
}

/// Chooses by what the scene calls for and what the machine has.
pub fn member(friction: bool, periodic: bool, resistance: bool) -> Member {
    match (friction, periodic, resistance) {
        (false, false, false) => choose::<false, false, false>(),
        (false, false, true) => choose::<false, false, true>(),
        (false, true, false) => choose::<false, true, false>(),
        (false, true, true) => choose::<false, true, true>(),
        (true, false, false) => choose::<true, false, false>(),
        (true, false, true) => choose::<true, false, true>(),
        (true, true, false) => choose::<true, true, false>(),
        (true, true, true) => choose::<true, true, true>(),
    }
}

fn choose<const FRICTION: bool, const PERIODIC: bool, const RESISTANCE: bool>() -> Member {
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl") {
            // SAFETY: the machine has these instructions.
            return Member(|team, me| unsafe { avx512::<FRICTION, PERIODIC, RESISTANCE>(team, me) });
        }
        if is_x86_feature_detected!("avx2") {
            // SAFETY: the machine has these instructions.
            return Member(|team, me| unsafe { avx2::<FRICTION, PERIODIC, RESISTANCE>(team, me) });
        }
    }
    Member(|team, me| team.steps::<FRICTION, PERIODIC, RESISTANCE>(me))
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl")]
fn avx512<const FRICTION: bool, const PERIODIC: bool, const RESISTANCE: bool>(team: &Team<'_>, me: usize) -> End {
    team.steps::<FRICTION, PERIODIC, RESISTANCE>(me)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn avx2<const FRICTION: bool, const PERIODIC: bool, const RESISTANCE: bool>(team: &Team<'_>, me: usize) -> End {
    team.steps::<FRICTION, PERIODIC, RESISTANCE>(me)
}
