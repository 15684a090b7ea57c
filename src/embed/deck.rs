//! The deck group of a surface of constant curvature: its fundamental group, which acts on the model space by isometries.
//!
//! ```
//! use ricci::canonical::{QuotientOptions, uniformize_quotient};
//! use ricci::{Control, Surface, mesh::shapes};
//! # fn main() -> ricci::Result<()> {
//! let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 8, 8)?)?;
//! let flat = uniformize_quotient(&torus, &QuotientOptions::default(), &Control::new())?;
//! // The deck group of a torus consists of translations that commute.
//! assert_eq!(flat.deck.generators.len(), 2);
//! assert!(flat.deck.relation_residual < 1e-12);
//! # Ok(())
//! # }
//! ```

use super::boundary_lift::BoundaryLift;
use super::cover_walk::CoverWalks;
use super::element::DeckElement;
use super::layout::Layout;
use crate::archive::stored;
use crate::control::Control;
use crate::error::{Error, Result, check_size};
use crate::flow::Solution;
use crate::geometry::modulus::modulus;
use crate::geometry::motion::precise_point;
use crate::geometry::{DoubleDouble, Motion, Space, worse};
use crate::mesh::HalfedgeId;
use crate::topology::word::{Letter, Word};
use crate::topology::{DomainSide, FundamentalDomain, HomotopyBasis, SurfaceGroup};
use std::f64::consts::TAU;

/// Largest residual and error of the relator of loops that are a basis; one of them is enough. A product of other loops is no small motion, but
/// may be small beside the longest of its partial products.
const MOST_RESIDUAL: f64 = 1e-16;
const MOST_RELATION_ERROR: f64 = 1e-3;

/// The group of deck transformations of the universal cover of a layout. It acts from the left: M(γ) carries the base lift to the end of
/// γ's lift, and `M(γδ) = M(γ) M(δ)`.
///
/// Isometries are in double-double precision, so that the rounding of products of far translations is smaller than the errors of the side
/// pairings.
#[derive(Debug, Clone)]
pub struct DeckGroup {
    /// The space on which the group acts.
    pub space: Space,
    /// The abstract group, with the names of its generators and its relator.
    pub group: SurfaceGroup,
    /// The isometries of the canonical generators a1, b1, …, ag, bg, c1, …, cb.
    pub generators: Vec<Motion<DoubleDouble>>,
    /// Per side of the layout's fundamental domain, counterclockwise, the element that carries the domain onto its neighbour there.
    pub sides: Vec<DeckElement>,
    /// The lifts of boundary loops along which the layout's domain meets the boundary of the surface, counterclockwise. If the boundary is
    /// straight, they are lines that bound the universal cover.
    pub borders: Vec<BoundaryLift>,
    /// The corner of the layout that is the base lift, as a half-edge of a face at the base vertex.
    pub corner: HalfedgeId,
    /// `‖R − I‖_F / max_k ‖P_k‖²` for the relator's matrix R and its partial products P_k (Frobenius norms of 2×2 matrices, R with the
    /// nearer sign); 0 without a relation.
    pub relation_residual: f64,
    /// `‖R − I‖_F`: the error of the relation near the base.
    pub relation_error: f64,
    /// The largest difference between the pairing of a side and the isometry of the side's word, relative as `relation_residual` is.
    pub side_residual: f64,
}
stored!(sections DeckGroup { space, group, generators, sides, borders, corner, relation_residual,
    relation_error, side_residual });

