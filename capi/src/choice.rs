//! Enum values, which come from C as `uint32_t`: an integer that is no value is refused with the names of all values.

use crate::failure::{Failure, Outcome};

/// The constants of an enum in the order of their numbers from 0, each with the value that it stands for.
pub struct Choices<T: 'static> {
    /// The name of the enum in messages.
    pub what: &'static str,
    pub values: &'static [(&'static str, T)],
}

/// Makes the table of an enum of the library, or of an enum that it declares with the values of the table.
macro_rules! choices {
    ($vis:vis enum $type:ident, $table:ident = $what:literal, [$($name:ident => $value:ident),+ $(,)?]) => {
        #[derive(Debug, Clone, Copy, PartialEq)]
        $vis enum $type {
            $($value),+
        }
        $crate::choice::choices!($vis $table: $type = $what, [$($name => $type::$value),+]);
    };
    ($vis:vis $table:ident: $type:ty = $what:literal, [$($name:ident => $value:expr),+ $(,)?]) => {
        $vis const $table: $crate::choice::Choices<$type> =
            $crate::choice::Choices { what: $what, values: &[$((stringify!($name), $value)),+] };
    };
}
pub(crate) use choices;

impl<T: Copy + PartialEq> Choices<T> {
    /// The value that a number stands for.
    pub fn choose(&self, number: u32) -> Outcome<T> {
        self.values.get(number as usize).map(|&(_, value)| value).ok_or_else(|| {
            let names: Vec<&str> = self.values.iter().map(|(name, _)| *name).collect();
            Failure::argument(format!("{} is {number}: known are {}", self.what, names.join(", ")))
        })
    }

    /// The number of a value.
    pub fn number(&self, value: T) -> Outcome<u32> {
        let found = self.values.iter().position(|(_, own)| *own == value);
        found.map(|k| k as u32).ok_or_else(|| Failure::argument(format!("{} has no number in C", self.what)))
    }
}
