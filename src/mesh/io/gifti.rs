//! Reader of GIFTI surfaces (`.surf.gii`), which brain imaging uses. The format is that of <https://www.nitrc.org/projects/gifti>,
//! version 1.0.

use super::budget::Budget;
use super::gifti_data::{ArrayHeader, ArrayText, VectorTable};
use super::scan::{Location, Quoted};
use super::{Attributes, Soup};
use crate::error::Result;
use crate::mesh::Point;
use quick_xml::Reader;
use quick_xml::escape::unescape;
use quick_xml::events::{BytesStart, Event};
use std::borrow::Cow;

/// Parses a GIFTI surface: its `NIFTI_INTENT_POINTSET`, its `NIFTI_INTENT_TRIANGLE` and, as normals, an array `NIFTI_INTENT_VECTOR` of
/// one vector per vertex; other arrays are skipped. Data are ASCII, base64 or compressed base64, in either byte order and either array
/// order; data in another file are refused with its name.
///
/// Positions are as stored: `CoordinateSystemTransformMatrix`, which maps them to the coordinates of another space, is not applied
/// ([`super::parse_gifti_notes`] reads it).
/// Entities are not expanded. `path` is used in errors.
///
/// # Errors
///
/// [`crate::Error::Parse`] with the line.
pub fn parse_gifti(bytes: &[u8], path: &str) -> Result<Soup> {
    let mut arrays = GiftiArrays { budget: Budget::of(bytes), ..GiftiArrays::default() };
    read_gifti(bytes, path, &mut arrays)?;
    arrays.soup(Location::whole(path))
}

/// What takes the parts of a file that it needs.
pub(super) trait GiftiVisitor {
    /// The text of an array's data.
    fn array(&mut self, header: &ArrayHeader, data: &ArrayText<'_>) -> Result<()>;

    /// A row of the table of labels and its name.
    fn label(&mut self, _tag: &BytesStart<'_>, _name: &str, _place: Location<'_>) -> Result<()> {
        Ok(())
    }

    /// A name and its value, of an array or of the whole file.
    fn note(&mut self, _within: Option<&ArrayHeader>, _note: [&str; 2], _place: Location<'_>) -> Result<()> {
        Ok(())
    }

    /// A part of a transform of points: the name of its element, `DataSpace`, `TransformedSpace` or `MatrixData`, and the text.
    fn transform(&mut self, _element: &str, _text: &str, _place: Location<'_>) -> Result<()> {
        Ok(())
    }
}

/// Goes through a file.
///
/// # Errors
/// [`crate::Error::Parse`] with the line; those of the visitor.
pub(super) fn read_gifti(bytes: &[u8], path: &str, visitor: &mut dyn GiftiVisitor) -> Result<()> {
    let mut reader = Reader::from_reader(bytes);
    reader.config_mut().expand_empty_elements = true;
    let mut lines = LineCounter { bytes, at: 0, line: 1 };
    let mut open = OpenElements::default();
    let mut root = false;
    loop {
        let event = reader.read_event();
        let place = Location::line(path, lines.until(reader.buffer_position()));
        let no_xml = |e: quick_xml::Error| place.error(format!("this is no XML: {e}"));
        match event {
            Ok(Event::Start(tag)) if !root => {
                if tag.name().0 != "GIFTI" {
                    return place.error("this is no GIFTI file: its first element is not `GIFTI`".into());
                }
                root = true;
            }
            Ok(Event::Start(tag)) if tag.name().0 == "DataArray" => match open.array {
                None => open.array = Some(ArrayHeader::new(&tag, place)?),
                Some(_) => return place.error("a DataArray inside another".into()),
            },
            Ok(Event::Start(tag)) if OpenElements::WITH_TEXT.contains(&tag.name().0) => {
                match reader.read_text(tag.name()) {
                    Ok(text) => open.text(&tag, &text, place, visitor)?,
                    Err(e) => return no_xml(e),
                }
            }
            Ok(Event::End(tag)) if tag.name().0 == "DataArray" => open.array = None,
            Ok(Event::End(tag)) if tag.name().0 == "GIFTI" => return Ok(()),
            Ok(Event::Eof) if root => return place.error("the file ends inside the element `GIFTI`".into()),
            Ok(Event::Eof) => return place.error("this is no GIFTI file: it has no element".into()),
            Ok(_) => {}
            Err(e) => return no_xml(e),
        }
    }
}

/// What has begun at a place of a file.
#[derive(Default)]
struct OpenElements {
    /// The array that is being read.
    array: Option<ArrayHeader>,
    /// The name of the note that is being read.
    name: String,
}

impl OpenElements {
    /// Elements whose text counts.
    const WITH_TEXT: [&str; 7] =
        ["Data", "Name", "Value", "Label", "DataSpace", "TransformedSpace", "MatrixData"];