impl DeckGroup {
    /// The deck group of a layout without cones of this metric ([`super::LayoutOpening::MetricEdges`]), with the generators of a homotopy basis
    /// of the mesh that is laid out.
    ///
    /// # Errors
    /// [`Error::Layout`], [`Error::Size`] for a metric or basis of another mesh, or where the opened surface is no disk;
    /// [`Error::Cancelled`].
    pub fn new(
        metric: &Solution,
        layout: &Layout,
        basis: &HomotopyBasis,
        control: &Control,
    ) -> Result<DeckGroup> {
        control.check()?;
        let mesh = layout.mesh();
        let corner = mesh.outgoing(basis.base).find(|&h| !mesh.is_outside(h));
        let no_face = || Error::Layout(format!("the base, vertex {}, has no face", basis.base));
        let mut deck = DeckGroup {
            space: layout.space,
            group: basis.group,
            generators: Vec::new(),
            sides: Vec::new(),
            borders: Vec::new(),
            corner: corner.ok_or_else(no_face)?,
            relation_residual: 0.0,
            relation_error: 0.0,
            side_residual: 0.0,
        };
        if deck.group.n_generators() == 0 {
            return Ok(deck);
        }
        let domain = FundamentalDomain::new(mesh, &layout.cut.is_cut, basis)?;
        deck.corner = domain.base_corner;
        let pairing = |side: &DomainSide| match side.halfedges.first() {
            Some(&h) => Ok(layout.neighbour(h).normalised()),
            None => Err(Error::Layout("a side of the fundamental domain has no edges".into())),
        };
        let pairings: Vec<_> = domain.sides.iter().map(pairing).collect::<Result<_>>()?;
        let walks = CoverWalks::new(metric, layout)?;
        let element = |path: &Vec<HalfedgeId>| walks.element(deck.corner, path, control);
        deck.generators = basis.loops.iter().map(element).collect::<Result<_>>()?;
        for (k, (side, motion)) in domain.sides.iter().zip(pairings).enumerate() {
            if side.partner.is_none() {
                let start = side.halfedges.first().copied().unwrap_or(deck.corner);
                let copy = &domain.corners[k].element;
                deck.borders.push(BoundaryLift::new(&walks, basis, copy, start, control)?);
                continue;
            }
            let word = side.element.clone();
            let spelled = deck.motion(&word)?.compose(&motion.inverse());
            deck.side_residual = worse(deck.side_residual, deck.residual(&word, &spelled)?);
            deck.sides.push(DeckElement { word, motion });
        }
        let relator = deck.group.relator();
        let whole = deck.motion(&relator)?;
        deck.relation_error = whole.distance_from_identity().min(f64::MAX);
        deck.relation_residual = deck.residual(&relator, &whole)?;
        Ok(deck)
    }

    /// The deck group with loops of one's own as generators, edge paths on the mesh that is laid out; without sides and borders.
    ///
    /// # Errors
    /// [`Error::Size`] for another number of loops than `group` has generators; [`Error::Argument`] for edges that do not follow each other, or loops
    /// that do not start and end at one vertex; [`Error::Layout`] where their relator is not 1; [`Error::Cancelled`].
    pub fn of_loops(
        metric: &Solution,
        layout: &Layout,
        group: SurfaceGroup,
        loops: &[Vec<HalfedgeId>],
        control: &Control,
    ) -> Result<DeckGroup> {
        let mesh = layout.mesh();
        check_size("loops of a canonical basis", loops.len(), group.n_generators())?;
        let ends = |path: &Vec<HalfedgeId>| Some((mesh.origin(*path.first()?), mesh.tip(*path.last()?)));
        let base = loops.first().and_then(ends).map(|(v, _)| v);
        if let Some(k) = loops.iter().position(|path| ends(path) != base.map(|v| (v, v))) {
            let need = "start and end at one vertex with the others";
            return Err(Error::argument("loop of a canonical basis", k, need));
        }
        let corner = base.and_then(|v| mesh.outgoing(v).find(|&h| !mesh.is_outside(h)));
        let corner = corner.ok_or_else(|| Error::Layout("loops of a canonical basis have no face".into()))?;
        let walks = CoverWalks::new(metric, layout)?;
        let element = |path: &Vec<HalfedgeId>| walks.element(corner, path, control);
        let mut deck = DeckGroup {
            space: layout.space,
            group,
            generators: loops.iter().map(element).collect::<Result<_>>()?,
            sides: Vec::new(),
            borders: Vec::new(),
            corner,
            relation_residual: 0.0,
            relation_error: 0.0,
            side_residual: 0.0,
        };
        let relator = group.relator();
        let whole = deck.motion(&relator)?;
        deck.relation_error = whole.distance_from_identity().min(f64::MAX);
        deck.relation_residual = deck.residual(&relator, &whole)?;
        if deck.relation_residual > MOST_RESIDUAL && deck.relation_error > MOST_RELATION_ERROR {
            let text = group.text(&relator);
            return Err(Error::Layout(format!("the loops are no canonical basis: {text} is not 1 for them")));
        }
        Ok(deck)
    }

    /// The element of a generator or its inverse.
    ///
    /// # Errors
    /// As [`DeckGroup::letter`].
    pub fn element(&self, letter: Letter) -> Result<DeckElement> {
        Ok(DeckElement { word: Word::from_iter([letter]), motion: self.letter(letter)? })
    }

