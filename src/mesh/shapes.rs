//! Sample surfaces of every topology.
