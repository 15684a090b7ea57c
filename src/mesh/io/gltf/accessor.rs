//! Numbers of a glTF file where they lie [glTF 2.0, section 3.6]. Every range is checked against its buffer before anything is
//! read or allocated.

use super::super::budget::Budget;
use super::super::scan::Location;
use super::document::{Document, Shape, Sparse};
use super::locate::locate;
use crate::error::Result;
use std::borrow::Cow;

/// A document with the bytes of its buffers.
pub(super) struct File<'a> {
    pub document: &'a Document,
    pub buffers: Vec<Stored<'a>>,
    pub path: &'a str,
    /// The text of the document, and the byte of the file at which it begins.
    pub json: &'a [u8],
    pub json_start: usize,
}

/// The bytes of a buffer, and where in the file they are as they stand.
pub(super) struct Stored<'a> {
    pub bytes: Cow<'a, [u8]>,
    pub start: Option<usize>,
}

#[derive(Clone, Copy, PartialEq)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn new(code: u32) -> Option<Component> {
        Some(match code {
            5120 => Component::I8,
            5121 => Component::U8,
            5122 => Component::I16,
            5123 => Component::U16,
            5125 => Component::U32,
            5126 => Component::F32,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Component::I8 | Component::U8 => 1,
            Component::I16 | Component::U16 => 2,
            Component::U32 | Component::F32 => 4,
        }
    }

    /// The largest value of an integer that can be normalised to 1; 1 for the others.
    fn full(self) -> f64 {
        match self {
            Component::I8 => f64::from(i8::MAX),
            Component::U8 => f64::from(u8::MAX),
            Component::I16 => f64::from(i16::MAX),
            Component::U16 => f64::from(u16::MAX),
            Component::U32 | Component::F32 => 1.0,
        }
    }

    fn read(self, b: &[u8]) -> f64 {
        match (self, b) {
            (Component::I8, &[a, ..]) => f64::from(a as i8),
            (Component::U8, &[a, ..]) => f64::from(a),
            (Component::I16, &[a, b, ..]) => f64::from(i16::from_le_bytes([a, b])),
            (Component::U16, &[a, b, ..]) => f64::from(u16::from_le_bytes([a, b])),
            (Component::U32, &[a, b, c, d, ..]) => f64::from(u32::from_le_bytes([a, b, c, d])),
            (Component::F32, &[a, b, c, d, ..]) => f64::from(f32::from_le_bytes([a, b, c, d])),
            _ => f64::NAN,
        }
    }
}

/// `count` elements of `width` components, `stride` bytes apart; the last one ends inside `bytes`.
#[derive(Clone, Copy)]
struct Elements<'a> {
    bytes: &'a [u8],
    /// Where in the file they begin, if they are there as they stand.
    start: Option<usize>,
    component: Component,
    width: usize,
    stride: usize,
    count: usize,
}

impl Elements<'_> {
    /// Where element `i` stands, or the place of what names it.
    fn place<'p>(&self, i: usize, else_at: Location<'p>) -> Location<'p> {
        self.start.map_or(else_at, |start| Location::byte(else_at.path, start + i * self.stride))
    }

    fn number(&self, i: usize, k: usize) -> f64 {
        self.component.read(&self.bytes[i * self.stride + k * self.component.size()..])
    }
}

/// Numbers of one accessor.
pub(super) struct Accessor<'a> {
    index: u32,
    pub count: usize,
    width: usize,
    component: Component,
    normalized: bool,
    /// `None`: zeros.
    dense: Option<Elements<'a>>,
    /// Elements that differ, and what they are.
    sparse: Option<(Elements<'a>, Elements<'a>)>,
}

