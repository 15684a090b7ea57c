//! What cannot be matched is refused by name.

use super::samples::{potato, surface};
use ricci::matching::{MatchOptions, match_surfaces};
use ricci::mesh::{VertexId, shapes};
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
    let torus = surface(&shapes::torus(2.0, 0.8, 12, 8).unwrap());
    let mesh = torus.mesh();
    let n = mesh.n_vertices() as u32;
    // The goal of the second landmark lies between the goals of others, which come from elsewhere.
    let goal = VertexId(30);
    let around: Vec<VertexId> = mesh.outgoing(goal).map(|h| mesh.tip(h)).collect();
    let mut landmarks = vec![[0, 0], [70, goal.0]];
    landmarks.extend(around.iter().enumerate().map(|(k, v)| [n - 1 - k as u32, v.0]));
    let names: Vec<String> = (1..2 + around.len()).map(|k| format!("landmark {k} ")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    refused(&torus, &torus, &landmarks, &names);
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

#[test]
fn a_cancelled_matching_says_so() {
    let ball = surface(&potato(6));
    let control = Control::new();
    control.cancel();
    let error = match_surfaces(&ball, &ball, &MatchOptions::default(), &control).unwrap_err();
    assert_eq!(error, Error::Cancelled);
}
