//! Types of numbers in files.

/// A type of numbers.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Kind {
    /// The type of this name in PLY, which knows the names of C and those with a size; GIFTI has the latter behind a prefix.
    pub fn named(name: &str) -> Option<Kind> {
        Some(match name {
            "char" | "int8" => Kind::I8,
            "uchar" | "uint8" => Kind::U8,
            "short" | "int16" => Kind::I16,
            "ushort" | "uint16" => Kind::U16,
            "int" | "int32" => Kind::I32,
            "uint" | "uint32" => Kind::U32,
            "int64" => Kind::I64,
            "uint64" => Kind::U64,
            "float" | "float32" => Kind::F32,
            "double" | "float64" => Kind::F64,
            _ => return None,
        })
    }

    pub fn size(self) -> usize {
        match self {
            Kind::I8 | Kind::U8 => 1,
            Kind::I16 | Kind::U16 => 2,
            Kind::I32 | Kind::U32 | Kind::F32 => 4,
            Kind::I64 | Kind::U64 | Kind::F64 => 8,
        }
    }

    pub fn is_integer(self) -> bool {
        !matches!(self, Kind::F32 | Kind::F64)
    }

    /// The value that stands for 1 where numbers of this type are fractions: the largest up to 16 bits, 255 for longer integers.
    pub fn full(self) -> f64 {
        match self {
            Kind::I8 => f64::from(i8::MAX),
            Kind::I16 => f64::from(i16::MAX),
            Kind::U16 => f64::from(u16::MAX),
            Kind::F32 | Kind::F64 => 1.0,
            _ => f64::from(u8::MAX),
        }
    }

    /// The number that the first bytes of `bytes` hold, of which there are enough.
    pub fn read(self, bytes: &[u8], big_endian: bool) -> f64 {
        let mut word = [0; 8];
        let low = &mut word[..self.size()];
        low.copy_from_slice(&bytes[..low.len()]);
        if big_endian {
            low.reverse();
        }
        let [a, b, c, d, ..] = word;
        match self {
            Kind::I8 => f64::from(a as i8),
            Kind::U8 => f64::from(a),
            Kind::I16 => f64::from(i16::from_le_bytes([a, b])),
            Kind::U16 => f64::from(u16::from_le_bytes([a, b])),
            Kind::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Kind::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Kind::I64 => i64::from_le_bytes(word) as f64,
            Kind::U64 => u64::from_le_bytes(word) as f64,
            Kind::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Kind::F64 => f64::from_le_bytes(word),
        }
    }
}
