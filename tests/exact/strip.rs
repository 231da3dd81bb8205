//! One-dimensional answers in strips between conducting walls: Fresnel's coefficients, the skin depth.
//!
//! A strip 30 m wide carries the mode `sin(pi y/w)`, which is two plane waves. Sources with these amplitudes excite it alone,
//! for on a grid it is a mode to the bit, with the wave number `2/D sin(pi/(2 n))` across (n cells of D). Along the strip
//! all is one-dimensional, at nearly normal incidence above 0.2 GHz (the mode's cut-off is 5 MHz), and exact:
//! `kx² = eps (w/c)² - ky²`. The strip is so long that nothing comes back from its ends. Both solvers are held to it: in three
//! dimensions the strip is two cells high between conducting plates.

use std::f64::consts::PI;

use ballast_gpr::model::{Axis, DebyePole, Material, Model, Object};
use ballast_gpr::trace::Traces;
use ballast_gpr::units::constants::{C0, EPSILON_0, MU_0};
use rustfft::num_complex::Complex64;

use super::setting::{add_dipole, add_pulse, add_receiver, difference, empty, ez, solve, spectrum};

/// Cells across the strip, and their size.
const ACROSS: (usize, f64) = (4, 7.5);
/// Source, first receiver, and where materials begin, m.
const PLACES: [f64; 3] = [1.5, 1.6, 1.7];
/// Length and time: 10 ns to an end and back at the speed of light.
const LENGTH: f64 = 3.4;
const WINDOW: f64 = 10e-9;
/// Below the Courant limit of one dimension, at which air would have no dispersion at all.
const COURANT: f64 = 0.7;

/// The permittivity of a material.
fn permittivity(material: &Material, w: f64) -> Complex64 {
    let i = Complex64::i();
    let poles = material.poles.iter().map(|pole| pole.delta_eps / (1.0 + i * w * pole.tau)).sum::<Complex64>();
    material.eps_r + poles - i * material.sigma / (w * EPSILON_0)
}

fn across() -> f64 {
    2.0 / ACROSS.1 * (PI / (2.0 * ACROSS.0 as f64)).sin()
}

/// Along the strip: decays forwards.
fn kx(eps: Complex64, w: f64) -> Complex64 {
    let kx = (eps * (w / C0).powi(2) - across().powi(2)).sqrt();
    if kx.im > 0.0 { -kx } else { kx }
}

/// A strip with a slab that begins at the third place; receivers at given places.
fn strip(three: bool, cell: f64, slab: Option<(&Material, f64, bool)>, receivers: &[f64]) -> Traces {
    let node = |x: f64| (x / cell).round() as usize;
    let high = if three { 2 } else { 1 };
    let mut model: Model = empty([node(LENGTH), ACROSS.0, high], [cell, ACROSS.1, ACROSS.1], 1);
    model.stability_factor = COURANT;
    let steps = WINDOW / model.time_step();
    model.time_window = ballast_gpr::model::TimeWindow::Iterations(steps as usize);
    for j in 1..ACROSS.0 {
        let pulse = add_pulse(&mut model, (PI * j as f64 / ACROSS.0 as f64).sin());
        for k in 0..high {
            add_dipole(&mut model, Axis::Z, [node(PLACES[0]), j, k], pulse, None);
        }
    }
    receivers.iter().for_each(|&x| add_receiver(&mut model, [node(x), ACROSS.0 / 2, high / 2]));
    if let Some((material, thickness, averaging)) = slab {
        let id = model.add_material(material.clone());
        let lower = [PLACES[2], 0.0, 0.0];
        let upper = [PLACES[2] + thickness, ACROSS.0 as f64 * ACROSS.1, high as f64 * ACROSS.1];
        model.objects.push(Object::Box { lower, upper, material: id, averaging });
    }
    solve(&model)
}

