//! From a scene to a model.
