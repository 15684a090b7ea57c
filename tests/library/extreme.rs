//! Extreme input: the flow reaches its target, or its stated rounding floor, or refuses it by name. No result is NaN, and no report
//! claims what does not hold.

use crate::common::Random;
use crate::common::flips::{SCHEMES, balanced, honest, in_the_middle, started, stretched};
use crate::common::flow::{attempt, euclidean, prescribing_target, surface};
use ricci::flow::{Options, Report, StopReason};
use ricci::geometry::Space;
use ricci::mesh::shapes::{self, Sliver};
use ricci::mesh::{EdgeId, Mesh, PerEdge, PerVertex, VertexId};
use ricci::metric::Scheme;
use ricci::metric::delaunay::{IntrinsicOptions, Triangulated, intrinsic_delaunay};
use ricci::metric::target::check_admissible;
use ricci::{Class, Control, Error, Flow, Target};
use std::f64::consts::PI;

type Surface = (Mesh, PerEdge<f64>);

/// Runs one flow, checks it and prints a line. Errors at the start count as refusals.
fn flow(
    (mesh, lengths): &Surface,
    geometry: Space,
    (space, scheme): (Space, Scheme),
    target: &PerVertex<f64>,
    what: &str,
) -> Result<Report, Error> {
    let what = format!("{what}, {space} {scheme}");
    let class = Class::new(scheme, space);
    check_admissible(mesh, class, target).unwrap();
    let given = ricci::Surface::intrinsic(mesh.clone(), lengths.clone(), geometry)?;
    let mut flow = Flow::new(given, class, &Options::default(), &Control::new())?;
    let report = attempt(&mut flow, target);
    let reached = honest(&flow, &report, target, &what);
    println!(
        "{what}: {}, {} steps, {} + {} flips, error {:.1e} of {:.1e}",
        report.stop_reason,
        report.iterations,
        flow.start_flips(),
        report.flips,
        report.max_curvature_error,
        report.allowed_error()
    );
    assert!(reached, "{what}: {}", report.stop_reason);
    Ok(report)
}

/// The flat metric (four cones on a sphere), and the one of constant curvature −1 where it exists.
fn default_targets(surface: &Surface) -> Vec<(Space, PerVertex<f64>)> {
    let given = euclidean(&surface.0, &surface.1);
    let curved = (given.mesh().euler() < 0).then_some(Space::H2);
    let target = |space| {
        let target = prescribing_target(&given, space);
        (space, target.resolve(&given, Class::yamabe(space)).unwrap())
    };
    [Space::E2].into_iter().chain(curved).map(target).collect()
}

#[test]
fn slivers_of_a_millionth_of_a_radian() {
    let shapes = [
        ("sphere", shapes::icosphere(5).unwrap()),
        ("torus", shapes::torus(2.0, 0.8, 20, 10).unwrap()),
        ("genus 2", shapes::genus(2, 3).unwrap()),
        ("disk", shapes::disk(6).unwrap()),
    ];
    for (name, soup) in shapes {
        for kind in [Sliver::Cap, Sliver::Needle] {
            let mut soup = soup.clone();
            shapes::slivers(&mut soup, kind, 40, 1e-6, 3).unwrap();
            let surface = surface(&soup);
            for (space, target) in default_targets(&surface) {
                for scheme in SCHEMES {
                    let what = format!("{name} with {kind:?}s");
                    flow(&surface, Space::E2, (space, scheme), &target, &what).unwrap();
                }
            }
        }
    }
}

#[test]
fn edges_a_million_times_as_long_as_others() {
    let shapes = [
        ("sphere", shapes::icosphere(5).unwrap()),
        ("torus", shapes::torus(2.0, 0.8, 20, 10).unwrap()),
        ("genus 2", shapes::genus(2, 3).unwrap()),
        ("disk", shapes::disk(6).unwrap()),
    ];
    for (name, mut soup) in shapes {
        let finest = soup.positions.len() as u32 / 2;
        shapes::grade(&mut soup, finest, 20).unwrap();
        let graded = surface(&soup);
        let range = |lengths: &PerEdge<f64>| {
            let (low, high) = lengths.iter().fold((f64::MAX, 0.0f64), |(a, b), &l| (a.min(l), b.max(l)));
            high / low
        };
        assert!(range(&graded.1) > 1e6, "{name}: {:e}", range(&graded.1));
        for (space, target) in default_targets(&graded) {
            for scheme in SCHEMES {
                flow(&graded, Space::E2, (space, scheme), &target, &format!("graded {name}")).unwrap();
            }
        }
    }
}

