//! Tests of the generators: topology, geometry and known totals.

use ricci::geometry::{Space, triangle};
use ricci::mesh::io::Soup;
use ricci::mesh::shapes::{self, IntrinsicSurface};
use ricci::mesh::{HalfedgeId, Mesh, Point};
use ricci::metric::{curvature, lengths_from_positions};
use ricci::topology::homology_generators;
use ricci::{Control, Error};
use std::f64::consts::PI;

fn topology(soup: &Soup) -> (usize, usize) {
    let mesh = Mesh::from_soup(soup).unwrap();
    (mesh.genus(), mesh.boundary_loops().len())
}

/// Smallest angle in degrees.
fn min_angle(soup: &Soup) -> f64 {
    let mesh = Mesh::from_soup(soup).unwrap();
    let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
    let corner = |f| triangle::angles(Space::E2, mesh.opposite_edges(f).map(|e| lengths[e])).at;
    mesh.faces().flat_map(corner).fold(PI, f64::min).to_degrees()
}

fn volume(soup: &Soup) -> f64 {
    let det = |[a, b, c]: [Point; 3]| {
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    soup.faces.iter().map(|f| det(f.map(|v| soup.positions[v as usize]))).sum::<f64>() / 6.0
}

#[test]
fn every_shape_has_its_topology_and_faces_outwards() {
    for n in [1, 2, 5] {
        let sphere = shapes::icosphere(n).unwrap();
        assert_eq!((sphere.positions.len(), sphere.faces.len()), (10 * n * n + 2, 20 * n * n));
        assert_eq!(topology(&sphere), (0, 0));
        assert!(volume(&sphere) > 2.0);
        assert_eq!(topology(&shapes::disk(n).unwrap()), (0, 1));
        assert_eq!(shapes::disk(n).unwrap().faces.len(), 6 * n * n);
    }
    assert_eq!(topology(&shapes::torus(2.0, 0.5, 7, 5).unwrap()), (1, 0));
    assert!(volume(&shapes::torus(2.0, 0.5, 40, 20).unwrap()) > 9.0);
    assert_eq!(topology(&shapes::annulus(1.0, 2.0, 4, 9).unwrap()), (0, 2));
    for genus in 1..=6 {
        for n in [1, 2, 5] {
            let soup = shapes::genus(genus, n).unwrap();
            assert_eq!(topology(&soup), (genus, 0), "genus {genus}, n {n}");
            assert!(volume(&soup) > 0.0);
        }
    }
    assert_eq!(topology(&shapes::genus(10, 3).unwrap()), (10, 0));
    // Plane shapes face up: their signed area in the plane is positive, face by face.
    for soup in [shapes::disk(6).unwrap(), shapes::annulus(0.5, 2.0, 5, 12).unwrap()] {
        for f in &soup.faces {
            let [a, b, c] = f.map(|v| soup.positions[v as usize]);
            assert!((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0.0);
        }
    }
}

#[test]
fn triangles_are_well_shaped() {
    assert!(min_angle(&shapes::icosphere(12).unwrap()) > 50.0);
    assert!(min_angle(&shapes::disk(12).unwrap()) > 40.0);
    for (genus, n) in [(1, 1), (1, 4), (2, 1), (2, 4), (2, 32), (3, 6), (3, 16), (5, 4), (9, 2)] {
        let angle = min_angle(&shapes::genus(genus, n).unwrap());
        assert!(angle > 27.0, "genus {genus}, n {n}: {angle}°");
    }
}

#[test]
fn vertices_lie_on_their_surface() {
    let worst = |soup: &Soup, f: &dyn Fn(f64, f64, f64) -> f64| {
        soup.positions.iter().map(|&[x, y, z]| f(x, y, z).abs()).fold(0.0, f64::max)
    };
    assert!(worst(&shapes::icosphere(9).unwrap(), &|x, y, z| x * x + y * y + z * z - 1.0) < 1e-15);
    let ellipsoid = shapes::ellipsoid([3.0, 2.0, 0.5], 9).unwrap();
    assert!(
        worst(&ellipsoid, &|x, y, z| (x / 3.0).powi(2) + (y / 2.0).powi(2) + (z / 0.5).powi(2) - 1.0) < 2e-15
    );
    let torus = shapes::torus(2.0, 0.7, 30, 20).unwrap();
    assert!(worst(&torus, &|x, y, z| (x.hypot(y) - 2.0).hypot(z) - 0.7) < 1e-15);
    // Handles: z² (1/p + Σ 1/p_k) = 0.7, multiplied by all p: a smooth function that is zero there.
    for (genus, n) in [(1usize, 3), (2, 5), (2, 16), (4, 3)] {
        let centre = |k: usize| 1.35 * (2.0 * k as f64 + 1.0 - genus as f64);
        let implicit = |x: f64, y: f64, z: f64| {
            let square = |k: usize| (x - centre(k)).powi(2) + y * y;
            let rim =
                (1.7f64.powi(2) + 2.0 * (0..genus).map(|k| (-0.5 * square(k)).exp()).sum::<f64>().ln()) / 3.4;
            let mut p: Vec<f64> = (0..genus).map(|k| 0.5 * (square(k) - 1.0)).collect();
            p.push(rim);
            let product = |skip: usize| {
                p.iter().enumerate().filter(|(i, _)| *i != skip).map(|(_, p)| p).product::<f64>()
            };
            z * z * (0..p.len()).map(product).sum::<f64>() - 0.7 * product(p.len())
        };
        let soup = shapes::genus(genus, n).unwrap();
        // Far holes have p_k up to 60.
        assert!(worst(&soup, &implicit) < 1e-14 * 60f64.powi(genus as i32 - 1), "genus {genus}");
        assert_eq!(soup.positions.len(), 8 * (5 * genus + 1) * n * n + 2 - 2 * genus);
        let mut places: Vec<_> = soup.positions.iter().map(|p| p.map(|x| (x * 1e9) as i64)).collect();
        let triangles = soup.faces.iter().filter(|f| f.contains(&0)).count();
        assert!(genus == 1 || triangles == 10, "genus {genus}: {triangles} at vertex 0");
        places.sort_unstable();
        places.dedup();
        assert_eq!(places.len(), soup.positions.len(), "genus {genus}: two vertices in one place");
    }
}

#[test]
fn area_of_a_surface_with_handles_converges_quadratically() {
    let areas = [4, 8, 16, 32].map(|n| area(&shapes::genus(2, n).unwrap()));
    let rate = ((areas[1] - areas[0]) / (areas[2] - areas[1])).log2();
    let next = ((areas[2] - areas[1]) / (areas[3] - areas[2])).log2();
    assert!((rate - 2.0).abs() < 0.2 && (next - 2.0).abs() < 0.1, "{areas:?}: {rate} {next}");
}

fn area(soup: &Soup) -> f64 {
    let mesh = Mesh::from_soup(soup).unwrap();
    let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
    let k = curvature(&mesh, Space::E2, &lengths).unwrap();
    assert!(k.gauss_bonnet <= 1e-10);
    k.area
}

#[test]
fn area_of_the_icosphere_tends_to_four_pi_quadratically() {
    let errors = [8, 16, 32].map(|n| 4.0 * PI - area(&shapes::icosphere(n).unwrap()));
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1] - 4.0).abs() < 0.1, "{errors:?}");
    }
}

