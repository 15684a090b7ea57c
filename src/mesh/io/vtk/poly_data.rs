//! The polygons of a VTK file with their arrays, and the triangle list that they become.

use crate::error::Result;
use crate::mesh::Point;
use crate::mesh::io::budget::Budget;
use crate::mesh::io::kind::NumberType;
use crate::mesh::io::polygon::Polygons;
use crate::mesh::io::scan::{Location, Quoted};
use crate::mesh::io::{Attributes, NumberColumn, Soup};

/// What the numbers of an array are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ArrayRole {
    Normals,
    TextureCoordinates,
    Colors,
    Plain,
}

/// An array of points or cells.
pub(super) struct VtkArray {
    pub name: String,
    pub role: ArrayRole,
    /// Numbers per point or cell.
    pub components: usize,
    pub kind: NumberType,
    pub values: Vec<f64>,
}

/// The content of a file.
#[derive(Default)]
pub(super) struct PolyData {
    pub budget: Budget,
    pub positions: Vec<Point>,
    pub polygons: Polygons,
    /// True if there are points, lines or strips beside the polygons: the arrays of cells are then those of these too.
    pub has_others: bool,
    pub at_points: Vec<VtkArray>,
    pub at_cells: Vec<VtkArray>,
    pub unread: Vec<String>,
}

/// Most arrays that are not read and are named.
const MOST_NAMED: usize = 16;

impl PolyData {
    /// Takes the coordinates of points.
    pub fn set_points(&mut self, numbers: &[f64]) {
        self.positions = numbers.as_chunks::<3>().0.to_vec();
    }

    /// Takes polygons from lists of corners with the end of each.
    pub fn add_polygons(&mut self, ends: &[f64], corners: &[f64], place: Location<'_>) -> Result<()> {
        let mut start = 0;
        for (k, &end) in ends.iter().enumerate() {
            let corners = usize::try_from(end as i64)
                .ok()
                .filter(|_| end.fract() == 0.0)
                .and_then(|end| corners.get(start..end));
            let Some(corners) = corners else {
                return place.error(format!("polygon {k} ends at corner {end}, which cannot be"));
            };
            start += corners.len();
            for &v in corners {
                self.polygons.corners.push(place.vertex(v, format_args!("polygon {k}"))?);
            }
            self.polygons.end();
        }
        Ok(())
    }

    /// Takes polygons from the numbers of a list in which each begins with its number of corners.
    pub fn add_counted(&mut self, count: usize, numbers: &[f64], place: Location<'_>) -> Result<()> {
        let mut at = 0;
        for k in 0..count {
            let size = numbers.get(at).filter(|size| **size >= 0.0 && size.fract() == 0.0);
            let corners = size.and_then(|size| numbers.get(at + 1..)?.get(..*size as usize));
            let Some(corners) = corners else {
                return place.error(format!("polygon {k} of {count} is not complete"));
            };
            at += 1 + corners.len();
            for &v in corners {
                self.polygons.corners.push(place.vertex(v, format_args!("polygon {k}"))?);
            }
            self.polygons.end();
        }
        if at < numbers.len() {
            return place
                .error(format!("{} numbers follow the last of {count} polygons", numbers.len() - at));
        }
        Ok(())
    }

    /// Takes strips of triangles, every other of which is turned around.
    pub fn add_strips(&mut self, strips: Polygons, place: Location<'_>) -> Result<()> {
        let counts: usize = strips.corners.len();
        self.budget.take(counts, 3 * size_of::<u32>(), "triangles of strips", place)?;
        let mut start = 0;
        for end in strips.ends() {
            for (k, triple) in strips.corners[start..end].windows(3).enumerate() {
                let [a, b, c] = [triple[0], triple[1], triple[2]];
                self.polygons.push(if k % 2 == 0 { [a, b, c] } else { [b, a, c] });
            }
            start = end;
        }
        self.has_others = true;
        Ok(())
    }

    /// Notes an array that is not read.
    pub fn leave_out(&mut self, what: String) {
        if self.unread.len() < MOST_NAMED {
            self.unread.push(what);
        }
    }

