//! The scheme of fourth order in two dimensions: its order, its walls and conductors, its stability.

#[expect(dead_code, reason = "the closed forms above layers are used elsewhere")]
#[path = "fdtd_support/exact.rs"]
mod exact;
mod fdtd_support;

use std::f64::consts::PI;

use ballast_gpr::fdtd::{FdtdError, Precision};
use ballast_gpr::model::{Averaging, DebyePole, Material, MaterialId, Model, Object, Order};
use ballast_gpr::units::constants::C0;
use exact::free_space;
use fdtd_support::{box_of, ez, relative_l2, run, scene, solve};
use proptest::prelude::*;
use rustfft::num_complex::Complex64;

/// A scene of [`scene`] with an order and a factor on its largest stable step; `window` in place of a number of steps.
fn of_order(mut model: Model, order: Order, factor: f64, window: f64) -> Model {
    (model.order, model.stability_factor) = (order, factor);
    model.time_window = ballast_gpr::model::TimeWindow::Seconds(window);
    model
}

/// Error at 48 mm from a line current in free space, the walls too far away for an echo.
fn error_in_free_space(order: Order, factor: f64, cell: f64) -> f64 {
    let cells = (0.72 / cell).round() as usize;
    let (middle, away) = (cells / 2, (0.048 / cell).round() as usize);
    let model = scene([cells, cells], cell, 1, [middle, middle], &[[middle + away, middle]]);
    let traces = solve(&of_order(model, order, factor, 2.3e-9), Precision::Double);
    let times = traces.receivers[0].components[2].times();
    relative_l2(ez(&traces, 0), &exact::trace(times, 1e9, free_space(0.048)))
}

/// With a time step so short that the differences in time have no part in it, the error falls as the fourth power of the
/// cell size; with the plain differences as the square.
#[test]
fn the_order_of_accuracy_is_four_in_space() {
    let order = |order| (error_in_free_space(order, 0.05, 0.008) / error_in_free_space(order, 0.05, 0.004)).log2();
    let (second, fourth) = (order(Order::Second), order(Order::Fourth));
    println!("orders in space: {second:.3} {fourth:.3}");
    assert!((second - 2.0).abs() < 0.1, "{second}");
    assert!((fourth - 4.0).abs() < 0.25, "{fourth}");
}

/// At its largest step the error of time rules: of second order.
#[test]
fn at_the_largest_step_time_rules() {
    let error = |order, cell| error_in_free_space(order, 1.0, cell);
    let [coarse, fine] = [0.004, 0.002].map(|cell| error(Order::Fourth, cell));
    let measured = (coarse / fine).log2();
    println!("order at the largest step {measured:.3}: {coarse:e} {fine:e}, plain {:e}", error(Order::Second, 0.002));
    assert!((1.9..4.0).contains(&measured), "{measured}");
}

/// A line current 96 mm from a conductor's plane face and 96 mm from the receiver along it: the current and its image.
/// Tolerance: what the same grid errs by without a conductor on the longer way.
#[test]
fn a_conducting_plane_is_an_image() {
    for axis in [0, 1] {
        for order in [Order::Second, Order::Fourth] {
            let error = |cell: f64| {
                let n = |metres: f64| (metres / cell).round() as usize;
                let cells = n(0.96);
                let place = |along: usize, off: usize| if axis == 0 { [off, along] } else { [along, off] };
                let (middle, face) = (cells / 2, n(0.384));
                let source = place(middle, face + n(0.096));
                let mut model = scene([cells, cells], cell, 1, source, &[place(middle + n(0.096), face + n(0.048))]);
                let end = place(cells, face);
                model.objects.push(box_of(&model, [0, 0, end[0], end[1]], MaterialId::PEC, true));
                let traces = solve(&of_order(model, order, 0.1, 2.6e-9), Precision::Double);
                let (direct, image) = (free_space(0.096f64.hypot(0.048)), free_space(0.096f64.hypot(0.144)));
                let response = |w: Complex64| direct(w) - image(w);
                relative_l2(ez(&traces, 0), &exact::trace(traces.receivers[0].components[2].times(), 1e9, response))
            };
            let (coarse, fine) = (error(0.008), error(0.004));
            let measured = (coarse / fine).log2();
            println!("plane across axis {axis}, order {order}: {coarse:e} {fine:e}, {measured:.2}");
            // A tenth of the largest step leaves the fine grid of fourth order a share of the error of time.
            let least = if order == Order::Second { 1.9 } else { 3.2 };
            assert!(measured > least && measured < 4.3, "{axis} {order}: {measured}");
        }
    }
}

