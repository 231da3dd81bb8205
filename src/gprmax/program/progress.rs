//! Reading gprMax's progress bar and its closing lines.

use crate::forward::Progress;

/// Reads the bar of the time loop: `|--->:  37%|####      | 318/849 [00:00<00:00, 3178.72it/s]`. Bars of other stages (they
/// have a name in front) and other lines give nothing.
pub(super) fn progress(line: &str) -> Option<Progress> {
    let bar = line.trim().strip_prefix("|--->:")?;
    let counts = bar.rsplit('|').next()?.split('[').next()?.trim();
    let (done, total) = counts.split_once('/')?;
    let (done, total) = (done.trim().parse().ok()?, total.trim().parse().ok()?);
    (done <= total && total > 0).then_some(Progress { done, total })
}

/// Reads the time of the time loop in seconds: `Time taken: 0.2525 seconds`, `Time taken: 1 minute and 2.5 seconds`.
pub(super) fn loop_seconds(line: &str) -> Option<f64> {
    let text = line.trim().strip_prefix("Time taken:")?;
    let words: Vec<&str> = text.split_whitespace().collect();
    let mut seconds = None;
    for pair in words.windows(2) {
        let Ok(count) = pair[0].parse::<f64>() else { continue };
        let unit = pair[1].trim_end_matches([',', '.']).trim_end_matches('s');
        let scale = match unit {
            "millisecond" => 1e-3,
            "second" => 1.0,
            "minute" => 60.0,
            "hour" => 3600.0,
            "day" => 86400.0,
            _ => continue,
        };
        seconds = Some(seconds.unwrap_or(0.0) + count * scale);
    }
    seconds
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines as gprMax 4.0.1 prints them.
    #[test]
    fn the_bar_of_the_time_loop_is_read_and_no_other() {
        let bar = "|--->:  37%|███████████▌                   | 318/849 [00:00<00:00, 3178.72it/s]";
        assert_eq!(progress(bar), Some(Progress { done: 318, total: 849 }));
        assert_eq!(progress("|--->:   0%|       | 0/849 [00:00<?, ?it/s]"), Some(Progress { done: 0, total: 849 }));
        assert_eq!(progress("Building Yee cells [main_grid]: 100%|███████████| 2/2 [00:00<00:00, 719.99it/s]"), None);
        assert_eq!(progress("|--->OpenMP: 2 threads"), None);
        assert_eq!(progress("|--->: 9/3 ["), None);
    }

    #[test]
    fn the_time_of_the_loop_is_read() {
        assert_eq!(loop_seconds("Time taken: 0.2525 seconds"), Some(0.2525));
        assert_eq!(loop_seconds("Time taken: 1 minute and 2.5 seconds"), Some(62.5));
        assert_eq!(loop_seconds("Time taken: 1 hour, 2 minutes and 3 seconds"), Some(3723.0));
        assert_eq!(loop_seconds("Time taken: unknown"), None);
        assert_eq!(loop_seconds("=== Simulation completed in 0.3489 seconds ==="), None);
    }
}
