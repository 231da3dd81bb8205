//! The hard cases in every mode: contrast, conductivity, features of one cell, fast poles, sources on faces, objects in the
//! absorbing boundary, tiny grids, oblong cells.

use ballast_gpr::fdtd::{InstructionSet, Precision};
use ballast_gpr::units::constants::EPSILON_0;

use super::mode::{Mode, components, largest, read, run};

/// The strongest field that a Ricker pulse of 1 A can make at its own edge, V/m: its largest charge, `exp(-1/2)/(sqrt(2) pi f)`,
/// over the smallest face of a cell, with nothing to carry it away; half as much again for other waves on top of it.
fn strongest(spacing: [f64; 3], frequency: f64) -> f64 {
    let face = (spacing[0] * spacing[1]).min(spacing[1] * spacing[2]).min(spacing[2] * spacing[0]);
    1.5 * (-0.5f64).exp() / (2f64.sqrt() * std::f64::consts::PI * frequency) / (EPSILON_0 * face)
}

/// Runs a scene for four windows, in both precisions: finite, at no time stronger than the source allows, and gone at the end.
fn dies_away(name: &str, mode: Mode, text: &str, most: f64, left: f64) {
    for precision in [Precision::Single, Precision::Double] {
        let model = read(text).unwrap_or_else(|error| panic!("{name}, {mode:?}: {error}\n{text}"));
        let (traces, _) =
            run(&model, precision, 2, InstructionSet::Auto).unwrap_or_else(|error| panic!("{name}, {mode:?}: {error}"));
        assert_eq!(traces.receivers[0].components.len(), components());
        let window = traces.iterations / 4;
        for magnetic in [false, true] {
            let peaks: Vec<f64> = (0..4).map(|n| largest(&traces, magnetic, n * window..(n + 1) * window)).collect();
            let top = peaks.iter().fold(0.0, |top: f64, peak| top.max(*peak));
            assert!(top > 0.0 && top < most, "{name}, {mode:?}, {precision:?}: {peaks:?}");
            assert!(peaks[3] <= left * top, "{name}, {mode:?}, {precision:?}: {peaks:?}");
        }
    }
}

/// Air, absorbing cells all around, a pulse in the upper part, two receivers; then objects, given in cells.
fn scene(
    mode: Mode,
    spacing: [f64; 3],
    frequency: f64,
    objects: &[([usize; 3], [usize; 3], &str)],
    materials: &str,
) -> String {
    let cells = if mode == Mode::Three { [22, 20, 24] } else { [40, 36, 38] };
    let mut text = mode.grid(cells, spacing, [5; 6]);
    text += &format!("#time_window: 3000\n#waveform: ricker 1 {frequency:e} w\n{materials}");
    let at = |node: [usize; 3]| mode.point(mode.node(node), spacing);
    text += &format!("#hertzian_dipole: {} {} w\n", mode.polarisations()[0], at([10, 12, 12]));
    text += &format!("#rx: {}\n#rx: {}\n#rx: {}\n", at([10, 12, 12]), at([12, 13, 14]), at([14, 8, 9]));
    for (low, high, material) in objects {
        let (mut low, mut high) = (*low, *high);
        for axis in 0..3 {
            high[axis] = high[axis].min(cells[axis]);
            if Some(axis) == mode.invariant() {
                (low[axis], high[axis]) = (0, if mode == Mode::Te { 2 } else { 1 });
            }
        }
        text += &format!("#box: {} {} {material}\n", mode.point(low, spacing), mode.point(high, spacing));
    }
    text
}

const CUBES: [f64; 3] = [0.002; 3];
const ALL: usize = 99;

#[test]
fn contrasts_and_conductivities() {
    for mode in Mode::ALL {
        // Eps_r 80 beside air, six cells in the shortest wave: water rings, so 3 % may be left.
        let water = [([11, 4, 8], [16, 9, 13], "water")];
        dies_away(
            "1:80",
            mode,
            &scene(mode, CUBES, 1e9, &water, "#material: 80 0.01 1 0 water\n"),
            strongest(CUBES, 1e9),
            0.03,
        );
        for exponent in [-8, -4, -2, 0, 2, 4, 8] {
            let half = [([0, 0, 0], [ALL, ALL, 10], "clay"), ([0, 0, 0], [ALL, 9, ALL], "clay")];
            let half = &half[usize::from(mode.invariant() == Some(2))..][..1];
            let text = scene(mode, CUBES, 2e9, half, &format!("#material: 5 1e{exponent} 1 0 clay\n"));
            dies_away(&format!("1e{exponent} S/m"), mode, &text, strongest(CUBES, 2e9), 1e-2);
        }
    }
}

