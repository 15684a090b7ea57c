//! CSV files: tables of curvatures, places, landmarks and edges that commands read, and the steps of a gradient flow that they write.

use crate::failure::Failure;
use ricci::flow::TraceRow;
use ricci::mesh::{EdgeId, HalfedgeId, Mesh, PerVertex, VertexId};
use std::io::{self, Write};
use std::path::Path;

/// The text of a file, with the file's name in the error. UTF-16, in which spreadsheets save text, is read by its byte order mark.
pub fn read_text(path: &Path) -> Result<String, Failure> {
    let refuse = |why: String| Failure::Input(format!("{}: {why}", path.display()));
    let bytes = std::fs::read(path).map_err(|e| refuse(e.to_string()))?;
    let word: fn([u8; 2]) -> u16 = match bytes[..] {
        [0xff, 0xfe, ..] => u16::from_le_bytes,
        [0xfe, 0xff, ..] => u16::from_be_bytes,
        _ => {
            return String::from_utf8(bytes).map_err(|e| {
                refuse(format!("byte {} is not UTF-8; save it in UTF-8", e.utf8_error().valid_up_to()))
            });
        }
    };
    let words: Vec<u16> = bytes.as_chunks::<2>().0.iter().map(|&pair| word(pair)).collect();
    String::from_utf16(&words).map_err(|e| refuse(format!("{e}; save it in UTF-8")))
}

/// Read `vertex,curvature` rows (radians): each vertex below `n_vertices` and at most once.
///
/// Fields stand between commas, semicolons or tabs, perhaps in quotes; where no comma separates them, one may stand in a number for the
/// point. Empty lines, lines that begin with `#` and a first line `vertex,curvature` are passed over.
pub fn read_curvatures(path: &Path, n_vertices: usize) -> Result<Vec<(VertexId, f64)>, Failure> {
    let mut rows = Vec::new();
    let mut named = vec![false; n_vertices];
    for (i, [vertex, curvature]) in read_rows(path, ["vertex", "curvature"])? {
        let v = vertex_of(path, i, &vertex, n_vertices)?;
        let curvature: f64 = curvature
            .parse()
            .ok()
            .filter(|k: &f64| k.is_finite())
            .ok_or_else(|| refuse(path, i, format!("`{curvature}` is not a curvature in radians")))?;
        if std::mem::replace(&mut named[v.index()], true) {
            return Err(refuse(path, i, format!("vertex {v} is named twice")));
        }
        rows.push((v, curvature));
    }
    Ok(rows)
}

/// Read `vertex,valence` rows: the number of right angles around a cone. Lines as in [`read_curvatures`].
pub fn read_valences(path: &Path, n_vertices: usize) -> Result<Vec<(VertexId, u32)>, Failure> {
    let rows = read_rows(path, ["vertex", "valence"])?;
    let valence = |(i, [vertex, valence]): (usize, [String; 2])| {
        let v = vertex_of(path, i, &vertex, n_vertices)?;
        let number = valence.parse().map_err(|_| refuse(path, i, format!("`{valence}` is no valence")))?;
        Ok((v, number))
    };
    rows.into_iter().map(valence).collect()
}

/// Read `vertex,factor` rows: how much larger lengths near a vertex are to be. Lines as in [`read_curvatures`].
pub fn read_factors(path: &Path, n_vertices: usize) -> Result<Vec<(VertexId, f64)>, Failure> {
    let factor = |(i, [vertex, factor]): (usize, [String; 2])| {
        let v = vertex_of(path, i, &vertex, n_vertices)?;
        let number = factor.parse().ok().filter(|x: &f64| x.is_finite());
        Ok((v, number.ok_or_else(|| refuse(path, i, format!("`{factor}` is no number")))?))
    };
    read_rows(path, ["vertex", "factor"])?.into_iter().map(factor).collect()
}

/// Read `vertex,NAME` rows: a number of vertices, each at most once, and the name where a header has one. Lines as in
/// [`read_curvatures`]; a number may be `nan`.
pub fn read_numbers(
    path: &Path,
    n_vertices: usize,
) -> Result<(Option<String>, Vec<(VertexId, f64)>), Failure> {
    let (mut name, mut rows, mut named) = (None, Vec::new(), vec![false; n_vertices]);
    for (i, [vertex, number]) in read_rows(path, ["vertex", "number"])? {
        if rows.is_empty() && name.is_none() && vertex.eq_ignore_ascii_case("vertex") {
            name = Some(number);
            continue;
        }
        let v = vertex_of(path, i, &vertex, n_vertices)?;
        let number = number.parse().map_err(|_| refuse(path, i, format!("`{number}` is no number")))?;
        if std::mem::replace(&mut named[v.index()], true) {
            return Err(refuse(path, i, format!("vertex {v} is named twice")));
        }
        rows.push((v, number));
    }
    if rows.is_empty() {
        return Err(Failure::Input(format!(
            "{}: no vertex has a number; rows are vertex,number",
            path.display()
        )));
    }
    Ok((name, rows))
}

