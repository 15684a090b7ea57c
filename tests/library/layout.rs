//! Layouts of given lengths in the plane, by theorem.

use crate::surfaces::*;
use ricci::embed::quality::DILATATION_CAP;
use ricci::embed::{CirclePattern, Layout, LayoutOpening, LayoutOptions, Quality};
use ricci::flow::{Options, flow};
use ricci::geometry::{PlaneIsometry, Space, vector};
use ricci::mesh::{EdgeId, FaceId, Mesh, PerEdge, VertexId, shapes};
use ricci::metric::CommonSubdivision;
use ricci::topology::cut_graph;
use ricci::{Class, Control, Error, Solution, Surface, Target};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

fn cut_and_unfold(mesh: &Mesh, lengths: &PerEdge<f64>, cones: &[VertexId]) -> Layout {
    gauss_bonnet(mesh, Space::E2, lengths);
    let cut = cut_graph(mesh, lengths, cones, &Control::new()).unwrap();
    Layout::of_lengths(&Arc::new(mesh.clone()), lengths, &cut, &Control::new()).unwrap()
}

fn vertices(n: u32) -> Vec<VertexId> {
    (0..n).map(VertexId).collect()
}

fn distance(p: [f64; 2], q: [f64; 2]) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}

/// Distance of an angle from the multiples of `period`.
fn off_multiple(angle: f64, period: f64) -> f64 {
    (angle - period * (angle / period).round()).abs()
}

/// Curvature from the law of cosines.
fn curvature(mesh: &Mesh, lengths: &PerEdge<f64>, v: VertexId) -> f64 {
    let mut k = TAU;
    for h in mesh.halfedges().filter(|&h| mesh.origin(h) == v) {
        let [a, b, c] = [h, mesh.next(h), mesh.prev(h)].map(|h| lengths[h.edge()]);
        k -= ((a * a + c * c - b * b) / (2.0 * a * c)).acos();
    }
    k
}

fn assert_faithful(mesh: &Mesh, lengths: &PerEdge<f64>, layout: &Layout, tolerance: f64) {
    assert!(layout.flipped.is_empty(), "{} faces flipped", layout.flipped.len());
    assert!(layout.consistency() < tolerance, "{}", layout.consistency());
    for h in mesh.halfedges().filter(|&h| !mesh.is_outside(h)) {
        let l = lengths[h.edge()];
        let measured = distance(layout.uv(h), layout.uv(mesh.next(h)));
        assert!((measured - l).abs() < tolerance * layout.diameter, "{measured} for {l}");
    }
    for seam in &layout.seams {
        assert!(seam.residual < tolerance, "{}", seam.residual);
    }
}

#[test]
fn a_plane_mesh_is_recovered_up_to_an_isometry() {
    for (seed, holes) in [(1, vec![]), (2, vec![(3, 4), (20, 11)]), (3, vec![(0, 4)])] {
        let (mesh, positions) = square(30, &holes, &mut Random(seed));
        let lengths = plane_lengths(&mesh, &positions);
        let layout = cut_and_unfold(&mesh, &lengths, &[]);
        assert_faithful(&mesh, &lengths, &layout, 1e-12);
        // Holes cut the square, but its holonomy is trivial: one isometry fits all corners.
        let pairs = || {
            let inside = mesh.halfedges().filter(|&h| !mesh.is_outside(h));
            inside.map(|h| (layout.uv(h), positions[mesh.origin(h).index()]))
        };
        let n = pairs().count() as f64;
        let mean = |k: usize| [0, 1].map(|x| pairs().map(|(p, q)| [p, q][k][x]).sum::<f64>() / n);
        let (centre, other) = (mean(0), mean(1));
        let vectors =
            pairs().map(|(p, q)| ([p[0] - centre[0], p[1] - centre[1]], [q[0] - other[0], q[1] - other[1]]));
        let g = PlaneIsometry::fit(vectors, pairs());
        let worst = pairs().map(|(p, q)| distance(g.apply(p), q)).fold(0.0, f64::max);
        assert!(worst < 1e-12, "{worst}");
        for seam in &layout.seams {
            let g = seam.isometry();
            assert!(g.rotation.abs() < 1e-12 && g.translation[0].hypot(g.translation[1]) < 1e-12);
        }
        assert!((layout.area - (900 - holes.len()) as f64 / 900.0).abs() < 0.05);
    }
}

