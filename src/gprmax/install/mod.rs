//! Finding gprMax, or installing it into an environment of its own.
//!
//! gprMax is a Python program. [`install`] makes a virtual environment in the user's cache folder, puts a fixed version of
//! gprMax into it and checks that it starts; [`find`] gives the environment to use. Nothing outside that folder is touched.

mod environment;
mod error;
mod python;

pub use environment::{check, find, install};
pub use error::InstallError;
pub use python::{Interpreter, VersionInfo, cache_folder};

/// The version of gprMax that is installed and whose behaviour the tests hold fast.
pub const GPRMAX_VERSION: &str = "4.0.1";

/// The version of h5py that is installed beside it.
pub const H5PY_VERSION: &str = "3.16.0";

/// Names a Python whose gprMax is to be used instead of the private one.
pub const PYTHON_WITH_GPRMAX: &str = "BALLAST_GPR_GPRMAX_PYTHON";

/// Names a Python to make the private environment from.
pub const PYTHON_TO_INSTALL_WITH: &str = "BALLAST_GPR_PYTHON";

/// Names the cache folder.
pub const CACHE_FOLDER: &str = "BALLAST_GPR_CACHE";
