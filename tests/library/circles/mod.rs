//! Circle domains: surfaces with boundary whose loops are circles, by theorem.

mod check;
mod known;
mod precision;

use crate::common::{Random, named};
use check::{check, domain, domain_of};
use ricci::canonical::{CircleDomainOptions, circle_domain};
use ricci::flow::Options;
use ricci::geometry::Space;
use ricci::mesh::io::Soup;
use ricci::mesh::shapes;
use ricci::mesh::{EdgeId, FaceId, Mesh};
use ricci::metric::Split;
use ricci::{Control, Error, Surface};

#[test]
fn generated_surfaces_become_round() {
    let torus = shapes::torus(2.0, 1.0, 32, 16).unwrap();
    let shapes = [
        ("hexagon", shapes::disk(1).unwrap()),
        ("disk", shapes::disk(8).unwrap()),
        ("strip of triangles", shapes::annulus(0.5, 1.0, 1, 6).unwrap()),
        ("annulus", shapes::annulus(0.01, 1.0, 12, 9).unwrap()),
        ("sphere with a hole", shapes::punch(&shapes::icosphere(8).unwrap(), 1).unwrap()),
        ("sphere with nine holes", shapes::punch(&shapes::icosphere(12).unwrap(), 9).unwrap()),
        ("torus with three holes", shapes::punch(&torus, 3).unwrap()),
        ("genus 2 with two holes", shapes::punch(&shapes::genus(2, 20).unwrap(), 2).unwrap()),
    ];
    for (name, soup) in shapes {
        check(&domain(&soup), name, 1e-10);
    }
    // Given by lengths alone, in the hyperbolic plane.
    let (mesh, lengths) = shapes::pants([2.0, 1.0, 3.0], 3).unwrap().build().unwrap();
    let pants = Surface::intrinsic(mesh, lengths, Space::H2).unwrap();
    check(&domain_of(&pants), "pair of pants", 1e-11);
}

#[test]
fn meshes_of_the_corpus_become_round() {
    let names = [
        "nefertiti_299",
        "pig_7b",
        "camel_b",
        "flatmesh_5b",
        "eight_hole",
        "elephant_with_holes",
        "b9_mesh",
        "derived_fertility_3disks",
    ];
    let Some(meshes) = named("good", &names) else { return };
    for (name, soup) in meshes {
        check(&domain(&soup), name, 1e-9);
    }
}

