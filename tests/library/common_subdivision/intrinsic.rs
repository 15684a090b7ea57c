//! Surfaces that isometric flips change first: their edges are straight on the surface.

use crate::common::flow::default_target;
use crate::common::flow::{attempt, euclidean};
use crate::common::{self, Random};
use crate::common_subdivision::check::{check, determinant};
use crate::common_subdivision::flown::{Flown, SCHEMES, flow};
use crate::common_subdivision::small::shuffle;
use ricci::embed::{Layout, LayoutOptions, cones_of};
use ricci::flow::Options;
use ricci::geometry::Space;
use ricci::mesh::{Mesh, PerEdge, Point, io, shapes};
use ricci::metric::{CommonSubdivision, lengths_from_positions};
use ricci::{Class, Control, Flow, Solution};
use std::f64::consts::PI;

type Surface = (Mesh, PerEdge<f64>);

/// A flat torus of n × n vertices, its triangles sheared by this many of their bases.
fn sheared_torus(n: usize, shear: usize) -> Surface {
    let at = |i: usize, j: usize| (i % n + n * (j % n)) as u32;
    let mut faces = Vec::new();
    for (i, j) in (0..n).flat_map(|j| (0..n).map(move |i| (i, j))) {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + shear + 1, j + 1), at(i + shear, j + 1)];
        faces.extend([[a, b, c], [a, c, d]]);
    }
    let mesh = Mesh::from_faces(n * n, &faces).unwrap();
    let mut lengths = PerEdge::filled(mesh.n_edges(), 0.0);
    let length = |x: usize, y: usize| (x as f64 + 0.13 * y as f64).hypot(0.9 * y as f64);
    for f in mesh.faces() {
        let sides = match f.index() % 2 {
            0 => [length(1, 0), length(shear, 1), length(shear + 1, 1)],
            _ => [length(shear + 1, 1), length(1, 0), length(shear, 1)],
        };
        for (h, l) in mesh.face_halfedges(f).into_iter().zip(sides) {
            lengths[h.edge()] = l;
        }
    }
    (mesh, lengths)
}

/// A plane disk of uneven points, each row of which is joined to the next askew. Positions, too.
fn sheared_disk(n: usize, shear: usize) -> (Surface, Vec<Point>) {
    let mut random = Random::new(8);
    let positions: Vec<Point> = (0..n * n)
        .map(|k| {
            let (i, j) = (k % n, k / n);
            // Sheared back: a parallelogram whose rows begin farther and farther left.
            let off = [0, 1].map(|_| 0.2 * random.symmetric());
            [i as f64 - (shear * j) as f64 + off[0], j as f64 + off[1], 0.0]
        })
        .collect();
    let at = |i: usize, j: usize| (i + n * j) as u32;
    let mut faces = Vec::new();
    for (i, j) in (0..n - 1).flat_map(|j| (0..n - 1).map(move |i| (i, j))) {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        faces.extend([[a, b, c], [a, c, d]]);
    }
    let mesh = Mesh::from_faces(n * n, &faces).unwrap();
    let lengths = lengths_from_positions(&mesh, &positions).unwrap();
    ((mesh, lengths), positions)
}

/// An icosphere with radii at random, and squeezed.
fn rough_sphere(frequency: usize, noise: f64, squeeze: f64) -> (Surface, Vec<Point>) {
    let soup = shapes::icosphere(frequency).unwrap();
    let mut random = Random::new(3);
    let positions: Vec<Point> = soup
        .positions
        .iter()
        .map(|&[x, y, z]| {
            let r = 1.0 + noise * random.symmetric();
            [r * x, r * y, squeeze * r * z]
        })
        .collect();
    let mesh = Mesh::from_soup(&soup).unwrap();
    let lengths = lengths_from_positions(&mesh, &positions).unwrap();
    ((mesh, lengths), positions)
}

/// Square of the length of a side of a triangle of the subdivision in its face: of weights with these differences.
fn squared_length(from: [f64; 3], to: [f64; 3], sides: [f64; 3]) -> f64 {
    let d = [0, 1, 2].map(|k| to[k] - from[k]);
    -(0..3).map(|k| d[(k + 1) % 3] * d[(k + 2) % 3] * sides[k] * sides[k]).sum::<f64>()
}

