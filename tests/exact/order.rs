//! The order of accuracy in three dimensions, from the magnetic field of a dipole in free space.

use std::f64::consts::PI;

use ballast_gpr::model::{Axis, TimeWindow};
use ballast_gpr::trace::Component;
use ballast_gpr::units::constants::C0;

use super::setting::{add_dipole, add_pulse, add_receiver, empty, relative_l2, samples, solve};

/// Hy of a dipole along z, `dl` long, at `x` from it in its plane: `dl/(4 pi) (I'/(c x) + I/x²)` at `t - x/c` (Balanis, Antenna
/// Theory, section 4.2).
fn exact(x: f64, dl: f64, t: f64) -> f64 {
    let (zeta, tau) = ((PI * 1e9f64).powi(2), t - x / C0 - 2f64.sqrt() / 1e9);
    let bell = (-zeta * tau * tau).exp();
    let current = (1.0 - 2.0 * zeta * tau * tau) * bell;
    let rise = (4.0 * zeta * tau * tau - 6.0) * zeta * tau * bell;
    dl / (4.0 * PI) * (rise / (C0 * x) + current / (x * x))
}

/// Hy lies half a cell beyond its node. The walls are too far away for an echo.
fn error(cell: f64) -> f64 {
    let count = |metres: f64| (metres / cell).round() as usize;
    let cells = count(0.72);
    let mut model = empty([cells; 3], [cell; 3], 1);
    model.time_window = TimeWindow::Seconds(1.9e-9);
    let pulse = add_pulse(&mut model, 1.0);
    add_dipole(&mut model, Axis::Z, [cells / 2; 3], pulse, None);
    let away = count(0.096);
    add_receiver(&mut model, [cells / 2 + away, cells / 2, cells / 2]);
    let traces = solve(&model);
    let trace = traces.receivers[0].component(Component::Hy).unwrap();
    let x = (away as f64 + 0.5) * cell;
    let expected: Vec<f64> = trace.times().map(|t| exact(x, cell, t)).collect();
    relative_l2(samples(&traces, 0, Component::Hy), &expected)
}

/// 12, 8 and 6 mm: each pair gives an order of 2.0 within 0.1.
#[test]
fn the_order_in_three_dimensions_is_two() {
    let [coarse, middle, fine] = [0.012, 0.008, 0.006].map(error);
    let orders = [(coarse / middle).ln() / 1.5f64.ln(), (middle / fine).ln() / (4.0f64 / 3.0).ln()];
    println!("Hy of a dipole, errors {coarse:.2e} {middle:.2e} {fine:.2e}, orders {orders:.3?}");
    assert!(orders.iter().all(|order| (order - 2.0).abs() < 0.1), "{orders:?} from {coarse:e} {middle:e} {fine:e}");
}
