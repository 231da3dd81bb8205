//! Dielectric models and named materials: what the ground is made of, as a radar sees it.
//!
//! Complex permittivity is written `eps' - i eps''` with `eps'' >= 0`, for fields that go as `exp(+i omega t)`. A Debye
//! pole is then `delta / (1 + i omega tau)` and conduction is `sigma / (i omega eps_0)`.
//!
//! - [`Dielectric`]: permittivity, conductivity and Debye poles; [`named`] finds one by name with its source.
//! - [`mix`]: CRIM, Looyenga, Lichtenecker, Maxwell Garnett and Bruggeman over any number of components; [`topp_permittivity`]
//!   and [`Peplinski`] for soils.
//! - [`debye_fit`], [`effective_debye`]: one pole and a conductivity that a time-domain solver can take.
//! - [`equivalent_2d`]: the stone that makes a two-dimensional bed as slow as the real one.
//! - [`BottomFilledBed`], [`FoulingIndices`]: how much fouling, in every unit that the field uses.

mod dielectric;
mod effective_debye;
mod equivalent_2d;
mod fouling;
mod fouling_amount;
mod mixing;
mod named;
mod soil;

pub use dielectric::{DebyePole, Dielectric, DielectricError, WATER, water};
pub use effective_debye::{FitError, FittedDielectric, debye_fit, effective_debye};
pub use equivalent_2d::{Equivalent2d, Equivalent2dError, JudgedBy, equivalent_2d};
pub use fouling::{Bed, Compaction, FinesPassing, FoulingIndices, RelativeFoulingClass, SeligClass, selig_from_height};
pub use fouling_amount::{BottomFilledBed, Described, Fouling, FoulingAmount, FoulingError};
pub use mixing::{MixError, MixingModel, mix, mix_dielectrics};
pub use named::{Confidence, NamedMaterial, UnknownMaterial, all_named, named};
pub use soil::{Mixture, Peplinski, SoilError, WATER_25_C, topp_permittivity, topp_water_content};

/// A complex number of double precision, as permittivities are.
pub type Complex = nalgebra::Complex<f64>;
