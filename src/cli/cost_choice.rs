//! The cheapest setting for a tolerance, from a cost table.

use crate::cli::error::{CliError, Kind};
use crate::gprmax;
use crate::model::Order;
use crate::scene::Smoothing;
use crate::study::{CostTable, absorbing_cells};
use crate::units::{Hertz, Metres, Share};

/// The table that is built in: errors hold everywhere, times are those of the machine that made it.
const BUILT_IN: &str = include_str!("../../validation/cost/fdtd2d.json");
/// Name of the user's own table in the cache folder.
pub const OWN_TABLE: &str = "cost-fdtd2d.json";

/// A setting and why it was chosen.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// Cell size.
    pub cell: Metres,
    /// Smoothing.
    pub smoothing: Smoothing,
    /// Order of the differences.
    pub order: Order,
    /// Absorbing cells on every open side.
    pub absorbing_cells: usize,
    error: f64,
    tolerance: Share,
    from: &'static str,
}

impl Choice {
    /// What is chosen, in a sentence.
    pub fn sentence(&self) -> String {
        let smoothing = match self.smoothing {
            Smoothing::None => "none",
            Smoothing::Edges => "edges",
            Smoothing::Area => "area",
            Smoothing::Shapes => "shapes",
        };
        format!(
            "tolerance {}: cells of {} with smoothing `{smoothing}`, order {} and {} absorbing cells are the cheapest that keep it ({:.1} % by {})",
            self.tolerance,
            self.cell.in_unit("mm"),
            self.order,
            self.absorbing_cells,
            100.0 * self.error,
            self.from
        )
    }
}

/// The user's own table, if `cost fdtd2d` was run on this machine, else the built-in one.
///
/// # Errors
/// When a table cannot be read.
pub fn table() -> Result<(CostTable, &'static str), CliError> {
    let own = gprmax::install::cache_folder().ok().map(|folder| folder.join(OWN_TABLE)).filter(|path| path.is_file());
    let (text, from) = match &own {
        Some(path) => (crate::files::read_text(path)?, "your own cost table"),
        None => (BUILT_IN.to_string(), "the built-in cost table"),
    };
    let table =
        serde_json::from_str(&text).map_err(|error| CliError::input(format!("{from} cannot be read: {error}")))?;
    Ok((table, from))
}

/// Chooses the cheapest setting that keeps a tolerance at a centre frequency.
///
/// # Errors
/// When no setting of the table keeps it.
pub fn choose(tolerance: Share, frequency: Hertz) -> Result<Choice, CliError> {
    let (table, from) = table()?;
    let Some(point) = table.cheapest(tolerance) else {
        let best = table.best().map_or(f64::NAN, |point| point.error);
        return Err(CliError::new(
            Kind::Input,
            format!(
                "no setting of {from} keeps {tolerance}: the best has {:.2} %\n\nhint: ask for {:.1}% or more",
                100.0 * best,
                (1000.0 * best).ceil() / 10.0
            ),
        ));
    };
    // Error goes with cells per wavelength. Rounded down to a tenth of a millimetre below 10 mm.
    let scaled = point.setting.cell.si() * table.frequency / frequency.si();
    let cell = Metres(((scaled * 1e4 + 1e-9).floor() / 1e4).max(1e-4));
    Ok(Choice {
        cell,
        smoothing: point.setting.smoothing,
        order: point.setting.order,
        // Of the depth that the table's runs had, in wavelengths.
        absorbing_cells: absorbing_cells(point.setting.cell),
        error: point.error,
        tolerance,
        from,
    })
}
