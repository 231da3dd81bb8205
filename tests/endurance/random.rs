//! Random scenes: whatever is drawn, the field is finite, the same on every machine, and that of double precision.

use ballast_gpr::fdtd::{FdtdError, InstructionSet, Precision};
use ballast_gpr::trace::Traces;
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::mode::{Mode, fields, largest, read, run};

const SCENES: u64 = 250;
const STEPS: usize = 120;

/// Draws a scene as an input file.
fn draw(seed: u64) -> (Mode, String) {
    let mut random = Pcg64::seed_from_u64(seed);
    let mode = Mode::ALL[random.random_range(0..Mode::ALL.len())];
    // Some are so large that several threads share them.
    let large = seed.is_multiple_of(8);
    let range = match (mode == Mode::Three, large) {
        (true, false) => 6..16,
        (true, true) => 30..36,
        (false, false) => 8..50,
        (false, true) => 150..190,
    };
    let cells: [usize; 3] = std::array::from_fn(|_| random.random_range(range.clone()));
    let cells = mode.cells(cells);
    let spacing: [f64; 3] = std::array::from_fn(|_| f64::from(random.random_range(5..20)) * 1e-4);
    let absorbing: [usize; 6] =
        std::array::from_fn(|side| random.random_range(0..=cells[side % 3].div_ceil(3).min(8) - 1));
    let mut text = mode.grid(cells, spacing, absorbing);
    text += &format!("#time_window: {STEPS}\n#time_step_stability_factor: {:.3}\n", random.random_range(0.4..1.0));

    let mut densest = 1.0f64;
    let mut names = vec!["pec".to_owned(), "free_space".to_owned()];
    for number in 0..random.random_range(1..6) {
        let name = format!("m{number}");
        let eps = random.random_range(1.0..20.0);
        let sigma = if random.random_bool(0.5) { 0.0 } else { 10f64.powf(random.random_range(-6.0..4.0)) };
        let magnetic = random.random_bool(0.15);
        let (mu, loss) =
            if magnetic { (random.random_range(1.0..3.0), random.random_range(0.0..100.0)) } else { (1.0, 0.0) };
        text += &format!("#material: {eps:.4} {sigma:e} {mu:.4} {loss:.4} {name}\n");
        let mut rest = eps;
        if random.random_bool(0.3) {
            let poles = random.random_range(1..4);
            text += &format!("#add_dispersion_debye: {poles}");
            for _ in 0..poles {
                let (delta, tau) = (random.random_range(0.0..10.0), 10f64.powf(random.random_range(-14.0..-8.0)));
                text += &format!(" {delta:.4} {tau:e}");
                rest += delta;
            }
            text += &format!(" {name}\n");
        } else if random.random_bool(0.3) {
            // Within what a step can follow (the shortest cell sets it), and damped so that the resonance is no spike.
            let shortest = spacing.iter().fold(f64::INFINITY, |shortest, d| shortest.min(*d));
            let fastest = 299_792_458.0 / (2.0 * std::f64::consts::PI * shortest);
            if random.random_bool(0.5) && eps >= 4.0 {
                let (delta, f) = (random.random_range(0.0..4.0), random.random_range(0.01..0.5) * fastest);
                let damping = random.random_range(0.3..0.9) * 2.0 * std::f64::consts::PI * f;
                text += &format!("#add_dispersion_lorentz: 1 {delta:.4} {f:e} {damping:e} {name}\n");
                rest += 2.0 * delta;
            } else {
                let f = random.random_range(0.001..0.02) * fastest;
                let collisions = random.random_range(0.3..3.0) * 2.0 * std::f64::consts::PI * f;
                text += &format!("#add_dispersion_drude: 1 {f:e} {collisions:e} {name}\n");
            }
        }
        densest = densest.max(rest * mu);
        names.push(name);
    }
    if random.random_bool(0.2) {
        text += "#magnetic_averaging: arithmetic\n";
    }
    if random.random_bool(0.15) {
        text += "#dispersive_averaging: y\n";
    }
    if random.random_bool(0.2) {
        text += &noise(mode, cells, spacing, &mut random);
        densest = densest.max(8.0);
    }
    // Five cells in the shortest wave.
    let longest = spacing.iter().fold(0.0f64, |longest, d| longest.max(*d));
    let frequency = 299_792_458.0 / (5.0 * 3.6 * longest * densest.sqrt());
    for (number, kind) in ["ricker", "gaussian", "gaussiandotnorm"].iter().enumerate() {
        text += &format!("#waveform: {kind} {:.3} {frequency:e} w{number}\n", random.random_range(0.1..2.0));
    }
    for _ in 0..random.random_range(0..9) {
        text += &object(mode, cells, spacing, &names, &mut random);
    }
    let inner = |random: &mut Pcg64| {
        let node = std::array::from_fn(|axis| if cells[axis] > 2 { random.random_range(1..cells[axis]) } else { 0 });
        mode.point(mode.node(node), spacing)
    };
    for _ in 0..random.random_range(1..4) {
        let polarisation = mode.polarisations()[random.random_range(0..mode.polarisations().len())];
        let place = inner(&mut random);
        let wave = random.random_range(0..3);
        text += &match random.random_range(0..6) {
            0 => {
                let across = mode.magnetic_polarisations();
                format!("#magnetic_dipole: {} {place} w{wave}\n", across[random.random_range(0..across.len())])
            }
            1 => {
                let ohm = if random.random_bool(0.3) { 0.0 } else { random.random_range(1.0..300.0) };
                format!("#voltage_source: {polarisation} {place} {ohm:.3} w{wave}\n")
            }
            _ => format!("#hertzian_dipole: {polarisation} {place} w{wave}\n"),
        };
        text += &format!("#rx: {place}\n");
    }
    for _ in 0..random.random_range(1..6) {
        text += &format!("#rx: {}\n", inner(&mut random));
    }
    (mode, text)
}

