//! Objects, groups and materials: the names under which faces stand in an OBJ file.

use crate::archive::stored;
use crate::error::{Error, Result, check_size};
use std::collections::{HashMap, HashSet};
#[cfg(feature = "gltf")]
use std::ops::Range;

/// Most primitives of a glTF file.
#[cfg(feature = "gltf")]
const MOST_STRETCHES: usize = 256;

/// The names under which a face stands; an empty one for none.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct FaceLabel {
    /// The object (`o`).
    pub object: String,
    /// The group, or several with blanks between them (`g`).
    pub group: String,
    /// The material (`usemtl`).
    pub material: String,
    /// The smoothing group (`s`).
    pub smoothing: String,
}
stored!(sections FaceLabel { object, group, material, smoothing });

impl FaceLabel {
    /// The names in the order of [`KEYWORDS`].
    pub(super) fn names(&self) -> [&str; 4] {
        [&self.object, &self.group, &self.material, &self.smoothing]
    }
}

/// The words of OBJ that begin a label's lines.
pub(super) const KEYWORDS: [&str; 4] = ["o", "g", "usemtl", "s"];

/// The look of a material of glTF.
#[derive(Debug, Clone, PartialEq)]
pub struct PlainMaterial {
    /// The name by which labels mean it.
    pub name: String,
    /// Red, green, blue, opacity, from 0 to 1, linear.
    pub base_color: [f64; 4],
    /// The share of metal, from 0 to 1.
    pub metallic: f64,
    /// From 0, a mirror, to 1.
    pub roughness: f64,
}
stored!(sections PlainMaterial { name, base_color, metallic, roughness });

/// The label of every face.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FaceLabels {
    /// The files that describe the materials (`mtllib`), as the file names them.
    pub libraries: Vec<String>,
    /// The different labels.
    pub labels: Vec<FaceLabel>,
    /// For each face the index of its label (F entries).
    pub of_face: Vec<u32>,
    /// The materials whose look is known; only glTF holds it.
    pub materials: Vec<PlainMaterial>,
}
stored!(sections FaceLabels { libraries, labels, of_face, materials });

impl FaceLabels {
    /// The labels of other faces, each that of the face it comes from. A face from none has no names.
    pub fn of_origins(&self, origins: impl IntoIterator<Item = u32>) -> FaceLabels {
        let mut labels = self.labels.clone();
        let mut plain = None;
        let mut of_none = || {
            *plain.get_or_insert_with(|| {
                labels.push(FaceLabel::default());
                labels.len() as u32 - 1
            })
        };
        let label = |face: u32| self.of_face.get(face as usize).copied().unwrap_or_else(&mut of_none);
        let of_face = origins.into_iter().map(label).collect();
        FaceLabels { libraries: self.libraries.clone(), labels, of_face, materials: self.materials.clone() }
    }

    /// The stretches of faces with one material, and its name, an empty one for none; `None` where no face has one, and where there are more
    /// stretches than a file of glTF gets primitives.
    #[cfg(feature = "gltf")]
    pub(crate) fn material_stretches(&self) -> Option<Vec<(Range<usize>, &str)>> {
        let mut made: Vec<(Range<usize>, &str)> = Vec::new();
        for (f, &label) in self.of_face.iter().enumerate() {
            let name = self.labels.get(label as usize).map_or("", |label| label.material.as_str());
            let n = made.len();
            match made.last_mut() {
                Some((faces, last)) if *last == name => faces.end = f + 1,
                _ if n == MOST_STRETCHES => return None,
                _ => made.push((f..f + 1, name)),
            }
        }
        made.iter().any(|(_, name)| !name.is_empty()).then_some(made)
    }

    /// The numbers of different materials, groups and objects, as a phrase; none where there is nothing to tell.
    pub fn told(&self) -> Option<String> {
        self.told_of(true)
    }

