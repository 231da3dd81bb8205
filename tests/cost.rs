//! The cost curve of the built-in solver, on coarse cells.

use std::ops::ControlFlow;

use ballast_gpr::fdtd::Fdtd;
use ballast_gpr::model::Order;
use ballast_gpr::scene::Smoothing;
use ballast_gpr::study::{CostScene, CostSolver, cost_curve};
use ballast_gpr::units::Metres;

/// Finer cells cost more and err less: from 8 mm to 2 mm with area means the error falls by half at least at every step,
/// and the order measured on the traces is that of a second-order scheme with first-order interfaces (1 to 3).
#[test]
fn finer_cells_err_less_and_cost_more() {
    let solver = Fdtd::default();
    let bytes = |model: &ballast_gpr::model::Model| Ok(12 * model.grid.cell_count() as u64);
    let solvers = [CostSolver { solver: &solver, double_precision: false, bytes: &bytes }];
    let cells = [Metres(0.008), Metres(0.004), Metres(0.002)];
    let table =
        cost_curve(&CostScene::standard().unwrap(), &cells, &solvers, &|_, _| {}, &|_| ControlFlow::Continue(()))
            .unwrap();
    for point in &table.points {
        eprintln!("{:?}: {:.2} %", point.setting, 100.0 * point.error);
    }
    assert_eq!(table.points.len(), 24);
    let area: Vec<_> = table
        .points
        .iter()
        .filter(|p| p.setting.smoothing == Smoothing::Area && p.setting.order == Order::Second)
        .collect();
    for pair in area.windows(2) {
        assert!(pair[1].error < 0.5 * pair[0].error, "{} then {}", pair[0].error, pair[1].error);
        assert!(pair[1].cell_steps > 5 * pair[0].cell_steps);
    }
    assert!((1.0..3.0).contains(&table.measured_order), "{}", table.measured_order);
}
