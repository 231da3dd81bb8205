//! Whether a model can be run well: resolution, time step, absorbing cells, memory.

use super::{Axis, Grid, Model, Painted, Painted3};
use crate::units::constants::C0;
use crate::units::{Hertz, Metres};

/// Cells per wavelength below which gprMax refuses to run, and so does this.
pub const LEAST_CELLS_PER_WAVELENGTH: f64 = 3.0;
/// Cells per wavelength below which numerical dispersion shows; the gprMax user guide asks for as many.
pub const WANTED_CELLS_PER_WAVELENGTH: f64 = 10.0;

/// Why a model cannot be run.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CheckError {
    /// A time step beyond the Courant limit, or none at all.
    #[error(
        "a time step of {factor} times the Courant limit is not stable: the factor must lie in (0, 1]\n\n\
         hint: leave `#time_step_stability_factor` out, or give for example 0.99"
    )]
    StabilityFactor {
        /// Factor on the Courant step.
        factor: f64,
    },
    /// A cell size or a number of cells that is none.
    #[error("a grid of {0} x {1} x {2} cells of {3} x {4} x {5} m cannot be", cells[0], cells[1], cells[2], spacing[0], spacing[1], spacing[2])]
    Grid {
        /// Cell counts.
        cells: [usize; 3],
        /// Cell sizes, m.
        spacing: [f64; 3],
    },
    /// Absorbing cells that fill the grid, or along an axis where nothing changes.
    #[error(
        "{low} and {high} absorbing cells leave nothing of the {cells} cells along {axis}\n\n\
         hint: give fewer with `#pml_cells: x0 y0 z0 xmax ymax zmax`, 0 on a side without, or enlarge the domain"
    )]
    AbsorbingCells {
        /// `x`, `y` or `z`.
        axis: &'static str,
        /// At the lower end.
        low: usize,
        /// At the upper end.
        high: usize,
        /// Cells in all.
        cells: usize,
    },
    /// A TE model that is not two cells thick, or not two-dimensional.
    #[error(
        "a TE model across {} has two cells along that axis and more than one along the others, but this one has {} x {} x {}",
        axis.name(), cells[0], cells[1], cells[2]
    )]
    TransverseElectric {
        /// The axis that E lies across.
        axis: Axis,
        /// Cell counts.
        cells: [usize; 3],
    },
    /// Too few cells in the shortest wavelength.
    #[error("{0}")]
    TooCoarse(Resolution),
    /// More memory than there is.
    #[error(
        "the model needs {} of memory, but {} are available\n\n\
         hint: larger cells need less (twice the cell size, a quarter of the memory)",
        mebibytes(*.needed), mebibytes(*.available)
    )]
    Memory {
        /// Bytes needed.
        needed: u64,
        /// Bytes available.
        available: u64,
    },
}

/// Writes bytes as MiB.
pub fn mebibytes(bytes: u64) -> String {
    format!("{:.1} MiB", bytes as f64 / 1_048_576.0)
}

/// How well the cells resolve the shortest wavelength.
///
/// Displayed, it says so in words, with a hint that names the cell size to use.
#[derive(Debug, Clone, PartialEq)]
pub struct Resolution {
    /// Identifier of the material with the shortest wavelength.
    pub material: String,
    /// Its relative permittivity at `frequency`.
    pub eps_r: f64,
    /// The highest frequency of any pulse: above it the spectrum stays 40 dB below its peak.
    pub frequency: Hertz,
    /// The shortest wavelength.
    pub wavelength: Metres,
    /// The longer side of a cell.
    pub cell: Metres,
    /// Cells in the shortest wavelength.
    pub cells_per_wavelength: f64,
}

impl Resolution {
    /// Reads the resolution off a model; `None` without a source whose pulse has a highest frequency. Perfect conductors hold no wave and do not count.
    pub fn of(model: &Model, painted: &Painted) -> Option<Self> {
        Self::of_present(model, painted.cells_per_material(model.materials.len()))
    }

    /// As [`Resolution::of`], for any grid.
    pub fn of_three(model: &Model, painted: &Painted3) -> Option<Self> {
        Self::of_present(model, painted.cells_per_material(model.materials.len()))
    }

    /// The same from how many cells hold each material.
    fn of_present(model: &Model, present: Vec<usize>) -> Option<Self> {
        let highest = |source: &super::Source| model.waveforms.get(source.waveform())?.highest_frequency();
        let frequency = model.sources.iter().filter_map(highest).max_by(f64::total_cmp)?;
        let candidates =
            model.materials.iter().zip(model.acting(present)).filter(|(m, cells)| *cells > 0 && !m.is_pec());
        let of = |m: &super::Material| (m.id.clone(), m.eps_r_at(frequency) * m.mu_r);
        let (material, eps_r) = candidates.map(|(m, _)| of(m)).max_by(|a, b| a.1.total_cmp(&b.1))?;
        let wavelength = C0 / (frequency * eps_r.sqrt());
        let cell = longest_side(model);
        Some(Self {
            material,
            eps_r,
            frequency: Hertz(frequency),
            wavelength: Metres(wavelength),
            cell: Metres(cell),
            cells_per_wavelength: wavelength / cell,
        })
    }

