//! Finer triangle lists of the same surface in space, with the place of each vertex and face in the given one.
//!
//! ```
//! use ricci::control::Control;
//! use ricci::mesh::{refine::{Refine, refine}, shapes};
//! let torus = shapes::torus(2.0, 1.0, 12, 6)?;
//! let finer = refine(&torus, &Refine { levels: 1, ..Refine::default() }, &Control::new())?;
//! assert_eq!(finer.soup.faces.len(), 4 * torus.faces.len());
//! let short = refine(&torus, &Refine { longest_edge: Some(0.25), ..Refine::default() }, &Control::new())?;
//! assert!(short.longest_edge() <= 0.25);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::ids::FaceId;
use super::io::{Attributes, NumberColumn, Soup};
use super::place::Place;
use crate::control::{Control, Stage};
use crate::error::{Error, Result};
use crate::geometry::vector::{distance, norm, triangle_normal};
use std::collections::HashMap;

/// Options of [`refine()`]; by default the list stays as it is. Both may be asked for: the levels come first.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Refine {
    /// The number of times that every face is cut into four by the midpoints of its sides. Default 0.
    pub levels: usize,
    /// The length above which no edge is left: longer ones are halved, round by round. Default none.
    pub longest_edge: Option<f64>,
}

/// A refined triangle list, with the places of its elements in the given one.
#[derive(Debug, Clone, PartialEq)]
pub struct RefinedSoup {
    /// The list: the given vertices first, in order. The parts of a face follow each other, and parts keep the order of the faces.
    pub soup: Soup,
    /// For each face the given face that it is a part of.
    pub face_origin: Vec<u32>,
    /// For each vertex its place in the given faces; none for a vertex that no face uses.
    pub vertex_place: Vec<Option<Place>>,
}

/// Faces that are cut between two looks at the control.
const FACES_PER_CHECK: usize = 1 << 12;
/// Most faces of a refined list. About 10 GB hold them while they are made, and no other command takes more.
const MOST_FACES: usize = 1 << 26;

impl RefinedSoup {
    /// Length of the longest edge, 0 without faces.
    pub fn longest_edge(&self) -> f64 {
        longest_edge(&self.soup)
    }
}

/// Length of the longest edge of a triangle list whose corners name vertices, 0 without faces.
pub fn longest_edge(soup: &Soup) -> f64 {
    let at = |v: u32| soup.positions[v as usize];
    let sides = |f: &[u32; 3]| [0, 1, 2].map(|k| distance(at(f[k]), at(f[(k + 1) % 3])));
    soup.faces.iter().flat_map(sides).fold(0.0, f64::max)
}

/// Halves edges at their midpoints. The faces beside them are cut by straight lines: one midpoint is joined to the opposite corner, two
/// with each other and by the shorter diagonal, three with each other. So the surface stays the same set of points, edges that two faces
/// share stay shared, and the result depends on the list alone.
///
/// Every line that cuts a face is at most √3/2 as long as its longest side or no longer than `longest_edge`, so the rounds end. Normals
/// and colours of vertices are means of those of the edge's ends, values at corners and further numbers are linear in each given face; labels
/// and numbers of faces stay with their parts.
///
/// # Errors
/// [`Error::Argument`] for a length that is not positive, coordinates or attributes that are not finite, and faces that name a missing
/// vertex or one vertex twice, and a result of more than 67 million faces; [`Error::Cancelled`].
pub fn refine(soup: &Soup, options: &Refine, control: &Control) -> Result<RefinedSoup> {
    least_faces(soup, options)?;
    if let Some(f) = soup.faces.iter().position(|&[a, b, c]| a == b || b == c || c == a) {
        let need = "three different vertices: `ricci repair` drops faces that use one twice";
        return Err(Error::argument("face to refine", f, need));
    }
    let mut parts = FaceParts::new(soup);
    for level in 0..options.levels {
        // Each level takes four times as long as the one before.
        control.step(Stage::Build, 0.25f64.powi((options.levels - level).try_into().unwrap_or(i32::MAX)))?;
        parts.halve(|_, _| true, control)?;
    }
    if let Some(longest) = options.longest_edge {
        while parts.halve(|a, b| distance(a, b) > longest, control)? {}
    }
    control.check()?;
    Ok(parts.finish(soup))
}

fn too_many(faces: usize) -> Error {
    let need = "at most 67 million: ask for fewer levels or longer edges";
    Error::argument("number of faces of the refined surface", faces, need)
}