/// The largest disagreement of lengths, relative to the longest side of the faces, between input and final triangulation.
fn strain(r: &CommonSubdivision, (input, lengths): &Surface, metric: &Solution) -> f64 {
    let mesh = metric.mesh();
    let finally = metric.metric().lengths(mesh).unwrap();
    let mut worst = 0.0f64;
    for f in r.mesh.faces() {
        let of_input = input.opposite_edges(r.faces[0][f]).map(|e| lengths[e]);
        let of_final = mesh.opposite_edges(r.faces[1][f]).map(|e| finally[e]);
        let (a, b) = (r.barycentric(0, f), r.barycentric(1, f));
        let longest = of_input.into_iter().chain(of_final).fold(0.0, f64::max);
        for k in 0..3 {
            let next = (k + 1) % 3;
            let [x, y] = [squared_length(a[k], a[next], of_input), squared_length(b[k], b[next], of_final)];
            worst = worst.max((x.max(0.0).sqrt() - y.max(0.0).sqrt()).abs() / longest);
        }
    }
    worst
}

/// The result of a flow to the curvature that the surface has already: start flips, crossings, strain, mean and largest
/// dilatation − 1, over the spread of the layout.
fn unchanged(surface: &Surface, scheme: ricci::metric::Scheme) -> (usize, usize, f64, [f64; 2]) {
    let (input, lengths) = surface;
    let class = Class::new(scheme, Space::E2);
    let flow = Flow::new(euclidean(input, lengths), class, &Options::default(), &Control::new()).unwrap();
    let metric = flow.solution();
    let r = metric.common_subdivision(&Control::new()).unwrap();
    assert!(r.weight.iter().all(|q| (q - 1.0).abs() < 1e-12));
    let curvature = metric.curvature().unwrap();
    let cones = Some(cones_of(input, &curvature.at, 1e-11).unwrap());
    let options = LayoutOptions { cones, ..LayoutOptions::default() };
    let laid = Layout::of_solution(&metric, &options, &Control::new()).unwrap();
    let quality = laid.quality(input, lengths).unwrap();
    assert!(laid.flipped.is_empty());
    let strain = strain(&r, surface, &metric);
    // Coordinates are rounded at the size of the layout, and a cut along edges that wind round the surface opens it into a long strip.
    let spread = laid.diameter / laid.area.sqrt();
    let qc = [quality.qc_mean, quality.qc_max].map(|k| (k - 1.0) / spread);
    (metric.start_flips(), r.crossings.len(), strain, qc)
}

#[test]
fn a_surface_that_flows_to_its_own_curvature_is_mapped_to_itself() {
    let surfaces = [
        ("torus sheared by 9", sheared_torus(12, 9), 1e-11),
        ("torus sheared by 200", sheared_torus(24, 200), 1e-8),
        ("disk sheared by 3", sheared_disk(12, 3).0, 1e-11),
        ("disk sheared by 12", sheared_disk(20, 12).0, 1e-8),
        ("rough sphere", rough_sphere(8, 0.4, 1.0).0, 1e-10),
        ("flat rough sphere", rough_sphere(8, 0.2, 1e-2).0, 1e-9),
        ("flatter rough sphere", rough_sphere(5, 0.1, 1e-4).0, 1e-8),
    ];
    for (name, surface, bound) in surfaces {
        for scheme in SCHEMES {
            let (flips, crossings, strain, qc) = unchanged(&surface, scheme);
            println!(
                "{name} {scheme}: {flips} flips, {crossings} crossings, strain {strain:.0e}, qc − 1 {qc:?}"
            );
            assert!(flips > 50 && crossings > 50, "{name}");
            assert!(strain < 1e-11 && qc[0] < bound && qc[1] < bound, "{name} {scheme}: {strain} {qc:?}");
        }
    }
    let Some((folder, _)) = common::index("good") else { return };
    for (name, bound) in [
        ("nefertiti_299", 1e-12),
        ("lion_head", 1e-10),
        ("ember_520644", 1e-8),
        ("fixed_top", 1e-8),
        ("plate_holes", 1e-8),
    ] {
        let soup = io::read(&folder.join(format!("{name}.obj"))).unwrap();
        let mesh = Mesh::from_soup(&soup).unwrap();
        let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
        let surface = (mesh, lengths);
        for scheme in SCHEMES {
            let (flips, crossings, strain, qc) = unchanged(&surface, scheme);
            println!(
                "{name} {scheme}: {flips} flips, {crossings} crossings, strain {strain:.0e}, qc − 1 {qc:?}"
            );
            assert!(flips > 50 && strain < 1e-11 && qc[1] < bound, "{name} {scheme}: {strain} {qc:?}");
        }
    }
}

