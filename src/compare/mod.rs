//! Comparing traces: time zero, resampling, normalisation, picks and misfits.
