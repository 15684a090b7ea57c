//! Areal and shape distortion of a map at the vertices of a surface.

use crate::failure::Failure;
use ricci::embed::Quality;
use ricci::geometry::complex::doubled_area;
use ricci::geometry::triangle;
use ricci::geometry::vector::{Vector, cross, dot, norm, sub};
use ricci::metric::Surface;

/// Distortion at each vertex: means over its faces, weighed with their areas on the surface.
pub struct VertexDistortion {
    /// log2 of the area of the faces in the image over that on the surface.
    pub areal: Vec<f64>,
    /// log2 of the dilatation of the faces, the larger stretch over the smaller one.
    pub shape: Vec<f64>,
}

impl VertexDistortion {
    /// The distortion of a map to the plane.
    pub fn of_plane(surface: &Surface, points: &[[f64; 2]]) -> Result<VertexDistortion, Failure> {
        let corners = surface.mesh().triangles().into_iter().map(|f| f.map(|v| points[v as usize])).collect();
        VertexDistortion::of_corners(surface, corners)
    }

    /// The distortion of a map to the unit sphere, which is scaled to the area of the surface.
    pub fn of_sphere(surface: &Surface, points: &[Vector]) -> Result<VertexDistortion, Failure> {
        let radius = (surface.area()? / (4.0 * std::f64::consts::PI)).sqrt();
        let plane = |f: [u32; 3]| {
            let [a, b, c] = f.map(|v| points[v as usize]);
            let (p, q) = (sub(b, a), sub(c, a));
            let length = norm(p);
            let across = norm(cross(p, q)) / length;
            [[0.0; 2], [length, 0.0], [dot(p, q) / length, across]].map(|x: [f64; 2]| x.map(|x| radius * x))
        };
        let corners = surface.mesh().triangles().into_iter().map(plane).collect();
        VertexDistortion::of_corners(surface, corners)
    }

    /// `corners`: the images of the faces, each in a plane of its own.
    fn of_corners(surface: &Surface, corners: Vec<[[f64; 2]; 3]>) -> Result<VertexDistortion, Failure> {
        let Some(positions) = surface.positions() else { return Err(Failure::no_positions()) };
        let mesh = surface.mesh();
        let faces = mesh.triangles();
        let quality = Quality::of_texture(positions, &faces, &corners)?;
        let sides = |f| mesh.opposite_edges(f).map(|e| surface.lengths()[e]);
        let mut sums = vec![[0.0; 3]; mesh.n_vertices()];
        for (f, qc) in mesh.faces().zip(quality.qc.iter()) {
            let area = triangle::area(surface.geometry(), sides(f));
            let image = 0.5 * doubled_area(corners[f.index()]);
            for v in mesh.face_vertices(f) {
                let [whole, there, shape] = sums[v.index()];
                sums[v.index()] = [whole + area, there + image, shape + area * qc.log2()];
            }
        }
        Ok(VertexDistortion {
            areal: sums.iter().map(|[whole, there, _]| (there / whole).log2()).collect(),
            shape: sums.iter().map(|[whole, _, shape]| shape / whole).collect(),
        })
    }
}
