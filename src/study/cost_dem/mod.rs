//! What accuracy costs in time for settled beds: voids, settlement and radar trace over time step, stiffness and number of
//! stones, and against random sequential adsorption, which settles nothing.

mod measure;
mod plan;
mod press;
mod table;

pub use measure::{DemCostError, settling_cost};
pub use plan::{DemCostPlan, DemKnob, DemSetting};
pub use press::{PRESSED, settlement};
pub use table::{DemCostRow, DemCostTable, Judged};
