//! Flattens a surface and says how much the layout distorts it: `cargo run --release --example flatten -- mesh.obj`.
//! Without a file it flattens a torus.

#![allow(clippy::print_stdout)]

use ricci::embed::{Layout, LayoutOptions};
use ricci::{Class, Control, Flow, Result, Surface, Target, flow, geometry::Space, mesh::shapes};

fn main() -> Result<()> {
    let surface = match std::env::args_os().nth(1) {
        Some(path) => Surface::read(path)?,
        None => Surface::from_soup(&shapes::torus(2.0, 1.0, 48, 24)?)?,
    };
    let control = Control::new();
    let target = Target::default_for(&surface, Space::E2)?;
    let mut flow = Flow::new(surface.clone(), Class::yamabe(Space::E2), &flow::Options::default(), &control)?;
    let flat = flow.solve(&target, &control)?;
    let layout = Layout::of_solution(&flat, &LayoutOptions::default(), &control)?;
    let quality = layout.quality(surface.mesh(), surface.lengths())?;
    assert!(flat.converged() && layout.flipped.is_empty());
    println!("{} faces, dilatation {:.3} in the mean", surface.mesh().n_faces(), quality.qc_mean);
    Ok(())
}