/// The echo of a stone, a cylinder of eps_r 6 whose axis lies off the nodes, against the series: with differences of fourth
/// order and edges averaged over the true shape it errs least, and less by half at least on cells of half the size.
#[test]
fn a_stone_echoes_by_its_series() {
    let (radius, eps_r) = (0.024, 6.0);
    let error = |order: Order, averaging: Averaging, cell: f64| {
        let n = |metres: f64| (metres / cell).round() as usize;
        let cells = n(0.72);
        let (middle, [off_x, off_y]) = (cells / 2, [0.0011, 0.0023]);
        let receiver = [middle - n(0.048), middle + n(0.032)];
        let model = scene([cells, cells], cell, 1, [middle + n(0.064), middle], &[receiver]);
        let mut model = of_order(model, order, 1.0, 2.4e-9);
        model.averaging = averaging;
        let direct = solve(&model, Precision::Double);
        let stone = model.add_material(Material::dielectric("stone", eps_r, 0.0));
        let at = middle as f64 * cell;
        let (start, end) = ([at + off_x, at + off_y, 0.0], [at + off_x, at + off_y, cell]);
        model.objects.push(Object::Cylinder { start, end, radius, material: stone, averaging: true });
        let traces = solve(&model, Precision::Double);
        let echo: Vec<f64> = ez(&traces, 0).iter().zip(ez(&direct, 0)).map(|(with, without)| with - without).collect();
        let from = |x: f64, y: f64| ((x - off_x).hypot(y - off_y), (y - off_y).atan2(x - off_x));
        let ((rho_source, phi_source), (rho, phi)) = (from(0.064, 0.0), from(-0.048, 0.032));
        let response = |w| exact::cylinder(w, eps_r, radius, rho_source, rho, phi - phi_source);
        relative_l2(&echo, &exact::trace(traces.receivers[0].components[2].times(), 1e9, response))
    };
    let of = |order, averaging| [0.008, 0.004, 0.002].map(|cell| error(order, averaging, cell));
    for (order, averaging) in [
        (Order::Second, Averaging::Cells),
        (Order::Second, Averaging::Shapes),
        (Order::Fourth, Averaging::Cells),
        (Order::Fourth, Averaging::Shapes),
    ] {
        println!("stone, order {order}, {}: {:?}", averaging.name(), of(order, averaging).map(|e| format!("{e:.2e}")));
    }
    let (plain, best) = (of(Order::Second, Averaging::Cells), of(Order::Fourth, Averaging::Shapes));
    assert!(best[0] < 0.5 * plain[0] && best[1] < 0.5 * plain[1], "{plain:?} {best:?}");
    assert!(best[1] < 0.5 * best[0] && best[2] < 0.5 * best[1], "{best:?}");
}

/// A closed box, once by the outer walls, once within conductor: the same trace. Its lowest waves ring at the frequencies of
/// the scheme, `sin(w dt/2)/(c dt) = |K|/2`, `K = 2/d sin(k d/2) (1 + sin²(k d/2)/6)` along each axis, for 10⁵ steps.
#[test]
fn a_closed_box_rings_at_its_frequencies() {
    let (d, nx, ny) = (0.004, 40, 28);
    let steps = 100_000;
    let boxed = |rim: usize| {
        let at = |i: usize, j: usize| [i + rim, j + rim];
        let mut model = scene([nx + 2 * rim, ny + 2 * rim], d, steps, at(11, 9), &[at(27, 17)]);
        (model.order, model.pml_cells) = (Order::Fourth, Some([0; 6]));
        for object in [[0, 0, nx + 2 * rim, rim], [0, rim + ny, nx + 2 * rim, 2 * rim + ny]] {
            model.objects.push(box_of(&model, object, MaterialId::PEC, true));
        }
        for object in [[0, rim, rim, rim + ny], [rim + nx, rim, 2 * rim + nx, rim + ny]] {
            model.objects.push(box_of(&model, object, MaterialId::PEC, true));
        }
        if rim == 0 {
            model.objects.clear();
        }
        let dt = model.time_step();
        (ez(&solve(&model, Precision::Double), 0).to_vec(), dt)
    };
    let (walls, dt) = boxed(0);
    for rim in [1, 5] {
        let error = relative_l2(&boxed(rim).0, &walls);
        assert!(error < 1e-9, "rim of {rim}: {error:e}");
    }
    let rms = |part: &[f64]| (part.iter().map(|v| v * v).sum::<f64>() / part.len() as f64).sqrt();
    let (early, late) = (rms(&walls[2_000..30_000]), rms(&walls[70_000..]));
    assert!((late / early - 1.0).abs() < 0.02, "{early:e} {late:e}");
    for (p, q) in [(1, 1), (2, 1)] {
        let along = |p: usize, n: usize| {
            let s = (PI * p as f64 / (2.0 * n as f64)).sin();
            2.0 / d * s * (1.0 + s * s / 6.0)
        };
        let w = 2.0 / dt * (C0 * dt / 2.0 * along(p, nx).hypot(along(q, ny))).asin();
        let exact = PI * C0 * (p as f64 / (nx as f64 * d)).hypot(q as f64 / (ny as f64 * d));
        assert!((w / exact - 1.0).abs() < 1e-3, "{p} {q}: {w:e} {exact:e}");
        // A peak of the windowed spectrum between two places 0.2 of its width to both sides.
        let power = |w: f64| {
            let sum: Complex64 = walls
                .iter()
                .enumerate()
                .map(|(n, v)| {
                    let window = (PI * n as f64 / steps as f64).sin().powi(2);
                    Complex64::from_polar(v * window, -w * n as f64 * dt)
                })
                .sum();
            sum.norm()
        };
        let width = 2.0 * PI / (steps as f64 * dt);
        let [below, at, above] = [-0.2, 0.0, 0.2].map(|shift| power(w + shift * width));
        assert!(at > below && at > above, "{p} {q}: {below:e} {at:e} {above:e}");
    }
}

