//! Every failure, with the exit code that tells its kind.

use std::fmt;
use std::process::ExitCode;

/// What kind of failure it was; the number is the exit code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// The program ran, and the verdict is no.
    Verdict = 1,
    /// Something in the user's input.
    Input = 2,
    /// gprMax is missing or failed.
    GprMax = 3,
    /// A fault of this program.
    Fault = 70,
    /// Stopped by Ctrl-C.
    Interrupted = 130,
}

/// A failure to print, with its exit code.
#[derive(Debug)]
pub struct CliError {
    kind: Kind,
    message: String,
}

impl CliError {
    /// A failure of `kind` with a message; a hint goes behind a blank line.
    pub fn new(kind: Kind, message: impl Into<String>) -> Self {
        Self { kind, message: message.into() }
    }

    /// A failure in the user's input.
    pub fn input(message: impl Into<String>) -> Self {
        Self::new(Kind::Input, message)
    }

    /// What kind it is.
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// The exit code.
    pub fn exit_code(&self) -> ExitCode {
        ExitCode::from(self.kind as u8)
    }
}

impl fmt::Display for CliError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

/// Gives each error of the library its exit code.
macro_rules! exit_codes {
    ($($kind:ident: $($error:ty),+ $(,)?;)+) => {
        $($(impl From<$error> for CliError {
            fn from(error: $error) -> Self {
                Self::new(Kind::$kind, chain(&error))
            }
        })+)+
    };
}

exit_codes! {
    Input: crate::packing::PackingError, crate::raster::RasterError, crate::compare::CompareError,
        crate::compare::text::TextError, crate::model::CheckError, crate::model::PaintError, crate::units::UnitError;
    Input: crate::gprmax::GeometryWriteError, crate::model::SnapshotError, crate::trace::BScanError,
        crate::compare::process::ProcessError;
    Fault: serde_json::Error, crate::study::CaseError;
}

/// As [`exit_codes`], for errors that may wrap one of a file: that is then the user's file or disk, whoever met it.
macro_rules! exit_codes_but_of_files {
    ($($kind:ident: $($($part:ident)::+),+ $(,)?;)+) => {
        $($(impl From<$crate::$($part)::+> for CliError {
            fn from(error: $crate::$($part)::+) -> Self {
                match error {
                    $crate::$($part)::+::File(error) => error.into(),
                    error => Self::new(Kind::$kind, chain(&error)),
                }
            }
        })+)+
    };
}

exit_codes_but_of_files! {
    Input: scene::SceneError, gprmax::InFileError, gprmax::WriteError, gprmax::hdf5::Hdf5Error,
        measured::MeasuredError;
    GprMax: gprmax::InstallError;
    Fault: plot::PlotError, gprmax::OutputWriteError;
}

impl From<crate::files::FileError> for CliError {
    fn from(error: crate::files::FileError) -> Self {
        Self::input(format!("failed to {error}"))
    }
}

impl From<crate::gprmax::OutputError> for CliError {
    fn from(error: crate::gprmax::OutputError) -> Self {
        match error {
            crate::gprmax::OutputError::Hdf5(error) => error.into(),
            error => Self::input(chain(&error)),
        }
    }
}

impl From<crate::gprmax::RunError> for CliError {
    fn from(error: crate::gprmax::RunError) -> Self {
        use crate::gprmax::RunError;
        match error {
            RunError::File(error) => error.into(),
            RunError::Write(error) => error.into(),
            RunError::Stopped => crate::forward::ForwardError::Stopped.into(),
            error => Self::new(Kind::GprMax, chain(&error)),
        }
    }
}

impl From<crate::fdtd::FdtdError> for CliError {
    fn from(error: crate::fdtd::FdtdError) -> Self {
        if let crate::fdtd::FdtdError::Snapshot { .. } = error {
            return Self::input(error.to_string());
        }
        crate::forward::ForwardError::from(error).into()
    }
}

impl From<crate::forward::ForwardError> for CliError {
    fn from(error: crate::forward::ForwardError) -> Self {
        use crate::forward::ForwardError;
        let kind = match error {
            ForwardError::Model(_) => Kind::Input,
            ForwardError::Solver(_) => Kind::Verdict,
            ForwardError::Stopped => Kind::Interrupted,
        };
        Self::new(kind, chain(&error))
    }
}

impl From<crate::study::EchoError> for CliError {
    fn from(error: crate::study::EchoError) -> Self {
        use crate::study::EchoError;
        match error {
            EchoError::Forward(error) => error.into(),
            EchoError::Raster(error) => error.into(),
            EchoError::Compare(error) => error.into(),
            EchoError::NoTrace | EchoError::NotPicked { .. } => Self::new(Kind::Verdict, error.to_string()),
        }
    }
}

impl From<crate::study::PulseError> for CliError {
    fn from(error: crate::study::PulseError) -> Self {
        use crate::study::PulseError;
        match error {
            PulseError::Scene(error) => error.into(),
            PulseError::Echo(error) => error.into(),
            PulseError::Compare(error) => error.into(),
        }
    }
}

impl From<crate::study::BiasError> for CliError {
    fn from(error: crate::study::BiasError) -> Self {
        use crate::study::BiasError;
        match error {
            BiasError::Scene(error) => error.into(),
            BiasError::Echo(error) => error.into(),
            BiasError::Mix(_) => Self::input(error.to_string()),
        }
    }
}

impl From<crate::study::DimensionError> for CliError {
    fn from(error: crate::study::DimensionError) -> Self {
        use crate::study::DimensionError;
        match error {
            DimensionError::Scene(error) => error.into(),
            DimensionError::Echo(error) => error.into(),
            DimensionError::NoSections => Self::input(error.to_string()),
        }
    }
}

impl From<crate::study::CostError> for CliError {
    fn from(error: crate::study::CostError) -> Self {
        use crate::study::CostError;
        match error {
            CostError::Scene(error) => error.into(),
            CostError::Echo(error) => error.into(),
            CostError::TooFewCells { .. } => Self::input(error.to_string()),
        }
    }
}

impl From<crate::study::experiments::ExperimentError> for CliError {
    fn from(error: crate::study::experiments::ExperimentError) -> Self {
        use crate::packing::dem::DemError;
        use crate::study::experiments::ExperimentError;
        let kind = match &error {
            ExperimentError::Stopped { .. } | ExperimentError::Dem(DemError::Stopped { .. }) => Kind::Interrupted,
            ExperimentError::NeverEnds { .. }
            | ExperimentError::Dem(
                DemError::TooFast { .. } | DemError::TooDeep { .. } | DemError::EnergyGrows { .. },
            ) => Kind::Verdict,
            _ => Kind::Input,
        };
        Self::new(kind, error.to_string())
    }
}

/// The message of an error, followed by those of its causes that it does not repeat.
pub fn chain(error: &dyn std::error::Error) -> String {
    let mut message = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        let text = error.to_string();
        if !message.contains(&text) {
            message.push_str(": ");
            message.push_str(&text);
        }
        cause = error.source();
    }
    message
}
