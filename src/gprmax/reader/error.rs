//! What can be wrong with an input file.

use std::path::PathBuf;

use super::super::geometry::GeometryError;
use crate::files::FileError;
use crate::model::SnapshotError;

/// Why an input file was not read.
#[derive(Debug, thiserror::Error)]
pub enum InFileError {
    /// The system refused.
    #[error(transparent)]
    File(#[from] FileError),
    /// A line is wrong.
    #[error("`{}` line {line}: {problem}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: usize,
        /// What is wrong.
        problem: Box<Problem>,
    },
    /// One of the three commands that every file needs is not there.
    #[error("`{}` has no `#{command}`\n\nhint: write for example `{example}`", path.display())]
    Missing {
        /// The file.
        path: PathBuf,
        /// The command.
        command: &'static str,
        /// Something to write.
        example: &'static str,
    },
    /// The default absorbing boundary does not fit into the domain.
    #[error(
        "`{}`: the default of {} absorbing cells on each side does not fit into {cells} cells along {axis}\n\nhint: write for example `#pml_cells: 5 5 0 5 5 0`, or enlarge the domain",
        path.display(),
        layer
    )]
    DefaultPml {
        /// The file.
        path: PathBuf,
        /// `x`, `y` or `z`.
        axis: &'static str,
        /// Cells along it.
        cells: usize,
        /// Absorbing cells on each side.
        layer: usize,
    },
}