#[test]
fn seams_of_a_flat_torus_are_translations_that_generate_its_lattice() {
    for (n, m, tau) in [(1, 1, [0.3, 1.2]), (2, 1, [-0.4, 0.7]), (9, 5, [0.25, 0.6]), (6, 17, [2.7, 1.1])] {
        let (mesh, lengths) = flat_torus(n, m, tau);
        let layout = cut_and_unfold(&mesh, &lengths, &[]);
        assert_faithful(&mesh, &lengths, &layout, 1e-12);
        // Coordinates (s, t) of a translation s + tτ, in the frame where the first edge of face 0 is real.
        let [a, b, _] = layout.face_uv(FaceId(0));
        let turn = PlaneIsometry::new(-(b[1] - a[1]).atan2(b[0] - a[0]), [0.0; 2]);
        let mut periods = Vec::new();
        for seam in &layout.seams {
            let seam = seam.isometry();
            assert!(seam.rotation.abs() < 1e-12, "rotation {}", seam.rotation);
            let [x, y] = turn.apply(seam.translation);
            let (s, t) = (x - y * tau[0] / tau[1], y / tau[1]);
            assert!((s - s.round()).abs() < 1e-11 && (t - t.round()).abs() < 1e-11, "{s} + {t} τ");
            periods.push([s.round() as i64, t.round() as i64]);
        }
        // They generate ℤ + τℤ iff the 2 × 2 minors have no common factor.
        let mut common = 0_i64;
        for p in &periods {
            for q in &periods {
                let (mut a, mut b) = (common, (p[0] * q[1] - p[1] * q[0]).abs());
                while b != 0 {
                    (a, b) = (b, a % b);
                }
                common = a;
            }
        }
        assert_eq!(common, 1, "{periods:?}");
    }
}

/// The holonomy around each interior vertex rotates by its curvature and fixes it.
fn assert_holonomy_is_curvature(mesh: &Mesh, lengths: &PerEdge<f64>, layout: &Layout) {
    for v in mesh.vertices().filter(|&v| !mesh.is_boundary_vertex(v)) {
        let g = PlaneIsometry::from(layout.vertex_holonomy(v).unwrap());
        let off = off_multiple(g.rotation - curvature(mesh, lengths, v), TAU);
        assert!(off < 1e-12, "vertex {v}: off by {off}");
    }
}

#[test]
fn holonomy_around_a_cone_rotates_by_its_curvature() {
    for (mesh, lengths) in [cube(), tetrahedron(), octagon()] {
        let all = vertices(mesh.n_vertices() as u32);
        let layout = cut_and_unfold(&mesh, &lengths, &all);
        assert_faithful(&mesh, &lengths, &layout, 1e-13);
        assert_holonomy_is_curvature(&mesh, &lengths, &layout);
    }
    let angle = 5.0;
    let (mesh, lengths) = cone(6, 7, 0.7, angle);
    let layout = cut_and_unfold(&mesh, &lengths, &[]);
    let around = layout.seams.iter().map(|s| s.isometry().rotation.abs()).fold(0.0, f64::max);
    assert!((around - (TAU - angle)).abs() < 1e-12, "{around}");
}

#[test]
fn holonomy_around_a_cone_fixes_its_image() {
    for (mesh, lengths) in [cube(), tetrahedron()] {
        let layout = cut_and_unfold(&mesh, &lengths, &vertices(mesh.n_vertices() as u32));
        for v in mesh.vertices() {
            let g = PlaneIsometry::from(layout.vertex_holonomy(v).unwrap());
            // The counterclockwise turn starts in the corner of the last half-edge clockwise.
            let start = mesh.outgoing(v).last().unwrap();
            assert!(distance(g.apply(layout.uv(start)), layout.uv(start)) < 1e-13);
        }
    }
}

#[test]
fn seams_of_the_cube_turn_by_right_angles_and_those_of_the_tetrahedron_by_straight_ones() {
    for ((mesh, lengths), step) in [(cube(), FRAC_PI_2), (tetrahedron(), PI)] {
        let layout = cut_and_unfold(&mesh, &lengths, &vertices(mesh.n_vertices() as u32));
        assert!(!layout.seams.is_empty());
        for seam in layout.seams.iter().map(|seam| seam.isometry()) {
            assert!(off_multiple(seam.rotation, step) < 1e-13, "{}", seam.rotation);
            assert!(seam.rotation > -PI && seam.rotation <= PI);
        }
        let area = if step == PI { 3.0_f64.sqrt() } else { 6.0 };
        assert!((layout.area - area).abs() < 1e-13);
    }
}