/// A sphere without the faces around random places, `n` holes of random sizes that share no vertex.
fn random_holes(n: usize, seed: u64) -> Soup {
    let sphere = shapes::icosphere(40).unwrap();
    let mesh = Mesh::from_soup(&sphere).unwrap();
    let mut random = Random::new(seed);
    let mut taken = vec![false; mesh.n_vertices()];
    let mut gone = vec![false; mesh.n_faces()];
    let mut made = 0;
    while made < n {
        let centre = random.below(mesh.n_vertices());
        let radius = 0.05 + 0.1 * random.unit();
        let p = sphere.positions[centre];
        let near = |v: u32, r: f64| {
            let q = sphere.positions[v as usize];
            (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>() < r * r
        };
        let around: Vec<u32> = (0..mesh.n_vertices() as u32).filter(|&v| near(v, radius + 0.1)).collect();
        if around.iter().any(|&v| taken[v as usize]) {
            continue;
        }
        around.into_iter().for_each(|v| taken[v as usize] = true);
        for f in mesh.faces().filter(|&f: &FaceId| mesh.face_vertices(f).iter().all(|v| near(v.0, radius))) {
            gone[f.index()] = true;
        }
        made += 1;
    }
    let faces: Vec<[u32; 3]> =
        mesh.faces().filter(|f| !gone[f.index()]).map(|f| mesh.face_vertices(f).map(|v| v.0)).collect();
    let mut number = vec![u32::MAX; mesh.n_vertices()];
    let mut soup = Soup::default();
    soup.faces = faces
        .into_iter()
        .map(|f| {
            f.map(|v| {
                if number[v as usize] == u32::MAX {
                    number[v as usize] = soup.positions.len() as u32;
                    soup.positions.push(sphere.positions[v as usize]);
                }
                number[v as usize]
            })
        })
        .collect();
    soup
}

#[test]
fn spheres_with_random_holes_become_round() {
    for (n, seed) in [(3, 1), (10, 2), (30, 3)] {
        let d = domain(&random_holes(n, seed));
        assert_eq!(d.circles.len(), n);
        check(&d, &format!("{n} holes"), 1e-10);
    }
}

#[test]
fn results_are_the_same_for_any_number_of_threads() {
    let surface = Surface::from_soup(&random_holes(6, 9)).unwrap();
    let on = |threads| {
        let flow = Options { threads, ..Options::default() };
        let options = CircleDomainOptions { flow, ..CircleDomainOptions::default() };
        circle_domain(&surface, &options, &Control::new()).unwrap()
    };
    let (one, three) = (on(1), on(3));
    assert!(one.layout == three.layout && one.circles == three.circles);
}

#[test]
fn any_loop_can_be_the_outer_one() {
    let surface = Surface::from_soup(&random_holes(4, 7)).unwrap();
    for k in 0..4 {
        let options = CircleDomainOptions { outer: Some(k), ..CircleDomainOptions::default() };
        let d = circle_domain(&surface, &options, &Control::new()).unwrap();
        check(&d, "chosen loop", 1e-11);
        assert_eq!(d.outer, Some(k));
        assert_eq!((d.circles[k].centre, d.circles[k].radius), ([0.0; 2], 1.0));
    }
}

#[test]
fn what_is_no_circle_domain_is_refused() {
    let refused = |soup: &Soup, options: CircleDomainOptions| {
        let surface = Surface::from_soup(soup).unwrap();
        circle_domain(&surface, &options, &Control::new()).unwrap_err()
    };
    let usual = CircleDomainOptions::default;
    let sphere = shapes::icosphere(2).unwrap();
    assert!(matches!(refused(&sphere, usual()), Error::Argument { what: "surface", .. }));
    let disk = shapes::disk(3).unwrap();
    let outer = CircleDomainOptions { outer: Some(1), ..usual() };
    assert!(matches!(refused(&disk, outer), Error::Argument { what: "outer loop", .. }));
    let torus = shapes::punch(&shapes::torus(2.0, 1.0, 24, 12).unwrap(), 1).unwrap();
    let outer = CircleDomainOptions { outer: Some(0), ..usual() };
    assert!(matches!(refused(&torus, outer), Error::Argument { what: "outer loop", .. }));
    let triangle = Soup {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        faces: vec![[0, 1, 2]],
        ..Soup::default()
    };
    assert!(matches!(refused(&triangle, usual()), Error::Argument { what: "surface", .. }));
    let (control, surface) = (Control::new(), Surface::from_soup(&disk).unwrap());
    control.cancel();
    assert_eq!(circle_domain(&surface, &usual(), &control).unwrap_err(), Error::Cancelled);
}

#[test]
fn halved_edges_leave_the_surface_as_it_is() {
    for geometry in [Space::E2, Space::H2, Space::S2] {
        let disk = Surface::from_soup(&shapes::disk(3).unwrap()).unwrap();
        let mut split = Split::new(&disk.clone().read_in(geometry));
        let mut random = Random::new(3);
        let first = disk.mesh().n_edges();
        for n in first..first + 60 {
            // Each parting makes two more edges at least.
            split.part(EdgeId::from(random.below(n)), 0.2 + 0.6 * random.unit()).unwrap();
        }
        let finer = split.surface().unwrap();
        finer.mesh().validate().unwrap();
        let area = split.given().area().unwrap();
        assert!((finer.area().unwrap() / area - 1.0).abs() < 1e-12, "{geometry}");
        // Positions are those of the places in the given faces.
        let (given, positions) = (disk.positions().unwrap(), finer.positions().unwrap());
        for f in finer.mesh().faces() {
            let (face, corners) = split.place(f);
            let parent = disk.mesh().face_vertices(face).map(|v| given[v.index()]);
            for (v, w) in finer.mesh().face_vertices(f).into_iter().zip(corners) {
                let place = [0, 1, 2].map(|k| (0..3).map(|c| w[c] * parent[c][k]).sum::<f64>());
                assert!((0..3).all(|k| (place[k] - positions[v.index()][k]).abs() < 1e-15));
            }
        }
    }
}
