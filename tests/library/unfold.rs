//! Layouts of flows' results: every space, closed and open, flipped or not, cut along the input's edges.

use crate::common::flow::{euclidean, prescribing_target, surface};
use ricci::embed::{CONE_TOLERANCE, Layout, LayoutOpening, LayoutOptions, LayoutScale, Quality, cones_of};
use ricci::flow::{Flips, Options, Solution, auto_cones, flow};
use ricci::geometry::{PlaneIsometry, Space};
use ricci::mesh::io::Soup;
use ricci::mesh::{Mesh, PerEdge, PerVertex, VertexId, shapes};
use ricci::metric::curvature::area;
use ricci::topology::cut::is_disk;
use ricci::topology::cut_graph;
use ricci::{Class, Control, Error, Target};
use std::f64::consts::PI;

fn flow_to(
    (mesh, lengths): &(Mesh, PerEdge<f64>),
    space: Space,
    target: &PerVertex<f64>,
    flips: Flips,
) -> Solution {
    let options = Options { flips, ..Options::default() };
    let (class, target) = (Class::yamabe(space), Target::All(target.clone()));
    let found = flow(euclidean(mesh, lengths), class, &target, &options, &Control::new()).unwrap();
    assert!(found.converged() || flips == Flips::Never);
    found
}

fn with_cones(cones: &[VertexId]) -> LayoutOptions {
    LayoutOptions { cones: Some(cones.to_vec()), ..LayoutOptions::default() }
}

/// The properties of every layout on the surface as it came.
fn check(mesh: &Mesh, layout: &Layout, what: &str) {
    assert!(layout.flipped.is_empty() && layout.broken.is_empty(), "{what}: {:?}", layout.flipped);
    assert!(layout.consistency() <= layout.consistency_limit(1e-9), "{what}: {:e}", layout.consistency());
    let on_input = layout.on_input().unwrap();
    assert!(layout.cut.segments.is_empty() || is_disk(mesh, &on_input.cut.is_cut), "{what}");
    assert_eq!(on_input.cut.segments.len(), layout.seams.len(), "{what}");
    let index = |h| on_input.corner_index[h];
    for e in mesh.edges().filter(|&e| !mesh.is_boundary_edge(e)) {
        let (h, t) = (e.halfedge(), e.halfedge().twin());
        let joined = index(h) == index(mesh.next(t)) && index(mesh.next(h)) == index(t);
        assert!(joined || on_input.cut.is_cut[e], "{what}: edge {e}");
    }
    if let Some(r) = layout.common_subdivision() {
        for e in r.mesh.edges().filter(|&e| layout.cut.is_cut[e]) {
            assert!(r.edge(0, e).is_some_and(|e| on_input.cut.is_cut[e]), "{what}: edge {e}");
        }
    }
    let corners = layout.corner_uv().unwrap();
    assert_eq!(corners.len(), mesh.n_faces());
    assert!(corners.as_flattened().as_flattened().iter().all(|x| x.is_finite()), "{what}");
    // Few faces fold over: some of those that final edges cross in strongly bent regions.
    assert!(50 * on_input.flipped.len() <= mesh.n_faces(), "{what}: {} fold", on_input.flipped.len());
    println!(
        "{what}: {} seams, {} of {} faces fold",
        layout.seams.len(),
        on_input.flipped.len(),
        mesh.n_faces()
    );
}

