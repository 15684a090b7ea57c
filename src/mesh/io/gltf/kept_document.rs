//! A glTF document that is written again with other accessors: all else stays as it is. What the new accessors replace and nothing else
//! names goes out of the file, and the new ones take its numbers.

use super::accessor::{GltfFile, PackedElements};
use super::document_walk::{
    collect_views, each_accessor, each_primitive, give_back, named_accessors, put, taken,
};
use super::glb_chunks::GlbChunks;
use crate::error::Result;
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// Compression of buffer views, of which the plain form is written.
const COMPRESSED_VIEWS: &str = "EXT_meshopt_compression";

/// The number of the first added accessor until the document is written: no file has as many.
const FIRST_ADDED: usize = 1 << 31;

/// The use of a buffer view.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum ViewTarget {
    Vertices,
    Indices,
}

/// A document with the accessors and pictures that are added to it.
pub(super) struct KeptDocument {
    pub document: Value,
    /// The number of accessors that it had.
    n_accessors: usize,
    added: Vec<AddedAccessor>,
    /// The accessors that are replaced where they were named.
    replaced: BTreeSet<usize>,
    pictures: Vec<AddedPicture>,
}

struct AddedAccessor {
    entry: Value,
    elements: PackedElements,
    target: ViewTarget,
}

struct AddedPicture {
    image: usize,
    kind: &'static str,
    bytes: Vec<u8>,
}

/// The bytes of a buffer view: those that it had, or new ones.
enum ViewBytes {
    Kept,
    New(Vec<u8>),
}

/// The buffer views of a document in their order.
struct ViewList {
    views: Vec<ViewBytes>,
    /// The numbers that are given to new ones first.
    free: Vec<usize>,
    /// The entries of new ones.
    entries: Vec<(usize, Value)>,
}

impl ViewList {
    fn add(&mut self, bytes: Vec<u8>, entry: Value) -> usize {
        let at = self.free.pop().unwrap_or(self.views.len());
        match self.views.get_mut(at) {
            Some(view) => *view = ViewBytes::New(bytes),
            None => self.views.push(ViewBytes::New(bytes)),
        }
        self.entries.push((at, entry));
        at
    }
}

impl KeptDocument {
    pub fn new(document: Value) -> KeptDocument {
        let n_accessors = document["accessors"].as_array().map_or(0, Vec::len);
        let (added, pictures) = (Vec::new(), Vec::new());
        KeptDocument { document, n_accessors, added, replaced: BTreeSet::new(), pictures }
    }

    /// Adds an accessor whose entry lacks its buffer view; returns its number.
    pub fn add(&mut self, entry: Value, elements: PackedElements, target: ViewTarget) -> usize {
        self.added.push(AddedAccessor { entry, elements, target });
        FIRST_ADDED + self.added.len() - 1
    }

    /// Marks an accessor that is no longer named where it was.
    pub fn replace(&mut self, accessor: usize) {
        self.replaced.insert(accessor);
    }

    /// Adds a picture for an image.
    pub fn picture(&mut self, image: usize, kind: &'static str, bytes: Vec<u8>) {
        self.pictures.push(AddedPicture { image, kind, bytes });
    }

    /// The file: the document with its accessors and buffer views, all in one buffer.
    pub fn chunks(mut self, file: &GltfFile<'_>) -> Result<GlbChunks> {
        let named = named_accessors(&self.document);
        let free: Vec<usize> = self.replaced.iter().copied().filter(|k| !named.contains(k)).collect();
        let mut loose = BTreeSet::new();
        for k in &free {
            collect_views(&self.document["accessors"][k], &mut loose);
        }
        let numbers = self.number_accessors(&free);
        let views = self.number_views(loose, &numbers);
        self.forget_compression();
        let binary = self.gathered(views, file)?;
        if !binary.is_empty() {
            self.document["buffers"] = json!([{"byteLength": binary.len()}]);
        }
        Ok(GlbChunks::new(&self.document, binary))
    }

