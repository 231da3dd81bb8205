//! The cases that break such solvers.

#[expect(dead_code, reason = "the closed forms above layers are used elsewhere")]
#[path = "fdtd_support/exact.rs"]
mod exact;
mod fdtd_support;

use ballast_gpr::fdtd::Precision;
use ballast_gpr::model::{DebyePole, Material, MaterialId, Model, Object};
use ballast_gpr::units::constants::{EPSILON_0, MU_0};
use fdtd_support::{box_of, ez, relative_l2, run, scene, solve};
use proptest::prelude::*;

fn peak(samples: &[f64]) -> f64 {
    samples.iter().fold(0.0, |peak, v| if v.is_finite() { v.abs().max(peak) } else { f64::INFINITY })
}

/// Inclusions of eps_r 81 in air, six cells per wavelength inside: fields stay finite, and once the pulse is over they
/// only decay, in the inclusion too.
#[test]
fn water_in_air_rings_down() {
    let mut model = scene([120, 120], 0.002, 6000, [60, 100], &[[60, 50], [80, 100], [62, 48]]);
    let water = model.add_material(Material::dielectric("water", 81.0, 0.001));
    let (start, end) = ([0.12, 0.1, 0.0], [0.12, 0.1, 0.002]);
    model.objects.push(Object::Cylinder { start, end, radius: 0.03, material: water, averaging: true });
    let traces = solve(&model, Precision::Single);
    for receiver in 0..3 {
        let trace = ez(&traces, receiver);
        let [early, middle, late] = [peak(&trace[..2000]), peak(&trace[2000..4000]), peak(&trace[4000..])];
        assert!(early.is_finite() && middle < early && late < middle, "{receiver}: {early:e} {middle:e} {late:e}");
    }
}

/// Under a conducting half-space, 10 and 20 mm deep: the whole trace against Sommerfeld's integral. At 10 S/m and 1 GHz the
/// skin depth is 5 mm, five cells. Tolerance: the wave number inside is off by `|k d|²/24`, at
/// the 1 GHz of the pulse's centre and 10 S/m 0.3 %, so over 20 mm (4 e-foldings and as many radians) the trace is off by
/// `0.3 % * 4 sqrt(2)` = 1.9 %, in proportion to `sigma^(3/2)` below.
#[test]
fn fields_in_a_conductor_fall_with_the_skin_depth() {
    for (sigma, tolerance) in [(1.0, 2e-3), (3.0, 5e-3), (10.0, 2e-2)] {
        let mut model = scene([160, 140], 0.001, 1500, [80, 110], &[[80, 70], [80, 60]]);
        let clay = model.add_material(Material::dielectric("clay", 10.0, sigma));
        model.objects.push(box_of(&model, [0, 0, 160, 80], clay, true));
        let traces = solve(&model, Precision::Double);
        let eps = exact::debye(10.0, sigma, 0.0, 1e-12);
        for (receiver, depth) in [(0, 0.01), (1, 0.02)] {
            let times = traces.receivers[receiver].components[2].times();
            let expected = exact::trace(times, 1e9, |w| exact::transmitted(w, &eps, 0.03, depth));
            let error = relative_l2(ez(&traces, receiver), &expected);
            assert!(error < tolerance, "{sigma} S/m, {depth} m: {error:e}");
        }
    }
}

/// From no conductivity to a good conductor, in single precision: finite, and gone at the end.
#[test]
fn any_conductivity_is_stable() {
    for sigma in [0.0, 1e-6, 1e-3, 0.1, 1.0, 10.0, 1e4, 1e9] {
        let mut model = scene([80, 80], 0.002, 3000, [40, 60], &[[40, 30], [50, 60]]);
        let clay = model.add_material(Material::dielectric("clay", 5.0, sigma));
        model.objects.push(box_of(&model, [0, 0, 80, 40], clay, true));
        let traces = solve(&model, Precision::Single);
        for receiver in 0..2 {
            let trace = ez(&traces, receiver);
            assert!(peak(&trace[2500..]) <= 1e-3 * peak(trace).max(1.0), "{sigma}: {:e}", peak(&trace[2500..]));
        }
    }
}

