//! Left and right: names of files and of anatomy, and the way to the other side.

use serde::Serialize;
use std::path::Path;

/// A hemisphere.
#[derive(clap::ValueEnum, Serialize, Debug, Clone, Copy, PartialEq)]
#[serde(rename_all = "lowercase")]
pub enum HemisphereSide {
    Left,
    Right,
}

impl HemisphereSide {
    /// The hemisphere that a file's name says.
    pub fn of_name(path: &Path) -> Option<HemisphereSide> {
        let name = path.file_name()?.to_string_lossy().to_ascii_lowercase();
        let says = |words: [&str; 3], begin: &str| {
            name.starts_with(begin) || words.iter().any(|word| name.contains(word))
        };
        match (says(["left", "hemi-l", ".l."], "lh."), says(["right", "hemi-r", ".r."], "rh.")) {
            (true, false) => Some(HemisphereSide::Left),
            (false, true) => Some(HemisphereSide::Right),
            _ => None,
        }
    }

    /// The beginning of the names of its files.
    pub fn short(self) -> &'static str {
        match self {
            HemisphereSide::Left => "lh",
            HemisphereSide::Right => "rh",
        }
    }

    /// The name in the metadata of GIFTI.
    pub fn anatomy(self) -> &'static str {
        match self {
            HemisphereSide::Left => "CortexLeft",
            HemisphereSide::Right => "CortexRight",
        }
    }

    /// The direction towards the other hemisphere, x growing from left to right.
    pub fn medial(self) -> [f64; 3] {
        match self {
            HemisphereSide::Left => [1.0, 0.0, 0.0],
            HemisphereSide::Right => [-1.0, 0.0, 0.0],
        }
    }
}