/// Read `vertex,x,y,z` rows: a direction in space at a vertex. Lines as in [`read_curvatures`].
pub fn read_directions(path: &Path, n_vertices: usize) -> Result<Vec<(VertexId, [f64; 3])>, Failure> {
    let rows = read_rows(path, ["vertex", "x", "y", "z"])?;
    let direction = |(i, [vertex, x, y, z]): (usize, [String; 4])| {
        let v = vertex_of(path, i, &vertex, n_vertices)?;
        let number = |text: &String| text.parse().ok().filter(|x: &f64| x.is_finite());
        match [&x, &y, &z].map(number) {
            [Some(x), Some(y), Some(z)] => Ok((v, [x, y, z])),
            _ => Err(refuse(path, i, format!("`{x},{y},{z}` is no direction"))),
        }
    };
    rows.into_iter().map(direction).collect()
}

/// Read `vertex,x,y` rows: where vertices go, each at most once. Lines as in [`read_curvatures`], but for the names of a header.
pub fn read_places(path: &Path, n_vertices: usize) -> Result<Vec<(VertexId, [f64; 2])>, Failure> {
    let mut named = vec![false; n_vertices];
    let mut rows = Vec::new();
    for (i, [vertex, x, y]) in read_rows(path, ["vertex", "x", "y"])? {
        if rows.is_empty() && vertex.starts_with("vertex") {
            continue;
        }
        let vertex = &vertex[..];
        let v = vertex_of(path, i, vertex, n_vertices)?;
        let number = |text: &str| text.parse().ok().filter(|x: &f64| x.is_finite());
        let (Some(x), Some(y)) = (number(&x), number(&y)) else {
            return Err(refuse(path, i, format!("`{x},{y}` is no point of the plane")));
        };
        if std::mem::replace(&mut named[v.index()], true) {
            return Err(refuse(path, i, format!("vertex {v} is named twice")));
        }
        rows.push((v, [x, y]));
    }
    if rows.is_empty() {
        return Err(Failure::Input(format!("{}: no vertex has a place", path.display())));
    }
    Ok(rows)
}

/// Read `source_vertex,target_vertex` rows: landmarks of two surfaces with so many vertices. Lines as in [`read_curvatures`], but for the
/// names of a header.
pub fn read_landmarks(path: &Path, n_vertices: [usize; 2]) -> Result<Vec<[VertexId; 2]>, Failure> {
    let mut rows = Vec::new();
    for (i, ends) in read_rows(path, ["source_vertex", "target_vertex"])? {
        let [a, b] = [0, 1].map(|k| vertex_of(path, i, &ends[k], n_vertices[k]));
        rows.push([a?, b?]);
    }
    Ok(rows)
}

/// Read `loop,vertex` rows: the vertices of loops, which follow each other; loops by their names, in order. Lines as in
/// [`read_curvatures`], but for the names of a header.
pub fn read_loops(path: &Path, n_vertices: usize) -> Result<Vec<(String, Vec<VertexId>)>, Failure> {
    read_runs(path, "loop", n_vertices)
}

/// [`read_loops`] with another name of the first column.
pub fn read_runs(path: &Path, of: &str, n_vertices: usize) -> Result<Vec<(String, Vec<VertexId>)>, Failure> {
    let mut loops: Vec<(String, Vec<VertexId>)> = Vec::new();
    for (i, [name, vertex]) in read_rows(path, [of, "vertex"])? {
        let v = vertex_of(path, i, &vertex, n_vertices)?;
        match loops.iter_mut().find(|(known, _)| *known == name) {
            Some((_, vertices)) => vertices.push(v),
            None => loops.push((name, vec![v])),
        }
    }
    if loops.is_empty() {
        return Err(Failure::Input(format!("{}: no {of}; rows are {of},vertex", path.display())));
    }
    Ok(loops)
}