/// A pole of 1 fs against a step of 4.7 ps has relaxed before it is seen: the static permittivity, to the bit.
#[test]
fn a_pole_far_faster_than_the_step_is_permittivity() {
    let model = |material: Material| {
        let mut model: Model = scene([80, 80], 0.002, 800, [40, 60], &[[40, 30], [50, 60]]);
        let id = model.add_material(Material { averagable: false, ..material });
        model.objects.push(box_of(&model, [20, 10, 60, 40], id, true));
        solve(&model, Precision::Double)
    };
    let mut fast = Material::dielectric("fast", 2.0, 0.01);
    fast.poles.push(DebyePole { delta_eps: 14.0, tau: 1e-15 });
    let (fast, still) = (model(fast), model(Material::dielectric("still", 16.0, 0.01)));
    assert_eq!(ez(&fast, 0), ez(&still, 0));
    assert_eq!(ez(&fast, 1), ez(&still, 1));
}

/// 40 ns above a half-space that runs through the absorbing boundary. gprMax decays to 2e-5 of the peak at 8 ns and to
/// 6e-8, the floor of single precision, at 40 ns; here no window may exceed the one before by more than that floor.
#[test]
fn late_times_decay_through_the_absorbing_boundary() {
    let mut model = scene([150, 120], 0.002, 8480, [65, 80], &[[85, 80]]);
    let soil = model.add_material(Material::dielectric("soil", 6.0, 0.0));
    model.objects.push(box_of(&model, [0, 0, 150, 60], soil, true));
    let traces = solve(&model, Precision::Single);
    let trace = ez(&traces, 0);
    let top = peak(trace);
    let windows: Vec<f64> = trace.chunks(1060).map(|window| peak(window) / top).collect();
    for pair in windows[1..].windows(2) {
        assert!(pair[1] <= pair[0] + 2e-7, "{windows:?}");
    }
    assert!(windows[2] < 1e-4 && windows[7] < 3e-7, "{windows:?}");
}

/// A source on the face between air and stone: between the traces of the two media, and finite.
#[test]
fn a_source_on_an_interface_is_sound() {
    let mut model = scene([100, 100], 0.002, 2000, [50, 50], &[[60, 50], [50, 60]]);
    let stone = model.add_material(Material::dielectric("stone", 6.0, 0.0));
    model.objects.push(box_of(&model, [0, 0, 100, 50], stone, true));
    let traces = solve(&model, Precision::Single);
    let trace = ez(&traces, 0);
    assert!(peak(&trace[1800..]) < 1e-3 * peak(trace));
    assert!((10.0..1e4).contains(&peak(trace)), "{}", peak(trace));
}

/// Cells of 2 mm by 3 mm: Hankel's function along both axes. The error along x is that of 2 mm (2.4e-4, see
/// `fdtd_exact`) to within a factor of two, along y that of 3 mm.
#[test]
fn oblong_cells_agree_with_hankels_function() {
    let mut model = scene([200, 140], 0.002, 700, [100, 70], &[]);
    model.grid.spacing[1] = 0.003;
    let at = |i: usize, j: usize| [i as f64 * 0.002, j as f64 * 0.003, 0.0];
    let ballast_gpr::model::Source::HertzianDipole(dipole) = &mut model.sources[0] else { panic!("a current") };
    dipole.position = at(100, 70);
    let receiver = |position| ballast_gpr::model::Receiver { position, name: None };
    model.receivers = vec![receiver(at(124, 70)), receiver(at(100, 86))];
    let traces = solve(&model, Precision::Double);
    for index in 0..2 {
        let times = traces.receivers[index].components[2].times();
        let error = relative_l2(ez(&traces, index), &exact::trace(times, 1e9, exact::free_space(0.048)));
        assert!(error < 8e-4, "{index}: {error:e}");
    }
}

