//! Reader and writer of PLY, ascii and both binary byte orders. The reader accepts numbers, names and blank lines of existing files that
//! the grammars of the PLY crates refuse, and its errors give the line or the byte. The format is Greg Turk's,
//! <https://paulbourke.net/dataformats/ply/>.

mod body;
mod header;
mod numbers;
mod write;

pub use write::write_ply;

use super::budget::Budget;
use super::polygon::Polygons;
use super::scan::{Location, Quoted};
use super::{Attributes, NumberColumn, Soup};
use crate::error::Result;
use crate::mesh::Point;
use crate::mesh::incidence::distinct;
use body::{PlyBody, PlyRow};
use header::{PlyElement, header};
use numbers::OwnColumns;

/// Parses a PLY file: elements `vertex` (x, y, z; nx, ny, nz; red, green, blue, alpha, also as diffuse_red, …; s, t or u, v or texture_u,
/// texture_v), `face` (vertex_indices or vertex_index, texcoord) and `tristrips`; other numbers of vertices and faces are kept under
/// their names, everything else is skipped and named in [`Attributes::unread`]. `path` is used in errors.
///
/// Integer colours are divided by the largest value of their type (by 255 from 32 bits on).
///
/// # Errors
///
/// [`crate::Error::Parse`] with the line or byte.
pub fn parse_ply(bytes: &[u8], path: &str) -> Result<Soup> {
    let header = header(bytes, path)?;
    let Some(vertex) = header.elements.iter().find(|e| e.name == b"vertex") else {
        return Location::line(path, header.line - 1).error("the header has no element `vertex`".into());
    };
    let mut unread: Vec<String> =
        header.pictures.iter().map(|name| format!("picture {name} of the texture")).collect();
    let mut vertices = VertexColumns::new(vertex, path, &mut unread)?;
    let mut faces = FaceRows::default();
    let mut budget = Budget::of(bytes);
    let mut body = PlyBody::new(bytes, &header, path);
    for element in &header.elements {
        match element.name {
            b"vertex" => body.each(element, &[], |_, row, _| {
                vertices.push(row);
                Ok(())
            })?,
            b"face" => {
                let lists = [corners_of(element, path)?, element.list(&["texcoord"])];
                let read: Vec<usize> = lists.into_iter().flatten().collect();
                faces.own = OwnColumns::new(element, &read, &mut unread);
                body.each(element, &lists, |f, row, place| faces.push(f, row, place))?;
            }
            b"tristrips" => {
                let lists = [corners_of(element, path)?];
                body.each(element, &lists, |f, row, place| {
                    // A triangle for each corner, which may take a byte.
                    budget.take(row.lists[0].len(), size_of::<([u32; 3], usize)>(), "strips", place)?;
                    strips(&row.lists[0], f, place, &mut faces.polygons)
                })?;
            }
            _ => {
                if element.count > 0 && !element.properties.is_empty() {
                    let name = String::from_utf8_lossy(element.name);
                    unread.push(format!("element {} of {} rows", Quoted(&name), element.count));
                }
                body.skip(element)?;
            }
        }
    }
    let triangles = faces.polygons.triangles(&vertices.positions, &mut budget, Location::whole(path))?;
    let face_numbers = faces.numbers(&triangles, &mut budget, Location::whole(path))?;
    let mut soup = vertices.soup(&faces.polygons, &triangles, &faces.corner_uv);
    soup.attributes.face_numbers = face_numbers;
    soup.attributes.unread.extend(unread);
    Ok(soup)
}

/// The rows of the element `face` that have been read.
#[derive(Default)]
struct FaceRows {
    polygons: Polygons,
    corner_uv: Vec<[f64; 2]>,
    own: OwnColumns,
}

impl FaceRows {
    fn push(&mut self, f: usize, row: &PlyRow, place: Location<'_>) -> Result<()> {
        for &v in &row.lists[0] {
            self.polygons.corners.push(place.vertex(v, format_args!("face {f}"))?);
        }
        if row.lists[1].len() == 2 * row.lists[0].len() {
            self.corner_uv.extend(row.lists[1].chunks_exact(2).map(|uv| [uv[0], uv[1]]));
        }
        self.own.push(row);
        self.polygons.end();
        Ok(())
    }

    /// The numbers of the triangles: those of the polygons that they are parts of. Triangles of strips have none.
    fn numbers(
        &mut self,
        triangles: &[[usize; 3]],
        budget: &mut Budget,
        place: Location<'_>,
    ) -> Result<Vec<NumberColumn>> {
        let columns = std::mem::take(&mut self.own.columns);
        budget.take(
            columns.len().saturating_mul(triangles.len()),
            size_of::<f64>(),
            "numbers of faces",
            place,
        )?;
        let owners: Vec<u32> = self.polygons.owners(triangles).map(|polygon| polygon as u32).collect();
        Ok(columns.iter().map(|column| column.of_origins(&owners)).collect())
    }
}

