//! Millions of mutated inputs: `cargo bench --bench fuzz -- --inputs 2000000 --seconds 300 [--target in] [--seed 2]`.

#[path = "../fuzz_support/mod.rs"]
mod fuzz_support;

use std::path::Path;
use std::time::Duration;

use fuzz_support::targets::Target;
use fuzz_support::watch::{Budget, Watched, run};

#[global_allocator]
static ALLOCATOR: Watched = Watched;

fn main() -> std::process::ExitCode {
    let words: Vec<String> = std::env::args().collect();
    let after = |name: &str| words.iter().position(|word| word == name).and_then(|at| words.get(at + 1));
    let whole = |name: &str, default: u64| after(name).map_or(default, |word| word.parse().expect("a whole number"));
    let budget = Budget { inputs: whole("--inputs", 100_000), time: Duration::from_secs(whole("--seconds", 60)) };
    let only = after("--target");
    let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fuzz");
    let mut failed = false;
    for target in Target::ALL.into_iter().filter(|target| only.is_none_or(|name| name == target.name())) {
        let report = run(&target, whole("--seed", 2), budget, &kept);
        println!("{:<13}{report}", target.name());
        report.failures.iter().for_each(|failure| println!("  {failure}"));
        failed |= !report.failures.is_empty();
    }
    std::process::ExitCode::from(u8::from(failed))
}
