//! The embedded finite-difference time-domain solver.