/// The smallest grid that holds a source: 2 x 2 cells, one node between perfect conductors. With `s` the sum of the fields
/// so far, `e <- e - 4 cb s - kick`, `cb = (c dt/d)² = 1/2`.
#[test]
fn the_smallest_grid_is_an_oscillator() {
    let mut model = scene([2, 2], 0.002, 400, [1, 1], &[[1, 1]]);
    model.pml_cells = Some([0; 6]);
    let traces = solve(&model, Precision::Double);
    let (dt, w) = (traces.time_step.si(), &model.waveforms[0]);
    let (cb, source) = (dt * dt / (EPSILON_0 * MU_0 * 4e-6), dt / (EPSILON_0 * 4e-6));
    let (mut e, mut sum) = (0.0, 0.0);
    let exact: Vec<f64> = (0..400)
        .map(|n| {
            let now = e;
            sum += e;
            e = e - 4.0 * cb * sum - source * w.value((n as f64 + 0.5) * dt);
            now
        })
        .collect();
    assert!(relative_l2(ez(&traces, 0), &exact) < 1e-9);
}

/// Grids of a few cells, with and without absorbing cells, down to one more than these leave.
#[test]
fn tiny_grids_run() {
    for (cells, pml) in [([2, 3], 0), ([3, 2], 0), ([3, 3], 1), ([5, 4], 1), ([21, 21], 10), ([17, 33], 8)] {
        let mut model = scene(cells, 0.002, 500, [cells[0] / 2, cells[1] / 2], &[[cells[0] / 2, 1], cells]);
        model.pml_cells = Some([pml, pml, 0, pml, pml, 0]);
        for precision in [Precision::Single, Precision::Double] {
            assert!(peak(ez(&solve(&model, precision), 0)).is_finite(), "{cells:?} {pml}");
        }
    }
}

/// At the Courant limit and just below it a closed lossless box keeps its energy; beyond, the run is refused.
#[test]
fn the_courant_limit_is_kept() {
    let run_at = |factor| {
        let mut model = scene([40, 40], 0.002, 4000, [20, 20], &[[28, 25]]);
        model.pml_cells = Some([0; 6]);
        model.stability_factor = factor;
        run(&ballast_gpr::fdtd::Fdtd::default(), &model)
    };
    for factor in [0.5, 0.99, 1.0] {
        let traces = run_at(factor).unwrap();
        let trace = ez(&traces, 0);
        assert!(peak(&trace[2000..]) < 3.0 * peak(&trace[..2000]), "{factor}");
    }
    let message = run_at(1.01).unwrap_err().to_string();
    assert!(message.starts_with("a time step of 1.01 times the Courant limit is not stable"), "{message}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    /// Whatever lies on the grid, the field stays finite and never outgrows what the source puts in: at the source's own
    /// node in free space the peak is some 2000 V/m per ampere.
    #[test]
    fn any_mixture_is_stable(
        objects in prop::collection::vec((0usize..5, 0usize..44, 0usize..34, 2usize..20, any::<bool>()), 1..8),
        eps in 1.0f64..40.0, sigma in 0.0f64..5.0, delta in 0.0f64..60.0, log_tau in -13.0f64..-8.0,
        factor in 0.3f64..1.0, pml in 0usize..11,
    ) {
        let mut model = scene([48, 38], 0.002, 1200, [24, 19], &[[30, 20], [10, 8]]);
        model.stability_factor = factor;
        model.pml_cells = Some([pml, pml / 2, 0, 10 - pml, pml, 0]);
        let mut relaxing = Material::dielectric("relaxing", 3.0, sigma / 100.0);
        relaxing.poles = vec![DebyePole { delta_eps: delta / 3.0, tau: 10f64.powf(log_tau) }, DebyePole { delta_eps: 1.0, tau: 3e-11 }];
        relaxing.averagable = false;
        let ids = [
            MaterialId::PEC, MaterialId::FREE_SPACE,
            model.add_material(Material::dielectric("lossy", 4.0, sigma)),
            model.add_material(Material::dielectric("dense", eps, 0.0)),
            model.add_material(relaxing),
        ];
        for (material, i, j, size, averaging) in objects {
            // The source's surroundings stay free of conductors.
            if material == 0 && i <= 25 && i + size >= 23 && j <= 20 && j + size >= 18 {
                continue;
            }
            model.objects.push(box_of(&model, [i, j, i + size, j + size], ids[material], averaging));
        }
        let traces = solve(&model, Precision::Single);
        for receiver in 0..2 {
            prop_assert!(peak(ez(&traces, receiver)) < 2e4, "{:e}", peak(ez(&traces, receiver)));
        }
    }
}
