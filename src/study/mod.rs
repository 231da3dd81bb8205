//! Ensembles, and accuracy against cost.
