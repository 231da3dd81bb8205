//! A hundred thousand steps in closed boxes.

use ballast_gpr::fdtd::{InstructionSet, Precision};

use super::mode::{Mode, fields, largest, read, run};

const STEPS: usize = 100_000;
const WINDOW: usize = 10_000;

/// A closed box of 24 x 20 cells, or 14 x 12 x 10, with something in it, a pulse, and receivers all over.
fn scene(mode: Mode, factor: f64, contents: &str) -> String {
    let (cells, spacing) = (if mode == Mode::Three { [14, 12, 10] } else { [24, 20, 16] }, [0.004; 3]);
    let mut text = mode.grid(cells, spacing, [0; 6]);
    text += &format!("#time_window: {STEPS}\n#time_step_stability_factor: {factor}\n#waveform: ricker 1 1.5e9 w\n");
    let at = |node: [usize; 3]| mode.point(mode.node(node), spacing);
    text += &format!("#hertzian_dipole: {} {} w\n", mode.polarisations()[0], at([5, 4, 4]));
    for node in [[5, 4, 4], [7, 5, 5], [10, 8, 7], [4, 9, 6], [11, 3, 3], [6, 6, 8], [9, 10, 5]] {
        text += &format!("#rx: {}\n", at(node));
    }
    text + contents
}

/// A block in the middle and one beside it, through the whole of an invariant axis.
fn blocks(mode: Mode, first: &str, second: &str) -> String {
    let spacing = [0.004; 3];
    let block = |mut low: [usize; 3], mut high: [usize; 3], material: &str| {
        if let Some(axis) = mode.invariant() {
            (low[axis], high[axis]) = (0, if mode == Mode::Te { 2 } else { 1 });
        }
        format!("#box: {} {} {material}\n", mode.point(low, spacing), mode.point(high, spacing))
    };
    block([6, 5, 5], [9, 8, 7], first) + &block([2, 8, 2], [4, 10, 5], second)
}

/// Mean square of E over all receivers, less what stays for ever (charges at rest), in each window.
fn energies(mode: Mode, precision: Precision, factor: f64, contents: &str) -> Vec<f64> {
    let model = read(&scene(mode, factor, contents)).unwrap();
    let (traces, _) = run(&model, precision, 1, InstructionSet::Auto).unwrap();
    for magnetic in [false, true] {
        assert!(largest(&traces, magnetic, 0..STEPS).is_finite(), "{mode:?}");
    }
    let of = |window: usize| {
        fields(&traces, false)
            .map(|samples| {
                let samples = &samples[window * WINDOW..(window + 1) * WINDOW];
                let mean = samples.iter().sum::<f64>() / WINDOW as f64;
                samples.iter().map(|v| (v - mean).powi(2)).sum::<f64>()
            })
            .sum()
    };
    (0..STEPS / WINDOW).map(of).collect()
}

/// Without loss energy stays: every window holds as much as the second, within what beating modes may share out differently
/// between seven receivers (a factor of two). At a stability factor of 0.99 and at the limit itself.
#[test]
fn boxes_with_conductors_ring_for_ever() {
    for mode in [Mode::Tmz, Mode::Te, Mode::Three] {
        for (precision, factor) in [(Precision::Single, 0.99), (Precision::Double, 0.99), (Precision::Single, 1.0)] {
            let contents = blocks(mode, "pec", "pec");
            let found = energies(mode, precision, factor, &contents);
            let reference = found[1];
            assert!(reference > 0.0);
            let within = |energy: &f64| (0.5..2.0).contains(&(energy / reference));
            assert!(found[1..].iter().all(within), "{mode:?} {precision:?} {factor}: {found:?}");
        }
    }
}

/// With loss energy only falls, to the floor of rounding: `1e5` steps of half a unit in the last place each, at random.
#[test]
fn boxes_with_loss_fall_silent() {
    let wet = "#material: 4 0 1 0 wet\n#add_dispersion_debye: 2 6 2e-11 2 3e-10 wet\n";
    let lossy = "#material: 6 0.03 1 0 lossy\n#material: 3 0.001 1 0 dry\n";
    for mode in [Mode::Tmz, Mode::Te, Mode::Three] {
        for (name, materials, blocks) in [
            ("lossy", lossy, blocks(mode, "lossy", "dry")),
            ("Debye", wet, blocks(mode, "wet", "wet")),
            (
                "lossy, Debye and conductor",
                &format!("{lossy}{wet}"),
                blocks(mode, "wet", "pec") + &blocks(mode, "lossy", "pec"),
            ),
        ] {
            for (precision, unit) in [(Precision::Single, f64::from(f32::EPSILON)), (Precision::Double, f64::EPSILON)] {
                let found = energies(mode, precision, 0.99, &format!("{materials}{blocks}"));
                let floor = found[0] * (unit / 2.0).powi(2) * STEPS as f64;
                for pair in found.windows(2) {
                    assert!(pair[1] <= pair[0] + floor, "{mode:?}, {name}, {precision:?}: {found:?}");
                }
                assert!(found[9] < 1e-3 * found[0], "{mode:?}, {name}, {precision:?}: {found:?}");
            }
        }
    }
}

/// Beyond the limit nothing runs: the reader refuses it, and so does the solver where a model comes another way.
#[test]
fn steps_beyond_the_courant_limit_are_refused() {
    for mode in Mode::ALL {
        let message = read(&scene(mode, 1.01, "")).unwrap_err().to_string();
        assert!(message.contains("factor") && message.contains("1.01"), "{message}");
        let mut model = read(&scene(mode, 0.99, "")).unwrap();
        model.stability_factor = 1.01;
        let message = run(&model, Precision::Single, 1, InstructionSet::Auto).unwrap_err().to_string();
        assert!(message.starts_with("a time step of 1.01 times the Courant limit is not stable"), "{message}");
    }
}
