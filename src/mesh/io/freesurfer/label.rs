//! Labels: a set of vertices, with their places and a value each.

use crate::error::{Error, Result};
use crate::mesh::Point;
use crate::mesh::io::scan::{Location, lines, words};
use crate::mesh::io::shortest::Shortest;

/// A set of vertices of a surface.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct VertexLabel {
    /// The first line, without its `#`.
    pub comment: String,
    /// The vertices; `None` for a point of the volume that belongs to none.
    pub vertices: Vec<Option<u32>>,
    /// Their places.
    pub positions: Vec<Point>,
    /// Their values, such as probabilities.
    pub values: Vec<f64>,
}

/// Parses a label: a comment, the number of vertices, then `vertex x y z value` per line. `path` is used in errors.
///
/// # Errors
/// [`Error::Parse`] with the line.
pub fn parse_label(text: &str, path: &str) -> Result<VertexLabel> {
    let mut found = VertexLabel::default();
    let mut rest = lines(text).filter(|(_, line)| !line.is_empty()).peekable();
    if let Some((_, line)) = rest.next_if(|(_, line)| line.starts_with('#')) {
        found.comment = line[1..].trim().into();
    }
    let Some((line, text)) = rest.next() else {
        return Location::whole(path).error("the label has no number of vertices".into());
    };
    let n = Location::line(path, line).count(words(text).next(), format_args!("number of vertices"))?;
    for k in 0..n {
        let Some((line, text)) = rest.next() else {
            return Location::whole(path).error(format!("the label ends after {k} of {n} vertices"));
        };
        let (place, mut words) = (Location::line(path, line), words(text));
        let mut numbers = [0.0; 5];
        for (x, what) in numbers.iter_mut().zip(["vertex", "x", "y", "z", "value"]) {
            *x = place.number(words.next(), format_args!("{what} of row {k}"))?;
        }
        let [v, x, y, z, value] = numbers;
        let vertex = if v == -1.0 { None } else { Some(place.vertex(v, format_args!("row {k}"))?) };
        found.vertices.push(vertex);
        found.positions.push([x, y, z]);
        found.values.push(value);
    }
    match rest.next() {
        Some((line, _)) => {
            Location::line(path, line).error(format!("a line follows the {n} vertices of the label"))
        }
        None => Ok(found),
    }
}

/// The text of a label.
///
/// # Errors
/// [`Error::Size`] unless each vertex has a place and a value; [`Error::Argument`] for a comment of several lines and numbers that are not finite.
pub fn label_text(label: &VertexLabel) -> Result<String> {
    let VertexLabel { comment, vertices, positions, values } = label;
    crate::error::check_size("positions", positions.len(), vertices.len())?;
    crate::error::check_size("values", values.len(), vertices.len())?;
    if comment.contains(['\n', '\r']) {
        return Err(Error::argument("comment", format!("{comment:?}"), "a single line"));
    }
    let numbers = positions.as_flattened().iter().chain(values);
    if let Some(x) = numbers.into_iter().find(|x| !x.is_finite()) {
        return Err(Error::argument("number of a label", x, "finite"));
    }
    let mut text = format!("#{comment}\n{}\n", vertices.len());
    for ((vertex, [x, y, z]), value) in vertices.iter().zip(positions).zip(values) {
        let vertex = vertex.map_or(-1, i64::from);
        let [x, y, z, value] = [*x, *y, *z, *value].map(Shortest);
        text += &format!("{vertex} {x} {y} {z} {value}\n");
    }
    Ok(text)
}
