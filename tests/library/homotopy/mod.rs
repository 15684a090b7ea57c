//! Tests of canonical homotopy bases, lifts and fundamental domains, by theorem. Results are compared with homomorphisms to symmetric
//! groups that are made of faces alone, and with intersection numbers.

mod basis;
mod domain;
mod group;
mod representation;
mod samples;
