//! `ricci flow --components all`: a flow for each connected piece of a file, and one file with all layouts.

mod command;
mod outcome;
mod uv;

pub use command::ComponentsJob;