/// What a slab sends back at each frequency, as measured, with what is exact for a slab that begins `ahead` earlier and ends
/// `ahead` later. From beyond a metre nothing comes back in time.
fn reflection(three: bool, cell: f64, slab: (&Material, f64, bool), ahead: f64) -> Vec<[Complex64; 2]> {
    let nothing = strip(three, cell, None, &[PLACES[1]]);
    let something = strip(three, cell, Some(slab), &[PLACES[1]]);
    let echo = difference(ez(&something, 0), ez(&nothing, 0));
    let dt = nothing.time_step.si();
    let (material, thickness, _) = slab;
    let at = |frequency: f64| {
        let w = 2.0 * PI * frequency;
        let (air, inside) = (kx(Complex64::ONE, w), kx(permittivity(material, w), w));
        let i = Complex64::i();
        let face = (air - inside) / (air + inside);
        let through = (-2.0 * i * inside * (thickness + 2.0 * ahead)).exp();
        let through = if thickness > 1.0 { Complex64::ZERO } else { through };
        let exact = face * (1.0 - through) / (1.0 - face * face * through) * (2.0 * i * air * ahead).exp();
        let path = (2.0 * i * air * (PLACES[2] - PLACES[1])).exp();
        [spectrum(&echo, dt, frequency) / spectrum(ez(&nothing, 0), dt, frequency) * path, exact]
    };
    FREQUENCIES.map(at).to_vec()
}

const FREQUENCIES: [f64; 15] =
    [0.2e9, 0.4e9, 0.6e9, 0.8e9, 1e9, 1.2e9, 1.4e9, 1.6e9, 1.8e9, 2e9, 2.2e9, 2.4e9, 2.6e9, 2.8e9, 3e9];

/// How far a reflection may be off: a wave loses `(k d)²/24` of its phase per radian, on the way through the air and, three
/// times to and fro (later echoes are too weak), through the slab; a face that is one edge of mean permittivity is off by
/// `(k d)²/8` at most.
fn tolerance(material: &Material, thickness: f64, cell: f64, frequency: f64) -> f64 {
    let w = 2.0 * PI * frequency;
    let (air, inside) = (w / C0, kx(permittivity(material, w), w).norm());
    let way = 2.0 * air * (PLACES[2] - PLACES[1]);
    let deep = 6.0 * inside * thickness.min(3.0 / kx(permittivity(material, w), w).im.abs().max(1e-9));
    (air * cell).powi(2) / 24.0 * way + (inside * cell).powi(2) * (deep / 24.0 + 0.125) + 1e-4
}

/// Worst error in units of the tolerance, and the error's order between cells of 4 and 2 mm at 1 GHz.
fn judge(name: &str, three: bool, slab: (&Material, f64, bool), ahead_in_cells: f64) -> f64 {
    let errors = [0.004, 0.002].map(|cell| {
        let found = reflection(three, cell, slab, ahead_in_cells * cell);
        let errors: Vec<f64> = found.iter().map(|[ours, exact]| (ours - exact).norm()).collect();
        for (error, frequency) in errors.iter().zip(FREQUENCIES) {
            let tolerance = tolerance(slab.0, slab.1, cell, frequency);
            assert!(*error < tolerance, "{name}, {cell} m, {frequency:e} Hz: {error:e} > {tolerance:e}");
        }
        errors
    });
    let worst = |errors: &[f64]| errors.iter().fold(0.0f64, |worst, error| worst.max(*error));
    let norm = |errors: &[f64]| errors.iter().map(|e| e * e).sum::<f64>().sqrt();
    let order = (norm(&errors[0]) / norm(&errors[1])).log2();
    println!(
        "{name:<34} largest error {:.2e} at 4 mm, {:.2e} at 2 mm, order {order:.2}",
        worst(&errors[0]),
        worst(&errors[1])
    );
    order
}

fn wet() -> Material {
    let mut wet = Material::dielectric("wet", 3.5, 0.01);
    wet.poles = vec![DebyePole { delta_eps: 5.0, tau: 1e-10 }];
    wet.averagable = false;
    wet
}

/// A half-space and a slab of stone, a half-space that conducts: second order, faces averaged.
#[test]
fn averaged_faces_reflect_by_fresnel() {
    for three in [false, true] {
        let (stone, clay) = (Material::dielectric("stone", 6.0, 0.0), Material::dielectric("clay", 8.0, 0.2));
        for (name, material, thickness) in [
            ("half-space, 6", &stone, LENGTH - PLACES[2]),
            ("slab of 80 mm, 6", &stone, 0.08),
            ("half-space of 0.2 S/m", &clay, LENGTH - PLACES[2]),
        ] {
            let name = format!("{name}, {}", if three { "3-D" } else { "2-D" });
            let order = judge(&name, three, (material, thickness, true), 0.0);
            assert!((order - 2.0).abs() < 0.2, "{name}: {order}");
        }
    }
}

