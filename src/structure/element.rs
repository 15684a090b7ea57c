//! Elements of the transformation groups of structures, as matrices that act on chart coordinates.

use super::kind::Structure;
use crate::archive::{ArchiveReader, ArchiveWriter, Stored};
use crate::error::Result;
use crate::geometry::{DoubleDouble, Motion};
use nalgebra::{Complex, Matrix2, Matrix3, SMatrix, Vector2, Vector3};

/// An element of the group of a structure, acting on the coordinates of charts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GroupElement {
    /// `z ↦ (a z + b)/(c z + d)`, rows `[a, b]`, `[c, d]`: in PSL(2,C), SU(2), SU(1,1) (determinant 1), or `[[e^{iθ}, t], [0, 1]]`.
    Mobius(Matrix2<Complex<f64>>),
    /// A matrix that acts on `(x, y, 1)` up to scale: in SE(2), with last row `[0, 0, 1]`, or in SO⁺(2,1).
    Projective(Matrix3<f64>),
}

impl Stored for GroupElement {
    const LEAST: usize = 65;

    fn write(&self, to: &mut ArchiveWriter) {
        matches!(self, GroupElement::Mobius(_)).write(to);
        match self {
            GroupElement::Mobius(matrix) => matrix.iter().for_each(|entry| entry.write(to)),
            GroupElement::Projective(matrix) => matrix.iter().for_each(|entry| entry.write(to)),
        }
    }

    fn read(from: &mut ArchiveReader<'_>) -> Result<Self> {
        Ok(if bool::read(from)? {
            GroupElement::Mobius(Matrix2::from_column_slice(&<[Complex<f64>; 4]>::read(from)?))
        } else {
            GroupElement::Projective(Matrix3::from_column_slice(&<[f64; 9]>::read(from)?))
        })
    }
}

impl GroupElement {
    /// An isometry of the space as an element of the group of a structure.
    pub fn of_motion(structure: Structure, motion: &Motion<DoubleDouble>) -> GroupElement {
        if structure.is_complex() {
            let [[a, b], [c, d]] = motion.mobius().map(|row| row.map(|[re, im]| Complex::new(re, im)));
            return GroupElement::Mobius(Matrix2::new(a, b, c, d));
        }
        let rows = motion.matrix().map(|row| row.map(|x| structure.exact(f64::from(x))));
        GroupElement::Projective(Matrix3::from_fn(|i, j| rows[i][j]))
    }

    /// The identity.
    pub fn identity(structure: Structure) -> GroupElement {
        if structure.is_complex() {
            GroupElement::Mobius(Matrix2::identity())
        } else {
            GroupElement::Projective(Matrix3::identity())
        }
    }

    /// The image of a point; not finite if the image is infinite.
    pub fn apply(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        match self {
            GroupElement::Mobius(m) => {
                let image = m * Vector2::new(Complex::new(x, y), Complex::new(1.0, 0.0));
                let z = image.x / image.y;
                [z.re, z.im]
            }
            GroupElement::Projective(m) => {
                let image = m * Vector3::new(x, y, 1.0);
                [image.x / image.z, image.y / image.z]
            }
        }
    }

    /// The composition `self ∘ first`; none for elements that act on different coordinates.
    pub fn after(&self, first: &GroupElement) -> Option<GroupElement> {
        match (self, first) {
            (GroupElement::Mobius(m), GroupElement::Mobius(n)) => Some(GroupElement::Mobius(m * n)),
            (GroupElement::Projective(m), GroupElement::Projective(n)) => {
                Some(GroupElement::Projective(m * n))
            }
            _ => None,
        }
    }

    /// The inverse; none for a matrix without one.
    pub fn inverse(&self) -> Option<GroupElement> {
        match self {
            GroupElement::Mobius(m) => m.try_inverse().map(GroupElement::Mobius),
            GroupElement::Projective(m) => m.try_inverse().map(GroupElement::Projective),
        }
    }

    /// The difference of two elements as maps: the largest difference of an entry after both matrices are divided by their entry at the
    /// position of the second one's largest. Infinite for elements that act on different coordinates.
    pub fn difference(&self, other: &GroupElement) -> f64 {
        match (self, other) {
            (GroupElement::Mobius(m), GroupElement::Mobius(n)) => apart(m, n, |z| z.norm()),
            (GroupElement::Projective(m), GroupElement::Projective(n)) => apart(m, n, |x| x.abs()),
            _ => f64::INFINITY,
        }
    }

    /// The matrix by rows, complex numbers as `[Re, Im]`.
    pub fn rows(&self) -> Vec<Vec<[f64; 2]>> {
        match self {
            GroupElement::Mobius(m) => by_rows(m, |z| [z.re, z.im]),
            GroupElement::Projective(m) => by_rows(m, |x| [x, 0.0]),
        }
    }
}

fn by_rows<T: Copy, const N: usize>(
    m: &SMatrix<T, N, N>,
    entry: impl Fn(T) -> [f64; 2],
) -> Vec<Vec<[f64; 2]>> {
    (0..N).map(|i| (0..N).map(|j| entry(m[(i, j)])).collect()).collect()
}

fn apart<T, const N: usize>(m: &SMatrix<T, N, N>, n: &SMatrix<T, N, N>, size: impl Fn(T) -> f64) -> f64
where
    T: Copy + std::ops::Div<Output = T> + std::ops::Sub<Output = T>,
{
    let entries = || (0..N).flat_map(|i| (0..N).map(move |j| (i, j)));
    let largest = entries().max_by(|&p, &q| size(n[p]).total_cmp(&size(n[q]))).unwrap_or((0, 0));
    entries().map(|at| size(m[at] / m[largest] - n[at] / n[largest])).fold(0.0, crate::geometry::worse)
}