#[test]
fn edges_that_span_fifteen_orders_of_magnitude_keep_their_local_accuracy() {
    for angle in [TAU, 5.0, 6.0 * PI] {
        let (mesh, lengths) = cone(52, 24, 0.5, angle);
        let range = lengths.iter().fold([f64::MAX, 0.0_f64], |[a, b], &l| [a.min(l), b.max(l)]);
        assert!(range[1] / range[0] > 1e15);
        let layout = cut_and_unfold(&mesh, &lengths, &[]);
        assert!(layout.flipped.is_empty(), "angle {angle}: {} flipped", layout.flipped.len());
        assert!(layout.local_consistency < 1e-11, "angle {angle}: {}", layout.local_consistency);
        assert!(layout.consistency() < 1e-13);
    }
}

#[test]
fn consistency_shows_curvature_inside_the_layout() {
    let (mesh, positions) = square(6, &[], &mut Random(5));
    let mut lengths = plane_lengths(&mesh, &positions);
    let raised = VertexId(24);
    for h in mesh.outgoing(raised) {
        lengths[h.edge()] *= 1.05;
    }
    let flat = cut_and_unfold(&mesh, &lengths, &[]);
    assert!(flat.consistency() > 1e-3);
    let g = PlaneIsometry::from(flat.vertex_holonomy(raised).unwrap());
    assert_eq!(g, PlaneIsometry::IDENTITY, "an uncut vertex has no transition around it");
    assert!(flat.vertex_holonomy(VertexId(0)).is_none());
}

#[test]
fn flipped_faces_are_found_in_the_final_coordinates() {
    let mesh = Mesh::from_faces(3, &[[0, 1, 2]]).unwrap();
    let sides = |l: [f64; 3]| {
        let [bc, ca, ab] = mesh.opposite_edges(FaceId(0));
        let mut lengths = PerEdge::filled(3, 0.0);
        (lengths[bc], lengths[ca], lengths[ab]) = (l[0], l[1], l[2]);
        lengths
    };
    assert!(cut_and_unfold(&mesh, &sides([3.0, 4.0, 5.0]), &[]).flipped.is_empty());
    assert_eq!(cut_and_unfold(&mesh, &sides([2.0, 1.0, 1.0]), &[]).flipped, [FaceId(0)]);
}

#[test]
fn broken_triangles_are_laid_out_flat_and_named() {
    let (mesh, lengths) = flat_torus(6, 6, [0.0, 1.0]);
    let cut = cut_graph(&mesh, &lengths, &[], &Control::new()).unwrap();
    let mut long = lengths.clone();
    let e = EdgeId(3 * 14);
    long[e] = 1.0;
    let layout = Layout::of_lengths(&Arc::new(mesh.clone()), &long, &cut, &Control::new()).unwrap();
    let mut beside = [e.halfedge(), e.halfedge().twin()].map(|h| mesh.face(h).unwrap());
    beside.sort();
    assert_eq!(layout.broken, beside);
    assert!(layout.consistency() > 1e-2 && layout.coordinates.as_flattened().iter().all(|x| x.is_finite()));
    let q = layout.quality(&mesh, &lengths).unwrap();
    assert!(q.qc.iter().chain(&q.area_ratio).all(|x| x.is_finite()));
    assert!(matches!(layout.quality(&mesh, &long), Err(Error::TriangleInequality { .. })));
}

