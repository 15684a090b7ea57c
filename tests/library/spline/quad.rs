//! Splines over four-sided patches by known answers: dimensions of spaces, tangent planes across arcs, fits to ellipsoids and tori.

use ricci::geometry::vector::{cross, distance, dot, norm, normalised, scale, sub};
use ricci::mesh::shapes;
use ricci::spline::{
    PatchArc, PatchCorner, PatchLayout, QuadFit, QuadFitOptions, QuadSpline, QuadSplineSpace, SplineTarget,
    SurfacePoint, bilinear, fit_quads,
};
use ricci::{Control, Error};
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// A mesh of quadrilaterals.
pub(super) struct Quads {
    pub(super) positions: Vec<[f64; 3]>,
    pub(super) faces: Vec<[u32; 4]>,
}

impl Quads {
    pub fn layout(&self) -> PatchLayout {
        PatchLayout::from_quads(self.positions.len(), &self.faces, &[]).unwrap()
    }

    pub(super) fn space(&self, spans: usize) -> Arc<QuadSplineSpace> {
        Arc::new(QuadSplineSpace::new(self.layout(), spans).unwrap())
    }

    fn at(&self, patch: usize, uv: [f64; 2]) -> [f64; 3] {
        bilinear(self.faces[patch].map(|v| self.positions[v as usize]), uv)
    }
}

/// The surface of a set of unit cells, outwards.
pub(super) fn cells(set: &[[i32; 3]]) -> Quads {
    let mut numbers: BTreeMap<[i32; 3], u32> = BTreeMap::new();
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for cell in set {
        for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]) {
            let mut beside = *cell;
            beside[axis] += 2 * side - 1;
            if set.contains(&beside) {
                continue;
            }
            let mut corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[a, b]| {
                let mut at = *cell;
                at[axis] += side;
                at[(axis + 1) % 3] += a;
                at[(axis + 2) % 3] += b;
                at
            });
            if side == 0 {
                corners.reverse();
            }
            faces.push(corners.map(|at| {
                *numbers.entry(at).or_insert_with(|| {
                    positions.push(at.map(f64::from));
                    positions.len() as u32 - 1
                })
            }));
        }
    }
    Quads { positions, faces }
}

pub(super) fn block([a, b, c]: [i32; 3]) -> Vec<[i32; 3]> {
    (0..a).flat_map(|i| (0..b).flat_map(move |j| (0..c).map(move |k| [i, j, k]))).collect()
}

/// A slab with two holes, of genus 2.
pub(super) fn slab() -> Quads {
    let mut set = block([5, 3, 1]);
    set.retain(|&[x, y, _]| !(y == 1 && (x == 1 || x == 3)));
    cells(&set)
}

/// Two poles with m patches around each.
fn trapezohedron(m: u32) -> Quads {
    let ring = |i: u32| 2 + i % (2 * m);
    let pair = |i: u32| {
        [
            [0, ring(2 * i), ring(2 * i + 1), ring(2 * i + 2)],
            [1, ring(2 * i + 3), ring(2 * i + 2), ring(2 * i + 1)],
        ]
    };
    Quads { positions: vec![[0.0; 3]; 2 + 2 * m as usize], faces: (0..m).flat_map(pair).collect() }
}

