//! The surfaces of the tests, and measures of maps between them that do not use the library's own measures.

use ricci::matching::{MatchOptions, Matching, Place, match_surfaces};
use ricci::mesh::io::Soup;
use ricci::mesh::{Point, VertexId, shapes};
use ricci::{Control, Surface};

pub fn surface(soup: &Soup) -> Surface {
    Surface::from_soup(soup).unwrap()
}

/// A soup after a map of its points.
pub fn moved(soup: &Soup, to: impl Fn(Point) -> Point) -> Soup {
    Soup { positions: soup.positions.iter().map(|&p| to(p)).collect(), ..soup.clone() }
}

/// A rotation, a change of size and a shift.
pub fn similar([x, y, z]: Point) -> Point {
    let (sin, cos) = 0.7f64.sin_cos();
    [3.0 * (cos * x - sin * y) + 1.0, 3.0 * (sin * x + cos * y), 3.0 * z - 2.0]
}

/// A dented ball of which no rotation is a symmetry.
pub fn potato(n: usize) -> Soup {
    let ball = shapes::icosphere(n).unwrap();
    moved(&ball, |[x, y, z]| {
        let r = 1.0 + 0.2 * x + 0.15 * (2.0 * y + 0.5).sin() + 0.1 * (z - 0.3 * x).cos();
        [1.2 * r * x, r * y, 0.9 * r * z]
    })
}

pub fn matched(source: &Surface, target: &Surface, landmarks: &[u32]) -> Matching {
    let landmarks = landmarks.iter().map(|&v| [VertexId(v), VertexId(v)]).collect();
    // The loops keep their numbers, whatever their lengths are.
    let loops = Some((0..source.mesh().boundary_loops().len()).collect());
    let options = MatchOptions { landmarks, loops, ..MatchOptions::default() };
    match_surfaces(source, target, &options, &Control::new()).unwrap()
}

pub fn distance(p: Point, q: Point) -> f64 {
    (0..3).map(|k| (p[k] - q[k]) * (p[k] - q[k])).sum::<f64>().sqrt()
}

pub fn image(place: &Place, target: &Surface) -> Point {
    let corners = target.mesh().face_vertices(place.face).map(|v| target.positions().unwrap()[v.index()]);
    std::array::from_fn(|i| (0..3).map(|k| place.weights[k] * corners[k][i]).sum())
}

fn size(surface: &Surface) -> f64 {
    let all = surface.positions().unwrap();
    let ends = |k: usize| all.iter().fold([f64::MAX, f64::MIN], |[a, b], p| [a.min(p[k]), b.max(p[k])]);
    (0..3).map(|k| (ends(k)[1] - ends(k)[0]).powi(2)).sum::<f64>().sqrt()
}

/// Per vertex the distance of its image from the place where it should be, as a share of the target's size.
pub fn apart_from(matching: &Matching, target: &Surface, wanted: impl Fn(usize) -> Point) -> Vec<f64> {
    let places = matching.forward.places.iter().enumerate();
    places.map(|(v, place)| distance(image(place, target), wanted(v)) / size(target)).collect()
}

/// The largest distance of a vertex from the target's vertex of the same number.
pub fn apart(matching: &Matching, target: &Surface) -> f64 {
    apart_from(matching, target, |v| target.positions().unwrap()[v]).into_iter().fold(0.0, f64::max)
}

/// Asserts that no face folds, that the places of vertices are barycentric coordinates in faces, and that the map is in balance.
pub fn check_map(matching: &Matching, source: &Surface, target: &Surface) {
    assert!(matching.flipped.is_empty() && matching.target_flipped.is_empty());
    for (map, from, to) in [(&matching.forward, source, target), (&matching.backward, target, source)] {
        assert_eq!(map.places.len(), from.mesh().n_vertices());
        for place in &map.places {
            assert!(place.face.index() < to.mesh().n_faces());
            assert!(place.weights.iter().all(|w| *w >= 0.0), "{place:?}");
            assert!((place.weights.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{place:?}");
        }
    }
    assert!(matching.balance.iter().all(|report| report.residual < 1e-9), "{:?}", matching.balance);
}
