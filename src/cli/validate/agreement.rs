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
use crate::forward::{Forward as _, ForwardError, Progress};
use crate::gprmax;
use crate::model::Model;
use crate::raster;
use crate::scene::{FoulingSpec, GeometryKind, SceneSpec, resolve};
use crate::trace::Traces;

/// Largest relative difference in single precision on a plane: gprMax's own single precision differs by 1e-6 to 4e-6.
pub const SINGLE_LIMIT: f64 = 2e-5;
/// The same in three dimensions, where gprMax's own differs by up to 7e-4 of the peak.
pub const SINGLE_LIMIT_3D: f64 = 1e-3;
/// Largest relative difference in double precision: rounding over a few thousand steps.
pub const DOUBLE_LIMIT: f64 = 1e-10;

struct Agreement {
    name: String,
    cells: [usize; 3],
    steps: usize,
    single: f64,
    double: f64,
    /// Between what gprMax gives now and what was stored.
    stored: Option<f64>,
}

impl Agreement {
    fn single_limit(&self) -> f64 {
        if self.cells[2] == 1 { SINGLE_LIMIT } else { SINGLE_LIMIT_3D }
    }

    fn holds(&self) -> bool {
        self.single <= self.single_limit()
            && self.double <= DOUBLE_LIMIT
            && self.stored.is_none_or(|difference| difference <= DOUBLE_LIMIT)
    }
}

/// Runs every stored case; in the full tier gprMax runs each of them again, and the clean and the fouled tank.
pub fn validate(args: &ValidateArgs) -> Result<CaseReport, CliError> {
    let mut found = Vec::new();
    let folders: Vec<PathBuf> = args.cases.iter().map(|folder| cases(folder)).collect::<Result<Vec<_>, _>>()?.concat();
    let bar = Bar::new("cases");
    for (index, folder) in folders.iter().enumerate() {
        if bar.update(Progress { done: index, total: folders.len() }).is_break() {
            return Err(ForwardError::Stopped.into());
        }
        let name = folder.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned());
        let model = gprmax::read_model(&folder.join("scene.in"))?;
        let kept = gprmax::read_traces(&folder.join("out_f64.h5"))?;
        if args.tier == Tier::Fast {
            found.push(agree(&name, &model, &kept)?);
            continue;
        }
        let now = run_again(args, folder)?;
        let stored = compare::worst_field_difference(&kept, &now)?;
        found.push(Agreement { stored: Some(stored), ..agree(&name, &model, &now)? });
    }
    drop(bar);
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
    report(&found, args.markdown)
}

/// Runs a case through gprMax in a folder of its own: what the case writes beside itself is not left among the stored files.
fn run_again(args: &ValidateArgs, case: &Path) -> Result<Traces, CliError> {
    let place = tempfile::tempdir().map_err(|error| CliError::input(format!("no temporary folder: {error}")))?;
    copy(case, place.path())
        .map_err(|error| CliError::input(format!("the case `{}` cannot be copied: {error}", case.display())))?;
    let solver = gprmax_solver(args.gprmax_python.as_deref(), PrecisionName::Double, None)?;
    let run = solver.run_file(&place.path().join("scene.in"), &place.path().join("now.h5"), &|_| interrupt::flow());
    Ok(run?.traces)
}

/// Copies what a folder holds, and what its folders hold, into another that is there.
fn copy(from: &Path, to: &Path) -> std::io::Result<()> {
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let place = to.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            fs::create_dir(&place)?;
            copy(&entry.path(), &place)?;
        } else {
            fs::copy(entry.path(), &place)?;
        }
    }
    Ok(())
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
        Ok(compare::worst_field_difference(theirs, &ours)?)
    };
    Ok(Agreement {
        name: name.into(),
        cells: model.grid.cells,
        steps: model.iterations(),
        single: difference(Precision::Single)?,
        double: difference(Precision::Double)?,
        stored: None,
    })
}

/// Every case in a row of its own; in Markdown, which is for the README, the worst of each kind.
fn report(found: &[Agreement], summary: bool) -> Result<CaseReport, CliError> {
    let title = "gprmax: the built-in solver against gprMax 4.0.1 in double precision, all components and receivers";
    let (single, double) = ("single (≤ 2e-5, 3-D ≤ 1e-3)", "double (≤ 1e-10)");
    let verdict = |holds| if holds { "agrees" } else { "DIFFERS" };
    let table = if summary {
        let mut table = Report::new(title, ["cases", "single precision", "double precision", "verdict"]);
        let (two, three): (Vec<&Agreement>, Vec<&Agreement>) = found.iter().partition(|case| case.cells[2] == 1);
        for (name, cases, limit) in
            [("two dimensions", two, SINGLE_LIMIT), ("three dimensions", three, SINGLE_LIMIT_3D)]
        {
            let worst = |of: fn(&Agreement) -> f64| cases.iter().map(|case| of(case)).fold(0.0, f64::max);
            // The figures themselves end in rounding, which another mathematical library may do otherwise.
            let shown =
                |worst: f64, limit| if worst <= limit { format!("≤ {limit:e}") } else { format!("{worst:.1e}") };
            table.row([
                name.to_owned(),
                shown(worst(|case| case.single), limit),
                shown(worst(|case| case.double), DOUBLE_LIMIT),
                verdict(cases.iter().all(|case| case.holds())).into(),
            ]);
        }
        table
    } else {
        let mut table =
            Report::new(title, ["case", "cells", "steps", single, double, "gprMax now and stored", "verdict"]);
        for case in found {
            let cells = if case.cells[2] == 1 { &case.cells[..2] } else { &case.cells[..] };
            table.row([
                case.name.clone(),
                cells.iter().map(usize::to_string).collect::<Vec<_>>().join(" x "),
                case.steps.to_string(),
                format!("{:.1e}", case.single),
                format!("{:.1e}", case.double),
                case.stored.map_or("–".into(), |difference| format!("{difference:.1e}")),
                verdict(case.holds()).into(),
            ]);
        }
        table
    };
    let json = found.iter().map(|case| {
        serde_json::json!({
            "case": case.name, "cells": case.cells, "steps": case.steps, "single": case.single, "double": case.double,
            "gprmax_now_and_stored": case.stored, "agrees": case.holds(),
        })
    });
    let misses = found.iter().filter(|case| !case.holds()).count();
    Ok(CaseReport { title: title.into(), table, json: json.collect(), misses })
}
