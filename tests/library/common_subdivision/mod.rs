//! Tests the common subdivision of a surface's triangulation before and after a flow.

mod check;
mod flown;
mod intrinsic;
mod normal;
mod small;

use crate::common::flow::{default_target, euclidean, small_meshes};
use check::{check, check_layout};
use flown::{SCHEMES, flow};
use ricci::geometry::Space;
use ricci::mesh::{Double, PerEdge, PerVertex};
use ricci::metric::Scheme;
use ricci::{Class, Target};

/// Largest mesh that tests take, so that they are quick in a debug build too.
const MOST_VERTICES: usize = 3000;

#[test]
fn every_closed_mesh_is_refined_with_its_flat_and_hyperbolic_metrics() {
    for (name, mesh, lengths, positions) in
        small_meshes(MOST_VERTICES).into_iter().filter(|(_, mesh, ..)| mesh.is_closed())
    {
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
                let class = Class::new(scheme, space);
                check_layout(&euclidean(&mesh, &lengths), class, &Target::All(target), &what);
            }
        }
    }
}

#[test]
fn every_open_mesh_is_refined_in_its_half_of_the_double() {
    for (name, half, lengths, positions) in
        small_meshes(MOST_VERTICES).into_iter().filter(|(_, mesh, ..)| !mesh.is_closed())
    {
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
            check_layout(&euclidean(&half, &lengths), class, &Target::Boundary, &name);
        }
    }
}