#[test]
fn a_sphere_a_million_times_as_long_as_wide() {
    let (surface, by_height) = stretched(6, 1e6);
    let n = by_height.len();
    // Two cones at either end: a long flat pillow.
    let ends: Vec<_> = [0, 1, n - 2, n - 1].iter().map(|&k| (by_height[k], PI)).collect();
    for scheme in SCHEMES {
        let kind = (Space::E2, scheme);
        flow(&surface, Space::E2, kind, &balanced(&surface.0, &ends), "cones at the ends").unwrap();
        // The metric with four cones in the middle has triangles with angles of 1e-24, and ∂K/∂u entries of 1e24 beside entries of 1, of
        // which f64 keeps nothing: the flow stalls, and its report says so.
        let target = in_the_middle(&surface.0, &by_height);
        let mut flow = started(&surface, kind, &Options { max_iterations: 150, ..Options::default() });
        let report = attempt(&mut flow, &target);
        honest(&flow, &report, &target, "cones in the middle");
        println!("cones in the middle, {scheme}: {} after {}", report.stop_reason, report.iterations);
        assert_ne!(report.stop_reason, StopReason::Diverged, "{scheme}");
    }
}

/// Needles with angles of 1e-12 on the way and at the end. They magnify the rounding of η by 1e12, and flips add it up: with η in f64 the
/// flow stalls at an error of 1e-3.
#[test]
fn needles_of_a_millionth_of_a_millionth_of_a_radian() {
    let (surface, by_height) = stretched(6, 1e5);
    let target = in_the_middle(&surface.0, &by_height);
    for scheme in SCHEMES {
        flow(&surface, Space::E2, (Space::E2, scheme), &target, "cones in the middle").unwrap();
    }
}

#[test]
fn targets_near_the_largest_admissible_curvature() {
    let closed = [
        ("sphere", surface(&shapes::icosphere(5).unwrap())),
        ("genus 2", surface(&shapes::genus(2, 3).unwrap())),
    ];
    for (name, surface) in &closed {
        let n = surface.0.n_vertices() as u32;
        for short in [1e-3, 1e-6] {
            for many in [1, 2, 5] {
                let cones: Vec<_> = (0..many).map(|k| (VertexId(k * (n / many)), 2.0 * PI - short)).collect();
                let target = balanced(&surface.0, &cones);
                for scheme in SCHEMES {
                    let what = format!("{name}, {many} × (2π − {short:e})");
                    flow(surface, Space::E2, (Space::E2, scheme), &target, &what).unwrap();
                }
            }
        }
    }
    let disk = surface(&shapes::disk(6).unwrap());
    let corners: Vec<VertexId> =
        disk.0.vertices().filter(|&v| disk.0.is_boundary_vertex(v)).step_by(7).take(5).collect();
    for short in [1e-3, 1e-6] {
        for many in [1, 2, 5] {
            let cones: Vec<_> = corners[..many].iter().map(|&v| (v, PI - short)).collect();
            let target = balanced(&disk.0, &cones);
            for scheme in SCHEMES {
                let what = format!("disk, {many} × (π − {short:e})");
                flow(&disk, Space::E2, (Space::E2, scheme), &target, &what).unwrap();
            }
        }
    }
}

#[test]
fn hyperbolic_targets_near_a_metric_without_area() {
    // Σ K̄ just above 2πχ: the area, which is the difference, is as small.
    let surface = surface(&shapes::genus(2, 3).unwrap());
    let n = surface.0.n_vertices();
    for area in [1e-3, 1e-6] {
        let target = PerVertex::filled(n, (2.0 * PI * surface.0.euler() as f64 + area) / n as f64);
        for scheme in SCHEMES {
            flow(&surface, Space::E2, (Space::H2, scheme), &target, &format!("area {area:e}")).unwrap();
        }
    }
    // And vertices that are nearly cusps.
    for short in [1e-3, 1e-6] {
        let mut target = PerVertex::filled(n, 0.0);
        target[0usize.into()] = 2.0 * PI - short;
        for scheme in SCHEMES {
            flow(&surface, Space::E2, (Space::H2, scheme), &target, &format!("2π − {short:e}")).unwrap();
        }
    }
}

#[test]
fn cones_on_neighbouring_vertices() {
    let surfaces = [
        ("sphere", surface(&shapes::icosphere(5).unwrap())),
        ("torus", surface(&shapes::torus(2.0, 0.8, 20, 10).unwrap())),
        ("genus 2", surface(&shapes::genus(2, 3).unwrap())),
    ];
    for (name, surface) in &surfaces {
        let [a, b] = surface.0.ends(17usize.into());
        for (p, q) in
            [(1.9 * PI, -1.9 * PI), (1.9 * PI, 1.9 * PI), (-6.0 * PI, -6.0 * PI), (1.99 * PI, -8.0 * PI)]
        {
            let target = balanced(&surface.0, &[(a, p), (b, q)]);
            for scheme in SCHEMES {
                let what = format!("{name}, {:.2}π beside {:.2}π", p / PI, q / PI);
                flow(surface, Space::E2, (Space::E2, scheme), &target, &what).unwrap();
            }
        }
    }
}

