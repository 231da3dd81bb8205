//! Dielectric models and named materials.
