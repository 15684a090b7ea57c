//! Small surfaces, Δ-complexes among them, against independent facts.

use crate::common::Random;
use crate::common::flow::default_target;
use crate::common_subdivision::check::determinant;
use crate::common_subdivision::flown::flow;
use ricci::Control;
use ricci::geometry::flip::Hinge;
use ricci::geometry::{DoubleDouble, Space};
use ricci::mesh::{EdgeId, FaceId, Mesh, NormalCoordinates, PerEdge, PerVertex, VertexId, shapes};
use ricci::metric::common_subdivision::{FinalTriangulation, InputTriangulation, Triangulations};
use ricci::metric::{Class, CommonSubdivision, Metric, Scheme, initial_metric, lengths_from_positions};
use std::f64::consts::PI;
use std::sync::Arc;

#[test]
fn without_flips_the_subdivision_is_the_input() {
    let soup = shapes::genus(2, 3).unwrap();
    let mesh = Mesh::from_soup(&soup).unwrap();
    let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
    let initial = initial_metric(&mesh, &lengths, Space::E2, Class::inversive(Space::E2)).unwrap();
    let normal = NormalCoordinates::new(&mesh);
    let mut metric = initial.metric;
    metric.u.iter_mut().for_each(|u| *u += 0.5);
    let given = InputTriangulation { mesh: &mesh, geometry: Space::E2, u: &initial.input_u };
    let result = FinalTriangulation { mesh: &mesh, metric: &metric, normal: &normal };
    let all = Triangulations { input: given, intrinsic: None, result };
    let r = CommonSubdivision::new(all, &|_| true, &Control::new()).unwrap();
    assert_eq!(r.mesh.n_vertices(), mesh.n_vertices());
    for f in r.mesh.faces() {
        assert_eq!(r.mesh.face_vertices(f), mesh.face_vertices(f));
        assert!(r.faces[0][f] == f && r.faces[1][f] == f);
    }
    assert!(r.weight.iter().all(|q| (q * 0.5f64.exp() - 1.0).abs() < 1e-14));
}

/// Flip at random inside the class (ε = 0: every edge can be flipped), recording.
pub fn shuffle(
    mesh: &mut Mesh,
    metric: &mut Metric,
    normal: &mut NormalCoordinates,
    flips: usize,
    seed: u64,
) -> Vec<EdgeId> {
    let mut random = Random::new(seed);
    let mut done = Vec::new();
    while done.len() < flips {
        let e = EdgeId(random.below(mesh.n_edges()) as u32);
        done.extend(ptolemy(mesh, metric, normal, e).then_some(e));
    }
    done
}

fn ptolemy(mesh: &mut Mesh, metric: &mut Metric, normal: &mut NormalCoordinates, e: EdgeId) -> bool {
    let h = e.halfedge();
    if mesh.face(h).is_none() || mesh.face(h.twin()).is_none() || mesh.face(h) == mesh.face(h.twin()) {
        return false;
    }
    let sides = [h, mesh.prev(h), mesh.next(h), mesh.next(h.twin()), mesh.prev(h.twin())];
    let eta = Arc::make_mut(&mut metric.eta);
    eta[e] =
        Hinge::from_products([DoubleDouble::default(); 4], sides.map(|h| eta[h.edge()])).flipped().unwrap();
    normal.record(mesh, e);
    mesh.flip(e)
}

