//! How long a packing takes: the tank of the paper, and beds of 1e3 to 3e5 stones.
//!
//! Run with `cargo bench --bench packing`. The median of several runs; the exponent is the slope of the logarithms.

use std::time::Instant;

use ballast_gpr::packing::{InputRule, RsaInput, RsaOutcome, RsaStart, pack};
use ballast_gpr::units::{Metres, Share};

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// A square bed of about `stones` stones, with the start of the paper's tank: 1.153 times as high, 50.3 % solid.
fn bed(stones: f64) -> Result<RsaInput, Box<dyn std::error::Error>> {
    let base = RsaInput::benedetto2018()?;
    let start = base.start()?;
    let side = (stones / 294.0 * base.width.si() * base.height.si()).sqrt();
    let height = Metres(side * start.height.si() / base.height.si());
    let input = InputRule::Explicit(RsaStart { height, solid_share: start.solid_share });
    Ok(RsaInput { width: Metres(side), height: Metres(side), input, ..base })
}

fn slope(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let mean = |f: fn(&(f64, f64)) -> f64| points.iter().map(|p| f(p).ln()).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    points.iter().map(|p| (p.0.ln() - x) * (p.1.ln() - y)).sum::<f64>()
        / points.iter().map(|p| (p.0.ln() - x).powi(2)).sum::<f64>()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let tank = RsaInput::benedetto2018()?;
    let mut seconds = Vec::new();
    for seed in 0..101 {
        let clock = Instant::now();
        std::hint::black_box(pack(&tank, seed)?);
        seconds.push(clock.elapsed().as_secs_f64());
    }
    println!("tank of the paper, 1.5 m by 48 cm, 58 %: median of 101 seeds {:.2} ms\n", median(seconds) * 1e3);
    let dense = RsaInput {
        input: InputRule::Explicit(RsaStart { height: Metres(0.48 * 1.025), solid_share: Share(0.58 / 1.025) }),
        ..tank
    };
    let outcomes = (0..21).map(|seed| pack(&dense, seed)).collect::<Result<Vec<_>, _>>()?;
    let positioning = |o: &RsaOutcome| o.seconds_positioning.si();
    println!(
        "the same from 56.6 %, near the jam: median of 21 seeds {:.2} ms\n",
        median(outcomes.iter().map(positioning).collect()) * 1e3
    );
    println!("{:>8} {:>14} {:>12} {:>16}", "stones", "positioning s", "compaction s", "us per stone");
    let (mut positionings, mut compactions) = (Vec::new(), Vec::new());
    for (stones, runs) in [(1e3, 21), (1e4, 7), (1e5, 3), (3e5, 1)] {
        let input = bed(stones)?;
        let outcomes = (0..runs).map(|seed| pack(&input, seed)).collect::<Result<Vec<_>, _>>()?;
        let count = outcomes[0].after.count() as f64;
        let place = median(outcomes.iter().map(positioning).collect());
        let settle = median(outcomes.iter().map(|o| o.seconds_compaction.si()).collect());
        println!("{count:>8} {place:>14.4} {settle:>12.5} {:>16.2}", (place + settle) / count * 1e6);
        positionings.push((count, place));
        compactions.push((count, settle));
    }
    println!(
        "\nexponent in the number of stones: positioning {:.2}, compaction {:.2}",
        slope(&positionings),
        slope(&compactions)
    );
    Ok(())
}
