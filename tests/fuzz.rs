//! No file, however damaged, makes a reader panic, hang or take memory without bound.
//!
//! Inputs are mutations of those in `tests/corpus`, the same in every run; any input that once failed is kept there too. The
//! long run with millions of inputs is `cargo bench --bench fuzz`.

mod fuzz_support;

use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Duration;

use ballast_gpr::fdtd::Fdtd;
use ballast_gpr::gprmax::read_input;
use fuzz_support::targets::Target;
use fuzz_support::watch::{Budget, Watched, run, run_one};

#[global_allocator]
static ALLOCATOR: Watched = Watched;

/// About fifteen seconds in all on one core, of which the deadlines are generous multiples.
#[test]
fn mutated_inputs_are_survived() {
    let mut failures = vec![];
    for target in Target::ALL {
        let inputs = match target {
            Target::In => 20_000,
            Target::Traces | Target::Voxels => 4_000,
            Target::Dzt | Target::Dt1 | Target::Mala | Target::SegY | Target::Iprb | Target::Ids => 3_000,
            _ => 5_000,
        };
        let budget = Budget { inputs, time: Duration::from_secs(60) };
        let report = run(&target, 1, budget, &Path::new(env!("CARGO_TARGET_TMPDIR")).join("fuzz"));
        println!("{:<13}{report}", target.name());
        assert!(report.inputs > 200 && report.accepted > 0, "{}: {report}", target.name());
        failures.extend(report.failures);
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// The corpus itself, unchanged: what mutations start from is read, what once was not survived is.
#[test]
fn the_corpus_is_survived() {
    let mut kept = 0;
    for target in Target::ALL {
        let folder = tempfile::tempdir().unwrap();
        target.prepare(folder.path());
        let survived = |input: &[u8]| match run_one(&target, folder.path(), input) {
            Ok(read) => read,
            Err(panic) => panic!("{}: {panic}", target.name()),
        };
        assert!(target.seeds().iter().any(|input| survived(input)), "{}", target.name());
        for (_, input) in target.kept() {
            survived(&input);
            kept += 1;
        }
    }
    assert!(kept >= 5, "{kept}");
}

/// What asks for more than a machine has is refused by the reader or by the solver, before memory is asked for: `## expected`
/// in the first line tells by which words.
#[test]
fn extreme_input_files_are_refused_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("input.in");
    let mut seen = 0;
    for (name, input) in Target::In.kept() {
        let text = String::from_utf8(input).unwrap();
        let Some(expected) = text.lines().next().and_then(|line| line.strip_prefix("## expected: ")) else { continue };
        fs::write(&path, &text).unwrap();
        let message = match read_input(&path) {
            Err(error) => error.to_string(),
            Ok(read) => match Fdtd::default().solve_stats(&read.model, &|_| ControlFlow::Continue(())) {
                Err(error) => error.to_string(),
                Ok(_) => "no error".into(),
            },
        };
        assert!(message.contains(expected), "{name}: {message}");
        seen += 1;
    }
    assert!(seen >= 5, "{seen}");
}
