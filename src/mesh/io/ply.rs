//! PLY, ascii and both binary byte orders, by the crate `ply-rs-bw`.

use super::budget::Budget;
use super::polygon::Polygons;
use super::scan::Place;
use super::{Attributes, Point, Soup, write_atomically};
use crate::error::{Error, Result};
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult};
use std::io::{BufRead, ErrorKind, Read, Write};
use std::path::Path;

/// Parse a PLY file: elements `vertex` (x, y, z; nx, ny, nz; red, green, blue, alpha; s, t or u, v), `face` (vertex_indices or
/// vertex_index, texcoord) and `tristrips`; everything else is skipped. `path` is used in errors.
pub fn parse_ply(bytes: &[u8], path: &str) -> Result<Soup> {
    let (header, body) = split_header(bytes, path)?;
    let mut reader = Reader::new(header.as_bytes().chain(body));
    let header = match Parser::<Skipped>::new().read_header(&mut reader) {
        Ok(header) => header,
        Err(error) => return Err(failed(&error, path)),
    };
    check_header(&header, Place { path, line: 1 })?;
    let (mut vertices, mut polygons, mut corner_uv) =
        (Vertices::new(&header), Polygons::default(), Vec::new());
    let (mut budget, place) = (Budget::of(bytes), Place { path, line: 0 });
    for (name, element) in &header.elements {
        let mut rows = Rows { reader: &mut reader, header: &header, element, path };
        match name.as_str() {
            "vertex" => rows.each(|_, row| {
                vertices.push(row);
                Ok(())
            })?,
            "face" => rows.each(|f, row: FaceRow| {
                for &v in &row.corners {
                    polygons.corners.push(vertex(v, f, place)?);
                }
                if row.uv.len() == 2 * row.corners.len() {
                    corner_uv.extend(row.uv.chunks_exact(2).map(|uv| [uv[0], uv[1]]));
                }
                polygons.end();
                Ok(())
            })?,
            "tristrips" => rows.each(|f, row: FaceRow| {
                // A triangle for each corner, which may take a byte.
                budget.take(row.corners.len(), size_of::<([u32; 3], usize)>(), "strips", place)?;
                strips(&row.corners, f, place, &mut polygons)
            })?,
            _ if element.properties.is_empty() && header.encoding != Encoding::Ascii => {}
            _ => rows.each(|_, _: Skipped| Ok(()))?,
        }
    }
    let triangles = polygons.triangles(&vertices.positions, &mut budget, place)?;
    Ok(vertices.soup(&polygons, &triangles, &corner_uv))
}

fn failed(error: &ParseError, path: &str) -> Error {
    let message = error.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
    Error::Parse { path: path.into(), line: error.line().unwrap_or(0), message }
}

/// The rows of an element, which the reader has before it.
struct Rows<'a, R: BufRead> {
    reader: &'a mut Reader<R>,
    header: &'a Header,
    element: &'a ElementDef,
    path: &'a str,
}

impl<R: BufRead> Rows<'_, R> {
    /// Hand on each row with its number. They are parsed in blocks: a row of a byte would take many in memory.
    fn each<E: PropertyAccess>(&mut self, mut take: impl FnMut(usize, E) -> Result<()>) -> Result<()> {
        const BLOCK: usize = 1024;
        let (parser, mut block) = (Parser::<E>::new(), self.element.clone());
        for first in (0..self.element.count).step_by(BLOCK) {
            block.count = BLOCK.min(self.element.count - first);
            match parser.read_payload_for_element(self.reader, &block, self.header) {
                Ok(rows) => {
                    for (i, row) in rows.into_iter().enumerate() {
                        take(first + i, row)?;
                    }
                }
                Err(error) if error.kind() == ErrorKind::UnexpectedEof => {
                    let place = Place { path: self.path, line: error.line().unwrap_or(0) };
                    let ElementDef { name, count, .. } = self.element;
                    return place.error(format!("the file ends inside element `{name}` of {count} rows"));
                }
                Err(error) => return Err(failed(&error, self.path)),
            }
        }
        Ok(())
    }
}

/// The header as plain lines, and the bytes behind it. Blanks at line ends and lone carriage returns occur in the wild.
fn split_header<'a>(bytes: &'a [u8], path: &str) -> Result<(String, &'a [u8])> {
    let place = Place { path, line: 1 };
    let mut header = String::new();
    let mut rest = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    while !rest.is_empty() {
        let end = rest.iter().position(|b| matches!(b, b'\n' | b'\r')).unwrap_or(rest.len());
        let line = String::from_utf8_lossy(&rest[..end]);
        let line = line.trim_end();
        if header.is_empty() && line != "ply" {
            break;
        }
        let pair = rest[end..].starts_with(b"\r\n");
        rest = rest.get(end + 1 + usize::from(pair)..).unwrap_or_default();
        header.push_str(line);
        header.push('\n');
        if line == "end_header" {
            return Ok((header, rest));
        }
    }
    place.error(if header.is_empty() {
        "this is no PLY file: that begins with the line `ply`".into()
    } else {
        "the header has no line `end_header`".into()
    })
}

