//! Arrays with one entry per element, indexed by the element's typed id and owned by the caller.
//!
//! ```
//! use ricci::mesh::{EdgeId, Mesh, PerEdge};
//! let mesh = Mesh::from_faces(3, &[[0, 1, 2]])?;
//! let mut lengths = PerEdge::filled(mesh.n_edges(), 1.0);
//! lengths[EdgeId(0)] = 1.5;
//! assert_eq!(lengths.iter().sum::<f64>(), 3.5);
//! # Ok::<(), ricci::Error>(())
//! ```

use super::ids::{EdgeId, FaceId, HalfedgeId, VertexId};
use crate::archive::{ArchiveReader, ArchiveWriter, Stored};
use crate::error::Result;
use std::marker::PhantomData;
use std::ops::{Deref, DerefMut, Index, IndexMut};

/// One `T` per element with id type `I`. Dereferences to a slice for iteration and arithmetic.
#[derive(Debug, Clone, PartialEq)]
pub struct PerElement<I, T> {
    values: Vec<T>,
    id: PhantomData<I>,
}

/// One entry per vertex.
pub type PerVertex<T> = PerElement<VertexId, T>;
/// One entry per half-edge.
pub type PerHalfedge<T> = PerElement<HalfedgeId, T>;
/// One entry per edge.
pub type PerEdge<T> = PerElement<EdgeId, T>;
/// One entry per face.
pub type PerFace<T> = PerElement<FaceId, T>;

impl<I, T> PerElement<I, T> {
    /// `n` copies of `value`.
    pub fn filled(n: usize, value: T) -> Self
    where
        T: Clone,
    {
        vec![value; n].into()
    }

    /// `f(id)` for the ids 0…n−1.
    pub fn from_fn(n: usize, f: impl FnMut(I) -> T) -> Self
    where
        I: From<usize>,
    {
        (0..n).map(I::from).map(f).collect::<Vec<_>>().into()
    }

    /// Adds the entries of elements that were added.
    pub(crate) fn extend(&mut self, values: impl IntoIterator<Item = T>) {
        self.values.extend(values);
    }

    /// The entries as a plain vector.
    pub fn into_vec(self) -> Vec<T> {
        self.values
    }
}

impl<I, T> From<Vec<T>> for PerElement<I, T> {
    fn from(values: Vec<T>) -> Self {
        Self { values, id: PhantomData }
    }
}

impl<I, T: Stored> Stored for PerElement<I, T> {
    const LEAST: usize = Vec::<T>::LEAST;

    fn write(&self, to: &mut ArchiveWriter) {
        self.values.write(to);
    }

    fn read(from: &mut ArchiveReader<'_>) -> Result<Self> {
        Vec::read(from).map(Self::from)
    }
}

impl<I, T> Deref for PerElement<I, T> {
    type Target = [T];
    fn deref(&self) -> &[T] {
        &self.values
    }
}

impl<I, T> DerefMut for PerElement<I, T> {
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.values
    }
}

macro_rules! indexed_by {
    ($($id:ty),*) => {$(
        impl<T> Index<$id> for PerElement<$id, T> {
            type Output = T;
            #[inline]
            fn index(&self, id: $id) -> &T {
                &self.values[id.index()]
            }
        }
        impl<T> IndexMut<$id> for PerElement<$id, T> {
            #[inline]
            fn index_mut(&mut self, id: $id) -> &mut T {
                &mut self.values[id.index()]
            }
        }
    )*};
}
indexed_by!(VertexId, HalfedgeId, EdgeId, FaceId);

impl<'a, I, T> IntoIterator for &'a PerElement<I, T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;
    fn into_iter(self) -> Self::IntoIter {
        self.values.iter()
    }
}
