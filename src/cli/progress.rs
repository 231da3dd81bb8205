//! Progress on the screen: a bar with an estimate for whatever takes longer than two seconds.

use std::ops::ControlFlow;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::cli::interrupt;
use crate::forward::Progress;

/// A bar that appears after two seconds, on a terminal only.
pub struct Bar {
    label: String,
    started: Instant,
    shown: Mutex<Option<ProgressBar>>,
}

impl Bar {
    /// Starts the clock.
    pub fn new(label: impl Into<String>) -> Self {
        Self { label: label.into(), started: Instant::now(), shown: Mutex::new(None) }
    }

    /// As [`update`](Self::update), with something said beside the label.
    pub fn update_saying(&self, progress: Progress, said: &str) -> ControlFlow<()> {
        let flow = self.update(progress);
        if let Ok(shown) = self.shown.lock()
            && let Some(bar) = shown.as_ref()
        {
            bar.set_message(format!("{} {said}", self.label));
        }
        flow
    }

    /// Moves the bar, and tells whether to go on.
    pub fn update(&self, progress: Progress) -> ControlFlow<()> {
        self.update_with(progress, || self.label.clone())
    }

    /// Moves the bar and says something else beside it.
    pub fn update_with(&self, progress: Progress, label: impl Fn() -> String) -> ControlFlow<()> {
        if self.started.elapsed() > Duration::from_secs(2)
            && let Ok(mut shown) = self.shown.lock()
        {
            let bar = shown.get_or_insert_with(|| {
                let bar =
                    ProgressBar::with_draw_target(Some(progress.total as u64), ProgressDrawTarget::stderr_with_hz(5));
                if let Ok(style) =
                    ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %  {elapsed_precise}, about {eta} left")
                {
                    bar.set_style(style);
                }
                bar
            });
            bar.set_message(label());
            bar.set_length(progress.total as u64);
            bar.set_position(progress.done as u64);
        }
        interrupt::flow()
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        if let Ok(Some(bar)) = self.shown.get_mut().map(|shown| shown.take()) {
            bar.finish_and_clear();
        }
    }
}