    /// Whether numerical dispersion will show: under ten cells per wavelength.
    pub fn is_coarse(&self) -> bool {
        self.cells_per_wavelength < WANTED_CELLS_PER_WAVELENGTH
    }

    /// Refuses what gprMax refuses.
    ///
    /// # Errors
    /// Under three cells per wavelength.
    pub fn check(&self) -> Result<(), CheckError> {
        if self.cells_per_wavelength < LEAST_CELLS_PER_WAVELENGTH {
            return Err(CheckError::TooCoarse(self.clone()));
        }
        Ok(())
    }

    /// The cell size that gives the ten cells wanted, rounded down to two digits.
    pub fn wanted_cell(&self) -> Metres {
        let cell = self.wavelength.si() / WANTED_CELLS_PER_WAVELENGTH;
        let digit = 10f64.powf(cell.log10().floor() - 1.0);
        let text = format!("{:.1e}", ((cell / digit) * (1.0 + 1e-12)).floor() * digit);
        Metres(text.parse().unwrap_or(cell))
    }
}

impl std::fmt::Display for Resolution {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { material, eps_r, .. } = self;
        let [cell, wavelength] = [self.cell, self.wavelength].map(|length| length.si() * 1e3);
        let frequency = self.frequency.si() / 1e9;
        let verdict = if self.cells_per_wavelength < LEAST_CELLS_PER_WAVELENGTH { "too coarse" } else { "coarse" };
        writeln!(f, "cells of {} mm are {verdict} for this scene", short(cell))?;
        writeln!(
            f,
            "  shortest wavelength   {wavelength:.1} mm  ({frequency:.1} GHz in `{material}`, eps_r {})",
            short(*eps_r)
        )?;
        writeln!(f, "  cells per wavelength   {:.1}, at least 10 wanted\n", self.cells_per_wavelength)?;
        let wanted = self.wanted_cell().in_unit("mm").replace(' ', "");
        write!(f, "hint: `--cell {wanted}`, or a lower `--frequency`")
    }
}

/// At most three digits after the point, and no idle zeros.
fn short(value: f64) -> String {
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn longest_side(model: &Model) -> f64 {
    let invariant = model.invariant_axis();
    (0..3).filter(|&axis| Some(axis) != invariant).map(|axis| model.grid.spacing[axis]).fold(0.0, f64::max)
}

/// Refuses a time step beyond the Courant limit, and a grid that cannot be.
///
/// # Errors
/// A stability factor outside (0, 1], or a cell size that is not a positive number.
pub fn check_stability_factor(model: &Model) -> Result<(), CheckError> {
    let Grid { cells, spacing } = model.grid;
    if cells.contains(&0) || spacing.iter().any(|d| !(*d > 0.0 && d.is_finite())) {
        return Err(CheckError::Grid { cells, spacing });
    }
    let factor = model.stability_factor;
    if factor > 0.0 && factor <= 1.0 { Ok(()) } else { Err(CheckError::StabilityFactor { factor }) }
}

/// Refuses a TE model that is not two cells thick, or has an axis of a single cell.
///
/// # Errors
/// With the axis and the cell counts.
pub fn check_mode(model: &Model) -> Result<(), CheckError> {
    let cells = model.grid.cells;
    match model.transverse_electric {
        Some(axis) if cells[axis.index()] != 2 || cells.contains(&1) => {
            Err(CheckError::TransverseElectric { axis, cells })
        }
        _ => Ok(()),
    }
}

/// Refuses absorbing cells that leave nothing between them.
///
/// # Errors
/// When those of the two ends of an axis fill it.
pub fn check_absorbing_cells(model: &Model) -> Result<(), CheckError> {
    let absorbing = model.absorbing_cells();
    for (side, axis) in ["x", "y", "z"].into_iter().enumerate() {
        let (low, high, cells) = (absorbing[side], absorbing[side + 3], model.grid.cells[side]);
        if low + high > 0 && low + high >= cells {
            return Err(CheckError::AbsorbingCells { axis, low, high, cells });
        }
    }
    Ok(())
}

/// Refuses more samples than the memory holds, before any is made: six components at each receiver, and the drive of each
/// source in either precision.
///
/// # Errors
/// When the samples alone need more memory than is available.
pub fn check_recording(model: &Model, available: Option<u64>) -> Result<(), CheckError> {
    let per_step = 48 * model.receivers.len() as u64 + 16 * model.sources.len() as u64;
    check_memory(per_step.saturating_mul(model.iterations() as u64), available)
}

/// Memory that programs may still take, bytes; `None` where the system does not tell.
pub fn available_memory() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok().map(|kibibytes| kibibytes * 1024)
}