#[test]
fn refined_from_either_side_the_crossings_are_the_same() {
    let surfaces = [
        (shapes::one_vertex(1).unwrap().build().unwrap().0, 5),
        (shapes::one_vertex(2).unwrap().build().unwrap().0, 12),
        (shapes::two_vertex(2).unwrap().build().unwrap().0, 20),
        (shapes::two_triangle_sphere().build().unwrap().0, 6),
        (Mesh::from_soup(&shapes::disk(3).unwrap()).unwrap(), 80),
        (Mesh::from_soup(&shapes::genus(2, 3).unwrap()).unwrap(), 400),
    ];
    let mut total = 0;
    for (k, (before, flips)) in surfaces.into_iter().enumerate() {
        let mut random = Random::new(k as u64);
        let class = Metric {
            space: Space::E2,
            epsilon: PerVertex::filled(before.n_vertices(), 0),
            eta: Arc::new(PerEdge::from_fn(before.n_edges(), |_| (3.0 * random.symmetric()).exp().into())),
            u: PerVertex::from_fn(before.n_vertices(), |_| random.symmetric()),
            u_low: PerVertex::filled(before.n_vertices(), 0.0),
        };
        let (mut after, mut metric, mut normal) =
            (before.clone(), class.clone(), NormalCoordinates::new(&before));
        let done = shuffle(&mut after, &mut metric, &mut normal, flips, 7);
        let (mut back, mut again) = (after.clone(), metric.clone());
        let mut reverse = NormalCoordinates::new(&after);
        for &e in done.iter().rev() {
            (0..3).for_each(|_| assert!(ptolemy(&mut back, &mut again, &mut reverse, e)));
        }
        let refine = |a: &Mesh, b: &Mesh, metric: &Metric, normal: &NormalCoordinates| {
            let given = InputTriangulation { mesh: a, geometry: Space::E2, u: &metric.u };
            let result = FinalTriangulation { mesh: b, metric, normal };
            CommonSubdivision::new(
                Triangulations { input: given, intrinsic: None, result },
                &|_| true,
                &Control::new(),
            )
            .unwrap()
        };
        let there = refine(&before, &after, &metric, &normal);
        let here = refine(&after, &back, &again, &reverse);
        assert_eq!(there.mesh.euler(), before.euler());
        assert_eq!(there.mesh.boundary_loops().len(), before.boundary_loops().len());
        assert_eq!(there.crossings.len(), here.crossings.len());
        total += there.crossings.len();
        let mut one: Vec<_> = there
            .crossings
            .iter()
            .map(|c| (c[0].edge, c[1].edge, c[0].weights[1], c[1].weights[1]))
            .collect();
        let mut two: Vec<_> =
            here.crossings.iter().map(|c| (c[1].edge, c[0].edge, c[1].weights[1], c[0].weights[1])).collect();
        for list in [&mut one, &mut two] {
            list.sort_by(|a, b| (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2)));
        }
        for (a, b) in one.iter().zip(&two) {
            assert!(
                (a.0, a.1) == (b.0, b.1) && (a.2 - b.2).abs() < 1e-11 && (a.3 - b.3).abs() < 1e-11,
                "{a:?} {b:?}"
            );
        }
        // The weight of the way back is the inverse, up to a crossing's number.
        let product = |r: &CommonSubdivision| r.weight.iter().map(|q| q.ln()).sum::<f64>();
        assert!((product(&there) + product(&here)).abs() < 1e-9);
        // Pieces fill the faces of both.
        for (r, n) in [(&there, before.n_faces()), (&here, after.n_faces())] {
            let mut area = vec![[0.0; 2]; n];
            for f in r.mesh.faces() {
                area[r.faces[0][f].index()][0] += determinant(r.barycentric(0, f));
                area[r.faces[1][f].index()][1] += determinant(r.barycentric(1, f));
            }
            assert!(area.iter().flatten().all(|a| (a - 1.0).abs() < 1e-12), "{area:?}");
        }
    }
    assert!(total > 400, "{total}");
}

