//! What a solver must endure: hundreds of thousands of steps, hard cases in every mode, random scenes, grazing waves.

mod absorbing;
mod hard;
mod long;
mod mode;
mod random;
