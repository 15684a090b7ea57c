//! Enum values that come from C: any integer may come, and an unknown one is refused by name.

use crate::failure::{Failure, Outcome};
use crate::integer::raw;
use std::mem::MaybeUninit;

/// An enum that C passes by value, with the library's value for each of its own.
pub trait Choice: Sized + Copy + 'static {
    /// Its name in messages.
    const NAME: &'static str;
    /// The library's type.
    type Value: Copy + PartialEq;
    /// Every value.
    const ALL: &'static [(Self, Self::Value)];
    /// Its number.
    fn number(self) -> i32;
}

/// Makes a `#[repr(C)]` enum the choices of an argument, each with the value that it stands for.
macro_rules! choice {
    ($type:ident, $name:literal, $value:ident, [$($own:ident => $stands_for:ident),+ $(,)?]) => {
        impl $crate::choice::Choice for $type {
            const NAME: &'static str = $name;
            type Value = $value;
            const ALL: &'static [(Self, $value)] = &[$(($type::$own, $value::$stands_for)),+];
            fn number(self) -> i32 {
                self as i32
            }
        }
    };
}
pub(crate) use choice;

/// The library's value of what C passed.
pub fn choose<E: Choice>(value: MaybeUninit<E>) -> Outcome<E::Value> {
    let number = raw(value);
    let found = E::ALL.iter().find(|(known, _)| known.number() == number);
    found.map(|&(_, value)| value).ok_or_else(|| {
        let largest = E::ALL.iter().map(|(known, _)| known.number()).max().unwrap_or(0);
        Failure::argument(format!("{} is {number}: known are 0 to {largest}", E::NAME))
    })
}

/// The C enum of a library value.
pub fn name<E: Choice>(value: E::Value) -> Outcome<E> {
    let found = E::ALL.iter().find(|(_, own)| *own == value);
    found.map(|&(known, _)| known).ok_or_else(|| Failure::argument(format!("{} has no number in C", E::NAME)))
}
