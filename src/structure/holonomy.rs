//! The holonomy of a structure: the isometry that each generator of the fundamental group is sent to; [`Holonomy::element`] gives it in
//! the structure's group.

use super::developable::DevelopableSurface;
use super::element::GroupElement;
use super::kind::Structure;
use crate::archive::stored;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::complex::norm2;
use crate::geometry::motion::Real;
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::topology::{HomotopyBasis, SurfaceGroup, crossed_halfedges};

/// The homomorphism from the fundamental group into the isometries of the structure's space, given by its values at the generators of a
/// canonical basis.
///
/// It does not matter on which side a loop passes a singular vertex: the holonomy around one is the identity, since its cone angle is a
/// multiple of 2π. Only those of an integer structure turn by other multiples of 90°: there the values are those of the loops of the basis,
/// and there is no relation between them.
#[derive(Debug, Clone)]
pub struct Holonomy {
    /// The fundamental group of the surface, with names and relator.
    pub group: SurfaceGroup,
    /// The values at a1, b1, …, ag, bg, c1, …, cb, in a frame with the base at its origin: `M(γδ) = M(γ) M(δ)`, where γδ is γ first.
    pub generators: Vec<Motion<DoubleDouble>>,
    /// `‖R − I‖ / max_k ‖P_k‖²`: R is the product of the relator's letters, P_k those of its first k letters. Frobenius norms of 2×2
    /// matrices. In E², lengths are divided first by the larger of the longest translation and √area. 0 where there is no relation: without
    /// generators, and around singular vertices that turn.
    pub relation_residual: f64,
}
stored!(sections Holonomy { group, generators, relation_residual });

impl Holonomy {
    pub(super) fn new(
        surface: &DevelopableSurface,
        basis: &HomotopyBasis,
        control: &Control,
    ) -> Result<Holonomy> {
        let mesh = surface.mesh();
        let no_face = || Error::Layout(format!("the base, vertex {}, has no face", basis.base));
        let start = mesh.outgoing(basis.base).find(|&h| !mesh.is_outside(h)).ok_or_else(no_face)?;
        let (f, k) = mesh.corner(start).ok_or_else(no_face)?;
        let base_place = surface.place_about(f, Some(k));
        let identity = Motion::identity(surface.faces.space);
        let mut generators = Vec::with_capacity(basis.loops.len());
        for path in &basis.loops {
            control.check()?;
            let crossed = crossed_halfedges(mesh, start, path)?;
            let walk = crossed.iter().fold(identity, |m, &h| m.compose(&surface.faces.across[h]));
            generators.push(walk.conjugated_by(&base_place).normalised());
        }
        let relation_residual =
            if surface.turns { 0.0 } else { residual(basis.group, &generators, surface.size()) };
        Ok(Holonomy { group: basis.group, generators, relation_residual })
    }

    /// The value at generator `k`, as an element of the group of a structure.
    pub fn element(&self, structure: Structure, k: usize) -> Option<GroupElement> {
        self.generators.get(k).map(|motion| GroupElement::of_motion(structure, motion))
    }
}

/// If ‖R‖ ≥ 2^FAR, then ‖R − I‖ = ‖R‖ to all digits.
const FAR: i32 = 120;

/// The relation residual, see [`Holonomy::relation_residual`]; `surface_size` is a length about as large as the surface.
fn residual(group: SurfaceGroup, generators: &[Motion<DoubleDouble>], surface_size: f64) -> f64 {
    let Some(first) = generators.first() else { return 0.0 };
    let longest = generators.iter().map(|g| f64::from(norm2(g.b)).sqrt()).fold(surface_size, f64::max);
    let unit = if first.space == Space::E2 { longest } else { 1.0 };
    let in_units = |g: &Motion<DoubleDouble>| Motion { b: g.b.map(|x| x / unit.into()), ..*g };
    // The product is `product · 2^power` with a size near 1, since products of many far translations are beyond the range of f64.
    let (mut product, mut power) = (Motion::<DoubleDouble>::identity(first.space), 0);
    let size = |m: &Motion<DoubleDouble>, power: i32| 0.5 * m.norm_square().log2() + f64::from(power);
    let mut largest = size(&product, power);
    for letter in group.relator().letters() {
        let g = in_units(&generators[letter.index()]);
        product = product.compose(&if letter.is_inverse() { g.inverse() } else { g });
        largest = largest.max(size(&product, power));
        let by = size(&product, 0).floor() as i32;
        (product, power) = (scaled(&product, -by), power + by);
    }
    let off = if power < FAR {
        scaled(&product, power).distance_from_identity().log2()
    } else {
        size(&product, power)
    };
    let residual = (off - 2.0 * largest).exp2();
    // A generator beyond the range of f64 gives NaN.
    if residual.is_nan() { f64::MAX } else { residual }
}

/// The motion with both parameters multiplied by 2^k.
fn scaled(m: &Motion<DoubleDouble>, k: i32) -> Motion<DoubleDouble> {
    Motion { a: m.a.map(|x| x.times_two_to(k)), b: m.b.map(|x| x.times_two_to(k)), ..*m }
}
