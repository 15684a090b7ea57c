//! The types of numbers in binary files.

use crate::archive::stored;

/// A type of numbers.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum NumberType {
    /// A signed integer of 8 bits.
    I8,
    /// An unsigned integer of 8 bits.
    U8,
    /// A signed integer of 16 bits.
    I16,
    /// An unsigned integer of 16 bits.
    U16,
    /// A signed integer of 32 bits.
    I32,
    /// An unsigned integer of 32 bits.
    U32,
    /// A signed integer of 64 bits.
    I64,
    /// An unsigned integer of 64 bits.
    U64,
    /// A floating-point number of 32 bits.
    F32,
    /// A floating-point number of 64 bits.
    F64,
}
stored!(variants NumberType {
        I8 = 0,
        U8 = 1,
        I16 = 2,
        U16 = 3,
        I32 = 4,
        U32 = 5,
        I64 = 6,
        U64 = 7,
        F32 = 8,
        F64 = 9,
    }
);

impl NumberType {
    /// The type with this name in PLY, which has the names of C and names with a size; GIFTI has the latter with a prefix.
    pub(super) fn named(name: &str) -> Option<NumberType> {
        Some(match name {
            "char" | "int8" => NumberType::I8,
            "uchar" | "uint8" => NumberType::U8,
            "short" | "int16" => NumberType::I16,
            "ushort" | "uint16" => NumberType::U16,
            "int" | "int32" => NumberType::I32,
            "uint" | "uint32" => NumberType::U32,
            "int64" => NumberType::I64,
            "uint64" => NumberType::U64,
            "float" | "float32" => NumberType::F32,
            "double" | "float64" => NumberType::F64,
            _ => return None,
        })
    }

    /// The name in PLY.
    pub(super) fn name(self) -> &'static str {
        match self {
            NumberType::I8 => "char",
            NumberType::U8 => "uchar",
            NumberType::I16 => "short",
            NumberType::U16 => "ushort",
            NumberType::I32 => "int",
            NumberType::U32 => "uint",
            NumberType::I64 => "int64",
            NumberType::U64 => "uint64",
            NumberType::F32 => "float",
            NumberType::F64 => "double",
        }
    }

    pub(super) fn size(self) -> usize {
        match self {
            NumberType::I8 | NumberType::U8 => 1,
            NumberType::I16 | NumberType::U16 => 2,
            NumberType::I32 | NumberType::U32 | NumberType::F32 => 4,
            NumberType::I64 | NumberType::U64 | NumberType::F64 => 8,
        }
    }

    pub(crate) fn is_integer(self) -> bool {
        !matches!(self, NumberType::F32 | NumberType::F64)
    }

    /// The value that stands for 1 where numbers of this type are fractions: the largest one up to 16 bits, 255 for longer integers.
    pub(super) fn full(self) -> f64 {
        match self {
            NumberType::I8 => f64::from(i8::MAX),
            NumberType::I16 => f64::from(i16::MAX),
            NumberType::U16 => f64::from(u16::MAX),
            NumberType::F32 | NumberType::F64 => 1.0,
            _ => f64::from(u8::MAX),
        }
    }

    /// The number in the first bytes of `bytes`, which has enough of them.
    pub(super) fn read(self, bytes: &[u8], big_endian: bool) -> f64 {
        let mut word = [0; 8];
        let low = &mut word[..self.size()];
        low.copy_from_slice(&bytes[..low.len()]);
        if big_endian {
            low.reverse();
        }
        let [a, b, c, d, ..] = word;
        match self {
            NumberType::I8 => f64::from(a as i8),
            NumberType::U8 => f64::from(a),
            NumberType::I16 => f64::from(i16::from_le_bytes([a, b])),
            NumberType::U16 => f64::from(u16::from_le_bytes([a, b])),
            NumberType::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            NumberType::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            NumberType::I64 => i64::from_le_bytes(word) as f64,
            NumberType::U64 => u64::from_le_bytes(word) as f64,
            NumberType::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            NumberType::F64 => f64::from_le_bytes(word),
        }
    }

    /// The bytes of a number, little-endian, in the first [`NumberType::size`] of the result. What an integer cannot hold becomes its
    /// nearest value, NaN 0.
    pub(super) fn bytes(self, x: f64) -> [u8; 8] {
        let mut word = [0; 8];
        let mut put = |bytes: &[u8]| word[..bytes.len()].copy_from_slice(bytes);
        match self {
            NumberType::I8 => put(&(x as i8).to_le_bytes()),
            NumberType::U8 => put(&(x as u8).to_le_bytes()),
            NumberType::I16 => put(&(x as i16).to_le_bytes()),
            NumberType::U16 => put(&(x as u16).to_le_bytes()),
            NumberType::I32 => put(&(x as i32).to_le_bytes()),
            NumberType::U32 => put(&(x as u32).to_le_bytes()),
            NumberType::I64 => put(&(x as i64).to_le_bytes()),
            NumberType::U64 => put(&(x as u64).to_le_bytes()),
            NumberType::F32 => put(&(x as f32).to_le_bytes()),
            NumberType::F64 => put(&x.to_le_bytes()),
        }
        word
    }
}
