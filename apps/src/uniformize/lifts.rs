//! The loops of `--lift` and `--word`, lifted to the universal cover, and the file of `--lift-out`.

use super::group_file::letters;
use super::model_place::ModelPlace;
use super::quotient::{NamedLift, Uniformized};
use super::request::CoverRequest;
use crate::csv::read_loops;
use crate::failure::Failure;
use crate::input::Input;
use ricci::embed::LiftedLoop;
use serde::Serialize;
use serde_json::{Value, json};

/// Lift the loops that are asked for.
pub fn lifts(u: &Uniformized, request: &CoverRequest<'_>, input: &Input) -> Result<Vec<NamedLift>, Failure> {
    let mut found = Vec::new();
    for text in request.words {
        let word = u.deck.group.parse(&text.replace('.', " "));
        let word = word.map_err(|error| Failure::Usage(format!("--word {text}: {error}")))?;
        let lift = u.deck.lift_word(&u.layout, &u.basis, &word)?;
        found.push(NamedLift { name: text.clone(), lift });
    }
    if let Some(path) = request.lift {
        let layout = &u.laid()?.layout;
        for (name, vertices) in read_loops(path, input.mesh().n_vertices())? {
            let refuse = |error: ricci::Error| match error {
                ricci::Error::Argument { .. } => {
                    Failure::Input(format!("{}: loop {name}: {error}", path.display()))
                }
                other => other.into(),
            };
            let lift = u.deck.lift_loop(layout, &vertices).map_err(refuse)?;
            found.push(NamedLift { name, lift });
        }
    }
    Ok(found)
}

/// Lifted loops.
#[derive(Serialize)]
pub struct LiftFile {
    space: &'static str,
    /// The model of the coordinates of points; matrices act on the plane or the Poincaré disk.
    model: &'static str,
    lifts: Vec<LiftEntry>,
}

#[derive(Serialize)]
struct LiftEntry {
    name: String,
    /// The deck transformation that carries the first point to the last, as a word in the generators and as a Möbius matrix of `[re, im]`.
    word: Vec<String>,
    matrix: [[[f64; 2]; 2]; 2],
    /// The part of `matrix` that floating-point numbers lose.
    matrix_lo: [[[f64; 2]; 2]; 2],
    /// Vertices along the loop: numbers of the input, further ones are crossings of the common subdivision.
    vertices: Vec<u32>,
    points: Vec<Vec<f64>>,
}

impl LiftFile {
    pub fn new(u: &Uniformized, at: ModelPlace) -> LiftFile {
        let entry = |named: &NamedLift| {
            let LiftedLoop { vertices, points, element, .. } = &named.lift;
            LiftEntry {
                name: named.name.clone(),
                word: letters(&u.deck.group, &element.word),
                matrix: element.motion.mobius(),
                matrix_lo: element.motion.mobius_remainder(),
                vertices: vertices.iter().map(|v| v.0).collect(),
                points: points.iter().map(|p| at.numbers(*p)).collect(),
            }
        };
        LiftFile { space: u.deck.space.name(), model: at.name(), lifts: u.lifts.iter().map(entry).collect() }
    }
}

/// The figures of the lifts for the report; none where no loop was lifted.
pub fn figures(u: &Uniformized) -> Option<Value> {
    let of = |named: &NamedLift| {
        let LiftedLoop { vertices, element, end_error, .. } = &named.lift;
        json!({
            "name": named.name,
            "word": letters(&u.deck.group, &element.word),
            "vertices": vertices.len(),
            "translation_length": element.motion.translation_length(),
            "end_error": end_error,
        })
    };
    (!u.lifts.is_empty()).then(|| u.lifts.iter().map(of).collect())
}

/// The lines of the summary about lifts.
pub fn text(u: &Uniformized) -> String {
    let line = |named: &NamedLift| {
        let LiftedLoop { element, end_error, .. } = &named.lift;
        let word = u.deck.group.text(&element.word);
        format!("lift     {}: ends where {word} carries its start, to {end_error:.1e}\n", named.name)
    };
    u.lifts.iter().map(line).collect()
}