/// Where faces fold, splits leave none: every point lies on an edge of the input, the triangles of a face fill it in the input, and none is
/// turned over in the layout.
fn check_repair((mesh, lengths): &(Mesh, PerEdge<f64>), layout: &Layout, what: &str) {
    let (on_input, repaired) =
        (layout.on_input().unwrap(), layout.repaired_input(&Control::new()).unwrap().unwrap());
    let (r, n) = (&repaired.refinement, repaired.n_added());
    assert!(repaired.flipped.is_empty(), "{what}: {:?}", repaired.flipped);
    assert_eq!(repaired.split_edges.is_empty(), on_input.flipped.is_empty(), "{what}");
    let most = layout.common_subdivision().map_or(0, |r| r.crossings.len());
    assert!(n >= repaired.split_edges.len() && n <= most, "{what}: {n} of {most} points");
    assert_eq!((r.mesh.n_vertices(), r.mesh.euler()), (mesh.n_vertices() + n, mesh.euler()), "{what}");
    let mut share = vec![0.0; mesh.n_faces()];
    for f in r.mesh.faces() {
        let [a, b, c] = r.barycentric(0, f);
        let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
        let part = a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1);
        assert!(part > 0.0, "{what}: triangle {f}");
        share[r.faces[0][f].index()] += part;
    }
    assert!(share.iter().all(|whole| (whole - 1.0).abs() < 1e-12), "{what}");
    for e in r.mesh.edges().filter(|&e| !r.mesh.is_boundary_edge(e)) {
        let (h, t) = (e.halfedge(), e.halfedge().twin());
        let at = |h| repaired.corner_index[h];
        let joined = at(h) == at(r.mesh.next(t)) && at(r.mesh.next(h)) == at(t);
        assert!(joined || r.edge(0, e).is_some_and(|e| on_input.cut.is_cut[e]), "{what}: edge {e}");
    }
    let quality = layout.quality_of_repaired(&repaired, lengths).unwrap();
    assert!(quality.degenerate.is_empty() && quality.qc.len() == r.mesh.n_faces(), "{what}");
}

/// K + 1/K for the dilatation K of a linear map of triangles: the squared norm of its derivative over the determinant, computed from squared
/// lengths and areas.
fn check_quality((mesh, lengths): &(Mesh, PerEdge<f64>), corners: &[[[f64; 2]; 3]], quality: &Quality) {
    let [mut areas, mut images] = [Vec::new(), Vec::new()];
    for f in mesh.faces() {
        let squares = mesh.opposite_edges(f).map(|e| lengths[e] * lengths[e]);
        let [a, b, c] = squares;
        let area = 0.25 * (2.0 * (a * b + b * c + c * a) - a * a - b * b - c * c).sqrt();
        let p = corners[f.index()];
        let across = |i: usize, j: usize| [p[i][0] - p[j][0], p[i][1] - p[j][1]];
        let ([x, y], [z, w]) = (across(1, 0), across(2, 0));
        let image = 0.5 * (x * w - y * z).abs();
        let norm: f64 = (0..3)
            .map(|k| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                let [x, y] = across(i, j);
                (squares[i] + squares[j] - squares[k]) * (x * x + y * y)
            })
            .sum();
        let (expected, k) = (norm / (8.0 * area * image), quality.qc[f]);
        assert!((k + 1.0 / k - expected).abs() < 1e-9 * expected * expected, "face {f}: {k} for {expected}");
        areas.push(area);
        images.push(image);
    }
    let (all, whole) = (areas.iter().sum::<f64>(), images.iter().sum::<f64>());
    for (f, (area, image)) in areas.into_iter().zip(images).enumerate() {
        let expected = (image / whole) / (area / all);
        assert!((quality.area_ratio[f.into()] - expected).abs() < 1e-9 * (1.0 + expected), "face {f}");
    }
}

/// Rounding errors in a target make no cones: eight cones on a sphere are joined by seven seams, and some more if those branch.
#[test]
fn noise_in_a_target_makes_no_cones() {
    let surface = surface(&shapes::ellipsoid([1.0, 1.3, 0.8], 12).unwrap());
    let (mesh, lengths) = &surface;
    let cones = auto_cones(mesh, lengths, 8, &Control::new()).unwrap();
    let mut target = cones.target.clone();
    for v in mesh.vertices().filter(|&v| cones.target[v] == 0.0) {
        target[v] = if v.0 % 2 == 0 { 1e-17 } else { -1e-17 };
    }
    let result = flow_to(&surface, Space::E2, &target, Flips::Auto);
    for cones in [Some(cones_of(mesh, &target, CONE_TOLERANCE).unwrap()), None] {
        let options = LayoutOptions { cones, ..LayoutOptions::default() };
        let layout = Layout::of_solution(&result, &options, &Control::new()).unwrap();
        assert!((7..=9).contains(&layout.seams.len()), "{}", layout.seams.len());
        check(mesh, &layout, "ellipsoid");
    }
}

