//! Atlases of generated surfaces, checked by theorems.

mod integer;
mod known;
mod points;

use crate::common;
use ricci::mesh::io::Soup;
use ricci::mesh::shapes::{self, IntrinsicSurface};
use ricci::mesh::{Mesh, PerVertex, VertexId};
use ricci::structure::{AffineSource, Atlas, AtlasOptions, ChartKind, Structure, atlas};
use ricci::{Control, Error, Surface};

/// Tolerance for generated surfaces, all of moderate shape: a few hundred roundings.
const NEAR: f64 = 1e-11;

fn of(soup: ricci::Result<Soup>) -> Surface {
    Surface::from_soup(&soup.unwrap()).unwrap()
}

fn glued(shape: ricci::Result<IntrinsicSurface>) -> Surface {
    let shape = shape.unwrap();
    let (mesh, lengths) = shape.build().unwrap();
    Surface::intrinsic(mesh, lengths, shape.geometry).unwrap()
}

fn options(structure: Structure, charts: ChartKind) -> AtlasOptions {
    AtlasOptions { structure, charts, ..AtlasOptions::default() }
}

fn made(surface: &Surface, options: &AtlasOptions) -> Atlas {
    atlas(surface, options, &Control::new()).unwrap()
}

fn all_options(surface: &Surface) -> Vec<AtlasOptions> {
    let (closed, euler) = (surface.mesh().is_closed(), surface.mesh().euler());
    let fits = |structure: &Structure| match structure {
        Structure::Conformal | Structure::Affine => true,
        Structure::Spherical => closed && euler == 2,
        Structure::Hyperbolic | Structure::Projective => euler < 0,
        // Its triangles are others than those of the surface: see `integer`.
        Structure::Integer => false,
    };
    let mut all = Vec::new();
    for charts in [ChartKind::Stars, ChartKind::Patches] {
        all.extend(Structure::ALL.into_iter().filter(fits).map(|structure| options(structure, charts)));
        if closed && euler <= 0 {
            all.push(AtlasOptions { source: AffineSource::Form, ..options(Structure::Affine, charts) });
        }
    }
    all
}

/// Properties of every atlas: transitions map shared vertices to their images and compose, the holonomy keeps the relation, charts are
/// embedded, and every regular point lies inside a chart.
fn check(name: &str, atlas: &Atlas, within: f64) {
    let errors = [
        atlas.transition_residual(),
        atlas.cocycles.residual,
        atlas.holonomy.relation_residual,
        atlas.curvature_error,
    ];
    assert!(errors.iter().all(|e| *e <= within), "{name}: {errors:?}");
    assert!(atlas.folded.is_empty() && atlas.converged, "{name}: {:?}", atlas.folded);
    let mesh: &Mesh = &atlas.mesh;
    for f in mesh.faces() {
        let is_covered = !atlas.lifts(f).unwrap().is_empty();
        assert_eq!(is_covered, !atlas.excluded.contains(&f), "{name}: face {f}");
    }
    let mut inside = PerVertex::filled(mesh.n_vertices(), false);
    for chart in &atlas.charts {
        let mut count = vec![0; chart.vertices.len()];
        chart.corners.iter().flatten().for_each(|&v| count[v as usize] += 1);
        for (&v, count) in chart.vertices.iter().zip(count) {
            inside[v] |= mesh.outgoing(v).filter(|&h| !mesh.is_outside(h)).count() == count;
        }
    }
    let touches = |v: VertexId| {
        mesh.outgoing(v).any(|h| mesh.face(h).is_some_and(|f| atlas.excluded.binary_search(&f).is_ok()))
    };
    for v in mesh.vertices() {
        let singular = atlas.singular_vertices.contains(&v);
        // Around a cone with less than a full turn a chart may have all faces, open along an edge.
        if singular && atlas.structure == Structure::Integer {
            continue;
        }
        assert_eq!(inside[v], !singular && !touches(v), "{name}: vertex {v}");
    }
}

#[test]
fn every_structure_of_generated_surfaces_closes_up() {
    let all = [
        ("ellipsoid", of(shapes::ellipsoid([1.0, 2.0, 3.0], 3))),
        ("torus", of(shapes::torus(2.0, 0.7, 16, 9))),
        ("genus 2", of(shapes::genus(2, 2))),
        ("genus 4", of(shapes::genus(4, 2))),
        ("disk", of(shapes::disk(5))),
        ("annulus", of(shapes::annulus(0.5, 1.0, 3, 18))),
        ("pants", glued(shapes::pants([0.6, 0.8, 1.0], 3))),
        ("two vertices, genus 2", glued(shapes::two_vertex(2))),
    ];
    for (name, surface) in &all {
        for options in all_options(surface) {
            let name = format!("{name}, {} {:?} {:?}", options.structure, options.source, options.charts);
            let found = made(surface, &options);
            check(&name, &found, NEAR);
            let (closed, euler) = (surface.mesh().is_closed(), surface.mesh().euler());
            let zeros: i64 = found.zeros.iter().map(|zero| zero.multiplicity).sum();
            match (options.structure, options.source) {
                (Structure::Affine, AffineSource::Form) => assert_eq!(zeros, -euler, "{name}"),
                (Structure::Affine, _) if closed && euler != 0 => {
                    assert_eq!(found.singular_vertices.len(), 1, "{name}");
                }
                _ => assert!(found.singular_vertices.is_empty() && found.excluded.is_empty(), "{name}"),
            }
        }
    }
}

