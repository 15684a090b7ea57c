//! Landmarks on surfaces of every topology: whatever they are, they are met and no face folds, or the error names them.

use super::corpus::read;
use super::samples::{check_map, moved, potato, surface};
use ricci::matching::{MatchOptions, Matching, map_quality, match_surfaces};
use ricci::mesh::shapes::{self, SplitMix64};
use ricci::mesh::{Mesh, VertexId};
use ricci::{Control, Surface};

/// Share of the diagonal by which landmarks may be missed.
const MISSED: f64 = 1e-8;

fn met(source: &Surface, target: &Surface, landmarks: Vec<[VertexId; 2]>) -> Matching {
    let options = MatchOptions { landmarks: landmarks.clone(), ..MatchOptions::default() };
    let matching = match_surfaces(source, target, &options, &Control::new()).unwrap();
    check_map(&matching, source, target);
    let quality = map_quality([source, target], &matching.forward, &landmarks).unwrap();
    assert!(quality.landmark_error < MISSED, "{landmarks:?}: {:e}", quality.landmark_error);
    matching
}

/// Different vertices, so many inside and on the boundary.
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
    // The map of a torus to another one with one landmark, and the vertices that it brings near vertices as further landmarks: these move little.
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
