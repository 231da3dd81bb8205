//! Files of radar instruments, read and written.
//!
//! [`read()`] takes any of these by its ending, in upper or lower case; of a pair, either file may be named.
//!
//! | format | files | samples | read | written |
//! |---|---|---|---|---|
//! | GSSI | `.dzt` | 8, 16 bits unsigned, 32 bits; several channels | yes | – |
//! | Sensors & Software pulseEKKO | `.dt1` and `.hd` | 16 bits | yes | yes |
//! | MALÅ | `.rd3` or `.rd7`, and `.rad` | 16, 32 bits | yes | `.rd3` |
//! | SEG-Y, of either byte order | `.sgy`, `.segy` | 16, 32 bits, IEEE and IBM floats | yes | IEEE floats |
//! | ImpulseRadar | `.iprb` and `.iprh` | 16, 32 bits | experimental | – |
//! | IDS | `.dt` | 16 bits | experimental | – |
//! | CSV, NumPy | `.csv`, `.npz` | decimal, 64 bits | (`compare::text`) | yes |
//!
//! *Experimental* readers were made from a description of the format, without a real file to check them against.
//!
//! Nothing is allocated because a header asks for it: every count is first held against the size of the file. What a header
//! contradicts is a [`Warning`] with both values; what cannot be right is a [`MeasuredError`] with the name of the field, its
//! value and its place in the file.

mod block;
mod cursor;
mod dt1;
mod dzt;
mod error;
mod ids;
mod iprb;
mod mala;
mod npz;
mod read;
mod recording;
mod segy;
mod segy_text;
mod text_header;
mod write;

pub use error::MeasuredError;
pub use read::read;
pub use recording::{Format, Recording, SampleKind, Warning};
pub use write::{About, Written, write_csv, write_dt1, write_npz, write_rd3, write_segy};