/// A torus of m × n patches, at (R + r cos v) (cos u, sin u) and r sin v.
fn torus([m, n]: [u32; 2]) -> Quads {
    let at = |i: u32, j: u32| {
        let [u, v] = [TAU * f64::from(i) / f64::from(m), TAU * f64::from(j) / f64::from(n)];
        [(2.0 + 0.7 * v.cos()) * u.cos(), (2.0 + 0.7 * v.cos()) * u.sin(), 0.7 * v.sin()]
    };
    let number = |i: u32, j: u32| (i % m) * n + j % n;
    let face = |i, j| [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
    Quads {
        positions: (0..m).flat_map(|i| (0..n).map(move |j| at(i, j))).collect(),
        faces: (0..m).flat_map(|i| (0..n).map(move |j| face(i, j))).collect(),
    }
}

/// Some spline of a space, whose free control points are all different.
pub(super) fn any_spline(space: &Arc<QuadSplineSpace>) -> QuadSpline {
    let coordinate =
        |k: usize, x: usize| (43758.5453 * (k as f64 * 12.9898 + x as f64 * 78.233).sin()).fract();
    let free: Vec<[f64; 3]> = (0..space.dimension()).map(|k| [0, 1, 2].map(|x| coordinate(k, x))).collect();
    QuadSpline::of_free(space.clone(), &free).unwrap()
}

/// The place on a side at a share of the way along it.
fn on_side(side: usize, x: f64) -> [f64; 2] {
    [[x, 0.0], [1.0, x], [1.0 - x, 1.0], [0.0, 1.0 - x]][side]
}

/// The largest distance between points of both sides of all smooth arcs, and the largest determinant of the unit vectors along an arc and into
/// both of its patches: 0 in a common tangent plane.
pub(super) fn jumps(spline: &QuadSpline) -> [f64; 2] {
    let layout = spline.space().layout();
    let mut worst = [0.0f64; 2];
    for arc in (0..layout.arcs().len()).filter(|&arc| !layout.arcs()[arc].is_crease) {
        let [Some(left), Some(right)] = layout.beside(arc) else { continue };
        for k in 0..=20 {
            let x = f64::from(k) / 20.0;
            let at = |side: PatchCorner, x| spline.evaluate(side.patch, on_side(side.corner, x)).unwrap();
            let [p, q] = [at(left, x), at(right, 1.0 - x)];
            worst[0] = worst[0].max(distance(p.point, q.point));
            // Along side k the derivative into the patch is that by the other parameter, away from side k + 2.
            let into = |at: SurfacePoint, side: usize| {
                scale(if side == 0 || side == 3 { 1.0 } else { -1.0 }, at.first[1 - side % 2])
            };
            let along = p.first[left.corner % 2];
            let [a, b, c] = [along, into(p, left.corner), into(q, right.corner)].map(normalised);
            worst[1] = worst[1].max(dot(a, cross(b, c)).abs());
        }
    }
    worst
}

#[test]
fn dimensions_are_those_of_the_formula() {
    // 4 F + 2 E + Σ (3 + valence), all nodes irregular and one span.
    for quads in [cells(&block([1, 1, 1])), trapezohedron(5), trapezohedron(6), trapezohedron(8)] {
        let (faces, nodes) = (quads.faces.len(), quads.positions.len());
        let edges = 2 * faces;
        assert_eq!(quads.space(1).dimension(), 4 * faces + 2 * edges + 3 * nodes + 2 * edges);
    }
    // Without irregular nodes: twice differentiable periodic splines, with three functions for each span.
    for spans in [1, 2, 3] {
        assert_eq!(torus([3, 4]).space(spans).dimension(), 12 * 9 * spans * spans);
    }
}

#[test]
fn tangent_planes_are_continuous_across_arcs_for_any_free_control_points() {
    let shapes =
        [cells(&block([3, 1, 1])), cells(&block([2, 2, 2])), slab(), trapezohedron(5), trapezohedron(8)];
    for quads in shapes {
        for spans in [1, 2, 3] {
            let spline = any_spline(&quads.space(spans));
            let [gap, turn] = jumps(&spline);
            assert!(
                gap < 1e-13 && turn < 1e-9,
                "{} patches, {spans} spans: {gap}, {turn}",
                quads.faces.len()
            );
        }
    }
}

/// A cube of eight cells, and its patches with creases around the lid z = 2.
pub(super) fn lidded() -> (Quads, PatchLayout) {
    let quads = cells(&block([2, 2, 2]));
    let border: Vec<[u32; 2]> = quads
        .faces
        .iter()
        .flat_map(|face| (0..4).map(|k| [face[k], face[(k + 1) % 4]]))
        .filter(|pair| pair.iter().all(|&v| quads.positions[v as usize][2] == 2.0))
        .filter(|pair| {
            let is_rim = |v: u32| quads.positions[v as usize][..2].iter().any(|&x| x == 0.0 || x == 2.0);
            pair.iter().all(|&v| is_rim(v))
        })
        .collect();
    let layout = PatchLayout::from_quads(quads.positions.len(), &quads.faces, &border).unwrap();
    (quads, layout)
}

#[test]
fn a_crease_lets_the_normal_jump_and_nothing_else() {
    let (quads, layout) = lidded();
    assert_eq!(layout.arcs().iter().filter(|arc| arc.is_crease).count(), 8);
    let space = Arc::new(QuadSplineSpace::new(layout, 1).unwrap());
    assert!(space.dimension() > quads.space(1).dimension());
    let spline = any_spline(&space);
    let [gap, turn] = jumps(&spline);
    assert!(gap < 1e-13 && turn < 1e-11, "{gap}, {turn}");
    let arc = space.layout().arcs().iter().position(|arc| arc.is_crease).unwrap();
    let [left, right] = space.layout().beside(arc).map(Option::unwrap);
    let normal =
        |side: PatchCorner| spline.evaluate(side.patch, on_side(side.corner, 0.5)).unwrap().normal().unwrap();
    assert!(norm(cross(normal(left), normal(right))) > 1e-3);
}

#[test]
fn layouts_that_cannot_be_are_refused_by_name() {
    let refused = |layout: Result<PatchLayout, Error>| layout.unwrap_err().to_string();
    let pillow = [[0, 1, 2, 3], [3, 2, 1, 0]];
    assert!(refused(PatchLayout::from_quads(4, &pillow, &[])).contains("three are needed"));
    let twice = [[0, 1, 2, 3], [0, 1, 4, 5]];
    assert!(refused(PatchLayout::from_quads(6, &twice, &[])).contains("same side"));
    assert!(refused(PatchLayout::from_quads(4, &pillow[..1], &[[0, 2]])).contains("no side joins"));
    let arc = PatchArc { ends: [0, 9], length: 1.0, is_crease: false };
    assert!(refused(PatchLayout::new(2, vec![arc], Vec::new())).contains("does not exist"));
    let cube = cells(&block([1, 1, 1]));
    for spans in [0, 33] {
        assert!(matches!(QuadSplineSpace::new(cube.layout(), spans), Err(Error::Argument { .. })));
    }
}

/// The point of an ellipsoid nearest to a point, by bisection, and the normal there.
pub(super) fn ellipsoid_foot(axes: [f64; 3], x: [f64; 3]) -> [[f64; 3]; 2] {
    let squares = axes.map(|a| a * a);
    let at = |t: f64| [0, 1, 2].map(|i| squares[i] * x[i] / (t + squares[i]));
    let level = |t: f64| (0..3).map(|i| (at(t)[i] / axes[i]).powi(2)).sum::<f64>() - 1.0;
    let (mut low, mut high) = (-0.999 * squares.iter().copied().fold(f64::INFINITY, f64::min), 100.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if level(middle) > 0.0 { low = middle } else { high = middle }
    }
    let point = at(low);
    [point, normalised([0, 1, 2].map(|i| point[i] / squares[i]))]
}

/// The larger principal curvature of an ellipsoid.
fn ellipsoid_curvature(axes: [f64; 3], point: [f64; 3]) -> f64 {
    let [a, b, c] = axes.map(|x| x * x);
    let w = point[0].powi(2) / (a * a) + point[1].powi(2) / (b * b) + point[2].powi(2) / (c * c);
    let gauss = 1.0 / (a * b * c * w * w);
    let mean = (a + b + c - dot(point, point)) / (2.0 * a * b * c * w.powf(1.5));
    mean + (mean * mean - gauss).max(0.0).sqrt()
}

pub(super) const AXES: [f64; 3] = [1.6, 1.0, 0.7];

/// The ellipsoid by a box of patches, from a mesh of it with edges of length 1 / n.
pub(super) fn fitted_ellipsoid(n: usize, spans: usize, threads: usize) -> QuadFit {
    let quads = cells(&block([3, 1, 1]));
    let mut mesh = shapes::icosphere(n).unwrap();
    mesh.positions.iter_mut().for_each(|p| *p = [0, 1, 2].map(|i| AXES[i] * p[i]));
    let target = SplineTarget::new(&mesh.positions, &mesh.faces, PI / 4.0).unwrap();
    let start = |patch: usize, uv: [f64; 2]| {
        let [x, y, z] = quads.at(patch, uv);
        ellipsoid_foot(
            AXES,
            [(2.0 * x / 3.0 - 1.0) * AXES[0], (2.0 * y - 1.0) * AXES[1], (2.0 * z - 1.0) * AXES[2]],
        )[0]
    };
    let options = QuadFitOptions { threads, ..QuadFitOptions::default() };
    fit_quads(quads.space(spans), &start, &target, &options, &Control::new()).unwrap()
}

/// The largest distance over twice the length of the axes, the largest error of a normal in degrees, and the largest relative error of a
/// principal curvature.
fn errors(spline: &QuadSpline) -> [f64; 3] {
    let mut worst = [0.0f64; 3];
    for patch in 0..spline.space().layout().patches().len() {
        for (i, j) in (0..=18).flat_map(|i| (0..=18).map(move |j| (i, j))) {
            let at = spline.evaluate(patch, [f64::from(i) / 18.0, f64::from(j) / 18.0]).unwrap();
            let [foot, normal] = ellipsoid_foot(AXES, at.point);
            worst[0] = worst[0].max(distance(at.point, foot) / (2.0 * norm(AXES)));
            let cosine = dot(at.normal().unwrap(), normal);
            worst[1] = worst[1].max(cosine.clamp(-1.0, 1.0).acos().to_degrees());
            // The normal points outwards, where the ellipsoid bends away from it.
            let [_, least] = at.principal_curvatures().unwrap();
            let exact = ellipsoid_curvature(AXES, foot);
            worst[2] = worst[2].max((-least - exact).abs() / exact);
        }
    }
    worst
}

#[test]
fn an_ellipsoid_is_met_from_its_mesh_to_second_order_of_the_mesh_and_better() {
    let fine = fitted_ellipsoid(24, 1, 0);
    let after = errors(&fine.spline);
    // The space of one span is the limit on these meshes, that of two is not.
    let [coarse, finer] = [12, 24].map(|n| errors(&fitted_ellipsoid(n, 2, 0).spline));
    assert!(fine.folded_patches.is_empty() && fine.spline.space().n_control_points() == 352);
    assert!(after[0] < 4e-6 && after[1] < 0.03 && after[2] < 0.006, "{after:?}");
    assert!(coarse[0] / finer[0] > 4.0 && finer[0] < after[0], "{coarse:?} {finer:?} {after:?}");
    let [gap, turn] = jumps(&fine.spline);
    assert!(gap < 1e-14 && turn < 1e-11, "{gap}, {turn}");
    assert!(fine.spline.normal_jump() < 1e-10, "{}", fine.spline.normal_jump());
}

#[test]
fn a_fit_is_the_same_for_any_number_of_threads() {
    let [one, two] = [1, 2].map(|threads| fitted_ellipsoid(6, 1, threads));
    assert_eq!(one.spline.control_points(), two.spline.control_points());
    assert_eq!((one.to_target, one.of_vertices), (two.to_target, two.of_vertices));
    assert_eq!((one.patch_max.clone(), one.worst_patch()), (two.patch_max.clone(), two.worst_patch()));
    assert_eq!(one.patch_max[one.worst_patch()], one.max());
}

/// A spline over a cylinder of radius 1 between z = -1 and 1 from its mesh with 96 sectors: two lids of nine patches and a barrel of twelve. Per patch true
/// on a lid.
pub(super) fn fitted_drum() -> (QuadFit, Vec<bool>) {
    let mut set = cells(&block([3, 3, 1]));
    let is_lid = |face: &[u32; 4]| {
        let z = face.map(|v| set.positions[v as usize][2]);
        z.iter().all(|&x| x == z[0])
    };
    let lids: Vec<bool> = set.faces.iter().map(is_lid).collect();
    let rim: Vec<[u32; 2]> = set
        .faces
        .iter()
        .zip(&lids)
        .filter(|(_, lid)| !**lid)
        .flat_map(|(face, _)| (0..4).map(|k| [face[k], face[(k + 1) % 4]]))
        .filter(|pair| set.positions[pair[0] as usize][2] == set.positions[pair[1] as usize][2])
        .collect();
    set.positions.iter_mut().for_each(|p| *p = on_drum(*p));
    let layout = PatchLayout::from_quads(set.positions.len(), &set.faces, &rim).unwrap();
    let space = Arc::new(QuadSplineSpace::new(layout, 1).unwrap());
    let mesh = drum(96);
    let target = SplineTarget::new(&mesh.0, &mesh.1, PI / 4.0).unwrap();
    assert_eq!(target.n_pieces(), 3);
    let start = |patch: usize, uv: [f64; 2]| set.at(patch, uv);
    let fit = fit_quads(space, &start, &target, &QuadFitOptions::default(), &Control::new()).unwrap();
    (fit, lids)
}

#[test]
fn the_sharp_edges_of_a_drum_are_kept() {
    let (fit, lids) = fitted_drum();
    let mut worst = [0.0f64; 2];
    for (patch, lid) in lids.iter().enumerate() {
        for (i, j) in (0..=18).flat_map(|i| (0..=18).map(move |j| (i, j))) {
            let [x, y, z] =
                fit.spline.evaluate(patch, [f64::from(i) / 18.0, f64::from(j) / 18.0]).unwrap().point;
            if *lid {
                worst[0] = worst[0].max((z.abs() - 1.0).abs());
            } else {
                worst[1] = worst[1].max((x.hypot(y) - 1.0).abs());
            }
        }
    }
    // The mesh has chords of the circle, 5e-4 inside of it; its vertices tell the cylinder.
    assert!(worst[0] < 1e-12 && worst[1] < 3e-6, "{worst:?}");
    let volume = fit.spline.volume();
    assert!((volume / TAU - 1.0).abs() < 1e-6, "{volume}");
    assert!(fit.max() < 1e-6, "{}", fit.max());
}

/// A point of the grid of 3 × 3 × 1 cells on the drum: squares around the axis become circles.
fn on_drum([x, y, z]: [f64; 3]) -> [f64; 3] {
    let [a, b] = [x - 1.5, y - 1.5];
    let size = a.abs().max(b.abs()) / 1.5;
    let length = a.hypot(b);
    let circle = if length > 0.0 { size / length } else { 0.0 };
    [a * circle, b * circle, 2.0 * z - 1.0]
}

/// A closed cylinder of radius 1 around the z axis between z = −1 and 1, with n sectors.
fn drum(n: u32) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut positions = vec![[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]];
    for z in [-1.0, 1.0] {
        positions.extend((0..n).map(|k| {
            let (sin, cos) = (TAU * f64::from(k) / f64::from(n)).sin_cos();
            [cos, sin, z]
        }));
    }
    let mut faces = Vec::new();
    for k in 0..n {
        let [a, b] = [2 + k, 2 + (k + 1) % n];
        let [c, d] = [a + n, b + n];
        faces.extend([[0, b, a], [1, c, d], [a, b, d], [a, d, c]]);
    }
    (positions, faces)
}