#[test]
fn edges_across_a_cocircular_quadrilateral_stay_straight() {
    let mut random = Random::new(4);
    let mut seen = 0;
    for round in 0..400 {
        let (space, epsilon) = ([Space::E2, Space::H2][round / 2 % 2], (round % 2) as i8);
        // A circle of radius 1 about the origin. ε = 0: four points on it. ε = 1: four circles orthogonal to it, with their centres
        // outside; radii by Pythagoras.
        let polar: Vec<[f64; 2]> = (0..4)
            .map(|k| {
                let angle = 0.5 * PI * (f64::from(k) + 0.4 * random.symmetric());
                [if epsilon == 0 { 1.0 } else { 1.1 + 0.02 * random.symmetric() }, angle]
            })
            .collect();
        let radius = |r: f64| match space {
            Space::E2 => (r * r - 1.0).sqrt(),
            _ => (r.cosh() / 1f64.cosh()).acosh(),
        };
        let u = PerVertex::from_fn(4, |v: VertexId| match (epsilon, space, polar[v.index()][0]) {
            (0, ..) => 0.3,
            (_, Space::E2, r) => radius(r).ln(),
            (_, _, r) => (0.5 * radius(r)).tanh().ln(),
        });
        // Positions as vectors: (x, y, 1), the hyperboloid.
        let at: Vec<[f64; 3]> = polar
            .iter()
            .map(|&[r, angle]| {
                let (out, up) = if space == Space::E2 { (r, 1.0) } else { (r.sinh(), r.cosh()) };
                [out * angle.cos(), out * angle.sin(), up]
            })
            .collect();
        let eta = |mesh: &Mesh, e: EdgeId| {
            let [a, b] = mesh.ends(e).map(VertexId::index);
            let [p, q] = [at[a], at[b]];
            let scales = (u[VertexId::from(a)] + u[VertexId::from(b)]).exp();
            let r = [a, b].map(|v| radius(polar[v][0]));
            let flat = p[0] * q[0] + p[1] * q[1];
            let squared = (p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2);
            match (space, epsilon) {
                (Space::E2, 0) => squared / (2.0 * scales),
                (Space::E2, _) => (squared - r[0] * r[0] - r[1] * r[1]) / (2.0 * scales),
                (_, 0) => (p[2] * q[2] - flat - 1.0) / (4.0 * scales),
                _ => (p[2] * q[2] - flat - r[0].cosh() * r[1].cosh()) / (r[0].sinh() * r[1].sinh()),
            }
        };
        let before = Mesh::from_faces(4, &[[0, 1, 2], [0, 2, 3]]).unwrap();
        let (mut mesh, mut normal) = (before.clone(), NormalCoordinates::new(&before));
        let diagonal = mesh.edges().find(|&e| !mesh.is_boundary_edge(e)).unwrap();
        normal.record(&mesh, diagonal);
        assert!(mesh.flip(diagonal));
        let metric = Metric {
            space,
            epsilon: PerVertex::filled(4, epsilon),
            eta: Arc::new(PerEdge::from_fn(5, |e| eta(&mesh, e).into())),
            u: u.clone(),
            u_low: PerVertex::filled(4, 0.0),
        };
        if epsilon == 1 && metric.eta.iter().any(|eta| eta.high < 1.001) {
            continue;
        }
        seen += 1;
        let given = InputTriangulation { mesh: &before, geometry: space, u: &u };
        let result = FinalTriangulation { mesh: &mesh, metric: &metric, normal: &normal };
        let r = CommonSubdivision::new(
            Triangulations { input: given, intrinsic: None, result },
            &|_| true,
            &Control::new(),
        )
        .unwrap();
        // The diagonals' common point, as a combination of their ends.
        let volume = |a: usize, b: usize, c: usize| determinant([at[a], at[b], at[c]]);
        let c = r.crossings[0];
        for (ends, weights, [from, to], [one, other]) in
            [(c[0].ends, c[0].weights, [0, 2], [1, 3]), (c[1].ends, c[1].weights, [1, 3], [2, 0])]
        {
            let share = volume(from, one, other) / (volume(from, one, other) + volume(to, other, one));
            let found = weights[usize::from(ends[1].index() == to)];
            assert!((found - share).abs() < 1e-12, "{space} {epsilon}: {found} {share}");
        }
        // The surface is mapped to itself: both say the same vector.
        assert!(r.weight.iter().take(4).all(|q| (q - 1.0).abs() < 1e-14));
        let point = |ends: [VertexId; 2], w: [f64; 2], i: usize| {
            w[0] * at[ends[0].index()][i] + w[1] * at[ends[1].index()][i]
        };
        let q = r.weight[VertexId(4)];
        for i in 0..3 {
            let [p, image] = [point(c[0].ends, c[0].weights, i), q * point(c[1].ends, c[1].weights, i)];
            assert!((p - image).abs() < 1e-12, "{space} {epsilon}: {p} {image}");
        }
    }
    assert!(seen > 250, "{seen}");
}