#[test]
fn all_curvature_at_one_vertex() {
    for genus in 1..=3 {
        let surface = surface(&shapes::genus(genus, 4).unwrap());
        for vertex in [0, surface.0.n_vertices() / 2] {
            let target = Target::Single(vertex.into());
            let target =
                target.resolve(&euclidean(&surface.0, &surface.1), Class::yamabe(Space::E2)).unwrap();
            for scheme in SCHEMES {
                let what = format!("genus {genus}, all at vertex {vertex}");
                flow(&surface, Space::E2, (Space::E2, scheme), &target, &what).unwrap();
            }
        }
    }
}

#[test]
fn surfaces_of_one_or_two_vertices() {
    let mut surfaces = vec![("two triangles".to_string(), shapes::two_triangle_sphere())];
    for genus in 1..=4 {
        surfaces.push((format!("one vertex, genus {genus}"), shapes::one_vertex(genus).unwrap()));
        surfaces.push((format!("two vertices, genus {genus}"), shapes::two_vertex(genus).unwrap()));
    }
    for tau in [[0.0, 1.0], [0.5, 0.1], [3.7, 0.01]] {
        surfaces.push((format!("torus {tau:?}"), shapes::flat_torus(tau, 1, 1).unwrap()));
        surfaces.push((format!("torus of 6 {tau:?}"), shapes::flat_torus(tau, 3, 2).unwrap()));
    }
    for (name, intrinsic) in surfaces {
        let surface = intrinsic.build().unwrap();
        let mut random = Random::new(8);
        for (space, _) in [Space::E2, Space::H2].into_iter().zip(0..if surface.0.euler() < 0 { 2 } else { 1 })
        {
            let n = surface.0.n_vertices();
            let mean = 2.0 * PI * surface.0.euler() as f64 / n as f64;
            let mut target = PerVertex::filled(n, if space == Space::E2 { mean } else { 0.0 });
            for round in 0..3 {
                for scheme in SCHEMES {
                    let what = format!("{name}, target {round}");
                    flow(&surface, intrinsic.geometry, (space, scheme), &target, &what).unwrap();
                }
                // The next target: some curvature goes from one vertex to another.
                let (from, to) = (random.below(n), random.below(n));
                let most = (1.95 * PI - target[to.into()]).min(3.0);
                let moved = random.unit() * most;
                target[from.into()] -= moved;
                target[to.into()] += moved;
            }
        }
    }
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    let sphere = surface(&shapes::icosphere(2).unwrap());
    let at = |v: usize, k: f64| balanced(&sphere.0, &[(v.into(), k)]);
    let check = |target: &PerVertex<f64>, space| check_admissible(&sphere.0, Class::yamabe(space), target);
    assert!(matches!(check(&at(3, 2.0 * PI), Space::E2), Err(Error::TargetAtVertex { vertex: 3, .. })));
    let mut over = at(3, 1.0);
    over[5usize.into()] += 1e-3;
    assert!(matches!(check(&over, Space::E2), Err(Error::TargetTotal { .. })));
    assert!(matches!(check(&at(3, 1.0), Space::H2), Err(Error::TargetTotal { .. })));
    // A flow refuses them with the same errors, and keeps its state.
    let mut nan = at(3, 1.0);
    nan[7usize.into()] = f64::NAN;
    let small: PerVertex<f64> = at(3, 1.0).iter().map(|k| k - 0.01).collect::<Vec<_>>().into();
    for scheme in SCHEMES {
        let refused = |space, target: &PerVertex<f64>| {
            let mut flow = started(&sphere, (space, scheme), &Options::default());
            let before = (flow.mesh().clone(), flow.metric().clone());
            let error = flow.solve(&Target::All(target.clone()), &Control::new()).unwrap_err();
            println!("inadmissible, {space} {scheme}: {error}");
            assert!(before == (flow.mesh().clone(), flow.metric().clone()));
            assert!(flow.solution().report().is_none());
            error
        };
        let large = at(3, 2.5 * PI);
        assert!(matches!(refused(Space::E2, &large), Error::TargetAtVertex { vertex: 3, .. }));
        assert!(matches!(refused(Space::H2, &large), Error::TargetAtVertex { vertex: 3, .. }));
        assert!(matches!(refused(Space::E2, &over), Error::TargetTotal { .. }));
        assert!(matches!(refused(Space::H2, &small), Error::TargetTotal { .. }));
        assert!(matches!(refused(Space::E2, &nan), Error::Argument { what: "target curvature", .. }));
    }
    // A broken triangle inequality, and lengths that are invalid.
    for (edge, length) in [(0usize, 10.0), (1, f64::NAN), (2, 0.0)] {
        let mut lengths = sphere.1.clone();
        lengths[edge.into()] = length;
        let made = ricci::Surface::intrinsic(sphere.0.clone(), lengths, Space::E2).and_then(|surface| {
            Flow::new(surface, Class::yamabe(Space::E2), &Options::default(), &Control::new())
        });
        let Err(error) = made else { panic!("edge {edge} of length {length} passed") };
        println!("refused: {error}");
    }
}

