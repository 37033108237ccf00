//! Bindings to Embree.
