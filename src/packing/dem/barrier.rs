//! A place where the threads of a team wait for each other.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Rounds of waiting before a thread lets others run: some 20 µs.
const SPINS: u32 = 2000;

/// Spins for a while, then yields the core, so that a crowded machine is not spun dry.
#[derive(Debug)]
pub struct Barrier {
    members: usize,
    here: AtomicUsize,
    round: AtomicUsize,
    broken: AtomicBool,
}

impl Barrier {
    /// A barrier for so many threads.
    pub fn new(members: usize) -> Self {
        Self { members, here: AtomicUsize::new(0), round: AtomicUsize::new(0), broken: AtomicBool::new(false) }
    }

    /// Waits for all; what they wrote before is then seen by all. False when one of them has panicked.
    #[inline]
    pub fn wait(&self) -> bool {
        if self.members == 1 {
            return true;
        }
        let round = self.round.load(Ordering::Acquire);
        if self.here.fetch_add(1, Ordering::AcqRel) + 1 == self.members {
            self.here.store(0, Ordering::Relaxed);
            self.round.store(round + 1, Ordering::Release);
            return !self.broken.load(Ordering::Acquire);
        }
        let mut rounds = 0;
        while self.round.load(Ordering::Acquire) == round {
            if self.broken.load(Ordering::Acquire) {
                return false;
            }
            if rounds < SPINS {
                rounds += 1;
                std::hint::spin_loop();
            } else {
                std::thread::yield_now();
            }
        }
        !self.broken.load(Ordering::Acquire)
    }

    /// Makes a guard that frees the others when the thread panics.
    pub fn guard(&self) -> BreaksOnPanic<'_> {
        BreaksOnPanic(self)
    }
}

/// Breaks the barrier when its thread panics.
pub struct BreaksOnPanic<'a>(&'a Barrier);

impl Drop for BreaksOnPanic<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.broken.store(true, Ordering::Release);
        }
    }
}