/// The list of corners in the rows of an element, if it has rows.
fn corners_of(element: &PlyElement<'_>, path: &str) -> Result<Option<usize>> {
    match element.list(&["vertex_indices", "vertex_index"]) {
        None if element.count > 0 => element.place(path).error(format!(
            "element `{}` has no list property `vertex_indices`",
            String::from_utf8_lossy(element.name)
        )),
        list => Ok(list),
    }
}

/// The columns and values of the element `vertex` that have been read.
struct VertexColumns {
    /// The indices of the properties of each attribute.
    position: [usize; 3],
    normal: Option<[usize; 3]>,
    color: Option<[usize; 3]>,
    opacity: Option<[usize; 1]>,
    texture: Option<[usize; 2]>,
    /// For each property, the value of a colour of full strength.
    full: Vec<f64>,
    positions: Vec<Point>,
    normals: Vec<Point>,
    colors: Vec<[f64; 4]>,
    uv: Vec<[f64; 2]>,
    own: OwnColumns,
}

/// The properties with these names, of the first alternative that exists completely.
fn columns<const N: usize>(element: &PlyElement<'_>, alternatives: &[[&str; N]]) -> Option<[usize; N]> {
    alternatives.iter().find_map(|names| {
        let mut columns = [0; N];
        for (column, name) in columns.iter_mut().zip(names) {
            *column = element.column(name)?;
        }
        Some(columns)
    })
}

impl VertexColumns {
    fn new(element: &PlyElement<'_>, path: &str, unread: &mut Vec<String>) -> Result<VertexColumns> {
        let Some(position) = columns(element, &[["x", "y", "z"]]) else {
            let missing = ["x", "y", "z"].into_iter().find(|name| element.column(name).is_none());
            let missing = missing.unwrap_or_default();
            return element.place(path).error(format!("element `vertex` has no property `{missing}`"));
        };
        let normal = columns(element, &[["nx", "ny", "nz"]]);
        let rgb = [["red", "green", "blue"], ["diffuse_red", "diffuse_green", "diffuse_blue"]];
        let color = columns(element, &rgb);
        let opacity = columns(element, &[["alpha"], ["diffuse_alpha"]]).filter(|_| color.is_some());
        let texture = columns(element, &[["s", "t"], ["u", "v"], ["texture_u", "texture_v"]]);
        let read =
            position.into_iter().chain(normal.into_iter().flatten()).chain(color.into_iter().flatten());
        let read = read.chain(opacity.into_iter().flatten()).chain(texture.into_iter().flatten());
        Ok(VertexColumns {
            own: OwnColumns::new(element, &read.collect::<Vec<_>>(), unread),
            position,
            normal,
            color,
            opacity,
            texture,
            full: element.properties.iter().map(|p| p.kind.full()).collect(),
            positions: Vec::new(),
            normals: Vec::new(),
            colors: Vec::new(),
            uv: Vec::new(),
        })
    }

    fn push(&mut self, row: &PlyRow) {
        let value = |k: usize| row.numbers[k];
        let color = |k: usize| row.numbers[k] / self.full[k];
        self.own.push(row);
        self.positions.push(self.position.map(value));
        self.normals.extend(self.normal.map(|columns| columns.map(value)));
        self.uv.extend(self.texture.map(|columns| columns.map(value)));
        if let Some(rgb) = self.color {
            let [r, g, b] = rgb.map(color);
            self.colors.push([r, g, b, self.opacity.map_or(1.0, |[a]| color(a))]);
        }
    }

    fn soup(self, polygons: &Polygons, triangles: &[[usize; 3]], corner_uv: &[[f64; 2]]) -> Soup {
        let uv = if corner_uv.len() == polygons.corners.len() && !corner_uv.is_empty() {
            Some(triangles.iter().map(|t| t.map(|k| corner_uv[k])).collect())
        } else {
            let at = |v: u32| self.uv.get(v as usize).copied().unwrap_or_default();
            self.texture.map(|_| triangles.iter().map(|&t| polygons.face(t).map(at)).collect())
        };
        let attributes = Attributes {
            normals: self.normal.map(|_| self.normals),
            colors: self.color.map(|_| self.colors),
            uv,
            vertex_numbers: self.own.columns,
            ..Attributes::default()
        };
        let faces = polygons.faces(triangles);
        Soup { positions: self.positions, faces, attributes: attributes.finite_only() }
    }
}

/// Adds the triangles of the strips of one list, separated by −1; every other triangle of a strip is turned around.
fn strips(list: &[f64], row: usize, place: Location<'_>, polygons: &mut Polygons) -> Result<()> {
    for strip in list.split(|&v| v == -1.0) {
        let vertex = |v: f64| place.vertex(v, format_args!("face {row}"));
        for (k, w) in strip.windows(3).enumerate() {
            let mut face = [vertex(w[0])?, vertex(w[1])?, vertex(w[2])?];
            if k % 2 == 1 {
                face.swap(0, 1);
            }
            // A repeated vertex joins strips together.
            if distinct(&face) {
                polygons.push(face);
            }
        }
    }
    Ok(())
}