/// Refuses to begin what the memory cannot hold.
///
/// # Errors
/// When more is needed than is available.
pub fn check_memory(needed: u64, available: Option<u64>) -> Result<(), CheckError> {
    match available {
        Some(available) if needed > available => Err(CheckError::Memory { needed, available }),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{
        Axis, DebyePole, Excitation, HertzianDipole, Material, Object, Source, TimeWindow, Waveform, WaveformKind,
        paint,
    };

    fn model(cell: f64, material: Material) -> Model {
        let grid = Grid { cells: [20, 20, 1], spacing: [cell; 3] };
        let mut model = Model::new("", grid, TimeWindow::Iterations(1));
        let id = model.add_material(material);
        model.objects.push(Object::Box { lower: [0.0; 3], upper: [1.0; 3], material: id, averaging: true });
        model.waveforms.push(Waveform { id: "w".into(), kind: WaveformKind::Ricker, amplitude: 1.0, frequency: 1e9 });
        let excitation = Excitation { start: 0.0, stop: None };
        let dipole =
            HertzianDipole { polarisation: Axis::Z, position: [cell * 9.0, cell * 9.0, 0.0], waveform: 0, excitation };
        model.sources.push(Source::HertzianDipole(dipole));
        model
    }

    fn resolution(cell: f64, material: Material) -> Resolution {
        let model = model(cell, material);
        Resolution::of(&model, &paint(&model).unwrap()).unwrap()
    }

    /// A Ricker spectrum `x² exp(1 - x²)` falls to 1 % at x = 2.76; c/(2.76 GHz sqrt(90)) / 4 mm = 2.86 cells. gprMax reads
    /// the same frequency off the bins of a Fourier transform, so it finds 2.83 to 2.99 GHz, the more the shorter the window.
    #[test]
    fn under_three_cells_per_wavelength_are_refused() {
        let resolution = resolution(0.004, Material::dielectric("wet", 90.0, 0.0));
        assert!((resolution.cells_per_wavelength - 2.86).abs() < 0.01, "{}", resolution.cells_per_wavelength);
        let message = resolution.check().unwrap_err().to_string();
        assert!(message.starts_with("cells of 4 mm are too coarse for this scene\n"), "{message}");
        assert!(message.contains("11.4 mm  (2.8 GHz in `wet`, eps_r 90)"), "{message}");
        assert!(message.contains("hint: `--cell 1.1mm`, or a lower `--frequency`"), "{message}");
    }

    /// A Debye pole counts with what is left of it at the highest frequency: water 80.1 at rest, 78.2 at 2.76 GHz.
    #[test]
    fn debye_materials_count_at_the_highest_frequency() {
        let mut water = Material::dielectric("water", 4.9, 0.0);
        water.poles.push(DebyePole { delta_eps: 75.2, tau: 9.231e-12 });
        let found = resolution(0.002, water);
        let omega_tau = 2.0 * std::f64::consts::PI * found.frequency.si() * 9.231e-12;
        assert_eq!(found.eps_r, 4.9 + 75.2 / (1.0 + omega_tau * omega_tau));
        assert!((found.eps_r - 78.2).abs() < 0.3);
        assert!(found.check().is_ok() && found.is_coarse());
    }

    #[test]
    fn materials_that_are_not_on_the_grid_do_not_count() {
        let mut model = model(0.002, Material::dielectric("stone", 6.0, 0.0));
        model.add_material(Material::dielectric("idle", 80.0, 0.0));
        let resolution = Resolution::of(&model, &paint(&model).unwrap()).unwrap();
        assert_eq!(resolution.material, "stone");
        assert!(!resolution.is_coarse());
    }

    #[test]
    fn time_steps_beyond_the_courant_limit_are_refused() {
        let mut model = model(0.002, Material::dielectric("stone", 6.0, 0.0));
        for (factor, fine) in [(0.99, true), (1.0, true), (1.01, false), (0.0, false), (-1.0, false), (f64::NAN, false)]
        {
            model.stability_factor = factor;
            assert_eq!(check_stability_factor(&model).is_ok(), fine, "{factor}");
        }
    }

    /// A billion steps at one receiver and one source: 64 GB of samples, whatever the grid.
    #[test]
    fn samples_beyond_the_memory_are_refused() {
        let mut model = model(0.002, Material::dielectric("stone", 6.0, 0.0));
        model.receivers.push(crate::model::Receiver { position: [0.0; 3], name: None });
        model.time_window = TimeWindow::Iterations(1_000_000_000);
        assert_eq!(
            check_recording(&model, Some(8 << 30)),
            Err(CheckError::Memory { needed: 64_000_000_000, available: 8 << 30 })
        );
        assert!(check_recording(&model, Some(64_000_000_000)).is_ok() && check_recording(&model, None).is_ok());
    }

    #[test]
    fn memory_errors_name_both_numbers() {
        let message = check_memory(3 << 30, Some(1 << 30)).unwrap_err().to_string();
        assert!(message.starts_with("the model needs 3072.0 MiB of memory, but 1024.0 MiB are available"), "{message}");
        assert!(check_memory(3 << 30, None).is_ok());
    }
}
