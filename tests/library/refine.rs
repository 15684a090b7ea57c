//! Refinement of triangle lists in space, and of metrics to a least angle: the surface stays what it was.

use ricci::geometry::Space;
use ricci::mesh::check::diagnose;
use ricci::mesh::io::{NumberColumn, NumberType, Soup};
use ricci::mesh::refine::{Refine, RefinedSoup, least_faces, longest_edge, refine};
use ricci::mesh::{Mesh, PerEdge, Place, VertexId, shapes};
use ricci::metric::ShapeQuality;
use ricci::metric::angle_refinement::{AngleRefinement, AngleReport, FinerMetric, refine_to_angle};
use ricci::{Control, Error, Surface};
use std::f64::consts::TAU;

/// Checks that every vertex and face lies where the way back says, that the area and χ are those of the given list, and that the faces of a
/// given face cover it once.
fn check(given: &Soup, finer: &RefinedSoup) {
    let at = |v: u32| given.positions[v as usize];
    let (size, n) = (longest_edge(given), given.positions.len());
    assert_eq!(finer.soup.positions[..n], given.positions[..]);
    for (place, p) in finer.vertex_place.iter().zip(&finer.soup.positions) {
        let place = place.unwrap();
        let corners = given.faces[place.face.index()].map(at);
        assert!(place.weights.iter().all(|w| *w >= 0.0) && place.weights.iter().sum::<f64>() == 1.0);
        for k in 0..3 {
            let x: f64 = (0..3).map(|c| place.weights[c] * corners[c][k]).sum();
            assert!((x - p[k]).abs() <= 1e-14 * size.max(p[k].abs()));
        }
    }
    let area = |soup: &Soup| ShapeQuality::of_soup(soup).area;
    assert!((area(&finer.soup) / area(given) - 1.0).abs() < 1e-12);
    let euler = |soup: &Soup| diagnose(&soup.positions, &soup.faces).euler;
    assert_eq!(euler(&finer.soup), euler(given));
    assert!(finer.face_origin.windows(2).all(|pair| pair[0] <= pair[1]));
    let part = |f: u32| -> Soup {
        let own = finer.face_origin.iter().zip(&finer.soup.faces).filter(|(origin, _)| **origin == f);
        Soup::new(finer.soup.positions.clone(), own.map(|(_, face)| *face).collect())
    };
    let whole = Soup::new(given.positions.clone(), vec![given.faces[0]]);
    assert!((area(&part(0)) / area(&whole) - 1.0).abs() < 1e-12);
}

#[test]
fn levels_cut_every_face_into_four() {
    for given in [shapes::torus(2.0, 1.0, 9, 5).unwrap(), shapes::disk(3).unwrap()] {
        let finer = refine(&given, &Refine { levels: 2, longest_edge: None }, &Control::new()).unwrap();
        assert_eq!(finer.soup.faces.len(), 16 * given.faces.len());
        assert!((finer.longest_edge() / longest_edge(&given) - 0.25).abs() < 1e-12);
        check(&given, &finer);
        // Similar triangles have the same angles.
        let angle = |soup: &Soup| ShapeQuality::of_soup(soup).min_angle.unwrap();
        assert!((angle(&finer.soup) - angle(&given)).abs() < 1e-12);
    }
}

#[test]
fn edges_are_split_until_none_is_too_long() {
    let given = shapes::torus(2.0, 0.4, 7, 12).unwrap();
    for bound in [1.0, 0.31, 0.05] {
        let options = Refine { levels: 0, longest_edge: Some(bound) };
        let finer = refine(&given, &options, &Control::new()).unwrap();
        let least = least_faces(&given, &options).unwrap();
        assert!(least >= given.faces.len() && least <= finer.soup.faces.len());
        assert!(finer.longest_edge() <= bound && Mesh::from_soup(&finer.soup).unwrap().genus() == 1);
        check(&given, &finer);
    }
    let same = refine(&given, &Refine { levels: 0, longest_edge: Some(10.0) }, &Control::new()).unwrap();
    assert_eq!(same.soup, given);
}

