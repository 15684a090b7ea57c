//! Tests of findings that are no defects: open seams, T-junctions, coarse coordinates; and of boundary loops, sharp edges and corners.

use ricci::control::Control;
use ricci::mesh::check::{Features, Hint, OpenSeam, diagnose, hints};
use ricci::mesh::io::Soup;
use ricci::mesh::repair::{Repair, repair};
use ricci::mesh::rims::rims;
use ricci::mesh::{Mesh, shapes};
use std::f64::consts::{FRAC_PI_2, TAU};

/// A cylinder of n × m squares cut open along a line, whose two sides are `gap` apart.
fn cut_cylinder(n: u32, m: u32, gap: f64) -> Soup {
    let at = |i: u32, j: u32| {
        let angle = TAU * f64::from(i % n) / f64::from(n);
        [angle.cos(), angle.sin() + if i == n { gap } else { 0.0 }, f64::from(j) / f64::from(m)]
    };
    let positions = (0..=n).flat_map(|i| (0..=m).map(move |j| at(i, j))).collect();
    let v = |i, j| i * (m + 1) + j;
    let squares = (0..n).flat_map(|i| (0..m).map(move |j| (i, j)));
    let faces = squares.flat_map(|(i, j)| {
        [[v(i, j), v(i + 1, j), v(i + 1, j + 1)], [v(i, j), v(i + 1, j + 1), v(i, j + 1)]]
    });
    Soup::new(positions, faces.collect())
}

fn seam(soup: &Soup) -> Option<OpenSeam> {
    hints(&soup.positions, &soup.faces).into_iter().find_map(|hint| match hint {
        Hint::OpenSeam(seam) => Some(seam),
        _ => None,
    })
}

#[test]
fn the_smallest_weld_that_closes_a_seam_is_found() {
    for gap in [0.0, 2.3e-16, 1e-12, 1.7e-9, 2.4e-7] {
        let soup = cut_cylinder(24, 9, gap);
        let found = seam(&soup).unwrap();
        assert_eq!((found.vertices, found.boundary_edges, found.components), (20, [66, 48], [1, 1]));
        assert!(found.weld >= found.gap && found.weld <= 1.1 * found.gap, "{found:?}");
        assert_eq!(found.lost_faces, 0);
        let done =
            repair(&soup, &Repair { weld: Some(found.weld), ..Repair::default() }, &Control::new()).unwrap();
        assert_eq!((done.diagnosis.boundary_loops, done.diagnosis.euler), (2, 0));
        assert!(done.diagnosis.hints.is_empty(), "{:?}", done.diagnosis.hints);
        // No smaller distance of two digits does it.
        if found.gap > 0.0 {
            let less =
                repair(&soup, &Repair { weld: Some(0.9 * found.gap), ..Repair::default() }, &Control::new())
                    .unwrap();
            assert_eq!(less.diagnosis.boundary_loops, 1);
        }
    }
    // A slit that people see is none of these, nor is a closed surface or a sheet.
    for soup in [cut_cylinder(24, 9, 1e-3), shapes::icosphere(3).unwrap(), shapes::disk(4).unwrap()] {
        assert_eq!(hints(&soup.positions, &soup.faces), []);
    }
}

