//! Resonances of closed boxes.

use std::f64::consts::PI;

use ballast_gpr::model::{Axis, Material, Object, Order};
use ballast_gpr::units::constants::C0;

use super::setting::{add_dipole, add_pulse, add_receiver, empty, ez, solve};

/// The frequency at which a box rings, as it was measured and as it is exactly, on the grid and in the continuum, Hz.
///
/// Currents along z with the pattern of a mode, `sin(p pi x/a) sin(q pi y/b) cos(r pi z/c)`, excite that mode alone, and the
/// charges that they leave behind, whose field does not change any more. Once they are over, each sample with its neighbours
/// fulfils `E' - 2 E + 'E = (2 cos(w dt) - 2)(E - rest)`; a straight line through these gives `w`.
fn resonance(cells: [usize; 3], spacing: [f64; 3], mode: [usize; 3], eps_r: f64) -> [f64; 3] {
    resonance_of(cells, spacing, mode, eps_r, Order::Second, (0.9, 4000)).0
}

/// As [`resonance`], of an order, with a factor on the largest step and a number of steps; and the time step.
fn resonance_of(
    cells: [usize; 3],
    spacing: [f64; 3],
    mode: [usize; 3],
    eps_r: f64,
    order: Order,
    (factor, steps): (f64, usize),
) -> ([f64; 3], f64) {
    let mut model = empty(cells, spacing, steps);
    (model.stability_factor, model.order) = (factor, order);
    if eps_r != 1.0 {
        let material = model.add_material(Material::dielectric("filling", eps_r, 0.0));
        let upper = model.grid.node_position(cells);
        model.objects.push(Object::Box { lower: [0.0; 3], upper, material, averaging: true });
    }
    let stop = 3e-9;
    let phase = |axis: usize, place: f64| PI * mode[axis] as f64 * place / cells[axis] as f64;
    for i in 1..cells[0] {
        for j in 1..cells[1] {
            for k in 0..cells[2] {
                let pattern = phase(0, i as f64).sin() * phase(1, j as f64).sin() * phase(2, k as f64 + 0.5).cos();
                let pulse = add_pulse(&mut model, pattern);
                add_dipole(&mut model, Axis::Z, [i, j, k], pulse, Some(stop));
            }
        }
    }
    add_receiver(&mut model, [cells[0] / 2 - 1, cells[1] / 2 - 1, 0]);
    let traces = solve(&model);
    let dt = traces.time_step.si();
    let trace = &ez(&traces, 0)[(stop / dt) as usize + 5..];
    let points: Vec<[f64; 2]> = trace.windows(3).map(|w| [w[1], w[2] - 2.0 * w[1] + w[0]]).collect();
    let mean = |of: usize| points.iter().map(|p| p[of]).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(0), mean(1));
    let slope = points.iter().map(|p| (p[0] - x) * (p[1] - y)).sum::<f64>()
        / points.iter().map(|p| (p[0] - x).powi(2)).sum::<f64>();
    let measured = (1.0 + slope / 2.0).acos() / (2.0 * PI * dt);
    let axes = (0..3).filter(|&axis| cells[axis] > 1);
    let squares = |of: &dyn Fn(usize) -> f64| axes.clone().map(|axis| of(axis).powi(2)).sum::<f64>().sqrt();
    let on_grid = squares(&|axis| {
        let s = (phase(axis, 1.0) / 2.0).sin();
        let more = if order == Order::Fourth { 1.0 + s * s / 6.0 } else { 1.0 };
        2.0 / spacing[axis] * s * more
    });
    let speed = C0 / eps_r.sqrt();
    let exact = squares(&|axis| phase(axis, 1.0) / spacing[axis]);
    ([measured, (speed * dt / 2.0 * on_grid).asin() / (PI * dt), speed * exact / (2.0 * PI)], dt)
}

/// Six modes: the grid's own frequency to 1e-9, the exact one to `((k d)² + (w dt)²)/24` with the longest side of a cell.
#[test]
fn boxes_ring_at_their_resonances() {
    for (cells, spacing, mode, eps_r) in [
        ([24, 20, 1], [0.01, 0.012, 0.01], [1, 1, 0], 1.0),
        ([24, 20, 1], [0.01, 0.012, 0.01], [3, 2, 0], 5.0),
        ([14, 12, 10], [0.01, 0.01, 0.01], [1, 1, 0], 1.0),
        ([14, 12, 10], [0.01, 0.01, 0.01], [1, 1, 1], 1.0),
        ([14, 12, 10], [0.01, 0.012, 0.008], [2, 1, 1], 4.0),
        ([12, 14, 10], [0.01, 0.012, 0.008], [1, 2, 2], 2.5),
    ] {
        let [measured, on_grid, exact] = resonance(cells, spacing, mode, eps_r);
        let k = 2.0 * PI * exact * eps_r.sqrt() / C0;
        let longest = spacing.iter().fold(0.0f64, |longest, d| longest.max(*d));
        let tolerance = 2.0 * (k * longest).powi(2) / 24.0;
        println!(
            "{cells:?} mode {mode:?} eps_r {eps_r}: {:.6} GHz, exact {:.6} GHz, {:.1e} off, tolerance {tolerance:.1e}",
            measured / 1e9,
            exact / 1e9,
            (measured / exact - 1.0).abs()
        );
        assert!((measured / on_grid - 1.0).abs() < 1e-9, "{mode:?}: {measured} {on_grid}");
        assert!((measured / exact - 1.0).abs() < tolerance, "{mode:?}: {measured} {exact}");
    }
}

/// Cells of half the size, a quarter of the error: the order is 2.0 within 0.1, in both dimensions.
#[test]
fn resonances_converge_with_the_square_of_the_cell() {
    for (cells, mode) in [([8, 10, 1], [1, 1, 0]), ([8, 10, 6], [1, 1, 1])] {
        let error = |fine: usize| {
            let cells = cells.map(|count| if count == 1 { 1 } else { count * fine });
            let [measured, _, exact] = resonance(cells, [0.02 / fine as f64; 3], mode, 1.0);
            measured / exact - 1.0
        };
        let order = (error(1) / error(2)).log2();
        println!("mode {mode:?}: order {order:.3}");
        assert!((order - 2.0).abs() < 0.1, "{mode:?}: {order}");
    }
}

/// Differences of fourth order in a box: the grid's own frequency to 1e-9, `|K| = 2/d sin(k d/2) (1 + sin²(k d/2)/6)` along each
/// axis; and with the time step's part taken out, cells of half the size err a sixteenth.
#[test]
fn differences_of_fourth_order_ring_at_their_resonances() {
    for (mode, eps_r) in [([1, 1, 0], 1.0), ([1, 1, 1], 1.0), ([2, 1, 1], 3.0)] {
        let error = |refined: usize| {
            let (cells, d) = ([6 * refined, 5 * refined, 4 * refined], 0.02 / refined as f64);
            let (found, dt) = resonance_of(cells, [d; 3], mode, eps_r, Order::Fourth, (0.5, 1500 * refined));
            let [measured, on_grid, exact] = found;
            assert!((measured / on_grid - 1.0).abs() < 1e-9, "{mode:?}: {measured} {on_grid}");
            ((PI * measured * dt).sin() / (PI * dt) / exact - 1.0).abs()
        };
        let (coarse, fine) = (error(1), error(2));
        let order = (coarse / fine).log2();
        println!("mode {mode:?}: {coarse:e} {fine:e}, order {order:.3}");
        assert!((order - 4.0).abs() < 0.15, "{mode:?}: {order}");
    }
}
