//! Ways through a glTF document as plain JSON: its primitives, and what names its accessors and buffer views.

use serde_json::{Map, Value};
use std::collections::BTreeSet;

/// Prefixes of extensions that name no accessor.
const WITHOUT_ACCESSORS: [&str; 3] = ["KHR_materials_", "KHR_texture_", "KHR_lights_"];

/// Takes a list out of the document; an empty one if it has none.
pub(super) fn taken(document: &mut Value, name: &str) -> Vec<Value> {
    match document.get_mut(name).map(Value::take) {
        Some(Value::Array(list)) => list,
        _ => Vec::new(),
    }
}

/// Puts a list that was taken back; the format has no empty ones.
pub(super) fn give_back(document: &mut Value, name: &str, list: Vec<Value>) {
    let Some(members) = document.as_object_mut() else { return };
    if list.is_empty() {
        members.remove(name);
    } else {
        members.insert(name.into(), Value::Array(list));
    }
}

/// Puts an entry in a place of a list, or behind it.
pub(super) fn put(list: &mut Vec<Value>, at: usize, entry: Value) {
    match list.get_mut(at) {
        Some(place) => *place = entry,
        None => list.push(entry),
    }
}

/// All primitives of all meshes.
pub(super) fn each_primitive(document: &mut Value, mut to: impl FnMut(&mut Value)) {
    let meshes = document.get_mut("meshes").and_then(Value::as_array_mut);
    for mesh in meshes.into_iter().flatten() {
        let primitives = mesh.get_mut("primitives").and_then(Value::as_array_mut);
        primitives.into_iter().flatten().for_each(&mut to);
    }
}

/// The numbers of the accessors that a primitive names: of its attributes, its morph targets, its indices.
pub(super) fn each_accessor(primitive: &mut Value, mut to: impl FnMut(&mut Value)) {
    if let Some(indices) = primitive.get_mut("indices") {
        to(indices);
    }
    each_attribute_list(primitive, |members| members.values_mut().for_each(&mut to));
}

/// The attributes of a primitive and those of each of its morph targets, by their names.
pub(super) fn each_attribute_list(primitive: &mut Value, mut to: impl FnMut(&mut Map<String, Value>)) {
    if let Some(attributes) = primitive.get_mut("attributes").and_then(Value::as_object_mut) {
        to(attributes);
    }
    let targets = primitive.get_mut("targets").and_then(Value::as_array_mut);
    targets.into_iter().flatten().filter_map(Value::as_object_mut).for_each(to);
}

/// The accessors that something in the document names: primitives, animations, skins, and extensions, of which every whole number may be
/// one.
pub(super) fn named_accessors(document: &Value) -> BTreeSet<usize> {
    let mut named = BTreeSet::new();
    let mut add = |value: &Value| named.extend(value.as_u64().map(|k| k as usize));
    let entries = |list: &'static str| document[list].as_array().into_iter().flatten();
    for primitive in entries("meshes").filter_map(|mesh| mesh["primitives"].as_array()).flatten() {
        add(&primitive["indices"]);
        let targets = primitive["targets"].as_array().into_iter().flatten();
        for attributes in targets.chain([&primitive["attributes"]]).filter_map(Value::as_object) {
            attributes.values().for_each(&mut add);
        }
    }
    for sampler in entries("animations").filter_map(|animation| animation["samplers"].as_array()).flatten() {
        add(&sampler["input"]);
        add(&sampler["output"]);
    }
    entries("skins").for_each(|skin| add(&skin["inverseBindMatrices"]));
    extension_numbers(document, &mut add);
    named
}

/// Every whole number in an extension that may name accessors.
fn extension_numbers(part: &Value, add: &mut impl FnMut(&Value)) {
    match part {
        Value::Array(list) => list.iter().for_each(|value| extension_numbers(value, add)),
        Value::Object(members) => {
            for (name, value) in members {
                match value.as_object().filter(|_| name == "extensions") {
                    Some(extensions) => extensions
                        .iter()
                        .filter(|(name, _)| !WITHOUT_ACCESSORS.iter().any(|prefix| name.starts_with(prefix)))
                        .for_each(|(_, value)| whole_numbers(value, add)),
                    None => extension_numbers(value, add),
                }
            }
        }
        _ => {}
    }
}

fn whole_numbers(part: &Value, add: &mut impl FnMut(&Value)) {
    match part {
        Value::Array(list) => list.iter().for_each(|value| whole_numbers(value, add)),
        Value::Object(members) => members.values().for_each(|value| whole_numbers(value, add)),
        number => add(number),
    }
}

/// The buffer views that a part of the document names.
pub(super) fn collect_views(part: &Value, views: &mut BTreeSet<usize>) {
    match part {
        Value::Array(list) => list.iter().for_each(|value| collect_views(value, views)),
        Value::Object(members) => {
            for (name, value) in members {
                match value.as_u64().filter(|_| name == "bufferView") {
                    Some(view) => {
                        views.insert(view as usize);
                    }
                    None => collect_views(value, views),
                }
            }
        }
        _ => {}
    }
}
