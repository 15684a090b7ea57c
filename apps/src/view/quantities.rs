//! The quantities of a view: those of a CSV file, of the mesh's own file, and the distortion of its texture coordinates.

use crate::csv::read_numbers;
use crate::failure::Failure;
use crate::page::{VertexQuantity, ViewSides};
use ricci::embed::Quality;
use ricci::mesh::io::Soup;
use std::path::Path;

/// The quantity of a CSV file for a mesh with so many vertices; those without a row have no number.
pub fn of_table(path: &Path, n_vertices: usize) -> Result<VertexQuantity, Failure> {
    let (name, rows) = read_numbers(path, n_vertices)?;
    let mut values = vec![f64::NAN; n_vertices];
    rows.into_iter().for_each(|(v, x)| values[v.index()] = x);
    let of_file = || path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    Ok(VertexQuantity { name: name.unwrap_or_else(of_file), values })
}

/// The numbers that a mesh file has at its vertices.
pub fn of_file(soup: &Soup) -> Vec<VertexQuantity> {
    let columns = soup.attributes.vertex_numbers.iter();
    columns
        .map(|column| VertexQuantity { name: column.name.clone(), values: column.values.clone() })
        .collect()
}

/// How texture coordinates change areas and angles around each of `n` vertices of a file: means of the faces that are shown.
pub fn of_texture(sides: &ViewSides, n: usize) -> ricci::Result<Vec<VertexQuantity>> {
    let Some(image) = &sides.image else { return Ok(Vec::new()) };
    let at = |v: u32| [image[v as usize][0], image[v as usize][1]];
    let uv: Vec<[[f64; 2]; 3]> = sides.corners.iter().map(|corners| corners.map(at)).collect();
    let quality = Quality::of_texture(&sides.places, &sides.corners, &uv)?;
    let around = |of: &dyn Fn(usize) -> f64| {
        let (mut sum, mut count) = (vec![0.0; n], vec![0.0; n]);
        for (f, corners) in sides.corners.iter().enumerate() {
            let value = of(f);
            for v in corners.map(|v| sides.origins[v as usize] as usize) {
                sum[v] += value;
                count[v] += 1.0;
            }
        }
        sum.iter().zip(count).map(|(sum, count)| sum / count).collect()
    };
    let named = |name: &str, values| VertexQuantity { name: name.into(), values };
    Ok(vec![
        named("logarithm of the change of area", around(&|f| quality.area_ratio[f.into()].ln())),
        named("quasi-conformal dilatation", around(&|f| quality.qc[f.into()])),
    ])
}
