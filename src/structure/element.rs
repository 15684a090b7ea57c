//! Elements of the groups in which the transitions of atlases lie.

use super::kind::Structure;
use crate::geometry::{DoubleDouble, Motion};
use nalgebra::{Complex, Matrix2, Matrix3, SMatrix, Vector2, Vector3};

/// An element of the group of a structure, acting on the coordinates of its charts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Element {
    /// `z ↦ (a z + b)/(c z + d)`, rows `[a, b]`, `[c, d]`: of PSL(2,C), SU(2), SU(1,1) (determinant 1), or `[[e^{iθ}, t], [0, 1]]`.
    Mobius(Matrix2<Complex<f64>>),
    /// Acts on `(x, y, 1)` up to scale: of SE(2), with last row `[0, 0, 1]`, or of SO⁺(2,1).
    Projective(Matrix3<f64>),
}

impl Element {
    /// An isometry as the charts of a structure see it.
    pub fn of_motion(structure: Structure, motion: &Motion<DoubleDouble>) -> Element {
        if structure.is_complex() {
            let [[a, b], [c, d]] = motion.mobius().map(|row| row.map(|[re, im]| Complex::new(re, im)));
            return Element::Mobius(Matrix2::new(a, b, c, d));
        }
        let rows = motion.matrix().map(|row| row.map(f64::from));
        Element::Projective(Matrix3::from_fn(|i, j| rows[i][j]))
    }

    /// The identity.
    pub fn identity(structure: Structure) -> Element {
        match structure.is_complex() {
            true => Element::Mobius(Matrix2::identity()),
            false => Element::Projective(Matrix3::identity()),
        }
    }

    /// The image of a point; not finite where that is infinite.
    pub fn apply(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        match self {
            Element::Mobius(m) => {
                let image = m * Vector2::new(Complex::new(x, y), Complex::new(1.0, 0.0));
                let z = image.x / image.y;
                [z.re, z.im]
            }
            Element::Projective(m) => {
                let image = m * Vector3::new(x, y, 1.0);
                [image.x / image.z, image.y / image.z]
            }
        }
    }

    /// `self ∘ first`; none for elements that act on different coordinates.
    pub fn after(&self, first: &Element) -> Option<Element> {
        match (self, first) {
            (Element::Mobius(m), Element::Mobius(n)) => Some(Element::Mobius(m * n)),
            (Element::Projective(m), Element::Projective(n)) => Some(Element::Projective(m * n)),
            _ => None,
        }
    }

    /// The inverse; none for a matrix without one.
    pub fn inverse(&self) -> Option<Element> {
        match self {
            Element::Mobius(m) => m.try_inverse().map(Element::Mobius),
            Element::Projective(m) => m.try_inverse().map(Element::Projective),
        }
    }

    /// How far two elements are apart, as maps: the largest difference of an entry once both matrices are divided by their entry in the
    /// place where the second one has its largest. Infinite for elements that act on different coordinates.
    pub fn difference(&self, other: &Element) -> f64 {
        match (self, other) {
            (Element::Mobius(m), Element::Mobius(n)) => apart(m, n, |z| z.norm()),
            (Element::Projective(m), Element::Projective(n)) => apart(m, n, |x| x.abs()),
            _ => f64::INFINITY,
        }
    }

    /// Its matrix by rows, complex numbers as `[Re, Im]`.
    pub fn rows(&self) -> Vec<Vec<[f64; 2]>> {
        match self {
            Element::Mobius(m) => by_rows(m, |z| [z.re, z.im]),
            Element::Projective(m) => by_rows(m, |x| [x, 0.0]),
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
