//! Reading output files.

use std::path::Path;

use super::super::hdf5::H5File;
use super::error::OutputError;
use crate::trace::{AScan, Component, ReceiverTraces, Traces};
use crate::units::{Metres, Seconds};

/// Reads an output file of gprMax 4 (`.h5`) or 3 (`.out`), of one run or merged from several.
///
/// The time of the first sample is taken from each dataset (gprMax 4), or is minus half a step for H and zero for E
/// (gprMax 3, which does not record it). A merged file gives one receiver per trace, named `NAME trace 1`, `NAME trace 2`, …
/// Early files of gprMax 3 do not record cell counts: `cells` is then zero along each axis. Only the six field components
/// are read.
///
/// # Errors
/// See [`OutputError`]; an attribute that is missing is named, never guessed.
pub fn read_traces(path: &Path) -> Result<Traces, OutputError> {
    let file = H5File::open(path)?;
    if !file.has("/rxs") || file.children("/rxs")?.0.is_empty() {
        return Err(OutputError::NoReceivers { path: path.into() });
    }
    let run = Run::of(&file)?;
    let mut receivers = vec![];
    for group in file.children("/rxs")?.0 {
        receivers.extend(run.receiver(&group)?);
    }
    let solver = match (file.attribute("/", "Solver")?, &run.version) {
        (Some(_), _) => file.text("/", "Solver")?,
        (None, Some(version)) => format!("gprMax {version}"),
        (None, None) => "gprMax before 3.1".into(),
    };
    Ok(Traces {
        title: file.text("/", "Title")?,
        solver,
        time_step: Seconds(run.time_step),
        iterations: run.iterations,
        cells: run.cells,
        spacing: run.spacing.map(Metres),
        double_precision: run.double_precision()?,
        receivers,
    })
}

/// What holds for the whole file.
struct Run<'a> {
    file: &'a H5File,
    version: Option<String>,
    iterations: usize,
    time_step: f64,
    spacing: [f64; 3],
    cells: [usize; 3],
}

impl<'a> Run<'a> {
    fn of(file: &'a H5File) -> Result<Self, OutputError> {
        let value = |name, value, limit| OutputError::Value { path: file.path().into(), name, value, limit };
        let iterations = match file.integers("/", "Iterations")?[..] {
            [count] if count > 0 => count as usize,
            ref other => return Err(value("Iterations", other.first().map_or(0.0, |&n| n as f64), "1 or more")),
        };
        let time_step = file.float("/", "dt")?;
        if !(time_step > 0.0 && time_step.is_finite()) {
            return Err(value("dt", time_step, "above 0"));
        }
        let version = match file.attribute("/", "gprMax")? {
            Some(_) => Some(file.text("/", "gprMax")?),
            None => None,
        };
        // Files before gprMax 3.1 name the cell sizes "dx, dy, dz" and do not record the version or the cell counts.
        let old = version.is_none() && file.attribute("/", "dx, dy, dz")?.is_some();
        let spacing = three(file, "/", if old { "dx, dy, dz" } else { "dx_dy_dz" })?;
        let cells = match file.attribute("/", "nx_ny_nz")? {
            None if old => [0; 3],
            _ => {
                let counts = file.integers("/", "nx_ny_nz")?;
                match counts[..] {
                    [x, y, z] if x > 0 && y > 0 && z > 0 => [x as usize, y as usize, z as usize],
                    _ => return Err(file.wrong("/", "nx_ny_nz", "three counts above 0", format!("{counts:?}")).into()),
                }
            }
        };
        Ok(Self { file, version, iterations, time_step, spacing, cells })
    }

    /// Version 4 records the time of the first sample beside each dataset.
    fn is_version_4(&self) -> bool {
        self.version.as_ref().is_some_and(|version| !version.starts_with(['1', '2', '3']))
    }