#[test]
fn a_torus_is_met_with_the_order_of_its_degree() {
    let error = |m: u32| {
        let quads = torus([3 * m, 3 * m]);
        let mesh = shapes::torus(2.0, 0.7, 240, 120).unwrap();
        let target = SplineTarget::new(&mesh.positions, &mesh.faces, PI / 4.0).unwrap();
        let start = |patch: usize, uv: [f64; 2]| {
            let p = quads.at(patch, uv);
            let ring = scale(2.0 / p[0].hypot(p[1]), [p[0], p[1], 0.0]);
            let across = normalised(sub(p, ring));
            [0, 1, 2].map(|x| ring[x] + 0.7 * across[x])
        };
        let fit =
            fit_quads(quads.space(1), &start, &target, &QuadFitOptions::default(), &Control::new()).unwrap();
        let mut worst = 0.0f64;
        for patch in 0..quads.faces.len() {
            for (i, j) in (0..=12).flat_map(|i| (0..=12).map(move |j| (i, j))) {
                let [x, y, z] =
                    fit.spline.evaluate(patch, [f64::from(i) / 12.0, f64::from(j) / 12.0]).unwrap().point;
                worst = worst.max(((x.hypot(y) - 2.0).hypot(z) - 0.7).abs());
            }
        }
        worst
    };
    let [coarse, fine] = [error(1), error(2)];
    println!("torus {coarse:.2e} {fine:.2e}");
    assert!(coarse / fine > 16.0, "{coarse} {fine}");
}
