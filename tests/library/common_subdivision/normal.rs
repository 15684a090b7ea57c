//! Normal coordinates against curves tracked by hand, and against straight lines.

use ricci::Error;
use ricci::mesh::normal_trace::{CurveCrossing, Curves};
use ricci::mesh::shapes::{self, SplitMix64};
use ricci::mesh::{EdgeId, HalfedgeId, Mesh, NormalCoordinates};
use std::collections::HashMap;

/// A curve, tracked by hand: the corner it leaves (a half-edge), the half-edges it crosses, the corner it ends in.
#[derive(Debug, Clone, PartialEq)]
enum Tracked {
    Along(HalfedgeId),
    Across { from: HalfedgeId, crossed: Vec<HalfedgeId>, to: HalfedgeId },
}

/// One station of a curve's way through the quadrilateral of an edge.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    A,
    B,
    C,
    D,
}

/// The sides b → c, c → a, a → d, d → b around the edge a → b.
fn quadrilateral(mesh: &Mesh, h: HalfedgeId) -> [HalfedgeId; 4] {
    let t = h.twin();
    [mesh.next(h), mesh.prev(h), mesh.next(t), mesh.prev(t)]
}

/// Rewrite a curve for the flip of the edge of h = a → b, passage by passage.
fn rewrite(mesh: &Mesh, h: HalfedgeId, curve: &Tracked) -> Tracked {
    let t = h.twin();
    let [bc, ca, ad, db] = quadrilateral(mesh, h);
    // After the flip: faces (d, c, a) and (c, d, b); h = d → c, t = c → d.
    let corner_side = |x: HalfedgeId| match x {
        x if x == h || x == ad => Some(Side::A),
        x if x == t || x == bc => Some(Side::B),
        x if x == ca => Some(Side::C),
        x if x == db => Some(Side::D),
        _ => None,
    };
    let side = |x: HalfedgeId| match x {
        x if x == ca || x == ad => Some(Side::A),
        x if x == bc || x == db => Some(Side::B),
        _ => None,
    };
    let (from, crossed, to) = match curve {
        Tracked::Along(x) if *x == h => return Tracked::Across { from: ad, crossed: vec![h], to: bc },
        Tracked::Along(x) if *x == t => return Tracked::Across { from: bc, crossed: vec![t], to: ad },
        Tracked::Along(x) => return Tracked::Along(*x),
        Tracked::Across { from, crossed, to } => (*from, crossed, *to),
    };
    // Stations: where the curve enters the quadrilateral (None: it is elsewhere), where it leaves.
    let mut now = corner_side(from);
    let mut out = Vec::new();
    let cross = |out: &mut Vec<HalfedgeId>, from: Option<Side>, to: Option<Side>| match (from, to) {
        (Some(Side::A), Some(Side::B)) => out.push(h),
        (Some(Side::B), Some(Side::A)) => out.push(t),
        _ => {}
    };
    for &x in crossed.iter().filter(|x| x.edge() != h.edge()) {
        if let Some(leaves) = side(x) {
            cross(&mut out, now, Some(leaves));
        }
        out.push(x);
        now = side(x.twin());
    }
    let end = corner_side(to);
    if out.is_empty() && crossed.iter().all(|x| x.edge() == h.edge()) {
        match (now, end) {
            (Some(Side::C), Some(Side::D)) => return Tracked::Along(t),
            (Some(Side::D), Some(Side::C)) => return Tracked::Along(h),
            _ => {}
        }
    }
    cross(&mut out, now, end);
    // The corners that the first and the last crossing leave to: a fan of a new face, opposite the crossed side.
    let corner = |old: HalfedgeId, side: Option<Side>, other: Option<Side>| match side {
        Some(Side::A) => ad,
        Some(Side::B) => bc,
        Some(Side::C) if other == Some(Side::A) => ca,
        Some(Side::C) => t,
        Some(Side::D) if other == Some(Side::A) => h,
        Some(Side::D) => db,
        None => old,
    };
    let first = out.first().and_then(|&x| side(x));
    let last = out.last().and_then(|&x| side(x.twin()));
    Tracked::Across { from: corner(from, corner_side(from), first), to: corner(to, end, last), crossed: out }
}