#[test]
fn scaling_to_an_area_scales_coordinates_and_seams() {
    let (mesh, lengths) = flat_torus(5, 4, [0.2, 0.8]);
    let mut layout = cut_and_unfold(&mesh, &lengths, &[]);
    let before = layout.clone();
    let factor = layout.scale_to_area(20.0).unwrap();
    assert!((factor - 5.0).abs() < 1e-12);
    let scaled = |p: [f64; 2]| p.map(|x| factor * x);
    for (p, q) in layout.coordinates.iter().zip(&before.coordinates) {
        assert_eq!(*p, scaled(*q));
    }
    for (s, t) in layout.seams.iter().zip(&before.seams) {
        // Pairings are in double-double precision: the scaled one is rounded once.
        let (p, q) = (s.isometry().translation, scaled(t.isometry().translation));
        assert!((0..2).all(|k| (p[k] - q[k]).abs() <= 4.0 * f64::EPSILON * factor), "{p:?} {q:?}");
    }
    assert!(matches!(layout.scale_to_area(f64::NAN), Err(Error::Argument { .. })));
}

#[test]
fn quality_of_an_isometric_layout_is_one() {
    let (mesh, positions) = square(20, &[(7, 7)], &mut Random(9));
    let lengths = plane_lengths(&mesh, &positions);
    let q = cut_and_unfold(&mesh, &lengths, &[]).quality(&mesh, &lengths).unwrap();
    assert!(q.qc_max < 1.0 + 1e-12 && q.qc_mean < 1.0 + 1e-12 && q.qc_mean >= 1.0);
    assert!(q.area_ratio_min > 1.0 - 1e-11 && q.area_ratio_max < 1.0 + 1e-11);
    assert!(q.degenerate.is_empty());
}

#[test]
fn quality_of_an_affine_stretch_is_the_ratio_of_its_factors() {
    let (mesh, positions) = square(12, &[], &mut Random(10));
    let input = plane_lengths(&mesh, &positions);
    for [a, b] in [[3.0, 2.0], [1.0, 7.0], [1e-3, 1e3]] {
        let stretched: Vec<_> = positions.iter().map(|p| [a * p[0], b * p[1]]).collect();
        let layout = cut_and_unfold(&mesh, &plane_lengths(&mesh, &stretched), &[]);
        let q = layout.quality(&mesh, &input).unwrap();
        let k = f64::max(a / b, b / a);
        let tolerance = 1e-14 * k * k; // lengths of the image know its smaller extent to this
        for f in mesh.faces() {
            assert!((q.qc[f] / k - 1.0).abs() < 1e-12 + tolerance, "{} for {k}", q.qc[f]);
            assert!((q.area_ratio[f] - 1.0).abs() < 1e-11 + tolerance);
        }
        assert!((q.qc_mean / k - 1.0).abs() < 1e-12 + tolerance);
    }
}

/// The subdivision of an icosphere by itself, and its positions as they are on the sphere.
fn round_sphere(subdivisions: usize) -> (Surface, CommonSubdivision) {
    let surface = Surface::from_soup(&shapes::icosphere(subdivisions).unwrap()).unwrap();
    let metric = Solution::initial_of(surface.clone(), Class::yamabe(Space::E2)).unwrap();
    (surface, metric.common_subdivision(&Control::new()).unwrap())
}

#[test]
fn quality_on_the_sphere_is_that_of_the_chords() {
    let (surface, subdivision) = round_sphere(6);
    let (mesh, positions) = (surface.mesh(), surface.positions().unwrap());
    let corners = |f| mesh.face_vertices(f).map(|v| positions[v.index()]);
    let q = Quality::on_sphere(&subdivision, mesh, surface.lengths(), corners).unwrap();
    assert!(q.degenerate.is_empty() && q.qc_max < 1.0 + 1e-12);
    assert!(q.area_ratio_min > 1.0 - 1e-11 && q.area_ratio_max < 1.0 + 1e-11);

    // The input is the sphere stretched along an axis. In a plane with unit normal n the map that undoes that has the singular values 1 and
    // σ, where the product of both is the ratio of areas.
    let stretch = |[x, y, z]: [f64; 3]| [x, y, 4.0 * z];
    let long = PerEdge::from_fn(mesh.n_edges(), |e| {
        let [p, q] = mesh.ends(e).map(|v| stretch(positions[v.index()]));
        vector::distance(p, q)
    });
    let q = Quality::on_sphere(&subdivision, mesh, &long, corners).unwrap();
    let normal = |p| vector::norm(vector::triangle_normal(p));
    for f in mesh.faces() {
        let ratio = normal(corners(f).map(stretch)) / normal(corners(f));
        let k = ratio.max(1.0 / ratio);
        assert!((q.qc[f] / k - 1.0).abs() < 1e-12, "{} for {k}", q.qc[f]);
    }
    assert!(q.qc_max > 3.9 && q.qc_mean > 1.0 && q.area_ratio_min < 1.0 && q.area_ratio_max > 1.0);
}

