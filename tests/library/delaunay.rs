//! Starts of flows with flips: short and long lengths, isometric flips that end, and arguments of the wrong size.

use crate::common::Random;
use crate::common::flow::surface;
use ricci::geometry::conformal::Vertex;
use ricci::geometry::flip::diagonal;
use ricci::geometry::{DoubleDouble, Space};
use ricci::mesh::{EdgeId, FixedEdges, Mesh, PerEdge, PerVertex, shapes};
use ricci::metric::delaunay::{ClassFlips, FlipQueue, IntrinsicOptions, failing, intrinsic_delaunay};
use ricci::metric::{Class, Initial, Scheme, StartOptions, Triangulated, delaunay_start};
use ricci::{Control, Error};

/// A torus whose triangulation is far from Delaunay, without ties; its edges are about `size` long.
fn torus(size: f64) -> (Mesh, PerEdge<f64>) {
    let mut soup = shapes::torus(2.0, 0.8, 40, 20).unwrap();
    let mut random = Random::new(4);
    soup.positions.as_flattened_mut().iter_mut().for_each(|x| *x = 4.0 * size * (*x + 0.1 * random.unit()));
    surface(&soup)
}

fn start(given: &(Mesh, PerEdge<f64>), geometry: Space, scheme: Scheme) -> (Triangulated, Initial, usize) {
    let mut surface = Triangulated { mesh: given.0.clone(), lengths: given.1.clone(), geometry };
    let (mut flips, class) = (0, Class::new(scheme, Space::E2));
    let start = delaunay_start(&mut surface, class.into(), &mut |_, _| flips += 1, &Control::new());
    (surface, start.unwrap(), flips)
}

/// η of two real circles of radii a, b whose centres are l apart, to 30 digits for lengths below 1e-3: with x = t(a/2), y = t(b/2)
/// (t = tanh, tan) it is `(s(l/2)² (1 + λx²) (1 + λy²) − x² − y²)/(2xy)` (s = sinh, sin).
fn exact_weight(curvature: f64, [l, a, b]: [f64; 3]) -> f64 {
    let two = DoubleDouble::from;
    let (one, lambda) = (two(1.0), two(curvature));
    let half = |x: f64| two(0.5) * two(x);
    // t² = h²(1 + 2λh²/3 + 17h⁴/45 + …), s² = h²(1 − λh²/3 + 2h⁴/45 + …)
    let squared = |h: DoubleDouble, first: f64, second: f64| {
        let z = h * h;
        z * (one + lambda * z * two(first) / two(3.0) + z * z * two(second) / two(45.0))
    };
    let [x2, y2] = [a, b].map(|r| squared(half(r), 2.0, 17.0));
    let chord = squared(half(l), -1.0, 2.0) * (one + lambda * x2) * (one + lambda * y2);
    let eta = (chord - x2 - y2) / (two(2.0) * (x2 * y2).sqrt());
    eta.high
}

#[test]
fn short_curved_lengths_start_in_the_class_of_the_flat_ones() {
    for size in [1e-5, 1e-6, 1e-8, 1e-12] {
        let given = torus(size);
        let (flat, plane, flips) = start(&given, Space::E2, Scheme::Inversive);
        assert!(flips > 100, "{flips}");
        for geometry in [Space::H2, Space::S2] {
            let (curved, initial, _) = start(&given, geometry, Scheme::Inversive);
            assert!(curved.mesh == flat.mesh, "{geometry} {size:e}: another triangulation");
            let (mut apart, mut off) = (0.0f64, 0.0f64);
            for e in curved.mesh.edges() {
                let [a, b] = curved.mesh.ends(e).map(|v| initial.radii[v]);
                let exact = exact_weight(geometry.curvature(), [curved.lengths[e], a, b]);
                off = off.max((initial.metric.eta[e].high / exact - 1.0).abs());
                apart = apart.max((initial.metric.eta[e].high / plane.metric.eta[e].high - 1.0).abs());
            }
            println!("{geometry} {size:e}: η off by {off:.1e}, {apart:.1e} from the flat one");
            // Curvature moves η by a few l².
            assert!(
                off < 1e-12 && apart < 1e-12 + 100.0 * size * size,
                "{geometry} {size:e}: {off:e} {apart:e}"
            );
            let left = failing(&curved.mesh, &initial.metric);
            assert!(left.is_empty(), "{geometry} {size:e}: {left:?} are not Delaunay");
        }
    }
}

