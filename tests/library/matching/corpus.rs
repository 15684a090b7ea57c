//! Maps between pairs of real surfaces.

use super::samples::{apart, check_map};
use ricci::matching::{MatchOptions, match_surfaces};
use ricci::mesh::VertexId;
use ricci::topology::farthest_vertices;
use ricci::{Control, Surface};

pub fn read(name: &str) -> Option<Surface> {
    let folder = crate::common::corpus("good")?;
    Some(Surface::read(folder.join(format!("{name}.obj"))).unwrap())
}

#[test]
fn no_face_of_two_cats_folds_and_landmarks_bring_their_vertices_near_each_other() {
    let (Some(source), Some(target)) = (read("pair_cat_A"), read("pair_cat_B")) else { return };
    let vertices =
        farthest_vertices(source.mesh(), source.lengths(), VertexId(0), 16, &Control::new()).unwrap();
    let off = [4, 16].map(|n| {
        let landmarks = vertices[..n].iter().map(|&v| [v, v]).collect();
        let options = MatchOptions { landmarks, ..MatchOptions::default() };
        let matching = match_surfaces(&source, &target, &options, &Control::new()).unwrap();
        check_map_nearly(&matching, &source, &target);
        apart(&matching, &target)
    });
    assert!(off[1] < 0.3 * off[0] && off[1] < 0.06, "{off:?}");
}

/// As [`check_map`], with a tolerance for surfaces whose domain reaches so far out that the balance loses digits.
fn check_map_nearly(matching: &ricci::matching::Matching, source: &Surface, target: &Surface) {
    assert!(matching.balance.iter().all(|report| report.residual < 1e-6));
    let mut exact = matching.clone();
    exact.balance.iter_mut().for_each(|report| report.residual = 0.0);
    check_map(&exact, source, target);
}

#[test]
fn no_face_folds_between_two_meshes_of_genus_2() {
    let (Some(source), Some(target)) = (read("eight_766"), read("eight_3498")) else { return };
    let matching = match_surfaces(&source, &target, &MatchOptions::default(), &Control::new()).unwrap();
    check_map(&matching, &source, &target);
}

#[test]
fn surfaces_with_far_and_with_tiny_parts_go_to_themselves_by_the_identity() {
    // Among them are domains in H² of radius 18 and 22, a torus with a part of 1e-14 of its size, a long torus with thin faces, surfaces with
    // long words, and domains of radius 51 and 73.
    let far = ["couplingdown", "airplane_27b", "cow_oded_low", "trim_star", "plate_holes", "tray_bottom"];
    for name in far.into_iter().chain(["derived_fertility_3disks", "b9_mesh", "elephant_with_holes"]) {
        let Some(surface) = read(name) else { return };
        let matching = match_surfaces(&surface, &surface, &MatchOptions::default(), &Control::new()).unwrap();
        check_map(&matching, &surface, &surface);
        let apart = apart(&matching, &surface);
        assert!(apart < 1e-8, "{name}: {apart:e}");
    }
}
