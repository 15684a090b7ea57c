//! Writers of VTK polygons, legacy and in XML, both with numbers in binary.

use super::poly_data::type_names;
use crate::error::{Error, Result};
use crate::mesh::io::kind::NumberType;
use crate::mesh::io::{Format, NumberColumn, Soup, write_atomically};
use std::io::{self, Write};
use std::path::Path;

/// An array that is written.
struct OutArray<'a> {
    name: &'a str,
    components: usize,
    kind: NumberType,
    values: Vec<f64>,
}

/// The content of a file.
struct OutData<'a> {
    normals: Option<OutArray<'a>>,
    uv: Option<OutArray<'a>>,
    colors: Option<OutArray<'a>>,
    left_out: Vec<String>,
}

impl<'a> OutData<'a> {
    fn new(soup: &'a Soup, format: Format) -> Result<OutData<'a>> {
        soup.check_writable()?;
        if soup.faces.len() > i32::MAX as usize / 4 || soup.positions.len() > i32::MAX as usize {
            return Err(Error::TooLarge { what: "faces of a VTK file", count: soup.faces.len() });
        }
        let attributes = &soup.attributes;
        let uv = attributes.vertex_uv(soup.positions.len(), &soup.faces);
        let left_out = [attributes.left_out(uv.is_some()), attributes.unheld(format)].concat();
        let array = |name, components, kind, values| OutArray { name, components, kind, values };
        let bytes = |x: f64| (255.0 * x.clamp(0.0, 1.0)).round();
        let normals = attributes.normals.as_ref();
        let colors = attributes.colors.as_ref();
        Ok(OutData {
            normals: normals.map(|rows| array("Normals", 3, NumberType::F64, rows.as_flattened().to_vec())),
            uv: uv.map(|rows| array("TextureCoordinates", 2, NumberType::F64, rows.as_flattened().to_vec())),
            colors: colors.map(|rows| {
                array("Colors", 4, NumberType::U8, rows.as_flattened().iter().copied().map(bytes).collect())
            }),
            left_out,
        })
    }
}

/// Writes a legacy VTK file of polygons, atomically: binary, positions as 64-bit numbers, with normals, texture coordinates if each vertex has a
/// single pair, colours (8 bits) and further numbers. Returns what was left out.
///
/// # Errors
/// With the file untouched: [`Error::Argument`] for numbers that are not finite and corners out of range, [`Error::Size`] for attributes of
/// another size, [`Error::TooLarge`], [`Error::Io`].
pub fn write_vtk(path: &Path, soup: &Soup) -> Result<Vec<String>> {
    let data = OutData::new(soup, Format::Vtk)?;
    write_atomically(path, |out| {
        writeln!(out, "# vtk DataFile Version 3.0\nwritten by ricci\nBINARY\nDATASET POLYDATA")?;
        writeln!(out, "POINTS {} double", soup.positions.len())?;
        put(out, NumberType::F64, soup.positions.as_flattened().iter().copied())?;
        writeln!(out, "\nPOLYGONS {} {}", soup.faces.len(), 4 * soup.faces.len())?;
        let corners = soup.faces.iter().flat_map(|[a, b, c]| [3, *a, *b, *c]).map(f64::from);
        put(out, NumberType::I32, corners)?;
        let at_points: Vec<OutArray<'_>> = soup.attributes.vertex_numbers.iter().map(column).collect();
        let at_cells: Vec<OutArray<'_>> = soup.attributes.face_numbers.iter().map(column).collect();
        if data.normals.is_some() || data.uv.is_some() || data.colors.is_some() || !at_points.is_empty() {
            writeln!(out, "\nPOINT_DATA {}", soup.positions.len())?;
        }
        if let Some(normals) = &data.normals {
            writeln!(out, "NORMALS {} double", normals.name)?;
            put(out, normals.kind, normals.values.iter().copied())?;
            writeln!(out)?;
        }
        if let Some(uv) = &data.uv {
            writeln!(out, "TEXTURE_COORDINATES {} 2 double", uv.name)?;
            put(out, uv.kind, uv.values.iter().copied())?;
            writeln!(out)?;
        }
        if let Some(colors) = &data.colors {
            writeln!(out, "COLOR_SCALARS {} 4", colors.name)?;
            put(out, colors.kind, colors.values.iter().copied())?;
            writeln!(out)?;
        }
        field(out, &at_points)?;
        if !at_cells.is_empty() {
            writeln!(out, "CELL_DATA {}", soup.faces.len())?;
        }
        field(out, &at_cells)
    })?;
    Ok(data.left_out)
}

fn column(column: &NumberColumn) -> OutArray<'_> {
    OutArray { name: &column.name, components: 1, kind: column.kind, values: column.values.clone() }
}

