//! Surfaces and landmarks that cannot be matched are refused, and the error names them.

use super::samples::{potato, surface};
use ricci::matching::{MatchOptions, Place, SoftLandmark, match_surfaces};
use ricci::mesh::shapes::SplitMix64;
use ricci::mesh::{FaceId, Mesh, VertexId, shapes};
use ricci::{Control, Error, Surface};

fn refused(source: &Surface, target: &Surface, landmarks: &[[u32; 2]], words: &[&str]) {
    let landmarks = landmarks.iter().map(|pair| pair.map(VertexId)).collect();
    let options = MatchOptions { landmarks, ..MatchOptions::default() };
    let error = match_surfaces(source, target, &options, &Control::new()).unwrap_err();
    assert_eq!(error.code(), 650, "{error}");
    let text = error.to_string();
    assert!(words.iter().all(|word| text.contains(word)), "{text}");
}

#[test]
fn surfaces_of_different_topology_and_landmarks_in_conflict_are_named() {
    let ball = surface(&potato(4));
    let torus = surface(&shapes::torus(2.0, 0.8, 12, 8).unwrap());
    let disk = surface(&shapes::disk(5).unwrap());
    let annulus = surface(&shapes::annulus(0.4, 1.0, 4, 24).unwrap());
    refused(&ball, &torus, &[], &["genus 0", "1"]);
    refused(&disk, &annulus, &[], &["1 boundary loops", "2"]);
    refused(&ball, &ball, &[[0, 1], [2, 1]], &["landmarks 0 and 1", "vertex 1", "target"]);
    refused(&torus, &torus, &[[0, 0], [5, 6], [7, 6]], &["landmarks 1 and 2", "vertex 6"]);
    let edge = disk.mesh().vertices().find(|&v| disk.mesh().is_boundary_vertex(v)).unwrap();
    refused(&disk, &disk, &[[edge.0, 0]], &["landmark 0", "boundary of the source"]);
    let around: Vec<u32> =
        disk.mesh().vertices().filter(|&v| disk.mesh().is_boundary_vertex(v)).map(|v| v.0).collect();
    let [a, b, c, d] = [0, 1, 2, 3].map(|k| around[k * around.len() / 4]);
    refused(&disk, &disk, &[[a, a], [b, c], [c, b], [d, d]], &["boundary loop 0", "order"]);
}

#[test]
fn landmarks_that_bar_the_way_of_another_one_are_named() {
    // All vertices of a small torus are landmarks and change places: there is no room for the paths of all of them.
    let torus = surface(&shapes::torus(2.0, 0.8, 8, 5).unwrap());
    let n = torus.mesh().n_vertices();
    let mut conflicts = 0;
    for seed in 1..5 {
        let mut random = SplitMix64::new(seed);
        let mut goals: Vec<u32> = (0..n as u32).collect();
        (1..n).for_each(|k| goals.swap(k, (random.unit() * (k + 1) as f64) as usize));
        let landmarks = goals.iter().enumerate().map(|(k, &to)| [VertexId(k as u32), VertexId(to)]).collect();
        let options = MatchOptions { landmarks, ..MatchOptions::default() };
        let Err(error) = match_surfaces(&torus, &torus, &options, &Control::new()) else { continue };
        let text = error.to_string();
        assert!(error.code() == 650, "{text}");
        if let Some((first, others)) = text.split_once(" has no way to its goal: it is in conflict with ") {
            let (number, vertices) = first.rsplit_once("landmark ").unwrap().1.split_once(' ').unwrap();
            let k: usize = number.parse().unwrap();
            // The error names one of the landmarks after the first, which is met by a shift of the torus.
            assert!(vertices.starts_with(&format!("(vertices {k} and {})", goals[k])), "{text}");
            assert!(others.contains("landmark ") && others.contains("(vertices "), "{text}");
            conflicts += 1;
        }
    }
    assert!(conflicts > 0);
}

