//! Circle domains with known answers.

use crate::circles::check::{check, domain, domain_of, triangles};
use crate::common::Random;
use ricci::canonical::{CircleDomainOptions, Normalisation, circle_domain};
use ricci::geometry::Mobius;
use ricci::mesh::io::Soup;
use ricci::mesh::{VertexId, shapes};
use ricci::{Control, Surface};
use std::f64::consts::{LN_2, PI, TAU};

/// A strip of m × n squares, cut alternately, whose sides left and right are one; `place` of (row, angle).
pub fn strip(m: usize, n: usize, place: impl Fn(f64, f64) -> [f64; 3]) -> Soup {
    let mut soup = Soup::default();
    for i in 0..=m {
        soup.positions.extend((0..n).map(|j| place(i as f64 / m as f64, TAU * j as f64 / n as f64)));
    }
    let at = |i: usize, j: usize| (i * n + j % n) as u32;
    for i in 0..m {
        for j in 0..n {
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            soup.faces.extend(if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
        }
    }
    soup
}

/// Errors of a modulus on two meshes, the second twice as fine: a quarter of the first, about.
fn converges(name: &str, exact: f64, modulus: impl Fn(usize) -> f64) {
    let [coarse, fine] = [1, 2].map(|k| (modulus(k) - exact).abs());
    println!("{name}: off by {coarse:.2e}, {fine:.2e}");
    assert!(fine < 0.02 * exact && (fine < 0.3 * coarse || fine < 1e-10), "{name}: {coarse:e}, {fine:e}");
}

#[test]
fn annuli_have_their_modulus() {
    let modulus = |soup: &Soup| {
        let d = domain(soup);
        check(&d, "annulus", 1e-12);
        d.modulus.unwrap()
    };
    converges("cylinder", 1.5 / TAU, |k| {
        modulus(&strip(6 * k, 24 * k, |t, angle| [angle.cos(), angle.sin(), 1.5 * t]))
    });
    converges("plane annulus", LN_2 / TAU, |k| {
        modulus(&strip(4 * k, 32 * k, |t, angle| [(1.0 + t) * angle.cos(), (1.0 + t) * angle.sin(), 0.0]))
    });
    // Circles of radius 1 about 0 and 0.3 about 0.4, in a mesh that knows nothing of the map between them and concentric ones.
    let exact = ((1.0 + 0.09 - 0.16) / 0.6f64).acosh() / TAU;
    converges("eccentric annulus", exact, |k| {
        modulus(&strip(12 * k, 64 * k, |t, angle| {
            let [x, y] = [angle.cos(), angle.sin()];
            let r = 0.3 + 0.7 * t;
            [r * x + 0.4 * (1.0 - t), r * y, 0.0]
        }))
    });
}

/// Conformal maps of a rectangle to the disk: the cross ratio of its corners is that of −1, 1, 1/k, −1/k, where K'/K is twice the height
/// over the width.
#[test]
fn corners_of_a_rectangle_have_their_cross_ratio() {
    let q = (-PI * 2.0 * 0.5f64).exp();
    let sum = |shift: f64| (-40..40).map(|n| q.powf((f64::from(n) + shift).powi(2))).sum::<f64>();
    let k = (sum(0.5) / sum(0.0)).powi(2);
    let exact = ((1.0 + k) / (1.0 - k)).powi(2);
    converges("rectangle", exact, |scale| {
        let (m, n) = (12 * scale, 24 * scale);
        let mut soup = Soup::default();
        for i in 0..=m {
            soup.positions.extend((0..=n).map(|j| [2.0 * j as f64 / n as f64, i as f64 / m as f64, 0.0]));
        }
        let at = |i: usize, j: usize| (i * (n + 1) + j) as u32;
        for i in 0..m {
            for j in 0..n {
                let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
                soup.faces.extend(if (i + j) % 2 == 0 {
                    [[a, b, c], [a, c, d]]
                } else {
                    [[a, b, d], [b, c, d]]
                });
            }
        }
        let d = domain(&soup);
        check(&d, "rectangle", 1e-12);
        let corners = [at(0, 0), at(0, n), at(m, n), at(m, 0)];
        let (_, places) = triangles(&d);
        let [p, r, s, t] = corners.map(|v| places[VertexId(v)]);
        let distance = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
        distance(p, s) * distance(r, t) / (distance(r, s) * distance(p, t))
    });
}

/// A planar circle domain as a surface in space, each vertex moved.
fn moved(faces: &[[u32; 3]], places: &[[f64; 2]], to: impl Fn([f64; 2]) -> [f64; 2]) -> Surface {
    let positions = places.iter().map(|&z| to(z)).map(|[x, y]| [x, y, 0.0]).collect();
    Surface::from_soup(&Soup { positions, faces: faces.to_vec(), ..Soup::default() }).unwrap()
}

#[test]
fn circle_domains_come_back_whatever_moebius_transformation_has_moved_them() {
    let sphere = shapes::punch(&shapes::icosphere(24).unwrap(), 4).unwrap();
    let first = domain(&sphere);
    check(&first, "sphere with four holes", 1e-12);
    assert_eq!(first.report.crossed_edges, 0);
    let (faces, places) = triangles(&first);
    let outer = first.outer.unwrap();
    let mut random = Random::new(5);
    for round in 0..6 {
        let map = match round {
            0 => Mobius::IDENTITY,
            // Poles outside the disk, and in one of the holes, which is the outer circle then.
            1..=3 => Mobius::to_origin([0.5 * random.symmetric(), 0.5 * random.symmetric()]),
            _ => {
                let hole = first.circles.iter().filter(|c| c.boundary_loop != outer).nth(round - 4).unwrap();
                Mobius { matrix: [[[0.0; 2], [1.0, 0.3]], [[1.0, 0.0], hole.centre.map(|x| -x)]] }
            }
        };
        let surface = moved(&faces, &places, |z| map.apply(z));
        let again = domain_of(&surface);
        check(&again, "moved domain", 1e-12);
        assert_eq!((again.report.halved_edges, again.report.crossed_edges), (0, 0));
        let (_, back) = triangles(&again);
        // The transformation that carries three vertices back carries all of them.
        let three = [7u32, 211, 503].map(VertexId);
        let home = Mobius::of_triples(three.map(|v| back[v]), three.map(|v| places[v])).unwrap();
        let off = back.iter().zip(places.iter()).map(|(&w, z)| {
            let [x, y] = home.apply(w);
            (x - z[0]).hypot(y - z[1])
        });
        let off = off.fold(0.0, f64::max);
        println!("moved {round}: off by {off:.1e}");
        assert!(off < 1e-8, "round {round}: {off:e}");
    }
}

#[test]
fn disks_are_normalised_as_asked() {
    let mut soup = shapes::disk(7).unwrap();
    shapes::noise(&mut soup, 0.02, 4).unwrap();
    let surface = Surface::from_soup(&soup).unwrap();
    let rim: Vec<VertexId> = {
        let mesh = surface.mesh();
        let rim = &mesh.boundary_loops()[0];
        rim.iter().rev().map(|&h| mesh.origin(h)).collect()
    };
    let run = |normalisation| {
        let options = CircleDomainOptions { normalisation, ..CircleDomainOptions::default() };
        circle_domain(&surface, &options, &Control::new())
    };
    let at = |d: &ricci::canonical::CircleDomain, v: VertexId| triangles(d).1[v];
    let three = [rim[0], rim[11], rim[30]];
    let angles = [0.3, 1.9, 4.4];
    let d = run(Normalisation::Three(three, angles)).unwrap();
    for (v, angle) in three.into_iter().zip(angles) {
        let [x, y] = at(&d, v);
        assert!((x - angle.cos()).hypot(y - angle.sin()) < 1e-12);
    }
    let d = run(Normalisation::Vertex(VertexId(3))).unwrap();
    let [x, y] = at(&d, VertexId(3));
    assert!(x.hypot(y) < 1e-13);
    // The barycentre of the area lies at the centre.
    let d = run(Normalisation::Centred).unwrap();
    let (mesh, (_, places)) = (surface.mesh(), triangles(&d));
    let mut sum = [0.0; 2];
    for f in mesh.faces() {
        let l = mesh.opposite_edges(f).map(|e| surface.lengths()[e]);
        let area = ricci::geometry::triangle::area(ricci::geometry::Space::E2, l);
        mesh.face_vertices(f)
            .into_iter()
            .for_each(|v| (0..2).for_each(|k| sum[k] += area / 3.0 * places[v][k]));
    }
    assert!(sum[0].hypot(sum[1]) < 1e-13 * surface.area().unwrap());
    assert!(run(Normalisation::Three([rim[0], rim[30], rim[11]], angles)).is_err());
    assert!(run(Normalisation::Vertex(rim[4])).is_err());
    assert!(run(Normalisation::Three([rim[0], rim[11], VertexId(0)], angles)).is_err());
}
