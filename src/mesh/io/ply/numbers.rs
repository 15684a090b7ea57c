//! The properties of vertices and faces that are no attribute of this library's: one number each becomes a column with its name.

use super::super::number_column::NumberColumn;
use super::super::scan::Quoted;
use super::body::PlyRow;
use super::header::PlyElement;

/// The columns of an element while its rows are read.
#[derive(Default)]
pub(super) struct OwnColumns {
    /// The property of each column.
    properties: Vec<usize>,
    pub columns: Vec<NumberColumn>,
}

impl OwnColumns {
    /// The properties with one number per row, without those that are `read` otherwise. Lists that are not read are added to `unread`, and
    /// so are properties whose names are no words.
    pub fn new(element: &PlyElement<'_>, read: &[usize], unread: &mut Vec<String>) -> OwnColumns {
        let mut own = OwnColumns::default();
        for (k, property) in element.properties.iter().enumerate().filter(|(k, _)| !read.contains(k)) {
            match std::str::from_utf8(property.name) {
                Ok(name) if property.count.is_none() && !name.contains(|c: char| c.is_control()) => {
                    own.properties.push(k);
                    own.columns.push(NumberColumn {
                        name: name.into(),
                        kind: property.kind,
                        values: Vec::new(),
                    });
                }
                _ if element.count == 0 => {}
                _ => {
                    let [name, of] = [property.name, element.name].map(String::from_utf8_lossy);
                    let what = if property.count.is_some() { "list" } else { "property" };
                    unread.push(format!("{what} {} of element {}", Quoted(&name), Quoted(&of)));
                }
            }
        }
        own
    }

    /// Takes the numbers of a row.
    pub fn push(&mut self, row: &PlyRow) {
        for (column, &k) in self.columns.iter_mut().zip(&self.properties) {
            column.values.push(row.numbers[k]);
        }
    }
}
