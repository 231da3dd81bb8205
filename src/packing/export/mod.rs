//! Packings as files: the text file and the CAD script of the paper (section 4.3), DXF, CSV and JSON.
//!
//! Every function gives back the text or the bytes; [`crate::files`] writes them. CSV and JSON are read back, to the same
//! bits, and checked: a reader never lets an overlap pass in silence.

mod cad;
mod report;
mod table;

pub use cad::{autocad_script, dxf};
pub use report::text_report;
pub use table::{OVERLAP_TOLERANCE, csv, from_csv, from_json, json};
