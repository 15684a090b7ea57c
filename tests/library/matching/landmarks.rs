//! Landmarks on surfaces of every topology: they are met and no face folds, or the error names them.

use super::corpus::read;
use super::samples::{check_map, image, moved, potato, surface};
use ricci::harmonic::{Domain, MapConstraints, harmonic_map};
use ricci::matching::{MatchOptions, Matching, Place, SoftLandmark, map_quality, match_surfaces};
use ricci::mesh::shapes::{self, SplitMix64};
use ricci::mesh::{FaceId, Mesh, VertexId};
use ricci::{Control, Surface};

/// Largest distance from its partner at which a landmark counts as met, as a share of the diagonal.
const MISSED: f64 = 1e-8;

fn met(source: &Surface, target: &Surface, landmarks: Vec<[VertexId; 2]>) -> Matching {
    let options = MatchOptions { landmarks: landmarks.clone(), ..MatchOptions::default() };
    let matching = match_surfaces(source, target, &options, &Control::new()).unwrap();
    check_map(&matching, source, target);
    let quality = map_quality([source, target], &matching.forward, &landmarks).unwrap();
    assert!(quality.landmark_error < MISSED, "{landmarks:?}: {:e}", quality.landmark_error);
    matching
}

/// Different random vertices, these numbers of them inside and on the boundary.
fn drawn(mesh: &Mesh, [inside, outside]: [usize; 2], random: &mut SplitMix64) -> Vec<VertexId> {
    let mut all: Vec<VertexId> = Vec::new();
    while all.len() < inside + outside {
        let v = VertexId((random.unit() * mesh.n_vertices() as f64) as u32);
        if mesh.is_boundary_vertex(v) == (all.len() >= inside) && !all.contains(&v) {
            all.push(v);
        }
    }
    all
}

fn pairs(surfaces: [&Surface; 2], counts: [usize; 2], seed: u64) -> Vec<[VertexId; 2]> {
    let mut random = SplitMix64::new(seed);
    let [from, to] = surfaces.map(|s| drawn(s.mesh(), counts, &mut random));
    from.into_iter().zip(to).map(|(a, b)| [a, b]).collect()
}

#[test]
fn one_and_two_landmarks_of_a_sphere_are_met() {
    let source = surface(&potato(8));
    let target = surface(&moved(&potato(7), |[x, y, z]| [x * (1.0 + 0.3 * y), y + 0.2 * z * z, 1.3 * z]));
    for seed in 1..6 {
        for n in [1, 2] {
            met(&source, &target, pairs([&source, &target], [n, 0], seed));
        }
    }
}

#[test]
fn few_landmarks_of_a_disk_are_met() {
    let source = surface(&shapes::disk(8).unwrap());
    let target = surface(&moved(&shapes::disk(9).unwrap(), |[x, y, _]| [x, 1.4 * y, 0.3 * x * x + 0.2 * y]));
    for seed in 1..5 {
        for counts in [[1, 0], [0, 1], [0, 2], [1, 1], [1, 2], [2, 0], [2, 1]] {
            met(&source, &target, pairs([&source, &target], counts, seed));
        }
    }
}

#[test]
fn any_landmarks_of_surfaces_with_handles_are_met() {
    let torus = |small, n, m| shapes::torus(2.0, small, n, m).unwrap();
    let holed = |soup| surface(&shapes::punch(&soup, 1).unwrap());
    let cases = [
        (surface(&torus(0.8, 24, 12)), surface(&torus(0.6, 30, 14)), vec![[2, 0], [5, 0]]),
        (
            surface(&shapes::genus(2, 5).unwrap()),
            surface(&shapes::genus(2, 6).unwrap()),
            vec![[1, 0], [3, 0]],
        ),
        (holed(torus(0.8, 36, 18)), holed(torus(0.7, 32, 18)), vec![[1, 0], [2, 1], [0, 2]]),
    ];
    for (source, target, all) in cases {
        for counts in all {
            for seed in 1..4 {
                met(&source, &target, pairs([&source, &target], counts, seed));
            }
        }
    }
}

#[test]
fn landmarks_that_a_map_brings_together_do_not_change_it() {
    // The map of a torus to another one with one landmark; vertices that it brings near vertices are further landmarks, which move little.
    let source = surface(&shapes::torus(2.0, 0.8, 24, 12).unwrap());
    let target =
        surface(&moved(&shapes::torus(2.0, 0.8, 48, 24).unwrap(), |[x, y, z]| [x, y * (1.0 + 0.1 * x), z]));
    let first = [VertexId(0), VertexId(0)];
    let bare = met(&source, &target, vec![first]);
    let near = bare.forward.nearest_vertices(target.mesh()).unwrap();
    let more = [40, 150, 222].map(|v| [VertexId(v), near[v as usize]]);
    let matching = met(&source, &target, vec![first, more[0], more[1], more[2]]);
    let positions = target.positions().unwrap();
    let [a, b] = [&bare, &matching].map(|m| m.forward.carry(target.mesh(), positions).unwrap());
    let off = a.iter().zip(&b).map(|(p, q)| ricci::geometry::vector::distance(*p, *q)).fold(0.0, f64::max);
    assert!(off < 0.3, "{off}");
    assert!(off > 1e-6, "{off}");
}

