//! Newton and gradient flow to a prescribed curvature.