/// In curved input geometry: products of the vectors of a triangle's corners, which homogeneous weights carry over.
#[test]
fn a_curved_surface_is_mapped_to_itself_with_its_homogeneous_weights() {
    let ((mesh, flat), _) = rough_sphere(6, 0.4, 1.0);
    for (space, scheme) in [(Space::H2, SCHEMES[0]), (Space::H2, SCHEMES[1]), (Space::S2, SCHEMES[0])] {
        let lengths = PerEdge::from_fn(mesh.n_edges(), |e| 0.8 * flat[e]);
        let start = Flown::start_in(space, (&mesh, &lengths), (space, scheme), None);
        let r = start.refine(&mesh, None);
        assert!(start.flips > 50 && r.crossings.len() > 50);
        if space == Space::H2 {
            let surface = ricci::Surface::intrinsic(mesh.clone(), lengths.clone(), space).unwrap();
            let class = Class::new(scheme, space);
            let flow = Flow::new(surface, class, &Options::default(), &Control::new()).unwrap();
            assert!(flow.solution().common_subdivision(&Control::new()).unwrap() == r);
        }
        let finally = start.metric.lengths(&start.mesh).unwrap();
        let gram = |l: [f64; 3]| {
            let g = l.map(|l: f64| if space == Space::H2 { l.cosh() } else { l.cos() });
            [[1.0, g[2], g[1]], [g[2], 1.0, g[0]], [g[1], g[0], 1.0]]
        };
        let product = |a: [f64; 3], b: [f64; 3], g: [[f64; 3]; 3]| {
            (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).map(|(i, j)| a[i] * b[j] * g[i][j]).sum::<f64>()
        };
        let mut worst = 0.0f64;
        for f in r.mesh.faces() {
            let of_input = gram(mesh.opposite_edges(r.faces[0][f]).map(|e| lengths[e]));
            let of_final = gram(start.mesh.opposite_edges(r.faces[1][f]).map(|e| finally[e]));
            let (a, b, q) = (r.barycentric(0, f), r.barycentric(1, f), r.weights(f));
            for (i, j) in [(0, 0), (0, 1), (1, 2), (2, 0)] {
                let image = q[i] * q[j] * product(b[i], b[j], of_final);
                worst = worst.max((product(a[i], a[j], of_input) - image).abs());
            }
        }
        println!("{space} {scheme}: {} crossings, {worst:.0e}", r.crossings.len());
        assert!(worst < 1e-12, "{space} {scheme}: {worst}");
    }
}

