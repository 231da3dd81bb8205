//! One A-scan from the shell: `ballast-gpr run` against `python -m gprMax`, wall time of the whole process.
//!
//! The clean tank at 2 mm over 25 ns, single precision, the same `.in` file for both, the same number of threads, run in turns.
//! gprMax keeps its own OpenMP policy; only the number of threads is set. `cargo bench --bench whole_process` prints the table.
//!
//! Environment: `BENCH_ROUNDS` (5), `BENCH_THREADS` ("1 2"), `BENCH_WINDOW` ("25ns"), `BENCH_CELL` ("2mm"), and
//! `BALLAST_GPR_GPRMAX_PYTHON` for a gprMax other than the private one. Where there is no gprMax the bench fails.

#[path = "support/peer.rs"]
mod peer;

use std::path::PathBuf;

use ballast_gpr::compare::relative_l2;
use ballast_gpr::gprmax::{InputOptions, install, read_traces, write_input};
use ballast_gpr::raster::build_model;
use ballast_gpr::scene::{SceneSpec, resolve};
use peer::{Outcome, least, load, median, ours, setting, theirs};

fn main() -> Outcome<()> {
    let rounds: usize = setting("BENCH_ROUNDS", "5").parse()?;
    let threads: Vec<usize> =
        setting("BENCH_THREADS", "1 2").split_whitespace().map(str::parse).collect::<Result<_, _>>()?;
    let python = install::find(None)?;
    let mut spec = SceneSpec::preset("tank")?;
    (spec.grid.time_window, spec.grid.cell) =
        (setting("BENCH_WINDOW", "25ns").parse()?, setting("BENCH_CELL", "2mm").parse()?);
    let model = build_model(&resolve(&spec)?)?;
    let folder = tempfile::tempdir()?;
    write_input(&model, folder.path(), "model", &InputOptions::default())?;
    let place = |name: &str| -> PathBuf { folder.path().join(name) };
    let [nx, ny, _] = model.grid.cells;
    println!("clean tank, {nx} x {ny} cells, {} steps, single precision; {rounds} rounds in turns", model.iterations());
    println!(
        "{:<9}{:>9}{:>24}{:>24}{:>8}{:>26}  load",
        "threads", "", "ballast-gpr, s", "gprMax, s", "ratio", "loops: ours, gprMax, s"
    );
    for threads in threads {
        let before = load();
        let (mut our_times, mut their_times) = (vec![], vec![]);
        for round in 0..rounds {
            // Each goes first as often as the other, so that a machine that slows down or warms up favours neither.
            for turn in 0..2 {
                if (round + turn) % 2 == 0 {
                    our_times.push(ours(&place("model.in"), &place("ours.h5"), threads, &[])?);
                } else {
                    their_times.push(theirs(&python, &place("model.in"), &place("theirs.h5"), threads, &[])?);
                }
            }
        }
        let (a, b) = (read_traces(&place("theirs.h5"))?, read_traces(&place("ours.h5"))?);
        let difference = relative_l2(a.radar_trace().ok_or("no trace")?, b.radar_trace().ok_or("no trace")?)?;
        // Two runs in single precision: the same work was done.
        if difference.is_nan() || difference > 2e-5 {
            return Err(format!("the traces differ by {difference:e}").into());
        }
        let column = |times: &[[f64; 2]], which: usize| times.iter().map(|time| time[which]).collect::<Vec<_>>();
        for (name, of) in [("median", median as fn(&[f64]) -> f64), ("least", least)] {
            let [we, they] = [of(&column(&our_times, 0)), of(&column(&their_times, 0))];
            let loops = format!("{:.2}, {:.2}", of(&column(&our_times, 1)), of(&column(&their_times, 1)));
            println!(
                "{threads:<9}{name:>9}{we:>24.2}{they:>24.2}{:>8.1}{loops:>26}  {before} -> {}",
                they / we,
                load()
            );
        }
        println!("         the traces differ by {difference:.1e}");
    }
    Ok(())
}
