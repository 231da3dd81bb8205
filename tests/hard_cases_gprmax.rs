//! The hard scenes of `validation/gprmax`, run on far beyond the stored outputs: fields stay finite and die away.

mod common;

use std::fs;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;

use ballast_gpr::fdtd::{Fdtd, Precision};
use ballast_gpr::forward::Forward as _;
use ballast_gpr::gprmax::read_model;
use ballast_gpr::model::{Model, TimeWindow};
use ballast_gpr::trace::{Component, Traces};
use common::reference_case;

/// Windows as long as the stored output: the pulses end within the first.
const WINDOWS: usize = 5;

fn ours(model: &Model, precision: Precision) -> Traces {
    let fdtd = Fdtd { precision, threads: NonZeroUsize::new(1), ..Fdtd::default() };
    fdtd.solve(model, &|_| ControlFlow::Continue(())).unwrap()
}

/// Peak and energy (sum of squares) of each window.
fn windows(samples: &[f64], length: usize) -> Vec<[f64; 2]> {
    let of = |window: &[f64]| window.iter().fold([0.0f64, 0.0], |[peak, sum], v| [peak.max(v.abs()), sum + v * v]);
    samples.chunks_exact(length).map(of).collect()
}

/// No window of E or H is stronger than the first, in which the pulse is, and none after the second is stronger than that, in
/// either precision. (Not each than the one before: what flows on in a good conductor dies away by diffusion and changes sign
/// on its way. In `hard_conductivities` H beside 10 S/m is 2.5e-6 and then 2.6e-6 A/m, after 0.56 A/m.)
///
/// Floor: a field is a running sum, each step rounded to half a unit in the last place of the strongest the run saw (6e-8 in
/// single precision, 1.1e-16 in double). Over `n` steps that walks `sqrt(n)` as far; H beside a good conductor stays there.
/// The peak of the whole run is bounded as well: no receiver is stronger than 1 A can make it at its own node (a current in
/// free space drives its node to some 2000 V/m, in proportion to frequency; four currents and 8 GHz stay below 1e5).
#[test]
fn hard_cases_die_away() {
    let mut names: Vec<String> = fs::read_dir(reference_case(""))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .filter(|name| name.starts_with("hard_"))
        .collect();
    names.sort();
    assert!(names.len() >= 10, "{names:?}");
    println!("{:<30}{:>7}  peak of Ez in each window over the first, single | double", "", "steps");
    for name in names {
        let mut model = read_model(&reference_case(&name).join("scene.in")).unwrap();
        let length = model.iterations();
        model.time_window = TimeWindow::Iterations(length * WINDOWS);
        print!("{name:<30}{:>7}", length * WINDOWS);
        for (precision, rounding) in
            [(Precision::Single, f64::from(f32::EPSILON) / 2.0), (Precision::Double, f64::EPSILON / 2.0)]
        {
            let floor = rounding * ((length * WINDOWS) as f64).sqrt();
            let traces = ours(&model, precision);
            let mut shown: Vec<f64> = vec![0.0; WINDOWS];
            for group in [&[Component::Ez][..], &[Component::Hx, Component::Hy]] {
                let recorded: Vec<_> = traces
                    .receivers
                    .iter()
                    .flat_map(|receiver| group.iter().map(|component| receiver.component(*component).unwrap()))
                    .collect();
                assert!(recorded.iter().all(|trace| trace.samples.iter().all(|v| v.is_finite())), "{name}");
                let top = recorded.iter().fold(0.0f64, |top, trace| top.max(trace.peak()));
                assert!(top > 0.0 && top < 1e5, "{name}: {top:e}");
                for trace in recorded {
                    let found = windows(&trace.samples, length);
                    assert_eq!(found.len(), WINDOWS);
                    let (peak_floor, energy_floor) = (floor * top, length as f64 * (floor * top).powi(2));
                    for (index, window) in found.iter().enumerate().skip(1) {
                        let place = format!("{name}, {} {}: {found:?}", trace.name, trace.component.name());
                        let before = found[usize::from(index > 1)];
                        assert!(window[0] <= before[0] + peak_floor, "{place}");
                        assert!(window[1] <= before[1] + energy_floor, "{place}");
                    }
                    if trace.component == Component::Ez {
                        for (shown, window) in shown.iter_mut().zip(&found) {
                            *shown = shown.max(window[0] / top);
                        }
                    }
                }
            }
            print!("  |");
            shown.iter().for_each(|share| print!(" {share:.0e}"));
        }
        println!();
    }
}