#[test]
fn layouts_in_the_plane_are_cut_along_the_inputs_edges() {
    let torus = shapes::torus(2.0, 0.8, 20, 12).unwrap();
    let open = shapes::punch(&torus, 2).unwrap();
    let surfaces: [(&str, Soup); 4] = [
        ("torus", torus.clone()),
        ("open torus", open),
        ("ellipsoid", shapes::ellipsoid([1.0, 2.0, 0.5], 8).unwrap()),
        ("genus 2", shapes::genus(2, 4).unwrap()),
    ];
    for (name, soup) in surfaces {
        let surface = surface(&soup);
        let mesh = &surface.0;
        let given = euclidean(mesh, &surface.1);
        let target = match mesh.euler() {
            2 => auto_cones(mesh, &surface.1, 6, &Control::new()).unwrap().target,
            -2 => Target::Single(VertexId(3)).values(&given, Space::E2).unwrap(),
            _ => prescribing_target(&given, Space::E2).values(&given, Space::E2).unwrap(),
        };
        for flips in [Flips::Auto, Flips::Never] {
            if ["genus 2", "open torus"].contains(&name) && flips == Flips::Never {
                continue;
            }
            let result = flow_to(&surface, Space::E2, &target, flips);
            let cones = cones_of(mesh, &target, CONE_TOLERANCE).unwrap();
            let layout = Layout::of_solution(&result, &with_cones(&cones), &Control::new()).unwrap();
            let what = format!("{name}, flips {flips:?}, {} of them", result.flips());
            check(mesh, &layout, &what);
            assert_eq!(layout.common_subdivision().is_some(), !result.is_unflipped());
            let given_area = area(mesh, Space::E2, &surface.1).unwrap();
            assert!((layout.area / given_area - 1.0).abs() < 1e-12, "{what}");
            let options = LayoutOptions { scale: LayoutScale::AsSolved, ..with_cones(&cones) };
            let solved = Layout::of_solution(&result, &options, &Control::new()).unwrap();
            assert_eq!(solved.scale, 1.0);
            assert!((solved.area * layout.scale * layout.scale / given_area - 1.0).abs() < 1e-12, "{what}");
            let quality = layout.quality(mesh, &surface.1).unwrap();
            assert!(quality.qc_mean >= 1.0 && quality.qc_mean < 3.0, "{what}: {}", quality.qc_mean);
            let on_input = layout.quality_on_input(&surface.1).unwrap().unwrap();
            assert_eq!(on_input == quality, result.is_unflipped(), "{what}");
            check_quality(&surface, &layout.corner_uv().unwrap(), &on_input);
            check_repair(&surface, &layout, &what);
        }
    }
}

