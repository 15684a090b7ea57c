//! Quad meshes and layouts of seamless maps: known T-meshes of square-tiled surfaces, and what every quad mesh and layout has.

use ricci::geometry::Space;
use ricci::mesh::io::Soup;
use ricci::mesh::{Mesh, PerEdge, VertexId, shapes};
use ricci::quads::{QuadLayout, QuadMesh, QuadOptions, QuadSize, quad_layout, quad_mesh};
use ricci::seamless::{ConeValence, Seamless, SeamlessCones, SeamlessOptions, seamless};
use ricci::{Control, Error, Surface};
use std::collections::BTreeMap;

/// Cells along each side of a square of a square-tiled surface.
const CELLS: usize = 4;

/// A surface of unit squares: per square the one to its right and the one above it, glued by translations. Each square is divided into
/// cells, and each cell into two triangles.
fn square_tiled(right: &[usize], up: &[usize]) -> Surface {
    let n = right.len();
    // Vertices of cells, of which those that are glued are found by following the gluing.
    let of = |s: usize, i: usize, j: usize| (s * (CELLS + 1) + j) * (CELLS + 1) + i;
    let mut same: Vec<usize> = (0..n * (CELLS + 1) * (CELLS + 1)).collect();
    let mut changed = true;
    while changed {
        changed = false;
        let pairs = (0..n).flat_map(|s| {
            (0..=CELLS).flat_map(move |k| {
                [(of(s, CELLS, k), of(right[s], 0, k)), (of(s, k, CELLS), of(up[s], k, 0))]
            })
        });
        for (a, b) in pairs {
            let least = same[a].min(same[b]);
            changed |= same[a] != least || same[b] != least;
            (same[a], same[b]) = (least, least);
        }
    }
    let mut used: Vec<usize> = same.clone();
    used.sort_unstable();
    used.dedup();
    let vertex = |s, i, j| used.binary_search(&same[of(s, i, j)]).unwrap() as u32;
    let mut faces = Vec::new();
    for s in 0..n {
        for j in 0..CELLS {
            for i in 0..CELLS {
                let [a, b] = [vertex(s, i, j), vertex(s, i + 1, j)];
                let [c, d] = [vertex(s, i + 1, j + 1), vertex(s, i, j + 1)];
                faces.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    let mesh = Mesh::from_faces(used.len(), &faces).unwrap();
    // The first half-edge of each face's pair is straight, the diagonal is longer.
    let mut lengths = PerEdge::filled(mesh.n_edges(), 1.0 / CELLS as f64);
    for f in mesh.faces() {
        let diagonal = if f.index() % 2 == 0 { 2 } else { 0 };
        let e = mesh.face_halfedges(f)[diagonal].edge();
        lengths[e] = 2f64.sqrt() / CELLS as f64;
    }
    Surface::intrinsic(mesh, lengths, Space::E2).unwrap()
}

/// The seamless metric whose cones are where the surface has them already.
fn own_cones(surface: &Surface) -> Seamless {
    let mesh = surface.mesh();
    let valence = |v: VertexId| (mesh.outgoing(v).count() as f64 / 1.5).round() as u32;
    let cones = mesh.vertices().filter(|&v| ![4, 6, 8].contains(&mesh.outgoing(v).count()));
    let cones = cones.map(|vertex| ConeValence { vertex, valence: valence(vertex) }).collect();
    let options = SeamlessOptions { cones: SeamlessCones::Valences(cones), ..SeamlessOptions::default() };
    seamless(surface, &options, &Control::new()).unwrap()
}

fn quads(of: &Seamless, size: QuadSize) -> QuadMesh {
    quad_mesh(of, &QuadOptions { size, ..QuadOptions::default() }, &Control::new()).unwrap()
}

fn layout(of: &Seamless) -> QuadLayout {
    sized_layout(of, QuadSize::Coarse).unwrap()
}

fn sized_layout(of: &Seamless, size: QuadSize) -> ricci::Result<QuadLayout> {
    quad_layout(of, &QuadOptions { size, ..QuadOptions::default() }, &Control::new())
}

#[test]
fn layouts_have_at_most_the_patches_that_are_asked_for() {
    let of = Surface::from_soup(&shapes::genus(2, 6).unwrap()).unwrap();
    let of = seamless(&of, &SeamlessOptions::default(), &Control::new()).unwrap();
    let least = layout(&of).patches.len();
    // Each node but cones has four patches around it: V − χ of them in all, with at least one node per cone.
    assert!(least >= of.cones.len() + 2 && least <= 3 * (of.cones.len() + 2), "{least}");
    let error = sized_layout(&of, QuadSize::AtMost(of.cones.len() + 1)).unwrap_err();
    assert!(error.to_string().contains("the fewest quads"), "{error}");
    let more = sized_layout(&of, QuadSize::AtMost(4 * least)).unwrap();
    check_layout("genus 2, more patches", &of, &more);
    assert!(more.patches.len() > least && more.patches.len() <= 4 * least, "{}", more.patches.len());
}

/// What every layout has: the topology of the surface, arcs that end at nodes and are in two sides of patches, or in one on the boundary,
/// opposite sides of the same length, and quads in every unit.
fn check_layout(name: &str, of: &Seamless, layout: &QuadLayout) {
    let QuadLayout { mesh, parts, nodes, arcs, patches } = layout;
    let euler = nodes.len() as i64 - arcs.len() as i64 + patches.len() as i64;
    assert_eq!(euler, of.solution.given().euler(), "{name}");
    let mut ways = vec![[0, 0]; arcs.len()];
    for patch in patches {
        let length = |side: &[i32]| {
            let lengths = side.iter().map(|a| arcs[a.unsigned_abs() as usize - 1].length);
            lengths.sum::<u32>()
        };
        let lengths = patch.sides.each_ref().map(|side| length(side));
        assert_eq!([lengths[0], lengths[1], lengths[0], lengths[1]], lengths, "{name}");
        assert_eq!(patch.size, [lengths[0], lengths[1]], "{name}");
        assert_eq!(patch.quads.len() as u32, lengths[0] * lengths[1] * parts * parts, "{name}");
        let around: Vec<i32> = patch.sides.iter().flatten().copied().collect();
        for (k, &a) in around.iter().enumerate() {
            ways[a.unsigned_abs() as usize - 1][usize::from(a < 0)] += 1;
            let end =
                |a: i32, last: bool| arcs[a.unsigned_abs() as usize - 1].ends[usize::from((a < 0) != last)];
            assert_eq!(end(a, true), end(around[(k + 1) % around.len()], false), "{name}");
        }
    }
    for (arc, ways) in arcs.iter().zip(ways) {
        assert!(ways == [1, 1] || (arc.is_crease && ways[0] + ways[1] == 1), "{name}: {ways:?}");
        let ends = arc.ends.map(|k| nodes[k as usize].vertex);
        assert_eq!(ends, [arc.vertices[0], arc.vertices[arc.vertices.len() - 1]], "{name}");
        assert_eq!(arc.vertices.len() as u32, arc.length * parts + 1, "{name}");
    }
    let mut valences: Vec<u32> =
        mesh.topology().irregular.iter().map(|&v| mesh.valences()[v as usize]).collect();
    let mut cones: Vec<u32> = of.cones.iter().map(|cone| cone.valence).collect();
    valences.sort_unstable();
    cones.sort_unstable();
    assert_eq!(valences, cones, "{name}");
}

/// What every quad mesh has: the topology of the surface, and no irregular vertex but at cones.
fn check(name: &str, of: &Seamless, mesh: &QuadMesh) {
    let topology = mesh.topology();
    assert_eq!((topology.bad_edges, topology.bad_vertices), (0, 0), "{name}");
    let given = of.solution.given();
    assert_eq!(topology.euler, given.euler(), "{name}");
    let mut cones: Vec<u32> = of.cones.iter().map(|cone| cone.valence).collect();
    let valences = mesh.valences();
    let mut irregular: Vec<u32> = topology.irregular.iter().map(|&v| valences[v as usize]).collect();
    cones.sort_unstable();
    irregular.sort_unstable();
    assert_eq!(irregular, cones, "{name}");
    for (f, weights) in &mesh.places {
        assert!(f.index() < given.n_faces() && weights.iter().all(|w| (0.0..=1.0).contains(w)), "{name}");
    }
}

#[test]
fn a_square_torus_is_one_rectangle() {
    let torus = square_tiled(&[0], &[0]);
    let of = own_cones(&torus);
    let mesh = quads(&of, QuadSize::Quads(36));
    check("square torus", &of, &mesh);
    assert_eq!(mesh.t_mesh_size, [1, 2]);
    assert_eq!(mesh.quads.len(), 36);
    let layout = layout(&of);
    check_layout("square torus", &of, &layout);
    assert_eq!((layout.nodes.len(), layout.arcs.len(), layout.patches.len()), (1, 2, 1));
}

#[test]
fn a_square_tiled_surface_of_genus_2_is_its_squares() {
    // Three squares in the form of an L: one cone of 6π.
    let surface = square_tiled(&[1, 0, 2], &[2, 1, 0]);
    assert_eq!(surface.mesh().genus(), 2);
    let of = own_cones(&surface);
    assert_eq!(of.cones.len(), 1);
    let mesh = quads(&of, QuadSize::Quads(3 * 16));
    check("genus 2", &of, &mesh);
    assert_eq!(mesh.t_mesh_size, [3, 6]);
    assert_eq!(mesh.quads.len(), 3 * 16);
    let layout = layout(&of);
    check_layout("genus 2", &of, &layout);
    assert_eq!((layout.nodes.len(), layout.arcs.len(), layout.patches.len()), (1, 6, 3));
}

/// The surface of a cube, each side divided into n × n cells.
fn cube(n: i32) -> Surface {
    let mut number: BTreeMap<[i32; 3], u32> = BTreeMap::new();
    let mut faces = Vec::new();
    for axis in 0..3 {
        for (side, at) in [(0, 0), (1, n)] {
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let mut corner = |i: i32, j: i32| {
                    let mut place = [at; 3];
                    (place[(axis + 1) % 3], place[(axis + 2) % 3]) = (i, j);
                    let next = number.len() as u32;
                    *number.entry(place).or_insert(next)
                };
                let [a, b] = [corner(i, j), corner(i + 1, j)];
                let [c, d] = [corner(i + 1, j + 1), corner(i, j + 1)];
                let [b, d] = if side == 1 { [b, d] } else { [d, b] };
                faces.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    let mut positions = vec![[0.0; 3]; number.len()];
    number.iter().for_each(|(place, &v)| positions[v as usize] = place.map(|x| f64::from(x) / f64::from(n)));
    Surface::from_soup(&Soup::new(positions, faces)).unwrap()
}

#[test]
fn a_cube_with_its_corners_as_cones_is_its_sides() {
    let surface = cube(5);
    let positions = surface.positions().unwrap();
    let is_corner = |v: &VertexId| positions[v.index()].iter().all(|x| *x == 0.0 || *x == 1.0);
    let cones = surface.mesh().vertices().filter(is_corner);
    let cones = cones.map(|vertex| ConeValence { vertex, valence: 3 }).collect();
    let options = SeamlessOptions { cones: SeamlessCones::Valences(cones), ..SeamlessOptions::default() };
    let of = seamless(&surface, &options, &Control::new()).unwrap();
    let mesh = quads(&of, QuadSize::Quads(6 * 16));
    check("cube", &of, &mesh);
    assert_eq!(mesh.t_mesh_size, [6, 12]);
    assert_eq!(mesh.quads.len(), 6 * 16);
    let shape = mesh.shape(&mesh.positions(&of.solution).unwrap());
    assert!(shape.angle_max < 1e-7 && (shape.edge_mean - 0.25).abs() < 1e-7, "{shape:?}");
    let layout = layout(&of);
    check_layout("cube", &of, &layout);
    assert_eq!((layout.nodes.len(), layout.arcs.len(), layout.patches.len()), (8, 12, 6));
}

#[test]
fn quad_meshes_are_regular_off_cones() {
    for (name, soup, cones) in [
        ("torus", shapes::torus(2.0, 1.0, 20, 12).unwrap(), SeamlessCones::Valences(Vec::new())),
        ("torus with cones", shapes::torus(2.0, 1.0, 20, 12).unwrap(), SeamlessCones::Auto(4)),
        ("genus 2", shapes::genus(2, 6).unwrap(), SeamlessCones::Field),
        ("ellipsoid", shapes::ellipsoid([1.6, 1.0, 0.7], 8).unwrap(), SeamlessCones::Field),
        ("disk", shapes::disk(6).unwrap(), SeamlessCones::Field),
        ("annulus", shapes::annulus(0.4, 1.0, 6, 30).unwrap(), SeamlessCones::Field),
    ] {
        let surface = Surface::from_soup(&soup).unwrap();
        let options = SeamlessOptions { cones, ..SeamlessOptions::default() };
        let of = seamless(&surface, &options, &Control::new()).unwrap();
        assert!(of.converged(), "{name}: {:e}", of.error);
        check_layout(name, &of, &layout(&of));
        for n in [300, 2000] {
            let mesh = quads(&of, QuadSize::Quads(n));
            check(name, &of, &mesh);
            assert!(mesh.quads.len() as f64 > 0.8 * n as f64, "{name}: {} of {n}", mesh.quads.len());
            assert!(mesh.positions(&of.solution).unwrap().iter().flatten().all(|x| x.is_finite()));
        }
    }
}

#[test]
fn the_edge_length_is_the_one_that_was_asked_for() {
    let surface = Surface::from_soup(&shapes::torus(2.0, 1.0, 40, 24).unwrap()).unwrap();
    let cones = SeamlessCones::Valences(Vec::new());
    let options = SeamlessOptions { cones, ..SeamlessOptions::default() };
    let of = seamless(&surface, &options, &Control::new()).unwrap();
    let mesh = quads(&of, QuadSize::Edge(0.1));
    let shape = mesh.shape(&mesh.positions(&of.solution).unwrap());
    assert!((shape.edge_mean / 0.1 - 1.0).abs() < 0.1, "{}", shape.edge_mean);
}

#[test]
fn threads_do_not_change_quads() {
    let surface = Surface::from_soup(&shapes::genus(2, 6).unwrap()).unwrap();
    let of = seamless(&surface, &SeamlessOptions::default(), &Control::new()).unwrap();
    let with = |threads| {
        let options = QuadOptions { size: QuadSize::Quads(500), threads };
        quad_mesh(&of, &options, &Control::new()).unwrap()
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn sizes_that_are_none_are_refused() {
    let surface = Surface::from_soup(&shapes::torus(2.0, 1.0, 20, 12).unwrap()).unwrap();
    let of = seamless(&surface, &SeamlessOptions::default(), &Control::new()).unwrap();
    for size in [QuadSize::Edge(0.0), QuadSize::Edge(f64::NAN), QuadSize::Quads(0)] {
        let options = QuadOptions { size, ..QuadOptions::default() };
        let refused = quad_mesh(&of, &options, &Control::new());
        assert!(matches!(refused, Err(Error::Argument { .. })), "{size:?}");
    }
}

/// The angle between the normals of the surface and of the corners of quads is less than a right angle nearly everywhere but at cones, where an angle below 180° of
/// the flat metric can be larger in space; and the quads have the area of the surface: no quad lies over another.
fn check_sheets(name: &str, of: &Seamless, mesh: &QuadMesh, area_error: f64) {
    let positions = mesh.positions(&of.solution).unwrap();
    let (given, on_surface) = (of.solution.given(), of.solution.surface().positions().unwrap());
    let normal = |[a, b, c]: [[f64; 3]; 3]| {
        let [u, v] = [b, c].map(|p| [0, 1, 2].map(|k| p[k] - a[k]));
        [0, 1, 2].map(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3])
    };
    let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
    let (mut area, mut turned, valences) = (0.0, 0, mesh.valences());
    for quad in &mesh.quads {
        for k in 0..4 {
            let corners = [k, (k + 1) % 4, (k + 3) % 4].map(|i| positions[quad[i] as usize]);
            let (f, _) = mesh.places[quad[k] as usize];
            let face = normal(given.face_vertices(f).map(|v| on_surface[v.index()]));
            let corner = normal(corners);
            let is_cone = valences[quad[k] as usize] != 4;
            turned += usize::from(!is_cone && dot(face, corner) <= 0.0);
            area += dot(corner, corner).sqrt() / 4.0;
        }
    }
    // Large quads bend: a corner may stand across the surface without a fold in the flat metric.
    assert!(500 * turned <= 4 * mesh.quads.len(), "{name}: quads turn over at {turned} corners");
    let of_faces = given.faces().map(|f| {
        let n = normal(given.face_vertices(f).map(|v| on_surface[v.index()]));
        dot(n, n).sqrt() / 2.0
    });
    let whole: f64 = of_faces.sum();
    assert!((area / whole - 1.0).abs() < area_error, "{name}: quads have the area {area} of {whole}");
}

#[test]
fn squares_do_not_fold_where_arcs_have_length_0() {
    for (name, soup, cones) in [
        ("torus", shapes::torus(2.0, 1.0, 60, 36).unwrap(), SeamlessCones::Auto(4)),
        ("genus 2", shapes::genus(2, 12).unwrap(), SeamlessCones::Field),
        ("ellipsoid", shapes::ellipsoid([1.6, 1.0, 0.7], 24).unwrap(), SeamlessCones::Field),
    ] {
        let surface = Surface::from_soup(&soup).unwrap();
        let of =
            seamless(&surface, &SeamlessOptions { cones, ..SeamlessOptions::default() }, &Control::new());
        let of = of.unwrap();
        check_sheets(name, &of, &layout(&of).mesh, 0.05);
        check_sheets(name, &of, &quads(&of, QuadSize::Quads(2000)), 0.05);
    }
}
