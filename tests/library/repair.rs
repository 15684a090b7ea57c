//! Tests of repair: defects that need no guess are mended, the others are named, and every element can be traced back.

use crate::common;
use crate::common::Random;
use ricci::Error;
use ricci::control::Control;
use ricci::mesh::check::{Defect, diagnose};
use ricci::mesh::io::{self, Attributes, Soup};
use ricci::mesh::repair::{Repair, RepairSteps, Repaired, repair};
use ricci::mesh::{Mesh, shapes};

fn mend(soup: &Soup) -> Repaired {
    check(soup, &Repair::default())
}

/// Repairs a soup, and checks what every repair must satisfy.
fn check(soup: &Soup, options: &Repair) -> Repaired {
    let done = repair(soup, options, &Control::new()).unwrap();
    let mut left = diagnose(&done.soup.positions, &done.soup.faces);
    if let Some(Defect::Empty { collapsed }) = left.defects.first_mut() {
        *collapsed = done.steps.degenerate_faces;
    }
    // Seams that the repair cut open itself are none to it.
    let mut found = done.diagnosis.clone();
    if done.steps.split_vertices > 0 {
        for diagnosis in [&mut found, &mut left] {
            diagnosis.hints.clear();
            for defect in &mut diagnosis.defects {
                if let Defect::SeveralComponents { torn, .. } = defect {
                    *torn = false;
                }
            }
        }
    }
    assert_eq!(found, left);
    assert_eq!(done.vertex_origin.len(), done.soup.positions.len());
    assert_eq!(done.face_origin.len(), done.soup.faces.len());
    assert!(done.face_origin.is_sorted_by(|a, b| a < b));
    for (v, &origin) in done.vertex_origin.iter().enumerate() {
        assert_eq!(done.soup.positions[v], soup.positions[origin as usize]);
    }
    // Each face has the corners of its origin, up to its direction and to welding.
    for (face, &origin) in done.soup.faces.iter().zip(&done.face_origin) {
        let place = |v: u32| soup.positions[v as usize].map(|x| (x + 0.0).to_bits()); // −0 is 0
        let mut here = face.map(|v| place(done.vertex_origin[v as usize]));
        let mut there = soup.faces[origin as usize].map(place);
        here.sort_unstable();
        there.sort_unstable();
        assert!(here == there || options.weld.is_some_and(|w| w > 0.0));
    }
    for refused in &done.weld_refused {
        // Each face has corners at both positions.
        let place = |v: u32| soup.positions[v as usize].map(|x| x + 0.0);
        let at = |f: u32, end: u32| soup.faces[f as usize].iter().any(|&v| place(v) == place(end));
        assert!(refused.faces.len() > 2);
        assert!(refused.faces.iter().all(|&f| refused.vertices.iter().all(|&v| at(f, v))));
    }
    // A repaired soup stays as it is. (Welding is not repeated: faces that were dropped may allow more of it.)
    let again =
        repair(&done.soup, &Repair { weld: None, component: None, ..options.clone() }, &Control::new())
            .unwrap();
    assert_eq!(again.steps, RepairSteps::default());
    assert!(again.soup.positions == done.soup.positions && again.soup.faces == done.soup.faces);
    done
}