#[test]
fn layouts_in_the_hyperbolic_plane_are_cut_along_the_inputs_edges() {
    let torus = shapes::torus(2.0, 0.8, 20, 12).unwrap();
    let surfaces: [(&str, Soup); 3] = [
        ("genus 2", shapes::genus(2, 4).unwrap()),
        ("genus 3", shapes::genus(3, 3).unwrap()),
        ("torus with 2 holes", shapes::punch(&torus, 2).unwrap()),
    ];
    for (name, soup) in surfaces {
        let surface = surface(&soup);
        let mesh = &surface.0;
        let result = flow_to(&surface, Space::H2, &PerVertex::filled(mesh.n_vertices(), 0.0), Flips::Auto);
        let layout = Layout::of_solution(&result, &with_cones(&[]), &Control::new()).unwrap();
        check(mesh, &layout, name);
        check_repair(&surface, &layout, name);
        assert!((layout.area + 2.0 * PI * mesh.euler() as f64).abs() < 1e-8, "{name}: {}", layout.area);
        // The root lies at the origin, and a cone on the cut.
        let root = VertexId(5);
        let options = LayoutOptions { root: Some(root), ..with_cones(&[VertexId(9)]) };
        let other = Layout::of_solution(&result, &options, &Control::new()).unwrap();
        check(mesh, &other, name);
        let laid = other.mesh();
        let at_root = laid.halfedges().filter(|&h| !laid.is_outside(h) && laid.origin(h) == root);
        assert!(at_root.into_iter().any(|h| other.uv(h)[0].hypot(other.uv(h)[1]) < 1e-15), "{name}");
        if !mesh.is_boundary_vertex(VertexId(9)) {
            assert!(laid.outgoing(VertexId(9)).any(|h| other.cut.is_cut[h.edge()]), "{name}");
        }
    }
}

/// A layout of a subdivision and one of the metric's triangulation about the same vertex agree near that vertex.
#[test]
fn subdivisions_lie_as_their_final_faces_do() {
    let surface = surface(&shapes::genus(2, 3).unwrap());
    let result = flow_to(&surface, Space::H2, &PerVertex::filled(surface.0.n_vertices(), 0.0), Flips::Auto);
    let control = Control::new();
    let root = Some(VertexId(7));
    let options = LayoutOptions {
        opening: LayoutOpening::MetricEdges,
        scale: LayoutScale::AsSolved,
        root,
        ..with_cones(&[])
    };
    let whole = Layout::of_solution(&result, &options, &control).unwrap();
    let layout = Layout::of_solution(&result, &LayoutOptions { root, ..with_cones(&[]) }, &control).unwrap();
    let around = |layout: &Layout| {
        let mesh = layout.mesh();
        let near = mesh.outgoing(VertexId(7)).map(|h| mesh.tip(h)).collect::<Vec<_>>();
        let lies = |v: VertexId| {
            mesh.halfedges()
                .filter(|&h| mesh.origin(h) == v)
                .map(|h| layout.uv(h))
                .min_by(|p, q| p[0].hypot(p[1]).total_cmp(&q[0].hypot(q[1])))
                .unwrap()
        };
        near.into_iter()
            .filter(|v| v.index() < surface.0.n_vertices())
            .map(|v| (v, lies(v)))
            .collect::<Vec<_>>()
    };
    let known = around(&whole);
    let mut compared = 0;
    for (v, p) in around(&layout) {
        for (_, q) in known.iter().filter(|(w, _)| *w == v) {
            assert!((p[0] - q[0]).hypot(p[1] - q[1]) < 1e-12, "vertex {v}");
            compared += 1;
        }
    }
    assert!(compared > 2);
}

#[test]
fn a_sphere_in_its_own_space_has_no_cut_and_an_explicit_cut_is_kept() {
    let flat = surface(&shapes::torus(2.0, 0.8, 12, 8).unwrap());
    let (mesh, lengths) = &flat;
    let result = flow_to(&flat, Space::E2, &PerVertex::filled(mesh.n_vertices(), 0.0), Flips::Auto);
    let cut = cut_graph(mesh, lengths, &[VertexId(4)], &Control::new()).unwrap();
    let options = LayoutOptions { opening: LayoutOpening::InputCut(cut.clone()), ..with_cones(&[]) };
    let layout = Layout::of_solution(&result, &options, &Control::new()).unwrap();
    check(mesh, &layout, "torus");
    assert_eq!(layout.on_input().unwrap().cut, cut);
    assert!(layout.modulus().is_some());
    for seam in &layout.seams {
        assert!(PlaneIsometry::from(seam.pairing).rotation.abs() < 1e-9);
    }

    let round = surface(&shapes::icosphere(4).unwrap());
    let (mesh, lengths) = &round;
    let (options, control) = (Options { tolerance: 1e-8, ..Options::default() }, Control::new());
    let class = Class::yamabe(Space::S2);
    let found = flow(euclidean(mesh, lengths), class, &Target::Uniform, &options, &control).unwrap();
    let layout = Layout::of_solution(&found, &with_cones(&[]), &control).unwrap();
    assert!(layout.seams.is_empty() && layout.flipped.is_empty());
    assert!((layout.area - 4.0 * PI).abs() < 1e-6, "{}", layout.area);
}