    /// [`FaceLabels::told`], of all names or of all but those of materials.
    pub(super) fn told_of(&self, with_materials: bool) -> Option<String> {
        let used: HashSet<u32> = self.of_face.iter().copied().collect();
        let used: Vec<&FaceLabel> = used.iter().filter_map(|&k| self.labels.get(k as usize)).collect();
        let kinds: [(fn(&FaceLabel) -> &str, [&str; 2]); 4] = [
            (|label| &label.material, ["material", "materials"]),
            (|label| &label.group, ["group", "groups"]),
            (|label| &label.object, ["object name", "object names"]),
            (
                |label| if label.smoothing == "off" { "0" } else { &label.smoothing },
                ["smoothing group", "smoothing groups"],
            ),
        ];
        let parts = kinds.into_iter().skip(usize::from(!with_materials)).filter_map(|(name, [one, many])| {
            let names: HashSet<&str> =
                used.iter().map(|label| name(label)).filter(|n| !n.is_empty() && *n != "0").collect();
            (!names.is_empty())
                .then(|| format!("{} {}", names.len(), if names.len() == 1 { one } else { many }))
        });
        let parts: Vec<String> = parts.collect();
        (!parts.is_empty()).then(|| parts.join(", "))
    }

    /// Checks that each of the faces has a label, and that names stay on their lines.
    pub(super) fn check(&self, n_faces: usize) -> Result<()> {
        check_size("labels", self.of_face.len(), n_faces)?;
        if let Some(f) = self.of_face.iter().position(|&k| k as usize >= self.labels.len()) {
            return Err(Error::argument(
                "labels",
                format!("{} of face {f}", self.of_face[f]),
                "indices of labels",
            ));
        }
        let libraries = self.libraries.iter().map(String::as_str);
        let mut names = self.labels.iter().flat_map(FaceLabel::names).chain(libraries);
        match names.find(|name| name.contains(['\n', '\r'])) {
            Some(name) => Err(Error::argument("labels", format!("{name:?}"), "names without line ends")),
            None => Ok(()),
        }
    }
}

/// The lines of an OBJ file, or of a part of it, that say under which names its faces stand.
pub(super) struct LabelLines {
    libraries: Vec<String>,
    /// The number of each name.
    names: HashMap<String, u32>,
    /// The names in force, by [`KEYWORDS`].
    now: [u32; 4],
    /// The polygons before which names change, with those in force from there on.
    changes: Vec<(usize, [u32; 4])>,
}

/// Bytes that a label may take: its names, which are those of its lines again, and the table in which it is found.
pub(super) const PER_LABEL: usize = 2 * size_of::<FaceLabel>();

/// In place of the number of a name: that in force before this part of the file.
const INHERITED: u32 = u32::MAX;

impl Default for LabelLines {
    fn default() -> LabelLines {
        LabelLines { libraries: Vec::new(), names: HashMap::new(), now: [INHERITED; 4], changes: Vec::new() }
    }
}

impl LabelLines {
    /// True for the words whose lines these are.
    pub fn begins(word: &str) -> bool {
        word == "mtllib" || KEYWORDS.contains(&word)
    }

    /// Takes a line: its first word, the rest, and the number of polygons before it. Other words are passed over.
    pub fn line(&mut self, word: &str, rest: &str, polygons: usize) {
        if word == "mtllib" {
            if !rest.is_empty() && self.libraries.last().is_none_or(|last| last != rest) {
                self.libraries.push(rest.into());
            }
        } else if let Some(k) = KEYWORDS.iter().position(|keyword| *keyword == word) {
            self.now[k] = self.number(rest);
            self.change(polygons);
        }
    }

    fn number(&mut self, name: &str) -> u32 {
        if let Some(&number) = self.names.get(name) {
            return number;
        }
        let number = self.names.len() as u32;
        self.names.insert(name.into(), number);
        number
    }

    /// Notes that the names in force hold from this polygon on. Only the last of several changes before a polygon matters.
    fn change(&mut self, polygon: usize) {
        match self.changes.last_mut() {
            Some((at, names)) if *at == polygon => *names = self.now,
            Some((_, names)) if *names == self.now => {}
            _ => self.changes.push((polygon, self.now)),
        }
    }

