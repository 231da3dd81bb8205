//! What this machine's memory gives at most: the line under which every solver stays.

use std::hint::black_box;
use std::sync::Barrier;
use std::time::Instant;

/// Sweeps of one measurement.
const ROUNDS: usize = 7;

/// Bytes per second that all threads together read and write in place (`a[i] += b`), arrays of `bytes` in each thread, best
/// of several sweeps. Counted are the bytes read and the bytes written.
pub fn in_place_bandwidth(threads: usize, bytes: usize) -> f64 {
    let numbers = (bytes / size_of::<f32>()).max(1024);
    // Short arrays are swept often, so that a round takes about ten milliseconds.
    let sweeps = (100_000_000 / numbers).clamp(1, 100_000);
    let barrier = Barrier::new(threads.max(1));
    let slowest = std::thread::scope(|scope| {
        let workers: Vec<_> =
            (0..threads.max(1)).map(|_| scope.spawn(|| best_sweep(numbers, sweeps, &barrier))).collect();
        workers.into_iter().filter_map(|worker| worker.join().ok()).fold(0.0f64, f64::max)
    });
    (2 * threads.max(1) * numbers * sweeps * size_of::<f32>()) as f64 / slowest
}

/// Seconds of the fastest round; all threads begin each round together.
fn best_sweep(numbers: usize, sweeps: usize, barrier: &Barrier) -> f64 {
    let mut field = vec![1.0f32; numbers];
    let mut best = f64::INFINITY;
    for _ in 0..ROUNDS {
        barrier.wait();
        let begin = Instant::now();
        for sweep in 0..sweeps {
            let step = black_box(sweep as f32);
            field.iter_mut().for_each(|value| *value += step);
        }
        best = best.min(begin.elapsed().as_secs_f64());
        black_box(&mut field);
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A machine that this runs on moves more than 100 MB/s and less than 100 TB/s.
    #[test]
    fn bandwidths_are_in_a_sensible_range() {
        let bandwidth = in_place_bandwidth(2, 64 * 1024);
        assert!((1e8..1e14).contains(&bandwidth), "{bandwidth:e}");
    }
}
