//! Grading in, particles out.