#[test]
fn lists_that_are_no_surface_are_refined_and_attributes_are_interpolated() {
    // Three faces in one edge, beside a separate one and an isolated vertex.
    let mut positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
    positions.extend([[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [5.0, 1.0, 0.0], [9.0, 9.0, 9.0]]);
    let faces = vec![[0, 1, 2], [0, 1, 3], [0, 1, 4], [5, 6, 7]];
    let mut soup = Soup::new(positions, faces);
    soup.attributes.colors = Some((0..9).map(|v| [f64::from(v) / 8.0, 0.0, 0.0, 1.0]).collect());
    soup.attributes.uv =
        Some((0..4).map(|f| [[f64::from(f), 0.0], [f64::from(f), 1.0], [0.0, 1.0]]).collect());
    let column = |kind, values: Vec<f64>| NumberColumn { name: "n".into(), kind, values };
    soup.attributes.vertex_numbers = vec![column(NumberType::F64, (0..9).map(f64::from).collect())];
    soup.attributes.face_numbers = vec![column(NumberType::U8, vec![4.0, 5.0, 6.0, 7.0])];
    let finer = refine(&soup, &Refine { levels: 1, longest_edge: None }, &Control::new()).unwrap();
    let carried = &finer.soup.attributes;
    let of_face = finer.face_origin.iter().map(|f| 4.0 + f64::from(*f)).collect::<Vec<_>>();
    assert_eq!(carried.face_numbers[0].values, of_face);
    let numbers = carried.vertex_numbers[0].values.iter();
    // The colours are the same numbers over 8.
    let red = carried.colors.as_ref().unwrap().iter().map(|color| 8.0 * color[0]);
    assert!(numbers.zip(red).all(|(x, y)| (x - y).abs() < 1e-14));
    // The three faces share the midpoint of their common edge: 7 edges get a midpoint, and 3 of the separate face.
    assert_eq!((finer.soup.positions.len(), finer.soup.faces.len()), (9 + 7 + 3, 16));
    assert!(finer.vertex_place[8].is_none() && finer.vertex_place[..8].iter().all(Option::is_some));
    let colors = finer.soup.attributes.colors.as_ref().unwrap();
    let uv = finer.soup.attributes.uv.as_ref().unwrap();
    for (f, face) in finer.soup.faces.iter().enumerate() {
        for (k, &v) in face.iter().enumerate() {
            let p = finer.soup.positions[v as usize];
            let origin = finer.face_origin[f];
            if origin == 0 {
                // Linear on the face with corners of colour 0, 1/8, 2/8 and coordinates (0, 0), (0, 1), (0, 1).
                assert!((colors[v as usize][0] - (p[0] + 2.0 * p[1]) / 8.0).abs() < 1e-15);
                assert!((uv[f][k][1] - p[0] - p[1]).abs() < 1e-15);
            }
        }
    }
    let twice = Soup::new(soup.positions.clone(), vec![[0, 1, 1]]);
    assert!(matches!(refine(&twice, &Refine::default(), &Control::new()), Err(Error::Argument { .. })));
    let endless = Refine { levels: 40, longest_edge: None };
    assert!(refine(&soup, &endless, &Control::new()).unwrap_err().to_string().contains("67 million"));
    // A needle has no area, but its sides have as many parts as fit on them.
    let needle = Soup::new(vec![[0.0; 3], [1e9, 0.0, 0.0], [0.0, 1e-9, 0.0]], vec![[0, 1, 2]]);
    let short = Refine { longest_edge: Some(1.0), ..Refine::default() };
    assert!(refine(&needle, &short, &Control::new()).unwrap_err().to_string().contains("67 million"));
    let negative = Refine { levels: 0, longest_edge: Some(-1.0) };
    assert!(matches!(refine(&soup, &negative, &Control::new()), Err(Error::Argument { .. })));
}

/// Checks the places of a refined metric's vertices: given vertices are their own places; no edge, a geodesic, is shorter than the straight
/// line in space between its ends, and where both lie in one given face and the edge is as long as that line, it is the line.
fn check_places(given: &Surface, finer: &Surface, places: &[Place]) {
    let Some(positions) = given.positions() else { return };
    let mesh = given.mesh();
    assert_eq!(places.len(), finer.mesh().n_vertices());
    let at = |v: VertexId| {
        let Place { face, weights } = places[v.index()];
        assert!(weights.iter().all(|&w| w >= 0.0) && (weights.iter().sum::<f64>() - 1.0).abs() < 1e-14);
        let corners = mesh.face_vertices(face).map(|v| positions[v.index()]);
        [0, 1, 2].map(|i| (0..3).map(|k| weights[k] * corners[k][i]).sum::<f64>())
    };
    for v in mesh.vertices() {
        assert_eq!(at(v), positions[v.index()]);
    }
    let mut in_one_face = 0;
    for e in finer.mesh().edges() {
        let (ends, length) = (finer.mesh().ends(e), finer.lengths()[e]);
        let [a, b] = ends.map(at);
        let straight = (0..3).map(|k| (b[k] - a[k]).powi(2)).sum::<f64>().sqrt();
        assert!(straight <= length * (1.0 + 1e-9), "edge {e}: {length} in a line of {straight}");
        let [f, g] = ends.map(|v| places[v.index()].face);
        in_one_face += usize::from(f == g && straight > length * (1.0 - 1e-9));
    }
    let added = finer.mesh().n_vertices() - mesh.n_vertices();
    assert!(
        added < 100 || in_one_face > added / 10,
        "{in_one_face} edges in one face, {added} vertices added"
    );
}

/// Refines to an angle and checks that area, χ and boundary length stay, and that the smallest angle is what the report says.
fn refined(surface: &Surface, degrees: f64) -> (Surface, AngleReport) {
    let options = AngleRefinement { least_angle: degrees.to_radians(), most_added: 0 };
    let FinerMetric { surface: finer, places, report } =
        refine_to_angle(surface, &options, &Control::new()).unwrap();
    check_places(surface, &finer, &places);
    let (before, after) = (surface.mesh(), finer.mesh());
    assert_eq!(before.euler(), after.euler());
    assert_eq!(after.n_vertices(), before.n_vertices() + report.inside + report.on_boundary);
    assert!((finer.area().unwrap() / surface.area().unwrap() - 1.0).abs() < 1e-10);
    let around = |s: &Surface| -> Vec<f64> {
        let length = |rim: Vec<ricci::mesh::HalfedgeId>| rim.iter().map(|h| s.lengths()[h.edge()]).sum();
        let mut all: Vec<f64> = s.mesh().boundary_loops().into_iter().map(length).collect();
        all.sort_by(f64::total_cmp);
        all
    };
    for (x, y) in around(surface).into_iter().zip(around(&finer)) {
        assert!((x / y - 1.0).abs() < 1e-12);
    }
    assert_eq!(report.below, 0);
    let quality = ShapeQuality::of_surface(&finer);
    // Edges of which both diagonals are Delaunay may count as either.
    assert!(quality.non_delaunay_fraction.unwrap() < 0.01);
    if report.forced == 0 {
        assert!((quality.min_angle.unwrap() - report.least_angle).abs() < 1e-12);
        assert!(report.least_angle >= degrees.to_radians());
    }
    (finer, report)
}

#[test]
fn thin_triangles_are_refined_to_the_angle_on_closed_surfaces_and_open_ones() {
    // Tubes of long thin triangles, closed and open, and a needle-shaped strip.
    let torus = Surface::from_soup(&shapes::torus(3.0, 0.2, 8, 30).unwrap()).unwrap();
    assert!(refined(&torus, 25.0).1.inside > 100);
    let sphere = Surface::from_soup(&shapes::ellipsoid([1.0, 0.05, 8.0], 3).unwrap()).unwrap();
    refined(&sphere, 25.0);
    let strip = |n: u32| {
        let positions = (0..2 * n).map(|k| [f64::from(k / 2), 0.01 * f64::from(k % 2), 0.0]).collect();
        let quads = (0..n - 1).map(|k| 2 * k);
        let faces = quads.flat_map(|a| [[a, a + 2, a + 3], [a, a + 3, a + 1]]).collect();
        Surface::from_soup(&Soup::new(positions, faces)).unwrap()
    };
    let (_, report) = refined(&strip(4), 25.0);
    assert!(report.on_boundary > 200 && report.given_angle < 0.011);
}

#[test]
fn cones_keep_their_curvature_and_narrow_corners_are_told() {
    // A disk of six triangles about a cone of angle 6 · 2 asin(1/4), and a wedge of 20° with sides of different lengths.
    let fan: Vec<[u32; 3]> = (0..6).map(|k| [0, k + 1, (k + 1) % 6 + 1]).collect();
    let mesh = Mesh::from_faces(7, &fan).unwrap();
    let is_rim = |e| mesh.ends(e).iter().all(|v| v.0 != 0);
    let lengths = PerEdge::from_fn(mesh.n_edges(), |e| if is_rim(e) { 0.5 } else { 1.0 });
    let cone = Surface::intrinsic(mesh, lengths, Space::E2).unwrap();
    let (finer, _) = refined(&cone, 25.0);
    let at = |s: &Surface| {
        let faces = s.mesh().fan(VertexId(0));
        let sides = |h| [h, s.mesh().next(h), s.mesh().prev(h)].map(|h| s.lengths()[h.edge()]);
        faces
            .into_iter()
            .map(sides)
            .map(|[c, a, b]| ((b * b + c * c - a * a) / (2.0 * b * c)).acos())
            .sum::<f64>()
    };
    assert!((at(&finer) - at(&cone)).abs() < 1e-10 && at(&cone) < TAU);
    let wedge = 20f64.to_radians();
    let soup = Soup::new(
        vec![[0.0; 3], [1.0, 0.0, 0.0], [0.7 * wedge.cos(), 0.7 * wedge.sin(), 0.0]],
        vec![[0, 1, 2]],
    );
    let (_, report) = refined(&Surface::from_soup(&soup).unwrap(), 25.0);
    assert!(report.forced > 0 && report.least_angle >= 25f64.to_radians());
}

#[test]
fn angles_out_of_reach_and_other_geometries_are_refused() {
    let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 8, 6).unwrap()).unwrap();
    for degrees in [0.0, 31.0, f64::NAN] {
        let options = AngleRefinement { least_angle: degrees.to_radians(), most_added: 0 };
        assert!(matches!(refine_to_angle(&torus, &options, &Control::new()), Err(Error::Argument { .. })));
    }
    let hyperbolic = torus.clone().read_in(Space::H2);
    let options = AngleRefinement::default();
    assert!(matches!(refine_to_angle(&hyperbolic, &options, &Control::new()), Err(Error::Argument { .. })));
    // A limit on the vertices leaves small angles, and says how many.
    let thin = Surface::from_soup(&shapes::torus(3.0, 0.2, 8, 30).unwrap()).unwrap();
    let few = AngleRefinement { most_added: 5, ..AngleRefinement::default() };
    let FinerMetric { surface: finer, report, .. } = refine_to_angle(&thin, &few, &Control::new()).unwrap();
    assert!(report.below > 0 && finer.mesh().n_vertices() == thin.mesh().n_vertices() + 5);
}
