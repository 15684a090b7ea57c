//! Tests of the generators of surfaces with holes, knots, unequal handles, given boundary lengths or branch points, and bad triangles.

use ricci::Error;
use ricci::geometry::hyperelliptic::period_matrix;
use ricci::geometry::{Space, triangle};
use ricci::mesh::io::Soup;
use ricci::mesh::shapes::{self, Sliver, TorusKnot};
use ricci::mesh::{Mesh, Point, VertexId};
use ricci::metric::{curvature, lengths_from_positions};
use std::f64::consts::{PI, TAU};

fn build(soup: &Soup) -> Mesh {
    Mesh::from_soup(soup).unwrap()
}

fn angles(soup: &Soup) -> Vec<[f64; 3]> {
    let mesh = build(soup);
    let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
    mesh.faces().map(|f| triangle::angles(Space::E2, mesh.opposite_edges(f).map(|e| lengths[e])).at).collect()
}

fn smallest_angle(soup: &Soup) -> f64 {
    angles(soup).into_iter().flatten().fold(PI, f64::min)
}

fn distance(p: Point, q: Point) -> f64 {
    (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt()
}

/// Centre and radius of the circle through three points of the plane z = 0.
fn circle([a, b, c]: [Point; 3]) -> ([f64; 2], f64) {
    let (b, c) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
    let (bb, cc) = (b[0] * b[0] + b[1] * b[1], c[0] * c[0] + c[1] * c[1]);
    let d = 2.0 * (b[0] * c[1] - b[1] * c[0]);
    let centre = [(c[1] * bb - b[1] * cc) / d, (b[0] * cc - c[0] * bb) / d];
    ([a[0] + centre[0], a[1] + centre[1]], centre[0].hypot(centre[1]))
}

#[test]
fn holes_are_boundary_loops_and_nothing_else_changes() {
    let surfaces = [
        (shapes::disk(20).unwrap(), 0, 1),
        (shapes::icosphere(16).unwrap(), 0, 0),
        (shapes::ellipsoid([3.0, 1.0, 0.5], 16).unwrap(), 0, 0),
        (shapes::annulus(0.4, 1.0, 12, 60).unwrap(), 0, 2),
        (shapes::torus(2.0, 1.0, 60, 30).unwrap(), 1, 0),
        (shapes::genus(2, 6).unwrap(), 2, 0),
        (shapes::genus(3, 4).unwrap(), 3, 0),
    ];
    for (soup, genus, loops) in &surfaces {
        for count in [0, 1, 2, 3, 5, 9] {
            let punched = shapes::punch(soup, count).unwrap();
            let mesh = build(&punched);
            assert_eq!((mesh.genus(), mesh.boundary_loops().len()), (*genus, loops + count));
            let angle = smallest_angle(&punched).to_degrees();
            println!("genus {genus}, {loops} + {count} loops: smallest angle {angle:.1}°");
            assert!(angle > 0.4 * smallest_angle(soup).to_degrees().min(30.0), "{angle}");
        }
    }
    // Where a round hole has no room, it consists of the faces around a vertex; loops share no vertex.
    for (soup, most) in [
        (shapes::disk(3).unwrap(), 1),
        (shapes::disk(8).unwrap(), 5),
        (shapes::icosphere(1).unwrap(), 2),
        (shapes::icosphere(3).unwrap(), 4),
        (shapes::genus(2, 2).unwrap(), 5),
        (shapes::torus(2.0, 1.0, 8, 6).unwrap(), 2),
    ] {
        let whole = build(&soup);
        for count in 1..=most {
            let mesh = build(&shapes::punch(&soup, count).unwrap());
            let loops = whole.boundary_loops().len() + count;
            assert_eq!((mesh.genus(), mesh.boundary_loops().len()), (whole.genus(), loops));
        }
    }
    assert!(shapes::punch(&shapes::icosphere(1).unwrap(), 3).is_err());
    assert!(shapes::punch(&shapes::icosphere(8).unwrap(), 300).is_err());
    assert!(shapes::punch(&shapes::disk(2).unwrap(), usize::MAX).is_err());
}

#[test]
fn rims_of_holes_in_the_plane_are_circles() {
    let punched = shapes::punch(&shapes::disk(24).unwrap(), 4).unwrap();
    let mesh = build(&punched);
    let mut radii = Vec::new();
    for rim in mesh.boundary_loops() {
        let at = |i: usize| punched.positions[mesh.origin(rim[i % rim.len()]).index()];
        let (centre, radius) = circle([at(0), at(rim.len() / 3), at(2 * rim.len() / 3)]);
        for i in 0..rim.len() {
            let r = (at(i)[0] - centre[0]).hypot(at(i)[1] - centre[1]);
            assert!((r - radius).abs() < 1e-13);
        }
        radii.push(radius);
    }
    radii.sort_by(f64::total_cmp);
    assert!(radii[0] > 0.7 * 0.15 && radii[3] <= 0.15 && (radii[4] - 1.0).abs() < 1e-12, "{radii:?}");
}

#[test]
fn knotted_torus_is_a_tube_around_its_knot() {
    let knots = [(2, 3, 0.45), (3, 2, 0.3), (2, 5, 0.3), (1, 4, 0.3), (3, 1, 0.3), (1, 1, 0.3)];
    for (p, q, tube) in knots {
        let knot = TorusKnot { p, q, big: 2.0, small: 0.9 };
        let (n, m) = (400, 24);
        let soup = knot.torus(tube, n, m).unwrap();
        let mesh = build(&soup);
        assert_eq!((mesh.genus(), mesh.boundary_loops().len()), (1, 0));
        // The core is compared point by point; the tube's area and volume are known by Pappus.
        let core = |t: f64| {
            let (u, v) = (TAU * f64::from(p) * t, TAU * f64::from(q) * t);
            let r = 2.0 + 0.9 * v.cos();
            [r * u.cos(), r * u.sin(), 0.9 * v.sin()]
        };
        for (v, &x) in soup.positions.iter().enumerate() {
            assert!((distance(x, core((v % n) as f64 / n as f64)) - tube).abs() < 1e-14);
        }
        let length: f64 = (0..20 * n)
            .map(|i| distance(core(i as f64 / (20 * n) as f64), core((i + 1) as f64 / (20 * n) as f64)))
            .sum();
        let known = PI * tube * tube * length;
        let got = volume(&soup);
        assert!((got / known - 1.0).abs() < 0.02, "({p}, {q}): {got} {known}");
        // A tube twice as thick as the room for it is refused.
        assert!(knot.torus(2.5, n, m).is_err());
    }
    for (p, q) in [(2, 4), (0, 1), (2, 0), (1001, 1)] {
        assert!(TorusKnot { p, q, big: 2.0, small: 0.9 }.torus(0.1, 50, 8).is_err());
    }
    let knot = TorusKnot { p: 2, q: 3, big: 2.0, small: 0.9 };
    assert!(knot.torus(f64::NAN, 50, 8).is_err() && knot.torus(0.1, 2, 8).is_err());
    assert!(TorusKnot { small: 2.0, ..knot }.torus(0.1, 50, 8).is_err());
}

#[test]
fn knots_have_no_fewer_sections_than_make_them() {
    let least = |knot: TorusKnot, tube: f64| {
        let Err(Error::Argument { what: "cross-sections", value, .. }) = knot.torus(tube, 3, 12) else {
            panic!()
        };
        let words: Vec<&str> = value.split(' ').collect();
        words[4].parse::<usize>().unwrap()
    };
    for (p, q, tube) in [(2, 3, 0.4), (3, 2, 0.3), (2, 5, 0.3), (1, 4, 0.3), (3, 1, 0.2), (5, 3, 0.1)] {
        let knot = TorusKnot { p, q, big: 2.0, small: 0.9 };
        let n = least(knot, tube);
        assert!(knot.torus(tube, n - 1, 12).is_err());
        // At the bound the surface is oriented outwards, with the volume of a much finer one except for what the chords cut off.
        let (coarse, fine) = (knot.torus(tube, n, 12).unwrap(), knot.torus(tube, 20 * n, 12).unwrap());
        let ratio = volume(&coarse) / volume(&fine);
        println!("({p}, {q}), tube {tube}: {n} sections, volume {ratio:.3} of the limit");
        assert!(build(&coarse).genus() == 1 && (0.85..1.0).contains(&ratio));
        // No two sections meet: the core of each is farther from every other's than within the tube.
        let centre = |i: usize| {
            let sum = (0..12)
                .fold([0.0; 3], |s: Point, j| [0, 1, 2].map(|k| s[k] + coarse.positions[i + n * j][k]));
            sum.map(|x| x / 12.0)
        };
        for i in 0..n {
            let (x, next) = (centre(i), centre((i + 1) % n));
            let ahead = |v: usize| {
                let p = coarse.positions[v];
                (0..3).map(|k| (p[k] - x[k]) * (next[k] - x[k])).sum::<f64>()
            };
            // Corresponding vertices of the next section lie ahead.
            for j in 0..12 {
                assert!(i + 1 == n || ahead((i + 1) % n + n * j) > ahead(i + n * j));
            }
        }
    }
}

fn volume(soup: &Soup) -> f64 {
    let det = |f: &[u32; 3]| {
        let [a, b, c] = f.map(|v| soup.positions[v as usize]);
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    soup.faces.iter().map(det).sum::<f64>() / 6.0
}

#[test]
fn tapered_handles_are_the_equal_ones_up_to_a_conformal_map() {
    for (genus, ratio) in [(2, 2.0), (2, 4.0), (3, 5.0), (5, 1.5), (4, 1.0)] {
        let (equal, tapered) =
            (shapes::genus(genus, 3).unwrap(), shapes::tapered_genus(genus, 3, ratio).unwrap());
        let mesh = build(&tapered);
        assert_eq!((mesh.genus(), mesh.is_closed()), (genus, true));
        // Möbius maps keep the cross-ratios of distances.
        let n = equal.positions.len();
        let cross = |soup: &Soup, i: [usize; 4]| {
            let [a, b, c, d] = i.map(|i| soup.positions[i]);
            distance(a, b) * distance(c, d) / (distance(a, c) * distance(b, d))
        };
        for i in 0..n - 3 {
            let four = [i, (7 * i + 1) % n, (3 * i + n / 2) % n, i + 3];
            let (x, y) = (cross(&equal, four), cross(&tapered, four));
            assert!(
                (0..4).any(|k| (0..k).any(|l| four[k] == four[l])) || (x / y - 1.0).abs() < 1e-9,
                "{x} {y}"
            );
        }
        // The holes' radii, from the vertices that lay on the holes of radius 1.
        let radius = |k: usize| {
            let centre = 1.35 * (2.0 * k as f64 + 1.0 - genus as f64);
            let on: Vec<Point> = (0..n)
                .filter(|&v| {
                    let [x, y, z] = equal.positions[v];
                    z == 0.0 && ((x - centre).hypot(y) - 1.0).abs() < 1e-12
                })
                .map(|v| tapered.positions[v])
                .collect();
            circle([on[0], on[on.len() / 3], on[2 * on.len() / 3]]).1
        };
        assert!((radius(0) / radius(genus - 1) - ratio).abs() < 1e-9 * ratio);
        for k in 1..genus {
            assert!(radius(k) <= radius(k - 1) * (1.0 + 1e-12));
        }
        assert!(smallest_angle(&tapered) > 0.7 * smallest_angle(&equal));
    }
    for (genus, ratio) in [(2, 6.7), (3, 17.1), (4, 32.0)] {
        assert_eq!(build(&shapes::tapered_genus(genus, 3, ratio).unwrap()).genus(), genus);
    }
    for (genus, ratio) in [(1, 2.0), (2, 0.5), (2, 6.9), (3, 17.3), (2, f64::NAN)] {
        assert!(shapes::tapered_genus(genus, 3, ratio).is_err(), "{genus} {ratio}");
    }
}

#[test]
fn pants_have_geodesic_boundaries_of_the_given_lengths() {
    for (lengths, levels) in [
        ([1.0, 1.0, 1.0], 3),
        ([0.5, 3.0, 7.0], 3),
        ([1e-3, 1e-3, 1e-3], 2),
        ([12.0, 20.0, 16.0], 2),
        ([1e-6, 1.0, 40.0], 0),
        ([1e-6, 200.0, 1e-6], 0),
    ] {
        for level in 0..=levels {
            let surface = shapes::pants(lengths, level).unwrap();
            let (mesh, edges) = surface.build().unwrap();
            assert_eq!((mesh.genus(), mesh.boundary_loops().len()), (0, 3));
            assert_eq!(mesh.n_faces(), 8 * 4usize.pow(level as u32));
            let k = curvature(&mesh, Space::H2, &edges).unwrap();
            let worst = k.at.iter().map(|k| k.abs()).fold(0.0, f64::max);
            // A length is rounded to half an ulp, which changes angles in proportion to the shortest length.
            let longest = edges.iter().copied().fold(0.0, f64::max);
            let shortest = edges.iter().copied().fold(f64::INFINITY, f64::min);
            let bound = 32.0 * f64::EPSILON * longest / shortest;
            assert!(k.broken.is_empty() && worst < bound, "{lengths:?}: {worst} {bound}");
            assert!((k.area - 2.0 * PI).abs() < 8.0 * bound, "{lengths:?}: {}", k.area);
            let mut loops: Vec<f64> =
                mesh.boundary_loops().iter().map(|l| l.iter().map(|h| edges[h.edge()]).sum()).collect();
            loops.sort_by(f64::total_cmp);
            let mut known = lengths;
            known.sort_by(f64::total_cmp);
            for (got, known) in loops.iter().zip(known) {
                assert!((got / known - 1.0).abs() < 1e-13, "{loops:?}");
            }
            // Corners 5 and 0 lie on boundary 1, 1 and 2 on boundary 2, 3 and 4 on boundary 3.
            for (l, pair) in [[5u32, 0], [1, 2], [3, 4]].into_iter().enumerate() {
                let on = mesh
                    .boundary_loops()
                    .into_iter()
                    .find(|b| b.iter().any(|&h| mesh.origin(h).0 == pair[0]));
                let on = on.unwrap();
                assert!(on.iter().any(|&h| mesh.origin(h).0 == pair[1]));
                let length: f64 = on.iter().map(|h| edges[h.edge()]).sum();
                assert!((length / lengths[l] - 1.0).abs() < 1e-13);
            }
        }
    }
    assert!(shapes::pants([1.0, 0.0, 1.0], 1).is_err() && shapes::pants([1.0, 201.0, 1.0], 1).is_err());
    assert!(shapes::pants([1.0, f64::NAN, 1.0], 1).is_err() && shapes::pants([1.0; 3], 99).is_err());
}

#[test]
fn hyperelliptic_surfaces_are_double_covers_of_the_round_sphere() {
    for count in 3..=10usize {
        let spiral = |j: usize| num_complex::Complex64::from_polar(0.5 + 0.2 * j as f64, 2.4 * j as f64);
        let points: Vec<_> = (0..count).map(spiral).collect();
        let surface = shapes::hyperelliptic(&points, 16).unwrap();
        let (mesh, lengths) = surface.build().unwrap();
        assert!(mesh.is_closed());
        assert_eq!(mesh.genus(), (count - 1) / 2);
        assert_eq!(period_matrix(&points).unwrap().len(), mesh.genus());
        let k = curvature(&mesh, Space::S2, &lengths).unwrap();
        assert!(k.broken.is_empty() && (k.area - 8.0 * PI).abs() < 1e-11);
        for v in mesh.vertices() {
            let known = if v.index() < count + count % 2 { -2.0 * PI } else { 0.0 };
            assert!((k.at[v] - known).abs() < 1e-12);
        }
    }
    // Graded towards the branch points it is the same surface.
    let points = [0.0, 1.0, -1.3, 2.1].map(|x| num_complex::Complex64::new(x, 0.3 * x * x));
    for grading in [2.0, 3.0] {
        let (mesh, lengths) = shapes::hyperelliptic_graded(&points, 16, grading).unwrap().build().unwrap();
        let k = curvature(&mesh, Space::S2, &lengths).unwrap();
        assert!(k.broken.is_empty() && (k.area - 8.0 * PI).abs() < 1e-11 && mesh.genus() == 1);
        let shortest = lengths.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(shortest < 0.06 / grading, "{shortest}");
        assert!(mesh.vertices().all(|v| k.at[v].abs() < 1e-11 || v.index() < 4));
    }
    assert!(shapes::hyperelliptic_graded(&points, 16, 0.5).is_err());
    let close = [0.0, 1.0, 1.001].map(|x| num_complex::Complex64::new(x, 0.0));
    assert!(shapes::hyperelliptic(&close, 8).is_err() && shapes::hyperelliptic(&close[..2], 8).is_err());
}

#[test]
fn grading_halves_edges_towards_a_vertex() {
    let mut soup = shapes::icosphere(4).unwrap();
    let (before, area) = (build(&soup), total_area(&soup));
    let longest = longest_spoke(&soup, 5);
    let least = smallest_angle(&soup);
    shapes::grade(&mut soup, 5, 10).unwrap();
    let mesh = build(&soup);
    assert_eq!((mesh.genus(), mesh.is_closed()), (0, true));
    assert_eq!(mesh.n_vertices(), before.n_vertices() + 10 * 5);
    assert!((longest_spoke(&soup, 5) / longest * 1024.0 - 1.0).abs() < 1e-11);
    assert!((total_area(&soup) / area - 1.0).abs() < 1e-13);
    assert!(smallest_angle(&soup) > 0.45 * least);
    assert!(shapes::grade(&mut soup, 100_000, 1).is_err() && shapes::grade(&mut soup, 5, 101).is_err());
    // The largest allowed number of levels gives valid triangles, at the origin and elsewhere.
    for (mut soup, vertex) in
        [(shapes::icosphere(4).unwrap(), 0), (shapes::disk(3).unwrap(), 0), (shapes::disk(3).unwrap(), 20)]
    {
        let least = smallest_angle(&soup);
        let Err(Error::Argument { value, .. }) = shapes::grade(&mut soup, vertex, 101) else { panic!() };
        let most: usize = value.split(' ').nth(4).unwrap().parse().unwrap();
        let at_origin = soup.positions[vertex as usize] == [0.0; 3];
        assert!(if at_origin { most == 100 } else { (35..45).contains(&most) }, "{value}");
        assert!(shapes::grade(&mut soup, vertex, most + 1).is_err());
        shapes::grade(&mut soup, vertex, most).unwrap();
        assert!(smallest_angle(&soup) > 0.45 * least);
    }
    // The same at a boundary vertex.
    let mut disk = shapes::disk(3).unwrap();
    shapes::grade(&mut disk, 20, 3).unwrap();
    assert_eq!(build(&disk).boundary_loops().len(), 1);
}

fn longest_spoke(soup: &Soup, v: u32) -> f64 {
    let mesh = build(soup);
    let at = |v: VertexId| soup.positions[v.index()];
    mesh.outgoing(VertexId(v)).map(|h| distance(at(VertexId(v)), at(mesh.tip(h)))).fold(0.0, f64::max)
}

fn total_area(soup: &Soup) -> f64 {
    let mesh = build(soup);
    curvature(&mesh, Space::E2, &lengths_from_positions(&mesh, &soup.positions).unwrap()).unwrap().area
}

#[test]
fn slivers_have_the_angle_asked_for() {
    for angle in [0.1, 1e-3, 1e-6, 1e-7] {
        for kind in [Sliver::Cap, Sliver::Needle] {
            let mut soup = shapes::torus(2.0, 1.0, 40, 20).unwrap();
            let area = total_area(&soup);
            let faces = soup.faces.len();
            shapes::slivers(&mut soup, kind, 50, angle, 7).unwrap();
            assert_eq!(soup.faces.len(), faces + 100);
            assert_eq!(build(&soup).genus(), 1);
            assert!((total_area(&soup) / area - 1.0).abs() < 1e-11);
            let thin: Vec<[f64; 3]> =
                angles(&soup).into_iter().filter(|a| a.iter().any(|&a| a < 2.0 * angle)).collect();
            let smallest = thin.iter().flatten().fold(PI, |m, &a| m.min(a));
            println!("{kind:?} {angle:e}: {} thin triangles, smallest angle {smallest:.3e}", thin.len());
            assert!(thin.len() >= 50 && smallest > 0.5 * angle && smallest < 1.1 * angle);
            let obtuse = thin.iter().flatten().any(|&a| a > PI - 2.2 * angle);
            assert_eq!(obtuse, kind == Sliver::Cap);
        }
    }
    let same = |seed| {
        let mut soup = shapes::icosphere(3).unwrap();
        shapes::slivers(&mut soup, Sliver::Cap, 10, 1e-3, seed).unwrap();
        soup.positions
    };
    assert!(same(1) == same(1) && same(1) != same(2));
    let mut soup = shapes::icosphere(1).unwrap();
    assert!(shapes::slivers(&mut soup, Sliver::Cap, 21, 1e-3, 0).is_err());
    assert!(shapes::slivers(&mut soup, Sliver::Cap, 1, 0.0, 0).is_err());
    shapes::slivers(&mut soup, Sliver::Cap, 20, 1e-3, 0).unwrap();
}
