//! STEP files (AP242) of tensor-product patches: closed parts as solids, open ones as shells, with common edges and vertices.

mod geometry;
mod shells;

use crate::error::{Error, Result};
use crate::geometry::vector::Vector;
use geometry::{Authored, ParameterPlane, add_curve, add_point, add_surface};
pub(super) use geometry::{StepCurveGeometry, StepSurfaceGeometry};
use shells::add_shells;
use std::io::Write;
use step_io::build::{StyleTarget, UnitsInput};
use step_io::model as m;
use step_io::scene::Rgb;
use step_io::{Ap242Author, StepBuilder, StepModel};

/// The time stamp of every file: fixed, so that the same patches give the same bytes.
const TIME_STAMP: &str = "2000-01-01T00:00:00Z";
/// Distance, over the diagonal, below which a reader may take two points as one. Common curves and points agree to the last bit.
const UNCERTAINTY: f64 = 1e-7;

/// The colours of faces, as red, green and blue in [0, 1]: five suffice where at most four patches lie beside one.
const COLOURS: [[f64; 3]; 5] =
    [[0.55, 0.70, 0.86], [0.95, 0.76, 0.50], [0.63, 0.80, 0.58], [0.87, 0.62, 0.62], [0.76, 0.68, 0.84]];

/// The unit of the coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LengthUnit {
    /// Millimetres.
    #[default]
    Millimetre,
    /// Metres.
    Metre,
}

/// Options of STEP files.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StepOptions {
    /// The name of the part.
    pub name: String,
    /// The unit of the coordinates.
    pub unit: LengthUnit,
    /// True: faces have colours that differ from those of their neighbours, so that programs show the patches. By default they have none.
    pub colours: bool,
}

/// A curve that is a side of one patch or of two.
pub(super) struct StepCurve {
    /// The points at which it begins and ends.
    pub ends: [u32; 2],
    /// True where the surface may have an edge: the file's edge is named `crease`.
    pub is_crease: bool,
    pub curve: StepCurveGeometry,
}

/// A patch.
pub(super) struct StepPatch {
    pub surface: StepSurfaceGeometry,
    /// Its sides along the way around: the curve of each, and true if that runs against the way.
    pub sides: [(usize, bool); 4],
}

/// A connected part of a surface of patches.
pub(super) struct StepPart {
    /// The numbers of its patches.
    pub patches: Vec<usize>,
    /// True if every side of its patches belongs to two of them.
    pub is_closed: bool,
    /// True if the normals of its patches point inwards.
    pub is_inverted: bool,
}

/// Patches that share curves and points.
pub(super) struct StepPatches<'a> {
    /// The points at which curves end.
    pub points: &'a [Vector],
    pub curves: Vec<StepCurve>,
    pub patches: Vec<StepPatch>,
    pub parts: Vec<StepPart>,
    /// The diagonal of the box around the surface.
    pub diagonal: f64,
}