/// Just below the largest step a closed box full of conductors and contrasts rings for 10⁵ steps; beyond it the run is
/// refused.
#[test]
fn the_largest_step_is_the_limit() {
    let mut model = scene([40, 36], 0.002, 100_000, [11, 9], &[[27, 17], [12, 30]]);
    (model.order, model.pml_cells, model.stability_factor) = (Order::Fourth, Some([0; 6]), 0.99);
    let water = model.add_material(Material::dielectric("water", 80.0, 0.0));
    for (k, corner) in [[5, 5], [20, 8], [30, 25], [9, 27], [18, 20]].into_iter().enumerate() {
        let [i, j] = corner;
        let material = if k % 2 == 0 { MaterialId::PEC } else { water };
        model.objects.push(box_of(&model, [i, j, i + 1 + k, j + 1 + k % 3], material, true));
    }
    let traces = solve(&model, Precision::Single);
    for receiver in 0..2 {
        let peak = |part: &[f64]| part.iter().fold(0.0f64, |peak, v| peak.max(v.abs()));
        let trace = ez(&traces, receiver);
        let (early, late) = (peak(&trace[..20_000]), peak(&trace[80_000..]));
        assert!(late.is_finite() && late < 1.5 * early, "{receiver}: {early:e} {late:e}");
    }
    model.stability_factor = 1.01;
    let refusal = run(&Default::default(), &model).unwrap_err();
    assert!(refusal.to_string().contains("1.01"), "{refusal}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    /// Anything: contrasts of 80, single cells, conductors, loss, Debye media, also in the absorbing cells, in either order:
    /// finite, and decaying once the pulse is over.
    #[test]
    fn anything_is_bounded(
        objects in prop::collection::vec((0usize..5, 0usize..46, 0usize..46, 1usize..9, 1usize..9), 0..24),
        fourth in any::<bool>(), open in any::<bool>(),
    ) {
        let mut model = scene([48, 48], 0.003, 6000, [24, 24], &[[30, 30], [10, 24]]);
        model.order = if fourth { Order::Fourth } else { Order::Second };
        if !open {
            model.pml_cells = Some([0; 6]);
        }
        let mut fines = Material::dielectric("fines", 4.0, 0.02);
        fines.poles.push(DebyePole { delta_eps: 20.0, tau: 9e-12 });
        let materials = [
            MaterialId::PEC,
            model.add_material(Material::dielectric("water", 80.0, 0.0)),
            model.add_material(Material::dielectric("clay", 8.0, 0.3)),
            model.add_material(fines),
            MaterialId::FREE_SPACE,
        ];
        for (material, i, j, wide, high) in objects {
            model.objects.push(box_of(&model, [i, j, (i + wide).min(48), (j + high).min(48)], materials[material], true));
        }
        match run(&Default::default(), &model) {
            Ok(traces) => for receiver in 0..2 {
                let trace = ez(&traces, receiver);
                let peak = |part: &[f64]| part.iter().fold(0.0f64, |peak, v| if v.is_finite() { peak.max(v.abs()) } else { f64::INFINITY });
                let (early, late) = (peak(&trace[..3000]), peak(&trace[3000..]));
                prop_assert!(late < 2.0 * early.max(1e-30), "{early:e} {late:e}");
            },
            Err(error) => prop_assert!(matches!(error, FdtdError::SourceInConductor { .. }), "{error}"),
        }
    }
}
