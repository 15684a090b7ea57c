//! The way back from the final triangulation to the input's: the common refinement.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

mod check;
#[path = "../common/mod.rs"]
mod common;
mod flown;
mod intrinsic;
mod normal;
mod small;

use check::{check, check_layout};
use common::flow::euclidean;
use flown::{SCHEMES, default_target, flow};
use ricci::geometry::Space;
use ricci::mesh::{Double, Mesh, PerEdge, PerVertex, Point, io};
use ricci::metric::{Scheme, lengths_from_positions};
use ricci::{Class, Target};

/// Largest mesh that the optimised tests of a debug build take.
const MOST_VERTICES: usize = 3000;

fn corpus() -> Vec<(String, Mesh, PerEdge<f64>, Vec<Point>)> {
    let Some((folder, rows)) = common::index("good") else { return Vec::new() };
    let mut all = Vec::new();
    for row in &rows {
        if row["V"].parse::<usize>().unwrap() <= MOST_VERTICES {
            let soup = io::read(&folder.join(&row["file"])).unwrap();
            let mesh = Mesh::from_soup(&soup).unwrap();
            let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
            all.push((row["file"].clone(), mesh, lengths, soup.positions));
        }
    }
    all
}

#[test]
fn every_closed_mesh_is_refined_with_its_flat_and_hyperbolic_metrics() {
    for (name, mesh, lengths, positions) in corpus().into_iter().filter(|(_, mesh, ..)| mesh.is_closed()) {
        let kinds = SCHEMES.map(|scheme| (Space::E2, scheme));
        let curved = (mesh.genus() >= 2).then_some((Space::H2, Scheme::Yamabe));
        for (space, scheme) in kinds.into_iter().chain(curved) {
            let target = default_target(&mesh, &lengths, space, scheme);
            let what = format!("{name} {space} {scheme}");
            let Some(flown) = flow(&mesh, &lengths, (space, scheme), &target, None) else {
                panic!("{what} does not converge")
            };
            let time = std::time::Instant::now();
            let r = flown.refine(&mesh, None);
            let seconds = time.elapsed().as_secs_f64();
            let worst = check(&r, &mesh, &flown, &positions, &what);
            assert!(
                worst.area < 1e-10 && worst.position < 1e-10 && worst.projective < 1e-10,
                "{what}: {worst:?}"
            );
            println!(
                "{what}: {} flips, V {} → {}, {seconds:.3} s, {worst:?}",
                flown.flips,
                mesh.n_vertices(),
                r.mesh.n_vertices()
            );
            if space == Space::E2 {
                check_layout(&r, (&mesh, &lengths), &flown, &target, &what);
            }
        }
    }
}

#[test]
fn every_open_mesh_is_refined_in_its_half_of_the_double() {
    for (name, half, lengths, positions) in corpus().into_iter().filter(|(_, mesh, ..)| !mesh.is_closed()) {
        let double = Double::new(&half).unwrap();
        let lengths_of_double: PerEdge<f64> = double.spread_edges(&lengths).unwrap().into();
        for scheme in SCHEMES {
            let class = Class::new(scheme, Space::E2);
            let Ok(target) = Target::Boundary.resolve(&euclidean(&half, &lengths), class) else { continue };
            let target: PerVertex<f64> = double.target(&target).unwrap().into();
            let kind = (Space::E2, scheme);
            let Some(flown) = flow(&double.mesh, &lengths_of_double, kind, &target, Some(&double)) else {
                println!("{name} {scheme} does not converge");
                continue;
            };
            let r = flown.refine(&double.mesh, Some(&double));
            let worst = check(&r, &half, &flown, &positions, &name);
            assert!(
                worst.area < 1e-10 && worst.position < 1e-10 && worst.projective < 1e-10,
                "{name}: {worst:?}"
            );
            println!(
                "{name} {scheme}: {} flips, V {} → {}, {worst:?}",
                flown.flips,
                half.n_vertices(),
                r.mesh.n_vertices()
            );
            check_layout(&r, (&half, &lengths), &flown, &target, &name);
        }
    }
}