    /// The isometry of a generator or its inverse.
    ///
    /// # Errors
    /// [`Error::Argument`] for a generator that the group does not have.
    pub fn letter(&self, letter: Letter) -> Result<Motion<DoubleDouble>> {
        match self.generators.get(letter.index()) {
            Some(g) if letter.is_inverse() => Ok(g.inverse()),
            Some(g) => Ok(*g),
            None => {
                let value = format!("number {}", letter.index());
                Err(Error::Argument { what: "generator", value, need: "one of the group's generators" })
            }
        }
    }

    /// The isometry of a word.
    ///
    /// # Errors
    /// As [`DeckGroup::letter`].
    pub fn motion(&self, word: &Word) -> Result<Motion<DoubleDouble>> {
        let letters = word.letters().iter();
        letters.map(|&l| self.letter(l)).try_fold(Motion::identity(self.space), |m, g| Ok(m.compose(&g?)))
    }

    /// The distance of `rest` from the identity, relative to the largest ‖P‖² of the partial products of a word.
    fn residual(&self, word: &Word, rest: &Motion<DoubleDouble>) -> Result<f64> {
        let mut product = Motion::identity(self.space);
        let mut largest = product.norm_square();
        for &letter in word.letters() {
            product = product.compose(&self.letter(letter)?);
            largest = largest.max(product.norm_square());
        }
        let residual = rest.distance_from_identity() / largest;
        // A product beyond the range of f64s gives NaN.
        Ok(if residual.is_nan() { f64::MAX } else { residual })
    }

    /// Per generator, |tr| of its matrix of determinant 1: 2 cosh(L/2) in H².
    pub fn traces(&self) -> Vec<f64> {
        self.generators.iter().map(|g| 2.0 * f64::from(g.half_trace()).abs()).collect()
    }

    /// The translation length of each generator ([`Motion::translation_length`]).
    pub fn translation_lengths(&self) -> Vec<f64> {
        self.generators.iter().map(Motion::translation_length).collect()
    }

    /// The modulus of a flat torus, `[Re τ, Im τ]` reduced ([`modulus`]); `None` for another group.
    pub fn modulus(&self) -> Option<[f64; 2]> {
        match self.generators.as_slice() {
            [a, b] if self.space == Space::E2 && self.group.genus == 1 => {
                modulus([a, b].map(|g| g.mobius()[0][1]))
            }
            _ => None,
        }
    }

    /// The 4g + b corners of the canonical polygon, whose sides are geodesics from lift to lift of the base along the relator: the images of the
    /// point `base` under the prefixes of the relator, in ambient coordinates.
    ///
    /// For a closed surface the polygon is a fundamental domain, since the geodesic loops of the generators meet at the base alone. It need
    /// not be convex.
    ///
    /// # Errors
    /// As [`DeckGroup::letter`].
    pub fn canonical_polygon(&self, base: [f64; 3]) -> Result<Vec<[f64; 3]>> {
        let mut product = Motion::identity(self.space);
        let base = precise_point(self.space, base);
        let relator = self.group.relator();
        let corner = |&letter: &Letter| {
            let at = product.apply(base).map(f64::from);
            product = product.compose(&self.letter(letter)?);
            Ok(at)
        };
        relator.letters().iter().map(corner).collect()
    }

    /// The interior angles of the canonical polygon, in [0, 2π). On a closed surface they add up to 2π, since all corners are one point of it.
    ///
    /// Each angle is computed at the base, between the images of the base under the inverse of the last letter and under the next letter.
    ///
    /// # Errors
    /// As [`DeckGroup::letter`].
    pub fn canonical_angles(&self, base: [f64; 3]) -> Result<Vec<f64>> {
        let to_origin = Motion::to_origin(self.space, precise_point(self.space, base));
        let direction = |g: Motion<DoubleDouble>| {
            let [x, y, _] = g.conjugated_by(&to_origin).origin().map(f64::from);
            y.atan2(x)
        };
        let relator = self.group.relator();
        let letters = relator.letters();
        let n = letters.len();
        let angle = |k: usize| {
            let before = direction(self.letter(letters[(k + n - 1) % n].inverse())?);
            Ok((before - direction(self.letter(letters[k])?)).rem_euclid(TAU))
        };
        (0..n).map(angle).collect()
    }
}
