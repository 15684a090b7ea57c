//! Edge flips: by themselves, and in a flow to a drawn target, with the way back to the surface as it was.
#![no_main]

use ricci::flow::Options;
use ricci::geometry::Space;
use ricci::mesh::{EdgeId, FaceId, Mesh, NormalCoordinates, PerVertex, VertexId};
use ricci::metric::{CommonSubdivision, Scheme};
use ricci::{Class, Control, Error, Surface, Target, flow};
use std::f64::consts::PI;

/// Error of barycentric coordinates, and of areas in shares of a face, that rounding leaves on surfaces this small.
const ROUNDING: f64 = 1e-6;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let mut bytes = data.iter().copied();
    let Some(how) = bytes.next() else { return };
    let Some(surface) = ricci_fuzz::surfaces::surface(data, &mut bytes) else { return };
    if how & 1 == 0 { by_hand(surface.mesh(), how, bytes) } else { in_a_flow(surface, how, bytes) }
});

/// Steps of a flow: few are enough for targets that are reached at all.
const MOST_STEPS: usize = 16;
/// Flips of one input, and of one in 32.
const FLIPS: [usize; 2] = [16, 200];

/// The origin of every half-edge, and the faces beside it.
fn shape(mesh: &Mesh) -> Vec<(VertexId, Option<FaceId>)> {
    mesh.edges()
        .flat_map(|e| [e.halfedge(), e.halfedge().twin()])
        .map(|h| (mesh.origin(h), mesh.face(h)))
        .collect()
}

/// Any flips leave a surface of the same topology, four flips of one edge restore it, and curves are followed.
fn by_hand(given: &Mesh, how: u8, bytes: impl Iterator<Item = u8>) {
    let mut mesh = given.clone();
    let mut curves = NormalCoordinates::new(&mesh);
    let most = FLIPS[usize::from(how & 0x3e == 0x3e)];
    for b in bytes.take(most) {
        let e = EdgeId::from(usize::from(b) % mesh.n_edges());
        let before = shape(&mesh);
        let mut turned = mesh.clone();
        let flipped = (0..4).filter(|_| turned.flip(e)).count();
        assert!(flipped == 4 || flipped == 0);
        turned.validate().unwrap();
        assert_eq!(
            shape(&turned).iter().map(|x| x.0).collect::<Vec<_>>(),
            before.iter().map(|x| x.0).collect::<Vec<_>>()
        );
        curves.record(&mesh, e);
        mesh.flip(e);
    }
    mesh.validate().unwrap();
    ricci_fuzz::counts(&mesh);
    assert_eq!((mesh.euler(), mesh.n_edges()), (given.euler(), given.n_edges()));
    match curves.check(&mesh) {
        Ok(_) | Err(Error::TooLarge { .. }) => {}
        Err(other) => panic!("{other}"),
    }
}

/// Curvature drawn for every vertex, with the total that the plane asks for.
fn target(surface: &Surface, bytes: &mut impl Iterator<Item = u8>) -> PerVertex<f64> {
    let mesh = surface.mesh();
    let n = mesh.n_vertices();
    let drawn = PerVertex::from_fn(n, |_: VertexId| f64::from(bytes.next().unwrap_or(0) as i8) / 32.0);
    let miss = 2.0 * PI * mesh.euler() as f64 - drawn.iter().sum::<f64>();
    PerVertex::from_fn(n, |v: VertexId| drawn[v] + miss / n as f64)
}

/// For any target the flow ends with a metric or an error, and the subdivision covers both triangulations.
fn in_a_flow(surface: Surface, how: u8, mut bytes: impl Iterator<Item = u8>) {
    let scheme = if how & 2 == 0 { Scheme::Yamabe } else { Scheme::Inversive };
    let target = Target::All(target(&surface, &mut bytes));
    let options =
        Options { max_iterations: usize::from(how >> 2) % MOST_STEPS, threads: 1, ..Options::default() };
    let given = surface.mesh().clone();
    let control = Control::new();
    let solution = match flow::flow(surface, Class::new(scheme, Space::E2), &target, &options, &control) {
        Ok(solution) => solution,
        Err(error) => {
            assert!(!matches!(error, Error::Connectivity { .. }), "{error}");
            assert!(!error.to_string().is_empty());
            return;
        }
    };
    let (mesh, metric) = (solution.mesh(), solution.metric());
    mesh.validate().unwrap();
    metric.check(mesh).unwrap();
    assert!(metric.u.iter().chain(metric.rounded_eta().iter()).all(|x| x.is_finite()));
    let curvature = solution.curvature().unwrap();
    let total: f64 = curvature.at.iter().sum();
    // Of a double it is that of the given half.
    let expected = 2.0 * PI * given.euler() as f64;
    assert!((total - expected).abs() < ROUNDING * mesh.n_faces() as f64, "{total}, not {expected}");
    let report = solution.report().unwrap();
    assert!(!report.converged() || report.max_curvature_error <= report.tolerance.max(options.tolerance));
    match solution.common_subdivision(&control) {
        Ok(subdivision) => way_back(&subdivision, &given),
        Err(Error::TooLarge { .. }) => {}
        // Pieces that are too small for doubles, of a metric that the flow has not brought to its target.
        Err(error) => assert!(!report.converged(), "{error}"),
    }
}

/// The pieces cover every face of the surface once, and points come back.
fn way_back(subdivision: &CommonSubdivision, given: &Mesh) {
    subdivision.mesh.validate().unwrap();
    assert_eq!(subdivision.mesh.euler(), given.euler());
    assert!(subdivision.weight.iter().all(|&q| q > 0.0 && q.is_finite()));
    let mut areas = vec![0.0; given.n_faces()];
    for f in subdivision.mesh.faces() {
        let [a, b, c] = subdivision.barycentric(0, f);
        assert!([a, b, c].iter().flatten().all(|x| (-ROUNDING..=1.0 + ROUNDING).contains(x)));
        areas[subdivision.faces[0][f].index()] += a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    assert!(areas.iter().all(|area| (area - 1.0).abs() < ROUNDING), "{areas:?}");
    let (forward, backward) = (subdivision.forward(), subdivision.backward());
    for f in given.faces() {
        let Some((there, weights)) = forward.image(f, [0.5, 0.3, 0.2]) else {
            panic!("no image of face {f}")
        };
        assert!(weights.iter().all(|x| x.is_finite()));
        let (_, back) = backward.image(there, weights).expect("an image of the image");
        assert!(back.iter().all(|x| x.is_finite()));
    }
}
