//! Any triangle list as sheets: connected pieces that are surfaces, opened where the list is none.
//!
//! Nothing is refused. Faces are turned until neighbours agree, the fewer of each piece, unless it is one-sided. Two faces are joined along an edge that has them alone and along which they run in opposite
//! directions. Where more than two faces meet in an edge, those that continue each other best are joined in pairs. Everywhere else the
//! list is open: along one-sided strips, at vertices of several fans.
//!
//! ```
//! use ricci::mesh::{io::Soup, sheets::sheets};
//! // Three triangles on one edge: the two that lie in a plane are joined.
//! let positions = vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., -1., 0.], [0., 0., 1.]];
//! let soup = Soup::new(positions, vec![[0, 1, 2], [1, 0, 3], [0, 1, 4]]);
//! let found = sheets(&soup);
//! assert_eq!(found.sheets.iter().map(|sheet| sheet.faces.len()).collect::<Vec<_>>(), [2, 1]);
//! assert_eq!(found.opened_edges, 1);
//! ```

use super::Point;
use super::check::{Orientation, OrientedPiece};
use super::incidence::{Incidence, NONE, distinct, is_forward};
use super::io::Soup;
use super::union_find::UnionFind;
use super::weld::coincident;
use crate::geometry::vector::cross;
use std::collections::HashMap;

/// A connected piece of a triangle list that is a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// Per face of the sheet its number in the list, ascending.
    pub faces: Vec<u32>,
    /// Per face of the sheet its corners, as numbers of the sheet's own vertices; of a face that is turned in the order first, third, second.
    pub corners: Vec<[u32; 3]>,
    /// Per vertex of the sheet one of the list's vertices in its place.
    pub origins: Vec<u32>,
}

/// The sheets of a triangle list.
#[derive(Debug, Clone, PartialEq)]
pub struct SheetList {
    /// The sheets, in the order of their first faces.
    pub sheets: Vec<Sheet>,
    /// The faces that are in no sheet: those with a corner that does not exist or is not finite, or with two corners in one place.
    pub placeless: Vec<u32>,
    /// Per face of the list, true if it is turned.
    pub turned: Vec<bool>,
    /// The number of edges with several faces along which some of them were opened.
    pub opened_edges: usize,
}

/// Side that a side is joined with, per side; side `3f + k` runs from corner k of face f to the next one.
type Partners = Vec<u32>;

/// Cuts a triangle list into sheets. Vertices in exactly the same place count as one. O(F log F).
pub fn sheets(soup: &Soup) -> SheetList {
    joined_sheets(soup, &coincident(&soup.positions, 0.0))
}

/// [`sheets`] for a list of several parts: vertices in the same place count as one where they have the same part, which is given for each
/// vertex; those behind the end of `parts` are in part 0.
pub fn sheets_of_parts(soup: &Soup, parts: &[u32]) -> SheetList {
    let mut known: HashMap<(u32, u32), u32> = HashMap::new();
    let part = |v: u32| parts.get(v as usize).copied().unwrap_or(0);
    let of_place = coincident(&soup.positions, 0.0);
    let first: Vec<u32> =
        (0u32..).zip(of_place).map(|(v, place)| *known.entry((place, part(v))).or_insert(v)).collect();
    joined_sheets(soup, &first)
}

/// The sheets of a list of whose vertices each counts as the one that `first` names.
fn joined_sheets(soup: &Soup, first: &[u32]) -> SheetList {
    let is_finite =
        |v: &u32| soup.positions.get(*v as usize).is_some_and(|p| p.iter().all(|x| x.is_finite()));
    // A face without a place names one vertex three times, so that it has no sides.
    let place = |f: &[u32; 3]| match f.iter().all(is_finite) {
        true => f.map(|v| first[v as usize]),
        false => [0; 3],
    };
    let mut faces: Vec<[u32; 3]> = soup.faces.iter().map(place).collect();
    let is_placed: Vec<bool> = faces.iter().map(distinct).collect();
    let incidence = Incidence::new(soup.positions.len(), &faces);
    let turned = turned(&faces, &incidence);
    for (f, _) in faces.iter_mut().zip(&turned).filter(|(_, turned)| **turned) {
        f.swap(1, 2);
    }
    let incidence = Incidence::new(soup.positions.len(), &faces);
    let normals: Vec<Point> = faces.iter().map(|f| unit_normal(&soup.positions, f)).collect();
    let mut partner: Partners = vec![NONE; 3 * faces.len()];
    let mut opened_edges = 0;
    for sides in incidence.edges() {
        opened_edges += usize::from(!join_sides(sides, &faces, &normals, &mut partner));
    }
    let vertices = loop {
        let vertices = fans(&partner, faces.len());
        let alone = unfit(&vertices, &is_placed, &partner);
        if alone.is_empty() {
            break vertices;
        }
        alone.into_iter().for_each(|f| set_free(f, &mut partner));
    };
    let placeless = (0..faces.len() as u32).filter(|&f| !is_placed[f as usize]).collect();
    SheetList { sheets: gathered(&faces, &vertices, &is_placed, &partner), placeless, turned, opened_edges }
}

/// Per face, true if it is turned so that neighbours agree: the fewer faces of each piece, of two equal parts that without the first face.
fn turned(faces: &[[u32; 3]], incidence: &Incidence) -> Vec<bool> {
    let Orientation { mut turned, pieces, .. } = Orientation::new(faces, incidence);
    for OrientedPiece { faces, clash } in pieces {
        let n_turned = faces.iter().filter(|&&f| turned[f as usize]).count();
        for f in faces.iter().map(|f| *f as usize) {
            turned[f] = clash.is_none() && turned[f] == (2 * n_turned <= faces.len());
        }
    }
    turned
}