/// Arrays of a legacy file.
fn field(out: &mut impl Write, arrays: &[OutArray<'_>]) -> io::Result<()> {
    if arrays.is_empty() {
        return Ok(());
    }
    writeln!(out, "FIELD FieldData {}", arrays.len())?;
    for array in arrays {
        let [kind, _] = type_names(array.kind);
        writeln!(
            out,
            "{} {} {} {kind}",
            array.name,
            array.components,
            array.values.len() / array.components
        )?;
        put(out, array.kind, array.values.iter().copied())?;
        writeln!(out)?;
    }
    Ok(())
}

/// Numbers, big-endian.
fn put(out: &mut impl Write, kind: NumberType, numbers: impl Iterator<Item = f64>) -> io::Result<()> {
    for x in numbers {
        let mut word = kind.bytes(x);
        let word = &mut word[..kind.size()];
        word.reverse();
        out.write_all(word)?;
    }
    Ok(())
}

/// Writes a VTK file of polygons in XML, atomically: numbers as base64, positions of 64 bits, with what [`write_vtk`] writes beside them.
/// Returns what was left out.
///
/// # Errors
/// Those of [`write_vtk`].
#[cfg(feature = "gifti")]
pub fn write_vtp(path: &Path, soup: &Soup) -> Result<Vec<String>> {
    let data = OutData::new(soup, Format::Vtp)?;
    let (n, f) = (soup.positions.len(), soup.faces.len());
    write_atomically(path, |out| {
        writeln!(out, "<?xml version=\"1.0\"?>")?;
        writeln!(
            out,
            "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">"
        )?;
        writeln!(
            out,
            "<PolyData>\n<Piece NumberOfPoints=\"{n}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"{f}\">"
        )?;
        let roles = [("Normals", &data.normals), ("TCoords", &data.uv), ("Scalars", &data.colors)];
        let named =
            roles.iter().filter_map(|(role, array)| Some(format!(" {role}=\"{}\"", array.as_ref()?.name)));
        writeln!(out, "<PointData{}>", named.collect::<String>())?;
        for (_, array) in roles {
            array.iter().try_for_each(|array| element(out, array))?;
        }
        soup.attributes.vertex_numbers.iter().try_for_each(|own| element(out, &column(own)))?;
        writeln!(out, "</PointData>\n<CellData>")?;
        soup.attributes.face_numbers.iter().try_for_each(|own| element(out, &column(own)))?;
        writeln!(out, "</CellData>\n<Points>")?;
        let values = soup.positions.as_flattened().to_vec();
        element(out, &OutArray { name: "Points", components: 3, kind: NumberType::F64, values })?;
        writeln!(out, "</Points>\n<Polys>")?;
        let whole = |name, values| OutArray { name, components: 1, kind: NumberType::I64, values };
        let corners = soup.faces.as_flattened().iter().map(|v| f64::from(*v)).collect();
        element(out, &whole("connectivity", corners))?;
        element(out, &whole("offsets", (1..=f).map(|k| 3.0 * k as f64).collect()))?;
        writeln!(out, "</Polys>\n</Piece>\n</PolyData>\n</VTKFile>")
    })?;
    Ok(data.left_out)
}

/// An array of a file in XML: its size in bytes and its numbers, little-endian, as base64.
#[cfg(feature = "gifti")]
fn element(out: &mut impl Write, array: &OutArray<'_>) -> io::Result<()> {
    let mut bytes = ((array.values.len() * array.kind.size()) as u64).to_le_bytes().to_vec();
    for x in &array.values {
        bytes.extend(&array.kind.bytes(*x)[..array.kind.size()]);
    }
    let [_, kind] = type_names(array.kind);
    let escaped = array.name.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
    let text = crate::mesh::io::base64::encode(&bytes);
    writeln!(
        out,
        "<DataArray type=\"{kind}\" Name=\"{escaped}\" NumberOfComponents=\"{}\" format=\"binary\">{text}</DataArray>",
        array.components
    )
}