    /// The receivers of one group: one, or one per trace of a merged file.
    fn receiver(&self, group: &str) -> Result<Vec<ReceiverTraces>, OutputError> {
        let object = format!("/rxs/{group}");
        let (_, datasets) = self.file.children(&object)?;
        let name = match self.file.attribute(&object, "Name")? {
            Some(_) => self.file.text(&object, "Name")?,
            None if self.is_version_4() => self.file.text(&object, "Name")?,
            None => group.into(),
        };
        let mut receivers: Vec<ReceiverTraces> = vec![];
        for component in Component::FIELDS.into_iter().filter(|c| datasets.iter().any(|name| name == c.name())) {
            let dataset = format!("{object}/{}", component.name());
            let (columns, samples) = self.columns(&dataset)?;
            if receivers.is_empty() {
                receivers = self.named(group, &object, &name, columns)?;
            }
            if receivers.len() != columns {
                let (path, shape) = (self.file.path().into(), self.file.shape(&dataset)?);
                return Err(OutputError::Shape { path, dataset, shape, iterations: self.iterations });
            }
            let first_sample = Seconds(self.first_sample(&dataset, component)?);
            for (column, receiver) in receivers.iter_mut().enumerate() {
                receiver.components.push(AScan {
                    samples: samples.iter().skip(column).step_by(columns).copied().collect(),
                    time_step: Seconds(self.time_step),
                    first_sample,
                    component,
                    position: Some(receiver.position),
                    name: format!("{} {}", receiver.name, component.name()),
                });
            }
        }
        Ok(receivers)
    }

    /// Number of traces in a dataset, and its samples.
    fn columns(&self, dataset: &str) -> Result<(usize, Vec<f64>), OutputError> {
        let shape = self.file.shape(dataset)?;
        let columns = match shape[..] {
            [samples] if samples == self.iterations => 1,
            [samples, columns] if samples == self.iterations && columns > 0 => columns,
            _ => {
                let (path, dataset) = (self.file.path().into(), dataset.into());
                return Err(OutputError::Shape { path, dataset, shape, iterations: self.iterations });
            }
        };
        Ok((columns, self.file.read_f64(dataset)?))
    }

    fn first_sample(&self, dataset: &str, component: Component) -> Result<f64, OutputError> {
        if self.is_version_4() {
            return Ok(self.file.float(dataset, "TimeSampleOffset")?);
        }
        Ok(if component.is_magnetic() { -0.5 * self.time_step } else { 0.0 })
    }

    /// Receivers with their names and positions, still without traces.
    fn named(&self, group: &str, object: &str, name: &str, columns: usize) -> Result<Vec<ReceiverTraces>, OutputError> {
        let empty = |name: String, position: [f64; 3]| ReceiverTraces {
            name,
            position: position.map(Metres),
            components: vec![],
        };
        let first = self.position(object)?;
        if columns == 1 {
            return Ok(vec![empty(name.into(), first)]);
        }
        let positions = self.merged_positions(group, first, columns)?;
        Ok(positions.into_iter().enumerate().map(|(n, at)| empty(format!("{name} trace {}", n + 1), at)).collect())
    }

    /// An attribute, or in files before gprMax 3.1 a dataset.
    fn position(&self, object: &str) -> Result<[f64; 3], OutputError> {
        let dataset = format!("{object}/Position");
        if self.file.attribute(object, "Position")?.is_none() && !self.is_version_4() && self.file.has(&dataset) {
            let values = self.file.read_f64(&dataset)?;
            return values[..].try_into().map_err(|_| {
                self.file.wrong(object, "Position", "three coordinates", format!("{} values", values.len())).into()
            });
        }
        three(self.file, object, "Position")
    }

    /// Positions of the traces of a merged file: recorded by gprMax 4, from the first position and the step in gprMax 3.
    fn merged_positions(&self, group: &str, first: [f64; 3], columns: usize) -> Result<Vec<[f64; 3]>, OutputError> {
        let recorded = format!("/trace_metadata/rxs/{group}/Position");
        if self.file.has(&recorded) {
            let values = self.file.read_f64(&recorded)?;
            let positions = values.as_chunks::<3>().0;
            if values.len() == 3 * columns {
                return Ok(positions.to_vec());
            }
            let (path, shape) = (self.file.path().into(), self.file.shape(&recorded)?);
            return Err(OutputError::Shape { path, dataset: recorded, shape, iterations: columns });
        }
        let steps = three(self.file, "/", "rxsteps")?;
        let at =
            |trace: usize| std::array::from_fn(|axis| first[axis] + trace as f64 * steps[axis] * self.spacing[axis]);
        Ok((0..columns).map(at).collect())
    }

    fn double_precision(&self) -> Result<bool, OutputError> {
        for group in self.file.children("/rxs")?.0 {
            for component in Component::FIELDS {
                let dataset = format!("/rxs/{group}/{}", component.name());
                if self.file.has(&dataset) {
                    return Ok(self.file.is_f64(&dataset)?);
                }
            }
        }
        Ok(false)
    }
}

/// Three floats from an attribute.
fn three(file: &H5File, object: &str, name: &str) -> Result<[f64; 3], OutputError> {
    let values = file.floats(object, name)?;
    values[..]
        .try_into()
        .map_err(|_| file.wrong(object, name, "three numbers", format!("{} of them", values.len())).into())
}
