//! The files of a hemisphere.

use super::args::BrainArgs;
use super::names::{FREESURFER, GIFTI, PICTURE};
use super::outcome::Hemisphere;
use crate::failure::Failure;
use crate::on_sphere::n_turned;
use crate::output::Outputs;
use crate::runner::CommandRun;
use ricci::geometry::predicates::orientation;
use ricci::mesh::Point;
use ricci::mesh::io::freesurfer::{
    SurfacePatch, VertexLabel, label_text, parse_freesurfer, parse_patch, patch_bytes, values_bytes,
};
use ricci::mesh::io::{
    Format, GiftiLabel, GiftiNotes, Soup, gifti_labels, gifti_surface, gifti_values, write_as,
};
use std::cmp::Ordering;

impl BrainArgs {
    /// Writes the files; returns the numbers of triangles that the numbers in the files of the sphere and of the patch turn over.
    pub fn write_hemisphere(&self, of: &Hemisphere, run: &mut CommandRun<'_>) -> Result<[usize; 2], Failure> {
        let turned = self.write_freesurfer(of, &mut run.outputs)?;
        if self.gifti {
            self.write_gifti(of, &mut run.outputs)?;
        }
        if self.pictures {
            let path = self.file(of.side, PICTURE);
            run.draw(Some(&path), || self.draw(of))?;
        }
        Ok(turned)
    }

    fn write_freesurfer(&self, of: &Hemisphere, outputs: &mut Outputs) -> Result<[usize; 2], Failure> {
        let faces = of.surface.mesh().triangles();
        let n_faces = faces.len();
        let sphere = Soup::new(of.on_sphere(self.radius), faces.clone());
        let inflated = Soup::new(of.inflated.clone(), faces);
        outputs.add_named(&self.file(of.side, FREESURFER[0]), |path| {
            write_as(path, Format::FreeSurfer, &sphere)
        })?;
        let turned_on_sphere = turned_on_sphere(outputs)?;
        outputs.add_named(&self.file(of.side, FREESURFER[1]), |path| {
            write_as(path, Format::FreeSurfer, &inflated)
        })?;
        outputs.add_bytes(&self.file(of.side, FREESURFER[2]), &values_bytes(&of.sulc, n_faces)?)?;
        outputs.add_bytes(&self.file(of.side, FREESURFER[3]), &patch_bytes(&of.patch())?)?;
        let turned_in_patch = of.turned_in_patch(outputs)?;
        outputs.add_bytes(&self.file(of.side, FREESURFER[4]), label_text(&of.label())?.as_bytes())?;
        for (ending, values) in FREESURFER[5..].iter().zip(of.distortion.as_flattened()) {
            outputs.add_bytes(&self.file(of.side, ending), &values_bytes(values, n_faces)?)?;
        }
        Ok([turned_on_sphere, turned_in_patch])
    }

    fn write_gifti(&self, of: &Hemisphere, outputs: &mut Outputs) -> Result<(), Failure> {
        let notes = |kind: &[(&str, &str)]| {
            let primary = ("AnatomicalStructurePrimary", of.side.anatomy());
            let all = std::iter::once(&primary).chain(kind);
            let metadata = all.map(|(name, value)| (name.to_string(), value.to_string())).collect();
            GiftiNotes { metadata, transforms: Vec::new() }
        };
        let kind = |kind| notes(&[("GeometricType", kind)]);
        let faces = of.surface.mesh().triangles();
        let inside = |f: &&[u32; 3]| f.iter().all(|&v| of.is_cortex[v as usize]);
        let flat_faces: Vec<[u32; 3]> = faces.iter().filter(inside).copied().collect();
        let [[a, b], [c, d]] = &of.distortion;
        let distortion: [(&str, &[f64]); 4] =
            [("sphere areal", a), ("sphere shape", b), ("flat areal", c), ("flat shape", d)];
        let color = |x: f64| [x, 0.6 * x, 0.0, x];
        let row = |key, name: &str, x| GiftiLabel { key, name: name.into(), color: color(x) };
        let table = [row(0, "medial wall", 0.0), row(1, "cortex", 1.0)];
        let labels: Vec<i32> = of.is_cortex.iter().map(|&cortex| cortex.into()).collect();
        let files = [
            gifti_surface(&Soup::new(of.on_sphere(self.radius), faces.clone()), &kind("Spherical"))?,
            gifti_surface(&Soup::new(of.inflated.clone(), faces), &kind("Inflated"))?,
            gifti_surface(&Soup::new(of.whole_flat(), flat_faces), &kind("Flat"))?,
            gifti_values(&[("sulc", &of.sulc)], &notes(&[]))?,
            gifti_values(&distortion, &notes(&[]))?,
            gifti_labels(&labels, &table, &notes(&[]))?,
        ];
        GIFTI
            .iter()
            .zip(files)
            .try_for_each(|(ending, bytes)| outputs.add_bytes(&self.file(of.side, ending), &bytes))
    }
}

/// The triangles of the file that was written last that its numbers turn over as seen from the middle.
fn turned_on_sphere(outputs: &Outputs) -> Result<usize, Failure> {
    let bytes = outputs.last_bytes().map_err(|e| Failure::Failed(e.to_string()))?;
    let back = parse_freesurfer(&bytes, "the sphere")?;
    Ok(n_turned(&back))
}

impl Hemisphere {
    pub fn on_sphere(&self, radius: f64) -> Vec<Point> {
        self.sphere.points.iter().map(|p| p.map(|x| radius * x)).collect()
    }

    /// The flat map at the vertices of the whole surface; those outside the cortex are at the origin.
    pub fn whole_flat(&self) -> Vec<Point> {
        let mut all = vec![[0.0; 3]; self.is_cortex.len()];
        for (&v, [x, y]) in self.cortex.origins.iter().zip(&self.cortex.flat.points) {
            all[v as usize] = [*x, *y, 0.0];
        }
        all
    }

    fn patch(&self) -> SurfacePatch {
        let mesh = self.cortex.surface.mesh();
        SurfacePatch {
            vertices: self.cortex.origins.clone(),
            positions: self.cortex.flat.points.iter().map(|[x, y]| [*x, *y, 0.0]).collect(),
            is_border: mesh.vertices().map(|v| mesh.is_boundary_vertex(v)).collect(),
        }
    }

    /// The triangles of the cortex that the numbers in the file that was written last turn over.
    fn turned_in_patch(&self, outputs: &Outputs) -> Result<usize, Failure> {
        let bytes = outputs.last_bytes().map_err(|e| Failure::Failed(e.to_string()))?;
        let back = parse_patch(&bytes, "the patch")?;
        let is_turned = |f: &&[u32; 3]| {
            let [a, b, c] = f.map(|v| back.positions[v as usize]).map(|[x, y, _]| [x, y]);
            orientation(a, b, c) != Ordering::Greater
        };
        Ok(self.cortex.surface.mesh().triangles().iter().filter(is_turned).count())
    }

    fn label(&self) -> VertexLabel {
        let positions = self.surface.positions();
        let place = |&v: &u32| positions.map_or([0.0; 3], |positions| positions[v as usize]);
        VertexLabel {
            comment: "ascii label, the cortex without its medial wall, by ricci".into(),
            vertices: self.cortex.origins.iter().map(|&v| Some(v)).collect(),
            positions: self.cortex.origins.iter().map(place).collect(),
            values: vec![0.0; self.cortex.origins.len()],
        }
    }
}
