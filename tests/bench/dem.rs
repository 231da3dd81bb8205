//! Particle-steps per second of the spheres: settled beds, free fall, and the cost against their number; beside LIGGGHTS and
//! Kratos where they are installed (see `support/dem_peers.rs`), interleaved, as the median of five.
//!
//! `cargo bench --bench dem` for all tables; `-- own` leaves the peers out, `-- peers` everything else; `-- quick` takes a
//! tenth of the steps.

use ballast_gpr::packing::dem::{Grain, Setup, Simulation, Stuff, TimeStep};

#[path = "support/dem_beds.rs"]
mod dem_beds;
#[path = "support/dem_peers.rs"]
mod dem_peers;
#[path = "../dem_support/mod.rs"]
mod dem_support;

use dem_beds::{TILE, bed, fall, must, rate, settled_tile};
use dem_peers::Peer;

/// Rounds of each measurement.
const ROUNDS: usize = 5;

/// A scene and what to time of it.
struct Scene {
    name: &'static str,
    setup: Setup,
    /// Width of its box, m.
    wide: Option<f64>,
    /// Particle-steps of a round.
    work: u64,
}

fn median(mut rates: Vec<f64>) -> f64 {
    rates.sort_by(f64::total_cmp);
    rates.get(rates.len() / 2).copied().unwrap_or(f64::NAN)
}

fn main() {
    let said = |word: &str| std::env::args().any(|said| said == word);
    let share = if said("quick") { 10 } else { 1 };
    let tile = settled_tile();
    let scene = |name, setup, wide, work| Scene { name, setup, wide, work: work / share };
    let scenes = [
        scene("bed", bed(&tile, [1, 1]), Some(1.0), 20_000_000),
        scene("bed", bed(&tile, [2, 2]), Some(2.0), 20_000_000),
        scene("fall", fall(TILE), None, 40_000_000),
        scene("fall", fall(4 * TILE), None, 40_000_000),
    ];
    let peers = if said("own") { vec![] } else { Peer::installed() };
    println!("| scene | stones | threads | program | particle-steps/s, median of {ROUNDS} | ours over it |");
    println!("|---|---|---|---|---|---|");
    for threads in [1, 2] {
        for scene in &scenes {
            compare(scene, &peers, threads);
        }
    }
    if !said("peers") {
        against_number(&tile, share);
        against_stiffness(&tile, share);
        against_time_step(&tile, share);
    }
}

/// Ours and the peers in turns.
fn compare(scene: &Scene, peers: &[Peer], threads: usize) {
    let count = scene.setup.grains.len();
    let steps = (scene.work / count as u64).max(50);
    let mut simulation = must(Simulation::new(scene.setup.clone()));
    rate(&mut simulation, 100, threads);
    let mut ours = vec![];
    let mut theirs: Vec<Vec<f64>> = vec![vec![]; peers.len()];
    for _ in 0..ROUNDS {
        if scene.wide.is_none() {
            // From rest again, as the peers.
            simulation = must(Simulation::new(scene.setup.clone()));
            rate(&mut simulation, 100, threads);
        }
        ours.push(rate(&mut simulation, steps, threads));
        for (peer, rates) in peers.iter().zip(&mut theirs) {
            // Kratos takes some forty times as long.
            let steps = if *peer == Peer::Kratos { (steps / 40).max(20) } else { steps };
            rates.extend(peer.rate(&scene.setup, scene.wide, steps, threads));
        }
    }
    let ours = median(ours);
    println!("| {} | {count} | {threads} | ballast-gpr | {ours:.3e} | 1 |", scene.name);
    for (peer, rates) in peers.iter().zip(theirs) {
        let rate = median(rates);
        println!("| {} | {count} | {threads} | {} | {rate:.3e} | {:.2} |", scene.name, peer.name(), ours / rate);
    }
}

/// Time of a step against the number of stones, and the exponent between neighbours in the table.
fn against_number(tile: &[Grain], share: u64) {
    println!("\n| stones | contacts | particle-steps/s on 2 threads | ns a stone and step | exponent of the time |");
    println!("|---|---|---|---|---|");
    let mut before: Option<(f64, f64)> = None;
    for tiles in [[1, 1], [2, 1], [2, 2], [4, 2], [4, 4], [8, 5]] {
        let mut simulation = must(Simulation::new(bed(tile, tiles)));
        let count = simulation.count();
        let steps = (20_000_000 / share / count as u64).max(20);
        rate(&mut simulation, 50, 2);
        let rate = median((0..3).map(|_| rate(&mut simulation, steps, 2)).collect());
        let time = count as f64 / rate;
        let exponent = before.map_or("–".to_string(), |(number, then)| {
            format!("{:.2}", (time / then).ln() / (count as f64 / number).ln())
        });
        println!("| {count} | {} | {rate:.3e} | {:.1} | {exponent} |", simulation.contacts().len(), 1e9 / rate);
        before = Some((count as f64, time));
    }
}

/// What a second of a bed costs for the four moduli of Irazábal et al. 2017, each with a fifth of its Rayleigh time.
fn against_stiffness(tile: &[Grain], share: u64) {
    println!(
        "\n| modulus of Young GPa | time step µs | particle-steps/s on 2 threads | wall time of 1 s of 5000 stones, s |"
    );
    println!("|---|---|---|---|");
    for young in [5.9e9, 11.8e9, 17.7e9, 23.6e9] {
        let mut setup = bed(tile, [1, 1]);
        setup.stuffs = vec![Stuff { young, ..Stuff::BALLAST }];
        setup.time_step = TimeStep::ShareOfRayleigh(0.2);
        let mut simulation = must(Simulation::new(setup));
        rate(&mut simulation, 200, 2);
        let rate = median((0..3).map(|_| rate(&mut simulation, 2000 / share, 2)).collect());
        let step = simulation.step_length().seconds;
        let second = simulation.count() as f64 / (rate * step);
        println!("| {:.1} | {:.2} | {rate:.3e} | {second:.0} |", 1e-9 * young, 1e6 * step);
    }
}

/// What a second of a bed costs with shares of the Rayleigh time, E 17.7 GPa. The work of a step hardly depends on it, so that the
/// time goes as the inverse.
fn against_time_step(tile: &[Grain], share: u64) {
    println!(
        "\n| share of the Rayleigh time | time step µs | particle-steps/s on 2 threads | wall time of 1 s of 5000 stones, s | exponent |"
    );
    println!("|---|---|---|---|---|");
    let mut before: Option<(f64, f64)> = None;
    for part in [0.05, 0.1, 0.2, 0.4] {
        let mut setup = bed(tile, [1, 1]);
        setup.time_step = TimeStep::ShareOfRayleigh(part);
        let mut simulation = must(Simulation::new(setup));
        rate(&mut simulation, 200, 2);
        let rate = median((0..3).map(|_| rate(&mut simulation, 2000 / share, 2)).collect());
        let step = simulation.step_length().seconds;
        let second = simulation.count() as f64 / (rate * step);
        let exponent = before
            .map_or("–".to_string(), |(then, took)| format!("{:.2}", (second / took).ln() / (step / then).ln()));
        println!("| {part} | {:.2} | {rate:.3e} | {second:.0} | {exponent} |", 1e6 * step);
        before = Some((step, second));
    }
}
