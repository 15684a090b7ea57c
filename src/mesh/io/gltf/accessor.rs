//! Access to the numbers of a glTF file [glTF 2.0, section 3.6]. Every range is checked against its buffer before anything is read or
//! allocated.

use super::super::budget::Budget;
use super::super::kind::NumberType;
use super::super::scan::Location;
use super::document::{ElementShape, GltfDocument, Sparse};
use super::locate::locate;
use crate::error::Result;
use std::borrow::Cow;

/// A document with the bytes of its buffers.
pub(super) struct GltfFile<'a> {
    pub document: &'a GltfDocument,
    pub buffers: Vec<StoredBytes<'a>>,
    pub path: &'a str,
    /// The text of the document, and its first byte in the file.
    pub json: &'a [u8],
    pub json_start: usize,
}

/// The bytes of a buffer, and their first byte in the file unless they were encoded as text.
pub(super) struct StoredBytes<'a> {
    pub bytes: Cow<'a, [u8]>,
    pub start: Option<usize>,
}

/// The type of components with this code.
fn component(code: u32) -> Option<NumberType> {
    Some(match code {
        5120 => NumberType::I8,
        5121 => NumberType::U8,
        5122 => NumberType::I16,
        5123 => NumberType::U16,
        5125 => NumberType::U32,
        5126 => NumberType::F32,
        _ => return None,
    })
}

/// The type with this code, if it is an unsigned integer.
fn unsigned(code: u32) -> Option<NumberType> {
    component(code).filter(|kind| matches!(kind, NumberType::U8 | NumberType::U16 | NumberType::U32))
}

/// Elements as the document describes them: `count` of `width` components each, from byte `offset` of a buffer view.
struct ElementRun {
    view: u32,
    offset: usize,
    kind: NumberType,
    width: usize,
    count: usize,
}

/// `count` elements of `width` components, `stride` bytes apart; the last one ends inside `bytes`.
#[derive(Clone, Copy)]
struct Elements<'a> {
    bytes: &'a [u8],
    /// Their first byte in the file, unless they were encoded as text.
    start: Option<usize>,
    kind: NumberType,
    width: usize,
    stride: usize,
    count: usize,
}

impl Elements<'_> {
    /// The position of element `i`, or of the part of the document that describes it.
    fn place<'p>(&self, i: usize, else_at: Location<'p>) -> Location<'p> {
        self.start.map_or(else_at, |start| Location::byte(else_at.path, start + i * self.stride))
    }

    fn number(&self, i: usize, k: usize) -> f64 {
        self.kind.read(&self.bytes[i * self.stride + k * self.kind.size()..], false)
    }
}

/// The bytes of elements one after the other, each filled up to whole words of 4 bytes.
pub(super) struct PackedElements {
    pub bytes: Vec<u8>,
    pub stride: usize,
}

/// The numbers of one accessor.
pub(super) struct Accessor<'a> {
    index: u32,
    /// Its use, for errors.
    what: &'static str,
    pub count: usize,
    kind: NumberType,
    width: usize,
    /// The divisor of numbers that stand for fractions.
    full: Option<f64>,
    is_unsigned: bool,
    /// `None` for zeros.
    dense: Option<Elements<'a>>,
    /// The indices of the elements that differ, and their values.
    sparse: Option<(Elements<'a>, Elements<'a>)>,
}

