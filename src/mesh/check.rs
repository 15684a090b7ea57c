//! Diagnosis of triangle lists.

/// Every defect of a triangle list.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Diagnosis {}

impl std::fmt::Display for Diagnosis {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("defects")
    }
}
