//! Quantities with their units, as users write them and as the program holds them (SI).
//!
//! Users write `"20cm"`, `"1 GHz"`, `"42%"`; a bare number is refused. The digits are scaled in decimal, so `"48cm"`
//! and `"0.48m"` are the same bits.

pub mod constants;
mod parse;
mod quantity;

pub use parse::UnitError;
pub use quantity::{
    Hertz, Kilograms, KilogramsPerCubicMetre, Metres, MetresPerSecond, Pascals, Seconds, Share, SiemensPerMetre,
};