impl<'a> GltfFile<'a> {
    /// The position of entry `index` of an array of the document.
    pub fn place_of(&self, array: &str, index: usize) -> Location<'a> {
        match locate(self.json, array, index) {
            Some(at) => Location::byte(self.path, self.json_start + at),
            None => Location::whole(self.path),
        }
    }

    pub fn whole(&self) -> Location<'a> {
        Location::whole(self.path)
    }

    /// The accessor with this index, which must hold one of these shapes; `what` describes it in errors.
    pub fn accessor(
        &'a self,
        index: u32,
        what: &'static str,
        shapes: &[ElementShape],
    ) -> Result<Accessor<'a>> {
        let Some(text) = self.document.accessors.get(index as usize) else {
            return self.whole().error(format!("{what} names accessor {index}, which does not exist"));
        };
        let fail = |message: String| {
            self.place_of("accessors", index as usize).error(format!("accessor {index} ({what}): {message}"))
        };
        let Some(kind) = component(text.component_type) else {
            return fail(format!("component type {} does not exist", text.component_type));
        };
        let width = match text.shape {
            shape if !shapes.contains(&shape) => return fail(format!("{shape:?} has no meaning there")),
            ElementShape::Scalar => 1,
            ElementShape::Vec2 => 2,
            ElementShape::Vec3 => 3,
            ElementShape::Vec4 | ElementShape::Mat2 => 4,
            ElementShape::Mat3 => 9,
            ElementShape::Mat4 => 16,
        };
        let count = text.count;
        let dense =
            text.buffer_view.map(|view| ElementRun { view, offset: text.byte_offset, kind, width, count });
        let dense = dense.map(|run| self.elements(run)).transpose();
        let sparse = text.sparse.as_deref().map(|sparse| self.sparse(sparse, kind, width)).transpose();
        match (dense, sparse) {
            (Err(message), _) | (_, Err(message)) => fail(message),
            (Ok(dense), Ok(sparse)) => Ok(Accessor {
                index,
                what,
                count,
                kind,
                width,
                // The format has no fractions of more than 16 bits.
                full: (text.normalized && kind.size() < 4).then(|| kind.full()),
                is_unsigned: unsigned(text.component_type).is_some(),
                dense,
                sparse,
            }),
        }
    }

    /// The indices of the elements that differ, and their values; the error is a message.
    fn sparse(
        &'a self,
        text: &Sparse,
        kind: NumberType,
        width: usize,
    ) -> std::result::Result<(Elements<'a>, Elements<'a>), String> {
        let Some(index) = unsigned(text.indices.component_type) else {
            return Err("its sparse indices are no unsigned integers".into());
        };
        let (count, indices, values) = (text.count, &text.indices, &text.values);
        let indices = ElementRun {
            view: indices.buffer_view,
            offset: indices.byte_offset,
            kind: index,
            width: 1,
            count,
        };
        let values = ElementRun { view: values.buffer_view, offset: values.byte_offset, kind, width, count };
        Ok((self.elements(indices)?, self.elements(values)?))
    }

    /// The bytes of a buffer view.
    pub fn view(&self, index: usize) -> Result<&[u8]> {
        let fail = |why: String| self.place_of("bufferViews", index).error(why);
        let Some(text) = self.document.buffer_views.get(index) else {
            return fail(format!("buffer view {index} does not exist"));
        };
        let Some(buffer) = self.buffers.get(text.buffer as usize) else {
            return fail(format!("buffer {} of buffer view {index} does not exist", text.buffer));
        };
        let end = text.byte_offset.checked_add(text.byte_length);
        match end.and_then(|end| buffer.bytes.get(text.byte_offset..end)) {
            Some(bytes) => Ok(bytes),
            None => {
                fail(format!("buffer view {index} ends behind its buffer of {} bytes", buffer.bytes.len()))
            }
        }
    }

    /// The bytes of a run of elements; the error is a message.
    fn elements(&'a self, run: ElementRun) -> std::result::Result<Elements<'a>, String> {
        let ElementRun { view, offset, kind, width, count } = run;
        let Some(text) = self.document.buffer_views.get(view as usize) else {
            return Err(format!("buffer view {view} does not exist"));
        };
        let Some(buffer) = self.buffers.get(text.buffer as usize) else {
            return Err(format!("buffer {} of buffer view {view} does not exist", text.buffer));
        };
        let end = text.byte_offset.checked_add(text.byte_length);
        let Some(bytes) = end.and_then(|end| buffer.bytes.get(text.byte_offset..end)) else {
            return Err(format!("buffer view {view} ends behind its buffer of {} bytes", buffer.bytes.len()));
        };
        let size = width * kind.size();
        let stride = text.byte_stride.unwrap_or(size);
        if stride < size {
            return Err(format!("byte stride {stride} of buffer view {view} is below the element's {size}"));
        }
        let end = match count {
            0 => Some(offset),
            n => (n - 1).checked_mul(stride).and_then(|n| n.checked_add(size)?.checked_add(offset)),
        };
        match end.and_then(|end| bytes.get(offset..end)) {
            Some(bytes) => Ok(Elements {
                bytes,
                start: buffer.start.map(|at| at + text.byte_offset + offset),
                kind,
                width,
                stride,
                count,
            }),
            None => Err(format!("{count} elements end behind buffer view {view} of {} bytes", bytes.len())),
        }
    }
}