#[test]
fn landmarks_of_real_surfaces_with_handles_are_met() {
    for (names, n) in [(["bob", "kitten_10k"], 4), (["eight_766", "eight_3498"], 2)] {
        let [Some(source), Some(target)] = names.map(read) else { return };
        met(&source, &target, pairs([&source, &target], [n, 0], 1));
    }
}

fn place(face: u32, weights: [f64; 3]) -> Place {
    Place { face: FaceId(face), weights }
}

/// The largest distance of the image of a point from the place where it should be, as a share of the target's size.
fn missed(matching: &Matching, target: &Surface) -> f64 {
    let positions = target.positions().unwrap();
    let size = ricci::geometry::vector::diagonal(positions);
    let off = matching
        .points
        .iter()
        .map(|[a, b]| ricci::geometry::vector::distance(image(a, target), image(b, target)));
    off.fold(0.0, f64::max) / size
}

#[test]
fn points_inside_faces_and_on_edges_are_met() {
    let ball = surface(&potato(6));
    let other = surface(&moved(&potato(5), |[x, y, z]| [x * (1.0 + 0.3 * y), y + 0.2 * z * z, 1.3 * z]));
    let torus = surface(&shapes::torus(2.0, 0.8, 24, 12).unwrap());
    let thin = surface(&shapes::torus(2.0, 0.5, 30, 10).unwrap());
    let points = vec![
        [place(10, [0.2, 0.3, 0.5]), place(40, [0.6, 0.3, 0.1])],
        // Two points in one face, one on an edge, one at a corner.
        [place(100, [0.5, 0.0, 0.5]), place(40, [0.1, 0.1, 0.8])],
        [place(200, [0.0, 1.0, 0.0]), place(140, [0.25, 0.5, 0.25])],
        [place(10, [0.7, 0.2, 0.1]), place(230, [0.0, 0.4, 0.6])],
    ];
    for (source, target) in [(&ball, &other), (&torus, &thin)] {
        let options = MatchOptions { points: points.clone(), ..MatchOptions::default() };
        let matching = match_surfaces(source, target, &options, &Control::new()).unwrap();
        check_map(&matching, source, target);
        assert!(
            matching.points.len() == 4 && missed(&matching, target) < MISSED,
            "{}",
            missed(&matching, target)
        );
    }
    // Without the points the map brings them to other places.
    let bare = match_surfaces(&ball, &other, &MatchOptions::default(), &Control::new()).unwrap();
    let corner = ball.mesh().face_vertices(FaceId(200))[1];
    let there = image(&bare.forward.places[corner.index()], &other);
    assert!(ricci::geometry::vector::distance(there, image(&points[2][1], &other)) > 1e-3);
}

#[test]
fn the_vertices_of_a_curve_go_to_the_partner_by_arc_length() {
    // Meridians of two tori with other numbers of vertices, and arcs of two balls.
    let torus = |small, n, m| surface(&shapes::torus(2.0, small, n, m).unwrap());
    let (source, target) = (torus(0.8, 24, 12), torus(0.6, 30, 16));
    let meridian = |s: &Surface, m: usize| -> Vec<VertexId> {
        // The closed path along the tube through vertex 0, which steps to the neighbour whose angle about the axis differs least.
        let p = s.positions().unwrap();
        let first = VertexId(0);
        let mut path = vec![first];
        while path.len() < m {
            let v = path[path.len() - 1];
            let about = |u: VertexId| p[u.index()][1].atan2(p[u.index()][0]);
            let mut tips = s.mesh().outgoing(v).map(|h| s.mesh().tip(h));
            let next = tips.find(|u| !path.contains(u) && (about(*u) - about(first)).abs() < 1e-9);
            path.push(next.unwrap());
        }
        path.push(first);
        path
    };
    let curves = vec![[meridian(&source, 12), meridian(&target, 16)]];
    let options = MatchOptions { curves: curves.clone(), ..MatchOptions::default() };
    let matching = match_surfaces(&source, &target, &options, &Control::new()).unwrap();
    check_map(&matching, &source, &target);
    assert_eq!(matching.points.len(), 12);
    assert!(missed(&matching, &target) < MISSED);
    // All of them lie on the circle that the other curve approximates, within its sagitta.
    let start = target.positions().unwrap()[0];
    let about = start[1].atan2(start[0]);
    for &v in &curves[0][0] {
        let [x, y, _] = image(&matching.forward.places[v.index()], &target);
        assert!((y.atan2(x) - about).abs() < 1e-8);
    }
    let broken = [vec![VertexId(0), VertexId(150)], vec![VertexId(0), VertexId(1)]];
    let options = MatchOptions { curves: vec![broken], ..MatchOptions::default() };
    let error = match_surfaces(&source, &target, &options, &Control::new()).unwrap_err();
    assert!(error.to_string().contains("curve 0") && error.to_string().contains("vertex 150"), "{error}");
}

