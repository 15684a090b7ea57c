//! Maps between two surfaces of the same topology: both go to a canonical domain, one by a harmonic map into the other's, and the two are
//! composed \[ZLYG, Eqn 18\].

mod balance;
mod cover;
mod disk;
mod find;
mod generators;
mod handles;
mod measure;
mod options;
mod orbifold;
pub mod place;
mod repair;
mod route;
mod sphere;
mod tree;
mod turn;
mod walk;
mod weights;

pub use balance::BalanceReport;
pub use find::{Matching, match_surfaces};
pub use measure::{MapQuality, cycle_error, map_quality};
pub use options::MatchOptions;
pub use place::{Place, SurfaceMap};
