//! Checks that every circle domain has to pass, computed again from its layout.

use ricci::canonical::{CircleDomain, CircleDomainOptions, circle_domain};
use ricci::geometry::Space;
use ricci::geometry::predicates::orientation;
use ricci::mesh::io::Soup;
use ricci::mesh::{HalfedgeId, PerVertex};
use ricci::{Control, Surface};
use std::cmp::Ordering;

pub fn domain_of(surface: &Surface) -> CircleDomain {
    circle_domain(surface, &CircleDomainOptions::default(), &Control::new()).unwrap()
}

pub fn domain(soup: &Soup) -> CircleDomain {
    domain_of(&Surface::from_soup(soup).unwrap())
}

/// The circle through points, by least squares about their mean: centre, radius, and the largest share of the radius by which one is off.
pub fn fitted(points: &[[f64; 2]]) -> ([f64; 2], f64, f64) {
    let n = points.len() as f64;
    let mean = [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / n);
    let size = points.iter().map(|p| (p[0] - mean[0]).hypot(p[1] - mean[1])).fold(0.0, f64::max);
    let local: Vec<[f64; 2]> = points.iter().map(|p| [0, 1].map(|k| (p[k] - mean[k]) / size)).collect();
    // 2 c·p + (r² − |c|²) = |p|².
    let (mut a, mut b) = ([[0.0; 3]; 3], [0.0; 3]);
    for [x, y] in &local {
        let (row, value) = ([2.0 * x, 2.0 * y, 1.0], x * x + y * y);
        for i in 0..3 {
            b[i] += row[i] * value;
            (0..3).for_each(|j| a[i][j] += row[i] * row[j]);
        }
    }
    let determinant = |m: [[f64; 3]; 3]| {
        (0..3)
            .map(|k| {
                m[0][k] * (m[1][(k + 1) % 3] * m[2][(k + 2) % 3] - m[1][(k + 2) % 3] * m[2][(k + 1) % 3])
            })
            .sum::<f64>()
    };
    let [x, y, z] = [0, 1, 2].map(|column| {
        let mut replaced = a;
        (0..3).for_each(|row| replaced[row][column] = b[row]);
        determinant(replaced) / determinant(a)
    });
    let radius = (z + x * x + y * y).sqrt();
    let off = local.iter().map(|p| ((p[0] - x).hypot(p[1] - y) - radius).abs() / radius).fold(0.0, f64::max);
    ([mean[0] + size * x, mean[1] + size * y], size * radius, off)
}

/// The boundary loops of the layout, where the cut parts none of them: coordinates once around.
pub fn loops(d: &CircleDomain) -> Vec<Vec<[f64; 2]>> {
    let mesh = d.layout.mesh();
    let sides = |rim: Vec<HalfedgeId>| rim.into_iter().map(HalfedgeId::twin).collect::<Vec<_>>();
    let rims = mesh.boundary_loops().into_iter().map(sides);
    let whole = |rim: &Vec<HalfedgeId>| {
        // The end of each side, in its own face, is the start of the one before.
        (0..rim.len()).all(|i| d.layout.uv(mesh.next(rim[(i + 1) % rim.len()])) == d.layout.uv(rim[i]))
    };
    rims.filter(whole).map(|rim| rim.iter().map(|&h| d.layout.uv(h)).collect()).collect()
}

/// Round to `tolerance` of the radius, disjoint, inside the unit circle if planar, no triangle flipped, the metric flat.
pub fn check(d: &CircleDomain, name: &str, tolerance: f64) {
    let report = &d.report;
    assert!(report.converged && report.domain_curvature_error < 1e-10, "{name}: {report:?}");
    assert!(d.overlapping().is_empty() && d.layout.flipped.is_empty(), "{name}: {report:?}");
    let worst = d.circles.iter().map(|c| c.deviation).fold(0.0, f64::max);
    assert!(worst < tolerance, "{name}: off its circle by {worst:e}");
    let mut circles = Vec::new();
    for points in loops(d).into_iter().filter(|points| points.len() > 4) {
        let (centre, radius, off) = fitted(&points);
        assert!(off < tolerance, "{name}: off a fitted circle by {off:e}");
        circles.push((centre, radius));
    }
    if d.layout.space == Space::E2 && d.outer.is_some() {
        assert_eq!(circles.len(), d.circles.len(), "{name}");
    }
    circles.sort_by(|a, b| b.1.total_cmp(&a.1));
    if d.outer.is_some() {
        let (centre, radius) = circles.remove(0);
        assert!(centre[0].hypot(centre[1]) < 1e-12 && (radius - 1.0).abs() < 1e-12, "{name}");
        assert!(circles.iter().all(|(c, r)| c[0].hypot(c[1]) + r < 1.0), "{name}: a circle leaves the disk");
    }
    for (i, (c, r)) in circles.iter().enumerate() {
        for (d, s) in &circles[..i] {
            assert!((c[0] - d[0]).hypot(c[1] - d[1]) > r + s, "{name}: two circles overlap");
        }
    }
}

/// The triangles of a planar domain's metric that lie in its disk, none of them at a hub, with their vertices in the disk; all
/// counterclockwise.
pub fn triangles(d: &CircleDomain) -> (Vec<[u32; 3]>, PerVertex<[f64; 2]>) {
    let n = d.split.surface().unwrap().mesh().n_vertices();
    let mut places = PerVertex::filled(n, [0.0; 2]);
    let mesh = d.layout.mesh();
    for h in mesh.halfedges().filter(|&h| !mesh.is_outside(h) && mesh.origin(h).index() < n) {
        places[mesh.origin(h)] = d.layout.uv(h);
    }
    let is_point = |f: &[u32; 3]| f.iter().all(|&v| (v as usize) < n);
    let faces: Vec<[u32; 3]> = d.metric.mesh().triangles().into_iter().filter(is_point).collect();
    for f in &faces {
        let [a, b, c] = f.map(|v| places[ricci::mesh::VertexId(v)]);
        assert_eq!(orientation(a, b, c), Ordering::Greater);
    }
    (faces, places)
}
