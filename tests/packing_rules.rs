//! What every packing keeps, whatever goes in: no overlap, nothing outside, the stop rule, the same bytes from a seed.

use ballast_gpr::geometry::Disc;
use ballast_gpr::packing::export::json;
use ballast_gpr::packing::grading::Sieve;
use ballast_gpr::packing::{
    ClassReading, Grading, InputRule, Packing, PackingError, RsaInput, RsaStart, compact, pack,
};
use ballast_gpr::units::{Metres, Share};
use proptest::prelude::*;
use rayon::prelude::*;

/// Rounding of a rest position in a domain of metres: a few units in the last place of 1 m, with a margin.
const ROUNDING: f64 = 1e-12;

fn explicit(height: f64, solid_share: f64) -> InputRule {
    InputRule::Explicit(RsaStart { height: Metres(height), solid_share: Share(solid_share) })
}

fn check(before: &Packing, after: &Packing) {
    let deepest = |packing: &Packing| packing.deepest_overlap().map_or(0.0, |overlap| overlap.depth.si());
    assert!(deepest(before) <= 1e-15 && deepest(after) <= ROUNDING, "{} {}", deepest(before), deepest(after));
    for (placed, settled) in before.discs.iter().zip(&after.discs) {
        let (width, height) = (before.width.si(), before.height.si());
        assert!(placed.x - placed.radius >= 0.0 && placed.x + placed.radius <= width, "{placed:?}");
        assert!(placed.y - placed.radius >= 0.0 && placed.y + placed.radius <= height, "{placed:?}");
        assert_eq!((placed.x, placed.radius), (settled.x, settled.radius));
        assert!(settled.y <= placed.y + ROUNDING && settled.y >= settled.radius, "{placed:?} {settled:?}");
    }
}

fn rests(disc: &Disc, all: &[Disc]) -> bool {
    (disc.y - disc.radius).abs() < ROUNDING || all.iter().any(|d| d.y < disc.y && disc.gap(d).abs() < ROUNDING)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(48) })]

    /// Any tank, any density that RSA reaches, both readings.
    #[test]
    fn stones_keep_apart_stay_inside_and_come_to_rest(
        width in 0.4..3.0_f64, height in 0.25..1.2_f64, solid in 0.05..0.48_f64, seed: u64, up: bool, strip in 0.001..0.5_f64,
    ) {
        let class_reading = if up { ClassReading::OneSieveUp } else { ClassReading::En933 };
        let base = RsaInput::benedetto2018().unwrap();
        let input = RsaInput { width: Metres(width), class_reading, input: explicit(height, solid), strip: Metres(strip), ..base };
        let outcome = pack(&input, seed);
        // Five classes may overshoot a small tank by a stone each and jam it; such cases are drawn again.
        prop_assume!(!matches!(outcome, Err(PackingError::Jammed { .. })));
        let outcome = outcome.unwrap();
        check(&outcome.before, &outcome.after);
        prop_assert!(outcome.after.discs.iter().all(|disc| rests(disc, &outcome.after.discs)));
        prop_assert_eq!(outcome.after.height, outcome.after.top());
        // Equation 23, class by class, and no stone after the area was passed.
        let mut placed = outcome.before.discs.iter();
        for class in &outcome.classes {
            let stones: Vec<&Disc> = placed.by_ref().take(class.stones).collect();
            let largest = std::f64::consts::PI * (0.5 * class.class.largest.si()).powi(2);
            let sum: f64 = stones.iter().map(|disc| disc.area()).sum();
            prop_assert!(class.wanted_area < sum && sum <= class.wanted_area + largest * (1.0 + 1e-12), "{:?}", class);
            prop_assert!(sum - stones.last().unwrap().area() <= class.wanted_area * (1.0 + 1e-12));
            // Equation 21: one of 101 diameters.
            for disc in stones {
                let range = class.class.largest.si() - class.class.smallest.si();
                let step = (2.0 * disc.radius - class.class.smallest.si()) / range * 100.0;
                prop_assert!((step - step.round()).abs() < 1e-9 && (-1e-9..=100.000_001).contains(&step), "{}", step);
            }
        }
        prop_assert!(placed.next().is_none());
    }

    /// The order inside a strip is by height, so that strips of any height give the same bed; and the columns find what
    /// looking at every disc finds.
    #[test]
    fn the_strip_height_does_not_matter(seed: u64, strip in 0.0005..2.0_f64) {
        let base = RsaInput::benedetto2018().unwrap();
        let before = pack(&RsaInput { width: Metres(0.8), ..base }, seed).unwrap().before;
        let settled = compact(&before.discs, 0.8, strip);
        prop_assert_eq!(&settled, &compact(&before.discs, 0.8, 0.02));
        let mut order: Vec<Disc> = before.discs.clone();
        order.sort_by(|a, b| a.y.total_cmp(&b.y));
        let mut plain: Vec<Disc> = Vec::new();
        for disc in order {
            let on = |d: &Disc| {
                let sum = d.radius + disc.radius;
                ((d.x - disc.x).abs() < sum).then(|| d.y + (sum * sum - (d.x - disc.x).powi(2)).sqrt())
            };
            plain.push(Disc { y: plain.iter().filter_map(on).fold(disc.radius, f64::max), ..disc });
        }
        for disc in &settled {
            prop_assert!(plain.iter().any(|d| d.x == disc.x && (d.y - disc.y).abs() < ROUNDING), "{:?}", disc);
        }
    }
}

