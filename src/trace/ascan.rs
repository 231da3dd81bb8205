//! One trace, and the set of traces that one run of a solver returns.

use crate::units::{Metres, Seconds};

/// What a trace holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Component {
    /// Electric field along x, V/m.
    Ex,
    /// Electric field along y, V/m.
    Ey,
    /// Electric field along z, V/m.
    Ez,
    /// Magnetic field along x, A/m.
    Hx,
    /// Magnetic field along y, A/m.
    Hy,
    /// Magnetic field along z, A/m.
    Hz,
    /// What an instrument recorded, in its own counts or in normalised amplitude.
    Recorded,
}

impl Component {
    /// The six field components in the order gprMax writes them.
    pub const FIELDS: [Self; 6] = [Self::Ex, Self::Ey, Self::Ez, Self::Hx, Self::Hy, Self::Hz];

    /// The name used in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ex => "Ex",
            Self::Ey => "Ey",
            Self::Ez => "Ez",
            Self::Hx => "Hx",
            Self::Hy => "Hy",
            Self::Hz => "Hz",
            Self::Recorded => "recorded",
        }
    }

    /// Whether this is one of the three magnetic components.
    pub const fn is_magnetic(self) -> bool {
        matches!(self, Self::Hx | Self::Hy | Self::Hz)
    }
}

/// One radar trace, simulated or measured.
#[derive(Debug, Clone, PartialEq)]
pub struct AScan {
    /// Amplitudes, one per time step.
    pub samples: Vec<f64>,
    /// Time between samples.
    pub time_step: Seconds,
    /// Time of `samples[0]`. Zero for gprMax's E fields, minus half a step for its H fields.
    pub first_sample: Seconds,
    /// What the samples are.
    pub component: Component,
    /// Where the receiver was, in the coordinates of the model or the survey, if known.
    pub position: Option<[Metres; 3]>,
    /// A name to show in legends and messages: usually the file and the receiver.
    pub name: String,
}

impl AScan {
    /// Time of sample `index`, s.
    pub fn time(&self, index: usize) -> f64 {
        self.first_sample.si() + index as f64 * self.time_step.si()
    }

    /// Time of every sample, s.
    pub fn times(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.samples.len()).map(|index| self.time(index))
    }

    /// Largest absolute amplitude; zero for an empty trace.
    pub fn peak(&self) -> f64 {
        self.samples.iter().fold(0.0, |peak, v| v.abs().max(peak))
    }
}

/// The traces of one receiver.
#[derive(Debug, Clone, PartialEq)]
pub struct ReceiverTraces {
    /// Name of the receiver.
    pub name: String,
    /// Position of the receiver, m.
    pub position: [Metres; 3],
    /// One trace per component.
    pub components: Vec<AScan>,
}

impl ReceiverTraces {
    /// The trace of one component, if it was recorded.
    pub fn component(&self, component: Component) -> Option<&AScan> {
        self.components.iter().find(|trace| trace.component == component)
    }
}

/// What one run of a solver (or one output file) holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Traces {
    /// Title of the model.
    pub title: String,
    /// Who made them, for example `ballast-gpr 0.1.0 fdtd, single precision` or `gprMax 4.0.1`.
    pub solver: String,
    /// Time step of the run.
    pub time_step: Seconds,
    /// Number of samples in each trace.
    pub iterations: usize,
    /// Cell counts of the model along x, y, z.
    pub cells: [usize; 3],
    /// Cell sizes of the model along x, y, z.
    pub spacing: [Metres; 3],
    /// Whether the samples were computed in double precision (and are to be written so).
    pub double_precision: bool,
    /// One entry per receiver, in the order of the model.
    pub receivers: Vec<ReceiverTraces>,
}

impl Traces {
    /// The trace that a ground-penetrating radar would show: `Ez` of the first receiver, else its strongest E component.
    pub fn radar_trace(&self) -> Option<&AScan> {
        let receiver = self.receivers.first()?;
        let electric = || receiver.components.iter().filter(|trace| !trace.component.is_magnetic());
        receiver
            .component(Component::Ez)
            .filter(|trace| trace.peak() > 0.0)
            .or_else(|| electric().max_by(|a, b| a.peak().total_cmp(&b.peak())))
    }
}
