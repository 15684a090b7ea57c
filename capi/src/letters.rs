//! Words as C has them: letters are signed generator numbers.

use crate::arrays::{array, copy_counted};
use crate::failure::{Failure, Outcome};
use ricci::topology::SurfaceGroup;
use ricci::topology::word::{Letter, Word};

/// The letters of a word: k for generator k (1-based), -k for its inverse.
pub fn letters(word: &Word) -> impl Iterator<Item = i32> + '_ {
    word.letters().iter().map(|letter| {
        let number = letter.index() as i32 + 1;
        if letter.is_inverse() { -number } else { number }
    })
}

/// A caller's word, freely reduced.
pub fn read(group: &SurfaceGroup, what: &str, data: *const i32, n: usize) -> Outcome<Word> {
    word_of(group, what, &array(what, data, n)?, 0)
}

/// The word of these letters, which are those of `what` from number `first` on.
pub fn word_of(group: &SurfaceGroup, what: &str, letters: &[i32], first: usize) -> Outcome<Word> {
    let count = group.n_generators();
    let letter = |(i, number): (usize, &i32)| match number.unsigned_abs() as usize {
        k if k == 0 || k > count => Err(Failure::argument(format!(
            "{what}[{}] is {number}: letters are 1 to {count} for the generators, -1 to -{count} for their inverses",
            first + i
        ))),
        k if *number < 0 => Ok(Letter::generator(k - 1).inverse()),
        k => Ok(Letter::generator(k - 1)),
    };
    letters.iter().enumerate().map(letter).collect()
}

/// Hand a word out.
pub fn copy_word(word: &Word, buffer: *mut i32, capacity: usize, n_letters: *mut usize) -> Outcome {
    copy_counted("letters", &letters(word).collect::<Vec<_>>(), buffer, capacity, n_letters)
}
