//! Seamless metrics of surfaces with boundary and features: known answers, straight lines, angles measured anew.

use crate::common::Random;
use ricci::mesh::io::Soup;
use ricci::mesh::{HalfedgeId, Mesh, PerEdge, PerVertex, VertexId, shapes};
use ricci::seamless::{
    ConeValence, CrossField, Seamless, SeamlessCones, SeamlessMap, SeamlessOptions, curvature_guides,
    seamless, sharp_edges, stroke_guides,
};
use ricci::{Control, Error, Surface};
use std::f64::consts::{FRAC_PI_2, TAU};

fn made(surface: &Surface, options: &SeamlessOptions) -> Seamless {
    seamless(surface, options, &Control::new()).unwrap()
}

/// A rectangle of `width` by 1 with points off the grid inside.
fn rectangle(width: f64, n: usize) -> Surface {
    let mut random = Random::new(3);
    let (columns, rows) = ((width * n as f64) as usize, n);
    let step = 1.0 / n as f64;
    let mut positions = Vec::new();
    for j in 0..=rows {
        for i in 0..=columns {
            let is_inside = i > 0 && j > 0 && i < columns && j < rows;
            let mut off = || if is_inside { 0.5 * (random.unit() - 0.5) } else { 0.0 };
            positions.push([(i as f64 + off()) * step, (j as f64 + off()) * step, 0.0]);
        }
    }
    let at = |i: usize, j: usize| (j * (columns + 1) + i) as u32;
    let square = |k: usize| {
        let (i, j) = (k % columns, k / columns);
        [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
    };
    let faces = (0..columns * rows).flat_map(square).collect();
    Surface::from_soup(&Soup { positions, faces, ..Soup::default() }).unwrap()
}

/// The surface of a box, each edge cut into so many parts.
fn block(parts: [usize; 3]) -> Surface {
    let mut positions: Vec<[f64; 3]> = Vec::new();
    let mut faces = Vec::new();
    let mut vertex = |p: [usize; 3]| {
        let p = p.map(|x| x as f64);
        positions.iter().position(|q| *q == p).unwrap_or_else(|| {
            positions.push(p);
            positions.len() - 1
        }) as u32
    };
    for axis in 0..3 {
        let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
        for (level, is_up) in [(0, false), (parts[axis], true)] {
            for i in 0..parts[u] {
                for j in 0..parts[v] {
                    let mut corner = |a: usize, b: usize| {
                        let mut p = [0; 3];
                        (p[axis], p[u], p[v]) = (level, i + a, j + b);
                        vertex(p)
                    };
                    let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                    faces.extend(if is_up { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] });
                }
            }
        }
    }
    Surface::from_soup(&Soup { positions, faces, ..Soup::default() }).unwrap()
}

/// Largest difference between the logarithms of the ratios of old and new lengths of edges that are in both triangulations.
fn spread_of_scale(of: &Seamless, surface: &Surface) -> f64 {
    let mesh = of.solution.mesh();
    assert_eq!(**mesh, **surface.mesh(), "flipped");
    let lengths = of.solution.metric().lengths(mesh).unwrap();
    let ratios: Vec<f64> = lengths.iter().zip(surface.lengths().iter()).map(|(a, b)| (a / b).ln()).collect();
    ratios.iter().fold(f64::MIN, |a, b| a.max(*b)) - ratios.iter().fold(f64::MAX, |a, b| a.min(*b))
}

/// The angle at the origin of a half-edge, in its face, by the law of cosines alone.
fn angle(mesh: &Mesh, lengths: &PerEdge<f64>, h: HalfedgeId) -> f64 {
    let [a, c, b] = [h, mesh.next(h), mesh.prev(h)].map(|h| lengths[h.edge()]);
    ((a * a + b * b - c * c) / (2.0 * a * b)).acos()
}