fn check_header(header: &Header, place: Place<'_>) -> Result<()> {
    let Some(vertex) = header.elements.get("vertex") else {
        return place.error("the header has no element `vertex`".into());
    };
    match ["x", "y", "z"].into_iter().find(|name| !vertex.properties.contains_key(*name)) {
        Some(name) => place.error(format!("element `vertex` has no property `{name}`")),
        None => Ok(()),
    }
}

/// The rows of element `vertex`: what it has is kept.
struct Vertices {
    positions: Vec<Point>,
    normals: Option<Vec<Point>>,
    colors: Option<Vec<[f64; 4]>>,
    uv: Option<Vec<[f64; 2]>>,
}

impl Vertices {
    fn new(header: &Header) -> Vertices {
        let element = header.elements.get("vertex");
        let has = |names: &[&str]| {
            element.is_some_and(|e| names.iter().all(|name| e.properties.contains_key(*name)))
        };
        Vertices {
            positions: Vec::new(),
            normals: has(&["nx", "ny", "nz"]).then(Vec::new),
            colors: has(&["red", "green", "blue"]).then(Vec::new),
            uv: (has(&["s", "t"]) || has(&["u", "v"]) || has(&["texture_u", "texture_v"])).then(Vec::new),
        }
    }

    fn push(&mut self, row: VertexRow) {
        self.positions.push(row.position);
        self.normals.iter_mut().for_each(|list| list.push(row.normal));
        self.colors.iter_mut().for_each(|list| list.push(row.color));
        self.uv.iter_mut().for_each(|list| list.push(row.uv));
    }

    fn soup(self, polygons: &Polygons, triangles: &[[usize; 3]], corner_uv: &[[f64; 2]]) -> Soup {
        let Vertices { positions, normals, colors, uv } = self;
        let uv = if corner_uv.len() == polygons.corners.len() && !corner_uv.is_empty() {
            Some(triangles.iter().map(|t| t.map(|k| corner_uv[k])).collect())
        } else {
            let at = |uv: &[[f64; 2]], v: u32| uv.get(v as usize).copied().unwrap_or_default();
            uv.map(|uv| triangles.iter().map(|&t| polygons.face(t).map(|v| at(&uv, v))).collect())
        };
        let faces = triangles.iter().map(|&t| polygons.face(t)).collect();
        Soup { positions, faces, attributes: Attributes { normals, colors, uv } }
    }
}

fn vertex(index: i64, face: usize, place: Place<'_>) -> Result<u32> {
    match u32::try_from(index) {
        Ok(v) => Ok(v),
        Err(_) => place.error(format!("face {face} names vertex {index}, which cannot be")),
    }
}

/// Triangles of the strips of one list, which −1 separates; every other triangle of a strip is turned around.
fn strips(list: &[i64], row: usize, place: Place<'_>, polygons: &mut Polygons) -> Result<()> {
    for strip in list.split(|&v| v == -1) {
        for (k, w) in strip.windows(3).enumerate() {
            let [a, b, c] = [vertex(w[0], row, place)?, vertex(w[1], row, place)?, vertex(w[2], row, place)?];
            // A repeated vertex stitches strips together.
            if a != b && b != c && c != a {
                polygons.push(if k % 2 == 0 { [a, b, c] } else { [b, a, c] });
            }
        }
    }
    Ok(())
}

/// An element that is of no interest.
struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Skipped
    }
}

struct VertexRow {
    position: Point,
    normal: Point,
    color: [f64; 4],
    uv: [f64; 2],
}

