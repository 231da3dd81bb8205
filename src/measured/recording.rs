//! What a file of an instrument holds, once read.

use std::fmt;
use std::path::Path;

use crate::trace::BScan;
use crate::units::{Hertz, Metres};

/// A kind of instrument file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Format {
    /// GSSI, one file.
    Dzt,
    /// Sensors & Software pulseEKKO: samples in DT1, header in HD.
    Dt1,
    /// MALÅ: samples of 16 bits in RD3, header in RAD.
    Rd3,
    /// MALÅ: samples of 32 bits in RD7, header in RAD.
    Rd7,
    /// SEG-Y, one file, of either byte order.
    SegY,
    /// ImpulseRadar: samples in IPRB, header in IPRH. Experimental: no real file was at hand.
    Iprb,
    /// IDS, one file. Experimental: no real file was at hand.
    Ids,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 7] = [Self::Dzt, Self::Dt1, Self::Rd3, Self::Rd7, Self::SegY, Self::Iprb, Self::Ids];

    /// Name of the instrument's maker and of the format.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Dzt => "GSSI DZT",
            Self::Dt1 => "Sensors & Software DT1/HD",
            Self::Rd3 => "MALÅ RD3/RAD",
            Self::Rd7 => "MALÅ RD7/RAD",
            Self::SegY => "SEG-Y",
            Self::Iprb => "ImpulseRadar IPRB/IPRH (experimental)",
            Self::Ids => "IDS dt (experimental)",
        }
    }

    /// Whether the reader was made from a description alone, without a real file to check it against.
    pub const fn is_experimental(self) -> bool {
        matches!(self, Self::Iprb | Self::Ids)
    }

    /// Endings of the file with the samples, in lower case.
    pub const fn endings(self) -> &'static [&'static str] {
        match self {
            Self::Dzt => &["dzt"],
            Self::Dt1 => &["dt1"],
            Self::Rd3 => &["rd3"],
            Self::Rd7 => &["rd7"],
            Self::SegY => &["sgy", "segy", "seg"],
            Self::Iprb => &["iprb"],
            Self::Ids => &["dt"],
        }
    }

    /// Ending of the file with the header, for formats of two files.
    pub const fn header_ending(self) -> Option<&'static str> {
        match self {
            Self::Dt1 => Some("hd"),
            Self::Rd3 | Self::Rd7 => Some("rad"),
            Self::Iprb => Some("iprh"),
            Self::Dzt | Self::SegY | Self::Ids => None,
        }
    }

    /// The formats that a file of this name may belong to, by its ending in either case; the header of a pair counts.
    pub fn of(path: &Path) -> Vec<Self> {
        let Some(ending) = path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase()) else {
            return vec![];
        };
        let fits = |format: &Self| format.endings().contains(&&*ending) || format.header_ending() == Some(&*ending);
        Self::ALL.into_iter().filter(fits).collect()
    }
}

/// How one sample is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SampleKind {
    /// 8 bits around 128.
    Unsigned8,
    /// 16 bits around 32768.
    Unsigned16,
    /// 16 bits with a sign.
    Signed16,
    /// 32 bits with a sign.
    Signed32,
    /// IEEE 754, 32 bits.
    Float32,
    /// IBM System/360, 32 bits: a sign, an exponent of 16, 24 bits of fraction.
    Ibm32,
}

impl SampleKind {
    /// Bytes of one.
    pub const fn bytes(self) -> usize {
        match self {
            Self::Unsigned8 => 1,
            Self::Unsigned16 | Self::Signed16 => 2,
            Self::Signed32 | Self::Float32 | Self::Ibm32 => 4,
        }
    }

    /// In words.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unsigned8 => "8 bits, unsigned",
            Self::Unsigned16 => "16 bits, unsigned",
            Self::Signed16 => "16 bits",
            Self::Signed32 => "32 bits",
            Self::Float32 => "32 bits, IEEE float",
            Self::Ibm32 => "32 bits, IBM float",
        }
    }
}

/// Something that a header contradicts, and what was done about it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    /// Name of the field.
    pub field: String,
    /// Where it stands, from zero.
    pub offset: u64,
    /// What the header says.
    pub header: String,
    /// What contradicts it.
    pub found: String,
    /// Which was taken.
    pub taken: &'static str,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { field, offset, header, found, taken } = self;
        write!(f, "`{field}` at byte {offset} is {header}, but {found}: {taken}")
    }
}

/// What a file of an instrument holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// Which kind of file.
    pub format: Format,
    /// How its samples are stored.
    pub sample_kind: SampleKind,
    /// One radargram for each channel, amplitudes in counts (or as they are, where the file holds floats).
    pub channels: Vec<BScan>,
    /// Name of the antenna, as the file has it.
    pub antenna: Option<String>,
    /// Nominal centre frequency, where the file or the name of the antenna tells it.
    pub centre_frequency: Option<Hertz>,
    /// Distance of transmitter and receiver.
    pub antenna_separation: Option<Metres>,
    /// The other fields of the header, as they stand in the file.
    pub header: Vec<(String, String)>,
    /// What the header contradicts.
    pub warnings: Vec<Warning>,
}
