//! Studies: published cases against ours, ensembles, and accuracy against cost. Solvers come in as `&dyn Forward`.

mod bias;
mod case;
mod cost;
mod cost_dem;
mod cost_space;
mod dimension;
mod echoes;
pub mod experiments;
mod fouling_depth;
mod pulse;
mod statistics;

pub use bias::{Beds, BiasError, BiasRow, Reading, Waves, bias_rows, of_layers, read_bed};
pub use case::{Case, CaseError, Expected, Row, Verdict};
pub use cost::{
    CostError, CostPoint, CostScene, CostSetting, CostSolver, CostSubject, CostTable, absorbing_cells, cost_curve,
    cost_of,
};
pub use cost_dem::{
    DemCostError, DemCostPlan, DemCostRow, DemCostTable, DemKnob, DemSetting, Judged, PRESSED, settlement,
    settling_cost,
};
pub use cost_space::CostBed;
pub use dimension::{DimensionError, DimensionRow, DimensionTable, DimensionTrace, compare_dimensions, voids_percent};
pub use echoes::{EchoError, EchoTime, Echoes, PlateReference, plate_reference, plate_reference_of, simulate_echoes};
pub use fouling_depth::{DelayCurve, DelayPoint, LengthEstimate, delay_curve};
pub use pulse::{PlateSetup, PulseError, PulseOfPlate, SimulatedPlate, pulse_of_plate, pulse_peak, simulate_plate};
pub use statistics::{MeanAndSpread, fit_exponent};
