//! Layers, packing, materials and antenna, checked once.
