//! An indexed triangle list with its attributes, and the checks before it is written.

use super::Format;
use super::labels::FaceLabels;
use super::number_column::{NumberColumn, told};
use crate::archive::stored;
use crate::error::{Error, Result, check_size};
use crate::mesh::Point;

/// An indexed triangle list as read from a file. Polygons are triangulated: convex ones as fans from their first corner, others ear by
/// ear. Vertices keep the file's numbering, isolated ones included.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Soup {
    /// Vertex positions; coordinates that are not finite are found by [`crate::mesh::check::diagnose`].
    pub positions: Vec<Point>,
    /// Corners of each triangle, 0-based. Indices out of range are found by the diagnosis, too.
    pub faces: Vec<[u32; 3]>,
    /// The attributes of vertices and corners.
    pub attributes: Attributes,
}

/// The data of a file beside positions and faces. Elements for which the file has no value have the default.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Attributes {
    /// Normal of each vertex (V entries), of any length; by default 0.
    pub normals: Option<Vec<Point>>,
    /// Normals of each face's corners (F entries), of any length; by default 0. They replace those of the vertices where the corners of a
    /// vertex have different ones, as at hard edges. Formats that have both write these.
    pub corner_normals: Option<Vec<[Point; 3]>>,
    /// Colour of each vertex (V entries): red, green, blue, opacity, from 0 to 1; by default opaque white.
    pub colors: Option<Vec<[f64; 4]>>,
    /// Texture coordinates of each face's corners (F entries); by default (0, 0).
    pub uv: Option<Vec<[[f64; 2]; 3]>>,
    /// The objects, groups and materials under which faces stand, which OBJ can hold.
    pub labels: Option<FaceLabels>,
    /// Further numbers of vertices (V entries each), which PLY and VTK can hold.
    pub vertex_numbers: Vec<NumberColumn>,
    /// Further numbers of faces (F entries each), which PLY and VTK can hold.
    pub face_numbers: Vec<NumberColumn>,
    /// The parts of the file that are not here, each with the reason: what a writer of these attributes leaves out as well.
    pub unread: Vec<String>,
}
stored!(sections Attributes { normals, corner_normals, colors, uv, labels, vertex_numbers, face_numbers,
    unread });

/// The defaults of [`Attributes`].
pub(super) const NO_NORMAL: Point = [0.0; 3];
pub(super) const WHITE: [f64; 4] = [1.0; 4];
pub(super) const NO_TEXCOORD: [f64; 2] = [0.0; 2];

impl Attributes {
    /// The normals and texture coordinates that are left out of a format with one normal per vertex and, unless `corner_uv`, one pair of
    /// texture coordinates per vertex.
    pub(super) fn left_out(&self, corner_uv: bool) -> Vec<String> {
        let corner_normals =
            self.corner_normals.as_ref().map(|_| "normals at hard edges: the format has one per vertex");
        let uv = self.uv.as_ref().filter(|_| !corner_uv);
        let seams =
            uv.map(|_| "texture coordinates, for they have seams: the format has one pair per vertex");
        corner_normals.into_iter().chain(seams).map(String::from).collect()
    }

    /// What is left out of a format that has positions and faces alone.
    pub(super) fn all_left_out(&self, format: Format) -> Vec<String> {
        let has_normals = self.normals.is_some() || self.corner_normals.is_some();
        let parts = [
            (has_normals, "normals"),
            (self.colors.is_some(), "colours"),
            (self.uv.is_some(), "texture coordinates"),
        ];
        let bare =
            parts.into_iter().filter(|(has, _)| *has).map(|(_, what)| format!("{what}: the format has none"));
        bare.chain(self.unheld(format)).collect()
    }

    /// What a format has no room for beside normals, colours and texture coordinates, and what was not read in the first place.
    pub fn unheld(&self, format: Format) -> Vec<String> {
        let names = |labels: &FaceLabels| match format {
            Format::Obj => match labels.materials.len() {
                0 => None,
                1 => Some("the look of 1 material: only glTF has it".into()),
                n => Some(format!("the look of {n} materials: only glTF has it")),
            },
            #[cfg(feature = "gltf")]
            Format::Glb if labels.material_stretches().is_some() => {
                let libraries = labels.libraries.iter().map(String::as_str);
                let told = labels.told_of(false);
                let all: Vec<&str> = told.as_deref().into_iter().chain(libraries).collect();
                (!all.is_empty()).then(|| format!("{}: only OBJ has them", all.join(", ")))
            }
            _ => labels.told().map(|what| format!("{what}: only OBJ has them")),
        };
        let labels = self.labels.as_ref().and_then(names);
        let numbers = [(&self.vertex_numbers, "vertices"), (&self.face_numbers, "faces")];
        let numbers = numbers.into_iter().filter_map(|(columns, element)| told(columns, element));
        let numbers = numbers
            .filter(|_| !format.has_numbers())
            .map(|what| format!("{what}: only PLY and VTK have them"));
        labels.into_iter().chain(numbers).chain(self.unread.iter().cloned()).collect()
    }

