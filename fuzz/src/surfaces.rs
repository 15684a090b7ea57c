//! Small surfaces of every topology, drawn from bytes; rarely somewhat larger ones.

use crate::is_rare;
use ricci::Surface;
use ricci::geometry::Space;
use ricci::mesh::io::Soup;
use ricci::mesh::{Mesh, PerEdge, PerVertex, shapes};
use ricci::metric::lengths_from_positions;
use std::sync::OnceLock;

/// Largest change of the logarithm of a length that a byte makes at a vertex.
const MOST_CHANGE: f64 = 0.5;

/// One input of so many has a larger surface.
const LARGER: u32 = 64;
/// Faces of the octahedron; the corners k and k + 3 are opposite.
const OCTAHEDRON: [[u32; 3]; 8] =
    [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];

/// The small surfaces, and the larger ones.
fn all() -> &'static [Vec<(Mesh, PerEdge<f64>)>; 2] {
    static ALL: OnceLock<[Vec<(Mesh, PerEdge<f64>)>; 2]> = OnceLock::new();
    ALL.get_or_init(|| {
        let octahedron = {
            let corner = |k: u32| [0, 1, 2].map(|i| f64::from(k % 3 == i) * if k < 3 { 1.0 } else { -1.0 });
            Soup::new((0..6).map(corner).collect(), OCTAHEDRON.to_vec())
        };
        let in_space = |soup: Soup| {
            let mesh = Mesh::from_soup(&soup).unwrap();
            let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
            (mesh, lengths)
        };
        let small = vec![
            shapes::two_triangle_sphere().build().unwrap(),
            in_space(octahedron),
            in_space(shapes::disk(1).unwrap()),
            in_space(shapes::annulus(0.25, 1.0, 1, 3).unwrap()),
            in_space(shapes::torus(2.0, 1.0, 3, 3).unwrap()),
            shapes::flat_torus([0.3, 1.1], 2, 2).unwrap().build().unwrap(),
            shapes::one_vertex(1).unwrap().build().unwrap(),
            shapes::one_vertex(2).unwrap().build().unwrap(),
            shapes::two_vertex(2).unwrap().build().unwrap(),
            shapes::pants([1.0, 2.0, 1.5], 0).unwrap().build().unwrap(),
        ];
        let larger = vec![
            in_space(shapes::icosphere(1).unwrap()),
            in_space(shapes::disk(2).unwrap()),
            in_space(shapes::annulus(0.5, 1.0, 1, 5).unwrap()),
            in_space(shapes::torus(2.0, 1.0, 4, 3).unwrap()),
        ];
        [small, larger]
    })
}

/// A surface named by a byte, its lengths scaled at its vertices by those that follow; none where that leaves no triangles.
pub fn surface(input: &[u8], bytes: &mut impl Iterator<Item = u8>) -> Option<Surface> {
    let of_size = &all()[usize::from(is_rare(input, LARGER))];
    let (mesh, lengths) = &of_size[usize::from(bytes.next()?) % of_size.len()];
    let mut draw = || f64::from(bytes.next().unwrap_or(0) as i8) / 128.0 * MOST_CHANGE;
    let u = PerVertex::from_fn(mesh.n_vertices(), |_: ricci::mesh::VertexId| draw());
    let ends = |e: ricci::mesh::EdgeId| [e.halfedge(), e.halfedge().twin()].map(|h| u[mesh.origin(h)]);
    let lengths = PerEdge::from_fn(mesh.n_edges(), |e| lengths[e] * ends(e).iter().sum::<f64>().exp());
    match Surface::intrinsic(mesh.clone(), lengths, Space::E2) {
        Ok(surface) => Some(surface),
        Err(ricci::Error::TriangleInequality { .. }) => None,
        Err(other) => panic!("{other}"),
    }
}