#[test]
fn pieces_too_small_for_positions_on_the_sphere_are_degenerate() {
    let (surface, subdivision) = round_sphere(2);
    let (mesh, positions) = (surface.mesh(), surface.positions().unwrap());
    let small = |f: FaceId| {
        let [a, b, c] = mesh.face_vertices(f).map(|v| positions[v.index()]);
        let near = |p| vector::lerp(a, p, if f.0 == 3 { 1e-8 } else { 1.0 });
        if f.0 == 5 { [a, b, vector::lerp(a, b, 0.5)] } else { [a, near(b), near(c)] }
    };
    let q = Quality::on_sphere(&subdivision, mesh, surface.lengths(), small).unwrap();
    assert_eq!(q.degenerate, [FaceId(3), FaceId(5)]);
    assert_eq!([q.qc[FaceId(3)], q.qc[FaceId(5)]], [DILATATION_CAP; 2]);
    assert!(q.qc_max < 1.0 + 1e-12 && q.qc_mean < 1.0 + 1e-12);
}

#[test]
fn quality_is_finite_on_needles_and_on_faces_without_area() {
    let mesh = Mesh::from_faces(4, &[[0, 1, 2], [0, 2, 3]]).unwrap();
    let lengths = |l02: f64| {
        PerEdge::from_fn(5, |e: EdgeId| if mesh.ends(e).map(|v| v.0 % 2) == [0, 0] { l02 } else { 1.0 })
    };
    for sliver in [1e-3, 1e-9, 1e-15] {
        let needle = cut_and_unfold(&mesh, &lengths(sliver), &[]);
        let q = needle.quality(&mesh, &lengths(sliver)).unwrap();
        assert!((q.qc_max - 1.0).abs() < 1e-12, "needle {sliver}: {}", q.qc_max);
        // The equilateral triangle becomes the needle by shrinking its base and stretching its height.
        let q = needle.quality(&mesh, &lengths(1.0)).unwrap();
        let height = (1.0 - 0.25 * sliver * sliver).sqrt();
        let expected = (height / 0.75_f64.sqrt()) / sliver;
        assert!((q.qc_max / expected - 1.0).abs() < 1e-12, "{} for {expected}", q.qc_max);
    }
    let flat = cut_and_unfold(&mesh, &lengths(2.0), &[]);
    let q = flat.quality(&mesh, &lengths(1.0)).unwrap();
    assert_eq!(q.degenerate, [FaceId(0), FaceId(1)]);
    assert!(q.qc.iter().all(|&k| k == DILATATION_CAP) && q.qc_mean == 1.0 && q.area_ratio_max.is_finite());
}

#[test]
fn what_cannot_be_laid_out_is_refused_by_name() {
    let (mesh, lengths) = flat_torus(4, 4, [0.0, 1.0]);
    let mesh = Arc::new(mesh);
    let good = cut_graph(&mesh, &lengths, &[], &Control::new()).unwrap();
    let mut open = good.clone();
    open.is_cut.fill(false);
    assert!(matches!(Layout::of_lengths(&mesh, &lengths, &open, &Control::new()), Err(Error::Layout(_))));
    open.is_cut = good.is_cut.clone();
    open.segments[0].push(mesh.edges().find(|&e| !good.is_cut[e]).unwrap().halfedge());
    assert!(matches!(Layout::of_lengths(&mesh, &lengths, &open, &Control::new()), Err(Error::Layout(_))));
    let control = Control::new();
    control.cancel();
    assert_eq!(Layout::of_lengths(&mesh, &lengths, &good, &control), Err(Error::Cancelled));
}