fn tracked(mesh: &Mesh, curves: &[Tracked], normal: &NormalCoordinates) {
    let traced = Curves::trace(mesh, normal, &ricci::Control::new()).unwrap();
    let mut crossed: HashMap<EdgeId, Vec<u32>> = HashMap::new();
    for (e, curve) in curves.iter().enumerate() {
        let e = EdgeId(e as u32);
        match curve {
            Tracked::Along(h) => assert_eq!((traced.along(e), traced.crossings(e)), (Some(*h), &[][..])),
            Tracked::Across { crossed, .. } => {
                let found: Vec<_> = traced.crossings(e).iter().map(|c| c.halfedge).collect();
                assert_eq!(&found, crossed, "edge {e}");
            }
        }
        for CurveCrossing { halfedge, position } in traced.crossings(e) {
            let n = normal.crossings(halfedge.edge()) as u32;
            let from_start = if halfedge.0 & 1 == 0 { *position } else { n - 1 - position };
            crossed.entry(halfedge.edge()).or_default().push(from_start);
        }
    }
    for e in mesh.edges() {
        let mut positions = crossed.remove(&e).unwrap_or_default();
        positions.sort_unstable();
        assert!(positions.iter().enumerate().all(|(k, &p)| p as usize == k));
        let n = normal.crossings(e);
        assert!(n != 0 && positions.len() as i64 == n.max(0));
    }
}

#[test]
fn coordinates_follow_curves_that_are_tracked_one_by_one() {
    let mut random = SplitMix64::new(5);
    let surfaces = [
        (shapes::one_vertex(2).unwrap().build().unwrap().0, 60),
        (shapes::one_vertex(1).unwrap().build().unwrap().0, 12),
        (shapes::two_vertex(1).unwrap().build().unwrap().0, 40),
        (shapes::two_vertex(2).unwrap().build().unwrap().0, 60),
        (shapes::two_triangle_sphere().build().unwrap().0, 10),
        (Mesh::from_soup(&shapes::disk(2).unwrap()).unwrap(), 150),
        (Mesh::from_soup(&shapes::icosphere(2).unwrap()).unwrap(), 400),
        (Mesh::from_soup(&shapes::genus(2, 3).unwrap()).unwrap(), 600),
    ];
    for (before, flips) in surfaces {
        let mut mesh = before.clone();
        let mut normal = NormalCoordinates::new(&mesh);
        let mut curves: Vec<_> = mesh.edges().map(|e| Tracked::Along(e.halfedge())).collect();
        let mut done = Vec::new();
        while done.len() < flips {
            let e = EdgeId((random.bits() % mesh.n_edges() as u64) as u32);
            let h = e.halfedge();
            let flips = mesh.face(h).zip(mesh.face(h.twin())).is_some_and(|(f, g)| f != g);
            normal.record(&mesh, e);
            if flips {
                curves.iter_mut().for_each(|curve| *curve = rewrite(&mesh, h, curve));
                done.push(e);
            }
            assert_eq!(mesh.flip(e), flips);
            if done.len() % 7 == 0 {
                tracked(&mesh, &curves, &normal);
            }
        }
        tracked(&mesh, &curves, &normal);
        // Three more flips of an edge undo one.
        for &e in done.iter().rev() {
            for _ in 0..3 {
                normal.record(&mesh, e);
                mesh.flip(e);
            }
        }
        assert!(mesh.halfedges().all(|h| mesh.next(h) == before.next(h)));
        assert_eq!(normal, NormalCoordinates::new(&before));
    }
}

