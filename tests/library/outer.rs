//! The target that holds the outer loop and fills holes: what can be unrolled keeps its lengths, everything else is one piece without a seam.

use crate::common::flow::prescribing_target;
use ricci::embed::{Layout, LayoutOptions, LayoutScale};
use ricci::flow::{Flips, Method, Options, flow, prescribed_curvature};
use ricci::geometry::Space;
use ricci::mesh::io::Soup;
use ricci::mesh::{Point, shapes};
use ricci::metric::Scheme;
use ricci::{Class, Control, Error, Flow, Solution, Surface, Target};

/// A grid of n × m squares, each of two triangles, without those that `hole` names, at the points of `place`.
fn grid(n: u32, m: u32, hole: impl Fn(u32, u32) -> bool, place: impl Fn(f64, f64) -> Point) -> Soup {
    let at = |i: u32, j: u32| j * (n + 1) + i;
    let corners = (0..=m).flat_map(|j| (0..=n).map(move |i| (f64::from(i), f64::from(j))));
    let all: Vec<Point> = corners.map(|(x, y)| place(x, y)).collect();
    let squares = (0..m).flat_map(|j| (0..n).map(move |i| (i, j))).filter(|&(i, j)| !hole(i, j));
    let faces: Vec<[u32; 3]> = squares
        .flat_map(|(i, j)| {
            [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
        })
        .collect();
    let mut number = vec![u32::MAX; all.len()];
    let mut positions = Vec::new();
    let faces = faces.iter().map(|f| {
        f.map(|v| {
            if number[v as usize] == u32::MAX {
                number[v as usize] = positions.len() as u32;
                positions.push(all[v as usize]);
            }
            number[v as usize]
        })
    });
    let faces = faces.collect();
    Soup { positions, faces, ..Soup::default() }
}

/// Holes that no square fills: an L, and a rectangle.
fn two_holes(i: u32, j: u32) -> bool {
    let ell = (2..4).contains(&i) && (2..6).contains(&j) || (2..6).contains(&i) && (2..4).contains(&j);
    ell || ((8..11).contains(&i) && (3..5).contains(&j))
}

fn solved(soup: &Soup, class: Class, options: &Options) -> (Surface, Solution) {
    let given = Surface::from_soup(soup).unwrap();
    let end = flow(given.clone(), class, &Target::Outer(None), options, &Control::new()).unwrap();
    (given, end)
}

fn laid_out(solution: &Solution) -> Layout {
    let options = LayoutOptions { scale: LayoutScale::AsSolved, ..LayoutOptions::default() };
    Layout::of_solution(solution, &options, &Control::new()).unwrap()
}

/// Largest relative change of the length of a given edge in a layout on the given faces.
fn stretch(given: &Surface, layout: &Layout) -> f64 {
    let on_input = layout.on_input().unwrap();
    let mesh = given.mesh();
    let of_edge = |h: ricci::mesh::HalfedgeId| {
        let [a, b] = [h, mesh.next(h)].map(|h| on_input.coordinates[on_input.corner_index[h] as usize]);
        ((a[0] - b[0]).hypot(a[1] - b[1]) / given.lengths()[h.edge()] - 1.0).abs()
    };
    mesh.halfedges().filter(|&h| !mesh.is_outside(h)).map(of_edge).fold(0.0, f64::max)
}

fn assert_isometric(name: &str, soup: &Soup) {
    let (given, end) = solved(soup, Class::yamabe(Space::E2), &Options::default());
    let layout = laid_out(&end);
    let stretch = stretch(&given, &layout);
    println!("{name}: lengths change by {stretch:.1e}");
    assert!(end.converged() && end.is_one_piece() && layout.seams.is_empty(), "{name}");
    assert!(layout.flipped.is_empty() && stretch < 1e-12, "{name}: {stretch:e}");
}

#[test]
fn what_unrolls_keeps_its_lengths_holes_or_not() {
    let plate = |x: f64, y: f64| [x, y + 0.01 * x, 0.0];
    assert_isometric("plate", &grid(14, 8, two_holes, plate));
    let tilted = |x: f64, y: f64| [0.36 * x - 0.8 * y, 0.48 * x + 0.6 * y, 0.8 * x];
    assert_isometric("tilted plate", &grid(14, 8, |i, j| two_holes(i, j) || (i, j) == (12, 6), tilted));
    // The hole of a cylinder of which two thirds are there unrolls too.
    let cylinder = |x: f64, y: f64| {
        let angle = 0.3 * x;
        [angle.cos(), angle.sin(), 0.3 * y]
    };
    assert_isometric("cylinder cut open", &grid(14, 8, two_holes, cylinder));
    let cone = |x: f64, y: f64| {
        let (angle, height) = (0.4 * x, 1.0 + 0.2 * y);
        [0.6 * height * angle.cos(), 0.6 * height * angle.sin(), height]
    };
    assert_isometric("cone sector", &grid(12, 7, |_, _| false, cone));
    let scroll = |x: f64, y: f64| {
        let angle = 0.3 * x;
        [(1.0 + 0.1 * angle) * angle.cos(), (1.0 + 0.1 * angle) * angle.sin(), 0.4 * y]
    };
    assert_isometric("scroll", &grid(60, 5, |_, _| false, scroll));
}

#[test]
fn holes_of_a_curved_surface_leave_one_piece_that_meets_itself() {
    let bump = |x: f64, y: f64| [x, y, 3.0 * (-0.05 * ((x - 6.0).powi(2) + (y - 4.0).powi(2))).exp()];
    let tube = |x: f64, y: f64| [(1.0 + 0.1 * y) * (0.4 * x).cos(), (1.0 + 0.1 * y) * (0.4 * x).sin(), y];
    for (name, soup) in [
        ("bump", grid(14, 8, two_holes, bump)),
        ("tube", grid(14, 8, two_holes, tube)),
        ("sphere", shapes::punch(&shapes::icosphere(8).unwrap(), 9).unwrap()),
    ] {
        let (given, end) = solved(&soup, Class::yamabe(Space::E2), &Options::default());
        let layout = laid_out(&end);
        assert!(end.converged() && end.is_one_piece() && layout.seams.is_empty(), "{name}");
        assert!(layout.flipped.is_empty() && layout.consistency() < 1e-9, "{name}: {}", layout.consistency());
        let quality = layout.quality(given.mesh(), given.lengths()).unwrap();
        println!("{name}: dilatation {:.2}, consistency {:.1e}", quality.qc_max, layout.consistency());
        // The outer loop keeps its lengths.
        let longest = longest(&given);
        let factor = end.conformal_factor().unwrap();
        for h in &given.mesh().boundary_loops()[longest] {
            assert!(factor[given.mesh().origin(*h)].abs() < 1e-15, "{name}");
        }
    }
}

/// A rough surface with so many holes.
fn rough(smooth: &Soup, noise: f64, seed: u64, holes: usize) -> Soup {
    let mut soup = shapes::punch(smooth, holes).unwrap();
    shapes::noise(&mut soup, noise, seed).unwrap();
    soup
}

/// The longest boundary loop.
fn longest(given: &Surface) -> usize {
    let around = |rim: &Vec<ricci::mesh::HalfedgeId>| rim.iter().map(|h| given.lengths()[h.edge()]).sum();
    let lengths: Vec<f64> = given.mesh().boundary_loops().iter().map(around).collect();
    (0..lengths.len()).max_by(|&a, &b| lengths[a].total_cmp(&lengths[b])).unwrap()
}

#[test]
fn where_triangles_break_edges_of_loops_are_flipped_and_the_layout_is_still_one_piece() {
    let disk = rough(&shapes::disk(6).unwrap(), 1.0, 2, 1);
    let ball = rough(&shapes::icosphere(4).unwrap(), 0.3, 1, 5);
    // The hub of one hole; four hubs, and flaps on an outer loop.
    for (name, soup, is_open_beyond) in [("disk", disk, false), ("ball", ball, true)] {
        let (given, end) = solved(&soup, Class::yamabe(Space::E2), &Options::default());
        assert!(end.converged() && end.is_one_piece() && end.goes_beyond_given(), "{name}");
        let class = Class::yamabe(Space::E2);
        let refused = prescribed_curvature(&Target::Outer(None), &given, class, &Control::new()).unwrap_err();
        assert!(refused.to_string().contains("bend between vertices"), "{name}: {refused}");
        let (mesh, capped) = (given.mesh(), end.caps().unwrap());
        let n = mesh.n_vertices();
        let open = (n..capped.n_vertices()).filter(|&v| capped.is_boundary_vertex(v.into()));
        assert_eq!(open.count() > 0, is_open_beyond, "{name}");
        let layout = laid_out(&end);
        assert!(layout.seams.is_empty() && layout.flipped.is_empty() && layout.broken.is_empty(), "{name}");
        assert!(layout.consistency() < 1e-12, "{name}: {}", layout.consistency());
        // Flat inside, and around the loops as a polygon turns, with its crossings where edges of the loop bend.
        let curvature = end.curvature().unwrap();
        let inside = mesh.vertices().filter(|&v| !mesh.is_boundary_vertex(v));
        assert!(inside.map(|v| curvature.at[v].abs()).fold(0.0, f64::max) < 1e-9, "{name}");
        let found = end.target().unwrap();
        let on_loops = mesh.vertices().filter(|&v| mesh.is_boundary_vertex(v));
        assert!(on_loops.into_iter().all(|v| found[v] == curvature.at[v]), "{name}");
        let (pieces, points) = (layout.mesh(), &layout.coordinates);
        let area: f64 = pieces
            .faces()
            .map(|f| {
                let [a, b, c] = pieces.face_halfedges(f).map(|h| points[layout.corner_index[h] as usize]);
                0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
            })
            .sum();
        assert!((curvature.area / area - 1.0).abs() < 1e-12, "{name}: {} {area}", curvature.area);
        assert!((layout.area / area - 1.0).abs() < 1e-12, "{name}: {} {area}", layout.area);
        let outer = &mesh.boundary_loops()[longest(&given)];
        let factor = end.conformal_factor().unwrap();
        assert_eq!(factor.len(), n);
        assert!(outer.iter().all(|&h| factor[mesh.origin(h)].abs() < 1e-15), "{name}");
        // The next solve is one on the surface itself.
        let free = Control::new();
        let mut flow = Flow::resume(&end, &Options::default(), &free).unwrap();
        let next = flow.solve(&Target::Boundary, &free).unwrap();
        assert!(!next.is_one_piece() && next.caps().is_none(), "{name}");
        let again = flow.solve(&Target::Outer(None), &free).unwrap();
        assert_eq!(again.metric().u, end.metric().u, "{name}");
        // Where no edge may be flipped, none of a loop is.
        let never = Options { flips: Flips::Never, ..Options::default() };
        let (_, stuck) = solved(&soup, Class::yamabe(Space::E2), &never);
        assert!(!stuck.is_one_piece() && stuck.caps().is_none(), "{name}");
    }
}

#[test]
fn another_loop_can_be_the_outer_one() {
    let soup = grid(14, 8, two_holes, |x, y| [x, y, 0.02 * x * y]);
    let given = Surface::from_soup(&soup).unwrap();
    let free = Control::new();
    let mut scales = Vec::new();
    for outer in 0..3 {
        let target = Target::Outer(Some(outer));
        let end = flow(given.clone(), Class::yamabe(Space::E2), &target, &Options::default(), &free).unwrap();
        assert!(end.converged() && end.is_one_piece());
        let factor = end.conformal_factor().unwrap();
        let rim = &given.mesh().boundary_loops()[outer];
        scales.push(rim.iter().map(|&h| factor[given.mesh().origin(h)].abs()).fold(0.0, f64::max));
    }
    assert_eq!(scales, [0.0; 3]);
    let refused = Target::Outer(Some(3)).check(&given, Class::yamabe(Space::E2)).unwrap_err();
    assert!(refused.to_string().contains("loops 0 to 2"), "{refused}");
}

#[test]
fn a_flow_holds_the_outer_loop_for_one_solve_alone() {
    let given = Surface::from_soup(&grid(
        9,
        9,
        |i, j| (3..5).contains(&i) && (3..6).contains(&j),
        |x, y| [x, y, 0.1 * (x * y).sin()],
    ))
    .unwrap();
    let (class, free) = (Class::yamabe(Space::E2), Control::new());
    let mut flow = Flow::new(given.clone(), class, &Options::default(), &free).unwrap();
    let first = flow.solve(&Target::Outer(None), &free).unwrap();
    let straight = flow.solve(&Target::Boundary, &free).unwrap();
    assert!(first.is_one_piece() && straight.converged() && !straight.is_one_piece());
    let again = flow.solve(&Target::Outer(None), &free).unwrap();
    assert_eq!(first.metric().u, again.metric().u);
    // The curvature that was found leads to the same metric up to its scale.
    let found = prescribed_curvature(&Target::Outer(None), &given, class, &free).unwrap();
    assert_eq!(&found, first.target().unwrap());
    let to_found = flow.solve(&Target::All(found), &free).unwrap();
    let off = to_found.metric().u[0.into()] - first.metric().u[0.into()];
    let n = given.mesh().n_vertices();
    let apart = (0..n).map(|v| (to_found.metric().u[v.into()] - first.metric().u[v.into()] - off).abs());
    assert!(to_found.converged() && apart.fold(0.0, f64::max) < 1e-8);
}

#[test]
fn every_scheme_and_method_closes_the_holes_it_can() {
    let soup =
        grid(9, 9, |i, j| (3..5).contains(&i) && (3..6).contains(&j), |x, y| [x, y, 0.2 * (0.5 * x).sin()]);
    let never = Options { flips: Flips::Never, ..Options::default() };
    for (scheme, options) in [
        (Scheme::Yamabe, never.clone()),
        (Scheme::Inversive, Options::default()),
        (Scheme::Inversive, never),
        (Scheme::Yamabe, Options { method: Method::Gradient, tolerance: 1e-8, ..Options::default() }),
    ] {
        let (_, end) = solved(&soup, Class::new(scheme, Space::E2), &options);
        assert!(end.converged() && end.is_one_piece(), "{scheme}: {:?}", end.report().map(|r| r.stop_reason));
        assert!(laid_out(&end).consistency() < 1e-6);
    }
}

#[test]
fn the_outer_loop_is_refused_where_there_is_none() {
    let free = Control::new();
    let refused = |soup: &Soup, space| {
        let given = Surface::from_soup(soup).unwrap();
        flow(given, Class::yamabe(space), &Target::Outer(None), &Options::default(), &free).unwrap_err()
    };
    let kind = |error: Error| matches!(error, Error::TargetKind { target: "outer", .. });
    assert!(kind(refused(&shapes::icosphere(2).unwrap(), Space::E2)));
    assert!(kind(refused(&shapes::punch(&shapes::torus(2.0, 1.0, 12, 8).unwrap(), 2).unwrap(), Space::E2)));
    assert!(kind(refused(&shapes::disk(3).unwrap(), Space::H2)));
    let disk = Surface::from_soup(&shapes::disk(3).unwrap()).unwrap();
    assert!(kind(Target::Outer(None).values(&disk, Space::E2).unwrap_err()));
    assert_eq!(prescribing_target(&disk, Space::E2), Target::Boundary);
}