#[test]
fn soft_landmarks_come_nearer_with_their_weights_and_nothing_folds() {
    let source = surface(&shapes::torus(2.0, 0.8, 24, 12).unwrap());
    let target = surface(&shapes::torus(2.0, 0.6, 30, 16).unwrap());
    let landmarks = vec![[VertexId(0), VertexId(0)]];
    let pairs = [[VertexId(77), VertexId(200)], [VertexId(160), VertexId(190)]];
    let matched = |weight: f64| {
        let soft = pairs.map(|pair| SoftLandmark { pair, weight }).to_vec();
        let options = MatchOptions { landmarks: landmarks.clone(), soft, ..MatchOptions::default() };
        match_surfaces(&source, &target, &options, &Control::new()).unwrap()
    };
    let far = |matching: &Matching| {
        let error = map_quality([&source, &target], &matching.forward, &pairs).unwrap();
        check_map(matching, &source, &target);
        error.landmark_error
    };
    let all = [0.0, 0.3, 3.0, 1e15].map(matched);
    let off = [0, 1, 2, 3].map(|k| far(&all[k]));
    assert!(off[0] > off[1] && off[1] > off[2] && off[2] > off[3] && off[3] < MISSED, "{off:?}");
    let left = |k: usize| all[k].soft_left[0] / all[0].soft_left[0];
    assert!((left(1) - 1.0 / 1.3).abs() < 1e-12 && (left(2) - 0.25).abs() < 1e-12, "{} {}", left(1), left(2));
}

/// The distance by which the middle of a plane disk can move along the x axis, in steps of a thousandth, before faces of the harmonic map
/// that keeps the boundary fold.
fn folds_from(disk: &Surface) -> f64 {
    let (mesh, positions) = (disk.mesh(), disk.positions().unwrap());
    let rim = mesh.vertices().filter(|&v| mesh.is_boundary_vertex(v));
    let mut values: Vec<_> = rim.map(|v| (v, positions[v.index()])).collect();
    values.push((VertexId(0), [1.0, 0.0, 0.0]));
    let domain = Domain::rigid(disk).unwrap();
    let moved =
        harmonic_map(&domain, &MapConstraints { values, flux: None }, &Control::new()).unwrap().points;
    // The map depends linearly on the distance by which the middle moves.
    let folds = |far: f64| {
        let at = |v: VertexId| -> [f64; 2] {
            let [p, q] = [positions[v.index()], moved[v.index()]];
            [0, 1].map(|k| p[k] + far * (q[k] - p[k]))
        };
        mesh.faces().any(|f| {
            let [[a, b], [c, d], [e, g]] = mesh.face_vertices(f).map(at);
            (c - a) * (g - b) - (d - b) * (e - a) <= 0.0
        })
    };
    (1..=1000).map(|k| 1e-3 * f64::from(k)).find(|&far| folds(far)).unwrap()
}

#[test]
fn a_vertex_that_a_spring_pulls_folds_faces_and_a_soft_landmark_does_not() {
    // In the Dirichlet energy a point has no capacity: a spring at the middle of a disk, however strong, moves it and little around it. So
    // faces fold once it has moved by few edges, which is a smaller and smaller share of the disk as the mesh becomes finer.
    let mut shares = Vec::new();
    for n in [4, 8, 16, 32] {
        let disk = surface(&shapes::disk(n).unwrap());
        let first = folds_from(&disk);
        eprintln!("disk of {n} rings: faces fold from {first:.3} of its radius on");
        shares.push(first);
        let end = disk.mesh().vertices().find(|v| {
            let [x, y, _] = disk.positions().unwrap()[v.index()];
            x > 0.6 && y.abs() < 1e-9 && !disk.mesh().is_boundary_vertex(*v)
        });
        let soft = vec![SoftLandmark { pair: [VertexId(0), end.unwrap()], weight: 4.0 }];
        let landmarks = vec![[VertexId(1), VertexId(1)]];
        let options = MatchOptions { soft, landmarks, ..MatchOptions::default() };
        let matching = match_surfaces(&disk, &disk, &options, &Control::new()).unwrap();
        check_map(&matching, &disk, &disk);
        // The landmark has gone 4/5 of the way to its partner.
        let [x, ..] = image(&matching.forward.places[0], &disk);
        assert!(x > 0.45, "{x}");
    }
    assert!(shares.windows(2).all(|pair| pair[1] < 0.75 * pair[0]), "{shares:?}");
}