#[test]
fn straight_edges_of_a_torus_cross_as_often_as_lines_of_the_lattice() {
    let mut random = SplitMix64::new(8);
    for (n, m) in [(1, 1), (2, 1), (3, 2)] {
        let (mut mesh, lengths) =
            shapes::flat_torus([0.0, m as f64 / n as f64], n, m).unwrap().build().unwrap();
        // Edges as integer vectors, one per half-edge, from the lengths 1 and √2 and what closes the triangles.
        let unit = lengths.iter().copied().fold(f64::INFINITY, f64::min);
        let mut vectors = lattice_vectors(&mesh, &lengths.iter().map(|l| l / unit).collect::<Vec<_>>());
        let given = vectors.clone();
        let mut normal = NormalCoordinates::new(&mesh);
        let mut flips = 0;
        while flips < 120 {
            let e = EdgeId((random.bits() % mesh.n_edges() as u64) as u32);
            let h = e.halfedge();
            let [bc, ca, ad, db] = quadrilateral(&mesh, h).map(|h| vectors[h.index()]);
            let turn = |[a, b]: [i64; 2], [c, d]: [i64; 2]| a * d - b * c;
            let dc = [db[0] + bc[0], db[1] + bc[1]];
            if turn(ca, ad) <= 0 || turn(db, bc) <= 0 || dc.iter().any(|x| x.abs() > 1000) {
                continue;
            }
            normal.record(&mesh, e);
            assert!(mesh.flip(e));
            vectors[h.index()] = dc;
            vectors[h.twin().index()] = dc.map(|x| -x);
            flips += 1;
            for e in mesh.edges() {
                let v = vectors[e.halfedge().index()];
                // Between vertices, a line in direction v meets those of a family of edges with directions w |v × w| − 1 times.
                let mut families: Vec<[i64; 2]> = given.iter().map(|&w| w.max(w.map(|x| -x))).collect();
                families.sort_unstable();
                families.dedup();
                let crossings: i64 = families.iter().map(|&w| (turn(v, w).abs() - 1).max(0)).sum();
                let expected = if families.contains(&v.max(v.map(|x| -x))) { -1 } else { crossings };
                assert_eq!(normal.crossings(e), expected, "{v:?}");
            }
        }
    }
}

/// Vectors of the half-edges of a torus of unit squares with one diagonal each.
fn lattice_vectors(mesh: &Mesh, lengths: &[f64]) -> Vec<[i64; 2]> {
    let mut vectors = vec![[0, 0]; mesh.n_halfedges()];
    let start = mesh.halfedges().find(|h| (lengths[h.edge().index()] - 1.0).abs() < 1e-9).unwrap();
    let mut waiting = vec![(start, [1, 0])];
    while let Some((h, v)) = waiting.pop() {
        if vectors[h.index()] != [0, 0] {
            assert_eq!(vectors[h.index()], v);
            continue;
        }
        // The triangle to the left has a right angle between its two unit sides.
        let left = [-v[1], v[0]];
        let sides = [h, mesh.next(h), mesh.prev(h)];
        let long = sides.iter().position(|s| lengths[s.edge().index()] > 1.2).unwrap();
        let half = |x: [i64; 2]| x.map(|x| x / 2);
        let all = match long {
            0 => [v, half([left[0] - v[0], left[1] - v[1]]), half([-v[0] - left[0], -v[1] - left[1]])],
            1 => [v, [left[0] - v[0], left[1] - v[1]], left.map(|x| -x)],
            _ => [v, left, [-v[0] - left[0], -v[1] - left[1]]],
        };
        for (s, w) in sides.into_iter().zip(all) {
            vectors[s.index()] = w;
            waiting.push((s.twin(), w.map(|x| -x)));
        }
    }
    vectors
}

#[test]
fn twists_without_end_are_refused_before_numbers_run_out() {
    let mut mesh = shapes::one_vertex(1).unwrap().build().unwrap().0;
    let mut normal = NormalCoordinates::new(&mesh);
    // Going round the three edges, coordinates grow as the Fibonacci numbers.
    for k in 0..400 {
        let e = EdgeId(k % 3);
        normal.record(&mesh, e);
        assert!(mesh.flip(e));
    }
    assert!(matches!(Curves::trace(&mesh, &normal, &ricci::Control::new()), Err(Error::TooLarge { .. })));
    let other = Mesh::from_soup(&shapes::icosphere(1).unwrap()).unwrap();
    assert!(matches!(normal.check(&other), Err(Error::Size { .. })));
}