impl StepPatches<'_> {
    /// Writes the patches as STEP AP242. Each part that closes up becomes a solid with outward normals; the others become shells of one
    /// surface model. The same patches give the same bytes.
    ///
    /// # Errors
    /// [`Error::Spline`] for patches that cannot be written; [`Error::Io`], without a path, if writing to `out` fails.
    pub fn write(&self, options: &StepOptions, out: &mut impl Write) -> Result<()> {
        let model = self.model(options).map_err(|why| {
            let message = format!("they cannot be written as STEP: {why}");
            Error::Spline { what: "patches", index: 0, message }
        })?;
        step_io::write(&model, out).map_err(|why| Error::Io { path: "STEP".into(), message: why.to_string() })
    }

    fn model(&self, options: &StepOptions) -> Authored<StepModel> {
        let length = match options.unit {
            LengthUnit::Millimetre => step_io::build::LengthUnit::Millimetre,
            LengthUnit::Metre => step_io::build::LengthUnit::Metre,
        };
        let units = UnitsInput { length, uncertainty: UNCERTAINTY * self.diagonal };
        let mut builder = StepBuilder::new_with(&units)?;
        let header = builder.header_mut();
        header.time_stamp = TIME_STAMP.into();
        header.file_name.clone_from(&options.name);
        header.originating_system = concat!("ricci ", env!("CARGO_PKG_VERSION")).into();
        let part = builder.part(&options.name);
        let surfaces = self.patches.iter().map(|patch| add_surface(builder.author(), &patch.surface));
        let surfaces = surfaces.collect::<Authored<Vec<_>>>()?;
        let edges = self.edges(builder.author(), &surfaces)?;
        let colours = if options.colours { self.colours() } else { Vec::new() };
        let mut open = Vec::new();
        for part_of in &self.parts {
            let mut faces = Vec::with_capacity(part_of.patches.len());
            for &at in &part_of.patches {
                let sides = self.patches[at].sides.map(|(curve, reversed)| (edges[curve], reversed));
                let name = format!("patch {at}");
                let face = add_face(builder.author(), &name, surfaces[at], sides, part_of.is_inverted)?;
                if let Some([red, green, blue]) = colours.get(at).map(|&k| COLOURS[k]) {
                    builder.style(StyleTarget::Face(face), Rgb { red, green, blue }, None)?;
                }
                faces.push(face);
            }
            if part_of.is_closed {
                builder.solid(part, &options.name, faces)?;
            } else {
                open.push(faces);
            }
        }
        if !open.is_empty() {
            add_shells(&mut builder, part, open, &options.name, &units)?;
        }
        Ok(builder.finish())
    }

    /// Adds an edge for each curve, with the curves in the parameters of the patches beside it: a reader that had to find those by projection
    /// would take the wrong side of a thin patch.
    fn edges(
        &self,
        author: &mut Ap242Author,
        surfaces: &[m::BSplineSurfaceWithKnotsId],
    ) -> Authored<Vec<m::EdgeCurveId>> {
        let plane = ParameterPlane::add(author)?;
        let mut vertices = Vec::with_capacity(self.points.len());
        for &at in self.points {
            let point = m::PointRef::CartesianPoint(add_point(author, at)?);
            vertices.push(author.add_vertex_point("", point)?);
        }
        let mut beside = vec![Vec::new(); self.curves.len()];
        for (at, StepPatch { surface, sides }) in self.patches.iter().enumerate() {
            for (side, &(curve, reversed)) in sides.iter().enumerate() {
                let along = surface.side(side, reversed);
                let line = plane.add_line(author, surfaces[at], self.curves[curve].curve.domain(), along)?;
                beside[curve].push((at, line));
            }
        }
        let mut edges = Vec::with_capacity(self.curves.len());
        for (StepCurve { ends, is_crease, curve }, beside) in self.curves.iter().zip(&beside) {
            let curve = add_curve(author, curve)?;
            let lines = beside.iter().map(|&(_, line)| m::PcurveOrSurfaceRef::Pcurve(line)).collect();
            let by = m::PreferredSurfaceCurveRepresentation::Curve3d;
            let is_seam = beside.len() == 2 && beside[0].0 == beside[1].0;
            let on_surfaces = match is_seam {
                true => m::CurveRef::SeamCurve(author.add_seam_curve("", curve, lines, by)?),
                false => m::CurveRef::SurfaceCurve(author.add_surface_curve("", curve, lines, by)?),
            };
            let [from, to] = ends.map(|p| m::VertexRef::VertexPoint(vertices[p as usize]));
            let name = if *is_crease { "crease" } else { "" };
            edges.push(author.add_edge_curve(name, from, to, on_surfaces, true)?);
        }
        Ok(edges)
    }

    /// For each patch the number of its colour: the first that no patch before it has across a side, or where all are taken, that of the
    /// fewest.
    fn colours(&self) -> Vec<usize> {
        let mut beside = vec![Vec::new(); self.curves.len()];
        let mut chosen = Vec::with_capacity(self.patches.len());
        for StepPatch { sides, .. } in &self.patches {
            let mut taken = [0; COLOURS.len()];
            for &(curve, _) in sides {
                beside[curve].iter().for_each(|&k: &usize| taken[k] += 1);
            }
            let colour = (0..COLOURS.len()).min_by_key(|&k| taken[k]).unwrap_or(0);
            sides.iter().for_each(|&(curve, _)| beside[curve].push(colour));
            chosen.push(colour);
        }
        chosen
    }
}

/// Adds a named face over a surface with its sides, as (edge, true if it runs against the way around). An inverted face has the normal against
/// that of its surface.
fn add_face(
    author: &mut Ap242Author,
    name: &str,
    surface: m::BSplineSurfaceWithKnotsId,
    sides: [(m::EdgeCurveId, bool); 4],
    is_inverted: bool,
) -> Authored<m::AdvancedFaceId> {
    let mut around = Vec::with_capacity(4);
    for (edge, reversed) in sides {
        let edge = author.add_oriented_edge("", m::EdgeRef::EdgeCurve(edge), !reversed)?;
        around.push(m::OrientedEdgeRef::OrientedEdge(edge));
    }
    let around = m::LoopRef::EdgeLoop(author.add_edge_loop("", around)?);
    // The loop runs counterclockwise around the surface's own normal; the face's flags turn both at once.
    let bound = author.add_face_outer_bound("", around, !is_inverted)?;
    let surface = m::SurfaceRef::BSplineSurfaceWithKnots(surface);
    author.add_advanced_face(name, vec![m::FaceBoundRef::FaceOuterBound(bound)], surface, !is_inverted)
}