fn unit_normal(positions: &[Point], f: &[u32; 3]) -> Point {
    let [a, b, c] = f.map(|v| positions.get(v as usize).copied().unwrap_or_default());
    let along = |p: Point| [0, 1, 2].map(|k| p[k] - a[k]);
    let n = cross(along(b), along(c));
    let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 0.0 && length.is_finite() { n.map(|x| x / length) } else { [0.0; 3] }
}

/// Joins the sides along an edge in pairs of opposite directions, the flattest pair first; false if sides are left that have no partner
/// though there are several.
fn join_sides(sides: &[u32], faces: &[[u32; 3]], normals: &[Point], partner: &mut Partners) -> bool {
    let (ahead, back): (Vec<u32>, Vec<u32>) = sides.iter().partition(|&&side| is_forward(faces, side));
    if let ([a], [b]) = (&ahead[..], &back[..]) {
        (partner[*a as usize], partner[*b as usize]) = (*b, *a);
        return true;
    }
    let flatness = |a: u32, b: u32| -> f64 {
        let [m, n] = [a, b].map(|side| normals[side as usize / 3]);
        m.iter().zip(n).map(|(x, y)| x * y).sum()
    };
    let mut pairs: Vec<(f64, u32, u32)> =
        ahead.iter().flat_map(|&a| back.iter().map(move |&b| (flatness(a, b), a, b))).collect();
    pairs.sort_by(|p, q| q.0.total_cmp(&p.0).then((p.1, p.2).cmp(&(q.1, q.2))));
    for (_, a, b) in pairs {
        if partner[a as usize] == NONE && partner[b as usize] == NONE {
            (partner[a as usize], partner[b as usize]) = (b, a);
        }
    }
    sides.len() < 2
}

/// Per corner, the first corner of its fan: corners around a vertex that joined sides connect.
fn fans(partner: &Partners, n_faces: usize) -> Vec<u32> {
    let mut corners = UnionFind::new(3 * n_faces);
    let after = |side: u32| 3 * (side / 3) + (side + 1) % 3;
    for (side, &other) in (0u32..).zip(partner).filter(|(_, other)| **other != NONE) {
        corners.join(side, after(other));
        corners.join(after(side), other);
    }
    (0..3 * n_faces as u32).map(|c| corners.root(c)).collect()
}

/// The faces that keep their corners from determining the surface: those that close up a fan in itself, a second face with the same
/// corners, and faces on a second edge with the same ends.
fn unfit(vertices: &[u32], is_placed: &[bool], partner: &Partners) -> Vec<u32> {
    let corner = |f: u32| [0, 1, 2].map(|k| vertices[3 * f as usize + k]);
    let all = || (0..is_placed.len() as u32).filter(|&f| is_placed[f as usize]);
    let mut alone: Vec<u32> = all().filter(|&f| !distinct(&corner(f))).collect();
    let mut ends: Vec<([u32; 2], u32)> = Vec::with_capacity(3 * is_placed.len());
    for f in all() {
        let c = corner(f);
        ends.extend((0..3).map(|k| {
            let [a, b] = [c[k], c[(k + 1) % 3]];
            ([a.min(b), a.max(b)], 3 * f + k as u32)
        }));
    }
    ends.sort_unstable();
    for sides in ends.chunk_by(|a, b| a.0 == b.0).filter(|sides| sides.len() > 1) {
        let is_pair = sides.len() == 2 && partner[sides[0].1 as usize] == sides[1].1;
        if !is_pair {
            alone.extend(sides[1..].iter().map(|side| side.1 / 3).filter(|&f| has_partner(f, partner)));
        }
    }
    let mut triples: Vec<([u32; 3], u32)> = all()
        .map(|f| {
            let mut c = corner(f);
            c.sort_unstable();
            (c, f)
        })
        .collect();
    triples.sort_unstable();
    let again = triples.chunk_by(|a, b| a.0 == b.0).flat_map(|same| &same[1..]);
    alone.extend(again.map(|same| same.1));
    alone.sort_unstable();
    alone.dedup();
    alone
}

fn has_partner(f: u32, partner: &Partners) -> bool {
    (0..3).any(|k| partner[3 * f as usize + k] != NONE)
}

fn set_free(f: u32, partner: &mut Partners) {
    for side in 3 * f as usize..3 * f as usize + 3 {
        let other = std::mem::replace(&mut partner[side], NONE);
        if other != NONE {
            partner[other as usize] = NONE;
        }
    }
}

/// The pieces that joined sides connect, with vertices of their own.
fn gathered(faces: &[[u32; 3]], vertices: &[u32], is_placed: &[bool], partner: &Partners) -> Vec<Sheet> {
    let mut pieces = UnionFind::new(faces.len());
    for (side, &other) in (0u32..).zip(partner).filter(|(_, other)| **other != NONE) {
        pieces.join(side / 3, other / 3);
    }
    let mut number = vec![NONE; vertices.len()];
    let mut sheet_of = vec![NONE; faces.len()];
    let mut found: Vec<Sheet> = Vec::new();
    for f in (0..faces.len()).filter(|&f| is_placed[f]) {
        let root = pieces.root(f as u32) as usize;
        if sheet_of[root] == NONE {
            sheet_of[root] = found.len() as u32;
            found.push(Sheet { faces: Vec::new(), corners: Vec::new(), origins: Vec::new() });
        }
        let sheet = &mut found[sheet_of[root] as usize];
        let corners = [0, 1, 2].map(|k| {
            let own = &mut number[vertices[3 * f + k] as usize];
            if *own == NONE {
                *own = sheet.origins.len() as u32;
                sheet.origins.push(faces[f][k]);
            }
            *own
        });
        sheet.faces.push(f as u32);
        sheet.corners.push(corners);
    }
    found
}