/// Draws a box of noise, of four materials.
fn noise(mode: Mode, cells: [usize; 3], spacing: [f64; 3], random: &mut Pcg64) -> String {
    let [a, b] = corners(mode, cells, random).map(|corner| mode.point(corner, spacing));
    let (dimension, seed) = (random.random_range(0.0..3.0), random.random_range(0..1000));
    format!(
        "#material_range: 2 8 0 0.05 1 1.2 0 5 ores\n#fractal_box: {a} {b} {dimension:.2} 1 2 1 4 ores lode {seed}\n"
    )
}

/// The corners of a box.
fn corners(mode: Mode, cells: [usize; 3], random: &mut Pcg64) -> [[usize; 3]; 2] {
    let mut low: [usize; 3] = std::array::from_fn(|axis| random.random_range(0..cells[axis]));
    let mut high: [usize; 3] = std::array::from_fn(|axis| random.random_range(low[axis] + 1..=cells[axis]));
    if let Some(axis) = mode.invariant() {
        (low[axis], high[axis]) = (0, cells[axis]);
    }
    [low, high]
}

/// Draws an object of any shape.
fn object(mode: Mode, cells: [usize; 3], spacing: [f64; 3], names: &[String], random: &mut Pcg64) -> String {
    let mut material = names[random.random_range(0..names.len())].clone();
    let mut flag = if random.random_bool(0.7) { " y" } else { " n" };
    if random.random_bool(0.15) {
        // One for each axis, none of them a conductor.
        let any = |random: &mut Pcg64| names[random.random_range(1..names.len())].as_str();
        (material, flag) = ([any(random), any(random), any(random)].join(" "), "");
    }
    let extent = |axis: usize| cells[axis] as f64 * spacing[axis];
    let shortest = (0..3).filter(|&axis| cells[axis] > 2).map(extent).fold(f64::INFINITY, f64::min);
    let radius = random.random_range(0.1..0.45) * shortest;
    let [low, high] = corners(mode, cells, random);
    let (a, b) = (mode.point(low, spacing), mode.point(high, spacing));
    let along = mode.invariant().unwrap_or(random.random_range(0..3));
    let [p, q] = [[1, 2], [0, 2], [0, 1]][along];
    let metres = |node: [usize; 3], axis: usize| node[axis] as f64 * spacing[axis];
    let solid = mode == Mode::Three;
    match random.random_range(0..9) {
        0 => {
            let mut end = low;
            end[along] = high[along];
            format!("#cylinder: {a} {} {radius:.6} {material}{flag}\n", mode.point(end, spacing))
        }
        1 if solid => format!("#sphere: {a} {radius:.6} {material}{flag}\n"),
        2 => {
            let [x, y, z]: [f64; 3] = std::array::from_fn(|_| random.random_range(0.5..1.0) * radius);
            format!("#ellipsoid: {a} {x:.6} {y:.6} {z:.6} {material}{flag}\n")
        }
        3 if solid => format!("#cone: {a} {b} {radius:.6} {:.6} {material}{flag}\n", 0.3 * radius),
        4 => {
            let (start, sweep) = (random.random_range(0.0..359.0), random.random_range(30.0..359.0));
            let [u, v, from, to] = [metres(low, p), metres(low, q), metres(low, along), metres(high, along)];
            let axis = ["x", "y", "z"][along];
            let place = format!("{axis} {u:.7} {v:.7} {from:.7} {to:.7}");
            format!("#cylindrical_sector: {place} {radius:.6} {start:.1} {sweep:.1} {material}{flag}\n")
        }
        5 => {
            let (mut second, mut third) = (low, low);
            (second[p], third[q]) = (high[p], high[q]);
            let thickness = metres(high, along) - metres(low, along);
            let [b, c] = [second, third].map(|corner| mode.point(corner, spacing));
            format!("#triangle: {a} {b} {c} {thickness:.7} {material}{flag}\n")
        }
        6 => {
            let mut end = high;
            end[p] = low[p];
            let material = material.split(' ').next().unwrap_or("pec");
            format!("#plate: {a} {} {material}\n", mode.point(end, spacing))
        }
        7 => {
            let mut end = low;
            end[along] = high[along];
            let material = material.split(' ').next().unwrap_or("pec");
            format!("#edge: {a} {} {material}\n", mode.point(end, spacing))
        }
        _ => format!("#box: {a} {b} {material}{flag}\n"),
    }
}

