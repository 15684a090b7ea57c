//! Surfaces with their forms.

use ricci::geometry::Space;
use ricci::harmonic::{Domain, FormsOptions, HarmonicForms};
use ricci::mesh::io::Soup;
use ricci::mesh::shapes::{self, IntrinsicSurface};
use ricci::{Control, Surface};

pub fn in_space(soup: &Soup) -> Surface {
    Surface::from_soup(soup).unwrap()
}

pub fn intrinsic(shape: &IntrinsicSurface, geometry: Space) -> Surface {
    let (mesh, lengths) = shape.build().unwrap();
    Surface::intrinsic(mesh, lengths, geometry).unwrap()
}

pub fn forms_of(surface: &Surface) -> HarmonicForms {
    let control = Control::new();
    HarmonicForms::new(&Domain::new(surface, &control).unwrap(), &FormsOptions::default(), &control).unwrap()
}

/// Closed surfaces of genus 1 to 5, in space, flat and hyperbolic, with good and bad triangles, down to one vertex.
pub fn closed() -> Vec<(String, Surface)> {
    let mut needles = shapes::genus(2, 6).unwrap();
    shapes::slivers(&mut needles, shapes::Sliver::Needle, 20, 1e-3, 5).unwrap();
    let mut all = vec![
        ("torus".into(), in_space(&shapes::torus(2.0, 1.0, 30, 17).unwrap())),
        (
            "knot".into(),
            in_space(&shapes::TorusKnot { p: 2, q: 3, big: 2.0, small: 0.9 }.torus(0.3, 120, 9).unwrap()),
        ),
        ("flat torus".into(), intrinsic(&shapes::flat_torus([0.3, 1.2], 7, 5).unwrap(), Space::E2)),
        (
            "flat torus of one vertex".into(),
            intrinsic(&shapes::flat_torus([0.2, 0.9], 1, 1).unwrap(), Space::E2),
        ),
        ("Bolza".into(), intrinsic(&shapes::bolza(3).unwrap(), Space::H2)),
        ("two vertices".into(), intrinsic(&shapes::two_vertex(3).unwrap(), Space::H2)),
        ("slivers".into(), in_space(&needles)),
    ];
    all.extend((2..=5).map(|g| (format!("genus {g}"), in_space(&shapes::genus(g, 3).unwrap()))));
    all
}