fn check_flat(surface: &IntrinsicSurface, genus: usize, area: f64) {
    let (mesh, lengths) = surface.build().unwrap();
    assert!(mesh.is_closed());
    assert_eq!(mesh.genus(), genus);
    let k = curvature(&mesh, surface.geometry, &lengths).unwrap();
    assert!(k.gauss_bonnet <= 1e-10);
    assert!(k.broken.is_empty());
    assert!(k.at.iter().all(|k| k.abs() < 1e-12), "{:?}", k.at.iter().map(|k| k.abs()).fold(0.0, f64::max));
    assert!((k.area - area).abs() < 1e-11 * area.max(1.0), "area {}", k.area);
}

#[test]
fn intrinsic_surfaces_have_curvature_zero() {
    for level in 0..=4 {
        check_flat(&shapes::bolza(level).unwrap(), 2, 4.0 * PI);
    }
    for genus in 2..=5 {
        let area = 4.0 * PI * (genus as f64 - 1.0);
        check_flat(&shapes::one_vertex(genus).unwrap(), genus, area);
        check_flat(&shapes::two_vertex(genus).unwrap(), genus, area);
        check_flat(
            &shapes::two_vertex(genus).unwrap().subdivide().unwrap().subdivide().unwrap(),
            genus,
            area,
        );
    }
    check_flat(&shapes::one_vertex(1).unwrap(), 1, 1.0);
    check_flat(&shapes::two_vertex(1).unwrap(), 1, 1.0);
    check_flat(&shapes::flat_torus([0.3, 1.2], 1, 1).unwrap(), 1, 1.2);
    check_flat(&shapes::flat_torus([0.3, 1.2], 5, 4).unwrap().subdivide().unwrap(), 1, 1.2);
}

