//! Maps one surface onto another one, landmarks to landmarks: `cargo run --release --example match`.

#![allow(clippy::print_stdout)]

use ricci::matching::{MatchOptions, map_quality, match_surfaces};
use ricci::mesh::{VertexId, shapes};
use ricci::{Control, Result, Surface};

fn main() -> Result<()> {
    let ball = Surface::from_soup(&shapes::ellipsoid([1.0, 1.0, 1.0], 12)?)?;
    let egg = Surface::from_soup(&shapes::ellipsoid([1.0, 1.3, 0.8], 10)?)?;
    let landmarks = [0, 3, 5, 8, 11].map(|v| [VertexId(v), VertexId(v)]).to_vec();
    let options = MatchOptions { landmarks, ..MatchOptions::default() };
    let matching = match_surfaces(&ball, &egg, &options, &Control::new())?;
    let quality = map_quality([&ball, &egg], &matching.forward, &options.landmarks)?;
    let place = &matching.forward.places[20];
    println!("vertex 20 goes to face {} at {:?}", place.face, place.weights);
    println!("dilatation {:.3} in the mean, {} faces folded", quality.qc_mean, matching.flipped.len());
    Ok(())
}
