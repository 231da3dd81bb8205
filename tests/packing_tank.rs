//! The tank of Benedetto et al. 2018, section 5.2.1: does the method give the numbers of its paper?

use ballast_gpr::packing::calibrate::{CalibrationPlan, calibrate};
use ballast_gpr::packing::{ClassReading, InputRule, RsaInput, RsaOutcome, RsaStart, optimise, pack};
use ballast_gpr::units::{Metres, Share};

const SEEDS: u64 = 100;

fn tank(width: f64, class_reading: ClassReading, input: InputRule) -> RsaInput {
    RsaInput { width: Metres(width), class_reading, input, ..RsaInput::benedetto2018().unwrap() }
}

fn mean_and_sd(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let values: Vec<f64> = values.collect();
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    (mean, (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt())
}

/// The paper starts from 55 cm and 50 % and asks for 48 cm and 58 % (eqs. 1, 2). Tolerances 1.5 cm and 2 %: half a stone
/// (the final height is the top of one stone of 22–80 mm), and the paper rounds its start to 1 cm and 1 %. Inside
/// the bed another implementation of the same method found about 64 %, and 56–61 % over the enclosing rectangle; within 2 %. The inner width of the real tank is 1.47 m, the
/// paper says 1.5 m.
#[test]
fn the_published_start_settles_to_the_real_height_and_density() {
    let rounded = InputRule::Explicit(RsaStart { height: Metres(0.55), solid_share: Share(0.5) });
    for reading in [ClassReading::En933, ClassReading::OneSieveUp] {
        for (width, rule) in
            [(1.47, InputRule::Published), (1.5, InputRule::Published), (1.47, rounded), (1.5, rounded)]
        {
            let input = tank(width, reading, rule);
            let outcomes: Vec<RsaOutcome> = (0..SEEDS).map(|seed| pack(&input, seed).unwrap()).collect();
            let (height, height_sd) = mean_and_sd(outcomes.iter().map(|o| o.after.top().si()));
            let (solid, solid_sd) = mean_and_sd(outcomes.iter().map(|o| o.after.solid_share().si()));
            let (inner, inner_sd) = mean_and_sd(outcomes.iter().map(|o| o.after.interior_solid_share().si()));
            let (count, count_sd) = mean_and_sd(outcomes.iter().map(|o| o.after.count() as f64));
            println!(
                "{reading:?} {width} m from {:.1} cm: h_final {:.2} cm sd {:.2}, P_c {:.2} % sd {:.2}, interior {:.2} % sd {:.2}, {count:.1} stones sd {count_sd:.1}",
                outcomes[0].input_height.si() * 100.0,
                height * 100.0,
                height_sd * 100.0,
                solid * 100.0,
                solid_sd * 100.0,
                inner * 100.0,
                inner_sd * 100.0
            );
            assert!((height - 0.48).abs() < 0.015, "{height}");
            assert!((solid - 0.58).abs() < 0.02, "{solid}");
            assert!((inner - 0.64).abs() < 0.02, "{inner}");
        }
    }
}

/// Stones needed for 58 % of 1.5 m by 0.48 m: another packer of the same method needed 286–299 with the sieves as they
/// are and 184–189 one sieve up. Independently, renewal theory: stones of area `a` are added until `A_i` is passed, so
/// `N_i = A_i/E[a] + E[a²]/(2 E[a]²)`. The standard error of 100 packings is 0.25; tolerance 1.
#[test]
fn the_number_of_stones_follows_from_the_curve() {
    for (reading, range) in [(ClassReading::En933, 286.0..=299.0), (ClassReading::OneSieveUp, 184.0..=189.0)] {
        let input = tank(1.5, reading, InputRule::Published);
        let (count, _) = mean_and_sd((0..SEEDS).map(|seed| pack(&input, seed).unwrap().after.count() as f64));
        let expected: f64 = input
            .grading
            .classes(reading)
            .unwrap()
            .iter()
            .map(|class| {
                let diameter = |c: f64| class.smallest.si() + (class.largest.si() - class.smallest.si()) * c / 100.0;
                let areas: Vec<f64> =
                    (0..=100).map(|c| std::f64::consts::PI / 4.0 * diameter(f64::from(c)).powi(2)).collect();
                let first = areas.iter().sum::<f64>() / 101.0;
                let second = areas.iter().map(|a| a * a).sum::<f64>() / 101.0;
                class.share.si() * 0.58 * 1.5 * 0.48 / first + second / (2.0 * first * first)
            })
            .sum();
        println!("{reading:?}: {count:.2} stones, renewal theory {expected:.2}");
        assert!((count - expected).abs() < 1.0, "{reading:?}: {count} against {expected}");
        assert!(range.contains(&count), "{reading:?}: {count} outside {range:?}");
    }
}

/// Figure 8 of the paper: the curve that comes out is the curve that went in. A class overshoots its area by less than one
/// stone (eq. 23), so no sieve is off by more than the sum of the largest stones over the solid area, 1.7 %, and the 0.3 %
/// that Table 1 leaves without a size.
#[test]
fn the_grading_that_comes_out_is_the_one_that_went_in() {
    let input = tank(1.5, ClassReading::En933, InputRule::Published);
    let classes = input.grading.classes(ClassReading::En933).unwrap();
    let overshoot: f64 = classes.iter().map(|c| std::f64::consts::PI / 4.0 * c.largest.si().powi(2)).sum();
    let bound = overshoot / (0.58 * 1.5 * 0.48) + 0.003;
    assert!((bound - 0.02).abs() < 0.001, "{bound}");
    for seed in 0..SEEDS {
        for row in pack(&input, seed).unwrap().after.grading_table(&input.grading) {
            assert!(row.deviation().si().abs() < bound, "seed {seed}: {row:?}");
        }
    }
}

/// The paper's fit is alpha 22.5 cm, beta 18.6 cm, and its input height 55.3 cm. Refitting the same tank must lead to the
/// same input height within 1 cm (the rounding of its "55 cm") and to a slope within a third (see the range in
/// [`CalibrationPlan`]); one thread and four give the same bytes.
#[test]
fn refitting_the_tank_gives_the_paper_s_input_height() {
    for reading in [ClassReading::En933, ClassReading::OneSieveUp] {
        let input = tank(1.5, reading, InputRule::Published);
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| calibrate(&input, &CalibrationPlan::default(), |_, _| {}).unwrap())
        };
        let fit = run(1);
        assert!(fit == run(4));
        let start = optimise(input.height, input.voids, fit.fit).unwrap();
        println!(
            "{reading:?}: alpha {:.2} cm, beta {:.2} cm, R2 {:.3}, residual {:.2} cm, start {:.2} cm",
            fit.fit.alpha.si() * 100.0,
            fit.fit.beta.si() * 100.0,
            fit.r_squared,
            fit.residual.si() * 100.0,
            start.height.si() * 100.0
        );
        assert!((fit.fit.alpha.si() / 0.225 - 1.0).abs() < 1.0 / 3.0, "{:?}", fit.fit);
        assert!((start.height.si() - 0.5534).abs() < 0.01, "{start:?}");
        assert!(fit.jammed.is_empty() && fit.points.len() == 60 && fit.r_squared > 0.7, "{fit:?}");
    }
}
