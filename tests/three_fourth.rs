//! The scheme of fourth order in three dimensions: its walls and conductors, its boundary, its stability, its threads.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;

use ballast_gpr::fdtd::{Fdtd, FdtdError, Precision};
use ballast_gpr::model::{
    Axis, DebyePole, Excitation, Grid, HertzianDipole, Material, MaterialId, Model, Object, Order, Receiver, Source,
    TimeWindow, Waveform, WaveformKind,
};
use ballast_gpr::trace::{Component, Traces};

const D: f64 = 0.004;

/// A dipole along z and receivers at nodes, without absorbing cells.
fn scene(cells: [usize; 3], steps: usize, source: [usize; 3], receivers: &[[usize; 3]]) -> Model {
    let mut model = Model::new("fourth", Grid { cells, spacing: [D; 3] }, TimeWindow::Iterations(steps));
    (model.order, model.pml_cells) = (Order::Fourth, Some([0; 6]));
    model.waveforms.push(Waveform { id: "w".into(), kind: WaveformKind::Ricker, amplitude: 1.0, frequency: 2e9 });
    let at = |node: [usize; 3]| node.map(|index| index as f64 * D);
    let excitation = Excitation { start: 0.0, stop: None };
    let dipole = HertzianDipole { polarisation: Axis::Z, position: at(source), waveform: 0, excitation };
    model.sources.push(Source::HertzianDipole(dipole));
    model.receivers = receivers.iter().map(|&node| Receiver { position: at(node), name: None }).collect();
    model
}

fn cuboid(low: [usize; 3], high: [usize; 3], material: MaterialId) -> Object {
    let at = |node: [usize; 3]| node.map(|index| index as f64 * D);
    Object::Box { lower: at(low), upper: at(high), material, averaging: true }
}

fn run(model: &Model, threads: usize, precision: Precision) -> Result<Traces, FdtdError> {
    let fdtd = Fdtd { precision, threads: NonZeroUsize::new(threads), ..Fdtd::default() };
    fdtd.solve_stats(model, &|_| ControlFlow::Continue(())).map(|(traces, _)| traces)
}

fn all(traces: &Traces) -> Vec<f64> {
    let components = traces.receivers.iter().flat_map(|receiver| Component::FIELDS.map(|c| receiver.component(c)));
    components.flatten().flat_map(|scan| scan.samples.iter().copied()).collect()
}

fn relative(a: &[f64], b: &[f64]) -> f64 {
    let norm = |v: &mut dyn Iterator<Item = f64>| v.map(|v| v * v).sum::<f64>().sqrt();
    norm(&mut a.iter().zip(b).map(|(a, b)| a - b)) / norm(&mut b.iter().copied())
}

/// A closed box by the outer walls and one within conductor, a rim of one cell or of four: the same traces, all components.
#[test]
fn a_box_of_conductor_is_a_box_of_walls() {
    let inner = [13, 11, 12];
    let boxed = |rim: usize| {
        let at = |node: [usize; 3]| node.map(|index| index + rim);
        let cells = inner.map(|n| n + 2 * rim);
        let mut model = scene(cells, 1500, at([4, 5, 3]), &[at([8, 6, 7]), at([1, 1, 1])]);
        if rim > 0 {
            for axis in 0..3 {
                let (mut high, mut low) = (cells, [0; 3]);
                high[axis] = rim;
                model.objects.push(cuboid([0; 3], high, MaterialId::PEC));
                low[axis] = cells[axis] - rim;
                model.objects.push(cuboid(low, cells, MaterialId::PEC));
            }
        }
        all(&run(&model, 2, Precision::Double).unwrap())
    };
    let walls = boxed(0);
    assert!(walls.iter().any(|v| v.abs() > 1.0));
    for rim in [1, 4] {
        let error = relative(&boxed(rim), &walls);
        println!("rim of {rim}: {error:e}");
        assert!(error < 1e-9, "rim of {rim}: {error:e}");
    }
}

/// Just below the largest step a closed box full of conductors and contrasts rings on; beyond it the run is refused.
#[test]
fn the_largest_step_is_the_limit() {
    let mut model = scene([18, 16, 17], 12_000, [5, 5, 5], &[[12, 10, 11], [3, 12, 4]]);
    model.stability_factor = 0.99;
    let clay = model.add_material(Material::dielectric("clay", 10.0, 0.0));
    let corners = [[7, 3, 4], [10, 9, 2], [2, 10, 9], [12, 4, 12], [8, 7, 8]];
    for (k, corner) in corners.into_iter().enumerate() {
        let material = if k % 2 == 0 { MaterialId::PEC } else { clay };
        let high = [corner[0] + 1 + k % 3, corner[1] + 1 + k / 2, corner[2] + 1 + (k + 1) % 3];
        model.objects.push(cuboid(corner, high, material));
    }
    // A plate without thickness, along which differences are cut on both sides.
    let plate = |v: [usize; 3]| v.map(|index| index as f64 * D);
    model.objects.push(Object::Plate {
        lower: plate([4, 4, 13]),
        upper: plate([9, 12, 13]),
        material: MaterialId::PEC,
    });
    let traces = run(&model, 2, Precision::Single).unwrap();
    for receiver in &traces.receivers {
        let trace = &receiver.component(Component::Ez).unwrap().samples;
        let peak = |part: &[f64]| part.iter().fold(0.0f64, |peak, v| peak.max(v.abs()));
        let (early, late) = (peak(&trace[..3000]), peak(&trace[9000..]));
        println!("{early:e} {late:e}");
        assert!(late.is_finite() && late < 1.5 * early && late > 0.0, "{early:e} {late:e}");
    }
    model.stability_factor = 1.01;
    assert!(run(&model, 2, Precision::Single).unwrap_err().to_string().contains("1.01"));
}