#[test]
fn dual_circles_are_orthogonal_to_vertex_circles_with_and_without_flips() {
    let free = Control::new();
    for n in [3, 9] {
        let sphere = Surface::from_soup(&shapes::ellipsoid([1.0, 2.0, 0.4], n).unwrap()).unwrap();
        let target = Target::default_for(&sphere, Space::E2).unwrap();
        let flat = flow(sphere, Class::inversive(Space::E2), &target, &Options::default(), &free).unwrap();
        let layout = Layout::of_solution(&flat, &LayoutOptions::default(), &free).unwrap();
        let pattern = CirclePattern::new(&layout, flat.mesh(), flat.metric()).unwrap();
        assert_eq!(pattern.dual_circles.len(), flat.mesh().n_faces());
        let power_at = |p: [f64; 2], v: VertexId| {
            let circles = pattern.vertex_circles.iter().filter(|c| c.vertex == v);
            circles.map(|c| distance(p, c.centre).powi(2) - c.radius * c.radius).collect::<Vec<_>>()
        };
        // The two parts of a face that the cut runs through lie apart, and its circle is beside one of them.
        let mut is_cut = vec![false; flat.mesh().n_faces()];
        if let Some(subdivision) = layout.common_subdivision() {
            for e in layout.mesh().edges().filter(|&e| layout.cut.is_cut[e]) {
                let sides = [e.halfedge(), e.halfedge().twin()].map(|h| layout.mesh().face(h).unwrap());
                let [left, right] = sides.map(|f| subdivision.faces[1][f]);
                is_cut[left.index()] |= left == right;
            }
        }
        assert!(is_cut.iter().filter(|cut| **cut).count() < is_cut.len() / 4);
        for (f, circle) in pattern.dual_circles.iter().filter(|(f, _)| !is_cut[f.index()]) {
            for v in flat.mesh().face_vertices(*f) {
                let powers = power_at(circle.centre, v);
                let near = |p: &f64| (p - circle.power).abs() < 1e-7 * (1.0 + circle.power.abs());
                assert!(powers.iter().any(near), "face {f}, vertex {v}: {powers:?}, {}", circle.power);
            }
        }
    }
    let sphere = Surface::from_soup(&shapes::genus(2, 3).unwrap()).unwrap();
    let curved = Solution::initial_of(sphere, Class::inversive(Space::H2)).unwrap();
    let mesh = curved.mesh();
    let options = LayoutOptions { opening: LayoutOpening::MetricEdges, ..LayoutOptions::default() };
    let layout = Layout::of_solution(&curved, &options, &free).unwrap();
    assert!(matches!(CirclePattern::new(&layout, mesh, curved.metric()), Err(Error::Layout(_))));
}

/// Split edges leave the map as it is: every vertex of the input and every point of its faces comes to the same place.
#[test]
fn edges_are_split_where_straight_sides_turn_pieces_over() {
    let plate = Surface::from_soup(&pierced_plate()).unwrap();
    let class = Class::yamabe(Space::H2);
    let solution = flow(plate, class, &Target::Uniform, &Options::default(), &Control::new()).unwrap();
    let lay_out = |straight_sides: bool| {
        let options = LayoutOptions { straight_sides, ..LayoutOptions::default() };
        Layout::of_solution(&solution, &options, &Control::new()).unwrap()
    };
    let [plain, straight] = [false, true].map(lay_out);
    assert!(plain.flipped.is_empty() && straight.flipped.is_empty());
    let [before, after] = [&plain, &straight].map(|l| l.turned_by_straight_sides(&l.coordinates).len());
    assert!(before > 0 && after == 0, "{before} faces, {after} of the split ones");
    let [p, r] = [&plain, &straight].map(|layout| layout.common_subdivision().unwrap());
    assert!(r.mesh.n_vertices() > p.mesh.n_vertices() && r.mesh.euler() == p.mesh.euler());
    assert_eq!((r.n_vertices, r.crossings.len()), (p.n_vertices, p.crossings.len()));
    for (a, b) in
        plain.corner_uv().unwrap().iter().flatten().zip(straight.corner_uv().unwrap().iter().flatten())
    {
        assert!(distance(*a, *b) < 1e-9, "{a:?}, {b:?}");
    }
    let (before, after) = (p.forward(), r.forward());
    for f in solution.given().faces() {
        for weights in [[0.2, 0.3, 0.5], [0.7, 0.2, 0.1], [0.01, 0.01, 0.98]] {
            let ((face, at), (same, there)) =
                (before.image(f, weights).unwrap(), after.image(f, weights).unwrap());
            assert_eq!(face, same);
            assert!((0..3).all(|k| (at[k] - there[k]).abs() < 1e-6), "{f}: {at:?}, {there:?}");
        }
    }
}
