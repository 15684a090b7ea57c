//! The surfaces of the tests, and their uniformization.

use crate::common::index;
use ricci::Control;
use ricci::canonical::{Quotient, QuotientOptions, uniformize_quotient};
use ricci::geometry::Space;
use ricci::mesh::io::{Soup, read};
use ricci::mesh::shapes::{self, IntrinsicSurface};
use ricci::mesh::{Mesh, PerEdge};
use ricci::metric::lengths_from_positions;

/// Largest mesh of the corpus that tests take, so that they are quick in a debug build too.
const MOST_VERTICES: usize = 6000;

pub struct Surface {
    pub name: String,
    pub mesh: Mesh,
    pub lengths: PerEdge<f64>,
    pub geometry: Space,
}

impl Surface {
    pub fn from_soup(name: &str, soup: &Soup) -> Surface {
        let mesh = Mesh::from_soup(soup).unwrap();
        let lengths = lengths_from_positions(&mesh, &soup.positions).unwrap();
        Surface { name: name.into(), mesh, lengths, geometry: Space::E2 }
    }

    pub fn intrinsic(name: &str, surface: &IntrinsicSurface) -> Surface {
        let (mesh, lengths) = surface.build().unwrap();
        Surface { name: name.into(), mesh, lengths, geometry: surface.geometry }
    }

    /// The surface that flows start from.
    pub fn given(&self) -> ricci::Surface {
        ricci::Surface::intrinsic(self.mesh.clone(), self.lengths.clone(), self.geometry).unwrap()
    }

    pub fn uniformized(&self) -> Quotient {
        self.with(&QuotientOptions::default())
    }

    pub fn with(&self, options: &QuotientOptions) -> Quotient {
        uniformize_quotient(&self.given(), options, &Control::new())
            .unwrap_or_else(|error| panic!("{}: {error}", self.name))
    }
}

/// Tori and surfaces of genus 2 to 5, Δ-complexes of one and two vertices among them.
pub fn generated() -> Vec<Surface> {
    let mut all = vec![
        Surface::from_soup("torus of revolution", &shapes::torus(2.0, 0.7, 24, 15).unwrap()),
        Surface::intrinsic("flat torus", &shapes::flat_torus([0.3, 1.2], 5, 7).unwrap()),
        Surface::intrinsic("flat torus of one vertex", &shapes::flat_torus([0.3, 1.2], 1, 1).unwrap()),
        Surface::intrinsic("Bolza surface", &shapes::bolza(2).unwrap()),
    ];
    all.extend((2..=5).map(|g| Surface::from_soup(&format!("genus {g}"), &shapes::genus(g, 2).unwrap())));
    for g in 1..=4 {
        let one = shapes::one_vertex(g).unwrap();
        all.push(Surface::intrinsic(&format!("one vertex, genus {g}"), &one));
        all.push(Surface::intrinsic(&format!("two vertices, genus {g}"), &shapes::two_vertex(g).unwrap()));
    }
    all
}

/// The smaller closed meshes of genus 1 and more of the corpus.
pub fn corpus() -> Vec<Surface> {
    let Some((folder, rows)) = index("good") else { return Vec::new() };
    let number =
        |row: &std::collections::HashMap<String, String>, key: &str| row[key].parse::<usize>().unwrap();
    let wanted = rows.iter().filter(|row| {
        number(row, "boundary_loops") == 0 && number(row, "genus") >= 1 && number(row, "V") <= MOST_VERTICES
    });
    let load = |row: &std::collections::HashMap<String, String>| {
        Surface::from_soup(&row["name"], &read(&folder.join(&row["file"])).unwrap())
    };
    wanted.map(load).collect()
}