/// Any number of threads gives the same bits, with loss, contrasts, conductors and absorbing cells on all sides.
#[test]
fn threads_change_no_bit() {
    let mut model = scene([44, 40, 42], 120, [20, 18, 17], &[[27, 22, 25], [14, 12, 30]]);
    model.pml_cells = Some([8, 7, 10, 9, 8, 6]);
    let clay = model.add_material(Material::dielectric("clay", 8.0, 0.05));
    model.objects.push(cuboid([0, 0, 0], [44, 40, 14], clay));
    model.objects.push(cuboid([24, 10, 18], [30, 15, 24], MaterialId::PEC));
    let centre = [0.061, 0.093, 0.1];
    model.objects.push(Object::Sphere { centre, radius: 0.017, material: clay, averaging: true });
    for precision in [Precision::Single, Precision::Double] {
        let bits =
            |threads| all(&run(&model, threads, precision).unwrap()).into_iter().map(f64::to_bits).collect::<Vec<_>>();
        let one = bits(1);
        assert!(bits(2) == one && bits(3) == one);
    }
}

/// Ten absorbing cells echo less than a thousandth of what a dipole sends: against a grid so large that no echo comes back.
/// In a medium through the boundary as in air.
#[test]
fn the_boundary_absorbs() {
    for eps_r in [1.0, 4.0] {
        let of = |cells: usize, pml: usize| {
            let middle = cells / 2;
            let mut model = scene([cells; 3], 150, [middle; 3], &[[middle + 4, middle + 2, middle + 1]]);
            model.pml_cells = Some([pml; 6]);
            if eps_r != 1.0 {
                let medium = model.add_material(Material::dielectric("medium", eps_r, 0.0));
                model.objects.push(cuboid([0; 3], [cells; 3], medium));
            }
            all(&run(&model, 2, Precision::Single).unwrap())
        };
        let echo = relative(&of(40, 10), &of(if eps_r == 1.0 { 100 } else { 76 }, 10));
        println!("eps_r {eps_r}: {echo:e}");
        assert!(echo < 1e-3, "{echo:e}");
    }
}

/// With the cells that both take, the two orders agree as their errors let them, and the fourth is nearer to the limit.
#[test]
fn both_orders_have_one_limit() {
    let trace = |order: Order, refined: usize| {
        let cells = 20 * refined;
        let grid = Grid { cells: [cells; 3], spacing: [0.012 / refined as f64; 3] };
        let mut model = scene([cells; 3], 1, [0; 3], &[]);
        (model.grid, model.order, model.time_window) = (grid, order, TimeWindow::Seconds(1.5e-9));
        let d = grid.spacing[0];
        // An edge along z lies half a cell above its node: the receiver's as the source's.
        let at = |v: [f64; 3]| v.map(|v| v * 0.012);
        model.waveforms[0].amplitude = refined as f64;
        model.waveforms[0].frequency = 1.5e9;
        let excitation = Excitation { start: 0.0, stop: None };
        let dipole = HertzianDipole { polarisation: Axis::Z, position: at([9.0, 10.0, 10.0]), waveform: 0, excitation };
        model.sources = vec![Source::HertzianDipole(dipole)];
        model.receivers = vec![Receiver { position: at([13.0, 12.0, 10.0]), name: None }];
        let traces = run(&model, 2, Precision::Single).unwrap();
        let scan = traces.receivers[0].component(Component::Ez).unwrap().clone();
        let step = scan.time_step.si();
        let samples: Vec<f64> = (0..140)
            .map(|n| {
                let place = n as f64 * 1e-11 / step;
                let (k, part) = (place as usize, place.fract());
                scan.samples[k] * (1.0 - part) + scan.samples[k + 1] * part
            })
            .collect();
        assert!(d > 0.0);
        samples
    };
    let fine = trace(Order::Fourth, 4);
    let error = |order, refined| relative(&trace(order, refined), &fine);
    let [second, fourth] = [error(Order::Second, 2), error(Order::Fourth, 2)];
    println!("second {second:e}, fourth {fourth:e}");
    assert!(second < 0.2 && fourth < 0.7 * second, "{second:e} {fourth:e}");
}

/// What it does not take is named.
#[test]
fn what_it_does_not_take_is_named() {
    let mut model = scene([12; 3], 10, [5; 3], &[[6; 3]]);
    let mut wet = Material::dielectric("wet", 5.0, 0.0);
    wet.poles.push(DebyePole { delta_eps: 3.0, tau: 1e-11 });
    let wet = model.add_material(wet);
    model.objects.push(cuboid([2; 3], [5; 3], wet));
    let message = run(&model, 1, Precision::Single).unwrap_err().to_string();
    assert!(
        message.starts_with("differences of order 4 in three dimensions do not take a medium that relaxes"),
        "{message}"
    );
}
