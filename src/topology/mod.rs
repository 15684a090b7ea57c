//! Spanning trees, homology generators, cut graphs.