#[test]
fn features_of_one_cell_and_fast_poles() {
    for mode in Mode::ALL {
        let specks = [
            ([8, 6, 7], [9, 7, 8], "pec"),
            ([12, 6, 7], [13, 7, 8], "clay"),
            ([14, 10, 7], [15, 11, 8], "stone"),
            ([7, 15, 15], [8, 16, 16], "wet"),
        ];
        let materials = "#material: 5 10 1 0 clay\n#material: 9 0 1 0 stone\n#material: 3 0 1 0 wet\n\
                         #add_dispersion_debye: 3 5 1e-15 3 1e-12 2 1e-9 wet\n";
        dies_away("one cell", mode, &scene(mode, CUBES, 2e9, &specks, materials), strongest(CUBES, 2e9), 1e-2);
        let layer = [([0, 0, 0], [ALL, ALL, 10], "wet"), ([0, 0, 0], [ALL, 9, ALL], "wet")];
        let layer = &layer[usize::from(mode.invariant() == Some(2))..][..1];
        dies_away("fast poles", mode, &scene(mode, CUBES, 2e9, layer, materials), strongest(CUBES, 2e9), 1e-2);
    }
}

#[test]
fn sources_on_faces_and_objects_in_the_boundary() {
    for mode in Mode::ALL {
        let faces = [
            ([0, 0, 0], [ALL, 12, 12], "stone"),
            ([10, 12, 12], [ALL, ALL, ALL], "clay"),
            ([0, 3, 3], [4, 7, 7], "pec"),
        ];
        let materials = "#material: 6 0 1 0 stone\n#material: 9 0.05 1 0 clay\n";
        dies_away("faces", mode, &scene(mode, CUBES, 2e9, &faces, materials), strongest(CUBES, 2e9), 1e-2);
    }
}

#[test]
fn oblong_cells_of_one_to_ten() {
    for mode in Mode::ALL {
        for spacing in [[0.0004, 0.004, 0.002], [0.004, 0.0004, 0.0004], [0.002, 0.0005, 0.004]] {
            let stone = [([12, 5, 5], [17, 11, 10], "stone")];
            let mut text = scene(mode, spacing, 2e9, &stone, "#material: 4 0.05 1 0 stone\n");
            // Steps are as short as the shortest side wants them.
            text = text.replace("#time_window: 3000", "#time_window: 8000");
            dies_away(&format!("{spacing:?}"), mode, &text, strongest(spacing, 2e9), 2e-2);
        }
    }
}

/// From the smallest grids that hold a source and something beside it, closed and with an absorbing cell on each side.
#[test]
fn tiny_grids() {
    for mode in Mode::ALL {
        for (cells, absorbing) in [([2, 2, 2], 0), ([2, 3, 4], 0), ([3, 3, 3], 1), ([5, 4, 3], 1), ([4, 7, 5], 1)] {
            let mut text = mode.grid(cells, CUBES, [absorbing; 6]);
            text += "#time_window: 400\n#waveform: ricker 1 5e9 w\n";
            let middle = mode.point(mode.node(cells.map(|count| count / 2)), CUBES);
            text += &format!("#hertzian_dipole: {} {middle} w\n#rx: {middle}\n", mode.polarisations()[0]);
            text += &format!("#rx: {}\n", mode.point(mode.node(cells), CUBES));
            let model = read(&text).unwrap_or_else(|error| panic!("{mode:?} {cells:?}: {error}"));
            for precision in [Precision::Single, Precision::Double] {
                let traces = run(&model, precision, 4, InstructionSet::Auto)
                    .unwrap_or_else(|e| panic!("{mode:?} {cells:?}: {e}"))
                    .0;
                let top = largest(&traces, false, 0..400);
                assert!(top > 0.0 && top < strongest(CUBES, 5e9), "{mode:?} {cells:?} {absorbing}: {top:e}");
            }
        }
    }
}
