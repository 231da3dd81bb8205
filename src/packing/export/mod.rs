//! Packings as files: the text file and the CAD script of the paper (section 4.3), DXF, CSV and JSON; beds of spheres as
//! CSV, JSON and VTK.
//!
//! Every function gives back the text or the bytes; [`crate::files`] writes them. CSV and JSON are read back, to the same
//! bits, and checked: a reader never lets an overlap pass in silence. Both kinds of packing share one format version, and
//! [`particles_from_json`] reads either.

mod cad;
mod report;
mod spheres;
mod table;
mod vtk;

pub use cad::{autocad_script, dxf};
pub use report::text_report;
pub use spheres::{Particles, is_csv_of_spheres, particles_from_json, spheres_csv, spheres_from_csv, spheres_json};
pub use table::{OVERLAP_TOLERANCE, csv, from_csv, from_json, json};
pub use vtk::{contacts_vtp, stones_vtp};
