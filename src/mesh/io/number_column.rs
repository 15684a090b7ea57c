//! Further numbers of vertices and faces, under the names that a PLY file gives them.

use super::kind::NumberType;
use crate::archive::stored;
use crate::error::{Error, Result, check_size};

/// A number of every vertex, or of every face, with its name.
#[derive(Debug, Clone, PartialEq)]
pub struct NumberColumn {
    /// The name, without blanks.
    pub name: String,
    /// The type of the numbers in the file.
    pub kind: NumberType,
    /// The numbers, which may be NaN.
    pub values: Vec<f64>,
}
stored!(sections NumberColumn { name, kind, values });

impl NumberColumn {
    /// The numbers of other elements, each that of the element it comes from. An element from none has NaN, where the type has it, or 0.
    pub fn of_origins(&self, origins: &[u32]) -> NumberColumn {
        let none = if self.kind.is_integer() { 0.0 } else { f64::NAN };
        let values = origins.iter().map(|&k| self.values.get(k as usize).copied().unwrap_or(none)).collect();
        NumberColumn { name: self.name.clone(), kind: self.kind, values }
    }

    /// Checks that each of `n` elements has a number, and that the name is one word.
    pub(super) fn check(&self, n: usize) -> Result<()> {
        check_size("numbers", self.values.len(), n)?;
        if self.name.is_empty() || self.name.contains(|c: char| c.is_whitespace() || c.is_control()) {
            return Err(Error::argument("numbers", format!("{:?}", self.name), "a name without blanks"));
        }
        Ok(())
    }
}

/// Columns of vertices or faces as a phrase; none where there are none.
pub(super) fn told(columns: &[NumberColumn], element: &str) -> Option<String> {
    /// Names that are listed one by one.
    const LISTED: usize = 8;
    let names: Vec<String> = columns.iter().take(LISTED).map(|column| format!("`{}`", column.name)).collect();
    let more = columns.len().saturating_sub(LISTED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    (!columns.is_empty()).then(|| format!("numbers of {element} {}{more}", names.join(", ")))
}
