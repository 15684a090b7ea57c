//! Surfaces given by glued triangles and edge lengths, without positions.

use super::{THIN, check_count};
use crate::error::{Error, Result};
use crate::geometry::flip::diagonal;
use crate::geometry::space::USABLE_LENGTHS;
use crate::geometry::{Space, triangle};
use crate::mesh::{Mesh, PerEdge};
use std::f64::consts::PI;

/// Triangles of one geometry, glued along numbered edges (see [`Mesh::from_gluing`]).
#[derive(Debug, Clone, PartialEq)]
pub struct IntrinsicSurface {
    /// Number of vertices.
    pub n_vertices: usize,
    /// Vertices (a, b, c) of each face.
    pub faces: Vec<[u32; 3]>,
    /// `[±e_bc, ±e_ca, ±e_ab]` of each face, edges numbered from 1.
    pub face_edges: Vec<[i32; 3]>,
    /// Length of each edge.
    pub lengths: Vec<f64>,
    /// Geometry of the triangles.
    pub geometry: Space,
}

impl IntrinsicSurface {
    /// Connectivity and edge lengths.
    ///
    /// # Errors
    ///
    /// As [`Mesh::from_gluing`]; [`Error::Size`] unless there is one length per edge.
    pub fn build(&self) -> Result<(Mesh, PerEdge<f64>)> {
        let mesh = Mesh::from_gluing(self.n_vertices, &self.faces, &self.face_edges)?;
        crate::error::check_size("lengths", self.lengths.len(), mesh.n_edges())?;
        Ok((mesh, self.lengths.clone().into()))
    }

    /// The surface after `level` rounds of [`IntrinsicSurface::subdivide`]; it has about 8 faces.
    pub(super) fn subdivided(mut self, level: usize) -> Result<IntrinsicSurface> {
        check_count("level", level, 0, 8.0 * 4f64.powi(level.min(60) as i32))?;
        for _ in 0..level {
            self = self.subdivide()?;
        }
        Ok(self)
    }

    /// Cuts each triangle into four at the midpoints of its sides, in its own geometry.
    ///
    /// Edge e becomes 2e − 1 and 2e, in its direction; vertex V + e − 1 is its midpoint; three edges per face follow.
    ///
    /// # Errors
    ///
    /// Those of [`Mesh::from_gluing`] for a gluing that is not a surface; [`Error::EdgeLength`] and [`Error::TriangleInequality`] for
    /// lengths without such triangles; [`Error::Argument`] for sides in H² beyond 700; more edges than i32 can number.
    pub fn subdivide(&self) -> Result<IntrinsicSurface> {
        self.build()?;
        self.check_triangles()?;
        let after = 2 * self.lengths.len() + 3 * self.faces.len();
        if i32::try_from(after).is_err() {
            return Err(Error::TooLarge { what: "edges", count: after });
        }
        let (n, edges) = (self.n_vertices as u32, self.lengths.len());
        let mut fine = IntrinsicSurface {
            n_vertices: self.n_vertices + edges,
            faces: Vec::with_capacity(4 * self.faces.len()),
            face_edges: Vec::with_capacity(4 * self.faces.len()),
            lengths: self.lengths.iter().flat_map(|l| [0.5 * l, 0.5 * l]).collect(),
            geometry: self.geometry,
        };
        for (f, (corners, edge)) in self.faces.iter().zip(&self.face_edges).enumerate() {
            let l = edge.map(|e| self.lengths[e.unsigned_abs() as usize - 1]);
            let angles = triangle::angles(self.geometry, l).at;
            // Side k runs from corner k to corner k + 1 and is opposite corner k + 2.
            let side = |k: usize| edge[(k + 2) % 3];
            let middle = |k: usize| n + side(k % 3).unsigned_abs() - 1;
            let half = |k: usize, second: bool| {
                let e = 2 * side(k % 3);
                // Against the edge's direction its second half comes first.
                let later = second != (e < 0);
                if later { e } else { e - e.signum() }
            };
            // The inner edge near corner k, from the middle of side k to the middle of side k + 2.
            let inner = |k: usize| (2 * edges + 3 * f + k % 3 + 1) as i32;
            for k in 0..3 {
                // The segment between two midpoints is the third side of a triangle with half of the two sides.
                fine.lengths.push(match self.geometry {
                    Space::E2 => 0.5 * l[k],
                    space => diagonal(space, 0.5 * l[(k + 1) % 3], 0.5 * l[(k + 2) % 3], angles[k]),
                });
                fine.faces.push([corners[k], middle(k), middle(k + 2)]);
                fine.face_edges.push([inner(k), half(k + 2, true), half(k, false)]);
            }
            fine.faces.push([middle(0), middle(1), middle(2)]);
            fine.face_edges.push([-inner(2), -inner(0), -inner(1)]);
        }
        Ok(fine)
    }