/// A slab of 80 mm that relaxes at 1.6 GHz, over frequency. Its faces are not averaged (as in gprMax): every edge on them is
/// wet, so the slab begins half a cell earlier and ends half a cell later than it was drawn. For that slab the order is two.
#[test]
fn a_relaxing_slab_reflects_by_fresnel() {
    for three in [false, true] {
        let name = format!("Debye slab of 80 mm, {}", if three { "3-D" } else { "2-D" });
        let order = judge(&name, three, (&wet(), 0.08, false), 0.5);
        assert!((order - 2.0).abs() < 0.2, "{name}: {order}");
    }
}

/// Attenuation and phase per metre in soils and conductors, between 20 and 60 mm of depth (or two and six skin depths where
/// that is less): against the exact wave number with the tolerance `|k|(|k d|² + 2 (w dt)²)/24`
/// beside that of the tail below, and against that of the grid,
/// `4/d² sin²(kx d/2) + ky² = mu0 (2/dt) sin(w dt/2) (eps (2/dt) sin(w dt/2) - i sigma cos(w dt/2))`, to 1e-4 (a bound set
/// after 1.2e-5 was found: the slow tail of the field in a conductor goes on beyond the window).
#[test]
fn waves_in_conductors_decay_with_the_skin_depth() {
    let cell = 0.002;
    for three in [false, true] {
        for sigma in if three { vec![0.1, 5.0] } else { vec![0.01, 0.1, 1.0, 5.0] } {
            let clay = Material::dielectric("clay", 8.0, sigma);
            let places = if sigma > 2.0 { [0.01, 0.026] } else { [0.02, 0.06] };
            let traces =
                strip(three, cell, Some((&clay, LENGTH - PLACES[2], true)), &places.map(|depth| PLACES[2] + depth));
            let dt = traces.time_step.si();
            for frequency in [0.4e9, 1e9, 2e9] {
                let w = 2.0 * PI * frequency;
                let [near, far] = [0, 1].map(|receiver| spectrum(ez(&traces, receiver), dt, frequency));
                let exact = kx(permittivity(&clay, w), w);
                let rate = 2.0 / dt * (w * dt / 2.0).sin();
                let square = MU_0 * rate * (8.0 * EPSILON_0 * rate - Complex64::i() * sigma * (w * dt / 2.0).cos());
                let sine = (square - across().powi(2)).sqrt() * cell / 2.0;
                let on_grid = sine.asin() * (2.0 / cell);
                let on_grid = if on_grid.im > 0.0 { -on_grid } else { on_grid };
                // The logarithm knows the phase but for whole turns.
                let travelled = -(far / near).ln() / Complex64::i() / (places[1] - places[0]);
                let turn = 2.0 * PI / (places[1] - places[0]);
                let measured = travelled + ((exact.re - travelled.re) / turn).round() * turn;
                let tolerance = exact.norm() * (((exact.norm() * cell).powi(2) + 2.0 * (w * dt).powi(2)) / 24.0 + 1e-4);
                println!(
                    "{sigma:>5} S/m {:.1} GHz: {:>8.3} dB/m ({:>8.3} exact), {:>8.3} rad/m ({:>8.3} exact), {} of k off",
                    frequency / 1e9,
                    -measured.im * 20.0 / 10f64.ln(),
                    -exact.im * 20.0 / 10f64.ln(),
                    measured.re,
                    exact.re,
                    format_args!("{:.1e}", (measured - exact).norm() / exact.norm())
                );
                assert!((measured - exact).norm() < tolerance, "{three} {sigma} {frequency:e}: {measured} {exact}");
                assert!(
                    (measured - on_grid).norm() < 1e-4 * exact.norm(),
                    "{three} {sigma} {frequency:e}: {measured} {on_grid}"
                );
            }
        }
    }
}