#[test]
fn level_zero_of_bolza_is_a_complex_of_two_vertices() {
    let (mesh, lengths) = shapes::bolza(0).unwrap().build().unwrap();
    assert_eq!((mesh.n_vertices(), mesh.n_edges(), mesh.n_faces()), (2, 12, 8));
    // The side of the octagon: cosh(s/2) = cos(π/8)/sin(π/8).
    let side = lengths.iter().copied().fold(f64::INFINITY, f64::min).max(lengths[0usize.into()]);
    assert!(((side / 2.0).cosh() - 1.0 / (PI / 8.0).tan()).abs() < 1e-13);
}

#[test]
fn bolza_has_the_systole_of_the_regular_octagon() {
    // The shortest closed geodesics of the Bolza surface have length 2 arcosh(1 + √2), among them the sides of the octagon; no closed
    // path that does not bound is shorter.
    let systole = 2.0 * (1.0 + 2f64.sqrt()).acosh();
    let (mesh, lengths) = shapes::bolza(0).unwrap().build().unwrap();
    let loops: Vec<_> = mesh.edges().filter(|&e| mesh.ends(e)[0] == mesh.ends(e)[1]).collect();
    assert_eq!(loops.len(), 4);
    assert!(loops.iter().all(|&e| (lengths[e] - systole).abs() < 1e-14));
    for level in 0..=4 {
        let (mesh, lengths) = shapes::bolza(level).unwrap().build().unwrap();
        let generators = homology_generators(&mesh, &lengths, &Control::new()).unwrap();
        assert_eq!(generators.len(), 4);
        let length = |path: &Vec<HalfedgeId>| path.iter().map(|h| lengths[h.edge()]).sum::<f64>();
        assert!(generators.iter().all(|path| length(path) >= systole - 1e-12), "level {level}");
    }
}

type Complex = [f64; 2];

fn times([a, b]: Complex, [c, d]: Complex) -> Complex {
    [a * c - b * d, a * d + b * c]
}

/// The product of two isometries `z ↦ (p z + q)/(q̄ z + p̄)` of the Poincaré disk, each as (p, q).
fn compose([p, q]: [Complex; 2], [r, s]: [Complex; 2]) -> [Complex; 2] {
    let add = |a: Complex, b: Complex| [a[0] + b[0], a[1] + b[1]];
    let conj = |a: Complex| [a[0], -a[1]];
    [add(times(p, r), times(q, conj(s))), add(times(p, s), times(q, conj(r)))]
}