/// Largest distance from a multiple of 90° of the angles between features around all vertices, by the law of cosines.
fn off_right_angles(of: &Seamless) -> f64 {
    let mesh = of.solution.mesh();
    let lengths = of.solution.metric().lengths(mesh).unwrap();
    let mut is_feature = vec![false; mesh.n_edges()];
    of.features.iter().for_each(|e| is_feature[e.index()] = true);
    let mut worst = 0.0f64;
    for v in mesh.vertices() {
        let fan = mesh.fan(v);
        let first = fan.iter().position(|h| is_feature[h.edge().index()]).unwrap_or(0);
        let mut sum = 0.0;
        for k in 0..fan.len() {
            let h = fan[(first + k) % fan.len()];
            if k > 0 && is_feature[h.edge().index()] {
                worst = worst.max((sum / FRAC_PI_2 - f64::round(sum / FRAC_PI_2)).abs());
                sum = 0.0;
            }
            sum += angle(mesh, &lengths, h);
        }
        worst = worst.max((sum / FRAC_PI_2 - f64::round(sum / FRAC_PI_2)).abs());
    }
    worst
}

#[test]
fn a_flat_rectangle_returns_itself() {
    let surface = rectangle(2.0, 8);
    let of = made(&surface, &SeamlessOptions::default());
    assert!(of.converged(), "{:e}", of.error);
    assert_eq!(of.cones.iter().map(|cone| cone.valence).collect::<Vec<_>>(), [1; 4]);
    let SeamlessMap { layout, bend, .. } = of.map(&Control::new()).unwrap();
    let quality = layout.quality(surface.mesh(), surface.lengths()).unwrap();
    assert!((quality.symmetric_dirichlet - 4.0).abs() < 1e-8, "{}", quality.symmetric_dirichlet);
    assert!(bend == 0.0 && layout.flipped.is_empty(), "{bend:e}");
    let [x, y] = [0, 1].map(|k| {
        let at: Vec<f64> = layout.coordinates.iter().map(|z| z[k]).collect();
        at.iter().fold(f64::MIN, |a, b| a.max(*b)) - at.iter().fold(f64::MAX, |a, b| a.min(*b))
    });
    assert!(((x / y).max(y / x) - 2.0).abs() < 1e-9, "{x} {y}");
}

#[test]
fn a_flat_torus_without_turning_returns_itself() {
    for tau in [[0.0, 1.0], [0.3, 1.7], [-0.45, 0.9]] {
        let (mesh, lengths) = shapes::flat_torus(tau, 6, 7).unwrap().build().unwrap();
        let surface = Surface::intrinsic(mesh, lengths, ricci::geometry::Space::E2).unwrap();
        let cones = SeamlessCones::Valences(Vec::new());
        let of = made(&surface, &SeamlessOptions { cones, ..SeamlessOptions::default() });
        assert!(of.converged() && of.quarter_turns == [0, 0]);
        let lengths = of.solution.metric().lengths(of.solution.mesh()).unwrap();
        let mut ours: Vec<f64> = lengths.to_vec();
        let start = of.solution.initial().metric.lengths(of.solution.mesh()).unwrap();
        let mut theirs: Vec<f64> = start.to_vec();
        ours.sort_by(f64::total_cmp);
        theirs.sort_by(f64::total_cmp);
        let scale = ours[0] / theirs[0];
        for (a, b) in ours.iter().zip(&theirs) {
            assert!((a / b / scale - 1.0).abs() < 1e-9, "{tau:?}: {a} {b}");
        }
    }
}

