//! Reader of VTK polygons in XML.

use super::poly_data::{ArrayRole, PolyData, VtkArray};
use super::xml_array::{AppendedData, XmlArray, XmlEncoding, XmlFile, unescaped};
use crate::error::Result;
use crate::mesh::io::Soup;
use crate::mesh::io::budget::Budget;
use crate::mesh::io::polygon::Polygons;
use crate::mesh::io::scan::{Location, Quoted};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

/// Parses a VTK file of polygons in XML: one piece with its points, polygons and strips, and what [`super::parse_vtk`] reads beside them. Data
/// are text, base64 or appended, plain or compressed by zlib. `path` is used in errors.
///
/// # Errors
/// [`crate::Error::Parse`] with the byte.
pub fn parse_vtp(bytes: &[u8], path: &str) -> Result<Soup> {
    let (text, appended) = split(bytes);
    let mut reader = Reader::from_reader(text);
    reader.config_mut().expand_empty_elements = true;
    let mut piece = PieceReader {
        file: XmlFile { encoding: XmlEncoding::default(), appended },
        data: PolyData { budget: Budget::of(bytes), ..PolyData::default() },
        ..PieceReader::default()
    };
    loop {
        let event = reader.read_event();
        let place = Location::byte(path, reader.buffer_position() as usize);
        match event {
            Ok(Event::Start(tag)) if tag.name().0 == "DataArray" => {
                let array = XmlArray::new(&tag, place)?;
                match reader.read_text(tag.name()) {
                    Ok(text) => piece.take(&array, &text, place)?,
                    Err(e) => return place.error(format!("this is no XML: {e}")),
                }
            }
            Ok(Event::Start(tag)) => piece.open(&tag, place)?,
            Ok(Event::End(tag)) => piece.close(tag.name().0, place)?,
            Ok(Event::Eof) => break,
            Ok(_) => {}
            Err(e) => return place.error(format!("this is no XML: {e}")),
        }
    }
    let whole = Location::whole(path);
    if !piece.has_root {
        return whole.error("this is no VTK file: it has no element `VTKFile`".into());
    }
    piece.data.soup(whole)
}

/// The XML of a file, and the data behind the mark `_` of its element `AppendedData`, which need not be XML.
fn split(bytes: &[u8]) -> (&[u8], Option<AppendedData<'_>>) {
    let name = b"<AppendedData";
    let none = (bytes, None);
    let Some(at) = bytes.windows(name.len()).position(|window| window == name) else { return none };
    let Some(end) = bytes[at..].iter().position(|&b| b == b'>').map(|k| at + k + 1) else { return none };
    let Some(start) = bytes[end..].iter().position(|&b| b == b'_').map(|k| end + k + 1) else { return none };
    let is_base64 = bytes[at..end].windows(6).any(|window| window.eq_ignore_ascii_case(b"base64"));
    (&bytes[..at], Some(AppendedData { bytes: &bytes[start..], is_base64 }))
}

/// The piece of a file while it is read.
#[derive(Default)]
struct PieceReader<'a> {
    file: XmlFile<'a>,
    data: PolyData,
    has_root: bool,
    has_piece: bool,
    /// The element whose arrays follow: `Points`, `Polys`, `Strips`, `PointData`, `CellData`, or another.
    section: String,
    /// The names of the normals, of the texture coordinates and of the scalars among the arrays of points.
    roles: [String; 3],
    ends: Option<Vec<f64>>,
    corners: Option<Vec<f64>>,
}

/// An attribute of an element.
fn attribute(tag: &BytesStart<'_>, wanted: &str) -> Option<String> {
    let mut all = tag.attributes();
    let found = all.with_checks(false).flatten().find(|attribute| attribute.key.0 == wanted);
    found.map(|attribute| unescaped(attribute.value.trim()))
}

