//! Ctrl-C: the first asks for a clean stop, the second ends the program at once.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

static STOP: AtomicBool = AtomicBool::new(false);

/// Listens for Ctrl-C and termination from now on.
pub fn listen() {
    let installed = ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
        eprintln!("\nstopping; nothing half-written stays (Ctrl-C again ends at once)");
    });
    if let Err(error) = installed {
        eprintln!("warning: Ctrl-C cannot be caught ({error}); an interrupted run may leave `.partial` files");
    }
}

/// Whether somebody asked to stop.
pub fn requested() -> bool {
    STOP.load(Ordering::Relaxed)
}

/// `Break` once somebody asked to stop.
pub fn flow() -> ControlFlow<()> {
    if requested() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}