/// Every face with corners of its own.
fn torn(whole: &Soup) -> Soup {
    let corners = whole.faces.as_flattened();
    let positions = corners.iter().map(|&v| whole.positions[v as usize]).collect();
    Soup::new(positions, (0..whole.faces.len() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect())
}

/// A cube's surface with a corner at `at`, two triangles to a side.
fn cube(at: [f64; 3]) -> Soup {
    let bit = |v: u32, k: u32| f64::from(v >> k & 1);
    let positions = (0..8).map(|v| [at[0] + bit(v, 0), at[1] + bit(v, 1), at[2] + bit(v, 2)]).collect();
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Soup::new(positions, sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
}

fn beside(soups: &[Soup]) -> Soup {
    let mut all = Soup::default();
    for soup in soups {
        let n = all.positions.len() as u32;
        all.positions.extend(&soup.positions);
        all.faces.extend(soup.faces.iter().map(|f| f.map(|v| v + n)));
    }
    all
}

/// Euler characteristic, boundary loops and number of the components, and the codes of the defects.
fn shape(done: &Repaired) -> (i64, usize, usize, Vec<&'static str>) {
    let d = &done.diagnosis;
    (d.euler, d.boundary_loops, d.components, d.counts().into_iter().map(|(code, _)| code).collect())
}

#[test]
fn a_fin_in_a_torn_surface_stays_apart_and_is_reported() {
    let mut finned = cube([0.0; 3]);
    finned.positions.push([0.5, -1.0, -1.0]);
    finned.faces.push([0, 1, 8]);
    let loose = torn(&finned);
    for cut in [false, true] {
        let options = Repair { cut_non_manifold_edges: cut, ..Repair::default() };
        // The cube is closed; the fin is a triangle of its own.
        let done = check(&loose, &options);
        assert_eq!(shape(&done), (3, 1, 2, vec!["several_components"]));
        assert_eq!(done.weld_refused.len(), 1);
        assert_eq!(done.weld_refused[0].faces, [1, 4, 12]);
        let again = check(&done.soup, &options);
        assert!(again.soup == done.soup && again.weld_refused.len() == 1);
        assert_eq!(done.steps.welded_vertices, 36 + 3 - 8 - 3);
        let largest = check(&loose, &Repair { component: Some(0), ..options.clone() });
        assert_eq!(
            (shape(&largest).0, largest.soup.faces.len(), largest.diagnosis.defects.len()),
            (2, 12, 0)
        );
        // The same beside a sound surface, and with another fin.
        let two =
            beside(&[loose.clone(), torn(&cube([5.0, 0.0, 0.0])), torn(&shapes::icosphere(2).unwrap())]);
        assert_eq!(shape(&check(&two, &options)), (7, 1, 4, vec!["several_components"]));
    }
    // With a distance all of it is joined.
    let joined = check(&loose, &Repair { weld: Some(1e-9), ..Repair::default() });
    assert_eq!(shape(&joined).3, ["non_manifold_edge", "non_manifold_vertex", "inconsistent_orientation"]);
    let cut = Repair { weld: Some(1e-9), cut_non_manifold_edges: true, ..Repair::default() };
    assert_eq!(shape(&check(&loose, &cut)), (3, 1, 2, vec!["several_components"]));
    // Three pages of a book that were never joined: nothing tells which two belong together.
    let back = |k: f64| [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [k.cos(), k.sin(), 0.0]];
    let pages = beside(&[0.0, 2.0, 4.0].map(|k| Soup::new(back(k).to_vec(), vec![[0, 1, 2]])));
    let done = check(&pages, &Repair::default());
    assert_eq!((done.soup.faces.len(), done.steps, done.weld_refused.len()), (3, RepairSteps::default(), 1));
}

#[test]
fn closed_surfaces_that_touch_stay_what_they_are() {
    // In a point, along an edge, in a square of two triangles, and twice at once.
    for (at, refused) in [([1.0; 3], 0), ([1.0, 1.0, 0.0], 1), ([1.0, 0.0, 0.0], 4)] {
        let both = beside(&[cube([0.0; 3]), cube(at)]);
        let done = check(&both, &Repair::default());
        assert_eq!(shape(&done), (4, 0, 2, vec!["several_components"]));
        assert!(done.soup.faces == both.faces && done.steps == RepairSteps::default(), "{:?}", done.steps);
        assert_eq!(done.weld_refused.len(), refused);
    }
    // As loose triangles: a common point does not matter; along an edge the neighbours determine which faces belong together.
    for at in [[1.0; 3], [1.0, 1.0, 0.0]] {
        let loose = beside(&[torn(&cube([0.0; 3])), torn(&cube(at))]);
        assert_eq!(shape(&check(&loose, &Repair::default())), (4, 0, 2, vec!["several_components"]));
    }
    // A sheet given twice is one.
    let disk = shapes::disk(3).unwrap();
    let mut twice = beside(&[disk.clone(), disk.clone()]);
    twice.faces[disk.faces.len()..].iter_mut().for_each(|f| f.swap(0, 1));
    let done = check(&twice, &Repair::default());
    assert_eq!((done.steps.duplicate_faces, done.soup.faces), (disk.faces.len(), disk.faces));
}

#[test]
fn welding_makes_no_edge_of_more_than_two_faces() {
    // Random surfaces on few positions, partly torn, in which every kind of contact occurs.
    let mut random = Random::new(17);
    let mut below = |n: usize| (random.unit() * n as f64) as u32;
    let mut refused = 0;
    for _ in 0..3000 {
        let places = 3 + below(5);
        let copies = 1 + below(3);
        let positions: Vec<_> = (0..places * copies).map(|v| position_of(v % places)).collect();
        let faces: Vec<[u32; 3]> =
            (0..2 + below(12)).map(|_| [0; 3].map(|_| below((places * copies) as usize))).collect();
        let soup = Soup::new(positions, faces);
        let apart = repair(&soup, &Repair { weld: None, ..Repair::default() }, &Control::new()).unwrap();
        let crowded = |done: &Repaired| {
            done.diagnosis.defects.iter().filter(|d| d.code() == "non_manifold_edge").count()
        };
        let done = check(&soup, &Repair::default());
        assert!(crowded(&done) <= crowded(&apart), "{soup:?}");
        refused += usize::from(!done.weld_refused.is_empty());
        let cut = check(&soup, &Repair { cut_non_manifold_edges: true, ..Repair::default() });
        assert_eq!(crowded(&cut), 0);
    }
    assert!(refused > 300, "{refused}");
}

/// Positions no three of which are collinear.
fn position_of(place: u32) -> [f64; 3] {
    let t = f64::from(place);
    [t, t * t, t * t * t]
}

#[test]
fn a_sound_surface_is_left_alone() {
    for soup in [shapes::genus(2, 2).unwrap(), shapes::disk(3).unwrap(), shapes::icosphere(3).unwrap()] {
        let done = mend(&soup);
        assert_eq!(done.steps, RepairSteps::default());
        assert!(done.soup == soup);
    }
}

#[test]
fn a_shuffled_soup_becomes_the_surface_it_was() {
    let whole = shapes::genus(2, 3).unwrap();
    let mut random = Random::new(31);
    // Every face has corners of its own; some faces are turned, repeated or collapsed, and a few points are unused.
    let mut torn = Soup::default();
    for (f, face) in whole.faces.iter().enumerate() {
        let n = torn.positions.len() as u32;
        torn.positions.extend(face.map(|v| whole.positions[v as usize]));
        torn.faces.push(if random.unit() < 0.3 { [n, n + 2, n + 1] } else { [n, n + 1, n + 2] });
        if f % 50 == 0 {
            torn.faces.extend([[n + 1, n, n + 2], [n, n, n + 1]]);
        }
    }
    torn.positions.extend([[9.0, 0.0, 0.0], [f64::NAN, 0.0, 0.0]]);
    let done = mend(&torn);
    let mesh = Mesh::from_soup(&done.soup).unwrap();
    let expected = Mesh::from_soup(&whole).unwrap();
    assert_eq!(
        (mesh.n_vertices(), mesh.n_edges(), mesh.genus()),
        (expected.n_vertices(), expected.n_edges(), 2)
    );
    let repeated = whole.faces.len().div_ceil(50);
    assert_eq!((done.steps.duplicate_faces, done.steps.degenerate_faces), (repeated, repeated));
    assert_eq!(done.steps.isolated_vertices, 2);
    assert_eq!(done.steps.welded_vertices, 3 * whole.faces.len() - whole.positions.len());
    // The majority decides the orientation.
    let volume = |soup: &Soup| -> f64 {
        let det = |[a, b, c]: [u32; 3]| {
            let [p, q, r] = [a, b, c].map(|v| soup.positions[v as usize]);
            p[0] * (q[1] * r[2] - q[2] * r[1])
                + p[1] * (q[2] * r[0] - q[0] * r[2])
                + p[2] * (q[0] * r[1] - q[1] * r[0])
        };
        soup.faces.iter().map(|&f| det(f)).sum()
    };
    assert!((volume(&done.soup) / volume(&whole) - 1.0).abs() < 1e-12);
}

#[test]
fn welding_within_a_tolerance_joins_chains_and_no_more() {
    // A square as two triangles that miss each other by 1e-4.
    let gap = 1e-4;
    let soup = Soup::new(
        vec![
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, gap, 0.0],
            [1.0, 1.0 + gap, 0.0],
            [0.0, 1.0, 0.0],
        ],
        vec![[0, 1, 2], [3, 4, 5]],
    );
    let with = |weld| check(&soup, &Repair { weld, component: Some(0), ..Repair::default() });
    assert_eq!(with(Some(0.5 * gap)).soup.faces.len(), 1);
    let joined = with(Some(1.5 * gap));
    assert_eq!(
        (joined.soup.positions.len(), joined.soup.faces.len(), joined.steps.welded_vertices),
        (4, 2, 2)
    );
    assert!(joined.diagnosis.defects.is_empty());
    assert_eq!(with(None).soup.faces.len(), 1);
    // Against brute force on a cloud, at every scale of the tolerance.
    let mut random = Random::new(5);
    let cloud: Vec<_> =
        (0..300).map(|_| [random.symmetric(), random.symmetric(), 0.1 * random.symmetric()]).collect();
    let faces: Vec<[u32; 3]> = (0..100).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
    let cloud = Soup::new(cloud, faces);
    for tolerance in [1e-3, 0.03, 0.1, 0.4, 3.0] {
        let mut set: Vec<usize> = (0..300).collect();
        for a in 0..300 {
            for b in 0..a {
                let d = (0..3)
                    .map(|k| (cloud.positions[a][k] - cloud.positions[b][k]).powi(2))
                    .sum::<f64>()
                    .sqrt();
                if d <= tolerance && set[a] != set[b] {
                    let (from, to) = (set[a].max(set[b]), set[a].min(set[b]));
                    set.iter_mut().filter(|s| **s == from).for_each(|s| *s = to);
                }
            }
        }
        let expected = (0..300).filter(|&v| set[v] != v).count();
        let done =
            repair(&cloud, &Repair { weld: Some(tolerance), ..Repair::default() }, &Control::new()).unwrap();
        assert_eq!(done.steps.welded_vertices, expected, "{tolerance}");
    }
}

#[test]
fn sheets_that_touch_in_a_point_come_apart_and_keep_their_attributes() {
    // Two disks that share their centre, each corner with a texture coordinate of its own.
    let mut soup = shapes::disk(2).unwrap();
    let n = soup.positions.len() as u32;
    let lifted: Vec<_> = soup.positions[1..].iter().map(|p| [p[0], p[1], p[0] * p[0] + 1.0]).collect();
    let second: Vec<_> = soup.faces.iter().map(|f| f.map(|v| if v == 0 { 0 } else { v + n - 1 })).collect();
    soup.positions.extend(lifted);
    soup.faces.extend(second.iter().map(|&[a, b, c]| [a, c, b]));
    let (vertices, faces) = (soup.positions.len(), soup.faces.len());
    soup.attributes = Attributes {
        normals: Some(vec![[0.0, 0.0, 1.0]; vertices]),
        colors: Some((0..vertices).map(|v| [v as f64 / vertices as f64, 0.0, 0.0, 1.0]).collect()),
        uv: Some((0..faces).map(|f| [[f as f64, 0.0], [f as f64, 1.0], [f as f64, 2.0]]).collect()),
        ..Attributes::default()
    };
    let done = mend(&soup);
    assert_eq!((done.steps.split_vertices, done.soup.positions.len()), (1, vertices + 1));
    assert_eq!(done.diagnosis.components, 2);
    let codes: Vec<_> = done.diagnosis.counts().into_iter().map(|(code, _)| code).collect();
    assert_eq!(codes, ["several_components"]);
    let second = check(&soup, &Repair { component: Some(1), ..Repair::default() });
    assert!(second.diagnosis.defects.is_empty() && second.soup.faces.len() == faces / 2);
    assert_eq!(second.steps.faces_of_other_components, faces / 2);
    for done in [done, second] {
        let colors = done.soup.attributes.colors.unwrap();
        for (color, &origin) in colors.iter().zip(&done.vertex_origin) {
            assert_eq!(color[0], f64::from(origin) / vertices as f64);
        }
        let uv = done.soup.attributes.uv.unwrap();
        for ((face, uv), &origin) in done.soup.faces.iter().zip(uv).zip(&done.face_origin) {
            for (k, &v) in face.iter().enumerate() {
                let corner =
                    soup.faces[origin as usize].iter().position(|&w| w == done.vertex_origin[v as usize]);
                assert_eq!(uv[k], [f64::from(origin), corner.unwrap() as f64]);
            }
        }
    }
}

#[test]
fn non_manifold_edges_are_cut_on_request_only() {
    // Three pages of a book.
    let positions =
        vec![[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [-1.0, 0.1, 0.0], [0.0, 1.0, 0.0]];
    let book = Soup::new(positions, vec![[0, 1, 2], [0, 1, 3], [0, 1, 4]]);
    let left = mend(&book);
    assert_eq!(left.soup, book);
    assert!(left.diagnosis.counts().iter().any(|&(code, n)| (code, n) == ("non_manifold_edge", 1)));
    let cut = check(&book, &Repair { cut_non_manifold_edges: true, ..Repair::default() });
    assert_eq!((cut.steps.cut_edges, cut.steps.split_vertices, cut.diagnosis.components), (1, 4, 3));
    // What was cut on request is no open seam.
    assert_eq!(cut.diagnosis.hints, []);
    let first =
        check(&book, &Repair { cut_non_manifold_edges: true, component: Some(0), ..Repair::default() });
    assert_eq!((first.torn, first.diagnosis.hints), (Vec::new(), Vec::new()));
}

#[test]
fn what_needs_a_guess_is_left_and_garbage_is_refused() {
    let moebius: Vec<[u32; 3]> = (0..5).map(|i| [i, (i + 1) % 5, (i + 2) % 5]).collect();
    let points = (0..5).map(|i| [f64::from(i).cos(), f64::from(i).sin(), 0.1 * f64::from(i * i)]).collect();
    let band = Soup::new(points, moebius);
    let done = mend(&band);
    assert_eq!(done.soup, band);
    assert!(done.diagnosis.counts().iter().any(|&(code, _)| code == "non_orientable"));
    let mut garbage = shapes::icosphere(1).unwrap();
    garbage.faces[7][1] = 99;
    garbage.positions[3][0] = f64::INFINITY;
    garbage.positions.push([f64::NAN; 3]);
    let Err(Error::Defects(diagnosis)) = repair(&garbage, &Repair::default(), &Control::new()) else {
        panic!()
    };
    assert_eq!(diagnosis.counts(), [("index_out_of_range", 1), ("non_finite_coordinate", 1)]);
    let sound = shapes::icosphere(1).unwrap();
    for options in [
        Repair { weld: Some(-1.0), ..Repair::default() },
        Repair { weld: Some(f64::NAN), ..Repair::default() },
        Repair { component: Some(1), ..Repair::default() },
    ] {
        assert!(matches!(repair(&sound, &options, &Control::new()), Err(Error::Argument { .. })));
    }
}

#[test]
fn every_bad_mesh_is_repaired_or_says_what_is_left() {
    let Some((folder, rows)) = common::index("bad") else { return };
    let mut sound = 0;
    for row in &rows {
        let Ok(soup) = io::read(&folder.join(&row["file"])) else { continue };
        let whole = Repair { cut_non_manifold_edges: true, component: Some(0), ..Repair::default() };
        let options = if soup.faces.is_empty() { Repair::default() } else { whole };
        let done = check(&soup, &options);
        // Only defects that no option mends are left.
        let left: Vec<_> = done.diagnosis.counts().into_iter().map(|(code, _)| code).collect();
        let hopeless = ["empty", "zero_area_face", "non_orientable"];
        assert!(left.iter().all(|code| hopeless.contains(code)), "{}: {left:?}", row["file"]);
        sound += usize::from(left.is_empty());
    }
    assert!(sound >= 60, "{sound}");
}