#[test]
fn side_pairings_of_the_octagon_generate_a_surface_group_with_the_bolza_systole() {
    // The inradius from the mesh, by Pythagoras in the right triangle centre, corner, middle of a side.
    let (mesh, lengths) = shapes::bolza(0).unwrap().build().unwrap();
    let is_side = |e| mesh.ends(e)[0] == mesh.ends(e)[1];
    let side = mesh.edges().find(|&e| is_side(e)).map(|e| lengths[e]).unwrap();
    let spoke = mesh.edges().find(|&e| !is_side(e)).map(|e| lengths[e]).unwrap();
    let inradius = (spoke.cosh() / (0.5 * side).cosh()).acosh();
    // Pairing k moves a side to the opposite one along the diameter in direction kπ/4; k + 4: its inverse.
    let pairing = |k: usize| {
        let (sin, cos) = (PI * (k % 8) as f64 / 4.0).sin_cos();
        [[inradius.cosh(), 0.0], [cos * inradius.sinh(), sin * inradius.sinh()]]
    };
    // Once around the corner: its eight angles close up to 2π exactly if this word is the identity, ±1.
    let around = [5, 2, 7, 4, 1, 6, 3].iter().fold(pairing(0), |word, &k| compose(word, pairing(k)));
    assert!((around[0][0].abs() - 1.0).abs() < 1e-11 && around[0][1].abs() < 1e-11, "{around:?}");
    assert!(around[1][0].hypot(around[1][1]) < 1e-11, "{around:?}");
    // A free homotopy class has the length 2 arcosh |Re p|; the systole is the least of all words of up to four pairings.
    let mut words: Vec<[Complex; 2]> = (0..8).map(pairing).collect();
    let mut shortest = f64::INFINITY;
    for _ in 0..4 {
        let traces = words.iter().map(|w| w[0][0].abs());
        // Words that reduce to the identity have |Re p| = 1; no other element of the group is close to it.
        shortest = traces.filter(|&p| p > 1.0 + 1e-9).map(|p| 2.0 * p.acosh()).fold(shortest, f64::min);
        words = words.iter().flat_map(|&w| (0..8).map(move |k| compose(w, pairing(k)))).collect();
    }
    assert!((shortest - 2.0 * (1.0 + 2f64.sqrt()).acosh()).abs() < 1e-12, "{shortest}");
}

#[test]
fn subdivision_refuses_lengths_without_triangles() {
    let with = |geometry, lengths: [f64; 3]| {
        let lengths = lengths.to_vec();
        IntrinsicSurface { lengths, geometry, ..shapes::two_triangle_sphere() }.subdivide()
    };
    for bad in [f64::NAN, f64::INFINITY, -1.0, 0.0, 1e-160, 1e160] {
        let error = with(Space::E2, [1.0, bad, 1.0]).unwrap_err();
        assert!(matches!(error, Error::EdgeLength { edge: 1, .. }), "{bad}: {error}");
    }
    let excess = |surface: ricci::Result<IntrinsicSurface>| match surface {
        Err(Error::TriangleInequality { face: 0, excess }) => excess,
        other => panic!("{other:?}"),
    };
    assert_eq!(excess(with(Space::E2, [4.0, 1.0, 1.0])), 0.5);
    assert_eq!(excess(with(Space::H2, [1.0, 1.0, 2.0])), 0.0);
    assert!((excess(with(Space::S2, [2.5; 3])) - (7.5 - 2.0 * PI)).abs() < 1e-15);
    assert!(matches!(with(Space::H2, [701.0; 3]), Err(Error::Argument { .. })));
    // At the limit midlines are still accurate: an ideal triangle's feet are 2 asinh(1/2) apart.
    let far = with(Space::H2, [700.0; 3]).unwrap();
    assert!(far.lengths[6..].iter().all(|l| (l - 2.0 * 0.5f64.asinh()).abs() < 1e-9), "{:?}", far.lengths);
}

#[test]
fn doubled_triangle_is_a_sphere_with_three_cones() {
    let (mesh, lengths) = shapes::two_triangle_sphere().build().unwrap();
    assert_eq!(mesh.euler(), 2);
    let k = curvature(&mesh, Space::E2, &lengths).unwrap();
    assert!(k.gauss_bonnet <= 1e-10);
    assert!(k.at.iter().all(|k| (k - 4.0 * PI / 3.0).abs() < 1e-14));
}

