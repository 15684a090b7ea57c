//! Helpers of several tests: the mesh corpus with its index, and random numbers.
#![allow(dead_code)]

pub mod flips;
pub mod flow;

use ricci::mesh::io::{self, Soup};
use ricci::mesh::shapes::SplitMix64;
use std::collections::HashMap;
use std::path::PathBuf;

/// The folder `kind` (`good`, `bad`) of the mesh corpus, or `None` (said on stderr) where the corpus is absent. It is
/// looked for in `RICCI_MESHES`, by default `../shared/meshes`.
pub fn corpus(kind: &str) -> Option<PathBuf> {
    let root = std::env::var_os("RICCI_MESHES")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/meshes"), PathBuf::from);
    let folder = root.join(kind);
    if folder.join("INDEX.csv").exists() {
        return Some(folder);
    }
    eprintln!("mesh corpus absent: {} has no INDEX.csv; set RICCI_MESHES to run this test", folder.display());
    None
}

/// The rows of `INDEX.csv`, by column name.
pub fn index(kind: &str) -> Option<(PathBuf, Vec<HashMap<String, String>>)> {
    let folder = corpus(kind)?;
    let text = std::fs::read_to_string(folder.join("INDEX.csv")).unwrap();
    let mut rows = text.lines().map(fields);
    let header = rows.next().unwrap();
    Some((folder, rows.map(|row| header.iter().cloned().zip(row).collect()).collect()))
}

/// The meshes of these names from the corpus, or `None` where the corpus is absent. Each must be a row of `INDEX.csv`, be readable and
/// have the numbers of vertices and faces that the row counts.
pub fn named<'a>(kind: &str, names: &[&'a str]) -> Option<Vec<(&'a str, Soup)>> {
    let (folder, rows) = index(kind)?;
    let read = |&name: &&'a str| {
        let row = rows.iter().find(|row| row["name"] == name);
        let row = row.unwrap_or_else(|| panic!("{name} is not in INDEX.csv"));
        let soup = io::read(&folder.join(&row["file"])).unwrap_or_else(|error| panic!("{error}"));
        let counted = [&row["V"], &row["F"]].map(|n| n.parse::<usize>().unwrap());
        assert_eq!([soup.positions.len(), soup.faces.len()], counted, "{name}: vertices and faces");
        (name, soup)
    };
    Some(names.iter().map(read).collect())
}

/// Fields of a CSV line with quoted fields.
fn fields(line: &str) -> Vec<String> {
    let (mut fields, mut quoted) = (vec![String::new()], false);
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(String::new()),
            c => fields.last_mut().unwrap().push(c),
        }
    }
    fields
}

/// Seeded numbers for tests.
pub struct Random(SplitMix64);

impl Random {
    pub fn new(seed: u64) -> Random {
        Random(SplitMix64::new(seed))
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0.unit()
    }

    /// In [−1, 1).
    pub fn symmetric(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// In 0…n−1.
    pub fn below(&mut self, n: usize) -> usize {
        (self.0.bits() % n as u64) as usize
    }
}

/// A floating-point number as C's `%a` writes it.
pub fn hex(text: &str) -> f64 {
    let (sign, digits) = text.strip_prefix('-').map_or((1.0, text), |digits| (-1.0, digits));
    let (mantissa, exponent) = digits.strip_prefix("0x").unwrap().split_once('p').unwrap();
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let bits = u64::from_str_radix(&format!("{whole}{fraction}"), 16).unwrap();
    // Exact: at most 53 bits, and powers of two.
    let exponent = exponent.parse::<i32>().unwrap() - 4 * fraction.len() as i32;
    let half = exponent / 2;
    sign * bits as f64 * 2f64.powi(half) * 2f64.powi(exponent - half)
}
