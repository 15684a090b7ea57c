//! The overlay of two matched surfaces: it covers both, exactly once, and is one surface on either.

use super::samples::{matched, moved, potato, surface};
use ricci::matching::{MatchOptions, Matching, match_surfaces};
use ricci::mesh::io::Soup;
use ricci::mesh::{FaceId, Point, VertexId, shapes};
use ricci::metric::CommonSubdivision;
use ricci::{Control, Surface};

fn area([a, b, c]: [Point; 3]) -> f64 {
    let [u, v] = [b, c].map(|p| [0, 1, 2].map(|k| p[k] - a[k]));
    let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    0.5 * cross.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn combine(weights: [f64; 3], corners: [Point; 3]) -> Point {
    std::array::from_fn(|i| (0..3).map(|k| weights[k] * corners[k][i]).sum())
}

fn distance(p: Point, q: Point) -> f64 {
    (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt()
}

/// Everything that an overlay promises, measured from its arrays.
pub fn check(overlay: &CommonSubdivision, matching: &Matching, surfaces: [&Surface; 2], what: &str) {
    let mesh = &overlay.mesh;
    assert_eq!(mesh.euler(), surfaces[0].mesh().euler(), "{what}");
    assert_eq!(mesh.boundary_loops().len(), surfaces[0].mesh().boundary_loops().len(), "{what}");
    for (s, surface) in surfaces.into_iter().enumerate() {
        let positions = surface.positions().unwrap();
        let corners = |f: FaceId| surface.mesh().face_vertices(f).map(|v| positions[v.index()]);
        let size = surface.mesh().faces().map(|f| area(corners(f))).sum::<f64>();
        let own = |f: FaceId| {
            overlay.barycentric(s, f).map(|weights| combine(weights, corners(overlay.faces[s][f])))
        };
        let covered: f64 = mesh.faces().map(|f| area(own(f))).sum();
        assert!((covered / size - 1.0).abs() < 1e-10, "{what}: {covered} of {size}");
        // Every face is covered, and no piece lies outside its face or is turned over.
        let mut per_face = vec![0.0; surface.mesh().n_faces()];
        mesh.faces().for_each(|f| per_face[overlay.faces[s][f].index()] += area(own(f)));
        for f in surface.mesh().faces() {
            assert!((per_face[f.index()] / area(corners(f)) - 1.0).abs() < 1e-9, "{what}: face {f}");
        }
        for f in mesh.faces() {
            assert!(overlay.barycentric(s, f).as_flattened().iter().all(|&w| w > -1e-15), "{what}");
        }
        assert!(overlay.least_share(s) > -1e-15, "{what}: {:e}", overlay.least_share(s));
        // Neighbours agree where their common vertices are.
        let all = overlay.from_vertices(s, positions).unwrap();
        let worst = mesh.faces().flat_map(|f| {
            let there = own(f);
            let vertices = mesh.face_vertices(f);
            [0, 1, 2].map(|k| distance(there[k], all[vertices[k].index()]))
        });
        let worst = worst.fold(0.0, f64::max) / size.sqrt();
        assert!(worst < 1e-9, "{what}: vertices come apart by {worst:e} on {s}");
    }
    check_vertices(overlay, matching, surfaces, what);
    check_points(overlay, surfaces, what);
}

/// Vertices of the source are where the map has them, and crossings lie on their edges.
fn check_vertices(
    overlay: &CommonSubdivision,
    matching: &Matching,
    [source, target]: [&Surface; 2],
    what: &str,
) {
    let to = target.positions().unwrap();
    let on_target = overlay.from_vertices(1, to).unwrap();
    let on_source = overlay.from_vertices(0, source.positions().unwrap()).unwrap();
    let images = matching.forward.carry(target.mesh(), to).unwrap();
    for (v, &image) in images.iter().enumerate() {
        assert_eq!(on_source[v], source.positions().unwrap()[v], "{what}");
        assert!(distance(on_target[v], image) < 1e-8, "{what}: {:e}", distance(on_target[v], image));
    }
    let sides = [(source, &on_source), (target, &on_target)];
    for (k, crossing) in overlay.crossings.iter().enumerate() {
        let v = overlay.n_vertices[0] + k;
        for ((surface, all), at) in sides.into_iter().zip(crossing) {
            let ends = surface.mesh().ends(at.edge);
            assert!(ends == at.ends && (at.weights[0] + at.weights[1] - 1.0).abs() < 1e-15, "{what}");
            let [a, b] = ends.map(|v| surface.positions().unwrap()[v.index()]);
            let there = [0, 1, 2].map(|k| at.weights[0] * a[k] + at.weights[1] * b[k]);
            assert!(distance(all[v], there) < 1e-12, "{what}");
        }
    }
    // The parts of an edge lie on it, and are as long as it together.
    for (side, (surface, all)) in sides.into_iter().enumerate() {
        let (mesh, positions) = (surface.mesh(), surface.positions().unwrap());
        let mut covered = vec![0.0; mesh.n_edges()];
        for h in overlay.mesh.edges().map(|e| e.halfedge()) {
            let Some(along) = overlay.halfedge(side, h) else { continue };
            let [from, to] = [mesh.origin(along), mesh.tip(along)].map(|v| positions[v.index()]);
            let [a, b] = [overlay.mesh.origin(h), overlay.mesh.tip(h)].map(|v| all[v.index()]);
            let part = distance(a, b);
            let off = distance(from, a) + part + distance(b, to) - distance(from, to);
            assert!(off.abs() < 1e-9, "{what}: {off:e} of {along}");
            covered[along.edge().index()] += part;
        }
        for e in mesh.edges() {
            let [a, b] = mesh.ends(e).map(|v| positions[v.index()]);
            assert!((covered[e.index()] - distance(a, b)).abs() < 1e-9, "{what}: edge {e}");
        }
    }
}

/// The map of points and the one back undo each other.
fn check_points(overlay: &CommonSubdivision, [source, _]: [&Surface; 2], what: &str) {
    let (forward, back) = (overlay.forward(), overlay.backward());
    for f in source.mesh().faces() {
        let weights = [0.2, 0.3, 0.5];
        let (g, there) = forward.image(f, weights).unwrap();
        let (returned, again) = back.image(g, there).unwrap();
        // At the edge of a face rounding may bring it to the next one.
        if returned == f {
            assert!((0..3).all(|k| (again[k] - weights[k]).abs() < 1e-6), "{what}: {again:?}");
        } else {
            assert!(again.iter().any(|w| *w < 1e-6), "{what}: {returned} for {f}");
        }
    }
}

fn overlay(matching: &Matching) -> CommonSubdivision {
    matching.domain.overlay(1, &Control::new()).unwrap()
}

/// Pairs of different triangulations.
fn pairs() -> Vec<(&'static str, [Surface; 2], MatchOptions)> {
    let both = |a: &Soup, b: &Soup| [surface(a), surface(b)];
    let with = |pairs: &[[u32; 2]]| MatchOptions {
        landmarks: pairs.iter().map(|pair| pair.map(VertexId)).collect(),
        ..MatchOptions::default()
    };
    let wavy = |soup: &Soup| moved(soup, |[x, y, z]| [x, y + 0.1 * (2.0 * x + 0.4).sin(), z + 0.2 * x * y]);
    let holes = |soup: &Soup| shapes::punch(soup, 3).unwrap();
    let tori = [[2.0, 0.8, 24.0, 12.0], [2.0, 0.6, 19.0, 9.0]]
        .map(|[a, b, n, m]| shapes::torus(a, b, n as usize, m as usize).unwrap());
    vec![
        ("spheres", both(&potato(6), &shapes::icosphere(5).unwrap()), with(&[])),
        (
            "spheres, 4",
            both(&potato(6), &shapes::icosphere(5).unwrap()),
            with(&[[0, 0], [5, 5], [9, 9], [11, 11]]),
        ),
        ("disks", both(&wavy(&shapes::disk(8).unwrap()), &shapes::disk(5).unwrap()), with(&[])),
        (
            "annuli",
            both(
                &wavy(&shapes::annulus(0.4, 1.0, 6, 36).unwrap()),
                &shapes::annulus(0.3, 1.0, 4, 25).unwrap(),
            ),
            with(&[]),
        ),
        ("spheres with holes", both(&holes(&potato(6)), &holes(&shapes::icosphere(7).unwrap())), with(&[])),
        ("tori", both(&tori[0], &tori[1]), with(&[])),
        ("tori, 1", both(&tori[0], &tori[1]), with(&[[3, 7]])),
        ("tori with holes", both(&holes(&tori[0]), &holes(&tori[1])), with(&[])),
        ("genus 2", both(&shapes::genus(2, 12).unwrap(), &shapes::genus(2, 9).unwrap()), with(&[])),
    ]
}

#[test]
fn two_triangulations_are_laid_over_each_other() {
    for (what, [source, target], options) in pairs() {
        let matching = match_surfaces(&source, &target, &options, &Control::new()).unwrap();
        let overlay = overlay(&matching);
        eprintln!("{what}: {} faces, {} crossings", overlay.mesh.n_faces(), overlay.crossings.len());
        assert!(!overlay.crossings.is_empty());
        check(&overlay, &matching, [&source, &target], what);
        let again = matching.domain.overlay(3, &Control::new()).unwrap();
        assert!(again == overlay, "{what}: other numbers with 3 threads");
    }
}

#[test]
fn the_overlay_of_a_surface_and_itself_is_that_surface() {
    for (what, soup, landmarks) in [
        ("sphere", potato(6), vec![]),
        ("sphere, 4", potato(6), vec![0, 5, 9, 11]),
        ("torus, 1", shapes::torus(2.0, 0.8, 24, 12).unwrap(), vec![0]),
        ("holes", shapes::punch(&potato(8), 3).unwrap(), vec![]),
    ] {
        let surface = surface(&soup);
        let matching = matched(&surface, &surface, &landmarks);
        let overlay = overlay(&matching);
        check(&overlay, &matching, [&surface, &surface], what);
        let mesh = surface.mesh();
        eprintln!("{what}: {} of {} faces", overlay.mesh.n_faces(), mesh.n_faces());
        assert!(overlay.mesh.n_faces() == mesh.n_faces() && overlay.faces[0] == overlay.faces[1], "{what}");
    }
}