/// Three squares in the shape of an L, each cut into `n` by `n`, with opposite sides glued: genus 2, one cone of 1080°.
fn glued_squares(n: usize) -> Surface {
    let width = 2 * n + 1;
    let mut class: Vec<usize> = (0..width * width).collect();
    let mut glue = |[i, j]: [usize; 2], [k, l]: [usize; 2]| {
        let (from, to) = (class[i + width * j], class[k + width * l]);
        class.iter_mut().filter(|c| **c == from).for_each(|c| *c = to);
    };
    for k in 0..=n {
        glue([2 * n, k], [0, k]);
        glue([n, n + k], [0, n + k]);
        glue([k, 2 * n], [k, 0]);
        glue([n + k, n], [n + k, 0]);
    }
    let mut names: Vec<usize> = Vec::new();
    let mut vertex = |i: usize, j: usize| {
        let c = class[i + width * j];
        names.iter().position(|x| *x == c).unwrap_or_else(|| {
            names.push(c);
            names.len() - 1
        }) as u32
    };
    let mut faces = Vec::new();
    for (i, j) in (0..2 * n).flat_map(|i| (0..2 * n).map(move |j| (i, j))).filter(|(i, j)| *i < n || *j < n) {
        let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
        faces.extend([[a, b, c], [a, c, d]]);
    }
    let mesh = Mesh::from_faces(names.len(), &faces).unwrap();
    let mut lengths = PerEdge::filled(mesh.n_edges(), 1.0);
    for f in mesh.faces() {
        let [a, _, c] = mesh.face_vertices(f);
        let sides = mesh.face_halfedges(f);
        let diagonal = sides.into_iter().find(|&h| {
            let ends = [mesh.origin(h), mesh.tip(h)];
            if f.index() % 2 == 0 { ends == [c, a] } else { ends == [a, mesh.face_vertices(f)[1]] }
        });
        lengths[diagonal.unwrap().edge()] = 2f64.sqrt();
    }
    Surface::intrinsic(mesh, lengths, ricci::geometry::Space::E2).unwrap()
}

#[test]
fn glued_squares_return_themselves() {
    let surface = glued_squares(4);
    let mesh = surface.mesh();
    assert_eq!((mesh.n_vertices(), mesh.genus()), (3 * 16 - 2, 2));
    let cone = mesh.vertices().max_by_key(|&v| mesh.fan(v).len()).unwrap();
    let cones = SeamlessCones::Valences(vec![ConeValence { vertex: cone, valence: 12 }]);
    let of = made(&surface, &SeamlessOptions { cones, ..SeamlessOptions::default() });
    assert!(of.converged(), "{:e}", of.error);
    assert!(of.quarter_turns.iter().all(|k| k % 4 == 0), "{:?}", of.quarter_turns);
    assert!(spread_of_scale(&of, &surface) < 1e-8);
}

#[test]
fn a_box_of_squares_returns_itself_along_its_edges() {
    let surface = block([2, 3, 4]);
    let features = sharp_edges(&surface, 1.0).unwrap();
    assert_eq!(features.len(), 4 * (2 + 3 + 4));
    let of = made(&surface, &SeamlessOptions { features, ..SeamlessOptions::default() });
    assert!(of.converged(), "{:e}", of.error);
    assert_eq!(of.cones.iter().map(|cone| cone.valence).collect::<Vec<_>>(), [3; 8]);
    assert!(spread_of_scale(&of, &surface) < 1e-8);
    assert_eq!(of.map(&Control::new()).unwrap().bend, 0.0);
}

#[test]
fn an_annulus_becomes_the_cylinder_of_its_modulus() {
    // Height over circumference is ln(R/r)/2π; the error falls with the square of the size of triangles.
    let errors = [1, 2, 4].map(|n| {
        let surface = Surface::from_soup(&shapes::annulus(0.4, 1.0, 3 * n, 16 * n).unwrap()).unwrap();
        let of = made(&surface, &SeamlessOptions::default());
        assert!(of.converged() && of.cones.is_empty() && of.quarter_turns == [0], "{:?}", of.cones);
        let SeamlessMap { layout, bend, .. } = of.map(&Control::new()).unwrap();
        assert_eq!(bend, 0.0);
        let y: Vec<f64> = layout.coordinates.iter().map(|z| z[1]).collect();
        let height = y.iter().fold(f64::MIN, |a, b| a.max(*b)) - y.iter().fold(f64::MAX, |a, b| a.min(*b));
        let mesh = of.solution.mesh();
        let lengths = of.solution.metric().lengths(mesh).unwrap();
        let both: f64 = of.features.iter().map(|&e| lengths[e]).sum();
        (height / layout.scale / (0.5 * both) - (1.0f64 / 0.4).ln() / TAU).abs()
    });
    println!("{errors:?}");
    assert!(errors[0] > 3.0 * errors[1] && errors[1] > 3.0 * errors[2] && errors[2] < 1e-3, "{errors:?}");
}

