//! Atlases, by theorem.
#![allow(clippy::unwrap_used)]

use ricci::mesh::shapes;
use ricci::structure::{AffineSource, Atlas, AtlasOptions, Charts, Structure, atlas};
use ricci::{Control, Surface};

fn made(surface: &Surface, options: &AtlasOptions) -> Atlas {
    atlas(surface, options, &Control::new()).unwrap()
}

#[test]
fn scratch() {
    let soup = |s: ricci::Result<ricci::mesh::io::Soup>| Surface::from_soup(&s.unwrap()).unwrap();
    let all = [
        ("sphere", soup(shapes::ellipsoid([1.0, 2.0, 3.0], 4))),
        ("torus", soup(shapes::torus(2.0, 0.7, 24, 15))),
        ("g2", soup(shapes::genus(2, 4))),
        ("g3", soup(shapes::genus(3, 3))),
        ("disk", soup(shapes::disk(6))),
    ];
    for (name, surface) in &all {
        for structure in Structure::ALL {
            for source in [AffineSource::Flow, AffineSource::Form] {
                for charts in [Charts::Stars, Charts::Patches] {
                    let options = AtlasOptions { structure, charts, source, ..AtlasOptions::default() };
                    match atlas(surface, &options, &Control::new()) {
                        Ok(a) => eprintln!(
                            "{name} {structure} {source:?} {charts:?}: charts {} trans {} miss {:.1e} triples {} cocycle {:.1e} hol {:.1e} sing {} excl {} zeros {:?} curv {:.1e} folded {} faces {}",
                            a.charts.len(),
                            a.transitions.len(),
                            a.transition_residual(),
                            a.cocycles.triples,
                            a.cocycles.residual,
                            a.holonomy.relation_residual,
                            a.singular_vertices.len(),
                            a.excluded.len(),
                            a.zeros.iter().map(|z| z.multiplicity).collect::<Vec<_>>(),
                            a.curvature_error,
                            a.folded.len(),
                            a.mesh.n_faces()
                        ),
                        Err(e) => {
                            if charts == Charts::Stars {
                                eprintln!("{name} {structure} {source:?}: {e}")
                            }
                        }
                    }
                }
            }
        }
    }
}