    /// Takes the text of one of them, and hands it to the visitor.
    fn text(
        &mut self,
        tag: &BytesStart<'_>,
        text: &str,
        place: Location<'_>,
        visitor: &mut dyn GiftiVisitor,
    ) -> Result<()> {
        match (tag.name().0, &mut self.array) {
            ("Data", Some(array)) => visitor.array(array, &ArrayText { what: "data", text, place }),
            ("Name", _) => {
                self.name = plain(text).into();
                Ok(())
            }
            ("Value", array) => {
                let value = plain(text);
                if let Some(array) = array.as_mut().filter(|_| self.name == "Name") {
                    array.name = value.clone().into();
                }
                visitor.note(array.as_ref(), [&self.name, &value], place)
            }
            ("Label", None) => visitor.label(tag, &plain(text), place),
            // Some programs give each array a matrix; that of triangles or values says nothing.
            (element @ ("DataSpace" | "TransformedSpace" | "MatrixData"), Some(array))
                if array.intent == "NIFTI_INTENT_POINTSET" =>
            {
                visitor.transform(element, &plain(text), place)
            }
            _ => Ok(()),
        }
    }
}

/// A text as it is meant: without the marks that let it hold any character, or with these written out.
fn plain(text: &str) -> Cow<'_, str> {
    let text = text.trim();
    match text.strip_prefix("<![CDATA[").and_then(|text| text.strip_suffix("]]>")) {
        Some(inner) => inner.replace("]]]]><![CDATA[>", "]]>").into(),
        // An entity that is not known stays as it is.
        None => unescape(text).unwrap_or(Cow::Borrowed(text)),
    }
}

/// Line numbers of ascending byte positions.
struct LineCounter<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
}

impl LineCounter<'_> {
    fn until(&mut self, position: u64) -> usize {
        let to = usize::try_from(position).map_or(self.bytes.len(), |p| p.min(self.bytes.len())).max(self.at);
        self.line += self.bytes[self.at..to].iter().filter(|&&b| b == b'\n').count();
        self.at = to;
        self.line
    }
}

/// Most arrays that are not read and are named.
const MOST_OTHERS: usize = 16;

/// The arrays of interest that have been read.
#[derive(Default)]
struct GiftiArrays {
    budget: Budget,
    points: Option<Vec<Point>>,
    faces: Option<Vec<[u32; 3]>>,
    vectors: Vec<Vec<Point>>,
    /// The intents of the arrays that are not read.
    others: Vec<String>,
}

impl GiftiVisitor for GiftiArrays {
    fn array(&mut self, header: &ArrayHeader, data: &ArrayText<'_>) -> Result<()> {
        let (budget, place) = (&mut self.budget, data.place);
        let mut rows = |what| header.table(&ArrayText { what, ..*data }, budget);
        let points = |table: VectorTable| (0..table.rows).map(|i| table.row(i)).collect();
        match header.intent.as_str() {
            "NIFTI_INTENT_POINTSET" if self.points.is_none() => self.points = Some(points(rows("points")?)),
            "NIFTI_INTENT_TRIANGLE" if self.faces.is_none() => {
                let table = rows("triangles")?;
                let face = |i: usize| -> Result<[u32; 3]> {
                    let vertex = |v: f64| place.vertex(v, format_args!("triangle {i}"));
                    let [a, b, c] = table.row(i).map(vertex);
                    Ok([a?, b?, c?])
                };
                self.faces = Some((0..table.rows).map(face).collect::<Result<_>>()?);
            }
            "NIFTI_INTENT_POINTSET" | "NIFTI_INTENT_TRIANGLE" => {
                return place.error(format!("a second {}: the file holds several surfaces", header.intent));
            }
            "NIFTI_INTENT_VECTOR" if header.is_vectors() => {
                self.vectors.push(points(rows("vectors")?));
            }
            other if self.others.len() < MOST_OTHERS => {
                self.others.push(format!("array {}", Quoted(other.trim_start_matches("NIFTI_INTENT_"))));
            }
            _ => {}
        }
        Ok(())
    }
}

impl GiftiArrays {
    fn soup(self, place: Location<'_>) -> Result<Soup> {
        let Some(positions) = self.points else {
            return place.error(
                "the file has no NIFTI_INTENT_POINTSET: it is data on a surface, not a surface".into(),
            );
        };
        let normals = self.vectors.into_iter().find(|v| v.len() == positions.len() && !v.is_empty());
        let attributes = Attributes { normals, unread: self.others, ..Attributes::default() };
        Ok(Soup { positions, faces: self.faces.unwrap_or_default(), attributes: attributes.finite_only() })
    }
}