#[test]
fn a_landmark_that_is_no_vertex_and_loops_that_are_no_permutation_are_named() {
    let annulus = surface(&shapes::annulus(0.4, 1.0, 4, 24).unwrap());
    let options = MatchOptions { landmarks: vec![[VertexId(0), VertexId(9999)]], ..MatchOptions::default() };
    let error = match_surfaces(&annulus, &annulus, &options, &Control::new()).unwrap_err();
    assert!(matches!(error, Error::Argument { .. }), "{error}");
    let options = MatchOptions { loops: Some(vec![1, 1]), ..MatchOptions::default() };
    let error = match_surfaces(&annulus, &annulus, &options, &Control::new()).unwrap_err();
    assert!(error.to_string().contains("[1, 1]"), "{error}");
}

/// The text of the error with which a surface is not matched to itself.
fn why(surface: &Surface, options: &MatchOptions) -> String {
    match_surfaces(surface, surface, options, &Control::new()).unwrap_err().to_string()
}

#[test]
fn points_outside_their_faces_and_soft_landmarks_on_boundaries_are_named() {
    let disk = surface(&shapes::disk(5).unwrap());
    let place = |face: u32, weights: [f64; 3]| Place { face: FaceId(face), weights };
    let inside = place(3, [0.25, 0.25, 0.5]);
    for (wrong, word) in [
        (place(9999, [0.25, 0.25, 0.5]), "9999"),
        (place(3, [0.5, 0.75, -0.25]), "weights of a point"),
        (place(3, [0.5, 0.5, 0.5]), "weights of a point"),
        (place(3, [f64::NAN, 0.5, 0.5]), "weights of a point"),
    ] {
        for points in [vec![[inside, wrong]], vec![[wrong, inside]]] {
            let text = why(&disk, &MatchOptions { points, ..MatchOptions::default() });
            assert!(text.contains(word), "{text}");
        }
    }
    let rim = disk.mesh().vertices().find(|&v| disk.mesh().is_boundary_vertex(v)).unwrap();
    let soft = |pair, weight| {
        let soft = vec![SoftLandmark { pair, weight }];
        why(&disk, &MatchOptions { soft, ..MatchOptions::default() })
    };
    let inner = VertexId(0);
    assert!(
        soft([inner, rim], 1.0).contains(&format!("soft landmark 0 lies on the boundary, at vertex {rim}"))
    );
    assert!(soft([inner, VertexId(9999)], 1.0).contains("9999"));
    for weight in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(soft([inner, inner], weight).contains("weight of a landmark"));
    }
    // Two points at one place, as a landmark and a point, and as two points.
    let corner = Place::at_vertex(disk.mesh(), inner).unwrap();
    let options = MatchOptions {
        landmarks: vec![[inner, inner]],
        points: vec![[inside, corner]],
        ..MatchOptions::default()
    };
    assert!(why(&disk, &options).contains("landmarks 0 and 1 conflict"), "{}", why(&disk, &options));
}

#[test]
fn curves_that_do_not_correspond_are_named() {
    let disk = surface(&shapes::disk(5).unwrap());
    let ring = |mesh: &Mesh| -> Vec<VertexId> { mesh.face_vertices(FaceId(0)).to_vec() };
    let open = ring(disk.mesh());
    let closed: Vec<VertexId> = open.iter().chain(&open[..1]).copied().collect();
    let text = |pair: [Vec<VertexId>; 2]| {
        why(&disk, &MatchOptions { curves: vec![pair], ..MatchOptions::default() })
    };
    assert!(text([open.clone(), closed.clone()]).contains("curve 0 closes on one surface"));
    assert!(
        text([open[..1].to_vec(), open.clone()])
            .contains("curve 0 has fewer than two vertices on the source")
    );
    assert!(text([open.clone(), Vec::new()]).contains("curve 0 has fewer than two vertices on the target"));
    assert!(text([open.clone(), vec![open[0], VertexId(9999)]]).contains("9999"));
    assert!(Place::at_vertex(disk.mesh(), VertexId(9999)).is_err());
}

#[test]
fn a_cancelled_matching_says_so() {
    let ball = surface(&potato(6));
    let control = Control::new();
    control.cancel();
    let error = match_surfaces(&ball, &ball, &MatchOptions::default(), &control).unwrap_err();
    assert_eq!(error, Error::Cancelled);
}