/// A number of faces that the refined list has at least: by its levels, or the area and the longest side of each given face.
///
/// # Errors
/// [`Error::Argument`] for a longest edge that is no length, for coordinates or attributes that are not finite and faces that name a missing
/// vertex, and for more than 67 million faces, before memory is taken for them.
pub fn least_faces(soup: &Soup, options: &Refine) -> Result<usize> {
    soup.check_writable()?;
    let four = 4usize.saturating_pow(options.levels.try_into().unwrap_or(u32::MAX));
    let by_levels = soup.faces.len().saturating_mul(four);
    if by_levels > MOST_FACES {
        return Err(too_many(by_levels));
    }
    let Some(longest) = options.longest_edge else { return Ok(by_levels) };
    if !(longest > 0.0 && longest.is_finite()) {
        return Err(Error::argument("longest edge", longest, "a finite length greater than 0"));
    }
    // The area of a triangle with sides of this length bounds that of every part, and each part of a side belongs to another face.
    let largest = 0.25 * 3f64.sqrt() * longest * longest;
    let parts = |f: &[u32; 3]| {
        let [a, b, c] = f.map(|v| soup.positions[v as usize]);
        let side = distance(a, b).max(distance(b, c)).max(distance(c, a));
        (0.5 * norm(triangle_normal([a, b, c])) / largest).max((side / longest).ceil())
    };
    let least = soup.faces.iter().map(parts).sum::<f64>();
    if least > MOST_FACES as f64 { Err(too_many(least as usize)) } else { Ok(by_levels.max(least as usize)) }
}

/// A point of the list: its vertex, and its weights in the given face.
type PartCorner = (u32, [f64; 3]);

/// The parts of the given faces so far.
struct FaceParts {
    soup: Soup,
    /// Per part its given face, and the weights of its corners there.
    origin: Vec<u32>,
    corners: Vec<[[f64; 3]; 3]>,
}

impl FaceParts {
    fn new(given: &Soup) -> FaceParts {
        let n = given.faces.len();
        let Attributes { normals, colors, .. } = &given.attributes;
        let attributes =
            Attributes { normals: normals.clone(), colors: colors.clone(), ..Attributes::default() };
        let soup = Soup { positions: given.positions.clone(), faces: given.faces.clone(), attributes };
        let whole = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        FaceParts { soup, origin: (0..n as u32).collect(), corners: vec![whole; n] }
    }