impl Accessor<'_> {
    /// The position of its description in the document.
    pub fn place<'p>(&self, file: &GltfFile<'p>) -> Location<'p> {
        file.place_of("accessors", self.index as usize)
    }

    /// All elements, filled up to N components with `fill`.
    pub fn numbers<const N: usize>(
        &self,
        fill: f64,
        budget: &mut Budget,
        file: &GltfFile<'_>,
    ) -> Result<Vec<[f64; N]>> {
        budget.take(self.count, size_of::<[f64; N]>(), self.what, file.whole())?;
        let value = |x: f64| self.full.map_or(x, |full| (x / full).max(-1.0));
        let element = |from: &Elements<'_>, i: usize| -> [f64; N] {
            std::array::from_fn(|k| if k < from.width { value(from.number(i, k)) } else { fill })
        };
        let mut numbers: Vec<[f64; N]> = match &self.dense {
            Some(dense) => (0..self.count).map(|i| element(dense, i)).collect(),
            None => {
                let zero = std::array::from_fn(|k| if k < self.width { 0.0 } else { fill });
                vec![zero; self.count]
            }
        };
        if let Some((indices, values)) = &self.sparse {
            for i in 0..values.count {
                let at = indices.number(i, 0) as usize;
                match numbers.get_mut(at) {
                    Some(slot) => *slot = element(values, i),
                    None => {
                        let message = format!("{}: element {at} of {} is replaced", self.what, self.count);
                        return indices.place(i, self.place(file)).error(message);
                    }
                }
            }
        }
        Ok(numbers)
    }

    /// The bytes of all elements as they are, those that are replaced with their values.
    pub fn packed(&self, budget: &mut Budget, file: &GltfFile<'_>) -> Result<PackedElements> {
        let size = self.width * self.kind.size();
        let stride = size.next_multiple_of(4);
        budget.take(self.count, stride, self.what, file.whole())?;
        let mut bytes = vec![0; self.count * stride];
        let mut put = |at: usize, from: &Elements<'_>, i: usize| {
            bytes[at * stride..][..size].copy_from_slice(&from.bytes[i * from.stride..][..size]);
        };
        if let Some(dense) = &self.dense {
            (0..self.count).for_each(|i| put(i, dense, i));
        }
        if let Some((indices, values)) = &self.sparse {
            for i in 0..values.count {
                let at = indices.number(i, 0) as usize;
                if at >= self.count {
                    let message = format!("{}: element {at} of {} is replaced", self.what, self.count);
                    return indices.place(i, self.place(file)).error(message);
                }
                put(at, values, i);
            }
        }
        Ok(PackedElements { bytes, stride })
    }

    /// All elements as vertex numbers below `n`.
    pub fn indices(&self, n: usize, budget: &mut Budget, file: &GltfFile<'_>) -> Result<Vec<u32>> {
        if !self.is_unsigned {
            return self.place(file).error("indices are no unsigned integers".into());
        }
        let numbers: Vec<[f64; 1]> = self.numbers(0.0, budget, file)?;
        match numbers.iter().position(|&[v]| v >= n as f64) {
            Some(i) => {
                let place = self.place(file);
                let place = self.dense.map_or(place, |dense| dense.place(i, place));
                place.error(format!("index {i} of a mesh names vertex {} of {n}", numbers[i][0]))
            }
            None => Ok(numbers.into_iter().map(|[v]| v as u32).collect()),
        }
    }
}