    /// Checks that every length is usable, and every face a triangle of the geometry.
    pub(super) fn check_triangles(&self) -> Result<()> {
        if let Some((edge, &length)) =
            self.lengths.iter().enumerate().find(|(_, l)| !USABLE_LENGTHS.contains(*l))
        {
            return Err(Error::EdgeLength { edge, length });
        }
        if let Some(l) =
            self.lengths.iter().find(|&&l| self.geometry == Space::H2 && l > LONGEST_HYPERBOLIC_SIDE)
        {
            let need = "at most 700: its triangles' midlines are beyond the range of f64";
            return Err(Error::argument("length in H²", l, need));
        }
        for (face, edge) in self.face_edges.iter().enumerate() {
            let l = edge.map(|e| self.lengths[e.unsigned_abs() as usize - 1]);
            if triangle::angles(self.geometry, l).broken() {
                let [longest, perimeter] = [l.into_iter().fold(0.0, f64::max), l.iter().sum()];
                let over = (2.0 * longest - perimeter) / longest;
                let excess = if over >= 0.0 { over } else { perimeter - 2.0 * PI };
                return Err(Error::TriangleInequality { face, excess });
            }
        }
        Ok(())
    }
}

/// Longest side in H² of a triangle that is subdivided: the squared half chord of a midline grows like e^l, and f64 ends at e^709.
const LONGEST_HYPERBOLIC_SIDE: f64 = 700.0;

/// The flat torus ℂ/(ℤ + τℤ), Im τ > 0, as an n × m grid of parallelograms, each halved by its diagonal from z to z + 1/n + τ/m; n = m =
/// 1 (one vertex) is allowed. Vertex (i, j) is i + n j.
///
/// # Errors
///
/// [`Error::Argument`] for τ outside the upper half plane or not finite, triangles flatter than 1e-12
/// (twice the area over the longest side squared), or counts out of range.
pub fn flat_torus(tau: [f64; 2], n: usize, m: usize) -> Result<IntrinsicSurface> {
    if !(tau[0].is_finite() && tau[1].is_finite() && tau[1] > 0.0) {
        let value = format!("{} + {} i", tau[0], tau[1]);
        return Err(Error::argument("τ", value, "in the upper half plane"));
    }
    let vertices = n as f64 * m as f64;
    check_count("steps along 1", n, 1, vertices)?;
    check_count("steps along τ", m, 1, vertices)?;
    let vertex = |i: usize, j: usize| (i % n) + n * (j % m);
    let edge = |kind: usize, i: usize, j: usize| (3 * vertex(i, j) + kind + 1) as i32;
    let (x, y) = ([1.0 / n as f64, 0.0], [tau[0] / m as f64, tau[1] / m as f64]);
    let sides = [x[0], y[0].hypot(y[1]), (x[0] + y[0]).hypot(y[1])];
    // Twice a triangle's area over its longest side squared; 0 if that side is infinite.
    let longest = sides.into_iter().fold(0.0, f64::max);
    if (x[0] / longest) * (y[1] / longest) <= THIN {
        let value = format!("{} + {} i", tau[0], tau[1]);
        return Err(Error::argument("τ", value, "such that its triangles have an area in f64"));
    }
    let (mut faces, mut face_edges, mut lengths) = (Vec::new(), Vec::new(), Vec::new());
    for j in 0..m {
        for i in 0..n {
            let [a, b, c, d] =
                [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| vertex(i, j) as u32);
            faces.extend([[a, b, c], [a, c, d]]);
            face_edges.push([edge(1, i + 1, j), -edge(2, i, j), edge(0, i, j)]);
            face_edges.push([-edge(0, i, j + 1), -edge(1, i, j), edge(2, i, j)]);
            lengths.extend(sides);
        }
    }
    Ok(IntrinsicSurface { n_vertices: n * m, faces, face_edges, lengths, geometry: Space::E2 })
}

/// The Bolza surface: the regular hyperbolic octagon with angles π/4 and opposite sides identified, as eight triangles around its centre,
/// subdivided `level` times. Every vertex has curvature 0; the area is 4π.
///
/// # Errors
///
/// [`Error::Argument`] for too many levels.
pub fn bolza(level: usize) -> Result<IntrinsicSurface> {
    // Side i and side i + 4 are the same edge in opposite directions.
    let sides: Vec<i32> = (1..=4).chain((1..=4).map(|e| -e)).collect();
    centre_fan(&sides, 2).subdivided(level)
}