    pub fn soup(mut self, place: Location<'_>) -> Result<Soup> {
        let positions = std::mem::take(&mut self.positions);
        let triangles = self.polygons.triangles(&positions, &mut self.budget, place)?;
        let faces = self.polygons.faces(&triangles);
        let mut attributes = Attributes::default();
        let (n, cells) = (positions.len(), self.polygons.len());
        for array in std::mem::take(&mut self.at_points) {
            self.take_at_points(array, n, &faces, &mut attributes);
        }
        for array in std::mem::take(&mut self.at_cells) {
            let fits = array.components == 1 && array.values.len() == cells && !self.has_others;
            if !fits {
                self.leave_out(format!("array {} of cells", Quoted(&array.name)));
                continue;
            }
            let values = self.polygons.owners(&triangles).map(|k| array.values[k]).collect();
            attributes.face_numbers.push(NumberColumn { values, ..column(array) });
        }
        attributes.unread = self.unread;
        Ok(Soup { positions, faces, attributes: attributes.finite_only() })
    }

    fn take_at_points(&mut self, array: VtkArray, n: usize, faces: &[[u32; 3]], attributes: &mut Attributes) {
        let VtkArray { role, components, kind, ref values, .. } = array;
        let has_rows = components > 0 && values.len() == components * n;
        let row = |v: usize, k: usize| values.get(v * components + k).copied().unwrap_or(0.0);
        match (role, components) {
            (ArrayRole::Normals, 3) if has_rows => {
                attributes.normals = Some((0..n).map(|v| [0, 1, 2].map(|k| row(v, k))).collect());
            }
            (ArrayRole::TextureCoordinates, 2..) if has_rows => {
                let at = |v: u32| [0, 1].map(|k| row(v as usize, k));
                attributes.uv = Some(faces.iter().map(|f| f.map(at)).collect());
            }
            (ArrayRole::Colors, 3 | 4) if has_rows => {
                let full = kind.full();
                let color =
                    |v: usize| [0, 1, 2, 3].map(|k| if k < components { row(v, k) / full } else { 1.0 });
                attributes.colors = Some((0..n).map(color).collect());
            }
            (_, 1) if has_rows => attributes.vertex_numbers.push(column(array)),
            _ => self.leave_out(format!("array {} of points", Quoted(&array.name))),
        }
    }
}

/// The column of an array with one number per element; blanks in its name become underscores.
fn column(array: VtkArray) -> NumberColumn {
    let blank = |c: char| c.is_whitespace() || c.is_control();
    let name = array.name.replace(blank, "_");
    let name = if name.is_empty() { "unnamed".into() } else { name };
    NumberColumn { name, kind: array.kind, values: array.values }
}

/// The type of numbers with a name of VTK, legacy or XML.
pub(super) fn number_type(name: &str) -> Option<NumberType> {
    Some(match name.to_ascii_lowercase().as_str() {
        "char" | "signed_char" | "int8" | "vtktypeint8" => NumberType::I8,
        "unsigned_char" | "uint8" | "vtktypeuint8" => NumberType::U8,
        "short" | "int16" | "vtktypeint16" => NumberType::I16,
        "unsigned_short" | "uint16" | "vtktypeuint16" => NumberType::U16,
        // Legacy files write identities as `int`.
        "int" | "int32" | "vtktypeint32" | "vtkidtype" => NumberType::I32,
        "unsigned_int" | "uint32" | "vtktypeuint32" => NumberType::U32,
        "long" | "int64" | "vtktypeint64" => NumberType::I64,
        "unsigned_long" | "uint64" | "vtktypeuint64" => NumberType::U64,
        "float" | "float32" => NumberType::F32,
        "double" | "float64" => NumberType::F64,
        _ => return None,
    })
}

/// The name of a type in legacy files, and in XML.
pub(super) fn type_names(kind: NumberType) -> [&'static str; 2] {
    match kind {
        NumberType::I8 => ["char", "Int8"],
        NumberType::U8 => ["unsigned_char", "UInt8"],
        NumberType::I16 => ["short", "Int16"],
        NumberType::U16 => ["unsigned_short", "UInt16"],
        NumberType::I32 => ["int", "Int32"],
        NumberType::U32 => ["unsigned_int", "UInt32"],
        NumberType::I64 => ["vtktypeint64", "Int64"],
        NumberType::U64 => ["vtktypeuint64", "UInt64"],
        NumberType::F32 => ["float", "Float32"],
        NumberType::F64 => ["double", "Float64"],
    }
}