/// What is wrong with a line.
#[derive(Debug, thiserror::Error)]
pub enum Problem {
    /// A comment for the embedded solver that it does not know.
    #[error(
        "`{text}` is nothing that the embedded solver can be told\n\nhint: `## ballast-gpr: order 4` or `## ballast-gpr: averaging shapes`"
    )]
    Directive {
        /// What stands there.
        text: String,
    },
    /// No colon behind the name.
    #[error("a colon is missing behind the command in `{text}`\n\nhint: `#command: parameters`")]
    NoColon {
        /// The line.
        text: String,
    },
    /// No space behind the colon.
    #[error("a space is missing behind the colon of `#{command}:`")]
    NoSpace {
        /// The command.
        command: String,
    },
    /// Nobody knows the command.
    #[error("`#{command}` is not a gprMax command{}", nearest.map_or(String::new(), |name| format!("\n\nhint: did you mean `#{name}`?")))]
    Unknown {
        /// The command.
        command: String,
        /// The nearest known one.
        nearest: Option<&'static str>,
    },
    /// gprMax knows the command, this program does not act on it.
    #[error(
        "`#{command}` is not supported by the embedded solver\n\nhint: `--solver gprmax` runs the file in gprMax itself"
    )]
    Unsupported {
        /// The command.
        command: String,
    },
    /// gprMax no longer knows the command.
    #[error("`#{command}` is not a command of gprMax 4\n\nhint: {instead}")]
    Retired {
        /// The command.
        command: String,
        /// What to do.
        instead: &'static str,
    },
    /// A form of a supported command that is not supported.
    #[error(
        "{what} of `#{command}` is not supported by the embedded solver\n\nhint: `--solver gprmax` runs the file in gprMax itself"
    )]
    UnsupportedForm {
        /// The command.
        command: String,
        /// The form.
        what: &'static str,
    },
    /// A command that may stand once stands twice.
    #[error("`#{command}` stands for the second time, first in line {first}")]
    Duplicate {
        /// The command.
        command: String,
        /// Line of the first.
        first: usize,
    },
    /// Wrong number of parameters.
    #[error("`#{command}` has {found} parameters\n\nhint: `#{command}: {form}`")]
    Parameters {
        /// The command.
        command: String,
        /// How many stand there.
        found: usize,
        /// How it is written.
        form: &'static str,
    },
    /// Something that should be a number is not.
    #[error("`{text}` is not a number: `#{command}` wants {what} there")]
    NotANumber {
        /// The command.
        command: String,
        /// What stands there.
        text: String,
        /// What should.
        what: &'static str,
    },
    /// A number outside its range.
    #[error("{what} of `#{command}` is {value}, it should be {limit}")]
    OutOfRange {
        /// The command.
        command: String,
        /// What the number means.
        what: &'static str,
        /// The number.
        value: f64,
        /// What is allowed.
        limit: &'static str,
    },
    /// A word that is not one of those allowed.
    #[error("`{text}` is not {what}, which `#{command}` wants there: one of {known}")]
    Word {
        /// The command.
        command: String,
        /// What stands there.
        text: String,
        /// What it should be.
        what: &'static str,
        /// The words allowed.
        known: String,
    },
    /// A material or waveform that is not defined.
    #[error("the {what} `{id}` is not defined{}", nearest.as_ref().map_or(String::new(), |name| format!("\n\nhint: did you mean `{name}`?")))]
    Undefined {
        /// `material` or `waveform`.
        what: &'static str,
        /// The identifier.
        id: String,
        /// The nearest one that is.
        nearest: Option<String>,
    },
    /// A material or waveform that is defined already.
    #[error("the {what} `{id}` is defined already")]
    DefinedTwice {
        /// `material`, `waveform` or `geometry file`.
        what: &'static str,
        /// The identifier.
        id: String,
    },
    /// Too many cells to be meant.
    #[error("a domain of {} x {} x {} cells ({total:.1e} in all) is beyond the limit of {limit:.1e} cells\n\nhint: `#domain` and `#dx_dy_dz` are in metres", cells[0], cells[1], cells[2])]
    TooManyCells {
        /// Cells along x, y, z.
        cells: [f64; 3],
        /// Their product.
        total: f64,
        /// The most that is taken.
        limit: f64,
    },
    /// The absorbing boundary does not fit.
    #[error("{below} + {above} absorbing cells do not fit into the {cells} along {axis}{}", if *cells == 1 { "\n\nhint: a two-dimensional model needs six values, for example `#pml_cells: 10 10 0 10 10 0`" } else { "" })]
    PmlTooThick {
        /// `x`, `y` or `z`.
        axis: &'static str,
        /// Cells at the lower side.
        below: usize,
        /// Cells at the upper side.
        above: usize,
        /// Cells along the axis.
        cells: usize,
    },
    /// A position outside the domain.
    #[error("the {what} at {x} {y} {z} m lies outside the domain of {} x {} x {} m", domain[0], domain[1], domain[2])]
    Outside {
        /// `source`, `receiver` or `corner of the box`.
        what: &'static str,
        /// Position, m.
        x: f64,
        /// Position, m.
        y: f64,
        /// Position, m.
        z: f64,
        /// Extents, m.
        domain: [f64; 3],
    },
    /// An array of receivers that runs backwards.
    #[error("the first corner of `#rx_array` lies beyond its second along {axis}: {lower} m and {upper} m")]
    ArrayCorners {
        /// Axis.
        axis: &'static str,
        /// First corner, m.
        lower: f64,
        /// Second corner, m.
        upper: f64,
    },
    /// A box without a cell.
    #[error("`#{command}` fills no cell along {axis}: it reaches from {lower} m to {upper} m")]
    NoCells {
        /// Name of the command.
        command: String,
        /// `x`, `y` or `z`.
        axis: &'static str,
        /// Lower coordinate, m.
        lower: f64,
        /// Upper coordinate, m.
        upper: f64,
    },
    /// A source across a two-dimensional model.
    #[error("a source along {polarisation} in a model of one cell along {axis}: it must point {how} {axis}")]
    Polarisation {
        /// Direction of the source.
        polarisation: &'static str,
        /// Axis of the single cell.
        axis: &'static str,
        /// `along` for currents and voltages, `across` for magnetic dipoles.
        how: &'static str,
    },
    /// A two-dimensional mode without its infinite axis.
    #[error(
        "`#domain` has {found} infinite axes, but `#domain_mode: TM` and `TE` want one\n\n\
         hint: write `inf` for the axis along which nothing changes, for example `#domain: 0.6 0.5 inf`"
    )]
    InfiniteAxes {
        /// How many there are.
        found: usize,
    },
    /// An infinite axis without a two-dimensional mode.
    #[error("`inf` in `#domain` wants a two-dimensional mode\n\nhint: add `#domain_mode: TM` or `#domain_mode: TE`")]
    InfiniteWithoutMode,
    /// A source along the axis that a TE model's E lies across.
    #[error(
        "a source along {polarisation} in a TE model across {polarisation}: it must point along one of the other axes"
    )]
    AcrossTransverseElectric {
        /// Direction of the source.
        polarisation: &'static str,
    },
    /// A magnetic dipole across the axis that a TE model's H lies along.
    #[error("a magnetic dipole along {polarisation} in a TE model across {axis}: it must point along {axis}")]
    MagneticTransverseElectric {
        /// Direction of the source.
        polarisation: &'static str,
        /// The axis along which nothing changes.
        axis: &'static str,
    },
    /// A source off the one layer of nodes that holds the fields of a TE model.
    #[error(
        "a source at node {node} along {axis} of a TE model, whose fields are at node 1\n\n\
         hint: give {spacing} for its {axis} coordinate"
    )]
    BetweenWalls {
        /// The axis along which nothing changes.
        axis: &'static str,
        /// Node of the source.
        node: i64,
        /// Cell size along the axis, m.
        spacing: f64,
    },
    /// A file that includes itself, directly or through others.
    #[error("`{file}` includes itself")]
    IncludesItself {
        /// The file as it is written there.
        file: String,
    },
    /// More included files, or more text in them, than can be meant.
    #[error("{files} files are included, or more than 1 GiB of text: that is taken for a mistake")]
    TooMuchIncluded {
        /// Files so far.
        files: usize,
    },
    /// A file that a command names cannot be read.
    #[error("failed to {0}")]
    File(#[from] FileError),
    /// A file of pulses is wrong.
    #[error("`{}` line {line}: {what}", file.display())]
    Excitation {
        /// The file.
        file: PathBuf,
        /// Line number, from 1.
        line: usize,
        /// What is wrong.
        what: String,
    },
    /// The file of a `#geometry_objects_read` is wrong.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// A snapshot that cannot be taken.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
}
