//! What an electromagnetic solver needs, and nothing else.
//!
//! A [`Model`] is an ordered list of objects on a grid, with materials, sources, receivers, a time window and absorbing
//! boundaries: the content of a gprMax input file. It is built from a scene by `raster` or from anybody's `.in` file by
//! `gprmax`, and both solvers take it. [`paint`] turns the objects into cells and edges by gprMax's rules.

mod absorbing;
mod averaging;
mod check;
mod effects;
mod fractal;
mod geometry_file;
mod grid;
mod indices;
mod material;
mod object;
mod order;
mod paint;
mod painted;
mod painted3;
mod palette;
mod pulse_table;
mod route;
mod sampled;
mod snapshot;
mod source;
mod spec;
mod view;
mod volume;
mod waveform;

pub use absorbing::{AbsorbingProfile, Formulation, Grading, Stretch};
pub use averaging::Averaging;
pub use check::{
    CheckError, LEAST_CELLS_PER_WAVELENGTH, Resolution, WANTED_CELLS_PER_WAVELENGTH, available_memory,
    check_absorbing_cells, check_memory, check_mode, check_recording, check_stability_factor, mebibytes,
};
pub use effects::{Effect, Effects};
pub use fractal::{FractalBox, FractalSurface};
pub use geometry_file::GeometryFile;
pub use grid::{Grid, ceil_half_down};
pub use indices::Indices;
pub use material::{DebyePole, Material, MaterialId, Resonance};
pub use object::{BlockEdges, Object, Voxels};
pub use order::{NoSuchOrder, Order};
pub use paint::{
    Finished, PaintError, Parts, check_grid, check_two_dimensional, edge_flag, face_flag, paint, paint_finished, paint3,
};
pub use painted::Painted;
pub use painted3::{Coupling, Painted3};
pub use palette::{EdgeMaterial, FaceMaterial, MagneticAveraging};
pub use pulse_table::{PulseTable, PulseTableError};
pub use route::{MOST_POLES_IN_A_PLANE, Route};
pub use sampled::{Between, Beyond, Sampled};
pub use snapshot::{Snapshot, SnapshotCells, SnapshotError, SnapshotFormat, SnapshotTime};
pub use source::{Axis, Excitation, HertzianDipole, MagneticDipole, Receiver, Source, VoltageSource};
pub use spec::{COUPLED_STABLE_SHARE, Model, TimeWindow};
pub use view::{GeometryView, ViewKind};
pub use waveform::{Waveform, WaveformKind};
