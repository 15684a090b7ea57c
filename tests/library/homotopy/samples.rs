//! Sample surfaces of every topology, including Δ-complexes with one vertex.

use crate::surfaces::{Random, cube, flat_torus, load, octagon, plane_lengths, square, tetrahedron};
use ricci::mesh::io::Soup;
use ricci::mesh::{EdgeId, HalfedgeId, Mesh, PerEdge, VertexId, shapes};
use ricci::metric::lengths_from_positions;
use ricci::topology::{HomotopyBasis, homotopy_basis};

/// Largest mesh of the corpus that tests use, so that they are quick in a debug build too.
const MOST_VERTICES: usize = 20_000;

pub type Surface = (String, Mesh, PerEdge<f64>);

pub fn from_soup(name: &str, soup: &Soup) -> Surface {
    let mesh = Mesh::from_soup(soup).unwrap();
    let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
    (name.into(), mesh, lengths)
}

/// The surface after random flips, with lengths for which every face is a triangle; it has vertices of degree 1, loops and repeated
/// edges.
fn flipped((name, mut mesh, _): Surface, random: &mut Random) -> Surface {
    for _ in 0..3 * mesh.n_edges() {
        mesh.flip(EdgeId::from(random.below(mesh.n_edges())));
    }
    let lengths = PerEdge::from_fn(mesh.n_edges(), |_: EdgeId| 1.0 + random.real());
    (format!("{name}, flipped"), mesh, lengths)
}

/// Generated surfaces: spheres, disks, annuli, pants, tori, genus 2 to 7, with holes, and each of them flipped.
pub fn generated() -> Vec<Surface> {
    let mut all = vec![
        from_soup("icosphere", &shapes::icosphere(3).unwrap()),
        from_soup("disk", &shapes::disk(5).unwrap()),
        from_soup("annulus", &shapes::annulus(0.3, 1.0, 4, 18).unwrap()),
        from_soup("torus of revolution", &shapes::torus(2.0, 0.7, 15, 9).unwrap()),
        from_soup("torus with a hole", &shapes::punch(&shapes::torus(2.0, 0.7, 15, 9).unwrap(), 1).unwrap()),
        from_soup(
            "torus with 4 holes",
            &shapes::punch(&shapes::torus(2.0, 0.7, 21, 12).unwrap(), 4).unwrap(),
        ),
        from_soup("genus 3 with 2 holes", &shapes::punch(&shapes::genus(3, 3).unwrap(), 2).unwrap()),
    ];
    all.extend((2..=5).map(|g| from_soup(&format!("genus {g}"), &shapes::genus(g, 2).unwrap())));
    let intrinsic = |name: &str, (mesh, lengths)| (name.to_string(), mesh, lengths);
    for (n, m) in [(1, 1), (1, 2), (2, 1), (5, 7)] {
        all.push(intrinsic("flat torus", flat_torus(n, m, [0.3, 1.2])));
    }
    for g in 2..=7 {
        all.push(intrinsic(
            &format!("one vertex, genus {g}"),
            shapes::one_vertex(g).unwrap().build().unwrap(),
        ));
        all.push(intrinsic(
            &format!("two vertices, genus {g}"),
            shapes::two_vertex(g).unwrap().build().unwrap(),
        ));
    }
    all.push(intrinsic("octagon", octagon()));
    all.push(intrinsic("bolza", shapes::bolza(2).unwrap().build().unwrap()));
    all.push(intrinsic("two triangles", shapes::two_triangle_sphere().build().unwrap()));
    all.push(intrinsic("tetrahedron", tetrahedron()));
    all.push(intrinsic("cube", cube()));
    all.push(intrinsic("pants", shapes::pants([1.0, 2.0, 3.0], 0).unwrap().build().unwrap()));
    all.push(intrinsic("fine pants", shapes::pants([1.0, 2.0, 3.0], 2).unwrap().build().unwrap()));
    let mut random = Random(5);
    let (mesh, positions) = square(9, &[(1, 1), (4, 2), (5, 6), (2, 6)], &mut random);
    let lengths = plane_lengths(&mesh, &positions);
    all.push(intrinsic("square with 4 holes", (mesh, lengths)));
    let again: Vec<_> = all.iter().cloned().map(|surface| flipped(surface, &mut random)).collect();
    all.extend(again);
    all
}

/// The good meshes of the corpus (none where it is absent, with a note on stderr).
pub fn corpus() -> Vec<Surface> {
    let name = |path: &std::path::Path| path.file_name().unwrap().to_string_lossy().into_owned();
    let all = crate::surfaces::corpus().into_iter().map(|path| (name(&path), load(&path)));
    all.map(|(name, (mesh, lengths))| (name, mesh, lengths))
        .filter(|(_, mesh, _)| mesh.n_vertices() < MOST_VERTICES)
        .collect()
}

pub fn basis_of(mesh: &Mesh, lengths: &PerEdge<f64>) -> HomotopyBasis {
    homotopy_basis(mesh, lengths, None, &ricci::Control::new()).unwrap()
}

/// A walk of random steps.
pub fn walk(mesh: &Mesh, start: VertexId, steps: usize, random: &mut Random) -> Vec<HalfedgeId> {
    let mut at = start;
    let mut path = Vec::new();
    for _ in 0..steps {
        let out: Vec<_> = mesh.outgoing(at).collect();
        path.push(out[random.below(out.len())]);
        at = mesh.tip(path[path.len() - 1]);
    }
    path
}

pub fn reversed(path: &[HalfedgeId]) -> Vec<HalfedgeId> {
    path.iter().rev().map(|h| h.twin()).collect()
}

/// A random loop through the base: along a walk, and back along the tree.
pub fn random_loop(mesh: &Mesh, basis: &HomotopyBasis, steps: usize, random: &mut Random) -> Vec<HalfedgeId> {
    let mut path = walk(mesh, basis.base, steps, random);
    let end = path.last().map_or(basis.base, |&h| mesh.tip(h));
    path.extend(reversed(&basis.tree_path(mesh, end).unwrap()));
    path
}

/// The loops of the basis along its relator: a1 b1 a1⁻¹ b1⁻¹ … c1 … cb.
pub fn relator_path(basis: &HomotopyBasis) -> Vec<HalfedgeId> {
    let letter = |l: &ricci::topology::Letter| {
        if l.is_inverse() { reversed(&basis.loops[l.index()]) } else { basis.loops[l.index()].clone() }
    };
    basis.group.relator().letters().iter().flat_map(letter).collect()
}
