//! The maps of one hemisphere, computed.

use super::args::BrainArgs;
use super::outcome::{Cortex, Hemisphere};
use super::side::HemisphereSide;
use crate::failure::Failure;
use crate::flatten::named_vertices;
use crate::input;
use crate::progress::doing;
use crate::vertex_distortion::VertexDistortion;
use ricci::Control;
use ricci::flatten::{
    FlattenOptions, InflateOptions, flat_part, flatten, flatten_sphere, inflate, medial_wall,
};
use ricci::geometry::vector::{cross, dot, normalised, sub};
use ricci::mesh::Point;
use ricci::mesh::io::Soup;
use ricci::metric::Surface;
use std::path::Path;

impl BrainArgs {
    /// Reads a hemisphere and computes its maps.
    pub fn hemisphere(
        &self,
        side: HemisphereSide,
        path: &Path,
        label: Option<&Path>,
        control: &Control,
    ) -> Result<Hemisphere, Failure> {
        let soup = input::read_triangles(path)?;
        let (surface, _) = input::in_space(Soup::new(soup.positions, soup.faces), None)?;
        check(&surface, path)?;
        let threads = self.common.threads;
        let options = FlattenOptions { threads, ..FlattenOptions::default() };
        let sphere =
            doing("mapping to the sphere", || flatten_sphere(&surface, &options, &control.part(0.0, 0.6)))?;
        let inflating = InflateOptions { time: self.inflate, threads, ..InflateOptions::default() };
        let inflated = doing("inflating", || inflate(&surface, &inflating, &control.part(0.6, 0.7)))?;
        let is_cortex = match label {
            Some(label) => flat_part(&surface, &named_vertices(label, inflated.len())?)?,
            None => {
                let wall = medial_wall(&surface, &inflated, side.medial(), self.wall)?;
                wall.into_iter().map(|wall| !wall).collect()
            }
        };
        let options = FlattenOptions { energy: self.energy.into(), injective: self.injective, ..options };
        let cortex =
            doing("flattening", || laid_flat(&surface, &is_cortex, &options, &control.part(0.7, 1.0)))
                .map_err(|why| not_flat(path, why))?;
        let sulc = moved_outwards(&surface, &inflated);
        let on_sphere = VertexDistortion::of_sphere(&surface, &sphere.points)?;
        let flat = VertexDistortion::of_plane(&cortex.surface, &cortex.flat.points)?;
        let whole = |values: Vec<f64>| {
            let mut all = vec![0.0; inflated.len()];
            cortex.origins.iter().zip(values).for_each(|(&v, x)| all[v as usize] = x);
            all
        };
        let distortion = [[on_sphere.areal, on_sphere.shape], [whole(flat.areal), whole(flat.shape)]];
        Ok(Hemisphere {
            side,
            path: path.into(),
            surface,
            sphere,
            inflated,
            sulc,
            is_cortex,
            cortex,
            distortion,
        })
    }
}

/// Refuses what is no hemisphere.
fn check(surface: &Surface, path: &Path) -> Result<(), Failure> {
    let mesh = surface.mesh();
    let (genus, loops) = (mesh.genus(), mesh.boundary_loops().len());
    if genus == 0 && loops == 0 {
        return Ok(());
    }
    Err(Failure::Input(format!(
        "{}: the surface has genus {genus} and {loops} boundary loops; a closed one of genus 0 is needed: `ricci repair --fill-holes` closes holes, handles have to be cut by the program that made the surface",
        path.display()
    )))
}

fn not_flat(path: &Path, why: Failure) -> Failure {
    match why {
        Failure::Cancelled => Failure::Cancelled,
        why => Failure::Input(format!("{}: the cortex cannot be laid flat: {why}", path.display())),
    }
}

/// The faces of the cortex as a surface of their own, laid flat.
fn laid_flat(
    surface: &Surface,
    is_cortex: &[bool],
    options: &FlattenOptions,
    control: &Control,
) -> Result<Cortex, Failure> {
    let positions = surface.positions().ok_or_else(Failure::no_positions)?;
    let origins: Vec<u32> = (0..is_cortex.len() as u32).filter(|&v| is_cortex[v as usize]).collect();
    let mut number = vec![u32::MAX; is_cortex.len()];
    (0..).zip(&origins).for_each(|(k, &v)| number[v as usize] = k);
    let inside = |face: &[u32; 3]| face.iter().all(|&v| is_cortex[v as usize]);
    let faces = surface.mesh().triangles().into_iter().filter(inside);
    let soup = Soup::new(
        origins.iter().map(|&v| positions[v as usize]).collect(),
        faces.map(|face| face.map(|v| number[v as usize])).collect(),
    );
    let surface = Surface::from_soup(&soup)?;
    let flat = flatten(&surface, options, control)?;
    Ok(Cortex { surface, origins, flat })
}

/// How far each vertex moved along the outer normal of the inflated surface, less the mean of all: positive in sulci.
fn moved_outwards(surface: &Surface, inflated: &[Point]) -> Vec<f64> {
    let mut normals = vec![[0.0; 3]; inflated.len()];
    for face in surface.mesh().triangles() {
        let [a, b, c] = face.map(|v| inflated[v as usize]);
        let normal = cross(sub(b, a), sub(c, a));
        for v in face {
            (0..3).for_each(|k| normals[v as usize][k] += normal[k]);
        }
    }
    let before = surface.positions();
    let moved =
        |v: usize| before.map_or(0.0, |before| dot(normalised(normals[v]), sub(inflated[v], before[v])));
    let all: Vec<f64> = (0..inflated.len()).map(moved).collect();
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    all.into_iter().map(|x| x - mean).collect()
}