#[test]
fn a_seed_gives_the_same_bytes_on_any_number_of_threads() {
    let input = RsaInput::benedetto2018().unwrap();
    let bytes = |seed| json(&pack(&input, seed).unwrap().after).unwrap();
    let in_pool = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| (0..16_u64).into_par_iter().map(bytes).collect::<Vec<_>>())
    };
    let one = in_pool(1);
    assert!(one == in_pool(4) && one[7] == bytes(7));
    assert_ne!(one[0], one[1]);
}

/// Discs of one size placed until none fits cover 54.70 % of an endless plane (Feder 1980; Hinrichsen, Feder & Jøssang
/// 1986: 0.547). Walls lower that by an amount that falls as diameter over side, so two sides extrapolate to none. The
/// standard deviation from seed to seed is 0.125 % at 100 diameters and 0.08 % at 200, hence a standard error of 0.065 %
/// of the extrapolated mean of 10 seeds; tolerance four of them and half of the last digit of 0.547.
#[test]
fn discs_of_one_size_jam_where_they_are_known_to() {
    let one_size =
        Grading::new("40 mm", vec![Sieve::new(Metres(0.04), Share(0.0)), Sieve::new(Metres(0.040_000_04), Share(1.0))])
            .unwrap();
    let jam = |diameters: f64, seed: u64| {
        let base = RsaInput::benedetto2018().unwrap();
        let side = 0.04 * diameters;
        let input = RsaInput { width: Metres(side), grading: one_size.clone(), input: explicit(side, 0.7), ..base };
        let PackingError::Jammed { solid_share, wanted, .. } = pack(&input, seed).unwrap_err() else {
            panic!("not jammed")
        };
        assert_eq!(wanted, Share(0.7));
        solid_share.si()
    };
    let mean = |diameters: f64| (0..10).into_par_iter().map(|seed| jam(diameters, seed)).sum::<f64>() / 10.0;
    let (small, large) = (mean(100.0), mean(200.0));
    let endless = 2.0 * large - small;
    println!("covered: {small:.4} at 100 diameters, {large:.4} at 200, {endless:.4} without walls");
    assert!((endless - 0.547).abs() < 0.003, "{small} {large} -> {endless}");
}

