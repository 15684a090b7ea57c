//! The cases of `tests/vectors`: reading them, their seals, their surfaces, and how a result is held against one.

use crate::common::hex;
use ricci::geometry::Space;
use ricci::mesh::{Mesh, PerEdge, Point, shapes};
use ricci::metric::Scheme;
use ricci::{Class, Surface};
use serde_json::Value;
use std::path::PathBuf;

/// Quantities with their numbers.
pub type Found = Vec<(&'static str, Vec<f64>)>;

pub struct Case {
    /// File and name.
    pub name: String,
    pub json: Value,
    intact: bool,
}

/// The folder of the files: that of the repository, or `RICCI_VECTORS`.
fn folder() -> PathBuf {
    std::env::var_os("RICCI_VECTORS")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/vectors"), PathBuf::from)
}

/// The seal of a case: FNV-1a of the text before it.
fn sealed(line: &str) -> bool {
    let (text, rest) = line.split_once(",\"seal\":\"").unwrap();
    let value = text
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325_u64, |v, byte| (v ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
    rest.starts_with(&format!("{value:016x}"))
}

/// All cases, in the order of the files' names.
pub fn all() -> Vec<Case> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder()).unwrap().map(|f| f.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|e| e == "json"));
    files.sort();
    let mut cases = Vec::new();
    for path in files {
        let text = std::fs::read_to_string(&path).unwrap();
        let stem = path.file_stem().unwrap().to_str().unwrap();
        for line in text.lines().filter(|line| line.starts_with("{\"name\"")) {
            let json: Value = serde_json::from_str(line.trim_end_matches(',')).unwrap();
            assert!(!json["because"].as_str().unwrap().is_empty());
            let name = format!("{stem}/{}", json["name"].as_str().unwrap());
            cases.push(Case { name, intact: sealed(line), json });
        }
    }
    cases
}

impl Case {
    pub fn call(&self) -> &str {
        self.json["call"].as_str().unwrap()
    }

    pub fn option(&self, key: &str) -> &Value {
        &self.json["options"][key]
    }

    pub fn numbers(&self, key: &str) -> Vec<f64> {
        numbers(self.option(key))
    }

    pub fn indices(&self, key: &str) -> Vec<u32> {
        indices(self.option(key))
    }

    pub fn text(&self, key: &str) -> &str {
        self.option(key).as_str().unwrap()
    }

    pub fn space(&self) -> Space {
        space(self.text("space"))
    }

    pub fn scheme(&self) -> Scheme {
        self.text("scheme").parse().unwrap()
    }

    pub fn class(&self) -> Class {
        Class::new(self.scheme(), self.space())
    }

    /// The surface under this key.
    pub fn surface(&self, key: &str) -> Surface {
        surface(&self.json[key])
    }

    /// A line for each quantity that does not agree.
    pub fn failures(&self, found: impl FnOnce(&Case) -> Option<Found>) -> Vec<String> {
        if !self.intact {
            return vec![format!("FAILED {}: what is written is not what was sealed", self.name)];
        }
        let Some(found) = found(self) else { return vec![] };
        let mut failures = Vec::new();
        for (quantity, expected) in self.json["expect"].as_object().unwrap() {
            let (exact, tolerance) = (numbers(&expected["values"]), expected["tolerance"].as_f64().unwrap());
            let ours = found.iter().find(|(name, _)| name == quantity).map_or(&[][..], |(_, x)| x);
            // Single triangles are of any size: relative.
            let relative = matches!(self.call(), "triangle" | "circle_pattern");
            let largest = exact.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            let scale = |x: f64| match relative {
                // Between circles that do not meet at right angles or less a weight can vanish by cancellation.
                true if quantity == "weights" && self.numbers("eta").iter().any(|e| *e > 1.0) => largest,
                true => x.abs(),
                false => 1.0,
            };
            let error = if ours.len() == exact.len() {
                ours.iter().zip(&exact).fold(0.0f64, |m, (a, b)| {
                    let off = (a - b).abs() / scale(*b);
                    if off.is_nan() { f64::INFINITY } else { m.max(off) }
                })
            } else {
                f64::INFINITY
            };
            if error > tolerance {
                failures.push(format!(
                    "FAILED {}: {quantity} (off by {error:.2e}, {tolerance:.2e} is allowed)",
                    self.name
                ));
            }
        }
        failures
    }
}

pub fn space(name: &str) -> Space {
    [Space::E2, Space::H2, Space::S2].into_iter().find(|s| s.name() == name).unwrap()
}

pub fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().unwrap().iter().map(|x| hex(x.as_str().unwrap())).collect()
}

pub fn indices(list: &Value) -> Vec<u32> {
    list.as_array().unwrap().iter().map(|x| x.as_u64().unwrap() as u32).collect()
}

pub fn points(list: &Value) -> Vec<Point> {
    numbers(list).as_chunks().0.to_vec()
}

fn surface(given: &Value) -> Surface {
    let whole = |key: &str| given[key].as_u64().unwrap() as usize;
    let size = |key: &str| hex(given[key].as_str().unwrap());
    match given["shape"].as_str() {
        Some("two_vertex") => {
            let shape = shapes::two_vertex(whole("genus")).unwrap();
            let (mesh, lengths) = shape.build().unwrap();
            return Surface::intrinsic(mesh, lengths, shape.geometry).unwrap();
        }
        Some(_) => {
            let soup = shapes::torus(size("a"), size("b"), whole("n"), whole("m")).unwrap();
            return Surface::from_soup(&soup).unwrap();
        }
        None => {}
    }
    let faces: Vec<[u32; 3]> = indices(&given["faces"]).as_chunks().0.to_vec();
    if given.get("positions").is_some() {
        let positions = points(&given["positions"]);
        let mesh = Mesh::from_faces(positions.len(), &faces).unwrap();
        return Surface::in_space(mesh, positions).unwrap();
    }
    let edges: Vec<i32> =
        given["face_edges"].as_array().unwrap().iter().map(|x| x.as_i64().unwrap() as i32).collect();
    let mesh = Mesh::from_gluing(whole("n_vertices"), &faces, edges.as_chunks().0).unwrap();
    let lengths = PerEdge::from(numbers(&given["lengths"]));
    Surface::intrinsic(mesh, lengths, space(given["geometry"].as_str().unwrap())).unwrap()
}