#[test]
fn noise_depends_on_its_seed_alone() {
    let noisy = |seed| {
        let mut soup = shapes::icosphere(4).unwrap();
        shapes::noise(&mut soup, 0.1, seed).unwrap();
        soup
    };
    assert_eq!(noisy(1), noisy(1));
    assert_ne!(noisy(1), noisy(2));
    assert_eq!(topology(&noisy(1)), (0, 0));
    // First outputs of SplitMix64 for seed 1234567, as its authors publish them.
    let mut random = shapes::SplitMix64::new(1_234_567);
    assert_eq!([random.bits(), random.bits()], [6_457_827_717_110_365_317, 3_203_168_211_198_807_973]);
}

#[test]
fn impossible_shapes_are_refused() {
    assert!(shapes::icosphere(0).is_err());
    assert!(shapes::icosphere(usize::MAX).is_err());
    assert!(shapes::torus(1.0, 1.0, 5, 5).is_err());
    assert!(shapes::torus(2.0, f64::NAN, 5, 5).is_err());
    assert!(shapes::torus(2.0, 1.0, 2, 5).is_err());
    assert!(shapes::genus(0, 4).is_err());
    assert!(shapes::genus(2, 0).is_err());
    assert!(shapes::genus(usize::MAX, 1).is_err());
    assert!(shapes::genus(2, usize::MAX).is_err());
    assert!(shapes::annulus(2.0, 2.0, 3, 9).is_err());
    assert!(shapes::annulus(1.0, 1.0 + 1e-14, 3, 9).is_err());
    assert!(shapes::annulus(f64::NAN, 1.0, 3, 9).is_err());
    assert!(shapes::disk(0).is_err());
    assert!(shapes::ellipsoid([1.0, 0.0, 1.0], 3).is_err());
    assert!(shapes::bolza(60).is_err());
    assert!(shapes::flat_torus([0.0, -1.0], 1, 1).is_err());
    assert!(shapes::flat_torus([1e20, 1.0], 1, 1).is_err());
    assert!(shapes::flat_torus([0.0, 1e-200], 1, 1).is_err());
    assert!(shapes::flat_torus([-1.0, 1e-13], 1, 1).is_err());
    for huge in [[1.7e308, 1.7e308], [0.0, 1e308], [f64::INFINITY, 1.0], [0.0, f64::NAN]] {
        assert!(shapes::flat_torus(huge, 1, 1).is_err());
    }
    assert!(shapes::flat_torus([0.5, 1.0], 0, 1).is_err());
    assert!(shapes::flat_torus([0.5, 1.0], usize::MAX, usize::MAX).is_err());
    // Sizes whose squares or quotients leave the range of f64, or that differ by rounding alone.
    assert!(shapes::annulus(1e-300, 1e300, 3, 9).is_err());
    assert!(shapes::annulus(1e-320, 1.0, 3, 9).is_err());
    assert!(shapes::annulus(1e-149, 1e149, 3, 9).is_err());
    assert!(shapes::annulus(1.0, f64::INFINITY, 3, 9).is_err());
    assert!(shapes::annulus(2.0, 1.0, 3, 9).is_err());
    assert!(shapes::annulus(1.0, 2.0, 0, 9).is_err());
    assert!(shapes::torus(1.2e308, 1.0e308, 5, 5).is_err());
    assert!(shapes::torus(1.0, 1e-300, 5, 5).is_err());
    assert!(shapes::torus(1.0, 1.0 - 1e-15, 6, 6).is_err());
    assert!(shapes::ellipsoid([1.0, 1e-20, 1.0], 3).is_err());
    assert!(shapes::ellipsoid([f64::NAN, 1.0, 1.0], 3).is_err());
    // Sizes just within the limits give surfaces.
    for soup in [
        shapes::torus(1.0, 1.0 - 2e-12, 6, 6),
        shapes::torus(1.0, 2e-12, 6, 6),
        shapes::ellipsoid([1.0, 2e-12, 1.0], 3),
        shapes::annulus(1e-149, 1e149, 30, 9),
        shapes::annulus(1.0, 1.0 + 4e-12, 3, 9),
    ] {
        let soup = soup.unwrap();
        assert!(soup.positions.iter().flatten().all(|x| x.is_finite()));
        assert_eq!(Mesh::from_soup(&soup).err(), None);
    }
}
