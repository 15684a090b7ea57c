//! The files of `--generators` and `--domain`: deck groups and fundamental polygons as JSON.

use super::model_place::ModelPlace;
use super::quotient::{ORIGIN, Uniformized};
use ricci::embed::DirichletDomain;
use ricci::topology::word::Word;
use ricci::topology::{SurfaceGroup, intersection_matrix};
use serde::Serialize;
use std::collections::BTreeMap;

/// A complex 2×2 matrix, entries `[re, im]`.
type MobiusMatrix = [[[f64; 2]; 2]; 2];

/// A deck group.
#[derive(Serialize, Default)]
pub struct GroupFile {
    space: &'static str,
    basis: Vec<String>,
    word: Vec<String>,
    /// Row i, column j: how often loop j of the basis crosses loop i from right to left, less how often from left to right; counted on
    /// the surface.
    intersections: Vec<Vec<i64>>,
    generators: BTreeMap<String, MobiusMatrix>,
    /// The parts of `generators` that floating-point numbers lose: without them far translations do not have a determinant of 1.
    generators_lo: BTreeMap<String, MobiusMatrix>,
    /// The isometries of `generators` as real matrices by rows: homogeneous in SE(2), or in SO⁺(2,1) on the hyperboloid and the Klein disk.
    matrices: BTreeMap<String, [[f64; 3]; 3]>,
}

impl GroupFile {
    /// The group of a surface that is its own universal cover.
    pub fn trivial(space: &'static str) -> GroupFile {
        GroupFile { space, ..GroupFile::default() }
    }

    /// The deck group of a surface.
    ///
    /// # Errors
    /// The errors of [`intersection_matrix`].
    pub fn new(u: &Uniformized) -> ricci::Result<GroupFile> {
        let deck = &u.deck;
        let basis = deck.group.names();
        let named = || basis.iter().cloned().zip(&deck.generators);
        Ok(GroupFile {
            space: deck.space.name(),
            intersections: intersection_matrix(u.layout.mesh(), &u.basis.loops)?,
            word: letters(&deck.group, &deck.group.relator()),
            generators: named().map(|(name, g)| (name, g.mobius())).collect(),
            generators_lo: named().map(|(name, g)| (name, g.mobius_remainder())).collect(),
            matrices: named().map(|(name, g)| (name, g.matrix().map(|row| row.map(f64::from)))).collect(),
            basis,
        })
    }
}

/// A Dirichlet domain, with the canonical polygon.
#[derive(Serialize)]
pub struct DomainFile {
    space: &'static str,
    /// The model of the coordinates of points; matrices act on the plane or the Poincaré disk.
    model: &'static str,
    centre: Vec<f64>,
    area: f64,
    /// Largest distance of a corner from the centre.
    radius: f64,
    /// Counterclockwise; side k runs from corner k to the next one.
    corners: Vec<Vec<f64>>,
    sides: Vec<SideFile>,
    canonical_polygon: PolygonFile,
}

#[derive(Serialize)]
struct SideFile {
    /// The deck transformation that carries the domain to its neighbour across this side.
    word: Vec<String>,
    matrix: MobiusMatrix,
    /// The part of `matrix` that floating-point numbers lose.
    matrix_lo: MobiusMatrix,
    /// The side with the inverse transformation; none on the boundary of the surface, which its word moves along itself.
    partner: Option<usize>,
}

/// The polygon from lift to lift of the base point along the relator.
#[derive(Serialize)]
struct PolygonFile {
    corners: Vec<Vec<f64>>,
    /// Per side the letter of the relator.
    sides: Vec<String>,
}

impl DomainFile {
    pub fn new(u: &Uniformized, domain: &DirichletDomain, at: ModelPlace) -> ricci::Result<DomainFile> {
        let group = &u.deck.group;
        let points = |list: &[[f64; 3]]| list.iter().map(|&p| at.numbers(p)).collect();
        let side = |k: usize| SideFile {
            word: letters(group, &domain.sides[k].word),
            matrix: domain.sides[k].motion.mobius(),
            matrix_lo: domain.sides[k].motion.mobius_remainder(),
            partner: domain.partner[k],
        };
        Ok(DomainFile {
            space: u.deck.space.name(),
            model: at.name(),
            centre: at.numbers(domain.centre),
            area: domain.area,
            radius: domain.radius,
            corners: points(&domain.corners),
            sides: (0..domain.sides.len()).map(side).collect(),
            canonical_polygon: PolygonFile {
                corners: points(&u.deck.canonical_polygon(ORIGIN)?),
                sides: letters(group, &group.relator()),
            },
        })
    }
}

/// The letters of a word by name.
pub fn letters(group: &SurfaceGroup, word: &Word) -> Vec<String> {
    if word.is_empty() { Vec::new() } else { group.text(word).split(' ').map(String::from).collect() }
}

/// A word as one name: its letters with dots between them, `1` for the empty word.
pub fn name(group: &SurfaceGroup, word: &Word) -> String {
    group.text(word).replace(' ', ".")
}
