//! Finds the metric of constant curvature of a surface of genus 2 and its deck group in the hyperbolic plane:
//! `cargo run --release --example uniformize`.

#![allow(clippy::print_stdout)]

use ricci::canonical::{QuotientOptions, Uniformization, uniformize};
use ricci::{Control, Result, Surface, mesh::shapes};

fn main() -> Result<()> {
    let surface = Surface::from_soup(&shapes::genus(2, 4)?)?;
    let found = uniformize(&surface, &QuotientOptions::default(), &Control::new())?;
    assert!(found.converged());
    if let Uniformization::Quotient(quotient) = &found {
        let deck = &quotient.deck;
        println!(
            "{} generators, their relation holds to {:.1e}",
            deck.generators.len(),
            deck.relation_residual
        );
    }
    Ok(())
}