fn same_bits(a: &Traces, b: &Traces) -> bool {
    [false, true].into_iter().all(|magnetic| {
        fields(a, magnetic)
            .zip(fields(b, magnetic))
            .all(|(a, b)| a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits()))
    })
}

/// At least 200 of 250 scenes run (the others have a source in a conductor, a hard voltage in a dispersive medium, or an object
/// that fills no cell).
///
/// Single precision stays within `8 * 6e-8 * 120` of the strongest E (and H) of the scene, receivers at every source: eight
/// roundings in a step, half a unit in the last place of the strongest value each, added up over 120 steps at worst.
#[test]
fn random_scenes_are_finite_and_the_same_everywhere() {
    let (mut ran, mut shared, mut refused) = ([0; 5], 0, std::collections::BTreeMap::<String, usize>::new());
    let mut furthest = 0.0f64;
    for seed in 0..SCENES {
        let (mode, text) = draw(seed);
        let said = |error: &dyn std::fmt::Display| error.to_string().lines().next().unwrap_or_default().to_owned();
        let model = read(&text).unwrap_or_else(|error| panic!("seed {seed}: {error}\n{text}"));
        let plain = match run(&model, Precision::Double, 1, InstructionSet::Scalar) {
            Ok((traces, _)) => traces,
            Err(error @ (FdtdError::Diverged { .. } | FdtdError::DivergedAt { .. })) => {
                panic!("seed {seed}: {error}\n{text}")
            }
            Err(error) => {
                let words: Vec<String> = said(&error)
                    .split(' ')
                    .filter(|w| !w.contains(|c: char| c.is_ascii_digit()))
                    .map(Into::into)
                    .collect();
                *refused.entry(words.join(" ")).or_default() += 1;
                continue;
            }
        };
        ran[mode as usize] += 1;
        for magnetic in [false, true] {
            let top = largest(&plain, magnetic, 0..STEPS);
            assert!(top.is_finite(), "seed {seed}, {mode:?}\n{text}");
        }
        for precision in [Precision::Double, Precision::Single] {
            let first = run(&model, precision, 1, InstructionSet::Scalar).unwrap().0;
            for (threads, set) in [
                (2, InstructionSet::Scalar),
                (4, InstructionSet::Auto),
                (1, InstructionSet::Avx2),
                (2, InstructionSet::Avx512),
                (1, InstructionSet::Auto),
            ] {
                match run(&model, precision, threads, set) {
                    Ok((traces, stats)) => {
                        shared += usize::from(stats.threads > 1);
                        assert!(
                            same_bits(&traces, &first),
                            "seed {seed}, {mode:?}, {precision:?}, {threads} threads, {}\n{text}",
                            set.name()
                        );
                    }
                    Err(FdtdError::NoSuchInstructions { .. }) => {}
                    Err(error) => panic!("seed {seed}: {error}\n{text}"),
                }
            }
            if precision == Precision::Single {
                for magnetic in [false, true] {
                    let top = largest(&plain, magnetic, 0..STEPS);
                    for (a, b) in fields(&first, magnetic).zip(fields(&plain, magnetic)) {
                        let off = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                        let allowed = 8.0 * f64::from(f32::EPSILON) / 2.0 * STEPS as f64 * top;
                        furthest = furthest.max(if top > 0.0 { off / top } else { 0.0 });
                        assert!(
                            off <= allowed,
                            "seed {seed}, {mode:?}, magnetic {magnetic}: {off:e} of {top:e}\n{text}"
                        );
                    }
                }
            }
        }
    }
    let total: usize = ran.iter().sum();
    println!(
        "{total} scenes ran ({ran:?} in {:?}), {shared} runs on several threads, single precision off by {furthest:.1e} at most",
        Mode::ALL
    );
    println!("refused: {refused:?}");
    assert!(total >= 200 && ran.iter().all(|count| *count >= 20) && shared >= 20, "{ran:?} {shared} {refused:?}");
}