#[test]
fn boundaries_become_straight() {
    for (name, soup) in [
        ("disk", shapes::disk(6).unwrap()),
        ("sphere with holes", shapes::punch(&shapes::icosphere(6).unwrap(), 3).unwrap()),
        ("torus with holes", shapes::punch(&shapes::torus(2.0, 1.0, 24, 14).unwrap(), 2).unwrap()),
        ("genus 2 with a hole", shapes::punch(&shapes::genus(2, 6).unwrap(), 1).unwrap()),
    ] {
        let surface = Surface::from_soup(&soup).unwrap();
        let of = made(&surface, &SeamlessOptions::default());
        assert!(of.converged(), "{name}: {:e} after {:?}", of.error, of.iterations);
        let (mesh, loops) = (surface.mesh(), surface.mesh().boundary_loops().len());
        assert_eq!(of.quarter_turns.len(), 2 * mesh.genus() + loops - 1, "{name}");
        assert!(off_right_angles(&of) < 1e-9, "{name}");
        let SeamlessMap { layout, moved, bend } = of.map(&Control::new()).unwrap();
        assert!(bend == 0.0 && moved < 1e-9 * layout.diameter, "{name}: {bend:e} {moved:e}");
        assert!(layout.flipped.is_empty(), "{name}");
        println!("{name}: {:?} iterations, {:.1e}, {} cones", of.iterations, of.error, of.cones.len());
    }
}

#[test]
fn isometric_steps_bring_lengths_nearer() {
    let surface = Surface::from_soup(&shapes::genus(2, 4).unwrap()).unwrap();
    let of = made(&surface, &SeamlessOptions { isometric_steps: 4, ..SeamlessOptions::default() });
    let [before, after] = of.length_changes;
    assert!(of.converged() && after < 0.9 * before, "{before} {after} {:e}", of.error);
    let n = surface.mesh().n_vertices();
    let wrong = SeamlessOptions { sizes: Some(PerVertex::filled(n, 0.0)), ..SeamlessOptions::default() };
    assert!(matches!(seamless(&surface, &wrong, &Control::new()), Err(Error::Argument { .. })));
}

#[test]
fn fields_follow_boundaries_strokes_and_curvature() {
    let surface = rectangle(1.0, 6);
    let off_axes = |field: &CrossField, turn: f64| {
        let directions = field.in_space(&surface).unwrap();
        let off = |d: &[f64; 3]| {
            let turns = (d[1].atan2(d[0]) - turn) / FRAC_PI_2;
            (turns - turns.round()).abs()
        };
        directions.iter().map(off).fold(0.0, f64::max)
    };
    let free = CrossField::new(&surface, &[], &[], &Control::new()).unwrap();
    assert!(off_axes(&free, 0.0) < 1e-6);
    // A torus of revolution has its lines of curvature along its two circles.
    let torus = Surface::from_soup(&shapes::torus(3.0, 1.0, 40, 20).unwrap()).unwrap();
    let guides = curvature_guides(&torus, 10.0).unwrap();
    let field = CrossField::new(&torus, &[], &guides, &Control::new()).unwrap();
    let (directions, positions) = (field.in_space(&torus).unwrap(), torus.positions().unwrap());
    for f in torus.mesh().faces() {
        let [x, y, _] = positions[torus.mesh().face_vertices(f)[0].index()];
        let round = [-y, x].map(|t| t / x.hypot(y));
        let along = (directions[f][0] * round[0] + directions[f][1] * round[1]).abs();
        assert!(!(0.25..0.97).contains(&along), "{along}");
    }
    let stroke = [(VertexId(0), [1.0, 1.0, 0.0])];
    let sphere = Surface::from_soup(&shapes::icosphere(4).unwrap()).unwrap();
    assert!(!stroke_guides(&sphere, &stroke).unwrap().is_empty());
    assert!(stroke_guides(&sphere, &[(VertexId(0), [0.0; 3])]).is_err());
    assert!(stroke_guides(&sphere, &[(VertexId(9999), [1.0, 0.0, 0.0])]).is_err());
}

