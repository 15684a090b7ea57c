//! The files of `--flat`: a layout in the plane as geometry, or as a drawing for cutting sheets and fabrics.

use crate::carry::{CarriedAttributes, carry, stays_behind};
use crate::failure::{Failure, NO_POSITIONS};
use crate::input::Input;
use crate::options::{FlatArgs, OnChoice};
use crate::output::{Outputs, check_extension, extension, format_of};
use crate::surface_layout::SurfaceLayout;
use ricci::embed::{FlatSurface, fold_edges};
use ricci::mesh::PerEdge;
use ricci::mesh::io::{self, CuttingSheet, SheetUnit};
use ricci::metric::CommonSubdivision;
use std::borrow::Cow;
use std::path::Path;

/// Angle in degrees above which an edge is a fold where none is asked for: between those of smooth parts and those of creases in most
/// meshes.
const FOLD: f64 = 30.0;

impl FlatArgs {
    /// Refuse names of files that have no known format.
    pub fn check(&self) -> Result<(), Failure> {
        let drawn = self.flat.as_ref().is_none_or(|path| ["svg", "dxf"].contains(&extension(path).as_str()));
        if self.allowance.is_some() && !drawn {
            return Err(Failure::Usage("--allowance is drawn: give --flat a name in .svg or .dxf".into()));
        }
        check_extension("--flat", self.flat.as_deref(), &["obj", "ply", "off", "glb", "svg", "dxf"])
    }

    /// Refuse what can be refused once the surface is known.
    pub fn check_surface(&self, input: &Input) -> Result<(), Failure> {
        if self.fold_angle.is_some() && input.positions().is_none() {
            return Err(Failure::Usage(format!("--fold-angle: {NO_POSITIONS}, and so no angles at edges")));
        }
        Ok(())
    }

    fn unit(&self) -> SheetUnit {
        self.flat_unit.map_or_else(SheetUnit::default, SheetUnit::from)
    }
}

/// A surface in the plane that is to be written.
pub struct FlatLayout<'a> {
    pub surface: FlatSurface<'a>,
    /// The surface in space.
    pub input: &'a Input,
    /// The subdivision of the input that is laid out, if it is one.
    pub subdivision: Option<&'a CommonSubdivision>,
}

impl<'a> FlatLayout<'a> {
    /// The faces of a layout that `on` names.
    pub fn new(input: &'a Input, laid: &'a SurfaceLayout, on: OnChoice) -> Result<FlatLayout<'a>, Failure> {
        let (surface, subdivision) = match (on, &laid.on_input) {
            (OnChoice::Refined, _) => {
                let (corner_index, points) = (laid.corner_index(), Cow::Borrowed(laid.coordinates()));
                let surface = FlatSurface { mesh: laid.mesh(), corner_index, points, seams: laid.seams() };
                (surface, laid.common_subdivision())
            }
            (OnChoice::Input, Some(on_input)) => match laid.repaired() {
                Some(repaired) => (FlatSurface::of_repaired(repaired, on_input), Some(&*repaired.refinement)),
                None => (FlatSurface::of_input(input.mesh(), on_input), None),
            },
            (OnChoice::Input, None) => {
                return Err(Failure::Failed(
                    "--on input: the layout is not cut along the input's edges".into(),
                ));
            }
        };
        Ok(FlatLayout { surface, input, subdivision })
    }

    /// The same layout with its lengths multiplied by a factor.
    pub fn scaled(mut self, factor: f64) -> FlatLayout<'a> {
        if factor != 1.0 {
            let scaled = self.surface.points.iter().map(|p| p.map(|x| factor * x));
            self.surface.points = Cow::Owned(scaled.collect());
        }
        self
    }

    /// Write the format that the name says.
    pub fn write(&self, outputs: &mut Outputs, path: &Path, args: &FlatArgs) -> Result<(), Failure> {
        let other = std::io::Error::other;
        match extension(path).as_str() {
            "svg" => {
                let sheet = self.sheet(args)?;
                outputs.add(path, |out| io::write_svg_to(out, &sheet, args.unit()).map_err(other))
            }
            "dxf" => {
                let sheet = self.sheet(args)?;
                outputs.add(path, |out| io::write_dxf_to(out, &sheet, args.unit()).map_err(other))
            }
            _ => {
                let format = format_of(path)?;
                let mut soup = self.surface.soup();
                let carried = carry(self.input, self.subdivision)?;
                soup.attributes.colors = self.colors(&carried);
                soup.attributes.labels = carried.labels;
                let behind = stays_behind(soup.attributes.labels.as_ref(), &self.input.path, path);
                let left_out = outputs.add_named(path, |path| io::write_as(path, format, &soup))?;
                outputs.leave_out(left_out.into_iter().chain(behind));
                Ok(())
            }
        }
    }

    fn sheet(&self, args: &FlatArgs) -> Result<CuttingSheet, Failure> {
        let mesh = self.input.mesh();
        let mut is_fold = PerEdge::filled(mesh.n_edges(), false);
        if let Some(positions) = self.input.positions() {
            let angle = args.fold_angle.unwrap_or(FOLD).to_radians();
            fold_edges(mesh, positions, angle).into_iter().for_each(|e| is_fold[e] = true);
        }
        let sheet = self.surface.sheet(|e| {
            let of_input = self.subdivision.map_or(Some(e), |r| r.edge(0, e));
            of_input.is_some_and(|e| is_fold[e])
        });
        match args.allowance {
            Some(distance) => Ok(sheet.with_allowance(distance)?),
            None => Ok(sheet),
        }
    }

    /// The input's colours at the points of the opened surface.
    fn colors(&self, carried: &CarriedAttributes) -> Option<Vec<[f64; 4]>> {
        let at_vertices = &carried.colors;
        if at_vertices.is_empty() {
            return None;
        }
        let FlatSurface { mesh, corner_index, points, .. } = &self.surface;
        let mut colors = vec![[1.0; 4]; points.len()];
        for h in mesh.halfedges().filter(|&h| !mesh.is_outside(h)) {
            colors[corner_index[h] as usize] = at_vertices[mesh.origin(h).index()];
        }
        Some(colors)
    }
}
