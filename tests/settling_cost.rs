//! What settling costs: softer beds settle more, and what was not settled is told as such.

use std::ops::ControlFlow;

use ballast_gpr::fdtd::Fdtd;
use ballast_gpr::study::{DemCostPlan, DemKnob, settling_cost};

/// Forty stones, two seeds, one section. A bed a thousand times softer settles more under the plate, by Hertz `1000^(2/3)` = 100 times
/// where nothing moves, here ten to a thousand; it lies denser. Stones that are placed in the bed's stead have no settlement,
/// and as spheres (35 % solid) some twenty points more of voids. References are off by nothing.
#[test]
fn softer_beds_settle_more_under_a_plate() {
    let plan = DemCostPlan::standard(40, 2, 1).unwrap();
    let table = settling_cost(&plan, &Fdtd::default(), &|_, _| {}, &|_| ControlFlow::Continue(())).unwrap();
    assert_eq!(table.rows.len(), 4 + 5 + 5 + 3);
    let of = |knob: DemKnob| table.rows.iter().filter(move |row| row.knob == knob);
    for knob in [DemKnob::Stiffness, DemKnob::TimeStep, DemKnob::Stones] {
        let references: Vec<_> = of(knob).map(|row| row.reference).collect();
        assert!(references[0] && !references[1..].contains(&true));
        let reference = of(knob).next().unwrap();
        assert_eq!((reference.voids_percent.unwrap().error, reference.trace_percent), (0.0, Some(0.0)));
        assert!(reference.stopped.is_none() && reference.seconds > 0.0);
    }
    let (stiff, softest) = (of(DemKnob::Stiffness).next().unwrap(), of(DemKnob::Stiffness).next_back().unwrap());
    let ratio = softest.strain_percent.unwrap().mean / stiff.strain_percent.unwrap().mean;
    assert!((10.0..1000.0).contains(&ratio), "{ratio}");
    assert!(softest.voids_percent.unwrap().error < 0.0, "{softest:?}");
    let placed = of(DemKnob::Placed).next().unwrap();
    assert!(placed.strain_percent.is_none() && placed.voids_percent.unwrap().error > 10.0, "{placed:?}");
    assert!(placed.seconds < 0.1 * stiff.seconds);
}
