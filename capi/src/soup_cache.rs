//! Lists of a triangle list that are made when they are asked for.

use crate::choice::choices;
use ricci::mesh::holes::Filling;
use ricci::mesh::io::{FaceLabel, NumberColumn, Soup};
use ricci::mesh::rims::{Rim, rims};
use std::collections::HashMap;
use std::ffi::{CStr, CString};
use std::sync::OnceLock;

choices!(pub(crate) enum LabelKind, LABELS = "which", [
    RICCI_LABEL_OBJECT => Object,
    RICCI_LABEL_GROUP => Group,
    RICCI_LABEL_MATERIAL => Material,
    RICCI_LABEL_SMOOTHING => Smoothing,
    RICCI_LABEL_VERTEX_NUMBERS => VertexNumbers,
    RICCI_LABEL_FACE_NUMBERS => FaceNumbers,
]);

/// The lists of a triangle list that are made when they are asked for.
#[derive(Default)]
pub(crate) struct SoupLists {
    rims: OnceLock<Vec<Rim>>,
    names: OnceLock<[LabelNames; 6]>,
    reasons: OnceLock<Vec<CString>>,
}

/// The different names of one kind, and for each face the number of its name.
pub(crate) struct LabelNames {
    pub names: Vec<String>,
    /// Empty for names of numbers.
    pub of_face: Vec<u32>,
}

impl LabelNames {
    /// The names in the order of the first faces that have them; the empty name of faces without one comes first.
    fn of_faces(soup: &Soup, name: fn(&FaceLabel) -> &str) -> LabelNames {
        let mut names = vec![""];
        let mut number = HashMap::from([("", 0)]);
        let mut of_face = vec![0; soup.faces.len()];
        if let Some(labels) = &soup.attributes.labels {
            for (own, &label) in of_face.iter_mut().zip(&labels.of_face) {
                let name = labels.labels.get(label as usize).map_or("", name);
                *own = *number.entry(name).or_insert_with(|| {
                    names.push(name);
                    names.len() as u32 - 1
                });
            }
        }
        LabelNames { names: names.into_iter().map(String::from).collect(), of_face }
    }

    fn of_numbers(columns: &[NumberColumn]) -> LabelNames {
        LabelNames { names: columns.iter().map(|column| column.name.clone()).collect(), of_face: Vec::new() }
    }
}

impl SoupLists {
    pub fn rims(&self, soup: &Soup) -> &[Rim] {
        self.rims.get_or_init(|| rims(&soup.positions, &soup.faces))
    }

    pub fn names(&self, soup: &Soup, kind: LabelKind) -> &LabelNames {
        let all = self.names.get_or_init(|| {
            let of = |name| LabelNames::of_faces(soup, name);
            [
                of(|label| &label.object),
                of(|label| &label.group),
                of(|label| &label.material),
                of(|label| &label.smoothing),
                LabelNames::of_numbers(&soup.attributes.vertex_numbers),
                LabelNames::of_numbers(&soup.attributes.face_numbers),
            ]
        });
        &all[kind as usize]
    }

    /// The reason why a hole was left open, by its number among these.
    pub fn reason(&self, filling: &Filling, index: usize) -> Option<&CStr> {
        let reasons =
            || filling.open.iter().map(|open| CString::new(open.reason).unwrap_or_default()).collect();
        self.reasons.get_or_init(reasons).get(index).map(CString::as_c_str)
    }
}