#[test]
fn torn_pieces_are_welded_before_one_is_taken() {
    // Every face with corners of its own, each moved by a rounding.
    let whole = shapes::icosphere(6).unwrap();
    let corners = whole.faces.as_flattened();
    let moved =
        |(k, &v): (usize, &u32)| whole.positions[v as usize].map(|x| x + 1e-9 * ((k % 7) as f64 - 3.0));
    let positions = corners.iter().enumerate().map(moved).collect();
    let torn =
        Soup::new(positions, (0..whole.faces.len() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect());
    let diagnosis = diagnose(&torn.positions, &torn.faces);
    let found = seam(&torn).unwrap();
    assert_eq!((found.boundary_edges[1], found.components), (0, [whole.faces.len(), 1]));
    let told = diagnosis.to_string();
    let (weld, components) =
        (told.find("ricci repair --weld").unwrap(), told.find("components; their").unwrap());
    assert!(weld < components && told.contains("weld first"), "{told}");
    let closed =
        repair(&torn, &Repair { weld: Some(found.weld), ..Repair::default() }, &Control::new()).unwrap();
    assert_eq!((closed.diagnosis.euler, closed.diagnosis.defects.len()), (2, 0));
}

#[test]
fn t_junctions_are_found_where_steps_differ() {
    // Two sheets over x² with common ends of a seam; the right one has twice as many edges along it.
    let sheet = |x0: f64, columns: u32, rows: u32| -> Soup {
        let at = |i: u32, j: u32| {
            let (x, y) = (x0 + f64::from(i) / f64::from(columns), f64::from(j) / f64::from(rows));
            [x, y, 0.02 * y * y]
        };
        let v = |i, j| i * (rows + 1) + j;
        let positions = (0..=columns).flat_map(|i| (0..=rows).map(move |j| at(i, j))).collect();
        let squares = (0..columns).flat_map(|i| (0..rows).map(move |j| (i, j)));
        let faces = squares.flat_map(|(i, j)| {
            [[v(i, j), v(i + 1, j), v(i + 1, j + 1)], [v(i, j), v(i + 1, j + 1), v(i, j + 1)]]
        });
        Soup::new(positions, faces.collect())
    };
    let (left, right) = (sheet(0.0, 4, 5), sheet(1.0, 8, 10));
    let n = left.positions.len() as u32;
    let mut both = left.clone();
    both.positions.extend(&right.positions);
    both.faces.extend(right.faces.iter().map(|f| f.map(|v| v + n)));
    let found = hints(&both.positions, &both.faces);
    let [Hint::TJunctions(junctions)] = &found[..] else { panic!("{found:?}") };
    let vertices: Vec<u32> = junctions.iter().map(|t| t.vertex).collect();
    assert_eq!(vertices, [1, 3, 5, 7, 9].map(|j| n + j));
    for (k, t) in (0u32..).zip(junctions) {
        assert_eq!(t.edge, [4 * 6 + k, 4 * 6 + k + 1]);
        assert!((t.share - 0.5).abs() < 0.01 && t.distance < 3e-4, "{t:?}");
    }
    assert_eq!(hints(&left.positions, &left.faces), []);
}

#[test]
fn loops_are_numbered_as_the_mesh_numbers_them() {
    for soup in [cut_cylinder(9, 4, 0.3), shapes::disk(3).unwrap(), shapes::genus(2, 2).unwrap()] {
        let mesh = Mesh::from_soup(&soup).unwrap();
        let loops = rims(&soup.positions, &soup.faces);
        let expected: Vec<(usize, u32)> = mesh
            .boundary_loops()
            .iter()
            .map(|rim| (rim.len(), rim.iter().map(|&h| mesh.origin(h).0).min().unwrap()))
            .collect();
        assert_eq!(loops.iter().map(|rim| (rim.vertices.len(), rim.vertex())).collect::<Vec<_>>(), expected);
        assert!(loops.iter().all(|rim| rim.is_oriented && rim.length > 0.0));
    }
    let closed = repair(&cut_cylinder(24, 3, 0.0), &Repair::default(), &Control::new()).unwrap().soup;
    let circle = 24.0 * 2.0 * (TAU / 48.0).sin();
    let loops = rims(&closed.positions, &closed.faces);
    assert!(loops.len() == 2 && loops.iter().all(|rim| (rim.length - circle).abs() < 1e-12));
}

#[test]
fn sharp_edges_and_corners_of_a_box() {
    let bit = |v: u32, k: u32| f64::from(v >> k & 1);
    let positions: Vec<_> = (0..8).map(|v| [bit(v, 0), bit(v, 1), bit(v, 2)]).collect();
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces: Vec<[u32; 3]> = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let found = Features::new(&positions, &faces, 40f64.to_radians());
    assert_eq!((found.edges.len(), found.corners), (12, (0..8).collect()));
    assert!(found.edges.iter().all(|edge| (edge.angle - FRAC_PI_2).abs() < 1e-15 && edge.length == 1.0));
    assert_eq!(Features::new(&positions, &faces, 91f64.to_radians()), Features::default());
    // Without its lid, the rim is a line with four corners of the boundary.
    let open = Features::new(&positions, &faces[2..], 40f64.to_radians());
    assert_eq!((open.edges.len(), open.corners.len()), (8, 8));
    let ball = shapes::icosphere(4).unwrap();
    assert_eq!(Features::new(&ball.positions, &ball.faces, 0.7), Features::default());
}

#[test]
fn caps_and_needles_are_mended_and_traced_back() {
    // A triangulated square of side 4 in which an edge of a face is divided by a vertex on it (cap), and one edge has length 1e-15 (needle).
    let positions = vec![
        [0.0, 0.0, 0.0],
        [4.0, 0.0, 0.0],
        [4.0, 4.0, 0.0],
        [0.0, 4.0, 0.0],
        [1.0, 1.0, 0.0],
        [2.0, 2.0, 0.0],
        [2.0, 2.0 + 1e-15, 0.0],
    ];
    // Vertex 4 lies on the edge 0–5 of the cap (0, 5, 4).
    let faces = vec![[0, 1, 5], [0, 5, 4], [0, 4, 3], [4, 5, 6], [4, 6, 3], [1, 2, 5], [5, 2, 6], [6, 2, 3]];
    let mut soup = Soup::new(positions, faces);
    let uv = |p: [f64; 3]| [p[0], p[1]];
    let corners = soup.faces.iter().map(|f| f.map(|v| uv(soup.positions[v as usize])));
    soup.attributes.uv = Some(corners.collect());
    let before = repair(&soup, &Repair::default(), &Control::new()).unwrap();
    assert!(before.diagnosis.counts().contains(&("zero_area_face", 3)), "{:?}", before.diagnosis.counts());
    let done = repair(&soup, &Repair { mend_zero_area: true, ..Repair::default() }, &Control::new()).unwrap();
    assert_eq!(
        (done.diagnosis.defects.len(), done.diagnosis.euler, done.diagnosis.boundary_loops),
        (0, 1, 1)
    );
    assert_eq!(
        (done.steps.flipped_edges, done.steps.collapsed_edges, done.steps.isolated_vertices),
        (1, 1, 0)
    );
    assert_eq!(done.face_origin, [0, 0, 2, 4, 5, 7]);
    let area = |soup: &Soup| -> f64 {
        let twice = |f: &[u32; 3]| {
            let [a, b, c] = f.map(|v| soup.positions[v as usize]);
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        assert!(soup.faces.iter().all(|f| twice(f) > 0.0));
        soup.faces.iter().map(|f| 0.5 * twice(f)).sum()
    };
    assert!((area(&done.soup) - 16.0).abs() < 1e-12);
    // Texture coordinates are continued into the divided face.
    for (face, uv) in done.soup.faces.iter().zip(done.soup.attributes.uv.as_ref().unwrap()) {
        for (&v, uv) in face.iter().zip(uv) {
            let p = done.soup.positions[v as usize];
            assert!((p[0] - uv[0]).abs() < 1e-13 && (p[1] - uv[1]).abs() < 1e-13, "{p:?} {uv:?}");
        }
    }
    // At the boundary a cap goes; in a tetrahedron squashed to a square without area nothing can be done.
    let cap = Soup::new(
        vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 1.0, 0.0]],
        vec![[0, 2, 1], [0, 1, 3], [1, 2, 3]],
    );
    let done = repair(&cap, &Repair { mend_zero_area: true, ..Repair::default() }, &Control::new()).unwrap();
    assert_eq!((done.steps.opened_faces, done.soup.faces.len(), done.diagnosis.defects.len()), (1, 2, 0));
    let flat = Soup::new(
        vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 0.0]],
        vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]],
    );
    let done = repair(&flat, &Repair { mend_zero_area: true, ..Repair::default() }, &Control::new()).unwrap();
    assert_eq!(done.diagnosis.counts(), [("zero_area_face", 4)]);
}