/// 73 handles behind one loop of a few short edges: after twenty steps the flow finds that it would need too many.
#[test]
fn curvature_that_lengths_cannot_carry_is_refused_soon() {
    let given = ricci::Surface::from_soup(&shapes::punch(&shapes::genus(73, 2).unwrap(), 1).unwrap());
    let class = Class::yamabe(Space::E2);
    let mut flow = Flow::new(given.unwrap(), class, &Options::default(), &Control::new()).unwrap();
    let solution = flow.solve(&Target::Boundary, &Control::new()).unwrap();
    let report = solution.report().unwrap();
    assert!(matches!(report.stop_reason, StopReason::OutOfReach { step } if step > 1e3), "{report:?}");
    assert!(!report.converged() && report.iterations <= 20);
    solution.metric().check_domain(solution.mesh()).unwrap();
}

/// Isometric flips to the plain Delaunay triangulation, and their number.
fn to_delaunay(surface: &mut Triangulated) -> usize {
    intrinsic_delaunay(surface, IntrinsicOptions::default(), &mut |_, _| (), &Control::new()).unwrap()
}

/// The flat torus with periods 1 and k + τ is the one with periods 1 and τ, sheared k times: unwinding it takes k flips.
#[test]
fn sheared_tori_are_unwound() {
    let tau = [0.3, 0.9];
    let mut reduced = [1.0, f64::hypot(tau[0], tau[1]), f64::hypot(1.0 - tau[0], tau[1])];
    reduced.sort_by(f64::total_cmp);
    for k in [10.0f64, 1e3, 5e3] {
        let torus = shapes::flat_torus([k + tau[0], tau[1]], 1, 1).unwrap();
        let (mesh, lengths) = torus.build().unwrap();
        let mut surface = Triangulated { mesh, lengths, geometry: Space::E2 };
        let flips = to_delaunay(&mut surface);
        let mut found = [0, 1, 2].map(|e| surface.lengths[EdgeId(e)]);
        found.sort_by(f64::total_cmp);
        let worst = (0..3).map(|i| (found[i] - reduced[i]).abs()).fold(0.0, f64::max);
        println!("sheared {k:.0} times: {flips} flips, lengths off by {worst:.1e}");
        assert!((flips as f64 - k).abs() <= 2.0, "{k}: {flips}");
        // Two sides of a triangle sheared j times exceed the third by 1/j², which is accurate to j³ ulp, and errors add up over j.
        assert!(worst < 4.0 * f64::EPSILON * k.powf(3.5), "{k}: {worst:e}");
    }
}

/// Angles near π and near 0 opposite one edge: their cosines cancel in f64, and still it is decided whether the edge is Delaunay.
#[test]
fn needles_beside_caps_are_told_from_delaunay_edges() {
    let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let soup = ricci::mesh::io::Soup { positions, faces: vec![[0, 1, 2], [0, 2, 3]], ..Default::default() };
    for (cap, needle, flips) in
        [(1e-7, 1e-6, 1), (1e-6, 1e-7, 0), (1e-6, 2e-6, 1), (1e-4, 2e-4, 1), (2e-4, 1e-4, 0)]
    {
        let (mesh, mut lengths) = surface(&soup);
        let inner = mesh
            .edges()
            .find(|&e| !mesh.is_outside(e.halfedge()) && !mesh.is_outside(e.halfedge().twin()))
            .unwrap();
        let base = 2.0 * f64::cos(0.5 * cap);
        let long = 0.5 * base / f64::sin(0.5 * needle);
        lengths[inner] = base;
        for (h, side) in [(inner.halfedge(), 1.0), (inner.halfedge().twin(), long)] {
            for next in [mesh.next(h), mesh.prev(h)] {
                lengths[next.edge()] = side;
            }
        }
        let made = to_delaunay(&mut Triangulated { mesh, lengths, geometry: Space::E2 });
        assert_eq!(made, flips, "π − {cap:e} and {needle:e}");
    }
}