#[test]
fn values_are_carried_through_both_triangulations() {
    let soup = shapes::genus(2, 3).unwrap();
    let mesh = Mesh::from_soup(&soup).unwrap();
    let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
    let target = default_target(&mesh, &lengths, Space::E2, Scheme::Yamabe);
    let flown = flow(&mesh, &lengths, (Space::E2, Scheme::Yamabe), &target, None).unwrap();
    let r = flown.refine(&mesh, None);
    assert!(!r.crossings.is_empty());
    // Values at corners that are those of the vertices are those of the vertices.
    let corners = |mesh: &Mesh| -> Vec<_> {
        mesh.faces().map(|f| mesh.face_vertices(f).map(|v| soup.positions[v.index()])).collect()
    };
    let of_input = (r.from_vertices(0, &soup.positions), r.from_corners(0, &corners(&mesh)));
    let of_final = (r.from_vertices(1, &soup.positions), r.from_corners(1, &corners(&flown.mesh)));
    for (at_vertices, at_corners) in [of_input, of_final] {
        let (at_vertices, at_corners) = (at_vertices.unwrap(), at_corners.unwrap());
        for f in r.mesh.faces() {
            for (v, value) in r.mesh.face_vertices(f).into_iter().zip(at_corners[f.index()]) {
                for i in 0..3 {
                    assert!((at_vertices[v.index()][i] - value[i]).abs() < 1e-14);
                }
            }
        }
    }
    assert!(r.from_vertices(0, &soup.positions[1..]).is_err());
    assert!(r.from_corners(0, &corners(&mesh)[1..]).is_err());
    // Points map across the common border of two pieces without a jump.
    let forward = r.forward();
    for h in r.mesh.halfedges().step_by(5) {
        let (f, g) = (r.mesh.face(h).unwrap(), r.mesh.face(h.twin()).unwrap());
        let middle = |f, h| {
            let k = r.mesh.face_halfedges(f).iter().position(|&x| x == h).unwrap();
            let b = r.barycentric(0, f);
            [0, 1, 2].map(|i| 0.3 * b[k][i] + 0.7 * b[(k + 1) % 3][i])
        };
        let other = |f, h| {
            let k = r.mesh.face_halfedges(f).iter().position(|&x| x == h).unwrap();
            let b = r.barycentric(0, f);
            [0, 1, 2].map(|i| 0.7 * b[k][i] + 0.3 * b[(k + 1) % 3][i])
        };
        let place = |(f, b): (FaceId, [f64; 3])| {
            let corners = flown.mesh.face_vertices(f).map(|v| soup.positions[v.index()]);
            [0, 1, 2].map(|i| (0..3).map(|k| b[k] * corners[k][i]).sum::<f64>())
        };
        let p = place(forward.image(r.faces[0][f], middle(f, h)).unwrap());
        let q = place(forward.image(r.faces[0][g], other(g, h.twin())).unwrap());
        assert!((0..3).all(|i| (p[i] - q[i]).abs() < 1e-10), "{p:?} {q:?}");
    }
}

#[test]
fn any_number_of_threads_gives_the_same_and_a_cancelled_call_says_so() {
    let soup = shapes::icosphere(16).unwrap();
    let mesh = Mesh::from_soup(&soup).unwrap();
    let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
    let initial = initial_metric(&mesh, &lengths, Space::E2, Class::yamabe(Space::E2)).unwrap();
    let (mut after, mut metric, mut normal) = (mesh.clone(), initial.metric, NormalCoordinates::new(&mesh));
    shuffle(&mut after, &mut metric, &mut normal, 2 * mesh.n_edges(), 2);
    let refine = |control: &Control| {
        let given = InputTriangulation { mesh: &mesh, geometry: Space::E2, u: &initial.input_u };
        let result = FinalTriangulation { mesh: &after, metric: &metric, normal: &normal };
        CommonSubdivision::new(Triangulations { input: given, intrinsic: None, result }, &|_| true, control)
    };
    let one = refine(&Control::new()).unwrap();
    assert!(one.crossings.len() > mesh.n_edges());
    for threads in [1, 2, 3] {
        let other = ricci::parallel::Pool::new(threads).unwrap().run(|| refine(&Control::new()).unwrap());
        assert!(one == other);
    }
    let cancelled = Control::new();
    cancelled.cancel();
    assert!(matches!(refine(&cancelled), Err(ricci::Error::Cancelled)));
    // A flip that was not recorded is noticed.
    let blind = NormalCoordinates::new(&mesh);
    let given = InputTriangulation { mesh: &mesh, geometry: Space::E2, u: &initial.input_u };
    let result = FinalTriangulation { mesh: &after, metric: &metric, normal: &blind };
    assert!(
        CommonSubdivision::new(
            Triangulations { input: given, intrinsic: None, result },
            &|_| true,
            &Control::new()
        )
        .is_err()
    );
}