impl PropertyAccess for VertexRow {
    fn new() -> Self {
        VertexRow { position: [0.0; 3], normal: [0.0; 3], color: [1.0; 4], uv: [0.0; 2] }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let slot = match name {
            "x" => &mut self.position[0],
            "y" => &mut self.position[1],
            "z" => &mut self.position[2],
            "nx" => &mut self.normal[0],
            "ny" => &mut self.normal[1],
            "nz" => &mut self.normal[2],
            "red" => &mut self.color[0],
            "green" => &mut self.color[1],
            "blue" => &mut self.color[2],
            "alpha" => &mut self.color[3],
            "s" | "u" | "texture_u" => &mut self.uv[0],
            "t" | "v" | "texture_v" => &mut self.uv[1],
            _ => return PropertyAccessResult::Ignored,
        };
        let color = matches!(name, "red" | "green" | "blue" | "alpha");
        let (value, full) = match property {
            Property::Char(x) => (f64::from(x), 127.0),
            Property::UChar(x) => (f64::from(x), 255.0),
            Property::Short(x) => (f64::from(x), 32767.0),
            Property::UShort(x) => (f64::from(x), 65535.0),
            Property::Int(x) => (f64::from(x), 255.0),
            Property::UInt(x) => (f64::from(x), 255.0),
            Property::Float(x) => (f64::from(x), 1.0),
            Property::Double(x) => (x, 1.0),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        *slot = if color { value / full } else { value };
        PropertyAccessResult::Set
    }
}

#[derive(Default)]
struct FaceRow {
    corners: Vec<i64>,
    uv: Vec<f64>,
}

impl PropertyAccess for FaceRow {
    fn new() -> Self {
        FaceRow::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        fn all<T: Copy + Into<i64>>(list: &[T]) -> Vec<i64> {
            list.iter().map(|&x| x.into()).collect()
        }
        match (name, property) {
            ("vertex_indices" | "vertex_index", list) => {
                self.corners = match list {
                    Property::ListChar(x) => all(&x),
                    Property::ListUChar(x) => all(&x),
                    Property::ListShort(x) => all(&x),
                    Property::ListUShort(x) => all(&x),
                    Property::ListInt(x) => all(&x),
                    Property::ListUInt(x) => all(&x),
                    _ => return PropertyAccessResult::UnsupportedType,
                }
            }
            ("texcoord", Property::ListFloat(x)) => self.uv = x.into_iter().map(f64::from).collect(),
            ("texcoord", Property::ListDouble(x)) => self.uv = x,
            _ => return PropertyAccessResult::Ignored,
        }
        PropertyAccessResult::Set
    }
}

/// Write binary PLY (little-endian, positions as doubles, so that they read back as they are), with normals, colours (8 bits)
/// and texture coordinates where there are any: at the vertices (s, t) if each has a single pair, else at the corners of the faces
/// (texcoord); atomically.
///
/// Errors, with the file untouched: [`Error::Argument`] for numbers that are not finite and corners out of range,
/// [`Error::Size`] for attributes of another size, [`Error::Io`].
pub fn write_ply(path: &Path, soup: &Soup) -> Result<()> {
    soup.check_writable()?;
    let Soup { positions, faces, attributes } = soup;
    let Attributes { normals, colors, uv } = attributes;
    let vertex_uv = attributes.vertex_uv(positions.len(), faces);
    let corner_uv = uv.as_ref().filter(|_| vertex_uv.is_none());
    write_atomically(path, |out| {
        write!(out, "ply\nformat binary_little_endian 1.0\ncomment ricci {}\n", env!("CARGO_PKG_VERSION"))?;
        write!(
            out,
            "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n",
            positions.len()
        )?;
        if normals.is_some() {
            out.write_all(b"property double nx\nproperty double ny\nproperty double nz\n")?;
        }
        if colors.is_some() {
            for name in ["red", "green", "blue", "alpha"] {
                writeln!(out, "property uchar {name}")?;
            }
        }
        if vertex_uv.is_some() {
            out.write_all(b"property double s\nproperty double t\n")?;
        }
        write!(out, "element face {}\nproperty list uchar uint vertex_indices\n", faces.len())?;
        if corner_uv.is_some() {
            out.write_all(b"property list uchar double texcoord\n")?;
        }
        out.write_all(b"end_header\n")?;
        for (v, position) in positions.iter().enumerate() {
            let normal = normals.as_ref().map(|n| n[v]);
            for x in position.iter().chain(normal.iter().flatten()) {
                out.write_all(&x.to_le_bytes())?;
            }
            if let Some(color) = colors.as_ref().map(|c| c[v]) {
                out.write_all(&color.map(|x| (255.0 * x.clamp(0.0, 1.0)).round() as u8))?;
            }
            for x in vertex_uv.iter().flat_map(|uv| uv[v]) {
                out.write_all(&x.to_le_bytes())?;
            }
        }
        for (f, face) in faces.iter().enumerate() {
            out.write_all(&[3])?;
            for v in face {
                out.write_all(&v.to_le_bytes())?;
            }
            if let Some(uv) = corner_uv.map(|uv| uv[f]) {
                out.write_all(&[6])?;
                for x in uv.as_flattened() {
                    out.write_all(&x.to_le_bytes())?;
                }
            }
        }
        Ok(())
    })
}