/// The star of the one vertex has every face three times: every transition leads from the chart to itself.
#[test]
fn a_surface_of_one_vertex_has_one_star_that_overlaps_itself() {
    let surface = glued(shapes::one_vertex(2));
    let found = made(&surface, &options(Structure::Hyperbolic, ChartKind::Stars));
    check("one vertex", &found, NEAR);
    let chart = &found.charts[0];
    assert_eq!((found.charts.len(), chart.faces.len()), (1, 3 * surface.mesh().n_faces()));
    assert!(found.transitions.iter().all(|t| t.from == 0 && t.to == 0));
    // Its affine structure has no regular vertex that could be the centre of a chart.
    let affine = atlas(&surface, &options(Structure::Affine, ChartKind::Stars), &Control::new()).unwrap();
    assert!(affine.charts.iter().all(|chart| chart.vertices.iter().all(|v| v.0 == 0)));
}

#[test]
fn results_do_not_depend_on_threads() {
    let surface = of(shapes::genus(2, 2));
    for structure in [Structure::Affine, Structure::Projective] {
        for charts in [ChartKind::Stars, ChartKind::Patches] {
            let on = |threads| {
                let mut options = options(structure, charts);
                options.flow.threads = threads;
                made(&surface, &options)
            };
            let [one, four] = [1, 4].map(on);
            assert!(one.charts == four.charts && one.transitions == four.transitions, "{structure}");
        }
    }
}

#[test]
fn meshes_of_the_corpus_have_their_structures() {
    let names = ["spot_low", "bob", "eight_766", "eight_open", "punctured_torus"];
    let Some(meshes) = common::named("good", &names) else { return };
    for (name, soup) in meshes {
        let surface = of(Ok(soup));
        for options in all_options(&surface) {
            if options.charts == ChartKind::Patches && options.structure != Structure::Affine {
                continue;
            }
            let name = format!("{name}, {} {:?} {:?}", options.structure, options.source, options.charts);
            check(&name, &made(&surface, &options), 1e-10);
        }
    }
}

#[test]
fn what_does_not_exist_is_refused_by_name() {
    let [sphere, torus] = [of(shapes::icosphere(2)), of(shapes::torus(2.0, 1.0, 8, 8))];
    let two = of(shapes::genus(2, 1));
    let disk = of(shapes::disk(3));
    let refused = |surface: &Surface, options: &AtlasOptions| match atlas(surface, options, &Control::new()) {
        Err(error @ Error::Argument { .. }) => error.to_string(),
        other => panic!("{:?}", other.map(|atlas| atlas.charts.len())),
    };
    let kind = |structure| options(structure, ChartKind::Stars);
    assert!(refused(&torus, &kind(Structure::Spherical)).contains("genus 0"));
    for structure in [Structure::Hyperbolic, Structure::Projective] {
        for surface in [&sphere, &torus, &disk] {
            assert!(refused(surface, &kind(structure)).contains("negative Euler characteristic"));
        }
    }
    let affine = kind(Structure::Affine);
    let form = AtlasOptions { source: AffineSource::Form, ..affine.clone() };
    assert!(refused(&sphere, &form).contains("genus at least 1"));
    assert!(refused(&two, &AtlasOptions { structure: Structure::Hyperbolic, ..form }).contains("affine"));
    let at = |v| AtlasOptions { singular: Some(VertexId(v)), ..affine.clone() };
    assert!(refused(&two, &at(1_000_000)).contains("singular vertex is 1000000"));
    assert!(refused(&torus, &at(0)).contains("genus other than 1"));
    assert!(refused(&disk, &at(0)).contains("closed surfaces"));
    assert!(refused(&two, &AtlasOptions { radius: Some(0.0), ..affine }).contains("radius"));
    assert!("round".parse::<Structure>().is_err() && "Affine".parse() == Ok(Structure::Affine));
    let cancelled = Control::new();
    cancelled.cancel();
    assert!(matches!(atlas(&two, &kind(Structure::Affine), &cancelled), Err(Error::Cancelled)));
}
