//! Annotations: one named region per vertex, with the colours of the regions.

use super::big_endian::{BigEndianWords, signed};
use crate::error::{Error, Result};
#[cfg(feature = "gifti")]
use crate::mesh::io::gifti_values::{GiftiColumns, is_xml, parse_gifti_columns};
#[cfg(feature = "gifti")]
use crate::mesh::io::{gifti_write::GiftiLabel, scan::Location};

/// A region of an annotation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AnnotationEntry {
    /// The name.
    pub name: String,
    /// The number of the region in its table of colours.
    pub index: u32,
    /// Red, green and blue, from 0 to 255, by which vertices name their region, and transparency, 0 for opaque.
    pub color: [u8; 4],
}

/// One region per vertex.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Annotation {
    /// Per vertex, its place in `entries`; `None` for a vertex in no region.
    pub regions: Vec<Option<u32>>,
    /// The regions.
    pub entries: Vec<AnnotationEntry>,
    /// The file that the table of colours came from; empty if none is named.
    pub source: String,
}

/// The number by which vertices name a region.
fn number_of(color: [u8; 4]) -> u32 {
    u32::from_le_bytes([color[0], color[1], color[2], 0])
}

/// Parses an annotation with its table of colours, of the present version or the one before; also, by its content, labels of GIFTI
/// (`.label.gii`), with the cargo feature `gifti`. A vertex whose number no region has, or that the file does not name, is in none. `path` is
/// used in errors.
///
/// # Errors
/// [`crate::Error::Parse`] with the byte, or the line.
pub fn parse_annotation(bytes: &[u8], path: &str) -> Result<Annotation> {
    #[cfg(feature = "gifti")]
    if is_xml(bytes) {
        return of_gifti(&parse_gifti_columns(bytes, path)?, path);
    }
    let mut words = BigEndianWords::new(bytes, path);
    let n = words.count("the number of vertices")?;
    words.holds(n, 8, "vertices")?;
    let mut numbers = vec![None; n];
    for _ in 0..n {
        let place = words.place();
        let v = words.count("a vertex")?;
        let number = words.integer("the number of a region")?;
        match numbers.get_mut(v) {
            Some(slot) => *slot = Some(number),
            None => return place.error(format!("vertex {v}: the file has {n}")),
        }
    }
    let mut found = Annotation { regions: vec![None; n], ..Annotation::default() };
    if words.at == bytes.len() {
        return words.place().error("the file has no table of colours, which names the regions".into());
    }
    if words.integer("the tag of the table of colours")? == 1 {
        table(&mut words, &mut found)?;
    }
    let known: std::collections::HashMap<u32, u32> =
        (0..).zip(&found.entries).map(|(k, entry)| (number_of(entry.color), k)).collect();
    for (region, number) in found.regions.iter_mut().zip(numbers) {
        *region = number.and_then(|number| known.get(&(number as u32 & 0xff_ffff)).copied());
    }
    Ok(found)
}

/// Labels of GIFTI as an annotation: colours are rounded to whole numbers.
#[cfg(feature = "gifti")]
fn of_gifti(found: &GiftiColumns, path: &str) -> Result<Annotation> {
    let Some(labels) = found.labels() else {
        return Location::whole(path).error("the file has no array of labels".into());
    };
    let regions = labels.into_iter().map(|row| row.map(|row| row as u32)).collect();
    let mut entries = Vec::with_capacity(found.table.len());
    for GiftiLabel { key, name, color: [red, green, blue, alpha] } in &found.table {
        let Ok(index) = u32::try_from(*key) else {
            return Location::whole(path).error(format!("the label {key} is negative; regions count from 0"));
        };
        let color = [*red, *green, *blue, 1.0 - alpha].map(|part| (255.0 * part).round() as u8);
        entries.push(AnnotationEntry { name: name.clone(), index, color });
    }
    Ok(Annotation { regions, entries, source: String::new() })
}

/// Reads a table of colours: a number of entries, or a negative version, then the entries with numbers of their own.
fn table(words: &mut BigEndianWords<'_>, found: &mut Annotation) -> Result<()> {
    let place = words.place();
    let first = words.integer("the number of regions")?;
    let is_numbered = first < 0;
    if is_numbered {
        if first != -2 {
            return place.error(format!("the table of colours has version {}; 2 is read", -i64::from(first)));
        }
        words.count("the largest number of a region")?;
    }
    let length = words.count("the length of a name")?;
    found.source = words.text(length, "bytes of a name")?;
    let n = if is_numbered { words.count("the number of regions")? } else { first as usize };
    words.holds(n, 20, "regions")?;
    for k in 0..n {
        let index = if is_numbered { words.count("the number of a region")? as u32 } else { k as u32 };
        let length = words.count("the length of a name")?;
        let name = words.text(length, "bytes of a name")?;
        let mut color = [0; 4];
        for part in &mut color {
            let place = words.place();
            let value = words.integer("a colour")?;
            let Ok(value) = u8::try_from(value) else {
                return place.error(format!("a colour of region {k} is {value}: it is from 0 to 255"));
            };
            *part = value;
        }
        found.entries.push(AnnotationEntry { name, index, color });
    }
    Ok(())
}

/// The bytes of an annotation, with a table of colours of version 2. Vertices in no region have the number 0.
///
/// # Errors
/// [`Error::Argument`] for a region that is none, two regions with the same red, green and blue, the colour 0 0 0 where some vertices are in no
/// region, and names with a 0; [`Error::TooLarge`].
pub fn annotation_bytes(annotation: &Annotation) -> Result<Vec<u8>> {
    let Annotation { regions, entries, source } = annotation;
    let mut seen = std::collections::HashSet::new();
    if regions.contains(&None) {
        seen.insert(0);
    }
    for entry in entries {
        if !seen.insert(number_of(entry.color)) {
            let need = "different from those of other regions, and not 0 0 0 where vertices are in no region";
            return Err(Error::argument("colour of a region", format!("{:?}", entry.color), need));
        }
    }
    let mut bytes = signed(regions.len(), "vertices")?.to_vec();
    for (v, region) in regions.iter().enumerate() {
        let number = match region {
            None => 0,
            Some(k) => {
                let none = || Error::argument("region of a vertex", k, "the place of one of the regions");
                number_of(entries.get(*k as usize).ok_or_else(none)?.color)
            }
        };
        bytes.extend(signed(v, "vertices")?);
        bytes.extend(number.to_be_bytes());
    }
    let most = entries.iter().map(|entry| entry.index as usize + 1).max().unwrap_or(0);
    bytes.extend([1_i32, -2].map(i32::to_be_bytes).concat());
    bytes.extend(signed(most, "regions")?);
    put_text(&mut bytes, source)?;
    bytes.extend(signed(entries.len(), "regions")?);
    for entry in entries {
        bytes.extend(signed(entry.index as usize, "regions")?);
        put_text(&mut bytes, &entry.name)?;
        entry.color.iter().for_each(|part| bytes.extend(i32::from(*part).to_be_bytes()));
    }
    Ok(bytes)
}

/// A text with its length and a 0 behind it.
fn put_text(bytes: &mut Vec<u8>, text: &str) -> Result<()> {
    if text.contains('\0') {
        return Err(Error::argument("name", format!("{text:?}"), "without a 0"));
    }
    bytes.extend(signed(text.len() + 1, "bytes of a name")?);
    bytes.extend(text.as_bytes());
    bytes.push(0);
    Ok(())
}