/// Read `loop,edge` rows: closed paths, loops numbered from 0 in order, edges from 1 and negative against their direction. Lines as in
/// [`read_curvatures`].
pub fn read_edge_loops(path: &Path, mesh: &Mesh) -> Result<Vec<Vec<HalfedgeId>>, Failure> {
    let mut loops: Vec<Vec<HalfedgeId>> = Vec::new();
    for (i, [number, edge]) in read_rows(path, ["loop", "edge"])? {
        let k = number.trim().parse::<usize>().ok().filter(|&k| k <= loops.len());
        let k = k.ok_or_else(|| refuse(path, i, format!("`{number}` is not the number of the next loop")))?;
        let e = edge
            .trim()
            .parse::<i32>()
            .ok()
            .filter(|e| (1..=mesh.n_edges() as u32).contains(&e.unsigned_abs()));
        let e = e.ok_or_else(|| {
            let most = mesh.n_edges();
            refuse(
                path,
                i,
                format!(
                    "`{edge}` is no edge: edges are numbered 1 to {most}, negative against their direction"
                ),
            )
        })?;
        let h = EdgeId(e.unsigned_abs() - 1).halfedge();
        if k == loops.len() {
            loops.push(Vec::new());
        }
        loops[k].push(if e > 0 { h } else { h.twin() });
    }
    Ok(loops)
}

/// Read `vertex,vertex` rows: the edges of `mesh` between these pairs, each once, ascending. Lines as in [`read_curvatures`].
pub fn read_edges(path: &Path, mesh: &Mesh) -> Result<Vec<EdgeId>, Failure> {
    let mut edges = Vec::new();
    for (i, ends) in read_rows(path, ["vertex", "vertex"])? {
        let [a, b] = ends.map(|v| vertex_of(path, i, &v, mesh.n_vertices()));
        let (a, b) = (a?, b?);
        let before = edges.len();
        edges.extend(mesh.outgoing(a).filter(|&h| mesh.tip(h) == b).map(|h| h.edge()));
        if edges.len() == before {
            return Err(refuse(path, i, format!("there is no edge between the vertices {a} and {b}")));
        }
    }
    edges.sort_unstable();
    edges.dedup();
    Ok(edges)
}

/// What is wrong with a line of a file.
pub fn refuse(path: &Path, line: usize, why: String) -> Failure {
    Failure::Input(format!("{}:{line}: {why}", path.display()))
}

/// Rows of as many fields as there are names, with their line numbers; a first row of the names is left out. The separator is the first
/// of tab, semicolon and comma that divides the first row into so many fields; a line `sep=;` before it names one.
pub fn read_rows<const N: usize>(
    path: &Path,
    names: [&str; N],
) -> Result<Vec<(usize, [String; N])>, Failure> {
    let text = read_text(path)?;
    let mut rows = Vec::new();
    // Spreadsheets write a byte order mark.
    let lines = text.trim_start_matches('\u{feff}').lines().enumerate().map(|(i, l)| (i + 1, l));
    let (mut separator, mut begun) = (None, false);
    for (i, row) in lines.filter(|(_, l)| !l.trim().is_empty() && !l.trim_start().starts_with('#')) {
        if let (false, Some(named)) = (begun, row.strip_prefix("sep=").and_then(|rest| rest.chars().next())) {
            separator = Some(named);
            continue;
        }
        let divides = |&c: &char| fields(row, c).len() == N;
        let by = *separator.get_or_insert_with(|| ['\t', ';', ','].into_iter().find(divides).unwrap_or(','));
        let is_header = !std::mem::replace(&mut begun, true);
        match <[String; N]>::try_from(fields(row, by)) {
            Ok(found) if is_header && found.iter().zip(names).all(|(a, b)| a.eq_ignore_ascii_case(b)) => {}
            Ok(found) => rows.push((i, found.map(|field| with_point(field, by)))),
            Err(_) => return Err(refuse(path, i, format!("`{}` is not `{}`", row.trim(), names.join(",")))),
        }
    }
    Ok(rows)
}

/// The fields of a row, without blanks around them. In quotes a separator belongs to its field, and two quotes are one.
fn fields(row: &str, separator: char) -> Vec<String> {
    let (mut fields, mut field, mut quoted) = (Vec::new(), String::new(), false);
    let mut letters = row.chars().peekable();
    while let Some(c) = letters.next() {
        match c {
            '"' if quoted && letters.peek() == Some(&'"') => field.extend(letters.next()),
            '"' if quoted || field.trim().is_empty() => quoted = !quoted,
            c if c == separator && !quoted => fields.push(std::mem::take(&mut field)),
            c => field.push(c),
        }
    }
    fields.push(field);
    fields.iter().map(|field| field.trim().to_string()).collect()
}

