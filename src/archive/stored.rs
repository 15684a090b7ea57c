//! A macro by which a type lists its parts, and checks of parts that were read.

use crate::error::{Error, Result};

/// The error of a value whose parts do not fit each other.
pub fn invalid(what: &'static str, need: &'static str) -> Error {
    Error::Argument { what, value: "of another size or out of range".into(), need }
}

/// Checks that all of some indices are below a bound.
///
/// # Errors
/// [`Error::Argument`] for an index that is not.
pub fn in_range(what: &'static str, mut indices: impl Iterator<Item = usize>, bound: usize) -> Result<()> {
    match indices.find(|&index| index >= bound) {
        Some(index) => Err(Error::Argument {
            what,
            value: index.to_string(),
            need: "an index below the number of elements",
        }),
        None => Ok(()),
    }
}

/// Implements [`super::Stored`] for a type of this crate by a list of all its parts. A part that is missing from the list is an error of the compiler.
///
/// - `sections Name { a, b } without { c } check Name::f`: named sections; `c` is not kept and has its default when it is read; `f` refuses values whose
///   parts do not fit.
/// - `row Name { a, b }`: the parts without names, for what stands in long lists.
/// - `variants Name { A = 0, B = 1 }`: variants without parts.
/// - `id Name`: a type of its own around one value of at least four bytes.
macro_rules! stored {
    (sections $name:ident { $($part:ident),* $(,)? } $(without { $($left:ident),* })? $(check $check:expr)?) => {
        impl $crate::archive::Stored for $name {
            const LEAST: usize = 0 $(+ 9 + stringify!($part).len())*;

            fn write(&self, to: &mut $crate::archive::ArchiveWriter) {
                let $name { $($part,)* $($($left: _,)*)? } = self;
                $(to.section(stringify!($part), $part);)*
            }

            fn read(from: &mut $crate::archive::ArchiveReader<'_>) -> $crate::error::Result<Self> {
                $(let $part = from.section(stringify!($part))?;)*
                let value = $name { $($part,)* $($($left: Default::default(),)*)? };
                $(from.checked($check(&value))?;)?
                Ok(value)
            }
        }
    };
    (row $name:ident { $($part:ident: $kind:ty),* $(,)? }) => {
        impl $crate::archive::Stored for $name {
            const LEAST: usize = 0 $(+ <$kind as $crate::archive::Stored>::LEAST)*;

            fn write(&self, to: &mut $crate::archive::ArchiveWriter) {
                let $name { $($part,)* } = self;
                $($crate::archive::Stored::write($part, to);)*
            }

            fn read(from: &mut $crate::archive::ArchiveReader<'_>) -> $crate::error::Result<Self> {
                $(let $part: $kind = $crate::archive::Stored::read(from)?;)*
                Ok($name { $($part,)* })
            }
        }
    };
    (variants $name:ident { $($variant:ident = $number:literal),* $(,)? }) => {
        impl $crate::archive::Stored for $name {
            const LEAST: usize = 1;

            fn write(&self, to: &mut $crate::archive::ArchiveWriter) {
                let number: u8 = match self { $($name::$variant => $number,)* };
                $crate::archive::Stored::write(&number, to);
            }

            fn read(from: &mut $crate::archive::ArchiveReader<'_>) -> $crate::error::Result<Self> {
                match <u8 as $crate::archive::Stored>::read(from)? {
                    $($number => Ok($name::$variant),)*
                    other => Err(from.wrong(format!("{other} is no {}", stringify!($name)))),
                }
            }
        }
    };
    (id $name:ident) => {
        impl $crate::archive::Stored for $name {
            const LEAST: usize = 4;

            fn write(&self, to: &mut $crate::archive::ArchiveWriter) {
                $crate::archive::Stored::write(&self.0, to);
            }

            fn read(from: &mut $crate::archive::ArchiveReader<'_>) -> $crate::error::Result<Self> {
                $crate::archive::Stored::read(from).map($name)
            }
        }
    };
}
pub(crate) use stored;
