//! Sources and receivers.

/// A coordinate axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// x
    X,
    /// y
    Y,
    /// z
    Z,
}

impl Axis {
    /// 0, 1 or 2.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// `x`, `y` or `z`.
    pub const fn name(self) -> &'static str {
        ["x", "y", "z"][self as usize]
    }
}

/// When a source is on. The waveform begins at the start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Excitation {
    /// First time at which the source is on, s.
    pub start: f64,
    /// Last time at which the source is on, s; `None`: to the end of the time window.
    pub stop: Option<f64>,
}

impl Excitation {
    /// Whether the source is on at a time, s.
    pub fn is_on(&self, time: f64) -> bool {
        time >= self.start && self.stop.is_none_or(|stop| time <= stop)
    }
}

/// An infinitesimal electric dipole: `#hertzian_dipole`. In two dimensions a line of current.
#[derive(Debug, Clone, PartialEq)]
pub struct HertzianDipole {
    /// Direction of the current.
    pub polarisation: Axis,
    /// Position as the user wrote it, m.
    pub position: [f64; 3],
    /// Index into [`Model::waveforms`](super::Model::waveforms).
    pub waveform: usize,
    /// When it is on.
    pub excitation: Excitation,
}

/// An infinitesimal magnetic dipole: `#magnetic_dipole`. In two dimensions it lies in the plane (TM) or across it (TE).
#[derive(Debug, Clone, PartialEq)]
pub struct MagneticDipole {
    /// Direction of the magnetic current.
    pub polarisation: Axis,
    /// Position as the user wrote it, m.
    pub position: [f64; 3],
    /// Index into [`Model::waveforms`](super::Model::waveforms): the magnetic current times its length, V m.
    pub waveform: usize,
    /// When it is on.
    pub excitation: Excitation,
}

/// A voltage across one edge of a cell: `#voltage_source`.
#[derive(Debug, Clone, PartialEq)]
pub struct VoltageSource {
    /// Direction of the edge.
    pub polarisation: Axis,
    /// Position as the user wrote it, m.
    pub position: [f64; 3],
    /// Internal resistance, ohm, which stays across the edge whether or not the source is on. With none, the voltage along
    /// the edge is what the waveform says while the source is on, whatever the fields around it.
    pub resistance: f64,
    /// Index into [`Model::waveforms`](super::Model::waveforms).
    pub waveform: usize,
    /// When it is on.
    pub excitation: Excitation,
}

/// A source.
#[derive(Debug, Clone, PartialEq)]
pub enum Source {
    /// See [`HertzianDipole`].
    HertzianDipole(HertzianDipole),
    /// See [`MagneticDipole`].
    MagneticDipole(MagneticDipole),
    /// See [`VoltageSource`].
    VoltageSource(VoltageSource),
}

impl Source {
    /// What it is, in words.
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::HertzianDipole(_) => "hertzian dipole",
            Self::MagneticDipole(_) => "magnetic dipole",
            Self::VoltageSource(_) => "voltage source",
        }
    }

    /// Its direction.
    pub const fn polarisation(&self) -> Axis {
        match self {
            Self::HertzianDipole(HertzianDipole { polarisation, .. })
            | Self::MagneticDipole(MagneticDipole { polarisation, .. })
            | Self::VoltageSource(VoltageSource { polarisation, .. }) => *polarisation,
        }
    }

    /// The direction, to turn it.
    pub const fn polarisation_mut(&mut self) -> &mut Axis {
        match self {
            Self::HertzianDipole(HertzianDipole { polarisation, .. })
            | Self::MagneticDipole(MagneticDipole { polarisation, .. })
            | Self::VoltageSource(VoltageSource { polarisation, .. }) => polarisation,
        }
    }

    /// Position as the user wrote it, m.
    pub const fn position(&self) -> [f64; 3] {
        match self {
            Self::HertzianDipole(HertzianDipole { position, .. })
            | Self::MagneticDipole(MagneticDipole { position, .. })
            | Self::VoltageSource(VoltageSource { position, .. }) => *position,
        }
    }

    /// The position, to move it.
    pub const fn position_mut(&mut self) -> &mut [f64; 3] {
        match self {
            Self::HertzianDipole(HertzianDipole { position, .. })
            | Self::MagneticDipole(MagneticDipole { position, .. })
            | Self::VoltageSource(VoltageSource { position, .. }) => position,
        }
    }

    /// Index into [`Model::waveforms`](super::Model::waveforms).
    pub const fn waveform(&self) -> usize {
        match self {
            Self::HertzianDipole(HertzianDipole { waveform, .. })
            | Self::MagneticDipole(MagneticDipole { waveform, .. })
            | Self::VoltageSource(VoltageSource { waveform, .. }) => *waveform,
        }
    }

    /// When it is on.
    pub const fn excitation(&self) -> Excitation {
        match self {
            Self::HertzianDipole(HertzianDipole { excitation, .. })
            | Self::MagneticDipole(MagneticDipole { excitation, .. })
            | Self::VoltageSource(VoltageSource { excitation, .. }) => *excitation,
        }
    }
}

/// A receiver: `#rx`.
#[derive(Debug, Clone, PartialEq)]
pub struct Receiver {
    /// Position as the user wrote it, m.
    pub position: [f64; 3],
    /// Name; gprMax writes `Rx(i,j,k)` with the node indices where the user gives none.
    pub name: Option<String>,
}