/// A number with a decimal comma, as it is written where fields are not separated by commas, with a point; other fields unchanged.
fn with_point(field: String, separator: char) -> String {
    let is_number = |text: &str| text.parse::<f64>().is_ok();
    match field.split_once(',') {
        Some((whole, rest)) if separator != ',' && is_number(&format!("{whole}.{rest}")) => {
            format!("{whole}.{rest}")
        }
        _ => field,
    }
}

fn vertex_of(path: &Path, line: usize, text: &str, n_vertices: usize) -> Result<VertexId, Failure> {
    let v: usize =
        text.parse().map_err(|_| refuse(path, line, format!("`{text}` is not a vertex number")))?;
    if v >= n_vertices {
        let last = n_vertices.saturating_sub(1);
        let why = format!("vertex {v} does not exist: vertices are numbered from 0, these are 0 to {last}");
        return Err(refuse(path, line, why));
    }
    Ok(VertexId::from(v))
}

/// Read a curvature for every vertex.
pub fn read_all_curvatures(path: &Path, n_vertices: usize) -> Result<PerVertex<f64>, Failure> {
    let mut curvature = PerVertex::filled(n_vertices, f64::NAN);
    for (v, k) in read_curvatures(path, n_vertices)? {
        curvature[v] = k;
    }
    match curvature.iter().position(|k| k.is_nan()) {
        None => Ok(curvature),
        Some(v) => Err(Failure::Input(format!(
            "{}: vertex {v} is missing; `file:` needs every vertex, `cones:` takes the missing ones as 0",
            path.display()
        ))),
    }
}

/// Write the steps of a gradient flow.
pub fn write_trace(out: &mut impl Write, trace: &[TraceRow]) -> io::Result<()> {
    writeln!(out, "step,energy,max_curvature_error,area,step_size")?;
    for row in trace {
        let TraceRow { step, energy, max_curvature_error, area, step_size } = row;
        writeln!(out, "{step},{energy:e},{max_curvature_error:e},{area:e},{step_size:e}")?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, n: usize) -> Result<Vec<(VertexId, f64)>, String> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        read_curvatures(file.path(), n).map_err(|e| e.to_string())
    }

    #[test]
    fn rows_comments_and_header_are_understood() {
        let rows = read("# cones\nvertex,curvature\n\n3, 1.5\r\n0,-2e-1\n", 4).unwrap();
        assert_eq!(rows, [(VertexId(3), 1.5), (VertexId(0), -0.2)]);
    }

    #[test]
    fn separators_quotes_and_decimal_commas_are_found() {
        let expected = [(VertexId(3), 1.5), (VertexId(0), -0.25)];
        for text in [
            "3;1,5\r\n0;-0,25\r\n",
            "3;1.5\n0;-0.25\n",
            "vertex\tcurvature\n3\t1.5\n0\t-2,5e-1\n",
            "\u{feff}\"Vertex\",\"Curvature\"\n\"3\",\"1.5\"\n\"0\" , -0.25\n",
            "sep=;\n\"3\";\"1,5\"\n0;-0,25\n",
        ] {
            assert_eq!(read(text, 4).unwrap(), expected, "{text}");
        }
        let file = tempfile::NamedTempFile::new().unwrap();
        let wide = "\u{feff}3\t1,5\n".encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<u8>>();
        std::fs::write(file.path(), wide).unwrap();
        assert_eq!(read_curvatures(file.path(), 4).unwrap(), [(VertexId(3), 1.5)]);
        assert_eq!(fields("a;\"b;\"\"c\"\"\";d", ';'), ["a", "b;\"c\"", "d"]);
    }

    #[test]
    fn a_bad_row_is_named_by_its_line() {
        for (text, line) in [
            ("1,1\n4,1\n", ":2: vertex 4 does not exist"),
            ("1,1\n1,2\n", ":2: vertex 1 is named twice"),
            ("0,NaN\n", ":1: `NaN`"),
            ("\n-1,0\n", ":2: `-1`"),
            ("0|1\n", ":1: `0|1`"),
            ("0;1\n0;1;2\n", ":2: `0;1;2`"),
            ("0,1,5\n", ":1: `0,1,5`"),
        ] {
            let message = read(text, 4).unwrap_err();
            assert!(message.contains(line), "{message}");
        }
    }

    #[test]
    fn a_full_target_names_every_vertex() {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), "0,1\n2,1\n").unwrap();
        let message = read_all_curvatures(file.path(), 3).unwrap_err().to_string();
        assert!(message.contains("vertex 1 is missing"), "{message}");
    }
}