    /// Puts the new accessors in the places of those that are free, then behind all others, and names them so; returns their numbers.
    fn number_accessors(&mut self, free: &[usize]) -> Vec<usize> {
        let n = self.n_accessors;
        let number = |k: usize| free.get(k).copied().unwrap_or_else(|| n + k - free.len());
        let numbers: Vec<usize> = (0..self.added.len()).map(number).collect();
        each_primitive(&mut self.document, |primitive| {
            each_accessor(primitive, |value| {
                let new = value.as_u64().and_then(|k| (k as usize).checked_sub(FIRST_ADDED));
                if let Some(number) = new.and_then(|k| numbers.get(k)) {
                    *value = json!(number);
                }
            });
        });
        let mut list = taken(&mut self.document, "accessors");
        for (number, added) in numbers.iter().zip(&self.added) {
            put(&mut list, *number, added.entry.clone());
        }
        // An accessor that nothing names and nothing replaces becomes a single zero: others keep their numbers.
        for k in free.iter().skip(numbers.len()) {
            put(&mut list, *k, json!({"componentType": 5126, "count": 1, "type": "SCALAR"}));
        }
        give_back(&mut self.document, "accessors", list);
        numbers
    }

    /// Gives the new accessors, which have these numbers, and pictures their buffer views. `loose` are views that may have lost all that
    /// named them.
    fn number_views(&mut self, loose: BTreeSet<usize>, numbers: &[usize]) -> ViewList {
        let mut named = BTreeSet::new();
        collect_views(&self.document, &mut named);
        let mut views = Vec::new();
        views.resize_with(self.document["bufferViews"].as_array().map_or(0, Vec::len), || ViewBytes::Kept);
        let free = loose.into_iter().rev().filter(|k| !named.contains(k)).collect();
        let mut list = ViewList { views, free, entries: Vec::new() };
        for (added, number) in self.added.iter_mut().zip(numbers) {
            let bytes = std::mem::take(&mut added.elements.bytes);
            let view = list.add(
                bytes,
                match added.target {
                    ViewTarget::Vertices => json!({"target": 34962, "byteStride": added.elements.stride}),
                    ViewTarget::Indices => json!({"target": 34963}),
                },
            );
            self.document["accessors"][number]["bufferView"] = json!(view);
        }
        for AddedPicture { image, kind, bytes } in std::mem::take(&mut self.pictures) {
            let view = list.add(bytes, json!({}));
            if let Some(members) = self.document["images"][image].as_object_mut() {
                members.remove("uri");
                members.insert("bufferView".into(), json!(view));
                members.insert("mimeType".into(), json!(kind));
            }
        }
        // A view that nothing names any more becomes a word of zeros.
        while !list.free.is_empty() {
            list.add(vec![0; 4], json!({}));
        }
        let mut entries = taken(&mut self.document, "bufferViews");
        list.entries.sort_by_key(|(view, _)| *view);
        for (view, entry) in std::mem::take(&mut list.entries) {
            put(&mut entries, view, entry);
        }
        give_back(&mut self.document, "bufferViews", entries);
        list
    }

    /// Views are written as they unfold, so that none says how it was compressed.
    fn forget_compression(&mut self) {
        for list in ["bufferViews", "buffers"] {
            let entries = self.document.get_mut(list).and_then(Value::as_array_mut);
            for extensions in entries.into_iter().flatten().filter_map(|entry| entry.get_mut("extensions")) {
                extensions.as_object_mut().map(|members| members.remove(COMPRESSED_VIEWS));
            }
        }
        self.forget_extension(COMPRESSED_VIEWS);
    }

    /// Takes an extension out of the list of those that the document uses.
    pub fn forget_extension(&mut self, name: &str) {
        let mut used = taken(&mut self.document, "extensionsUsed");
        used.retain(|used| used.as_str() != Some(name));
        give_back(&mut self.document, "extensionsUsed", used);
    }

    /// The bytes of all views one after the other, each from a whole word; their entries say where.
    fn gathered(&mut self, list: ViewList, file: &GltfFile<'_>) -> Result<Vec<u8>> {
        let mut binary: Vec<u8> = Vec::new();
        for (k, view) in list.views.iter().enumerate() {
            let bytes = match view {
                ViewBytes::New(bytes) => bytes,
                ViewBytes::Kept => file.view(k)?,
            };
            let entry = &mut self.document["bufferViews"][k];
            entry["buffer"] = json!(0);
            entry["byteOffset"] = json!(binary.len());
            entry["byteLength"] = json!(bytes.len());
            binary.extend_from_slice(bytes);
            binary.resize(binary.len().next_multiple_of(4), 0);
        }
        Ok(binary)
    }
}
