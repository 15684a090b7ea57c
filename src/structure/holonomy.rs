//! The holonomy of a structure: the homomorphism of the fundamental group into the structure's group.

use super::element::GroupElement;
use super::kind::Structure;
use super::sheet::DevelopableSurface;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::complex::norm2;
use crate::geometry::motion::Real;
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::topology::{HomotopyBasis, SurfaceGroup, crossed_halfedges};

/// The homomorphism from the fundamental group into the group of a structure, given by its values at the generators of a canonical basis.
///
/// On a surface with singular vertices, loops pass these on either side: the holonomy around one is the identity, since its cone angle is a
/// multiple of 2π.
#[derive(Debug, Clone)]
pub struct Holonomy {
    /// The fundamental group of the surface, with names and relator.
    pub group: SurfaceGroup,
    /// The values at a1, b1, …, ag, bg, c1, …, cb, in coordinates about the base: `M(γδ) = M(γ) M(δ)`.
    pub generators: Vec<Motion<DoubleDouble>>,
    /// `‖R − I‖_F / max_k ‖P_k‖²` of the relator's matrix R over its partial products P_k (Frobenius norms of 2×2 matrices, of flat
    /// structures with lengths in units of the longest translation, or of the root of the area if that is more). 0 without generators.
    pub relation_residual: f64,
}

impl Holonomy {
    pub(super) fn new(
        sheet: &DevelopableSurface,
        basis: &HomotopyBasis,
        control: &Control,
    ) -> Result<Holonomy> {
        let mesh = sheet.mesh();
        let none = || Error::Layout(format!("the base, vertex {}, has no face", basis.base));
        let corner = mesh.outgoing(basis.base).find(|&h| !mesh.is_outside(h)).ok_or_else(none)?;
        let (f, k) = mesh.corner(corner).ok_or_else(none)?;
        let home = sheet.place_about(f, Some(k));
        let identity = Motion::identity(sheet.steps.space);
        let mut generators = Vec::with_capacity(basis.loops.len());
        for path in &basis.loops {
            control.check()?;
            let crossed = crossed_halfedges(mesh, corner, path)?;
            let walk = crossed.iter().fold(identity, |m, &h| m.compose(&sheet.steps.across[h]));
            generators.push(walk.conjugated_by(&home).normalised());
        }
        let relation_residual = residual(basis.group, &generators, sheet.size());
        Ok(Holonomy { group: basis.group, generators, relation_residual })
    }

    /// The value at generator `k`, as an element of the group of a structure.
    pub fn element(&self, structure: Structure, k: usize) -> Option<GroupElement> {
        self.generators.get(k).map(|motion| GroupElement::of_motion(structure, motion))
    }
}

/// Binary exponent of the size of a product from which on its distance from the identity is its size, to all digits.
const FAR: i32 = 120;

/// The relation residual, see [`Holonomy::relation_residual`]; `unit` is a length about as large as the surface.
fn residual(group: SurfaceGroup, generators: &[Motion<DoubleDouble>], unit: f64) -> f64 {
    let Some(first) = generators.first() else { return 0.0 };
    let longest = generators.iter().map(|g| f64::from(norm2(g.b)).sqrt()).fold(unit, f64::max);
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