/// The regular 4g-gon with sides `a1 b1 a1⁻¹ b1⁻¹ …` glued (all corners are one vertex of curvature 0), as a fan around its centre: two
/// vertices, 6g edges. It is hyperbolic with angles 2π/4g for g ≥ 2, the unit square for g = 1.
///
/// # Errors
///
/// [`Error::Argument`] for genus 0, or one too large to number the vertices.
pub fn two_vertex(genus: usize) -> Result<IntrinsicSurface> {
    check_count("genus", genus, 1, 8.0 * genus as f64)?;
    Ok(centre_fan(&commutators(genus), genus))
}

/// The polygon of [`two_vertex`] as a fan of diagonals from one corner: one vertex, 6g − 3 edges, all of them loops.
///
/// # Errors
///
/// As [`two_vertex`].
pub fn one_vertex(genus: usize) -> Result<IntrinsicSurface> {
    check_count("genus", genus, 1, 8.0 * genus as f64)?;
    let sides = commutators(genus);
    let n = sides.len();
    let chord = polygon_chord(genus, n);
    let n_sides = n as i32 / 2;
    // The diagonal from corner 0 to corner k, 2 ≤ k ≤ n − 2; the first and last are sides.
    let from_corner = |k: usize| match k {
        1 => sides[0],
        k if k == n - 1 => -sides[n - 1],
        k => n_sides + k as i32 - 1,
    };
    let face_edges = (1..n - 1).map(|k| [sides[k], -from_corner(k + 1), from_corner(k)]).collect();
    let mut lengths = vec![chord(1); n / 2];
    lengths.extend((2..n - 1).map(chord));
    Ok(IntrinsicSurface {
        n_vertices: 1,
        faces: vec![[0; 3]; n - 2],
        face_edges,
        lengths,
        geometry: polygon_space(genus),
    })
}

/// Two equilateral triangles of side 1 glued along their boundary: a flat sphere with three cones of 4π/3.
pub fn two_triangle_sphere() -> IntrinsicSurface {
    IntrinsicSurface {
        n_vertices: 3,
        faces: vec![[0, 1, 2], [0, 2, 1]],
        face_edges: vec![[2, 3, 1], [-2, -1, -3]],
        lengths: vec![1.0; 3],
        geometry: Space::E2,
    }
}

/// The signed edge numbers of the sides `a1 b1 a1⁻¹ b1⁻¹ a2 …`.
fn commutators(genus: usize) -> Vec<i32> {
    (0..genus as i32).flat_map(|k| [2 * k + 1, 2 * k + 2, -(2 * k + 1), -(2 * k + 2)]).collect()
}

fn polygon_space(genus: usize) -> Space {
    if genus == 1 { Space::E2 } else { Space::H2 }
}

/// Radius of the polygon's corners: `cosh ρ = cot²(π/n)` for angles 2π/n in H²; √½ for the unit square.
fn polygon_radius(genus: usize, n: usize) -> f64 {
    let cot = 1.0 / (PI / n as f64).tan();
    if genus == 1 { 0.5f64.sqrt() } else { (cot * cot).acosh() }
}

/// Distance of corners that are k steps apart: `sinh(d/2) = sinh ρ sin(πk/n)`.
fn polygon_chord(genus: usize, n: usize) -> impl Fn(usize) -> f64 {
    let radius = polygon_radius(genus, n);
    move |k| {
        let sine = (PI * k as f64 / n as f64).sin();
        if genus == 1 { 2.0 * radius * sine } else { 2.0 * (radius.sinh() * sine).asinh() }
    }
}

/// The polygon with these glued sides as a fan around its centre (vertex 0; the corners are vertex 1).
fn centre_fan(sides: &[i32], genus: usize) -> IntrinsicSurface {
    let n = sides.len();
    let n_sides = n as i32 / 2;
    let spoke = |k: usize| n_sides + (k % n) as i32 + 1;
    let face_edges = (0..n).map(|k| [sides[k], -spoke(k + 1), spoke(k)]).collect();
    let mut lengths = vec![polygon_chord(genus, n)(1); n / 2];
    lengths.extend(vec![polygon_radius(genus, n); n]);
    IntrinsicSurface {
        n_vertices: 2,
        faces: vec![[0, 1, 1]; n],
        face_edges,
        lengths,
        geometry: polygon_space(genus),
    }
}