    /// The attributes of a triangle list whose vertices and faces come from these of the given one. Corners keep their order; an element
    /// that comes from none has the default.
    pub fn of_origins(&self, vertices: &[u32], faces: &[u32]) -> Attributes {
        fn picked<T: Copy>(list: &Option<Vec<T>>, origins: &[u32], default: T) -> Option<Vec<T>> {
            let list = list.as_ref().filter(|list| !list.is_empty())?;
            Some(origins.iter().map(|&k| list.get(k as usize).copied().unwrap_or(default)).collect())
        }
        let columns = |columns: &[NumberColumn], origins: &[u32]| -> Vec<NumberColumn> {
            columns.iter().map(|column| column.of_origins(origins)).collect()
        };
        Attributes {
            normals: picked(&self.normals, vertices, NO_NORMAL),
            corner_normals: picked(&self.corner_normals, faces, [NO_NORMAL; 3]),
            colors: picked(&self.colors, vertices, WHITE),
            uv: picked(&self.uv, faces, [NO_TEXCOORD; 3]),
            labels: self.labels.as_ref().map(|labels| labels.of_origins(faces.iter().copied())),
            vertex_numbers: columns(&self.vertex_numbers, vertices),
            face_numbers: columns(&self.face_numbers, faces),
            unread: self.unread.clone(),
        }
    }

    /// Leaves out each attribute with a number that is not finite, which no file could be written with, and says so in `unread`.
    pub(super) fn finite_only(mut self) -> Attributes {
        fn keep<const N: usize, T>(
            list: &mut Option<Vec<T>>,
            rows: impl Fn(&T) -> &[[f64; N]],
            what: [&str; 2],
        ) -> Option<String> {
            let given = list.as_deref()?;
            let bad = |row: &T| !rows(row).as_flattened().iter().all(|x| x.is_finite());
            let first = given.iter().position(bad)?;
            let (count, all, [what, element]) =
                (given.iter().filter(|row| bad(row)).count(), given.len(), what);
            *list = None;
            Some(format!("{what}: {count} of {all} are not finite, the first at {element} {first} (from 0)"))
        }
        let said = [
            keep(&mut self.normals, std::slice::from_ref, ["normals", "vertex"]),
            keep(&mut self.corner_normals, |row| &row[..], ["normals of corners", "face"]),
            keep(&mut self.colors, std::slice::from_ref, ["colours", "vertex"]),
            keep(&mut self.uv, |row| &row[..], ["texture coordinates", "face"]),
        ];
        self.unread.extend(said.into_iter().flatten());
        self
    }

    /// Texture coordinates per vertex, if the corners of each of the `n` vertices agree on them.
    pub(crate) fn vertex_uv(&self, n: usize, faces: &[[u32; 3]]) -> Option<Vec<[f64; 2]>> {
        let mut at: Vec<Option<[f64; 2]>> = vec![None; n];
        for (&v, &uv) in faces.as_flattened().iter().zip(self.uv.as_ref()?.as_flattened()) {
            let slot = at.get_mut(v as usize)?;
            if slot.is_some_and(|known| known != uv) {
                return None;
            }
            *slot = Some(uv);
        }
        Some(at.into_iter().map(Option::unwrap_or_default).collect())
    }
}

impl Soup {
    /// A triangle list without attributes.
    pub fn new(positions: Vec<Point>, faces: Vec<[u32; 3]>) -> Soup {
        Soup { positions, faces, attributes: Attributes::default() }
    }

    /// Checks that numbers are finite, corners name vertices, and attributes have an entry for each element.
    pub(crate) fn check_writable(&self) -> Result<()> {
        let Soup { positions, faces, attributes } = self;
        let Attributes { normals, corner_normals, colors, uv, .. } = attributes;
        let (n, f) = (positions.len(), faces.len());
        attributes.vertex_numbers.iter().try_for_each(|column| column.check(n))?;
        attributes.face_numbers.iter().try_for_each(|column| column.check(f))?;
        attributes.labels.iter().try_for_each(|labels| labels.check(f))?;
        sized("normals", normals, n)?;
        sized("corner_normals", corner_normals, f)?;
        sized("colors", colors, n)?;
        sized("uv", uv, f)?;
        finite("position", positions)?;
        in_range("vertex", faces, n)?;
        finite("normal", normals.as_deref().unwrap_or_default())?;
        finite("normal", corner_normals.as_deref().unwrap_or_default().as_flattened())?;
        finite("colour", colors.as_deref().unwrap_or_default())?;
        finite("texture coordinate", uv.as_deref().unwrap_or_default().as_flattened())
    }
}

fn sized<T>(what: &'static str, list: &Option<Vec<T>>, n: usize) -> Result<()> {
    list.as_ref().map_or(Ok(()), |list| check_size(what, list.len(), n))
}

pub(super) fn finite<const N: usize>(what: &'static str, points: &[[f64; N]]) -> Result<()> {
    match points.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
        Some(i) => {
            let value = format!("{:?} at entry {i}", points[i]);
            Err(Error::argument(what, value, "a file holds finite numbers only"))
        }
        None => Ok(()),
    }
}

pub(super) fn in_range(what: &'static str, faces: &[[u32; 3]], n: usize) -> Result<()> {
    match faces.iter().position(|corners| corners.iter().any(|&v| v as usize >= n)) {
        Some(f) => {
            let value = format!("one of {:?} in face {f}", faces[f]);
            Err(Error::argument(what, value, "corners must be below the number of entries they name"))
        }
        None => Ok(()),
    }
}
