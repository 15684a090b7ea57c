//! The deck group of a surface of constant curvature: its fundamental group as isometries of the model space.
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

use super::border::Border;
use super::element::DeckElement;
use super::layout::Layout;
use super::walk::Walks;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::flow::Solution;
use crate::geometry::modulus::modulus;
use crate::geometry::motion::precise_point;
use crate::geometry::{DoubleDouble, Motion, Space, worse};
use crate::mesh::HalfedgeId;
use crate::topology::word::{Letter, Word};
use crate::topology::{DomainSide, FundamentalDomain, HomotopyBasis, SurfaceGroup};
use std::f64::consts::TAU;

/// The group of deck transformations of the universal cover of a layout, acting from the left: M(γ) carries the base lift to the end of
/// γ's lift, `M(γδ) = M(γ) M(δ)`.
///
/// Isometries have twice the digits of doubles: products of far translations then lose less than the errors of the side pairings.
#[derive(Debug, Clone)]
pub struct DeckGroup {
    /// The space it acts on.
    pub space: Space,
    /// The group with its names and relator.
    pub group: SurfaceGroup,
    /// The isometries of the canonical generators a1, b1, …, ag, bg, c1, …, cb.
    pub generators: Vec<Motion<DoubleDouble>>,
    /// Sides of the layout's fundamental domain: the elements that carry it onto its neighbours, counterclockwise.
    pub sides: Vec<DeckElement>,
    /// The lines along which the layout's domain has the boundary of the surface, counterclockwise. Where the boundary is straight they
    /// bound the universal cover.
    pub borders: Vec<Border>,
    /// The corner of the layout that is the base lift: a half-edge of a face at the base vertex.
    pub corner: HalfedgeId,
    /// `‖R − I‖_F / max_k ‖P_k‖²` of the relator's matrix R over its partial products P_k (Frobenius norms of 2×2 matrices, R with the
    /// nearer sign). 0 without a relation.
    pub relation_residual: f64,
    /// `‖R − I‖_F` itself: the error of the relation near the base.
    pub relation_error: f64,
    /// As `relation_residual`, for each side: how far its pairing is from its word's isometry; the largest.
    pub side_residual: f64,
}

impl DeckGroup {
    /// The deck group of a layout without cones of this metric ([`super::layout_about`]), with the generators of a homotopy basis of the
    /// mesh that is laid out.
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
        let walks = Walks::new(metric, layout)?;
        let element = |path: &Vec<HalfedgeId>| walks.element(deck.corner, path, control);
        deck.generators = basis.loops.iter().map(element).collect::<Result<_>>()?;
        for (k, (side, motion)) in domain.sides.iter().zip(pairings).enumerate() {
            if side.partner.is_none() {
                let start = side.halfedges.first().copied().unwrap_or(deck.corner);
                let copy = &domain.corners[k].element;
                deck.borders.push(Border::new(&walks, basis, (copy, start), control)?);
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
    /// [`Error::Argument`] for a generator that the group has not.
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

    /// How far `rest` is from the identity, relative to the largest ‖P‖² of the partial products of a word.
    fn residual(&self, word: &Word, rest: &Motion<DoubleDouble>) -> Result<f64> {
        let mut product = Motion::identity(self.space);
        let mut largest = product.norm_square();
        for &letter in word.letters() {
            product = product.compose(&self.letter(letter)?);
            largest = largest.max(product.norm_square());
        }
        let residual = rest.distance_from_identity() / largest;
        // A product beyond the range of doubles gives NaN.
        Ok(if residual.is_nan() { f64::MAX } else { residual })
    }

    /// |tr| of the generators' matrices of determinant 1: 2 cosh(L/2) in H².
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

    /// Corners of the canonical polygon, whose sides are geodesics from lift to lift of the base along the relator: the images of the base
    /// lift at `base` under its prefixes, in ambient coordinates; 4g + b of them.
    ///
    /// It is a fundamental domain of a closed surface: the geodesic loops of the generators meet in the base alone. Its corners need
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

    /// The angles of the canonical polygon inside its corners, in [0, 2π): on a closed surface they add up to 2π, since all corners are one
    /// point of it.
    ///
    /// Each is formed at the base: seen from corner P_k, the neighbours are where the last letter came from and where the next one
    /// leads.
    ///
    /// # Errors
    /// As [`DeckGroup::letter`].
    pub fn canonical_angles(&self, base: [f64; 3]) -> Result<Vec<f64>> {
        let home = Motion::to_origin(self.space, precise_point(self.space, base));
        let direction = |g: Motion<DoubleDouble>| {
            let [x, y, _] = g.conjugated_by(&home).origin().map(f64::from);
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
