//! Layouts of flat metrics and their quality.
