//! Metrics in a conformal class.
