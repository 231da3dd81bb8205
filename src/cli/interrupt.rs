//! Ctrl-C: the first asks for a clean stop, the second ends the program at once. And a reader that goes away.

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

/// Exit code of a program whose reader went away: 128 and the number of SIGPIPE.
const NO_READER: i32 = 141;

/// From now on the program ends quietly when whoever reads its output has seen enough (`| head`); printing would panic.
pub fn end_with_the_reader() {
    let other = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        let said = panic.payload_as_str().unwrap_or_default();
        if said.starts_with("failed printing to stdout") && said.contains("Broken pipe") {
            std::process::exit(NO_READER);
        }
        other(panic);
    }));
}

/// Whether somebody asked to stop.
pub fn requested() -> bool {
    STOP.load(Ordering::Relaxed)
}

/// `Break` once somebody asked to stop.
pub fn flow() -> ControlFlow<()> {
    if requested() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}
