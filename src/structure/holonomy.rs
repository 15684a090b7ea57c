//! The holonomy of a structure: the fundamental group in the structure's group.

use super::element::Element;
use super::kind::Structure;
use super::sheet::Sheet;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::geometry::complex::norm2;
use crate::geometry::motion::Real;
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::topology::{HomotopyBasis, SurfaceGroup, crossed_halfedges};

/// The homomorphism from the fundamental group into the group of a structure, by its values at the generators of a canonical basis.
///
/// On a surface with singular vertices the loops go round them, on whichever side. The holonomy around one is the identity: its cone angle
/// is a multiple of 2π.
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
    pub(super) fn new(sheet: &Sheet, basis: &HomotopyBasis, control: &Control) -> Result<Holonomy> {
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

    /// The value at generator `k` as the charts of a structure see it.
    pub fn element(&self, structure: Structure, k: usize) -> Option<Element> {
        self.generators.get(k).map(|motion| Element::of_motion(structure, motion))
    }
}

/// Products of 2 to this power, and larger ones, are as far from the identity as they are large, to all digits.
const FAR: i32 = 120;

/// `unit`: a length that the surface is about as large as.
fn residual(group: SurfaceGroup, generators: &[Motion<DoubleDouble>], unit: f64) -> f64 {
    let Some(first) = generators.first() else { return 0.0 };
    let longest = generators.iter().map(|g| f64::from(norm2(g.b)).sqrt()).fold(unit, f64::max);
    let unit = if first.space == Space::E2 { longest } else { 1.0 };
    let in_units = |g: &Motion<DoubleDouble>| Motion { b: g.b.map(|x| x / unit.into()), ..*g };
    // The product is `product · 2^power`, of a size near 1: products of many far translations are beyond the range of doubles.
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
    let off = match power < FAR {
        true => scaled(&product, power).distance_from_identity().log2(),
        false => size(&product, power),
    };
    let residual = (off - 2.0 * largest).exp2();
    // A generator beyond the range of doubles gives NaN.
    if residual.is_nan() { f64::MAX } else { residual }
}

/// Both parameters times 2^k.
fn scaled(m: &Motion<DoubleDouble>, k: i32) -> Motion<DoubleDouble> {
    Motion { a: m.a.map(|x| x.times_two_to(k)), b: m.b.map(|x| x.times_two_to(k)), ..*m }
}
