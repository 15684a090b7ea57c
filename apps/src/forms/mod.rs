//! `ricci forms`: harmonic and holomorphic 1-forms, their periods and zeros.

mod args;
mod command;
mod drawn;
mod figures;
mod file;
mod found;

pub use args::{FormsArgs, HELP};
pub use command::{execute, run};
