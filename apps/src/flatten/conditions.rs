//! The files that say under which conditions a surface is flattened: weights of faces, places of vertices, straight pieces of the border.

use super::args::FlattenArgs;
use super::part::Part;
use crate::csv::{read_places, read_rows, read_runs, refuse};
use crate::failure::Failure;
use ricci::flatten::FlattenOptions;
use ricci::mesh::VertexId;
use std::path::Path;

impl FlattenArgs {
    /// The library's options with what the files say; vertices are those of the part, by their numbers in the whole surface.
    pub fn options_with_conditions(&self, part: &Part) -> Result<FlattenOptions, Failure> {
        let in_part = part.numbers();
        let here = |path: &Path, v: VertexId| match in_part[v.index()] {
            Some(here) => Ok(here),
            None => Err(Failure::Input(format!("{}: vertex {v} is outside the label", path.display()))),
        };
        let mut options = self.options();
        if let Some(path) = &self.weights {
            options.weights = read_weights(path, part.input.mesh().n_faces())?;
        }
        if let Some(path) = &self.pin {
            for (v, at) in read_places(path, part.n_whole)? {
                options.pins.push((here(path, v)?, at));
            }
        }
        if let Some(path) = &self.straight {
            for (name, piece) in read_runs(path, "piece", part.n_whole)? {
                if piece.len() < 3 {
                    let why = format!(
                        "{}: piece {name} has {} vertices; give 3 or more",
                        path.display(),
                        piece.len()
                    );
                    return Err(Failure::Input(why));
                }
                options.straight.push(piece.into_iter().map(|v| here(path, v)).collect::<Result<_, _>>()?);
            }
        }
        Ok(options)
    }
}

impl Part {
    /// Per vertex of the whole surface its number in the part.
    fn numbers(&self) -> Vec<Option<VertexId>> {
        let mut numbers = vec![None; self.n_whole];
        match &self.origins {
            None => numbers.iter_mut().zip(0..).for_each(|(number, v)| *number = Some(VertexId(v))),
            Some(origins) => (0..).zip(origins).for_each(|(v, &w)| numbers[w as usize] = Some(VertexId(v))),
        }
        numbers
    }
}

/// `face,weight` rows as a weight per face, 1 for faces without a row.
fn read_weights(path: &Path, n_faces: usize) -> Result<Vec<f64>, Failure> {
    let mut weights = vec![1.0; n_faces];
    for (i, [face, weight]) in read_rows(path, ["face", "weight"])? {
        let f: usize = face.parse().map_err(|_| refuse(path, i, format!("`{face}` is no face")))?;
        let known = weights.get_mut(f);
        let place = known.ok_or_else(|| refuse(path, i, format!("face {f}: there are {n_faces}, from 0")))?;
        let number = weight.parse().ok().filter(|x: &f64| x.is_finite() && *x > 0.0);
        *place = number.ok_or_else(|| refuse(path, i, format!("`{weight}` is no weight above 0")))?;
    }
    Ok(weights)
}
