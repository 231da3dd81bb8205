//! The built-in solver against gprMax: its stored double-precision outputs, and gprMax itself on the tanks.

use std::fs;
use std::path::{Path, PathBuf};

use crate::cli::error::CliError;
use crate::cli::interrupt;
use crate::cli::progress::Bar;
use crate::cli::run::{PrecisionName, gprmax_solver};
use crate::cli::table::Report;
use crate::cli::validate::{CaseReport, Tier, ValidateArgs};
use crate::compare;
use crate::fdtd::{Fdtd, Precision};
use crate::forward::Forward as _;
use crate::gprmax;
use crate::model::Model;
use crate::raster;
use crate::scene::{FoulingSpec, GeometryKind, SceneSpec, resolve};
use crate::trace::{Component, Traces};

/// Largest relative L2 difference in single precision: gprMax's own single precision differs by 1e-6 to 4e-6 of the peak.
pub const SINGLE_LIMIT: f64 = 2e-5;
/// Largest relative L2 difference in double precision: rounding over a few thousand steps.
pub const DOUBLE_LIMIT: f64 = 1e-10;

struct Agreement {
    name: String,
    cells: [usize; 3],
    steps: usize,
    single: f64,
    double: f64,
}

impl Agreement {
    fn holds(&self) -> bool {
        self.single <= SINGLE_LIMIT && self.double <= DOUBLE_LIMIT
    }
}

/// Runs every stored case, and in the full tier gprMax on the clean and the fouled tank.
pub fn validate(args: &ValidateArgs) -> Result<CaseReport, CliError> {
    let mut found = Vec::new();
    for folder in cases(&args.cases)? {
        let name = folder.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned());
        let model = gprmax::read_model(&folder.join("scene.in"))?;
        let theirs = gprmax::read_traces(&folder.join("out_f64.h5"))?;
        found.push(agree(&name, &model, &theirs)?);
    }
    if args.tier == Tier::Full {
        for (name, fouling, geometry) in [
            ("clean tank", None, GeometryKind::Voxels),
            ("tank, 20 cm of fouling", Some("20cm"), GeometryKind::Cylinders),
        ] {
            let mut spec = SceneSpec::preset("tank")?;
            spec.fouling = fouling.map(|amount| amount.parse().map(FoulingSpec::of)).transpose()?;
            spec.grid.geometry = geometry;
            let model = raster::build_model(&resolve(&spec)?)?;
            let solver = gprmax_solver(args.gprmax_python.as_deref(), PrecisionName::Double, None)?;
            let bar = Bar::new(format!("gprMax: {name}"));
            let theirs = solver.solve(&model, &|progress| bar.update(progress))?;
            drop(bar);
            found.push(agree(name, &model, &theirs)?);
        }
    }
    report(&found)
}

/// Folders that hold a `scene.in` and an `out_f64.h5`.
fn cases(folder: &Path) -> Result<Vec<PathBuf>, CliError> {
    let entries = fs::read_dir(folder).map_err(|error| {
        CliError::input(format!(
            "the folder `{}` with gprMax's outputs cannot be read: {error}\n\nhint: start in the program's source folder, or name it with `--cases`",
            folder.display()
        ))
    })?;
    let mut folders: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.join("scene.in").is_file() && path.join("out_f64.h5").is_file())
        .collect();
    folders.sort();
    if folders.is_empty() {
        return Err(CliError::input(format!(
            "the folder `{}` holds no case (scene.in with out_f64.h5)",
            folder.display()
        )));
    }
    Ok(folders)
}

fn agree(name: &str, model: &Model, theirs: &Traces) -> Result<Agreement, CliError> {
    let difference = |precision| -> Result<f64, CliError> {
        let ours = Fdtd { precision, ..Fdtd::default() }.solve(model, &|_| interrupt::flow())?;
        worst_difference(theirs, &ours)
    };
    Ok(Agreement {
        name: name.into(),
        cells: model.grid.cells,
        steps: model.iterations(),
        single: difference(Precision::Single)?,
        double: difference(Precision::Double)?,
    })
}

/// Largest relative L2 difference of Ez over the receivers.
///
/// # Errors
/// When the two runs do not have the same receivers, steps or samples.
pub fn worst_difference(theirs: &Traces, ours: &Traces) -> Result<f64, CliError> {
    if theirs.receivers.len() != ours.receivers.len() || theirs.receivers.is_empty() {
        return Err(CliError::input(format!("{} receivers against {}", theirs.receivers.len(), ours.receivers.len())));
    }
    let mut worst: f64 = 0.0;
    for (a, b) in theirs.receivers.iter().zip(&ours.receivers) {
        let (Some(a), Some(b)) = (a.component(Component::Ez), b.component(Component::Ez)) else {
            return Err(CliError::input(format!("receiver `{}` has no Ez", a.name)));
        };
        worst = worst.max(compare::relative_l2(a, b)?);
    }
    Ok(worst)
}

fn power_of_ten_above(value: f64) -> String {
    format!("< 1e{}", (2.0 * value).log10().ceil())
}

fn report(found: &[Agreement]) -> Result<CaseReport, CliError> {
    let title = "gprmax: relative L2 difference of Ez between the built-in solver and gprMax 4.0.1 in double precision";
    let mut table = Report::new(title, ["case", "cells", "steps", "single (≤ 2e-5)", "double (≤ 1e-10)", "verdict"]);
    let mut json = Vec::new();
    for case in found {
        table.row([
            case.name.clone(),
            format!("{} x {}", case.cells[0], case.cells[1]),
            case.steps.to_string(),
            format!("{:.1e}", case.single),
            format!("{:.1e}", case.double),
            if case.holds() { "agrees" } else { "DIFFERS" }.into(),
        ]);
        // The last digits are rounding, which another mathematical library may do otherwise.
        table.in_markdown(3, power_of_ten_above(case.single));
        table.in_markdown(4, power_of_ten_above(case.double));
        json.push(serde_json::json!({
            "case": case.name, "cells": case.cells, "steps": case.steps, "single": case.single, "double": case.double,
            "agrees": case.holds(),
        }));
    }
    let misses = found.iter().filter(|case| !case.holds()).count();
    Ok(CaseReport { title: title.into(), table, json: json.into(), misses })
}