    /// Appends the lines of the next part of the file, before which there are so many polygons.
    pub fn append(&mut self, part: LabelLines, polygons: usize) {
        self.libraries.extend(part.libraries);
        let mut numbers = vec![0; part.names.len()];
        for (name, &number) in &part.names {
            numbers[number as usize] = self.number(name);
        }
        let before = self.now;
        let joined = |names: [u32; 4]| -> [u32; 4] {
            std::array::from_fn(|k| match names[k] {
                INHERITED => before[k],
                number => numbers[number as usize],
            })
        };
        for (polygon, names) in part.changes {
            self.now = joined(names);
            self.change(polygons + polygon);
        }
    }

    /// The number of labels that [`LabelLines::finish`] makes at most, beside the one without names.
    pub fn count(&self) -> usize {
        self.changes.iter().map(|(_, names)| names).collect::<HashSet<_>>().len()
    }

    /// The labels of triangles, from the polygon of each; none if the file has no names.
    pub fn finish(mut self, polygons: impl Iterator<Item = usize>) -> Option<FaceLabels> {
        if self.changes.is_empty() && self.libraries.is_empty() {
            return None;
        }
        let mut seen = HashSet::new();
        self.libraries.retain(|library| seen.insert(library.clone()));
        let mut names = vec![String::new(); self.names.len()];
        for (name, number) in self.names {
            names[number as usize] = name;
        }
        let name = |number: u32| names.get(number as usize).cloned().unwrap_or_default();
        let (mut labels, mut known) = (Vec::new(), HashMap::new());
        let mut number = |in_force: [u32; 4]| {
            *known.entry(in_force).or_insert_with(|| {
                let [object, group, material, smoothing] = in_force.map(name);
                labels.push(FaceLabel { object, group, material, smoothing });
                labels.len() as u32 - 1
            })
        };
        let (mut next, mut now) = (self.changes.iter().peekable(), [INHERITED; 4]);
        let mut of_face = Vec::new();
        for polygon in polygons {
            while let Some((_, names)) = next.next_if(|(at, _)| *at <= polygon) {
                now = *names;
            }
            of_face.push(number(now));
        }
        let empty = self.libraries.is_empty() && labels.iter().all(|label| *label == FaceLabel::default());
        (!empty).then_some(FaceLabels { libraries: self.libraries, labels, of_face, materials: Vec::new() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_file_inherit_the_names_before_them() {
        let lines = [
            ("g", "a", 0),
            ("usemtl", "red", 0),
            ("mtllib", "x y.mtl", 1),
            ("g", "b", 2),
            ("g", "c", 2),
            ("usemtl", "", 3),
        ];
        let mut whole = LabelLines::default();
        let mut parts = [LabelLines::default(), LabelLines::default()];
        for (k, (word, rest, polygons)) in lines.into_iter().enumerate() {
            whole.line(word, rest, polygons);
            // The second part of the file has the polygons from the first on.
            let part = usize::from(k >= 2);
            parts[part].line(word, rest, polygons - part);
        }
        let [mut joined, second] = parts;
        joined.append(second, 1);
        let whole = whole.finish(0..4).unwrap();
        assert_eq!(joined.finish(0..4).unwrap(), whole);
        let names: Vec<[&str; 4]> = whole.of_face.iter().map(|&k| whole.labels[k as usize].names()).collect();
        assert_eq!(
            names,
            [["", "a", "red", ""], ["", "a", "red", ""], ["", "c", "red", ""], ["", "c", "", ""]]
        );
        assert_eq!(whole.libraries, ["x y.mtl"]);
        assert_eq!(whole.told().unwrap(), "1 material, 2 groups");
        let picked = whole.of_origins([3, u32::MAX, 0]);
        assert_eq!(picked.labels[picked.of_face[1] as usize], FaceLabel::default());
        assert!(picked.check(3).is_ok() && picked.check(2).is_err());
    }
}
