//! The way back from texture coordinates to the model, and the picture of an atlas.

use super::args::TextureArgs;
use super::outcome::TextureOutcome;
use crate::failure::Failure;
use crate::picture::{self, Picture, ShownLayout, ShownSurface, TextureChoice};
use std::collections::{HashMap, HashSet};
use std::io::Write;

/// A row for each texture coordinate of an OBJ file: the vertex of the model at which it is, its chart and its page. A coordinate at which
/// several vertices are, as between faces that the model does not join, has a row for each.
pub fn write_origins(out: &mut impl Write, outcome: &TextureOutcome) -> std::io::Result<()> {
    writeln!(out, "texcoord,vertex,chart,page")?;
    let atlas = &outcome.atlas;
    let mut number: HashMap<[u64; 2], usize> = HashMap::new();
    let mut known: HashSet<(usize, u32)> = HashSet::new();
    for (f, corners) in outcome.soup.faces.iter().enumerate() {
        for (v, uv) in corners.iter().zip(atlas.corner_uv[f]) {
            let next = number.len();
            let own = *number.entry(uv.map(f64::to_bits)).or_insert(next);
            if known.insert((own, *v)) {
                writeln!(out, "{own},{v},{},{}", atlas.chart[f] as i32, atlas.page(f))?;
            }
        }
    }
    Ok(())
}

/// The model with a checkerboard beside its atlas, or as SVG the atlas alone.
pub fn draw(outcome: &TextureOutcome, args: &TextureArgs) -> Result<Vec<u8>, Failure> {
    let atlas = &outcome.atlas;
    let style = args.picture.style(TextureChoice::Checker, args.common.threads);
    let Borders { on_page, on_model } = Borders::of(outcome);
    let ends = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let tile = |page: usize| [page % 10, page / 10].map(|x| x as f64);
    let sides = |page: usize| {
        let corner = move |k: usize| [0, 1].map(|c| ends[k % 4][c] + tile(page)[c]);
        [0, 1, 2, 3].map(|k| (corner(k), corner(k + 1)))
    };
    let frame: Vec<_> = (0..atlas.pages).flat_map(sides).collect();
    let flat = ShownLayout {
        corner_uv: &atlas.corner_uv,
        boundary: &on_page,
        frame: &frame,
        ..ShownLayout::default()
    };
    if args.picture.is_svg() {
        return picture::svg(&Picture { flat: Some(flat), ..Picture::default() }, &style);
    }
    let surface = ShownSurface {
        positions: &outcome.soup.positions,
        faces: &outcome.soup.faces,
        corner_uv: Some(&atlas.corner_uv),
        seams: &on_model,
        cones: &[],
        is_closed: false,
    };
    picture::png(&Picture { surface: Some(surface), flat: Some(flat), ..Picture::default() }, &style)
}

/// The sides of faces that no other face continues on the page.
struct Borders {
    on_page: Vec<([f64; 2], [f64; 2])>,
    /// Those that are seams, by the ends on the model.
    on_model: Vec<(u32, u32, usize)>,
}

impl Borders {
    fn of(outcome: &TextureOutcome) -> Borders {
        let (faces, uv) = (&outcome.soup.faces, &outcome.atlas.corner_uv);
        let bits = |p: [f64; 2]| p.map(f64::to_bits);
        let sides = || {
            let all = (0..faces.len()).flat_map(|f| [0, 1, 2].map(|k| (f, k, (k + 1) % 3)));
            all.map(|(f, k, next)| ([faces[f][k], faces[f][next]], [uv[f][k], uv[f][next]]))
        };
        let on_page: HashSet<[[u64; 2]; 2]> = sides().map(|(_, uv)| uv.map(bits)).collect();
        let on_model: HashSet<[u32; 2]> = sides().map(|(ends, _)| ends).collect();
        let mut borders = Borders { on_page: Vec::new(), on_model: Vec::new() };
        for ([v, w], [p, q]) in sides().filter(|(_, [p, q])| !on_page.contains(&[bits(*q), bits(*p)])) {
            borders.on_page.push((p, q));
            if on_model.contains(&[w, v]) {
                borders.on_model.push((v, w, 0));
            }
        }
        borders
    }
}