impl PieceReader<'_> {
    fn open(&mut self, tag: &BytesStart<'_>, place: Location<'_>) -> Result<()> {
        match tag.name().0 {
            "VTKFile" => {
                let kind = attribute(tag, "type").unwrap_or_default();
                if kind != "PolyData" {
                    return place.error(format!("the file holds {}; PolyData is read", Quoted(&kind)));
                }
                let is = |name: &str, value: &str| attribute(tag, name).is_some_and(|found| found == value);
                let compressor = attribute(tag, "compressor").unwrap_or_default();
                if !["", "vtkZLibDataCompressor"].contains(&compressor.as_str()) {
                    return place.error(format!(
                        "the compressor {} is not read; vtkZLibDataCompressor is",
                        Quoted(&compressor)
                    ));
                }
                self.file.encoding = XmlEncoding {
                    big_endian: is("byte_order", "BigEndian"),
                    wide_sizes: is("header_type", "UInt64"),
                    is_compressed: !compressor.is_empty(),
                };
                self.has_root = true;
            }
            name if !self.has_root => {
                return place.error(format!("this is no VTK file: its first element is {}", Quoted(name)));
            }
            "Piece" if self.has_piece => {
                return place.error("the file has several pieces; write it as one".into());
            }
            "Piece" => self.has_piece = true,
            name @ ("Points" | "Polys" | "Strips" | "Verts" | "Lines" | "PointData" | "CellData"
            | "FieldData") => {
                self.section = name.into();
                if name == "PointData" {
                    self.roles = ["Normals", "TCoords", "Scalars"]
                        .map(|role| attribute(tag, role).unwrap_or_default());
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn take(&mut self, array: &XmlArray, text: &str, place: Location<'_>) -> Result<()> {
        // Elements about the array can follow its numbers.
        let text = if array.is_inline() { text.split('<').next().unwrap_or_default() } else { "" };
        let (file, budget) = (&self.file, &mut self.data.budget);
        let is_read = matches!(
            self.section.as_str(),
            "Points" | "Polys" | "Strips" | "Lines" | "Verts" | "PointData" | "CellData"
        );
        if !is_read {
            return Ok(());
        }
        let values = array.numbers(text, file, budget, place)?;
        match (self.section.as_str(), array.name.as_str()) {
            ("Points", _) if array.components != 3 || !values.len().is_multiple_of(3) => {
                return place.error(format!("points have {} coordinates; 3 are read", array.components));
            }
            ("Points", _) => {
                self.data.budget.take(values.len() / 3, 24, "points", place)?;
                self.data.set_points(&values);
            }
            ("PointData", name) => {
                let role = [ArrayRole::Normals, ArrayRole::TextureCoordinates, ArrayRole::Colors];
                let named =
                    role.into_iter().zip(&self.roles).find(|(_, own)| !own.is_empty() && *own == name);
                let role = named.map_or(ArrayRole::Plain, |(role, _)| role);
                self.data.at_points.push(VtkArray { role, values, ..plain(array) });
            }
            ("CellData", _) => self.data.at_cells.push(VtkArray { values, ..plain(array) }),
            (_, "offsets") => self.ends = Some(values),
            (_, "connectivity") => self.corners = Some(values),
            _ => {}
        }
        Ok(())
    }

    /// The end of an element: cells are complete.
    fn close(&mut self, name: &str, place: Location<'_>) -> Result<()> {
        if !["Polys", "Strips", "Lines", "Verts"].contains(&name) {
            return Ok(());
        }
        let (ends, corners) = (self.ends.take().unwrap_or_default(), self.corners.take().unwrap_or_default());
        if ends.is_empty() {
            return Ok(());
        }
        self.data.budget.take(corners.len(), size_of::<u32>(), "corners", place)?;
        self.data.budget.take(ends.len(), size_of::<usize>(), "polygons", place)?;
        match name {
            "Polys" => self.data.add_polygons(&ends, &corners, place),
            "Strips" => {
                let polygons: Polygons = std::mem::take(&mut self.data.polygons);
                self.data.add_polygons(&ends, &corners, place)?;
                let strips = std::mem::replace(&mut self.data.polygons, polygons);
                self.data.add_strips(strips, place)
            }
            other => {
                self.data.has_others = true;
                self.data.leave_out(other.to_ascii_lowercase());
                Ok(())
            }
        }
    }
}

/// An array without its numbers, of no role.
fn plain(array: &XmlArray) -> VtkArray {
    VtkArray {
        name: array.name.clone(),
        role: ArrayRole::Plain,
        components: array.components,
        kind: array.kind,
        values: Vec::new(),
    }
}