    /// Halve, once, the edges for whose ends `is_long` is true; false if there are none.
    fn halve(&mut self, is_long: impl Fn([f64; 3], [f64; 3]) -> bool, control: &Control) -> Result<bool> {
        let mut steps = 0;
        let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
        let faces = std::mem::take(&mut self.soup.faces);
        let mut marks = Vec::with_capacity(faces.len());
        let mut n_faces = faces.len();
        for face in &faces {
            control.check_every(FACES_PER_CHECK, &mut steps)?;
            let sides = [0, 1, 2].map(|k| [face[k], face[(k + 1) % 3]]);
            let at = |v: u32| self.soup.positions[v as usize];
            let mark = sides.map(|[a, b]| is_long(at(a.min(b)), at(a.max(b))));
            n_faces += mark.iter().filter(|&&is_marked| is_marked).count();
            marks.push(mark);
        }
        if n_faces > MOST_FACES {
            return Err(too_many(n_faces));
        }
        if n_faces == faces.len() {
            self.soup.faces = faces;
            return Ok(false);
        }
        let origin = std::mem::take(&mut self.origin);
        let corners = std::mem::take(&mut self.corners);
        for (f, face) in faces.iter().enumerate() {
            control.check_every(FACES_PER_CHECK, &mut steps)?;
            let corner = [0, 1, 2].map(|k| (face[k], corners[f][k]));
            let middle = [0, 1, 2].map(|k| {
                let [(a, p), (b, q)] = [corner[k], corner[(k + 1) % 3]];
                marks[f][k].then(|| {
                    let v = *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| self.add_middle([a, b]));
                    (v, [0, 1, 2].map(|k| 0.5 * p[k] + 0.5 * q[k]))
                })
            });
            self.cut(origin[f], corner, middle);
        }
        Ok(true)
    }

    /// Add the midpoint of two vertices.
    fn add_middle(&mut self, ends: [u32; 2]) -> u32 {
        let [a, b] = ends.map(|v| v as usize);
        let Soup { positions, attributes, .. } = &mut self.soup;
        positions.push(mean(positions[a], positions[b]));
        if let Some(normals) = &mut attributes.normals {
            normals.push(mean(normals[a], normals[b]));
        }
        if let Some(colors) = &mut attributes.colors {
            colors.push(mean(colors[a], colors[b]));
        }
        positions.len() as u32 - 1
    }

    /// Add the parts of a face with these corners, some of whose sides (from corner k to corner k + 1) have a midpoint.
    fn cut(&mut self, origin: u32, corner: [PartCorner; 3], middle: [Option<PartCorner>; 3]) {
        let from = |k: usize| [0, 1, 2].map(|turn| (corner[(k + turn) % 3], middle[(k + turn) % 3]));
        let start = match middle {
            // The face is turned until the first side alone is halved, or the last side alone is not.
            [None, Some(_), None] | [None, Some(_), Some(_)] => 1,
            [None, None, Some(_)] | [Some(_), None, Some(_)] => 2,
            _ => 0,
        };
        let [(a, ab), (b, bc), (c, ca)] = from(start);
        match (ab, bc, ca) {
            (Some(m), Some(n), Some(l)) => {
                for part in [[a, m, l], [m, b, n], [l, n, c], [m, n, l]] {
                    self.add_part(origin, part);
                }
            }
            (Some(m), Some(n), None) => {
                let at = |p: PartCorner| self.soup.positions[p.0 as usize];
                let halves = if distance(at(m), at(c)) <= distance(at(a), at(n)) {
                    [[a, m, c], [m, n, c]]
                } else {
                    [[a, m, n], [a, n, c]]
                };
                self.add_part(origin, [m, b, n]);
                halves.into_iter().for_each(|part| self.add_part(origin, part));
            }
            (Some(m), None, None) => {
                [[a, m, c], [m, b, c]].into_iter().for_each(|part| self.add_part(origin, part));
            }
            _ => self.add_part(origin, corner),
        }
    }

    fn add_part(&mut self, origin: u32, corners: [PartCorner; 3]) {
        self.soup.faces.push(corners.map(|(v, _)| v));
        self.origin.push(origin);
        self.corners.push(corners.map(|(_, weights)| weights));
    }

    /// The list with the places of its vertices, and with the values at the corners of the given faces.
    fn finish(mut self, given: &Soup) -> RefinedSoup {
        let mut vertex_place = vec![None; self.soup.positions.len()];
        for (f, face) in self.soup.faces.iter().enumerate() {
            for (&v, &weights) in face.iter().zip(&self.corners[f]) {
                let place = &mut vertex_place[v as usize];
                place.get_or_insert(Place { face: FaceId(self.origin[f]), weights });
            }
        }
        let Attributes { corner_normals, uv, labels, vertex_numbers, face_numbers, unread, .. } =
            &given.attributes;
        self.soup.attributes.labels =
            labels.as_ref().map(|labels| labels.of_origins(self.origin.iter().copied()));
        self.soup.attributes.face_numbers =
            face_numbers.iter().map(|column| column.of_origins(&self.origin)).collect();
        self.soup.attributes.vertex_numbers =
            vertex_numbers.iter().map(|column| at_places(column, &vertex_place, &given.faces)).collect();
        self.soup.attributes.unread.clone_from(unread);
        self.soup.attributes.corner_normals = corner_normals.as_ref().map(|values| self.at_corners(values));
        self.soup.attributes.uv = uv.as_ref().map(|values| self.at_corners(values));
        RefinedSoup { soup: self.soup, face_origin: self.origin, vertex_place }
    }

    /// Values at the corners of the given faces, at those of the parts.
    fn at_corners<const N: usize>(&self, values: &[[[f64; N]; 3]]) -> Vec<[[f64; N]; 3]> {
        let linear = |of: &[[f64; N]; 3], w: [f64; 3]| -> [f64; N] {
            std::array::from_fn(|k| w[0] * of[0][k] + w[1] * of[1][k] + w[2] * of[2][k])
        };
        let of_part = |(&f, corners): (&u32, &[[f64; 3]; 3])| corners.map(|w| linear(&values[f as usize], w));
        self.origin.iter().zip(&self.corners).map(of_part).collect()
    }
}

/// The numbers of the given vertices at places in their faces: linear in each face, or where they are integers, which may be labels, that of
/// the nearest corner. Vertices without a face come first in order, as they were given.
fn at_places(column: &NumberColumn, places: &[Option<Place>], faces: &[[u32; 3]]) -> NumberColumn {
    let number = |(v, place): (usize, &Option<Place>)| {
        let Some(Place { face, weights }) = place else { return column.values[v] };
        let corners = faces[face.index()].map(|v| column.values[v as usize]);
        if column.kind.is_integer() {
            let nearest = (0..3).max_by(|&i, &j| weights[i].total_cmp(&weights[j])).unwrap_or(0);
            return corners[nearest];
        }
        // A corner that has no share may hold a number that is not finite.
        (0..3).filter(|&k| weights[k] != 0.0).map(|k| weights[k] * corners[k]).sum()
    };
    let values = places.iter().enumerate().map(number).collect();
    NumberColumn { name: column.name.clone(), kind: column.kind, values }
}

fn mean<const N: usize>(a: [f64; N], b: [f64; N]) -> [f64; N] {
    std::array::from_fn(|k| 0.5 * a[k] + 0.5 * b[k])
}
