//! The reason why a call fails: a status, a message, and the element and the amount as numbers.

use crate::status::*;
use crate::wording::in_functions;
use ricci::mesh::check::Defect;
use ricci::{Error, FilePosition};
use std::borrow::Cow;

/// The result of the body of an entry point.
pub type Outcome<T = ()> = Result<T, Failure>;

/// The kind of element at which a call fails, which its number counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FailureElement {
    #[default]
    None,
    Vertex,
    Edge,
    Face,
    /// An entry, or a row, of the caller's array.
    Entry,
    /// A line of a text file, from 1.
    Line,
    /// A byte of a file.
    Byte,
}

/// The reason why a call fails.
#[derive(Debug, Default)]
pub struct Failure {
    pub status: ricci_status,
    pub message: Cow<'static, str>,
    pub at: (FailureElement, usize),
    pub amount: f64,
    pub needed: usize,
    /// True if the caller asked for a size, by NULL with capacity 0: that is not logged.
    pub is_question: bool,
}

impl Failure {
    pub fn new(status: ricci_status, message: impl Into<Cow<'static, str>>) -> Failure {
        Failure { status, message: message.into(), ..Failure::default() }
    }

    pub fn null(what: &str) -> Failure {
        Failure::new(RICCI_NULL_POINTER, format!("{what} is NULL"))
    }

    pub fn argument(message: impl Into<Cow<'static, str>>) -> Failure {
        Failure::new(RICCI_ARGUMENT, message)
    }

    /// The failure of a call to which the system has refused memory, so that it could not go on.
    pub fn for_want_of_memory(self) -> Failure {
        let message = if self.status == RICCI_CANCELLED {
            "the system has no memory for the work of this call".into()
        } else {
            format!("the system has no memory for the work of this call ({})", self.message)
        };
        Failure::new(RICCI_NO_MEMORY, message)
    }

    /// The same failure, at an element.
    pub fn at(self, element: FailureElement, index: usize) -> Failure {
        Failure { at: (element, index), ..self }
    }

    /// The same failure, with the number of entries that are needed.
    pub fn needs(self, needed: usize) -> Failure {
        Failure { needed, ..self }
    }
}

/// The failure of a call that names an element which does not exist.
pub fn no_such(element: FailureElement, what: &str, index: usize, count: usize) -> Failure {
    Failure::argument(format!("{what} {index} does not exist: there are {count}")).at(element, index)
}

/// The number of the system's error, which the standard library writes at the end of its message; 0 where the failure has none.
fn system_error(message: &str) -> f64 {
    let number = message.rsplit_once("(os error ").and_then(|(_, rest)| rest.strip_suffix(')'));
    number.and_then(|number| number.parse::<i32>().ok()).map_or(0.0, f64::from)
}

/// The first vertex that a defect concerns, or the first face.
fn place(defect: &Defect) -> (FailureElement, usize) {
    let first = |numbers: Vec<u32>, element| Some((element, *numbers.first()? as usize));
    let vertex = first(defect.vertices(), FailureElement::Vertex);
    vertex.or_else(|| first(defect.faces(), FailureElement::Face)).unwrap_or_default()
}

impl From<Error> for Failure {
    fn from(error: Error) -> Failure {
        let failure = Failure::new(error.code(), in_functions(&error.to_string()).into_owned());
        let (at, amount) = match &error {
            Error::Size { expected, .. } => return failure.needs(*expected),
            // The system cannot start as many threads.
            Error::Argument { what: "threads", .. } => {
                return Failure { status: RICCI_NO_MEMORY, ..failure };
            }
            Error::Parse { at: FilePosition::Line(line), .. } => ((FailureElement::Line, *line), 0.0),
            Error::Parse { at: FilePosition::Byte(byte), .. } => ((FailureElement::Byte, *byte), 0.0),
            Error::Defects(found) => (found.defects.first().map_or((FailureElement::None, 0), place), 0.0),
            Error::TooLarge { count, .. } => ((FailureElement::None, 0), *count as f64),
            Error::Gluing { face, .. } => ((FailureElement::Face, *face), 0.0),
            Error::EdgeLength { edge, length } => ((FailureElement::Edge, *edge), *length),
            Error::TriangleInequality { face, excess } => ((FailureElement::Face, *face), *excess),
            Error::EdgeWeight { edge, eta, .. } => ((FailureElement::Edge, *edge), *eta),
            Error::Domain { vertex, u, .. } => ((FailureElement::Vertex, *vertex), *u),
            Error::TargetAtVertex { vertex, excess, .. } => ((FailureElement::Vertex, *vertex), *excess),
            Error::TargetBelow { vertex, excess, .. } => ((FailureElement::Vertex, *vertex), *excess),
            Error::Spline { what: "patch" | "triangle", index, .. } => ((FailureElement::Face, *index), 0.0),
            Error::Spline { what: "vertex", index, .. } => ((FailureElement::Vertex, *index), 0.0),
            Error::Spline { index, .. } => ((FailureElement::Entry, *index), 0.0),
            Error::TargetTotal { miss, .. } => ((FailureElement::None, 0), *miss),
            Error::Io { message, .. } => ((FailureElement::None, 0), system_error(message)),
            _ => return failure,
        };
        Failure { at, amount, ..failure }
    }
}
