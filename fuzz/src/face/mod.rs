//! Sequences of calls of the C face, drawn from bytes. The functions and structs are read off the headers when this is built.

mod draw;
mod session;
mod shared;
mod tape;

pub use session::{prepare, run};

use std::collections::HashMap;
use std::ffi::{c_char, c_void};
use std::sync::OnceLock;

include!(concat!(env!("OUT_DIR"), "/face.rs"));

/// The return value of a function.
pub enum Answer {
    Nothing,
    Status(u32),
    Number(u32),
    Text(*const c_char),
}

/// A function of the headers: the C type and name of each parameter, and its call with one word for each.
pub struct Call {
    pub name: &'static str,
    pub parameters: &'static [(&'static str, &'static str)],
    pub run: fn(&[u64]) -> Answer,
}

/// A struct of the headers: type, name and number of each field.
pub struct Struct {
    pub name: &'static str,
    pub fields: &'static [(&'static str, &'static str, usize)],
}

/// The kind of a parameter or field, by its C type.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Kind {
    F64,
    U32,
    I32,
    U64,
    Size,
    /// `const ricci_mesh *`.
    Handle(&'static str),
    /// `ricci_mesh *`, which a call releases or changes.
    Own(&'static str),
    /// `ricci_mesh **`.
    Made(&'static str),
    /// `const ricci_target *`.
    Given(&'static Struct),
    /// `ricci_mesh_summary *`.
    Filled(&'static Struct),
    /// `const double *` and its like; bytes of an entry.
    In(&'static str, usize),
    Out(&'static str, usize),
    Words,
    Text,
    Any,
    Callback,
}

impl PartialEq for Struct {
    fn eq(&self, other: &Struct) -> bool {
        self.name == other.name
    }
}
impl Eq for Struct {}
impl std::fmt::Debug for Struct {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

fn bytes_of(word: &str) -> usize {
    match word {
        "double" | "size_t" | "int64_t" | "uint64_t" => 8,
        "char" | "uint8_t" => 1,
        _ => 4,
    }
}

impl Kind {
    fn of(text: &'static str) -> Kind {
        let given = text.starts_with("const ");
        let word = text.trim_start_matches("const ").trim_end_matches([' ', '*']);
        let stars = text.matches('*').count();
        let structure = STRUCTS.iter().find(|s| s.name == word);
        match (word, stars, given) {
            ("ricci_log_callback", ..) => Kind::Callback,
            ("double", 0, _) => Kind::F64,
            ("uint32_t" | "ricci_status", 0, _) => Kind::U32,
            ("int32_t", 0, _) => Kind::I32,
            ("uint64_t" | "int64_t", 0, _) => Kind::U64,
            ("size_t", 0, _) => Kind::Size,
            ("void", ..) => Kind::Any,
            ("char", 1, true) => Kind::Text,
            ("char", 1, false) => Kind::Words,
            (word, 2, _) => Kind::Made(word),
            (word, 1, given) if word.starts_with("ricci_") => match (structure, given) {
                (Some(of), true) => Kind::Given(of),
                (Some(of), false) => Kind::Filled(of),
                (None, true) => Kind::Handle(word),
                (None, false) => Kind::Own(word),
            },
            (word, 1, true) => Kind::In(word, bytes_of(word)),
            (word, 1, false) => Kind::Out(word, bytes_of(word)),
            other => panic!("{other:?}"),
        }
    }

    /// Bytes in a struct, which are its alignment too.
    fn size(self) -> usize {
        if matches!(self, Kind::U32 | Kind::I32) { 4 } else { 8 }
    }
}

/// Fields with their kind, offset and number.
pub type Fields = Vec<(&'static str, Kind, usize, usize)>;

/// The fields of every struct, with its size.
pub fn layouts() -> &'static HashMap<&'static str, (Fields, usize)> {
    static ALL: OnceLock<HashMap<&'static str, (Fields, usize)>> = OnceLock::new();
    ALL.get_or_init(|| {
        let lay = |of: &Struct| {
            let (mut fields, mut end) = (Vec::new(), 0_usize);
            for &(text, name, count) in of.fields {
                let kind = Kind::of(text);
                let start = end.next_multiple_of(kind.size());
                fields.push((name, kind, start, count));
                end = start + count * kind.size();
            }
            (fields, end.next_multiple_of(8))
        };
        STRUCTS.iter().map(|of| (of.name, lay(of))).collect()
    })
}

/// The kinds of every function's parameters.
pub fn parameters() -> &'static [Vec<(&'static str, Kind)>] {
    static ALL: OnceLock<Vec<Vec<(&'static str, Kind)>>> = OnceLock::new();
    ALL.get_or_init(|| {
        let kinds = |call: &Call| call.parameters.iter().map(|&(of, name)| (name, Kind::of(of))).collect();
        CALLS.iter().map(kinds).collect()
    })
}

/// The call of a function by its name.
pub fn call(name: &str) -> &'static Call {
    static ALL: OnceLock<HashMap<&'static str, &'static Call>> = OnceLock::new();
    let all = ALL.get_or_init(|| CALLS.iter().map(|call| (call.name, call)).collect());
    all.get(name).unwrap_or_else(|| panic!("no {name} in the headers"))
}

/// A pointer as the word that passes it.
pub fn word<T>(place: *const T) -> u64 {
    place.cast::<c_void>() as u64
}