#[test]
fn one_double_zero_has_odd_spin() {
    let surface = Surface::from_soup(&shapes::genus(2, 4).unwrap()).unwrap();
    let cone = ConeValence { vertex: VertexId(0), valence: 12 };
    let mut refused = 0;
    for class in 0..16 {
        let turns = (0..4).map(|k| 4 * (class >> k & 1)).collect();
        let options = SeamlessOptions {
            cones: SeamlessCones::Valences(vec![cone]),
            quarter_turns: Some(turns),
            max_iterations: 0,
            ..SeamlessOptions::default()
        };
        match seamless(&surface, &options, &Control::new()) {
            Err(Error::TargetKind { message, .. }) => {
                assert!(message.contains("KZ03"), "{message}");
                refused += 1;
            }
            other => assert!(other.is_ok()),
        }
    }
    // Of the 16 spin structures of genus 2 six are odd.
    assert_eq!(refused, 10);
}

/// A torus whose wave has ridges and valleys that bend, so that sharp edges meet at all angles.
fn ridged_torus() -> Surface {
    let mut soup = shapes::torus(2.0, 1.0, 30, 18).unwrap();
    for p in &mut soup.positions {
        let (a, b) = (p[1].atan2(p[0]), p[2].atan2(p[0].hypot(p[1]) - 2.0));
        let off = 1.0 + 0.25 * (5.0 * a + 3.0 * b).sin() * (4.0 * b).cos();
        let around = p[0].hypot(p[1]);
        let (x, z) = ((around - 2.0) * off + 2.0, p[2] * off);
        *p = [p[0] * x / around, p[1] * x / around, z];
    }
    Surface::from_soup(&soup).unwrap()
}

#[test]
fn sharp_edges_that_bend_are_reached_in_few_steps() {
    let surface = ridged_torus();
    let features = sharp_edges(&surface, 0.7).unwrap();
    let asked = features.len();
    let of = made(&surface, &SeamlessOptions { features, ..SeamlessOptions::default() });
    println!("{asked} asked, {} left out, {:?} iterations", of.left_out.len(), of.iterations);
    assert!(of.converged() && of.features.len() + of.left_out.len() == asked && asked > 60, "{:e}", of.error);
    assert!(2 * of.left_out.len() < asked && of.iterations[1] <= 40, "{:?}", of.iterations);
    assert!(off_right_angles(&of) < 1e-9);
    let SeamlessMap { layout, bend, .. } = of.map(&Control::new()).unwrap();
    assert!(bend == 0.0 && layout.flipped.is_empty(), "{bend:e}");
}

#[test]
fn a_lone_sharp_triangle_is_left_out_and_told() {
    // A triangle has no room for four right angles.
    let surface = Surface::from_soup(&shapes::icosphere(4).unwrap()).unwrap();
    let features = surface.mesh().face_halfedges(ricci::mesh::FaceId(0)).map(|h| h.edge()).to_vec();
    let of = made(&surface, &SeamlessOptions { features: features.clone(), ..SeamlessOptions::default() });
    let mut wanted = features;
    wanted.sort_unstable();
    assert!(of.converged() && of.features.is_empty());
    assert_eq!(of.left_out, wanted);
}
