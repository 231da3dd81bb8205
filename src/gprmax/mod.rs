//! gprMax: its input files, its HDF5 files, and running it.