#[test]
fn what_cannot_be_packed_is_said() {
    let base = RsaInput::benedetto2018().unwrap();
    let message = |input: RsaInput| pack(&input, 1).unwrap_err().to_string();
    let jammed = message(RsaInput { input: explicit(0.48, 0.75), ..base.clone() });
    let (before, after) = jammed.split_once(" after ").unwrap();
    assert_eq!(before, "jammed: no room is left for a stone of the class 31.5 mm to 40 mm");
    let (placed, rest) = after.split_once(" of its area, with ").unwrap();
    let (covered, rest) = rest.split_once(" of the domain covered and ").unwrap();
    assert_eq!(
        rest,
        "75% wanted\n\nhint: try another `--seed`, or a higher input height with a lower input solid share"
    );
    let share = |text: &str| text.parse::<Share>().unwrap().si();
    assert!((0.0..1.0).contains(&share(placed)), "{placed}");
    assert!(share(covered) > 0.5 && share(covered) < 0.7, "{covered}");
    assert_eq!(
        message(RsaInput { width: Metres(0.05), ..base.clone() }),
        "stone larger than the tank: stones reach 63 mm but the tank is 0.05 m wide and 0.5534 m high before compaction\n\nhint: choose a finer grading, or widen the tank (the paper keeps it ten stones wide)"
    );
    assert_eq!(
        message(RsaInput { width: Metres(-1.0), ..base.clone() }),
        "the width of the bed of -1 m is not a length to build with: it must be above 0 m and finite"
    );
    assert_eq!(
        message(RsaInput { input: explicit(0.55, 1.0), ..base.clone() }),
        "an input solid share of 100% is not between 0% and 100%\n\nhint: the paper's tank starts from 50%"
    );
    let dust = Grading::from_csv("dust", "sieve_mm,passing_percent\n0.01,0\n0.02,100\n").unwrap();
    // 0.36 m² of stone over the mean area, pi/12 (1 + 2 + 4) 1e-10 m².
    let expected = 0.36 / (7.0 * std::f64::consts::PI / 12.0 * 1e-10);
    assert_eq!(
        message(RsaInput { grading: dust, input: explicit(0.48, 0.5), ..base }),
        format!(
            "this bed needs about {expected:.0} stones of 0.01 mm to 0.02 mm, and at most 20000000 are packed\n\nhint: leave the finest sieves out of the grading, or take a smaller tank"
        )
    );
}

/// A tank only just as wide as its stones stacks them in one column.
#[test]
fn a_tank_as_wide_as_one_stone_is_filled() {
    let grading =
        Grading::new("40 mm", vec![Sieve::new(Metres(0.0399), Share(0.0)), Sieve::new(Metres(0.04), Share(1.0))])
            .unwrap();
    let base = RsaInput::benedetto2018().unwrap();
    let outcome = pack(&RsaInput { width: Metres(0.04), grading, input: explicit(1.0, 0.4), ..base }, 2).unwrap();
    check(&outcome.before, &outcome.after);
    assert!(outcome.after.count() >= 12);
}

/// Every built-in grading packs the tank from 50 % by either reading, fines and all.
#[test]
fn every_grading_packs_the_tank() {
    let cases: Vec<_> =
        Grading::names().flat_map(|n| [(n, ClassReading::En933), (n, ClassReading::OneSieveUp)]).collect();
    cases.into_par_iter().for_each(|(name, class_reading)| {
        let base = RsaInput::benedetto2018().unwrap();
        let grading = Grading::named(name).unwrap();
        let outcome = pack(&RsaInput { grading, class_reading, input: explicit(0.55, 0.5), ..base }, 4).unwrap();
        let (count, top, seconds) = (outcome.after.count(), outcome.after.top(), outcome.seconds_positioning);
        println!("{name} {class_reading:?}: {count} stones, {:.1} cm, {:.1} ms", top.si() * 1e2, seconds.si() * 1e3);
        check(&outcome.before, &outcome.after);
        // Equation 23: from above half to half and one largest stone per class.
        let most: f64 = outcome.classes.iter().map(|c| std::f64::consts::PI / 4.0 * c.class.largest.si().powi(2)).sum();
        let solid = outcome.before.solid_area() - 0.5 * 1.5 * 0.55;
        assert!(solid > 0.0 && solid <= most, "{name}: {solid} of {most}");
    });
}

/// A scene holds the whole input: TOML gives it back unchanged, whatever rule and grading.
#[test]
fn an_input_is_written_to_toml_and_read_back() {
    let text = "width = \"1.5m\"\nheight = \"48cm\"\nvoids = \"42%\"\ngrading = \"benedetto2018\"\n";
    let input: RsaInput = toml::from_str(text).unwrap();
    assert_eq!(input, RsaInput::benedetto2018().unwrap());
    let fit = "class_reading = \"one-sieve-up\"\ninput = { fit = { alpha = \"25cm\", beta = \"21cm\" } }\n";
    let given = "input = { explicit = { height = \"55cm\", solid_share = \"50%\" } }\nstrip = \"1cm\"\n";
    for more in ["", fit, given, "input = \"published\"\n"] {
        let input: RsaInput = toml::from_str(&format!("{text}{more}")).unwrap();
        assert_eq!(toml::from_str::<RsaInput>(&toml::to_string(&input).unwrap()).unwrap(), input, "{more}");
    }
    let error = toml::from_str::<RsaInput>(&text.replace("42%", "0%")).unwrap_err().to_string();
    assert!(error.contains("voids of 0% leave no space between the stones"), "{error}");
}