#[test]
fn layouts_do_not_depend_on_the_number_of_threads() {
    let surface = surface(&shapes::genus(2, 8).unwrap());
    let mesh = &surface.0;
    let cone = VertexId(11);
    let target = Target::Single(cone).values(&euclidean(mesh, &surface.1), Space::E2).unwrap();
    let flat = flow_to(&surface, Space::E2, &target, Flips::Auto);
    let curved = flow_to(&surface, Space::H2, &PerVertex::filled(mesh.n_vertices(), 0.0), Flips::Auto);
    for (result, cones) in [(flat, vec![cone]), (curved, Vec::new())] {
        let on = |threads: usize| {
            Layout::of_solution(&result, &LayoutOptions { threads, ..with_cones(&cones) }, &Control::new())
                .unwrap()
        };
        let (one, three) = (on(1), on(3));
        assert_eq!(one, three);
        assert_eq!(one, Layout::of_solution(&result, &with_cones(&cones), &Control::new()).unwrap());
        let quality = |layout: &Layout| layout.quality(mesh, &surface.1).unwrap();
        assert_eq!(quality(&one), quality(&three));
    }
}

#[test]
fn impossible_layouts_are_refused_by_name() {
    let round = surface(&shapes::icosphere(3).unwrap());
    let (mesh, lengths) = &round;
    let cones = auto_cones(mesh, lengths, 4, &Control::new()).unwrap().target;
    let result = flow_to(&round, Space::E2, &cones, Flips::Auto);
    let refused =
        |options: &LayoutOptions| Layout::of_solution(&result, options, &Control::new()).unwrap_err();
    assert!(matches!(refused(&with_cones(&[VertexId(1)])), Error::Layout(_)));
    let n = mesh.n_vertices() as u32;
    assert!(matches!(refused(&with_cones(&[VertexId(n)])), Error::Argument { .. }));
    let root = LayoutOptions { root: Some(VertexId(n)), ..LayoutOptions::default() };
    assert!(matches!(refused(&root), Error::Argument { .. }));
    assert!(matches!(cones_of(mesh, &[0.0], 1e-10), Err(Error::Size { .. })));
    let mut layout = Layout::of_solution(&result, &LayoutOptions::default(), &Control::new()).unwrap();
    assert!(matches!(layout.scale_to_area(f64::NAN), Err(Error::Argument { .. })));
}

/// Needles in space whose layout has other diagonals: faces of the input fold, and all of them are mended.
#[test]
fn every_fold_of_a_sheared_surface_is_mended() {
    let mut folds = 0;
    for (shear, height) in [(3.0, 0.8), (8.0, 1.6), (8.0, 3.0)] {
        let mut soup = shapes::disk(10).unwrap();
        for p in &mut soup.positions {
            let [x, y, _] = *p;
            *p = [x + shear * y, y, height * (2.0 * x).sin() * (3.0 * y).cos()];
        }
        let surface = surface(&soup);
        let given = euclidean(&surface.0, &surface.1);
        let target = Target::Boundary.values(&given, Space::E2).unwrap();
        let result = flow_to(&surface, Space::E2, &target, Flips::Auto);
        let layout = Layout::of_solution(&result, &LayoutOptions::default(), &Control::new()).unwrap();
        folds += layout.on_input().unwrap().flipped.len();
        check_repair(&surface, &layout, &format!("disk sheared by {shear}"));
    }
    assert!(folds > 2, "{folds} faces fold");
}
