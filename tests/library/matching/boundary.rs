//! Boundaries go to each other by shares of their lengths, or slide until the map is harmonic up to the boundary.

use super::samples::{check_map, moved, surface};
use ricci::matching::{BoundaryMatching, MatchOptions, Matching, match_surfaces};
use ricci::mesh::{VertexId, shapes};
use ricci::{Control, Surface};

/// Per vertex of the boundary, in order from one of them, the length before it; and the length of the whole boundary.
fn lengths_before(surface: &Surface, start: VertexId) -> (Vec<(VertexId, f64)>, f64) {
    let mesh = surface.mesh();
    let loops = mesh.boundary_loops();
    let around = loops.iter().find(|around| around.iter().any(|&h| mesh.origin(h) == start)).unwrap();
    let first = around.iter().position(|&h| mesh.origin(h) == start).unwrap();
    let (mut all, mut total) = (Vec::new(), 0.0);
    for k in 0..around.len() {
        let h = around[(first + k) % around.len()];
        all.push((mesh.origin(h), total));
        total += surface.lengths()[h.edge()];
    }
    (all, total)
}

/// The share of the target's boundary before the image of a vertex. `before`: the lengths before the target's vertices; `all`: the whole.
fn before_image(
    matching: &Matching,
    target: &Surface,
    (before, all): (&[(VertexId, f64)], f64),
    v: VertexId,
) -> f64 {
    let place = matching.forward.places[v.index()];
    let corners = target.mesh().face_vertices(place.face);
    let of = |v| before.iter().find(|(u, _)| *u == v).expect("an image on the boundary").1;
    // The image lies on an edge of the boundary: the third corner of its face has no weight.
    let at = (0..3).filter(|&k| place.weights[k] > 1e-9).map(|k| (place.weights[k], of(corners[k])));
    let at: Vec<(f64, f64)> = at.collect();
    let largest = at.iter().map(|a| a.1).fold(0.0, f64::max);
    // An edge that ends at the start.
    let unrolled = |y: f64| if largest - y > 0.5 * all { y + all } else { y };
    at.iter().map(|&(w, y)| w * unrolled(y)).sum()
}

/// Largest difference between the share of the boundary before a vertex and that before its image, shares counted between landmarks.
fn off(matching: &Matching, [source, target]: [&Surface; 2], marks: &[VertexId]) -> f64 {
    let (own, total) = lengths_before(source, marks[0]);
    let (other, all) = lengths_before(target, marks[0]);
    let ends = |of: &[(VertexId, f64)], total: f64| -> Vec<f64> {
        let at = |v: &VertexId| of.iter().find(|(u, _)| u == v).unwrap().1;
        let mut ends: Vec<f64> = marks.iter().map(at).chain([total]).collect();
        ends.sort_by(f64::total_cmp);
        ends
    };
    let share = |ends: &[f64], x: f64| {
        let k = (1..ends.len()).find(|&k| x <= ends[k] + 1e-12).unwrap();
        (k - 1) as f64 + (x - ends[k - 1]) / (ends[k] - ends[k - 1])
    };
    let (ends, other_ends) = (ends(&own, total), ends(&other, all));
    let gap = |&(v, x): &(VertexId, f64)| {
        let image = before_image(matching, target, (&other, all), v).min(all);
        let gap = (share(&ends, x) - share(&other_ends, image)).abs();
        gap.min((gap - marks.len() as f64).abs())
    };
    own.iter().map(gap).fold(0.0, f64::max)
}

/// Largest difference between the step from a vertex of a loop to the next one and that between their images, as shares of the loops.
fn uneven(matching: &Matching, [source, target]: [&Surface; 2], start: VertexId) -> f64 {
    let (own, total) = lengths_before(source, start);
    // The meshes have the same vertices.
    let (other, all) = lengths_before(target, start);
    let images: Vec<f64> =
        own.iter().map(|&(v, _)| before_image(matching, target, (&other, all), v) / all).collect();
    let step = |k: usize| {
        let gap = (images[k] - images[k - 1]) - (own[k].1 - own[k - 1].1) / total;
        (gap - gap.round()).abs()
    };
    (1..own.len()).map(step).fold(0.0, f64::max)
}

#[test]
fn boundaries_correspond_by_shares_of_their_length_or_slide() {
    let bent = |n: usize, by: f64| {
        surface(&moved(&shapes::disk(n).unwrap(), |[x, y, _]| {
            [x, y * (1.0 + by * x), by * (x * y + 0.5 * x * x)]
        }))
    };
    let (source, target) = (bent(8, 0.1), bent(8, 0.7));
    let (around, _) = lengths_before(
        &source,
        source.mesh().vertices().find(|&v| source.mesh().is_boundary_vertex(v)).unwrap(),
    );
    for n in [3, 5] {
        let marks: Vec<VertexId> = (0..n).map(|k| around[k * around.len() / n].0).collect();
        let landmarks: Vec<_> = marks.iter().map(|&v| [v, v]).collect();
        let matched = |boundary| {
            let options = MatchOptions { landmarks: landmarks.clone(), boundary, ..MatchOptions::default() };
            let matching = match_surfaces(&source, &target, &options, &Control::new()).unwrap();
            check_map(&matching, &source, &target);
            off(&matching, [&source, &target], &marks)
        };
        let [by_length, sliding] = [BoundaryMatching::ArcLength, BoundaryMatching::Slides].map(matched);
        assert!(by_length < 1e-9, "{n}: {by_length:e}");
        assert!(sliding > 1e-3, "{n}: {sliding:e}");
    }
}

#[test]
fn loops_without_landmarks_keep_shares_of_their_length_too() {
    let lengthened = |soup: &ricci::mesh::io::Soup, by: f64| {
        surface(&moved(soup, |[x, y, z]| [x * (1.0 + by * y), y, z + by * x * y]))
    };
    let annulus = shapes::annulus(0.4, 1.0, 6, 36).unwrap();
    let holes = shapes::punch(&shapes::torus(2.0, 0.8, 36, 18).unwrap(), 2).unwrap();
    let ball = shapes::punch(&super::samples::potato(8), 3).unwrap();
    for (name, soup) in [("annulus", annulus), ("torus with holes", holes), ("three holes", ball)] {
        let (source, target) = (lengthened(&soup, 0.0), lengthened(&soup, 0.2));
        let n = source.mesh().boundary_loops().len();
        let options =
            |boundary| MatchOptions { boundary, loops: Some((0..n).collect()), ..MatchOptions::default() };
        let matching =
            match_surfaces(&source, &target, &options(BoundaryMatching::ArcLength), &Control::new()).unwrap();
        check_map(&matching, &source, &target);
        for around in source.mesh().boundary_loops() {
            let uneven = uneven(&matching, [&source, &target], source.mesh().origin(around[0]));
            // In H² barycentric coordinates along an edge are not shares of its length: with some seven edges around a hole that shows.
            let limit = if name == "annulus" { 1e-9 } else { 0.02 };
            assert!(uneven < limit, "{name}: {uneven:e}");
        }
        let itself =
            match_surfaces(&source, &source, &options(BoundaryMatching::ArcLength), &Control::new()).unwrap();
        assert!(super::samples::apart(&itself, &source) < 1e-8, "{name}");
    }
}