/// A plane surface, flown from a sheared triangulation and from its Delaunay triangulation.
#[test]
fn crossings_lie_where_the_map_of_the_delaunay_triangulation_takes_them() {
    for scheme in SCHEMES {
        let ((sheared, lengths), positions) = sheared_disk(10, 3);
        // A vertex that is pinned keeps the surface from being doubled: the Delaunay triangulation of the double is another one.
        let boundary: Vec<_> = sheared.vertices().filter(|&v| sheared.is_boundary_vertex(v)).collect();
        let options = Options { pinned: vec![boundary[0]], ..Options::default() };
        let begin = |mesh: &Mesh, lengths: &PerEdge<f64>| {
            let class = Class::new(scheme, Space::E2);
            Flow::new(euclidean(mesh, lengths), class, &options, &Control::new()).unwrap()
        };
        let start = begin(&sheared, &lengths).solution();
        let faces: Vec<_> =
            start.mesh().faces().map(|f| start.mesh().face_vertices(f).map(|v| v.0)).collect();
        let delaunay = Mesh::from_faces(sheared.n_vertices(), &faces).unwrap();
        let its_lengths = lengths_from_positions(&delaunay, &positions).unwrap();
        // Some of the way to a surface whose boundary turns evenly, but for two corners, and curvature inside.
        let mut target = start.curvature().unwrap().at;
        target.iter_mut().for_each(|k| *k *= 0.7);
        boundary.iter().for_each(|&v| target[v] += 0.3 * PI / boundary.len() as f64);
        [0, boundary.len() / 2].into_iter().for_each(|k| target[boundary[k]] += 0.15 * PI);
        let cones = [45.into(), 68.into()];
        (target[cones[0]], target[cones[1]]) = (0.5, -0.5);
        let flown = |mesh: &Mesh, lengths: &PerEdge<f64>| {
            let mut flow = begin(mesh, lengths);
            assert!(attempt(&mut flow, &target).converged());
            let flat = flow.solution();
            let r = flat.common_subdivision(&Control::new()).unwrap();
            let options = LayoutOptions { cones: Some(cones.to_vec()), ..LayoutOptions::default() };
            let laid = Layout::of_solution(&flat, &options, &Control::new()).unwrap();
            let quality = laid.quality(mesh, lengths).unwrap();
            (flow, r, quality)
        };
        let (flow, r, quality) = flown(&sheared, &lengths);
        let (other, expected, its_quality) = flown(&delaunay, &its_lengths);
        let map = expected.forward();
        assert!(!expected.crossings.is_empty() && r.crossings.len() > 3 * expected.crossings.len());
        // The face and the weights of a place of the plane in the Delaunay triangulation.
        let locate = |p: Point| {
            let homogeneous = |p: Point| [p[0], p[1], 1.0];
            let inside = |f| {
                let [a, b, c] = delaunay.face_vertices(f).map(|v| homogeneous(positions[v.index()]));
                let parts =
                    [[homogeneous(p), b, c], [a, homogeneous(p), c], [a, b, homogeneous(p)]].map(determinant);
                let total = determinant([a, b, c]);
                (f, parts.map(|x| x / total))
            };
            let least = |b: &[f64; 3]| b.iter().copied().fold(f64::INFINITY, f64::min);
            delaunay.faces().map(inside).max_by(|(_, a), (_, b)| least(a).total_cmp(&least(b))).unwrap()
        };
        let off = r
            .crossings
            .iter()
            .map(|c| {
                let [a, b] = c[0].ends.map(|v| positions[v.index()]);
                let p = [0, 1, 2].map(|i| c[0].weights[0] * a[i] + c[0].weights[1] * b[i]);
                let (f, barycentric) = locate(p);
                let (face, image) = map.image(f, barycentric).unwrap();
                // The weights of the two ends, and of no other vertex.
                let vertices = other.mesh().face_vertices(face);
                let weight = |v| (0..3).filter(|&k| vertices[k] == v).map(|k| image[k]).sum::<f64>();
                (0..2).map(|k| (weight(c[1].ends[k]) - c[1].weights[k]).abs()).fold(0.0, f64::max)
            })
            .fold(0.0, f64::max);
        println!(
            "{scheme}: {} flips, {} crossings to {:.0e}; qc mean {} and {}, max {} and {}",
            flow.solution().flips(),
            r.crossings.len(),
            off,
            quality.qc_mean,
            its_quality.qc_mean,
            quality.qc_max,
            its_quality.qc_max
        );
        assert!(off < 1e-11, "{scheme}: {off}");
        assert!((quality.qc_mean / its_quality.qc_mean - 1.0).abs() < 0.05, "{scheme}");
        assert!(quality.qc_max < 2.0 * its_quality.qc_max, "{scheme}");
    }
}