/// Diagonals of short and long lengths against 60 digits of mpmath.
#[test]
fn diagonals_of_any_length_keep_their_digits() {
    for (space, [a, b, angle], known) in [
        (Space::E2, [1e-140, 2e-140, 0.75], 1.439_876_565_718_296_7e-140),
        (Space::H2, [1e-9, 2.5e-9, 0.75], 1.895_140_009_506_13e-9),
        (Space::H2, [1e-120, 1e-120, 1e-3], 9.999_999_583_333_339e-124),
        (Space::H2, [400.0, 350.0, 1.25], 748.928_045_665_915_4),
        (Space::H2, [900.0, 1200.0, 0.5], 2_097.206_534_368_604_4),
        (Space::H2, [500.0, 500.0, 2f64.powi(-700)], 28.207_652_854_957_8),
        (Space::H2, [500.0, 500.0, 2f64.powi(-725)], 0.039_759_003_856_491_05),
        (Space::H2, [5e5, 4e5, 1e-3], 899_984.798_194_997_6),
        (Space::S2, [1e-9, 2.5e-9, 0.75], 1.895_140_009_506_13e-9),
        (Space::S2, [1.5, 1.625, 3.125], 3.118_150_131_078_198_4),
        (Space::S2, [2.0, 1.125, 3.0], 3.012_288_763_310_357_4),
    ] {
        let found = diagonal(space, a, b, angle);
        // The exponent of e^l has the rounding of l.
        assert!((found / known - 1.0).abs() < 1e-12, "{space} {a} {b} {angle}: {found:e} {known:e}");
    }
}

/// Tori as sheared as doubles can hold them, plain and with large circles, for which an end is not certain: the flips end within
/// seconds, or an error says that they do not.
#[test]
fn isometric_flips_end() {
    let mut random = Random::new(9);
    for (geometry, k) in [(Space::E2, 1e5), (Space::H2, 1e4), (Space::E2, 3e4), (Space::E2, 3e3)] {
        let (mesh, lengths) = shapes::flat_torus([k + 0.3, 0.9], 2, 1).unwrap().build().unwrap();
        let size = if geometry == Space::E2 { 1.0 } else { 1e-9 };
        let lengths = PerEdge::from_fn(mesh.n_edges(), |e: EdgeId| size * lengths[e]);
        for round in 0..4 {
            let scale = size * f64::from(round);
            let radii = PerVertex::from_fn(mesh.n_vertices(), |_| scale * random.unit());
            let circles = if round == 0 { None } else { Some(&radii) };
            let options = IntrinsicOptions { circles, ..IntrinsicOptions::default() };
            let mut surface = Triangulated { mesh: mesh.clone(), lengths: lengths.clone(), geometry };
            let (before, time, mut flips) = (surface.clone(), std::time::Instant::now(), 0u64);
            let made = intrinsic_delaunay(&mut surface, options, &mut |_, _| flips += 1, &Control::new());
            let seconds = time.elapsed().as_secs_f64();
            println!(
                "{geometry} sheared {k:e} times, circles {scale:e}: {made:?}, {flips} flips, {seconds:.2} s"
            );
            let named =
                matches!(&made, Err(Error::Connectivity { message, .. }) if message.contains("do not end"));
            assert!(made.is_ok() || (named && surface == before), "{made:?}");
            assert!(flips < 10_000_000, "{flips}");
        }
    }
}

#[test]
fn arguments_of_the_wrong_size_are_errors() {
    let (mesh, lengths) = torus(1.0);
    let missing = EdgeId::from(mesh.n_edges());
    let error = FixedEdges::new(&mesh, &[EdgeId(0), missing]).unwrap_err();
    assert!(matches!(error, Error::Argument { what: "fixed edge", .. }), "{error}");
    let fixed = FixedEdges::new(&mesh, &[EdgeId(7)]).unwrap();
    assert!(fixed.contains(EdgeId(7)) && !fixed.contains(EdgeId(0)) && !fixed.contains(missing));
    let control = Control::new();
    let mut surface = Triangulated { mesh: mesh.clone(), lengths: lengths.clone(), geometry: Space::E2 };
    for n in [0, 3, mesh.n_vertices() + 1] {
        let radii = PerVertex::filled(n, 0.01);
        let vertices = vec![Vertex::default(); n];
        let circles = IntrinsicOptions { circles: Some(&radii), ..IntrinsicOptions::default() };
        let error = intrinsic_delaunay(&mut surface, circles, &mut |_, _| {}, &control).unwrap_err();
        assert!(matches!(error, Error::Size { .. }), "{error}");
        let mut metric = start(&(mesh.clone(), lengths.clone()), Space::E2, Scheme::Yamabe).1.metric;
        let mut queue = FlipQueue::all(&mesh, &fixed);
        let mut flips = ClassFlips { mesh: &mut mesh.clone(), metric: &mut metric, record: &mut |_, _| {} };
        let error = flips.restore_delaunay(&vertices, &mut queue, &control).unwrap_err();
        assert!(matches!(error, Error::Size { .. }), "{error}");
    }
    let double = ricci::mesh::Double::new(&Mesh::from_soup(&shapes::disk(2).unwrap()).unwrap()).unwrap();
    let other = StartOptions { double: Some(&double), ..Class::new(Scheme::Virtual, Space::E2).into() };
    let error = delaunay_start(&mut surface, other, &mut |_, _| {}, &control).unwrap_err();
    assert!(matches!(error, Error::Size { .. }), "{error}");
    surface.lengths = PerEdge::filled(4, 1.0);
    let error =
        intrinsic_delaunay(&mut surface, IntrinsicOptions::default(), &mut |_, _| {}, &control).unwrap_err();
    assert!(matches!(error, Error::Size { .. }), "{error}");
}
