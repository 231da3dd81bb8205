//! The cheapest setting for a tolerance, from a cost table.

use crate::cli::error::{CliError, Kind};
use crate::gprmax;
use crate::model::{Model, Order};
use crate::scene::Smoothing;
use crate::study::{CostTable, absorbing_cells};
use crate::units::{Hertz, Metres, Share};

/// A table of the user's own, in the cache folder, and the one built in: errors hold everywhere, times are those of the
/// machine that made it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OwnTable {
    /// In two dimensions.
    Plane,
    /// In three dimensions.
    Space,
}

impl OwnTable {
    /// Name of its files, without ending.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Plane => "cost-fdtd2d",
            Self::Space => "cost-fdtd3d",
        }
    }

    const fn built_in(self) -> &'static str {
        match self {
            Self::Plane => include_str!("../../validation/cost/fdtd2d.json"),
            Self::Space => include_str!("../../validation/cost/fdtd3d.json"),
        }
    }
}

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
        let smoothing = self.smoothing.name();
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

/// The user's own table, if `cost fdtd2d --keep` (or `fdtd3d`) was run on this machine, else the built-in one.
///
/// # Errors
/// When a table cannot be read.
pub fn table(of: OwnTable) -> Result<(CostTable, &'static str), CliError> {
    let file = |folder: std::path::PathBuf| folder.join(format!("{}.json", of.name()));
    let own = gprmax::install::cache_folder().ok().map(file).filter(|path| path.is_file());
    let (text, from) = match &own {
        Some(path) => (crate::files::read_text(path)?, "your own cost table"),
        None => (of.built_in().to_string(), "the built-in cost table"),
    };
    let table =
        serde_json::from_str(&text).map_err(|error| CliError::input(format!("{from} cannot be read: {error}")))?;
    Ok((table, from))
}

/// The cheapest setting that keeps a tolerance for a model, by the table of its dimensions.
///
/// # Errors
/// When no source of the model has a pulse with a frequency, or no setting keeps it.
pub fn choose_for(model: &Model, tolerance: Share) -> Result<Choice, CliError> {
    let pulses = model.sources.iter().filter_map(|source| model.waveforms.get(source.waveform()));
    let highest = pulses.map(|pulse| pulse.frequency).filter(|f| *f > 0.0).max_by(f64::total_cmp);
    let Some(frequency) = highest else {
        return Err(CliError::input("no source of this model has a pulse with a frequency, so no wavelength is known"));
    };
    let of = if model.invariant_axis().is_some() { OwnTable::Plane } else { OwnTable::Space };
    choose(of, tolerance, Hertz(frequency))
}

/// Chooses the cheapest setting that keeps a tolerance at a centre frequency.
///
/// # Errors
/// When no setting of the table keeps it.
pub fn choose(of: OwnTable, tolerance: Share, frequency: Hertz) -> Result<Choice, CliError> {
    let (table, from) = table(of)?;
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
