//! From a sieve curve to a ground-penetrating-radar trace of railway ballast.
//!
//! # The way of the data
//!
//! ```text
//!     SceneSpec ──► Packing ──► Scene ──► Model ──► Traces ──► Comparison ──► figure, table
//!     (TOML, flags)  (seeded)             ▲   │
//!                                   .in file  └─► .in file + geometry (gprMax)
//! ```
//!
//! Each arrow is a plain function: [`scene::resolve`], [`raster::build_model`], [`forward::Forward::solve`],
//! [`compare::compare`]. A [`model::Model`] is what an electromagnetic solver needs and nothing else: an ordered list of
//! objects on a grid, as in a gprMax input file. It comes from a scene or from anybody's `.in` file, and **both solvers take
//! it**; the built-in one can therefore run files that were never made by this program, and "our solver agrees with gprMax"
//! compares two things.
//!
//! A quantity carries its unit at every public border ([`units`]); inside all is SI. A seed is an argument, and the same
//! seed gives the same bytes on any number of threads. What a model does not call for is absent from the computation, not
//! zero: [`model::Effects`] reads off a model which effects are on and why.
//!
//! # Modules
//!
//! | module | what | may import |
//! |---|---|---|
//! | [`units`] | quantities as users write them, physical constants | – |
//! | [`files`] | write-then-rename, nearest names | – |
//! | [`trace`] | A-scans, B-scans and sets of traces | units |
//! | [`geometry`] | discs, their neighbours, areas | units |
//! | [`material`] | dielectrics, mixing rules, named materials, fouling indices | units, files |
//! | [`model`] | what a solver needs; painting objects into cells; effects | units, geometry, material |
//! | [`packing`] | grading in, particles out | units, geometry, files |
//! | [`scene`] | layers, packing, materials, antenna: checked once | units, files, geometry, material, model, packing |
//! | [`raster`] | from a scene to a model | units, geometry, material, scene, model |
//! | [`forward`] | the trait of all solvers | units, trace, model |
//! | [`gprmax`] | its input files, its HDF5 files, running it | units, trace, material, model, geometry, forward, files |
//! | [`fdtd`] | the built-in solver | units, trace, material, model, forward, files |
//! | [`measured`] | files of radar instruments, read and written | units, files, trace |
//! | [`compare`] | time zero, resampling, picks, misfits | units, trace |
//! | [`study`] | published cases, ensembles, accuracy against cost, experiments with spheres | units, files, trace, geometry, material, model, packing, scene, raster, forward, compare |
//! | [`plot`] | figures from plain data | units, files |
//!
//! [`cli`] may import all of them, and is the only place that prints, reads flags or exits. `tests/layering.rs` holds the
//! same table and fails when an import breaks it. Two rows differ from the first sketch of the design, for a reason each:
//! `scene` imports `model` for the names of waveforms, so that a scene file and a gprMax file say them with one set of words;
//! and `model` holds objects rather than finished cells, so that a gprMax input is written as it was read and both kinds of
//! geometry (`#cylinder` lines, blocks of cells) come from one value.
//!
//! # Two dimensions
//!
//! In a 2-D section with the electric field along the stones (TMz), a bed of circles delays a wave like the *arithmetic
//! mean* of the permittivities or more, not like a three-dimensional mixture (CRIM): with stone 6.5 in air the bulk reads
//! about 4.2 where the mixture has 3.6, and the echo of the base comes later by as much as 20 cm of fouling would make it. Two
//! models answer two questions. With the true stone permittivity the trace is that of the section; with
//! `stone_permittivity = "equivalent-2d"` the echoes come when those of the three-dimensional bed would. `explain` and the
//! manifest show both bulk values ([`scene::BulkPermittivity`]).
#![warn(missing_docs)]

pub mod cli;
pub mod compare;
pub mod fdtd;
pub mod files;
pub mod forward;
pub mod geometry;
pub mod gprmax;
pub mod material;
pub mod measured;
pub mod model;
pub mod packing;
pub mod plot;
pub mod raster;
pub mod scene;
pub mod study;
pub mod trace;
pub mod units;