#[test]
fn what_holds_of_every_subdivision_holds_of_sheared_and_rough_surfaces() {
    let mut surfaces = Vec::new();
    for (name, frequency, noise, squeeze) in [("rough", 8, 0.4, 1.0), ("flat", 6, 0.2, 1e-2)] {
        let ((mesh, lengths), positions) = rough_sphere(frequency, noise, squeeze);
        surfaces.push((name, mesh, lengths, positions));
    }
    let (mesh, lengths) = sheared_torus(12, 30);
    // Any values at the vertices are positions.
    let mut random = Random::new(6);
    let positions = mesh.vertices().map(|_| [0, 1, 2].map(|_| random.symmetric())).collect();
    surfaces.push(("sheared torus", mesh, lengths, positions));
    for (name, mesh, lengths, positions) in surfaces {
        for scheme in SCHEMES {
            for round in 0..3 {
                let mut target = default_target(&mesh, &lengths, Space::E2, scheme);
                for k in 0..round {
                    target[(7 * k + 3).into()] += 2.0;
                    target[(11 * k + 20).into()] -= 2.0;
                }
                let what = format!("{name} {scheme} {round}");
                let flown = flow(&mesh, &lengths, (Space::E2, scheme), &target, None).unwrap();
                assert!(flown.start.is_some(), "{what}");
                let r = flown.refine(&mesh, None);
                let worst = check(&r, &mesh, &flown, &positions, &what);
                println!("{what}: {} flips, {} crossings, {worst:?}", flown.flips, r.crossings.len());
                assert!(
                    worst.area < 1e-10 && worst.position < 1e-10 && worst.projective < 1e-10,
                    "{what}: {worst:?}"
                );
            }
        }
    }
}

/// Final edges that wind around straight lines, again and again: what is met is far from what a curve pulled tight meets.
#[test]
fn what_holds_of_every_subdivision_holds_after_any_flips_in_the_class() {
    let mut random = Random::new(9);
    let mut surfaces = vec![sheared_torus(5, 7), rough_sphere(4, 0.7, 1.0).0, sheared_disk(6, 2).0];
    for soup in [shapes::one_vertex(1), shapes::one_vertex(2), shapes::two_vertex(2), shapes::one_vertex(3)] {
        let mesh = soup.unwrap().build().unwrap().0;
        let mut lengths = || PerEdge::from_fn(mesh.n_edges(), |_| 1.0 + 0.3 * random.symmetric());
        let flips = |lengths: &_| Flown::start(&mesh, lengths, (Space::E2, SCHEMES[0]), None).flips > 0;
        let lengths = std::iter::repeat_with(&mut lengths).take(1000).find(flips).unwrap();
        surfaces.push((mesh, lengths));
    }
    let mut crossings = 0;
    for (k, (input, given_lengths)) in surfaces.into_iter().enumerate() {
        for rounds in [1, 3] {
            let mut flown = Flown::start(&input, &given_lengths, (Space::E2, SCHEMES[0]), None);
            let Some((_, _, _, on_final)) = &mut flown.start else { panic!("surface {k} is Delaunay") };
            let (mut mesh, mut metric) = (flown.mesh.clone(), flown.metric.clone());
            let flips = rounds * mesh.n_edges();
            shuffle(&mut mesh, &mut metric, on_final, flips, k as u64);
            shuffle(&mut flown.mesh, &mut flown.metric, &mut flown.normal, flips, k as u64);
            assert!(flown.mesh == mesh);
            let r = flown.refine(&input, None);
            let positions: Vec<Point> =
                input.vertices().map(|_| [0, 1, 2].map(|_| random.symmetric())).collect();
            let worst = check(&r, &input, &flown, &positions, &format!("surface {k}"));
            println!("surface {k}: {} crossings, {worst:?}", r.crossings.len());
            assert!(worst.area < 1e-10 && worst.position < 1e-10, "{worst:?}");
            // After three flips per edge lines that are straight in the class leave their order by rounding.
            assert!(rounds > 1 || worst.projective < 1e-10, "{worst:?}");
            crossings += r.crossings.len();
        }
    }
    assert!(crossings > 1000, "{crossings}");
}