impl<'a> File<'a> {
    /// Where entry `index` of an array of the document stands.
    pub fn place_of(&self, array: &str, index: usize) -> Location<'a> {
        match locate(self.json, array, index) {
            Some(at) => Location::byte(self.path, self.json_start + at),
            None => Location::whole(self.path),
        }
    }

    pub fn whole(&self) -> Location<'a> {
        Location::whole(self.path)
    }

    /// The accessor that `what` names; it holds one of these shapes.
    pub fn accessor(&'a self, index: u32, what: &str, shapes: &[Shape]) -> Result<Accessor<'a>> {
        let Some(text) = self.document.accessors.get(index as usize) else {
            return self.whole().error(format!("{what} names accessor {index}, which does not exist"));
        };
        let fail = |message: String| {
            self.place_of("accessors", index as usize).error(format!("accessor {index} ({what}): {message}"))
        };
        let Some(component) = Component::new(text.component_type) else {
            return fail(format!("component type {} does not exist", text.component_type));
        };
        let width = match text.shape {
            shape if !shapes.contains(&shape) => return fail(format!("{shape:?} has no meaning there")),
            Shape::Scalar => 1,
            Shape::Vec2 => 2,
            Shape::Vec3 => 3,
            Shape::Vec4 | Shape::Mat2 => 4,
            Shape::Mat3 => 9,
            Shape::Mat4 => 16,
        };
        let run = |view: Option<u32>, offset: usize, component: Component, width: usize, count: usize| {
            view.map(|view| self.elements(view, offset, component, width, count)).transpose()
        };
        let dense = match run(text.buffer_view, text.byte_offset, component, width, text.count) {
            Ok(dense) => dense,
            Err(message) => return fail(message),
        };
        let sparse = match text.sparse.as_deref().map(|s| self.sparse(s, component, width)).transpose() {
            Ok(sparse) => sparse,
            Err(message) => return fail(message),
        };
        Ok(Accessor {
            index,
            count: text.count,
            width,
            component,
            normalized: text.normalized,
            dense,
            sparse,
        })
    }

    fn sparse(
        &'a self,
        text: &Sparse,
        component: Component,
        width: usize,
    ) -> std::result::Result<(Elements<'a>, Elements<'a>), String> {
        let index = match Component::new(text.indices.component_type) {
            Some(index @ (Component::U8 | Component::U16 | Component::U32)) => index,
            _ => return Err("its sparse indices are no unsigned integers".into()),
        };
        let (indices, values) = (&text.indices, &text.values);
        Ok((
            self.elements(indices.buffer_view, indices.byte_offset, index, 1, text.count)?,
            self.elements(values.buffer_view, values.byte_offset, component, width, text.count)?,
        ))
    }

    /// `count` elements from byte `offset` of a buffer view; the error says what is wrong.
    fn elements(
        &'a self,
        view: u32,
        offset: usize,
        component: Component,
        width: usize,
        count: usize,
    ) -> std::result::Result<Elements<'a>, String> {
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
        let size = width * component.size();
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
                component,
                width,
                stride,
                count,
            }),
            None => Err(format!("{count} elements end behind buffer view {view} of {} bytes", bytes.len())),
        }
    }
}

impl Accessor<'_> {
    /// Where the document names it.
    fn place<'p>(&self, file: &File<'p>) -> Location<'p> {
        file.place_of("accessors", self.index as usize)
    }

    /// All elements, filled up to N components with `fill`.
    pub fn numbers<const N: usize>(
        &self,
        fill: f64,
        what: &str,
        budget: &mut Budget,
        file: &File<'_>,
    ) -> Result<Vec<[f64; N]>> {
        budget.take(self.count, size_of::<[f64; N]>(), what, file.whole())?;
        let value = |x: f64| if self.normalized { (x / self.component.full()).max(-1.0) } else { x };
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
                        return indices
                            .place(i, self.place(file))
                            .error(format!("{what}: element {at} of {} is replaced", self.count));
                    }
                }
            }
        }
        Ok(numbers)
    }

    /// All elements as vertex numbers below `n`.
    pub fn indices(&self, n: usize, budget: &mut Budget, file: &File<'_>) -> Result<Vec<u32>> {
        if !matches!(self.component, Component::U8 | Component::U16 | Component::U32) {
            return self.place(file).error("indices are no unsigned integers".into());
        }
        let numbers: Vec<[f64; 1]> = self.numbers(0.0, "indices", budget, file)?;
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
